r"""Vertical flights in still air or a still liquid, with drag."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.flights import EndSpeeds, ReturnFlight
from vibroimpact.dynamics.fluids.air import Air
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.errors import InputError

_POINTS = 513
"""Points of a table; cubic interpolation errs by 1e-9 for a fall of 4 m."""

_BEGIN = 1e-6
"""Start of the integration, as a fraction of the range of the root of the height; drag is
negligible below it.
"""

_TOLERANCE = 1e-11
"""Relative tolerance of the integration."""

_FASTEST = 1e4
"""Speed at which the integration stops [m/s]."""

_WHOLE = 0.999
"""Fraction of the largest rise asked for from which on the tables reach it."""


@dataclass(frozen=True)
class FluidFlights:
    r"""Vertical flights of a sphere in still air or a still liquid.

    Below the top of a flight, at a depth s, :math:`v\,dv/ds = g - a(v)` on the way down and
    :math:`g + a(v)` on the way up, with the deceleration a by drag of
    `vibroimpact.dynamics.fluids.fluid`, and as g in a liquid the part of gravity that buoyancy and
    added mass leave. Both equations are integrated once over the square root of s, in which speeds
    and times are smooth, and then interpolated by cubic Hermite splines.

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
        """Return the speed after a fall from rest through a height [m/s], and its slope [1/s]."""
        speed = self._speed_from(self._tables.down, height)
        return speed, self._acceleration(speed, -1.0) / speed

    def speed_to_rise(self, height: Floats) -> tuple[Floats, Floats]:
        """Return the initial speed needed to rise by a height [m/s], and its slope [1/s]."""
        speed = self._speed_from(self._tables.up, height)
        return speed, self._acceleration(speed, 1.0) / speed

    def depth_at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the depth below the apex [m] at times from it [s], and downward velocity [m/s]."""
        depth = self._tables.depth
        tabulated_time = np.clip(time, depth.x[0], depth.x[-1])
        return np.asarray(depth(tabulated_time)), np.asarray(depth(tabulated_time, 1))

    def end_speeds(self, time: Floats) -> EndSpeeds:
        """Return the initial and final speeds of flights of given durations [s]."""
        tables = self._tables
        if np.any(time > tables.root_of_duration.x[-1]):
            raise self._too_far(f"a flight of {np.max(time):.4g} s", tables)
        root = tables.root_of_duration(time)
        root_slope = tables.root_of_duration(time, 1)
        return EndSpeeds(
            start=np.asarray(tables.up(root)),
            end=np.asarray(tables.down(root)),
            start_slope=np.asarray(tables.up(root, 1) * root_slope),
            end_slope=np.asarray(tables.down(root, 1) * root_slope),
        )

    def flight(self, speed: Floats) -> ReturnFlight:
        """Return the flights with given initial speeds [m/s]."""
        tables = self._tables
        if np.any(speed > tables.root_of_speed.x[-1]):
            raise self._too_far(f"a flight that begins with {np.max(speed):.4g} m/s", tables)
        root = tables.root_of_speed(speed)
        return ReturnFlight(
            height=np.asarray(root**2),
            rise_time=np.asarray(tables.rise(root)),
            duration=np.asarray(tables.duration(root)),
            return_speed=np.asarray(tables.down(root)),
        )

    def _acceleration(self, speed: Floats, sign: float) -> Floats:
        """Return the change of the speed by the time from the apex [m/s^2].

        It is that of the ascent (sign 1), in which drag adds to gravity, or the descent (-1).
        """
        return np.asarray(self.pull + sign * self.fluid.drag(speed, self.radius, self.density))

    def _speed_from(self, table: Any, height: Floats) -> Floats:
        if np.any(height > table.x[-1] ** 2):
            raise self._too_far(f"a rise of {np.max(height):.4g} m", self._tables)
        return np.asarray(table(np.sqrt(height)))

    def _too_far(self, what: str, tables: _Tables | None = None) -> InputError:
        """Return the error of a flight beyond the tables.

        They end where flights are not possible, or at the largest rise asked for.
        """
        key = "contact.liquid"
        if isinstance(self.fluid, Air):
            key = "drop.air and calibrate.air"
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

        highest_root = float(np.sqrt(self.highest))
        root, up_speed, up_time = self._branch(1.0, highest_root)
        # up to the height that the ascent has reached
        root, down_speed, down_time = self._branch(-1.0, float(root[-1]))
        up_speed_slope, up_time_slope = self._slopes(1.0, root, up_speed)
        down_speed_slope, down_time_slope = self._slopes(-1.0, root, down_speed)
        duration = up_time + down_time
        duration_slope = up_time_slope + down_time_slope
        # from the begin of the ascent to the end of the descent; the apex is in both
        time = np.concatenate([-up_time[:0:-1], down_time])
        # so high that the times of the descent agree to the last digit
        if not np.all(np.diff(time) > 0.0):
            raise self._too_far("so high a flight")
        depth = np.concatenate([root[:0:-1], root]) ** 2
        velocity = np.concatenate([-up_speed[:0:-1], down_speed])
        return _Tables(
            up=CubicHermiteSpline(root, up_speed, up_speed_slope),
            down=CubicHermiteSpline(root, down_speed, down_speed_slope),
            rise=CubicHermiteSpline(root, up_time, up_time_slope),
            duration=CubicHermiteSpline(root, duration, duration_slope),
            depth=CubicHermiteSpline(time, depth, velocity),
            root_of_duration=CubicHermiteSpline(duration, root, 1.0 / duration_slope),
            root_of_speed=CubicHermiteSpline(up_speed, root, 1.0 / up_speed_slope),
        )

    def _slopes(self, sign: float, root: Floats, speed: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of speed and time by the root of the depth, of which s = root^2.

        They are dt/droot = 2 root / v, and dv/droot = (g + sign a) dt/droot; `sign` is 1 for the
        ascent and -1 for the descent.
        """
        with np.errstate(invalid="ignore"):
            # at the apex v = root sqrt(2 g)
            time_slope = np.where(root > 0.0, 2.0 * root / speed, np.sqrt(2.0 / self.pull))
        return time_slope * self._acceleration(speed, sign), time_slope

    def _branch(self, sign: float, highest_root: float) -> tuple[Floats, Floats, Floats]:
        """Return roots of depths, and the speeds and the times from the apex there.

        They are those of the ascent (sign 1) or the descent (-1).
        """
        from scipy.integrate import solve_ivp

        def slope(root: float, state: Floats) -> list[float]:
            time_slope = 2.0 * root / state[0]
            drag = float(self.fluid.drag(state[0], self.radius, self.density))
            return [time_slope * (self.pull + sign * drag), time_slope]

        def too_fast(root: float, state: Floats) -> float:
            return float(state[0]) - _FASTEST

        too_fast.terminal = True  # type: ignore[attr-defined]
        first = _BEGIN * highest_root
        # without drag v = root sqrt(2 g), t = root sqrt(2 / g)
        start = [np.sqrt(2.0 * self.pull) * first, np.sqrt(2.0 / self.pull) * first]
        solution = solve_ivp(
            slope,
            (first, highest_root),
            start,
            method="DOP853",
            rtol=_TOLERANCE,
            atol=0.0,
            dense_output=True,
            events=too_fast,
            first_step=first,
        )
        root = np.linspace(0.0, solution.t[-1], _POINTS)
        # at the apex both are 0; the integration begins a little below it
        speed, time = np.hstack([np.zeros((2, 1)), solution.sol(root[1:])])
        return root, speed, time


class _Tables(NamedTuple):
    """Splines of a flight.

    As functions of the root of the height: the speeds of ascent (`up`) and descent (`down`), the
    time of ascent (`rise`) and of the flight (`duration`). `depth`: depth below the apex as a
    function of the time from it. The root of the height as a function of the duration of the
    flight, and of its initial speed.
    """

    up: Any
    down: Any
    rise: Any
    duration: Any
    depth: Any
    root_of_duration: Any
    root_of_speed: Any
