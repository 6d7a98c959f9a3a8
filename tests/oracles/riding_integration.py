"""Balls that lie on modes, many at once by scipy's DOP853 (an oracle: imports nothing of
vibroimpact).

All are one system of ordinary differential equations: s'' = g - F/m and q'' = -2 zeta omega q' -
omega^2 q - chi F, with F the static force of the law at the approach y = s + chi q, from a table,
and none where the surfaces are apart. The law's damping is left out: what stays without it, stays
with it. No event is located; the equations say what happens.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Ball:
    """A ball on its modes, and where all of it is.

    `approaches`: first and last of the table `force` [N], at equal steps [m]; below, the surfaces
    are apart. `sag`: where it carries the weight.
    """

    mass: float
    gravity: float
    omega: Floats
    damping: Floats
    shape: Floats
    approaches: tuple[float, float]
    force: Floats
    sag: float
    approach: float
    speed: float
    displacement: Floats
    velocity: Floats


def largest_gaps(balls: list[Ball], duration: float, tolerance: float = 1e-7) -> Floats:
    """How far each ball ever leaves the surface within a time [m]; less than nothing
    where it never does.
    """
    modes = max(len(ball.omega) for ball in balls)

    def each(name: str) -> Floats:
        return np.array([getattr(ball, name) for ball in balls])

    def padded(name: str, fill: float = 0.0) -> Floats:
        return np.array(
            [
                np.pad(getattr(ball, name), (0, modes - len(ball.omega)), constant_values=fill)
                for ball in balls
            ]
        )

    omega, damping, shape = padded("omega", 1.0), padded("damping"), padded("shape")
    mass, gravity, sag, table, rows = (
        each("mass"),
        each("gravity"),
        each("sag"),
        each("force"),
        np.arange(len(balls)),
    )
    low, high = each("approaches").T
    step, last = (high - low) / (table.shape[1] - 1), table.shape[1] - 2

    def approach(y: Floats) -> Floats:
        return np.asarray(y[:, 0] + (shape * y[:, 2 : 2 + modes]).sum(axis=1))

    def slopes(_: float, flat: Floats) -> Floats:
        y = flat.reshape(len(balls), -1)
        place = (approach(y) - low) / step
        cell = np.clip(place.astype(int), 0, last)
        force = table[rows, cell] + (place - cell) * (table[rows, cell + 1] - table[rows, cell])
        force = np.where(place > 0.0, force, 0.0)
        displacement, velocity = y[:, 2 : 2 + modes], y[:, 2 + modes :]
        push = -omega * (2.0 * damping * velocity + omega * displacement) - shape * force[:, None]
        return np.concatenate(
            [y[:, 1:2], (gravity - force / mass)[:, None], velocity, push], axis=1
        ).ravel()

    begun = np.concatenate(
        [
            each("approach")[:, None],
            each("speed")[:, None],
            padded("displacement"),
            padded("velocity"),
        ],
        axis=1,
    )
    size = np.stack([sag - np.minimum(low, 0.0), np.sqrt(gravity * sag)], axis=1)
    scale = np.concatenate([size, np.repeat(size, modes, axis=1)], axis=1)
    solver = DOP853(
        slopes, 0.0, begun.ravel(), duration, rtol=tolerance, atol=tolerance * scale.ravel()
    )
    gaps = low - approach(begun)
    while solver.status == "running":
        solver.step()
        gaps = np.maximum(gaps, low - approach(solver.y.reshape(len(balls), -1)))
    if solver.status != "finished":
        raise RuntimeError("the integration failed")
    return gaps
