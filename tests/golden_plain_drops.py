"""Drops whose numbers are kept: on rigid and elastic bodies, along the plate's normal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import vibroimpact as vi
from support import plain_case
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.registry import contact_laws

PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)
HERTZ, LOSSY = Hertz(stiffness=STIFFNESS), LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.65)
IMPACT = AdamsImpact(stiffness=STIFFNESS, damping_max=180.0, full_damping_penetration=1e-4)
SMALL = {
    "size": ["60 mm", "40 mm", "6 mm"],
    "material": "steel-paper",
    "model": "elastic",
    "modes": 6,
    "supports": "clamped",
    "damping": 0.02,
}


def _law_of(kind: type[ContactLaw]) -> ContactLaw:
    return kind.example(PAIR)


def _plate(seed: int = 1, number: int = 12) -> Any:
    return random_modes(seed, number, 100.0, 2e4, 1.2, 0.01)


def _sphere() -> Any:
    return random_modes(2, 6, 12e3, 60e3, 2.0, 0.02)


def _elastic(**changes: object) -> vi.Problem:
    return vi.case_of(
        plain_case(plate={**SMALL, "model": "elastic"}, run={"impacts": 2}, **changes)
    ).to_problem()


def plain_drops() -> dict[str, Callable[[], vi.Problem]]:
    found: dict[str, Callable[[], vi.Problem]] = {}
    for name in ("type1-theory", "type1-constant", "type1-variable", "full-damping-penetration"):
        found[name] = lambda name=name: vi.load_case(f"paper:{name}").to_problem()
    for name in (
        f"type{number}{kind}" for number in (2, 3) for kind in ("", "-superposed", "-identified")
    ):
        found[name] = lambda name=name: vi.load_case(f"paper:{name}").to_problem()
    for name, kind in contact_laws().items():
        found[f"rigid {name}"] = lambda kind=kind: drop_on(_law_of(kind), speed=2.0, impacts=3)
        if issubclass(kind, CompliantLaw):
            found[f"plate {name}"] = lambda kind=kind: drop_on(
                _law_of(kind), _plate(), speed=2.0, impacts=2
            )
    return found | {
        "sphere inside": lambda: drop_on(LOSSY, _plate(), _sphere(), impacts=3),
        "sphere outside": lambda: drop_on(
            LOSSY, _plate(), _sphere(), impacts=3, sphere_inside=False
        ),
        "sphere alone": lambda: drop_on(IMPACT, None, _sphere(), impacts=3),
        "local element": lambda: drop_on(LOSSY, _plate(), local_element=(1.2e6, 586.0), impacts=3),
        "local element alone": lambda: drop_on(IMPACT, local_element=(1.2e6, 586.0), impacts=3),
        "in series": lambda: drop_on(
            LOSSY, _plate(), quasi_static=QuasiStatic(linear=2e-9), impacts=3
        ),
        "in series, taken out": lambda: drop_on(
            HERTZ, _plate(), quasi_static=QuasiStatic(linear=-2e-10), impacts=2
        ),
        "in series, rigid": lambda: drop_on(
            JKR.example(PAIR), quasi_static=QuasiStatic(linear=1e-8), speed=0.3, impacts=2
        ),
        "consistent": lambda: _elastic(),
        "superposed": lambda: _elastic(contact__local_compliance="superposed"),
        "bricks": lambda: _elastic(plate__element="solid", plate__mesh={"element_size": "10 mm"}),
        "attachment mode": lambda: _elastic(plate__attachment_mode=True),
        "craig-bampton": lambda: _elastic(plate__reduction="craig-bampton"),
        "finite sphere": lambda: vi.case_of(plain_case(contact__finite_sphere=True)).to_problem(),
        "dent": lambda: drop_on(Thornton.example(PAIR), speed=5.0, impacts=4),
        "fresh dents": lambda: drop_on(
            Thornton.example(PAIR), speed=5.0, impacts=4, same_spot=False
        ),
        "dent on a plate": lambda: drop_on(
            WaltonBraun.example(PAIR), _plate(), speed=3.0, impacts=2
        ),
        "fresh dents on a plate": lambda: drop_on(
            Thornton.example(PAIR), _plate(), height=0.5, impacts=2, same_spot=False
        ),
        "sticking": lambda: drop_on(JKR.example(PAIR), speed=1e-3, impacts=None),
        "sticking to a plate": lambda: drop_on(
            JKR.example(PAIR), modes_of([400.0, 3e3], [0.8, 1.0], 0.05), speed=1e-3, impacts=None
        ),
        "capture": lambda: drop_on(
            HuntCrossley(stiffness=STIFFNESS, restitution=0.05), height=0.1, impacts=None
        ),
        "to rest": lambda: drop_on(
            LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.2), height=0.1, impacts=None
        ),
        "many contacts": lambda: replace(
            drop_on(
                LankaraniNikravesh(stiffness=1e10, restitution=0.2),
                modes_of([3.0], [2.0**-0.5]),
                height=1.18,
                impacts=1,
            ),
            sphere=vi.Body(mass=33.0, contact_offset=0.15),
        ),
        "micro-impacts": lambda: drop_on(
            HERTZ, modes_of([900.0, 5000.0], [3.0, 4.0], 0.001), height=0.1, impacts=3
        ),
        "kicked": lambda: drop_on(
            LOSSY, modes_of([30.0, 800.0], [2.5, 2.0], 1e-3), height=0.05, impacts=4
        ),
        "no gravity": lambda: drop_on(IMPACT, speed=2.0, gravity=0.0, impacts=1),
        "no gravity, plate": lambda: drop_on(HERTZ, _plate(), speed=2.0, gravity=0.0, impacts=1),
        "stiff plate": lambda: drop_on(
            IMPACT, modes_of([1e5, 3e5], [0.5, 0.5], 1.0), height=0.5, impacts=3
        ),
        "a duration": lambda: drop_on(IMPACT, height=0.2, impacts=None, duration=0.5),
        "batch of laws": lambda: drop_on(
            LankaraniNikravesh(stiffness=STIFFNESS, restitution=np.linspace(0.3, 0.95, 16)),
            height=0.5,
            impacts=3,
        ),
        "batch of speeds": lambda: drop_on(IMPACT, speed=np.geomspace(0.05, 12.0, 16), impacts=3),
        "batch of dents": lambda: drop_on(
            Thornton.example(PAIR), speed=np.geomspace(0.5, 12.0, 10), impacts=3
        ),
        "batch on a plate": lambda: drop_on(
            LOSSY, _plate(), height=np.geomspace(0.03, 1.0, 6), impacts=2
        ),
    }
