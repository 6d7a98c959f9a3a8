"""Several bodies with several contacts by scipy's DOP853, in the coordinates of each body: places, rotations, modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi


@dataclass(frozen=True)
class Moved:
    """Velocities of the centres and about them, at the end, by the names of the bodies."""

    velocity: dict[str, np.ndarray]
    angular_velocity: dict[str, np.ndarray]


def integrate(system: vi.System, duration: float, max_step: float = np.inf) -> Moved:
    """Integrate a system whose laws know no speed of first touch and remember nothing."""
    bodies, contacts = dict(system.bodies), list(system.contacts.items())
    counts = {name: 6 + (0 if body.modes is None else len(body.modes.frequencies)) for name, body in bodies.items()}
    ends = np.cumsum(list(counts.values()))
    places = {name: slice(end - counts[name], end) for name, end in zip(bodies, ends, strict=True)}
    number = int(ends[-1])

    def at_contact(name: str, contact: str, values: np.ndarray) -> np.ndarray:
        body, own = bodies[name], values[places[name]]
        moved = own[:3] + np.cross(own[3:6], system.contacts[contact].point - body.centre)
        return moved + (own[6:] @ body.modes.points[contact] if body.modes is not None else 0.0)

    def slopes(_: float, y: np.ndarray) -> np.ndarray:
        place, speed = y[:number], y[number:]
        pushed = {name: np.zeros(counts[name]) for name in bodies}
        for name, contact in contacts:
            gap = contact.gap + contact.normal @ (at_contact(contact.above, name, place) - at_contact(contact.below, name, place))
            rate = -contact.normal @ (at_contact(contact.above, name, speed) - at_contact(contact.below, name, speed))
            if gap >= 0.0:
                continue
            force = float(sum(contact.law.forces(-gap, rate, 1.0)))
            force = (force if contact.law.tension == "kept" else max(force, 0.0)) * contact.normal
            for of, sign in ((contact.above, 1.0), (contact.below, -1.0)):
                body, arm = bodies[of], contact.point - bodies[of].centre
                pushed[of][:3] += sign * force
                pushed[of][3:6] += sign * np.cross(arm, force)
                if body.modes is not None:
                    pushed[of][6:] += sign * (body.modes.points[name] @ force)
        rates = np.zeros(number)
        for name, body in bodies.items():
            own = places[name]
            if not body.held:
                rates[own][:3] = pushed[name][:3] / body.mass + system.gravity
                if body.inertia is not None:
                    rates[own][3:6] = np.linalg.solve(body.inertia, pushed[name][3:6])
            if body.modes is not None:
                omega, ratio = body.modes.angular_frequencies, body.modes.damping_ratios
                modal, slow = place[own][6:], speed[own][6:]
                rates[own][6:] = pushed[name][6:] - 2.0 * ratio * omega * slow - omega**2 * modal
        return np.concatenate([speed, rates])

    start = np.zeros(2 * number)
    for name, body in bodies.items():
        start[number:][places[name]][:3], start[number:][places[name]][3:6] = body.velocity, body.angular_velocity
    last = solve_ivp(slopes, (0.0, duration), start, "DOP853", rtol=1e-13, atol=1e-17, max_step=max_step).y[number:, -1]
    return Moved({name: last[places[name]][:3] for name in bodies}, {name: last[places[name]][3:6] for name in bodies})
