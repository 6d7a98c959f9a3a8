"""The modes of a plate in motion: what the page draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.modes.plate_shapes import is_in_plane, sensor_places
from vibroimpact.modes.supports import held_nodes, support_outlines
from vibroimpact.modes.tables import mode_title
from vibroimpact.results.surface_grid import beyond_edge, surface_grid
from vibroimpact.structures.finite_elements.outline import outline

_HEIGHT = 0.12
"""Largest drawn displacement, relative to the longer side of the plate."""


def mode_scene(body: BodyModes, number: int) -> dict[str, Any] | None:
    """Return what a page draws of the first modes of a plate in motion.

    It is None if all of them are in its plane.

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
        names and places; of a plate that is no rectangle also `outline`, x and y of the
        closed lines around it [m], each followed by NaN, and
        `held`, the held nodes of sets.
    """
    model = body.model
    grid = surface_grid(model.mesh)
    amplitude = _HEIGHT * float(max(np.ptp(grid.x), np.ptp(grid.y)))
    outlined: dict[str, Any] = {}
    if not grid.on_body.all():
        outlined["outline"] = np.column_stack(outline(model.mesh))
        held = held_nodes(body.body.recipe.supports, model.mesh)
        outlined["held"] = held - [0.0, 0.0, float(model.mesh.nodes[:, 2].max())]
    modes = []
    for mode in range(number):
        displacements = model.displacements(mode)
        if not is_in_plane(displacements):
            height = grid.interpolate(displacements[:, 2])
            height *= amplitude / np.nanmax(np.abs(height))
            shape = height.ravel()
            if outlined:
                shape = beyond_edge(height).ravel()
            period = 1.0 / float(model.frequencies[mode])
            modes.append({"name": mode_title(model, mode), "period": period, "shape": shape})
    if not modes:
        return None
    outlines = support_outlines(body.body.recipe.supports, model.mesh)
    return {
        "x": grid.x,
        "y": grid.y,
        **outlined,
        "modes": modes,
        "exaggeration": 1.0,
        "supports": [np.column_stack(outline) for outline in outlines],
        "sensors": [{"name": name, "x": x, "y": y} for name, x, y in sensor_places(body)],
    }
