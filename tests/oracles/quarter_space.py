"""A force on a quarter space, near its edge, by finite elements (an oracle: imports nothing of
vibroimpact).

The quarter space x > 0, z < 0 carries a unit force downwards at (1, 0, 0) on its upper side. Its
displacement is that of the half space (Boussinesq), which does not leave the face x = 0 free, and
what frees it: the opposite of Boussinesq's stresses on that face, which is smooth, and is done by
quadratic tetrahedra on a block that grows in size away from the edge and is held where it ends.

With 4 and 8 cells along an edge the factor for nu = 0 is 1.22 and 1.28: good to about 5 %.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    BilinearForm,
    ElementTetP2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshTet,
    condense,
)
from skfem.helpers import ddot, eye, sym_grad, trace

Floats = NDArray[np.float64]


def boussinesq(nu: float, x: Floats, y: Floats, depth: Floats) -> tuple[Floats, Floats, Floats]:
    """Stresses xx, xy and xz of a half space under a unit force at the origin; x and y
    along it, depth downwards, tension positive.
    """
    r = np.sqrt(x * x + y * y + depth * depth)
    s, m = r + depth, 1.0 - 2.0 * nu
    # Timoshenko and Goodier 1970, section 138, in Cartesian components
    xx = -(
        3 * x * x * depth / r**5
        - m * (depth / r**3 - 1 / (r * s) + x * x * (2 * r + depth) / (r**3 * s * s))
    ) / (2 * np.pi)
    xy = -(3 * x * y * depth / r**5 - m * x * y * (2 * r + depth) / (r**3 * s * s)) / (2 * np.pi)
    xz = -(3 * x * depth * depth / r**5) / (2 * np.pi)
    return xx, xy, xz


def image_factor(nu: float, cells: int = 8, reach: float = 60.0) -> float:
    """What the edge adds to the displacement under the force, over the half space's
    displacement at its mirror image.
    """
    along = np.concatenate(
        [
            np.linspace(0.0, 2.0, cells // 2 + 1),
            2.0 * (reach / 2.0) ** (np.arange(1, cells + 1) / cells),
        ]
    )
    across = np.concatenate(
        [np.linspace(0.0, 1.0, cells // 4 + 1), reach ** (np.arange(1, cells + 1) / cells)]
    )
    mesh = MeshTet.init_tensor(along, across, across)  # x, y and depth; half of it, for y > 0
    element = ElementVector(ElementTetP2())
    basis = Basis(mesh, element, intorder=2)
    shear, lame = 0.5 / (1.0 + nu), nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    @BilinearForm
    def stiffness(u, v, _):  # type: ignore[no-untyped-def]
        strain = sym_grad(u)
        return ddot(2.0 * shear * strain + lame * eye(trace(strain), 3), sym_grad(v))

    @LinearForm
    def freeing(v, w):  # type: ignore[no-untyped-def]
        x, y, depth = w.x
        xx, xy, xz = boussinesq(nu, x - 1.0, y, depth)
        # the outward normal is -x, and the traction is the opposite of Boussinesq's
        return xx * v[0] + xy * v[1] + xz * v[2]

    faces = mesh.facets_satisfying(lambda p: p[0] < 1e-9)
    load = freeing.assemble(FacetBasis(mesh, element, facets=faces, intorder=6))
    ends = basis.get_dofs(
        lambda p: (p[0] > reach - 1e-6) | (p[1] > reach - 1e-6) | (p[2] > reach - 1e-6)
    ).all()
    middle = basis.get_dofs(lambda p: p[1] < 1e-9).all("u^2")
    matrix, right, _, kept = condense(stiffness.assemble(basis), load, D=np.union1d(ends, middle))
    found = np.zeros(basis.N)
    found[kept] = splu(
        matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
    ).solve(right)
    under = int(np.argmin(np.abs(mesh.p - [[1.0], [0.0], [0.0]]).sum(axis=0)))
    return float(found[basis.nodal_dofs[2, under]] / ((1.0 - nu**2) / (np.pi * 2.0)))
