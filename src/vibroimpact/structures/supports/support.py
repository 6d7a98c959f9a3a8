"""Base class of supports, and a structure with several of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import lower_nodes
from vibroimpact.structures.supports.constraints import Constraints, HeldStructure

_RIGID_MOTIONS = 6  # of a free body


@dataclass(frozen=True)
class Support:
    """Base class of supports.

    They are frozen dataclasses, as their fields are part of the key of stored modes.
    """

    @property
    def description(self) -> str:
        """Short description for users."""
        raise NotImplementedError

    @property
    def discs(self) -> Sequence[Disc]:
        """Discs whose rims are to be edges of elements of a generated mesh; none by default."""
        return ()

    @property
    def lines(self) -> tuple[Sequence[float], Sequence[float]]:
        """The x and y [m] of lines that are to be edges of elements of a generated mesh.

        There are none by default.
        """
        return (), ()

    @property
    def rims(self) -> tuple[Sequence[float], Sequence[float]]:
        """Those lines that are rims of a held part of the lower face, where the strain is singular.

        There are none by default.
        """
        return (), ()

    def hold(self, constraints: Constraints) -> None:
        """Add this support to the constraints of a structure.

        Raises
        ------
        InputError
            If no nodes are held, or another support holds them.
        """
        raise NotImplementedError


def held_by(structure: Structure, supports: Sequence[Support] = ()) -> HeldStructure:
    """Return a structure with its supports; free without any.

    Raises
    ------
    InputError
        If a support holds no nodes, or two supports hold the same point.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> from vibroimpact.structures.finite_elements.structure import solid_structure
    >>> held_by(
    ...     solid_structure(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)), find_material("rock-paper"))
    ... ).rigid.shape
    (60, 6)
    """
    constraints = Constraints(structure)
    for support in supports:
        support.hold(constraints)
    if structure.mesh.joints is not None:
        constraints.join(structure.mesh.joints)
    return constraints.held()


def joint_remarks(held: HeldStructure, supports: Sequence[Support]) -> list[str]:
    """Return a remark if the joints of a mesh file hold the body as supports do."""
    structure = held.structure
    if structure.mesh.joints is None:
        return []
    free = held_by(structure) if supports else held
    missing = _RIGID_MOTIONS - len(free.rigid_coefficients)
    if not missing:
        return []
    return [
        f"the joints of the mesh file resist {missing} of the {_RIGID_MOTIONS} rigid motions of "
        "the body, as supports do: their equations are not those of bodies that move freely, or "
        "join nodes that are apart"
    ]


def nodes_within(
    structure: Structure, x: float, y: float, reach: Floats | float, what: str
) -> Integers:
    """Return the nodes of the lower side around a point.

    They lie within a radius, or within half the sides of a rectangle.

    Raises
    ------
    InputError
        If there are fewer than three, which cannot hold a plate.
    """
    lower = lower_nodes(structure.mesh)
    offset = structure.mesh.nodes[lower, :2] - [x, y]
    tolerance = 1e-9 * np.ptp(structure.mesh.nodes[:, 0])
    limit = np.asarray(reach) * (1.0 + 1e-9) + tolerance
    if limit.ndim == 0:
        is_inside = np.hypot(*offset.T) <= limit
    else:
        is_inside = (np.abs(offset) <= limit).all(axis=1)
    if is_inside.sum() < 3:
        count = "no nodes"
        if is_inside.any():
            count = f"only {is_inside.sum()} of the nodes"
        raise InputError(
            f"{what} at ({x:g}, {y:g}) m holds {count} on the lower side of the mesh, and "
            "needs three or more; "
            "move it, make it larger, or refine the mesh"
        )
    return np.asarray(lower[is_inside])
