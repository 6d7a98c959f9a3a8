"""Drops on vibrating bodies against scipy's DOP853 at 1e-12 on the same modal equations:
oracles/modal_integration.py.

Contacts with a plate that kicks the ball again while it rises, second and third impacts on a plate
that rings, modes inside and outside the contact, compliance and a local element in series. Nothing
of the march, of its collocation or of its search for the next touch is shared.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.modal_integration import Touch
from vibrating import STIFFNESS, drop_on, modes_of, oracle, random_modes
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.structures.modal_model import ModalBasis

AGAINST = Against(
    "SciPy's DOP853, modal equations of motion",
    "own independent computation",
    "impacts on vibrating bodies",
    "tests/oracles/modal_integration.py, tolerance 1e-12",
)


HERTZ = Hertz(stiffness=STIFFNESS)
LOSSY = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.7)
ADAMS = AdamsImpact(stiffness=STIFFNESS, damping_max=179.75, full_damping_penetration=1e-4)
SOFT = modes_of([260.0, 2100.0], [2.5, 1.5])
RICH = random_modes(3, 10, 150.0, 15e3, 1.2, 0.01)
BALL = modes_of([13.4e3, 22e3, 30e3], [2.0, -3.0, 2.5], 0.02)
CRITICAL = modes_of([300.0, 4e3], [2.0, 2.0], [1.0, 1.4])


def grouped(touches: list[Touch], counts: np.ndarray) -> list[list[Touch]]:
    ends = np.cumsum(counts).astype(int)
    return [touches[end - int(count) : end] for end, count in zip(ends, counts, strict=True)]


def check(agrees: Agrees, case: str, response: vi.Response, tolerance: float) -> None:
    """Every impact, to a relative tolerance; times of touch to that part of a contact."""
    impacts = response.impacts
    visits = grouped(
        oracle(response.problem).run(int(impacts["contacts"].sum())), impacts["contacts"]
    )
    for number, visit in enumerate(visits):
        row, force = (
            {name: values[number] for name, values in impacts.items()},
            max(touch.max_force for touch in visit),
        )
        agrees(
            case,
            "time of first contact",
            row["time_s"],
            visit[0].begin,
            unit="s",
            absolute=tolerance * 3e-4,
        )
        agrees(
            case,
            "contact duration",
            row["duration_s"],
            visit[-1].end - visit[0].begin,
            unit="s",
            relative=tolerance,
        )
        agrees(
            case,
            "separation speed",
            row["separation_speed_m_s"],
            visit[-1].separation_speed,
            unit="m/s",
            relative=tolerance,
        )
        agrees(
            case, "maximum contact force", row["max_force_N"], force, unit="N", relative=tolerance
        )


@pytest.mark.parametrize(
    ("law", "plate", "sphere", "more"),
    [
        (HERTZ, RICH, None, {}),
        (LOSSY, RICH, None, {}),
        (ADAMS, RICH, None, {}),
        (HERTZ, CRITICAL, None, {}),
        (LOSSY, RICH, BALL, {"sphere_inside": False}),
        (LOSSY, RICH, BALL, {"sphere_inside": True}),
        (ADAMS, None, BALL, {"sphere_inside": True}),
        (LOSSY, RICH, None, {"quasi_static": QuasiStatic(linear=4e-9)}),
        (ADAMS, RICH, None, {"local_element": (1.2e6, 586.0)}),
        (LOSSY, None, BALL, {"local_element": (2e7, 900.0), "sphere_inside": False}),
    ],
)
def test_one_impact(
    agrees: Agrees,
    law: CompliantLaw,
    plate: ModalBasis | None,
    sphere: ModalBasis | None,
    more: dict[str, object],
) -> None:
    check(
        agrees,
        "one impact, three contact laws, elastic plate and sphere, local elements",
        vi.simulate(drop_on(law, plate, sphere, tolerance=1e-11, **more)),
        1e-8,
    )


def test_a_plate_that_kicks_the_ball_again(agrees: Agrees) -> None:
    """While it still rises from the first contact: two contacts of one impact, or more,
    as soft or hard.
    """
    response = vi.simulate(drop_on(HERTZ, SOFT, speed=1.0, tolerance=1e-11))
    assert response.impacts["contacts"][0] >= 2
    check(agrees, "repeated contacts within one impact", response, 1e-8)


@pytest.mark.parametrize("law", [HERTZ, LOSSY, ADAMS], ids=lambda law: law.name)
def test_later_impacts_on_a_plate_that_rings(agrees: Agrees, law: CompliantLaw) -> None:
    """Three impacts of a slow ball on a plate that swings by more than the ball falls in
    a period: no meeting is stepped over.
    """
    response = vi.simulate(
        drop_on(
            law, modes_of([180.0, 950.0], [1.8, -1.2], 0.002), speed=0.6, impacts=3, tolerance=1e-11
        )
    )
    assert len(response.impacts["impact"]) == 3
    check(agrees, "three impacts on a vibrating plate", response, 1e-7)


def test_a_mode_that_is_not_met() -> None:
    """A node line through the contact point: as if it were not there."""
    with_it, without = (
        vi.simulate(drop_on(HERTZ, plate))
        for plate in (modes_of([300.0, 800.0], [1.5, 0.0]), modes_of([300.0], [1.5]))
    )
    for name, column in without.impacts.items():
        # which is made with differences of the force
        relative = 1e-7 if name == "sensitivity" else 1e-12
        np.testing.assert_allclose(
            with_it.impacts[name], column, rtol=relative, atol=1e-12, err_msg=name
        )
