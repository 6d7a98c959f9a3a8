"""How the plate's upper side is deflected at chosen times, on a regular grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.results.frames import frame_times
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


def first_frames(response: Response) -> Floats:
    """Return times from just before the first touch on [s]; none if there is no impact, or nothing vibrates in modes."""
    problem, impacts = response.problem, response.impacts
    modes = problem.plate.modes or problem.sphere.modes
    if modes is None or not len(impacts["impact"]):
        return np.zeros(0)
    touch, duration = (float(impacts[name][0]) for name in ("time_s", "duration_s"))
    return frame_times(touch, duration, 1.0 / float(modes.frequencies[0]), float(response.end_time[0]), _FRAMES)


def deflection_of(response: Response) -> Deflection | None:
    """Return the deflection of the plate of a run; None if its mesh is not known, or it is never touched."""
    model, time = response.problem.models.get("plate"), first_frames(response)
    if model is None or not len(time):
        return None
    grid = surface_grid(model.mesh)
    vertical = model.shapes.reshape(len(model.shapes), len(model.mesh.nodes), -1)[:, :, 2]
    height = response.modal(time)["plate"] @ grid.of(vertical).reshape(len(vertical), -1)
    history = response.at(time)
    return Deflection(
        time,
        grid.x,
        grid.y,
        height.reshape(len(time), *grid.on_body.shape).astype(np.float32),
        history["position_m"],
        history["plate_deflection_m"],
        contact_place(response, model),
    )


def contact_place(response: Response, model: ModalModel) -> tuple[float, float]:
    """Return x and y of the contact point in the coordinates of the plate's mesh [m]; its middle, if no case tells."""
    from vibroimpact.structures.surface import place_of  # which loads sparse matrices

    source = response.problem.source or {}
    mesh = source.get("plate", {}).get("mesh")
    spot = (mesh.get("contact") if isinstance(mesh, dict) else None) or source.get("drop", {}).get("position") or (0.0, 0.0)
    x, y = place_of(model.mesh, spot if isinstance(spot, str) else (spot[0], spot[1]), "upper")
    return x, y
