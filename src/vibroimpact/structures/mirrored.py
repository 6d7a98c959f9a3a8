"""The modes of a structure that is its own mirror image, from each of its symmetric parts by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.lanczos import TOLERANCE
from vibroimpact.structures.mirror import Mirror, mirrors_of, symmetric_parts
from vibroimpact.structures.modes import Eigenmodes, Elastic, Progress, most_modes
from vibroimpact.structures.supports.constraints import HeldStructure

_FEW = 600  # degrees of freedom up to which nothing is gained
_PART_OF_MOST = 0.5  # of the modes that a mesh has: up to so many, each part has enough of its own
_SPARE = 1.1  # times its share of the modes that each part is asked for at first
_ABOVE = 1.0 + 1e-9  # equal frequencies of two parts differ by rounding
_NONE = 1e-8  # of a rigid motion: less is rounding


def elastic_of(held: HeldStructure) -> Elastic | MirroredElastic:
    """Return what a held structure does at low frequencies, taken apart where it has mirror planes."""
    mirrors = mirrors_of(held) if len(held.free) > _FEW else []
    return MirroredElastic(held, mirrors) if mirrors else Elastic(held.stiffness, held.mass, held.rigid, held.order)


class MirroredElastic:
    """What a structure with mirror planes does at low frequencies: as `Elastic`, of parts that know nothing of each other.

    With three planes each part has an eighth of the degrees of freedom, and its factors a sixteenth of the entries; they are made
    for one part at a time, and not kept. Modes that are equal for symmetry lie in different parts.

    Parameters
    ----------
    held : HeldStructure
        The structure.
    mirrors : list of Mirror
        Its mirror planes, at least one.
    """

    def __init__(self, held: HeldStructure, mirrors: list[Mirror]) -> None:
        self.stiffness, self.mass, self._held = held.stiffness, held.mass, held
        self.bases = symmetric_parts(held, mirrors)
        """Of the parts (free, part), each in an elimination order."""
        motions = held.rigid
        if motions.shape[1]:
            lower = np.linalg.cholesky(motions.T @ (held.mass @ motions))
            motions = np.asarray(np.linalg.solve(lower, motions.T).T, dtype=np.float64)
        self.rigid = motions
        """The rigid motions, of unit modal mass."""

    def _part(self, basis: csr_array) -> Elastic:
        turned = basis.T.tocsr()
        return Elastic(csr_array(turned @ self.stiffness @ basis), csr_array(turned @ self.mass @ basis), self._rigid_in(basis))

    def _rigid_in(self, basis: csr_array) -> Floats:
        """Return the rigid motions of a part."""
        moved = basis.T @ self.rigid
        directions, sizes, _ = np.linalg.svd(moved, full_matrices=False)
        whole = float(np.linalg.norm(self.rigid, axis=0).max(initial=0.0))
        return np.asarray(directions[:, sizes > _NONE * whole])

    def static(self, load: Floats) -> Floats:
        """Return the static response to loads, shape (n,) or (n, loads), as `Elastic.static` does."""
        return np.asarray(sum(basis @ self._part(basis).static(basis.T @ load) for basis in self.bases))

    def count_below(self, angular_frequency: float) -> int:
        """Return how many modes lie below an angular frequency [rad/s], rigid motions left out, without computing them."""
        return sum(self._part(basis).count_below(angular_frequency) for basis in self.bases)

    def modes(self, number: int, progress: Progress | None = None, tolerance: float = TOLERANCE) -> Eigenmodes:
        """Return the lowest modes, rigid motions left out; takes and raises what `Elastic.modes` does."""
        size, most = self.stiffness.shape[0], most_modes(self.mass, self.rigid.shape[1])
        if not 1 <= number <= _PART_OF_MOST * most:  # of so few a mesh nothing need be saved
            return Elastic(self.stiffness, self.mass, self._held.rigid, self._held.order).modes(number, progress, tolerance)
        share = math.ceil(_SPARE * number / len(self.bases)) + 2
        found = [self._lowest(basis, share, told, tolerance) for basis, told in self._told(progress)]
        values = np.sort(np.concatenate([part.angular_frequencies for part in found]))
        last = _ABOVE * float(values[min(number, len(values)) - 1])
        for place, (basis, part) in enumerate(zip(self.bases, found, strict=True)):
            if part.angular_frequencies[-1] <= last:  # it may have more of them
                found[place] = self._lowest(basis, max(self._part(basis).count_below(last), share), lambda done: None, tolerance)
        values = np.concatenate([part.angular_frequencies for part in found])
        order = np.argsort(values, kind="stable")[:number]
        shapes = np.empty((size, len(order)))
        begin = 0
        for basis, part in zip(self.bases, found, strict=True):
            here = np.flatnonzero((order >= begin) & (order < begin + len(part.angular_frequencies)))
            shapes[:, here] = basis @ part.shapes[:, order[here] - begin]
            begin += len(part.angular_frequencies)
        return Eigenmodes(values[order], shapes)

    def _lowest(self, basis: csr_array, number: int, progress: Progress, tolerance: float) -> Eigenmodes:
        elastic = self._part(basis)
        return elastic.modes(min(number, most_modes(elastic.mass, elastic.rigid.shape[1])), progress, tolerance)

    def _told(self, progress: Progress | None) -> Iterator[tuple[csr_array, Progress]]:
        """Yield each part, and what is told how much of it is done."""
        for number, basis in enumerate(self.bases):

            def told(part: float, number: int = number) -> None:
                if progress is not None:
                    progress((number + part) / len(self.bases))

            yield basis, told
