"""Figures 4 to 8: the rigid sphere on the rigid plate, by the theory and by Adams' IMPACT with constant and variable damping."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.drawing import LINE_STYLES, Drawing
from vibroimpact.paper.runs import Runs, history_of
from vibroimpact.report.layout import heading, label_vertical, new_figure, row_of_axes, wide_axes
from vibroimpact.runs.figure_data import MARGIN, decimated, history_window
from vibroimpact.units.display import digits, fixed, largest, multiple, text

THEORY, CONSTANT, VARIABLE = "theory", "constant damping", "variable damping"
_CASES = {THEORY: "type1-theory", CONSTANT: "type1-constant", VARIABLE: "type1-variable"}
_RUN_HEIGHT, _CONTACTS_HEIGHT, _LEGEND = 2.9, 2.2, 0.3
"""Heights of the whole run, the contacts and the legend [in]."""


Responses = Mapping[str, Response]
"""Responses by the name of their curve."""


class RigidFigure(NamedTuple):
    """A figure of the rigid model.

    Parameters
    ----------
    number : int
        Number of the figure in the paper.
    quantity, column, unit : str
        Quantity, its column of the history, and its SI unit.
    compared, peak : str
        Column of the impact table in which the simulations are compared with the theory, and its description.
    shown : tuple of str
        Names of the curves.
    notes : tuple of callables
        Functions of the responses that return further sentences of the caption.
    """

    number: int
    quantity: str
    column: str
    unit: str
    compared: str
    peak: str
    shown: tuple[str, ...] = (THEORY, CONSTANT, VARIABLE)
    notes: tuple[Callable[[Responses], str], ...] = ()


def draw_rigid(content: RigidFigure, runs: Runs) -> Drawing:
    """Draw a figure of the rigid model: the whole run, and each contact enlarged.

    Parameters
    ----------
    content : RigidFigure
        The figure.
    runs : Runs
        The simulations.
    """
    responses = {name: runs.response(_CASES[name]) for name in content.shown}
    figure = new_figure(_RUN_HEIGHT + _CONTACTS_HEIGHT + _LEGEND)
    axes = wide_axes(figure, _CONTACTS_HEIGHT + _LEGEND + 0.5, _RUN_HEIGHT - 0.75)
    _draw_run(axes, responses, content)
    _draw_contacts(figure, responses, content)
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=len(responses), handlelength=4.5)
    title = f"Figure {content.number}: {content.quantity}, {', '.join(content.shown[:-1])} and {content.shown[-1]}"
    return Drawing(figure, title, _caption(responses, content))


def _draw_run(axes: Axes, responses: Responses, content: RigidFigure) -> None:
    scale = multiple(content.unit, [largest(history_of(response)[content.column]) for response in responses.values()])
    for (name, response), style in zip(responses.items(), LINE_STYLES, strict=False):
        history = history_of(response)
        axes.plot(*decimated(history["time_s"], history[content.column] / scale.size), label=name, **style)
    axes.set_title(f"{content.quantity[0].upper()}{content.quantity[1:]}: whole run")
    axes.set_xlabel("Time [s]")
    label_vertical(axes, f"{_axis_label(content)} [{scale.unit}]")
    axes.margins(x=0.01, y=0.06)


def _draw_contacts(figure: Figure, responses: Responses, content: RigidFigure) -> None:
    number = min(len(response.impacts["time_s"]) for response in responses.values())
    parts = {name: [_contact(response, impact, content.column) for impact in range(number)] for name, response in responses.items()}
    scale = multiple(content.unit, np.concatenate([values for lines in parts.values() for _, values in lines]))
    row = row_of_axes(figure, number, _LEGEND + 0.45, _CONTACTS_HEIGHT - 1.05)
    for impact, axes in enumerate(row):
        for name, style in zip(responses, LINE_STYLES, strict=False):
            time, values = parts[name][impact]
            axes.plot(time / 1e-3, values / scale.size, **style)
        axes.margins(x=0.0, y=0.08)
        axes.xaxis.set_major_locator(MaxNLocator(2, steps=[1, 2, 5, 10]))
        axes.yaxis.set_major_locator(MaxNLocator(4, min_n_ticks=3, steps=[1, 2, 2.5, 5, 10]))
        axes.set_title(f"Impact {impact + 1}", fontsize=8.5)
    since = ": height above that of first touch" if content.column == "position_m" else ""
    label_vertical(row[0], f"{_axis_label(content)} [{scale.unit}]")
    figure.text(0.5, (_LEGEND + 0.04) / figure.get_figheight(), "Time since first touch of each contact [ms]", ha="center", va="bottom")
    heading(figure, f"Each contact enlarged{since}", _LEGEND + _CONTACTS_HEIGHT - 0.28)


def _contact(response: Response, impact: int, column: str) -> tuple[Floats, Floats]:
    """Return a column around a contact over the time since first touch [s]; positions relative to that of first touch."""
    touch, duration = (float(response.impacts[name][impact]) for name in ("time_s", "duration_s"))
    part = history_window(history_of(response), touch - MARGIN * duration, touch + (1.0 + MARGIN) * duration)
    base = float(response.problem.sphere.contact_offset) if column == "position_m" else 0.0
    return part["time_s"] - touch, part[column] - base


def _axis_label(content: RigidFigure) -> str:
    """Return the axis label of the quantity."""
    return content.quantity.removesuffix(" of the sphere's centre").capitalize()


def _caption(responses: Responses, content: RigidFigure) -> str:
    off = {name: _differences(responses, name, content.compared) for name in content.shown if name != THEORY}
    said = " and ".join(f"{fixed(part.min(), 2)} to {fixed(part.max(), 2)} % with {name}" for name, part in off.items())
    return " ".join((f"Beside the theory the {content.peak} differs by {said}.", *(note(responses) for note in content.notes)))


def _differences(responses: Responses, name: str, column: str) -> Floats:
    """Return the difference of a column from the theory for each impact [%]."""
    return np.asarray(100.0 * (responses[name].impacts[column] / responses[THEORY].impacts[column] - 1.0))


def _last_impact_note(responses: Responses) -> str:
    """Return the sentence on the start of the last impact relative to the theory."""
    begins = {name: float(response.impacts["time_s"][-1]) for name, response in responses.items()}
    later = {name: time - begins[THEORY] for name, time in begins.items() if name != THEORY}
    told = (f"{text(abs(time), 's', 2)} {'late' if time > 0.0 else 'early'} with {name}" for name, time in later.items())
    return f"The last impact begins {' and '.join(told)}."


def _fourth_rebound_note(responses: Responses) -> str:
    off = _differences(responses, CONSTANT, "rebound_height_m")[3]
    value = printed("constant.height_error.4")
    return f"After the fourth impact the height differs by {fixed(off, 2)} %; the paper prints {value.text} % as its error."


def _acceleration_note(responses: Responses) -> str:
    first = (f"{digits(float(response.impacts['max_acceleration_m_s2'][0]))} m/s² ({name})" for name, response in responses.items())
    return f"In the first impact it is {', '.join(first)}; the paper prints {printed('type1.max_acceleration').text} m/s²."


RIGID_FIGURES = (
    RigidFigure(
        4,
        "position of the sphere's centre",
        "position_m",
        "m",
        "rebound_height_m",
        "rebound height",
        (THEORY, CONSTANT),
        (_last_impact_note, _fourth_rebound_note),
    ),
    RigidFigure(5, "position of the sphere's centre", "position_m", "m", "rebound_height_m", "rebound height", notes=(_last_impact_note,)),
    RigidFigure(6, "contact force", "force_N", "N", "max_force_N", "largest force"),
    RigidFigure(7, "velocity of the sphere's centre", "velocity_m_s", "m/s", "separation_speed_m_s", "speed of separation"),
    RigidFigure(
        8,
        "acceleration of the sphere's centre",
        "acceleration_m_s2",
        "m/s2",
        "max_acceleration_m_s2",
        "largest acceleration",
        notes=(_acceleration_note,),
    ),
)
