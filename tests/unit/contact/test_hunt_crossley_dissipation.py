"""Hunt and Crossley's law with its dissipation d in s/m, as multibody programs take it: F
= K delta^n (1 + d delta_dot).
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from exported_drops import MASS, STIFFNESS, told
from oracles.adams import Bounce, Motion
from oracles.adams_dataset import read_dataset, read_solver_commands
from support import plain_case
from vibroimpact.cases.build import resolved_case
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.dynamics.restitution import integrated_restitution
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.formats import adams_solver, exudyn, lammps, matlab

LAW = HuntCrossley(stiffness=STIFFNESS, dissipation=0.08)


def rebound(
    stiffness: float, exponent: float, dissipation: float, mass: float, speed: float
) -> tuple[float, float]:
    """Return restitution and largest force of an impact without gravity, integrated by SciPy."""

    def force(state: np.ndarray) -> float:
        return stiffness * max(state[0], 0.0) ** exponent * (1.0 + dissipation * state[1])

    def leaves(_: float, state: np.ndarray) -> float:
        return state[0]

    leaves.terminal, leaves.direction = True, -1  # type: ignore[attr-defined]
    long = (
        20.0
        * (mass / stiffness) ** (1.0 / (1.0 + exponent))
        * speed ** ((1.0 - exponent) / (1.0 + exponent))
    )
    options = {
        "method": "DOP853",
        "rtol": 1e-12,
        "atol": 1e-16,
        "events": leaves,
        "dense_output": True,
    }
    found = solve_ivp(
        lambda _, state: [state[1], -force(state) / mass], (0.0, long), [0.0, speed], **options
    )
    assert found.status == 1
    moments = np.linspace(0.0, found.t[-1], 20001)
    return -found.y[1, -1] / speed, max(force(found.sol(moment)) for moment in moments)


@pytest.mark.parametrize(
    ("exponent", "dissipation", "speed"),
    [(1.5, 0.08, 0.3), (1.5, 0.3, 5.0), (1.0, 0.5, 2.0), (2.2, 0.02, 9.0)],
)
def test_an_independent_integration(exponent: float, dissipation: float, speed: float) -> None:
    stiffness, mass = 1e8, 0.1
    law = HuntCrossley(stiffness=stiffness, exponent=exponent, dissipation=dissipation)
    problem = vi.Problem(
        sphere=vi.Body(mass, 0.01),
        plate=vi.rigid_plate(),
        laws=law,
        speed=speed,
        gravity=0.0,
        impacts=1,
        tolerance=1e-11,
    )
    row = vi.simulate(problem).impacts
    restitution, force = rebound(stiffness, exponent, dissipation, mass, speed)
    assert row["restitution_achieved"][0] == pytest.approx(restitution, rel=1e-9)
    assert row["max_force_N"][0] == pytest.approx(force, rel=1e-6)
    assert law.closed_form_restitution(mass, speed) == pytest.approx(restitution, rel=1e-9)


def test_the_restitution_falls_with_the_speed() -> None:
    """At low speeds e = 1 - alpha v with d = 3/2 alpha (Hunt and Crossley 1975), and at
    all speeds by D = d v.
    """
    speed = np.array([1e-4, 0.5, 5.0, 50.0])
    found = vi.laws.achieved_restitution(LAW, mass=0.3, speed=speed)
    assert (1.0 - found[0]) / speed[0] == pytest.approx(LAW.dissipation / 1.5, rel=1e-5)
    np.testing.assert_allclose(found, integrated_restitution(LAW, 0.3, speed), rtol=1e-9)
    for one, at in zip(found, speed, strict=True):
        same = (
            HuntCrossley(stiffness=1.0, restitution=1.0 - LAW.dissipation * at / 1.5)
            if at < 10.0
            else None
        )
        assert same is None or vi.laws.achieved_restitution(
            same, mass=0.3, speed=at
        ) == pytest.approx(one, rel=1e-12)


def test_the_dissipation_that_achieves_a_restitution() -> None:
    tuned = vi.laws.law_achieving(LAW, 0.6, mass=0.3, speed=2.0)
    assert (tuned.restitution, tuned.free_parameter) == (None, "dissipation")
    assert vi.laws.achieved_restitution(tuned, mass=0.3, speed=2.0) == pytest.approx(0.6, rel=1e-9)


def test_in_a_case() -> None:
    found = vi.simulate(
        vi.case_of(
            plain_case(
                contact={"law": "hunt-crossley", "dissipation": "0.08 s/m"}, run={"impacts": 4}
            )
        )
    ).impacts
    e = found["restitution_achieved"]
    assert np.all(np.diff(e) > 0.0)
    assert np.isnan(found["restitution_asked"]).all()
    without_gravity = LAW.closed_form_restitution(1.0, found["approach_speed_m_s"])
    np.testing.assert_allclose(e, without_gravity, rtol=1e-3)
    again = vi.case_of(
        resolved_case(vi.case_of(plain_case(contact={"law": "hunt-crossley", "dissipation": 0.08})))
    )
    assert again.contact.parameters["dissipation"] == 0.08


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        ({}, "hunt-crossley needs either restitution or dissipation"),
        ({"restitution": 0.7, "dissipation": 0.1}, "and not both"),
        ({"dissipation": -0.1}, "contact.dissipation"),
        ({"dissipation": "0.1 N s/m"}, "is a damping"),
    ],
)
def test_what_is_refused(contact: dict[str, object], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.simulate(vi.case_of(plain_case(contact={"law": "hunt-crossley", **contact})))


def test_compared_at_a_restitution() -> None:
    """Where a case has no restitution, that of the other laws is tuned; its own
    dissipation is, under the same law.
    """
    case = vi.case_of(
        plain_case(contact={"law": "hunt-crossley", "dissipation": 0.08}, run={"impacts": 1})
    )
    compared = vi.laws.compare_laws(case, ["hunt-crossley", "flores", "hertz"], achieving=0.7)
    for name in ("hunt-crossley", "flores"):
        assert compared.results[name].impacts["restitution_achieved"][0] == pytest.approx(
            0.7, abs=1e-3
        )
    of_hertz = vi.case_of(plain_case(contact={"law": "hertz"}, run={"impacts": 1}))
    compared = vi.laws.compare_laws(of_hertz, ["hunt-crossley", "hertz"], achieving=0.7)
    assert compared.results["hunt-crossley"].impacts["restitution_achieved"][0] == pytest.approx(
        0.7, abs=1e-3
    )


def moved(drop: Drop, *, always: bool = True) -> list[Bounce]:
    """Return the bounces of a drop as the parser reads them from its export for Adams."""
    files = adams_solver.FORMAT.write(drop)
    name = next(name[:-4] for name in files if name.endswith(".adm"))
    model = read_dataset(files[f"{name}.adm"].decode())
    read_solver_commands(files[f"{name}.acf"].decode(), model)
    return Motion(model).run(always=always)


@pytest.mark.parametrize("always", [True, False])
def test_for_adams(always: bool) -> None:
    """The factor of the force is the dissipation times the stored approach speed."""
    drop = told(LAW, height=2.0)
    bounces = moved(drop, always=always)
    np.testing.assert_allclose(
        [one.separation_speed for one in bounces], drop.impacts["separation_speed_m_s"], rtol=1e-7
    )
    np.testing.assert_allclose(
        [one.largest_force for one in bounces], drop.impacts["max_force_N"], rtol=1e-7
    )


def test_for_adams_with_a_value_for_each_impact() -> None:
    drop = told(LAW, replace(LAW, dissipation=0.02), height=2.0, number=2)
    np.testing.assert_allclose(
        [one.separation_speed for one in moved(drop)],
        drop.impacts["separation_speed_m_s"],
        rtol=1e-7,
    )


def test_for_exudyn() -> None:
    text = next(iter(exudyn.FORMAT.write(told(LAW)).values())).decode()
    head = text[: text.index("now = SimpleNamespace")]
    made: dict = {}
    exec(re.sub(r"import exudyn as exu\nfrom exudyn.*?\)\n", "", head, flags=re.DOTALL), made)
    for delta, rate in ((1e-5, 2.0), (3e-4, -1.2)):
        wanted = float(sum(LAW.forces(delta, rate, 2.0)))
        assert made["contact_force"](delta, rate, 2.0, made["parameters"](0, 2.0)) == pytest.approx(
            wanted, rel=1e-12
        )


def test_others_say_that_the_restitution_is_that_of_the_first_impact() -> None:
    drop = told(LAW)
    assert any("stays the same" in note for note in lammps.FORMAT.notes(drop))
    text = next(iter(lammps.FORMAT.write(drop).values())).decode()
    first = float(
        vi.laws.achieved_restitution(LAW, MASS, float(drop.impacts["approach_speed_m_s"][0]))
    )
    assert f"vector [{first!r}" in text
    assert matlab.FORMAT.write(drop)
