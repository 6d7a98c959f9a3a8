"""Constraints of supports on a structure: held and tied degrees of freedom, added
stiffness and bodies; and the reduced system.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, kron

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.bed import area_products, elements_within, patch_bed
from vibroimpact.structures.joints import Joints
from vibroimpact.structures.structure import Structure, rotation_columns

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
            part = motion[[row]].tocoo()
            waiting, weights = (
                list(zip(part.col.tolist(), part.data.tolist(), strict=True)),
                dict[int, float](),
            )
            while waiting:  # express the row in terms of free degrees of freedom
                dof, value = waiting.pop()
                if dof in self._ties:
                    waiting += [(other, value * share) for other, share in self._ties[dof].items()]
                else:
                    weights[dof] = weights.get(dof, 0.0) + value
            size = float(np.abs(part.data).max(initial=0.0))
            if max(map(abs, weights.values()), default=0.0) > _NONE * size:
                largest = max(weights, key=lambda dof: abs(weights[dof]))
                self._ties[largest] = {
                    dof: -value / weights[largest]
                    for dof, value in weights.items()
                    if dof != largest
                }

    def join(self, joints: Joints) -> None:
        """Let displacements follow others, by the joints of the mesh; supports come
        before, as what they hold does not follow.
        """
        supported = self._ties.keys() | {other for tie in self._ties.values() for other in tie}
        touched = []
        for follower, weights in joints.rows():
            if follower in supported or not supported.isdisjoint(weights):
                touched.append((follower, weights))
            else:
                self._ties[follower] = weights
        for follower, weights in touched:
            columns = np.array([follower, *weights], dtype=np.int64)
            values = np.array([-1.0, *weights.values()])
            row = coo_array(
                (values, (np.zeros(len(columns), dtype=np.int64), columns)), shape=(1, self._size)
            )
            self.hold_motion(csr_array(row))

    def attach(
        self, nodes: Integers, radius: float, body: tuple[Integers, Floats] | None = None
    ) -> None:
        """Hold the lower face at nodes, or attach it to a rigid body; through a bed if the
        structure has one.

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
        dofs = {
            per_node * node + axis: (node, axis) for node in nodes.tolist() for axis in range(3)
        }
        for dof, (node, _) in dofs.items():
            if dof in self._carried or (body is not None and dof in self._ties):
                self._refuse(node)
        if body is not None:
            self._carried.update(dofs)
        if self.structure.bed is not None:
            self._add_bed(
                nodes, patch_bed(self.structure.bed, self.structure.thickness / radius), body
            )
            return
        for dof, (node, axis) in dofs.items():
            self._ties[dof] = {
                other: -share for other, share in self._lower(node, axis).items() if other != dof
            }
            if body is not None:
                self._ties[dof] |= self._row(node, axis, *body)

    def _add_bed(
        self, nodes: Integers, bed: tuple[float, float], body: tuple[Integers, Floats] | None
    ) -> None:
        """Add distributed springs between the lower face of plate elements and the
        ground, or a body.
        """
        mesh = self.structure.mesh
        elements = elements_within(mesh, nodes)
        shared = elements[np.isin(elements, self._bedded)]
        if body is not None and len(shared):
            self._refuse(int(mesh.blocks[0].connectivity[shared[0]].flat[0]))
        elements = np.setdiff1d(elements, self._bedded)  # one bed where patches overlap
        self._bedded = np.concatenate([self._bedded, elements])
        stiffness = kron(
            area_products(mesh, elements), diags_array([bed[0], bed[0], bed[1]]), format="csr"
        )
        entries = []
        for node in nodes.tolist():
            for axis in range(3):
                moved = self._lower(node, axis)
                for dof, share in ({} if body is None else self._row(node, axis, *body)).items():
                    moved[dof] = moved.get(dof, 0.0) - share
                entries += [(3 * node + axis, dof, share) for dof, share in moved.items()]
        rows, columns, values = (np.array(side) for side in zip(*entries, strict=True))
        motion = csr_array(
            coo_array((values, (rows, columns)), shape=(stiffness.shape[0], self._size))
        )
        self._beds.append(csr_array(motion.T @ stiffness @ motion))

    def _lower(self, node: int, axis: int) -> dict[int, float]:
        """Return the displacement of the lower face at a node along an axis as
        coefficients of degrees of freedom.
        """
        mesh = self.structure.mesh
        dof = mesh.dofs_per_node * node + axis
        return (
            {dof: 1.0, dof + 3: -0.5 * self.structure.thickness}
            if mesh.is_flat and axis < 2
            else {dof: 1.0}
        )

    def _refuse(self, node: int) -> None:
        """Raise, as two supports hold a node."""
        x, y, _ = self.structure.mesh.nodes[node]
        raise InputError(
            f"two supports hold the same point, ({x:g}, {y:g}) m; supports must lie apart"
        )

    def _row(self, node: int, axis: int, dofs: Integers, point: Floats) -> dict[int, float]:
        """Return the displacement of a rigid body at a node along an axis as coefficients
        of its degrees of freedom.
        """
        at = self.structure.mesh.nodes[node] + [0.0, 0.0, -0.5 * self.structure.thickness] - point
        turned = rotation_columns(*at[:, None])[0, axis]
        return {int(dofs[axis]): 1.0} | {
            int(dof): float(value)
            for dof, value in zip(dofs[3:], turned, strict=True)
            if value != 0.0
        }

    def add_stiffness(self, dofs: Integers, stiffness: Floats) -> None:
        """Add a stiffness matrix on some degrees of freedom, grounded."""
        self._added.append((dofs, stiffness))

    def neglect(self, dofs: Integers, compliances: Floats) -> None:
        """Record neglected compliances in series with supports of degrees of freedom; a
        negative one stiffens the support.
        """
        self._neglected.append((dofs, compliances))

    def add_body(self, stiffness: Floats, mass: Floats, rigid: Floats) -> Integers:
        """Add a body with its own degrees of freedom, given its matrices and rigid
        motions; return the numbers of these.
        """
        self._bodies.append((stiffness, mass, rigid))
        self._size += len(stiffness)
        return np.arange(self._size - len(stiffness), self._size)

    @property
    def touched(self) -> Integers:
        """Degrees of freedom that the supports hold, tie or spring."""
        tied = [dof for one, tie in self._ties.items() for dof in (one, *tie)]
        parts = (
            [dofs for dofs, _ in self._added]
            + [bed.indices for bed in self._beds]
            + [np.array(tied, dtype=np.int64)]
        )
        return np.unique(np.concatenate(parts))

    def held(self) -> HeldStructure:
        """Return the structure with its supports, reduced to the free degrees of freedom."""
        structure = self.structure
        expansion, free = self._expansion()
        added = self._added_stiffness()
        bed = sum((self._whole(part) for part in self._beds), csr_array((self._size, self._size)))
        added = csr_array(added + bed)
        stiffness = (
            block_diag([structure.stiffness, *(body[0] for body in self._bodies)], format="csr")
            + added
        )
        mass = block_diag([structure.mass, *(body[1] for body in self._bodies)], format="csr")
        motions = np.concatenate([structure.rigid_motions(), *(body[2] for body in self._bodies)])
        # bodies are eliminated last, after all degrees of freedom of the structure that they couple
        order = np.concatenate(
            [structure.order, np.arange(structure.stiffness.shape[0], self._size)]
        )
        place = np.full(self._size, -1)
        place[free] = np.arange(len(free))
        order = place[order]
        if not self._ties and not self._bodies:  # no projection is needed
            reduced = [csr_array(matrix) for matrix in (stiffness, mass, bed)]
        else:
            turned = expansion.T.tocsr()
            reduced = [csr_array(turned @ matrix @ expansion) for matrix in (stiffness, mass, bed)]
        coefficients = self._rigid_coefficients(motions, expansion, free, added)
        neglected = [
            np.concatenate([np.zeros(0), *(part[side] for part in self._neglected)])
            for side in range(2)
        ]
        return HeldStructure(
            structure,
            reduced[0],
            reduced[1],
            csr_array(expansion[: structure.stiffness.shape[0]]),
            free,
            order[order >= 0],
            motions[free] @ coefficients.T,
            coefficients,
            reduced[2],
            (neglected[0].astype(np.int64), neglected[1]),
        )

    def _whole(self, part: csr_array) -> csr_array:
        """Return a matrix of earlier degrees of freedom enlarged to all present ones."""
        found = part.tocoo()
        return csr_array(
            coo_array((found.data, (found.row, found.col)), shape=(self._size, self._size))
        )

    def _expansion(self) -> tuple[csr_array, Integers]:
        """Return the map from free to all degrees of freedom, and the free ones."""
        tied = np.array(sorted(self._ties), dtype=np.int64)
        free = np.setdiff1d(np.arange(self._size), tied)
        entries = [
            (dof, other, value) for dof, tie in self._ties.items() for other, value in tie.items()
        ]
        rows, columns, values = (
            (np.array(side) for side in zip(*entries, strict=True))
            if entries
            else (np.zeros(0, int),) * 3
        )
        rows, columns = np.concatenate([free, rows]), np.concatenate([free, columns])
        values = np.concatenate([np.ones(len(free)), values])
        whole = csr_array(coo_array((values, (rows, columns)), shape=(self._size, self._size)))
        while whole[:, tied].nnz:  # substitute ties to degrees of freedom that are tied themselves
            whole = csr_array(whole @ whole)
            whole.eliminate_zeros()
        return csr_array(whole[:, free]), free

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
        """Return the coefficients of rigid motions that violate no tie and strain no
        spring, one motion per row.
        """
        # rotations in units of displacement
        scale = np.repeat([1.0, 1.0 / np.ptp(self.structure.mesh.nodes, axis=0).max()], 3)
        motions = motions * scale
        broken = motions - expansion @ motions[free]
        measure = broken.T @ broken / (motions.T @ motions).trace()
        energy = motions.T @ (added @ motions)
        start = self.structure.stiffness.shape[0]
        for stiffness, _, rigid in self._bodies:
            part = motions[start : start + len(rigid)]
            energy += part.T @ stiffness @ part
            start += len(rigid)
        if energy.any():
            measure = measure + energy / np.abs(energy).max()
        values, vectors = np.linalg.eigh(measure)
        return np.asarray((scale[:, None] * vectors[:, values < _STILL]).T)
