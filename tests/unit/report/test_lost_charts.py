"""What a run has computed is written whatever a chart does: the chart that is lost is
named by the page and by the command.
"""

from __future__ import annotations

import ast
import json
import warnings
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts import files as chart_files
from vibroimpact.charts.made import drawn, made_charts, made_scene
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.cli import main
from vibroimpact.errors import ChartWarning
from vibroimpact.runs import charts as run_charts_module
from vibroimpact.runs import report as run_report_module

SOURCE = Path(vi.__file__).parent


def fails(*_: object, **__: object) -> Any:
    raise ZeroDivisionError("no width")


def elastic_case(**changes: object) -> dict:
    plate = {
        "size": [0.52, 0.42, 0.008],
        "material": "steel",
        "model": "elastic",
        "modes": 6,
        "supports": "clamped",
        "damping": 0.01,
    }
    given = {
        "sensors": [{"name": "a1", "position": [0.1, 0.05], "rate": "5 kHz"}],
        "run__impacts": 1,
        **changes,
    }
    return plain_case(plate=plate, **given)


def run(case: dict, folder: Path, *options: str, monkeypatch: pytest.MonkeyPatch) -> int:
    (folder / "case.toml").write_text(tomli_w.dumps(case))
    monkeypatch.chdir(folder)
    monkeypatch.setattr("sys.argv", ["vibroimpact", "run", "case.toml", "-o", "out", *options])
    with warnings.catch_warnings(), pytest.raises(SystemExit) as ended:
        main()
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_a_sensor_without_a_sample_after_the_touch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quarter of a sample a second, in half a second: its signal is one sample, before
    the touch, and has no spectrum.
    """
    slow = {"name": "slow", "position": [0.1, 0.05], "rate": 0.25}
    assert (
        run(
            elastic_case(run__impacts=None, run__duration=0.5, sensors=[slow]),
            tmp_path,
            monkeypatch=monkeypatch,
        )
        == 0
    )
    assert "could not be drawn" not in (tmp_path / "out/report.html").read_text()


@pytest.mark.slow
def test_charts_that_raise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One that can't be made, one that can't be drawn in the page, one that can't be
    drawn as a file, and the plate in motion.
    """

    def draws_no_energy(chart: vi.charts.chart.Chart) -> Any:
        return fails() if chart.name == "energy" and chart.panels[0].marks else plotly_chart(chart)

    def draws_no_force(chart: vi.charts.chart.Chart) -> Any:
        return fails() if chart.name == "force" else figure(chart)

    figure = chart_files.matplotlib_figure
    monkeypatch.setattr(run_charts_module, "sensor_chart", fails)
    monkeypatch.setattr("vibroimpact.report.page.plotly_chart", draws_no_energy)
    monkeypatch.setattr(chart_files, "matplotlib_figure", draws_no_force)
    monkeypatch.setattr(run_report_module, "scene_of", fails)
    monkeypatch.setattr("vibroimpact.runs.animation.animate", fails)
    assert run(elastic_case(), tmp_path, "--figures", monkeypatch=monkeypatch) == 0
    told, page = capsys.readouterr().err, (tmp_path / "out/report.html").read_text()
    for name in ("sensor_a1", "energy", "force", "plate_in_motion"):
        assert (
            f"vibroimpact: the chart {name} could not be drawn: ZeroDivisionError: no width" in told
        )
    assert (
        page.count('<p class="note">This chart could not be drawn: ZeroDivisionError: no width</p>')
        == 3
    )
    for name in ("sensor_a1", "energy", "plate_in_motion"):
        assert f'<figure id="{name}">' in page
    result = vi.load_result(tmp_path / "out")
    assert len(result.impacts["time_s"]) == 1
    assert len(result.signals["a1"].value) > 1
    figures = {file.name for file in (tmp_path / "out/figures").iterdir()}
    assert {"energy.png", "sensor_a1.png"} <= figures
    assert not {"force.png", "plate.gif"} & figures


def test_a_calibration_whose_chart_raises(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    what = vi.calibration.load_calibration("paper:type1-theory")
    monkeypatch.setattr("vibroimpact.calibration.charts._parameter_chart", fails)
    with pytest.warns(ChartWarning, match="the chart parameter could not be drawn"):
        folder = vi.calibration.calibrate_case(what).save(tmp_path / "found")
    assert json.loads((folder / "calibration.json").read_text())["parameter"] == "damping_max"
    assert "could not be drawn" in (folder / "report.html").read_text()


@pytest.mark.slow
def test_every_list_of_charts_and_every_page_is_made_so() -> None:
    """Of run, sweep, calibrate, modes, dataset, recognise, identify, correlate, bound and
    compare, and of what comes later.
    """
    lists = 0
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if (
                isinstance(node, ast.FunctionDef)
                and node.returns is not None
                and ast.unparse(node.returns) == "list[Chart]"
            ):
                assert node.name == "made_charts" or "made_charts(" in ast.unparse(node), (
                    f"{path}: {node.name}"
                )
                lists += 1
    assert lists > 10


@pytest.mark.parametrize(
    "error", [MemoryError(), vi.InputError("too many"), RecursionError("x" * 5000)]
)
def test_any_error_is_one_sentence(error: Exception) -> None:
    def raises() -> Any:
        raise error

    with pytest.warns(ChartWarning) as seen:
        (lost,) = made_charts({"force_indentation": raises, "nothing": lambda: None})
    with pytest.warns(ChartWarning) as seen_too:
        scene, (instead,) = made_scene(raises)
    page = drawn(lost, plotly_chart)
    assert scene is None
    assert (lost.title, instead.title, page["name"]) == (
        "Force indentation",
        "Plate in motion",
        "force_indentation",
    )
    assert all(len(str(one.message)) < 300 for one in (*seen, *seen_too))


def test_ctrl_c_is_no_lost_chart() -> None:
    def interrupted() -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        made_charts({"force": interrupted})
