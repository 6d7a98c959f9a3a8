"""How the plate's upper side is deflected at chosen times, on a regular grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.results.surface_grid import surface_grid

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response
    from vibroimpact.structures.modal_model import ModalModel


_FRAMES = 96


@dataclass(frozen=True)
class Deflection:
    """The plate's upper side at some times.

    Parameters
    ----------
    time : array, shape (frames,)
        Since the start [s].
    x, y : array, shape (columns,) and (rows,)
        Of the grid [m], as in the plate's own coordinates.
    height : array, shape (frames, rows, columns)
        Displacement of the upper side, upwards [m], single precision; NaN beside the plate.
    sphere_position : array, shape (frames,)
        Height of the sphere's centre above the plate's upper surface at rest [m].
    contact_deflection : array, shape (frames,)
        Displacement of the plate at the contact point, upwards [m].
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


def frame_times_of(response: Response) -> Floats:
    """Return times from just before the first touch on [s]; none if there is no impact, or nothing vibrates in modes."""
    problem, impacts = response.problem, response.impacts
    modes = problem.plate.modes or problem.sphere.modes
    if modes is None or not len(impacts["impact"]):
        return np.zeros(0)
    touch, duration = (float(impacts[name][0]) for name in ("time_s", "duration_s"))
    return frame_times(touch, duration, 1.0 / float(modes.frequencies[0]), float(response.end_time[0]), _FRAMES)


def deflection_of(response: Response) -> Deflection | None:
    """Return the deflection of the plate of a run; None if its mesh is not known, or it is never touched."""
    model, time = response.problem.models.get("plate"), frame_times_of(response)
    if model is None or not len(time):
        return None
    grid = surface_grid(model.mesh)
    vertical = model.shapes.reshape(len(model.shapes), len(model.mesh.nodes), -1)[:, :, 2]
    height = response.modal(time)["plate"] @ grid.interpolate(vertical).reshape(len(vertical), -1)
    history = response.at(time)
    return Deflection(
        time,
        grid.x,
        grid.y,
        height.reshape(len(time), *grid.on_body.shape).astype(np.float32),
        history["position_m"],
        history["plate_deflection_m"],
        contact_point_of(response, model),
    )


def contact_point_of(response: Response, model: ModalModel) -> tuple[float, float]:
    """Return x and y of the contact point in the coordinates of the plate's mesh [m]; its middle, if no case tells."""
    from vibroimpact.structures.surface import place_of  # which loads sparse matrices

    source = response.problem.source or {}
    mesh = source.get("plate", {}).get("mesh")
    spot = (mesh.get("contact") if isinstance(mesh, dict) else None) or source.get("drop", {}).get("position") or (0.0, 0.0)
    x, y = place_of(model.mesh, spot if isinstance(spot, str) else (spot[0], spot[1]), "upper")
    return x, y


_IN_VISIT = 20
"""Frames in the first visit."""
_PER_PERIOD = 24
"""Frames a period of the lowest mode, at the end."""
_GROWTH = 1.15
"""By how much each step is longer than the last, in between."""


def frame_times(touch: float, duration: float, period: float, end: float, count: int) -> Floats:
    """Return times from just before first touch on [s].

    Parameters
    ----------
    touch, duration : float
        The first visit [s].
    period : float
        Of the lowest mode [s].
    end : float
        When the run ends [s].
    count : int
        How many times; fewer where the run ends before.

    Examples
    --------
    >>> frame_times(1.0, 1e-3, 0.1, 2.0, 96)[[0, 2, 22, -1]].round(4).tolist()
    [0.9999, 1.0, 1.001, 1.1925]
    """
    step = min(duration, 3.0 * period) / _IN_VISIT  # a sphere that stays is never released
    in_visit = touch + step * np.arange(-2, _IN_VISIT + 3)
    steps = np.minimum(step * _GROWTH ** np.arange(count - len(in_visit)), max(step, period / _PER_PERIOD))
    times = np.concatenate([in_visit, in_visit[-1] + np.cumsum(steps)])
    return np.asarray(times[(times >= 0.0) & (times <= end)])
