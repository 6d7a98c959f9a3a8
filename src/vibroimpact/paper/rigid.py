"""Section 3.2: rigid bodies, five impacts, constant and variable damping; the damping as a function of the approach speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.paper.damping_function import parabola, printed_function
from vibroimpact.paper.printed import printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import IMPACTS, Runs, with_law
from vibroimpact.paper.section import Section, Table
from vibroimpact.units.display import fixed

_SEEN = 1e-3
"""To which part rebound heights agree that were made to coincide by eye on a curve."""

_ROUNDED = 5e-6
"""How far an approach speed of five decimals may be off [m/s]."""


def section_3_2(runs: Runs) -> Section:
    """Return the rebounds and errors that the text of section 3.2 and section 5.1 prints for rigid bodies."""
    height, depth = (runs.below_theory("constant", name) for name in ("rebound_height_m", "max_indentation_m"))
    rebound = runs.response("type1-constant").impacts["rebound_height_m"][0]
    return Section(
        "Section 3.2: rebounds of rigid bodies",
        (
            "The theory is the law of Lankarani and Nikravesh with e_h = 0.65, the simulation IMPACT of Adams with a full-damping "
            "penetration of 0.1 mm; both are integrated here to a relative error of 1e-9, and peaks are located, not picked from samples. "
            "These two values are nowhere printed so: they were recovered from numbers that are printed, these among them (see the "
            "forensic section), so that it is the agreement of all of them with two values that counts.",
        ),
        (
            Row(printed("type1.rebound_height"), float(rebound), by="IMPACT"),
            Row(printed("constant.height_error.4"), float(height[3]), by="IMPACT beside the theory"),
            Row(printed("constant.compression_error.5"), float(depth[4]), by="IMPACT beside the theory"),
        ),
        (_impacts(runs),),
    )


def _impacts(runs: Runs) -> Table:
    """Return what the three runs give, impact by impact."""
    cells = []
    for name, words in (("theory", "theory"), ("constant", "IMPACT, constant damping"), ("variable", "IMPACT, variable damping")):
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
    return Table(headers, tuple(cells), "Impact by impact")


def damping(runs: Runs) -> Section:
    """Return the dampings that give the theory's rebounds, and the function of the approach speed through them."""
    found = runs.calibration
    within = dampings_within(runs, _SEEN)
    reason = f"chosen by hand: any from {{:.2f}} to {{:.2f}} N s/m gives the theory's rebound height to {100.0 * _SEEN:g} %"
    rows = [
        Row(printed(f"damping.{impact}"), float(value), by="calibration", accounts=(Account(reason.format(*ends), *map(float, ends)),))
        for impact, value, ends in zip(IMPACTS, found.values, within, strict=True)
    ]
    fit, reach = _fit_of_printed(runs)
    by = "least squares through the printed dampings, over the simulation's approach speeds"
    for power, (value, low, high) in enumerate(zip(fit, fit - reach, fit + reach, strict=True), start=1):
        told = f"a reading: least squares with approach speeds of five decimals give {fixed(low, 5)} to {fixed(high, 5)}"
        account = Account(told, float(low), float(high))
        rows.append(Row(printed(f"damping_function.{power}"), float(value), by=by, accounts=(account,)))
    exact = found.fit.function
    speeds = found.observations.speeds
    columns = (speeds, found.values, exact(speeds), printed_function(speeds))
    cells = tuple(
        (str(impact), f"{speed:.5f}", f"{value:.3f}", f"{through:.3f}", printed(f"damping.{impact}").text, f"{read:.3f}")
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
    return Section(
        "Section 3.2: the damping, and its function of the approach speed",
        (
            f"Calibration finds the damping with which each impact of IMPACT has the theory's separation speed: y(v) = {low:.4f} + "
            f"{middle:.5f} v - {-high:.6f} v^2 in N s/m for v in m/s is the least-squares parabola through the values found.",
        ),
        tuple(rows),
        (Table(headers, cells, "Damping found and printed"),),
    )


def dampings_within(runs: Runs, part: float) -> Floats:
    """Return between which dampings of IMPACT each rebound height is the theory's to a part of it [N s/m], (5, 2)."""
    found, problem = runs.calibration, runs.problem("type1-variable")
    speeds = found.observations.speeds
    damping, speed = (array.ravel() for array in np.meshgrid(np.linspace(0.97, 1.03, 31), speeds))
    damping = damping * np.repeat(found.values, 31)
    drops = with_law(replace(problem, height=None, speed=speed, impacts=1), damping_max=damping)
    heights = simulate(drops).impacts["rebound_height_m"].reshape(len(speeds), 31)
    wanted = runs.response("type1-theory").impacts["rebound_height_m"]
    ends = [
        np.interp([height * (1.0 - part), height * (1.0 + part)], row[::-1], values[::-1])[::-1]  # heights fall with the damping
        for height, row, values in zip(wanted, heights, damping.reshape(len(speeds), 31), strict=True)
    ]
    return np.array(ends)


def _fit_of_printed(runs: Runs) -> tuple[Floats, Floats]:
    """Return the coefficients through the printed dampings, and how far rounding of the speeds can move them."""
    speeds = runs.response("type1-variable").impacts["approach_speed_m_s"]
    fit = parabola(speeds)
    return fit, np.abs(parabola(speeds + _ROUNDED * np.eye(len(speeds))) - fit).sum(axis=0)
