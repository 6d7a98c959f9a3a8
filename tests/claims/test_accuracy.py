"""What is said of accuracy and of the closure of the ledger, on every page with the same
numbers.
"""

from __future__ import annotations

import json

import numpy as np
import pytest

import vibroimpact as vi
from agreement import TOLD
from golden import PROBLEMS
from stated_numbers import says
from support import plain_case
from vibroimpact.cases.limits.limit import limits
from vibroimpact.cases.validity import modes_left_out
from vibroimpact.cases.validity.finite_sphere import force_lacking
from vibroimpact.dynamics.motion.energy import CLOSURE_LIMIT, CLOSURE_USUAL

README = "README.md"
INDEX = "docs/index.md"
TRUST = "docs/guides/how-far-to-trust-it.md"
VERIFICATION = "docs/verification.md"
HOW = "docs/how-it-works.md"

QUICK = [
    name for name in PROBLEMS if name.startswith(("type1", "full-damping", "rigid ", "plate "))
]
"""The shipped cases of rigid bodies, and a drop with each law on a rigid and on a
vibrating plate.
"""
ELASTIC = [name for name in PROBLEMS if name.startswith(("type2", "type3"))]


@pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in ELASTIC)]
)
def test_the_ledger_closes(name: str) -> None:
    problem = PROBLEMS[name]()
    assert problem.tolerance == 1e-9  # the default
    assert float(np.max(vi.simulate(problem).energy["closure_relative"])) < CLOSURE_USUAL


def test_what_is_said_of_closure() -> None:
    says(
        README,
        "In the shipped cases of single drops the energy balance closes to better than {} "
        "of the energy put in",
        CLOSURE_USUAL,
    )
    says(README, "a run in which it does not close to {} is an error", CLOSURE_LIMIT)
    says(
        TRUST,
        "closes to {}, or the run is an error; better than {} in the shipped cases of single drops",
        CLOSURE_LIMIT,
        CLOSURE_USUAL,
    )
    says(
        VERIFICATION,
        "A run whose energy balance does not close to {} of the energy put in",
        CLOSURE_LIMIT,
    )
    says(VERIFICATION, "it closes to better than {} at the default tolerance", CLOSURE_USUAL)
    says(HOW, "In the shipped cases of single drops it does to better than {} of it", CLOSURE_USUAL)
    says(HOW, "a run with a closure error above {} is an error", CLOSURE_LIMIT)


def tolerance(test: str, *, case: str = "", quantity: str = "") -> float:
    """Return the largest tolerance of the recorded comparisons of a test: of cases that
    begin with some words, and of a quantity.
    """
    rows = [json.loads(line) for line in TOLD.read_text(encoding="utf-8").splitlines()]
    asked = [
        row
        for row in rows
        if f"{row['file']}::{row['test']}" == test and row["quantity"] != "time of first contact"
    ]
    found = [
        row for row in asked if row["case"].startswith(case) and quantity in ("", row["quantity"])
    ]
    assert found, test
    assert all(
        row["measure"] == "relative" or row["quantity"] == "coefficient of restitution"
        for row in found
    ), found
    return float(max(row["tolerance"] for row in found))


def test_what_is_said_of_rigid_bodies() -> None:
    """The tolerances of the comparisons, which the tests of verification assert."""
    paper = tolerance("tests/published/test_paper_type1.py::test_every_column")
    says(
        README,
        "Type 1, of rigid bodies, agrees to {} with an independent integration of the "
        "paper's equations",
        paper,
    )
    says(TRUST, "times, speeds, restitution, indentation, force, rebound) | {} |", paper)
    says(TRUST, "tests this installation against a known rebound, to {}", paper)
    says(VERIFICATION, "with that of an independent integration, to {}", paper)
    hertz, damped = (
        "tests/verification/test_vs_hertz.py",
        "tests/verification/test_vs_damped_hertz.py",
    )
    closed = [
        tolerance(f"{hertz}::test_closed_form"),
        tolerance(f"{hertz}::test_closed_form_of_a_table"),
        tolerance(
            f"{damped}::test_the_printed_restitutions", quantity="coefficient of restitution"
        ),
        tolerance(
            f"{damped}::test_the_laws_without_a_printed_restitution",
            quantity="coefficient of restitution",
        ),
    ]
    says(
        README,
        "normal impacts agree to {} with the closed forms of Hertz's impact and of "
        "hysteretic damping",
        max(closed),
    )
    says(
        TRUST,
        "against the closed forms of Hertz's impact and of hysteretic damping | {} |",
        max(closed),
    )
    laws = tolerance("tests/verification/test_vs_scipy.py::test_restitution")
    says(TRUST, "restitution of every law with a force, against SciPy | {} |", laws)


def test_what_is_said_of_elastic_bodies_and_other_programs() -> None:
    modal = "tests/verification/test_vs_modal_integration.py"
    one = tolerance(f"{modal}::test_one_impact", case="one impact")
    three = tolerance(f"{modal}::test_later_impacts_on_a_plate_that_rings", case="three impacts")
    says(TRUST, "{} for one impact, {} for three", one, three)
    names = ("LAMMPS", "YADE", "EXUDYN")
    rows = [json.loads(line) for line in TOLD.read_text(encoding="utf-8").splitlines()]
    own = [
        row
        for row in rows
        if row["opponent"] in {f"{name}, simulation of exported drops" for name in names}
        and row["case"]
        in (
            "contact laws of the program",
            "16 contact laws exported to the program, 19 sets of parameters, three impacts",
        )
    ]
    assert {row["opponent"].split(",")[0] for row in own} == set(names)
    most = max(row["tolerance"] for row in own)
    says(TRUST, "and run there, with laws of these programs | {} |", most)
    says(
        INDEX,
        "speeds and rebounds of normal impacts agree to {} in LAMMPS and YADE where the "
        "contact law is one of their own",
        most,
    )


def test_what_is_said_of_hertz() -> None:
    modulus, ratio, radius = 2.26e9, 0.28, 0.025
    pair = modulus / (1.0 - ratio**2)
    lacking = float(
        force_lacking(4.0 / 3.0 * pair * radius**2 * 0.1**3, radius, pair, modulus, ratio)
    )
    says(TRUST, "contact radius below {} of the sphere's: {} % of the force", 0.1, 100.0 * lacking)
    # a/R and N: finite elements, as test_vs_finite_sphere.py computes them
    part, reference = 0.307, 67731.0
    mass = 4.0 / 3.0 * np.pi * radius**3 * 1380.0
    speed = (0.8 * 4.0 / 3.0 * pair * radius**0.5 * (part**2 * radius) ** 2.5 / mass) ** 0.5
    off = []
    for corrected in (False, True):
        bodies = {
            "sphere": {"radius": radius, "material": "rock-paper"},
            "plate": {"material": "rigid"},
        }
        contact = {"law": "hertz", "finite_sphere": corrected}
        case = plain_case(
            **bodies, drop={"speed": speed, "gravity": 0.0}, contact=contact, run={"impacts": 1}
        )
        off.append(
            100.0
            * (float(vi.simulate(vi.case_of(case)).impacts["max_force_N"][0]) / reference - 1.0)
        )
    says(TRUST, "the force is {} % too small at {}, and {} % too large with", -off[0], part, off[1])


def test_what_is_said_of_other_assumptions() -> None:
    threshold = {name: limit.threshold for name, limit in limits().items()}
    says(TRUST, "an error of the force below {} %", 100.0 * threshold["plate_waves"])
    says(TRUST, "deflection below {} of the thickness", threshold["plate_deflection"])
    says(TRUST, "loss of speed below {} %", 100.0 * threshold["air_drag"])
    says(
        TRUST,
        "above {} %, or below one and a half periods, it gives a warning",
        100.0 * modes_left_out._TRUNCATED,
    )
    assert modes_left_out._CYCLES == 1.5
    assert modes_left_out._ENOUGH == 3.0


def test_what_is_said_of_a_wrong_modulus() -> None:
    found = []
    for modulus in (5e10, 6e10):
        sphere = {
            "radius": 0.02,
            "material": {"density": 2600, "youngs_modulus": modulus, "poissons_ratio": 0.25},
        }
        case = plain_case(
            sphere=sphere,
            plate={"material": "rigid"},
            drop={"speed": 1.0, "gravity": 0.0},
            contact={"law": "hertz"},
            run={"impacts": 1},
        )
        impacts = vi.simulate(vi.case_of(case)).impacts
        found.append([float(impacts[name][0]) for name in ("max_force_N", "duration_s")])
    force, time = 100.0 * (np.divide(*reversed(found)) - 1.0)
    says(
        TRUST,
        "an effective modulus {} % too large makes the force {} % too large, and the "
        "contact time {} % too short",
        20.0,
        force,
        -time,
    )
