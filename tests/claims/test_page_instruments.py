"""Numbers of the page on instruments."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import ROOT, says
from support import blocks
from vibroimpact.cases.sensor_doubts import _DOUBTED_SHARE

PAGE = "docs/instruments.md"


def test_defaults() -> None:
    """Those that stand in the table beside the keys."""
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    accelerometer = vi.sensors.Accelerometer()
    assert f"`damping_ratio` ({accelerometer.damping_ratio}), `range`" in text
    assert (
        "`damping_ratio` "
        f"({vi.sensors.Geophone(natural_frequency=10.0, sensitivity=27.6).damping_ratio}, with its "
        "shunt)" in text
    )
    says(PAGE, "or {} kg/m^3)", vi.sensors.Microphone().air_density)
    (case,) = (vi.case_of(tomllib.loads(block)) for block in blocks(PAGE, "toml"))
    microphone = case.sensors[1].microphone
    assert microphone is not None
    says(PAGE, "({} m/s) of air at {} C", microphone.speed_of_sound, 20.0)
    # of an ideal gas: 1.4 times the gas constant of air times the temperature
    assert float(np.sqrt(1.4 * 287.05 * 293.15)) == pytest.approx(
        microphone.speed_of_sound, abs=0.2
    )


def test_power_that_needs_a_baffle() -> None:
    says(
        PAGE,
        "A warning is given if more than {} % of the power lies below the former frequency",
        100.0 * _DOUBTED_SHARE,
    )
