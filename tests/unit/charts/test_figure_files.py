"""Figures as files: the command `figures`, `run --figures`, and what they refuse."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from PIL import Image

import vibroimpact as vi
from many_runs import elastic, sensor
from support import plain_case
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.files import save_charts
from vibroimpact.charts.marks import Points
from vibroimpact.cli import main
from vibroimpact.report.page import replace_report_files
from vibroimpact.report.save_report import write_figures
from vibroimpact.results.result import result_of

RIGID = {"setup", "position", "force", "velocity", "acceleration", "force_indentation", "energy"}
ELASTIC = RIGID | {"sphere_energy", "plate_motion", "plate_energy", "deflection", "sensor_a_1"}


@pytest.fixture(autouse=True, scope="module")
def small() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("vibroimpact.charts.files._DPI", 40)
        patch.setattr("vibroimpact.results.deflection._FRAMES", 12)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("results") / "rigid"
    vi.simulate(vi.case_of(plain_case(run={"impacts": 2}))).save(place)
    return place


@pytest.fixture(scope="module")
def elsewhere(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[float]]:
    """The figures of the folder in all formats at another place, and how far they were
    while they were drawn.
    """
    fractions: list[float] = []
    place = tmp_path_factory.mktemp("elsewhere") / "deep" / "there"
    assert vi.save_figures(folder, ["png", "svg", "pdf"], place, fractions.append) == place
    return place, fractions


def run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *arguments: object
) -> tuple[int, str]:
    monkeypatch.setattr("sys.argv", ["vibroimpact", *map(str, arguments)])
    with pytest.raises(SystemExit) as left:
        main()
    written = capsys.readouterr()
    return int(left.value.code or 0), written.out + written.err


def test_a_result_folder_has_none_unless_asked(folder: Path) -> None:
    assert not (folder / "figures").exists()


@pytest.mark.slow
def test_figures_of_a_folder(
    folder: Path,
    elsewhere: tuple[Path, list[float]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """They are the same byte for byte, wherever and in whichever order of formats they
    are drawn.
    """
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    before = {path.name: path.read_bytes() for path in copy.iterdir()}
    assert run(monkeypatch, capsys, "figures", copy) == (0, f"wrote {copy / 'figures'}\n")
    assert {path.name for path in (copy / "figures").iterdir()} == {f"{name}.png" for name in RIGID}
    (copy / "figures" / "mine.txt").write_text("mine")
    status, _ = run(monkeypatch, capsys, "figures", copy, "--format", "svg, pdf")
    assert status == 0
    names = {f"{name}.{kind}" for name in RIGID for kind in ("png", "svg", "pdf")}
    assert {path.name for path in (copy / "figures").iterdir()} == names | {"mine.txt"}
    assert {path.name: path.read_bytes() for path in copy.iterdir() if path.is_file()} == before
    assert not list(copy.rglob(".*"))
    for name in RIGID:
        with Image.open(copy / "figures" / f"{name}.png") as picture:
            assert picture.format == "PNG"
            assert picture.width == 8 * 40
        assert (copy / "figures" / f"{name}.svg").read_text().lstrip().startswith("<?xml")
        assert (copy / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF")
    for name in names:
        assert (copy / "figures" / name).read_bytes() == (elsewhere[0] / name).read_bytes(), name


def test_formats_do_not_depend_on_each_other(tmp_path: Path) -> None:
    """What is drawn as pixels has one resolution in all formats, whichever was written first."""
    x = np.linspace(0.0, 1.0, 400)
    chart = Chart(
        "points",
        "Points",
        ((Panel(Axis("x", "m"), Axis("y", "m"), (Points(x, np.sin(9.0 * x)),)),),),
    )
    for name, formats in (("a", ["svg", "pdf", "png"]), ("b", ["png", "pdf", "svg"])):
        (tmp_path / name).mkdir()
        save_charts([chart], tmp_path / name, formats)
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes(), path.name


@pytest.mark.slow
def test_figures_may_go_elsewhere(folder: Path, elsewhere: tuple[Path, list[float]]) -> None:
    place, fractions = elsewhere
    assert len(list(place.iterdir())) == 3 * len(RIGID)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert not (folder / "figures").exists()


@pytest.mark.slow
def test_a_run_writes_them_when_it_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "case.toml").write_text(
        tomli_w.dumps(elastic(sensors=[sensor("a 1")], run={"impacts": 1}))
    )
    status, written = run(
        monkeypatch, capsys, "run", tmp_path / "case.toml", "-o", tmp_path / "out", "--figures"
    )
    assert status == 0
    assert written.rstrip().endswith(
        f"wrote {tmp_path / 'out' / 'report.html'}, and figures beside it"
    )
    names = {path.name for path in (tmp_path / "out" / "figures").iterdir()}
    assert names == {f"{name}.png" for name in ELASTIC} | {"plate.gif"}
    with Image.open(tmp_path / "out" / "figures" / "plate.gif") as picture:
        assert getattr(picture, "n_frames", 1) > 10


@pytest.mark.slow
def test_those_of_a_run_are_those_of_its_folder(tmp_path: Path) -> None:
    response = vi.simulate(vi.case_of(elastic(sensors=[sensor("a 1")])))
    response.save(tmp_path / "out")
    (tmp_path / "figures").mkdir()
    write_figures(result_of(response).report, tmp_path / "figures", ["png"])
    again = vi.save_figures(tmp_path / "out", output=tmp_path / "again")
    for path in again.iterdir():
        assert path.read_bytes() == (tmp_path / "figures" / path.name).read_bytes(), path.name


@pytest.mark.parametrize(
    ("formats", "words"),
    [
        ("svgg", 'no figures of the format "svgg"; there are png, svg, pdf. Did you mean "svg"?'),
        (",", "name a format"),
        ("png,gif", "gif"),
    ],
)
def test_a_format_that_there_is_not(
    formats: str,
    words: str,
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    status, written = run(
        monkeypatch, capsys, "figures", folder, "--format", formats, "-o", tmp_path / "none"
    )
    assert status == 2
    assert words in written
    assert not (tmp_path / "none").exists()


def test_folders_without_charts_are_refused(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    for place in (tmp_path / "empty", tmp_path / "nowhere"):
        with pytest.raises(vi.InputError, match="not a result folder"):
            vi.save_figures(place)
    (tmp_path / "paper").mkdir()
    (tmp_path / "paper" / "summary.json").write_text(json.dumps({"reproduction": ["table1"]}))
    with pytest.raises(vi.InputError, match="has its figures already, in"):
        vi.save_figures(tmp_path / "paper")
    (tmp_path / "file").write_text("x")
    with pytest.raises(vi.InputError, match="can't be made"):
        vi.save_figures(folder, output=tmp_path / "file")
    assert not list(tmp_path.rglob(".*"))


def test_a_failure_leaves_what_was_there(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    (copy / "figures").mkdir()
    (copy / "figures" / "force.png").write_bytes(b"older")

    def breaks(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr("vibroimpact.charts.files.save_charts", breaks)
    with pytest.raises(vi.InputError, match="can't be written"):
        vi.save_figures(copy)
    assert {path.name: path.read_bytes() for path in (copy / "figures").iterdir()} == {
        "force.png": b"older"
    }
    assert not list(copy.rglob(".*"))


def test_files_of_a_report_are_replaced_all_or_none(tmp_path: Path) -> None:
    (tmp_path / "old.txt").write_text("old")

    def fails(place: Path) -> None:
        (place / "new.txt").write_text("new")
        raise OSError("full")

    with pytest.raises(vi.InputError, match="full"):
        replace_report_files(tmp_path, fails, ("*.txt",))
    assert [path.name for path in tmp_path.iterdir()] == ["old.txt"]
