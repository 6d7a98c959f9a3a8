"""The section on the conclusions of the paper (section 6)."""

from __future__ import annotations

import numpy as np

from vibroimpact.paper.measures import energy_released, plate_energy_part
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report_section import ReportSection, TextTable, holds_text
from vibroimpact.paper.runs import DAMPINGS, TREATMENTS, Runs, history_of
from vibroimpact.paper.sampling import QUANTITIES


def conclusions(runs: Runs) -> ReportSection:
    """Return the section that tests each conclusion of the paper."""
    cells = [*_variable_damping(runs), _damping_function(runs)]
    cells += [_elastic_sphere(runs, treatment) for treatment in TREATMENTS]
    cells += [
        _elastic_plate_as_printed(),
        *(_elastic_plate(runs, treatment) for treatment in TREATMENTS),
    ]
    cells += [_energy_of_the_plate(runs, treatment) for treatment in TREATMENTS]
    cells += [_consumed(runs, treatment) for treatment in TREATMENTS]
    return ReportSection(
        "Section 6: the conclusions",
        (
            "Each conclusion is tested as far as it can be computed. The three treatments "
            "are those of section 5.1. Conclusion (5) is advice on what to measure.",
        ),
        tables=(TextTable(("Conclusion", "By", "Does it hold?", "Numbers"), tuple(cells)),),
    )


def _variable_damping(runs: Runs) -> list[tuple[str, ...]]:
    cells: list[tuple[str, ...]] = []
    for quantity, (_, column, _) in QUANTITIES.items():
        largest_errors = {
            damping: float(np.abs(runs.below_theory(damping, column)).max()) for damping in DAMPINGS
        }
        constant = largest_errors["constant"]
        variable = largest_errors["variable"]
        phrase = (
            f"(1) With variable damping the largest error of the {quantity} is smaller than "
            "with constant damping"
        )
        cells.append(
            (
                phrase,
                "IMPACT",
                holds_text(variable < constant),
                f"{variable:.3f} % instead of {constant:.3f} %",
            )
        )
    return cells


def _damping_function(runs: Runs) -> tuple[str, ...]:
    values = runs.calibration.values
    speeds = runs.calibration.observations.speeds
    rises = bool(np.all(np.diff(values) * np.diff(speeds) > 0))
    numbers = (
        f"{values.min():.2f} N s/m at {speeds.min():.2f} m/s to {values.max():.2f} N s/m at "
        f"{speeds.max():.2f} m/s"
    )
    return (
        "(2) The damping that reproduces the theory rises with the approach speed",
        "calibration",
        holds_text(rises),
        numbers,
    )


def _elastic_sphere(runs: Runs, treatment: str) -> tuple[str, ...]:
    elastic = runs.treated(2, treatment).impacts
    elastic_force = float(elastic["max_force_N"][0])
    elastic_height = float(elastic["rebound_height_m"][0])
    rigid = runs.response("type1-variable").impacts
    rigid_force = float(rigid["max_force_N"][0])
    rigid_height = float(rigid["rebound_height_m"][0])
    phrase = "(3) An elastic sphere is hit with less force, and rebounds lower, than a rigid one"
    numbers = (
        f"{elastic_force:.0f} instead of {rigid_force:.0f} N, {elastic_height:.3f} instead of "
        f"{rigid_height:.3f} m"
    )
    holds = elastic_force < rigid_force and elastic_height < rigid_height
    return phrase, treatment, holds_text(holds), numbers


_ELASTIC_PLATE = (
    "(4) On an elastic plate the sphere rebounds lower, and is hit with less force, "
    "than on a rigid one"
)


def _elastic_plate(runs: Runs, treatment: str) -> tuple[str, ...]:
    columns = ("rebound_height_m", "max_force_N")
    return _lower(
        treatment,
        *(
            [float(runs.treated(kind, treatment).impacts[name][0]) for name in columns]
            for kind in (2, 3)
        ),
    )


def _elastic_plate_as_printed() -> tuple[str, ...]:
    names = ("rebound_height", "max_force")
    return _lower(
        "the printed numbers",
        *([printed(f"type{kind}.{name}").value for name in names] for kind in (2, 3)),
    )


def _lower(by: str, rigid: list[float], elastic: list[float]) -> tuple[str, ...]:
    """Return the test of conclusion (4), from rebound height [m] and force [N] on a rigid
    and on an elastic plate.
    """
    numbers = (
        f"{elastic[0]:.3f} instead of {rigid[0]:.3f} m, {elastic[1]:.0f} instead of "
        f"{rigid[1]:.0f} N"
    )
    return _ELASTIC_PLATE, by, holds_text(elastic[0] < rigid[0] and elastic[1] < rigid[1]), numbers


def _energy_of_the_plate(runs: Runs, treatment: str) -> tuple[str, ...]:
    """Return the test of the plate's share of the energy released, with its two largest
    energies added as in the paper.
    """
    response = runs.treated(3, treatment)
    least = printed("plate.energy_part")
    history = history_of(response)
    both = plate_energy_part(response)
    at_once = (
        100.0
        * float((history["plate_kinetic_J"] + history["plate_strain_J"]).max())
        / energy_released(response)
    )
    phrase = (
        f"(6) The energy of the plate can't be neglected: more than {least.text} % of the "
        "energy released"
    )
    numbers = (
        f"{both:.1f} % if the largest kinetic and strain energy are added, at most "
        f"{at_once:.1f} % at one time"
    )
    return phrase, treatment, holds_text(both > least.value), numbers


def _consumed(runs: Runs, treatment: str) -> tuple[str, ...]:
    """Return the test of the share of energy dissipated, in contact and bodies, by the
    first separation and by the second touch.
    """
    response = runs.treated(3, treatment)
    impacts = response.impacts
    put_in = float(response.energy["input_J"])
    history = response.at([impacts["time_s"][0] + impacts["duration_s"][0], impacts["time_s"][1]])
    dissipated = sum(
        history[name] for name in ("contact_dissipated_J", "sphere_damping_J", "plate_damping_J")
    )
    first, second = (100.0 * np.asarray(dissipated) / put_in).tolist()
    phrase = "(6) Most of the energy is consumed in the impact of elastic bodies"
    return (
        phrase,
        treatment,
        holds_text(first > 50.0),
        f"{first:.0f} % dissipated by the first separation, {second:.0f} % by the second touch",
    )
