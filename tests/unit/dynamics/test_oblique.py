"""Oblique drops: symmetries, balances, histories, and cases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.arrays import Floats
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.dynamics.motion.columns import LEDGER, OBLIQUE_LEDGER, VIBRATION_LEDGER
from vibroimpact.dynamics.rigid import drops as drops_of_rigid
from vibroimpact.dynamics.rigid import rubbed_contact
from vibroimpact.runs.tables import ledger_table

RADIUS, MASS = 0.01, 0.02
PAIR = {"effective_modulus": 1e9, "effective_shear_modulus": 0.8e9, "effective_radius": RADIUS}
FRICTION = {
    "none": None,
    "mdr": vi.friction.find_friction_law("mdr")(coefficient=0.3, **PAIR),
    "mindlin": vi.friction.find_friction_law("mindlin")(coefficient=0.3, **PAIR),
    "mindlin-rescale": vi.friction.find_friction_law("mindlin-rescale")(coefficient=0.3, **PAIR),
    "mindlin-force": vi.friction.find_friction_law("mindlin-force")(coefficient=0.3, **PAIR),
    "coulomb": vi.friction.find_friction_law("coulomb")(coefficient=0.3),
    "rigid": vi.friction.find_friction_law("rigid")(coefficient=0.3, slip_restitution=0.4),
}
WITH_ROLLING = {
    **FRICTION,
    "rolls": vi.friction.find_friction_law("mdr")(coefficient=0.3, rolling_coefficient=0.1, **PAIR),
}
LAWS = {
    "hertz": vi.laws.find_contact_law("hertz")(stiffness=1.3e8),
    "hunt-crossley": vi.laws.find_contact_law("hunt-crossley")(stiffness=1.3e8, restitution=0.7),
    "tsuji": vi.laws.find_contact_law("tsuji")(
        stiffness=1.3e8, restitution=0.7, effective_mass=MASS
    ),
    "adams-impact": vi.laws.find_contact_law("adams-impact")(stiffness=1.3e8, damping_max=20.0),
    "thornton": vi.laws.find_contact_law("thornton")(
        effective_modulus=1e9, effective_radius=RADIUS, yield_pressure=2e7
    ),
}
CASE: dict[str, Any] = {
    "sphere": {
        "radius": "10 mm",
        "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.2},
    },
    "plate": {
        "size": ["2 m", "1 m", "20 mm"],
        "material": {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3},
    },
    "drop": {"speed": "3 m/s", "angle": "30 deg", "position": ["-300 mm", 0]},
    "contact": {
        "law": "hunt-crossley",
        "restitution": 0.6,
        "friction": {"law": "mdr", "coefficient": 0.2},
    },
    "run": {"impacts": 3},
}
ELASTIC_PLATE = {
    **CASE["plate"],
    "size": ["600 mm", "400 mm", "20 mm"],
    "model": "elastic",
    "modes": 20,
    "supports": "clamped",
    "damping": 0.01,
}


def problem(law: str = "hertz", **changes: Any) -> vi.Problem:
    values: dict[str, Any] = {"speed": 2.0, "gravity": 9.81, "impacts": 3, **changes}
    return vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(LAWS[law],),
        **values,
    )


def spinning(friction: str) -> vi.Oblique:
    return vi.Oblique(velocity=(1.0, 0.4), spin=(10.0, -30.0, 50.0), friction=FRICTION[friction])


def kinetic(impacts: dict[str, Floats], when: str) -> Floats:
    """Return the energy of the motion along the plate and of the rotation, before or after [J]."""
    motion, side = {"before": ("approach", "before"), "after": ("separation", "after")}[when]
    velocity = sum(impacts[f"{motion}_velocity_{axis}_m_s"] ** 2 for axis in "xy")
    spin = sum(impacts[f"spin_{axis}_{side}_rad_s"] ** 2 for axis in "xyz")
    return np.asarray(0.5 * MASS * velocity + 0.2 * MASS * RADIUS**2 * spin)


def test_random_impacts_lose_in_microslip_and_in_gross_slip() -> None:
    """Both parts are losses, to the error of the integration, and friction took them
    together; all of steep impacts is gross.
    """
    random, number = np.random.default_rng(3), 3000
    pair = {
        "effective_modulus": 1e9,
        "effective_shear_modulus": 1e9 * random.uniform(0.3, 1.2, number),
        "effective_radius": RADIUS,
    }
    friction = vi.friction.find_friction_law("mdr")(
        coefficient=10.0 ** random.uniform(-2.0, 1.0, number), **pair
    )
    slip = 10.0 ** random.uniform(-3.0, 1.3, number)
    oblique = vi.Oblique(velocity=(slip, 0.0), friction=friction)
    law = vi.laws.find_contact_law("hunt-crossley")(
        stiffness=1.3e8, restitution=random.uniform(0.1, 1.0, number)
    )
    found = vi.tabulate(
        replace(
            problem(oblique=oblique, impacts=1),
            laws=(law,),
            speed=10.0 ** random.uniform(-1.0, 1.0, number),
        )
    )
    energy, lost, micro, gross = (
        np.ravel(values) / (MASS / 7.0 * slip**2)
        for values in (
            MASS / 7.0 * slip**2,
            *(found.impacts[f"{name}_lost_J"] for name in ("friction", "microslip", "gross_slip")),
        )
    )
    np.testing.assert_allclose(micro + gross, lost, atol=1e-12)
    assert micro.min() > -1e-5
    assert gross.min() > -1e-5
    assert 0.2 < (micro == 0.0).mean() < 0.6
    assert (lost < energy + 1e-9).all()


@pytest.mark.parametrize(
    "friction", ["coulomb", "rigid", *(name for name in FRICTION if name.startswith("m"))]
)
def test_contacts_that_slide_throughout_know_no_microslip(friction: str) -> None:
    """Neither does the slipping and rolling that follows the bounces."""
    response = vi.simulate(
        problem(
            oblique=vi.Oblique(velocity=(30.0, 0.4), friction=FRICTION[friction]),
            impacts=None,
            duration=3.0,
        )
    )
    assert not response.impacts["microslip_lost_J"][0]
    assert response.impacts["gross_slip_lost_J"][0] == response.impacts["friction_lost_J"][0]
    energy = response.energy
    assert energy["microslip_J"] == pytest.approx(
        response.impacts["microslip_lost_J"].sum(), rel=1e-12
    )
    assert energy["microslip_J"] + energy["gross_slip_J"] == pytest.approx(
        energy["friction_J"], rel=1e-12
    )


def test_the_ledger_shows_both_parts_of_friction_where_a_result_has_them() -> None:
    result = vi.result_of(vi.simulate(problem(oblique=spinning("mdr"))))
    rows = {row.title: row.energy for row in ledger_table(result)[1]}
    assert {"Lost in microslip", "Lost in gross slip"} < set(rows)
    assert "Lost by friction" not in rows
    older = replace(
        result, energy={name: value for name, value in result.energy.items() if "slip" not in name}
    )
    without = {row.title: row.energy for row in ledger_table(older)[1]}
    assert "Lost by friction" in without
    assert without["Sum"] == rows["Sum"]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("friction", FRICTION)
def test_the_normal_motion_does_not_feel_the_friction(law: str, friction: str) -> None:
    # of several drops, whose contacts are solved together with friction and without it
    speeds = np.array([2.0, 2.5])
    plain = vi.tabulate(problem(law, speed=speeds, same_spot=False))
    oblique = vi.tabulate(problem(law, speed=speeds, same_spot=False, oblique=spinning(friction)))
    for name, values in plain.impacts.items():
        np.testing.assert_array_equal(oblique.impacts[name], values)
    assert oblique.status == plain.status


@pytest.mark.parametrize("friction", FRICTION)
@pytest.mark.parametrize("law", LAWS)
def test_energy_is_not_made_and_the_impulse_turns_the_sphere(law: str, friction: str) -> None:
    impacts = vi.tabulate(
        problem(
            law,
            oblique=vi.Oblique(
                velocity=(1.0, 0.4), spin=(10.0, -30.0, 50.0), friction=FRICTION[friction]
            ),
        )
    ).impacts
    lost = kinetic(impacts, "before") - kinetic(impacts, "after")
    np.testing.assert_allclose(
        impacts["friction_lost_J"], lost, atol=1e-12 * kinetic(impacts, "before").max()
    )
    assert (lost >= -1e-9 * kinetic(impacts, "before")).all()
    change = {
        axis: impacts[f"separation_velocity_{axis}_m_s"] - impacts[f"approach_velocity_{axis}_m_s"]
        for axis in "xy"
    }
    turn = {
        axis: impacts[f"spin_{axis}_after_rad_s"] - impacts[f"spin_{axis}_before_rad_s"]
        for axis in "xyz"
    }
    np.testing.assert_allclose(turn["y"], -2.5 * change["x"] / RADIUS, atol=1e-9)
    np.testing.assert_allclose(turn["x"], 2.5 * change["y"] / RADIUS, atol=1e-9)
    assert (impacts["spin_z_after_rad_s"] >= 0.0).all()
    assert (impacts["spin_z_after_rad_s"] <= 50.0).all()


@pytest.mark.parametrize("friction", ["mdr", "mindlin-rescale", "coulomb", "rolls"])
def test_directions_are_alike(friction: str) -> None:
    """What falls in another direction moves on alike; a mirror image is a mirror image."""
    angle = np.array([0.0, 0.7, 2.0, 4.0])
    cos, sin = np.cos(angle), np.sin(angle)
    spin = (10.0 * cos - 20.0 * sin, 10.0 * sin + 20.0 * cos, 5.0)
    found = vi.tabulate(
        problem(
            "hunt-crossley",
            oblique=vi.Oblique(
                velocity=(1.0 * cos, 1.0 * sin), spin=spin, friction=WITH_ROLLING[friction]
            ),
        )
    )
    x, y = (found.impacts[f"separation_velocity_{axis}_m_s"] for axis in "xy")
    back = cos[:, None] * x + sin[:, None] * y, -sin[:, None] * x + cos[:, None] * y
    for part in back:
        np.testing.assert_allclose(part, np.broadcast_to(part[0], part.shape), atol=1e-12)
    mirrored = vi.tabulate(
        problem(
            "hunt-crossley",
            oblique=vi.Oblique(
                velocity=(1.0, 0.0), spin=(-10.0, 20.0, -5.0), friction=WITH_ROLLING[friction]
            ),
        )
    )
    np.testing.assert_allclose(mirrored.impacts["separation_velocity_x_m_s"], x[0], atol=1e-12)
    np.testing.assert_allclose(mirrored.impacts["separation_velocity_y_m_s"], -y[0], atol=1e-12)


def test_coulomb_ends_in_rolling() -> None:
    """A sphere that stops slipping rolls with 5/7 of its velocity; one with backspin that
    just suffices stops.
    """
    oblique = vi.Oblique(
        velocity=(0.7, 0.0), friction=vi.friction.find_friction_law("coulomb")(coefficient=10.0)
    )
    impacts = vi.tabulate(problem(oblique=oblique, gravity=0.0, impacts=1)).impacts
    assert impacts["tangential_restitution"][0] == pytest.approx(5.0 / 7.0, abs=1e-14)
    back = vi.Oblique(
        velocity=(0.7, 0.0), spin=(0.0, -2.5 * 0.7 / RADIUS, 0.0), friction=oblique.friction
    )
    assert vi.tabulate(problem(oblique=back, gravity=0.0, impacts=1)).impacts[
        "separation_velocity_x_m_s"
    ][0] == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("law", ["hertz", "hunt-crossley", "adams-impact"])
@pytest.mark.parametrize("friction", ["mdr", "mindlin", "coulomb", "rolls"])
def test_histories_conserve_energy_and_end_where_impacts_do(law: str, friction: str) -> None:
    oblique = vi.Oblique(
        velocity=(1.0, 0.4),
        spin=(10.0, -30.0, 50.0),
        position=(0.1, -0.2),
        gravity=(2.0, 0.5),
        friction=WITH_ROLLING[friction],
    )
    response = vi.simulate(problem(law, oblique=oblique, speed=None, height=0.3, velocity=0.5))
    history = response.history()
    assert set(history) == set(response.history_columns)
    entries = (
        "kinetic_J",
        "potential_J",
        "contact_elastic_J",
        "contact_dissipated_J",
        *OBLIQUE_LEDGER,
    )
    total = sum(history[name] for name in entries)
    np.testing.assert_allclose(total, response.energy["input_J"], rtol=1e-8)
    assert response.energy["closure_relative"] < 1e-12
    for impact in range(3):
        touch = float(response.impacts["time_s"][impact])
        parts = response.at([touch, touch + float(response.impacts["duration_s"][impact])])
        for axis in "xy":
            velocity = [
                response.impacts[f"{when}_velocity_{axis}_m_s"][impact]
                for when in ("approach", "separation")
            ]
            np.testing.assert_allclose(parts[f"velocity_{axis}_m_s"], velocity, atol=1e-8)
        np.testing.assert_allclose(
            parts["spin_y_rad_s"],
            [response.impacts[f"spin_y_{when}_rad_s"][impact] for when in ("before", "after")],
            atol=1e-5,
        )
    place = 0.1 + 1.0 * history["time_s"] + history["time_s"] ** 2
    flying = history["time_s"] < response.impacts["time_s"][0]
    np.testing.assert_allclose(history["position_x_m"][flying], place[flying], rtol=1e-14)


def test_a_batch_is_its_drops() -> None:
    speeds = np.array([0.1, 0.8, 3.0])
    whole = vi.simulate(
        problem(
            "hunt-crossley", oblique=vi.Oblique(velocity=(speeds, 0.2), friction=FRICTION["mdr"])
        )
    )
    for drop, speed in enumerate(speeds):
        alone = vi.simulate(
            problem(
                "hunt-crossley", oblique=vi.Oblique(velocity=(speed, 0.2), friction=FRICTION["mdr"])
            )
        )
        for name, values in alone.impacts.items():
            np.testing.assert_allclose(
                whole.drop(drop).impacts[name], values, rtol=1e-12, atol=1e-15
            )
        time = np.linspace(0.0, float(alone.end_time[0]), 50)
        np.testing.assert_allclose(
            whole.drop(drop).at(time)["position_x_m"], alone.at(time)["position_x_m"], rtol=1e-12
        )


@pytest.mark.parametrize("friction", ["mdr", "mindlin", "mindlin-rescale", "mindlin-force"])
def test_friction_of_a_drop_does_not_depend_on_its_neighbours(friction: str) -> None:
    """Bit for bit."""
    oblique = vi.Oblique(velocity=(np.linspace(0.05, 6.0, 40), 0.2), friction=FRICTION[friction])
    drops = problem("hunt-crossley", impacts=1, oblique=oblique)
    together = vi.tabulate(drops).impacts
    for drop in range(0, 40, 3):
        for name, values in vi.tabulate(drops.take(drop)).impacts.items():
            np.testing.assert_array_equal(together[name][drop], values, err_msg=name)


@pytest.mark.parametrize(
    ("law", "friction"),
    [
        (law, friction)
        for law in (*LAWS, "linear-spring-dashpot", "walton-braun")
        for friction in FRICTION
    ]
    + [("thornton", "rolls")],
)
def test_an_oblique_drop_is_what_it_is_alone(law: str, friction: str) -> None:
    """Its numbers don't depend on the size of the batch, on its place in it, or on its
    neighbours, to the last digit.
    """
    size = 30
    others = {
        "linear-spring-dashpot": {"stiffness": 2e6, "restitution": 0.7, "effective_mass": MASS},
        "walton-braun": {"stiffness": 1e6, "restitution": 0.6},
    }
    normal = LAWS[law] if law in LAWS else vi.laws.find_contact_law(law)(**others[law])
    oblique = vi.Oblique(
        velocity=(np.linspace(0.05, 6.0, size), 0.2),
        spin=(10.0, -30.0, 50.0),
        friction=WITH_ROLLING[friction],
    )
    ball, plate = vi.Body(mass=MASS, contact_offset=RADIUS), vi.rigid_plate()
    speeds = np.geomspace(0.05, 5.0, size)
    drops = vi.Problem(
        sphere=ball,
        plate=plate,
        laws=(normal,),
        speed=speeds,
        gravity=9.81,
        impacts=3,
        oblique=oblique,
    )
    together = vi.tabulate(drops).impacts
    turned = vi.tabulate(drops.take(np.arange(size)[::-1])).impacts
    for drop in range(0, size, 7):
        alone = vi.tabulate(drops.take(np.array([drop]))).impacts
        rows = alone["impact"].shape[1]
        for name, values in alone.items():
            np.testing.assert_array_equal(together[name][drop, :rows], values[0], err_msg=name)
            np.testing.assert_array_equal(
                turned[name][size - 1 - drop, :rows], values[0], err_msg=name
            )


@pytest.mark.parametrize("friction", ["mdr", "mindlin", "mindlin-rescale"])
@pytest.mark.parametrize("law", ["hunt-crossley", "linear-spring-dashpot"])
def test_spins_are_bounded_whatever_the_moduli(law: str, friction: str) -> None:
    """A spring whose oscillation needs steps in several parts once came to 1e58 rad/s,
    and one whose force jumps to a hundredfold.
    """
    size = 3000
    random = np.random.default_rng(11)
    normal = {
        "hunt-crossley": LAWS["hunt-crossley"],
        "linear-spring-dashpot": vi.laws.find_contact_law("linear-spring-dashpot")(
            stiffness=2e6, restitution=0.7, effective_mass=MASS
        ),
    }
    moduli = 10 ** random.uniform(6.5, 11.9, (2, size))
    pair = {
        "effective_modulus": moduli[0],
        "effective_shear_modulus": moduli[1],
        "effective_radius": RADIUS,
    }
    rubs = vi.friction.find_friction_law(friction)(
        coefficient=10 ** random.uniform(-2.0, 0.7, size), **pair
    )
    slip, speed = random.uniform(0.0, 3.0, size), random.uniform(0.3, 10.0, size)
    drops = vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(normal[law],),
        speed=speed,
        gravity=0.0,
        impacts=1,
        oblique=vi.Oblique(velocity=(slip, 0.0), friction=rubs),
    )
    spin = vi.tabulate(drops).impacts["spin_y_after_rad_s"][:, 0]
    # as much as a slip makes that is turned back whole
    assert (np.abs(spin) <= 2.0 * 2.5 / 3.5 * slip / RADIUS * 1.1).all()


def energies_of_random_impacts(
    number: int, seed: int, rolling: float = 0.0
) -> tuple[Floats, Floats]:
    """Return the energies along the plate before and after random impacts [J]; `rolling`:
    coefficient of rolling friction.
    """
    random = np.random.default_rng(seed)
    before, after, size = [], [], min(number, 8000)
    for _ in range(0, number, size):
        pair = {
            "effective_modulus": 10 ** random.uniform(7, 11, size),
            "effective_shear_modulus": 10 ** random.uniform(7, 11, size),
        }
        friction = vi.friction.find_friction_law("mdr")(
            coefficient=10 ** random.uniform(-3, 1, size),
            rolling_coefficient=rolling,
            effective_radius=RADIUS,
            **pair,
        )
        law = vi.laws.find_contact_law("hunt-crossley")(
            stiffness=4.0 / 3.0 * pair["effective_modulus"] * 0.1,
            restitution=random.uniform(0.0, 1.0, size),
        )
        speed, angle = 10 ** random.uniform(-1, 1, size), random.uniform(0.0, 0.5 * np.pi, size)
        spin = tuple(random.normal(0.0, 1.0, size) * speed / RADIUS for _ in range(3))
        oblique = vi.Oblique(velocity=(speed * np.sin(angle), 0.0), spin=spin, friction=friction)
        ball = vi.Body(mass=MASS, contact_offset=RADIUS)
        drops = vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=speed * np.cos(angle) + 1e-3,
            gravity=0.0,
            impacts=1,
            oblique=oblique,
        )
        impacts = vi.tabulate(drops).impacts
        before.append(kinetic(impacts, "before")[:, 0])
        after.append(kinetic(impacts, "after")[:, 0])
    return np.concatenate(before), np.concatenate(after)


def no_random_impact_makes_energy(number: int) -> None:
    before, after = energies_of_random_impacts(number, 5)
    assert np.isfinite(after).all()
    assert (after <= before * (1.0 + 1e-9)).all()


def test_no_random_impact_makes_energy() -> None:
    no_random_impact_makes_energy(4000)


@pytest.mark.slow
def test_none_of_a_million_random_impacts_makes_energy(population: Callable[[int], int]) -> None:
    no_random_impact_makes_energy(population(1_000_000))


@pytest.mark.slow
@pytest.mark.parametrize("rolling", [0.01, 0.3, 10.0])
def test_no_random_impact_makes_energy_by_rolling_resistance(rolling: float) -> None:
    before, after = energies_of_random_impacts(400, 6, rolling)
    assert (after <= before * (1.0 + 1e-9)).all()
    assert (after < before * 0.99).mean() > 0.9


def test_an_inclined_plate_pulls_along_x() -> None:
    case = {
        **CASE,
        "plate": {**CASE["plate"], "inclination": "20 deg"},
        "drop": {"height": "110 mm"},
        "contact": {"law": "newton", "restitution": 0.5},
    }
    response = vi.simulate(vi.case_of(case))
    touch = float(response.impacts["time_s"][0])
    gravity = 9.80665
    assert touch == pytest.approx(np.sqrt(2.0 * 0.1 / (gravity * np.cos(np.radians(20.0)))))
    assert response.impacts["position_x_m"][0] == pytest.approx(
        0.5 * gravity * np.sin(np.radians(20.0)) * touch**2
    )
    assert response.impacts["approach_velocity_x_m_s"][0] == pytest.approx(
        gravity * np.sin(np.radians(20.0)) * touch
    )


@pytest.mark.parametrize("gravity", [0.0, 9.0])
@pytest.mark.parametrize("law", ["hertz", "hunt-crossley"])
def test_the_softest_touch_of_a_slope_closes_its_ledger(law: str, gravity: float) -> None:
    """At 1e-9 m/s nearly all energy is what gravity brings down the plate, up to 1e27
    times that at first touch.
    """
    oblique = vi.Oblique(gravity=(2.0, 0.0), friction=FRICTION["coulomb"])
    response = vi.simulate(problem(law, speed=1e-9, gravity=gravity, impacts=5, oblique=oblique))
    energy = response.energy
    assert -energy["potential_J"] > 1e10 * energy["input_J"]
    assert energy["closure_relative"] < 1e-11  # a hundredth of the tolerance
    assert abs(energy["closure_J"]) < 1e-11 * -energy["potential_J"]


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_a_history_has_both_sides_of_an_impulse(restitution: float) -> None:
    """The motion along the plate and the spin jump where the normal velocity does, and a
    sphere lies on with what the last impulse left.
    """
    law, oblique = (
        vi.laws.find_contact_law("newton")(restitution=restitution),
        vi.Oblique(velocity=([1.0, 2.0], 0.4), friction=FRICTION["rigid"]),
    )
    batch = vi.simulate(replace(problem(oblique=oblique, impacts=None), laws=(law,), duration=0.6))
    for number in range(2):
        response = batch.drop(number)
        history, impacts, energy = response.history(), response.impacts, response.energy
        jumps = np.flatnonzero(np.diff(history["velocity_m_s"]) > 0.1)
        for side, at, spun in (("approach", jumps, "before"), ("separation", jumps + 1, "after")):
            assert history["velocity_x_m_s"][at] == pytest.approx(
                impacts[f"{side}_velocity_x_m_s"][: len(jumps)], rel=1e-12
            )
            assert history["spin_y_rad_s"][at] == pytest.approx(
                impacts[f"spin_y_{spun}_rad_s"][: len(jumps)], abs=1e-12
            )
        assert len(jumps) >= 1
        assert history["friction_J"][jumps + 1] == pytest.approx(
            np.cumsum(impacts["friction_lost_J"])[: len(jumps)], rel=1e-12
        )
        for name in ("friction_J", "rotation_J", "kinetic_J"):
            assert history[name][-1] == pytest.approx(energy[name], rel=1e-12), name


def test_a_sphere_falls_off_the_edge() -> None:
    response = vi.simulate(
        vi.case_of({**CASE, "drop": {"velocity": [5.0, 0, -3.0], "position": ["900 mm", 0]}})
    )
    assert response.outcomes == (vi.Outcome.FELL,)
    assert response.status.startswith("The sphere falls off the edge of the plate after 1 impact, ")
    assert len(response.impacts["time_s"]) == 1


def test_a_flight_over_the_uphill_edge_and_back() -> None:
    """A parabola whose top lies 25 mm beyond the edge, and which comes down 55 mm within
    it: what counts is where the sphere is then.
    """
    oblique = vi.Oblique(
        velocity=(-1.0, 0.0), position=(-0.9, 0.0), gravity=(4.0, 0.0), size=(2.0, 1.0)
    )
    falls = {
        "height": RADIUS + 0.5 * 9.81 * 0.45**2,
        "speed": None,
        "impacts": 1,
        "oblique": oblique,
    }
    response = vi.simulate(problem(**falls))
    assert response.at([0.25])["position_x_m"][0] == pytest.approx(-1.025, rel=1e-12)
    assert response.impacts["position_x_m"][0] == pytest.approx(-0.945, rel=1e-12)
    assert "falls off" not in response.status


def test_angle_speed_and_velocity_say_the_same() -> None:
    one = vi.simulate(vi.case_of(CASE))
    drop = {
        "velocity": [3.0 * np.sin(np.radians(30)), 0.0, -3.0 * np.cos(np.radians(30))],
        "position": ["-300 mm", 0],
    }
    other = vi.simulate(vi.case_of({**CASE, "drop": drop}))
    for name, values in one.impacts.items():
        np.testing.assert_allclose(other.impacts[name], values, rtol=1e-9, atol=1e-12)


def test_a_resolved_case_is_the_same_case(tmp_path: Path) -> None:
    response = vi.simulate(
        vi.case_of({**CASE, "drop": {**CASE["drop"], "spin": [0, "100 rad/s", 5]}})
    )
    response.save(tmp_path / "run")
    again = vi.simulate(vi.load_case(tmp_path / "run" / "case.toml"))
    result = vi.load_result(tmp_path / "run")
    for name, values in response.impacts.items():
        np.testing.assert_array_equal(again.impacts[name], values)
        np.testing.assert_allclose(result.impacts[name], values, rtol=1e-15)
    assert "Motion along the plate" in (tmp_path / "run" / "report.html").read_text(
        encoding="utf-8"
    )


def test_studies_sweep_angles_friction_and_spin(tmp_path: Path) -> None:
    over = {
        "drop.angle": ["10 deg", "40 deg"],
        "contact.friction.coefficient": [0.1, 0.3],
        "drop.spin.y": ["-50 rad/s", "50 rad/s"],
    }
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**CASE, "sweep": {"over": over}}), tmp_path / "study"
        )
    )
    assert study.size == 8
    for place in ((0, 1, 0), (1, 0, 1)):
        values = {key: options[at] for at, (key, options) in zip(place, over.items(), strict=True)}
        alone = vi.tabulate(vi.case_of(with_values(CASE, values)))
        np.testing.assert_allclose(
            study.values("tangential_restitution", *place),
            alone.impacts["tangential_restitution"],
            rtol=1e-10,
        )


def with_friction(**table: Any) -> dict[str, Any]:
    return {"contact": {"law": "hertz", "friction": table}}


FAULTS: list[tuple[dict[str, Any], str]] = [
    (
        {"drop": {"speed": 3.0, "angle": "95 deg"}},
        'drop.angle: "95 deg" is not allowed; it must be greater than -1.5708 and less than',
    ),
    (
        {"drop": {"velocity": [1.0, 0.0, 2.0]}},
        "drop.velocity: its z is 2 m/s, which does not lead to the plate; at "
        "first touch it is negative",
    ),
    (
        {"drop": {"speed": 3.0, "velocity": [1.0, 0.0, -2.0]}},
        "drop: give either speed or velocity; both are given",
    ),
    (
        {"drop": {"height": 1.0, "angle": 0.2}},
        "drop.angle: an angle needs the speed at first touch; give speed in place of "
        "height, or leave this out",
    ),
    (
        {
            "contact": {
                "law": "newton",
                "restitution": 0.5,
                "friction": {"law": "mdr", "coefficient": 0.2},
            }
        },
        "contact.friction.law: newton gives no normal force, which mdr follows; take "
        "another contact law, or friction by the impulse",
    ),
    (
        {
            "plate": ELASTIC_PLATE,
            "contact": {
                "law": "newton",
                "restitution": 0.5,
                "friction": {"law": "mdr", "coefficient": 0.2},
            },
        },
        "contact.friction.law: newton gives no normal force, which mdr follows; take "
        "another contact law",
    ),
    (
        with_friction(law="mindlinn"),
        'contact.friction.law: there is no friction law "mindlinn"; there are "none", "coulomb"',
    ),
    (
        with_friction(coefficient=0.2),
        'contact.friction: it needs law = "...", one of "none", "coulomb", "mdr"',
    ),
    (
        with_friction(law="mdr"),
        "contact.friction.coefficient: this key is missing; mdr needs coefficient of friction mu",
    ),
    (
        with_friction(law="coulomb", coefficient=-0.1),
        "contact.friction.coefficient: -0.1 is not allowed; it must be at least 0",
    ),
    (
        with_friction(law="coulomb", coefficient=0.1, rolling_coefficient=-1),
        "contact.friction.rolling_coefficient: -1 is not allowed; it must be at least 0",
    ),
    (
        with_friction(law="coulomb", mu=0.1),
        'contact.friction.mu: unknown key "mu"; coulomb takes coefficient, rolling_coefficient.',
    ),
    (
        {"plate": ELASTIC_PLATE, **with_friction(law="coulomb", coefficient=0.1)},
        "contact.friction.law: coulomb has no tangential compliance, which friction needs "
        "on bodies that deform or",
    ),
    (
        {"plate": {**CASE["plate"], "inclination": "90 deg"}},
        'plate.inclination: "90 deg" is not allowed; it must be greater than',
    ),
]


@pytest.mark.parametrize(("changes", "words"), FAULTS)
def test_bad_input_is_told_in_one_sentence(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError) as told:
        vi.case_of({**CASE, **changes}).to_problem()
    assert str(told.value).startswith(words)


def test_sliding_is_bounded_also_where_gravity_turns_it() -> None:
    """A coefficient of zero leaves the motion as it is, whichever way gravity pulls."""
    for friction in ("coulomb", "rigid", "mdr"):
        law = vi.friction.find_friction_law(friction)(
            coefficient=0.0, **({} if friction in ("coulomb", "rigid") else PAIR)
        )
        found = vi.tabulate(
            problem(
                oblique=vi.Oblique(velocity=(1e-4, 0.0), gravity=(-3.0, 0.0), friction=law),
                impacts=1,
            )
        ).impacts
        expected = 1e-4 - 3.0 * found["duration_s"][0]
        assert found["separation_velocity_x_m_s"][0] == pytest.approx(expected, rel=1e-8)
        assert abs(found["friction_lost_J"][0]) < 1e-14


def test_a_normal_force_that_pulls_gives_no_slip_back() -> None:
    """Where all slips Coulomb's friction and Mindlin's contact are one law, also at the
    end of a contact that is drawn out.
    """
    found = {}
    for friction in ("mdr", "coulomb"):
        oblique = vi.Oblique(velocity=(30.0, 0.0), friction=FRICTION[friction])
        found[friction] = vi.simulate(problem("tsuji", oblique=oblique, impacts=1)).impacts[
            "separation_velocity_x_m_s"
        ][0]
    assert found["coulomb"] == pytest.approx(found["mdr"], abs=1e-4)


def test_a_dent_is_left_behind() -> None:
    moved = vi.tabulate(problem("thornton", oblique=vi.Oblique(velocity=(1.0, 0.0)))).impacts[
        "restitution_achieved"
    ]
    fresh = vi.tabulate(problem("thornton", same_spot=False)).impacts["restitution_achieved"]
    np.testing.assert_allclose(moved, fresh, rtol=1e-12)
    stays = vi.tabulate(problem("thornton", oblique=vi.Oblique(spin=(0.0, 0.0, 5.0)))).impacts[
        "restitution_achieved"
    ]
    np.testing.assert_allclose(
        stays, vi.tabulate(problem("thornton")).impacts["restitution_achieved"], rtol=1e-12
    )


@pytest.mark.parametrize(
    "law", ["hunt-crossley", "tsuji", "adams-impact", "walton-braun", "adams-poisson"]
)
def test_sliding_takes_the_coefficient_of_the_normal_impulse(law: str) -> None:
    """Also where the normal force has a kink or a jump."""
    others = {
        "walton-braun": vi.laws.find_contact_law("walton-braun")(stiffness=1e6, restitution=0.6),
        "adams-poisson": vi.laws.find_contact_law("adams-poisson")(penalty=1e6, restitution=0.6),
    }
    laws = LAWS | others
    ball, plate = vi.Body(mass=MASS, contact_offset=RADIUS), vi.rigid_plate()
    for friction in ("mdr", "coulomb", "rigid"):
        oblique = vi.Oblique(velocity=(np.array([30.0, 50.0]), 0.0), friction=FRICTION[friction])
        drops = vi.Problem(
            sphere=ball,
            plate=plate,
            laws=(laws[law],),
            speed=2.0,
            gravity=0.0,
            impacts=1,
            oblique=oblique,
        )
        for impacts in (vi.tabulate(drops).impacts, vi.simulate(drops).impacts):
            pushed = MASS * (2.0 + impacts["separation_speed_m_s"][:, 0])
            pushed_along = (
                MASS
                * (impacts["approach_velocity_x_m_s"] - impacts["separation_velocity_x_m_s"])[:, 0]
            )
            least = 1.0 if law == "tsuji" else 1.0 - 1e-5  # whose end pulls
            assert (pushed_along >= least * 0.3 * pushed).all()
            assert (pushed_along <= (1.02 if law == "tsuji" else 1.0 + 1e-5) * 0.3 * pushed).all()


@pytest.mark.parametrize("friction", ["mdr", "mindlin", "mindlin-rescale", "mindlin-force"])
def test_sliding_throughout_is_what_the_integration_finds(
    friction: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Angles about that from which the contact slips all the time, with the shortcut for
    these and without it.
    """
    oblique = vi.Oblique(velocity=(np.linspace(1.0, 6.0, 60), 0.0), friction=FRICTION[friction])
    short = vi.tabulate(problem("hunt-crossley", oblique=oblique, impacts=1)).impacts[
        "separation_velocity_x_m_s"
    ]
    monkeypatch.setattr(rubbed_contact, "_ROUNDING_AT_RELEASE", -1e9)
    whole = vi.tabulate(problem("hunt-crossley", oblique=oblique, impacts=1)).impacts[
        "separation_velocity_x_m_s"
    ]
    np.testing.assert_allclose(short, whole, atol=1e-5)


@pytest.mark.parametrize("law", ["hertz", "hunt-crossley", "walton-braun"])
@pytest.mark.parametrize("friction", ["mdr", "mindlin", "mindlin-rescale", "mindlin-force"])
def test_more_steps_change_little(law: str, friction: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """From sticking to sliding throughout, so that contacts begin to stick at every point
    of the grid, and where its parts meet.
    """
    laws = LAWS | {
        "walton-braun": vi.laws.find_contact_law("walton-braun")(stiffness=1e6, restitution=0.6)
    }
    slip = np.linspace(0.05, 6.0, 400)
    oblique = vi.Oblique(velocity=(slip, 0.0), friction=FRICTION[friction])
    ball, plate = vi.Body(mass=MASS, contact_offset=RADIUS), vi.rigid_plate()
    drops = vi.Problem(
        sphere=ball,
        plate=plate,
        laws=(laws[law],),
        speed=2.0,
        gravity=0.0,
        impacts=1,
        oblique=oblique,
    )
    found = vi.tabulate(drops).impacts["separation_velocity_x_m_s"][:, 0]
    monkeypatch.setattr(drops_of_rigid, "friction_steps", lambda tolerance: 48)
    more = vi.tabulate(drops).impacts["separation_velocity_x_m_s"][:, 0]
    assert (np.abs(found - more) < 1e-4 * slip).all()


@pytest.mark.parametrize("friction", FRICTION)
def test_a_force_that_ends_and_begins_again_is_followed(friction: str) -> None:
    """Of Tsuji's law a force of nearly nothing is left after it has ended; this once gave
    a spring that was no number.
    """
    rng = np.random.default_rng(0)
    speed, angle = rng.uniform(1.0, 5.0, 1000), rng.uniform(0.0, 1.3, 1000)
    law = vi.laws.find_contact_law("tsuji")(stiffness=1.333e8, restitution=0.7, effective_mass=0.03)
    drops = vi.Problem(
        sphere=vi.Body(mass=rng.uniform(0.01, 0.1, 1000), contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(law,),
        speed=speed * np.cos(angle),
        gravity=0.0,
        impacts=1,
        oblique=vi.Oblique(velocity=(speed * np.sin(angle), 0.0), friction=FRICTION[friction]),
    )
    assert not vi.tabulate(drops).failures


def test_values_at_keys_are_not_shared() -> None:
    one = with_values({"drop": {"height": 1.0}}, {"drop.spin.y": 100.0})
    other = with_values({"drop": {"height": 1.0}}, {"drop.spin.x": 7.0})
    assert (one["drop"]["spin"], other["drop"]["spin"]) == ([0.0, 100.0, 0.0], [7.0, 0.0, 0.0])


def test_python_is_told_as_well() -> None:
    outside = {"position": (1.0, 0.0), "size": (1.0, 1.0)}
    wrongs: list[Any] = [
        {"velocity": ("a", 0)},
        {"inertia_ratio": np.inf},
        {"size": (1.0,)},
        {"size": 2.0},
        outside,
    ]
    for wrong in wrongs:
        with pytest.raises(vi.InputError):
            vi.Oblique(**wrong)
    with pytest.raises(vi.InputError, match="velocity of an oblique drop has 2 values, not 3"):
        vi.Oblique(velocity=3)  # type: ignore[arg-type]
    newton = {
        "sphere": vi.Body(mass=MASS, contact_offset=RADIUS),
        "plate": vi.rigid_plate(),
        "laws": vi.laws.find_contact_law("newton")(restitution=0.5),
    }
    with pytest.raises(vi.InputError, match="newton gives no normal force for mdr to follow"):
        vi.Problem(**newton, speed=1.0, oblique=vi.Oblique(friction=FRICTION["mdr"]))
    with pytest.raises(vi.InputError, match="may turn needs a radius"):
        vi.Problem(
            **{**newton, "sphere": vi.Body(mass=MASS, contact_offset=0.0)},
            speed=1.0,
            oblique=spinning("coulomb"),
        )
    with pytest.raises(vi.InputError, match="velocity is that at a height"):
        vi.Problem(**newton, speed=1.0, velocity=0.5)


DROP_ON_ELASTIC = {
    "speed": "3 m/s",
    "angle": "10 deg",
    "position": ["-100 mm", "20 mm"],
    "gravity": "60 m/s^2",
}


def on_elastic(**changes: Any) -> dict[str, Any]:
    sensors = [{"name": "a1", "position": ["50 mm", "60 mm"]}]
    return {**CASE, "plate": ELASTIC_PLATE, "drop": DROP_ON_ELASTIC, "sensors": sensors, **changes}


def case_of(**changes: Any) -> vi.Case:
    return vi.case_of(on_elastic(**changes))


@pytest.mark.parametrize("spin", [30.0, 100.0])
def test_the_ledger_of_a_spin_about_the_normal_closes_on_a_plate_that_vibrates(spin: float) -> None:
    """Soft and slow, so that the slip ends within the contact: the moment of twisting
    changes fast there.
    """
    soft = {
        "radius": "20 mm",
        "material": {"density": 2600, "youngs_modulus": "2 GPa", "poissons_ratio": 0.3},
    }
    drop = {"velocity": [0.5, -0.2, -1.1], "spin": [10, -20, spin]}
    contact = {
        "law": "thornton",
        "yield_pressure": "1 GPa",
        "friction": {"law": "mindlin", "coefficient": 0.3},
    }
    plate = {
        **ELASTIC_PLATE,
        "size": ["400 mm", "300 mm", "10 mm"],
        "modes": 12,
        "supports": "simply-supported",
        "damping": 0.0,
    }
    response = vi.simulate(
        case_of(sphere=soft, plate=plate, drop=drop, contact=contact, run={"impacts": 1})
    )
    assert response.energy["closure_relative"] < 1e-9


def test_an_oblique_drop_on_a_plate_that_vibrates(tmp_path: Path) -> None:
    """Each impact is where the sphere is by then; history, ledger, sensors and folder
    have both its motion and the plate's.
    """
    response = vi.simulate(case_of())
    places = np.stack([response.impacts["position_x_m"], response.impacts["position_y_m"]])
    assert len(places[0]) == 3
    assert places[0, 0] == pytest.approx(-0.1, abs=1e-9)
    assert (np.diff(places[0]) > 0.01).all()
    history = response.history()
    ledger = sum(history[name] for name in (*LEDGER, *VIBRATION_LEDGER, *OBLIQUE_LEDGER))
    np.testing.assert_allclose(ledger, ledger[0], rtol=1e-7)
    assert history["friction_J"][-1] == pytest.approx(
        response.impacts["friction_lost_J"].sum(), rel=1e-9
    )
    assert response.energy["closure_relative"] < 1e-9
    response.save(tmp_path / "run")
    result = vi.load_result(tmp_path / "run")
    np.testing.assert_allclose(
        result.impacts["tangential_restitution"],
        response.impacts["tangential_restitution"],
        rtol=1e-15,
    )
    assert "Motion along the plate" in (tmp_path / "run" / "report.html").read_text(
        encoding="utf-8"
    )


def test_the_plate_is_another_one_at_another_place() -> None:
    """The second impact is as a first one would be there, but for what still vibrates,
    which damping takes before it.
    """
    plate = {**ELASTIC_PLATE, "damping": 0.4}
    first = vi.simulate(case_of(plate=plate, run={"impacts": 2}))
    row = {name: values[1] for name, values in first.impacts.items()}
    drop = {
        "velocity": [
            row["approach_velocity_x_m_s"],
            row["approach_velocity_y_m_s"],
            -row["approach_speed_m_s"],
        ],
        "spin": [row[f"spin_{axis}_before_rad_s"] for axis in "xyz"],
        "position": [row["position_x_m"], row["position_y_m"]],
        "gravity": "60 m/s^2",
    }
    alone = vi.simulate(case_of(plate=plate, drop=drop, run={"impacts": 1})).impacts
    for name in ("separation_speed_m_s", "separation_velocity_x_m_s", "max_force_N", "duration_s"):
        assert alone[name][0] == pytest.approx(row[name], rel=1e-6)
    elsewhere = vi.simulate(
        case_of(plate=plate, drop={**drop, "position": [0.2, 0.1]}, run={"impacts": 1})
    ).impacts
    assert abs(elsewhere["max_force_N"][0] / row["max_force_N"] - 1.0) > 3e-4


def test_falling_off_the_edge_of_a_plate_that_vibrates() -> None:
    drop = {"height": "0.5 m", "velocity": ["1.5 m/s", 0, 0], "position": ["-100 mm", 0]}
    response = vi.simulate(case_of(drop=drop))
    assert "falls off the edge of the plate after 0 impacts" in response.status


def test_studies_of_oblique_drops_on_a_plate_that_vibrates(tmp_path: Path) -> None:
    over = {"drop.angle": ["0 deg", "40 deg"]}
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**on_elastic(run={"impacts": 1}), "sweep": {"over": over}}),
            tmp_path / "study",
        )
    )
    alone = vi.simulate(case_of(run={"impacts": 1}, drop={**DROP_ON_ELASTIC, "angle": "40 deg"}))
    assert float(study.values("tangential_restitution", 1)[0]) == float(
        alone.impacts["tangential_restitution"][0]
    )


def test_a_statement_names_what_it_takes() -> None:
    with pytest.raises(
        vi.InputError,
        match=r'such as vi\.friction\.find_friction_law\("coulomb"\)\(coefficient=0\.3\), not <class',
    ):
        vi.Oblique(friction=vi.friction.find_friction_law("coulomb"))  # type: ignore[arg-type]
    assert (
        vi.Oblique(friction=vi.friction.find_friction_law("coulomb")(coefficient=0.3)).shape == ()
    )
    assert vi.Oblique(size=np.array([0.5, 0.4])).shape == ()  # type: ignore[arg-type]
    with pytest.raises(
        vi.InputError,
        match="from its centre the plate reaches half its length along x and half its width along "
        "y",
    ):
        vi.Oblique(size=(0.5, 0.4), position=(0.0, 0.21))
