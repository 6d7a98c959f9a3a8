"""Modes of a structure with mirror planes, from its motions of each parity separately."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.lanczos import TOLERANCE
from vibroimpact.structures.mirror import Mirror, mirror_planes, symmetry_bases
from vibroimpact.structures.modes import (
    Eigenmodes,
    ElasticSystem,
    Progress,
    max_modes,
    of_unit_mass,
)
from vibroimpact.structures.supports.constraints import HeldStructure

_FEW = 600  # degrees of freedom up to which symmetry saves no time
_PART_OF_MOST = 0.5  # of the modes of a mesh: up to this number, each part has enough modes
_SPARE = 1.1  # first number of modes of each part, over its share
_ABOVE = 1.0 + 1e-9  # equal frequencies of two parts differ by rounding
_NONE = 1e-8  # of the norm of a rigid motion: below, its component in a part is rounding


def elastic_system(held: HeldStructure) -> ElasticSystem | MirroredSystem:
    """Return the elastic system of a held structure, divided by parity if it has mirror planes."""
    mirrors = []
    if len(held.free) > _FEW:
        mirrors = mirror_planes(held)
    if mirrors:
        return MirroredSystem(held, mirrors)
    return ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)


class MirroredSystem:
    """Statics and modes of a structure with mirror planes, from uncoupled parts of given parities.

    They are as of `ElasticSystem`. With three planes each part has an eighth of the degrees of
    freedom, and its factors a sixteenth of the entries; only the factors of one part at a time are
    in memory. Multiple modes due to the symmetry lie in different parts.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    mirrors : list of Mirror
        Its mirror planes, at least one.
    """

    def __init__(self, held: HeldStructure, mirrors: list[Mirror]) -> None:
        self.stiffness = held.stiffness
        self.mass = held.mass
        self._held = held
        self.bases = symmetry_bases(held, mirrors)
        """Bases of the parts, (free, part), each in an elimination order."""
        self.rigid = of_unit_mass(held.rigid, held.mass)
        """Rigid motions of unit modal mass."""

    def _part(self, basis: csr_array) -> ElasticSystem:
        """Return the system of one part, factorised."""
        transposed = basis.T.tocsr()
        return ElasticSystem(
            csr_array(transposed @ self.stiffness @ basis),
            csr_array(transposed @ self.mass @ basis),
            self._rigid_in(basis),
        )

    def _rigid_in(self, basis: csr_array) -> Floats:
        """Return the rigid motions of a part, (part, r)."""
        components = basis.T @ self.rigid
        directions, norms, _ = np.linalg.svd(components, full_matrices=False)
        whole_norm = float(np.linalg.norm(self.rigid, axis=0).max(initial=0.0))
        return np.asarray(directions[:, norms > _NONE * whole_norm])

    def static(self, load: Floats) -> Floats:
        """Return the static response to loads, (n,) or (n, loads), as `ElasticSystem` does."""
        responses = (basis @ self._part(basis).static(basis.T @ load) for basis in self.bases)
        return np.asarray(sum(responses))

    def count_below(self, angular_frequency: float) -> int:
        """Return the number of elastic modes below an angular frequency [rad/s].

        It follows from the signs of the pivots.
        """
        return sum(self._part(basis).count_below(angular_frequency) for basis in self.bases)

    def modes(
        self, number: int, progress: Progress | None = None, tolerance: float = TOLERANCE
    ) -> Eigenmodes:
        """Return the lowest elastic modes.

        Parameters and errors are those of `ElasticSystem.modes`.
        """
        most = max_modes(self.mass, self.rigid.shape[1])
        # few modes in all, so that a part might not have its share
        if not 1 <= number <= _PART_OF_MOST * most:
            held = self._held
            whole = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
            return whole.modes(number, progress, tolerance)
        share = math.ceil(_SPARE * number / len(self.bases)) + 2
        parts = [
            self._lowest(basis, share, report, tolerance)
            for basis, report in self._with_progress(progress)
        ]
        frequencies = np.sort(np.concatenate([part.angular_frequencies for part in parts]))
        last = _ABOVE * float(frequencies[min(number, len(frequencies)) - 1])
        for index, basis in enumerate(self.bases):
            # a part whose modes end below the last one may have further modes up to it
            if parts[index].angular_frequencies[-1] <= last:
                needed = max(self._part(basis).count_below(last), share)
                parts[index] = self._lowest(basis, needed, lambda done: None, tolerance)
        return self._joined(parts, number)

    def _joined(self, parts: list[Eigenmodes], number: int) -> Eigenmodes:
        """Return the lowest modes of all parts, on the degrees of freedom of the whole."""
        frequencies = np.concatenate([part.angular_frequencies for part in parts])
        lowest = np.argsort(frequencies, kind="stable")[:number]
        dofs = self.stiffness.shape[0]
        shapes = np.empty((dofs, len(lowest)))
        first = 0  # number of the first mode of a part among those of all parts
        for basis, part in zip(self.bases, parts, strict=True):
            end = first + len(part.angular_frequencies)
            is_of_part = (lowest >= first) & (lowest < end)
            number_in_part = lowest[is_of_part] - first
            shapes[:, is_of_part] = basis @ part.shapes[:, number_in_part]
            first = end
        return Eigenmodes(frequencies[lowest], shapes)

    def _lowest(
        self, basis: csr_array, number: int, progress: Progress, tolerance: float
    ) -> Eigenmodes:
        """Return the lowest modes of a part, or all that it has."""
        part = self._part(basis)
        most = max_modes(part.mass, part.rigid.shape[1])
        return part.modes(min(number, most), progress, tolerance)

    def _with_progress(self, progress: Progress | None) -> Iterator[tuple[csr_array, Progress]]:
        """Yield the basis of each part, and a callback of the progress in that part."""
        for number, basis in enumerate(self.bases):

            def report(fraction: float, number: int = number) -> None:
                if progress is not None:
                    progress((number + fraction) / len(self.bases))

            yield basis, report
