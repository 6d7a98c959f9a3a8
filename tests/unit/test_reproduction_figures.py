"""The paper's figures drawn anew: that all are there, that they show the right numbers, and that their sentences follow from them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import falling_potential, history_column, largest_of
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.compared_quantity import comparison_sentence
from vibroimpact.paper.report.elastic_figures import SPHERE_ENERGY, SPHERE_MOTION
from vibroimpact.paper.report.outline import PAPER_FIGURES
from vibroimpact.paper.runs import Runs
from vibroimpact.report.style import style
from vibroimpact.units.display import digits


class RigidRuns(Runs):
    """In place of the elastic bodies the rigid ones, which take no time."""

    def treated(self, kind: int, treatment: str) -> Response:
        return self.response("type1-constant" if kind == 2 else "type1-variable")


@pytest.fixture(scope="module")
def runs() -> Runs:
    return RigidRuns()


@pytest.fixture(autouse=True)
def in_style() -> Iterator[None]:
    with style():
        yield


def test_every_figure_with_results_is_drawn() -> None:
    assert list(PAPER_FIGURES) == [f"fig{number}" for number in range(3, 24)]


@pytest.mark.parametrize("name", ["fig4", "fig5", "fig6", "fig7", "fig8"])
def test_figures_of_the_rigid_model(runs: Runs, name: str) -> None:
    figure, title, sentence = PAPER_FIGURES[name](runs)
    assert title.startswith(f"Figure {name[3:]}: ")
    whole, *contacts = figure.axes
    shown = 2 if name == "fig4" else 3
    assert len(contacts) == 5
    assert all(len(axes.lines) == shown for axes in figure.axes)
    assert whole.lines[0].get_xdata()[-1] == pytest.approx(float(runs.response("type1-theory").end_time[0]))
    assert sentence.startswith("Beside the theory")
    assert ("variable damping" in sentence) == (name != "fig4")


def test_constant_damping_is_as_far_off_as_is_printed(runs: Runs) -> None:
    sentence = PAPER_FIGURES["fig4"](runs).sentence
    assert sentence.count(printed("constant.height_error.4").text) == 2


def test_enlarged_positions_count_from_first_touch(runs: Runs) -> None:
    contact = PAPER_FIGURES["fig5"](runs).figure.axes[1].lines[0]
    depth = runs.response("type1-theory").impacts["max_indentation_m"][0]
    assert -np.min(contact.get_ydata()) == pytest.approx(depth / 1e-6, rel=1e-3)  # in micrometres


def test_potential_energy_begins_at_zero_in_each_fall(runs: Runs) -> None:
    response = runs.response("type1-theory")
    time, values = falling_potential(response)
    falls = np.split(values, np.flatnonzero(np.isnan(values)))
    assert len(falls) == len(response.impacts["time_s"])
    assert np.all(np.diff(time) >= 0.0)
    weight = float(response.problem.sphere.mass) * float(response.problem.gravity)
    tops = np.append(4.0, response.impacts["rebound_height_m"])
    for index, fall in enumerate(falls):
        fall = fall[np.isfinite(fall)]
        assert fall[0] == pytest.approx(0.0, abs=2e-2)  # the first point after the top
        assert fall[-1] == pytest.approx(weight * (tops[index + 1] - tops[index]), abs=2e-2)
        depth = response.impacts["max_indentation_m"][index]
        assert fall.min() == pytest.approx(-weight * (tops[index] - 0.025 + depth), rel=1e-4)


@pytest.mark.parametrize("name", ["fig10", "fig11", "fig12", "fig13", "fig14", "fig15"])
def test_figures_by_treatment(runs: Runs, name: str) -> None:
    figure, title, sentence = PAPER_FIGURES[name](runs)
    assert title.startswith(f"Figure {name[3:]}: ")
    assert [axes.get_title("left") for axes in figure.axes[::2]] == ["Consistent", "Superposed", "Identified"]
    solid = 3 if int(name[3:]) < 14 else 2
    assert all(len(axes.lines) >= solid for axes in figure.axes)
    assert "Types 2 and 3" in sentence


def test_printed_values_are_marked_where_they_lie(runs: Runs) -> None:
    left, right = PAPER_FIGURES["fig11"](runs).figure.axes[:2]
    expected = sorted(printed(f"type{kind}.max_force").value / 1e3 for kind in (1, 2, 3))
    for axes in (left, right):
        assert sorted(float(line.get_ydata()[0]) for line in axes.lines[3:]) == pytest.approx(expected)
    assert [text.get_text() for text in right.texts] == ["2, 3", "1"]


def test_the_sentence_names_the_nearest_treatment(runs: Runs) -> None:
    force = SPHERE_MOTION[1]
    far = 100.0 * (force.value(runs.treated(3, "consistent")) / printed("type3.max_force").value - 1.0)
    sentence = comparison_sentence(force, (2, 3), runs)
    assert "Nearest to that of Type 3 is the consistent treatment" in sentence
    assert f"{digits(far, 2)} % above it." in sentence
    assert "the paper prints none" in comparison_sentence(SPHERE_MOTION[2], (2, 3), runs)


def test_the_sentence_tells_who_keeps_below_a_bound(runs: Runs) -> None:
    class OneIsLow(RigidRuns):
        def treated(self, kind: int, treatment: str) -> Response:
            return self.response("type1-theory") if treatment == "identified" else super().treated(kind, treatment)

    bound = SPHERE_ENERGY[3]

    def said(low: float, runs: Runs) -> str:
        theory = runs.response("type1-theory")
        return comparison_sentence(bound._replace(value=lambda response: low if response is theory else 1.0), (2, 3), runs)

    assert said(1e-9, OneIsLow()).endswith("and so is the identified treatment alone.")
    assert said(1.0, OneIsLow()).endswith("and none is.")
    assert comparison_sentence(bound._replace(value=lambda response: 0.0), (2, 3), runs).endswith("and so are all.")


def test_largest_of_a_timeline(runs: Runs) -> None:
    response = runs.response("type1-theory")
    assert largest_of(history_column("position_m"))(response) == 4.0
    assert largest_of(lambda _: (np.zeros(3), np.array([1.0, np.nan, -2.0])))(response) == 2.0
