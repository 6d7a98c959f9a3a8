"""Records of a test beside the simulation: of an impact that the program simulates, and
of a hammer by a superposition of SciPy.
"""

from __future__ import annotations

import csv
import json
import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from hammer_test import RATE, SOFT, TABLE, a_case, hammered, knocked, knocked_case, records
from support import plain_case
from vibroimpact.signals.decay.find import DecayMode
from vibroimpact.signals.estimate import Estimate
from vibroimpact.signals.record import Record
from vibroimpact.test_analysis.acquired import acquired_of
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.flat_tops import clipped_count
from vibroimpact.test_analysis.mode_pairs import paired
from vibroimpact.test_analysis.shared_differences import shared_differences

DROP = {"drop": {"height": 0.03, "position": TABLE["drop"]["position"]}}


@cache
def fallen() -> tuple[float, tuple[Record, ...]]:
    """First touch [s], and the noisy records of a ball that falls from 3 cm at another
    rate than the case says, one upside down.
    """
    sensors = [{**one, "rate": RATE} for one in TABLE["sensors"]]
    response = vi.simulate(vi.case_of({**TABLE, **DROP, "sensors": sensors, "run": {"impacts": 2}}))
    value = np.stack([one.value for one in response.signals().values()])
    touch, after = response.impacts["time_s"][:2]
    value = value[:, : int(after * RATE) - 40] * [[-1.0], [1.0]]
    return float(touch), tuple(records(value, 40.0, seed=7))


@cache
def dropped() -> Correlation:
    return vi.test_analysis.correlate(vi.case_of({**TABLE, **DROP}), fallen()[1], window=0.15)


@cache
def struck(damping: float = 0.008) -> Correlation:
    """Two blows, and the records of a plate of damping 0.008, beside the case with another."""
    force, value = hammered((0.02, 0.24), 0.45)
    return vi.test_analysis.correlate(
        a_case(damping=damping), records(value), force=Record("hammer", force, RATE, "N")
    )


@pytest.mark.slow
def test_the_delay_is_found_to_a_part_of_a_sample() -> None:
    touch, _ = fallen()
    assert dropped().first_touch * RATE == pytest.approx(touch * RATE, abs=0.01)
    assert abs(touch * RATE - round(touch * RATE)) > 0.05  # not at a sample
    assert dropped().polarity.tolist() == [-1.0, 1.0]
    assert (dropped().coefficient > 0.995).all()


def test_what_is_left_of_an_impact_is_the_noise() -> None:
    found = dropped()
    assert (found.relative_residual < 0.015).all()
    assert found.scale == pytest.approx(np.ones(2), abs=0.01)
    assert (found.frac > 0.999).all()
    assert found.hits == 0
    assert found.coherence is None
    words = " ".join(found.doubts)
    assert "12800 samples per second, and the case specifies 25600" in words
    assert 'the record "a1" has inverted polarity' in words


@pytest.mark.parametrize("found", [dropped, struck])
def test_frequencies_and_damping_are_those_of_the_case(found: Callable[[], Correlation]) -> None:
    pairs = [pair for pair in found().modes if pair.measured is not None]
    assert len(pairs) >= 7
    inside = []
    for pair in pairs:
        assert pair.measured is not None
        assert pair.number is not None
        assert abs(pair.frequency_difference) < max(
            1e-4, 3.5 * pair.measured.frequency.deviation / pair.frequency
        )
        assert (
            abs(np.log(pair.measured.damping_ratio.value / 0.008))
            < 3.5 * pair.measured.damping_ratio.deviation
        )
        inside.append(
            pair.measured.damping_ratio.interval[0]
            <= 0.008
            <= pair.measured.damping_ratio.interval[1]
        )
    assert np.mean(inside) > 0.7
    assert min(abs(pair.frequency_difference) for pair in pairs) < 1e-5


def test_a_hammer_by_another_superposition() -> None:
    found = struck()
    assert found.hits == 2
    assert abs(found.delay) * RATE < 0.01
    assert (found.relative_residual < 0.015).all()
    assert found.scale == pytest.approx(np.ones(2), abs=0.005)
    assert (found.octave_frac[:, :3] > 0.999).all()  # where the force has much
    assert found.octaves[1] == pytest.approx((353.55, 707.11), rel=1e-4)
    assert found.coherence is not None
    assert (found.coherence[:, found.frequency < 700.0] > 0.99).all()
    assert any(
        "the spectrum of the force has fallen by 20 dB at 1" in doubt for doubt in found.doubts
    )


def test_frequency_responses_are_those_of_the_modes() -> None:
    """Beside the first resonance, where the window smears little: a/F is the sum over
    modes, and what is left out of it.
    """
    from vibroimpact.cases.build import problem_of

    modes = problem_of(a_case()).plate.modes
    assert modes is not None
    found = struck()
    omega = 2.0 * np.pi * found.frequency[:, None]
    resonances = omega**2 / (
        modes.angular_frequencies**2
        - omega**2
        + 2j * modes.damping_ratios * modes.angular_frequencies * omega
    )
    for number, name in enumerate(("a1", "a2")):
        response = (
            resonances @ (modes.contact * modes.points[name][:, 2])
            + omega[:, 0] ** 2 * modes.residuals[name][2]
        )
        beside = (found.frequency > 550.0) & (found.frequency < 650.0)
        assert np.abs(found.measured_response[number, beside]) == pytest.approx(
            np.abs(response[beside]), rel=0.05
        )


def test_a_wrong_damping_is_seen() -> None:
    found = struck(0.02)
    assert (found.relative_residual > 0.3).all()
    assert (found.octave_frac[:, 1] < 0.9).all()
    measured = [pair.measured for pair in found.modes if pair.measured is not None]
    assert measured[0].damping_ratio.value == pytest.approx(0.008, rel=0.01)
    assert found.modes[0].damping_ratio == 0.02


def test_the_damping_is_put_into_the_case() -> None:
    from vibroimpact.test_analysis.mode_pairs import damping_field

    found = struck(0.02)
    field = tomllib.loads(damping_field(found.modes))["damping"]
    assert (struck(0.008).relative_residual < 0.015).all()
    force, value = hammered((0.02, 0.24), 0.45)
    again = vi.test_analysis.correlate(
        a_case(damping=field),
        records(value),
        force=Record("hammer", force, RATE, "N"),
        band=(300.0, 1100.0),
    )
    assert (again.relative_residual < 0.015).all()


def test_what_a_hammer_may_do() -> None:
    force, value = hammered((0.02, 0.024), 0.2)
    most = 0.4 * np.abs(value).max()
    clipped = [replace(one, value=np.clip(one.value, -most, most)) for one in records(value)]
    found = vi.test_analysis.correlate(
        a_case(), clipped, force=Record("hammer", force, RATE, "N"), band=(300.0, 1100.0)
    )
    words = " ".join(found.doubts)
    assert "double hit of the hammer: there are 2 pulses of force in 1 hits" in words
    assert 'the record "a' in words
    assert "is clipped" in words
    assert found.hits == 1


def test_channels_that_were_not_sampled_together_are_told() -> None:
    force, value = hammered((0.02,), 0.2)
    late = records(np.roll(value, 3, axis=1))
    found = vi.test_analysis.correlate(
        a_case(), late, force=Record("hammer", force, RATE, "N"), band=(300.0, 1100.0)
    )
    assert found.delay * RATE == pytest.approx(3.0, abs=0.01)
    assert "samples later than computed from the force" in " ".join(found.doubts)


HIT = hammered((0.02,), 0.2)
LOW = (300.0, 1700.0)


@pytest.mark.parametrize("shift", [-14, -6, 3, 5, 9, 13, 22, 40])
@pytest.mark.parametrize("late", [0, 1])
@pytest.mark.parametrize("with_force", [True, False])
def test_a_late_channel_is_named_and_the_right_one_is_not_inverted(
    shift: int, late: int, with_force: bool
) -> None:
    """With one common delay the right record was said to be inverted where half a period
    of it was lost.
    """
    force, value = HIT
    moved = value.copy()
    moved[late] = np.roll(moved[late], shift)
    if with_force:
        found = vi.test_analysis.correlate(
            a_case(), records(moved), force=Record("hammer", force, RATE, "N"), band=LOW
        )
    else:
        _, made = fallen()
        shifted = [
            replace(one, value=np.roll(one.value, shift)) if number == late else one
            for number, one in enumerate(made)
        ]
        found = vi.test_analysis.correlate(vi.case_of({**TABLE, **DROP}), shifted, window=0.1)
    signs = [1.0, 1.0] if with_force else [-1.0, 1.0]
    assert found.polarity.tolist() == signs
    said = [doubt for doubt in found.doubts if "than the others and its simulation" in doubt]
    assert len(said) == 1
    other = found.skew[late] - found.skew[1 - late]
    assert other * RATE == pytest.approx(shift, abs=0.1)
    if with_force:
        assert found.skew[1 - late] == 0.0
        assert (
            f'the record "a{late + 1}" comes {abs(shift)} samples '
            f"{'later' if shift > 0 else 'earlier'}" in said[0]
        )
        assert abs(found.delay * RATE) < 0.1
        assert found.frac[1 - late] > 0.97
    assert not any("inverted" in doubt for doubt in found.doubts if with_force)


def test_channels_that_were_sampled_together_have_no_skew() -> None:
    for found in (struck(), struck(0.02), dropped()):
        assert not found.skew.any()
        assert not any("than the others" in doubt for doubt in found.doubts)


def test_records_of_a_low_rate_are_aligned_by_64_samples() -> None:
    """Which take longer than 5 ms."""
    plate = {
        "size": [0.5, 0.4, 0.01],
        "material": "steel",
        "model": "elastic",
        "modes": 10,
        "supports": "clamped",
        "damping": 0.01,
    }
    sensors = [{"name": "a", "position": [0.1, 0.03], "rate": 6e3}]
    drop = {"speed": 1.0, "position": [0.02, 0.01]}
    case = vi.case_of(
        plain_case(
            plate=plate, drop=drop, contact={"law": "hertz"}, run={"duration": 0.2}, sensors=sensors
        )
    )
    found = vi.test_analysis.correlate(
        case, [Record("a", 1.3 * vi.simulate(case).signals()["a"].value, 6e3, "m/s2")], window=0.05
    )
    assert found.aligned == pytest.approx(64.0 / 6e3)
    assert any("times the simulation in the first 10.7 ms" in doubt for doubt in found.doubts), (
        found.doubts
    )
    assert "aligned in time by their first 10.7 ms" in found.report.charts[0].caption


@pytest.mark.parametrize("gain", [0.9, 0.94, 1.06, 1.1, 2.0])
def test_a_gain_that_is_off_is_doubted(gain: float) -> None:
    force, value = HIT
    hammer = Record("hammer", force, RATE, "N")
    one = vi.test_analysis.correlate(
        a_case(), records(value * [[1.0], [gain]]), force=hammer, band=LOW
    )
    (said,) = [doubt for doubt in one.doubts if "times" in doubt]
    assert f'the record "a2" is {gain:.3g} times its simulation in the first 5 ms' in said
    every = vi.test_analysis.correlate(a_case(), records(value * gain), force=hammer, band=LOW)
    (said,) = [doubt for doubt in every.doubts if "times" in doubt]
    assert f"all records are {gain:.3g} times the simulation" in said
    assert "the calibration of the force" in said


@pytest.mark.parametrize("gain", [0.97, 1.0, 1.03])
def test_a_gain_within_what_sensors_have_is_not(gain: float) -> None:
    force, value = HIT
    found = vi.test_analysis.correlate(
        a_case(),
        records(value * [[1.0], [gain]]),
        force=Record("hammer", force, RATE, "N"),
        band=LOW,
    )
    assert not any("times" in doubt for doubt in found.doubts)


def test_the_band_ends_where_the_force_does() -> None:
    """Through the zeros of the force's spectrum it is noise and leakage that are compared."""
    for damping in (0.008, 0.02):
        found, whole = struck(damping), _whole(damping)
        assert found.band[1] == pytest.approx(1400.0, rel=0.1)
        assert whole.band[1] > 3000.0
        assert {pair.number for pair in found.modes if pair.measured} == {
            pair.number for pair in whole.modes if pair.measured
        }
        assert any("where the band ends" in doubt for doubt in found.doubts)
    assert (struck(0.02).frac > _whole(0.02).frac).all()
    assert np.nanmin(struck().octave_frac) > 0.999
    assert np.nanmin(_whole(0.008).octave_frac) < 0.95  # though the model is right
    assert (struck().frac > 0.999).all()


def _whole(damping: float) -> Correlation:
    force, value = hammered((0.02, 0.24), 0.45)
    hammer = Record("hammer", force, RATE, "N")
    return vi.test_analysis.correlate(
        a_case(damping=damping),
        records(value),
        force=hammer,
        band=(struck(damping).band[0], 3100.0),
    )


@pytest.mark.parametrize("hits", [(0.02, 0.023), (0.02, 0.024, 0.24, 0.247)])
def test_the_band_of_a_double_hit_is_that_of_its_pulses(hits: tuple[float, ...]) -> None:
    """The zeros that two pulses have by their distance begin below the band, which then
    was taken whole, with those of each pulse.
    """
    force, value = hammered(hits, 0.45)
    for damping in (0.008, 0.02):
        found = vi.test_analysis.correlate(
            a_case(damping=damping), records(value), force=Record("hammer", force, RATE, "N")
        )
        # of a half sine of 1 ms the spectrum falls by 20 dB at 1.30 kHz
        assert found.band[1] == pytest.approx(1300.0, rel=0.02)
        assert any("double hit" in doubt for doubt in found.doubts)
        assert (found.damped_frac > 0.995).all()
        assert (found.frac > (0.995 if damping == 0.008 else 0.8)).all()


def fallen_by_20_dB(force: Record) -> float:
    """Where the spectrum of one pulse has fallen by 20 dB [Hz]; infinite if nowhere."""
    spectrum = np.abs(np.fft.rfft(force.value, 1 << 18))
    low = np.flatnonzero(spectrum < 0.1 * spectrum[0])
    return low[0] * force.rate / (1 << 18) if len(low) else np.inf


@pytest.mark.slow
@pytest.mark.parametrize("with_force", [True, False])
@pytest.mark.parametrize(
    ("radius", "material"),
    [
        (0.016, "steel"),
        (0.016, SOFT),
        (0.03, SOFT),
    ],
)
def test_where_damping_alone_differs_it_is_said(
    radius: float, material: Any, with_force: bool
) -> None:
    """FRAC is low rightly, and not for zeros of the force; it is not the frequencies
    either, nor a sensitivity.
    """
    motions, force = knocked(knocked_case(radius, material))
    found = vi.test_analysis.correlate(
        knocked_case(radius, material, damping=0.02), motions, force=force if with_force else None
    )
    assert found.band[1] == pytest.approx(min(11296.0, fallen_by_20_dB(force)), rel=0.01)
    assert (found.frac < 0.85).all()
    assert found.scaled_frac.tolist() == found.frac.tolist()
    assert (found.damped_frac > 0.995).all()
    said = [doubt for doubt in found.doubts if "spectrum" not in doubt]
    assert len(said) == 1
    assert "the frequencies agree within 0.2 %, and the damping does not" in said[0]
    assert "modes are 0.25 times the case's" in said[0]
    assert f"FRAC is {found.damped_frac.min():.3f}" in said[0]
    same = vi.test_analysis.correlate(
        knocked_case(radius, material), motions, force=force if with_force else None
    )
    assert (same.frac > 0.995).all()
    assert same.damped_frac.tolist() == same.frac.tolist()
    assert not any("damping" in doubt for doubt in same.doubts)


def test_a_case_without_damping() -> None:
    motions, force = knocked(knocked_case(0.016))
    found = vi.test_analysis.correlate(knocked_case(0.016, damping=0.0), motions, force=force)
    assert any(
        "modes are 0.0" in doubt and "and the case has no damping" in doubt
        for doubt in found.doubts
    )
    assert (found.damped_frac > 0.995).all()


@pytest.mark.slow
@pytest.mark.parametrize("with_force", [True, False])
def test_a_modulus_that_is_off_is_told_of_records_too(with_force: bool) -> None:
    """Frequencies are proportional to its square root; with them the damping can be told apart."""
    motions, force = knocked(knocked_case(0.016, modulus=1.03 * 206e9))
    found = vi.test_analysis.correlate(
        knocked_case(0.016, damping=0.01), motions, force=force if with_force else None
    )
    (said,) = (doubt for doubt in found.doubts if "Young's modulus over density" in doubt)
    assert "modes are 1.5 % higher" in said
    assert "differs from the case's by +3 %" in said
    assert any("modes are 0.5 times the case's" in doubt for doubt in found.doubts)
    assert (found.frac < 0.6).all()
    assert (found.scaled_frac > 0.85).all()
    assert (found.damped_frac > 0.99).all()
    # modes are dense above: some were paired with a neighbour
    assert all(
        0.012 < pair.frequency_difference < 0.018
        for pair in found.modes
        if pair.number and pair.measured
    )


CLIPPED = ("equal", "pairs", "noise", "offset", "steps")


@pytest.mark.parametrize("kind", CLIPPED)
def test_clipping_of_every_kind_is_found(kind: str) -> None:
    """It was found in runs of three equal samples alone."""
    random = np.random.default_rng(3)
    _, value = HIT
    value = value / np.abs(value).max(axis=1, keepdims=True)
    if kind == "pairs":  # on many peaks, of fast vibration
        value = np.sin(0.9 * np.pi * np.arange(400) / 3.0 + 0.3)[None] * np.exp(
            -np.arange(400) / 300.0
        )
    found = np.clip(value, -0.6, 0.6)
    if kind == "noise":
        found += 3e-4 * random.standard_normal(found.shape)
    if kind == "offset":
        found += 0.2
    if kind == "steps":
        found = np.round(200.0 * found) / 200.0
    for one in found:
        level = 0.2 if kind == "offset" else 0.0
        assert clipped_count(one - level, one, one[:200] - level) > 0


@pytest.mark.parametrize("common", [0.0, 0.045, 0.08, -0.08])
def test_modes_that_are_all_off_by_more_than_their_distance_are_paired(common: float) -> None:
    """By a wrong modulus each mode is nearer to a neighbour than to its own: what all
    have in common is sought.
    """
    frequencies = np.array(
        [210.0, 268.0, 352.0, 410.0, 455.0, 520.0, 611.0, 645.0, 733.0, 808.0, 861.0, 948.0]
    )
    seen = [row for row in range(12) if row not in (3, 8)]
    off = common + 0.002 * np.sin(np.arange(12.0))
    found = [
        DecayMode(Estimate(frequencies[row] * (1.0 + off[row]), 0.1), Estimate(0.01, 0.01), (1.0,))
        for row in seen
    ]
    pairs = paired(frequencies, np.full(12, 0.01), np.ones(12), found, (100.0, 1200.0))
    assert {pair.number: pair.measured for pair in pairs if pair.measured} == dict(
        zip([row + 1 for row in seen], found, strict=True)
    )
    shared = shared_differences(pairs).frequency
    assert (shared is not None) == (common != 0.0)
    assert shared is None or shared.value == pytest.approx(common, abs=0.002)


def test_what_is_not_clipped_is_not_said_to_be() -> None:
    """None of 2,160 records of three signals, with noise, in steps of a converter or not."""
    alarms = 0
    force, value = hammered((0.02, 0.24), 0.45)
    for seed in range(60):
        random = np.random.default_rng(seed)
        for one in (*value, force):
            for noise in (0.0, 1e-4, 1e-3, 1e-2):
                noisy = one + noise * np.abs(one).max() * random.standard_normal(len(one))
                for bits in (0, 12, 16):
                    steps = 2.0 ** (bits - 1) * random.uniform(0.2, 1.0) / np.abs(noisy).max()
                    record = np.round(noisy * steps) if bits else noisy
                    alarms += clipped_count(record, record, record[:200]) > 0
    assert alarms == 0


def test_a_force_that_is_upside_down_is_suspected() -> None:
    force, value = hammered((0.02, 0.24), 0.45)
    found = vi.test_analysis.correlate(
        a_case(damping=0.008), records(value), force=Record("hammer", -force, RATE, "N"), window=0.1
    )
    assert found.polarity.tolist() == [-1.0, -1.0]
    assert "the sign of the force may be wrong" in " ".join(found.doubts)
    assert "the sign of the force may be wrong" not in " ".join(struck().doubts)


def test_rates_that_differ_by_rounding_are_one_rate() -> None:
    first, *others = records(hammered()[1])
    sensors = [one.sensor() for one in a_case().sensors]
    found = acquired_of(sensors, [replace(first, rate=RATE * (1.0 + 1e-9)), *others], None)
    np.testing.assert_array_equal(found.value, acquired_of(sensors, [first, *others], None).value)
    with pytest.raises(
        vi.InputError, match=f'"a2" has {RATE:g} samples per second, and "a1" 12801.28'
    ):
        acquired_of(sensors, [replace(first, rate=RATE * 1.0001), *others], None)


def test_an_octave_of_few_frequencies_tells_nothing() -> None:
    """Of a single frequency the criterion would be 1, of noise too."""
    first, *others = fallen()[1]
    noise = replace(first, value=np.random.default_rng(0).standard_normal(len(first.value)))
    found = vi.test_analysis.correlate(
        vi.case_of({**TABLE, **DROP}), [noise, *others], window=0.15, band=(1408.0, 4000.0)
    )
    assert found.octaves[0] == (1408.0, pytest.approx(1414.2, abs=0.1))
    assert np.isnan(found.octave_frac[:, 0]).all()
    assert (found.octave_frac[0, 1:] < 0.3).all()


def changed(**one: Any) -> list[Record]:
    first, *others = records(hammered()[1])
    return [replace(first, **one), *others]


@pytest.mark.parametrize(
    ("change", "options", "words"),
    [
        ({"name": "a3"}, {}, 'no sensor "a3"; it has "a1", "a2"'),
        ({"unit": "V"}, {}, '"a1" is in V'),
        ({"rate": 10e3}, {}, "give records of one acquisition, or resample"),
        ({"start": 5.0}, {}, "longer records that overlap in time"),
        ({"start": 0.3 / RATE}, {}, "not sampled at the same instants"),
        ({"value": np.zeros(5120)}, {}, '"a1" is constant'),
        ({"value": np.full(5120, np.nan)}, {}, '"a1" is not a finite number'),
        ({}, {"window": 1e-3}, "64 are needed"),
        ({}, {"window": -1.0}, "it must be longer than 0 s"),
        ({}, {"band": (100.0, 7e3)}, "5760 Hz"),
        (
            {},
            {"force": Record("hammer", np.ones(5120), RATE, "V")},
            "the force of a hammer is in N",
        ),
    ],
)
def test_what_is_refused(change: dict[str, Any], options: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=f"(?i){words}"):
        vi.test_analysis.correlate(a_case(), changed(**change), **options)


def test_no_records_are_refused() -> None:
    with pytest.raises(vi.InputError, match="there is no record"):
        vi.test_analysis.correlate(a_case(), [])


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (
            {"plate": {"size": [0.4, 0.3, 0.012], "material": "steel"}, "sensors": []},
            'give it model = "elastic"',
        ),
        ({"sensors": []}, "the case has no sensors"),
        ({"drop": {"speed": 0.5, "angle": 0.2}}, "only a normal impact"),
    ],
)
def test_cases_that_are_refused(table: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.test_analysis.correlate(vi.case_of({**TABLE, **table}), changed())


def test_the_command(command: Callable[..., tuple[int, str, str]]) -> None:
    force, value = hammered((0.02,), 0.2)
    Path("case.toml").write_text(tomli_w.dumps(TABLE))
    table = np.column_stack([np.arange(len(force)) / RATE, force, value.T / 9.80665])
    np.savetxt(
        "tap.csv", table, delimiter=",", header="time [s],hammer [N],a1 [g],a2 [g]", comments=""
    )
    hammer = ("--hammer", "hammer", "--band", "300 Hz, 1.7 kHz")
    code, out, _ = command("correlate", "case.toml", "tap.csv", "-o", "found", *hammer)
    assert code == 0
    assert "FRAC of the frequency responses to the force, by H1 from 1 hit" in out
    assert "damping = { frequencies = [" in out
    files = {
        "case.toml",
        "modes.csv",
        "overlay.csv",
        "report.html",
        "responses.csv",
        "summary.json",
    }
    assert {one.name for one in Path("found").iterdir()} == files
    rows = list(csv.DictReader(Path("found/overlay.csv").read_text().splitlines()))
    parts = [
        np.array([float(row[f"a2_{name}"]) for row in rows])
        for name in ("measured", "simulated", "residual")
    ]
    assert parts[0] - parts[1] == pytest.approx(parts[2], abs=1e-6)
    code, out, _ = command("correlate", "case.toml", "tap.csv", "-o", "again", *hammer, "--json")
    assert code == 0
    told = json.loads(out)
    assert told["records"]["a1"]["frac"] > 0.999
    assert told["modes"][0]["damping_ratio"] == pytest.approx(0.008, rel=1e-3)
    assert {key: one for key, one in told.items() if key != "folder"} == json.loads(
        Path("again/summary.json").read_text()
    )
    np.savetxt("bare.txt", table)
    columns = ("--columns", "time=s,hammer=N,a1=g,a2=g")
    code, out, _ = command(
        "correlate", "case.toml", "bare.txt", *columns, "-o", "bare", *hammer, "--json"
    )
    assert code == 0
    assert json.loads(out)["records"] == told["records"]
    for words, message in (
        (
            ("bare.txt", "-o", "new"),
            "no header is above it; write a header, such as time [s],force [n], or give --columns",
        ),
        (("tap.csv", "-o", "new"), 'no sensor "hammer"'),
        (("tap.csv", "-o", "new", "--hammer", "hamer"), "did you mean"),
        (("tap.csv", "-o", "new", "--band", "300 Hz"), "give a lower and an upper frequency"),
        (("tap.csv", "-o", "found"), "there already"),
    ):
        code, _, err = command("correlate", "case.toml", *words)
        assert code == 2
        assert message in err.lower()
    assert not Path("new").exists()
