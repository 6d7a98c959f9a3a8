"""What the documents say is so: commands run, examples run, names exist, docstrings are whole."""

from __future__ import annotations

import inspect
import itertools
import re
import runpy
import shlex
import shutil
import subprocess
import sys
import tomllib
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from scipy.io import wavfile

import hammer_test
import vibroimpact as vi
from ball_records import heard
from identifying import a_case as an_impact_case
from identifying import an_impact, records_of
from thin_plate_responses import by_pyuff
from vibroimpact.cases.build import resolved_case
from vibroimpact.cli import main
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS
from vibroimpact.report import console
from vibroimpact.report.console import TerminalConsole

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted([*DOCS.glob("*.md"), *DOCS.glob("guides/*.md")])]
GUIDES = [DOCS / "first-steps.md", *sorted(DOCS.glob("guides/*.md"))]
LAW_PAGES = sorted(DOCS.glob("laws/*.md"))

# what blocks of the pages are: these are run or read by the tests below, a text is what is printed,
# and "sh" has its own list
LANGUAGES = {"console", "python", "toml", "text", "sh", "math"}
DIRECTIVES = {"{toctree}", "{eval-rst}", "{include}"}
SMALLER = {
    "vibroimpact dataset signals:coal-gangue -o falls": "--samples 320",
    "vibroimpact recognise falls -o recognised": "--seeds 1 --folds 2",
    "vibroimpact recognise falls -o new-plates --group plate": "--seeds 1 --folds 2",
    "vibroimpact recognise today --model recognised -o counted": "",
    "vibroimpact dataset signals:river-plate -o grains": "--samples 60",
    "vibroimpact bound grains -o bound": "",
    "vibroimpact recognise grains -o recognised --group rock": "--seeds 1 --folds 2 --force",
    "vibroimpact identify coal.toml records.csv -o found": "",
    "vibroimpact correlate plate.toml taps.csv --hammer force -o compared": "",
    "vibroimpact correlate plate.toml responses.uff -o responses": "",
    "vibroimpact modes responses.uff -o measured": "",
    "vibroimpact modes plate.toml --measured responses.uff -o beside": "",
}
"""Commands of the pages that take minutes, or files of the reader, and what makes them
small here.
"""

NOT_RUN = {
    "make test": "CI runs it",
    "make docs-site": "CI runs it",
    "vibroimpact run paper:type1-theory -o theory --json | jq "
    "'.impacts[0].max_force_N'": "tests/contract/test_json.py reads it",
    "vibroimpact --install-completion": "changes the settings of a shell; tests/unit/cli/test_completion.py tries it",
    "vibroimpact --show-completion": "tests/unit/cli/test_completion.py tries it",
    "python3 -m venv .venv": "installs; tests/project/test_packaging.py tries the package",
    "source .venv/bin/activate": "changes the shell",
    "python -m pip install .": "installs; tests/project/test_packaging.py tries the package",
    "pipx install .": "installs",
    "uvx --from . vibroimpact demo": "installs",
    "podman build -t vibroimpact -f packaging/Containerfile .": "builds an image",
    'podman run --rm -v "$PWD":/work vibroimpact demo': "runs that image",
    "vibroimpact serve mine.toml": "runs until it is ended; tests/page tries it",
    "vibroimpact reproduce -o paper-whole": "minutes; tests/published/test_reproduction_page.py has its page",
    "vibroimpact dataset signals:coal-gangue -o all-falls": "is run with another folder",
    "vibroimpact recognise all-falls -o recognised": "is run with another folder",
    "vibroimpact recognise all-falls -o new-plates --group plate": "is run with another folder",
    'python -m pip install ".[app]"': "installs",
    "vibroimpact serve": "runs until it is ended; tests/page tries it",
}
"""Commands of the pages that no test here runs, and why: they install, change a shell, or
run until they are ended.
"""


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.S)


def commands(pages: list[Path]) -> list[str]:
    return [
        line.split("  #")[0].removeprefix("$ ").strip()
        for page in pages
        for block in blocks(page, "console")
        for line in block.splitlines()
        # a server runs until it is ended: that of the live page is tried in tests/page
        if line.startswith("$ vibroimpact") and not line.startswith("$ vibroimpact serve")
    ]


def printed_blocks(page: Path) -> list[str]:
    """Return the blocks of text that follow a block of commands: what these print, or
    write into files.
    """
    text = page.read_text(encoding="utf-8")
    sections = re.split(
        r"^#+ .*$", re.sub(r"^# (?=\S+\.toml$)", "  # ", text, flags=re.M), flags=re.M
    )
    every = [
        re.findall(r"^```(\w+)\n(.*?)^```", section, flags=re.M | re.S) for section in sections
    ]
    pairs = itertools.chain.from_iterable(map(itertools.pairwise, every))
    return [
        block
        for (before, _), (language, block) in pairs
        if (before, language) == ("console", "text")
    ]


def unsaid(block: str, output: str, folder: Path) -> list[str]:
    """Return the lines of a block that are neither in an output nor in a file of a
    folder; spaces and broken lines do not count.
    """
    written = [
        path.read_text(errors="replace")
        for path in sorted(folder.rglob("*"))
        if path.suffix in (".py", ".in", ".adm", ".toml")
    ]
    everything = " ".join("\n".join([output, *written]).split())
    return [
        line
        for line in block.splitlines()
        for part in line.split("...")
        if " ".join(part.split()) not in everything
    ]


def is_quick(command: str) -> bool:
    """Modes of elastic bodies, studies, and figures for print take longer than all that
    the other commands do.
    """
    slow = {
        "paper:type3",
        "elastic.toml",
        "figures",
        "features",
        "dataset",
        "bound",
        "reproduce",
        "sweep",
        "bounces.wav",
    }
    return not slow & set(command.split())


def write_records(folder: Path) -> None:
    """Write the records of bounces and the tables that commands and examples name."""
    sound = heard(0, 0.7, 7, decibels=30.0).record
    wavfile.write(
        folder / "bounces.wav",
        round(sound.rate),
        (0.5 * sound.value / np.abs(sound.value).max()).astype("f4"),
    )
    plate = heard(1, 0.6, 6, decibels=30.0, rate=8e3).record
    rows = (
        f"{at!r},{value!r}\n"
        for at, value in zip(plate.time.tolist(), plate.value.tolist(), strict=True)
    )
    (folder / "plate.csv").write_text("time [s],geophone [V]\n" + "".join(rows))
    table = next(
        block
        for block in blocks(DOCS / "calibration.md", "text")
        if block.startswith("speed [m/s],restitution")
    )
    (folder / "ev.csv").write_text(table)
    np.savetxt(folder / "sound.txt", sound.value)
    np.savetxt(folder / "force.txt", np.stack([plate.time, plate.time, plate.value], axis=1))


def write_cases(folder: Path) -> None:
    """Write the cases that the pages show under the names that they say, or as `case.toml`."""
    for block in [
        *blocks(DOCS / "case-file.md", "toml"),
        *(block for guide in GUIDES for block in blocks(guide, "toml")),
    ]:
        name = re.match(r"# (\S+\.toml)\n", block)
        (folder / (name[1] if name else "case.toml")).write_text(block)


class NarrowAndWide(TerminalConsole):
    """A terminal of 80 columns that prints once more what a wide one shows: pages show both."""

    def __init__(self, width: int = 80, **options: Any) -> None:
        super().__init__(width=80, **options)

    def print(self, *objects: Any, **options: Any) -> None:
        for width in (160, 80):
            self.width = width
            super().print(*objects, **options)


@pytest.mark.parametrize(
    "all_pages",
    [False, pytest.param(True, marks=pytest.mark.slow)],
    ids=["README, quick", "all pages"],
)
def test_documented_commands_run(
    all_pages: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """Those of the README, and in another folder those of all other pages; what was
    computed once is copied.
    """
    monkeypatch.setattr(console, "TerminalConsole", NarrowAndWide)
    made: dict[str, Path | None] = {}
    printed: dict[str, str] = {}
    wrong: list[str] = []
    for place, pages in {
        "readme": PAGES[:1],
        **({"docs": [*PAGES[1:], *LAW_PAGES]} if all_pages else {}),
    }.items():
        folder = tmp_path / place
        folder.mkdir()
        monkeypatch.chdir(folder)
        write_cases(folder)
        write_records(folder)
        asked = [command for command in commands(pages) if all_pages or is_quick(command)]
        assert len(asked) >= 8
        for command in dict.fromkeys(asked):
            words, _, output = command.partition(" -o ")
            source = made.get(words)
            if output and source is not None and source.is_dir():
                shutil.copytree(source, output)
                continue
            made[words] = folder / output if output else None
            monkeypatch.setattr(sys, "argv", shlex.split(command))
            with pytest.raises(SystemExit) as left:
                main()
            out, err = capfd.readouterr()
            printed[words] = out + err
            assert not left.value.code, f"{command}\n{err}"
        for page in pages if all_pages else ():
            output = "\n".join(
                printed[command.partition(" -o ")[0]] for command in commands([page])
            )
            wrong += [
                f"{name_of(page)}: {line}"
                for block in printed_blocks(page)
                for line in unsaid(block, output, folder)
            ]
    assert not wrong, "\n".join(wrong)


def write_table(path: Path, columns: dict[str, np.ndarray]) -> None:
    np.savetxt(
        path,
        np.column_stack([*columns.values()]),
        delimiter=",",
        header=",".join(columns),
        comments="",
    )


def write_recorded_impacts(folder: Path) -> None:
    """Write the records of sensors, and their cases, that commands name: a ball of coal
    on a plate, and taps of a hammer.
    """
    (folder / "coal.toml").write_text(tomli_w.dumps(resolved_case(an_impact_case(60))))
    records = records_of(an_impact(0.02, 3.0, (0.05, 0.03)), 50.0, 1)
    sensors = {f"{record.name} [m/s^2]": record.value for record in records}
    write_table(
        folder / "records.csv",
        {"time [s]": np.arange(len(records[0].value)) / records[0].rate, **sensors},
    )
    (folder / "plate.toml").write_text(tomli_w.dumps(hammer_test.TABLE))
    force, value = hammer_test.hammered()
    taps = {f"{record.name} [m/s^2]": record.value for record in hammer_test.records(value)}
    write_table(
        folder / "taps.csv",
        {"time [s]": np.arange(len(force)) / hammer_test.RATE, "force [N]": force, **taps},
    )
    frequency = np.arange(200.0, 3000.0)
    of_case = vi.test_analysis.responses_of_case(hammer_test.a_case(), frequency)
    by_pyuff(
        folder / "responses.uff",
        *(
            {"rsp_node": 1, "rsp_ent_name": one.name, "x": frequency, "data": -one.value}
            for one in of_case
        ),
    )


@pytest.mark.slow
def test_commands_of_studies_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Those that take minutes as they stand, on less."""
    monkeypatch.chdir(tmp_path)
    write_recorded_impacts(tmp_path)
    for command in [
        "vibroimpact dataset signals:coal-gangue --samples 16 -o today",
        *map(" ".join, SMALLER.items()),
    ]:
        monkeypatch.setattr(sys, "argv", shlex.split(command))
        with pytest.raises(SystemExit) as left:
            main()
        assert not left.value.code, f"{command}\n{capfd.readouterr().err}"


def test_reasons_name_what_exists() -> None:
    for command, reason in NOT_RUN.items():
        for name in re.findall(r"tests/[\w/]+(?:\.py)?", reason):
            assert (ROOT / name).exists(), f"{command}: {reason}"
    shown = {
        line.split("  #")[0].strip()
        for page in PAGES
        for block in blocks(page, "sh")
        for line in block.splitlines()
    }
    shown |= {
        line.removeprefix("$ ").split("  #")[0].strip()
        for page in PAGES
        for block in blocks(page, "console")
        for line in block.splitlines()
    }
    assert set(NOT_RUN) | set(SMALLER) <= shown


def test_readme_shows_what_the_demo_prints(variable: vi.Response) -> None:
    from rich.console import Console

    from vibroimpact.report.terminal_report import terminal_report
    from vibroimpact.results.result import result_of

    written = StringIO()
    Console(width=80, file=written).print(terminal_report(result_of(variable).report))
    printed = [line.rstrip() for line in written.getvalue().splitlines()]
    (shown,) = blocks(ROOT / "README.md", "text")
    for line in shown.splitlines():
        assert line in printed


# of the pages on elastic bodies the other one computes modes too, and fewer
LONG_PAGES = {"coal-from-rock.md", "elastic-drops.md", "river-geophone.md"}


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page, id=name_of(page), marks=pytest.mark.slow if page.name in LONG_PAGES else ()
        )
        for page in PAGES
        if blocks(page, "python")
    ],
)
def test_documented_python_runs(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_records(tmp_path)
    names: dict = {}
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), names)


def test_documented_cases_are_valid() -> None:
    for page in PAGES:
        for block in blocks(page, "toml"):
            try:
                case = vi.case_of(tomllib.loads(block))
            except vi.InputError as error:
                pytest.fail(f"{name_of(page)}: {error}\n{block}")
            assert case.sphere.radius > 0


@pytest.mark.parametrize("pages", [PAGES, LAW_PAGES], ids=["pages", "laws"])
def test_every_block_is_run_or_has_a_reason(pages: list[Path]) -> None:
    for page in pages:
        text = page.read_text(encoding="utf-8")
        fences = re.findall(r"^\s*(?:```|~~~)[ \t]*([^\s`]*)", text, flags=re.M)
        opened = [fence for fence in fences if fence]
        assert len(fences) == 2 * len(opened), (
            f"{name_of(page)}: a block without a language, or one that is not closed"
        )
        assert set(opened) <= LANGUAGES | DIRECTIVES, name_of(page)
        for language in ("console", "python", "toml"):  # what the tests find is all there is
            assert opened.count(language) == len(blocks(page, language)), name_of(page)
        asked = [
            line.removeprefix("$ ")
            for block in blocks(page, "console")
            for line in block.splitlines()
            if line.startswith("$ ")
        ]
        run = {command.split("  #")[0].strip() for command in asked} - {*NOT_RUN, *SMALLER}
        assert run - {command for command in run if command.startswith("vibroimpact serve")} == set(
            commands([page])
        ), name_of(page)
        typed = {
            line.split("  #")[0].strip()
            for block in blocks(page, "sh")
            for line in block.splitlines()
            if line.strip()
        }
        assert typed <= {*NOT_RUN, *SMALLER}, name_of(page)


def test_links_lead_somewhere() -> None:
    links = [
        (page, target)
        for page in (*PAGES, *LAW_PAGES)
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
        if not target.startswith("https://")
    ]
    assert len(links) > 200
    assert [
        f"{name_of(page)}: {target}"
        for page, target in links
        if not (page.parent / target).exists()
    ] == []


# modes of a plate, studies
LONG_EXAMPLES = {"a_nanometre", "ball_on_table", "charts_of_studies", "how_it_works"}
# of many pictures, which change no number: before a release
PICTURES = {"pictures_of_guides", "pictures_of_pages", "ringing_plate"}


def _marks(example: Path) -> tuple[pytest.MarkDecorator, ...]:
    if example.stem in PICTURES:
        return (pytest.mark.slow, pytest.mark.whole)
    return (pytest.mark.slow,) if example.stem in LONG_EXAMPLES else ()


@pytest.mark.parametrize(
    "example",
    [
        pytest.param(path, id=path.stem, marks=_marks(path))
        for path in sorted((ROOT / "examples").glob("*.py"))
    ],
)
def test_examples_run(
    example: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(example), run_name="__main__")
    assert capsys.readouterr().out.strip()


def test_every_column_is_documented() -> None:
    text = (ROOT / "docs" / "result-folder.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in text for name in IMPACT_COLUMNS)


def test_every_case_key_is_documented() -> None:
    text = (ROOT / "docs" / "case-file.md").read_text(encoding="utf-8")
    schema = vi.case_schema()
    for section in schema["$defs"].values():
        for key in section.get("properties", {}):
            assert f"`{key}`" in text, key
    laws = (ROOT / "docs" / "laws.md").read_text(encoding="utf-8")
    for law in schema["properties"]["contact"]["oneOf"]:
        assert f"`{law['properties']['law']['const']}`" in laws


def test_public_names_are_documented() -> None:
    tops = [getattr(vi, name) for name in vi.__all__ if name != "__version__"]
    modules = [thing for thing in tops if inspect.ismodule(thing)]
    inner = [
        getattr(module, name) for module in modules for name in module.__all__ if not name.isupper()
    ]
    for thing in [*(thing for thing in tops if not inspect.ismodule(thing)), *inner]:
        name = thing.__name__
        text = inspect.getdoc(thing) or ""
        assert len(text) > 20, name
        parameters = list(inspect.signature(thing).parameters) if inspect.isfunction(thing) else []
        if len(parameters) > 1:
            assert [
                parameter for parameter in parameters if not re.search(rf"\b{parameter}\b", text)
            ] == [], name


def test_materials_have_a_source_for_each_number() -> None:
    library = vi.materials.material_library()
    assert len(library) >= 30
    for name, material in library.items():
        assert material.description, name
        numbers = {"density", "youngs_modulus", "poissons_ratio"}
        optional = (
            "yield_strength",
            "compressive_strength",
            "tensile_strength",
            "hardness",
            "loss_factor",
        )
        numbers |= {key for key in optional if getattr(material, key) is not None}
        assert set(material.sources) == numbers, name
        assert all(len(source) > 15 for source in material.sources.values()), name


def test_versions_agree() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"version: {version}" in (ROOT / "CITATION.cff").read_text()
    assert vi.__version__ == version


def test_help_is_light() -> None:
    """`--help` is quick because it imports nothing heavy; time is for the benchmarks to show."""
    code = (
        "import sys\nfrom vibroimpact.cli import app\nfrom typer.testing import CliRunner\n"
        "assert CliRunner().invoke(app, ['--help']).exit_code == 0\n"
        "heavy = {'numpy', 'scipy', 'pydantic', 'matplotlib', 'h5py', 'pint', 'jinja2', "
        "'skfem', 'numba'} & set(sys.modules)\nassert not heavy, heavy\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_schema_accepts_the_shipped_cases() -> None:
    import jsonschema

    schema = jsonschema.Draft202012Validator(vi.case_schema())
    for name in vi.shipped_cases():
        schema.validate(resolved_case(vi.load_case(name)))
    with pytest.raises(jsonschema.ValidationError):
        schema.validate(
            {**resolved_case(vi.load_case(name)), "contact": {"law": "hertz", "damping": 1}}
        )


def test_no_file_holds_a_merge_conflict() -> None:
    folders = ["docs", "src", "tests", "examples", "benchmarks", "packaging"]
    kinds = {".md", ".py", ".toml", ".yaml", ".yml", ".j2", ".rst", ".txt"}
    files = [
        file for folder in folders for file in (ROOT / folder).rglob("*") if file.suffix in kinds
    ]
    files += [file for file in ROOT.iterdir() if file.suffix in kinds]
    marks = re.compile(r"^(<{7}|>{7}) ", re.MULTILINE)
    assert [
        str(file.relative_to(ROOT))
        for file in files
        if marks.search(file.read_text(encoding="utf-8", errors="ignore"))
    ] == []
