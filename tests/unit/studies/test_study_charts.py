"""The charts of a study: their values are those of its drops, which are told at each
point, with the command that runs them.
"""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.marks import Bars, Level, Line, Map, Points
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.charts.pack import pack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.cli import main
from vibroimpact.report.page import palette
from vibroimpact.studies.computation import compute_study as computing
from vibroimpact.studies.computation.chunk_file import ChunkResult
from vibroimpact.studies.computation.study import Study, load_study
from vibroimpact.studies.planning.drop_variables import OUTCOME
from vibroimpact.studies.planning.sweep_file import sweep_of
from vibroimpact.studies.report.outputs import study_outputs
from vibroimpact.studies.report.sensitivity_table import sensitivity_of
from vibroimpact.studies.run_sweep import run_sweep

LOSSY = {"law": "lankarani-nikravesh", "restitution": 0.7}
RADII = {"from": "5 mm", "to": "50 mm", "scale": "log"}
MATERIALS = ["granite", "glass", "steel"]
DRAWN = {
    "sphere.material": MATERIALS,
    "sphere.radius": RADII,
    "contact.restitution": {"distribution": "uniform", "from": 0.5, "to": 0.9},
}
PLATE = {
    "material": "steel",
    "model": "elastic",
    "size": ["500 mm", "400 mm", "8 mm"],
    "supports": "simply-supported",
    "modes": 6,
}


def study_of(folder: Path, sweep: Mapping[str, Any], **sections: Any) -> Study:
    table = {**plain_case(**{"contact": LOSSY, **sections}), "sweep": dict(sweep)}
    return load_study(run_sweep(sweep_of(table), folder / "study"))


def charts_of(study: Study) -> dict[str, Chart]:
    return study.charts


def drop_in(text: str) -> int:
    return int(text.split("\n")[0].split(",")[0].removeprefix("drop "))


def marks_of(chart: Chart, kind: Any, panel: int = 0) -> list[Any]:
    return [mark for mark in chart.panels[panel].marks if isinstance(mark, kind)]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Spheres of three materials, drawn."""
    return study_of(
        tmp_path_factory.mktemp("drawn"),
        {"over": DRAWN, "design": "latin-hypercube", "samples": 400},
    )


@pytest.fixture(scope="module")
def charts(drawn: Study) -> dict[str, Chart]:
    """The charts of what is drawn."""
    return charts_of(drawn)


# grids
# ------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """A grid of two radii and three restitutions."""
    return study_of(
        tmp_path_factory.mktemp("small"),
        {"over": {"sphere.radius": ["10 mm", "22.5 mm"], "contact.restitution": [0.5, 0.7, 0.6]}},
    )


def test_few_levels_are_lines_with_their_value_in_words(small: Study) -> None:
    chart = charts_of(small)["curves"]
    lines = marks_of(chart, Line)
    assert [line.name for line in lines] == [
        "radius of the sphere 10\u00a0mm",
        "radius of the sphere 22.5\u00a0mm",
    ]
    force = small.values("largest_force_N")
    for line, levels in zip(lines, force, strict=True):
        assert line.x.tolist() == [0.5, 0.6, 0.7]
        assert line.y.tolist() == levels[[0, 2, 1]].tolist()
    assert (chart.panels[0].x.label, chart.panels[0].title, chart.panels[0].y.unit) == (
        "Restitution asked",
        "Largest force",
        "N",
    )
    assert chart.caption.endswith("In the case: contact.restitution, sphere.radius.")


def test_each_point_tells_its_drop_its_keys_and_results(small: Study) -> None:
    (_, line, *_) = marks_of(charts_of(small)["curves"], Line)
    assert [drop_in(text) for text in line.texts] == [3, 5, 4]
    first = line.texts[0].replace("\u00a0", " ").split("\n")
    assert first[:3] == ["drop 3", "sphere.radius: 22.50 mm", "contact.restitution: 0.5000"]
    assert f"Largest force: {small.values('largest_force_N')[1, 0] / 1e3:.3f} kN" in first
    assert first[-1] == "vibroimpact run study.toml --drop 3 -o drop-3"


def test_many_levels_are_maps_whose_cells_tell_their_drop(tmp_path: Path) -> None:
    over = {
        "sphere.radius": {**RADII, "number": 8},
        "contact.restitution": {"from": 0.4, "to": 0.9, "number": 7},
    }
    study = study_of(tmp_path, {"over": over})
    chart = charts_of(study)["maps"]
    (cells,) = marks_of(chart, Map)
    assert np.array_equal(cells.values, study.values("largest_force_N").T)
    assert cells.x.tolist() == study.coordinates["sphere.radius"].tolist()
    assert chart.panels[0].x.log
    assert not chart.panels[0].y.log
    assert [drop_in(text) for text in cells.texts] == np.arange(56).reshape(8, 7).T.ravel().tolist()
    # both draw the cells where the levels are, whatever the scale
    (trace,) = [one for one in plotly_chart(chart)["data"] if one["xaxis"] == "x"]
    assert len(trace["x"]) == 9
    assert np.sqrt(trace["x"][1:] * trace["x"][:-1]) == pytest.approx(cells.x, rel=1e-9)
    assert np.shape(plotly_figure(chart).data[0].text) == (7, 8)


def test_one_key_is_a_line_an_impact(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"drop.height": ["3 m", "1 m", "2 m"]}})
    chart = charts_of(study)["curves"]
    lines = marks_of(chart, Line)
    assert [line.name for line in lines] == ["impact 1", "impact 2", "impact 3"]
    for impact, line in enumerate(lines):
        assert line.x.tolist() == [1.0, 2.0, 3.0]
        assert line.y.tolist() == study.values("max_force_N")[[1, 2, 0], impact].tolist()
    assert lines[1].texts[2].split("\n")[0] == "drop 0, impact 2"
    assert lines[1].marked


def test_many_levels_of_one_key_have_no_marks(tmp_path: Path) -> None:
    study = study_of(tmp_path, {"over": {"sphere.radius": {**RADII, "number": 41}}})
    assert not any(line.marked for line in marks_of(charts_of(study)["curves"], Line))


def test_laws_are_lines_and_names_along_an_axis_are_points(tmp_path: Path) -> None:
    over = {
        "contact.law": ["hunt-crossley", "flores"],
        "sphere.radius": ["10 mm", "20 mm", "30 mm"],
    }
    study = study_of(tmp_path / "laws", {"over": over})
    lines = marks_of(charts_of(study)["curves"], Line)
    assert [line.name for line in lines] == ["hunt-crossley", "flores"]
    assert lines[1].y.tolist() == study.values("largest_force_N")[1].tolist()
    alone = study_of(tmp_path / "alone", {"over": {"contact.law": ["hunt-crossley", "flores"]}})
    points = marks_of(charts_of(alone)["curves"], Points)
    assert points[0].x.tolist() == [0.0, 1.0]
    assert points[0].y.tolist() == alone.values("max_force_N")[:, 0].tolist()


def test_a_grid_of_many_keys_shows_drops_and_medians(tmp_path: Path) -> None:
    over = {
        "sphere.radius": ["10 mm", "20 mm"],
        "contact.restitution": [0.5, 0.6, 0.7],
        "drop.height": ["1 m", "2 m", "3 m", "4 m"],
    }
    study = study_of(tmp_path, {"over": over})
    force, charts = study.values("largest_force_N"), charts_of(study)
    chart = charts["largest_force_N"]
    (points,) = marks_of(chart, Points, 2)
    assert points.y.tolist() == force.ravel().tolist()
    assert points.x.tolist() == np.tile([1.0, 2.0, 3.0, 4.0], 6).tolist()
    (median,) = marks_of(chart, Line, 2)
    assert median.y.tolist() == np.median(force, axis=(0, 1)).tolist()
    # the radius and the height move the force most: the median over the restitution is drawn
    lines = marks_of(charts["curves"], Line)
    assert [line.y.tolist() for line in lines] == np.median(force, axis=1).tolist()
    assert not any(line.texts for line in lines)  # they are those of no single drop


# drawn points
# -----------------------------------------------------------------------------------------


def test_points_are_coloured_by_the_key_of_names(charts: dict[str, Chart]) -> None:
    chart = charts["largest_force_N"]
    for panel in range(3):
        groups = [mark for mark in marks_of(chart, Points, panel) if mark.keys]
        assert sorted(group.name for group in groups) == sorted(MATERIALS)
        assert len({group.role for group in groups}) == 3
        assert sum(len(group.x) for group in groups) == 400
    assert list(groups[0].keys) == [
        "Material of the sphere",
        "Radius of the sphere [mm]",
        "Restitution asked",
    ]
    named = [
        text.get_text()
        for legend in matplotlib_figure(chart).legends
        for text in legend.get_texts()
    ]
    assert set(MATERIALS) <= set(named)


def test_points_are_the_drops_that_they_tell(drawn: Study, charts: dict[str, Chart]) -> None:
    force, radius = drawn.values("largest_force_N"), drawn.coordinates["sphere.radius"]
    for group in marks_of(charts["largest_force_N"], Points, 1):
        numbers = [drop_in(text) for text in group.texts]
        assert group.y.tolist() == force[numbers].tolist()
        assert group.x.tolist() == radius[numbers].tolist()
        assert group.keys["Radius of the sphere [mm]"] == pytest.approx(
            1e3 * radius[numbers], rel=1e-12
        )
        assert {drawn.coordinates["sphere.material"][number] for number in numbers} == {group.name}


def test_histograms_count_all_drops(drawn: Study, charts: dict[str, Chart]) -> None:
    for panel in charts["outputs"].panels[:6]:
        (bars,) = [mark for mark in panel.marks if isinstance(mark, Bars)]
        assert bars.values.sum() == 400
    (low, high, middle) = (mark.value for mark in marks_of(charts["outputs"], Level))
    assert (low, middle, high) == tuple(np.percentile(drawn.values("largest_force_N"), (5, 50, 95)))
    counted = marks_of(charts["inputs"], Bars)[0]
    names = charts["inputs"].panels[0].x.names
    assert {name: int(count) for name, count in zip(names, counted.values, strict=True)} == {
        name: int((drawn.coordinates["sphere.material"] == name).sum()) for name in MATERIALS
    }


def test_restitution_is_that_of_each_impact(drawn: Study, charts: dict[str, Chart]) -> None:
    over, less = charts["restitution"].panels[:2]
    asked, achieved, speed = (
        drawn.values(name)
        for name in ("restitution_asked", "restitution_achieved", "approach_speed_m_s")
    )
    seen = 0
    for left, right in zip(over.marks, less.marks, strict=True):
        if isinstance(left, Points) and isinstance(right, Points):
            found = [re.match(r"drop (\d+), impact (\d)", text) for text in left.texts]
            drop, impact = np.array([[int(one[1]), int(one[2]) - 1] for one in found if one]).T
            assert left.x.tolist() == asked[drop, impact].tolist()
            assert left.y.tolist() == achieved[drop, impact].tolist()
            assert right.x.tolist() == speed[drop, impact].tolist()
            assert right.y == pytest.approx(left.y - left.x, abs=1e-15)
            seen += len(drop)
    assert seen == 1200


def test_bars_of_the_sensitivity_are_those_of_its_table(
    drawn: Study, charts: dict[str, Chart]
) -> None:
    found = sensitivity_of(drawn, study_outputs(drawn))
    assert found is not None
    chart = charts["sensitivity"]
    (bars,) = marks_of(chart, Bars)
    ranks = dict(zip(found.keys, found.rows["largest_force_N"]["rank_correlation"], strict=True))
    assert dict(zip(chart.panels[0].y.names, bars.values, strict=True)) == {
        "Radius of the sphere": ranks["sphere.radius"],
        "Restitution asked": ranks["contact.restitution"],
    }


@pytest.mark.slow
def test_a_large_study_stays_light(tmp_path: Path) -> None:
    study = study_of(
        tmp_path, {"over": DRAWN, "design": "sobol", "samples": 2**13, "keep": ["peaks"]}
    )
    assert (study.path.parent / "report.html").stat().st_size < 4e6
    for chart in study.charts.values():
        for panel in chart.panels:
            assert (
                sum(len(mark.x) for mark in panel.marks if isinstance(mark, Points) and mark.keys)
                <= 3000
            )


# signals
# ----------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_signals_are_laid_over_each_other_at_first_touch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ringing(
        table: Any, keep: Any, first: int, points: Mapping[str, Any], window: Any
    ) -> ChunkResult:
        touch = np.asarray(points["drop.height"], dtype=float) / 100.0
        since = np.arange(4001) / 50e3 - touch[:, None]
        signals = (
            np.where(since >= 0.0, np.cos(6e3 * since) * np.exp(-300.0 * since), 0.0)
            * touch[:, None]
        )
        arrays = {
            OUTCOME: np.ones(len(touch), np.int8),
            "a1_max_magnitude": touch,
            "first_time_s": touch,
        }
        return ChunkResult({**arrays, "signal_a1": signals.astype(np.float32)}, {})

    monkeypatch.setattr(computing, "compute_points", ringing)
    study = study_of(
        tmp_path,
        {"over": {"drop.height": ["1 m", "2 m", "3 m"]}, "keep": ["signals"]},
        plate=PLATE,
        sensors=[{"name": "a1", "position": [0.1, 0.05]}],
        run={"duration": 0.08},
    )
    chart = charts_of(study)["signal_a1"]
    lines = marks_of(chart, Line, 1)
    assert [line.name for line in lines] == [
        "drop 2, largest peak",
        "drop 1",
        "drop 0, smallest peak",
    ]
    for line, drop in zip(lines, (2, 1, 0), strict=True):
        moved = np.flatnonzero(line.y)[0]
        assert line.x[moved] == pytest.approx(0.0, abs=1.01 / 50e3)
        assert line.y.tolist() == study.values("signal_a1", drop)[-len(line.y) :].tolist()
    assert [view.name for view in chart.views] == ["the first 5.0\u00a0ms", "the first 40\u00a0ms"]
    (median,) = marks_of(chart, Line, 0)
    assert np.flatnonzero(np.abs(median.y) > 1e-6)[0] == np.searchsorted(median.x, -0.5 / 50e3)
    assert chart.panels[1].x.label == "Time since first touch"


# drops alone
# ------------------------------------------------------------------------------------------


def run(monkeypatch: pytest.MonkeyPatch, folder: Path, command: str) -> int:
    monkeypatch.chdir(folder)
    monkeypatch.setattr("sys.argv", shlex.split(command))
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


@pytest.mark.parametrize(
    ("sweep", "sections"),
    [
        ({"over": DRAWN, "design": "latin-hypercube", "samples": 30}, {}),
        (
            {"over": {"contact": [LOSSY, {"law": "hertz"}], "drop.position.x": [0.0, 0.01]}},
            {"drop": {"height": 1.0, "position": [0.0, 0.0]}},
        ),
        (
            {"over": {"plate.size.thickness": ["8 mm", "10 mm"], "drop.height": ["0.5 m", "1 m"]}},
            {"plate": PLATE, "run": {"impacts": 1}},
        ),
    ],
)
def test_the_command_of_a_drop_gives_its_results(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sweep: dict[str, Any], sections: dict[str, Any]
) -> None:
    study = study_of(tmp_path, sweep, **sections)
    number = study.size - 1
    chart = next(
        iter(chart for chart in study.charts.values() if chart.name not in ("inputs", "outputs"))
    )
    texts = [
        text
        for panel in chart.panels
        for mark in panel.marks
        for text in getattr(mark, "texts", ())
    ]
    (command,) = {text.split("\n")[-1] for text in texts if drop_in(text) == number}
    folder = study.path.parent
    assert run(monkeypatch, folder, command) == 0
    impacts = vi.load_result(folder / f"drop-{number}").impacts
    for column in ("max_force_N", "restitution_achieved", "time_s"):
        kept = study.values(column).reshape(study.size, -1)[number]
        assert impacts[column] == pytest.approx(kept[np.isfinite(kept)], rel=1e-7)


def test_a_drop_may_be_changed_and_must_exist(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    command = (
        "vibroimpact run paper:sweep --drop 13 --set drop.height='1 "
        "m' --set sphere.radius='20 mm' -o changed"
    )
    assert run(monkeypatch, tmp_path, command) == 0
    assert "[sweep]" not in capsys.readouterr().err
    case = vi.load_result(tmp_path / "changed").case
    assert (case["drop"]["height"], case["sphere"]["radius"], case["contact"]["restitution"]) == (
        1.0,
        0.02,
        0.95,
    )
    assert run(monkeypatch, tmp_path, "vibroimpact run paper:sweep --drop 140") == 2
    assert (
        "paper:sweep: there is no drop 140; the study has 140, counted from 0"
        in capsys.readouterr().err
    )
    assert run(monkeypatch, tmp_path, "vibroimpact run paper:type1-theory --drop 0") == 2
    assert "paper:type1-theory: sweep: it is missing" in capsys.readouterr().err


def test_a_run_tells_that_it_leaves_the_study_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, tmp_path, "vibroimpact run paper:sweep --set run.impacts=1 --json") == 0
    said = capsys.readouterr()
    assert said.out.startswith("{")
    words = "vibroimpact sweep paper:sweep runs the study, and --drop N one of its drops"
    assert f"vibroimpact: [sweep] is left out, as this is a single drop; {words}\n" in said.err


# where they are shown
# ---------------------------------------------------------------------------------


def test_a_study_in_a_notebook(drawn: Study) -> None:
    figure = drawn.plot("restitution")
    assert figure.layout.title.text == "Restitution asked and achieved"
    assert drawn.plot().layout.title.text == "Sampled keys"
    with pytest.raises(
        vi.InputError, match='there is no chart "restituton"; there are inputs, '
    ) as told:
        drawn.plot("restituton")
    assert told.value.message.endswith('Did you mean "restitution"?')
    html = drawn._repr_html_()
    assert "400 drops; none failed." in html
    assert "<td>Largest force</td><td>kN</td><td>400</td>" in html


def test_names_that_are_markup_are_shown_as_they_are(tmp_path: Path) -> None:
    name = "<script>alert(1)</script> $\\frac{$ " + 100 * "a"
    study = study_of(tmp_path, {"over": {"sphere.radius": ["10 mm", "20 mm"]}}, name=name)
    html = study._repr_html_()
    assert "<script" not in html
    assert "&lt;script&gt;alert(1)" in html
    assert "<script>alert" not in (study.path.parent / "report.html").read_text(encoding="utf-8")


def test_keys_that_are_markup_are_shown_as_they_are(drawn: Study, tmp_path: Path) -> None:
    """A table of supports may have any key, and a name any letters."""
    hostile = "<b>$\\frac{$\n" + 300 * "a"
    coordinates = {
        **drawn.coordinates,
        "sphere.material": np.where(
            drawn.coordinates["sphere.material"] == "glass", hostile, "$x$"
        ),
    }
    study = replace(drawn, coordinates=coordinates)
    for chart in [
        chart
        for chart in study.charts.values()
        if chart.name in ("inputs", "largest_force_N", "restitution")
    ]:
        matplotlib_figure(chart).draw_without_rendering()
        words = json.dumps(
            [
                [*trace.get("text", []), trace.get("name", "")]
                for trace in plotly_chart(chart)["data"]
            ]
        )
        assert "<b>" not in words
        assert "a" * 200 not in words
        plotly_figure(chart)


@pytest.mark.slow
def test_no_figure_is_drawn_for_a_report(drawn: Study) -> None:
    program = """
import sys
from pathlib import Path
from vibroimpact.studies.report.write_report import write_study_report
from vibroimpact.studies.computation.study import load_study
folder = Path(sys.argv[1])
write_study_report(load_study(folder))
print([name for name in sys.modules if name.split(".")[0] in ("matplotlib", "plotly")])
"""
    done = subprocess.run(
        [sys.executable, "-c", program, str(drawn.path.parent)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "[]"


_COLOURED = """
const fs = require("fs"), vm = require("vm");
for (const script of ["arrays.js", "charts.js"]) vm.runInThisContext(fs.readFileSync(`${process.argv[1]}/${script}`, "utf8"));
const block = fs.readFileSync(process.argv[2]);
const { chart, palette } = vibroimpact.unpack(block.buffer.slice(block.byteOffset, block.byteOffset + block.length));
vibroimpact.setPalette(palette);
const { data, layout } = vibroimpact.complete(chart, { view: null, ranges: {}, key: process.argv[3], width: Number(process.argv[4]) });
const told = data.map(({ name, x, text, marker, showlegend, xaxis }) => ({ name, x: Array.from(x), text, marker, showlegend, xaxis }));
console.log(JSON.stringify({ data: told, layout }));
"""


def in_a_page(chart: Chart, folder: Path, key: str, width: int = 1200) -> Any:
    scripts = Path(vi.__file__).parent / "charts" / "scripts"
    (folder / "block").write_bytes(pack({"chart": plotly_chart(chart), "palette": palette()}))
    command = [
        str(shutil.which("node")),
        "-e",
        _COLOURED,
        str(scripts),
        str(folder / "block"),
        key,
        str(width),
    ]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


@pytest.mark.skipif(
    shutil.which("node") is None, reason="runs the script of a page, which needs node"
)
def test_a_page_colours_points_by_the_key_that_is_chosen(
    drawn: Study, charts: dict[str, Chart], tmp_path: Path
) -> None:
    chart, radius = charts["largest_force_N"], drawn.coordinates["sphere.radius"]
    by_radius = in_a_page(chart, tmp_path, "Radius of the sphere [mm]")
    scale = by_radius["layout"]["coloraxis9"]
    assert (scale["cmin"], scale["cmax"]) == pytest.approx(
        (1e3 * radius.min(), 1e3 * radius.max()), rel=1e-6
    )
    points = [trace for trace in by_radius["data"] if trace.get("text") and trace["xaxis"] == "x2"]
    for trace in points:
        # that is what the second panel is over
        assert trace["marker"]["color"] == pytest.approx(trace["x"], rel=1e-6)
        assert not trace["showlegend"]
    assert sum(len(trace["x"]) for trace in points) == 400
    by_name = in_a_page(chart, tmp_path, "Material of the sphere")
    legend = {
        trace["name"]: trace["marker"]["color"]
        for trace in by_name["data"]
        if trace["x"] == [None] and trace["name"] in MATERIALS
    }
    assert len(set(legend.values())) == 3
    for trace in by_name["data"]:
        if trace.get("text"):
            found = re.findall(r"sphere.material: (\w+)", " ".join(trace["text"]))
            assert trace["marker"]["color"] == [legend[name] for name in found]


@pytest.mark.skipif(
    shutil.which("node") is None, reason="runs the script of a page, which needs node"
)
def test_panels_lie_below_each_other_on_a_narrow_screen(
    charts: dict[str, Chart], tmp_path: Path
) -> None:
    chart = charts["largest_force_N"]
    wide, narrow = (in_a_page(chart, tmp_path, "", width)["layout"] for width in (1200, 390))
    assert wide["xaxis"]["domain"][1] < wide["xaxis2"]["domain"][0]
    domains = [narrow[f"yaxis{suffix}"]["domain"] for suffix in ("", "2", "3")]
    assert all(narrow[f"xaxis{suffix}"]["domain"] == [0, 1] for suffix in ("", "2", "3"))
    assert all(low > high for (low, _), (_, high) in pairwise(domains))
    assert narrow["height"] > wide["height"]
