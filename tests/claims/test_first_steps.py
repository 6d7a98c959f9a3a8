"""Numbers of the first steps."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

import vibroimpact as vi
from stated_numbers import ROOT, says
from support import blocks
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import numbers_of
from vibroimpact.runs.answer import answer_of
from vibroimpact.units.display import STANDARD_GRAVITY

PAGE = "docs/first-steps.md"
(CASE,) = (tomllib.loads(block) for block in blocks(PAGE, "toml"))
ALUMINIUM = {
    "density": 2700,
    "youngs_modulus": "70 GPa",
    "poissons_ratio": 0.3,
    "yield_strength": "240 MPa",
}


def first(response: vi.Response, column: str) -> float:
    return float(response.impacts[column][0])


def run(**changes: dict[str, Any]) -> vi.Response:
    return vi.simulate(
        vi.case_of({**CASE, **{name: {**CASE[name], **keys} for name, keys in changes.items()}})
    )


def test_python() -> None:
    required = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "requires-python"
    ]
    says(PAGE, "You need Python {} or newer", float(required.removeprefix(">=")))
    says("README.md", "On Linux with Python {} or newer", float(required.removeprefix(">=")))


@pytest.mark.slow  # modes of the plate
def test_the_run() -> None:
    response = run()
    says(
        PAGE,
        "1 {} {} {} 0.70000 {} {} {} {}",
        1e3 * first(response, "time_s"),
        1e6 * first(response, "duration_s"),
        first(response, "approach_speed_m_s"),
        first(response, "restitution_achieved"),
        1e6 * first(response, "max_indentation_m"),
        1e-3 * first(response, "max_force_N"),
        1e3 * first(response, "rebound_height_m"),
    )
    energy = {name: float(value) for name, value in response.energy.items()}
    put_in = energy["input_J"]
    says(
        PAGE,
        "contact dissipated {} {}",
        1e3 * energy["contact_dissipated_J"],
        100.0 * energy["contact_dissipated_J"] / put_in,
    )
    damped = energy["plate_damping_J"]
    says(PAGE, "plate damping {} {}", 1e3 * damped, 100.0 * damped / put_in)
    assert 0.5 < damped / put_in < 0.65  # more than half of the energy
    result = vi.result_of(response)
    answer = {quantity.name: quantity for quantity in answer_of(result)}
    force = answer["Largest force"]
    says(PAGE, "Largest force {} kN ± {} %", 1e-3 * force.value, 100.0 * force.error)
    restitution = answer["Restitution"]
    says(PAGE, "Restitution {} ± {} % or more", restitution.value, 100.0 * restitution.error)
    says(PAGE, "a1 {} m/s² ± {} %", answer["a1"].value, 100.0 * answer["a1"].error)
    says(PAGE, "{} g", answer["a1"].value / STANDARD_GRAVITY)
    says(PAGE, "here {}; fewer", float(len(result.frequencies("plate"))))
    says(PAGE, "the restitution achieved is {}.", first(response, "restitution_achieved"))
    (cracks,) = result.doubts
    assert "the sphere (limestone) cracks" in cracks


@pytest.mark.slow
def test_a_plate_that_yields() -> None:
    elastic = run(plate={"material": ALUMINIUM})
    result = vi.result_of(elastic)
    demand = float(numbers_of(Conditions(result.case, result._drop_summary))["plate_strength"])
    assert 1.0 / demand == pytest.approx(0.25, abs=0.01)  # a quarter of the pressure
    case = {**CASE, "plate": {**CASE["plate"], "material": ALUMINIUM}, "contact": {"law": "meyer"}}
    dented = vi.simulate(vi.case_of(case))
    says(
        PAGE,
        "it gives {} kN and a restitution of {} where the run below has {} kN and {},",
        1e-3 * first(dented, "max_force_N"),
        first(dented, "restitution_achieved"),
        1e-3 * first(elastic, "max_force_N"),
        first(elastic, "restitution_achieved"),
    )
