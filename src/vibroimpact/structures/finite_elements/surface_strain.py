"""Strain of a face of a body in its plane, per degree of freedom of its finite elements."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Side, face_gradients


def surface_strain(
    mesh: Mesh, place: tuple[float, float], side: Side = "upper", thickness: float = 0.0
) -> csr_array:
    r"""Return the strains of a face at a place per degree of freedom, (3, dofs).

    The rows are :math:`\varepsilon_x, \varepsilon_y, \gamma_{xy}` [-]; on common edges of elements
    they are means over these.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the body.
    place : tuple of two floats
        x and y [m].
    side : str, default "upper"
        "upper" or "lower".
    thickness : float, default 0
        Thickness of plate elements [m].

    Raises
    ------
    InputError
        If the place is not on the body.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> mesh = plate_mesh((0.5, 0.4), 0.1)
    >>> x, y = mesh.nodes[:, :2].T
    >>> motion = np.stack(
    ...     [3 * x, x + 2 * y, 0 * x, x**2 * y, y**2], axis=1
    ... )  # at the height z it adds z times the slopes
    >>> (surface_strain(mesh, (0.1, 0.05), "lower", 0.2) @ motion.ravel()).round(9).tolist()
    [2.999, 1.99, 0.999]
    """
    nodes, gradients = face_gradients(mesh, place, side)  # (k,), (2, k)
    sign = 1.0 if side == "upper" else -1.0
    height = sign * 0.5 * thickness
    # first degree of freedom of a node, and factor: displacements, and slopes times the height
    motions = [(0, 1.0)]
    if mesh.is_flat:
        motions.append((3, height))
    rows = []
    columns = []
    values = []
    for first_dof, factor in motions:
        # each strain, the displacement and the axis along which it is derived
        for strain, displacement, axis in ((0, 0, 0), (1, 1, 1), (2, 0, 1), (2, 1, 0)):
            rows.append(np.full(len(nodes), strain))
            columns.append(mesh.dofs_per_node * nodes + first_dof + displacement)
            values.append(factor * gradients[axis])
    coordinates = (np.concatenate(rows), np.concatenate(columns))
    shape = (3, mesh.dofs_per_node * len(mesh.nodes))
    return csr_array(coo_array((np.concatenate(values), coordinates), shape=shape))
