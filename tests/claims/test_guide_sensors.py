"""Numbers of the guide on accelerometers."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import says
from support import example
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import numbers_of

PAGE = "docs/guides/accelerometer.md"
PICTURES = example("pictures_of_guides")


@pytest.mark.slow  # modes to 52 kHz
def test_chains() -> None:
    response = PICTURES.measured_by_chains()
    (doubt,) = vi.result_of(response).doubts
    assert "is overloaded beyond its range" in doubt  # that which the page clips
    motion, magnet, clipped, slow = response.signals().values()
    says(PAGE, "| the motion itself, {} kHz | {3} |", 1e-3 * motion.sensor.rate, motion.largest)
    says(
        PAGE,
        "51.2 kHz | {3} | vibrates at its resonance: {} times too large |",
        magnet.largest,
        magnet.largest / motion.largest,
    )
    says(
        PAGE,
        "51.2 kHz | {2} | clipped for {} ms; the acceleration at the input reached {3} m/s² |",
        clipped.largest,
        1e3 * clipped.overload_time,
        clipped.peak,
    )
    says(PAGE, "resonance at 32 kHz, range {} m/s²", clipped.sensor.instrument.range)
    says(PAGE, "no resonance, {} kHz | {} |", 1e-3 * slow.sensor.rate, slow.largest)
    # a twelfth of the amplitude
    assert motion.largest / slow.largest == pytest.approx(12.0, abs=0.5)
    case = vi.case_of(PICTURES.SENSORS)
    apart = np.subtract(case.sensors[0].position, case.drop.position)
    says(PAGE, "one position {} mm from it", 1e3 * float(np.hypot(*apart)))
    impact = PICTURES.first_impact(response)
    says(
        PAGE,
        "the largest force is {} kN and the restitution {}",
        1e-3 * impact["max_force_N"],
        impact["restitution_achieved"],
    )


@pytest.mark.slow
def test_without_yielding() -> None:
    response = PICTURES.measured_by_chains("hertz")
    result, impact = vi.result_of(response), PICTURES.first_impact(response)
    says(
        PAGE,
        "would be {} times that of first yield",
        float(numbers_of(Conditions(result.case, result._drop_summary))["plate_strength"]),
    )
    says(
        PAGE,
        "it would be {} kN, and the largest acceleration {3} m/s²",
        1e-3 * impact["max_force_N"],
        next(iter(response.signals().values())).largest,
    )


@pytest.mark.slow
def test_the_case_of_the_page() -> None:
    response = vi.simulate(vi.case_of(PICTURES.SENSORS))
    assert not vi.result_of(response).doubts
    wide = response.signals()["wide"]
    says(PAGE, "reads {3} m/s² at most, and {3} m/s² reach its input", wide.largest, wide.peak)


def test_spectrum_of_hertz() -> None:
    body = vi.Body(mass=0.1, contact_offset=0.01)
    law = vi.laws.find_contact_law("hertz")(stiffness=1e8)
    response = vi.simulate(
        vi.Problem(
            sphere=body, plate=vi.rigid_plate(), laws=(law,), speed=1.0, gravity=0.0, impacts=1
        )
    )
    duration = float(response.impacts["duration_s"][0])
    time = np.linspace(0.0, duration, 2001)
    force = response.at(time, ("force_N",))["force_N"]
    part = abs(
        np.trapezoid(force * np.exp(-2j * np.pi * 1.2 / duration * time), time)
        / np.trapezoid(force, time)
    )
    says(
        PAGE,
        "up to about 1.2/T, where the spectrum of Hertz's force has fallen by {} dB",
        -20.0 * np.log10(part),
    )
    says(PAGE, "dB: {} kHz for 150 µs", 1e-3 * 1.2 / 150e-6)


def test_reading_below_the_resonance() -> None:
    says(
        PAGE,
        "At a fifth of the mounted resonance the reading is {} % too large",
        100.0 * (1.0 / (1.0 - 1.0 / 25.0) - 1.0),
    )
    says(PAGE, "at half {} %", 100.0 * (1.0 / (1.0 - 1.0 / 4.0) - 1.0))
