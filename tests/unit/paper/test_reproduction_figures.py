"""The paper's figures drawn anew: that all are there, that they show the right numbers,
and that their sentences follow from them.
"""

from __future__ import annotations

import numpy as np
import pytest

from shown_lines import assert_shows, lines_of
from vibroimpact.arrays import Floats
from vibroimpact.charts.chart import Panel
from vibroimpact.charts.frame import own_view, values_within
from vibroimpact.charts.marks import Band, Bars, Label, Level, Line, Points, Spans
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline, falling_potential, history_column, largest_of
from vibroimpact.paper.printed import printed
from vibroimpact.paper.recovery import recover_parameters
from vibroimpact.paper.report.compared_quantity import ComparedQuantity, comparison_sentence
from vibroimpact.paper.report.comparison_chart import ResponseLine, comparison_rows
from vibroimpact.paper.report.elastic_charts import SPHERE_ENERGY, SPHERE_MOTION
from vibroimpact.paper.report.outline import PAPER_FIGURES
from vibroimpact.paper.report.recovery_chart import recovery_chart
from vibroimpact.paper.report.rigid_charts import RIGID_FIGURES, RigidFigure
from vibroimpact.paper.report.sampling_chart import sampling_chart
from vibroimpact.paper.runs import TREATMENTS, Runs, history_of
from vibroimpact.paper.sampling import error_range, output_step, spacing_bound, table2_error
from vibroimpact.units.display import digits


class RigidRuns(Runs):
    """In place of the elastic bodies the rigid ones, which take no time."""

    def treated(self, kind: int, treatment: str) -> Response:
        return self.response("type1-constant" if kind == 2 else "type1-variable")


@pytest.fixture(scope="module")
def runs() -> Runs:
    return RigidRuns()


def levels_of(panel: Panel) -> list[Level]:
    return [mark for mark in panel.marks if isinstance(mark, Level)]


def test_every_figure_with_results_is_drawn() -> None:
    assert list(PAPER_FIGURES) == [f"fig{number}" for number in range(3, 24)]


@pytest.mark.parametrize("content", RIGID_FIGURES, ids=lambda content: f"fig{content.number}")
def test_figures_of_the_rigid_model(runs: Runs, content: RigidFigure) -> None:
    chart = PAPER_FIGURES[f"fig{content.number}"](runs)
    assert chart.name == f"fig{content.number}"
    assert chart.title.startswith(f"Figure {content.number}: {content.quantity}, ")
    (panel,) = chart.panels
    assert (panel.x.unit, panel.y.unit) == ("s", content.unit)
    cases = ("theory", "constant", "variable")[: len(content.shown)]
    assert [line.name for line in lines_of(panel)] == list(content.shown)
    assert [line.role for line in lines_of(panel)] == ["under", "series 1", "series 2"][
        : len(cases)
    ]
    for line, case in zip(lines_of(panel), cases, strict=True):
        assert_shows(line, history_column(content.column), runs.response(f"type1-{case}"), panel)
    assert [view.name for view in panel.x.views] == [f"Impact {impact}" for impact in range(1, 6)]
    assert chart.caption.startswith("Beside the theory")
    assert ("variable damping" in chart.caption) == (content.number != 4)


def test_constant_damping_is_as_far_off_as_is_printed(runs: Runs) -> None:
    assert PAPER_FIGURES["fig4"](runs).caption.count(printed("constant.height_error.4").text) == 2


def test_enlarged_positions_count_from_first_touch(runs: Runs) -> None:
    (panel,) = PAPER_FIGURES["fig5"](runs).panels
    for line, name in zip(lines_of(panel), ("theory", "constant", "variable"), strict=True):
        for impact, view in enumerate(panel.x.views):
            assert view.level_label == "From first touch"
            inside = values_within(line, own_view(line, panel, view)) - view.level
            depth = runs.response(f"type1-{name}").impacts["max_indentation_m"][impact]
            assert -np.min(inside) == pytest.approx(depth, rel=1e-3)


def test_contacts_coincide_in_views(runs: Runs) -> None:
    """The fifth impacts of theory and simulation begin 71 ms apart."""
    chart = PAPER_FIGURES["fig6"](runs)
    touches = [
        runs.response(f"type1-{name}").impacts["time_s"][4]
        for name in ("theory", "constant", "variable")
    ]
    assert np.ptp(touches) > 0.07
    drawn = plotly_chart(chart)
    assert [trace["origins"][4] for trace in drawn["data"]] == touches
    fifth = next(
        axes
        for axes in matplotlib_figure(chart).axes
        if axes.get_title("left").startswith("Impact 5")
    )
    for curve in fifth.lines:
        time, force = curve.get_data()
        assert 100.0 < float(time[np.argmax(force)]) < 200.0  # in microseconds since first touch
        assert float(np.max(force)) > 2.5


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


@pytest.mark.parametrize(
    "shown", [*SPHERE_MOTION, *SPHERE_ENERGY[:2]], ids=lambda shown: f"fig{shown.number}"
)
def test_figures_by_treatment(runs: Runs, shown: ComparedQuantity) -> None:
    chart = PAPER_FIGURES[f"fig{shown.number}"](runs)
    assert chart.title.startswith(f"Figure {shown.number}: {shown.name}")
    assert [panel.title for panel in chart.panels] == ["Consistent", "Superposed", "Identified"]
    # common scales
    assert (
        len({id(panel.x) for panel in chart.panels})
        == len({id(panel.y) for panel in chart.panels})
        == 1
    )
    types = (1, 2, 3) if shown in SPHERE_MOTION else (2, 3)
    for panel, treatment in zip(chart.panels, TREATMENTS, strict=True):
        assert [line.name.partition(",")[0] for line in lines_of(panel)] == [
            f"Type {kind}" for kind in types
        ]
        for line, kind in zip(lines_of(panel), types, strict=True):
            response = (
                runs.response("type1-variable") if kind == 1 else runs.treated(kind, treatment)
            )
            assert_shows(line, shown.timeline, response, panel)
    assert "Types 2 and 3" in chart.caption


def test_printed_values_are_marked_where_they_lie(runs: Runs) -> None:
    for panel in PAPER_FIGURES["fig11"](runs).panels:
        assert [level.value for level in levels_of(panel)] == sorted(
            printed(f"type{kind}.max_force").value for kind in (1, 2, 3)
        )
        assert {(level.name, level.role) for level in levels_of(panel)} == {("printed", "dotted")}
        assert [level.label for level in levels_of(panel)] == ["", "Types 2 and 3", "Type 1"]


def rows_with(
    runs: Runs, marks: dict[str, float], timeline: Timeline, signs: tuple[int, ...] = (1,)
) -> Panel:
    shown = SPHERE_MOTION[1]._replace(timeline=timeline, signs=signs)
    line = ResponseLine("theory", "series 0", runs.response("type1-theory"))
    return comparison_rows(shown, {"": [line]}, marks, lambda impact: (1e-5, 3e-4))[0][0]


def test_printed_values_far_from_the_curves_are_left_out(runs: Runs) -> None:
    force = history_column("force_N")
    most = float(np.max(history_of(runs.response("type1-theory"))["force_N"]))
    panel = rows_with(runs, {"1": 1.34 * most, "2": 1.36 * most, "3": -0.34 * most}, force)
    assert [level.label for level in levels_of(panel)] == ["Type 3", "Type 1"]
    assert [
        level.value for level in levels_of(rows_with(runs, {"": 0.3 * most}, force, (-1, 1)))
    ] == [-0.3 * most, 0.3 * most]


def test_what_is_zero_says_so_beside_the_printed_values(runs: Runs) -> None:
    def nothing(response: Response) -> tuple[Floats, Floats]:
        time = history_of(response)["time_s"]
        return time, np.zeros_like(time)

    panel = rows_with(runs, {"2": 1e-6, "3": 6e-7}, nothing)
    assert [level.label for level in levels_of(panel)] == ["Type 3", "Type 2"]
    assert [mark.words for mark in panel.marks if isinstance(mark, Label)] == ["zero"]
    assert not [
        mark
        for mark in rows_with(runs, {}, history_column("force_N")).marks
        if isinstance(mark, Label)
    ]


def test_table_2_is_drawn_with_its_ranges(runs: Runs) -> None:
    chart = sampling_chart(runs)
    assert [len(row) for row in chart.rows] == [2, 1]
    for panel, quantity in zip(chart.rows[0], ("compression", "force"), strict=True):
        bars = [mark for mark in panel.marks if isinstance(mark, Bars)]
        exact, values = lines_of(panel), [mark for mark in panel.marks if isinstance(mark, Points)]
        for number, damping in enumerate(("constant", "variable")):
            for impact in range(1, 6):
                which = (quantity, damping, impact)
                at = impact + (-0.19, 0.19)[number]
                assert values[number].x[impact - 1] == at
                assert values[number].y[impact - 1] == table2_error(*which).value
                assert set(exact[number].y[3 * impact - 3 : 3 * impact - 1]) == {
                    error_range(runs, 0.0, *which)[0]
                }
                narrow, wide = bars[2 + number], bars[number]
                low, high = error_range(runs, spacing_bound(runs), *which)
                assert (narrow.base[impact - 1], narrow.values[impact - 1]) == pytest.approx(
                    (low, high - low)
                )
                least, most = error_range(runs, output_step(), *which)
                # as far as the picture reaches
                assert wide.base[impact - 1] == pytest.approx(max(least, panel.y.range[0] - 1.0))
                assert wide.base[impact - 1] + wide.values[impact - 1] == pytest.approx(
                    min(most, panel.y.range[1] + 1.0)
                )


def test_one_contact_is_drawn_with_its_samples(runs: Runs) -> None:
    panel = sampling_chart(runs).rows[1][0]
    damping, impact = (
        ("variable" if "variable" in panel.title else "constant"),
        int(panel.title.split(",")[0].removeprefix("Impact ")),
    )
    compression, force = lines_of(panel)
    read = {mark.name: mark for mark in panel.marks if isinstance(mark, Points)}
    for line, quantity in ((compression, "compression"), (force, "force")):
        marked = read[f"printed {quantity}"]
        assert marked.y == pytest.approx(100.0 - table2_error(quantity, damping, impact).value)
        assert np.interp(marked.x, line.x, line.y) == pytest.approx(marked.y, abs=1e-6)
    (span,) = [mark for mark in panel.marks if isinstance(mark, Spans)]
    assert float(span.ends[0]) == pytest.approx(
        float(runs.response(f"type1-{damping}").impacts["duration_s"][impact - 1])
    )


def test_the_evidence_crosses_at_the_joint_estimate(runs: Runs) -> None:
    found = recover_parameters(runs)
    whole, enlarged = recovery_chart(runs).panels
    for panel in (whole, enlarged):
        joint = next(
            mark
            for mark in panel.marks
            if isinstance(mark, Points) and mark.name == "joint estimate"
        )
        assert (joint.x[0], joint.y[0]) == (found.penetration.value, found.restitution.value)
        bands = [mark for mark in panel.marks if isinstance(mark, Band | Spans)]
        lines = [
            mark
            for mark in panel.marks
            if isinstance(mark, Line | Level) and mark.role.startswith("series")
        ]
        assert [line.name for line in lines] == [
            one.name for one in found.evidence if not one.sampled
        ]
        for line in lines:
            if isinstance(line, Level):
                assert line.upright
                assert line.value == pytest.approx(found.penetration.value, rel=1e-3)
            else:
                assert np.interp(found.penetration.value, line.x, line.y) == pytest.approx(
                    found.restitution.value, abs=2e-4
                )
        for band in (mark for mark in bands if isinstance(mark, Band)):
            line = next(one for one in lines if f"{one.role} band" == band.role)
            assert np.allclose(
                0.5 * (band.low + band.high), line.y, rtol=0.0, atol=1e-9, equal_nan=True
            )
    assert [level.value for level in levels_of(whole) if level.role == "dotted"] == [
        printed("full_damping_penetration").value
    ]
    assert whole.x.log
    assert not enlarged.x.log


def test_the_model_is_drawn_with_its_dimensions(runs: Runs) -> None:
    chart = PAPER_FIGURES["fig3"](runs)
    (panel,) = chart.panels
    assert panel.picture
    words = {mark.words for mark in panel.marks if isinstance(mark, Label)}
    assert words == {
        "520 mm",
        "420 mm",
        "458.4 mm",
        "360 mm",
        "8 mm thick",
        "radius 25 mm",
        "4\u00a0m, not to scale",
    }
    assert "plate: 7850 kg/m³, E = 210 GPa" in chart.caption


def test_the_sentence_names_the_nearest_treatment(runs: Runs) -> None:
    force = SPHERE_MOTION[1]
    far = 100.0 * (
        force.value(runs.treated(3, "consistent")) / printed("type3.max_force").value - 1.0
    )
    sentence = comparison_sentence(force, (2, 3), runs)
    assert "Nearest to that of Type 3 is the consistent treatment" in sentence
    assert f"{digits(far, 2)} % above it." in sentence
    assert "the paper prints none" in comparison_sentence(SPHERE_MOTION[2], (2, 3), runs)


def test_the_sentence_tells_who_keeps_below_a_bound(runs: Runs) -> None:
    class OneIsLow(RigidRuns):
        def treated(self, kind: int, treatment: str) -> Response:
            return (
                self.response("type1-theory")
                if treatment == "identified"
                else super().treated(kind, treatment)
            )

    bound = SPHERE_ENERGY[3]

    def said(low: float, runs: Runs) -> str:
        theory = runs.response("type1-theory")
        return comparison_sentence(
            bound._replace(value=lambda response: low if response is theory else 1.0), (2, 3), runs
        )

    assert said(1e-9, OneIsLow()).endswith("and so is the identified treatment alone.")
    assert said(1.0, OneIsLow()).endswith("and none is.")
    assert comparison_sentence(bound._replace(value=lambda response: 0.0), (2, 3), runs).endswith(
        "and so are all."
    )


def test_largest_of_a_timeline(runs: Runs) -> None:
    response = runs.response("type1-theory")
    assert largest_of(history_column("position_m"))(response) == 4.0
    assert largest_of(lambda _: (np.zeros(3), np.array([1.0, np.nan, -2.0])))(response) == 2.0
