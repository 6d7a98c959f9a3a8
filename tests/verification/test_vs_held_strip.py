"""What plate elements add where a plate is held, against the elastic half strip of
tests/oracles/held_strip.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from agreement import Against, Agrees
from oracles.held_strip import rim_compliance
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.bed import bed_stiffness, end_compliance
from vibroimpact.structures.finite_elements.plate_element import shear_factor

AGAINST = Against(
    "elastic half strip supported at its edge, plane-strain finite elements",
    "own independent computation",
    "plates, spheres and modes",
    "tests/oracles/held_strip.py, with scikit-fem",
)


def rim_of_a_plate_on_a_bed(nu: float, along: float, across: float) -> np.ndarray:
    """The compliance of the rim of Mindlin's plate on springs under its lower face for x < 0; h and
    E / (1 - nu^2) are 1.

    The states u, w, beta, N, Q, M along x obey linear equations of first order; those that vanish
    at minus infinity remain.
    """
    shear = shear_factor(nu) * (1 - nu) / 2
    change = np.zeros((6, 6))
    change[0, 3], change[1, [4, 2]], change[2, 5] = 1.0, [1 / shear, -1.0], 12.0
    change[3, [0, 2]] = along, -along / 2
    change[4, 1] = across
    change[5, [4, 0, 2]] = 1.0, -along / 2, along / 4
    rates, states = np.linalg.eig(change)
    rising = states[:, np.argsort(-rates.real)[:3]]
    return np.real(rising[:3] @ np.linalg.inv(rising[3:]))


@pytest.mark.parametrize("nu", [0.05, 0.28, 0.45])
def test_a_straight_rim_gives_as_the_half_strip_does(agrees: Agrees, nu: float) -> None:
    """Turning under a moment and sinking under a transverse force within 0.3 %;
    stretching, which is not fitted, within 15 %.
    """
    expected = rim_compliance(nu, "lower")
    unit = Material(1.0, 1 - nu**2, nu)
    found = rim_of_a_plate_on_a_bed(nu, *bed_stiffness(unit, 1.0))
    case, (stretch, *others) = (
        "edge of a plate on an elastic foundation, Poisson's ratio 0.05 to 0.45",
        np.diag(expected),
    )
    agrees(case, "transverse and rotational compliance", np.diag(found)[1:], others, relative=3e-3)
    agrees(case, "in-plane compliance", found[0, 0], stretch, relative=0.15)
    rigid = rim_of_a_plate_on_a_bed(nu, 1e7, 1e7)  # without a bed
    assert rigid[2, 2] < 0.7 * expected[2, 2]


@pytest.mark.parametrize("nu", [0.1, 0.3, 0.45])
def test_a_held_end_is_stiffer_than_plate_theory(agrees: Agrees, nu: float) -> None:
    found, expected = (
        end_compliance(Material(1.0, 1 - nu**2, nu), 1.0),
        rim_compliance(nu, "end")[2, 2],
    )
    agrees(
        "clamped end, Poisson's ratio 0.1 to 0.45",
        "rotational compliance",
        found,
        expected,
        relative=0.03,
    )
