r"""Vertical flights in still air or a still liquid, with drag."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.flights import EndSpeeds, ReturnFlight
from vibroimpact.dynamics.air import Air
from vibroimpact.dynamics.fluid import Fluid
from vibroimpact.errors import InputError

_POINTS = 513  # of a table; cubic interpolation errs by 1e-9 for a fall of 4 m
# start of the integration, as a fraction of the range of the root of the height; drag is negligible
# below it
_BEGIN = 1e-6
_CLOSE = 1e-11
_FASTEST = 1e4  # m/s, at which the integration stops
_WHOLE = 0.999  # part of the largest rise asked for from which on the tables reach it


@dataclass(frozen=True)
class FluidFlights:
    r"""Vertical flights of a sphere in still air or a still liquid.

    Below the top of a flight, at a depth s, :math:`v\,dv/ds = g - a(v)` on the way down and
    :math:`g + a(v)` on the way up, with
    the deceleration a by drag of `vibroimpact.dynamics.fluid`, and as g in a liquid the part of
    gravity that buoyancy and added mass leave. Both equations are integrated once over the square
    root of s, in which speeds and times are smooth, and then interpolated by cubic Hermite splines.

    Parameters
    ----------
    gravity : float
        Acceleration [m/s^2], > 0.
    radius, density : float
        Radius [m] and density [kg/m^3] of the sphere.
    highest : float
        The largest rise to be tabulated [m].
    fluid : Fluid
        What it flies through; by default air at 20 C and sea level.

    Raises
    ------
    InputError
        If a requested flight exceeds the tables.

    Examples
    --------
    >>> pebble = FluidFlights(9.8, 0.002, 1250.0, 4.0)
    >>> [
    ...     round(float(speed), 2)
    ...     for speed in (
    ...         pebble.speed_after_fall(np.array(4.0))[0],
    ...         pebble.speed_to_rise(np.array(4.0))[0],
    ...     )
    ... ]
    [7.68, 10.33]
    """

    gravity: float
    radius: float
    density: float
    highest: float
    fluid: Fluid = Air()

    @property
    def pull(self) -> float:
        """Acceleration in a fall without drag [m/s^2]."""
        return float(
            self.gravity * self.fluid.weight(self.density) / self.fluid.inertia(self.density)
        )

    def speed_after_fall(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the speed after a fall from rest through a height [m/s], and its
        derivative with respect to the height [1/s].
        """
        speed = self._within(self._tables.down, height)
        return speed, (self.pull - self.fluid.drag(speed, self.radius, self.density)) / speed

    def speed_to_rise(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the initial speed needed to rise by a height [m/s], and its derivative
        with respect to the height [1/s].
        """
        speed = self._within(self._tables.up, height)
        return speed, (self.pull + self.fluid.drag(speed, self.radius, self.density)) / speed

    def depth_at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the depth below the apex [m] at a time relative to the apex [s], and the
        downward velocity [m/s].
        """
        depth = self._tables.depth
        at = np.clip(time, depth.x[0], depth.x[-1])
        return np.asarray(depth(at)), np.asarray(depth(at, 1))

    def end_speeds(self, time: Floats) -> EndSpeeds:
        """Return the initial and final speeds of flights of given durations [s]."""
        tables = self._tables
        if np.any(time > tables.lasted.x[-1]):
            raise self._too_far(f"a flight of {np.max(time):.4g} s", tables)
        root, by_time = tables.lasted(time), tables.lasted(time, 1)
        ends = [tables.up, tables.down]
        speeds, slopes = zip(
            *((np.asarray(end(root)), np.asarray(end(root, 1) * by_time)) for end in ends),
            strict=True,
        )
        return EndSpeeds(*speeds, *slopes)

    def flight(self, speed: Floats) -> ReturnFlight:
        """Return the flights with given initial speeds [m/s]."""
        tables = self._tables
        if np.any(speed > tables.risen.x[-1]):
            raise self._too_far(f"a flight that begins with {np.max(speed):.4g} m/s", tables)
        root = tables.risen(speed)
        return ReturnFlight(
            np.asarray(root**2),
            np.asarray(tables.rise(root)),
            np.asarray(tables.time(root)),
            np.asarray(tables.down(root)),
        )

    def _within(self, table: Any, height: Floats) -> Floats:
        if np.any(height > table.x[-1] ** 2):
            raise self._too_far(f"a rise of {np.max(height):.4g} m", self._tables)
        return np.asarray(table(np.sqrt(height)))

    def _too_far(self, what: str, tables: _Tables | None = None) -> InputError:
        """Return the error of a flight beyond the tables, which end where flights are not
        possible, or at the largest rise asked for.
        """
        key = "drop.air and calibrate.air" if isinstance(self.fluid, Air) else "contact.liquid"
        ends = "is not possible"
        if tables is not None and tables.up.x[-1] ** 2 > _WHOLE * self.highest:
            ends = f"is higher than {self.highest:.3g} m, far above what was measured,"
        return InputError(
            f"{what} {ends} in {self.fluid.word}, for a sphere of {self.radius:g} m and "
            f"{self.density:g} kg/m^3; look at units, "
            f"radius and density, or leave out {key}"
        )

    @cached_property
    def _tables(self) -> _Tables:
        # imported late: it takes longer to load than most calibrations
        from scipy.interpolate import CubicHermiteSpline

        last = float(np.sqrt(self.highest))
        root, up = self._branch(1.0, last)
        root, down = self._branch(-1.0, float(root[-1]))
        # derivatives of speed and time with respect to the root of the depth, for ascent and
        # descent
        slopes = []
        for sign, (speed, _) in ((1.0, up), (-1.0, down)):
            with np.errstate(invalid="ignore"):
                slow = np.where(root > 0.0, 2.0 * root / speed, np.sqrt(2.0 / self.pull))
            slopes.append(
                (
                    slow * (self.pull + sign * self.fluid.drag(speed, self.radius, self.density)),
                    slow,
                )
            )
        times = up[1] + down[1]
        by_root = slopes[0][1] + slopes[1][1]
        clock = np.concatenate([-up[1][:0:-1], down[1]])
        # so high that the times of the descent agree to the last digit
        if not np.all(np.diff(clock) > 0.0):
            raise self._too_far("so high a flight")
        fallen = np.concatenate([root[:0:-1], root]) ** 2
        velocity = np.concatenate([-up[0][:0:-1], down[0]])
        return _Tables(
            up=CubicHermiteSpline(root, up[0], slopes[0][0]),
            down=CubicHermiteSpline(root, down[0], slopes[1][0]),
            rise=CubicHermiteSpline(root, up[1], slopes[0][1]),
            time=CubicHermiteSpline(root, times, by_root),
            depth=CubicHermiteSpline(clock, fallen, velocity),
            lasted=CubicHermiteSpline(times, root, 1.0 / by_root),
            risen=CubicHermiteSpline(up[0], root, 1.0 / slopes[0][0]),
        )

    def _branch(self, sign: float, last: float) -> tuple[Floats, Floats]:
        """Return the roots of the depths, and speed and time from the apex there, for the
        ascent (sign 1) or the descent (-1).
        """
        from scipy.integrate import solve_ivp

        def slope(root: float, state: Floats) -> list[float]:
            slow = 2.0 * root / state[0]
            return [
                slow
                * (self.pull + sign * float(self.fluid.drag(state[0], self.radius, self.density))),
                slow,
            ]

        def too_fast(root: float, state: Floats) -> float:
            return float(state[0]) - _FASTEST

        too_fast.terminal = True  # type: ignore[attr-defined]
        first = _BEGIN * last
        begin = [np.sqrt(2.0 * self.pull) * first, np.sqrt(2.0 / self.pull) * first]
        found = solve_ivp(
            slope,
            (first, last),
            begin,
            method="DOP853",
            rtol=_CLOSE,
            atol=0.0,
            dense_output=True,
            events=too_fast,
            first_step=first,
        )
        root = np.linspace(0.0, found.t[-1], _POINTS)
        return root, np.hstack([np.zeros((2, 1)), found.sol(root[1:])])


class _Tables(NamedTuple):
    """Splines of a flight.

    As functions of the root of the height: the speeds of ascent (`up`) and descent (`down`), the
    time of ascent (`rise`) and of the flight (`time`). `depth`: depth below the apex as a function
    of the time from it. `lasted`, `risen`: root of the height as a function of the duration of the
    flight, and of its initial speed.
    """

    up: Any
    down: Any
    rise: Any
    time: Any
    depth: Any
    lasted: Any
    risen: Any
