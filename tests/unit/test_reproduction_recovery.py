"""The restitution and the full-damping penetration that the paper's numbers imply."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.reproduction.recovery import Recovery, implied_restitution, recover, recovery
from vibroimpact.reproduction.row import Verdict
from vibroimpact.reproduction.runs import Runs


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


@pytest.fixture(scope="module")
def found(runs: Runs) -> Recovery:
    return recover(runs)


def test_both_are_found_and_sharply(found: Recovery) -> None:
    assert found.restitution.value == pytest.approx(0.65, abs=5e-5)
    assert found.restitution.deviation < 2e-5
    assert found.penetration.value == pytest.approx(1e-4, rel=1e-4)
    assert found.penetration.deviation < 1e-8
    assert found.worst < 2.0, "the evidence agrees"
    assert found.single


def test_at_the_round_values_the_rounded_numbers_come_out_as_printed(found: Recovery) -> None:
    assert found.round_values <= 1.0


def test_each_piece_of_evidence_agrees_with_the_rest(found: Recovery) -> None:
    counted = [one for one in found.evidence if one.joint]
    assert len(counted) == 5
    for one in counted:
        for alone, joint in zip(found.alone[one.name], (found.restitution, found.penetration), strict=True):
            if alone is not None:
                assert abs(alone.value - joint.value) < 2.0 * alone.deviation, one.name
    assert found.alone["the first rebound"][0] is None, "it does not depend on the theory"
    assert found.alone["the damping function, at the theory's speeds"][1] is None, "it does not depend on the simulation"


def test_the_damping_function_was_fitted_at_the_speeds_of_the_simulation(found: Recovery) -> None:
    printed = np.array([138.93525, 6.00288, -0.15582])
    simulation, theory = (np.abs(coefficients - printed) for coefficients in found.parabolas)
    assert simulation == pytest.approx(0.0, abs=3e-4)
    assert np.all(simulation < 0.1 * theory)


def test_the_printed_penetration_gives_other_numbers(found: Recovery) -> None:
    height, fourth, fifth = found.as_printed
    assert (round(height, 4), round(fourth, 1), round(fifth, 1)) == (2.3613, 21.6, 13.1)


def test_what_is_interpolated_is_what_is_simulated(runs: Runs, found: Recovery) -> None:
    problem = runs.problem("type1-variable")
    laws = tuple(dataclasses.replace(law, full_damping_penetration=found.penetration.value) for law in problem.laws)
    height = vi.simulate(dataclasses.replace(problem, laws=laws)).impacts["rebound_height_m"][0]
    rebound = next(one for one in found.evidence if one.name == "the first rebound")
    residual = float(rebound.residuals(found.restitution.value, np.log10(found.penetration.value))[0])
    assert 2.41132 + residual == pytest.approx(height, abs=2e-8)


def test_a_restitution_outside_of_what_is_given_is_not_made_up(found: Recovery) -> None:
    rebounds = next(one for one in found.evidence if one.name.startswith("the five rebounds"))
    at = np.array([1e-4])
    assert implied_restitution(rebounds, np.linspace(0.6, 0.7, 201), at) == pytest.approx(0.65, abs=2e-4)
    assert np.isnan(implied_restitution(rebounds, np.linspace(0.8, 0.9, 11), at)).all()


def test_the_section_says_that_the_printed_penetration_is_not_it(runs: Runs) -> None:
    section = recovery(runs)
    assert [row.verdict for row in section.rows] == [Verdict.NOT_REPRODUCED]
    assert "misprint" in section.rows[0].otherwise
    assert "no second solution" in section.conclusion[0]
    evidence, parabolas = section.tables
    assert len(evidence.cells) == 11
    assert all(len(row) == len(evidence.headers) for row in evidence.cells)
    assert [row[1] for row in parabolas.cells] == ["138.93525", "6.00288", "-0.15582"]
