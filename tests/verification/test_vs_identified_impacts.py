"""Impacts that are known against what their records tell: 200 of them, simulated with twice the modes of the model that identifies them."""

from __future__ import annotations

import numpy as np
import pytest

from identifying import THICKNESS, an_impact, drawn, plate, records_of
from vibroimpact.identification.identify import identify_on

TRUTHS = ("place_x_m", "place_y_m", "radius_m", "speed_m_s", "max_force_N", "impulse_N_s", "recovered_max_force_N", "recovered_impulse_N_s")


@pytest.mark.slow
def test_intervals_hold_what_they_say() -> None:
    """Intervals of 95 % hold 88 to 99 % of 200 impacts: what the modes left out lack costs some of them, and 200 leave 1.7 % to chance.

    Those of the largest force from the records alone hold more, since the prior is as smooth as the force.
    """
    held = []
    for number, (radius, speed, place) in enumerate(drawn(200, seed=7)):
        impact = an_impact(radius, speed, place)
        told = identify_on(plate(), records_of(impact, 40.0, seed=1000 + number)).estimates
        truth = dict(zip(TRUTHS, (*place, radius, speed, *2 * (impact.peak, impact.impulse)), strict=True))
        held.append([told[name].interval[0] <= value <= told[name].interval[1] for name, value in truth.items()])
        assert told["recovered_max_force_N"].value == pytest.approx(impact.peak, rel=0.05)
        assert told["recovered_impulse_N_s"].value == pytest.approx(impact.impulse, rel=0.02)
        assert np.hypot(told["place_x_m"].value - place[0], told["place_y_m"].value - place[1]) < 0.5 * THICKNESS
    part = dict(zip(TRUTHS, np.mean(held, axis=0), strict=True))
    assert part.pop("recovered_max_force_N") > 0.9
    assert {name: one for name, one in part.items() if not 0.88 <= one <= 0.99} == {}
