"""How much stiffer a plate is that deflects far, against von Karman's equations, by SciPy."""

from __future__ import annotations

import pytest

from agreement import Against, Agrees
from oracles.von_karman import stiffening as exact
from vibroimpact.cases.validity.deflection import LIMITS, stiffening

AGAINST = Against(
    "von Kármán equations of circular plates, numerical solution (SciPy)",
    "own independent computation",
    "plates, spheres and modes",
    "Timoshenko and Woinowsky-Krieger 1959, eq. 231; force at the centre; "
    "tests/oracles/von_karman.py",
)


@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("load", [0.1, 0.25, 0.5])
def test_stiffening_under_a_force_at_the_centre(
    agrees: Agrees, load: float, *, clamped: bool
) -> None:
    """Circular plates, edges sliding in their plane and held in it, from a tenth of the
    thickness to three quarters; within 12 %.
    """
    for place, held in enumerate((False, True)):
        ratio, part = exact(load, clamped=clamped, held=held)
        case = (
            f"{'clamped' if clamped else 'supported'} edge, in-plane "
            f"{'fixed' if held else 'free'}, error estimate of a run"
        )
        agrees(
            case,
            "relative increase of the stiffness",
            stiffening(ratio, clamped=clamped)[place],
            part,
            relative=0.12,
        )


def test_the_threshold_is_where_it_begins_to_matter() -> None:
    """At a fifth of the thickness a plate whose edges are held is 2 % (clamped) to 6 %
    (supported) stiffer.
    """
    (limit,) = LIMITS
    assert limit.threshold == 0.2
    for clamped, load, part in ((True, 0.2, 0.02), (False, 0.084, 0.055)):
        ratio, found = exact(load, clamped=clamped, held=True)
        assert ratio == pytest.approx(0.2, rel=0.02)
        assert found == pytest.approx(part, rel=0.15)
