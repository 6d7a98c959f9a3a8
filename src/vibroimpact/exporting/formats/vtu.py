"""VTU: animation of the sphere and the plate's upper surface for ParaView."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Floats
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.exporting.resample import motion_at
from vibroimpact.files.plain_names import one_line

Cells = tuple[NDArray[np.float32], NDArray[np.int32]]
"""Points (points, 3) [m], and connectivity (cells, 4) of quadrilaterals, degenerate at
the poles.
"""

_EVEN = 200
_IMPACTS = 20
"""Number of equidistant frames, and of impacts whose first touch, maximum indentation and
release are further frames.
"""
_AROUND = 32
_DOWN = 16
"""Quadrilaterals of the sphere around its axis and from pole to pole."""
_QUADRILATERAL = 9
_BRICK = 12


def write(drop: Drop) -> dict[str, bytes]:
    """Return `sphere.pvd` and `plate.pvd`, with one file per frame; a plate without deflection that
    stands still is `plate.vtu`.

    Raises
    ------
    InputError
        If the drop has neither a history nor the motion of the plate's surface.
    """
    times, path = _sphere_path(drop)
    points, cells = _sphere(drop)
    moved = [points + at for at in path.astype(np.float32)]
    files = _series("sphere", times, [_text(nodes, cells) for nodes in moved])
    if drop.surface:
        points, cells, on_plate = _surface(drop)
        lifted = np.zeros((len(times), len(points), 3), dtype=np.float32)
        lifted[:, :, :2] = _plate_path(drop, times)[:, None, :2]
        lifted[:, :, 2] = drop.surface["height"].reshape(len(times), -1)[:, on_plate]
        return files | _series("plate", times, [_text(points, cells, nodes) for nodes in lifted])
    if drop.plate_size is None:
        return files
    boxes = [_box(drop.plate_size, at) for at in _plate_path(drop, times)]
    if drop.motion is None:  # one is enough
        return files | {"plate.vtu": boxes[0]}
    return files | _series("plate", times, boxes)


def _sphere_path(drop: Drop) -> tuple[Floats, Floats]:
    """Return the times of the frames [s], and how far the sphere's centre has moved along
    the plate, and its height [m] (frames, 3).
    """
    if drop.surface:
        times = drop.surface["time"]
        height = drop.surface["sphere_position"]
    else:
        times = _times(drop)
        height = motion_at(drop.history, times)["position_m"]
    path = np.zeros((len(times), 3))
    path[:, 2] = height
    if drop.oblique is not None:
        motion = motion_at(drop.history, times)
        path[:, :2] = (
            np.stack([motion["position_x_m"], motion["position_y_m"]], axis=1) - drop.position
        )
    return times, path


def _plate_path(drop: Drop, times: Floats) -> Floats:
    """Return how far the supports of the plate have moved at times [s] (frames, 3) [m]."""
    if drop.motion is None:
        return np.zeros((len(times), 3))
    displacement, *_ = drop.motion.at(times)
    return np.outer(displacement, drop.motion.direction)


def _times(drop: Drop) -> Floats:
    """Return equidistant times over the run, and those of what happens in the first impacts [s]."""
    if len(drop.history.get("time_s", ())) < 2:
        raise InputError(f'"{one_line(drop.name)}" has no history; there is no motion to write')
    times = np.linspace(0.0, float(drop.history["time_s"][-1]), _EVEN)
    if drop.impacts:
        touch, duration, deepest = (
            drop.impacts[name][:_IMPACTS]
            for name in ("time_s", "duration_s", "time_of_max_indentation_s")
        )
        events = np.concatenate([touch, touch + duration, deepest])
        times = np.union1d(times, events[(events >= 0.0) & (events <= times[-1])])  # without NaN
    return times


def _series(name: str, times: Floats, texts: list[bytes]) -> dict[str, bytes]:
    # imported here, since it loads scipy.sparse
    from vibroimpact.meshes.vtu_series import collection_text

    files = {f"{name}/{name}_{number:03d}.vtu": text for number, text in enumerate(texts)}
    return {f"{name}.pvd": collection_text(times.tolist(), files).encode(), **files}


def _text(
    points: NDArray[np.float32], cells: NDArray[np.int32], moved: NDArray[np.float32] | None = None
) -> bytes:
    fields = {}
    if moved is not None:
        fields["displacement_m"] = moved
    return _file(points, cells, _QUADRILATERAL, fields)


def _file(
    points: NDArray[np.float32],
    cells: NDArray[np.int32],
    kind: int,
    values: dict[str, NDArray[np.float32]],
) -> bytes:
    # imported here, since it loads scipy.sparse
    from vibroimpact.meshes.write_vtu import grid_text, vtu_text

    ends = np.cumsum(np.full(len(cells), cells.shape[1], dtype=np.int32), dtype=np.int32)
    return vtu_text(
        grid_text(points, cells.ravel(), ends, np.full(len(cells), kind, dtype=np.uint8)), values
    ).encode()


def _sphere(drop: Drop) -> Cells:
    """Return the surface mesh of the sphere with its centre at height zero."""
    around = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    down = np.linspace(0.0, np.pi, _DOWN + 1)
    ring = np.stack([np.cos(around), np.sin(around), np.zeros(_AROUND)], axis=1)
    pole = np.array([0.0, 0.0, 1.0])
    unit = np.sin(down)[:, None, None] * ring + np.cos(down)[:, None, None] * pole
    points = np.array([*drop.position, 0.0]) + drop.radius * unit.reshape(-1, 3)
    # points are numbered ring by ring, and the last cell of a ring closes it
    row, column = np.divmod(np.arange(_DOWN * _AROUND), _AROUND)
    right = (column + 1) % _AROUND
    upper = row * _AROUND
    lower = upper + _AROUND
    corners = [upper + column, lower + column, lower + right, upper + right]
    return points.astype(np.float32), np.stack(corners, axis=1).astype(np.int32)


def _surface(drop: Drop) -> tuple[NDArray[np.float32], NDArray[np.int32], Bools]:
    """Return points and cells of the plate's upper surface at rest, and a mask of the
    grid points on the plate.
    """
    x, y = np.meshgrid(drop.surface["x"], drop.surface["y"])
    on_plate = np.isfinite(drop.surface["height"][0])
    number = np.cumsum(on_plate.ravel()).reshape(on_plate.shape) - 1
    squares = [part.ravel() for part in _corners(on_plate)]
    inside = np.logical_and.reduce(squares)
    cells = np.stack([part.ravel()[inside] for part in _corners(number)], axis=1)
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)[on_plate.ravel()]
    return points.astype(np.float32), cells.astype(np.int32), on_plate.ravel()


def _corners(grid: NDArray[np.generic]) -> Iterator[NDArray[np.generic]]:
    """Yield the values of a grid at the four corners of its cells, in cyclic order."""
    yield from (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1])


def _box(size: tuple[float, float, float], moved: Floats) -> bytes:
    """Return a rigid plate as one brick that has moved (3,) [m]; at rest its upper
    surface is z = 0.
    """
    corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    points = np.array([(x, y, z) for z in (-1.0, 0.0) for x, y in corners]) * np.array(size) + moved
    return _file(points.astype(np.float32), np.arange(8, dtype=np.int32)[None, :], _BRICK, {})


def _notes(drop: Drop) -> list[str]:
    place = "at rest" if drop.motion is None else "in its mean position"
    notes = [
        "The sphere is drawn round, even where it deforms, at its true height above the "
        f"plate {place} (z = 0)."
    ]
    if drop.oblique is not None:
        notes.append("It moves along the plate, and does not turn; its spin is in the history.")
    if drop.surface:
        notes.append(
            "The frames are those of the result folder, from shortly before the first touch "
            "on; plate.pvd is drawn flat:"
        )
        notes[-1] += " apply Warp By Vector to displacement_m, which is small."
    elif drop.plate_size is None:
        notes.append("The case gives no size of the plate, so the sphere is written alone.")
    elif "plate" in drop.elastic:
        notes.append("The plate is written flat: the result does not contain its deflection.")
    return notes


FORMAT = ExportFormat(
    name="vtu",
    program="ParaView, VTK, PyVista",
    files="sphere.pvd and plate.pvd with a .vtu file for each frame; a plate at rest without its "
    "deflection is plate.vtu",
    tested="read back with meshio 5.3: points, cells and displacements the same",
    write=write,
    notes=_notes,
)
