"""The Radau rule of a stretch of contact, and the eigenbasis of its integration matrix."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.core.records import MAPS, Bases, Basis
from vibroimpact.dynamics.motion.collocation import Map, Rule, collocation_rule

NODES_PER_STRETCH = 12
"""Nodes of a stretch: with more the eigenvectors of the integration matrix are too ill-conditioned,
with fewer the stretches are too short.
"""

_TIME_MAPS: tuple[Map, ...] = ("touch", "inside", "release")

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
    eigenvalues, forward, backward, filters = _eigenbasis(rule.integral)
    inverse = forward[:, 0] + 1j * forward[:, 1]
    at_end = np.zeros(NODES_PER_STRETCH)
    # at the release the slope by the time is infinite
    if time_map != "release":
        at_end = rule.end_slope
    nodes = np.append(0.0, rule.nodes)
    between_nodes = _between(nodes)
    basis = Basis(
        time=rule.time,
        integral=rule.integral,
        integral_twice=rule.integral_twice,
        spectrum=rule.coefficients * rule.slope,
        at_start=rule.weights_at_start[:, 0],
        at_end=at_end,
        places=nodes,
        barycentric=rule.barycentric,
        grid=rule.weights(GRID).T,
        forces_between=rule.interpolate(between_nodes, np.eye(NODES_PER_STRETCH)),
        displacements_between=rule.weights(between_nodes)[1:].T,  # which are zero at the start
        time_map=MAPS.index(time_map),
        root=root,
        eigenvalues=_real_and_imaginary(eigenvalues),
        one=_real_and_imaginary(inverse.sum(axis=1)),
        clock=_real_and_imaginary(inverse @ rule.time),
        forward=forward.reshape(-1, NODES_PER_STRETCH).T,
        backward=backward.reshape(NODES_PER_STRETCH, -1).T,
        filters=filters,
    )
    return RadauEigenbasis(rule, _contiguous(basis))


def _contiguous(basis: Basis) -> Basis:
    """Return a basis whose arrays are contiguous, as compiled code takes them."""
    members: dict[str, Any] = {}
    for name, member in basis._asdict().items():
        if np.ndim(member):
            members[name] = np.ascontiguousarray(member)
    return basis._replace(**members)


def _eigenbasis(integral: Floats) -> tuple[Complex, Floats, Floats, Floats]:
    """Return the eigenbasis of an integration matrix (N, N), with one of each conjugate pair.

    Returns
    -------
    eigenvalues : array of complex, shape (H,)
        Those with an imaginary part >= 0.
    forward : array, shape (H, 2, N)
        From values at the nodes to real and imaginary parts of the coordinates.
    backward : array, shape (N, H, 2)
        From these parts to values at the nodes.
    filters : array, shape (2 H, N^2)
        Real parts and minus imaginary parts of the projections on the eigenvectors.
    """
    nodes = len(integral)
    all_eigenvalues, all_eigenvectors = np.linalg.eig(integral)
    half = np.flatnonzero(all_eigenvalues.imag >= 0.0)
    number = len(half)
    eigenvalues = all_eigenvalues[half].astype(np.complex128)
    paired = eigenvalues.imag > 0.0

    # v = sum of c_k u_k; the sum of a conjugate pair is twice the real part of one,
    # 2 (Re u Re c - Im u Im c)
    multiplicity = np.where(paired, 2.0, 1.0)
    eigenvectors = multiplicity * all_eigenvectors[:, half]
    backward = np.stack([eigenvectors.real, -eigenvectors.imag], axis=2)

    # inverse of the real matrix, so that a round trip is exact to rounding; the coordinate of a
    # real eigenvalue has no imaginary part
    has_part = np.stack([np.ones_like(paired), paired], axis=1)
    forward = np.zeros((number, 2, nodes))
    forward[has_part] = np.linalg.inv(backward[:, has_part])

    # an operator f(Q) is the sum of f(lambda_k) times the projections u_k w_k^T
    inverse = forward[:, 0] + 1j * forward[:, 1]
    projections = eigenvectors.T[:, :, None] * inverse[:, None, :]
    filters = np.stack([projections.real, -projections.imag], axis=1)
    return eigenvalues, forward, backward, filters.reshape(2 * number, nodes * nodes)


def _between(nodes: Floats) -> Floats:
    """Return the points at which friction is followed, `STEPS_BETWEEN` from each node on."""
    steps = np.diff(nodes)[:, None] * np.arange(1, STEPS_BETWEEN + 1) / STEPS_BETWEEN
    return np.asarray(nodes[:-1, None] + steps).ravel()


@cache
def bases_of(root: int) -> Bases:
    """Return the rule under the three maps of time, as the core takes it."""
    return Bases(*(radau_eigenbasis(time_map, root).basis for time_map in _TIME_MAPS))


def _real_and_imaginary(values: Complex | Floats) -> Floats:
    """Return the real and the imaginary parts as rows."""
    return np.stack([values.real, values.imag])
