"""The answers of tasks: the few results with which page, terminal and JSON begin."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from hammer_test import RATE, a_case, hammered, records
from vibroimpact.bayes_error.bound import bound_of
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Quantity, Report
from vibroimpact.signals.record import Record
from vibroimpact.test_analysis.criteria_tables import answer_of_modes


def by_name(report: Report) -> dict[str, Quantity]:
    """Return the answer of a report by names; it stands ahead of the contents of the page."""
    page = page_of_report(report)
    assert 0 < page.index('<dl class="answer') < page.index('<nav aria-label="Contents">')
    names = [quantity["name"] for quantity in report.document["answer"]]
    assert names == [quantity.name for quantity in report.quantities]
    return {quantity.name: quantity for quantity in report.quantities}


def plain(text: str) -> str:
    return text.replace("\u00a0", " ")


@pytest.mark.parametrize(
    ("value", "interval", "shown", "error"),
    [
        (98.1, (78.2, 99.8), "98 %", "95 %: 78 to 100 %"),
        (2.04, (0.0, 2.6), "2.0 %", "95 %: 0.0 to 2.6 %"),
        (0.0, (0.0, 36.9), "0 %", "95 %: 0 to 37 %"),
        (-0.05, (-0.131, 0.03), "\N{MINUS SIGN}0.05 %", "95 %: \N{MINUS SIGN}0.13 to 0.03 %"),
        # an interval below the last of five figures is told by its half
        (20.0, (19.9999, 20.0001), "20.000 %", "± 0.0005 %"),
        (20.0, (20.0, 20.0), "20.000 %", ""),
        (0.0, (0.0, 1e-9), "0.0000 %", ""),
        (0.0, (0.0, 5e-324), "0.0000 %", ""),
    ],
)
def test_digits_are_those_that_the_interval_leaves(
    value: float, interval: tuple[float, float], shown: str, error: str
) -> None:
    quantity = Quantity("x", value, "%", interval=interval)
    assert (plain(quantity.text), plain(quantity.error_text)) == (shown, error)
    assert quantity.document["interval"] == list(interval)


def test_counts_ranges_and_given_figures() -> None:
    assert Quantity("Falls", 20_000).text == "20,000"
    assert plain(Quantity("f", 99.0, "N", largest=1204.0).text) == "0.0990 to 1.2040 kN"
    assert plain(Quantity("e", 0.5, largest=0.5).text) == "0.5000"
    assert plain(Quantity("e", 4.333, "%", figures=2).text) == "4.3 %"
    assert plain(Quantity("e", 0.0, "%", largest=4.333, figures=2).text) == "0.0 to 4.3 %"
    document = Quantity("f", 99.0, "N", largest=1204.0).document
    assert (document["value"], document["largest"]) == (99.0, 1204.0)
    assert not {"interval", "largest"} & set(Quantity("f", 99.0, "N").document)


def test_laws_tell_which_of_them_differ_most() -> None:
    compared = vi.laws.compare_laws(vi.load_case("paper:type1-theory"), ["tsuji", "hertz"])
    force = by_name(compared.report)["Largest force"]
    forces = [compared.results[name].impacts["max_force_N"][0] for name in ("tsuji", "hertz")]
    assert (force.value, force.largest) == tuple(forces)
    assert force.note == "smallest by tsuji, largest by hertz"


def test_a_bound_tells_its_bracket() -> None:
    bound = bound_of(vi.studies.load_sweep("signals:coal-gangue", 100))
    answer = by_name(bound.report)
    error = bound.errors["one impact"]
    impact = answer["Lowest error: one impact"]
    assert impact.largest == 100.0 * error.upper
    # few falls have few neighbours: only the upper bound tells something
    assert (impact.value == 0.0) == (error.neighbours < 5.0)
    assert answer["Error without a measurement"].value == 100.0 * bound.majority
    assert answer["Falls"].value == 100


@pytest.fixture(scope="module")
def compared() -> vi.test_analysis.Correlation:
    force, value = hammered((0.02, 0.24), 0.45, damping=0.012)
    hammer = Record("hammer", force, RATE, "N")
    return vi.test_analysis.correlate(a_case(), records(value), force=hammer)


def test_a_test_tells_pairs_and_the_worst_of_them(compared: vi.test_analysis.Correlation) -> None:
    answer = by_name(compared.report)
    least = answer["Smallest FRAC"]
    assert least.value == compared.frac.min()
    assert compared.sensors[int(compared.frac.argmin())].name in least.note
    pairs = [pair for pair in compared.modes if pair.number and pair.measured is not None]
    assert answer["Paired modes"].value == len(pairs)
    differences = [100.0 * pair.frequency_difference for pair in pairs]
    worst = answer["Largest frequency difference"]
    assert abs(worst.value) == max(map(abs, differences))
    assert worst.interval is not None
    assert worst.interval[0] < worst.value < worst.interval[1]
    damping = answer["Measured over computed damping"]
    assert damping.value <= 1.5 <= damping.largest  # the plate's is 0.012, the case's 0.008


def test_modes_without_a_pair_have_no_difference(compared: vi.test_analysis.Correlation) -> None:
    alone = [pair for pair in compared.modes if pair.measured is None]
    (pairs,) = answer_of_modes(alone)
    assert (pairs.name, pairs.value) == ("Paired modes", 0)


def test_identified_values_have_their_intervals() -> None:
    table = {
        "sphere": {"radius": 0.02, "material": "rock-paper"},
        "plate": {
            "size": [0.3, 0.3, 0.02],
            "material": "steel",
            "model": "elastic",
            "modes": 20,
            "supports": "clamped",
            "damping": 0.01,
        },
        "drop": {"speed": 2.0, "position": [0.02, 0.01]},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1, "duration": 0.01},
        "sensors": [{"name": "a", "position": [0.1, 0.03], "rate": 20e3}],
    }
    case = vi.case_of(table)
    measured = [
        Record(name, signal.value, signal.sensor.rate, signal.sensor.unit)
        for name, signal in vi.simulate(case).signals().items()
    ]
    found = vi.identification.identify(case, measured, place=(0.02, 0.01))
    answer = by_name(found.report)
    radius = answer["Radius"]
    assert radius.value == found.estimates["radius_m"].value
    assert radius.interval == found.estimates["radius_m"].interval
    assert answer["Position, x"].note == "given"
    assert answer["Position, x"].interval is None


def test_measured_restitutions_tell_their_mean_and_slope(tmp_path: Path) -> None:
    table = tmp_path / "e.csv"
    rows = "0.5,0.86\n1,0.82\n1.5,0.80\n2,0.79\n3,0.75\n4,0.74\n"
    table.write_text(f"speed [m/s],restitution\n{rows}", encoding="utf-8")
    found = vi.calibration.load_restitutions(table)
    answer = by_name(found.report)
    constant, linear, _ = found.laws
    assert answer["Restitution"].value == constant.coefficients[0]
    assert answer["Restitution"].interval == pytest.approx(tuple(constant.intervals(0.95)[0]))
    slope = answer["Restitution over approach speed"]
    assert slope.value == linear.coefficients[1] < 0.0


def test_bounces_tell_the_height_of_the_fall() -> None:
    microphone = Record("microphone", np.zeros(48000), 48e3, "Pa")
    times = np.array([0.0, 0.4, 0.72, 0.976])
    heard = vi.signals.Bounces(microphone, times, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    given = by_name(vi.calibration.rebounds_of(heard, gravity=9.81, height=0.3).report)
    assert (given["Height of the fall"].value, given["Height of the fall"].note) == (0.3, "given")
    found = vi.calibration.rebounds_of(heard, gravity=9.81)
    height = by_name(found.report)["Height of the fall"]
    assert height.value == found.drop_height
    # 0.8 of the speed before it: g T / 2 / 0.8
    assert height.value == pytest.approx((9.81 * 0.4 / 2 / 0.8) ** 2 / (2 * 9.81), rel=1e-3)
    assert by_name(found.report)["Restitution"].value == pytest.approx(0.8, abs=1e-3)


def test_modes_tell_the_first_frequency() -> None:
    modes = vi.compute_modes(vi.load_case("paper:type2", {"sphere.modes": 5}))
    answer = by_name(modes.report)
    sphere = modes["sphere"]
    first = answer["First frequency of the sphere"]
    assert first.value == sphere.basis.frequencies[0]
    error = sphere.model.frequency_errors[0]
    assert first.error == error or (math.isnan(first.error) and math.isnan(error))
    assert answer["Modes of the sphere"].value == 5


def test_a_notebook_begins_with_the_answer() -> None:
    result = vi.result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    html = plain(result._repr_html_())
    force = result.report.quantities[0]
    cells = f"<td>{plain(force.text)}</td><td>{plain(force.error_text)}</td>"
    assert html.index(cells) < html.index("<th>Impact")
