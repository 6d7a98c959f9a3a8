"""Files that the browser saves: those that the commands write."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

import vibroimpact as vi
from live_page import ELASTIC, RIGID
from vibroimpact.app.saved import files_of
from vibroimpact.app.state import State, state_of
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.files import FORMATS
from vibroimpact.charts.marks import Line
from vibroimpact.errors import InputError
from vibroimpact.exporting.export_format import export_formats
from vibroimpact.exporting.export_result import export_result
from vibroimpact.figures import save_figures


@pytest.fixture(scope="module")
def rigid() -> State:
    return state_of(RIGID, "full", lambda what, part: None)


@pytest.fixture(scope="module")
def elastic() -> State:
    return state_of(ELASTIC, "full", lambda what, part: None)


def content_of(state: State, kind: str, **asked: str) -> tuple[str, bytes]:
    (file,) = files_of(kind, asked, state, {})["files"]
    return file["name"], file["bytes"].tobytes()


@pytest.mark.parametrize("name", ["adams", "csv", "exudyn", "lammps", "mujoco", "yade", "vtu"])
def test_an_export_is_what_the_command_writes(name: str, elastic: State, tmp_path: Path) -> None:
    folder = vi.simulate(elastic.case.to_problem()).save(tmp_path / "run")
    written = export_result(folder, name, tmp_path / "exported")
    file, content = content_of(elastic, "export", format=name)
    if len(written) == 1:
        assert (file, content) == (written[0].name, written[0].read_bytes())
        return
    assert file == f"an-elastic-drop-{name}.zip"
    with ZipFile(BytesIO(content)) as archive:
        assert {member: archive.read(member) for member in archive.namelist()} == {
            one.relative_to(tmp_path / "exported").as_posix(): one.read_bytes() for one in written
        }


def test_the_limits_of_a_format_are_told(rigid: State) -> None:
    found = files_of("export", {"format": "csv"}, rigid, {})
    assert found["notes"] == [
        "The tables contain the results of the drop, not its bodies and its contact law."
    ]


@pytest.mark.parametrize("name", list(FORMATS))
def test_a_figure_is_the_one_of_a_result_folder(name: str, rigid: State, tmp_path: Path) -> None:
    folder = vi.simulate(rigid.case.to_problem()).save(tmp_path / "run")
    expected = save_figures(folder, [name]) / f"force.{name}"
    file, content = content_of(rigid, "figure", chart="force", format=name)
    assert file == f"a-rigid-drop-force.{name}"
    assert content == expected.read_bytes()


def test_charts_of_a_measurement_are_figures_too(rigid: State) -> None:
    line = Line(np.array([0.0, 1.0]), np.array([5.0, 7.0]))
    panel = Panel(Axis("Time", "s"), Axis("Force", "N"), (line,))
    chart = Chart("record", "Measured force", ((panel,),))
    asked = {"chart": "record", "format": "svg"}
    (file,) = files_of("figure", asked, rigid, {"record": chart})["files"]
    assert file["name"] == "a-rigid-drop-record.svg"
    assert b"<svg" in file["bytes"].tobytes()


@pytest.mark.parametrize(
    ("kind", "asked", "words"),
    [
        ("export", {"format": "lamps"}, 'Did you mean "lammps"'),
        ("figure", {"chart": "force", "format": "gif"}, "there are png, svg, pdf"),
        ("figure", {"chart": "forse", "format": "png"}, 'there is no chart "forse"; there are'),
        ("export", {"format": "wav"}, "no sensors"),
    ],
)
def test_what_there_is_not_is_refused(
    kind: str, asked: dict[str, str], words: str, rigid: State
) -> None:
    with pytest.raises(InputError) as refused:
        files_of(kind, asked, rigid, {})
    assert words.lower() in str(refused.value).lower()


def test_every_format_is_offered() -> None:
    from vibroimpact.app.offer import offer

    assert list(offer()["exports"]) == list(export_formats())
