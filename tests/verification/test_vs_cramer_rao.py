"""Bounds of recognition against what is known otherwise: maximum likelihood, normal distributions
in closed form, spectra of Hertz's pulse.

The Cramer-Rao bound is reached by maximum likelihood where noise is small (Kay, Fundamentals of
Statistical Signal Processing I, 1993). The Bayes error of two normal distributions of equal
covariance at a Mahalanobis distance d is Phi(-d/2) (Fukunaga, Introduction to Statistical Pattern
Recognition, 1990, eq. 3.119). The spectrum of Hertz's pulse falls by 3 and 10 dB at .67/T and
1.16/T, and first vanishes at 1.80/T.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, least_squares
from scipy.stats import norm

import vibroimpact as vi
from agreement import Against, Agrees
from support import one_in
from vibroimpact.bayes_error.error_estimate import bayes_error
from vibroimpact.bayes_error.falls import falls_of_sweep
from vibroimpact.bayes_error.pulse_information import pulse_uncertainty
from vibroimpact.signals.inverse.hertz_pulse import hertz_pulse

AGAINST = Against(
    "Hertz pulse, its spectrum, and the Cramér-Rao bound",
    "closed form",
    "calibration, identification and studies",
    "Kay 1993; Fukunaga 1990, eq. 3.119; Hertz pulse by quadrature",
)


def test_the_pulse_is_that_of_a_simulated_impact(agrees: Agrees) -> None:
    problem = vi.Problem(
        sphere=vi.Body(mass=0.1, contact_offset=0.02),
        plate=vi.rigid_plate(),
        laws=(vi.laws.find_contact_law("hertz")(stiffness=1e9),),
        speed=3.0,
        gravity=0.0,
        impacts=1,
    )
    response = vi.simulate(problem)
    duration = float(response.impacts["duration_s"][0])
    part = np.linspace(0.01, 0.99, 99)
    force = response.at(part * duration)["force_N"]
    pulse = hertz_pulse(part) * 0.6 / duration  # impulse 2 m v
    agrees(
        "pulse of a simulated Hertz impact", "contact force", pulse, force, unit="N", relative=1e-6
    )


def test_the_spectrum_falls_where_it_is_known_to(agrees: Agrees) -> None:
    nodes, weights = np.polynomial.legendre.leggauss(300)
    time = 0.5 * (1.0 + nodes)

    def spectrum(u: float) -> float:
        return float(
            np.sum(0.5 * weights * hertz_pulse(time) * np.cos(2.0 * np.pi * u * (time - 0.5)))
        )

    falls = [
        brentq(lambda u, low=low: spectrum(u) - 10 ** (low / 20), *ends)
        for low, ends in ((-3, (0.1, 1.0)), (-10, (0.5, 1.5)))
    ]
    found = [*falls, brentq(spectrum, 1.5, 2.0)]
    agrees(
        "spectrum of the Hertz pulse",
        "frequencies of -3 dB, -10 dB and the first zero, times contact duration",
        found,
        [0.67, 1.16, 1.80],
        absolute=0.005,
    )


@pytest.mark.parametrize(
    ("rate", "duration"),
    [
        pytest.param(200e3, 300e-6, marks=pytest.mark.slow),
        (20e3, 300e-6),
        pytest.param(40e3, 1e-3, marks=pytest.mark.slow),
    ],
)
def test_maximum_likelihood_reaches_the_uncertainty(
    agrees: Agrees, rate: float, duration: float
) -> None:
    """White noise sampled at twice the band, and the pulse limited to the band by its own
    Fourier series.
    """
    over, number, rng = 16, 128, np.random.default_rng(1)
    frequency = np.fft.rfftfreq(number, 1.0 / rate)
    fine = (np.arange(number * over) - number * over // 2) / (rate * over)

    def model(values: np.ndarray) -> np.ndarray:
        length = duration * np.exp(values[1])
        whole = np.exp(values[0]) / length * hertz_pulse((fine - 1e-5 * values[2]) / length + 0.5)
        return np.fft.irfft(np.fft.rfft(whole)[: len(frequency)] / over, number)

    peak = float(hertz_pulse(np.array([0.5]))[0]) / duration
    deviation = peak / 30.0
    found = []
    for _ in range(200):
        heard = model(np.zeros(3)) + deviation * rng.standard_normal(number)
        found.append(
            least_squares(lambda one, heard=heard: (model(one) - heard) / deviation, np.zeros(3)).x[
                :2
            ]
        )
    least = pulse_uncertainty(
        np.ones(1), np.array([duration]), 0.5 * rate, deviation**2 / (0.5 * rate)
    )[:, 0]
    scatter = np.std(found, axis=0)  # of 200 estimates, which know it to 5 %
    agrees(
        "maximum-likelihood estimation, 200 noise realizations",
        "standard deviations of impulse and contact duration against the Cramér-Rao bound",
        scatter,
        least,
        relative=0.15,
    )


@pytest.mark.parametrize("distance", one_in(4, [0.5, 1.0, 2.0, 3.0]))
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_two_normal_distributions_in_two_quantities(distance: float, part: float) -> None:
    """A part of the variance is noise of the measurement, the rest is of the population."""
    rng = np.random.default_rng(2)
    classes = np.repeat([0, 1], 10_000)
    clean = np.sqrt(1.0 - part) * rng.standard_normal((20_000, 2)) + np.outer(
        classes, [0.6 * distance, 0.8 * distance]
    )
    found = bayes_error(clean, np.full_like(clean, np.sqrt(part)), classes, seed=3)
    known = norm.cdf(-0.5 * distance)
    assert found.lower - 0.012 <= known <= found.upper + 3.0 * found.standard_error
    assert found.upper - found.lower < 0.03 + 2.0 * found.standard_error


def test_unequal_shares_and_three_classes() -> None:
    rng = np.random.default_rng(4)
    classes = rng.choice(3, 20_000, p=[0.7, 0.2, 0.1])
    measured = 4.0 * classes[:, None] + rng.standard_normal((20_000, 1)) * 0.8
    noise = np.full_like(measured, 0.6)
    x = np.linspace(-8.0, 16.0, 20_001)
    each = np.array(
        [share * norm.pdf(x, 4.0 * number) for number, share in enumerate((0.7, 0.2, 0.1))]
    )
    known = 1.0 - np.trapezoid(each.max(axis=0), x)
    found = bayes_error(measured, noise, classes, tested=5000)
    assert abs(found.lower - known) < 0.006
    assert abs(found.upper - known) < 3.0 * found.standard_error


def test_other_falls_of_a_rock_do_not_betray_its_class() -> None:
    """Four falls of each rock are alike, and what is measured does not depend on the class:
    the error is a half, though the falls of the same rock would name the class.
    """
    rng = np.random.default_rng(5)
    rocks = np.repeat(np.arange(1000), 4)
    classes = np.repeat(rng.choice(2, 1000), 4)
    measured = np.repeat(rng.standard_normal((1000, 1)), 4, axis=0)
    noise = np.full_like(measured, 1e-4)
    found = bayes_error(measured, noise, classes, rocks)
    assert abs(found.upper - 0.5) < 4.0 * found.standard_error
    assert bayes_error(measured, noise, classes).upper < 0.2


def test_coal_rings_like_gangue_of_twice_its_size(agrees: Agrees) -> None:
    """Contact times on steel at 8.8 m/s: 261 us of coal of 25 mm, 145 and 291 us of
    gangue of 25 and 50 mm.
    """
    table = {
        "sphere": {
            "radius": 0.025,
            "material": {"density": 1380.0, "youngs_modulus": 2.26e9, "poissons_ratio": 0.28},
        },
        "plate": {"material": {"density": 7850.0, "youngs_modulus": 210e9, "poissons_ratio": 0.3}},
        "drop": {"speed": 8.8},
        "contact": {"law": "hertz"},
        "sweep": {
            "design": "population",
            "samples": 400,
            "over": {},
            "classes": {
                "coal": {"over": {"sphere.radius": [0.025], "sphere.material": [coal()]}},
                "gangue": {"over": {"sphere.radius": [0.025, 0.05], "sphere.material": [gangue()]}},
            },
        },
    }
    falls = falls_of_sweep(vi.studies.sweep_of(table))
    for name, radius, known in (
        ("coal", 0.025, 261e-6),
        ("gangue", 0.025, 145e-6),
        ("gangue", 0.05, 291e-6),
    ):
        there = (falls.classes == name) & (falls.radius == radius)
        agrees(
            "coal and gangue spheres on steel",
            "contact duration",
            falls.duration[there],
            known,
            unit="s",
            absolute=1e-6,
        )
    np.testing.assert_allclose(falls.impulse, 2.0 * falls.mass * 8.8, rtol=1e-8)


def coal() -> dict[str, float]:
    return {"density": 1380.0, "youngs_modulus": 2.26e9, "poissons_ratio": 0.28}


def gangue() -> dict[str, float]:
    return {"density": 2600.0, "youngs_modulus": 20e9, "poissons_ratio": 0.28}
