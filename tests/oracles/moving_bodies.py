"""Several bodies with several contacts by scipy's DOP853, in the coordinates of each
body: places, rotations, modes.
"""

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
    bodies, contacts = system.bodies, list(system.contacts.values())
    counts = {
        name: 6 + (0 if body.modes is None else len(body.modes.frequencies))
        for name, body in bodies.items()
    }
    ends = np.cumsum(list(counts.values()))
    places = {name: slice(end - counts[name], end) for name, end in zip(bodies, ends, strict=True)}
    number = int(ends[-1])

    mobility, weight, viscous, elastic = (
        np.zeros((number, number)),
        np.zeros(number),
        np.zeros(number),
        np.zeros(number),
    )
    start = np.zeros(2 * number)
    for name, body in bodies.items():
        own = places[name]
        start[number:][own][:3], start[number:][own][3:6] = body.velocity, body.angular_velocity
        if not body.held:
            mobility[own, own][:3, :3], weight[own][:3] = np.eye(3) / body.mass, system.gravity
            if body.inertia is not None:
                mobility[own, own][3:6, 3:6] = np.linalg.inv(body.inertia)
        if body.modes is not None:
            omega, ratio = body.modes.angular_frequencies, body.modes.damping_ratios
            mobility[own, own][6:, 6:], viscous[own][6:], elastic[own][6:] = (
                np.eye(len(omega)),
                2.0 * ratio * omega,
                omega**2,
            )

    opening = np.zeros((len(contacts), number))  # of each contact's gap, by each coordinate
    for row, (name, contact) in zip(opening, system.contacts.items(), strict=True):
        for of, sign in ((contact.above, 1.0), (contact.below, -1.0)):
            body, own = bodies[of], row[places[of]]
            own[:3], own[3:6] = (
                sign * contact.normal,
                sign * np.cross(contact.point - body.centre, contact.normal),
            )
            if body.modes is not None:
                own[6:] = sign * (body.modes.points[name] @ contact.normal)
    gaps = np.array([contact.gap for contact in contacts])

    def force(contact: vi.PointContact, depth: float, rate: float) -> float:
        if depth <= 0.0:
            return 0.0
        push = float(sum(contact.law.forces(depth, rate, 1.0)))
        return push if contact.law.tension == "kept" else max(push, 0.0)

    def slopes(_: float, y: np.ndarray) -> np.ndarray:
        place, speed = y[:number], y[number:]
        depths, rates = -(gaps + opening @ place), -(opening @ speed)
        pushes = np.array([force(*at) for at in zip(contacts, depths, rates, strict=True)])
        return np.concatenate(
            [speed, weight + mobility @ (pushes @ opening) - viscous * speed - elastic * place]
        )

    last = solve_ivp(
        slopes, (0.0, duration), start, "DOP853", rtol=1e-13, atol=1e-17, max_step=max_step
    ).y[number:, -1]
    return Moved(
        {name: last[places[name]][:3] for name in bodies},
        {name: last[places[name]][3:6] for name in bodies},
    )
