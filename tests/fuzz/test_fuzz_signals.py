"""10,000 hostile signals: every feature is a number or a named reason, without a warning."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.signals.reasons import Reason

AT_EACH_LENGTH = 200


def hostile(random: np.random.Generator, number: int, samples: int) -> np.ndarray:
    """Return signals of all kinds that a record can be, at all scales."""
    time = np.arange(samples)
    kinds = [
        lambda: random.standard_normal(samples),
        lambda: np.full(samples, random.standard_normal()),
        lambda: np.zeros(samples),
        lambda: (time == random.integers(max(samples, 1))).astype(float),
        lambda: np.sin(2.0 * np.pi * random.random() * time + random.random()),
        lambda: np.exp(-time * random.random()) * np.sin(time * random.random() * 3.0),
        lambda: np.clip(3.0 * random.standard_normal(samples), -1.0, 1.0),
        lambda: np.round(3.0 * random.standard_normal(samples)),
        lambda: np.sign(np.sin(time * random.random())),
        lambda: random.standard_cauchy(samples),
        lambda: random.standard_normal(samples).cumsum(),
        lambda: 1e12 + random.standard_normal(samples),
        lambda: 1.0 + 1e-16 * random.standard_normal(samples),
        lambda: time * random.standard_normal(),
        lambda: (-1.0) ** time,
        lambda: np.where(random.random(samples) < 0.02, random.standard_normal(samples), 0.0),
        lambda: np.where(random.random(samples) < 0.5, 1e-300, 1e300),
        lambda: np.maximum(np.sin(time * random.random()), 0.0) ** 40,
        lambda: random.choice([np.nan, np.inf, -np.inf, 0.0, 1.0], samples),
        lambda: np.where(time == samples // 2, np.nan, 1.0),
    ]
    scales = 10.0 ** random.choice([0, 0, 0, -3, 3, -150, 150, -300, 300, -320, 307], number)
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return np.array([scale * kinds[random.integers(len(kinds))]() for scale in scales]).reshape(
            number, samples
        )


@pytest.mark.parametrize("lengths", [10, pytest.param(50, marks=pytest.mark.slow)])
def test_hostile_signals(lengths: int) -> None:
    random = np.random.default_rng(2024)
    seen = set()
    for samples in [0, 1, 2, 3, 5, 8, *random.integers(4, 1500, lengths - 6)]:
        signals = hostile(random, AT_EACH_LENGTH, int(samples))
        settings = {"dead_time": float(random.choice([0.0, 5e-3, 1e9]))}
        if random.random() < 0.5:
            settings["threshold"] = float(10.0 ** random.choice([-300, -3, 0, 300]))
        table = vi.signals.feature_table(
            signals, float(10.0 ** random.choice([-300, 0, 4, 6, 300])), **settings
        )
        assert np.array_equal(np.isfinite(table.values), table.reasons == Reason.NONE)
        seen |= set(table.reasons.ravel().tolist())
        shares = [
            name
            for name in table.names
            if name.startswith(
                ("octave", "wavelet", "spectral_entropy", "spectral_flatness", "clipped")
            )
        ]
        for name in shares:
            there = table[name][np.isfinite(table[name])]
            assert np.all((there >= 0.0) & (there <= 1.0 + 1e-9)), name
        for name in (
            "kurtosis",
            "crest_factor",
            "shape_factor",
            "impulse_factor",
            "clearance_factor",
        ):
            there = table[name][np.isfinite(table[name])]
            assert np.all(there >= 1.0 - 1e-9), name
    # all reasons occur but the one that no feature of ours gives
    assert seen == set(Reason) - {Reason.UNDEFINED}
