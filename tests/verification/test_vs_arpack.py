"""Our block Lanczos iteration against ARPACK, and against Sylvester's law of inertia: no
mode is missed, none is there twice.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh

from agreement import Against, Agrees
from vibroimpact.materials import find_material
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import plate_structure, solid_structure
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.patch import Patch
from vibroimpact.structures.supports.support import held_by

AGAINST = Against(
    "ARPACK eigenvalue solver, through SciPy",
    "other program",
    "plates, spheres and modes",
    "Lehoucq, Sorensen and Yang 1998, ARPACK Users' Guide; scipy.sparse.linalg.eigsh",
)


STEEL = find_material("steel-paper")
PATCHES = tuple(Patch(x, y, 0.02) for x in (-0.2, 0.2) for y in (-0.15, 0.15))
SIMPLY = tuple(Edge(edge, "simply-supported") for edge in EDGES)
BODIES = {
    "sphere, multiplets of 5 to 13": lambda: (
        solid_structure(sphere_mesh(0.025, 6), STEEL),
        (),
        60,
        1e-9,
    ),
    "cube": lambda: (solid_structure(box_mesh((1.0, 1.0, 1.0), (4, 4, 4)), STEEL), (), 60, 1e-9),
    "square plate, free": lambda: (
        plate_structure(plate_mesh((1.0, 1.0), 0.2), STEEL, 0.01),
        (),
        40,
        1e-7,
    ),
    "square plate, thin, held": lambda: (
        plate_structure(plate_mesh((1.0, 1.0), 0.25), STEEL, 0.01, "thin"),
        SIMPLY,
        30,
        2e-6,
    ),
    "patches": lambda: (
        plate_structure(
            plate_mesh((0.5, 0.4), 0.1, [disc for patch in PATCHES for disc in patch.discs]),
            STEEL,
            0.008,
        ),
        PATCHES,
        60,
        1e-8,
    ),
}
SLOW = {"sphere, multiplets of 5 to 13", "patches"}


@pytest.mark.parametrize(
    "body", [pytest.param(body, marks=pytest.mark.slow if body in SLOW else ()) for body in BODIES]
)
def test_modes_of_arpack(agrees: Agrees, body: str) -> None:
    structure, supports, number, tolerance = BODIES[body]()
    held = held_by(structure, supports)
    elastic = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    modes = elastic.modes(number)
    ours, skip = modes.angular_frequencies**2, held.rigid.shape[1]
    theirs = eigsh(
        csc_array(held.stiffness),
        number + skip + 2,
        csc_array(held.mass),
        sigma=-0.3 * ours[0],
        return_eigenvectors=False,
    )
    agrees(
        body,
        "lowest eigenvalues ω²",
        ours,
        np.sort(theirs)[skip : skip + number],
        unit="rad²/s²",
        relative=tolerance,
    )
    np.testing.assert_allclose(
        modes.shapes.T @ (held.mass @ modes.shapes), np.eye(number), atol=1e-10
    )
    # between two multiplets
    apart = np.flatnonzero(
        np.diff(modes.angular_frequencies) > 1e-3 * modes.angular_frequencies[:-1]
    )[-1]
    between = 0.5 * (modes.angular_frequencies[apart] + modes.angular_frequencies[apart + 1])
    assert elastic.count_below(between) == apart + 1
