"""A sphere that bounces in air or a liquid: Newton's second law over time by SciPy, with
the drag coefficient of every moment.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

DENSITY, VISCOSITY = 1.2, 1.81e-5


class Medium(NamedTuple):
    """Density [kg/m^3] and viscosity [Pa s] around a sphere, and the parts of the
    displaced mass that lift it and that move along.
    """

    density: float
    viscosity: float
    lifting: float
    added: float


AIR = Medium(DENSITY, VISCOSITY, 0.0, 0.0)


class Bounces(NamedTuple):
    """Times of touch, speeds before and after, heights of the centre at the tops between;
    and the height at any times.
    """

    touches: np.ndarray
    before: np.ndarray
    after: np.ndarray
    tops: np.ndarray
    position: Callable[[np.ndarray], np.ndarray]


def clift_gauvin(reynolds: float) -> float:
    """The drag coefficient of a sphere, as published."""
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) + 0.42 / (1.0 + 4.25e4 / reynolds**1.16)


def schiller_naumann(reynolds: float) -> float:
    """Another: Schiller and Naumann (1935) to 1000, then 0.44."""
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) if reynolds < 1000.0 else 0.44


def bounces(
    radius: float,
    density: float,
    height: float,
    restitution: Callable[[float], float],
    number: int,
    *,
    gravity: float = 9.80665,
    coefficient: Callable[[float], float] = clift_gauvin,
    contact: float = 0.0,
    medium: Medium = AIR,
) -> Bounces:
    """A drop from a height of the centre, with `number` rebounds; each contact takes a
    time in which the sphere stands still.
    """
    area, volume = np.pi * radius**2, 4.0 / 3.0 * np.pi * radius**3
    weight = gravity * volume * (density - medium.lifting * medium.density)
    mass = volume * (density + medium.added * medium.density)

    def slope(_: float, state: np.ndarray) -> list[float]:
        speed = abs(state[1])
        reynolds = max(medium.density * speed * 2.0 * radius / medium.viscosity, 1e-12)
        force = 0.5 * medium.density * coefficient(reynolds) * area * speed * state[1]
        return [state[1], -(weight + force) / mass]

    def touch(_: float, state: np.ndarray) -> float:
        return float(state[0]) - radius

    def top(_: float, state: np.ndarray) -> float:
        return float(state[1])

    touch.terminal, touch.direction, top.direction = True, -1.0, -1.0
    time, state, pieces, found = 0.0, [height, 0.0], [], []
    for _ in range(number + 1):
        flight = solve_ivp(
            slope,
            (time, time + 100.0),
            state,
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
            events=(touch, top),
            dense_output=True,
            max_step=0.05,
        )
        end, speed = float(flight.t[-1]), -float(flight.y[1, -1])
        tops = [float(row[0]) for row in flight.y_events[1]]
        pieces.append((time, end, flight.sol))
        found.append((end, speed, restitution(speed) * speed, tops[-1] if tops else height))
        time, state = end + contact, [radius, restitution(speed) * speed]

    def position(times: np.ndarray) -> np.ndarray:
        out = np.full(len(times), radius)
        for begin, end, curve in pieces:
            inside = (times >= begin) & (times <= end)
            out[inside] = curve(times[inside])[0]
        return out

    touches, before, after, tops = np.array(found).T
    return Bounces(touches, before, after, tops[1:], position)
