"""Impacts that are known against what their records tell: 400 of them, simulated with twice the modes of the model that identifies them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from identifying import THICKNESS, an_impact, drawn, plate, records_of
from vibroimpact.identification.estimate import Estimate
from vibroimpact.identification.identify import identify_on

FROM_RECORDS = ("recovered_max_force_N", "recovered_impulse_N_s")
FITTED = ("place_x_m", "place_y_m", "radius_m", "speed_m_s", "max_force_N", "impulse_N_s")

pytestmark = pytest.mark.slow


@cache
def told() -> list[tuple[dict[str, float], dict[str, Estimate]]]:
    """The truth and what is told, of each impact."""
    found = []
    for number, (radius, speed, place) in enumerate(drawn(400, seed=7)):
        impact = an_impact(radius, speed, place)
        estimates = identify_on(plate(), records_of(impact, 40.0, seed=1000 + number)).estimates
        truth = (*place, radius, speed, impact.peak, impact.impulse, impact.peak, impact.impulse)
        found.append((dict(zip((*FITTED, *FROM_RECORDS), truth, strict=True)), estimates))
    return found


def part_held(name: str) -> float:
    """The part of the intervals of a quantity that hold the truth."""
    return float(np.mean([one[name].interval[0] <= truth[name] <= one[name].interval[1] for truth, one in told()]))


def test_force_and_place_of_400_impacts() -> None:
    for truth, one in told():
        assert one["recovered_max_force_N"].value == pytest.approx(truth["max_force_N"], rel=0.05)
        assert one["recovered_impulse_N_s"].value == pytest.approx(truth["impulse_N_s"], rel=0.02)
        assert np.hypot(*(one[name].value - truth[name] for name in ("place_x_m", "place_y_m"))) < 0.5 * THICKNESS


def test_intervals_from_the_records_alone_hold_the_truth() -> None:
    """Those of the largest force hold more than 97 %, since the prior is as smooth as the force."""
    assert part_held("recovered_max_force_N") >= 0.93
    assert 0.93 <= part_held("recovered_impulse_N_s") <= 0.97


@pytest.mark.xfail(strict=True, reason="what the modes left out lack is not all in the intervals: 91 to 93 % hold the truth")
def test_intervals_of_the_fitted_contact_hold_the_truth() -> None:
    assert {name: part for name in FITTED if not 0.93 <= (part := part_held(name)) <= 0.97} == {}
