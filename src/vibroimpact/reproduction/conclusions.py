"""Section 6: the conclusions of the paper, one by one."""

from __future__ import annotations

import numpy as np

from vibroimpact.reproduction.runs import TREATMENTS, Runs, history_of
from vibroimpact.reproduction.section import Section, Table
from vibroimpact.reproduction.table2 import COLUMNS, exact_errors


def conclusions(runs: Runs) -> Section:
    """Return what the paper concludes, and whether it holds."""
    cells: list[tuple[str, ...]] = []
    for quantity in COLUMNS:
        constant, variable = (max(np.abs(exact_errors(runs, quantity, damping))) for damping in ("constant", "variable"))
        words = f"(1) With variable damping the largest error of the {quantity} is smaller than with constant damping"
        cells.append((words, "IMPACT", _verdict(variable < constant), f"{variable:.3f} % instead of {constant:.3f} %"))
    values, speeds = runs.calibration.values, runs.calibration.observations.speeds
    rises = bool(np.all(np.diff(values) * np.diff(speeds) > 0))
    cells.append(
        (
            "(2) The damping that reproduces the theory rises with the approach speed",
            "calibration",
            _verdict(rises),
            f"{values.min():.2f} N s/m at {speeds.min():.2f} m/s to {values.max():.2f} N s/m at {speeds.max():.2f} m/s",
        )
    )
    rigid = runs.response("type1-variable").impacts
    for treatment in TREATMENTS:
        two, three = (runs.treated(kind, treatment).impacts for kind in (2, 3))
        holds = bool(two["max_force_N"][0] < rigid["max_force_N"][0] and two["rebound_height_m"][0] < rigid["rebound_height_m"][0])
        words = "(3) An elastic sphere is hit with much less force, and rebounds much lower, than a rigid one"
        numbers = f"{two['max_force_N'][0]:.0f} instead of {rigid['max_force_N'][0]:.0f} N, {two['rebound_height_m'][0]:.3f} instead of "
        cells.append((words, treatment, _verdict(holds), f"{numbers}{rigid['rebound_height_m'][0]:.3f} m"))
    for treatment in TREATMENTS:
        two, three = (runs.treated(kind, treatment).impacts for kind in (2, 3))
        ratio = float(three["rebound_height_m"][0] / two["rebound_height_m"][0])
        words = "(4) On an elastic plate the sphere rebounds lower than on a rigid one"
        cells.append((words, treatment, _verdict(ratio < 1.0), f"{100.0 * (1.0 - ratio):.0f} % lower"))
    cells += [_plate(runs, treatment) for treatment in TREATMENTS]
    cells += [_consumed(runs, treatment) for treatment in TREATMENTS]
    return Section(
        "Section 6: the conclusions",
        ("Each conclusion as far as it can be computed. The three treatments are those of section 5.1.",),
        tables=(Table(("Conclusion", "By", "Does it hold?", "Numbers"), tuple(cells)),),
    )


def _verdict(holds: bool) -> str:
    return "holds" if holds else "does not hold"


def _plate(runs: Runs, treatment: str) -> tuple[str, ...]:
    """Return the part of the energy released that goes into the plate, its two largest energies added as the paper does."""
    history = history_of(runs.treated(3, treatment))
    released = history["potential_J"][0] - history["potential_J"].min()
    both = 100.0 * float(history["plate_kinetic_J"].max() + history["plate_strain_J"].max()) / released
    at_once = 100.0 * float((history["plate_kinetic_J"] + history["plate_strain_J"]).max()) / released
    words = "(6) The energy of the plate can't be neglected: more than 11 % of the energy released"
    return words, treatment, _verdict(both > 11.0), f"{both:.1f} % if the largest of each are added, {at_once:.1f} % at one time"


def _consumed(runs: Runs, treatment: str) -> tuple[str, ...]:
    """Return how much of the energy released is gone after the first impact of Type 3."""
    impacts = runs.treated(3, treatment).impacts
    gone = 100.0 * (1.0 - float(impacts["separation_speed_m_s"][0] / impacts["approach_speed_m_s"][0]) ** 2)
    words = "(6) Most of the energy is consumed in the impact of elastic bodies"
    return words, treatment, _verdict(gone > 50.0), f"{gone:.0f} % of the sphere's energy after the first impact"
