"""The frequency up to which the modes of a body are enough for an impact."""

from __future__ import annotations

import math

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.structures import enough_modes
from vibroimpact.structures.enough_modes import Band, Impulse, ModalDensity, enough_frequency

IMPULSE = Impulse(duration=1e-4, stiffness=1e8)
THIN = ModalDensity(bending=5e-4, volume=0.0)
SOLID = ModalDensity(bending=0.0, volume=2e-13)


def test_the_spectrum_is_that_of_the_force() -> None:
    time = np.linspace(0.0, 1.0, 20_001)
    force = np.sin(np.pi * time) ** 1.5
    frequencies = enough_modes._SPECTRUM[:400:20]
    computed = np.array(
        [
            abs(np.trapezoid(force * np.exp(2j * np.pi * frequency * time), time))
            for frequency in frequencies
        ]
    )
    spectrum = enough_modes._force_spectrum()[:400:20]
    np.testing.assert_allclose(spectrum / spectrum[0], computed / computed[0], rtol=1e-5)


@pytest.mark.parametrize(("density", "power"), [(THIN, 3), (SOLID, 1)])
def test_the_error_falls_with_a_power_of_the_frequency(density: ModalDensity, power: int) -> None:
    """A tenth of the error needs 10^(1/3) of the frequency in a plate, ten times in a solid."""
    coarse = enough_frequency(IMPULSE, density, [], 0.02)
    fine = enough_frequency(IMPULSE, density, [], 0.002)
    # within a step of the series on either side
    assert fine / coarse == pytest.approx(10 ** (1 / power), rel=0.27)


def test_modes_of_the_octave_below_add_up_to_the_error() -> None:
    """The sum over modes at equal distances, as `dynamics.truncation` forms it."""
    frequency = enough_frequency(IMPULSE, THIN, [], 0.01)
    omega = 2.0 * math.pi * frequency
    step = omega / 20_000
    modes = np.arange(0.5 * omega, omega, step) + 0.5 * step
    inertia = np.sum(THIN.bending * step / modes**4)
    error = IMPULSE.stiffness * inertia * (math.pi / IMPULSE.duration) ** 2
    assert error == pytest.approx(
        enough_modes._force_error(IMPULSE, THIN, frequency, True), rel=1e-6
    )
    allowed = 0.01 / enough_modes._MARGIN
    assert error <= allowed
    assert enough_modes._force_error(IMPULSE, THIN, frequency / 1.27, True) > allowed


def test_a_signal_needs_no_modes_beyond_its_band() -> None:
    stiff = ModalDensity(bending=1e-7, volume=0.0)  # of which the force needs none
    for rate in (10e3, 20e3, 40e3):
        enough = enough_frequency(IMPULSE, stiff, [Band(1.0, 0.5 * rate)], 1e-3)
        assert max(1e4, 0.5 * rate) <= enough <= max(1e4, 0.5 * rate) * 1.3


def test_derivatives_of_the_motion_need_more() -> None:
    enough = [
        enough_frequency(IMPULSE, THIN, [Band(power, math.inf)], 0.01) for power in (-1.0, 0.0, 1.0)
    ]
    assert enough == sorted(enough)
    assert enough[0] < enough[2]


def test_of_several_sensors_the_one_that_needs_most_counts() -> None:
    bands = [Band(-1.0, 25e3), Band(1.0, 25e3)]
    assert enough_frequency(IMPULSE, THIN, bands, 0.01) == enough_frequency(
        IMPULSE, THIN, bands[1:], 0.01
    )


def test_what_no_static_solution_carries_needs_more() -> None:
    carried = enough_frequency(IMPULSE, THIN, [], 0.01)
    assert enough_frequency(IMPULSE, THIN, [], 0.01, is_carried=False) > carried


def test_an_accuracy_beyond_reach_is_refused() -> None:
    with pytest.raises(vi.InputError, match="modes beyond 100 MHz"):
        enough_frequency(IMPULSE, SOLID, [], 1e-9, is_carried=False)
