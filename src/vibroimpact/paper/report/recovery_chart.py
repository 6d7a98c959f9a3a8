"""The chart of restitution and full-damping penetration: each piece of evidence as a line
with a band, and the joint estimate.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Band, Level, Line, Mark, Points, Spans
from vibroimpact.charts.palette import series
from vibroimpact.paper.evidence import PENETRATIONS, RESTITUTIONS, Evidence
from vibroimpact.paper.printed import printed
from vibroimpact.paper.recovery import (
    RecoveredParameters,
    implied_restitution,
    off_joint,
    penetration_bands,
    recover_parameters,
)
from vibroimpact.paper.runs import Runs

_ZOOM = (2.0e-4, 1.2e-7)
"""Half-widths of the enlarged window around the joint estimate: restitution [-],
penetration [m].
"""

_SEARCH_MARGIN = 20.0
"""Margin of the searched restitutions around the window, in half-widths of the band."""

_POINTS = 401
_ROWS = 121


class _Window(NamedTuple):
    """A window of the plane: ranges of the restitution [-] and of the penetration [m]."""

    restitutions: tuple[float, float]
    penetrations: tuple[float, float]


def recovery_chart(runs: Runs) -> Chart:
    """Return the chart of the restitution over the full-damping penetration that each printed
    number implies.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    recovered = recover_parameters(runs)
    e = recovered.restitution
    d = recovered.penetration
    given = printed("full_damping_penetration").value
    zoom_e, zoom_d = _ZOOM
    close = _Window(
        (e.value - zoom_e, e.value + zoom_e),
        (d.value - zoom_d, d.value + zoom_d),
    )
    searched = _Window(RESTITUTIONS, PENETRATIONS)
    joint = Points(np.array([d.value]), np.array([e.value]), "joint estimate", "mark")
    with_deviation = replace(
        joint,
        low=np.array([e.value - e.deviation]),
        high=np.array([e.value + e.deviation]),
    )
    deviation_of_d = d.value + d.deviation * np.array([-1.0, 1.0])
    round_e, round_d = recovered.round_values
    estimate: tuple[Mark, ...] = (
        Points(np.array([round_d]), np.array([round_e]), "round values", "total"),
        Line(deviation_of_d, np.full(2, e.value), role="mark"),
        with_deviation,
    )
    as_printed = Level(given, f"d_max as printed, {1e6 * given:g} µm", "dotted", upright=True)
    panels = (
        _panel(recovered, searched, (as_printed, joint), "All that was searched"),
        _panel(recovered, close, estimate, "Where they cross, enlarged"),
    )
    caption = (
        "Each piece of evidence but Table 2 is a line in the plane of e_h and d_max, with a "
        "band as wide as rounding or its own scatter "
        f"allows, where it is not wider than the picture. {_caption(recovered)}"
    )
    return Chart(
        "recovery",
        "What the printed numbers imply: restitution and full-damping penetration",
        (panels,),
        caption,
        3.4,
    )


def _panel(
    recovered: RecoveredParameters, window: _Window, marks: tuple[Mark, ...], title: str
) -> Panel:
    log = window.penetrations[1] > 10.0 * window.penetrations[0]
    across = Axis("Full-damping penetration d_max", "m", log=log, range=window.penetrations)
    return Panel(
        across,
        Axis("Restitution asked for, e_h", range=window.restitutions),
        (*_lines(recovered, window), *marks),
        title,
    )


def _drawn_evidence(recovered: RecoveredParameters) -> list[Evidence]:
    """Return the evidence to draw: that without sampling bias."""
    return [evidence for evidence in recovered.evidence if not evidence.sampled]


def _caption(recovered: RecoveredParameters) -> str:
    """Return the sentences on the distances of the joint estimate and of the printed
    penetration from the bands.
    """
    off = [off_joint(recovered, evidence) for evidence in _drawn_evidence(recovered)]
    given = printed("full_damping_penetration").value
    met = penetration_bands(recovered, given)
    return (
        f"The joint estimate, e_h = {recovered.restitution.value:.4f} and d_max = "
        f"{1e6 * recovered.penetration.value:.2f} µm, lies in "
        f"{sum(distance <= 1.0 for distance in off)} of the {len(off)} bands, and from no line "
        f"farther than {max(off):.1f} times half the width of "
        f"its band; the printed {1e6 * given:g} µm lies in {sum(met) or 'none'} of the "
        f"{len(met)} bands that depend on d_max alone."
    )


def _lines(recovered: RecoveredParameters, window: _Window) -> list[Mark]:
    """Return the lines of the evidence in a window, with their bands below them."""
    (low, high) = window.restitutions
    penetrations = np.geomspace(*window.penetrations, _ROWS)
    bands: list[Mark] = []
    lines: list[Mark] = []
    for number, evidence in enumerate(_drawn_evidence(recovered)):
        restitution_alone, penetration_alone = recovered.alone[evidence.name]
        role = series(number)
        if restitution_alone is None and penetration_alone is not None:
            value = penetration_alone.value
            half = evidence.half_width * penetration_alone.deviation
            begin = np.array([value - half])
            end = np.array([value + half])
            bands.append(Spans(begin, end, role=f"{role} band"))
            lines.append(Level(value, evidence.name, role, upright=True))
        elif restitution_alone is not None:
            half = evidence.half_width * restitution_alone.deviation
            # beyond the window, as a minimum at an end of the grid would not be found
            margin = _SEARCH_MARGIN * half
            least = max(RESTITUTIONS[0], low - margin)
            largest = min(RESTITUTIONS[1], high + margin)
            restitutions = np.linspace(least, largest, _POINTS)
            line = implied_restitution(evidence, restitutions, penetrations)
            if half < 0.5 * (high - low):  # a wider band would only tint the background
                bands.append(Band(penetrations, line - half, line + half, role=f"{role} band"))
            lines.append(Line(penetrations, line, evidence.name, role))
    return bands + lines
