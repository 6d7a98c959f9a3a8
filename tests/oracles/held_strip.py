"""The rim of a held plate in plane strain: a half strip of scikit-fem's second-order
quadrilaterals, graded to where stress is singular.

Lengths are in thicknesses, stresses in E / (1 - nu^2).
"""

from __future__ import annotations

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, sym_grad, trace

LENGTH = 4.0


def graded(length: float, smallest: float) -> np.ndarray:
    """Points from 0, where elements are smallest and then double, to a length."""
    ends = np.concatenate([[0.0], smallest * 2.0 ** np.arange(40)])
    points = [0.0]
    for start, end in zip(ends[:-1], np.minimum(ends[1:], length), strict=True):
        if end > start:
            number = int(np.ceil((end - start) / 0.125))
            points += list(start + (end - start) * np.arange(1, number + 1) / number)
    return np.array(points)


def rim_compliance(nu: float, held: str) -> np.ndarray:
    """What the rim adds to the compliance of a plate beyond it, (3, 3), for membrane force,
    transverse force and moment there.

    `held` is "lower", the lower face for x < 0, or "end", the side at x = 0.
    """
    if held == "lower":  # one corner, at the origin, where small numbers keep their digits
        right = graded(LENGTH, 1e-7)
        x, z = np.concatenate([-right[:0:-1], right]), graded(1.0, 1e-7)
    else:  # two corners, where stress is less singular
        half = graded(0.5, 1e-3)
        x, z = graded(LENGTH, 1e-3), np.concatenate([half, (1.0 - half)[-2::-1]])
    mesh = skfem.MeshQuad.init_tensor(x, z)
    element = skfem.ElementVector(skfem.ElementQuad2())
    basis = skfem.Basis(mesh, element, intorder=5)
    modulus = 1.0 - nu**2
    mu, lame = modulus / (2 * (1 + nu)), modulus * nu / ((1 + nu) * (1 - 2 * nu))

    @skfem.BilinearForm
    def energy(u, v, _):  # type: ignore[no-untyped-def]
        one, other = sym_grad(u), sym_grad(v)
        return lame * trace(one) * trace(other) + 2 * mu * ddot(one, other)

    end = skfem.FacetBasis(
        mesh,
        element,
        facets=mesh.facets_satisfying(lambda at: np.isclose(at[0], LENGTH)),
        intorder=8,
    )
    loads = []
    for membrane, across, moment in np.eye(3):

        @skfem.LinearForm
        def work(v, w, membrane=membrane, across=across, there=moment + across * LENGTH):  # type: ignore[no-untyped-def]
            height = w.x[1] - 0.5
            return v[0] * (membrane + 12 * there * height) + v[1] * 1.5 * across * (
                1 - 4 * height**2
            )

        loads.append(work.assemble(end))
    load = np.array(loads).T
    still = (
        (lambda at: np.isclose(at[1], 0.0) & (at[0] <= 1e-12))
        if held == "lower"
        else (lambda at: np.isclose(at[0], 0.0))
    )
    fixed = basis.get_dofs(mesh.facets_satisfying(still)).all()
    matrix = energy.assemble(basis)
    free = np.setdiff1d(np.arange(matrix.shape[0]), fixed)
    whole = load[free].T @ splu(matrix[free][:, free].tocsc()).solve(load[free])
    # exact for these stresses
    beam = np.diag([LENGTH, 4 * LENGTH**3 + 1.2 * LENGTH / mu, 12 * LENGTH])
    beam[1, 2] = beam[2, 1] = 6 * LENGTH**2
    return np.asarray(whole - beam)
