"""The rigid limit: modes that are stiffened give what the solver of rigid bodies gives, which
shares nothing of the march with modes.

Force, duration, restitution and rebound within 1e-6 for modes a million times stiffer, and an error
that falls with the compliance that is left: with the square of the frequency. Stiff modes do not
slow the march down.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

AGAINST = Against(
    "rigid-body solver of this package",
    "consistency",
    "impacts on vibrating bodies",
    "limit of modes a million times stiffer; another solver of this package, no external reference",
)


LAWS: list[ContactLaw] = [
    Hertz(stiffness=STIFFNESS),
    AdamsImpact(stiffness=STIFFNESS, damping_max=179.75, full_damping_penetration=1e-4),
    LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.65),
]
OTHERS: list[ContactLaw] = [
    KuwabaraKono(stiffness=STIFFNESS, dissipation_time=1e-5),
    Thornton(effective_modulus=2.4264724e9, effective_radius=0.025, yield_pressure=1e8),
]
COLUMNS = (
    "max_force_N",
    "duration_s",
    "restitution_achieved",
    "rebound_height_m",
    "max_indentation_m",
    "separation_speed_m_s",
)
PLATE, SPHERE = random_modes(1, 12, 150.0, 2e4, 1.0), random_modes(2, 6, 12e3, 40e3, 3.0)
SPEED = 8.826664149


def misses(
    law: ContactLaw, factor: float, damping: float, inside: bool
) -> tuple[float, vi.Response]:
    """How far the stiffened bodies are off in any column of three impacts, relative."""
    plate, sphere = (
        modes_of(factor * body.frequencies, body.contact, damping) for body in (PLATE, SPHERE)
    )
    found = vi.simulate(drop_on(law, plate, sphere, speed=SPEED, impacts=3, sphere_inside=inside))
    rigid = vi.simulate(drop_on(law, speed=SPEED, impacts=3))
    assert len(found.impacts["impact"]) == len(rigid.impacts["impact"]) == 3
    return max(
        float(np.abs(found.impacts[name] / rigid.impacts[name] - 1.0).max()) for name in COLUMNS
    ), found


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("damping", [0.0, 1.0])
@pytest.mark.parametrize("law", [*LAWS, *OTHERS], ids=lambda law: law.name)
def test_stiff_bodies_are_rigid(
    agrees: Agrees, law: ContactLaw, damping: float, inside: bool
) -> None:
    error, response = misses(law, 1e6, damping, inside)
    agrees(
        "five contact laws, three impacts, both bodies stiffened",
        "maximum relative difference of six impact quantities",
        error,
        0.0,
        absolute=1e-10,
    )
    assert np.all(response.impacts["contacts"] == 1)
    assert response.energy["closure_relative"] < 1e-9


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_the_error_is_the_compliance_that_is_left(agrees: Agrees, law: ContactLaw) -> None:
    errors = [misses(law, factor, 1.0, True)[0] for factor in (1e3, 1e4)]
    assert errors[0] < 1e-5
    agrees(
        "natural frequencies ten times higher",
        "ratio of the errors (second order: 100)",
        errors[0] / errors[1],
        100.0,
        relative=0.15,
    )


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_stiff_modes_cost_nothing(law: ContactLaw) -> None:
    """As many stretches of contact as one soft mode takes, however stiff, damped or not."""
    counts = []
    for factor, damping in ((1e2, 1.0), (1e4, 0.0), (1e4, 1.0), (1e6, 0.0), (1e6, 1.0)):
        response = misses(law, factor, damping, True)[1]
        pieces = [
            piece.motion
            for bounce in response.bounces
            if bounce.contact
            for piece in bounce.contact.pieces
        ]
        counts.append(sum(isinstance(motion, VibratingStretch) for motion in pieces))
    assert max(counts) <= 1.5 * min(counts)
