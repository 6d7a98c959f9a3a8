"""The folder of a reproduction: part by part, each whole or not at all, and what the
commands make of it.
"""

from __future__ import annotations

import csv
import json
import re
import shlex
import shutil
import zlib
from base64 import b64decode
from collections.abc import Callable
from html import unescape
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vibroimpact as vi
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.pack import unpack
from vibroimpact.cli import main
from vibroimpact.files.check_sums import read_sealed, sealed
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report import folder as module
from vibroimpact.paper.report.blocks import blocks_of
from vibroimpact.paper.report.counts import kind_counts, range_widths, verdict_counts
from vibroimpact.paper.report.docs_page import write_docs_page
from vibroimpact.paper.report.folder import (
    missing_parts,
    reproduce_paper,
    write_reproduction_report,
)
from vibroimpact.paper.report.markdown_report import markdown_report
from vibroimpact.paper.report.outline import (
    PARTS,
    RenderedPart,
    ReportPart,
    find_parts,
    render_part,
)
from vibroimpact.paper.report.reproduction import is_reproduction, load_reproduction
from vibroimpact.paper.report_section import ComparedValue, Kind, ReportSection, Verdict
from vibroimpact.paper.runs import Runs
from vibroimpact.report.page import plotly_script
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Figure, Heading, Paragraph, Report, Section, Table

QUICK = ["table1", "section3.1", "fig4"]
COLUMNS = "part,name,what,place,read,unit,relation,printed,by,computed,difference,allowed,verdict,why,kind,range_low,range_high"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return reproduce_paper(tmp_path_factory.mktemp("reproduction") / "deep" / "paper", QUICK)


@pytest.fixture
def copy(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "paper"))


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let there be no parts but two quick ones."""
    monkeypatch.setattr(module, "PARTS", {name: PARTS[name] for name in ("table1", "corrections")})


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def contents(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in names(folder)}


def raises(error: BaseException) -> Callable[..., Any]:
    def broken(*_: Any, **__: Any) -> Any:
        raise error

    return broken


def command(monkeypatch: pytest.MonkeyPatch, *words: str | Path) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", *map(str, words)])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


# what it holds
#
#
#
# --------------------------------------------------------------------------------------------------------


def test_holds_what_it_should(made: Path) -> None:
    figures = {"figures/fig4.png", "parts/fig4.chart"}
    assert names(made) == {
        "summary.json",
        "report.md",
        "report.html",
        "values.csv",
        *(f"parts/{name}.json" for name in QUICK),
        *figures,
    }
    assert [path.name for path in made.parent.iterdir()] == ["paper"]
    assert is_reproduction(made)
    assert json.loads((made / "summary.json").read_text())["version"] == vi.__version__
    assert missing_parts(made) == [name for name in PARTS if name not in QUICK]
    assert list(load_reproduction(made).parts) == [name for name in PARTS if name in QUICK]


def test_values_are_a_table_of_numbers(made: Path) -> None:
    text = (made / "values.csv").read_text(encoding="utf-8")
    assert text.startswith(COLUMNS + "\n")
    rows = list(csv.DictReader(text.splitlines()))
    kept = load_reproduction(made).values
    assert [row["part"] for row in rows] == ["table1"] * 14 + ["section3.1"] * 3
    for row, before in zip(rows, kept, strict=True):
        assert [float(row[name]) for name in ("computed", "difference", "allowed")] == [
            before[n] for n in ("computed", "difference", "allowed")
        ]
        assert float(row["printed"]) > 0.0
        assert row["verdict"] in [verdict.value for verdict in Verdict]
        assert row["why"] or row["verdict"] == Verdict.REPRODUCED.value


def test_the_report_holds_its_parts_and_names_the_others(made: Path) -> None:
    text = (made / "report.md").read_text(encoding="utf-8")
    assert re.findall(r"^##+ (.*)", text, flags=re.M) == [
        "The inputs",
        "Table 1: the inputs",
        "Section 3.1: the contact",
        "Type 1: repeated impacts of rigid bodies",
        "Figure 4: position of the sphere's centre, theory and constant damping",
    ]
    missing = missing_parts(made)
    assert f"Not made yet: {', '.join(missing)}. `vibroimpact reproduce -o DIR` makes them." in text
    assert "| All | 16 | 0 | 0 | 1 |" in text


def data_of(page: str) -> dict[str, Any]:
    """The charts that lie in a page."""
    found = re.search(r'id="data">([^<]*)<', page)
    assert found
    return dict(unpack(zlib.decompress(b64decode(found[1]))))


def test_the_page_needs_nothing_else(made: Path) -> None:
    page = (made / "report.html").read_text(encoding="utf-8")
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert policy
    assert unescape(policy[1]).startswith("default-src 'none'; script-src 'sha256-")
    assert "<img" not in page
    links = re.findall(r'href="#([^"]*)"', page)
    assert links == ["the-inputs", "type-1-repeated-impacts-of-rigid-bodies"]
    # the last heading is that of a fold
    assert re.findall(r'<h2 id="([^"]*)"', page) == [*links, "provenance"]
    assert not re.search(
        r"""(?:src|href)=["'](?!data:|#)|url\(|https?://|<link|@import""",
        page.partition("<script")[0],
    )
    assert page.count('<td class="text wrapped good">reproduced</td>') == 16
    assert re.search(
        r'<td class="text wrapped bad">not reproduced: with the printed one the first '
        r"rebound would be [^<]*</td>",
        page,
    )
    assert len(page) < len(plotly_script())


def test_the_page_has_the_chart_in_the_place_of_its_image(made: Path) -> None:
    page = (made / "report.html").read_text(encoding="utf-8")
    (chart,) = data_of(page)["charts"]
    kept = unpack((made / "parts" / "fig4.chart").read_bytes())
    assert (chart["name"], chart["title"], chart["caption"]) == (
        kept["name"],
        kept["title"],
        kept["caption"],
    )
    for drawn, there in zip(chart["data"], kept["data"], strict=True):
        assert drawn["y"].tolist() == there["y"].tolist()
        assert drawn["origins"] == there["origins"]
    assert re.findall(r'<div class="chart" data-chart="([^"]*)"', page) == ["fig4"]
    # its title and caption are there once, besides what is read to those who do not see it
    title, caption = chart["title"].replace("'", "&#39;"), chart["caption"]
    assert page.count(f"<h3>{title}</h3>") == page.count(f"<figcaption>{caption}</figcaption>") == 1
    assert chart["title"] not in page
    assert page.count(f"<p>{caption}</p>") == 0
    assert re.findall(r"<option value=\"(-?\d)\">([^<]*)<", page)[:2] == [
        ("-1", "whole run"),
        ("0", "Impact 1"),
    ]


def test_a_text_is_kept_around_its_chart() -> None:
    image = '![Title: a "b"](figures/fig4.png)\n\nThe caption.\n'
    chart = Chart("fig4", 'Title: a "b"', (), "The caption.")
    # a heading that is the title of the chart is not repeated, another one stays
    repeated = f'### Title: a "b"\n\n{image}\nBetween \\<i\\> \\*x\\*.\n'
    assert blocks_of(repeated, chart) == [Figure(chart), Paragraph("Between <i> *x*.")]
    other = f"### Other\n\nBefore.\n\n{image}"
    assert blocks_of(other, chart) == [Heading("Other"), Paragraph("Before."), Figure(chart)]


def test_a_table_of_a_text_has_its_title_and_cells() -> None:
    (table,) = blocks_of(
        "**The masses \\[kg\\]**\n\n| body | mass |\n| --- | --- |\n| a\\|b |  |\n"
    )
    assert isinstance(table, Table)
    assert table.title == "The masses [kg]"
    assert [column.heading for column in table.columns] == ["body", "mass"]
    assert [list(column.cells) for column in table.columns] == [["a|b"], [""]]


def test_verdicts_have_colours_and_words_have_none() -> None:
    cells = [
        "reproduced",
        "explained: by |samples|",
        "fitted",
        "not reproduced",
        "not reproduced: x < 1",
        "explained here",
        "not fitted",
    ]
    text = "| Value | Verdict |\n| --- | --- |\n" + "".join(
        f"| mass | {cell.replace('|', chr(92) + '|')} |\n" for cell in cells
    )
    (table,) = blocks_of(text)
    assert isinstance(table, Table)
    assert list(table.columns[1].cells) == cells
    assert list(table.columns[1].tones) == ["good", "fair", "soft", "bad", "bad", "", ""]
    page = page_of_report(Report("Values", (Section("values", "Values", (table,)),), {}))
    for tone in ("good", "fair", "soft", "bad"):
        assert f".{tone} {{ color" in page
        assert f'<td class="text wrapped {tone}">' in page


def test_counts_tell_each_verdict_apart() -> None:
    def part(*verdicts: Verdict) -> RenderedPart:
        ranges = {"kind": "result", "printed": "-2", "range_low": -3.0, "range_high": -2.0}
        rows = [{"verdict": verdict.value, **ranges} for verdict in verdicts]
        return RenderedPart("T|1", "A text.\n", rows, None)

    parts = {
        "table1": part(*Verdict),
        "fig3": part(),
        "section3.2": part(Verdict.FITTED, Verdict.FITTED),
    }
    assert {name: list(by.values()) for name, by in verdict_counts(parts).items()} == {
        "table1": [1, 1, 1, 1],
        "section3.2": [0, 0, 2, 0],
        "all": [1, 1, 3, 1],
    }
    assert "| T\\|1 | 1 | 1 | 1 | 1 |" in markdown_report(parts)
    assert (
        verdict_counts({"fig3": part()})
        == kind_counts({"fig3": part()})
        == range_widths({"fig3": part()})
        == {}
    )
    assert {
        name: list(by.values()) for name, by in kind_counts(parts).items() if any(by.values())
    } == {"result": [1, 1, 3, 1]}
    assert list(kind_counts(parts)) == [kind.value for kind in Kind]
    assert range_widths(parts) == {"table1": (1, 0.5, 0.5)}
    assert "| T\\|1 | 1 | 50 % | 50 % |" in markdown_report(parts)
    assert "| Part |" not in markdown_report({"fig3": part()})
    assert "Not made yet" not in markdown_report({name: part() for name in PARTS})


def test_a_part_is_text_values_and_figure(made: Path) -> None:
    runs = Runs()
    table1, fig3 = PARTS["table1"], PARTS["fig3"]
    both = render_part(ReportPart("fig3", table1.section, fig3.chart), runs)
    assert both.title == "Table 1: the inputs"
    assert re.findall(r"^#.*", both.text, flags=re.M) == ["### Table 1: the inputs"]
    assert "](figures/fig3.png)" in both.text
    assert both.chart is not None
    assert both.chart.name == "fig3"
    assert {row["part"] for row in both.rows} == {"fig3"}
    drawn = render_part(fig3, runs)
    assert drawn.text.startswith(f"### {drawn.title}\n")
    assert drawn.title.startswith("Figure 3: ")
    assert drawn.rows == []
    assert render_part(table1, runs).chart is None


def test_a_bound_has_neither_difference_nor_allowance() -> None:
    bound = ComparedValue(
        printed("type2.energy_left"), 88.0, by="a calculation", otherwise="unknown"
    )
    value = ComparedValue(
        printed("type2.max_force"), 4000.0, by="a calculation", otherwise="unknown"
    )
    rows = render_part(
        ReportPart("both", lambda runs: ReportSection("A title", rows=(bound, value))), Runs()
    ).rows
    assert [row["relation"] for row in rows] == ["<", "="]
    assert (
        [row["difference"] is None for row in rows]
        == [row["allowed"] is None for row in rows]
        == [True, False]
    )
    assert [(row["printed"], row["computed"], row["why"]) for row in rows] == [
        ("6", 88.0, "unknown"),
        ("3582.036", 4000.0, "unknown"),
    ]


# adding to it, and replacing it
# ---------------------------------------------------------------------------------------


def test_parts_are_added_and_the_others_stay(copy: Path) -> None:
    before = contents(copy)
    assert reproduce_paper(copy, ["fig3", "table1"]) == copy
    after = contents(copy)
    new = {"parts/fig3.json", "parts/fig3.chart", "figures/fig3.png"}
    assert after.keys() - before.keys() == new
    assert {name for name in before if before[name] != after[name]} == {"report.md", "report.html"}
    text = (copy / "report.md").read_text(encoding="utf-8")
    assert text.index("### Section 3.1") < text.index("### Figure 3") < text.index("### Figure 4")


@pytest.mark.usefixtures("few")
def test_it_goes_on_with_what_is_missing(copy: Path) -> None:
    before = contents(copy)
    told: list[float] = []
    reproduce_paper(copy, progress=told.append)
    after = contents(copy)
    assert after.keys() - before.keys() == {"parts/corrections.json"}
    assert after["parts/table1.json"] == before["parts/table1.json"]
    assert told == [0.0, 1.0]
    with pytest.raises(
        vi.InputError, match=r"all parts are there already; .* --only, or all with --force"
    ):
        reproduce_paper(copy)
    assert contents(copy) == after


@pytest.mark.usefixtures("few")
def test_parts_of_another_version_are_missing(copy: Path) -> None:
    part = copy / "parts" / "table1.json"
    whole = part.read_text(encoding="utf-8")
    part.write_text(
        whole.replace(f'"version": "{vi.__version__}"', '"version": "0"'), encoding="utf-8"
    )
    assert missing_parts(copy) == ["table1", "corrections"]
    reproduce_paper(copy)
    assert part.read_text(encoding="utf-8") == whole
    assert missing_parts(copy) == []


@pytest.mark.usefixtures("few")
def test_force_makes_all_anew(copy: Path) -> None:
    told: list[float] = []
    reproduce_paper(copy, force=True, progress=told.append)
    assert names(copy) == {
        "summary.json",
        "report.md",
        "report.html",
        "values.csv",
        "parts/table1.json",
        "parts/corrections.json",
    }
    assert told == [0.0, 0.5, 1.0]
    reproduce_paper(copy, "corrections", force=True)  # which has no values
    assert names(copy) == {"summary.json", "report.md", "report.html", "parts/corrections.json"}
    assert [path.name for path in copy.parent.iterdir()] == ["paper"]


@pytest.mark.parametrize("force", [False, True])
def test_other_folders_and_files_are_refused(tmp_path: Path, force: bool) -> None:
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "summary.json.txt").write_text("years")
    (tmp_path / "file").write_text("x")
    before = contents(tmp_path)
    for name, words in (("thesis", "is not a result folder"), ("file", "not a folder")):
        with pytest.raises(vi.InputError, match=words):
            reproduce_paper(tmp_path / name, ["table1"], force=force)
    assert contents(tmp_path) == before
    with pytest.raises(vi.InputError, match="not the folder of a reproduction"):
        load_reproduction(tmp_path / "thesis")


def test_the_result_of_a_run_is_not_added_to(tmp_path: Path, theory: vi.Response) -> None:
    with_result = tmp_path / "theory"
    with_result.mkdir()
    for text in ('{"name": "theory"}', '{"reproduction": false}', "[1]", "\x00"):
        (with_result / "summary.json").write_text(text)
        with pytest.raises(vi.InputError, match="is there already"):
            reproduce_paper(with_result, ["table1"])
        assert names(with_result) == {"summary.json"}


def test_unknown_parts_are_told_before_anything_is_made(tmp_path: Path) -> None:
    with pytest.raises(vi.InputError) as refused:
        reproduce_paper(tmp_path / "paper", ["table1", "tabel2"])
    assert str(refused.value).startswith(
        'there is no part "tabel2"; there are table2, table1, section3.1, '
    )
    assert str(refused.value).endswith('. Did you mean "table2"?')
    with pytest.raises(vi.InputError, match="name at least one of table1, "):
        reproduce_paper(tmp_path / "paper", [])
    assert not list(tmp_path.iterdir())
    assert [part.name for part in find_parts(["fig4", "fig4", "table1"])] == ["table1", "fig4"]


# what goes wrong
#
#
#
# ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "error", [vi.ComputationError("the ledger is open"), KeyboardInterrupt(), ValueError("a bug")]
)
def test_earlier_parts_stay_when_a_part_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    monkeypatch.setitem(PARTS, "fig3", ReportPart("fig3", chart=raises(error)))
    with pytest.raises(type(error)):
        reproduce_paper(tmp_path / "paper", ["table1", "section3.1", "fig3", "corrections"])
    kept = {
        "summary.json",
        "report.md",
        "report.html",
        "values.csv",
        "parts/table1.json",
        "parts/section3.1.json",
    }
    assert names(tmp_path / "paper") == kept
    assert not list((tmp_path / "paper").rglob(".*"))
    missing = missing_parts(tmp_path / "paper")
    assert missing[0] == "fig3"
    assert f"Not made yet: {', '.join(missing)}." in (tmp_path / "paper" / "report.md").read_text(
        encoding="utf-8"
    )
    monkeypatch.undo()
    reproduce_paper(tmp_path / "paper", ["fig3"])  # goes on
    assert "fig3" in load_reproduction(tmp_path / "paper").parts


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize(
    "step",
    ["charts.files.save_charts", "paper.report.folder.pack", "files.json_text.json.dumps"],
)
def test_a_part_is_there_with_its_figure_or_not_at_all(
    copy: Path, monkeypatch: pytest.MonkeyPatch, step: str, error: BaseException
) -> None:
    before = contents(copy)
    monkeypatch.setattr(f"vibroimpact.{step}", raises(error))
    with pytest.raises((vi.InputError, KeyboardInterrupt)) as failed:
        reproduce_paper(copy, ["fig3"])
    if isinstance(error, OSError):
        assert (
            str(failed.value) == f"{copy}: the part fig3 can't be written: No space left on device"
        )
    assert contents(copy) == before
    assert not list(copy.rglob(".*"))


def test_what_stopped_the_run_is_told_and_not_what_else_is_damaged(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (copy / "parts" / "table1.json").write_text("")
    monkeypatch.setitem(
        PARTS, "fig3", ReportPart("fig3", chart=raises(vi.ComputationError("the ledger is open")))
    )
    with pytest.raises(vi.ComputationError, match="the ledger is open"):
        reproduce_paper(copy, ["fig3"])


@pytest.mark.parametrize(
    "damage",
    [
        "",
        "\x00",
        "[]",
        "null",
        '{"text": "", "rows": []}',
        '{"title": "", "text": ""}',
        '{"title": "", "text": "", "rows": [{}]}',
    ],
)
def test_a_damaged_part_is_told_and_mended_by_the_command_it_names(
    copy: Path, monkeypatch: pytest.MonkeyPatch, damage: str
) -> None:
    (copy / "parts" / "table1.json").write_text(damage)
    with pytest.raises(
        vi.InputError, match="the file is damaged; make it anew: vibroimpact reproduce"
    ) as told:
        load_reproduction(copy)
    assert str(told.value).startswith(f"{copy / 'parts' / 'table1.json'}: ")
    assert "table1" in missing_parts(copy)
    assert (
        command(monkeypatch, *shlex.split(str(told.value).partition("anew: vibroimpact ")[2])) == 0
    )
    assert list(load_reproduction(copy).parts) == ["table1", "section3.1", "fig4"]


@pytest.fixture(scope="module")
def drawn(made: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With a chart that takes little time too."""
    return reproduce_paper(
        shutil.copytree(made, tmp_path_factory.mktemp("drawn") / "paper"), ["fig3"]
    )


def without_chart(chart: Path) -> None:
    chart.unlink()


def with_another_chart(chart: Path) -> None:
    chart.write_bytes(chart.read_bytes()[:-8] + b"\x00" * 8)


def with_half_a_chart(chart: Path) -> None:
    chart.write_bytes(chart.read_bytes()[:1000])


def as_of_an_earlier_version(chart: Path) -> None:
    """The charts were files alone."""
    part = chart.with_suffix(".json")
    part.write_bytes(
        sealed({key: value for key, value in read_sealed(part).items() if key != "check_sums"})
    )


@pytest.mark.parametrize(
    "damage", [without_chart, with_another_chart, with_half_a_chart, as_of_an_earlier_version]
)
def test_a_missing_chart_is_told_and_mended_by_the_command_it_names(
    drawn: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: Callable[[Path], None]
) -> None:
    copy = Path(shutil.copytree(drawn, tmp_path / "paper"))
    assert "fig3" not in missing_parts(copy)
    damage(copy / "parts" / "fig3.chart")
    with pytest.raises(
        vi.InputError, match="the chart is missing or damaged; make it anew: vibroimpact reproduce"
    ) as told:
        write_reproduction_report(copy)
    assert str(told.value).startswith(f"{copy / 'parts' / 'fig3.chart'}: ")
    assert "fig3" in missing_parts(copy)
    assert (
        command(monkeypatch, *shlex.split(str(told.value).partition("anew: vibroimpact ")[2])) == 0
    )
    assert "fig3" not in missing_parts(copy)
    assert list(load_reproduction(copy).charts) == ["fig3", "fig4"]


def test_all_missing_charts_are_told_at_once(
    drawn: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = Path(shutil.copytree(drawn, tmp_path / "paper"))
    # which takes less time
    monkeypatch.setitem(PARTS, "fig5", ReportPart("fig5", chart=PARTS["fig3"].chart))
    reproduce_paper(copy, ["fig5"])
    (copy / "parts" / "fig3.chart").unlink()
    (copy / "parts" / "fig5.chart").write_text("")
    with pytest.raises(
        vi.InputError, match=r"damaged, and those of fig5; make them anew: .* --only fig3,fig5$"
    ) as told:
        write_reproduction_report(copy)
    assert (
        command(monkeypatch, *shlex.split(str(told.value).partition("anew: vibroimpact ")[2])) == 0
    )
    assert (copy / "report.html").read_text(encoding="utf-8").count("<figcaption>") == 3


# the commands
#
#
#
# ---------------------------------------------------------------------------------------------------------


def test_the_command_prints_the_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        command(monkeypatch, "reproduce", "--only", "table1, section3.1", "-o", tmp_path / "paper")
        == 0
    )
    title, *lines, last = capsys.readouterr().out.splitlines()
    assert title == "The paper, reproduced"
    answer, inputs, *_, by_part, by_kind, note = (
        [*rows] for blank, rows in groupby(lines, key=lambda line: not line.strip()) if not blank
    )
    assert [re.split(r"  +", row.strip()) for row in answer] == [
        ["Reproduced", "16", "of 17 printed values"],
        ["Explained", "0"],
        ["Fitted", "0"],
        ["Not reproduced", "1"],
    ]
    for (head, *_), first in ((by_part, "part"), (by_kind, "kind")):
        assert re.split(r"  +", head.strip()) == [first, *(verdict.value for verdict in Verdict)]
    assert [row.split() for row in by_part[1:]] == [
        ["table1", "14", "0", "0", "0"],
        ["section3.1", "2", "0", "0", "1"],
        ["all", "16", "0", "0", "1"],
    ]
    assert [re.split(r"  +", row.strip()) for row in by_kind[1:]] == [
        ["result", "1", "0", "0", "0"],
        ["inferred", "0", "0", "0", "1"],
        ["fitted model", "0", "0", "0", "0"],
        ["arithmetic", "0", "0", "0", "0"],
        ["input", "15", "0", "0", "0"],
    ]
    assert note[0].strip().startswith("Only a result tests the paper.")
    # the parts that were asked for, whole
    assert inputs[0].startswith("Table 1")
    density = next(line for line in inputs if "density of the sphere" in line)
    assert re.split(r"  +", density.strip())[1].replace("\u00a0", " ") == "1380 kg/m³"
    assert last == f"wrote {tmp_path / 'paper' / 'report.html'}"


def test_a_figure_that_is_asked_for_is_named_with_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    folder = tmp_path / "paper"
    assert command(monkeypatch, "reproduce", "--only", "fig3,table1", "-o", folder) == 0
    capsys.readouterr()
    # of a part that is there beside it nothing is said
    assert command(monkeypatch, "reproduce", "--only", "fig3", "-o", folder) == 0
    printed = capsys.readouterr().out
    file = folder / "figures" / "fig3.png"
    assert file.is_file()
    assert f"The figure is {file}." in printed.replace("\n", "")
    assert "Figure 3" in printed
    assert "Table 1: the inputs" not in printed


@pytest.mark.parametrize(
    ("only", "words"),
    [("tabel2", 'Did you mean "table2"?'), (" ,", "name at least one of table1, ")],
)
def test_bad_names_end_with_status_2(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    only: str,
    words: str,
) -> None:
    assert command(monkeypatch, "reproduce", "--only", only, "-o", tmp_path / "paper") == 2
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_interrupt_tells_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(PARTS, "fig3", ReportPart("fig3", chart=raises(KeyboardInterrupt())))
    assert (
        command(monkeypatch, "reproduce", "--only", "table1,fig3", "-o", tmp_path / "paper") == 130
    )
    assert (
        f"continue with: vibroimpact reproduce -o {tmp_path / 'paper'} --only fig3\n"
        in capsys.readouterr().err
    )


def test_an_interrupt_of_parts_made_anew_tells_to_make_them(
    copy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Parts that are there already are not those that are missing, which a command
    without --only would make.
    """
    monkeypatch.setitem(PARTS, "table1", ReportPart("table1", chart=raises(KeyboardInterrupt())))
    assert command(monkeypatch, "reproduce", "--only", "table1", "-o", copy) == 130
    assert (
        f"continue with: vibroimpact reproduce -o {copy} --only table1\n" in capsys.readouterr().err
    )


def test_the_report_is_remade_and_other_files_stay(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(copy)
    for name in ("report.md", "report.html", "values.csv"):
        (copy / name).unlink()
    (copy / "my notes.txt").write_text("mine")
    assert command(monkeypatch, "report", copy) == 0
    assert contents(copy) == {**before, "my notes.txt": b"mine"}


def test_the_page_of_the_documentation(made: Path, tmp_path: Path) -> None:
    images = tmp_path / "images" / "reproduction"
    images.mkdir(parents=True)
    (images / "old.png").write_bytes(b"old")
    page = write_docs_page(made, tmp_path)
    assert names(tmp_path) == {"reproduction.md", "images/reproduction/fig4.png"}
    files = images / "fig4.png", made / "figures" / "fig4.png"
    shown, drawn = (np.asarray(Image.open(file).convert("RGB"), dtype=float) for file in files)
    assert np.abs(shown - drawn).mean() < 0.5  # of 255; in fewer colours
    assert files[0].stat().st_size < 0.6 * files[1].stat().st_size
    text = page.read_text(encoding="utf-8")
    assert re.findall(r"\]\(([^)]*png)\)", text) == ["images/reproduction/fig4.png"]
    assert text.replace("images/reproduction/", "figures/") == (made / "report.md").read_text(
        encoding="utf-8"
    )
