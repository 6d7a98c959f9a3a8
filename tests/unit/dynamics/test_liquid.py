"""Cases, studies and exports of impacts in a liquid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import numbers_of
from vibroimpact.cases.rigid.expected import expected_of
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.dynamics.fluids.liquid import restitution_kept
from vibroimpact.exporting.load_drop import load_drop as drop_in_folder
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.runs.case_document import case_document


def wet(liquid: Any = True, **changes: Any) -> dict[str, Any]:
    """A drop in a liquid."""
    contact = {"law": "tsuji", "restitution": 0.8, "liquid": liquid}
    return plain_case(**{"contact": contact, "drop": {"speed": 1.0}, **changes})


def test_water_is_the_liquid_by_default_and_the_case_comes_back() -> None:
    case = vi.case_of(wet())
    assert case.contact.local.liquid is not None
    assert case.contact.local.liquid.model_dump() == {"density": 998.2, "viscosity": 1.002e-3}
    again = vi.case_of(resolved_case(case))
    assert again.contact.local == case.contact.local
    assert vi.case_of(wet(False)).contact.local.liquid is None
    assert "liquid" not in resolved_case(vi.case_of(wet(False)))["contact"]


def test_a_check_tells_what_is_left_and_a_run_achieves_it() -> None:
    case = vi.case_of(wet({"viscosity": "0.3 Pa s"}))
    told = case_document(case)["first_impact"]
    first = {name: values[0] for name, values in vi.simulate(case).impacts.items()}
    assert first["restitution_asked"] == pytest.approx(told["restitution_asked"], rel=1e-12)
    # gravity
    assert first["restitution_achieved"] == pytest.approx(told["restitution_achieved"], rel=1e-2)
    assert case_document(case)["case"]["contact"]["restitution"] == 0.8
    assert 0.2 < told["restitution_asked"] < 0.7


def test_a_check_tells_what_to_ask_in_air() -> None:
    contact = {"law": "hunt-crossley", "restitution": 0.8, "liquid": {"viscosity": "0.1 Pa s"}}
    told = case_document(vi.case_of(wet(contact=contact)))["first_impact"]
    again = case_document(
        vi.case_of(wet(contact={**contact, "restitution": told["restitution_to_ask"]}))
    )["first_impact"]
    assert told["restitution_achieved"] > told["restitution_asked"] + 0.02
    assert again["restitution_achieved"] == pytest.approx(told["restitution_asked"], rel=1e-6)


def test_the_ledger_and_the_history_know_of_it() -> None:
    response = vi.simulate(vi.case_of(wet({"viscosity": "0.3 Pa s"}, run={"impacts": 3})))
    assert response.energy["closure_relative"] < 1e-9
    lost = response.impacts["energy_lost_J"].sum()
    assert response.history()["contact_dissipated_J"].max() == pytest.approx(lost, rel=1e-6)


GLASS = {
    "radius": 0.005,
    "material": {"density": 2500.0, "youngs_modulus": 70e9, "poissons_ratio": 0.22},
}
PLATE = {
    "size": [0.4, 0.3, 0.02],
    "material": "steel",
    "model": "elastic",
    "supports": "clamped",
    "modes": 5,
    "damping": 0.02,
}
FRICTION = {"law": "mdr", "coefficient": 0.1}


@pytest.mark.parametrize("number", [None, "500 mm"])
def test_a_sphere_that_falls_in_it_does_not_fall_in_a_vacuum(number: str | None) -> None:
    """10 mm of glass in water: 0.70 m/s, not the 4.42 m/s of a fall of 1 m in a vacuum; a
    check tells it as well.
    """
    case = vi.case_of(wet(sphere=GLASS, drop={"height": number or 1.0}, run={"impacts": 1}))
    response = vi.simulate(case)
    assert response.impacts["approach_speed_m_s"][0] == pytest.approx(0.7025, abs=1e-4)
    assert case_document(case)["first_impact"]["approach_speed_m_s"] == pytest.approx(
        response.impacts["approach_speed_m_s"][0], rel=1e-9
    )


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"run": {"duration": 1.2}},
        {"run": {"impacts": "all"}},
        {
            "drop": {"speed": 2.0, "angle": "30 deg", "spin": [0.0, 20.0, 5.0]},
            "plate": {"material": "steel", "inclination": "5 deg", "size": [2.0, 2.0, 0.02]},
        },
        pytest.param({"plate": PLATE}, marks=pytest.mark.slow),
        pytest.param(
            {"plate": {**PLATE, "motion": {"amplitude": "0.1 mm", "frequency": "30 Hz"}}},
            marks=pytest.mark.slow,
        ),
    ],
)
def test_histories_keep_energy_with_what_the_liquid_takes(changes: dict[str, Any]) -> None:
    """Energy goes to drag, and to liquid that moves along and is turned with the sphere."""
    contact = {"law": "tsuji", "restitution": 0.8, "liquid": True}
    if "angle" in changes.get("drop", {}):
        contact["friction"] = FRICTION
    drop = {"sphere": GLASS, "drop": {"height": 0.2}, "contact": contact, "run": {"impacts": 3}}
    response = vi.simulate(vi.case_of(wet(**{**drop, **changes})))
    assert response.energy["closure_relative"] < 1e-9
    history = response.history()
    entries = [
        name
        for name in response.energy
        if name in history and not name.startswith(("microslip", "gross"))
    ]
    np.testing.assert_allclose(
        sum(history[name] for name in entries), response.energy["input_J"], rtol=1e-7
    )
    assert history["liquid_J"][-1] == pytest.approx(response.energy["liquid_J"], rel=1e-9)
    assert response.energy["liquid_J"] > 0.0
    assert np.all(response.impacts["liquid_lost_J"] >= 0.0)
    assert history["liquid_J"].min() >= -1e-5 * response.energy["input_J"], (
        "gravity goes on in the contact"
    )
    assert (
        response.history(columns=["kinetic_J"])["kinetic_J"].tolist()
        == history["kinetic_J"].tolist()
    )


def test_at_rest_it_presses_with_its_weight_less_buoyancy() -> None:
    response = vi.simulate(
        vi.case_of(wet(sphere=GLASS, drop={"height": 0.1}, run={"impacts": "all"}))
    )
    assert response.outcomes[0].at_rest
    history = response.history(columns=["force_N"])
    volume = 4.0 / 3.0 * np.pi * 0.005**3
    assert history["force_N"][-1] == pytest.approx(volume * (2500.0 - 998.2) * 9.80665, rel=1e-9)


def test_a_heavy_liquid_bears_the_sphere() -> None:
    mercury = {"density": 13534.0, "viscosity": "1.5 mPa s"}
    with pytest.raises(
        vi.InputError,
        match=r"contact\.liquid\.density: .* 5\.414 times the density of the sphere, which "
        r"floats in it",
    ):
        vi.case_of(wet(mercury, sphere=GLASS))
    response = vi.simulate(
        vi.case_of(
            wet(mercury, sphere=GLASS, drop={"speed": 1.0, "gravity": 0.0}, run={"impacts": 1})
        )
    )
    assert response.impacts["restitution_asked"][0] == pytest.approx(0.8, rel=1e-2)
    problem = vi.case_of(wet(sphere=GLASS)).to_problem()
    parts = {"sphere": problem.sphere, "plate": problem.plate, "laws": problem.laws, "speed": 1.0}
    with pytest.raises(vi.InputError, match="floats in it"):
        vi.Problem(**parts, liquid=vi.Liquid(density=3000.0))  # type: ignore[arg-type]
    with pytest.raises(vi.InputError, match="either in a liquid or in air"):
        vi.Problem(**parts, liquid=vi.Liquid(), air=vi.Air())  # type: ignore[arg-type]


def test_a_law_is_calibrated_along_a_drop_in_it() -> None:
    table = wet(
        sphere=GLASS,
        drop={"height": 0.5},
        contact={"law": "hunt-crossley", "restitution": 0.8, "liquid": True},
        run={"impacts": 4},
    )
    found = calibrate_case(
        calibration_of(
            {**table, "calibrate": {"target": {"restitution": 0.7}, "model": "hunt-crossley"}}
        )
    )
    newton = vi.simulate(
        vi.case_of({**table, "contact": {"law": "newton", "restitution": 0.7, "liquid": True}})
    ).impacts
    for drop, tolerance in (("target", 1e-9), ("variable", 3e-4)):
        np.testing.assert_allclose(
            found.drops[drop]["approach_speed_m_s"], newton["approach_speed_m_s"], rtol=tolerance
        )


def test_rebound_heights_measured_in_it_give_the_restitution_back() -> None:
    table = wet(
        sphere=GLASS,
        drop={"height": 0.5},
        contact={"law": "newton", "restitution": 0.8, "liquid": True},
        run={"impacts": 4},
    )
    heights = vi.simulate(vi.case_of(table)).impacts["rebound_height_m"].tolist()
    measured = {**table, "calibrate": {"target": {"rebound_heights": heights}, "degree": 0}}
    found = calibrate_case(calibration_of(measured))
    np.testing.assert_allclose(found.values, 0.8, rtol=1e-6)
    assert "buoyancy, drag and added mass of the liquid" in found.observations.notes[0]
    with pytest.raises(vi.InputError, match=r"flies through a liquid, as given by contact\.liquid"):
        calibrate_case(
            calibration_of({**table, "calibrate": {**measured["calibrate"], "air": True}})
        )


def test_an_elastic_plate_is_hit_in_it() -> None:
    impacts = {
        viscosity: vi.simulate(
            vi.case_of(wet({"viscosity": viscosity}, plate=PLATE, run={"impacts": 1}))
        ).impacts
        for viscosity in (1e-9, 0.5)
    }
    thin, thick = (found["restitution_achieved"][0] for found in impacts.values())
    assert thick < 0.75 * thin
    assert "sensitivity" not in impacts[0.5]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"contact": {"law": "hertz", "liquid": True}},
            "contact.liquid: hertz takes no restitution, of which a liquid leaves a part",
        ),
        (
            {"plate": {"material": "steel", "radius": 0.1}},
            "contact.liquid: what a liquid leaves of the restitution is known for a sphere",
        ),
        (
            {"drop": {"height": 1.0, "air": True}},
            "drop.air: the sphere meets the plate in a liquid",
        ),
        (
            {"contact": {"law": "tsuji", "restitution": 0.8, "liquid": "water"}},
            "contact.liquid: .*it must be true, false, or a table",
        ),
        (
            {"contact": {"law": "tsuji", "restitution": 0.8, "liquid": {"viscosty": 1.0}}},
            "Did you mean",
        ),
        (
            {"contact": {"law": "tsuji", "restitution": 0.8, "liquid": {"viscosity": 0.0}}},
            "contact.liquid.viscosity",
        ),
    ],
)
def test_what_is_not_known_is_refused(change: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.case_of(wet(**change))


def test_problems_check_their_liquid() -> None:
    problem = vi.case_of(wet()).to_problem()
    parts = {"sphere": problem.sphere, "plate": problem.plate, "speed": 1.0}
    with pytest.raises(vi.InputError, match="liquid must be a Liquid"):
        vi.Problem(**parts, laws=problem.laws, liquid=1.0)  # type: ignore[arg-type]
    with pytest.raises(vi.InputError, match="hertz takes no restitution"):
        vi.Problem(
            **parts, laws=(vi.laws.find_contact_law("hertz")(stiffness=1e9),), liquid=vi.Liquid()
        )
    damped = vi.laws.find_contact_law("linear-spring-dashpot")(stiffness=1e6, damping=10.0)
    with pytest.raises(
        vi.InputError,
        match=r"is given without a restitution, .*; give it one in place of damping, or take "
        r"another law",
    ):
        vi.Problem(**parts, laws=(damped,), liquid=vi.Liquid())
    with pytest.raises(
        vi.InputError, match="viscosity of a liquid must be a finite number greater than 0"
    ):
        vi.Liquid(viscosity=[1.0, -1.0])


def test_studies_sweep_it_as_arrays(tmp_path: Path) -> None:
    over = {
        "contact.liquid.viscosity": ["1 mPa s", "100 mPa s", "10 Pa s"],
        "drop.speed": [1.0, 2.0],
    }
    sweep = vi.studies.sweep_of({**wet(run={"impacts": 1}), "sweep": {"over": over}})
    study = vi.studies.load_study(vi.studies.run_sweep(sweep, tmp_path / "study"))
    singly = [
        float(vi.simulate(sweep.case_of(drop)).impacts["restitution_achieved"][0])
        for drop in range(6)
    ]
    np.testing.assert_allclose(
        study.values("first_restitution_achieved").ravel(), singly, rtol=1e-9
    )
    stokes = 10.0 / study.values("limit_no_rebound")
    np.testing.assert_allclose(
        study.values("first_restitution_asked"), 0.8 * restitution_kept(stokes), rtol=1e-5
    )
    assert study.values("limit_no_rebound").argmax() == 4


def test_too_slow_an_impact_is_doubted() -> None:
    def number(viscosity: str) -> float:
        case = vi.case_of(wet({"viscosity": viscosity}))
        return float(numbers_of(Conditions(resolved_case(case), expected_of(case)))["no_rebound"])

    assert number("0.5 Pa s") < 1.0 < number("2 Pa s")
    assert any(
        "spheres were seen to stay on the wall" in doubt
        for doubt in case_document(vi.case_of(wet({"viscosity": "2 Pa s"})))["doubts"]
    )


def test_programs_do_not_get_it(tmp_path: Path) -> None:
    vi.simulate(vi.case_of(wet(drop={"height": 0.5}))).save(tmp_path / "run")
    with pytest.raises(vi.InputError, match="programs get contacts without a liquid"):
        as_rigid(drop_in_folder(tmp_path / "run"))


def test_single_keys_of_it_are_set() -> None:
    table = with_values(wet(), {"contact.liquid.viscosity": "0.2 Pa s"})
    assert table["contact"]["liquid"] == {"viscosity": "0.2 Pa s"}
