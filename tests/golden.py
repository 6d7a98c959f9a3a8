"""Golden numbers: impacts, ledgers and sampled histories of drops of every kind, kept in a file, and compared with those computed now.

All are computed to a tolerance of 1e-12, so that two ways of solving the same equations give the same numbers. To keep new ones, once it
is understood why they are others, run this file with the names of the drops; without a name it keeps all.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
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

Floats = np.ndarray
KEPT = Path(__file__).with_name("golden.npz")
TOLERANCE = 1e-12
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
    return vi.read_case(plain_case(plate={**SMALL, "model": "elastic"}, run={"impacts": 2}, **changes)).to_problem()


def _problems() -> dict[str, Callable[[], vi.Problem]]:
    found: dict[str, Callable[[], vi.Problem]] = {}
    for name in ("type1-theory", "type1-constant", "type1-variable", "full-damping-penetration"):
        found[name] = lambda name=name: vi.load_case(f"paper:{name}").to_problem()
    for name in (f"type{number}{kind}" for number in (2, 3) for kind in ("", "-superposed", "-identified")):
        found[name] = lambda name=name: vi.load_case(f"paper:{name}").to_problem()
    for name, kind in contact_laws().items():
        found[f"rigid {name}"] = lambda kind=kind: drop_on(_law_of(kind), speed=2.0, impacts=3)
        if issubclass(kind, CompliantLaw):
            found[f"plate {name}"] = lambda kind=kind: drop_on(_law_of(kind), _plate(), speed=2.0, impacts=2)
    return found | {
        "sphere inside": lambda: drop_on(LOSSY, _plate(), _sphere(), impacts=3),
        "sphere outside": lambda: drop_on(LOSSY, _plate(), _sphere(), impacts=3, sphere_inside=False),
        "sphere alone": lambda: drop_on(IMPACT, None, _sphere(), impacts=3),
        "local element": lambda: drop_on(LOSSY, _plate(), local_element=(1.2e6, 586.0), impacts=3),
        "local element alone": lambda: drop_on(IMPACT, local_element=(1.2e6, 586.0), impacts=3),
        "in series": lambda: drop_on(LOSSY, _plate(), quasi_static=QuasiStatic(linear=2e-9), impacts=3),
        "in series, taken out": lambda: drop_on(HERTZ, _plate(), quasi_static=QuasiStatic(linear=-2e-10), impacts=2),
        "in series, rigid": lambda: drop_on(JKR.example(PAIR), quasi_static=QuasiStatic(linear=1e-8), speed=0.3, impacts=2),
        "consistent": lambda: _elastic(),
        "superposed": lambda: _elastic(contact__local_compliance="superposed"),
        "bricks": lambda: _elastic(plate__element="solid", plate__mesh={"element_size": "10 mm"}),
        "attachment mode": lambda: _elastic(plate__attachment_mode=True),
        "craig-bampton": lambda: _elastic(plate__reduction="craig-bampton"),
        "finite sphere": lambda: vi.read_case(plain_case(contact__finite_sphere=True)).to_problem(),
        "dent": lambda: drop_on(Thornton.example(PAIR), speed=5.0, impacts=4),
        "fresh dents": lambda: drop_on(Thornton.example(PAIR), speed=5.0, impacts=4, same_spot=False),
        "dent on a plate": lambda: drop_on(WaltonBraun.example(PAIR), _plate(), speed=3.0, impacts=2),
        "fresh dents on a plate": lambda: drop_on(Thornton.example(PAIR), _plate(), height=0.5, impacts=2, same_spot=False),
        "sticking": lambda: drop_on(JKR.example(PAIR), speed=1e-3, impacts=None),
        "sticking to a plate": lambda: drop_on(JKR.example(PAIR), modes_of([400.0, 3e3], [0.8, 1.0], 0.05), speed=1e-3, impacts=None),
        "capture": lambda: drop_on(HuntCrossley(stiffness=STIFFNESS, restitution=0.05), height=0.1, impacts=None),
        "to rest": lambda: drop_on(LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.2), height=0.1, impacts=None),
        "many contacts": lambda: replace(
            drop_on(LankaraniNikravesh(stiffness=1e10, restitution=0.2), modes_of([3.0], [2.0**-0.5]), height=1.18, impacts=1),
            sphere=vi.Body(mass=33.0, contact_offset=0.15),
        ),
        "micro-impacts": lambda: drop_on(HERTZ, modes_of([900.0, 5000.0], [3.0, 4.0], 0.001), height=0.1, impacts=3),
        "kicked": lambda: drop_on(LOSSY, modes_of([30.0, 800.0], [2.5, 2.0], 1e-3), height=0.05, impacts=4),
        "no gravity": lambda: drop_on(IMPACT, speed=2.0, gravity=0.0, impacts=1),
        "no gravity, plate": lambda: drop_on(HERTZ, _plate(), speed=2.0, gravity=0.0, impacts=1),
        "stiff plate": lambda: drop_on(IMPACT, modes_of([1e5, 3e5], [0.5, 0.5], 1.0), height=0.5, impacts=3),
        "a duration": lambda: drop_on(IMPACT, height=0.2, impacts=None, duration=0.5),
        "batch of laws": lambda: drop_on(
            LankaraniNikravesh(stiffness=STIFFNESS, restitution=np.linspace(0.3, 0.95, 16)), height=0.5, impacts=3
        ),
        "batch of speeds": lambda: drop_on(IMPACT, speed=np.geomspace(0.05, 12.0, 16), impacts=3),
        "batch of dents": lambda: drop_on(Thornton.example(PAIR), speed=np.geomspace(0.5, 12.0, 10), impacts=3),
        "batch on a plate": lambda: drop_on(LOSSY, _plate(), height=np.geomspace(0.03, 1.0, 6), impacts=2),
    }


PROBLEMS = _problems()


def numbers(name: str, times: Floats | None = None) -> dict[str, Floats]:
    """Return the numbers of a drop by name; its history at times [s], which are chosen unless they are given."""
    problem = replace(PROBLEMS[name](), tolerance=TOLERANCE)
    response = vi.simulate(problem)
    found = {f"impacts/{key}": np.asarray(value) for key, value in response.impacts.items()}
    found |= {f"energy/{key}": np.asarray(value) for key, value in response.energy.items()}
    found["outcomes"] = np.array([outcome.code for outcome in response.outcomes])
    if problem.shape == ():
        times = _moments(response) if times is None else times
        return found | {f"history/{key}": np.asarray(value) for key, value in response.at(times).items()}
    table = vi.tabulate(problem)
    return found | {f"table/{key}": np.asarray(value) for key, value in table.impacts.items()}


def _moments(response: vi.Response) -> Floats:
    """Return times over the whole run, and in its first contacts, away from their ends."""
    begun, length = response.impacts["time_s"], response.impacts["duration_s"]
    inside = [first + across * np.linspace(0.04, 0.96, 15) for first, across in zip(begun[:2], length[:2], strict=True)]
    return np.sort(np.concatenate([*inside, (begun[-1] + length[-1]) * (np.arange(25) + 0.37) / 25.0]))


def kept(name: str) -> dict[str, Floats]:
    """Return the numbers of a drop that are kept."""
    with np.load(KEPT) as file:
        values, shapes = file[name], json.loads(str(file[f"shapes of {name}"]))
    ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
    return {key: part.reshape(shape) for (key, shape), part in zip(shapes.items(), np.split(values, ends[:-1]), strict=True)}


def departures(name: str) -> dict[str, float]:
    """Return by how many times what is allowed each number of a drop departs from what is kept."""
    before = kept(name)
    now = numbers(name, before.get("history/time_s"))
    assert now.keys() == before.keys(), sorted(now.keys() ^ before.keys())
    growth = max(1.0, float(np.nanmax(before.get("impacts/sensitivity", 1.0))))
    found = {}
    for key, old in before.items():
        assert now[key].shape == old.shape, key
        assert np.array_equal(np.isnan(now[key]), np.isnan(old)), key
        off = float(np.nan_to_num(np.abs(now[key] - old)).max(initial=0.0))
        found[key] = off / ((_scale(key, before) or 1.0) * _allowance(key) * growth)
    return found


def _scale(key: str, numbers: Mapping[str, Floats]) -> float:
    """Return the size of a column: of energies that of what was put in."""
    if key.endswith("closure_relative"):
        return 1.0
    if key.endswith("_J"):
        return float(np.max(numbers["energy/input_J"]))
    return float(np.nanmax(np.abs(numbers[key]), initial=0.0))


def _allowance(key: str) -> float:
    """Return how far a column may be off, as a part of its size, times the growth of what the drops differ in.

    About 1e-10, where the mathematics is the same; more where the number is known less well.
    """
    if key.endswith("sensitivity"):
        return 1e-4  # of differences
    if "time_of_max" in key:
        return 1e-6  # of a flat top
    if "max_" in key:
        return 1e-7  # read between the nodes of a stretch
    if key.startswith("history/"):  # likewise; the error of the ends goes with the square of that between them
        if "plate_acceleration" in key:
            return 1e-2  # of modes that follow the force, its second derivative
        return 1e-4 if "plate_" in key else 1e-5 if "acceleration" in key or "force" in key else 1e-8
    return 2e-10  # 1e-10 in each of two


def keep(names: list[str]) -> None:
    """Compute the numbers of some drops, or of all, and keep them: of each a row of numbers, and the shapes of its columns."""
    found = {}
    for name in PROBLEMS:
        columns = numbers(name) if name in names or not names else kept(name)
        found[name] = np.concatenate([np.ravel(values).astype(float) for values in columns.values()])
        found[f"shapes of {name}"] = np.array(json.dumps({key: np.shape(values) for key, values in columns.items()}))
    np.savez_compressed(KEPT, **found)


if __name__ == "__main__":
    keep(sys.argv[1:])
