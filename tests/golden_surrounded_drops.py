"""Drops whose numbers are kept: oblique, with friction, in air and liquids, on shaken
plates, with instruments.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import vibroimpact as vi
from support import plain_case
from vibrating import STIFFNESS, drop_on, random_modes
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.fluids.air import Air
from vibroimpact.dynamics.fluids.liquid import Liquid
from vibroimpact.structures.modal_model import ModalBasis

Made = Callable[[], vi.Problem]

PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28, effective_shear_modulus=1.6e9)
LOSSY = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.65)
SMALL_PLATE = {
    "size": ["60 mm", "40 mm", "6 mm"],
    "material": "steel",
    "model": "elastic",
    "modes": 6,
    "damping": 0.02,
}
SLIDING: dict[str, Any] = {"velocity": (1.5, 0.0)}
SPINNING: dict[str, Any] = {"velocity": (0.3, -0.4), "spin": (20.0, -30.0, 15.0)}
ROLLING: dict[str, Any] = {"spin": (0.0, 50.0, 0.0)}
SLOPING: dict[str, Any] = {"velocity": (0.2, 0.0), "gravity": (3.0, 0.0)}


def surrounded_drops() -> dict[str, Made]:
    """Return drops by name, each as a function that makes it."""
    return {
        **_surface_friction_drops(),
        **_drops_under_all_laws(),
        **_drops_in_air(),
        **_drops_in_liquids(),
        **_shaken_drops(),
        **_watched_drops(),
    }


def friction_of(name: str, **parameters: float) -> vi.friction.FrictionLaw:
    """Return a friction law of the paper's pair, with a coefficient of 0.2 unless said
    otherwise.
    """
    return friction_laws()[name].for_pair(PAIR, **{"coefficient": 0.2, **parameters})


def _law(name: str) -> ContactLaw:
    return contact_laws()[name].example(PAIR)


def _oblique(friction: str | None, motion: dict[str, Any], **parameters: float) -> vi.Oblique:
    law = None if friction is None else friction_of(friction, **parameters)
    return vi.Oblique(friction=law, **motion)


def _drop(law: ContactLaw, plate: ModalBasis | None = None, **more: Any) -> vi.Problem:
    return drop_on(law, plate, **{"speed": 2.0, "impacts": 2, **more})


def _plate() -> ModalBasis:
    """Return modes whose contact point moves up and along the plate."""
    modes = random_modes(5, 10, 200.0, 2e4, 0.8, 0.02)
    along = 0.4 * np.random.default_rng(6).normal(size=(10, 2))
    return replace(modes, along=along)


def _surface_friction_drops() -> dict[str, Made]:
    damped = HuntCrossley(stiffness=STIFFNESS, restitution=0.3)
    resisted = _oblique("coulomb", SLIDING, rolling_coefficient=0.05)
    made: dict[str, Made] = {
        "oblique, no friction": lambda: _drop(LOSSY, oblique=_oblique(None, SPINNING))
    }
    for name, kind in friction_laws().items():
        made[f"sliding, {name}"] = lambda name=name: _drop(LOSSY, oblique=_oblique(name, SLIDING))
        made[f"spinning, {name}"] = lambda name=name: _drop(LOSSY, oblique=_oblique(name, SPINNING))
        made[f"sloping, {name}"] = lambda name=name: _drop(
            LOSSY, height=0.05, impacts=4, oblique=_oblique(name, SLOPING)
        )
        made[f"batch, {name}"] = lambda name=name: _drop(
            LOSSY, oblique=_oblique(name, {"velocity": (np.linspace(-1.0, 2.0, 6), 0.1)})
        )
        if issubclass(kind, CompliantFriction):
            made |= _surface_friction_drops_on_what_yields(name)
        else:
            # a tangential spring and rolling resistance together: rigid and yielding bodies do not
            # agree, so that nothing is kept of it
            made[f"rolling, {name}"] = lambda name=name: _drop(
                LOSSY, oblique=_oblique(name, ROLLING, rolling_coefficient=0.02)
            )
    return made | {
        "hollow ball": lambda: _drop(
            LOSSY,
            oblique=vi.Oblique(friction=friction_of("mdr"), inertia_ratio=2.0 / 3.0, **SPINNING),
        ),
        "off the edge": lambda: _drop(
            LOSSY,
            height=0.1,
            impacts=None,
            oblique=_oblique("coulomb", {**SLIDING, "size": (0.6, 0.4)}),
        ),
        "to rest on a slope": lambda: _drop(
            damped, height=0.05, impacts=None, duration=0.4, oblique=_oblique("coulomb", SLOPING)
        ),
        "rolling to rest": lambda: _drop(
            damped, height=0.03, impacts=None, duration=0.4, oblique=resisted
        ),
        "restitution by impulse": lambda: _drop(
            Newton(restitution=0.6), oblique=_oblique("coulomb", SPINNING)
        ),
        "without gravity, oblique": lambda: _drop(
            LOSSY, gravity=0.0, impacts=1, oblique=_oblique("mindlin", SLIDING)
        ),
    }


def _surface_friction_drops_on_what_yields(name: str) -> dict[str, Made]:
    soft = QuasiStatic(linear=2e-9)
    return {
        f"sliding on a plate, {name}": lambda: _drop(
            LOSSY, _plate(), oblique=_oblique(name, SLIDING)
        ),
        f"spinning on a plate, {name}": lambda: _drop(
            LOSSY, _plate(), impacts=1, oblique=_oblique(name, SPINNING)
        ),
        f"sloping in series, {name}": lambda: _drop(
            LOSSY, quasi_static=soft, oblique=_oblique(name, SLOPING)
        ),
    }


def _drops_under_all_laws() -> dict[str, Made]:
    shaking = vi.PlateMotion(amplitude=2e-4, frequency=60.0, phase=0.4)
    made: dict[str, Made] = {}
    for name, kind in contact_laws().items():
        friction = "mdr" if issubclass(kind, CompliantLaw) else "coulomb"
        made[f"oblique, {name}"] = lambda name=name, friction=friction: _drop(
            _law(name), oblique=_oblique(friction, SPINNING)
        )
        made[f"in air, {name}"] = lambda name=name: _drop(_law(name), height=0.5, air=Air())
        made[f"shaken, {name}"] = lambda name=name: _drop(_law(name), motion=shaking)
        if kind.example(PAIR).free_parameter == "restitution":
            made[f"in water, {name}"] = lambda name=name: _drop(_law(name), liquid=Liquid())
    return made


def _drops_in_air() -> dict[str, Made]:
    heights = np.geomspace(0.05, 20.0, 6)
    return {
        "air, a high fall": lambda: _drop(LOSSY, height=40.0, impacts=3, air=Air()),
        "air, drag coefficient": lambda: _drop(LOSSY, height=5.0, air=Air(drag_coefficient=0.47)),
        "air, to rest": lambda: _drop(
            HuntCrossley(stiffness=STIFFNESS, restitution=0.2), height=0.2, impacts=None, air=Air()
        ),
        "air, oblique": lambda: _drop(
            LOSSY, height=1.0, air=Air(), oblique=_oblique("coulomb", SPINNING)
        ),
        "air, sloping": lambda: _drop(
            LOSSY, height=0.3, air=Air(), oblique=_oblique("mdr", SLOPING)
        ),
        "air, a plate": lambda: _drop(LOSSY, _plate(), height=0.5, air=Air()),
        "air, batch": lambda: _drop(LOSSY, height=heights, air=Air()),
        "air, no gravity": lambda: _drop(
            LOSSY, gravity=0.0, impacts=1, duration=0.3, air=Air(density=5.0)
        ),
    }


def _drops_in_liquids() -> dict[str, Made]:
    oil = Liquid(density=920.0, viscosity=0.08)
    return {
        "oil": lambda: _drop(LOSSY, height=0.2, liquid=oil),
        "water, from a height": lambda: _drop(LOSSY, height=0.3, impacts=3, liquid=Liquid()),
        "water, oblique": lambda: _drop(
            LOSSY, height=0.1, liquid=Liquid(), oblique=_oblique("coulomb", SPINNING)
        ),
        "oil, sloping": lambda: _drop(
            LOSSY, height=0.1, liquid=oil, oblique=_oblique("mdr", SLOPING)
        ),
        "water, a plate": lambda: _drop(LOSSY, _plate(), liquid=Liquid()),
        "water, batch": lambda: _drop(LOSSY, speed=np.geomspace(0.05, 3.0, 6), liquid=Liquid()),
    }


def _shaken_drops() -> dict[str, Made]:
    table = vi.PlateMotion(amplitude=1e-3, frequency=30.0, phase=0.3)
    several = vi.PlateMotion(amplitude=[1e-3, 2e-4], frequency=[20.0, 45.0], phase=[0.0, 1.0])
    along = vi.PlateMotion(amplitude=1e-3, frequency=30.0, direction=(1.0, 0.0, 0.0))
    askew = vi.PlateMotion(amplitude=1e-3, frequency=30.0, direction=(0.6, 0.0, 0.8))
    gentle = replace(table, amplitude=1e-4)
    return {
        "shaken, from a height": lambda: _drop(LOSSY, height=0.1, impacts=4, motion=table),
        "shaken, several harmonics": lambda: _drop(
            LOSSY, height=0.1, impacts=None, duration=0.4, motion=several
        ),
        "shaken, it rides": lambda: _drop(
            Newton(restitution=0.3), height=0.04, impacts=None, duration=0.5, motion=gentle
        ),
        "shaken, restitution by impulse": lambda: _drop(
            Newton(restitution=0.5), height=0.1, impacts=5, motion=table
        ),
        "shaken along": lambda: _drop(LOSSY, motion=along, oblique=_oblique("mdr", SLIDING)),
        "shaken askew": lambda: _drop(LOSSY, motion=askew, oblique=_oblique("mindlin", SPINNING)),
        "shaken in air": lambda: _drop(LOSSY, height=0.3, motion=table, air=Air()),
        "shaken in water": lambda: _drop(LOSSY, height=0.1, motion=table, liquid=Liquid()),
        "shaken, sloping": lambda: _drop(
            LOSSY, height=0.06, motion=table, oblique=_oblique("mdr", SLOPING)
        ),
        "shaken, dents": lambda: _drop(_law("thornton"), speed=4.0, impacts=3, motion=table),
    }


def _watched_drops() -> dict[str, Made]:
    instruments: dict[str, dict[str, Any]] = {
        "accelerometer": {"quantity": "acceleration", "rate": "50 kHz"},
        "mounted accelerometer": {
            "rate": "50 kHz",
            "accelerometer": {"resonance": "30 kHz", "range": 2000.0},
        },
        "geophone": {
            "rate": "10 kHz",
            "geophone": {"natural_frequency": "10 Hz", "sensitivity": "27.6 V s/m"},
        },
        "strain gauge": {
            "instrument": "strain-gauge",
            "position": [0.012, 0.004],
            "direction": "y",
            "rate": "50 kHz",
        },
        "microphone": {"rate": "40 kHz", "microphone": {"distance": "30 cm"}},
        "force sensor": {"instrument": "force", "rate": "50 kHz", "position": [0.02, 0.015]},
    }
    made: dict[str, Made] = {}
    for name, keys in instruments.items():
        on_points = {"type": "patches", "spacing": ["40 mm", "30 mm"], "radius": "4 mm"}
        plate = {**SMALL_PLATE, "supports": on_points}
        sensor = {"name": "watching", "position": [0.01, 0.005], **keys}
        case = plain_case(
            plate=plate, sensors=[sensor], drop={"speed": 1.0}, run={"duration": 2e-3}
        )
        made[f"watched by: {name}"] = lambda case=case: vi.case_of(case).to_problem()
    return made


def all_systems() -> dict[str, tuple[Callable[[], vi.System], float]]:
    """Return systems of several bodies by name, each as a function that makes it and the
    duration of its run [s].
    """
    ball = {"mass": 0.1, "inertia": 2.5e-5}
    wall = vi.MovingBody(mass=np.inf)
    hertz = Hertz(stiffness=1e9)

    def collision(law: CompliantLaw, **contact: Any) -> vi.System:
        bodies = {"ball": vi.MovingBody(velocity=(0.0, 0.0, -1.0), **ball), "wall": wall}
        return vi.System(
            bodies=bodies,
            contacts={"at": vi.PointContact(above="ball", below="wall", law=law, **contact)},
        )

    def row(number: int, gap: float) -> vi.System:
        bodies = {
            f"{place}": vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, 0.0 if place else 1.0))
            for place in range(number)
        }
        contacts = {
            f"{place}-{place + 1}": vi.PointContact(
                below=f"{place}", above=f"{place + 1}", law=hertz, gap=gap
            )
            for place in range(number - 1)
        }
        return vi.System(bodies=bodies, contacts=contacts)

    def beam_between_stops() -> vi.System:
        shapes = {
            "upper": np.outer([1.0, -1.0], [0.0, 0.0, 1.0]),
            "lower": np.outer([1.0, 1.0], [0.0, 0.0, 1.0]),
        }
        modes = replace(random_modes(3, 2, 80.0, 900.0, 1.0, 0.01), points=shapes)
        beam = vi.MovingBody(mass=1.0, velocity=(0.0, 0.0, 0.5), modes=modes)
        contacts = {
            "upper": vi.PointContact(above="wall", below="beam", law=hertz, gap=1e-3),
            "lower": vi.PointContact(above="beam", below="wall", law=LOSSY, gap=1e-3),
        }
        return vi.System(bodies={"beam": beam, "wall": wall}, contacts=contacts)

    def askew() -> vi.System:
        bodies = {
            "ball": vi.MovingBody(velocity=(0.0, 0.0, -1.0), **ball),
            "rod": vi.MovingBody(mass=0.5, inertia=(1e-3, 1e-3, 1e-5)),
        }
        contact = vi.PointContact(
            above="ball", below="rod", law=LOSSY, point=(0.05, 0.0, 0.0), normal=(0.6, 0.0, 0.8)
        )
        return vi.System(bodies=bodies, contacts={"at": contact})

    return {
        "system: ball and wall": (lambda: collision(LOSSY), 2e-3),
        "system: in series": (lambda: collision(LOSSY, series=QuasiStatic(linear=1e-9)), 2e-3),
        "system: row of three": (lambda: row(3, 0.0), 1e-3),
        "system: row of six with gaps": (lambda: row(6, 1e-5), 1e-3),
        "system: beam between stops": (beam_between_stops, 0.02),
        "system: askew": (askew, 1e-3),
    }
