"""The sections on Type 1, rigid bodies: rebounds and damping function (section 3.2), and
the errors of Table 2.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.paper.derived import parabola, printed_function
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report_section import (
    ComparedValue,
    Explanation,
    Kind,
    ReportSection,
    TextTable,
)
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs, with_law
from vibroimpact.paper.sampling import QUANTITIES, error_range, spacing_bound, table2_error
from vibroimpact.units.display import fixed

_SEEN = 1e-3
"""Relative agreement assumed of rebound heights that were matched by eye on a curve."""

_ROUNDED = 5e-6
"""Rounding error of an approach speed of five decimals [m/s]."""


def section_3_2(runs: Runs) -> ReportSection:
    """Return the section on the rebounds and errors that sections 3.2 and 5.1 print for
    rigid bodies.
    """
    height, depth = (
        runs.below_theory("constant", name) for name in ("rebound_height_m", "max_indentation_m")
    )
    rebound = runs.response("type1-constant").impacts["rebound_height_m"][0]
    return ReportSection(
        "Section 3.2: rebounds of rigid bodies",
        (
            "The theory is the law of Lankarani and Nikravesh with e_h = 0.65, the "
            "simulation IMPACT of Adams with a full-damping "
            "penetration of 0.1 mm; both are integrated here with a relative tolerance of "
            "1e-9, and peaks are located, not picked from "
            "samples. These two values are not printed: they were recovered from printed "
            "numbers, including these (see the section on "
            "inferences), so that the evidence is the agreement of all of them with two values.",
        ),
        (
            ComparedValue(printed("type1.rebound_height"), float(rebound), by="IMPACT"),
            ComparedValue(
                printed("constant.height_error.4"), float(height[3]), by="IMPACT beside the theory"
            ),
            ComparedValue(
                printed("constant.compression_error.5"),
                float(depth[4]),
                by="IMPACT beside the theory",
            ),
        ),
        (_impacts(runs),),
    )


def _impacts(runs: Runs) -> TextTable:
    """Return the impact tables of the theory and of both simulations."""
    cells = []
    for name, words in (
        ("theory", "theory"),
        ("constant", "IMPACT, constant damping"),
        ("variable", "IMPACT, variable damping"),
    ):
        impacts = runs.response(f"type1-{name}").impacts
        for index in range(len(impacts["impact"])):
            found = {column: float(values[index]) for column, values in impacts.items()}
            cells.append(
                (
                    words,
                    str(index + 1),
                    f"{found['time_s']:.5f}",
                    f"{1e6 * found['duration_s']:.2f}",
                    f"{found['approach_speed_m_s']:.5f}",
                    f"{found['restitution_achieved']:.5f}",
                    f"{1e6 * found['max_indentation_m']:.2f}",
                    f"{found['max_force_N']:.2f}",
                    f"{found['rebound_height_m']:.5f}",
                )
            )
    headers = (
        "Run",
        "Impact",
        "Time [s]",
        "Contact [µs]",
        "Approach speed [m/s]",
        "Restitution",
        "Compression [µm]",
        "Force [N]",
        "Rebound height [m]",
    )
    return TextTable(headers, tuple(cells), "Impact by impact")


def damping_section(runs: Runs) -> ReportSection:
    """Return the section on the calibrated dampings and their function of the approach speed."""
    found = runs.calibration
    within = dampings_within(runs, _SEEN)
    reason = (
        f"a hypothesis, chosen by hand: any from {{:.2f}} to {{:.2f}} N s/m gives the theory's "
        f"rebound height to {100.0 * _SEEN:g} %"
    )
    rows = [
        ComparedValue(
            printed(f"damping.{impact}"),
            float(value),
            by="calibration",
            explanations=(Explanation(reason.format(*ends), *map(float, ends)),),
        )
        for impact, value, ends in zip(IMPACTS, found.values, within, strict=True)
    ]
    fit, reach = _fit_of_printed(runs)
    by = "least squares through the printed dampings, over the simulation's approach speeds"
    for power, (value, low, high) in enumerate(
        zip(fit, fit - reach, fit + reach, strict=True), start=1
    ):
        told = (
            "a hypothesis: least squares with approach speeds of five decimals give "
            f"{fixed(low, 5)} to {fixed(high, 5)}"
        )
        explanation = Explanation(told, float(low), float(high))
        rows.append(
            ComparedValue(
                printed(f"damping_function.{power}"),
                float(value),
                by=by,
                explanations=(explanation,),
            )
        )
    exact = found.fit.function
    speeds = found.observations.speeds
    columns = (speeds, found.values, exact(speeds), printed_function(speeds))
    cells = tuple(
        (
            str(impact),
            f"{speed:.5f}",
            f"{value:.3f}",
            f"{through:.3f}",
            printed(f"damping.{impact}").text,
            f"{read:.3f}",
        )
        for impact, speed, value, through, read in zip(IMPACTS, *columns, strict=True)
    )
    headers = (
        "Impact",
        "Approach speed [m/s]",
        "Calibrated [N s/m]",
        "Function through these [N s/m]",
        "Printed [N s/m]",
        "Printed function [N s/m]",
    )
    low, middle, high = exact.coefficients
    return ReportSection(
        "Section 3.2: the damping, and its function of the approach speed",
        (
            "Calibration finds the damping with which each impact of IMPACT has the "
            f"theory's separation speed: y(v) = {low:.4f} + "
            f"{middle:.5f} v - {-high:.6f} v^2 in N s/m for v in m/s is the least-squares "
            "parabola through the values found.",
        ),
        tuple(rows),
        (TextTable(headers, cells, "Damping found and printed"),),
    )


def dampings_within(runs: Runs, part: float) -> Floats:
    """Return the range of the damping of IMPACT in which each rebound height is within a
    relative `part` of the theory [N s/m], (5, 2).
    """
    found, problem = runs.calibration, runs.problem("type1-variable")
    speeds = found.observations.speeds
    damping, speed = (array.ravel() for array in np.meshgrid(np.linspace(0.97, 1.03, 31), speeds))
    damping = damping * np.repeat(found.values, 31)
    drops = with_law(replace(problem, height=None, speed=speed, impacts=1), damping_max=damping)
    heights = simulate(drops).impacts["rebound_height_m"].reshape(len(speeds), 31)
    wanted = runs.response("type1-theory").impacts["rebound_height_m"]
    # reversed, since np.interp needs ascending heights, and they fall with the damping
    ends = [
        np.interp([height * (1.0 - part), height * (1.0 + part)], row[::-1], values[::-1])[::-1]
        for height, row, values in zip(
            wanted, heights, damping.reshape(len(speeds), 31), strict=True
        )
    ]
    return np.array(ends)


def _fit_of_printed(runs: Runs) -> tuple[Floats, Floats]:
    """Return the parabola through the printed dampings, and the largest change of its
    coefficients by rounding of the speeds.
    """
    speeds = runs.response("type1-variable").impacts["approach_speed_m_s"]
    fit = parabola(speeds)
    return fit, np.abs(parabola(speeds + _ROUNDED * np.eye(len(speeds))) - fit).sum(axis=0)


def table2(runs: Runs) -> ReportSection:
    """Return the section that compares Table 2 with exact errors and with errors of
    sampled peaks.
    """
    rows = []
    for quantity, (_, column, _) in QUANTITIES.items():
        for damping in DAMPINGS:
            for impact, exact in zip(
                IMPACTS, np.abs(runs.below_theory(damping, column)), strict=True
            ):
                # the spacing is estimated without the compression that is tested, so that the test
                # is not circular
                spacing = spacing_bound(
                    runs, (damping, impact) if quantity == "compression" else None
                )
                low, high = _magnitudes(*error_range(runs, spacing, quantity, damping, impact))
                reason = (
                    f"peaks read off samples {1e6 * spacing:.0f} µs apart give {low:.2f} to "
                    f"{high:.2f} %"
                )
                value = table2_error(quantity, damping, impact)
                rows.append(
                    ComparedValue(
                        value,
                        float(exact),
                        by=f"IMPACT, {damping} damping",
                        explanations=(Explanation(reason, low, high),),
                    )
                )
    worst = max(
        (table2_error("compression", "variable", impact) for impact in IMPACTS),
        key=lambda value: value.value,
    )
    rows.append(
        ComparedValue(
            printed("worst_compression.variable"),
            worst.value,
            by="Table 2",
            otherwise=f"Table 2 and conclusion (1) have {worst.text} %",
            made_by=Kind.ARITHMETIC,
        )
    )
    return ReportSection(
        "Table 2: errors of the simulations",
        (
            "The computed values are the differences of the exact peaks. The printed ones "
            "scatter about them as if read from samples. "
            "This is a weak test, as the ranges show: sampling can be the cause (a "
            "compression is compared with the spacing implied by "
            "the other contacts). The section on inferences gives the evidence for it, and "
            "what remains open.",
        ),
        tuple(rows),
    )


def _magnitudes(low: float, high: float) -> tuple[float, float]:
    """Return the range of the absolute values in a range: the paper prints errors without
    their sign.
    """
    return (0.0 if low < 0.0 < high else min(abs(low), abs(high))), max(abs(low), abs(high))
