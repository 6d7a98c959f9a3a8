"""Numbers of the page on the numerics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import vibroimpact as vi
from stated_numbers import says
from support import plain_case
from vibroimpact.cases.rigid.rigid_problem import touch_speed
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.dynamics.core import phase_contact
from vibroimpact.dynamics.fluids import air, liquid
from vibroimpact.dynamics.rigid import line_contact
from vibroimpact.dynamics.vibrating import drop_at_start

PAGE = "docs/method.md"
WATER, QUARTZ = vi.Liquid(), 2650.0


def test_bounds() -> None:
    says(PAGE, "a restitution below {} or not at all", phase_contact._LEAST_RESTITUTION)
    says(PAGE, "all contacts below a tolerance of {}.", line_contact._TIGHTEST)
    assert line_contact._OF_STEP == 0.01  # a hundredth
    says(PAGE, "a hundredth of the tolerance, or {} if that is larger", line_contact._LEAST_ERROR)
    says(PAGE, "It is integrated for {} steps of contact", drop_at_start.MOST_STEPS)
    says(PAGE, "up to that time with at most {};", drop_at_start.MOST_STEPS_TO_A_TIME)
    says(PAGE, "more than {} % is refused", 100.0 * air._DENSEST)


def test_hertz_about_equilibrium() -> None:
    """The tangent stiffness goes with the cube root of the force, which is half the
    weight to three halves of it.
    """
    law = Hertz(stiffness=1e8)
    stiffness = []
    for load in (0.5, 1.0, 1.5):
        depth = (load / 1e8) ** (2.0 / 3.0) * np.array([1.0 - 1e-6, 1.0 + 1e-6])
        low, high = law.forces(depth, np.zeros(2), np.ones(2))[0]
        stiffness.append((high - low) / np.diff(depth)[0])
    says(
        PAGE,
        "spring varies between {} and {} of its value at equilibrium",
        stiffness[0] / stiffness[1],
        stiffness[2] / stiffness[1],
    )


def test_histories() -> None:
    """Those of the shipped cases of rigid bodies, against those at a tolerance a thousand
    times as small.
    """
    worst = 0.0
    for name in ("type1-theory", "type1-constant", "type1-variable"):
        problem = vi.load_case(f"paper:{name}").to_problem()
        runs = [vi.simulate(problem), vi.simulate(replace(problem, tolerance=1e-12))]
        for impact in range(5):
            spans = [
                run.impacts["time_s"][impact]
                + np.linspace(0.0, run.impacts["duration_s"][impact], 500)
                for run in runs
            ]
            found, exact = (run.at(span) for run, span in zip(runs, spans, strict=True))
            for quantity in ("force_N", "indentation_m", "velocity_m_s"):
                worst = max(
                    worst,
                    float(
                        np.abs(found[quantity] - exact[quantity]).max()
                        / np.abs(exact[quantity]).max()
                    ),
                )
    says(
        PAGE,
        "Histories of the shipped cases of rigid bodies are accurate to {} of the largest value",
        1e-9,
    )
    assert worst < 1e-9


def lost_in_contact(case: dict) -> float:
    """Return the part of the speed that drag would take in a contact, at the speed of
    approach throughout.
    """
    read = vi.case_of(case)
    row = {name: float(column[0]) for name, column in vi.simulate(read).impacts.items()}
    speed, sphere = row["approach_speed_m_s"], read.to_problem().sphere
    density = float(sphere.mass) / (4.0 / 3.0 * np.pi * float(sphere.contact_offset) ** 3)
    return float(vi.Air().drag(speed, sphere.contact_offset, density)) * row["duration_s"] / speed


def test_drag_during_a_contact() -> None:
    stone = lost_in_contact(plain_case(drop={"speed": 8.8}, run={"impacts": 1}))
    rubber = {"density": 1100.0, "youngs_modulus": 5e6, "poissons_ratio": 0.48}
    ball = lost_in_contact(
        plain_case(
            sphere={"radius": 0.013, "material": rubber}, drop={"speed": 4.4}, run={"impacts": 1}
        )
    )
    says(
        PAGE,
        "({} of the speed for a stone of {} mm at {} m/s, {} for a rubber ball of {} mm at {} m/s)",
        stone,
        50,
        8.8,
        ball,
        26,
        4.4,
    )


def test_liquids() -> None:
    in_water = float(liquid.restitution_kept(WATER.stokes_number(1.0, 0.005, QUARTZ)))
    in_oil = float(
        liquid.restitution_kept(
            vi.Liquid(density=900.0, viscosity=0.1).stokes_number(3.0, 0.005, QUARTZ)
        )
    )
    says(
        PAGE,
        "a grain of quartz of {} mm, relative to that in air, is {} % in water at {} m/s",
        10,
        100.0 * in_water,
        1.0,
    )
    says(
        PAGE,
        "and {} % at {} m/s in an oil of {} kg/m^3 and {} Pa s",
        100.0 * in_oil,
        3.0,
        900.0,
        0.1,
    )
    glass = vi.case_of(
        plain_case(
            sphere={
                "radius": 0.005,
                "material": {"density": 2500.0, "youngs_modulus": 70e9, "poissons_ratio": 0.22},
            },
            drop={"height": 1.0},
            contact={"law": "tsuji", "restitution": 0.8, "liquid": True},
        )
    )
    fast = (2.0 * 9.80665 * 0.995) ** 0.5
    says(
        PAGE,
        "A glass sphere of {} mm that falls {} m in water touches at its terminal speed of {} m/s",
        10,
        1,
        touch_speed(glass),
    )
    says(PAGE, "where it would have {} m/s in a vacuum", fast)
    heavier = 1.0 + 0.5 * liquid.WATER_DENSITY / QUARTZ
    says(PAGE, "lengthen it (by {} % in water for quartz", 100.0 * (heavier**0.4 - 1.0))
    says(PAGE, "Below a Stokes number of about {} no rebound", liquid.CRITICAL_STOKES)
    says(
        PAGE,
        "the correlation gives {} % (the smallest",
        100.0 * float(liquid.restitution_kept(liquid.CRITICAL_STOKES)),
    )
    says(PAGE, "(the smallest value used is {} %)", 100.0 * liquid._LEAST)
