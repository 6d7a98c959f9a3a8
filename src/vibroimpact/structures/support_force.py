r"""Forces of supports on a plate, as linear functions of its motion.

In a mode, the bare structure of stiffness K and mass M is in balance with the forces of its
supports, :math:`r = (K - \omega^2 M)\,\varphi`, and under a static force elsewhere :math:`r = K u`:
zero on all degrees of freedom but those that supports hold, tie or spring. The sum over the nodes
of a support is the force of that support.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.recipe import Recipe, plate_key
from vibroimpact.structures.store import COMPLIANCE, key_of, load_or_compute
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support
from vibroimpact.structures.transfer_strain import response_at_face


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
        squared_frequencies = model.angular_frequencies[:, None] ** 2
        # r = (K - omega^2 M) phi, summed over the nodes of each support
        forces = [
            model.shapes @ stiffness.T - squared_frequencies * (model.shapes @ mass.T)
            for stiffness, mass in zip(self.stiffness, self.mass, strict=True)
        ]
        return np.array(forces)


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
    return load_or_compute(
        support_force_key(recipe, place, side, spots),
        COMPLIANCE,
        lambda arrays: SupportForces(arrays["stiffness"], arrays["mass"], arrays["static"]),
        lambda: computed_support_forces(recipe, place, side, spots),
        lambda forces: vars(forces),
        tell,
    )


def support_force_key(
    recipe: Recipe, place: tuple[float, float], side: Side, spots: Sequence[Spot]
) -> str:
    """Return the key of the forces of supports in the store."""
    return key_of(["support forces", plate_key(recipe), place, side, list(spots)])


def computed_support_forces(
    recipe: Recipe, place: tuple[float, float], side: Side, spots: Sequence[Spot]
) -> SupportForces:
    """Return the forces of supports, computed anew.

    Parameters and errors are those of `support_forces`.
    """
    structure, displacements = response_at_face(recipe, place, side)
    watched = [support_at(structure, recipe.supports, spot) for spot in spots]
    _refuse_joints(structure, [recipe.supports[number] for number in watched])
    sums = _force_sums(structure, recipe.supports)
    stiffness = np.array([(sums[number] @ structure.stiffness).toarray() for number in watched])
    mass = np.array([(sums[number] @ structure.mass).toarray() for number in watched])
    return SupportForces(stiffness, mass, stiffness @ displacements)


def support_at(structure: Structure, supports: Sequence[Support], spot: Spot) -> int:
    """Return the number of the support nearest to a place, within the size of an element.

    The distance is that of its held nodes.

    Raises
    ------
    InputError
        If there is none, or several are as near.
    """
    mesh = structure.mesh
    place = np.array(place_of(mesh, spot, "lower"))
    distances = []
    for support in supports:
        positions = mesh.nodes[_nodes(structure, support), :2]
        distance = np.linalg.norm(positions - place, axis=1).min(initial=math.inf)
        distances.append(float(distance))
    least = min(distances, default=math.inf)
    reach = _largest_element(mesh)
    if least > reach:
        descriptions = "; ".join(support.description for support in supports) or "none"
        raise InputError(
            f"there is no support at ({place[0]:g}, {place[1]:g}) m; there are: {descriptions}"
        )
    limit = least + 1e-9 * reach
    near = [number for number, distance in enumerate(distances) if distance <= limit]
    if len(near) > 1:
        descriptions = " and ".join(supports[number].description for number in near)
        raise InputError(
            f"({place[0]:g}, {place[1]:g}) m is as near to a node that is held by one as "
            f"to that of another of {descriptions}; "
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
    for support in supports:
        if np.isin(_nodes(structure, support), joints.nodes).any():
            raise InputError(
                f"the force of {support.description} is not known: it holds nodes that the "
                "mesh file joins to others; "
                "leave out its force sensor, or move the support"
            )


def _force_sums(structure: Structure, supports: Sequence[Support]) -> list[csr_array]:
    """Return sums of forces along x, y and z over the nodes of each support, (3, dofs).

    A node of several supports has an equal share in each.
    """
    per_node = structure.mesh.dofs_per_node
    nodes_of_supports = [_nodes(structure, support) for support in supports]
    number_of_supports = np.bincount(  # of each node
        np.concatenate(nodes_of_supports), minlength=len(structure.mesh.nodes)
    )
    axes = np.array([[0], [1], [2]])
    sums = []
    for nodes in nodes_of_supports:
        shares = np.tile(1.0 / number_of_supports[nodes], 3)
        rows = np.repeat([0, 1, 2], len(nodes))
        columns = (per_node * nodes + axes).ravel()
        shape = (3, structure.stiffness.shape[0])
        sums.append(csr_array((shares, (rows, columns)), shape))
    return sums


def _largest_element(mesh: Mesh) -> float:
    """Return the largest extent of an element along x or y [m]."""
    return float(
        max(np.ptp(mesh.nodes[block.connectivity, :2], axis=1).max() for block in mesh.blocks)
    )
