"""The charts of a correlation: records over their simulation, what is left, frequency
responses, criteria and modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Bars, Line, Mark, Points, Rug
from vibroimpact.quoting import shortened, visible
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.criteria import Criteria
from vibroimpact.test_analysis.octaves import FEW

MOST = 8
"""Number of records drawn; all are in the tables."""
_HEIGHT = 2.8
_BEGIN = 6e-3
"""Time from the first touch on that is shown beside the whole [s]."""
_LOOKS = (("measured", "measured"), ("simulated", "fit"), ("residual", "difference"))
"""Names and roles of the lines of an overlay."""
_DECADES = 4.0
"""Decades below its peak down to which a response is shown."""


def correlation_charts(correlation: Correlation) -> list[Chart]:
    """Return the charts `overlay`, `responses`, `frac` and, if a damping was measured, `damping`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> record = vi.signals.Record("a1", vi.simulate(case).signals()["a1"].value, 25.6e3, "m/s2")
    >>> correlation = vi.test_analysis.correlate(case, [record], window=0.05)
    >>> [chart.name for chart in correlation_charts(correlation)]
    ['overlay', 'responses', 'frac', 'damping']
    """
    makers = {
        "overlay": partial(overlay_chart, correlation),
        "responses": partial(_responses, correlation),
        "frac": partial(frac_chart, correlation, what_frac_is_of(correlation)),
    }
    if any(pair.damping_measured for pair in correlation.modes):
        makers["damping"] = partial(damping_chart, correlation, "the decay of the records")
    return made_charts(makers)


def those_drawn(number: int) -> str:
    """Return, as the end of a caption, which of so many records are drawn; empty if all are."""
    if number <= MOST:
        return ""
    return f" The first {MOST} of {number} are drawn."


def _name(criteria: Criteria, number: int) -> str:
    return shortened(visible(criteria.sensors[number].name), 40)


def overlay_chart(correlation: Correlation) -> Chart:
    """Return the chart of the records over their simulation, with the difference."""
    begin = Axis("Time since first touch", "s")
    whole = Axis("Time since first touch", "s")
    rows: list[tuple[Panel, ...]] = []
    early = correlation.time <= max(_BEGIN, float(correlation.time[0]) + _BEGIN)
    for number, sensor in enumerate(correlation.sensors[:MOST]):
        level = Axis(sensor.quantity.capitalize(), sensor.unit)
        shown = (
            (begin, early, "first part"),
            (
                whole,
                slice(None),
                f"residual {100.0 * correlation.relative_residual[number]:.1f} % (rms)",
            ),
        )
        panels = []
        for axis, part, phrase in shown:
            values = (
                correlation.measured[number, part],
                correlation.simulated[number, part],
                correlation.residual[number, part],
            )
            lines = (
                Line(correlation.time[part], value, name, role)
                for value, (name, role) in zip(values, _LOOKS, strict=True)
            )
            panels.append(
                Panel(axis, level, tuple(lines), f"{_name(correlation, number)}: {phrase}")
            )
        rows.append(tuple(panels))
    caption = (
        f"Records, aligned in time by their first {1e3 * correlation.aligned:.3g} ms, the "
        "simulation, and the difference, within the band from "
        f"{correlation.band[0]:.4g} to {correlation.band[1]:.4g} Hz."
        f"{those_drawn(len(correlation.sensors))}"
    )
    return Chart("overlay", "Records and simulation", tuple(rows), caption, _HEIGHT)


def _responses(correlation: Correlation) -> Chart:
    axis = Axis("Frequency", "Hz", range=correlation.band)
    rows: list[tuple[Panel, ...]] = []
    computed = np.array([pair.frequency for pair in correlation.modes if pair.number is not None])
    if correlation.hits:
        title = "Frequency responses"
        what = "Frequency responses to the force (estimator H1)"
        quantity = "Magnitude"
        per_force = "/N"
    else:
        title = "Spectra"
        what = "Spectra of record and simulation"
        quantity = "Amplitude"
        per_force = ""
    for number, sensor in enumerate(correlation.sensors[:MOST]):
        lines, shown = magnitude_lines(
            correlation.frequency,
            (correlation.measured_response[number], correlation.simulated_response[number]),
        )
        scale = Axis(quantity, f"{sensor.unit}{per_force}", log=True, range=shown)
        marks: tuple[Mark, ...] = (*lines, Rug(computed, "modes of the case", "fit"))
        panels = [
            Panel(
                axis,
                scale,
                marks,
                f"{_name(correlation, number)}: FRAC {correlation.frac[number]:.3f}",
            )
        ]
        if correlation.coherence is not None:
            level = Axis("Coherence", range=(0.0, 1.02))
            panels.append(
                Panel(
                    axis,
                    level,
                    (Line(correlation.frequency, correlation.coherence[number], role="detail"),),
                    "Coherence of force and record",
                )
            )
        rows += [(panel,) for panel in panels]
    caption = (
        f"{what}, with the same window and spectral leakage. Ticks mark the modes of the "
        f"case.{those_drawn(len(correlation.sensors))}"
    )
    return Chart("responses", title, tuple(rows), caption, _HEIGHT)


def magnitude_lines(
    frequency: Floats, responses: Sequence[Complex], looks: Sequence[tuple[str, str]] = _LOOKS[:2]
) -> tuple[list[Line], tuple[float, float] | None]:
    """Return the lines of the magnitudes of responses, (bins,) each, and the range of their axis:
    decades below the largest peak.

    `looks`: names and roles of the lines.
    """
    sizes = [np.abs(response) for response in responses]
    most = max(float(size.max(initial=0.0)) for size in sizes)
    floor = 10.0**-_DECADES * most + 1e-300
    lines = [
        Line(frequency, np.maximum(size, 1e-3 * floor), name, role)
        for size, (name, role) in zip(sizes, looks, strict=True)
    ]
    shown = (floor, 2.0 * most) if most > 0.0 else None
    return lines, shown


def frac_chart(criteria: Criteria, of: str) -> Chart:
    """Return the chart of the criterion over octaves, of what is compared."""
    names = tuple(f"{low:.4g} to {high:.4g} Hz" for low, high in criteria.octaves)
    shown = criteria.octave_frac[:MOST]
    width = 0.8 / len(shown)
    marks = tuple(
        Bars(
            np.asarray(np.arange(len(names)) + (number - 0.5 * (len(shown) - 1)) * width),
            np.nan_to_num(values),
            _name(criteria, number),
            f"series {number}",
            width=width,
        )
        for number, values in enumerate(shown)
    )
    panel = Panel(Axis("Band", names=names), Axis("FRAC", range=(0.0, 1.0)), marks)
    caption = (
        f"Frequency response assurance criterion over each octave, of {of}. 1: equal except "
        f"for a factor; 0: uncorrelated. An octave with fewer than {FEW} frequencies has "
        f"no bar.{those_drawn(len(criteria.sensors))}"
    )
    return Chart("frac", "Frequency response assurance criterion", ((panel,),), caption, _HEIGHT)


def damping_chart(criteria: Criteria, by: str) -> Chart:
    """Return the chart of damping ratios, measured by something and of the case."""
    measured = [
        pair.measured
        for pair in criteria.modes
        if pair.measured is not None and not pair.measured.doubt
    ]
    intervals = np.array([mode.damping_ratio.interval for mode in measured])
    places = np.array([mode.frequency.value for mode in measured])
    ratios = np.array([mode.damping_ratio.value for mode in measured])
    of_case = [pair for pair in criteria.modes if pair.number is not None]
    computed = np.array([pair.damping_ratio for pair in of_case])
    marks = (
        Points(np.array([pair.frequency for pair in of_case]), computed, "case", "other mark"),
        Points(
            places,
            ratios,
            "measured, with 95 % interval",
            "measured",
            low=intervals[:, 0],
            high=intervals[:, 1],
        ),
    )
    # room for the marks of the largest
    top = 1.1 * float(np.nanmax(np.append(computed, intervals)))
    panel = Panel(
        Axis("Frequency", "Hz", range=criteria.band), Axis("Damping ratio", range=(0.0, top)), marks
    )
    caption = f"Damping ratios estimated from {by}, and those of the case."
    return Chart("damping", "Modal damping", ((panel,),), caption, _HEIGHT)


def what_frac_is_of(correlation: Correlation) -> str:
    """Return of what the frequency response assurance criterion is."""
    if not correlation.hits:
        return "the spectra of the signals, since no force was measured"
    ending = "s" if correlation.hits > 1 else ""
    return f"the frequency responses to the force, by H1 from {correlation.hits} hit{ending}"
