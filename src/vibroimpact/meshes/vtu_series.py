"""Time series of a mesh for ParaView.

It has a .vtu file for each time, and a .pvd file that lists them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike

from vibroimpact.errors import InputError
from vibroimpact.meshes.write_vtu import cells_of, checked_values, grid_text, vtu_text
from vibroimpact.structures.finite_elements.mesh import Mesh


def write_vtu_series(
    mesh: Mesh,
    path: str | PathLike[str],
    times: ArrayLike,
    point_data: Iterable[Mapping[str, ArrayLike]],
) -> list[Path]:
    """Write nodal values of a mesh over time, in single precision.

    They are written into a folder that is being made: the files appear one by one.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    path : path
        The .pvd file to open in ParaView; the .vtu files are written to a folder of the same name
        next to it.
    times : array_like
        Times [s].
    point_data : iterable of mapping of str to array
        For each time, nodal values by name, of shape (nodes,) or (nodes, 3).

    Returns
    -------
    list of pathlib.Path
        The .vtu files, one for each time.

    Raises
    ------
    InputError
        If the numbers of values and times differ, values have a wrong shape, or a file can't be
        written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from vibroimpact.structures.finite_elements.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     files = write_vtu_series(
    ...         tet,
    ...         Path(folder, "tet.pvd"),
    ...         [0.0, 1e-3],
    ...         [{"displacement_m": np.zeros((4, 3))}] * 2,
    ...     )
    ...     [file.name for file in files]
    ['tet_000.vtu', 'tet_001.vtu']
    """
    target = Path(path)
    instants = np.asarray(times, dtype=float)
    remaining_data = iter(point_data)
    nodes, ends, types = cells_of(mesh)
    # the same at all times
    grid = grid_text(
        mesh.nodes.astype(np.float32), nodes.astype(np.int32), ends.astype(np.int32), types
    )
    folder = target.parent / target.stem
    files: list[Path] = []
    try:
        folder.mkdir(exist_ok=True)
        for number, data in zip(range(len(instants)), remaining_data, strict=False):
            single = {
                name: checked_values(name, values, len(mesh.nodes)).astype(np.float32)
                for name, values in data.items()
            }
            files.append(folder / f"{target.stem}_{number:03d}.vtu")
            files[-1].write_bytes(vtu_text(grid, single).encode())
        if len(files) < len(instants) or next(remaining_data, None) is not None:
            raise InputError(
                f"there must be values for each of the {len(instants)} times, and no more",
                "point_data",
            )
        names = [f"{target.stem}/{file.name}" for file in files]
        target.write_bytes(collection_text(instants.tolist(), names).encode())
    except OSError as error:
        raise InputError(
            f"{error.filename or target}: it can't be written: {error.strerror}"
        ) from None
    return files


def collection_text(times: Iterable[float], files: Iterable[str]) -> str:
    """Return the content of a .pvd file that lists a file for each time [s]."""
    rows = [
        f'<DataSet timestep="{time!r}" part="0" file={quoteattr(file)}/>'
        for time, file in zip(times, files, strict=True)
    ]
    head = (
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" '
        'byte_order="LittleEndian">\n<Collection>'
    )
    return "\n".join([head, *rows, "</Collection>", "</VTKFile>", ""])


def series_size(mesh: Mesh, vectors: int) -> int:
    """Return the approximate size of the file of one time, with some nodal vectors [bytes]."""
    nodes, ends, _ = cells_of(mesh)
    # connectivity, offsets and types, then coordinates and vectors, all in base64
    binary = 4 * len(nodes) + 5 * len(ends) + 12 * (1 + vectors) * len(mesh.nodes)
    return int(binary * 4 / 3) + 2000
