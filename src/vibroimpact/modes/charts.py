"""Charts of the modes of a case: the first shapes of each elastic body."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.modes.plate_shapes import plate_panels
from vibroimpact.modes.solid_shapes import solid_panels
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.units.display import brief

MOST_SHAPES = 12
_COLUMNS = 4
_FLAT = 0.25
"""Thickness over width below which a body is drawn as a plate."""

_WIDTH = 1.9
_TITLE = 0.3
"""Width of a shape, and height of its title [in]."""


def mode_charts(modes: Mapping[str, BodyModes]) -> list[Chart]:
    """Return the charts of the modes of a case: for each body its first shapes, up to twelve.

    Parameters
    ----------
    modes : mapping of str to BodyModes
        Modes of its bodies, from `compute_modes`.

    Returns
    -------
    list of Chart
        `sphere_modes` and `plate_modes`, of the bodies that are elastic.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> modes = vi.compute_modes(vi.load_case("paper:type2", {"sphere.modes": 5}))
    >>> [(chart.name, len(chart.panels)) for chart in mode_charts(modes)]
    [('sphere_modes', 8)]
    """
    return made_charts(
        {f"{name}_modes": partial(_chart, name, body) for name, body in modes.items()}
    )


def is_plate(model: ModalModel) -> bool:
    """Return whether a body is so thin that it is shown from above."""
    extent = model.mesh.extent
    return model.mesh.is_flat or bool(extent[2] < _FLAT * extent[:2].min())


def _chart(name: str, body: BodyModes) -> Chart:
    model = body.model
    number = min(MOST_SHAPES, len(body.model.frequencies))
    extent = model.mesh.extent
    if is_plate(model):
        panels = plate_panels(body, number)
        way = "up"
        size = f"{brief(extent[0], 'm')} \u00d7 {brief(extent[1], 'm')}"
        meaning = "Red is up, blue is down, and the thick line is at rest."
        shape = float(np.clip(extent[1] / extent[0], 0.3, 1.5))
    else:
        panels = solid_panels(model, number)
        way = "outwards"
        size = f"{brief(extent.max(), 'm')} large"
        meaning = (
            "Red is outwards, blue is inwards; where it only twists, what is lighter moves "
            "more. Dashed: at rest."
        )
        shape = 1.0
    number = len(panels)
    columns = min(_COLUMNS, number)
    blank = Panel(panels[0].x, panels[0].y, (), picture=True)
    panels += [blank] * (-number % columns)
    rows = tuple(tuple(panels[start : start + columns]) for start in range(0, len(panels), columns))
    if number > 1:
        title = f"Modes of the {name}"
        count = f"{number} of {len(model.frequencies)}"
        drawn = f"The first {count} modes, each drawn as large as the others"
    else:
        title = f"The mode of the {name}"
        drawn = "The lowest mode"
    caption = f"{drawn}; which way is {way} is arbitrary."
    return Chart(
        f"{name}_modes",
        title,
        rows,
        caption,
        _WIDTH * shape + _TITLE,
        f"The {name} is {size}. {meaning}",
    )
