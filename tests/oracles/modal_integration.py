"""A mass that falls on modes, step by step with scipy's DOP853 (an oracle: imports nothing of
vibroimpact).

In contact the equations of motion are integrated at 1e-12 until the approach is back at zero;
apart, everything moves in closed form, by the exponential of each mode's 2 by 2 matrix, and the
next touch is where the gap changes sign between samples an eightieth of the shortest period apart.
A law is what it is: a static force and a factor on the rate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

Floats = NDArray[np.float64]
Law = Callable[[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Touch:
    """A contact: when it begins and ends, how fast the mass leaves upwards, the largest force."""

    begin: float
    end: float
    separation_speed: float
    max_force: float


@dataclass
class Drop:
    """The mass, what it meets, and where all of it is.

    `law(indentation, speed at touch)` returns the static force and the dashpot's constant.
    `series`: linear compliance in series with the static force. `local`: stiffness and damping of
    an element in series with the whole force. `inside`: modes that only the static force drives,
    and whose motion the dashpot does not feel. `clip`: may it not pull? Where it would, it does
    nothing, to the modes inside either.
    """

    mass: float
    gravity: float
    omega: Floats
    damping: Floats
    shape: Floats
    law: Law
    speed: float
    inside: NDArray[np.bool_] | None = None
    local: tuple[float, float] | None = None
    series: float = 0.0
    clip: bool = False
    longest: float = 0.1
    """How long a contact may last [s]."""
    step: float = 2e-5
    """The longest step in it [s]."""

    def __post_init__(self) -> None:
        count = len(self.omega)
        self.inside = np.zeros(count, dtype=bool) if self.inside is None else self.inside
        self.outer = np.where(self.inside, 0.0, self.shape)
        # approach, speed, displacements, velocities, the local element
        self.y = np.zeros(2 * count + 3)
        self.y[1], self.time = self.speed, 0.0

    def approach(self, y: Floats) -> float:
        count = len(self.omega)
        return float(y[0] + self.shape @ y[2 : 2 + count] + y[-1])

    def forces(self, y: Floats, at_touch: float) -> tuple[float, float]:
        """The whole force, and the static one."""
        count = len(self.omega)
        indentation = max(self.approach(y), 0.0)
        if self.series and indentation:
            whole = indentation
            settings = {"xtol": 1e-18, "rtol": 1e-14}
            indentation = brentq(
                lambda delta: delta + self.series * self.law(delta, at_touch)[0] - whole,
                0.0,
                whole,
                **settings,
            )
        static, dashpot = self.law(indentation, at_touch)
        rate = y[1] + self.outer @ y[2 + count : 2 + 2 * count]
        if self.local:
            stiffness, damping = self.local
            force = (static + dashpot * (rate - stiffness / damping * y[-1])) / (
                1.0 + dashpot / damping
            )
        else:
            force = static + dashpot * rate
        return (0.0, 0.0) if self.clip and force < 0.0 else (force, static)

    def slopes(self, _: float, y: Floats, at_touch: float) -> Floats:
        count = len(self.omega)
        force, static = self.forces(y, at_touch)
        displacement, velocity = y[2 : 2 + count], y[2 + count : 2 + 2 * count]
        push = -np.where(self.inside, static, force) * self.shape
        push -= self.omega * (2.0 * self.damping * velocity + self.omega * displacement)
        local = 0.0 if self.local is None else -(self.local[0] * y[-1] + force) / self.local[1]
        return np.concatenate([[y[1], self.gravity - force / self.mass], velocity, push, [local]])

    def contact(self) -> Touch:
        """Integrate a contact."""
        count, begin = len(self.omega), self.time
        at_touch = float(self.y[1] + self.outer @ self.y[2 + count : 2 + 2 * count])
        if self.local:
            at_touch -= self.local[0] / self.local[1] * self.y[-1]

        def apart(_: float, y: Floats, __: float) -> float:
            return self.approach(y)

        apart.terminal, apart.direction = True, -1  # type: ignore[attr-defined]
        forces: list[float] = []
        settings = {
            "method": "DOP853",
            "rtol": 1e-12,
            "atol": 1e-16,
            "args": (at_touch,),
            "dense_output": True,
        }
        first = solve_ivp(self.slopes, (self.time, self.time + 1e-8), self.y, **settings)
        whole = solve_ivp(
            self.slopes,
            (first.t[-1], begin + self.longest),
            first.y[:, -1],
            events=apart,
            max_step=self.step,
            **settings,
        )
        times = np.linspace(whole.t[0], whole.t[-1], 2001)
        for _ in range(3):  # closer and closer
            forces = [self.forces(whole.sol(time), at_touch)[0] for time in times]
            best = int(np.argmax(forces))
            times = np.linspace(times[max(best - 1, 0)], times[min(best + 1, len(times) - 1)], 101)
        self.time, self.y = whole.t[-1], whole.y[:, -1]
        return Touch(begin, self.time, -float(self.y[1]), max(forces))

    def flight(self, until: float) -> bool:
        """Let everything move freely until the next touch; return whether there is one
        before a time.
        """
        step = 2.0 * np.pi / max(float(self.omega.max(initial=0.0)), 1e3) / 80.0
        before, start = self.y.copy(), self.time
        while self.time < until:
            first = self.time == start
            self.y, self.time = self.free(before, step), self.time + step
            if self.approach(self.y) > 0.0 and not first:
                length = brentq(
                    lambda length: self.approach(self.free(before, length)),  # noqa: B023
                    0.0,
                    step,
                    xtol=1e-17,
                    rtol=1e-14,
                )
                self.y, self.time = self.free(before, length), self.time - step + length
                return True
            before = self.y
        return False

    def free(self, y: Floats, length: float) -> Floats:
        """The state after a time without contact."""
        count = len(self.omega)
        new = y.copy()
        new[0] += length * (y[1] + 0.5 * self.gravity * length)
        new[1] += length * self.gravity
        for mode, matrix in enumerate(self.exponentials(length)):
            new[[2 + mode, 2 + count + mode]] = matrix @ y[[2 + mode, 2 + count + mode]]
        if self.local:
            new[-1] *= np.exp(-self.local[0] / self.local[1] * length)
        return new

    def exponentials(self, length: float) -> Floats:
        if length not in self.__dict__.setdefault("_kept", {}):
            if len(self._kept) > 4:
                self._kept.clear()
            matrices = [
                [[0.0, 1.0], [-(w * w), -2.0 * z * w]]
                for w, z in zip(self.omega, self.damping, strict=True)
            ]
            self._kept[length] = [expm(length * np.array(matrix)) for matrix in matrices]
        return self._kept[length]

    def run(self, contacts: int, until: float = 10.0) -> list[Touch]:
        """Follow so many contacts."""
        found = [self.contact()]
        while len(found) < contacts and self.flight(until):
            found.append(self.contact())
        return found
