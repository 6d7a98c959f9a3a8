"""Deflection of the plate's upper side at selected times, sampled on a regular grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.results.surface_grid import POINTS, SurfaceGrid, surface_grid

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response
    from vibroimpact.structures.modal_model import ModalModel


_FRAMES = 96
"""Number of frame times, at most."""
_IN_VISIT = 20
"""Frames during the first visit."""
_PER_PERIOD = 24
"""Frames per period of the lowest mode, at the largest step."""
_GROWTH = 1.15
"""Ratio of successive steps after the first visit."""


@dataclass(frozen=True)
class Deflection:
    """Vertical displacement of the plate's upper side at selected times.

    Parameters
    ----------
    time : array, shape (frames,)
        Times since the start of the run [s].
    x, y : array, shape (columns,) and (rows,)
        Grid coordinates in the plate's own coordinate system [m].
    height : array, shape (frames, rows, columns)
        Displacement of the upper side, positive upwards [m], in single precision; NaN at grid
        points outside the plate.
    sphere_position : array, shape (frames,)
        Height of the sphere's centre above the plate's upper surface at rest [m].
    contact_deflection : array, shape (frames,)
        Displacement of the plate at the contact point, positive upwards [m].
    contact : tuple of two floats
        x and y of the contact point [m].
    """

    time: Floats
    x: Floats
    y: Floats
    height: NDArray[np.float32]
    sphere_position: Floats
    contact_deflection: Floats
    contact: tuple[float, float]


def frame_times_of(response: Response, frames: int = _FRAMES) -> Floats:
    """Return the frame times of a run [s], from just before the first touch on.

    There are none without an impact or without modes. The period that spaces the last frames is
    that of the lowest mode of the plate, or of the sphere if the plate has no modes.
    """
    problem = response.problem
    impacts = response.impacts
    modes = problem.plate.modes or problem.sphere.modes
    if modes is None or not len(impacts["impact"]):
        return np.zeros(0)
    touch = float(impacts["time_s"][0])
    duration = float(impacts["duration_s"][0])
    period = 1.0 / float(modes.frequencies[0])
    return frame_times(touch, duration, period, float(response.end_time[0]), frames)


def deflection_of(response: Response, frames: int = _FRAMES) -> Deflection | None:
    """Return the plate's deflection at the frame times of a run.

    It is None if the plate has no modal model with a mesh, or no impact occurs.
    """
    model = response.problem.models.get("plate")
    time = frame_times_of(response, frames)
    if model is None or not len(time):
        return None

    def shapes_on_grid() -> tuple[SurfaceGrid, Floats]:
        # once per mode: the deflection at any time is then a product with the modal coordinates
        grid = surface_grid(model.mesh)
        vertical = model.shapes.reshape(len(model.shapes), len(model.mesh.nodes), -1)[:, :, 2]
        return grid, grid.interpolate(vertical).reshape(len(vertical), -1)

    grid, shapes = model.cached("vertical displacement on a grid", shapes_on_grid, POINTS)
    height = response.modal(time)["plate"] @ shapes
    motion = response.problem.motion  # of the supports, which carry the plate along
    if motion is not None:
        height += motion.direction[2] * motion.at(time)[0][:, None]
    history = response.at(time, ("position_m", "plate_deflection_m"))
    return Deflection(
        time=time,
        x=grid.x,
        y=grid.y,
        height=height.reshape(len(time), *grid.on_body.shape).astype(np.float32),
        sphere_position=history["position_m"],
        contact_deflection=history["plate_deflection_m"],
        contact=contact_point_of(response, model),
    )


def contact_point_of(response: Response, model: ModalModel) -> tuple[float, float]:
    """Return x and y of the contact point in the coordinates of the plate's mesh [m].

    It is the middle of the plate if the case gives none.
    """
    from vibroimpact.structures.finite_elements.surface import (
        place_of,  # here, as it imports scipy.sparse
    )

    source = response.problem.source or {}
    mesh = source.get("plate", {}).get("mesh")
    contact = mesh.get("contact") if isinstance(mesh, dict) else None
    position = contact or source.get("drop", {}).get("position") or (0.0, 0.0)
    # text names a group of nodes of the mesh
    point = position if isinstance(position, str) else (position[0], position[1])
    x, y = place_of(model.mesh, point, "upper")
    return x, y


def frame_times(touch: float, duration: float, period: float, end: float, count: int) -> Floats:
    """Return frame times [s]: equally spaced through the first visit, then ever sparser.

    After the visit the steps grow geometrically up to a limit.

    Parameters
    ----------
    touch, duration : float
        Time of first touch and duration of the first visit [s].
    period : float
        Period of the lowest mode [s].
    end : float
        End of the run [s].
    count : int
        Number of frames; times outside the run are dropped.

    Examples
    --------
    >>> frame_times(1.0, 1e-3, 0.1, 2.0, 96)[[0, 2, 22, -1]].round(4).tolist()
    [0.9999, 1.0, 1.001, 1.1925]
    """
    # a sphere that stays has no release to bound the duration
    step = min(duration, 3.0 * period) / _IN_VISIT
    in_visit = touch + step * np.arange(-2, _IN_VISIT + 3)
    largest_step = max(step, period / _PER_PERIOD)
    steps = np.minimum(step * _GROWTH ** np.arange(count - len(in_visit)), largest_step)
    times = np.concatenate([in_visit, in_visit[-1] + np.cumsum(steps)])
    return np.asarray(times[(times >= 0.0) & (times <= end)])
