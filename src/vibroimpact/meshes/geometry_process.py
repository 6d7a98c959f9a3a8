"""The separate Gmsh process: `python -m vibroimpact.meshes.geometry_process geometry mesh size
order`.

It writes the mesh to a file, and an error message to standard error, after a mark that separates it
from other output.
"""

from __future__ import annotations

import sys

MARK = "vibroimpact could not make a mesh: "
MOST_ELEMENTS = 3_000_000
DEFAULT_FRACTION = 12


def make_mesh(geometry: str, mesh: str, size: float, order: int) -> None:
    """Mesh the single solid of a geometry; a size of 0 means a twelfth of the largest extent.

    Raises
    ------
    RuntimeError
        If there is not exactly one solid, there would be too many elements, or some have a negative
        Jacobian.
    """
    import gmsh  # type: ignore[import-untyped, unused-ignore]

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    settings = {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.MeshSizeMin": 0,
        "Mesh.ElementOrder": order,
        # moves nodes until no curved element has a negative Jacobian
        "Mesh.HighOrderOptimize": 2 if order > 1 else 0,
        "Mesh.MshFileVersion": 4.1,
        "Mesh.Binary": 0,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(name, value)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.occ.importShapes(geometry)
    gmsh.model.occ.synchronize()
    solids = gmsh.model.getEntities(3)
    if len(solids) != 1:
        remedy = "join them" if solids else "make a solid of its surfaces"
        raise RuntimeError(
            f"it holds {len(solids)} solids; it must hold one: {remedy} in the program that made it"
        )
    box = gmsh.model.getBoundingBox(-1, -1)
    size = size or max(box[axis + 3] - box[axis] for axis in range(3)) / DEFAULT_FRACTION
    expected = _expected_elements(gmsh, size)
    if expected > MOST_ELEMENTS:
        raise RuntimeError(
            f"elements of that size would be about {expected / 1e6:.3g} million; at most "
            f"{MOST_ELEMENTS / 1e6:g} million are made: choose a larger size"
        )
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    for dimension, word in ((2, "face"), (3, "volume")):
        for _, tag in gmsh.model.getEntities(dimension):
            label = gmsh.model.getEntityName(dimension, tag).rpartition("/")[2]
            gmsh.model.addPhysicalGroup(dimension, [tag], name=label or f"{word}{tag}")
    gmsh.model.mesh.generate(3)
    _check(gmsh)
    gmsh.write(mesh)


def _expected_elements(gmsh: object, size: float) -> float:
    """Estimate the number of elements from the volume (regular tetrahedra), the surface
    (triangles) and the edges (thin parts).
    """
    occ = gmsh.model.occ  # type: ignore[attr-defined]
    measure = [
        sum(occ.getMass(dimension, tag) for _, tag in occ.getEntities(dimension))
        for dimension in (1, 2, 3)
    ]
    return float(max(measure[0] / size, 2.3 * measure[1] / size**2, 8.5 * measure[2] / size**3))


def _check(gmsh: object) -> None:
    mesh = gmsh.model.mesh  # type: ignore[attr-defined]
    elements = [tag for tags in mesh.getElements(3)[1] for tag in tags]
    inverted = int((mesh.getElementQualities(elements, "minDetJac") <= 0).sum())
    if not elements or inverted:
        what = (
            f"{inverted} of {len(elements)} elements are inside out"
            if elements
            else "there are no elements"
        )
        raise RuntimeError(f"{what}; choose a smaller size, or mesh it in another program")


if __name__ == "__main__":
    try:
        make_mesh(sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4]))
    except BaseException as problem:
        sys.stderr.write(f"\n{MARK}{type(problem).__name__}: {problem}\n")
        sys.exit(1)
