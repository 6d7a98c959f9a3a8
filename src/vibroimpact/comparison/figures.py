"""The figures of a comparison: one drop under several laws, in common axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vibroimpact.arrays import Floats
from vibroimpact.report.layout import label_vertical, new_figure, wide_axes
from vibroimpact.report.style import LOOPS, style
from vibroimpact.results.result import Result
from vibroimpact.runs.figure_data import contact_history, contacts_with_duration, decimated
from vibroimpact.units.display import multiple

_HEIGHT, _LINE = 3.6, 0.2
"""Height of the axes, and of a row of the legend [in]."""

_LEGEND_COLUMNS = 3
"""Entries in a row of the legend."""

_LABEL = 0.036
"""Height of a label in units of restitution, for the spacing of labels."""


def draw_comparison(results: Mapping[str, Result], speeds: Floats, restitutions: Mapping[str, Floats]) -> dict[str, Figure]:
    """Draw the figures of a comparison.

    Parameters
    ----------
    results : mapping of str to Result
        The result under each law.
    speeds : array, shape (S,)
        Approach speeds [m/s].
    restitutions : mapping of str to array, shape (S,)
        Restitution that each law achieves at these speeds.

    Returns
    -------
    dict of str to Figure
        `position`, `force`, `force_indentation` and `restitution`; the two of force only if a law has one.
    """
    styles = {name: _line_style(number) for number, name in enumerate(results)}
    forceful = {name: one for name, one in results.items() if len(contacts_with_duration(one))}
    with style():
        figures = {"position": _draw_positions(results, styles)}
        if forceful:
            figures["force"] = _draw_first_contacts(forceful, styles, "time_s", "s", "Time since first touch")
            figures["force_indentation"] = _draw_first_contacts(forceful, styles, "indentation_m", "m", "Indentation")
        figures["restitution"] = _draw_restitutions(results, styles, speeds, restitutions)
    return figures


def _draw_positions(results: Mapping[str, Result], styles: Mapping[str, Any]) -> Figure:
    figure, axes = _axes(len(results))
    scale = multiple("m", [one.history["position_m"].max() for one in results.values()])
    clock = multiple("s", [one.history["time_s"][-1] for one in results.values()])
    end = max(one.history["time_s"][-1] for one in results.values())
    for name, one in results.items():
        time, height = one.history["time_s"], one.history["position_m"]
        if one.status.startswith("At rest"):  # the history ends at rest; extend the line to the longest run
            time, height = np.append(time, end), np.append(height, height[-1])
        axes.plot(*decimated(time / clock.size, height / scale.size), label=name, **styles[name])
    axes.set_title("Height of the sphere's centre")
    axes.set_xlabel(f"Time [{clock.unit}]")
    label_vertical(axes, f"Height above the plate [{scale.unit}]")
    return _with_legend(figure, axes)


def _draw_first_contacts(results: Mapping[str, Result], styles: Mapping[str, Any], column: str, unit: str, label: str) -> Figure:
    figure, axes = _axes(len(results))
    parts = {name: contact_history(one, contacts_with_duration(one)[0]) for name, one in results.items()}
    for name, one in results.items():
        parts[name]["time_s"] = parts[name]["time_s"] - one.impacts["time_s"][contacts_with_duration(one)[0]]
    across = multiple(unit, np.concatenate([part[column] for part in parts.values()]))
    force = multiple("N", np.concatenate([part["force_N"] for part in parts.values()]))
    for name, part in parts.items():
        axes.plot(part[column] / across.size, part["force_N"] / force.size, label=name, **styles[name])
    axes.set_title("Contact force over time, first impact" if unit == "s" else "Contact force over indentation, first impact")
    axes.set_xlabel(f"{label} [{across.unit}]")
    label_vertical(axes, f"Contact force [{force.unit}]")
    return _with_legend(figure, axes)


def _draw_restitutions(
    results: Mapping[str, Result], styles: Mapping[str, Any], speeds: Floats, restitutions: Mapping[str, Floats]
) -> Figure:
    figure, axes = _axes(len(results))
    for name, one in results.items():
        axes.semilogx(speeds, restitutions[name], label=name, **styles[name])
        impacts = one.impacts
        axes.plot(
            impacts["approach_speed_m_s"], impacts["restitution_achieved"], "o", markersize=3.5, color=styles[name]["color"], zorder=3
        )
    _mark_asked(axes, results)
    axes.set_ylim(0.0, 1.05)
    axes.set_title("Restitution achieved (lines: any speed, without gravity; marks: this run)")
    axes.set_xlabel("Approach speed [m/s]")
    label_vertical(axes, "Separation speed over approach speed")
    return _with_legend(figure, axes)


def _mark_asked(axes: Axes, results: Mapping[str, Result]) -> None:
    """Draw a line at each required restitution, with a label that does not overlap the others."""
    first = (float(one.impacts["restitution_asked"][0]) for one in results.values() if len(one.impacts["restitution_asked"]))
    asked = sorted({float(f"{value:.4g}") for value in first if np.isfinite(value)})
    for value, place in zip(asked, spread_labels(asked, _LABEL), strict=True):
        axes.axhline(value, color="#888888", linewidth=0.8, linestyle=(0, (1, 2)))
        axes.annotate(f"asked {value:.4g}", (1.0, place), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=7.5)


def spread_labels(places: Sequence[float], gap: float) -> list[float]:
    """Return ascending positions moved upwards as little as needed to keep a minimum gap.

    Examples
    --------
    >>> [round(place, 3) for place in spread_labels([0.1, 0.7, 0.716, 0.72], 0.04)]
    [0.1, 0.7, 0.74, 0.78]
    """
    found: list[float] = []
    for place in places:
        found.append(max(place, found[-1] + gap) if found else place)
    return found


def _axes(number: int) -> tuple[Figure, Axes]:
    room = _LINE * -(-number // _LEGEND_COLUMNS) + 0.1
    figure = new_figure(_HEIGHT + 0.85 + room)
    return figure, wide_axes(figure, 0.5 + room, _HEIGHT)


def _with_legend(figure: Figure, axes: Axes) -> Figure:
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=_LEGEND_COLUMNS, handlelength=4.0)
    return figure


def _line_style(number: int) -> dict[str, Any]:
    colour, dashes = LOOPS[number % len(LOOPS)]
    return {"color": colour, "linestyle": dashes, "linewidth": 1.5 if number < len(LOOPS) else 0.9}
