"""The charts of a correlation of frequency responses: magnitudes, phases and coherences,
criteria and damping.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Line, Rug
from vibroimpact.quoting import shortened, visible
from vibroimpact.test_analysis.charts import (
    MOST,
    damping_chart,
    frac_chart,
    magnitude_lines,
    those_drawn,
)
from vibroimpact.test_analysis.responses.result import ResponseCorrelation

_LOOKS = (("measured", "measured"), ("simulated", "fit"))
"""Names and roles of the lines."""

WHAT_FRAC_IS_OF = "the measured frequency responses"
"""Of what the frequency response assurance criterion is."""


def response_charts(correlation: ResponseCorrelation) -> list[Chart]:
    """Return the charts `responses`, `frac` and, if a damping was measured, `damping`.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> measured = vi.test_analysis.responses_of_case(case, np.arange(50.0, 400.0))
    >>> correlation = vi.test_analysis.correlate_responses(case, measured)
    >>> [chart.name for chart in response_charts(correlation)]
    ['responses', 'frac', 'damping']
    """
    makers = {
        "responses": partial(_responses, correlation),
        "frac": partial(frac_chart, correlation, WHAT_FRAC_IS_OF),
    }
    if any(pair.damping_measured for pair in correlation.modes):
        makers["damping"] = partial(damping_chart, correlation, "the measured frequency responses")
    return made_charts(makers)


def _responses(correlation: ResponseCorrelation) -> Chart:
    axis = Axis("Frequency", "Hz", range=correlation.band)
    computed = np.array([pair.frequency for pair in correlation.modes if pair.number is not None])
    turns = Axis("Phase", "°", range=(-190.0, 190.0))
    rows: list[tuple[Panel, ...]] = []
    for number, sensor in enumerate(correlation.sensors[:MOST]):
        both = (correlation.measured_response[number], correlation.simulated_response[number])
        magnitudes, shown = magnitude_lines(correlation.frequency, both)
        scale = Axis("Magnitude", correlation.units[number], log=True, range=shown)
        phases = [
            Line(*_phase(correlation.frequency, response), name, role)
            for response, (name, role) in zip(both, _LOOKS, strict=True)
        ]
        title = f"{shortened(visible(sensor.name), 40)}: FRAC {correlation.frac[number]:.3f}"
        rows.append(
            (Panel(axis, scale, (*magnitudes, Rug(computed, "modes of the case", "fit")), title),)
        )
        rows.append((Panel(axis, turns, tuple(phases), "Phase"),))
        if correlation.coherence is not None and not np.isnan(correlation.coherence[number]).any():
            level = Axis("Coherence", range=(0.0, 1.02))
            rows.append(
                (
                    Panel(
                        axis,
                        level,
                        (
                            Line(
                                correlation.frequency, correlation.coherence[number], role="detail"
                            ),
                        ),
                        "Coherence",
                    ),
                )
            )
    place = visible(correlation.reference)
    if correlation.reciprocal:
        of = f"of the motion at {place} to forces at the sensors"
    else:
        of = f"to a force at {place}"
    caption = (
        f"Measured frequency responses {of}, and those of the case. Ticks mark the modes of "
        f"the case.{those_drawn(len(correlation.sensors))}"
    )
    return Chart("responses", "Frequency responses", tuple(rows), caption)


def _phase(frequency: Floats, response: Complex) -> tuple[Floats, Floats]:
    """Return the frequencies and the phases [°] of a line, which is interrupted where a
    phase goes on at the other end of the axis.
    """
    phase = np.degrees(np.angle(response))
    turns = np.flatnonzero(np.abs(np.diff(phase)) > 180.0) + 1
    return np.insert(frequency, turns, frequency[turns]), np.insert(phase, turns, np.nan)
