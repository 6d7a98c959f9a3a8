"""Every registered feature: what it says of itself, and a number or a reason for every signal."""

from __future__ import annotations

import re
import warnings
from importlib.metadata import EntryPoint

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.signals import registry as module
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.feature_table import features_at_rest
from vibroimpact.signals.reasons import Reason

FEATURES = vi.signals.signal_features()
RATE, SAMPLES = 10e3, 512
TIME = np.arange(SAMPLES) / RATE
COUNTS = {"packets", "impulses"}


def ringing(seed: int = 0) -> np.ndarray:
    """Return impacts of modes that ring, three bounces in a record, with noise: every
    feature has a value.
    """
    random = np.random.default_rng(seed)
    signal = 1e-3 * random.standard_normal(SAMPLES)
    for at, peak in ((0.004, 1.0), (0.022, 0.6), (0.035, 0.3)):
        since = TIME - at
        signal += peak * np.where(
            since >= 0.0,
            np.exp(-np.maximum(since, 0.0) / 1e-3) * np.sin(2.0 * np.pi * 900.0 * since),
            0.0,
        )
    return signal


def described(values: np.ndarray, rate: float = RATE, **settings: float) -> vi.signals.FeatureTable:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = vi.signals.feature_table(values, rate, **settings)
    # a number, or a reason that is a sentence
    assert np.array_equal(np.isfinite(table.values), table.reasons == Reason.NONE)
    assert not np.isinf(table.values).any()
    assert Reason.UNDEFINED not in table.reasons
    return table


def test_there_are_some_forty_and_more() -> None:
    assert len(FEATURES) >= 40


@pytest.mark.parametrize("feature", FEATURES.values(), ids=FEATURES)
def test_a_feature_says_what_it_is(feature: Feature) -> None:
    assert re.fullmatch(r"[a-z][a-zA-Z0-9_]*", feature.name)
    assert feature.meaning
    assert feature.equation
    assert feature.source
    assert not feature.meaning.endswith(".")
    assert feature.source.startswith(("ISO", "IEC", "ASTM", "of this program")) or re.search(
        r"\b(19|20)\d\d\b", feature.source
    )
    assert feature.unit in ("1", "s", "Hz", "1/s")
    assert feature.degree in (0, 1, 2)


def test_every_feature_has_a_value_of_a_bouncing_ball() -> None:
    table = described(ringing()[None])
    assert table.lacking(0) == {}


@pytest.mark.parametrize("factor", [3.7, 1e-150, 1e150, -1.0])
def test_amplitudes_scale_and_shapes_do_not(factor: float) -> None:
    signals = np.stack([ringing(seed) for seed in range(5)])
    before, after = described(signals), described(factor * signals)
    signed = {"mean": 1, "skewness": 1}
    # which see the upper side
    one_sided = {"impulses", "zero_crossing_rate"} if factor < 0.0 else set()
    for name, feature in FEATURES.items():
        if name in one_sided or abs(feature.degree * np.log10(abs(factor))) > 290:
            continue
        expected = before[name] * (
            factor if name in signed and feature.degree else abs(factor) ** feature.degree
        )
        expected = expected * (np.sign(factor) if name == "skewness" else 1.0)
        np.testing.assert_allclose(
            after[name],
            expected,
            rtol=1e-9,
            atol=1e-12 * abs(factor) ** feature.degree,
            err_msg=name,
        )


def test_features_without_offset_do_not_feel_it() -> None:
    signals = np.stack([ringing(seed) for seed in range(5)])
    before, after = at_rest(signals), at_rest(signals + 5.0)
    changed = {
        name
        for name in FEATURES
        if not np.allclose(before[name], after[name], rtol=1e-9, equal_nan=True)
    }
    assert changed.isdisjoint(name for name, feature in FEATURES.items() if feature.offset_free)
    # and what is said to feel it does, but for what no offset of this signal changes
    assert {name for name, feature in FEATURES.items() if not feature.offset_free} - changed <= {
        "clipped_part"
    }


def at_rest(signals: np.ndarray) -> dict[str, np.ndarray]:
    values, _ = features_at_rest(signals, signals, RATE, FEATURES, None, 5e-3)
    return dict(zip(FEATURES, values.T, strict=True))


@pytest.mark.parametrize(
    "baseline", [5.0, -0.3, np.linspace(-2.0, 2.0, SAMPLES), 3.0 * np.exp(-TIME / 0.02) - 1.0]
)
@pytest.mark.parametrize("feature", FEATURES)
def test_no_feature_feels_a_baseline(feature: str, baseline: float | np.ndarray) -> None:
    quiet = np.stack([ringing(seed) for seed in range(5)])
    before, after = described(quiet, threshold=0.05), described(quiet + baseline, threshold=0.05)
    assert not before.offset.any()
    np.testing.assert_allclose(after.offset, np.mean(baseline), atol=5e-3)
    np.testing.assert_allclose(after.drift, np.ptp(baseline), atol=0.05)
    scale = np.abs(before[feature]).max()
    loose = {"zero_crossing_rate": 0.5, "skewness": 0.1, "mean": 3.0}.get(feature, 0.06)
    np.testing.assert_allclose(
        after[feature], before[feature], atol=loose * scale + 1e-3, err_msg=feature
    )


def test_time_counts_from_the_onset() -> None:
    signal = ringing()
    signal[300:] = 0.0
    signal[:40] = 0.0
    before, after = described(signal[None]), described(np.roll(signal, 100)[None])
    same = (
        "rise_time",
        "duration",
        "decay_time",
        "temporal_centroid",
        "packets",
        "impulses",
        "bounce_interval",
        "rms",
        "spectral_centroid",
    )
    for name in same:
        np.testing.assert_allclose(after[name], before[name], rtol=1e-9, err_msg=name)


def test_signals_do_not_know_each_other() -> None:
    signals = np.stack([ringing(seed) for seed in range(40)])
    signals[3], signals[7], signals[11] = np.nan, 0.0, np.arange(SAMPLES)
    together = described(signals)
    for number in (0, 3, 7, 11, 39):
        np.testing.assert_allclose(
            described(signals[number : number + 1]).values[0], together.values[number], rtol=1e-12
        )


@pytest.mark.parametrize(
    "kind", ["int8", "int16", "int64", "uint8", "uint64", "float16", "float32", "bool"]
)
def test_types_are_numbers(kind: str) -> None:
    values = (100 * np.abs(ringing())).astype(kind)
    np.testing.assert_array_equal(
        described(values[None]).values, described(values[None].astype(float)).values
    )


def test_of_a_constant_amplitudes_are_known_and_deviations_are_not() -> None:
    table = described(np.full((1, SAMPLES), -0.1))
    assert table["peak"][0] == 0.1
    assert table["rms"][0] == pytest.approx(0.1, rel=1e-14)
    assert table["standard_deviation"][0] == table["peak_to_peak"][0] == 0.0
    assert (
        table.lacking(0)["kurtosis"] == table.lacking(0)["skewness"] == "all samples are the same"
    )


def test_silence_has_no_shape() -> None:
    table = described(np.zeros((1, SAMPLES)))
    for name in (
        "crest_factor",
        "spectral_centroid",
        "wavelet_packet_1",
        "cepstrum_1",
        "intrinsic_mode_1",
        "rise_time",
        "decay_time",
    ):
        assert table.lacking(0)[name] == "all samples are the same", name
    assert table["peak"][0] == table["energy"][0] == table["packets"][0] == 0.0


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_sample_that_is_not_finite_spoils_its_signal_alone(wrong: float) -> None:
    signals = np.stack([ringing(0), ringing(1)])
    signals[0, 77] = wrong
    table = described(signals)
    assert set(table.lacking(0).values()) == {"a sample is not a finite number"}
    assert table.lacking(1) == {}


def test_without_samples_there_is_nothing() -> None:
    assert set(described(np.empty((2, 0))).lacking(1).values()) == {"there are no samples"}
    assert described(np.empty((0, 100))).values.shape == (0, len(FEATURES))


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 7, 8, 15, 16, 63, 64, 79, 80, 255, 256])
def test_short_signals_lack_what_they_are_too_short_for(samples: int) -> None:
    table = described(ringing()[None, 40 : 40 + samples])
    for name, feature in FEATURES.items():
        assert (table.lacking(0).get(name) == "there are too few samples") == (
            samples < feature.least
        ), name


@pytest.mark.parametrize("scale", [1e300, 1e-300, 5e-324, 1.7e308])
def test_extreme_scales(scale: float) -> None:
    table = described(scale * np.clip(ringing()[None], -1.0, 1.0))
    degrees = {name: FEATURES[name].degree for name in table.lacking(0)}
    if scale != 5e-324:  # of which little is left
        assert 0 not in degrees.values()
        assert set(table.lacking(0).values()) == {
            "the value is beyond the range of floating-point numbers"
        }
        assert table["peak"][0] == pytest.approx(scale * np.abs(ringing()).max(), rel=1e-12)


def test_clipped_signals_are_told() -> None:
    signal = ringing()
    assert described(signal[None])["clipped_part"][0] == 0.0
    clipped = np.clip(signal, -0.2, 0.2)
    at_limit = np.flatnonzero(np.abs(clipped) == 0.2)
    part = described(clipped[None])["clipped_part"][0]
    assert 0.0 < part <= len(at_limit) / SAMPLES


@pytest.mark.parametrize("rate", [1e-300, 1.0, 1e300])
def test_rates_of_any_size(rate: float) -> None:
    table = described(ringing()[None], rate)
    assert table["rise_time"][0] * rate == pytest.approx(
        described(ringing()[None])["rise_time"][0] * RATE, rel=1e-9
    )


def test_a_threshold_that_is_given_is_that_of_the_signal() -> None:
    table = described(ringing()[None], threshold=0.3)
    assert table["packets"][0] == 2.0
    silent = described(ringing()[None], threshold=2.0)
    assert silent["packets"][0] == silent["impulses"][0] == 0.0
    assert silent.lacking(0)["rise_time"] == "the envelope stays below the threshold"
    assert silent.lacking(0)["peak_ratio"] == "there are fewer than two packets"
    assert described(1e300 * ringing()[None], threshold=1e-300)["packets"][0] == 1.0
    scaled = described(1e200 * ringing()[None], threshold=0.3e200)
    assert scaled["packets"][0] == 2.0
    assert scaled["duration"] == pytest.approx(table["duration"])


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    vi.signals.feature_table(
        np.ones((5, 2**14)), RATE, ["rms"], progress=lambda done, of: told.append((done, of))
    )
    assert told == [(2, 5), (4, 5), (5, 5)]


def test_chosen_features_are_those_of_all() -> None:
    every, some = (
        vi.signals.feature_table(ringing()[None], RATE),
        vi.signals.feature_table(ringing()[None], RATE, ["kurtosis", "peak"], unit="V"),
    )
    assert some.names == ("kurtosis", "peak")
    assert some.units == ("1", "V")
    assert some.values[0].tolist() == [every["kurtosis"][0], every["peak"][0]]


@pytest.mark.parametrize(
    ("values", "settings", "message"),
    [
        (np.zeros(5), {}, "1 dimensions; give a table of shape"),
        (np.zeros((1, 5), dtype=complex), {}, "complex128; they must be real numbers"),
        ([["a", "b"]], {}, "must be real numbers"),
        ([[1.0], [1.0, 2.0]], {}, "rows of different lengths"),
        (
            np.zeros((1, 5)),
            {"rate": 0.0},
            "the rate is 0.0; it must be a finite number of Hz above 0",
        ),
        (np.zeros((1, 5)), {"rate": np.nan}, "the rate is nan"),
        (np.zeros((1, 5)), {"rate": "10 kHz"}, "the rate is"),
        (np.zeros((1, 5)), {"names": ["kurtossis"]}, 'Did you mean "kurtosis"'),
        (np.zeros((1, 5)), {"threshold": 0.0}, "the threshold is 0; it must be finite and above 0"),
        (np.zeros((1, 5)), {"threshold": np.nan}, "the threshold is nan"),
        (np.zeros((1, 5)), {"dead_time": -1.0}, "the dead time is -1 s"),
    ],
)
def test_what_is_not_allowed_is_said(values: object, settings: dict, message: str) -> None:
    with pytest.raises(vi.InputError, match=re.escape(message)):
        vi.signals.feature_table(values, **{"rate": 1.0, **settings})


def first_sample(block: Block) -> np.ndarray:
    return block.value[:, :1]


FOREIGN = Family(
    (
        Feature(
            name="first_sample", meaning="first sample", equation="x[0]", source="nobody", degree=1
        ),
    ),
    first_sample,
)
USURPER = Family((Feature(name="rms", meaning="", equation="", source=""),), first_sample)


def bring(monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    monkeypatch.setattr(
        module, "entry_points", lambda group: [EntryPoint(name="mine", value=value, group=group)]
    )
    module.families.cache_clear()


@pytest.fixture
def _own_features() -> object:
    yield
    module.families.cache_clear()


@pytest.mark.usefixtures("_own_features")
def test_features_are_brought_by_an_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    bring(monkeypatch, f"{__name__}:FOREIGN")
    assert vi.signals.feature_table([[3.0, 1.0]], 1.0, ["first_sample"], unit="N")[
        "first_sample"
    ].tolist() == [3.0]


@pytest.mark.usefixtures("_own_features")
@pytest.mark.parametrize(
    ("value", "message"),
    [
        (f"{__name__}:USURPER", 'two features are called "rms"'),
        ("no.such:thing", "can't be loaded"),
        ("math:pi", "is not a Family"),
    ],
)
def test_a_broken_entry_point_is_named(
    monkeypatch: pytest.MonkeyPatch, value: str, message: str
) -> None:
    bring(monkeypatch, value)
    with pytest.raises(vi.InputError, match=message):
        vi.signals.signal_features()
