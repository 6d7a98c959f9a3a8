"""Balls on shaken tables, against closed forms of the bouncing ball and against SciPy's integration
of a lump on a sprung deck.

With Gamma = A omega^2 / g: a ball that does not rebound stays on the table if Gamma < 1, and is
launched else where sin(omega t) = 1/Gamma. One bounce a period needs Gamma >= pi (1 - e)/(1 + e),
as the table must be as fast as pi g/omega (1 - e)/(1 + e) where they meet; it doubles its period
where Gamma^2 = (pi (1 - e)/(1 + e))^2 + 4 (1 + e^2)^2/(1 + e)^4 (Luck and Mehta 1993, Phys. Rev. E
48:3988; Holmes 1982, J. Sound Vib. 84:173, for high bounces; both hold for the exact motion, since
the map has determinant e^2 and trace 1 + e^2 - (1 + e)^2 A omega^2 sin(theta)/g).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.bouncing_in_air import clift_gauvin
from oracles.shaken_integration import ShakenDeck
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.dynamics.motion.columns import ALL_HISTORY_COLUMNS
from vibroimpact.structures.modal_model import ModalBasis

AGAINST = Against(
    "Luck and Mehta, Holmes, ball on a vibrating table",
    "closed form",
    "flight, bounces and shaken plates",
    "Luck and Mehta 1993, Phys. Rev. E 48, 3988, doi 10.1103/PhysRevE.48.3988; Holmes 1982, "
    "J. Sound Vib. 84, 173",
)
DOP853 = Against(
    "SciPy's DOP853, spheres on vibrating tables and decks",
    "own independent computation",
    "flight, bounces and shaken plates",
    "tests/oracles/shaken_integration.py",
)


G, FREQUENCY = 9.8, 25.0
OMEGA = 2.0 * math.pi * FREQUENCY


def table(strength: float, phase: float = 0.0) -> vi.PlateMotion:
    """A table of a greatest acceleration of so many g."""
    return vi.PlateMotion(amplitude=strength * G / OMEGA**2, frequency=FREQUENCY, phase=phase)


def ball(restitution: float, motion: vi.PlateMotion | None, **more: Any) -> vi.Problem:
    start = {"height": 0.05} if "speed" not in more else {}
    settings: dict[str, Any] = {"gravity": G, "motion": motion, **start, **more}
    return vi.Problem(
        sphere=vi.Body(mass=0.1, contact_offset=0.01),
        plate=vi.rigid_plate(),
        laws=(Newton(restitution=restitution),),
        **settings,
    )


def on_orbit(strength: float, restitution: float, shift: float = 0.0, **more: Any) -> vi.Problem:
    """A ball that begins on the orbit of one bounce a period, or shifted by some phase [rad]."""
    bounce = math.pi * (1.0 - restitution) / (1.0 + restitution)
    phase = math.acos(min(bounce / strength, 1.0))
    return ball(restitution, table(strength, phase + shift), speed=math.pi * G / OMEGA, **more)


def doubling(restitution: float) -> float:
    once = math.pi * (1.0 - restitution) / (1.0 + restitution)
    return math.sqrt(once**2 + 4.0 * (1.0 + restitution**2) ** 2 / (1.0 + restitution) ** 4)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 0.7])
def test_a_ball_stays_on_a_table_below_one_g(agrees: Agrees, restitution: float) -> None:
    response = vi.simulate(ball(restitution, table(0.999), impacts=None, duration=20.0))
    assert response.outcomes == (vi.Outcome.REST_SPEED,)
    assert response.energy["closure_relative"] <= 1e-9
    last = response.at(np.linspace(19.0, 20.0, 101))
    assert last["position_m"] - 0.01 == pytest.approx(last["surface_m"], abs=1e-15)
    agrees(
        "ball in persistent contact, table acceleration below 1 g",
        "contact force",
        last["force_N"],
        0.1 * (G - last["surface_m"] * OMEGA**2),
        unit="N",
        relative=1e-9,
    )
    assert "moves with the plate" in response.status


@pytest.mark.parametrize("strength", [1.001, 1.2, 1.8])
def test_launch_from_a_table_beyond_one_g(agrees: Agrees, strength: float) -> None:
    """The first flight after a ride begins at sin(omega t) = 1/Gamma, with the velocity
    of the table.
    """
    response = vi.simulate(ball(0.0, table(strength), impacts=3))
    launch = math.asin(1.0 / strength) / OMEGA
    touch = response.impacts["time_s"][0]
    launch += math.ceil((touch - launch) * FREQUENCY) / FREQUENCY
    place, speed, _ = response.problem.surface(launch)
    moment = response.at(launch + np.array([0.0, 1e-4, 1e-3]))
    later = np.array([0.0, 1e-4, 1e-3])
    flight = place + speed * later - 0.5 * G * later**2
    agrees(
        "launch, table acceleration above 1 g",
        "position in flight",
        moment["position_m"] - 0.01,
        flight,
        unit="m",
        absolute=1e-14,
    )
    pressed = response.at(launch - 1e-7)["force_N"]
    assert pressed == pytest.approx(0.1 * G * OMEGA * 1e-7 * math.sqrt(strength**2 - 1.0), rel=1e-3)
    assert response.energy["closure_relative"] <= 1e-9


def test_one_bounce_a_period_exists_from_its_threshold_on(agrees: Agrees) -> None:
    threshold = math.pi * 0.2 / 1.8
    above = vi.simulate(on_orbit(1.01 * threshold, 0.8, impacts=500))
    agrees(
        "one impact per period",
        "time between impacts",
        np.diff(above.impacts["time_s"]),
        1.0 / FREQUENCY,
        unit="s",
        relative=1e-9,
    )
    below = vi.simulate(on_orbit(0.99 * threshold, 0.8, impacts=None, duration=60.0))
    assert below.outcomes == (vi.Outcome.REST_SPEED,)


@pytest.mark.parametrize("restitution", [0.3, 0.5, 0.8])
def test_period_doubling(agrees: Agrees, restitution: float) -> None:
    """The factor by which a small shift grows a bounce is -1 at the threshold, found from
    the factors beside it.
    """

    def growth(strength: float) -> float:
        shifted, orbit = (
            vi.simulate(on_orbit(strength, restitution, shift, impacts=45)).impacts["time_s"]
            for shift in (1e-7, 0.0)
        )
        away = shifted + 1e-7 / OMEGA - orbit
        return float(away[-1] / away[-2])

    expected = doubling(restitution)
    strengths = expected * np.array([0.99, 1.0, 1.01])
    factors = np.array([growth(strength) for strength in strengths])
    assert factors[0] > -1.0 > factors[2]
    found = np.interp(1.0, -factors, strengths)
    agrees(
        "coefficients of restitution 0.3, 0.5 and 0.8",
        "table acceleration amplitude at period doubling, normalized by gravity",
        found,
        expected,
        relative=1e-5,
    )


@pytest.mark.slow
def test_two_bounces_of_different_length_beyond_the_doubling() -> None:
    times = [
        vi.simulate(on_orbit(factor * doubling(0.5), 0.5, 1e-3, impacts=900)).impacts["time_s"]
        for factor in (0.98, 1.02)
    ]
    (even, odd) = (np.diff(times[0][-21:]), np.diff(times[1][-21:]))
    assert even == pytest.approx(1.0 / FREQUENCY, rel=1e-6)
    assert odd[::2] == pytest.approx(odd[0], rel=1e-6)
    assert abs(odd[0] - odd[1]) * FREQUENCY > 0.01


@pytest.mark.slow
@pytest.mark.parametrize(("strength", "restitution"), [(2.5, 0.8), (8.0, 0.7), (1.5, 0.95)])
def test_ledger_of_a_billiard_of_a_thousand_impacts(strength: float, restitution: float) -> None:
    response = vi.simulate(ball(restitution, table(strength), impacts=1000))
    assert response.impacts["impact"][-1] == 1000
    assert response.energy["closure_relative"] <= 1e-9
    history = response.history(50_000)
    total = sum(history[name] for name in history if name.endswith("_J"))
    assert total == pytest.approx(total[0], abs=1e-9 * response.energy["contact_dissipated_J"])
    assert (history["position_m"] - 0.01 - history["surface_m"]).min() >= -1e-12


@pytest.mark.slow
def test_ledger_of_a_thousand_soft_impacts() -> None:
    law = KuwabaraKono(stiffness=1e8, dissipation_time=1e-5)
    body = vi.Body(mass=0.1, contact_offset=0.01)
    settings: dict[str, Any] = {"height": 0.03, "gravity": G, "impacts": 1000, "sensitivity": False}
    response = vi.tabulate(
        vi.Problem(sphere=body, plate=vi.rigid_plate(), laws=(law,), motion=table(3.0), **settings)
    )
    assert response.impacts["impact"][-1] == 1000
    assert response.energy["closure_relative"] <= 1e-9
    assert -response.energy["drive_J"] > 100.0 * response.energy["input_J"]


@pytest.mark.parametrize(
    ("relaxation", "height"),
    [(2e-5, 0.02), (2e-3, 0.006)],
    ids=["bouncing", "riding and launched again"],
)
@pytest.mark.parametrize("deck", [np.inf, 80.0], ids=["stiff deck", "sprung deck"])
def test_lump_on_a_deck(agrees: Agrees, deck: float, relaxation: float, height: float) -> None:
    """A lump of 20 kg on a deck of 80 kg on springs of 12 Hz, or on none, on a frame
    shaken at 15 Hz, against SciPy's DOP853.
    """
    stiffness = 1e8 if relaxation < 1e-3 else 1e7
    system = ShakenDeck(20.0, deck, 12.0, 0.05, stiffness, relaxation, 1.6e-3, 15.0)
    modes = None
    if np.isfinite(deck):
        shape = np.array([deck**-0.5])
        moves = np.array([[0.0, 0.0, deck**0.5]])
        modes = ModalBasis(
            np.array([12.0]),
            np.array([0.05]),
            shape,
            moves,
            {"a": np.outer(shape, [0.0, 0.0, 1.0])},
            deck,
        )
    problem = vi.Problem(
        sphere=vi.Body(mass=20.0, contact_offset=0.1),
        plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=modes),
        laws=(KuwabaraKono(stiffness=stiffness, dissipation_time=relaxation),),
        height=0.1 + height,
        gravity=9.8,
        duration=1.0,
        impacts=None,
        tolerance=1e-11,
        motion=vi.PlateMotion(amplitude=1.6e-3, frequency=15.0),
    )
    response, times = vi.simulate(problem), np.linspace(0.0, 1.0, 1001)
    expected, left = system.follow(height, times)
    found = response.at(times)
    case = "sphere of 20 kg on a rigid or spring-supported deck, impacts and persistent contact"
    agrees(
        case,
        "position history over 1 s",
        found["position_m"] - 0.1,
        expected[:, 0],
        unit="m",
        against=DOP853,
        absolute=1e-8,
    )
    # in contact it changes by 1e4 m/s in a second, and rounding grows from impact to impact
    agrees(
        case,
        "velocity history over 1 s",
        found["velocity_m_s"],
        expected[:, 1],
        unit="m/s",
        against=DOP853,
        absolute=1e-5,
    )
    agrees(
        case,
        "deflection history of the deck",
        found["plate_deflection_m"],
        expected[:, 2],
        unit="m",
        against=DOP853,
        absolute=1e-8,
    )
    assert found["plate_displacement_m"] == pytest.approx(expected[:, 2], abs=1e-8)
    assert found["plate_velocity_m_s"] == pytest.approx(expected[:, 3], abs=1e-6)
    assert len(left) > 2
    assert response.energy["closure_relative"] <= 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(
    ("relaxation", "height"),
    [(2e-5, 0.02), (2e-3, 0.006)],
    ids=["bouncing", "riding and launched again"],
)
@pytest.mark.parametrize("deck", [np.inf, 1.4], ids=["stiff deck", "sprung deck"])
def test_a_light_lump_on_a_deck_in_air(
    agrees: Agrees, deck: float, relaxation: float, height: float
) -> None:
    """As above, of 0.35 kg and 0.2 m in diameter, which air slows down by 6 % of its
    weight at 1 m/s.
    """
    mass, radius, coefficient, density = 0.35, 0.1, 10.0, 1.2
    drag = 0.375 * density / (mass / (4.0 / 3.0 * math.pi * radius**3)) * coefficient / radius
    system = ShakenDeck(
        mass,
        deck,
        12.0,
        0.05,
        2e6 if relaxation < 1e-3 else 2e5,
        relaxation,
        1.6e-3,
        15.0,
        drag=drag,
    )
    modes = None
    if np.isfinite(deck):
        modes = ModalBasis(
            np.array([12.0]),
            np.array([0.05]),
            np.array([deck**-0.5]),
            np.array([[0.0, 0.0, deck**0.5]]),
            {},
            deck,
        )
    problem = vi.Problem(
        sphere=vi.Body(mass=mass, contact_offset=radius),
        plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=modes),
        laws=(KuwabaraKono(stiffness=system.stiffness, dissipation_time=relaxation),),
        height=radius + height,
        gravity=9.8,
        duration=1.0,
        impacts=None,
        rest_speed=1e-9,
        tolerance=1e-11,
        motion=vi.PlateMotion(amplitude=1.6e-3, frequency=15.0),
        air=vi.Air(density=density, drag_coefficient=coefficient),
    )
    response, times = vi.simulate(problem), np.linspace(0.0, 1.0, 1001)
    expected, left = system.follow(height, times)
    vacuum, _ = replace(system, drag=0.0).follow(height, times)
    assert np.abs(expected[:, 0] - vacuum[:, 0]).max() > 1e-5
    found = response.at(times)
    # between the contacts of one row there is no drag
    split = response.impacts["time_s"][response.impacts["contacts"] > 1]
    here = times < split.min(initial=np.inf)
    case, place = (
        "sphere of 0.35 kg in air, impacts and persistent contact",
        found["position_m"][here] - radius,
    )
    agrees(
        case,
        "position history over 1 s",
        place,
        expected[here, 0],
        unit="m",
        against=DOP853,
        absolute=1e-8,
    )
    agrees(
        case,
        "velocity history over 1 s",
        found["velocity_m_s"][here],
        expected[here, 1],
        unit="m/s",
        against=DOP853,
        absolute=1e-6,
    )
    assert found["plate_deflection_m"][here] == pytest.approx(expected[here, 2], abs=1e-8)
    assert np.count_nonzero(here) > 900
    assert len(left) > 2
    assert response.energy["closure_relative"] <= 1e-9
    assert response.energy["air_J"] > 0.0


def test_a_hard_ball_on_a_table_in_air(agrees: Agrees) -> None:
    """A table tennis ball, between its touches by SciPy: each flight from the table to
    the next meeting.
    """
    radius, density, restitution = 0.02, 84.0, 0.9
    mass = 4.0 / 3.0 * math.pi * radius**3 * density
    problem = replace(
        ball(restitution, table(2.0), impacts=8),
        sphere=vi.Body(mass=mass, contact_offset=radius),
        height=0.15,
        air=vi.Air(),
    )
    response = vi.simulate(problem)

    def slopes(_: float, y: Any) -> list[float]:
        drag = (
            0.375
            * 1.2
            / density
            * clift_gauvin(max(1.2 * abs(y[1]) * 2.0 * radius / 1.81e-5, 1e-12))
            / radius
        )
        return [y[1], -G - drag * abs(y[1]) * y[1]]

    def gap(time: float, y: Any) -> float:
        return float(y[0] - problem.surface(time)[0])

    gap.terminal, gap.direction = True, -1.0  # type: ignore[attr-defined]
    time, state = 0.0, [0.15 - radius, 0.0]
    for touch, speed in zip(
        response.impacts["time_s"], response.impacts["approach_speed_m_s"], strict=True
    ):
        flight = solve_ivp(
            slopes,
            (time, time + 2.0),
            state,
            "DOP853",
            events=gap,
            rtol=1e-12,
            atol=1e-14,
            max_step=2e-3,
        )
        time, velocity = float(flight.t[-1]), float(problem.surface(flight.t[-1])[1])
        agrees(
            "table tennis ball in air on a vibrating table",
            "time of impact",
            touch,
            time,
            unit="s",
            against=DOP853,
            absolute=1e-8,
        )
        closing = velocity - flight.y[1, -1]
        agrees(
            "table tennis ball in air on a vibrating table",
            "approach speed",
            speed,
            closing,
            unit="m/s",
            against=DOP853,
            relative=1e-6,
        )
        state = [
            float(problem.surface(time)[0]) + 1e-15,
            velocity + restitution * (velocity - flight.y[1, -1]),
        ]
    assert response.energy["closure_relative"] <= 1e-9
    assert response.impacts["rebound_height_m"][-1] == pytest.approx(
        float(response.at(response.end_time[0])["position_m"]), abs=1e-12
    )


@pytest.mark.parametrize(
    "law",
    [
        Newton(restitution=0.6),
        Hertz(stiffness=1e8),
        KuwabaraKono(stiffness=1e8, dissipation_time=1e-5),
    ],
)
def test_a_table_without_amplitude_is_a_plate_at_rest(law: vi.laws.ContactLaw) -> None:
    still = vi.PlateMotion(amplitude=0.0, frequency=25.0)
    body = vi.Body(mass=0.1, contact_offset=0.01)
    settings: dict[str, Any] = {"height": 0.05, "gravity": G, "impacts": 20}
    rest, shaken = (
        vi.simulate(
            vi.Problem(sphere=body, plate=vi.rigid_plate(), laws=(law,), motion=motion, **settings)
        )
        for motion in (None, still)
    )
    for name, values in rest.impacts.items():
        assert np.array_equal(values, shaken.impacts[name], equal_nan=True), name
    for name, values in rest.history().items():
        assert np.array_equal(values, shaken.history()[name], equal_nan=True), name
    for name, value in rest.energy.items():
        assert value == shaken.energy[name], name


@pytest.mark.parametrize(
    "law", [Newton(restitution=0.6), KuwabaraKono(stiffness=1e8, dissipation_time=1e-5)]
)
def test_a_table_that_hardly_moves_is_nearly_a_plate_at_rest(law: vi.laws.ContactLaw) -> None:
    nearly = vi.PlateMotion(amplitude=1e-15, frequency=25.0)
    body = vi.Body(mass=0.1, contact_offset=0.01)
    settings: dict[str, Any] = {"height": 0.05, "gravity": G, "impacts": 5}
    rest, shaken = (
        vi.simulate(
            vi.Problem(sphere=body, plate=vi.rigid_plate(), laws=(law,), motion=motion, **settings)
        )
        for motion in (None, nearly)
    )
    for name in (
        "time_s",
        "duration_s",
        "approach_speed_m_s",
        "separation_speed_m_s",
        "max_indentation_m",
        "rebound_height_m",
    ):
        assert shaken.impacts[name] == pytest.approx(rest.impacts[name], rel=1e-8), name


def test_a_lump_at_rest_on_a_sprung_deck_moves_on_as_scipy_has_it(agrees: Agrees) -> None:
    """Found at rest, the lump is no longer integrated: its contact is linear, which errs
    by the square of the change of the force.
    """
    law, system = (
        KuwabaraKono(stiffness=1e9, dissipation_time=2e-3),
        ShakenDeck(20.0, 80.0, 12.0, 0.05, 1e9, 2e-3, 2e-4, 15.0),
    )
    shape = np.array([80.0**-0.5])
    moves = np.array([[0.0, 0.0, 80.0**0.5]])
    modes = ModalBasis(
        np.array([12.0]),
        np.array([0.05]),
        shape,
        moves,
        {"a": np.outer(shape, [0.0, 0.0, 1.0])},
        80.0,
    )
    problem = vi.Problem(
        sphere=vi.Body(mass=20.0, contact_offset=0.1),
        plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=modes),
        laws=(law,),
        height=0.102,
        gravity=9.8,
        duration=1.5,
        impacts=None,
        motion=vi.PlateMotion(amplitude=2e-4, frequency=15.0),
    )
    response, times = vi.simulate(problem), np.linspace(0.0, 1.5, 15001)
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    assert "moves with the plate" in response.status
    (expected, left), found = system.follow(0.002, times), response.at(times)
    weight, rest = 20.0 * 9.8, float(response.rest.time[0])
    assert rest < 0.1
    assert max(left, default=0.0) < rest
    later = times > rest + 0.05
    change = np.abs(found["force_N"][later] / weight - 1.0).max()
    assert 0.2 < change < 0.5
    sag = (weight / 1e9) ** (2.0 / 3.0)
    case = "sphere at rest on a spring-supported deck"
    agrees(
        case,
        "deflection history of the deck",
        found["plate_deflection_m"],
        expected[:, 2],
        unit="m",
        against=DOP853,
        absolute=2e-7,
    )
    assert found["position_m"] - 0.1 == pytest.approx(expected[:, 0], abs=0.2 * change**2 * sag)
    force = 20.0 * (9.8 + np.gradient(expected[:, 1], times, edge_order=2))
    assert found["force_N"][later] == pytest.approx(force[later], abs=1e-3 * weight)
    # the ledger closes, and its drive is the work of the contact at the surface as it moves without
    # the lump
    total = sum(
        found[name]
        for name, column in ALL_HISTORY_COLUMNS.items()
        if column.in_ledger and name in found
    )
    assert total == pytest.approx(total[0], abs=1e-7 * response.energy["input_J"])
    # what is left of the impact, and loses energy together with the steady motion, has decayed
    steady = times > 1.0
    power, drive = (
        (found["force_N"] * found["surface_velocity_m_s"])[steady],
        -found["drive_J"][steady],
    )
    work = np.append(0.0, np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times[steady])))
    assert np.ptp(work) > 0.05
    assert drive - drive[0] == pytest.approx(work, abs=0.01 * np.ptp(work))


@pytest.mark.slow
def test_friction_turns_with_a_table_that_shakes_across_the_slip(agrees: Agrees) -> None:
    """A sphere rides and slides over many periods: friction points against the slip at
    every instant, as in SciPy's integration of it.
    """
    friction = vi.friction.find_friction_law("mindlin")(
        coefficient=0.05,
        effective_modulus=4e10,
        effective_shear_modulus=3e10,
        effective_radius=0.02,
    )
    law = vi.laws.find_contact_law("linear-spring-dashpot")(
        stiffness=1e7, restitution=0.1, effective_mass=0.087
    )
    motion = vi.PlateMotion(amplitude=2e-5, frequency=400.0, direction=(0.0, 1.0, 0.0))
    response = vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=0.087, contact_offset=0.02),
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=0.1,
            impacts=None,
            duration=0.2,
            motion=motion,
            oblique=vi.Oblique(velocity=(0.8, 0.0), friction=friction),
            tolerance=1e-7,
        )
    )
    times = np.array([0.06, 0.199])
    found = response.at(times)
    assert found["force_N"] == pytest.approx(0.087 * 9.80665, rel=1e-6)

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        slip = state + np.array([0.0, -2e-5 * 800.0 * np.pi * np.cos(800.0 * np.pi * time)])
        return -3.5 * 0.05 * 9.80665 * slip / np.hypot(*slip)

    slips = np.array(
        [
            found["velocity_x_m_s"] - 0.02 * found["spin_y_rad_s"],
            found["velocity_y_m_s"] + 0.02 * found["spin_x_rad_s"],
        ]
    )
    expected = solve_ivp(
        rates, tuple(times), slips[:, 0], method="DOP853", rtol=1e-10, atol=1e-13, max_step=1e-4
    ).y[:, -1]
    straight = slips[0, 0] - 3.5 * 0.05 * 9.80665 * (times[1] - times[0])
    assert expected[0] - straight > 4e-4
    within = float(0.03 * (expected[0] - straight))
    agrees(
        "sliding on a table vibrating transverse to the sliding direction",
        "sliding velocity",
        slips[0, 1],
        expected[0],
        unit="m/s",
        against=DOP853,
        absolute=within,
    )
