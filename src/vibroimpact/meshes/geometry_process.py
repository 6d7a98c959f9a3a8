"""The separate Gmsh process, with the arguments geometry, mesh, size and order.

It is run as `python -m vibroimpact.meshes.geometry_process`.

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
    # moves nodes until no curved element has a negative Jacobian
    optimises = 2 if order > 1 else 0
    settings = {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.MeshSizeMin": 0,
        "Mesh.ElementOrder": order,
        "Mesh.HighOrderOptimize": optimises,
        "Mesh.MshFileVersion": 4.1,
        "Mesh.Binary": 0,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(name, value)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.occ.importShapes(geometry)
    gmsh.model.occ.synchronize()
    _check_single_solid(gmsh)
    box = gmsh.model.getBoundingBox(-1, -1)
    size = size or max(box[axis + 3] - box[axis] for axis in range(3)) / DEFAULT_FRACTION
    expected = _expected_elements(gmsh, size)
    if expected > MOST_ELEMENTS:
        raise RuntimeError(
            f"elements of that size would be about {expected / 1e6:.3g} million; at most "
            f"{MOST_ELEMENTS / 1e6:g} million are made: choose a larger size"
        )
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    _name_groups(gmsh)
    gmsh.model.mesh.generate(3)
    _check_elements(gmsh)
    gmsh.write(mesh)


def _check_single_solid(gmsh: object) -> None:
    """Raise RuntimeError unless a geometry has exactly one solid."""
    solids = gmsh.model.getEntities(3)  # type: ignore[attr-defined]
    if len(solids) != 1:
        remedy = "join them" if solids else "make a solid of its surfaces"
        raise RuntimeError(
            f"it holds {len(solids)} solids; it must hold one: {remedy} in the program that made it"
        )


def _name_groups(gmsh: object) -> None:
    """Make a physical group of each face and of the volume, named as in the file or by number."""
    model = gmsh.model  # type: ignore[attr-defined]
    for dimension, kind in ((2, "face"), (3, "volume")):
        for _, tag in model.getEntities(dimension):
            name = model.getEntityName(dimension, tag).rpartition("/")[2]
            model.addPhysicalGroup(dimension, [tag], name=name or f"{kind}{tag}")


def _expected_elements(gmsh: object, size: float) -> float:
    """Estimate the number of elements from the volume, the surface and the edges.

    In the volume they are regular tetrahedra, at the surface triangles; edges count in thin parts.
    """
    occ = gmsh.model.occ  # type: ignore[attr-defined]
    length, area, volume = (
        sum(occ.getMass(dimension, tag) for _, tag in occ.getEntities(dimension))
        for dimension in (1, 2, 3)
    )
    return float(max(length / size, 2.3 * area / size**2, 8.5 * volume / size**3))


def _check_elements(gmsh: object) -> None:
    """Raise RuntimeError if there are no elements, or some have a negative Jacobian."""
    mesh = gmsh.model.mesh  # type: ignore[attr-defined]
    elements = [tag for tags in mesh.getElements(3)[1] for tag in tags]
    inverted = int((mesh.getElementQualities(elements, "minDetJac") <= 0).sum())
    if elements and not inverted:
        return
    fault = "there are no elements"
    if elements:
        fault = f"{inverted} of {len(elements)} elements are inside out"
    raise RuntimeError(f"{fault}; choose a smaller size, or mesh it in another program")


if __name__ == "__main__":
    try:
        make_mesh(sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4]))
    except BaseException as problem:
        sys.stderr.write(f"\n{MARK}{type(problem).__name__}: {problem}\n")
        sys.exit(1)
