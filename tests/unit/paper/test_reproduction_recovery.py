"""The restitution and the full-damping penetration that the paper's numbers imply."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.paper.derived import function_at, parabola, printed_dampings
from vibroimpact.paper.recovery import (
    RecoveredParameters,
    implied_restitution,
    off_joint,
    penetration_bands,
    recover_parameters,
    recovery_section,
)
from vibroimpact.paper.runs import Runs, with_law
from vibroimpact.units.display import MISSING


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


@pytest.fixture(scope="module")
def found(runs: Runs) -> RecoveredParameters:
    return recover_parameters(runs)


def test_both_are_found_and_sharply(found: RecoveredParameters) -> None:
    assert found.restitution.value == pytest.approx(0.65, abs=5e-5)
    assert found.restitution.deviation < 2e-5
    assert found.penetration.value == pytest.approx(1e-4, rel=1e-4)
    assert found.penetration.deviation < 1e-8
    assert found.worst < 2.0, "the evidence agrees"
    assert found.single


def test_at_the_round_values_the_rounded_numbers_come_out_as_printed(
    found: RecoveredParameters,
) -> None:
    assert found.round_values == (0.65, 1e-4)


def test_each_piece_of_evidence_agrees_with_the_rest(found: RecoveredParameters) -> None:
    counted = [one for one in found.evidence if one.joint]
    assert len(counted) == 5
    for one in counted:
        for alone, joint in zip(
            found.alone[one.name], (found.restitution, found.penetration), strict=True
        ):
            if alone is not None:
                assert abs(alone.value - joint.value) < 2.0 * alone.deviation, one.name
    assert found.alone["the first rebound"][0] is None, "it does not depend on the theory"
    assert found.alone["the damping function, at the theory's speeds"][1] is None, (
        "it does not depend on the simulation"
    )


def test_the_damping_function_was_fitted_at_the_speeds_of_the_simulation(
    found: RecoveredParameters,
) -> None:
    printed = np.array([138.93525, 6.00288, -0.15582])
    simulation, theory = (np.abs(coefficients - printed) for coefficients in found.parabolas)
    assert simulation == pytest.approx(0.0, abs=3e-4)
    assert np.all(simulation < 0.1 * theory)


def test_the_printed_penetration_gives_other_numbers(found: RecoveredParameters) -> None:
    height, fourth, fifth = found.as_printed
    assert (round(height, 4), round(fourth, 1), round(fifth, 1)) == (2.3613, 21.6, 13.1)


def test_what_is_interpolated_is_what_is_simulated(runs: Runs, found: RecoveredParameters) -> None:
    problem = runs.problem("type1-variable")
    height = vi.simulate(
        with_law(problem, full_damping_penetration=found.penetration.value)
    ).impacts["rebound_height_m"][0]
    rebound = next(one for one in found.evidence if one.name == "the first rebound")
    residual = float(
        rebound.residuals(found.restitution.value, np.log10(found.penetration.value))[0]
    )
    assert 2.41132 + residual == pytest.approx(height, abs=2e-8)


def test_a_restitution_outside_of_what_is_given_is_not_made_up(found: RecoveredParameters) -> None:
    rebounds = next(one for one in found.evidence if one.name.startswith("the five rebounds"))
    at = np.array([1e-4])
    assert implied_restitution(rebounds, np.linspace(0.6, 0.7, 201), at) == pytest.approx(
        0.65, abs=2e-4
    )
    assert np.isnan(implied_restitution(rebounds, np.linspace(0.8, 0.9, 11), at)).all()


def test_the_printed_penetration_lies_in_no_band_and_the_round_one_in_all(
    found: RecoveredParameters,
) -> None:
    assert penetration_bands(found, 1e-5) == (False, False)
    assert penetration_bands(found, 1e-4) == (True, True)


def test_the_joint_estimate_lies_in_the_bands_of_what_is_rounded(
    found: RecoveredParameters,
) -> None:
    off = {one.name: off_joint(found, one) for one in found.evidence if not one.sampled}
    assert len(off) == 6
    assert all(off[one.name] <= 1.0 for one in found.evidence if one.freedom is None)
    assert max(off.values()) < 2.0
    assert off["the five rebounds match the theory's"] > 1.0, (
        "a band of one standard deviation need not hold it"
    )


def test_the_parabola_is_that_of_a_polynomial_fit() -> None:
    speeds = np.array([[8.8, 6.8, 5.3, 4.1, 3.2], [8.0, 7.0, 5.0, 4.0, 3.0]])
    for row, found in zip(speeds, parabola(speeds), strict=True):
        fit = np.polyfit(row, printed_dampings(), 2)
        assert found == pytest.approx(fit[::-1], rel=1e-9)
        assert function_at(row, found) == pytest.approx(np.polyval(fit, row), rel=1e-12)
    assert function_at(speeds, parabola(speeds)).shape == speeds.shape


def test_the_section_says_that_the_printed_penetration_is_not_it(runs: Runs) -> None:
    section = recovery_section(runs)
    assert not section.rows, "section 3.1 has the row"
    assert "no second solution" in section.conclusion[0]
    assert "0.00001 m, is met by none of the 2" in section.conclusion[1]
    assert "The paper's other numbers are those of 0.1000 mm" in section.conclusion[1]
    evidence, parabolas = section.tables
    assert len(evidence.cells) == 11
    assert all(len(row) == len(evidence.headers) for row in evidence.cells)
    assert evidence.cells[0][1] == MISSING
    assert [row[1] for row in parabolas.cells] == ["138.93525", "6.00288", "\u22120.15582"]
