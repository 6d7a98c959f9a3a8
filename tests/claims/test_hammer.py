"""What the page on impact-hammer tests says of its example, and of noise of the force."""

from __future__ import annotations

import runpy
from functools import cache
from typing import Any
from unittest import mock

import numpy as np
import pytest

import vibroimpact as vi
from hammer_test import RATE, a_case, hammered, records
from stated_numbers import ROOT, says
from vibroimpact.signals.decay import find
from vibroimpact.signals.estimate import Estimate

PAGE = "docs/hammer.md"


@cache
def example() -> dict[str, Any]:
    """Return the names of the example, which draws nothing here."""
    with mock.patch.object(vi, "save_charts", create=True):
        return runpy.run_path(str(ROOT / "examples" / "hammer.py"))


def row(number: int) -> tuple[float, float, float, float]:
    """Return the numbers of a mode in the table."""
    (pair,) = (one for one in example()["found"].modes if one.number == number)
    mode = pair.measured
    return (
        mode.frequency.value,
        100.0 * pair.frequency_difference,
        pair.damping_ratio,
        mode.damping_ratio.value,
    )


@pytest.mark.slow
def test_as_drawn() -> None:
    found, drawn = example()["found"], example()["DRAWN"]
    sides = [float(one.removesuffix(" mm")) for one in drawn["plate"]["size"]]
    says(
        PAGE,
        "of a steel plate of {} x {} x {} mm whose case has a damping ratio of {} in all modes",
        *sides,
        drawn["plate"]["damping"],
    )
    thinner = float(example()["thinner"]["size"][2].removesuffix(" mm"))
    says(PAGE, "The plate as built is {} % thinner", 100.0 * (1.0 - thinner / sides[2]))
    says(
        PAGE,
        "before any correction: FRAC {}, residual {} %",
        float(found.frac[0]),
        100.0 * float(found.relative_residual[0]),
    )
    differences = [
        -100.0 * pair.frequency_difference for pair in found.modes if pair.measured is not None
    ]
    says(PAGE, "measured resonances lie {} % below the simulated ones", min(differences))
    says(PAGE, "All frequencies are {} % low", max(differences))
    says(PAGE, "| 1 | {} Hz | {} % | {} | {} |", *row(1))
    says(PAGE, "| 2 | {} Hz | {} % | {} | {} |", *row(2))
    says(PAGE, "| 3 | {} Hz | {} % | {} | {} |", *row(3))
    says(PAGE, "| 8 | {} Hz | {} % | {} | {} |", *row(8))


@pytest.mark.slow
def test_corrected() -> None:
    again = example()["again"]
    says(
        PAGE,
        "the residual is {} %, and FRAC {}",
        100.0 * float(again.relative_residual[0]),
        float(again.frac[0]),
    )


def test_what_of_damping_is_not_told() -> None:
    says(
        PAGE,
        "is wider than from {} to {} times its value",
        *Estimate(1.0, find._VAGUE, logarithmic=True).interval,
    )
    says(PAGE, "Modes with damping ratios above {} are not reported", find._LARGEST_DAMPING)


@pytest.mark.slow
def test_noise_of_the_force() -> None:
    force, value = hammered((0.02, 0.24), 0.45)
    noise = force.max() * np.random.default_rng(3).standard_normal(len(force))

    def residual(measured: np.ndarray) -> float:
        found = vi.test_analysis.correlate(
            a_case(damping=0.008),
            records(value),
            force=vi.signals.Record("hammer", measured, RATE, "N"),
        )
        return 100.0 * float(found.relative_residual[0])

    level = 0.01
    says(
        PAGE,
        "with a residual of {} %, white noise of {} % of the force's peak increases the "
        "residual to {} %, and {} % to {} %",
        residual(force),
        *(0.1, residual(force + 0.001 * noise)),
        *(100.0 * level, residual(force + level * noise)),
    )
    windowed = np.where(force < 1e-3 * force.max(), 0.0, force + level * noise)
    says(PAGE, "the residual with {} % of noise is then {} %", 100.0 * level, residual(windowed))
