"""Meshing of geometry files (STEP and BREP) with Gmsh."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from dataclasses import replace
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, beginning, with_path
from vibroimpact.meshes.geometry_process import MARK
from vibroimpact.meshes.read_gmsh import read_gmsh
from vibroimpact.quoting import shortened
from vibroimpact.structures.finite_elements.mesh import Mesh

STEP = (".step", ".stp")
BREP = (".brep",)

GEOMETRY = FileKind(
    "a geometry is a STEP or BREP file with one solid",
    500_000_000,
    "leave out details that an impact does not feel",
)
"""Requirements on a geometry file."""

MOST_SECONDS = 1200.0
"""Time limit of Gmsh: more than three million elements take.

On some damaged geometries it never ends.
"""


def mesh_geometry(
    path: str | PathLike[str],
    size: float | None = None,
    order: int = 2,
    unit_in_metres: float = 1.0,
) -> Mesh:
    """Mesh the solid in a STEP or BREP file with tetrahedra; requires Gmsh.

    Mid-edge nodes of second-order elements lie on the geometry. Its faces become node sets, named
    as in the file or `face1`, `face2`, and so on. Gmsh runs in a separate process, which isolates
    its messages, settings and crashes.

    Parameters
    ----------
    path : path
        The file: .step, .stp or .brep.
    size : float, optional
        Approximate maximum element size [m]; by default a twelfth of the largest extent.
    order : int, default 2
        Element order, 1 or 2.
    unit_in_metres : float, default 1
        Length unit of a BREP file [m]; a STEP file states its own.

    Raises
    ------
    InputError
        If Gmsh is not installed, or can't mesh the file.

    Examples
    --------
    >>> mesh_geometry("plate.iges")
    Traceback (most recent call last):
    vibroimpact.errors.InputError: plate.iges: ".iges" is not a geometry that is read; it must be
    .step, .stp or .brep
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in (*STEP, *BREP):
        raise InputError(
            f'{path}: "{path.suffix}" is not a geometry that is read; it must be .step, '
            ".stp or .brep"
        )
    if size is not None and not 0 < size < math.inf:
        raise InputError(f"{size:g} m is not allowed; it must be greater than 0 and finite", "size")
    if order not in (1, 2):
        raise InputError(f"{order} is not allowed; it must be 1 or 2", "order")
    if suffix in STEP and unit_in_metres != 1.0:
        raise InputError(
            f"{path}: a STEP file states its own unit; leave this out", "unit_in_metres"
        )
    # STEP is read in millimetres, for which the tolerances of the geometry kernel are intended
    unit = 1e-3 if suffix in STEP else unit_in_metres
    try:
        if not beginning(path, GEOMETRY, 1):
            raise InputError(f"the file is empty; {GEOMETRY.what}")
    except InputError as error:
        raise with_path(path, error) from None
    size_in_unit = 0.0 if size is None else size / unit
    with TemporaryDirectory() as folder:
        mesh_file = Path(folder, "mesh.msh")
        # an absolute path, since a file name that starts with a dash would be taken for an option
        arguments = [str(path.resolve()), str(mesh_file), repr(size_in_unit), str(order)]
        _run_gmsh(path, arguments)
        mesh = read_gmsh(mesh_file)
    return replace(mesh, nodes=mesh.nodes * unit)


def _run_gmsh(path: Path, arguments: list[str]) -> None:
    """Run Gmsh in a separate process; raise InputError with the cause if it fails."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-m", "vibroimpact.meshes.geometry_process", *arguments]
    try:
        process = subprocess.run(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
            timeout=MOST_SECONDS,
        )
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{path}: Gmsh did not end within {MOST_SECONDS / 60:g} minutes and was stopped; "
            "give a larger element size, or mesh the geometry in another program"
        ) from None
    if process.returncode:
        raise _failure(path, process.returncode, process.stderr.decode("utf-8", errors="replace"))


def _failure(path: Path, status: int, output: str) -> InputError:
    """Return an error for a process of Gmsh that failed.

    Parameters
    ----------
    path : Path
        The geometry.
    status : int
        Exit status of the process.
    output : str
        Its standard error, in which the exception stands behind `MARK`.
    """
    _, mark, exception = output.rpartition(MARK)
    if not mark:
        return InputError(
            f"{path}: Gmsh stopped with status {status} while it meshed the "
            "geometry; check the file in another program"
        )
    name, _, message = " ".join(exception.split()).partition(": ")
    if name in ("ImportError", "ModuleNotFoundError", "OSError"):
        fault = (
            f"{path}: meshing a geometry needs Gmsh, which can't be loaded "
            f"({shortened(message, 200)})"
        )
        if name == "OSError":
            return InputError(
                f"{fault}; install the library that it lacks, or mesh the geometry in another "
                "program"
            )
        return InputError(f'{fault}: pip install "vibroimpact[mesh]"')
    return InputError(f"{path}: the geometry can't be meshed: {shortened(message, 300)}")
