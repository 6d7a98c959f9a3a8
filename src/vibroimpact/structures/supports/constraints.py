"""How supports act on a structure: degrees of freedom held or tied, stiffness and bodies added; then what is left free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, kron

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.bed import area_products, bed_under, elements_within
from vibroimpact.structures.structure import Structure, rotation_columns

_STILL = 1e-12  # the part of a rigid motion's energy or displacement that rounding may leave


@dataclass(frozen=True)
class HeldStructure:
    """A structure as its supports hold it.

    Parameters
    ----------
    structure : Structure
        The structure.
    stiffness, mass : sparse arrays, shape (free, free)
        Of the degrees of freedom that are left free.
    expansion : sparse array, shape (dofs, free)
        From the free degrees of freedom to those of the structure.
    free : int array, shape (free,)
        Their numbers among all: those of the structure, then those of the bodies that hold it.
    order : int array, shape (free,)
        An elimination order.
    rigid : array, shape (free, r)
        The rigid motions that the supports leave, r from none to six.
    left : array, shape (r, 6)
        What these are: how much of each translation along x, y and z, and of each rotation about the centre of mass.
    bed : sparse array, shape (free, free)
        The part of the stiffness that beds under plate elements have (see `bed_stiffness`).
    neglected : tuple of int array and array, shape (n,)
        Degrees of freedom of the structure that are held, and compliances in series with what holds them that are left out.
    """

    structure: Structure
    stiffness: csr_array
    mass: csr_array
    expansion: csr_array
    free: Integers
    order: Integers
    rigid: Floats
    left: Floats
    bed: csr_array
    neglected: tuple[Integers, Floats]


class Constraints:
    """What the supports of a structure do to it, gathered one after the other.

    Parameters
    ----------
    structure : Structure
        The structure to be held.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self._ties: dict[int, dict[int, float]] = {}  # a degree of freedom as a sum of others; of none: it is held
        self._carried: set[int] = set()  # those that move with bodies
        self._added: list[tuple[Integers, Floats]] = []  # degrees of freedom and their stiffness
        self._beds: list[csr_array] = []  # their stiffness, on the degrees of freedom that there were
        self._bedded = np.zeros(0, dtype=np.int64)  # elements that have a bed
        self._neglected: list[tuple[Integers, Floats]] = []
        self._bodies: list[tuple[Floats, Floats, Floats]] = []  # stiffness, mass and rigid motions of each
        self._size = structure.stiffness.shape[0]

    def hold(self, dofs: Integers) -> None:
        """Hold degrees of freedom still.

        Raises
        ------
        InputError
            If one moves with a body already.
        """
        for dof in dofs.ravel().tolist():
            if dof in self._carried:
                self._refuse(dof // self.structure.mesh.dofs_per_node)
            self._ties[dof] = {}

    def hold_motion(self, motion: csr_array) -> None:
        """Hold sums of degrees of freedom, one a row, at zero."""
        for row in range(motion.shape[0]):
            part = motion[[row]].tocoo()
            waiting, weights = list(zip(part.col.tolist(), part.data.tolist(), strict=True)), dict[int, float]()
            while waiting:  # in terms of those that are free
                dof, value = waiting.pop()
                if dof in self._ties:
                    waiting += [(other, value * share) for other, share in self._ties[dof].items()]
                else:
                    weights[dof] = weights.get(dof, 0.0) + value
            if any(weights.values()):
                largest = max(weights, key=lambda dof: abs(weights[dof]))
                self._ties[largest] = {dof: -value / weights[largest] for dof, value in weights.items() if dof != largest}

    def attach(self, nodes: Integers, radius: float, body: tuple[Integers, Floats] | None = None) -> None:
        """Hold the lower face at nodes, or let it move with a rigid body; plate elements that have a bed rest on it.

        Parameters
        ----------
        nodes : int array
            Nodes of the lower face; of plate elements, those above it.
        radius : float
            Twice the area over the perimeter of what is held [m]: of a disc its radius.
        body : tuple, optional
            Six degrees of freedom of a rigid body, and the point [m], shape (3,), that its first three move.

        Raises
        ------
        InputError
            If a node is attached to two bodies.
        """
        per_node = self.structure.mesh.dofs_per_node
        dofs = {per_node * node + axis: (node, axis) for node in nodes.tolist() for axis in range(3)}
        for dof, (node, _) in dofs.items():
            if dof in self._carried or (body is not None and dof in self._ties):
                self._refuse(node)
        if body is not None:
            self._carried.update(dofs)
        if self.structure.bed is not None:
            self._rest(nodes, bed_under(self.structure.bed, self.structure.thickness / radius), body)
            return
        for dof, (node, axis) in dofs.items():
            self._ties[dof] = {other: -share for other, share in self._lower(node, axis).items() if other != dof}
            if body is not None:
                self._ties[dof] |= self._row(node, axis, *body)

    def _rest(self, nodes: Integers, bed: tuple[float, float], body: tuple[Integers, Floats] | None) -> None:
        """Put springs between the lower face of plate elements and what holds it."""
        mesh = self.structure.mesh
        elements = elements_within(mesh, nodes)
        if body is not None and np.isin(elements, self._bedded).any():
            self._refuse(int(nodes[0]))
        elements = np.setdiff1d(elements, self._bedded)  # where two patches overlap there is one bed
        self._bedded = np.concatenate([self._bedded, elements])
        stiffness = kron(area_products(mesh, elements), diags_array([bed[0], bed[0], bed[1]]), format="csr")
        entries = []
        for node in nodes.tolist():
            for axis in range(3):
                moved = self._lower(node, axis)
                for dof, share in ({} if body is None else self._row(node, axis, *body)).items():
                    moved[dof] = moved.get(dof, 0.0) - share
                entries += [(3 * node + axis, dof, share) for dof, share in moved.items()]
        rows, columns, values = (np.array(side) for side in zip(*entries, strict=True))
        motion = csr_array(coo_array((values, (rows, columns)), shape=(stiffness.shape[0], self._size)))
        self._beds.append(csr_array(motion.T @ stiffness @ motion))

    def _lower(self, node: int, axis: int) -> dict[int, float]:
        """Return by which degrees of freedom the lower face at a node moves along an axis."""
        mesh = self.structure.mesh
        dof = mesh.dofs_per_node * node + axis
        return {dof: 1.0, dof + 3: -0.5 * self.structure.thickness} if mesh.is_flat and axis < 2 else {dof: 1.0}

    def _refuse(self, node: int) -> None:
        x, y, _ = self.structure.mesh.nodes[node]
        raise InputError(f"two supports hold the same point, ({x:g}, {y:g}) m; supports must lie apart")

    def _row(self, node: int, axis: int, dofs: Integers, point: Floats) -> dict[int, float]:
        at = self.structure.mesh.nodes[node] + [0.0, 0.0, -0.5 * self.structure.thickness] - point
        turned = rotation_columns(*at[:, None])[0, axis]
        return {int(dofs[axis]): 1.0} | {int(dof): float(value) for dof, value in zip(dofs[3:], turned, strict=True) if value != 0.0}

    def add_stiffness(self, dofs: Integers, stiffness: Floats) -> None:
        """Add a stiffness matrix on some degrees of freedom, grounded."""
        self._added.append((dofs, stiffness))

    def neglect(self, dofs: Integers, compliances: Floats) -> None:
        """Note compliances in series with what holds degrees of freedom still, which are left out; a negative one stiffens."""
        self._neglected.append((dofs, compliances))

    def add_body(self, stiffness: Floats, mass: Floats, rigid: Floats) -> Integers:
        """Add a body with degrees of freedom of its own, given its matrices and its rigid motions; return their numbers."""
        self._bodies.append((stiffness, mass, rigid))
        self._size += len(stiffness)
        return np.arange(self._size - len(stiffness), self._size)

    def held(self) -> HeldStructure:
        """Return the structure as it is held."""
        structure = self.structure
        expansion, free = self._expansion()
        added = self._added_stiffness()
        bed = sum((self._whole(part) for part in self._beds), csr_array((self._size, self._size)))
        added = csr_array(added + bed)
        stiffness = block_diag([structure.stiffness, *(body[0] for body in self._bodies)], format="csr") + added
        mass = block_diag([structure.mass, *(body[1] for body in self._bodies)], format="csr")
        motions = np.concatenate([structure.rigid_motions(), *(body[2] for body in self._bodies)])
        order = np.concatenate([structure.order, np.arange(structure.stiffness.shape[0], self._size)])
        place = np.full(self._size, -1)
        place[free] = np.arange(len(free))
        order = place[order]
        if not self._ties and not self._bodies:
            reduced = [csr_array(matrix) for matrix in (stiffness, mass, bed)]
        else:
            turned = expansion.T.tocsr()
            reduced = [csr_array(turned @ matrix @ expansion) for matrix in (stiffness, mass, bed)]
        left = self._left(motions, expansion, free, added)
        neglected = [np.concatenate([np.zeros(0), *(part[side] for part in self._neglected)]) for side in range(2)]
        return HeldStructure(
            structure,
            reduced[0],
            reduced[1],
            csr_array(expansion[: structure.stiffness.shape[0]]),
            free,
            order[order >= 0],
            motions[free] @ left.T,
            left,
            reduced[2],
            (neglected[0].astype(np.int64), neglected[1]),
        )

    def _whole(self, part: csr_array) -> csr_array:
        """Return a matrix of the degrees of freedom that there were, on those that there are."""
        found = part.tocoo()
        return csr_array(coo_array((found.data, (found.row, found.col)), shape=(self._size, self._size)))

    def _expansion(self) -> tuple[csr_array, Integers]:
        tied = np.array(sorted(self._ties), dtype=np.int64)
        free = np.setdiff1d(np.arange(self._size), tied)
        entries = [(dof, other, value) for dof, tie in self._ties.items() for other, value in tie.items()]
        rows, columns, values = (np.array(side) for side in zip(*entries, strict=True)) if entries else (np.zeros(0, int),) * 3
        rows, columns = np.concatenate([free, rows]), np.concatenate([free, columns])
        values = np.concatenate([np.ones(len(free)), values])
        whole = csr_array(coo_array((values, (rows, columns)), shape=(self._size, self._size)))
        for _ in range(4):  # a tie may lead to a degree of freedom that is tied itself
            if whole[:, tied].nnz == 0:
                break
            whole = csr_array(whole @ whole)
            whole.eliminate_zeros()
        return csr_array(whole[:, free]), free

    def _added_stiffness(self) -> csr_array:
        total = csr_array((self._size, self._size))
        for dofs, stiffness in self._added:
            rows, columns = np.meshgrid(dofs, dofs, indexing="ij")
            total = total + csr_array(coo_array((stiffness.ravel(), (rows.ravel(), columns.ravel())), shape=total.shape))
        return csr_array(total)

    def _left(self, motions: Floats, expansion: csr_array, free: Integers, added: csr_array) -> Floats:
        """Return the combinations of rigid motions that break no tie and strain no spring, a row each."""
        scale = np.repeat([1.0, 1.0 / np.ptp(self.structure.mesh.nodes, axis=0).max()], 3)  # so that rotations count as translations
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
