"""Writing of VTK unstructured grids (.vtu), for ParaView."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from os import PathLike
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_text_file
from vibroimpact.meshes.deck_mesh import nine_node_shells
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

_CELLS = {
    "tet4": 10,
    "tet10": 24,
    "wedge6": 13,
    "wedge15": 26,
    "pyramid5": 14,
    "pyramid13": 27,
    "pyramid14": 27,
    "hex8": 12,
    "hex20": 25,
    "hex27": 29,
    "quad25": 28,
}
_PYRAMID_NODES = 13
"""Of the pyramid of VTK that ParaView draws for that of 14 nodes."""
_TYPES = {
    "float64": "Float64",
    "float32": "Float32",
    "int64": "Int64",
    "int32": "Int32",
    "uint8": "UInt8",
}


def write_vtu(
    mesh: Mesh, path: str | PathLike[str], point_data: Mapping[str, ArrayLike] | None = None
) -> None:
    """Write a mesh, and values at its nodes, as a VTK unstructured grid (.vtu) for ParaView.

    Each plate element becomes four biquadratic quadrilaterals.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    path : path
        The file; an existing one is replaced.
    point_data : mapping of str to array, optional
        Values at all nodes by name, of shape (nodes,) or (nodes, 3).

    Raises
    ------
    InputError
        If values have a wrong shape, or the file can't be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from vibroimpact.structures.finite_elements.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     write_vtu(tet, Path(folder, "tet.vtu"), {"displacement_m": np.zeros((4, 3))})
    ...     "displacement_m" in Path(folder, "tet.vtu").read_text()
    True
    """
    values = {
        name: checked_values(name, data, len(mesh.nodes))
        for name, data in (point_data or {}).items()
    }
    grid = grid_text(np.asarray(mesh.nodes, dtype=float), *cells_of(mesh))
    write_text_file(path, vtu_text(grid, values))


def cells_of(mesh: Mesh) -> tuple[Integers, Integers, NDArray[np.uint8]]:
    """Return the cells of a mesh as VTK arrays: connectivity, offsets and cell types."""
    # empty arrays first, for a mesh without blocks
    connectivity = [np.zeros(0, dtype=np.int64)]
    sizes = [np.zeros(0, dtype=np.int64)]
    types = [np.zeros(0, dtype=np.uint8)]
    for block in mesh.blocks:
        nodes = _cell_nodes(block)
        connectivity.append(nodes.ravel())
        sizes.append(np.full(len(nodes), nodes.shape[1]))
        types.append(np.full(len(nodes), _CELLS[block.kind], dtype=np.uint8))
    return np.concatenate(connectivity), np.cumsum(np.concatenate(sizes)), np.concatenate(types)


def _cell_nodes(block: ElementBlock) -> Integers:
    """Return the nodes of the cells of a block."""
    if block.kind == "quad25":
        return nine_node_shells(block.connectivity)
    if block.kind == "pyramid14":
        return block.connectivity[:, :_PYRAMID_NODES]
    return block.connectivity


def grid_text(
    points: NDArray[np.floating],
    nodes: NDArray[np.integer],
    ends: NDArray[np.integer],
    types: NDArray[np.uint8],
) -> str:
    """Return the points and cells of a .vtu file, with all that comes before them.

    Each array is written with its own precision.
    """
    rows = [
        '<?xml version="1.0"?>',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(types)}">',
        "<Points>",
        _array("Points", points),
        "</Points>",
        "<Cells>",
        _array("connectivity", nodes),
        _array("offsets", ends),
        _array("types", types),
        "</Cells>",
    ]
    return "\n".join(rows)


def vtu_text(grid: str, point_data: Mapping[str, NDArray[np.floating]]) -> str:
    """Return the content of a .vtu file from its points and cells, and values at its points.

    The former are those of `grid_text`.
    """
    rows = [
        grid,
        "<PointData>",
        *(_array(name, data) for name, data in point_data.items()),
        "</PointData>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
        "",
    ]
    return "\n".join(rows)


def checked_values(name: str, data: ArrayLike, nodes: int) -> Floats:
    """Return nodal values as an array of floats.

    Raises
    ------
    InputError
        If they are not real numbers, or their shape is neither (nodes,) nor (nodes, 3).
    """
    try:
        values = np.asarray(data)
        if np.iscomplexobj(values):
            raise TypeError
        values = values.astype(float)
    except (TypeError, ValueError):
        raise InputError(
            "the values are not real numbers; ParaView takes no others", name
        ) from None
    if values.shape not in ((nodes,), (nodes, 3)):
        raise InputError(
            f"the values have the shape {values.shape}; it must be ({nodes},) or ({nodes}, "
            f"3), for {nodes} nodes",
            name,
        )
    return values


def _array(name: str, values: NDArray[np.generic]) -> str:
    """Return an array as a VTK DataArray element: number of bytes and bytes, both in base64."""
    # binary data of VTK: little-endian, with the number of bytes before them
    raw = values.astype(values.dtype.newbyteorder("<")).tobytes()
    text = base64.b64encode(len(raw).to_bytes(8, "little") + raw).decode("ascii")
    label = quoteattr("".join(letter for letter in name if letter.isprintable()))
    components = ""
    if values.ndim == 2:
        components = f' NumberOfComponents="{values.shape[1]}"'
    return (
        f'<DataArray type="{_TYPES[values.dtype.name]}" Name={label}{components} '
        f'format="binary">{text}</DataArray>'
    )
