"""The indentation of a contact law in series with a compliance, as the compiled core finds it."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.core.law import law_indentation
from vibroimpact.dynamics.vibrating.local import LocalContact

STEEL_ON_ALUMINIUM = Thornton(
    effective_modulus=5.77e10, effective_radius=0.01, yield_pressure=3.76e8
)


@pytest.mark.parametrize("share", np.linspace(0.02, 0.98, 13))
def test_unloading_is_not_mistaken_for_loading(share: float) -> None:
    """Newton's method went to and fro between zero force and loading beyond the deepest
    indentation, and found neither.
    """
    contact = LocalContact(STEEL_ON_ALUMINIUM, QuasiStatic(linear=2.37e-8), 2.0).after_indentation(
        8.09e-5
    )
    delta = contact.release_indentation + share * (8.09e-5 - contact.release_indentation)
    approach = float(contact.approach_at(np.asarray(delta)))
    assert law_indentation(contact.with_levels, approach) == pytest.approx(delta, rel=1e-8)


def test_a_ball_that_yields_rubs_on_a_plate() -> None:
    """Friction asks for short stretches, which begin anywhere in the unloading."""
    case = {
        "sphere": {"radius": "10 mm", "material": "steel"},
        "plate": {
            "size": ["300 mm", "300 mm", "6 mm"],
            "material": "aluminium",
            "model": "elastic",
            "supports": "simply-supported",
            "modes": 12,
        },
        "drop": {"velocity": [1.0, 0.2, -2.0]},
        "contact": {"law": "thornton", "friction": {"law": "mdr", "coefficient": 0.2}},
        "run": {"impacts": 1},
    }
    sliding = vi.simulate(vi.case_of(case)).impacts["separation_speed_m_s"]
    del case["contact"]["friction"]
    assert sliding == pytest.approx(
        vi.simulate(vi.case_of(case)).impacts["separation_speed_m_s"], rel=1e-8
    )
