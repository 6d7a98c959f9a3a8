r"""Spheres that lie on the plate and slip, roll and twist on it.

With the slip s of the contact point, of which the spin makes the part w, gravity :math:`g_n` along
the normal and :math:`g` along the plate, the mass m and the moment of inertia I, the friction Q and
the moment of rolling resistance M

.. math:: \dot v = g + \frac{Q}{m},\qquad \dot w = \frac{R^2 Q + R M}{I},\qquad s = v + w

.. math:: Q = -\mu m g_n \frac{s}{|s|},\qquad M = -\mu_r R\, m g_n \frac{w}{|w|}

where s or w is zero, Q or M is what keeps it so, up to these values. A sphere that rolls thus has
:math:`\dot v = \frac57 (g - \mu_r g_n v/|v|)`, and it stays at rest where the plate is less steep
than :math:`\mu` and :math:`\mu_r`.
Both are constant along a line, up to the next zero of s or w. The spin about the normal, which
changes neither, is integrated afterwards (`twisting`). In all cases, with the effective mass
:math:`m_t` of the tangential motion,
2/7 m of a solid sphere, and what the moment makes of the slip, :math:`\dot u = R M / I`,

.. math:: v = v_0 + \Bigl(1 - \frac{m_t}{m}\Bigr) g t + \frac{m_t}{m} (s - s_0 - u)

(K. L. Johnson, Contact Mechanics, 1985, section 8.1; the ball of billiards: G. Coriolis, 1835; the
moment: J. Ai, J.-F. Chen, J. M. Rotter and J. Y. Ooi, Powder Technol. 206:269, 2011, constant
directional torque).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.dynamics.oblique.state import Sphere, State
from vibroimpact.dynamics.oblique.twisting import slowed_spins

ACROSS = 1e-12
"""Of two vectors: the part of one across the other that counts as none."""

_STOPPED = 1e-9  # of the slip and the spin at the start: what has ended, where the motion turns

_TURNS = 3  # of false position, to where a centre turns back

# of the spin about the normal, from each place where slip or spin begin or end to the next
_TWIST_STEPS = 256


@dataclass(frozen=True)
class _Forces:
    """What acts on B spheres that lie on the plate.

    `gravity`: acceleration along the plate [m/s^2] (2, B). `bound`, `resistance`: what sliding and
    rolling friction take at most from the acceleration of the contact point [m/s^2] (B,). `share`:
    effective mass of the tangential motion over the mass (B,).
    """

    gravity: Floats
    bound: Floats
    resistance: Floats
    share: Floats

    def of(self, drop: int) -> _Forces:
        """Return what acts on one of the spheres."""
        one = slice(drop, drop + 1)
        return _Forces(self.gravity[:, one], self.bound[one], self.resistance[one], self.share[one])


class LyingSpheres:
    """The motion of B spheres that lie on the plate.

    Parameters
    ----------
    sphere : Sphere
        The spheres.
    start : State
        Their states at the beginning.
    law : FrictionLaw or None
        The friction law; None if there is no friction.
    pressing : array, shape (B,)
        Acceleration of gravity along the normal [m/s^2].
    until : array, shape (B,)
        Times up to which they are followed [s].

    Examples
    --------
    A sphere that starts without spin ends up rolling with 5/7 of its velocity:

    >>> from vibroimpact.contact.friction.laws.coulomb import Coulomb
    >>> one = np.ones(1)
    >>> ball, start = (
    ...     Sphere(one, one, 0.4 * one, np.zeros((2, 1))),
    ...     State(np.zeros((2, 1)), np.array([[7.0], [0.0]]), np.zeros((3, 1))),
    ... )
    >>> lying = LyingSpheres(ball, start, Coulomb(coefficient=0.1), 9.81 * one, 10.0 * one)
    >>> state, _ = lying.at(np.array([0]), 10.0 * one)
    >>> state.velocity[0].round(12).tolist(), state.spin[1].round(12).tolist()
    ([5.0], [5.0])
    """

    def __init__(
        self, sphere: Sphere, start: State, law: FrictionLaw | None, pressing: Floats, until: Floats
    ) -> None:
        self.sphere, self.start, self.until, self.share = (
            sphere,
            start,
            until,
            sphere.tangential_mass / sphere.mass,
        )
        sliding, rolling = (0.0, 0.0) if law is None else (law.coefficient, law.rolling_coefficient)
        self.slip, turning, share, none = (
            sphere.slip(start),
            sphere.turning(start),
            self.share,
            0.0 * until,
        )
        bound, resistance = sliding * pressing / share, rolling * pressing * (1.0 - share) / share
        forces = _Forces(
            np.broadcast_to(sphere.gravity, self.slip.shape),
            bound + none,
            resistance + none,
            share + none,
        )
        # of a sphere that rolls: its direction says nothing
        rounding = np.hypot(*self.slip) <= ACROSS * np.hypot(*turning)
        begin = np.where(rounding, 0.0, self.slip)
        self.phases = _straight(begin, turning, forces, until)
        self.curves = {
            drop: _Curve(begin[:, [drop]], turning[:, [drop]], forces.of(drop), float(until[drop]))
            for drop in np.flatnonzero(_turns(begin, turning, forces)).tolist()
        }
        self.twists: dict[int, tuple[Floats, ...]] = {}
        if law is not None:
            load = sphere.mass * pressing
            slower = law.twisting_moment(load) / sphere.inertia
            self.twists = {
                drop: self._twist(drop, law, load, slower)
                for drop in np.flatnonzero(start.spin[2] * slower).tolist()
            }

    def at(self, drops: Drops, time: Floats) -> tuple[State, Floats]:
        """Return the states of some spheres and the friction forces on them [N] (2, b) at
        times [s] (b,); one may be asked for often.
        """
        sphere, start, slip, share = (
            self.sphere.take(drops),
            self.start.take(drops),
            self.slip[:, drops],
            self.share[drops],
        )
        gravity, rows = sphere.gravity, _along_a_line(self.phases, drops, time)
        for drop, curve in self.curves.items():
            here = drops == drop
            rows[:, :, here] = curve.at(time[here])
        moved, now, turned_way, turned, taken = rows
        velocity = start.velocity + (1.0 - share) * gravity * time + share * (now - slip - turned)
        position = start.position + (start.velocity + 0.5 * (1.0 - share) * gravity * time) * time
        position = position + share * (moved - slip * time - turned_way)
        pushed = sphere.pushed(start, sphere.mass * (velocity - start.velocity - gravity * time))
        twist = np.zeros_like(time)
        for drop, (times, left, rate) in self.twists.items():
            here = np.flatnonzero(drops == drop)
            step = np.searchsorted(times, time[here], side="right") - 1
            now_left = np.maximum(left[step] - rate[step] * (time[here] - times[step]), 0.0)
            twist[here] = np.sign(start.spin[2, here]) * (now_left - left[0])
        return State(
            position, velocity, sphere.turned(pushed, turned, twist).spin
        ), -sphere.tangential_mass * taken

    def _twist(
        self, drop: int, law: FrictionLaw, load: Floats, slower: Floats
    ) -> tuple[Floats, ...]:
        """Return times [s], the sizes of the spin of a sphere about the normal then [rad/s], and
        the rates at which it falls from there on.

        `load`: normal forces [N]. `slower`: what full twisting takes from the spins [rad/s^2].
        """
        begins = (
            [begin for begin, _ in self.curves[drop].parts]
            if drop in self.curves
            else [phase.begin[drop] for phase in self.phases]
        )
        ends = np.unique([0.0, *begins, self.until[drop]])
        # close to where the slip begins or ends
        parts = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _TWIST_STEPS + 1)[:-1]))
        times = np.append((ends[:-1, None] + np.diff(ends)[:, None] * parts).ravel(), ends[-1])
        one = np.array([drop])
        state, friction = self.at(np.repeat(one, len(times)), times)
        friction, slip = (
            np.hypot(*friction)[:, None],
            np.hypot(*self.sphere.take(one).slip(state))[:, None],
        )
        full = slower[one] * times[:, None]
        left, lost = slowed_spins(
            law.take(one), self.start.spin[2, one], full, load[one] + 0.0 * full, friction, slip
        )
        return times, left[:, 0], np.append(lost[:, 0] / np.diff(times), 0.0)

    def edge_time(self, half: Floats) -> Floats:
        """Return the times at which the spheres leave the plate, as their centres first are beyond
        an edge [s] (B,); else their last times.

        `half`: half the sides of the plate [m] (2, 1).
        """

        def beside(time: Floats) -> Bools:
            (along, across), (length, width) = self._centres(time)[0], half
            return np.asarray((np.abs(along) > length) | (np.abs(across) > width))

        stations = self._stations()
        low, high, leaves = (
            np.zeros_like(self.until),
            self.until.copy(),
            np.zeros(len(self.until), dtype=bool),
        )
        for time, out in zip(stations, beside(stations), strict=True):
            low, high = np.where(leaves | out, low, time), np.where(out & ~leaves, time, high)
            leaves |= out
        for _ in range(60 if leaves.any() else 0):
            middle = 0.5 * (low + high)
            out = beside(middle)
            low, high = np.where(out, low, middle), np.where(out, middle, high)
        return np.where(leaves, high, self.until)

    def _stations(self) -> Floats:
        """Return times (K, B), in order, between which the centres move in one direction
        along each side of the plate.
        """
        steps = np.repeat(
            self.until[None],
            1 + max((len(curve.steps) for curve in self.curves.values()), default=0),
            axis=0,
        )
        for drop, curve in self.curves.items():
            steps[: len(curve.steps), drop] = curve.steps
        steps = np.sort(np.concatenate([[phase.begin for phase in self.phases], steps]), axis=0)
        found, speeds = [steps], self._centres(steps)[1]
        for axis in range(2):
            low, high, before, after = steps[:-1], steps[1:], speeds[axis, :-1], speeds[axis, 1:]
            # by false position: of a sphere that moves along a line the first one is exact
            for _ in range(_TURNS):
                turns = before * after < 0.0
                turn = np.where(
                    turns,
                    low
                    + (high - low)
                    * np.divide(before, before - after, out=np.ones_like(before), where=turns),
                    high,
                )
                there = self._centres(turn)[1][axis]
                ahead = there * before > 0.0
                low, before = np.where(ahead, turn, low), np.where(ahead, there, before)
                high, after = np.where(ahead, high, turn), np.where(ahead, after, there)
            found.append(turn)
        return np.sort(np.concatenate(found), axis=0)

    def _centres(self, time: Floats) -> tuple[Floats, Floats]:
        """Return places [m] and velocities [m/s] of all centres at times [s] (..., B):
        (2, ..., B).
        """
        drops = np.broadcast_to(np.arange(len(self.until)), time.shape)
        state, _ = self.at(drops.ravel(), time.ravel())
        return state.position.reshape(2, *time.shape), state.velocity.reshape(2, *time.shape)


def _across(one: Floats, other: Floats) -> Bools:
    """Return where two vectors do not lie along one line."""
    return np.asarray(
        np.abs(one[0] * other[1] - one[1] * other[0]) > ACROSS * np.hypot(*one) * np.hypot(*other)
    )


def _turns(slip: Floats, turning: Floats, forces: _Forces) -> Bools:
    """Return where gravity pulls across the slip, or the moment acts across one of both,
    so that directions turn.
    """
    moment = (forces.resistance > 0.0) & (_across(slip, turning) | _across(forces.gravity, turning))
    return np.asarray(_across(slip, forces.gravity) | moment)


class _Phase(NamedTuple):
    """A part of the motion of spheres along a line, without a zero of the slip or the spin within
    it.

    `begin`: of the part [s] (B,). `along`: the direction (2, B). Then, along it (B,): at its begin
    the way of the contact point, its slip, and what the moment makes of both; the acceleration of
    the slip, what the moment adds to it, and what friction takes from it.
    """

    begin: Floats
    along: Floats
    way: Floats
    slip: Floats
    turned_way: Floats
    turned: Floats
    rate: Floats
    turn: Floats
    taken: Floats

    def at(self, drops: Drops, time: Floats) -> Floats:
        """Return the way of the contact point and its slip, what the moment makes of
        both, and what friction takes, at times (5, 2, b).
        """
        along, (begin, *parts) = (
            self.along[:, drops],
            (part[drops] for part in (self.begin, *self[2:])),
        )
        way, slip, turned_way, turned, rate, turn, taken = parts
        step = time - begin
        way, turned_way = (
            way + (slip * step + 0.5 * rate * step**2),
            turned_way + (turned * step + 0.5 * turn * step**2),
        )
        return (
            np.stack([way, slip + rate * step, turned_way, turned + turn * step, taken])[:, None]
            * along
        )


def _straight(slip: Floats, turning: Floats, forces: _Forces, until: Floats) -> list[_Phase]:
    """Return the motion of spheres along a line, from one zero of the slip or the spin to
    the next; arrays are (2, B).
    """
    speed, down, around = np.hypot(*slip), np.hypot(*forces.gravity), np.hypot(*turning)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(around > 0.0, turning / around, 0.0)
        along = np.where(
            speed > 0.0, slip / speed, np.where(down > 0.0, forces.gravity / down, along)
        )
    pull, spin, begin = (
        (forces.gravity * along).sum(axis=0),
        (turning * along).sum(axis=0),
        np.zeros_like(until),
    )
    way, now, turned_way, turned = (
        np.zeros_like(speed),
        speed,
        np.zeros_like(speed),
        np.zeros_like(speed),
    )
    phases: list[_Phase] = []
    while True:
        rate, turn, taken = _rates(now, spin, pull, forces)
        phases.append(_Phase(begin, along, way, now, turned_way, turned, rate, turn, taken))
        left = until - begin
        if not (left > 0.0).any():
            return phases
        spin_rate = (1.0 - forces.share) * (rate - pull) + forces.share * turn
        with np.errstate(divide="ignore", invalid="ignore"):
            stop = np.where(now * rate < 0.0, -now / rate, np.inf)
            settle = np.where(
                (forces.resistance > 0.0) & (spin * spin_rate < 0.0), -spin / spin_rate, np.inf
            )
        step = np.minimum(np.maximum(left, 0.0), np.minimum(stop, settle))
        way = way + (now * step + 0.5 * rate * step**2)
        turned_way = turned_way + (turned * step + 0.5 * turn * step**2)
        turned = turned + turn * step
        now, spin = (
            np.where(step < stop, now + rate * step, 0.0),
            np.where(step < settle, spin + spin_rate * step, 0.0),
        )
        begin = np.minimum(begin + step, until)


def _along_a_line(phases: Sequence[_Phase], drops: Drops, time: Floats) -> Floats:
    """Return the rows of `_Phase.at` of some spheres at times [s] (b,), each in the last
    phase that has begun.
    """
    found = phases[0].at(drops, time)
    for phase in phases[1:]:
        found = np.where(time >= phase.begin[drops], phase.at(drops, time), found)
    return found


def _rates(
    slip: Floats, turning: Floats, pull: Floats, forces: _Forces
) -> tuple[Floats, Floats, Floats]:
    """Return the accelerations of the slip along a line, what the moment adds to it, and
    what friction takes from it.
    """
    sliding_friction = forces.bound * np.sign(slip)
    friction = np.where(
        slip != 0.0, sliding_friction, np.clip(pull / forces.share, -forces.bound, forces.bound)
    )
    holding = (1.0 - forces.share) * friction  # the moment that leaves a sphere without spin
    turn = np.where(
        turning != 0.0,
        -forces.resistance * np.sign(turning),
        np.clip(holding, -forces.resistance, forces.resistance),
    )
    free = pull + turn
    # where the slip has ended it begins again, if friction can't hold it
    again = np.sign(free) * np.maximum(np.abs(free) - forces.bound, 0.0)
    return (
        np.where(slip != 0.0, free - sliding_friction, again),
        turn,
        np.where(slip != 0.0, sliding_friction, free - again),
    )


class _Curve:
    """The motion of one sphere whose directions turn, by integration from one zero of the slip or
    the spin to the next.

    `slip`, `turning`: at the start (2, 1). `until`: its end [s]. The rows of its state (rows, 2, T)
    are the first four of `_Phase.at`, two where rolling is not resisted. `steps`: times of the
    integration [s]. `parts`: their begins [s], and the rows of `_Phase.at` at times within them.
    """

    def __init__(self, slip: Floats, turning: Floats, forces: _Forces, until: float) -> None:
        self.slip, self.turning, self.forces, self.gravity = slip, turning, forces, forces.gravity
        self.bound, self.resistance, self.share = (
            float(part[0]) for part in (forces.bound, forces.resistance, forces.share)
        )
        self.resists = self.resistance > 0.0
        self.least = _STOPPED * float(
            (np.hypot(*slip) + (np.hypot(*turning) if self.resists else 0.0))[0]
        )
        self.steps = np.zeros(1)
        self.parts: list[tuple[float, Callable[[Floats], Floats]]] = []
        self._follow(until)

    def at(self, time: Floats) -> Floats:
        """Return the rows of `_Phase.at` at times [s] (T,)."""
        found = np.empty((5, 2, len(time)))
        for begin, part in self.parts:
            later = time >= begin
            if later.any():
                found[:, :, later] = part(time[later])
        return found

    def _follow(self, until: float) -> None:
        """Find the parts up to a time [s]."""
        time, rows = 0.0, np.zeros((4 if self.resists else 2, 2, 1))
        rows[1], slips = self.slip, self._goes_on(self.slip)
        while True:
            # not what has ended in the last part
            turns = self.resists and self._goes_on(0.5 * self._spin(time, rows))
            slips = slips or (
                turns and float(np.hypot(*(self.gravity + self._turn(time, rows)))[0]) > self.bound
            )
            if not (slips or turns):
                self.parts.append((time, self._straight_on(time, rows, until)))
                return
            time, rows, slips = self._integrate(time, rows, until, slips, turns)
            rows[1] *= slips
            if time >= until:
                return

    def _goes_on(self, vector: Floats) -> bool:
        """Return whether a slip or a spin has not ended."""
        return float(np.hypot(*vector)[0]) > self.least

    def _directed(self, size: float, vector: Floats) -> Floats:
        """Return a vector of a size along another one; shorter where that has ended."""
        return np.asarray(size * vector / np.maximum(np.hypot(*vector), self.least))

    def _spin(self, time: Floats | float, rows: Floats) -> Floats:
        """Return what the spin makes of the slip."""
        return np.asarray(
            self.turning
            + (1.0 - self.share) * (rows[1] - self.slip - self.gravity * time)
            + self.share * rows[3]
        )

    def _turn(self, time: Floats | float, rows: Floats, held: bool = False) -> Floats:
        """Return what the moment adds to the acceleration of the slip; `held`: so that
        the sphere stays without spin.
        """
        if held:
            return self._directed((1.0 - self.share) * self.bound, rows[1])
        return self._directed(-self.resistance, self._spin(time, rows))

    def _integrate(
        self, begin: float, rows: Floats, until: float, slips: bool, turns: bool
    ) -> tuple[float, Floats, bool]:
        """Add a part to where slip or spin end, or the slip begins; return time and state
        there, and whether it slips then.
        """
        from scipy.integrate import solve_ivp  # what moves along one line does not load it

        held = not turns and self.resistance >= (1.0 - self.share) * self.bound

        def rates(time: float, flat: Floats) -> Floats:
            rows = flat.reshape(-1, 2, 1)
            if not self.resists:
                return np.concatenate(
                    [rows[1], self.gravity - self._directed(self.bound, rows[1])]
                ).ravel()
            turn = self._turn(time, rows, held)
            rate = (
                self.gravity + turn - self._directed(self.bound, rows[1])
                if slips
                else np.zeros((2, 1))
            )
            return np.concatenate([rows[1], rate, rows[3], turn]).ravel()

        def changes(time: float, flat: Floats) -> float:
            rows = flat.reshape(-1, 2, 1)
            left = (
                np.hypot(*rows[1]) - self.least
                if slips
                else self.bound - np.hypot(*(self.gravity + self._turn(time, rows)))
            )
            return float(left[0])

        def settles(time: float, flat: Floats) -> float:
            return float(np.hypot(*self._spin(time, flat.reshape(-1, 2, 1)))[0] - self.least)

        ends = [changes, settles] if turns else [changes]
        for one in ends:
            one.terminal, one.direction = True, -1.0  # type: ignore[attr-defined]
        # an error that is small beside what counts as ended, however slow the motion: else the end
        # is stepped over to and fro for ever
        settings = {
            "method": "DOP853",
            "rtol": 1e-11,
            "atol": 1e-5 * self.least,
            "dense_output": True,
        }
        found = solve_ivp(rates, (begin, until), rows.ravel(), events=ends, **settings)

        def part(time: Floats) -> Floats:
            rows = found.sol(time).reshape(-1, 2, len(time))
            taken = (
                self._directed(self.bound, rows[1])
                if slips
                else self.gravity + self._turn(time, rows)
            )
            return np.concatenate([rows, np.zeros((4 - len(rows), 2, len(time))), taken[None]])

        self.parts.append((begin, part))
        self.steps = np.append(self.steps, found.t)
        return (
            float(found.t[-1]),
            found.y[:, -1].reshape(-1, 2, 1),
            slips != bool(len(found.t_events[0])),
        )

    def _straight_on(self, begin: float, rows: Floats, until: float) -> Callable[[Floats], Floats]:
        """Return the rows from a time on when slip and spin have ended."""
        so_far, nothing = np.zeros((5, 2, 1)), np.zeros((2, 1))
        so_far[: len(rows)] = rows
        phases = _straight(nothing, nothing, self.forces, np.array([until - begin]))

        def part(time: Floats) -> Floats:
            found = so_far + _along_a_line(phases, np.zeros(len(time), dtype=np.intp), time - begin)
            found[2] += so_far[3] * (time - begin)
            return found

        return part
