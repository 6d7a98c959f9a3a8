"""What the pages on coal and gangue say: bounds, moduli, pressures, and the small study."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import norm

import vibroimpact as vi
from stated_numbers import page_text, says
from vibroimpact.bayes_error.bound import BANDWIDTHS, SIGNAL_TO_NOISE, Bound, least_error
from vibroimpact.bayes_error.error_estimate import BayesError, bayes_error
from vibroimpact.bayes_error.falls import Falls, falls_of_sweep
from vibroimpact.bayes_error.observations import Channel, measurable
from vibroimpact.bayes_error.report import error_interval
from vibroimpact.signals.inverse.hertz_pulse import hertz_pulse

GUIDE = "docs/guides/coal-from-rock.md"
BOUNDS = "docs/bounds.md"
RECOGNITION = "docs/recognition.md"

COAL = {
    "three specimens": 2.11,
    "panel 8939": 3.66,
    "roof cutting": 9 * 4.91 * 2.01 / (3 * 4.91 + 2.01),
    "Shangwan": 23.87,
}
"""Young's moduli of coal [GPa] as published: Shock Vib. 2021:8854538, Table 5, without gas; Adv.
Civ. Eng. 2019:4815236, Table 2; Sci. Rep. 14, 2024, doi 10.1038/s41598-024-79523-8, Table 1, 9 K G
/ (3 K + G); Shock Vib. 2021:7649459, Table 4."""
ROCK = {
    "sandy mudstone, roof cutting": 9 * 2.56 * 2.36 / (3 * 2.56 + 2.36),
    "medium sandstone, roof cutting": 9 * 2.89 * 2.54 / (3 * 2.89 + 2.54),
    "fine sandstone, roof cutting": 9 * 21.01 * 13.52 / (3 * 21.01 + 13.52),
    "basic roof, Shangwan": 30.94,
    "direct roof, Shangwan": 40.31,
    "floor, Shangwan": 47.35,
}
"""Those of the rock around the seam [GPa], of the two last of these tables."""


def test_contact_times_of_coal_and_gangue() -> None:
    times = {}
    for name, density, modulus, radius in (
        ("coal", 1380, 2.5e9, 0.025),
        ("large gangue", 2550, 20e9, 0.05),
    ):
        material = {"density": density, "youngs_modulus": modulus, "poissons_ratio": 0.28}
        plate = {"material": {"density": 7850.0, "youngs_modulus": 210e9, "poissons_ratio": 0.3}}
        case = {
            "sphere": {"radius": radius, "material": material},
            "plate": plate,
            "drop": {"speed": 8.8},
            "contact": {"law": "hertz"},
        }
        times[name] = 1e6 * float(
            vi.simulate(vi.case_of({**case, "run": {"impacts": 1}})).impacts["duration_s"][0]
        )
    says(
        GUIDE,
        "at 8.8 m/s, the contact of gangue of 50 mm radius lasts {} µs, that of "
        "coal of 25 mm {} µs",
        times["large gangue"],
        times["coal"],
    )


# bounds of the shipped population


@pytest.fixture(scope="module")
def whole() -> Bound:
    """The bound that the command computes by default."""
    return vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", 20_000))


def per_cent(error: BayesError) -> tuple[float, float]:
    return 100.0 * error.lower, 100.0 * error.upper


@pytest.mark.slow
def test_the_table_of_bounds(whole: Bound) -> None:
    errors, exact = whole.errors, whole.without_scatter
    impulse, time, near, far = (
        errors[name]
        for name in ("impulse", "contact time", "one impact", "one impact, place unknown")
    )
    says(
        GUIDE,
        "the impulse alone | {} to {} % | {} to {} % |",
        *per_cent(impulse),
        *per_cent(exact["impulse"]),
    )
    says(
        GUIDE,
        "the contact time alone (normalised signals) | {} to {} % | {} to {} % |",
        *per_cent(time),
        *per_cent(time),
    )
    says(
        GUIDE,
        "impulse and contact time, position known | {} to {} % | at most {} % |",
        *per_cent(near),
        100.0 * exact["one impact"].upper,
    )
    says(
        GUIDE,
        "impulse and contact time, position unknown | {} to {} % | at most {} % |",
        *per_cent(far),
        100.0 * exact["one impact"].upper,
    )
    says(
        GUIDE,
        "is near the bound for impulse and contact time at an unknown position, {} to {} %",
        *per_cent(far),
    )
    says(
        BOUNDS,
        "the command uses {} falls: {} to {} %, {} to {} %, {} to {} % and {} to {} %",
        len(whole.falls),
        *(part for one in (impulse, time, near, far) for part in per_cent(one)),
    )
    says(
        BOUNDS,
        "So of the {} to {} % for an unknown position {} % or less would remain",
        *per_cent(far),
        100.0 * exact["one impact"].upper,
    )
    # at least a third of the error is the scatter
    assert exact["one impact"].upper < far.lower * 2.0 / 3.0
    says(
        GUIDE,
        "with a bandwidth of 1 kHz the lowest error is at most {} %, with 8 kHz {} %",
        *over_bandwidth(whole, 40.0),
    )
    says(GUIDE, "At 20 dB it is {} and {} %", *over_bandwidth(whole, 20.0))
    most = max(one.standard_error for one in whole.errors.values())
    says(
        BOUNDS,
        "the upper bounds have standard errors of up to {} %, as 2,000 falls are tested",
        100.0 * most,
    )
    assert 0.24 < time.lower < time.upper < 0.3, f"{BOUNDS}: a quarter of the falls"


def over_bandwidth(bound: Bound, ratio: float) -> tuple[float, float]:
    """Return the errors from one impact with a band of 1 and of 8 kHz [%]."""
    column = SIGNAL_TO_NOISE.tolist().index(ratio)
    narrow, wide = (
        100.0 * float(bound.map[BANDWIDTHS.tolist().index(band), column]) for band in (1e3, 8e3)
    )
    return narrow, wide


@pytest.mark.slow
def test_the_printed_table_of_bounds() -> None:
    bound = vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", 5000))
    text = page_text(BOUNDS)
    for name in ("impulse", "contact time", "one impact", "one impact, place unknown"):
        assert (
            f" {name} {error_interval(bound.errors[name])} {error_interval(bound.without_scatter[name])} "
            in text
        )


def test_the_assumed_channel() -> None:
    one = Channel()
    says(
        BOUNDS,
        "a band of {} kHz, noise {} dB below the peak force of the median fall, and "
        "relative standard deviations of {} % for the "
        "sensitivity and {} % for the amplitude where the position is not known",
        1e-3 * one.bandwidth,
        one.signal_to_noise,
        100.0 * one.gain,
        100.0 * one.place,
    )
    says(
        BOUNDS,
        "of the speed ({} %), the radius ({} %) and the time to the next impact ({} %)",
        *(100.0 * part for part in (one.height, one.size, one.interval)),
    )
    says(
        GUIDE,
        "chosen by this program, not measured: {} % of the sensitivity, and {} "
        "% where the position is",
        100.0 * one.gain,
        100.0 * one.place,
    )
    says(GUIDE, "the bound assumes a scatter of {} %", 100.0 * one.place)
    says(GUIDE, "at a peak force of {} dB above the noise", one.signal_to_noise)
    says(BOUNDS, "The noise is counted in {} kHz, whatever the band", 10.0)


# moduli


@cache
def with_moduli(coal: tuple[float, float] | None, gangue: tuple[float, float]) -> Falls:
    """Return falls of the shipped population with other log-normal moduli, by mean and
    standard deviation [GPa].
    """
    table = vi.studies.load_sweep("signals:coal-gangue").whole_table
    table["sweep"]["samples"] = 20_000
    for name, given in (("coal", coal), ("gangue", gangue)):
        if given is not None:
            mean, deviation = (1e9 * part for part in given)
            drawn = {"distribution": "lognormal", "mean": mean, "standard_deviation": deviation}
            table["sweep"]["classes"][name]["over"]["sphere.material.youngs_modulus"] = drawn
    return falls_of_sweep(vi.studies.sweep_of(table))


def between(values: Any) -> tuple[float, float]:
    """Return mean and standard deviation of the log-normal distribution that has nine
    tenths between smallest and largest value.
    """
    low, high = min(values), max(values)
    spread = np.log(high / low) / (norm.ppf(0.95) - norm.ppf(0.05))
    mean = np.sqrt(low * high) * np.exp(0.5 * spread**2)
    return float(mean), float(mean * np.sqrt(np.expm1(spread**2)))


def errors_of(falls: Falls) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Return the bounds [%] from impulse and contact time at a known and at an unknown
    position, and the larger standard error.
    """
    values, noise = measurable(falls, Channel())
    classes = np.unique(falls.classes, return_inverse=True)[1]
    found = []
    for impulse in ("impulse", "far impulse"):
        measured, deviation = (
            np.stack([part[impulse], part["duration"]], axis=1) for part in (values, noise)
        )
        found.append(bayes_error(measured, deviation, classes, falls.rocks))
    near, far = found
    return per_cent(near), per_cent(far), 100.0 * max(near.standard_error, far.standard_error)


@pytest.mark.slow
def test_the_ratio_of_the_moduli_decides() -> None:
    near, far, deviation = {}, {}, {}
    for ratio in (1.2, 2.0, 4.0, 8.0):
        near[ratio], far[ratio], deviation[ratio] = errors_of(
            with_moduli(None, (ratio * 2.5, 0.35 * ratio * 2.5))
        )
    says(GUIDE, "| 1.2 | {} to {} % | {} to {} % |", *near[1.2], *far[1.2])
    says(GUIDE, "| 2 | {} to {} % | {} to {} % |", *near[2.0], *far[2.0])
    says(GUIDE, "| 4 | {} to {} % | {} % |", *near[4.0], far[4.0][1])
    says(GUIDE, "| 8 (shipped) | {} to {} % | {} to {} % |", *near[8.0], *far[8.0])
    says(
        GUIDE,
        "The upper bounds have standard errors of up to {} %. Guessing",
        max(deviation.values()),
    )
    mixed, mixed_far, _ = errors_of(with_moduli(between(COAL.values()), between(ROCK.values())))
    says(
        GUIDE,
        "| both spread as in published tables | {} to {} % | {} % |",
        *mixed,
        mixed_far[1],
    )


def test_published_moduli() -> None:
    says(
        GUIDE,
        "Published moduli of coal are {} GPa (mean of three specimens, Shock Vib. "
        "2021:8854538, Table 5), {} (Adv. Civ. Eng.",
        COAL["three specimens"],
        COAL["panel 8939"],
    )
    says(
        GUIDE,
        "Table 2), {} (Sci. Rep. 14, 2024, doi 10.1038/s41598-024-79523-8, Table 1, from "
        "bulk and shear modulus) and",
        COAL["roof cutting"],
    )
    says(GUIDE, "and {} GPa (Shock Vib. 2021:7649459, Table 4)", COAL["Shangwan"])
    mudstone, medium, fine, *others = ROCK.values()
    says(
        GUIDE,
        "sandy mudstone of {}, sandstone of {} and {}, and roof and floor of {} to {} GPa",
        mudstone,
        medium,
        fine,
        min(others),
        max(others),
    )
    ratios = [modulus / COAL[name.split(", ")[1]] for name, modulus in ROCK.items()]
    says(GUIDE, "the rock has {} to {} times the modulus of the coal", min(ratios), max(ratios))


@pytest.mark.slow
def test_an_almost_exact_bound_excludes_nothing() -> None:
    """Of two classes that differ by their density alone impulse, contact time and
    interval leave the bound near zero.
    """
    alike = with_moduli(None, (2.5, 0.8))
    assert least_error(alike) < 5e-4
    says(GUIDE, "all nearly exactly, is less than {} %", 0.05)
    assert least_error(with_moduli(None, (20.0, 7.0))) < 5e-4
    says(
        RECOGNITION,
        "For coal and gangue the bound is less than {} %: a test against it finds no leak",
        0.05,
    )


# what elastic contacts leave out


def test_peak_pressures() -> None:
    falls = falls_of_sweep(vi.studies.load_sweep("signals:coal-gangue", 4096))
    force = falls.impulse / falls.duration * float(hertz_pulse(np.array([0.5]))[0])
    effective = 1.0 / ((1.0 - 0.28**2) / falls.modulus + (1.0 - 0.3**2) / 210e9)
    pressure = (6.0 * force * effective**2 / (np.pi**3 * falls.radius**2)) ** (1.0 / 3.0)
    coal, gangue = (1e-9 * pressure[falls.classes == name] for name in ("coal", "gangue"))
    says(
        GUIDE, "Hertz's peak pressure of the median fall of coal is {} GPa", float(np.median(coal))
    )
    says(GUIDE, "that of gangue is {} GPa", float(np.median(gangue)))
    assert gangue.min() > 1.6 * 0.235  # GPa, first yield of steel of 235 MPa


# the small study


@pytest.mark.slow
def test_the_demonstration_with_64_falls(tmp_path: Path) -> None:
    folder = vi.studies.run_sweep(
        vi.studies.load_sweep("signals:coal-gangue", 64), tmp_path / "falls"
    )
    found = vi.recognition.recognise(folder, seeds=1, folds=2, workers=1)
    best = found.scores[found.best].balanced_accuracy
    says(
        GUIDE,
        "the balanced accuracy of the best classifier is {} %, with an interval from {} to {} %",
        *(100.0 * one for one in (best.value, best.low, best.high)),
    )
    assert found.bayes_error is not None
    assert found.bayes_error < 5e-4
