"""Drops through air: the key of the case, batches, histories, sweeps, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.dynamics.motion.columns import LEDGER, OBLIQUE_LEDGER, VIBRATION_LEDGER
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.structures.modal_model import ModalBasis

SKEW = vi.Oblique(velocity=(0.4, -0.2), gravity=(0.3, 0.0))
RUBBER = {"density": 1100.0, "youngs_modulus": 5e6, "poissons_ratio": 0.48}


def case(air: Any = True, **changes: Any) -> dict:
    return plain_case(
        sphere={"radius": 0.013, "material": RUBBER}, drop={"height": 1.0, "air": air}, **changes
    )


def test_no_air_is_a_vacuum() -> None:
    table = case(False)
    without = vi.simulate(vi.case_of(table))
    del table["drop"]["air"]
    again = vi.simulate(vi.case_of(table))
    assert all(type(bounce.flight) is Flight for bounce in without.bounces or ())
    assert "air_J" not in without.energy
    for name, values in again.impacts.items():
        np.testing.assert_array_equal(values, without.impacts[name])


def test_thin_air_tends_to_a_vacuum() -> None:
    """What the air takes goes with its density, and with it the time and the speed of
    every impact.
    """
    vacuum = vi.simulate(vi.case_of(case(False))).impacts
    off = []
    for density in (1e-4, 1e-6):
        found = vi.simulate(
            vi.case_of(case({"density": density, "drag_coefficient": 0.44}))
        ).impacts
        off.append(found["approach_speed_m_s"] - vacuum["approach_speed_m_s"])
    np.testing.assert_allclose(off[0], 100.0 * off[1], rtol=2e-4)
    assert np.all(off[0] < 0.0)


@pytest.mark.parametrize("law", ["hunt-crossley", pytest.param("newton", marks=pytest.mark.slow)])
@pytest.mark.parametrize("run", [{"impacts": 3}, {"impacts": "all"}, {"duration": 2.0}])
@pytest.mark.parametrize("drop", [{}, {"velocity": [3.0, 0.0, 2.0], "spin": [0.0, 50.0, 0.0]}])
def test_histories_keep_energy_and_show_the_drag(
    law: str, run: dict[str, Any], drop: dict[str, Any]
) -> None:
    table = case(contact={"law": law, "restitution": 0.8}, run=run)
    table["drop"] |= drop
    response = vi.simulate(vi.case_of(table))
    assert response.energy["closure_relative"] < 1e-12
    history = response.history()
    entries = [values for name, values in history.items() if name.endswith("_J")]
    np.testing.assert_allclose(sum(entries), response.energy["input_J"], rtol=1e-10)
    assert history["air_J"][-1] == pytest.approx(response.energy["air_J"], rel=1e-12)
    assert np.all(np.diff(history["air_J"]) >= -1e-15)
    time = 0.3 * float(response.impacts["time_s"][1]) + 0.7 * float(response.impacts["time_s"][0])
    near = response.at(time + np.array([-1e-4, 0.0, 1e-4]))
    slope = (near["velocity_m_s"][2] - near["velocity_m_s"][0]) / 2e-4
    assert near["acceleration_m_s2"][1] == pytest.approx(slope, rel=1e-6)
    assert near["acceleration_m_s2"][1] < -float(response.problem.gravity), (
        "on the way up drag pulls down as well"
    )


@pytest.mark.slow
def test_a_batch_is_its_drops() -> None:
    """Spheres of 0.1 to 50 mm at once, in air of several densities, obliquely."""
    radius, density = np.geomspace(1e-4, 0.05, 6), np.linspace(0.5, 1.5, 6)
    ball = vi.Body(mass=4.0 / 3.0 * np.pi * radius**3 * 2600.0, contact_offset=radius)
    law = vi.laws.find_contact_law("newton")(restitution=0.7)
    oblique = vi.Oblique(velocity=(np.linspace(0.0, 2.0, 6), 1.0), gravity=(1.0, 0.0))
    stated = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        height=0.5,
        velocity=2.0,
        air=vi.Air(density=density),
        oblique=oblique,
        impacts=3,
    )
    together = vi.simulate(stated)
    table = vi.tabulate(stated)
    for number in range(6):
        alone = vi.simulate(stated.take(number))
        for name, values in alone.impacts.items():
            np.testing.assert_allclose(
                together.impacts[name][number], values, rtol=1e-11, atol=1e-13, err_msg=name
            )
            np.testing.assert_allclose(
                table.impacts[name][number], values, rtol=1e-11, atol=1e-13, err_msg=name
            )
        times = np.linspace(0.0, float(alone.end_time[0]), 50)
        one = together.drop(number)
        for name, values in one.at(np.minimum(times, one.end_time[0])).items():
            np.testing.assert_allclose(
                values, alone.at(times)[name], rtol=1e-9, atol=1e-11, err_msg=name
            )


def test_without_gravity_air_stops_what_leaves() -> None:
    table = {
        **case(contact={"law": "newton", "restitution": 0.5}),
        "drop": {"speed": 2.0, "gravity": 0.0, "air": True},
    }
    assert "never comes back" in vi.simulate(vi.case_of({**table, "run": {"impacts": 3}})).status
    response = vi.simulate(vi.case_of({**table, "run": {"duration": 1e6}}))
    assert response.energy["closure_relative"] < 1e-12
    assert 0.0 <= float(response.energy["kinetic_J"]) < 1e-20
    assert float(response.energy["air_J"]) == pytest.approx(
        0.25 * float(response.energy["input_J"]), rel=1e-12
    )


def test_a_resolved_case_is_the_same_case(tmp_path: Path) -> None:
    for air, resolved in (
        (True, {"density": 1.2, "viscosity": 1.81e-5}),
        ({"density": "0.9 kg/m^3", "viscosity": "17 uPa s"}, {"density": 0.9, "viscosity": 17e-6}),
        ({"drag_coefficient": 0.5}, {"density": 1.2, "drag_coefficient": 0.5}),
    ):
        response = vi.simulate(vi.case_of(case(air)))
        response.save(tmp_path / "found", force=True)
        again = vi.load_case(tmp_path / "found" / "case.toml")
        assert again.drop.air is not None
        assert again.drop.air.model_dump(exclude_none=True) == pytest.approx(resolved)
        np.testing.assert_array_equal(
            vi.simulate(again).impacts["time_s"], response.impacts["time_s"]
        )


@pytest.mark.parametrize("air", [True, {"drag_coefficient": 0.4}, False])
def test_studies_sweep_air(air: Any, tmp_path: Path) -> None:
    """The densities are one batch, whether the case has air or not."""
    table = case(air)
    over = {"drop.air.density": [0.6, 2.4], "sphere.radius": [0.01, 0.02]}
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**table, "sweep": {"over": over}}), tmp_path / "study"
        )
    )
    for place in ((0, 1), (1, 0)):
        values = {key: options[at] for at, (key, options) in zip(place, over.items(), strict=True)}
        alone = vi.tabulate(vi.case_of(with_values(table, values)))
        for name in ("approach_speed_m_s", "air_lost_J"):
            np.testing.assert_allclose(study.values(name, *place), alone.impacts[name], rtol=1e-10)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"drop__air": "thick"},
            r"drop\.air.*true, false, or a table with any of density, viscosity, drag_coefficient",
        ),
        ({"drop__air": {"densty": 1.0}}, r"drop\.air\.densty.*density"),
        ({"drop__air": {"density": -1.0}}, r"drop\.air\.density.*greater than 0"),
        (
            {"drop__air": {"viscosity": 1e-5, "drag_coefficient": 0.4}},
            r"drop\.air\.drag_coefficient.*leave one of them out",
        ),
        (
            {"drop__air": {"density": 1000.0, "viscosity": 1e-3}},
            r"drop\.air\.density.*90\.9 %.*buoyancy",
        ),
    ],
)
def test_bad_input_is_told_in_one_sentence(changes: dict[str, Any], words: str) -> None:
    table = case()
    for path, value in changes.items():
        section, key = path.split("__")
        table[section][key] = value
    with pytest.raises(vi.InputError, match=words):
        vi.case_of(table)


def test_python_is_told_as_well() -> None:
    law = vi.laws.find_contact_law("newton")(restitution=0.8)
    with pytest.raises(
        vi.InputError, match="viscosity of air must be a finite number greater than 0"
    ):
        vi.Air(viscosity=0.0)
    for ball, words in (
        (vi.Body(mass=1e-3, contact_offset=0.1), "buoyancy"),
        (vi.Body(mass=1e-3, contact_offset=0.0), "needs a radius"),
    ):
        with pytest.raises(vi.InputError, match=words):
            vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0, air=vi.Air())


def test_data_is_exported_with_air_and_programs_get_none(tmp_path: Path) -> None:
    vi.simulate(vi.case_of(case(run={"impacts": 1}))).save(tmp_path / "found")
    vi.exporting.export_result(tmp_path / "found", "csv", tmp_path / "data")
    assert "air_lost_J" in (tmp_path / "data" / "impacts.csv").read_text(encoding="utf-8")
    with pytest.raises(vi.InputError, match=r"drop\.air.*vacuum"):
        vi.exporting.export_result(tmp_path / "found", "lammps", tmp_path / "out")


@pytest.mark.parametrize("size", [1e-9, 0.4])
@pytest.mark.parametrize(
    "more",
    [pytest.param({}, marks=pytest.mark.slow), {"oblique": SKEW}],
    ids=["vertical", "oblique"],
)
def test_bodies_that_vibrate_in_air(size: float, more: dict[str, Any]) -> None:
    """Modes that hardly move leave the numbers of rigid bodies; others the balance of
    energy, with what air takes.
    """
    law = vi.laws.find_contact_law("hunt-crossley")(stiffness=5e8, restitution=0.7)
    ball, drop = (
        vi.Body(mass=0.02, contact_offset=0.02),
        {"height": 2.0, "impacts": 3, "air": vi.Air()},
    )
    random = np.random.default_rng(5)
    contact, along = size * random.normal(size=8), size * random.normal(size=(8, 2))
    modes = ModalBasis(
        np.geomspace(150.0, 9e3, 8),
        np.full(8, 0.001),
        contact,
        np.zeros((8, 3)),
        mass=3.0,
        along=along,
    )
    plate = vi.Body(mass=np.inf, contact_offset=0.0, modes=modes)
    found = vi.simulate(vi.Problem(sphere=ball, plate=plate, laws=(law,), **drop, **more))
    if size < 1e-3:
        rigid = vi.simulate(
            vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), **drop, **more)
        )
        for name in ("time_s", "approach_speed_m_s", "rebound_height_m", "air_lost_J"):
            np.testing.assert_allclose(found.impacts[name], rigid.impacts[name], rtol=1e-9)
    assert found.energy["closure_relative"] < 1e-9
    history = found.history()
    entries = [
        name for name in history if name in (*LEDGER, *VIBRATION_LEDGER, *OBLIQUE_LEDGER, "air_J")
    ]
    np.testing.assert_allclose(
        sum(history[name] for name in entries), found.energy["input_J"], rtol=1e-7
    )


def test_falls_through_air_onto_a_plate_that_rings() -> None:
    """The second touch of a sphere that air slows down, against an integration of sphere
    and mode between the contacts by SciPy.
    """
    law = vi.laws.find_contact_law("hertz")(stiffness=5e8)
    ball = vi.Body(mass=0.02, contact_offset=0.02)
    modes = ModalBasis(
        np.array([180.0]), np.array([1e-4]), np.array([1.2]), np.zeros((1, 3)), mass=1.0
    )
    plate = vi.Body(mass=np.inf, contact_offset=0.0, modes=modes)
    problem = vi.Problem(sphere=ball, plate=plate, laws=(law,), height=3.0, impacts=2, air=vi.Air())
    response = vi.simulate(problem)
    row = response.impacts
    start, omega = float(row["time_s"][0] + row["duration_s"][0]), 2.0 * np.pi * 180.0
    begin = response.at([start])
    density = 0.02 / (4.0 / 3.0 * np.pi * 0.02**3)
    q, velocity = float(response.modal([start])["plate"][0, 0]), float(begin["velocity_m_s"][0])
    eps = 1e-7
    rate = float(response.modal([start + eps])["plate"][0, 0] - q) / eps + 0.5 * eps * omega**2 * q

    def rates(_: float, state: Any) -> list[float]:
        _, up, place, moving = state
        reynolds = max(1.2 * abs(up) * 0.04 / 1.81e-5, 1e-12)
        coefficient = 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) + 0.42 / (
            1.0 + 42500.0 * reynolds**-1.16
        )
        slowed = 0.375 * 1.2 / density * coefficient * up * abs(up) / 0.02
        return [up, -9.80665 - slowed, moving, -(omega**2) * place - 2e-4 * omega * moving]

    def apart(_: float, state: Any) -> float:
        return float(state[0] - 1.2 * state[2])

    apart.terminal, apart.direction = True, -1.0  # type: ignore[attr-defined]
    gap = float(begin["position_m"][0]) - 0.02
    found = solve_ivp(
        rates,
        (0.0, 3.0),
        [gap + 1e-9, velocity, q, rate],
        events=apart,
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        max_step=1e-3,
    )
    assert start + found.t[-1] == pytest.approx(row["time_s"][1], abs=2e-7)
    assert found.y[1, -1] == pytest.approx(-row["approach_speed_m_s"][1], rel=1e-6)
