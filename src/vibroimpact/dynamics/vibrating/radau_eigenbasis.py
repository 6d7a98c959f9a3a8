"""The Radau rule of a stretch of contact, and the eigenbasis of its integration matrix."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.collocation import Map, Rule, collocation_rule
from vibroimpact.dynamics.core.records import MAPS, Bases, Basis

NODES_PER_STRETCH = 12
"""Nodes of a stretch: with more the eigenvectors of the integration matrix are too ill-conditioned,
with fewer the stretches are too short.
"""


_MAPS: tuple[Map, ...] = ("touch", "inside", "release")

STEPS_BETWEEN = 4
"""Steps in which friction is followed from each node to the next."""

GRID = np.linspace(0.0, 1.0, 33)
"""Values of x at which a stretch is searched for events."""


@dataclass(frozen=True)
class RadauEigenbasis:
    """A collocation rule, and what the core needs of it."""

    rule: Rule
    basis: Basis


@cache
def radau_eigenbasis(time_map: Map, root: int) -> RadauEigenbasis:
    """Return the Radau rule under a time map, with the eigenbasis of its integration matrix."""
    rule = collocation_rule(NODES_PER_STRETCH, time_map, root)
    values, vectors = np.linalg.eig(rule.integral)
    half = np.flatnonzero(values.imag >= 0.0)
    values = values[half].astype(np.complex128)
    paired = values.imag > 0.0
    # the sum of a conjugate pair is twice the real part of one
    vectors = np.where(paired, 2.0, 1.0) * vectors[:, half]
    parts = np.stack([vectors.real, -vectors.imag], axis=2)  # (N, H, 2)
    kept = np.stack([np.ones_like(paired), paired], axis=1)
    back = np.zeros((len(half), 2, NODES_PER_STRETCH))
    # inverse of the real matrix, so that a round trip is exact to rounding
    back[kept] = np.linalg.inv(parts[:, kept])
    inverse = back[:, 0] + 1j * back[:, 1]
    ends = np.append(0.0, rule.nodes)
    between = (
        ends[:-1, None] + np.diff(ends)[:, None] * np.arange(1, STEPS_BETWEEN + 1) / STEPS_BETWEEN
    ).ravel()
    filters = (vectors.T[:, :, None] * inverse[:, None, :]).reshape(len(half), -1)
    basis = Basis(
        time=rule.time,
        integral=rule.integral,
        integral_twice=rule.integral_twice,
        spectrum=rule.coefficients * rule.slope,
        at_start=rule.weights_at_start[:, 0],
        at_end=np.zeros(NODES_PER_STRETCH) if time_map == "release" else rule.end_slope,
        places=np.append(0.0, rule.nodes),
        barycentric=rule.barycentric,
        grid=rule.weights(GRID).T,
        forces_between=rule.interpolate(between, np.eye(NODES_PER_STRETCH)),
        displacements_between=rule.weights(between)[1:].T,  # which are zero at the start
        time_map=MAPS.index(time_map),
        root=root,
        eigenvalues=_parts(values),
        one=_parts(inverse.sum(axis=1)),
        clock=_parts(inverse @ rule.time),
        forward=back.reshape(-1, NODES_PER_STRETCH).T,
        backward=parts.reshape(NODES_PER_STRETCH, -1).T,
        filters=np.stack([filters.real, -filters.imag], axis=1).reshape(2 * len(half), -1),
    )
    members: Any = (np.ascontiguousarray(part) if np.ndim(part) else part for part in basis)
    return RadauEigenbasis(rule, Basis(*members))


@cache
def bases_of(root: int) -> Bases:
    """Return the rule under the three maps of time, as the core takes it."""
    return Bases(*(radau_eigenbasis(time_map, root).basis for time_map in _MAPS))


def _parts(values: Complex | Floats) -> Floats:
    """Return the real and the imaginary parts as rows."""
    return np.stack([values.real, values.imag])
