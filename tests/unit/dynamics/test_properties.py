"""Random valid cases: no exception, no NaN, energy never created, the ledger closes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import vibroimpact as vi
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS, LEDGER

MAY_BE_MISSING = {"restitution_asked"}


def log(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: float(10.0**exponent))


def ratio(low: float, high: float) -> st.SearchStrategy[float]:
    # 1e-129 is refused, as nobody means it
    return st.floats(low, high).map(lambda value: round(value, 9))


materials = st.fixed_dictionaries(
    {
        "density": log(100, 2e4),
        "youngs_modulus": log(1e5, 5e11),
        "poissons_ratio": ratio(-0.9, 0.499),
    }
)
restitutions = ratio(0.0, 1.0) | st.sampled_from([1e-50, 1e-20])
contacts = st.one_of(
    st.fixed_dictionaries({"law": st.just("hertz"), "exponent": st.floats(1.0, 3.0)}),
    st.fixed_dictionaries({"law": st.just("lankarani-nikravesh"), "restitution": restitutions}),
    st.fixed_dictionaries(
        {
            "law": st.just("adams-impact"),
            "damping_max": st.one_of(
                st.just(0.0), log(1e-6, 1e6), st.lists(log(1e-6, 1e6), min_size=1, max_size=4)
            ),
            "full_damping_penetration": log(1e-9, 1e-2),
        }
    ),
    st.fixed_dictionaries(
        {
            "law": st.just("linear-spring-dashpot"),
            "stiffness": log(10, 1e9),
            "restitution": log(1e-4, 1.0),
        }
    ),
    st.fixed_dictionaries(
        {
            "law": st.just("linear-spring-dashpot"),
            "stiffness": log(10, 1e9),
            "damping": log(1e-6, 1e6),
        }
    ),
    st.fixed_dictionaries({"law": st.just("newton"), "restitution": restitutions}),
)
asked = {"restitution": st.floats(0.02, 1.0)}
others = {
    "anagnostopoulos": {"stiffness": log(10, 1e9), **asked},
    "adams-poisson": {"penalty": log(10, 1e9), **asked},
    "walton-braun": {"stiffness": log(10, 1e9), "stiffening": log(1e-2, 1e6)},
    **dict.fromkeys(("flores", "zhiying-qishao", "tsuji", "jankowski"), asked),
    "kuwabara-kono": {"dissipation_time": log(1e-9, 1e-4)},
    "thornton": {"yield_pressure": log(1e3, 1e10), "loaded_to": st.sampled_from([0.0, 1e-6, 1e-4])},
    "storakers": {"yield_strength": log(1e3, 1e10), "hardening_exponent": st.floats(1.01, 100.0)},
    "jackson-green-marghitu": {
        "yield_strength": log(1e3, 1e10),
        "poissons_ratio": ratio(0.0, 0.49),
    },
    "jkr": {"work_of_adhesion": log(1e-4, 10.0)},
    "krijt": {"work_of_adhesion": log(1e-4, 10.0), "dissipation_time": log(1e-9, 1e-5)},
}
contacts |= st.one_of(
    *(st.fixed_dictionaries({"law": st.just(name), **given}) for name, given in others.items())
)
runs = st.one_of(
    st.fixed_dictionaries({"impacts": st.integers(1, 4)}),
    st.fixed_dictionaries({"impacts": st.just(4), "duration": log(1e-4, 10)}),
)


@st.composite
def cases(draw: st.DrawFn) -> dict:
    radius = draw(log(1e-4, 1.0))
    drop = draw(
        st.one_of(
            st.builds(lambda h: {"height": radius + h}, log(1e-6, 30)),
            st.builds(lambda v: {"speed": v}, log(1e-4, 100)),
        )
    )
    if "speed" in drop:
        drop["gravity"] = draw(st.sampled_from([0.0, 1.62, 9.81, 30.0]))
    return {
        "sphere": {"radius": radius, "material": draw(materials)},
        "plate": {"material": draw(st.one_of(st.just("rigid"), materials))},
        "drop": drop | {"same_spot": draw(st.booleans())},
        "contact": draw(contacts),
        "run": draw(runs),
    }


def case_of(
    radius: float, density: float, modulus: float, drop: dict, contact: dict, impacts: int = 1
) -> dict:
    material = {"density": density, "youngs_modulus": modulus, "poissons_ratio": 0.0}
    return {
        "sphere": {"radius": radius, "material": material},
        "plate": {"material": "rigid"},
        "drop": {"same_spot": True, **drop},
        "contact": contact,
        "run": {"impacts": impacts},
    }


STIFF_DASHPOT = {
    "law": "adams-impact",
    "damping_max": 7498.942093324558,
    "full_damping_penetration": 1e-6,
}
CREEPING_OUT = {"law": "adams-impact", "damping_max": 1000.0, "full_damping_penetration": 1e-5}
DENT = {"law": "thornton", "yield_pressure": 1000.0, "loaded_to": 1e-4}
STICKY = {"law": "jkr", "work_of_adhesion": 10.0}
SLOWLY = {"speed": 1e-4, "gravity": 0.0}


@given(cases())
@example(case_of(0.01778279410038923, 100.0, 5e4, {"height": 1.0177827941003892}, STIFF_DASHPOT))
@example(case_of(0.01, 1000.0, 1e5, {"speed": 1.0, "gravity": 0.0}, CREEPING_OUT))
@example(case_of(0.001, 100.0, 1e10, {"height": 1.001}, DENT, impacts=2))
@example(case_of(0.001, 100.0, 1e5, SLOWLY, STICKY))
@example(case_of(0.01, 100.0, 1e5, SLOWLY, STICKY))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_random_drops(case: dict) -> None:
    check(case)


@pytest.mark.slow
@given(cases())
@settings(max_examples=300, deadline=None, derandomize=True)
def test_many_random_drops(case: dict) -> None:
    check(case)


def check(case: dict) -> None:
    response = vi.simulate(vi.case_of(case))
    rigid = case["contact"]["law"] in ("newton", "jackson-green-marghitu")
    row = response.impacts
    for name in IMPACT_COLUMNS:
        missing = name in MAY_BE_MISSING or (
            rigid and ("force" in name or "indentation" in name or "acceleration" in name)
        )
        missing |= name == "rebound_height_m" and case["drop"].get("gravity") == 0.0
        assert missing or np.all(np.isfinite(row[name])), name
    assert np.all(row["restitution_achieved"] >= 0.0)
    # of a sphere put down softly, what gravity gives and takes again in the indentation outweighs
    # its speed
    weight = (
        case["drop"].get("gravity", 9.80665)
        * row["max_indentation_m"]
        / row["approach_speed_m_s"] ** 2
    )
    assert np.all(row["restitution_achieved"] <= 1.0 + 1e-9 * (1.0 + weight))
    assert np.all(row["energy_lost_J"] >= -1e-9 * response.energy["input_J"])
    assert response.energy["closure_relative"] <= 1e-8
    history = response.history()
    for name, values in history.items():
        assert np.all(np.isfinite(values)), name
    # what gravity and adhesion give in the indentation may be more than what was put in
    scale = max(
        response.energy["input_J"],
        *(np.abs(history[name]).max() for name in ("potential_J", "contact_elastic_J")),
    )
    total = sum(history[name] for name in LEDGER)
    np.testing.assert_allclose(total, response.energy["input_J"], atol=1e-5 * scale)
