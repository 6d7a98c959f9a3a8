r"""Spheres that lie on the plate and slip or roll along it.

With the slip s of the contact point, gravity :math:`g_n` along the normal and :math:`g` along the plate, and the effective mass
:math:`m_t` of the tangential motion, 2/7 m of a solid sphere, the slip follows

.. math:: \dot s = g - \frac{m}{m_t}\, \mu g_n \frac{s}{|s|}

until it has ended. Then the sphere rolls, if :math:`m_t |g| / m \le \mu g_n`, with 5/7 of the acceleration of gravity; else it slips on
downhill. In all cases the centre has

.. math:: v = v_0 + \Bigl(1 - \frac{m_t}{m}\Bigr) g t + \frac{m_t}{m} (s - s_0)

(K. L. Johnson, Contact Mechanics, 1985, section 8.1; the ball of billiards: G. Coriolis, 1835).
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array, Bools, Floats
from vibroimpact.dynamics.oblique.state import Sphere, State

_ACROSS = 1e-12  # of gravity: a pull across the slip that counts as none
_STOPPED = 1e-9  # of the slip at the start: it has ended where it turns against gravity


def slide_and_roll(sphere: Sphere, start: State, coefficient: Array, pressing: Floats, elapsed: Floats) -> tuple[State, Floats]:
    """Return the states of spheres that lie on the plate after a time [s], and the friction forces on them [N] (2, B).

    Parameters
    ----------
    sphere : Sphere
        The spheres.
    start : State
        Their states at the beginning.
    coefficient : float or array, shape (B,)
        Coefficient of friction.
    pressing : array, shape (B,)
        Acceleration of gravity along the normal [m/s^2].
    elapsed : array, shape (B,)
        Times [s].

    Examples
    --------
    A sphere that starts without spin ends up rolling with 5/7 of its velocity:

    >>> one, none = np.ones(1), np.zeros(1)
    >>> ball = Sphere(one, one, 0.4 * one, np.zeros((2, 1)))
    >>> state, _ = slide_and_roll(ball, State(np.zeros((2, 1)), np.array([[7.0], [0.0]]), np.zeros((3, 1))), 0.1, 9.81 * one, 10.0 * one)
    >>> state.velocity[0].round(12).tolist(), state.spin[1].round(12).tolist()
    ([5.0], [5.0])
    """
    share = sphere.tangential_mass / sphere.mass
    slip, gravity = sphere.slip(start), np.broadcast_to(sphere.gravity, start.velocity.shape)
    bound = coefficient * pressing / share
    moved, now, pull = _straight(slip, gravity, bound + 0.0 * elapsed, elapsed)
    for drop in np.flatnonzero(_turns(slip, gravity)):
        moved[:, drop], now[:, drop], pull[:, drop] = _curved(slip[:, drop], gravity[:, drop], float(bound[drop]), float(elapsed[drop]))
    velocity = start.velocity + (1.0 - share) * gravity * elapsed + share * (now - slip)
    position = start.position + (start.velocity + 0.5 * (1.0 - share) * gravity * elapsed) * elapsed + share * (moved - slip * elapsed)
    pushed = sphere.pushed(start, sphere.mass * (velocity - start.velocity - gravity * elapsed))
    return State(position, velocity, pushed.spin), -sphere.tangential_mass * pull


def _turns(slip: Floats, gravity: Floats) -> Bools:
    """Return where gravity pulls across the slip, so that its direction turns."""
    across = np.abs(slip[0] * gravity[1] - slip[1] * gravity[0])
    return np.asarray(across > _ACROSS * np.hypot(*slip) * np.hypot(*gravity))


def _straight(slip: Floats, gravity: Floats, bound: Floats, elapsed: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the way of the contact point, its slip, and what friction takes from the acceleration of it, where all is along one line.

    `bound`: what friction takes while it slips [m/s^2].
    """
    speed, down = np.hypot(*slip), np.hypot(*gravity)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(speed > 0.0, slip / speed, np.where(down > 0.0, gravity / down, 0.0))
        pull = (gravity * along).sum(axis=0)
        stop = np.where(speed > 0.0, np.where(bound > pull, speed / (bound - pull), np.inf), 0.0)
    first = np.minimum(elapsed, stop)
    later = elapsed - first
    # after the slip has ended it begins again downhill, if friction can't hold it
    again = np.sign(pull) * np.maximum(np.abs(pull) - bound, 0.0)
    now = np.where(elapsed < stop, speed + (pull - bound) * first, again * later)
    moved = speed * first + 0.5 * (pull - bound) * first**2 + 0.5 * again * later**2
    taken = np.where(elapsed < stop, bound, pull - again)
    return moved * along, now * along, taken * along


def _curved(slip: Floats, gravity: Floats, bound: float, elapsed: float) -> tuple[Floats, Floats, Floats]:
    """Return the same of one contact point whose slip turns, by integration until it has ended."""
    from scipy.integrate import solve_ivp  # what moves along one line does not load it

    least = _STOPPED * float(np.hypot(*slip))

    def rates(_: float, state: Floats) -> Floats:
        speed = max(float(np.hypot(state[2], state[3])), least)
        return np.concatenate([state[2:], gravity - bound * state[2:] / speed])

    def ended(_: float, state: Floats) -> float:
        return float(np.hypot(state[2], state[3])) - least

    ended.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(rates, (0.0, elapsed), np.concatenate([[0.0, 0.0], slip]), events=ended, method="DOP853", rtol=1e-11, atol=1e-14)
    moved, now = found.y[:2, -1], found.y[2:, -1]
    if found.t[-1] < elapsed:
        one = np.array([elapsed - found.t[-1]])
        rest = _straight(np.zeros((2, 1)), gravity[:, None], np.array([bound]), one)
        return moved + rest[0][:, 0], rest[1][:, 0], rest[2][:, 0]
    return moved, now, bound * now / max(float(np.hypot(*now)), least)


def edge_time(sphere: Sphere, start: State, coefficient: Array, pressing: Floats, elapsed: Floats, half: Floats) -> Floats:
    """Return the times at which spheres that lie on the plate leave it over an edge [s], at most `elapsed`.

    `half`: half the sides of the plate [m] (2, 1).
    """

    def beside(time: Floats) -> Bools:
        state, _ = slide_and_roll(sphere, start, coefficient, pressing, time)
        return np.asarray((np.abs(state.position) > half).any(axis=0))

    low, high = np.zeros(len(elapsed)), elapsed.copy()
    leaves = beside(high)
    for _ in range(60 if leaves.any() else 0):
        middle = 0.5 * (low + high)
        out = beside(middle)
        low, high = np.where(out, low, middle), np.where(out, middle, high)
    return np.where(leaves, high, elapsed)
