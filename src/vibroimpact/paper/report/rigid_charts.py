"""Figures 4 to 8: the rigid sphere on the rigid plate, by the theory and by Adams' IMPACT
with constant and variable damping.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import history_column
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.impact_views import impact_views, longest_contact, response_line
from vibroimpact.paper.runs import Runs
from vibroimpact.runs.chart_data import MARGIN
from vibroimpact.units.display import digits, fixed, text

THEORY = "theory"
CONSTANT = "constant damping"
VARIABLE = "variable damping"
_CASES = {THEORY: "type1-theory", CONSTANT: "type1-constant", VARIABLE: "type1-variable"}
_ROLES = {THEORY: "under", CONSTANT: "series 1", VARIABLE: "series 2"}


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
        Column of the impact table in which the simulations are compared with the theory, and its
        description.
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


def rigid_chart(content: RigidFigure, runs: Runs) -> Chart:
    """Return a figure of the rigid model: the whole run, and each contact as a view in which the
    first touches coincide.

    Parameters
    ----------
    content : RigidFigure
        The figure.
    runs : Runs
        The simulations.
    """
    responses = {name: runs.response(_CASES[name]) for name in content.shown}
    several = list(responses.values())

    def shown(impact: int) -> tuple[float, float]:
        longest = longest_contact(several, impact)
        return MARGIN * longest, (1.0 + MARGIN) * longest

    touch = float(several[0].problem.sphere.contact_offset)
    if content.column == "position_m":
        views = impact_views(several, shown, touch, "From first touch")
    else:
        views = impact_views(several, shown)
    timeline = history_column(content.column)
    lines = tuple(
        response_line(timeline, response, views, name, _ROLES[name])
        for name, response in responses.items()
    )
    panel = Panel(Axis("Time", "s", views=views), Axis(_axis_label(content), content.unit), lines)
    title = (
        f"Figure {content.number}: {content.quantity}, {', '.join(content.shown[:-1])} and "
        f"{content.shown[-1]}"
    )
    return Chart(f"fig{content.number}", title, ((panel,),), _caption(responses, content))


def _axis_label(content: RigidFigure) -> str:
    """Return the axis label of the quantity."""
    return content.quantity.removesuffix(" of the sphere's centre").capitalize()


def _caption(responses: Responses, content: RigidFigure) -> str:
    off = {
        name: _differences(responses, name, content.compared)
        for name in content.shown
        if name != THEORY
    }
    said = " and ".join(
        f"{fixed(part.min(), 2)} to {fixed(part.max(), 2)} % with {name}"
        for name, part in off.items()
    )
    return " ".join(
        (
            f"Beside the theory the {content.peak} differs by {said}.",
            *(note(responses) for note in content.notes),
        )
    )


def _differences(responses: Responses, name: str, column: str) -> Floats:
    """Return the difference of a column from the theory for each impact [%]."""
    return np.asarray(
        100.0 * (responses[name].impacts[column] / responses[THEORY].impacts[column] - 1.0)
    )


def _last_impact_note(responses: Responses) -> str:
    """Return the sentence on the start of the last impact relative to the theory."""
    begins = {name: float(response.impacts["time_s"][-1]) for name, response in responses.items()}
    later = {name: time - begins[THEORY] for name, time in begins.items() if name != THEORY}
    differences = []
    for name, time in later.items():
        side = "late" if time > 0.0 else "early"
        differences.append(f"{text(abs(time), 's', 2)} {side} with {name}")
    return f"The last impact begins {' and '.join(differences)}."


def _fourth_rebound_note(responses: Responses) -> str:
    off = _differences(responses, CONSTANT, "rebound_height_m")[3]
    value = printed("constant.height_error.4")
    return (
        f"After the fourth impact the height differs by {fixed(off, 2)} %; the paper prints "
        f"{value.text} % as its error."
    )


def _acceleration_note(responses: Responses) -> str:
    first = (
        f"{digits(float(response.impacts['max_acceleration_m_s2'][0]))} m/s² ({name})"
        for name, response in responses.items()
    )
    return (
        f"In the first impact it is {', '.join(first)}; the paper prints "
        f"{printed('type1.max_acceleration').text} m/s²."
    )


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
    RigidFigure(
        5,
        "position of the sphere's centre",
        "position_m",
        "m",
        "rebound_height_m",
        "rebound height",
        notes=(_last_impact_note,),
    ),
    RigidFigure(6, "contact force", "force_N", "N", "max_force_N", "largest force"),
    RigidFigure(
        7,
        "velocity of the sphere's centre",
        "velocity_m_s",
        "m/s",
        "separation_speed_m_s",
        "speed of separation",
    ),
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
