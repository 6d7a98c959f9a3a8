"""Impacts that are known against what is identified from their records: 400, each on a plate of its
own.

The plates are simulated with twice the modes of the model that identifies the impacts, and each
differs from that finer model by errors of its frequencies and of its static compliance that are
drawn from those that the finer model states of itself.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from agreement import Against, Agrees
from identifying import (
    DELAY,
    FITTED,
    FROM_RECORDS,
    THICKNESS,
    an_impact,
    drawn,
    plate,
    records_of,
)
from vibroimpact.identification.identify import identify_on

AGAINST = Against(
    "identification of simulated impacts: twice the modes, errors of the plate model, noise",
    "consistency",
    "calibration, identification and studies",
    "tests/identifying.py: estimates against the simulated impacts; no external reference",
)


@pytest.mark.slow
def test_400_impacts(agrees: Agrees, population: Callable[..., int]) -> None:
    """One test, as they take minutes; all are simulated first, as the factors of one
    plate are kept at a time.
    """
    simulated = []
    for number, (radius, speed, place) in enumerate(
        drawn(400, seed=7)[: population(400, share=20)]
    ):
        impact = an_impact(radius, speed, place, off=np.random.default_rng(5000 + number))
        known = (*place, radius, speed, DELAY, *2 * (impact.peak, impact.impulse))
        simulated.append((known, records_of(impact, 40.0, seed=1000 + number)))
    held = []
    for known, records in simulated:
        told = identify_on(plate(), records).estimates
        truth = dict(zip((*FITTED, *FROM_RECORDS), known, strict=True))
        held.append(
            [
                told[name].interval[0] <= value <= told[name].interval[1]
                for name, value in truth.items()
            ]
        )
        case, found = (
            "400 impacts, 40 dB",
            {name: estimate.value for name, estimate in told.items()},
        )
        peak, impulse = truth["recovered_max_force_N"], truth["recovered_impulse_N_s"]
        agrees(
            case,
            "maximum contact force, estimated from the records",
            found["recovered_max_force_N"],
            peak,
            unit="N",
            relative=0.05,
        )
        agrees(
            case,
            "impulse, estimated from the records",
            found["recovered_impulse_N_s"],
            impulse,
            unit="N s",
            relative=0.02,
        )
        off = np.hypot(
            found["place_x_m"] - truth["place_x_m"], found["place_y_m"] - truth["place_y_m"]
        )
        agrees(
            case,
            "distance of the estimated from the true position",
            off,
            0.0,
            unit="m",
            absolute=0.5 * THICKNESS,
        )
    part = dict(zip((*FITTED, *FROM_RECORDS), np.mean(held, axis=0), strict=True))
    assert min(part.values()) > 0.88
    if missed := [
        f"{name} {100.0 * value:.1f} %" for name, value in part.items() if not 0.93 <= value <= 0.97
    ]:
        pytest.xfail(f"intervals that hold other than 93 to 97 %: {', '.join(missed)}")
