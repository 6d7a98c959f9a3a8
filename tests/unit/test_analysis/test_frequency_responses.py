"""Measured frequency responses: universal files of pyuff with those of a plate in closed
form, their modes, and what differs.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from scipy import signal
from scipy.stats import binom
from typer.testing import CliRunner

import vibroimpact as vi
from thin_plate_responses import (
    DAMPING,
    FREQUENCY,
    IMPACT,
    MODULUS,
    NODES,
    PLACES,
    TABLE,
    a_case,
    accelerance,
    by_pyuff,
    measured,
    modal,
    noisy,
    with_records,
)
from vibroimpact.cli import app
from vibroimpact.test_analysis.compared_kind import compared_kind
from vibroimpact.test_analysis.responses.computed import computed_responses
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.test_analysis.simulated import plate_problem

RIGHT = tuple(accelerance(place) for place in PLACES)
VALUES = np.array([1.0 + 2.0j, -3.0 - 4e-5j, 1e5 + 2.0j, -0.5j, 7.0 - 8.0j])


def responses_in(
    folder: Path, *responses: Any, **changes: Any
) -> tuple[vi.signals.FrequencyResponse, ...]:
    return vi.signals.load_responses(measured(folder / "plate.uff", responses or RIGHT, **changes))


def compared(
    folder: Path,
    *responses: Any,
    case: vi.Case | None = None,
    reference: str | None = None,
    **changes: Any,
) -> ResponseCorrelation:
    return vi.test_analysis.correlate_responses(
        case or a_case(), responses_in(folder, *responses, **changes), reference=reference
    )


@pytest.mark.parametrize("binary", [0, 1], ids=["text", "binary"])
@pytest.mark.parametrize("precision", [5, 6], ids=["single", "double"])
@pytest.mark.parametrize(
    "frequency",
    [np.array([0.0, 2.5, 3.0, 7.0, 11.0]), 1.0 + 0.5 * np.arange(5)],
    ids=["uneven", "even"],
)
def test_every_form_of_a_response_is_read(
    tmp_path: Path, frequency: np.ndarray, precision: int, binary: int
) -> None:
    even = int(frequency[0] > 0.0)
    one = {
        "rsp_node": 12,
        "x": frequency,
        "data": VALUES,
        "ord_data_type": precision,
        "binary": binary,
        "abscissa_spacing": even,
    }
    (found,) = vi.signals.load_responses(
        by_pyuff(tmp_path / "a.uff", {**one, "rsp_ent_name": "a1"})
    )
    told = frequency > 0.0
    np.testing.assert_allclose(found.frequency, frequency[told])
    np.testing.assert_allclose(found.value, VALUES[told], rtol=1e-5)
    assert found.response.direction == 3
    assert (found.reference.name, found.reference.direction) == ("4", -3)
    assert {"a1", "12", "a1:12", "12Z", "12:+Z", "plate", "function 1"} <= set(found.response.names)


def test_lines_without_a_number_are_left_out(tmp_path: Path) -> None:
    path = by_pyuff(tmp_path / "a.uff", {"rsp_node": 12, "x": np.arange(5.0) + 1.0, "data": VALUES})
    path.write_text(
        path.read_text().replace(f"{1.0:20.11e}{2.0:20.11e}", f"{'NaN':>20}{'NaN':>20}")
    )
    (found,) = vi.signals.load_responses(path)
    assert found.frequency.tolist() == [2.0, 3.0, 4.0, 5.0]


@pytest.mark.parametrize(
    ("changes", "factor", "unit"),
    [
        ({"ordinate_axis_units_lab": "g"}, 9.80665, "m/s2/N"),
        (
            {"ordinate_axis_units_lab": "g", "orddenom_axis_units_lab": "lbf"},
            9.80665 / 4.4482216152605,
            "m/s2/N",
        ),
        ({"ordinate_axis_units_lab": "(m/s^2)/kN"}, 1e-3, "m/s2/N"),
        ({"ordinate_axis_units_lab": "mm/s", "ordinate_spec_data_type": 11}, 1e-3, "m/s/N"),
        ({"ordinate_axis_units_lab": "um", "ordinate_spec_data_type": 8}, 1e-6, "m/N"),
        ({"ordinate_axis_units_lab": "mV", "ordinate_spec_data_type": 0}, 1e-3, "V/N"),
        ({"ordinate_axis_units_lab": "um/m", "ordinate_spec_data_type": 3}, 1e-6, "1/N"),
    ],
)
def test_units_as_laboratories_label_them(
    tmp_path: Path, changes: dict[str, Any], factor: float, unit: str
) -> None:
    found = responses_in(tmp_path, **changes)
    assert {one.unit for one in found} == {unit}
    np.testing.assert_allclose(found[0].value, factor * RIGHT[0], rtol=1e-9)
    assert found[0].doubts == ()


def test_units_of_dataset_164(tmp_path: Path) -> None:
    inches = {
        "type": 164,
        "units_code": 9,
        "units_description": "in",
        "temp_mode": 1,
        "length": 1.0 / 0.0254,
        "force": 0.22481,
    }
    inches |= {"temp": 1.8, "temp_offset": 459.67}
    labels = {"ordinate_axis_units_lab": "NONE", "orddenom_axis_units_lab": "NONE"}
    path = by_pyuff(
        tmp_path / "a.uff",
        {"rsp_node": 12, "x": FREQUENCY, "data": RIGHT[0], **labels},
        first=inches,
    )
    (found,) = vi.signals.load_responses(path)
    assert found.unit == "m/s2/N"
    np.testing.assert_allclose(found.value, 0.0254 * 0.22481 * RIGHT[0], rtol=1e-9)


@pytest.mark.slow
def test_without_a_unit_it_is_taken_as_si_and_said(tmp_path: Path) -> None:
    labels = {"ordinate_axis_units_lab": "NONE", "orddenom_axis_units_lab": "NONE"}
    found = compared(tmp_path, **labels)
    assert any(
        'plate.uff, "12", "13": it states no unit of its motion, and there is no dataset 164'
        in doubt
        for doubt in found.doubts
    )
    unknown = compared(tmp_path, **labels, ordinate_spec_data_type=0, orddenom_spec_data_type=0)
    assert unknown.units == ("m/s2/N", "m/s2/N")
    assert any(
        "it states neither a unit nor a data type of motion" in doubt for doubt in unknown.doubts
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"ordinate_axis_units_lab": "Pa", "ordinate_spec_data_type": 15},
            '"Pa" over "N" is no unit of a frequency response',
        ),
        (
            {"ordinate_spec_data_type": 11},
            'its data type 11 is in m/s, and its unit is "m/s^2"; correct one of them',
        ),
        ({"orddenom_spec_data_type": 12}, "it must be a motion, strain or voltage over a force"),
        ({"rsp_dir": 5}, "it is of a rotation or a moment"),
        ({"func_type": 9}, "there is no frequency response in it"),
    ],
)
def test_what_is_no_response_of_a_plate_is_refused(
    tmp_path: Path, changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(vi.InputError) as raised:
        responses_in(tmp_path, **changes)
    assert words in str(raised.value)
    assert len(str(raised.value)) <= 490


def test_a_header_as_found_in_the_trade(tmp_path: Path) -> None:
    """A unit in Latin-1 that has the whole, no nodes, no kind of the numerator."""
    lines = ["    -1", "    58", "ref6_23_Mar", "NONE", "NONE", "Record 1", "H1 : #  2 / #  1"]
    lines += [f"{4:5}{0:10}{0:5}{0:10} {'NONE':10}{0:10}{0:4} {'NONE':10}{0:10}{0:4}"]
    lines += [f"{5:10}{3:10}{1:10} 0.00000e+00  1.95313e-01  0.00000e+00 "]
    for kind, label, unit in (
        (18, "NONE", "Hz"),
        (1, "Frequency Function", "(1/N)*(m/s²)"),
        (0, "NONE", "NONE"),
        (0, "NONE", "NONE"),
    ):
        lines += [f"{kind:10}{0:5}{0:5}{0:5} {label:20} {unit:20}"]
    lines += [
        " 4.07994e-01  0.00000e+00 -5.99924e-02 -5.53260e-02  2.58750e-02 -2.30085e-04 ",
        "    -1",
        "",
    ]
    path = tmp_path / "trade.uff"
    path.write_bytes("\n".join(lines).encode("latin-1"))
    (found,) = vi.signals.load_responses(path)
    assert (found.name, found.unit, found.doubts) == ("ref6_23_Mar", "m/s2/N", ())
    assert found.value[0] == -5.99924e-02 - 5.53260e-02j


def test_records_of_such_a_file_are_refused_with_what_reads_it(tmp_path: Path) -> None:
    path = measured(tmp_path / "plate.uff", RIGHT)
    with pytest.raises(
        vi.InputError, match="its 2 functions of frequency are for correlate and modes"
    ):
        list(vi.signals.load_records(path))


@pytest.mark.parametrize("swapped", [False, True])
def test_coherences_belong_to_their_responses(tmp_path: Path, swapped: bool) -> None:
    from thin_plate_responses import COHERENCE

    ends = {"rsp_node": 4, "ref_node": 12, "rsp_dir": 3, "ref_dir": 3} if swapped else {}
    coherence = np.linspace(0.5, 1.0, len(FREQUENCY))
    one = {"rsp_node": 12, "x": FREQUENCY, "data": RIGHT[0]}
    path = by_pyuff(
        tmp_path / "a.uff",
        one,
        {**one, "rsp_node": 13},
        {**one, **ends, "data": coherence, **COHERENCE},
    )
    first, second = vi.signals.load_responses(path)
    assert first.coherence is not None
    np.testing.assert_allclose(first.coherence, coherence)
    assert second.coherence is None


@pytest.mark.slow
def test_modes_of_a_closed_form(tmp_path: Path) -> None:
    """Without noise to 1e-5, with noise within the intervals; those that both places and
    the impact move all are found.
    """
    truths = modal(PLACES[0])[0]
    seen = np.abs(modal(IMPACT)[1]) * np.maximum(*(np.abs(modal(place)[1]) for place in PLACES))
    expected = [
        f
        for f, size in zip(truths, seen / seen.max(), strict=True)
        if 60.0 < f < 700.0 and size > 0.05
    ]
    for level in (0.0, 0.01):
        found = vi.signals.modes_in_responses(
            responses_in(tmp_path, *noisy(RIGHT, level)), (60.0, 700.0)
        )
        assert len(found) >= len(expected) >= 4
        for truth in expected:
            mode = min(found, key=lambda one: abs(one.frequency.value - truth))
            assert mode.frequency.value == pytest.approx(truth, rel=1e-5 if not level else 1e-3)
            assert abs(mode.frequency.value - truth) < max(
                3.5 * mode.frequency.deviation, 1e-6 * truth
            )
            assert abs(np.log(mode.damping_ratio.value / DAMPING)) < max(
                3.5 * mode.damping_ratio.deviation, 1e-4
            )


def synthetic(
    frequency: np.ndarray, seed: int, growing: float
) -> tuple[list[vi.signals.FrequencyResponse], np.ndarray, np.ndarray]:
    """Seven modes in a band, two of them 2 % apart, and two above it, at three places;
    noise of 1 % of the rms, or that grows with them.
    """
    natural = np.array([182.0, 410.0, 418.0, 700.0, 955.0, 1290.0, 1610.0, 2050.0, 2600.0])
    ratios = np.array([0.010, 0.006, 0.006, 0.004, 0.012, 0.008, 0.005, 0.004, 0.005])
    sizes = np.random.default_rng(1).standard_normal((3, 9))
    omega, resonant = 2.0 * np.pi * frequency, 2.0 * np.pi * natural[:, None]
    value = -(omega**2) * (
        sizes @ (1.0 / (resonant**2 - omega**2 + 2j * ratios[:, None] * resonant * omega))
    )
    random = np.random.default_rng(seed)
    noise = random.standard_normal(value.shape) + 1j * random.standard_normal(value.shape)
    level = (
        0.01 * np.sqrt(np.mean(np.abs(value) ** 2, axis=1, keepdims=True))
        if not growing
        else growing * np.abs(value)
    )
    hammer = vi.signals.DegreeOfFreedom(("hammer",))
    named = [
        (vi.signals.DegreeOfFreedom((str(number),)), one)
        for number, one in enumerate(value + level * noise)
    ]
    return (
        [vi.signals.FrequencyResponse(end, hammer, frequency, one, "m/s2/N") for end, one in named],
        natural,
        ratios,
    )


@pytest.mark.parametrize(
    "frequency",
    [np.arange(50.0, 2400.0), np.geomspace(50.0, 2400.0, 4000)],
    ids=["even", "logarithmic"],
)
def test_frequencies_at_any_steps(frequency: np.ndarray) -> None:
    responses, natural, ratios = synthetic(frequency, 3, 0.0)
    found = vi.signals.modes_in_responses(responses, (100.0, 2000.0))
    assert len(found) == 7
    for mode, truth, ratio in zip(found, natural, ratios, strict=False):
        assert abs(mode.frequency.value - truth) < 3.5 * mode.frequency.deviation
        assert abs(np.log(mode.damping_ratio.value / ratio)) < 3.5 * mode.damping_ratio.deviation


@pytest.mark.slow
@pytest.mark.parametrize(
    ("growing", "invented"),
    [(0.0, 0.02), (0.01, 0.1)],
    ids=["white noise", "noise that grows with the response"],
)
def test_intervals_hold_the_truth(
    growing: float, invented: float, population: Callable[..., int]
) -> None:
    """Of frequencies and damping ratios; all modes are found, and few in many files that
    are not there.
    """
    draws, held, more = population(60, share=4), np.zeros(2), 0
    for seed in range(draws):
        responses, natural, ratios = synthetic(np.arange(50.0, 2400.0), seed, growing)
        found = vi.signals.modes_in_responses(responses, (100.0, 2000.0))
        more += len(found) - 7
        for truth, ratio in zip(natural[:7], ratios[:7], strict=True):
            mode = min(found, key=lambda one: abs(one.frequency.value - truth))
            assert mode.frequency.value == pytest.approx(truth, rel=2e-3)
            both = ((mode.frequency.interval, truth), (mode.damping_ratio.interval, ratio))
            held += [low <= value <= high for (low, high), value in both]
    # of fewer intervals the part that holds scatters more
    least = 0.91 if draws == 60 else binom.ppf(1e-3, 7 * draws, 0.95) / (7 * draws)
    assert (held / (7 * draws) >= least).all()
    assert more <= invented * draws


def test_the_cases_own_agree(tmp_path: Path) -> None:
    """Written, read and compared: FRAC is 1, nothing differs, and nothing is doubted."""
    case = a_case()
    own = vi.test_analysis.responses_of_case(case, FREQUENCY)
    found = compared(tmp_path, *(-one.value for one in own), case=case)
    assert found.frac == pytest.approx(1.0, abs=1e-9)
    assert found.scale == pytest.approx(1.0, abs=1e-9)
    assert found.level_difference.max() < 1e-6
    assert found.phase_difference.max() < 1e-6
    pairs = [pair for pair in found.modes if pair.measured is not None]
    assert len(pairs) >= 7
    assert max(abs(pair.frequency_difference) for pair in pairs) < 1e-5
    assert found.doubts == ()


@cache
def thin(modulus: float = MODULUS) -> ResponseCorrelation:
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        return compared(
            Path(folder), *noisy([accelerance(place, modulus=modulus) for place in PLACES])
        )


def test_responses_of_a_case_are_those_of_the_closed_form() -> None:
    problem = plate_problem(a_case())
    found = computed_responses(problem, problem.sensors, ["m/s2/N"] * 2, FREQUENCY)
    modes = problem.plate.modes
    assert modes is not None
    # aside from resonances, which are off by 1e-3 here
    rightly = np.abs(FREQUENCY - modes.frequencies[:, None]).min(axis=0) > 6.0
    for one, closed in zip(found, RIGHT, strict=True):
        assert np.median(np.abs(-one[rightly] / closed[rightly] - 1.0)) < 0.01
    assert (thin().frac > 0.97).all()
    assert thin().scale == pytest.approx(1.0, abs=0.02)
    assert thin().polarity.tolist() == [1.0, 1.0]


def test_a_modulus_three_per_cent_off_is_told() -> None:
    found = thin(1.03 * MODULUS)
    assert (found.frac < 0.6).all()
    assert (found.scaled_frac > 0.97).all()
    pairs = [pair for pair in found.modes if pair.measured is not None and pair.number is not None]
    assert all(0.0135 < pair.frequency_difference < 0.019 for pair in pairs)
    (doubt,) = (one for one in found.doubts if "Young's modulus over density" in one)
    assert "modes are 1." in doubt
    assert "differs from the case's by +3." in doubt
    assert not any("Young" in one for one in thin().doubts)


def test_where_damping_alone_differs_it_is_said(tmp_path: Path) -> None:
    """A smaller damping has larger responses, which is no sensitivity."""
    found = compared(tmp_path, *noisy(RIGHT), case=a_case(damping=4.0 * DAMPING))
    (doubt,) = (one for one in found.doubts if "the measured damping" in one)
    assert (
        "the frequencies agree within 0.2 %, and the damping does not: the measured damping "
        "ratios of 7 modes are 0.25 times" in doubt
    )
    assert (found.frac < 0.8).all()  # 0.64 for one resonance, by the closed form
    assert (found.damped_frac > 0.97).all()
    assert found.scaled_frac.tolist() == found.frac.tolist()
    assert not any("sensitivity" in one for one in found.doubts)


def test_gain_polarity_and_coherence_are_told(tmp_path: Path) -> None:
    resonance = float(modal(PLACES[0])[0][0])
    coherence = np.where(np.abs(FREQUENCY - resonance) < 5.0, 0.6, 0.99)
    found = compared(tmp_path, 1.1 * RIGHT[0], -RIGHT[1], coherence=coherence)
    words = " ".join(found.doubts)
    assert 'the response "12" has 1.1 times the simulated magnitude' in words
    assert 'the response "13" has inverted polarity' in words
    assert found.polarity.tolist() == [1.0, -1.0]
    assert 'the coherence of "12" is below 0.9 at the mode of 12' in words
    assert found.coherence is not None
    assert found.coherence.shape == found.measured_response.shape


@pytest.mark.slow
def test_directions_turn_signs(tmp_path: Path) -> None:
    assert compared(tmp_path, *(-one for one in RIGHT), ref_dir=3).polarity.tolist() == [1.0, 1.0]
    assert compared(tmp_path, *(-one for one in RIGHT), rsp_dir=-3).polarity.tolist() == [1.0, 1.0]
    # as if the force were positive upwards, which nobody says
    unstated = compared(tmp_path, *(-one for one in RIGHT), ref_dir=0)
    assert unstated.polarity.tolist() == [1.0, 1.0]
    assert not any("polarity" in doubt for doubt in unstated.doubts)


@pytest.mark.slow
def test_velocities_over_force(tmp_path: Path) -> None:
    omega = 2.0 * np.pi * FREQUENCY
    found = compared(
        tmp_path,
        *(one / (1j * omega) for one in RIGHT),
        ordinate_axis_units_lab="m/s",
        ordinate_spec_data_type=11,
    )
    assert found.units == ("m/s/N", "m/s/N")
    assert (found.frac > 0.97).all()


def test_a_roving_hammer(tmp_path: Path) -> None:
    """An accelerometer at the place of the impact, and blows where the case has its sensors."""
    sets = [
        {
            "rsp_node": 4,
            "rsp_dir": 3,
            "ref_node": node,
            "ref_dir": -3,
            "x": FREQUENCY,
            "data": response,
        }
        for node, response in zip(NODES, RIGHT, strict=True)
    ]
    found = vi.test_analysis.correlate_responses(
        a_case(), vi.signals.load_responses(by_pyuff(tmp_path / "a.uff", *sets))
    )
    assert found.reciprocal
    assert (found.frac > 0.97).all()
    assert any("by reciprocity" in doubt for doubt in found.doubts)


@pytest.mark.slow
def test_several_places_of_the_hammer(tmp_path: Path) -> None:
    sets = [
        {
            "rsp_node": node,
            "ref_node": place,
            "x": FREQUENCY,
            "data": response * (1.0 if place == 4 else 2.0),
        }
        for place in (4, 7)
        for node, response in zip(NODES, RIGHT, strict=True)
    ]
    responses = vi.signals.load_responses(by_pyuff(tmp_path / "a.uff", *sets))
    with pytest.raises(
        vi.InputError,
        match=r"the forces act at 4, 7; name the one at drop.position of the case by --hammer",
    ):
        vi.test_analysis.correlate_responses(a_case(), responses)
    with pytest.raises(vi.InputError, match='no force acts, and no motion was measured, at "9"'):
        vi.test_analysis.correlate_responses(a_case(), responses, reference="9")
    assert vi.test_analysis.correlate_responses(
        a_case(), responses, reference="4"
    ).scale == pytest.approx(1.0, abs=0.02)
    assert vi.test_analysis.correlate_responses(
        a_case(), responses, reference="7"
    ).scale == pytest.approx(2.0, abs=0.04)


def test_three_directions_at_a_node(tmp_path: Path) -> None:
    sets = [
        {
            "rsp_node": 12,
            "rsp_dir": direction,
            "x": FREQUENCY,
            "data": RIGHT[0] * (1.0 if direction == 3 else 0.01),
        }
        for direction in (1, 2, 3)
    ]
    found = vi.test_analysis.correlate_responses(
        a_case(), vi.signals.load_responses(by_pyuff(tmp_path / "a.uff", *sets))
    )
    assert [sensor.name for sensor in found.sensors] == ["12"]
    assert found.frac[0] > 0.97
    assert any(
        "2 responses have no sensor of that name and direction" in doubt for doubt in found.doubts
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"rsp_dir": 1},
            'the response "12" is along x, and the case\'s sensor along [0.0, 0.0, 1.0]',
        ),
        ({"ref_dir": 2}, 'the forces at "4" are along the plate'),
        (
            {"ordinate_axis_units_lab": "mV", "ordinate_spec_data_type": 0},
            'the response "12" is in V/N',
        ),
    ],
)
def test_what_the_case_does_not_measure_is_refused(
    tmp_path: Path, changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(vi.InputError) as raised:
        compared(tmp_path, **changes)
    assert words in str(raised.value)
    assert len(str(raised.value)) <= 490


def test_names_that_do_not_match(tmp_path: Path) -> None:
    case = vi.case_of({**TABLE, "sensors": [{"name": "a1", "position": [0.12, 0.08]}]})
    with pytest.raises(
        vi.InputError,
        match=r"no sensor of the case \(a1\) is named after a response.*12, 13; write the "
        r'name.*name = "12"',
    ):
        compared(tmp_path, case=case)
    named = vi.case_of({**TABLE, "sensors": [{"name": "12:+Z", "position": [0.12, 0.08]}]})
    assert compared(tmp_path, case=named).frac[0] > 0.97


def test_bad_bands_and_frequencies(tmp_path: Path) -> None:
    responses = responses_in(tmp_path)
    with pytest.raises(
        vi.InputError,
        match=r"a band from 10 to 300 Hz is not allowed; it must rise, within the 40 to 799.5 Hz "
        r"measured",
    ):
        vi.test_analysis.correlate_responses(a_case(), responses, band=(10.0, 300.0))
    low = [
        vi.signals.FrequencyResponse(
            one.response, one.reference, one.frequency[:60], one.value[:60], one.unit
        )
        for one in responses
    ]
    with pytest.raises(vi.InputError, match="the lowest mode of the plate has"):
        vi.test_analysis.correlate_responses(a_case(), low)
    with pytest.raises(
        vi.InputError,
        match=r"have different frequencies, 1520 from 40 to 799.5 Hz and 60 from 40 to 69.5 Hz",
    ):
        vi.signals.modes_in_responses([responses[0], low[1]])
    with pytest.raises(
        vi.InputError,
        match="there are 21 frequencies of the responses from 100 to 110 Hz, and 32 at least are "
        "needed",
    ):
        vi.signals.modes_in_responses(responses, (100.0, 110.0))


def run(*words: str) -> Any:
    return CliRunner().invoke(app, list(words), catch_exceptions=True)


@pytest.mark.slow
def test_the_commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plate.toml").write_text(tomli_w.dumps(TABLE))
    measured(
        Path("plate.uff"),
        noisy([accelerance(place, modulus=1.03 * MODULUS) for place in PLACES]),
        coherence=np.full(len(FREQUENCY), 0.98),
    )
    told = run("correlate", "plate.toml", "plate.uff", "-o", "compared", "--json")
    assert told.exit_code == 0, told.output
    summary = json.loads(Path("compared/summary.json").read_text())
    assert summary["responses"]["12"]["unit"] == "m/s2/N"
    assert summary["responses"]["12"]["coherence_median"] == pytest.approx(0.98)
    assert summary["reference"] == "4"
    with Path("compared/responses.csv").open() as file:
        assert next(csv.reader(file))[:4] == [
            "frequency_Hz",
            "12_measured_magnitude",
            "12_measured_phase_rad",
            "12_simulated_magnitude",
        ]
    assert "Young&#39;s modulus" in Path("compared/report.html").read_text()

    told = run("modes", "plate.uff", "--json")
    assert told.exit_code == 0, told.output
    alone = json.loads(Path("plate-modes/summary.json").read_text())
    assert len(alone["modes"]) >= 7
    assert {path.name for path in Path("plate-modes").iterdir()} == {
        "modes.csv",
        "summary.json",
        "report.html",
    }
    assert "Damping" not in run("modes", "plate.uff", "--force").output.split("wrote")[-1]

    told = run("modes", "plate.toml", "--measured", "plate.uff", "-o", "beside", "--json")
    assert told.exit_code == 0, told.output
    with Path("beside/measured.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["frequency_Hz"] and row["mode"]]
    assert len(rows) >= 7
    assert all(
        1.013 < float(row["frequency_Hz"]) / float(row["case_frequency_Hz"]) < 1.019 for row in rows
    )
    assert "Measured modes" in Path("beside/report.html").read_text()


@pytest.mark.filterwarnings("ignore::vibroimpact.errors.LeftOutWarning")
def test_what_the_commands_refuse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plate.toml").write_text(tomli_w.dumps(TABLE))
    Path("records.csv").write_text("time [s],12 [m/s^2]\n0,0\n1e-4,1\n")
    measured(Path("plate.uff"), RIGHT)
    for words, message in (
        (
            ("correlate", "plate.toml", "plate.uff", "--window", "5 ms"),
            "--window: frequency responses have no time",
        ),
        (
            ("correlate", "plate.toml", "plate.uff", "records.csv"),
            "plate.uff has frequency responses, and records.csv records over time",
        ),
        (
            ("modes", "plate.uff", "--set", "plate.modes=3"),
            "--set: plate.uff is a measurement, which has no keys",
        ),
        (
            (
                "modes",
                "plate.toml",
                "--set",
                "plate.model=rigid",
                "--set",
                "plate.modes=3",
                "--measured",
                "plate.uff",
            ),
            "plate",
        ),
    ):
        raised = run(*words).exception
        assert isinstance(raised, vi.InputError), words
        assert message in str(raised)


RATE = 5000.0


def both_kinds(path: Path) -> Path:
    """A file with responses and with records of the case's own plate under a pulse of 1 ms."""
    from vibroimpact.cases.build import problem_of

    modes = problem_of(a_case()).plate.modes
    assert modes is not None
    fine = np.arange(round(8 * RATE * 0.8)) / (8 * RATE)
    push = 50.0 * np.sin(np.pi * (fine - 0.05) / 1e-3) * ((fine > 0.05) & (fine < 0.051))
    motions = []
    for node in NODES:
        motion = np.zeros(len(fine))
        for omega, ratio, here, there in zip(
            modes.angular_frequencies,
            modes.damping_ratios,
            modes.contact,
            modes.points[str(node)][:, 2],
            strict=True,
        ):
            system = signal.cont2discrete(
                ([1.0, 0.0, 0.0], [1.0, 2.0 * ratio * omega, omega**2]),
                1.0 / (8 * RATE),
                method="foh",
            )
            motion -= here * there * signal.lfilter(np.ravel(system[0]), system[1], push)
        motions.append(signal.resample_poly(motion, 1, 8, window=("kaiser", 12.0)))
    return with_records(
        path, RIGHT, signal.resample_poly(push, 1, 8, window=("kaiser", 12.0)), motions, RATE
    )


def test_phases_do_not_cross_the_chart() -> None:
    """Near 180 degrees noise drew a line from one end of the axis to the other at each
    second frequency.
    """
    chart = thin().charts["responses"]
    phases = [panel for row in chart.rows for panel in row if panel.title == "Phase"]
    assert len(phases) == len(NODES)
    lines = [mark for panel in phases for mark in panel.marks]
    assert any(np.isnan(line.y).any() for line in lines)
    for line in lines:
        assert np.isfinite(line.y).sum() == len(thin().frequency)
        assert np.nanmax(np.abs(np.diff(line.y))) <= 180.0


def test_the_report_can_be_read(tmp_path: Path) -> None:
    """Words to the left, no column of remarks without any, and the whole line for the case."""
    page = (thin().save(tmp_path / "compared") / "report.html").read_text()
    assert '<th scope="col" class="text">Polarity</th>' in page
    assert '<td class="text">as simulated</td>' in page
    assert '<td class="text">m/s²/N</td>' in page
    assert '<th scope="col">FRAC</th>' in page
    assert "Remark" not in page
    assert '<pre id="damping-text" class="wrapped">damping = { frequencies = [' in page
    assert '<button type="button" data-copy="damping-text">' in page


@pytest.mark.slow
def test_of_a_file_with_both_either_is_compared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was read as records alone, and its frequency responses were not mentioned."""
    monkeypatch.chdir(tmp_path)
    Path("plate.toml").write_text(
        tomli_w.dumps({**TABLE, "sensors": [{**one, "rate": RATE} for one in TABLE["sensors"]]})
    )
    path = both_kinds(Path("both.uff"))
    found = {}
    for name, options in (
        ("plain", ()),
        ("of hammer", ("--hammer", "hammer", "--band", "60 Hz, 700 Hz")),
        ("asked", ("--hammer", "hammer", "--compare", "records", "--band", "60 Hz, 700 Hz")),
        ("node", ("--hammer", "4", "--compare", "responses")),
    ):
        told = run("correlate", "plate.toml", str(path), "-o", name, "--json", *options)
        assert told.exit_code == 0, (name, told.output, told.exception)
        found[name] = json.loads(Path(name, "summary.json").read_text())
    has = "both.uff has 3 records over time and 2 frequency responses: "
    for name, kind, remark in (
        (
            "plain",
            "responses",
            "the responses are compared, and the records by --compare records, without "
            "--window and without files of responses alone",
        ),
        (
            "node",
            "responses",
            "the responses are compared, and the records by --compare records, without "
            "--window and without files of responses alone",
        ),
        (
            "of hammer",
            "records",
            "the records are compared, and the responses by --compare responses, without "
            "--window and without files of records alone",
        ),
        (
            "asked",
            "records",
            "the records are compared, and the responses by --compare responses, without "
            "--window and without files of records alone",
        ),
    ):
        assert list(found[name][kind]) == ["12", "13"]
        assert found[name]["doubts"].count(has + remark) == 1
        assert min(one["frac"] for one in found[name][kind].values()) > 0.97
        assert "both.uff has 3 records" in Path(name, "report.html").read_text()
    assert compared_kind([path], None, None, windowed=True).kind == "records"
    told = run("modes", str(path), "--json")
    doubts = json.loads(Path("both-modes/summary.json").read_text())["doubts"]
    assert any(
        "both.uff also has 3 records over time, which these modes are not from" in doubt
        for doubt in doubts
    )


def test_several_files_of_different_kinds(tmp_path: Path) -> None:
    both, alone = both_kinds(tmp_path / "both.uff"), measured(tmp_path / "plate.uff", RIGHT)
    table = tmp_path / "records.csv"
    table.write_text("time [s],12 [m/s^2]\n0,0\n1e-4,1\n")
    kinds = {
        (both, alone): "responses",
        (both, table): "records",
        (alone,): "responses",
        (table,): "records",
    }
    for files, kind in kinds.items():
        found = compared_kind(files, None, None, windowed=False)
        assert found.kind == kind
        assert len(found.remarks) == (both in files)
    for files, asked, message in (
        (
            (alone, table),
            None,
            "plate.uff has frequency responses, and .*records.csv records over time; "
            "compare them one after the other",
        ),
        ((both, alone), "records", "plate.uff has no record over time; leave it out"),
        ((both, table), "responses", "records.csv has no frequency response; leave it out"),
        ((both,), "respones", 'there are records, responses. Did you mean "responses"'),
    ):
        with pytest.raises(vi.InputError, match=message):
            compared_kind(files, asked, None, windowed=False)


def test_the_noise_of_one_channel_is_no_mode() -> None:
    """One of six channels has thirty times the noise of the others: each channel counts once."""
    random = np.random.default_rng(3)
    frequency = np.arange(20.0, 1000.0, 0.5)
    natural = np.sort(random.uniform(100.0, 900.0, 5))
    ratios = random.uniform(0.003, 0.02, 5)
    squares = natural[:, None] ** 2
    tones = squares / (squares - frequency**2 + 2j * ratios[:, None] * natural[:, None] * frequency)
    hammer = vi.signals.DegreeOfFreedom(("hammer",))
    responses = []
    for channel in range(6):
        value = 1e-3 * random.normal(size=5) @ tones
        level = (0.06 if channel == 1 else 0.002) * np.abs(value).mean()
        noise = random.normal(size=len(frequency)) + 1j * random.normal(size=len(frequency))
        sensor = vi.signals.DegreeOfFreedom((f"a{channel}",))
        responses.append(
            vi.signals.FrequencyResponse(sensor, hammer, frequency, value + level * noise, "m/N")
        )
    modes = vi.signals.modes_in_responses(responses)
    assert [mode.frequency.value for mode in modes] == pytest.approx(natural, rel=1e-3)
