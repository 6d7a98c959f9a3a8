"""Constraints of supports on a structure, and the reduced system.

They are held and tied degrees of freedom, added stiffness and bodies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, kron

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.bed import area_products, elements_within, patch_bed
from vibroimpact.structures.finite_elements.joints import Joints
from vibroimpact.structures.finite_elements.structure import Structure, rotation_columns

# of the largest coefficient of a row: what is left of one that follows from others is rounding
_NONE = 1e-9
_STILL = 1e-12  # relative energy or displacement of a rigid motion that counts as rounding


@dataclass(frozen=True)
class HeldStructure:
    """Structure with its supports, reduced to the free degrees of freedom.

    Parameters
    ----------
    structure : Structure
        The structure without supports.
    stiffness, mass : sparse arrays, shape (free, free)
        Of the free degrees of freedom.
    expansion : sparse array, shape (dofs, free)
        Map from the free degrees of freedom to those of the structure.
    free : int array, shape (free,)
        Numbers of the free degrees of freedom: those of the structure come first, then those of
        supporting bodies.
    order : int array, shape (free,)
        Elimination order.
    rigid : array, shape (free, r)
        Rigid motions that the supports permit, r from 0 to 6.
    rigid_coefficients : array, shape (r, 6)
        Coefficients of these motions: translations along x, y and z, and rotations about the centre
        of mass.
    bed : sparse array, shape (free, free)
        Contribution of beds under plate elements to the stiffness (see `bed_stiffness`).
    neglected : tuple of int array and array, shape (n,)
        Held degrees of freedom of the structure, and the compliances in series with their supports
        that the model neglects.
    """

    structure: Structure
    stiffness: csr_array
    mass: csr_array
    expansion: csr_array
    free: Integers
    order: Integers
    rigid: Floats
    rigid_coefficients: Floats
    bed: csr_array
    neglected: tuple[Integers, Floats]


Body = tuple[Integers, Floats]
"""Six degrees of freedom of a rigid body, and the point [m], (3,), whose displacements are the
first three.
"""


class Constraints:
    """Constraints, stiffness and bodies that supports add to a structure.

    Parameters
    ----------
    structure : Structure
        The structure.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        # each tied degree of freedom as a linear combination of others; empty if held
        self._ties: dict[int, dict[int, float]] = {}
        self._carried: set[int] = set()  # degrees of freedom attached to bodies
        self._added: list[tuple[Integers, Floats]] = []  # degrees of freedom and stiffness matrices
        # stiffness matrices, on the degrees of freedom present at the time
        self._beds: list[csr_array] = []
        self._bedded = np.zeros(0, dtype=np.int64)  # elements with a bed
        self._neglected: list[tuple[Integers, Floats]] = []
        # stiffness, mass and rigid motions of each
        self._bodies: list[tuple[Floats, Floats, Floats]] = []
        self._size = structure.stiffness.shape[0]

    def hold(self, dofs: Integers) -> None:
        """Hold degrees of freedom at zero.

        Raises
        ------
        InputError
            If one is attached to a body.
        """
        for dof in dofs.ravel().tolist():
            if dof in self._carried:
                self._refuse(dof // self.structure.mesh.dofs_per_node)
            self._ties[dof] = {}

    def hold_motion(self, motion: csr_array) -> None:
        """Hold linear functions of degrees of freedom, the rows of `motion`, at zero."""
        for row in range(motion.shape[0]):
            function = motion[[row]].tocoo()
            weights = self._in_free(function.col.tolist(), function.data.tolist())
            size = float(np.abs(function.data).max(initial=0.0))
            if not max(map(abs, weights.values()), default=0.0) > _NONE * size:
                continue  # the function is held already
            # that of the largest weight follows the others, so that no share exceeds one
            largest = max(weights, key=lambda dof: abs(weights[dof]))
            largest_weight = weights.pop(largest)
            self._ties[largest] = {dof: -weight / largest_weight for dof, weight in weights.items()}

    def _in_free(self, dofs: list[int], weights: list[float]) -> dict[int, float]:
        """Return a linear function of degrees of freedom in terms of those that are not tied."""
        stack = list(zip(dofs, weights, strict=True))
        free_weights = dict[int, float]()
        while stack:
            dof, weight = stack.pop()
            if dof in self._ties:
                stack += [(other, weight * share) for other, share in self._ties[dof].items()]
            else:
                free_weights[dof] = free_weights.get(dof, 0.0) + weight
        return free_weights

    def join(self, joints: Joints) -> None:
        """Let displacements follow others, by the joints of the mesh.

        Supports come before, as what they hold does not follow.
        """
        supported = set(self._ties)
        for tie in self._ties.values():
            supported.update(tie)
        held_followers = []
        for follower, weights in joints.rows():
            if follower in supported or not supported.isdisjoint(weights):
                held_followers.append((follower, weights))
            else:
                self._ties[follower] = weights
        for follower, weights in held_followers:
            columns = np.array([follower, *weights], dtype=np.int64)
            values = np.array([-1.0, *weights.values()])
            rows = np.zeros(len(columns), dtype=np.int64)
            difference = coo_array((values, (rows, columns)), shape=(1, self._size))
            self.hold_motion(csr_array(difference))

    def attach(self, nodes: Integers, radius: float, body: Body | None = None) -> None:
        """Hold the lower face at nodes, or attach it to a rigid body.

        If the structure has a bed, the face is held through it.

        Parameters
        ----------
        nodes : int array
            Nodes of the lower face; of plate elements, those above it.
        radius : float
            Twice the area over the perimeter of the held part [m]: the radius of a disc.
        body : tuple, optional
            Six degrees of freedom of a rigid body, and the point [m], (3,), whose displacements are
            the first three.

        Raises
        ------
        InputError
            If a node is attached to two bodies.
        """
        per_node = self.structure.mesh.dofs_per_node
        node_axes = [(node, axis) for node in nodes.tolist() for axis in range(3)]
        for node, axis in node_axes:
            dof = per_node * node + axis
            if dof in self._carried or (body is not None and dof in self._ties):
                self._refuse(node)
        if body is not None:
            self._carried.update(per_node * node + axis for node, axis in node_axes)
        if self.structure.bed is not None:
            bed = patch_bed(self.structure.bed, self.structure.thickness / radius)
            self._add_bed(nodes, bed, body)
            return
        for node, axis in node_axes:
            dof = per_node * node + axis
            lower_face = self._lower_face(node, axis)
            tie = {other: -share for other, share in lower_face.items() if other != dof}
            if body is not None:
                tie |= self._of_body(node, axis, *body)
            self._ties[dof] = tie

    def _add_bed(self, nodes: Integers, bed: tuple[float, float], body: Body | None) -> None:
        """Add distributed springs between the lower face of plate elements and ground or body.

        The bed is the stiffness per area [N/m^3] along and across the plate.
        """
        mesh = self.structure.mesh
        elements = elements_within(mesh, nodes)
        shared = elements[np.isin(elements, self._bedded)]
        if body is not None and len(shared):
            self._refuse(int(mesh.blocks[0].connectivity[shared[0]].flat[0]))
        elements = np.setdiff1d(elements, self._bedded)  # one bed where patches overlap
        self._bedded = np.concatenate([self._bedded, elements])
        along, across = bed
        stiffness = kron(
            area_products(mesh, elements), diags_array([along, along, across]), format="csr"
        )
        # stretch of the springs along each axis, three rows per node
        rows = []
        columns = []
        weights = []
        for node in nodes.tolist():
            for axis in range(3):
                for dof, weight in self._stretch(node, axis, body).items():
                    rows.append(3 * node + axis)
                    columns.append(dof)
                    weights.append(weight)
        stretch = csr_array(
            coo_array((weights, (rows, columns)), shape=(stiffness.shape[0], self._size))
        )
        self._beds.append(csr_array(stretch.T @ stiffness @ stretch))

    def _stretch(self, node: int, axis: int, body: Body | None) -> dict[int, float]:
        """Return the displacement of the lower face at a node less that of the body below it.

        It is along an axis, in coefficients of degrees of freedom.
        """
        weights = self._lower_face(node, axis)
        if body is not None:
            for dof, weight in self._of_body(node, axis, *body).items():
                weights[dof] = weights.get(dof, 0.0) - weight
        return weights

    def _lower_face(self, node: int, axis: int) -> dict[int, float]:
        """Return the displacement of the lower face at a node along an axis.

        It is in coefficients of degrees of freedom.
        """
        mesh = self.structure.mesh
        dof = mesh.dofs_per_node * node + axis
        if mesh.is_flat and axis < 2:  # the slope displaces the face below the middle plane
            return {dof: 1.0, dof + 3: -0.5 * self.structure.thickness}
        return {dof: 1.0}

    def _refuse(self, node: int) -> None:
        """Raise, as two supports hold a node."""
        x, y, _ = self.structure.mesh.nodes[node]
        raise InputError(
            f"two supports hold the same point, ({x:g}, {y:g}) m; supports must lie apart"
        )

    def _of_body(self, node: int, axis: int, dofs: Integers, point: Floats) -> dict[int, float]:
        """Return the displacement of a rigid body at a node along an axis.

        It is in coefficients of the body's degrees of freedom: displacements of the point, and
        rotations.
        """
        lower_face = self.structure.mesh.nodes[node] + [0.0, 0.0, -0.5 * self.structure.thickness]
        arm = lower_face - point
        weights = {int(dofs[axis]): 1.0}
        by_rotation = rotation_columns(*arm[:, None])[0, axis]
        for dof, weight in zip(dofs[3:], by_rotation, strict=True):
            if weight != 0.0:
                weights[int(dof)] = float(weight)
        return weights

    def add_stiffness(self, dofs: Integers, stiffness: Floats) -> None:
        """Add a stiffness matrix on some degrees of freedom, grounded."""
        self._added.append((dofs, stiffness))

    def neglect(self, dofs: Integers, compliances: Floats) -> None:
        """Record neglected compliances in series with supports of degrees of freedom.

        A negative one stiffens the support.
        """
        self._neglected.append((dofs, compliances))

    def add_body(self, stiffness: Floats, mass: Floats, rigid: Floats) -> Integers:
        """Add a body with its own degrees of freedom; return the numbers of these.

        Parameters
        ----------
        stiffness, mass : array, shape (n, n)
            Matrices of the body.
        rigid : array, shape (n, 6)
            Its rigid motions.
        """
        self._bodies.append((stiffness, mass, rigid))
        self._size += len(stiffness)
        return np.arange(self._size - len(stiffness), self._size)

    @property
    def touched(self) -> Integers:
        """Degrees of freedom that the supports hold, tie or spring."""
        tied = list(self._ties)
        for tie in self._ties.values():
            tied += tie
        return np.unique(
            np.concatenate(
                [
                    *(dofs for dofs, _ in self._added),
                    *(bed.indices for bed in self._beds),
                    np.array(tied, dtype=np.int64),
                ]
            )
        )

    def held(self) -> HeldStructure:
        """Return the structure with its supports, reduced to the free degrees of freedom."""
        structure = self.structure
        expansion, free = self._expansion()
        beds = csr_array((self._size, self._size))
        for bed in self._beds:
            beds = beds + self._enlarged(bed)
        added = csr_array(self._added_stiffness() + beds)
        body_stiffness = [stiffness for stiffness, _, _ in self._bodies]
        stiffness = block_diag([structure.stiffness, *body_stiffness], format="csr") + added
        body_mass = [mass for _, mass, _ in self._bodies]
        mass = block_diag([structure.mass, *body_mass], format="csr")
        matrices = (stiffness, mass, beds)
        if not self._ties and not self._bodies:  # no projection is needed
            reduced = [csr_array(matrix) for matrix in matrices]
        else:  # K_r = T^T K T
            transposed = expansion.T.tocsr()
            reduced = [csr_array(transposed @ matrix @ expansion) for matrix in matrices]
        body_motions = [rigid for _, _, rigid in self._bodies]
        motions = np.concatenate([structure.rigid_motions(), *body_motions])
        coefficients = self._rigid_coefficients(motions, expansion, free, added)
        return HeldStructure(
            structure,
            stiffness=reduced[0],
            mass=reduced[1],
            expansion=csr_array(expansion[: structure.stiffness.shape[0]]),
            free=free,
            order=self._free_order(free),
            rigid=motions[free] @ coefficients.T,
            rigid_coefficients=coefficients,
            bed=reduced[2],
            neglected=(
                np.concatenate(
                    [np.zeros(0, dtype=np.int64), *(dofs for dofs, _ in self._neglected)]
                ),
                np.concatenate([np.zeros(0), *(compliances for _, compliances in self._neglected)]),
            ),
        )

    def _free_order(self, free: Integers) -> Integers:
        """Return the elimination order of the free degrees of freedom."""
        structure = self.structure
        # bodies are eliminated last, after all degrees of freedom of the structure that they couple
        of_bodies = np.arange(structure.stiffness.shape[0], self._size)
        free_number = np.full(self._size, -1)
        free_number[free] = np.arange(len(free))
        order = free_number[np.concatenate([structure.order, of_bodies])]
        return np.asarray(order[order >= 0])

    def _enlarged(self, matrix: csr_array) -> csr_array:
        """Return a matrix of earlier degrees of freedom enlarged to all present ones."""
        entries = matrix.tocoo()
        return csr_array(
            coo_array((entries.data, (entries.row, entries.col)), shape=(self._size, self._size))
        )

    def _expansion(self) -> tuple[csr_array, Integers]:
        """Return the map from free to all degrees of freedom, and the free ones."""
        tied = np.array(sorted(self._ties), dtype=np.int64)
        free = np.setdiff1d(np.arange(self._size), tied)
        # each free degree of freedom is itself, and each tied one a combination of others
        rows = free.tolist()
        columns = free.tolist()
        values = [1.0] * len(free)
        for dof, tie in self._ties.items():
            rows += [dof] * len(tie)
            columns += tie.keys()
            values += tie.values()
        expansion = csr_array(coo_array((values, (rows, columns)), shape=(self._size, self._size)))
        # substitute ties to degrees of freedom that are tied themselves
        while expansion[:, tied].nnz:
            expansion = csr_array(expansion @ expansion)
            expansion.eliminate_zeros()
        return csr_array(expansion[:, free]), free

    def _added_stiffness(self) -> csr_array:
        """Return the stiffness of springs on all degrees of freedom."""
        total = csr_array((self._size, self._size))
        for dofs, stiffness in self._added:
            rows, columns = np.meshgrid(dofs, dofs, indexing="ij")
            total = total + csr_array(
                coo_array((stiffness.ravel(), (rows.ravel(), columns.ravel())), shape=total.shape)
            )
        return csr_array(total)

    def _rigid_coefficients(
        self, motions: Floats, expansion: csr_array, free: Integers, added: csr_array
    ) -> Floats:
        """Return the coefficients of rigid motions that the supports permit, one motion per row.

        These violate no tie and strain no spring.
        """
        # rotations in units of displacement
        extent = np.ptp(self.structure.mesh.nodes, axis=0).max()
        scale = np.repeat([1.0, 1.0 / extent], 3)
        motions = motions * scale
        # what ties make of a motion of the free degrees of freedom differs from the motion itself
        violations = motions - expansion @ motions[free]
        measure = violations.T @ violations / (motions.T @ motions).trace()
        energy = motions.T @ (added @ motions)
        start = self.structure.stiffness.shape[0]
        for stiffness, _, rigid in self._bodies:
            body_motions = motions[start : start + len(rigid)]
            energy += body_motions.T @ stiffness @ body_motions
            start += len(rigid)
        if energy.any():
            measure = measure + energy / np.abs(energy).max()
        # a permitted motion has neither: it is in the null space of the sum
        values, vectors = np.linalg.eigh(measure)
        permitted = vectors[:, values < _STILL]
        return np.asarray((scale[:, None] * permitted).T)
