"""Section 5.3: the vibration of the plate in Type 3."""

from __future__ import annotations

import numpy as np

from vibroimpact.paper.implicit_euler import PEAKS
from vibroimpact.paper.measures import after_each_impact, column, largest_of, plate_energy_part
from vibroimpact.paper.printed import printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import IMPACTS, TREATMENTS, Runs
from vibroimpact.paper.section import Section, Table
from vibroimpact.paper.treatments import rows_by_treatment
from vibroimpact.paper.unresolved import unresolved_range

_PEAKS = {
    "displacement": "plate_displacement_m",
    "velocity": "plate_velocity_m_s",
    "acceleration": "plate_acceleration_m_s2",
    "kinetic_energy": "plate_kinetic_J",
    "strain_energy": "plate_strain_J",
    "potential_energy": "plate_potential_J",
}
"""What is printed of the plate, and the column of the history that has it."""


def section_5_3(runs: Runs) -> Section:
    """Return the peaks of the plate's motion and energies."""
    rows: list[Row] = [_impact_speed(runs)]
    for name, told in _PEAKS.items():
        unresolved = unresolved_range(runs, 3, told) if told in PEAKS else None
        rows += rows_by_treatment(runs, 3, printed(f"plate.{name}"), largest_of(column(told)), unresolved)
    rows += rows_by_treatment(
        runs, 3, printed("plate.acceleration.5"), lambda response: float(after_each_impact(column(_PEAKS["acceleration"]))(response)[4])
    )
    rows += _parts()
    rows += rows_by_treatment(runs, 3, printed("plate.energy_part"), plate_energy_part)
    table, words = _decay(runs)
    return Section(
        "Section 5.3: the vibration of the plate",
        ("Peaks of the whole run, of the plate's centre of mass and of its energies.",),
        tuple(rows),
        (table,),
        (words,),
    )


def _impact_speed(runs: Runs) -> Row:
    problem = runs.problem("type1-variable")
    assert problem.height is not None
    whole = float(np.sqrt(2.0 * problem.gravity * problem.height))
    account = Account(
        f"a fall of the full {float(problem.height):g} m, to the centre instead of to first touch: {whole:.3f} m/s", whole, whole
    )
    speed = float(runs.response("type1-variable").impacts["approach_speed_m_s"][0])
    return Row(printed("impact_speed"), speed, by="the fall to first touch", accounts=(account,))


def _parts() -> list[Row]:
    """Return the printed parts in per cent beside the numbers that they are made of."""
    released, thickness = printed("type3.potential_energy"), printed("plate.size.3")
    kinetic, strain = (printed(f"plate.{name}_energy") for name in ("kinetic", "strain"))
    return [
        Row(
            printed("plate.displacement_part"),
            100.0 * printed("plate.displacement").value / (1e-3 * thickness.value),
            by="the printed displacement and thickness",
        ),
        Row(printed("plate.kinetic_part"), 100.0 * kinetic.value / released.value, by="the printed energies"),
        Row(printed("plate.strain_part"), 100.0 * strain.value / released.value, by="the printed energies"),
        Row(printed("plate.energy_part"), 100.0 * (kinetic.value + strain.value) / released.value, by="the printed energies"),
    ]


def _decay(runs: Runs) -> tuple[Table, str]:
    """Return how the peaks fall from impact to impact, and whether the acceleration falls most slowly, as the paper says."""
    cells, slowest = [], []
    for treatment in TREATMENTS:
        response, left = runs.treated(3, treatment), {}
        for name in ("displacement", "velocity", "acceleration"):
            peaks = after_each_impact(column(_PEAKS[name]))(response)
            cells.append((treatment, name, *(f"{100.0 * peak / peaks[0]:.2f}" for peak in peaks)))
            left[name] = float(peaks[-1] / peaks[0])
        slowest += [treatment] if left["acceleration"] == max(left.values()) else []
    headers = ("Treatment", "Peak of the plate's centre of mass", *(f"Impact {number} [%]" for number in IMPACTS))
    where = f"this holds in these treatments: {', '.join(slowest)}" if slowest else "this holds in none of the three treatments"
    words = (
        "The paper says that from impact to impact the acceleration of the plate's centre of mass decreases more slowly than its "
        f"displacement and velocity: {where}."
    )
    return Table(headers, tuple(cells), "Peaks after each impact, of those after the first"), words
