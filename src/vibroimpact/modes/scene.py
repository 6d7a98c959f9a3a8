"""The modes of a plate in motion: what the page draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.modes.plate_shapes import is_in_plane, sensor_places
from vibroimpact.modes.supports import support_outlines
from vibroimpact.modes.titles import mode_title
from vibroimpact.results.surface_grid import surface_grid

_HEIGHT = 0.12
"""Largest drawn displacement, relative to the longer side of the plate."""


def mode_scene(body: BodyModes, number: int) -> dict[str, Any] | None:
    """Return what a page draws of the first modes of a plate in motion; None if all of them are in
    its plane.

    Parameters
    ----------
    body : BodyModes
        The plate.
    number : int
        Number of modes.

    Returns
    -------
    dict, optional
        `x`, `y`: lines of the grid [m]; `modes`: name, period [s] and shape of each, scaled so that
        it can be seen [m]; `exaggeration`, which is 1; `supports`: their outlines; `sensors`: their
        names and places.
    """
    mesh = body.model.mesh
    grid = surface_grid(mesh)
    size = _HEIGHT * float(max(np.ptp(grid.x), np.ptp(grid.y)))
    modes = []
    for mode in range(number):
        moved = body.model.displacements(mode)
        if not is_in_plane(moved):
            height = grid.interpolate(moved[:, 2])
            shape = (size / np.nanmax(np.abs(height)) * height).ravel()
            modes.append(
                {
                    "name": mode_title(body.model, mode),
                    "period": 1.0 / float(body.model.frequencies[mode]),
                    "shape": shape,
                }
            )
    return (
        {
            "x": grid.x,
            "y": grid.y,
            "modes": modes,
            "exaggeration": 1.0,
            "supports": [
                np.column_stack(outline)
                for outline in support_outlines(body.body.recipe.supports, mesh)
            ],
            "sensors": [{"name": name, "x": x, "y": y} for name, x, y in sensor_places(body)],
        }
        if modes
        else None
    )
