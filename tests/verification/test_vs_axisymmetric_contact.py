"""The elastic sphere on a rigid plane: the treatments against full finite-element contact.

The reference is 12166 N, 246.45 us and a restitution of 0.99906 at 8.826664 m/s (two independent
codes, undamped, small strain, frictionless), and oracles/axisymmetric_contact.py, which comes to
the same and does the static contact as well.

`consistent` is within 0.7 % in force and time, whatever the modes and the mesh. `superposed` counts
the local indentation twice: the more modes, the softer; with the static deformation of the point of
contact among them, as an attachment mode or by Craig and Bampton, the finer the mesh, the
softer."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.axisymmetric_contact import impact, static_approach
from support import plain_case
from vibroimpact.dynamics.vibrating.local import LocalContact

AGAINST = Against(
    "finite-element contact analysis of an elastic sphere",
    "own independent computation",
    "impacts on vibrating bodies",
    "two independent programs, tests/oracles/axisymmetric_contact.py; undamped, small "
    "strain, frictionless",
)


FORCE, DURATION, RESTITUTION, SPEED = 12166.0, 246.45e-6, 0.99906, 8.826664
RADIUS, DENSITY, MODULUS, RATIO = 0.025, 1380.0, 2.26e9, 0.28


@cache
def problem(
    treatment: str, modes: int, across: int = 8, grading: float = 1.0, attachment: bool = False
) -> vi.Problem:
    sphere = {
        "radius": RADIUS,
        "material": "rock-paper",
        "model": "elastic",
        "modes": modes,
        "attachment_mode": attachment,
    }
    sphere["mesh"] = {"elements_across": across, "grading": grading}
    case = plain_case(
        plate={"material": "rigid"}, drop={"speed": SPEED, "gravity": 9.8}, run={"impacts": 1}
    )
    return vi.case_of(
        {**case, "sphere": sphere, "contact": {"law": "hertz", "local_compliance": treatment}}
    ).to_problem()


def impact_of(problem: vi.Problem) -> tuple[float, float, float]:
    """Force [N], duration [s] and restitution."""
    impacts = vi.simulate(problem).impacts
    return tuple(
        float(impacts[name][0]) for name in ("max_force_N", "duration_s", "restitution_achieved")
    )  # type: ignore[return-value]


def check_consistent(
    agrees: Agrees,
    modes: int,
    across: int,
    grading: float = 1.0,
    attachment: bool = False,
    *,
    tried: str = "10 to 150 modes, several meshes",
) -> None:
    force, duration, restitution = impact_of(
        problem("consistent", modes, across, grading, attachment)
    )
    case = f"impact, local compliance `consistent`, {tried}"
    agrees(case, "maximum contact force", force, FORCE, unit="N", relative=0.01)
    agrees(case, "contact duration", duration, DURATION, unit="s", relative=0.01)
    agrees(case, "coefficient of restitution", restitution, RESTITUTION, absolute=8e-4)


@pytest.mark.parametrize("modes", [10, 60])
def test_consistent(agrees: Agrees, modes: int) -> None:
    check_consistent(agrees, modes, 8, tried="10 and 60 modes")
    # and how much is left as vibration, 0.19 %, within a factor of two
    response = vi.simulate(problem("consistent", modes))
    assert (
        0.5
        < response.impacts["energy_to_vibration_J"][0] / response.energy["input_J"] / 0.0019
        < 2.0
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("modes", "across", "grading"),
    [
        (150, 8, 1.0),
        (20, 12, 1.0),
        (20, 8, 4.0),
        *(
            pytest.param(*case, marks=pytest.mark.whole)
            for case in ((20, 8, 1.0), (40, 8, 1.0), (100, 8, 1.0), (10, 12, 1.0), (60, 12, 1.0))
        ),
    ],
)
def test_consistent_whatever_the_modes_and_the_mesh(
    agrees: Agrees, modes: int, across: int, grading: float
) -> None:
    check_consistent(agrees, modes, across, grading)


@pytest.mark.slow
def test_consistent_against_the_oracle(agrees: Agrees) -> None:
    """The whole history of the force: within 1.5 % of its peak wherever it is."""
    reference = impact(RADIUS, DENSITY, MODULUS, RATIO, SPEED)
    assert reference.peak_force == pytest.approx(FORCE, rel=1e-3)
    response = vi.simulate(problem("consistent", 60))
    times = reference.time[
        reference.time < min(reference.contact_duration, float(response.end_time[0]))
    ]
    found = response.at(times)
    history = reference.force[: len(times)]
    agrees(
        "impact, local compliance `consistent`, 60 modes",
        "contact force history",
        found["force_N"],
        history,
        unit="N",
        absolute=0.015 * FORCE,
    )


@pytest.mark.parametrize("radius", [1e-3, 2.5e-3, 4.5e-3])
def test_static_force_against_approach(agrees: Agrees, radius: float) -> None:
    """Of the law, what is in series with it and the modes together, at Hertz's contact
    radii of 1, 2.5 and 4.5 mm, within 0.5 %.
    """
    made = problem("consistent", 10)
    local = LocalContact(made.laws[0], made.quasi_static, SPEED)  # type: ignore[arg-type]
    modes = made.sphere.modes
    assert modes is not None
    delta = np.array([radius**2 / RADIUS])
    force = float(local.law.forces(delta, np.zeros(1), SPEED)[0][0])
    approach = float(local.approach_at(delta)[0]) + force * float(
        ((modes.contact / modes.angular_frequencies) ** 2).sum()
    )
    expected = static_approach(RADIUS, MODULUS, RATIO, approach, 8.0).force
    agrees(
        "static contact, contact radii 1, 2.5 and 4.5 mm",
        "contact force at equal approach",
        force,
        expected,
        unit="N",
        relative=5e-3,
    )


def test_superposed_falls_with_the_modes() -> None:
    (few, _, _), (many, longer, _) = (impact_of(problem("superposed", modes)) for modes in (10, 60))
    assert many < 0.93 * few < 0.93 * FORCE
    assert many < 0.81 * FORCE
    assert longer > 1.17 * DURATION


@pytest.mark.slow
def test_superposed_falls_with_the_mesh(agrees: Agrees) -> None:
    """With the static deformation of the point among the modes; so does nothing of
    `consistent`, or it is refused.
    """
    meshes = ((6, 1.0), (8, 1.0), (8, 2.0), (8, 4.0))
    forces = [
        impact_of(problem("superposed", 20, across, grading, True))[0] for across, grading in meshes
    ]
    assert np.all(np.diff(forces) < 0.0)
    assert forces[0] < 0.45 * FORCE
    assert forces[-1] < 0.25 * FORCE
    check_consistent(agrees, 20, 8, 4.0, True)
    with pytest.raises(vi.InputError, match=r"attachment_mode: .* leave this out"):
        problem("consistent", 20, 8, 1.0, True)


@pytest.mark.slow
def test_superposed_goes_on_falling() -> None:
    """With 150 modes at twelve elements across it has lost a quarter of the force; a
    point has no limit.
    """
    forces = [impact_of(problem("superposed", modes, 12))[0] for modes in (20, 60, 150)]
    assert forces == pytest.approx([10549.0, 9718.0, 8990.0], rel=5e-3)
