"""The largest force of a contact: against SciPy's Runge-Kutta of order 8, wherever it
lies and at every tolerance.
"""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

import vibroimpact as vi
from support import one_in
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.jankowski import Jankowski
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws

COMPLIANT = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]


def peak_by_scipy(law: CompliantLaw, mass: float, speed: float) -> tuple[float, float, float]:
    """Return the largest force [N], when it is reached, and when the contact is deepest
    [s], without gravity.
    """
    floor = float(law.release_level)

    def force(state: np.ndarray) -> float:
        return float(sum(law.forces(max(state[0], floor), state[1], speed)))

    def turned(_: float, state: np.ndarray) -> float:
        return state[1]

    turned.terminal, turned.direction = True, -1.0
    start = [float(law.touch_level), speed]
    way_in = solve_ivp(
        lambda _, state: [state[1], -force(state) / mass],
        (0.0, 1.0),
        start,
        method="DOP853",
        rtol=3e-13,
        atol=1e-18,
        events=turned,
        dense_output=True,
    )
    steps = zip(way_in.t[:-1], way_in.t[1:], strict=True)
    times = np.append(
        np.concatenate([np.linspace(low, high, 8, endpoint=False) for low, high in steps]),
        way_in.t[-1],
    )
    best = int(np.argmax([force(way_in.sol(time)) for time in times]))
    bounds = times[max(best - 1, 0)], times[min(best + 1, len(times) - 1)]
    top = minimize_scalar(
        lambda time: -force(way_in.sol(time)),
        bounds=bounds,
        method="bounded",
        options={"xatol": 1e-9 * times[-1]},
    )
    at_best = force(way_in.sol(times[best]))
    peak, when = (-top.fun, top.x) if -top.fun > at_best else (at_best, times[best])
    return peak, when, way_in.t[-1]


def drops(
    law: CompliantLaw, mass: np.ndarray, speed: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest forces [N], and when they are reached [s]."""
    ball = vi.Body(mass=mass, contact_offset=0.02)
    stated = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        height=None,
        speed=speed,
        gravity=0.0,
        impacts=1,
        tolerance=tolerance,
    )
    row = vi.simulate(stated).impacts
    return row["max_force_N"][:, 0], row["time_of_max_force_s"][:, 0]


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-10, 1e-13])
@pytest.mark.parametrize("kind", [Tsuji, Jankowski])
def test_a_peak_near_the_end_of_a_stretch(kind: type[CompliantLaw], tolerance: float) -> None:
    restitution = np.array([0.6, 0.9, 0.95, 0.987, 0.999])
    law = kind(stiffness=1e8, restitution=restitution, effective_mass=0.1)
    force, when = drops(law, np.full(5, 0.1), np.full(5, 10.0), tolerance)
    for drop in range(5):
        peak, place, deepest = peak_by_scipy(law.take(drop), 0.1, 10.0)
        assert force[drop] == pytest.approx(peak, rel=1e-9)
        assert when[drop] == pytest.approx(place, abs=5e-6 * deepest)


@pytest.mark.parametrize("kind", one_in(2, COMPLIANT, lambda law: law.name))
def test_random_drops_of_every_law(kind: type[CompliantLaw]) -> None:
    random, size = np.random.default_rng(5), 8
    mass, speed, stiffness = (
        10 ** random.uniform(-4, 1, size),
        10 ** random.uniform(-1, 1.7, size),
        10 ** random.uniform(6, 11, size),
    )
    radius = np.cbrt(mass / 6000.0)
    modulus = 0.75 * stiffness / np.sqrt(radius)
    law = kind.example(
        ContactPair(modulus, radius, mass, 10 ** random.uniform(-3.5, -1.5, size) * modulus, 0.3)
    )
    if any(item.name == "restitution" for item in fields(law)):
        law = law.changed({"restitution": random.uniform(0.3, 1.0, size)})
    force, when = drops(law, mass, speed, 1e-9)
    for drop in range(size):
        peak, place, deepest = peak_by_scipy(law.take(drop), mass[drop], speed[drop])
        assert force[drop] == pytest.approx(peak, rel=3e-9)
        assert when[drop] == pytest.approx(place, abs=1e-6 * deepest)
