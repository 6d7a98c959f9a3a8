"""What a support is, and how a structure is held by several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.rectangle import Disc
from vibroimpact.structures.structure import Structure
from vibroimpact.structures.supports.constraints import Constraints, HeldStructure
from vibroimpact.structures.surface import lower_nodes


@dataclass(frozen=True)
class Support:
    """Base of what holds a structure: frozen, as its numbers are part of the key under which modes are kept."""

    @property
    def words(self) -> str:
        """What it is, for people."""
        raise NotImplementedError

    @property
    def discs(self) -> Sequence[Disc]:
        """The discs whose rims should be edges of elements in a mesh made for it: none unless it says so."""
        return ()

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """The x and y [m] that should be edges of elements in a mesh made for it: none unless it says so."""
        return (), ()

    @property
    def rims(self) -> tuple[Sequence[float], Sequence[float]]:
        """Those of the lines that are rims of a held part of the lower face, where strain grows without bound: none unless it says so."""
        return (), ()

    def hold(self, constraints: Constraints) -> None:
        """Hold the structure of the constraints.

        Raises
        ------
        InputError
            If there is nothing to hold, or another support holds it.
        """
        raise NotImplementedError


def held_by(structure: Structure, supports: Sequence[Support] = ()) -> HeldStructure:
    """Return a structure as supports hold it; without any it is free.

    Raises
    ------
    InputError
        If a support finds nothing to hold, or two hold the same point.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> from vibroimpact.structures.structure import solid_structure
    >>> held_by(solid_structure(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)), find_material("rock-paper"))).rigid.shape
    (60, 6)
    """
    constraints = Constraints(structure)
    for support in supports:
        support.hold(constraints)
    return constraints.held()


def nodes_within(structure: Structure, x: float, y: float, reach: Floats | float, what: str) -> Integers:
    """Return the nodes of the lower side within a radius, or within half the sides of a rectangle, around a point.

    Raises
    ------
    InputError
        If there are fewer than three, which can hold nothing.
    """
    lower = lower_nodes(structure.mesh)
    apart = structure.mesh.nodes[lower, :2] - [x, y]
    limit = np.asarray(reach) * (1.0 + 1e-9) + 1e-9 * np.ptp(structure.mesh.nodes[:, 0])
    inside = np.hypot(*apart.T) <= limit if limit.ndim == 0 else (np.abs(apart) <= limit).all(axis=1)
    if inside.sum() < 3:
        count = "no nodes" if not inside.any() else f"only {inside.sum()} of the nodes"
        raise InputError(
            f"{what} at ({x:g}, {y:g}) m holds {count} on the lower side of the mesh; move it, make it larger, or refine the mesh"
        )
    return lower[inside]
