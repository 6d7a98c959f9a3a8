"""Balls and plates at random, thin and thick, soft and hard, light and sprung; and those
said to rest, as an oracle takes them on.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

import vibroimpact as vi
from oracles.riding_integration import Ball
from oracles.simply_supported import simply_supported
from vibrating import modes_of, random_modes
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

LAWS = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
STEEL, ALUMINIUM, ACRYLIC = (7850.0, 210e9, 0.3), (2700.0, 70e9, 0.33), (1190.0, 3.2e9, 0.37)
ROCK, RUBBER = (2600.0, 40e9, 0.25), (1200.0, 20e6, 0.48)
ROWS = 4001


def random_drop(seed: int) -> vi.Problem:
    """Any of the laws; a plate of 0.8 to 20 mm, every third on springs of 2 to 20 Hz, of
    any damping; a ball of 2 to 60 mm radius.
    """
    random = np.random.default_rng([17, seed])

    def spread(low: float, high: float) -> float:
        return float(np.exp(random.uniform(math.log(low), math.log(high))))

    ball, plate = (
        (ROCK, STEEL, RUBBER)[random.integers(3)],
        (STEEL, ALUMINIUM, ACRYLIC)[random.integers(3)],
    )
    radius, size = spread(2e-3, 6e-2), (spread(0.15, 1.0), spread(0.15, 1.0), spread(0.8e-3, 2e-2))
    mass = 4.0 / 3.0 * math.pi * radius**3 * ball[0]
    place = (size[0] * random.uniform(0.2, 0.8), size[1] * random.uniform(0.2, 0.8))
    frequencies, contact = simply_supported(size, plate, place, int(random.integers(1, 13)))
    if seed % 3 == 0:
        whole = plate[0] * math.prod(size)
        frequencies, contact = (
            np.append(frequencies, spread(2.0, 20.0)),
            np.append(contact, whole**-0.5),
        )
    damping = (0.0, 0.001, 0.01, 0.1)[random.integers(4)]
    sphere = random_modes(seed, 3, 2e3, 1e4, 0.5 * mass**-0.5, 0.02) if seed % 7 == 3 else None
    return vi.Problem(
        sphere=vi.Body(mass=mass, contact_offset=radius, modes=sphere),
        plate=vi.Body(
            mass=np.inf, contact_offset=0.0, modes=modes_of(frequencies, contact, damping)
        ),
        laws=(_law(seed, ball, plate, radius),),
        height=radius + spread(2e-3, 0.5),
        gravity=9.81,
        impacts=(4, None, None)[random.integers(3)],
        duration=1.0,
        sphere_inside=False,
    )


def random_held_drop(seed: int) -> vi.Problem:
    """The same on a plate of elements, 60 to 160 mm long: on four patches, on one, on
    three points, on four pads on springs, or clamped.
    """
    random = np.random.default_rng([18, seed])
    size = [
        *random.uniform(0.06, 0.16, 2).round(3).tolist(),
        (0.001, 0.002, 0.005)[random.integers(3)],
    ]
    ball, plate = (
        (ROCK, STEEL, RUBBER)[random.integers(3)],
        (STEEL, ALUMINIUM, ACRYLIC)[random.integers(3)],
    )
    (at_x, at_y), across = (0.35 * size[0], 0.35 * size[1]), 0.08 * min(size[:2])
    corners = [(x, y) for x in (-at_x, at_x) for y in (-at_y, at_y)]
    supports = [
        {"type": "patches", "spacing": [2.0 * at_x, 2.0 * at_y], "radius": across},
        {"type": "patch", "position": [0.0, 0.0], "radius": 2.0 * across},
        [{"type": "point", "position": place, "directions": "xyz"} for place in corners[:3]],
        [
            {
                "type": "spring",
                "position": place,
                "stiffness": 2e3,
                "horizontal_stiffness": 2e3,
                "radius": across,
            }
            for place in corners
        ],
        "clamped",
    ][seed % 5]
    radius = float(np.exp(random.uniform(math.log(2e-3), math.log(3e-2))))
    case = {
        "sphere": {"radius": radius, "material": _material(ball)},
        "plate": {
            "size": size,
            "material": _material(plate),
            "model": "elastic",
            "modes": 12,
            "damping": (0.0, 0.001, 0.01, 0.1)[random.integers(4)],
            "supports": supports,
        },
        "drop": {
            "height": radius + random.uniform(0.002, 0.2),
            "position": [0.2 * size[0] * random.uniform(-1.0, 1.0), 0.15 * size[1]],
        },
        "contact": {
            "law": "hertz",
            "local_compliance": ("consistent", "superposed")[random.integers(2)],
        },
        "run": {"duration": 1.0},
    }
    return replace(vi.case_of(case).to_problem(), laws=(_law(seed, ball, plate, radius),))


def _material(of: tuple[float, float, float]) -> dict[str, float]:
    return dict(zip(("density", "youngs_modulus", "poissons_ratio"), of, strict=True))


def _law(
    seed: int, ball: tuple[float, float, float], plate: tuple[float, float, float], radius: float
) -> CompliantLaw:
    modulus = 1.0 / sum((1.0 - ratio**2) / stiffness for _, stiffness, ratio in (ball, plate))
    mass = 4.0 / 3.0 * math.pi * radius**3 * ball[0]
    return LAWS[seed % len(LAWS)].example(ContactPair(modulus, radius, mass, 1e-3 * modulus, 0.3))


def at_rest(response: vi.Response) -> Ball:
    """Where the integration left a ball that was found to be at rest, for the oracle; of
    the law it takes the static force alone.
    """
    lying, problem, contact = response.rest.lying[0], response.problem, response.bounces[-1].contact
    assert lying is not None
    assert contact is not None
    motion = contact.pieces[-1].motion
    assert isinstance(motion, VibratingStretch | FreePhase)
    state = (
        motion.end if isinstance(motion, VibratingStretch) else motion.free.state(motion.duration)
    )
    law, sag = lying.equilibrium.local.law, float(response.rest.sag[0])
    floor = float(law.release_level)
    delta = np.linspace(floor, floor + 6.0 * (sag - floor), ROWS)
    force = np.asarray(law.forces(delta, np.zeros_like(delta), np.ones_like(delta))[0])
    if problem.quasi_static:  # what is in series with it, at equal steps of the whole approach
        whole = delta + problem.quasi_static.indentation(force)
        delta, force = (
            np.linspace(whole[0], whole[-1], ROWS),
            np.interp(np.linspace(whole[0], whole[-1], ROWS), whole, force),
        )
    bodies = [
        (body.modes, sign)
        for body, sign in ((problem.sphere, -1.0), (problem.plate, 1.0))
        if body.modes is not None
    ]
    of = [
        (modes.angular_frequencies, modes.damping_ratios, sign * modes.contact)
        for modes, sign in bodies
    ]
    modal = (np.concatenate(parts) for parts in zip(*of, strict=True))
    place, speed = np.ravel(state.displacement), np.ravel(state.velocity)
    centre = (float(part[0]) * float(problem.sphere.mass) ** -0.5 for part in (place, speed))
    span = (float(delta[0]), float(delta[-1]))
    facts = (float(problem.sphere.mass), float(problem.gravity))
    return Ball(*facts, *modal, span, force, sag, *centre, place[1:], speed[1:])
