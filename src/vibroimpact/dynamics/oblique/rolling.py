r"""Spheres that lie on the plate and slip, roll and twist on it.

With the slip s of the contact point, of which the spin makes the part w, gravity :math:`g_n` along the normal and :math:`g` along the
plate, the mass m and the moment of inertia I, the friction Q and the moment of rolling resistance M

.. math:: \dot v = g + \frac{Q}{m},\qquad \dot w = \frac{R^2 Q + R M}{I},\qquad s = v + w

.. math:: Q = -\mu m g_n \frac{s}{|s|},\qquad M = -\mu_r R\, m g_n \frac{w}{|w|}

where s or w is zero, Q or M is what keeps it so, up to these values. A sphere that rolls thus has
:math:`\dot v = \frac57 (g - \mu_r g_n v/|v|)`, and it stays at rest where the plate is less steep than :math:`\mu` and :math:`\mu_r`.
Both are constant along a line, up to the next zero of s or w. In all cases, with the effective mass :math:`m_t` of the tangential motion,
2/7 m of a solid sphere, and what the moment makes of the slip, :math:`\dot u = R M / I`,

.. math:: v = v_0 + \Bigl(1 - \frac{m_t}{m}\Bigr) g t + \frac{m_t}{m} (s - s_0 - u)

(K. L. Johnson, Contact Mechanics, 1985, section 8.1; the ball of billiards: G. Coriolis, 1835; the moment: J. Ai, J.-F. Chen,
J. M. Rotter and J. Y. Ooi, Powder Technol. 206:269, 2011, constant directional torque).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.dynamics.oblique.state import Sphere, State

ACROSS = 1e-12
"""Of two vectors: the part of one across the other that counts as none."""

_STOPPED = 1e-9  # of the slip and the spin at the start: what has ended, where the motion turns


@dataclass(frozen=True)
class _Lying:
    """What acts on B spheres that lie on the plate.

    `gravity`: acceleration along the plate [m/s^2] (2, B). `bound`, `resistance`: what sliding and rolling friction take at most from the
    acceleration of the contact point [m/s^2] (B,). `share`: effective mass of the tangential motion over the mass (B,).
    """

    gravity: Floats
    bound: Floats
    resistance: Floats
    share: Floats

    def of(self, drop: int) -> _Lying:
        """Return what acts on one of the spheres."""
        one = slice(drop, drop + 1)
        return _Lying(self.gravity[:, one], self.bound[one], self.resistance[one], self.share[one])


def slide_and_roll(sphere: Sphere, start: State, law: FrictionLaw | None, pressing: Floats, elapsed: Floats) -> tuple[State, Floats]:
    """Return the states of spheres that lie on the plate after a time [s], and the friction forces on them [N] (2, B).

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
    elapsed : array, shape (B,)
        Times [s].

    Examples
    --------
    A sphere that starts without spin ends up rolling with 5/7 of its velocity:

    >>> from vibroimpact.contact.friction.laws.coulomb import Coulomb
    >>> one = np.ones(1)
    >>> ball, start = Sphere(one, one, 0.4 * one, np.zeros((2, 1))), State(np.zeros((2, 1)), np.array([[7.0], [0.0]]), np.zeros((3, 1)))
    >>> state, _ = slide_and_roll(ball, start, Coulomb(coefficient=0.1), 9.81 * one, 10.0 * one)
    >>> state.velocity[0].round(12).tolist(), state.spin[1].round(12).tolist()
    ([5.0], [5.0])
    """
    share, none = sphere.tangential_mass / sphere.mass, 0.0 * elapsed
    sliding, rolling = (0.0, 0.0) if law is None else (law.coefficient, law.rolling_coefficient)
    gravity = np.broadcast_to(sphere.gravity, start.velocity.shape)
    lying = _Lying(gravity, sliding * pressing / share + none, rolling * pressing * (1.0 - share) / share + none, share + none)
    slip, turning = sphere.slip(start), sphere.turning(start)
    rounding = np.hypot(*slip) <= ACROSS * np.hypot(*turning)  # of a sphere that rolls: its direction says nothing
    begin = np.where(rounding, 0.0, slip)
    found = _straight(begin, turning, lying, elapsed)
    for drop in np.flatnonzero(_turns(begin, turning, lying)):
        found[:, :, drop] = _curved(begin[:, drop], turning[:, drop], lying.of(int(drop)), float(elapsed[drop]))
    moved, now, turned_way, turned, taken = found
    velocity = start.velocity + (1.0 - share) * gravity * elapsed + share * (now - slip - turned)
    position = start.position + (start.velocity + 0.5 * (1.0 - share) * gravity * elapsed) * elapsed
    position = position + share * (moved - slip * elapsed - turned_way)
    pushed = sphere.pushed(start, sphere.mass * (velocity - start.velocity - gravity * elapsed))
    twist = 0.0 if law is None else sphere.twist(start, law.twisting_moment(sphere.mass * pressing) * elapsed)
    return State(position, velocity, sphere.turned(pushed, turned, twist).spin), -sphere.tangential_mass * taken


def _across(one: Floats, other: Floats) -> Bools:
    """Return where two vectors do not lie along one line."""
    return np.asarray(np.abs(one[0] * other[1] - one[1] * other[0]) > ACROSS * np.hypot(*one) * np.hypot(*other))


def _turns(slip: Floats, turning: Floats, lying: _Lying) -> Bools:
    """Return where gravity pulls across the slip, or the moment acts across one of both, so that directions turn."""
    moment = (lying.resistance > 0.0) & (_across(slip, turning) | _across(lying.gravity, turning))
    return np.asarray(_across(slip, lying.gravity) | moment)


def _straight(slip: Floats, turning: Floats, lying: _Lying, elapsed: Floats) -> Floats:
    """Return the way of the contact point and its slip, what the moment makes of both, and what friction takes from the acceleration.

    All is along one line, from one zero of the slip or the spin to the next. Arrays are (2, B), the result (5, 2, B).
    """
    speed, down, around = np.hypot(*slip), np.hypot(*lying.gravity), np.hypot(*turning)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(around > 0.0, turning / around, 0.0)
        along = np.where(speed > 0.0, slip / speed, np.where(down > 0.0, lying.gravity / down, along))
    pull, spin, left = (lying.gravity * along).sum(axis=0), (turning * along).sum(axis=0), elapsed
    way, now, turned_way, turned = np.zeros_like(speed), speed, np.zeros_like(speed), np.zeros_like(speed)
    while True:
        rate, turn, taken = _rates(now, spin, pull, lying)
        if not (left > 0.0).any():
            return np.asarray(np.stack([way, now, turned_way, turned, taken])[:, None] * along)
        spin_rate = (1.0 - lying.share) * (rate - pull) + lying.share * turn
        with np.errstate(divide="ignore", invalid="ignore"):
            stop = np.where(now * rate < 0.0, -now / rate, np.inf)
            settle = np.where((lying.resistance > 0.0) & (spin * spin_rate < 0.0), -spin / spin_rate, np.inf)
        step = np.minimum(left, np.minimum(stop, settle))
        way = way + (now * step + 0.5 * rate * step**2)
        turned_way = turned_way + (turned * step + 0.5 * turn * step**2)
        turned = turned + turn * step
        now, spin = np.where(step < stop, now + rate * step, 0.0), np.where(step < settle, spin + spin_rate * step, 0.0)
        left = left - step


def _rates(slip: Floats, turning: Floats, pull: Floats, lying: _Lying) -> tuple[Floats, Floats, Floats]:
    """Return the accelerations of the slip along a line, what the moment adds to it, and what friction takes from it."""
    rubbed = lying.bound * np.sign(slip)
    friction = np.where(slip != 0.0, rubbed, np.clip(pull / lying.share, -lying.bound, lying.bound))
    holding = (1.0 - lying.share) * friction  # the moment that leaves a sphere without spin
    turn = np.where(turning != 0.0, -lying.resistance * np.sign(turning), np.clip(holding, -lying.resistance, lying.resistance))
    free = pull + turn
    # where the slip has ended it begins again, if friction can't hold it
    again = np.sign(free) * np.maximum(np.abs(free) - lying.bound, 0.0)
    return np.where(slip != 0.0, free - rubbed, again), turn, np.where(slip != 0.0, rubbed, free - again)


class _Curve:
    """The motion of one sphere whose directions turn; `slip`, `turning`: at the beginning (2,).

    The rows of its state are the first four of what `_straight` returns, two where rolling is not resisted.
    """

    def __init__(self, slip: Floats, turning: Floats, lying: _Lying) -> None:
        self.slip, self.turning, self.gravity = slip, turning, lying.gravity[:, 0]
        self.bound, self.resistance, self.share = (float(part[0]) for part in (lying.bound, lying.resistance, lying.share))
        self.resists = self.resistance > 0.0
        self.least = _STOPPED * (np.hypot(*slip) + (np.hypot(*turning) if self.resists else 0.0))

    def directed(self, size: float, vector: Floats) -> Floats:
        """Return a vector of a size along another one; shorter where that has ended."""
        return np.asarray(size * vector / max(np.hypot(*vector), self.least))

    def spin(self, time: float, rows: Floats) -> Floats:
        """Return what the spin makes of the slip."""
        return np.asarray(self.turning + (1.0 - self.share) * (rows[1] - self.slip - self.gravity * time) + self.share * rows[3])

    def turn(self, time: float, rows: Floats, held: bool = False) -> Floats:
        """Return what the moment adds to the acceleration of the slip; `held`: so that the sphere stays without spin."""
        if held:
            return self.directed((1.0 - self.share) * self.bound, rows[1])
        return self.directed(-self.resistance, self.spin(time, rows))

    def phase(self, time: float, rows: Floats, end: float, slips: bool, turns: bool, held: bool) -> tuple[float, Floats, bool]:
        """Return time and state where slip or spin end, or the slip begins, at most at a time, and whether it slips then."""
        from scipy.integrate import solve_ivp  # what moves along one line does not load it

        def rates(time: float, flat: Floats) -> Floats:
            rows = flat.reshape(-1, 2)
            if not self.resists:
                return np.concatenate([rows[1], self.gravity - self.directed(self.bound, rows[1])])
            turn = self.turn(time, rows, held)
            rate = self.gravity + turn - self.directed(self.bound, rows[1]) if slips else np.zeros(2)
            return np.concatenate([rows[1], rate, rows[3], turn])

        def changes(time: float, flat: Floats) -> float:
            rows = flat.reshape(-1, 2)
            left = np.hypot(*rows[1]) - self.least if slips else self.bound - np.hypot(*(self.gravity + self.turn(time, rows)))
            return float(left)

        def settles(time: float, flat: Floats) -> float:
            return float(np.hypot(*self.spin(time, flat.reshape(-1, 2))) - self.least)

        ends = [changes, settles] if turns else [changes]
        for one in ends:
            one.terminal, one.direction = True, -1.0  # type: ignore[attr-defined]
        found = solve_ivp(rates, (time, end), rows.ravel(), events=ends, method="DOP853", rtol=1e-11, atol=1e-14)
        return float(found.t[-1]), found.y[:, -1].reshape(-1, 2), slips != bool(len(found.t_events[0]))


def _curved(slip: Floats, turning: Floats, lying: _Lying, elapsed: float) -> Floats:
    """Return the same of one sphere whose directions turn (5, 2), by integration from one zero of the slip or the spin to the next."""
    curve = _Curve(slip, turning, lying)
    time, rows, turn = 0.0, np.zeros((4 if curve.resists else 2, 2)), np.zeros(2)
    rows[1], slips, turns, held = slip, bool(np.hypot(*slip) > curve.least), False, False
    while True:
        if curve.resists:
            turns = np.hypot(*curve.spin(time, rows)) > 2.0 * curve.least  # which has not ended in the last phase
            held = not turns and curve.resistance >= (1.0 - curve.share) * curve.bound
            turn = curve.turn(time, rows, held)
            slips = slips or (turns and np.hypot(*(curve.gravity + turn)) > curve.bound)
        if time >= elapsed or not (slips or turns):
            break
        time, rows, slips = curve.phase(time, rows, elapsed, slips, turns, held)
        rows[1] *= slips
    way, now, turned_way, turned = rows if curve.resists else (*rows, np.zeros(2), np.zeros(2))
    if slips:
        return np.stack([way, now, turned_way, turned, curve.directed(curve.bound, now)])
    if turns:
        return np.stack([way, now, turned_way, turned, curve.gravity + turn])
    left, nothing = elapsed - time, np.zeros((2, 1))
    rest = _straight(nothing, nothing, lying, np.array([left]))[:, :, 0]
    return np.asarray(rest + np.stack([way, np.zeros(2), turned_way + left * turned, turned, np.zeros(2)]))


def edge_time(sphere: Sphere, start: State, law: FrictionLaw | None, pressing: Floats, elapsed: Floats, half: Floats) -> Floats:
    """Return the times at which spheres that lie on the plate leave it over an edge [s], at most `elapsed`.

    `half`: half the sides of the plate [m] (2, 1).
    """

    def beside(time: Floats) -> Bools:
        state, _ = slide_and_roll(sphere, start, law, pressing, time)
        return np.asarray((np.abs(state.position) > half).any(axis=0))

    low, high = np.zeros(len(elapsed)), elapsed.copy()
    leaves = beside(high)
    for _ in range(60 if leaves.any() else 0):
        middle = 0.5 * (low + high)
        out = beside(middle)
        low, high = np.where(out, low, middle), np.where(out, middle, high)
    return np.where(leaves, high, elapsed)
