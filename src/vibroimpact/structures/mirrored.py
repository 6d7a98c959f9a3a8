"""Modes of a structure with mirror planes, from its motions of each parity separately."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.lanczos import TOLERANCE
from vibroimpact.structures.mirror import Mirror, mirror_planes, symmetry_bases
from vibroimpact.structures.modes import Eigenmodes, ElasticSystem, Progress, max_modes
from vibroimpact.structures.supports.constraints import HeldStructure

_FEW = 600  # degrees of freedom up to which symmetry saves no time
_PART_OF_MOST = 0.5  # of the modes of a mesh: up to this number, each part has enough modes
_SPARE = 1.1  # first number of modes of each part, over its share
_ABOVE = 1.0 + 1e-9  # equal frequencies of two parts differ by rounding
_NONE = 1e-8  # of the norm of a rigid motion: below, its component in a part is rounding


def elastic_system(held: HeldStructure) -> ElasticSystem | MirroredSystem:
    """Return the elastic system of a held structure, divided by parity if it has mirror planes."""
    mirrors = mirror_planes(held) if len(held.free) > _FEW else []
    return (
        MirroredSystem(held, mirrors)
        if mirrors
        else ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    )


class MirroredSystem:
    """Statics and modes of a structure with mirror planes, as of `ElasticSystem`, from uncoupled
    parts of given parities.

    With three planes each part has an eighth of the degrees of freedom, and its factors a sixteenth
    of the entries; only the factors of one part at a time are in memory. Multiple modes due to the
    symmetry lie in different parts.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    mirrors : list of Mirror
        Its mirror planes, at least one.
    """

    def __init__(self, held: HeldStructure, mirrors: list[Mirror]) -> None:
        self.stiffness, self.mass, self._held = held.stiffness, held.mass, held
        self.bases = symmetry_bases(held, mirrors)
        """Bases of the parts, (free, part), each in an elimination order."""
        motions = held.rigid
        if motions.shape[1]:
            lower = np.linalg.cholesky(motions.T @ (held.mass @ motions))
            motions = np.asarray(np.linalg.solve(lower, motions.T).T, dtype=np.float64)
        self.rigid = motions
        """Rigid motions of unit modal mass."""

    def _part(self, basis: csr_array) -> ElasticSystem:
        """Return the system of one part, factorised."""
        turned = basis.T.tocsr()
        return ElasticSystem(
            csr_array(turned @ self.stiffness @ basis),
            csr_array(turned @ self.mass @ basis),
            self._rigid_in(basis),
        )

    def _rigid_in(self, basis: csr_array) -> Floats:
        """Return the rigid motions of a part, (part, r)."""
        moved = basis.T @ self.rigid
        directions, sizes, _ = np.linalg.svd(moved, full_matrices=False)
        whole = float(np.linalg.norm(self.rigid, axis=0).max(initial=0.0))
        return np.asarray(directions[:, sizes > _NONE * whole])

    def static(self, load: Floats) -> Floats:
        """Return the static response to loads, shape (n,) or (n, loads), as
        `ElasticSystem.static` does.
        """
        return np.asarray(
            sum(basis @ self._part(basis).static(basis.T @ load) for basis in self.bases)
        )

    def count_below(self, angular_frequency: float) -> int:
        """Return the number of elastic modes below an angular frequency [rad/s], from the
        signs of the pivots.
        """
        return sum(self._part(basis).count_below(angular_frequency) for basis in self.bases)

    def modes(
        self, number: int, progress: Progress | None = None, tolerance: float = TOLERANCE
    ) -> Eigenmodes:
        """Return the lowest elastic modes; parameters and errors are those of
        `ElasticSystem.modes`.
        """
        size, most = self.stiffness.shape[0], max_modes(self.mass, self.rigid.shape[1])
        # few modes in all, so that a part might not have its share
        if not 1 <= number <= _PART_OF_MOST * most:
            return ElasticSystem(
                self.stiffness, self.mass, self._held.rigid, self._held.order
            ).modes(number, progress, tolerance)
        share = math.ceil(_SPARE * number / len(self.bases)) + 2
        found = [
            self._lowest(basis, share, report, tolerance)
            for basis, report in self._with_progress(progress)
        ]
        values = np.sort(np.concatenate([part.angular_frequencies for part in found]))
        last = _ABOVE * float(values[min(number, len(values)) - 1])
        for place, (basis, part) in enumerate(zip(self.bases, found, strict=True)):
            if part.angular_frequencies[-1] <= last:  # it may have further modes up to the last one
                found[place] = self._lowest(
                    basis,
                    max(self._part(basis).count_below(last), share),
                    lambda done: None,
                    tolerance,
                )
        values = np.concatenate([part.angular_frequencies for part in found])
        order = np.argsort(values, kind="stable")[:number]
        shapes = np.empty((size, len(order)))
        begin = 0
        for basis, part in zip(self.bases, found, strict=True):
            here = np.flatnonzero(
                (order >= begin) & (order < begin + len(part.angular_frequencies))
            )
            shapes[:, here] = basis @ part.shapes[:, order[here] - begin]
            begin += len(part.angular_frequencies)
        return Eigenmodes(values[order], shapes)

    def _lowest(
        self, basis: csr_array, number: int, progress: Progress, tolerance: float
    ) -> Eigenmodes:
        """Return the lowest modes of a part, or all that it has."""
        elastic = self._part(basis)
        return elastic.modes(
            min(number, max_modes(elastic.mass, elastic.rigid.shape[1])), progress, tolerance
        )

    def _with_progress(self, progress: Progress | None) -> Iterator[tuple[csr_array, Progress]]:
        """Yield the basis of each part, and a callback of the progress in that part."""
        for number, basis in enumerate(self.bases):

            def report(part: float, number: int = number) -> None:
                if progress is not None:
                    progress((number + part) / len(self.bases))

            yield basis, report
