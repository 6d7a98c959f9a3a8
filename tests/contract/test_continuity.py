"""What a drop has beside its contact law acts alike whatever solves it: rigid bodies, a plate that
hardly yields, and a batch.

Friction, rolling resistance, air, liquid, shaken plate and gravity in all combinations, each with
contact laws in turn. A rigid plate equals one with a spring of 1e18 N/m in series with the law, and
one with a mode of 1 THz; a batch equals its drops.
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

import vibroimpact as vi
from support import one_in
from vibrating import modes_of
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws

RADIUS, MASS, SPEED, HEIGHT = 0.01, 0.033, 2.0, 0.2
PAIR = ContactPair(2.4e9, RADIUS, MASS, 8e7, 0.28)
MODULI = {
    "effective_modulus": 1.8e10,
    "effective_shear_modulus": 1.4e10,
    "effective_radius": RADIUS,
}
LAWS = [
    name for name, kind in contact_laws().items() if isinstance(kind.example(PAIR), CompliantLaw)
]
IN_LIQUID = [name for name in LAWS if hasattr(contact_laws()[name].example(PAIR), "restitution")]
SOFTENED = (1e18, 1e6)  # N/m, N s/m


class Setting(NamedTuple):
    """What acts beside the contact law; `friction`: None for a drop along the normal,
    "none" for a smooth plate.
    """

    friction: str | None
    rolling: float
    around: str
    shaken: bool
    gravity: float
    law: str


def settings() -> list[Setting]:
    """Return all combinations, each with the next of the laws that it takes."""
    frictions = [(None, 0.0), ("none", 0.0)]
    frictions += [
        (name, rolling)
        for name in ("mdr", "mindlin", "mindlin-rescale", "mindlin-force")
        for rolling in (0.0, 0.02)
    ]
    every = itertools.product(frictions, ("vacuum", "air", "liquid"), (False, True), (0.0, 9.81))
    laws, laws_in_liquid = itertools.cycle(LAWS), itertools.cycle(IN_LIQUID)
    return [
        Setting(
            friction,
            rolling,
            around,
            shaken,
            gravity,
            next(laws_in_liquid if around == "liquid" else laws),
        )
        for (friction, rolling), around, shaken, gravity in every
    ]


def drop(setting: Setting, **changes: Any) -> vi.Problem:
    """Return the drop on a rigid plate."""
    oblique = None
    if setting.friction is not None:
        friction = None
        if setting.friction != "none":
            friction = vi.friction.find_friction_law(setting.friction)(
                coefficient=0.2, rolling_coefficient=setting.rolling, **MODULI
            )
        oblique = vi.Oblique(velocity=(0.4, 0.1), spin=(3.0, -20.0, 0.0), friction=friction)
    falls = {"height": HEIGHT} if setting.gravity else {"speed": SPEED}
    values: dict[str, Any] = {
        "laws": (contact_laws()[setting.law].example(PAIR),),
        "oblique": oblique,
        "air": vi.Air() if setting.around == "air" else None,
        "liquid": vi.Liquid() if setting.around == "liquid" else None,
        "motion": vi.PlateMotion(amplitude=2e-4, frequency=60.0) if setting.shaken else None,
        "gravity": setting.gravity,
        "impacts": 1 if not setting.gravity else 2,
        **falls,
        **changes,
    }
    return vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS), plate=vi.rigid_plate(), **values
    )


SCALES = {
    "time_s": None,
    "duration_s": None,
    "max_force_N": None,
    "max_indentation_m": None,
    "separation_speed_m_s": SPEED,
    "energy_lost_J": 0.5 * MASS * SPEED**2,
}
ALONG = {
    "separation_velocity_x_m_s": 0.4,
    "separation_velocity_y_m_s": 0.4,
    "spin_x_after_rad_s": 0.4 / RADIUS,
    "spin_y_after_rad_s": 0.4 / RADIUS,
    "friction_lost_J": 0.5 * MASS * 0.4**2,
}


def departure(one: dict[str, Any], other: dict[str, Any], scales: dict[str, float | None]) -> float:
    """Return the largest difference of the impacts of two drops, relative to the scales,
    by default the largest value.
    """
    largest = 0.0
    for name, scale in scales.items():
        if name in one:
            values = np.asarray(one[name], dtype=float)
            largest = max(
                largest,
                float(np.abs(values - other[name]).max() / (scale or np.abs(values).max() or 1.0)),
            )
    return largest


def stiff_plate(problem: vi.Problem) -> vi.Problem:
    """Return the drop on a plate with a mode of 1 THz, at the face that is hit."""
    mode = replace(modes_of(1e12, 1.0), along=np.zeros((1, 2)))
    return replace(problem, plate=replace(problem.plate, modes=mode))


SETTINGS = one_in(
    7, [(setting,) for setting in settings()], name=lambda setting: "-".join(map(str, setting))
)


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_rigid_plate_is_one_that_hardly_yields(setting: Setting) -> None:
    """Friction on bodies that yield is known less well: to 1e-4 of the velocity along the
    plate, to 3e-3 where rolling is resisted.
    """
    rigid = drop(setting)
    expected = vi.simulate(rigid).impacts
    normal, along = 1e-8, 1e-8
    if setting.friction not in (None, "none"):
        along = 3e-3 if setting.rolling else 1e-4
        # drag depends on the velocity along the plate as well
        normal = 1e-8 if setting.around == "vacuum" else 1e-3 * along
    for problem in (replace(rigid, local_element=SOFTENED), stiff_plate(rigid)):
        impacts = vi.simulate(problem).impacts
        assert departure(expected, impacts, SCALES) < normal
        assert departure(expected, impacts, ALONG) < along


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_batch_is_its_drops(setting: Setting) -> None:
    """The second drop of two is that drop alone."""
    alone = vi.simulate(drop(setting)).impacts
    falls = (
        {"height": np.array([0.5 * HEIGHT, HEIGHT])}
        if setting.gravity
        else {"speed": np.array([0.5 * SPEED, SPEED])}
    )
    together = {
        name: values[1] for name, values in vi.tabulate(drop(setting, **falls)).impacts.items()
    }
    assert departure(alone, together, SCALES) < 1e-9
    assert departure(alone, together, ALONG) < 1e-6
