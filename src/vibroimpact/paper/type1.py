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
    height = runs.below_theory("constant", "rebound_height_m")
    depth = runs.below_theory("constant", "max_indentation_m")
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
    for name, phrase in (
        ("theory", "theory"),
        ("constant", "IMPACT, constant damping"),
        ("variable", "IMPACT, variable damping"),
    ):
        impacts = runs.response(f"type1-{name}").impacts
        for index in range(len(impacts["impact"])):
            row = {column: float(values[index]) for column, values in impacts.items()}
            cells.append(
                (
                    phrase,
                    str(index + 1),
                    f"{row['time_s']:.5f}",
                    f"{1e6 * row['duration_s']:.2f}",
                    f"{row['approach_speed_m_s']:.5f}",
                    f"{row['restitution_achieved']:.5f}",
                    f"{1e6 * row['max_indentation_m']:.2f}",
                    f"{row['max_force_N']:.2f}",
                    f"{row['rebound_height_m']:.5f}",
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
    constant, linear, quadratic = runs.calibration.fit.function.coefficients
    return ReportSection(
        "Section 3.2: the damping, and its function of the approach speed",
        (
            "Calibration finds the damping with which each impact of IMPACT has the "
            f"theory's separation speed: y(v) = {constant:.4f} + "
            f"{linear:.5f} v - {-quadratic:.6f} v^2 in N s/m for v in m/s is the least-squares "
            "parabola through the values found.",
        ),
        (*_damping_rows(runs), *_function_rows(runs)),
        (_dampings_table(runs),),
    )


def _damping_rows(runs: Runs) -> list[ComparedValue]:
    """Return the damping of each impact, with the range that gives nearly the same height."""
    rows = []
    ranges = dampings_within(runs, _SEEN)
    for impact, damping, (low, high) in zip(IMPACTS, runs.calibration.values, ranges, strict=True):
        reason = (
            f"a hypothesis, chosen by hand: any from {low:.2f} to {high:.2f} N s/m gives the "
            f"theory's rebound height to {100.0 * _SEEN:g} %"
        )
        explanation = Explanation(reason, float(low), float(high))
        rows.append(
            ComparedValue(
                printed(f"damping.{impact}"),
                float(damping),
                by="calibration",
                explanations=(explanation,),
            )
        )
    return rows


def _function_rows(runs: Runs) -> list[ComparedValue]:
    """Return the coefficients of the damping function, with their ranges by rounded speeds."""
    rows = []
    coefficients, changes = _fit_of_printed(runs)
    for number, (coefficient, change) in enumerate(
        zip(coefficients, changes, strict=True), start=1
    ):
        low = coefficient - change
        high = coefficient + change
        reason = (
            "a hypothesis: least squares with approach speeds of five decimals give "
            f"{fixed(low, 5)} to {fixed(high, 5)}"
        )
        rows.append(
            ComparedValue(
                printed(f"damping_function.{number}"),
                float(coefficient),
                by="least squares through the printed dampings, over the simulation's approach "
                "speeds",
                explanations=(Explanation(reason, float(low), float(high)),),
            )
        )
    return rows


def _dampings_table(runs: Runs) -> TextTable:
    """Return the dampings that were calibrated and printed, with the functions through them."""
    calibration = runs.calibration
    speeds = calibration.observations.speeds
    fitted = calibration.fit.function(speeds)
    as_printed = printed_function(speeds)
    cells = []
    for number, impact in enumerate(IMPACTS):
        cells.append(
            (
                str(impact),
                f"{speeds[number]:.5f}",
                f"{calibration.values[number]:.3f}",
                f"{fitted[number]:.3f}",
                printed(f"damping.{impact}").text,
                f"{as_printed[number]:.3f}",
            )
        )
    headers = (
        "Impact",
        "Approach speed [m/s]",
        "Calibrated [N s/m]",
        "Function through these [N s/m]",
        "Printed [N s/m]",
        "Printed function [N s/m]",
    )
    return TextTable(headers, tuple(cells), "Damping found and printed")


def dampings_within(runs: Runs, part: float) -> Floats:
    """Return the range of the damping of IMPACT in which each rebound height is within a
    relative `part` of the theory [N s/m], (5, 2).
    """
    calibration = runs.calibration
    factors = np.linspace(0.97, 1.03, 31)
    # each impact with its own speed, and with dampings about that which was calibrated for it
    dampings = factors * calibration.values[:, None]
    speeds = np.repeat(calibration.observations.speeds, len(factors))
    drop = runs.problem("type1-variable")
    single_impacts = replace(drop, height=None, speed=speeds, impacts=1)
    drops = with_law(single_impacts, damping_max=dampings.ravel())
    heights = simulate(drops).impacts["rebound_height_m"].reshape(dampings.shape)
    theory = runs.response("type1-theory").impacts["rebound_height_m"]
    ranges = []
    for number, height in enumerate(theory):
        ends = [height * (1.0 - part), height * (1.0 + part)]
        # reversed, since np.interp needs ascending heights, and they fall with the damping
        of_ends = np.interp(ends, heights[number, ::-1], dampings[number, ::-1])
        ranges.append(of_ends[::-1])
    return np.array(ranges)


def _fit_of_printed(runs: Runs) -> tuple[Floats, Floats]:
    """Return the parabola through the printed dampings, and the largest change of its
    coefficients by rounding of the speeds.
    """
    speeds = runs.response("type1-variable").impacts["approach_speed_m_s"]
    fit = parabola(speeds)
    # each speed off by its rounding, one at a time; at worst their effects add up
    with_one_off = parabola(speeds + _ROUNDED * np.eye(len(speeds)))
    return fit, np.abs(with_one_off - fit).sum(axis=0)


def table2(runs: Runs) -> ReportSection:
    """Return the section that compares Table 2 with exact errors and with errors of
    sampled peaks.
    """
    rows = []
    for quantity, (_, column, _) in QUANTITIES.items():
        for damping in DAMPINGS:
            errors = np.abs(runs.below_theory(damping, column))
            for impact, error in zip(IMPACTS, errors, strict=True):
                rows.append(_sampled_error_row(runs, quantity, damping, impact, float(error)))
    compressions = [table2_error("compression", "variable", impact) for impact in IMPACTS]
    worst = max(compressions, key=lambda error: error.value)
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


def _sampled_error_row(
    runs: Runs, quantity: str, damping: str, impact: int, error: float
) -> ComparedValue:
    """Return an error of Table 2, with the range of the errors of sampled peaks."""
    left_out = None
    if quantity == "compression":
        # the spacing is estimated without the compression that is tested, so that the test is not
        # circular
        left_out = (damping, impact)
    spacing = spacing_bound(runs, left_out)
    low, high = _magnitudes(*error_range(runs, spacing, quantity, damping, impact))
    reason = f"peaks read off samples {1e6 * spacing:.0f} µs apart give {low:.2f} to {high:.2f} %"
    return ComparedValue(
        table2_error(quantity, damping, impact),
        error,
        by=f"IMPACT, {damping} damping",
        explanations=(Explanation(reason, low, high),),
    )


def _magnitudes(low: float, high: float) -> tuple[float, float]:
    """Return the range of the absolute values in a range: the paper prints errors without
    their sign.
    """
    largest = max(abs(low), abs(high))
    if low < 0.0 < high:
        return 0.0, largest
    return min(abs(low), abs(high)), largest
