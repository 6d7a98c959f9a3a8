"""Reading of mesh and geometry files, by suffix."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.meshes.element_materials import with_element_materials
from vibroimpact.meshes.geometry import BREP, STEP, mesh_geometry
from vibroimpact.meshes.read_abaqus import read_abaqus
from vibroimpact.meshes.read_gmsh import read_gmsh
from vibroimpact.meshes.read_nastran import read_nastran
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.parts import part_at
from vibroimpact.structures.finite_elements.surface import Side, Spot

READERS: Mapping[str, Callable[[str | PathLike[str]], Mesh]] = {
    ".bdf": read_nastran,
    ".dat": read_nastran,
    ".nas": read_nastran,
    ".fem": read_nastran,
    ".inp": read_abaqus,
    ".msh": read_gmsh,
}


def load_mesh(
    path: str | PathLike[str],
    unit_in_metres: float = 1.0,
    size: float | None = None,
    materials: Mapping[str, Material] | None = None,
    contact: tuple[Spot, Side] | None = None,
) -> Mesh:
    """Read a mesh file (Nastran, Abaqus, Gmsh) or mesh a geometry file (STEP, BREP), by suffix.

    Parameters
    ----------
    path : path
        The file: .bdf, .dat, .nas, .fem, .inp, .msh, .step, .stp or .brep.
    unit_in_metres : float, default 1
        Unit of the coordinates [m], such as 0.001 for millimetres; a STEP file states its own.
    size : float, optional
        Approximate maximum element size of a geometry [m]; by default a twelfth of the largest
        extent.
    materials : mapping of str to Material, optional
        Materials in place of those of the file, by the name of a material or an element set; see
        `with_element_materials`.
    contact : tuple of a spot and a side, optional
        Of several parts that share no node and are not joined the one there, such as `((0.0, 0.0),
        "upper")`; see `part_at`. By default all are returned.

    Raises
    ------
    InputError
        If the file is of another kind, can't be read, or gives its elements several materials that
        can't be used.

    Examples
    --------
    >>> load_mesh("plate.stl")
    Traceback (most recent call last):
    vibroimpact.errors.InputError: plate.stl: ".stl" is not read; a mesh must be .bdf, .dat, .nas,
    .fem, .inp, .msh, .step, .stp or .brep
    """
    mesh = mesh_of_file(path, unit_in_metres, size)
    if materials:  # names may be those of any part
        mesh = with_element_materials(mesh, unit_in_metres, materials)
    if contact is not None:
        mesh = part_at(mesh, *contact)
    if not materials:
        mesh = with_element_materials(mesh, unit_in_metres)
    return mesh


def mesh_of_file(
    path: str | PathLike[str], unit_in_metres: float = 1.0, size: float | None = None
) -> Mesh:
    """Return all parts of a mesh file, or of a meshed geometry, without materials.

    Parameters and errors are those of `load_mesh`.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    known = [*READERS, *STEP, *BREP]
    if suffix not in known:
        allowed = f"{', '.join(known[:-1])} or {known[-1]}"
        raise InputError(f'{path}: "{path.suffix}" is not read; a mesh must be {allowed}')
    if not 0 < unit_in_metres < math.inf:
        raise InputError(
            f"{unit_in_metres:g} m is not allowed; it must be greater than 0 and finite",
            "unit_in_metres",
        )
    if suffix not in READERS:
        return mesh_geometry(path, size, unit_in_metres=unit_in_metres)
    if size is not None:
        raise InputError(
            f"{path}: the file is a mesh already; a size is for geometries (.step, .stp or .brep)",
            "size",
        )
    mesh = READERS[suffix](path)
    return replace(mesh, nodes=mesh.nodes * unit_in_metres)
