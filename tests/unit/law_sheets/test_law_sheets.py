"""The sheets and pictures of the contact laws: readable in a terminal, and never written over."""

from __future__ import annotations

from dataclasses import fields
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

import vibroimpact as vi
from support import one_in
from vibroimpact.charts.marks import Line, Points
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.cli import main
from vibroimpact.law_sheets.curves import law_chart
from vibroimpact.law_sheets.sheet import law_sheet, law_table
from vibroimpact.law_sheets.text import law_text, short_source

LAWS = vi.laws.contact_laws()


def printed(what: object, width: int) -> str:
    file = StringIO()
    Console(width=width, file=file).print(what)
    return file.getvalue()


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", "laws", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


@pytest.mark.parametrize("width", [80, 100, 160])
def test_the_table_names_every_law_whole(width: int) -> None:
    lines = printed(law_table(width), width).splitlines()
    assert max(map(len, lines)) <= width
    assert not any("\u2026" in line for line in lines)
    assert set(LAWS) <= {line.split()[0] for line in lines if line.strip()}
    assert "vibroimpact laws NAME" in lines[-1] + lines[-2]


@pytest.mark.parametrize("name", LAWS)
def test_the_sheet_reads_well(name: str) -> None:
    for width in (80, 160):
        text = printed(law_sheet(name), width)
        assert not any(
            mark in text for mark in ("\\", ":math:", ".. math", "`", "{", "}", "$", "\u2026")
        )
        assert max(map(len, text.splitlines())) <= width
    words = " ".join(text.split())
    for item in (*law_text(LAWS[name]).parameters, *law_text(LAWS[name]).state):
        assert item.name in words
    for heading in ("Parameters", "End of the contact", "Notes", "References"):
        assert heading in words
    assert short_source(LAWS[name])


def test_asked_and_achieved_are_shown() -> None:
    words = " ".join(printed(law_sheet("lankarani-nikravesh"), 100).split())
    assert "asked 0.9 0.7 0.5 0.3 achieved 0.913 0.796 0.725 0.684" in words
    assert "achieved" not in printed(law_sheet("hertz"), 100)


@pytest.mark.parametrize("name", one_in(8, LAWS))
def test_every_law_is_drawn(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, name, "-o", f"{name}.png") == 0
    with Image.open(f"{name}.png") as picture:
        assert picture.width == 1600
        assert 800 < picture.height < 1000
        assert len(picture.getcolors(1 << 20) or ()) > 20


@pytest.mark.parametrize("name", ["flores", "thornton", "jkr", "newton"])
def test_a_loop_encloses_the_energy_that_is_lost(name: str) -> None:
    """As the restitution beside it says, at the speeds of the loops; and all parameters
    are below the title.
    """
    law = LAWS[name]
    chart = law_chart(law)
    *left, right = chart.panels
    marked = [mark for mark in right.marks if isinstance(mark, Points)]
    curve = next(mark for mark in right.marks if isinstance(mark, Line))
    assert len(left) == (name != "newton")
    assert len(marked) == 3 * len(left)
    loops = {mark.role: mark for panel in left for mark in panel.marks if isinstance(mark, Line)}
    for point in marked:
        speed, restitution = float(point.x[0]), float(point.y[0])
        assert restitution == pytest.approx(
            np.interp(np.log(speed), np.log(curve.x), curve.y), abs=0.12 if name == "jkr" else 5e-3
        )
        loop = loops[point.role]
        lost = np.trapezoid(loop.y, loop.x)
        density = vi.find_material("steel" if name == "thornton" else "rock-paper").density
        radius = 1e-4 if name == "jkr" else 0.025
        energy = 0.5 * density * 4.0 / 3.0 * np.pi * radius**3 * speed**2
        assert lost == pytest.approx(energy * (1.0 - restitution**2), abs=1e-3 * energy)
    known = [item.name for item in fields(law) if not item.metadata["memory"]]
    assert all(f"{one} " in chart.subtitle for one in known if one != "dissipation_time")
    assert plotly_figure(chart).layout.title.text == name


def test_a_sheet_alone_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "hertz") == 0
    assert "Elastic contact" in capsys.readouterr().out
    assert not list(tmp_path.iterdir())


def test_a_picture_that_is_there_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "mine.png"
    target.write_bytes(b"mine")
    assert run(monkeypatch, "hertz", "-o", str(target)) == 2
    assert target.read_bytes() == b"mine"
    assert "mine.png is there already; --force replaces it" in capsys.readouterr().err
    assert run(monkeypatch, "hertz", "-o", str(target), "--force") == 0
    assert target.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("hertz", "-o", "nowhere/hertz.png"), "there is no folder nowhere"),
        (("hertz", "-o", "hertz.pdf"), "ends in .png"),
        (("hertz", "-o", "folder.png"), "this is a folder"),
        (("hetrz",), 'Did you mean "hertz"?'),
        (("-o", "all.png"), "name the law"),
    ],
)
def test_what_is_refused(
    arguments: tuple[str, ...],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.png").mkdir()
    assert run(monkeypatch, *arguments) == 2
    written = capsys.readouterr()
    assert message in written.err
    assert not written.out
    assert [path.name for path in tmp_path.iterdir()] == ["folder.png"]
