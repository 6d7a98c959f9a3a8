r"""Forces of supports on a plate, as linear functions of its motion.

In a mode, the bare structure of stiffness K and mass M is in balance with the forces of its
supports,
:math:`r = (K - \omega^2 M)\,\varphi`, and under a static force elsewhere :math:`r = K u`: zero on
all degrees of freedom but those that
supports hold, tie or spring. The sum over the nodes of a support is the force of that support.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.recipe import Recipe, plate_key
from vibroimpact.structures.static_compliance import responses_to_spread_forces
from vibroimpact.structures.store import key_of, load_entry, save_entry
from vibroimpact.structures.structure import Structure
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support
from vibroimpact.structures.surface import Side, Spot, place_of
from vibroimpact.structures.transfer_strain import spread_at_face

_KIND = "compliance"


@dataclass(frozen=True)
class SupportForces:
    """Forces of supports at S places, along x, y and z.

    Parameters
    ----------
    stiffness, mass : array, shape (S, 3, dofs)
        Forces per displacement [N/m] and acceleration [kg] of the degrees of freedom of the bare
        structure.
    static : array, shape (S, 3)
        Forces under a unit upward force at the contact [-].
    """

    stiffness: Floats
    mass: Floats
    static: Floats

    def of_modes(self, model: ModalModel) -> Floats:
        """Return the forces in each mode, (S, modes, 3) [N m^-1 kg^-1/2]."""
        square = model.angular_frequencies[:, None] ** 2
        return np.array(
            [
                model.shapes @ k.T - square * (model.shapes @ m.T)
                for k, m in zip(self.stiffness, self.mass, strict=True)
            ]
        )


def support_forces(
    recipe: Recipe,
    place: tuple[float, float],
    side: Side,
    spots: Sequence[Spot],
    tell: Callable[[str], None] | None = None,
) -> SupportForces:
    """Return the forces of the supports at places of a held plate, from the store or computed.

    Parameters
    ----------
    recipe : Recipe
        The plate and its supports; the reduction has no effect.
    place : tuple of two floats
        x and y of the contact [m].
    side : str
        Face of the contact, "upper" or "lower".
    spots : sequence of (x, y) or str
        Places of supports, or names of sets of nodes.
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError
        If no support or more than one is at a place, or the mesh or a support is invalid.
    ComputationError
        If the stiffness is singular.
    """
    key, say = support_force_key(recipe, place, side, spots), tell or (lambda text: None)
    found, trouble = load_entry(
        key, _KIND, lambda parts: SupportForces(parts["stiffness"], parts["mass"], parts["static"])
    )
    if trouble:
        say(trouble)
    if found is None:
        found = computed_support_forces(recipe, place, side, spots)
        trouble = save_entry(key, _KIND, vars(found))
        if trouble:
            say(trouble)
    return found


def support_force_key(
    recipe: Recipe, place: tuple[float, float], side: Side, spots: Sequence[Spot]
) -> str:
    """Return the key of the forces of supports in the store."""
    return key_of(["support forces", plate_key(recipe), place, side, list(spots)])


def computed_support_forces(
    recipe: Recipe, place: tuple[float, float], side: Side, spots: Sequence[Spot]
) -> SupportForces:
    """Return the forces of supports, computed anew; parameters and errors are those of
    `support_forces`.
    """
    structure, _, displacements = responses_to_spread_forces(
        recipe, [place], side, lambda _, thickness: spread_at_face(recipe, thickness)
    )
    watched = [support_at(structure, recipe.supports, spot) for spot in spots]
    _refuse_joints(structure, [recipe.supports[number] for number in watched])
    shares = _shares(structure, recipe.supports)
    rows = [shares[number] for number in watched]
    stiffness, mass = (
        np.array([(row @ matrix).toarray() for row in rows])
        for matrix in (structure.stiffness, structure.mass)
    )
    return SupportForces(stiffness, mass, stiffness @ displacements[:, 0])


def support_at(structure: Structure, supports: Sequence[Support], spot: Spot) -> int:
    """Return the number of the support whose held nodes lie nearest to a place, within the size of
    an element.

    Raises
    ------
    InputError
        If there is none, or several are as near.
    """
    mesh, place = structure.mesh, np.array(place_of(structure.mesh, spot, "lower"))
    apart = [
        float(
            np.linalg.norm(mesh.nodes[_nodes(structure, one), :2] - place, axis=1).min(
                initial=math.inf
            )
        )
        for one in supports
    ]
    least, reach = min(apart, default=math.inf), _largest_element(mesh)
    words = "; ".join(one.description for one in supports) or "none"
    if least > reach:
        raise InputError(
            f"there is no support at ({place[0]:g}, {place[1]:g}) m; there are: {words}"
        )
    near = [number for number, one in enumerate(apart) if one <= least + 1e-9 * reach]
    if len(near) > 1:
        both = " and ".join(supports[number].description for number in near)
        raise InputError(
            f"({place[0]:g}, {place[1]:g}) m is as near to a node that is held by one as "
            f"to that of another of {both}; "
            "give a place that is nearer to one of them by an element or more"
        )
    return near[0]


def _nodes(structure: Structure, support: Support) -> Integers:
    """Return the nodes of a structure whose motion a support holds, ties or springs."""
    constraints = Constraints(structure)
    support.hold(constraints)
    dofs = constraints.touched
    return np.unique(dofs[dofs < structure.stiffness.shape[0]] // structure.mesh.dofs_per_node)


def _refuse_joints(structure: Structure, supports: Sequence[Support]) -> None:
    """Raise if a support whose force is asked for holds a node that is joined to others.

    Raises
    ------
    InputError
        If one does: what holds the node is then the support and the joint together.
    """
    joints = structure.mesh.joints
    if joints is None:
        return
    for one in supports:
        if np.isin(_nodes(structure, one), joints.nodes).any():
            raise InputError(
                f"the force of {one.description} is not known: it holds nodes that the "
                "mesh file joins to others; "
                "leave out its force sensor, or move the support"
            )


def _shares(structure: Structure, supports: Sequence[Support]) -> list[csr_array]:
    """Return sums of forces along x, y and z over the nodes of each support, (3, dofs); a
    node of several has an equal share in each.
    """
    nodes, per_node = (
        [_nodes(structure, support) for support in supports],
        structure.mesh.dofs_per_node,
    )
    owners = np.bincount(np.concatenate(nodes), minlength=len(structure.mesh.nodes))
    shape = (3, structure.stiffness.shape[0])
    return [
        csr_array(
            (
                np.tile(1.0 / owners[mine], 3),
                (
                    np.repeat([0, 1, 2], len(mine)),
                    (per_node * mine + np.array([[0], [1], [2]])).ravel(),
                ),
            ),
            shape,
        )
        for mine in nodes
    ]


def _largest_element(mesh: Mesh) -> float:
    """Return the largest extent of an element along x or y [m]."""
    return float(
        max(np.ptp(mesh.nodes[block.connectivity, :2], axis=1).max() for block in mesh.blocks)
    )
