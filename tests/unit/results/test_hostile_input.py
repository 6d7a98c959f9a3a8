"""Input that means harm, or is damaged: refused in a few clean lines before work is done,
or done.
"""

from __future__ import annotations

import pickle
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from hostile_runs import LONGEST, attack
from studies import study_table
from support import plain_case, run_command
from vibroimpact.cases.fields.size_limits import DEEPEST, check_text
from vibroimpact.charts.files import render_png
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.errors import MOST_LINES, ComputationError, InputError
from vibroimpact.files.result_folder import check_free
from vibroimpact.results.result import result_of
from vibroimpact.runs.charts import run_charts
from vibroimpact.studies.computation.compute_points import compute_points

ESCAPE = "\x1b[31m"
SENSOR = {"name": "a", "position": [0, 0]}
PLATE = {"model": "elastic", "size": [0.5, 0.4, 0.01], "material": "steel", "supports": "clamped"}


def patches(**changes: object) -> dict:
    patch = {"type": "patches", "spacing": [0.3, 0.3], "radius": 0.02}
    return {**PLATE, "supports": patch, **changes}


def nested(levels: int) -> object:
    found: object = 1
    for _ in range(levels):
        found = [found]
    return found


TOO_LARGE = [
    ({"sphere__radius": nested(300)}, "sphere.radius.0.0: tables and lists lie more than 20 deep in one another"),
    ({"sensors": [SENSOR] * 20_000, "plate": PLATE}, "sensors: there are 20000 sensors; 1000 are the most"),
    ({"plate": {**PLATE, "supports": [{"type": "point", "position": [0, 0]}] * 1001}}, "there are 1001 supports; 1000 are the most"),
    ({"contact__restitution": [0.5] * 10_001}, "contact.restitution: there are 10001 values; 10000 are the most"),
    ({"name": "x" * 300}, "name: the name has 300 characters; 200 are the most"),
    ({"name": "x" * 5000}, "name: the text has 5000 characters; 4096 are the most"),
    ({"name": f"a{ESCAPE}b"}, 'name: "a\\x1b[31mb" has characters that can\'t be shown; a name is one ' 'line of ' '' 'text'),
    ({"name": "a\nb"}, 'name: "a\\nb" has characters'),
    ({"plate": PLATE, "sensors": [{**SENSOR, "name": "a\u202eb"}]}, "sensors.name"),
    ({"k" * 300: 1}, "a key has 300 characters; 200 are the most"),
    ({"drop__gravity": 10**30}, "drop.gravity: the number is too large for a whole number"),
    ({"drop__gravity": 1e60}, "drop.gravity: 1e+60 is beyond what can be computed; a magnitude"),
    ({"sphere__radius": "1e-70 km"}, 'sphere.radius: "1e-70 km" is beyond what can be computed'),
    ({"sphere__radius": [1] * 300_000}, "it holds more than 200000 values"),
    ({"sphere__radius": ["a"] * 5000}, 'sphere.radius: ["a", "a", "a"'),
    ({"sphere__material": ESCAPE}, 'there is no material "\\x1b[31m" in the library'),
    ({f"x{ESCAPE}": 1}, 'x\\x1b[31m: unknown key "x\\x1b[31m"; a case takes'),
    ({"plate": patches(supports={"type": "patches", "spacing": [0.3, 0.3], "radius": 1e-12}, mesh={"elements": 500}, element="solid")},
     "is too small for a plate of 0.5 m x 0.4 m; take a point, or a radius of at least 5e-06 m"),
    ({"plate": patches(size=[1e9, 0.4, 0.01], mesh={"elements": 500}, element="solid")}, "is too small for a plate of 1e+09 m x 0.4 m"),
    ({"plate": {**PLATE, "element": "solid", "mesh": {"elements": 10**12}}}, "would be more than 1000000 on this plate"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "words"), TOO_LARGE, ids=[words[:40] for _, words in TOO_LARGE]
)
def test_cases_beyond_what_a_case_can_be(changes: dict, words: str) -> None:
    (outcome,) = attack(vi.case_of, [plain_case(**changes)])
    assert outcome.kind == "refused", outcome
    assert words in outcome.text


@pytest.mark.parametrize(
    "text",
    [
        "a." * 100_000 + "b = 1",
        "[" + "a." * 100_000 + "b]",
        '"a" . ' * 100_000 + "b = 1",
        "x." * 30 + "y = 1",
    ],
)
def test_keys_of_very_many_parts(text: str, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(text)
    (outcome,) = attack(vi.load_case, [file])
    assert outcome.kind == "refused", outcome
    assert "has more than 20 parts joined by dots" in outcome.text


def test_texts_with_many_points_are_no_keys() -> None:
    check_text('name = "a.b.c"\n# ' + "a." * 100 + "b\nvalues = [" + "1.5, " * 1000 + "]")
    check_text("x" * 900_000)
    check_text("." * 900_000)
    assert DEEPEST < 30


def test_faults_are_few_short_and_clean() -> None:
    case = plain_case(
        sphere={str(number): number for number in range(5000)}, **{f"x{'y' * 150}{ESCAPE}": 1}
    )
    with pytest.raises(InputError) as caught:
        vi.case_of(case)
    lines = str(caught.value).split("\n")
    assert 1 < len(lines) <= MOST_LINES + 1
    assert lines[-1].startswith("and at least ")
    assert all(line.isprintable() for line in lines)
    assert len(str(caught.value)) <= LONGEST


def test_faults_that_are_not_shown_are_counted(tmp_path: Path) -> None:
    """Also where the name of the file takes the place of some."""
    file = tmp_path / "case.toml"
    file.write_text(
        tomli_w.dumps(plain_case(run={f"wrong_{number}": number for number in range(30)}))
    )
    with pytest.raises(InputError) as caught:
        vi.load_case(file)
    *lines, rest = str(caught.value).split("\n")
    assert len(str(caught.value)) <= LONGEST
    assert int(rest.split()[1]) + len(lines) == 30


def test_errors_are_clean_whatever_they_are_made_of() -> None:
    for error in (
        InputError(f"a\n{ESCAPE}" + "x" * 10_000, "key\n" * 100),
        ComputationError(f"a\r{ESCAPE}" + "x" * 10_000),
    ):
        assert str(error).isprintable()
        assert len(str(error)) <= LONGEST
    several = InputError.of_several(["a: 1", "b: 2", f"c{ESCAPE}"])
    assert str(several).split("\n") == ["a: 1", "b: 2", "c\\x1b[31m"]
    # as it comes out of another process
    assert str(pickle.loads(pickle.dumps(several))) == str(several)


@pytest.mark.parametrize(
    "key",
    [
        "plate.size.thickness",
        "drop.position.x",
        "plate.material.density",
        "sphere.material.tensile_strength",
    ],
)
def test_a_swept_key_that_moves_nothing(key: str) -> None:
    values = [0.01, 0.02, 0.04]
    table = study_table(
        {"over": {key: values}}, plate={"size": [0.5, 0.4, 0.01], "material": "steel"}
    )
    study = vi.studies.sweep_of(table)
    found = compute_points(study.table, ("impacts",), 0, study.plan.points(0, 3))
    assert not found.failures
    alone = vi.simulate(study.case_of(2)).impacts["max_force_N"]
    np.testing.assert_allclose(
        found.arrays["max_force_N"], np.broadcast_to(alone, (3, 3)), rtol=1e-8
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plate": 0.025}, "plate: 0.025 is not a table, so that it has no size"),
        (
            {"plate__size": [0.1]},
            "plate.size: [0.1] does not have the right number of values; it takes length, "
            "width, thickness",
        ),
    ],
)
def test_swept_keys_of_what_is_no_table(changes: dict, words: str) -> None:
    with pytest.raises(InputError) as caught:
        vi.studies.sweep_of(
            study_table({"over": {"plate.size.thickness": [0.01, 0.02]}}, **changes)
        )
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("sweep", "words"),
    [
        ({"over": {"sphere.radius": {"from": 0.01, "to": 0.02, "number": 9_000_000}, "drop.height": [1, 2]}}, "18000000 drops"),
        ({"over": {f"plate.mesh.k{number}": [1] for number in range(101)}}, "there are 101 swept keys; 100 are the most"),
        ({"design": "zip", "over": {"plate.material": [{"density": float(n)} for n in range(2000)]}}, "different names and tables"),
        ({"design": "sobol", "samples": 2**23, "over": {f"sphere.material.{key}": {"from": 1, "to": 2} for key in (
            "density", "youngs_modulus", "yield_strength", "loss_factor", "tensile_strength")}}, "values are the most"),
    ],
)  # fmt: skip
def test_studies_beyond_what_a_study_can_be(sweep: dict, words: str) -> None:
    (outcome,) = attack(vi.studies.sweep_of, [study_table(sweep)])
    assert outcome.kind == "refused", outcome
    assert words in outcome.text


def test_levels_of_a_long_range_are_not_compared_as_texts() -> None:
    study = study_table(
        {"over": {"sphere.radius": {"from": 0.01, "to": 0.02, "number": 9_000_000}}}
    )
    (outcome,) = attack(vi.studies.sweep_of, [study])
    assert outcome.kind == "accepted", outcome


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("/", "this is the root of the file system"),
        ("a\0b", "NUL"),
        ("x" * 300, "200 bytes at most"),
        ("x" * 250, "200 bytes at most"),
    ],
)
def test_folders_that_can_not_be(name: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        check_free(name)
    assert words in str(caught.value)
    assert str(caught.value).isprintable()


def run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *arguments: str
) -> tuple[int, str]:
    status, output, errors = run_command(monkeypatch, capsys, *arguments)
    return status, output + errors


@pytest.mark.parametrize(
    "arguments",
    [
        ("check", f"a{ESCAPE}\n"), (f"--x{ESCAPE}",), ("check", "a", f"b{ESCAPE}"), (f"x{ESCAPE}",),
        ("laws", ESCAPE), ("materials", ESCAPE),
        ("units", "5", ESCAPE), ("run", "paper:type1-theory", "-o", "/"), ("check", "paper:" + "x" * 300), ("report", f"/{ESCAPE}"),
        ("check", "x" * 100_000), ("--" + "x" * 100_000,), ("compare", "paper:type1-theory", "--laws", "hertz", "--achieving", "nan"),
        ("compare", "paper:type1-theory", "--laws", f"hertz,{ESCAPE}"), ("sweep", "paper:sweep", "--memory", "1e999 MB"),
        ("sweep", "paper:sweep", "--memory", ESCAPE), ("sweep", "paper:sweep", "--processes", "-1"),
    ],
    ids=lambda arguments: " ".join(arguments)[:20].encode("unicode_escape").decode(),
)  # fmt: skip
def test_arguments(
    arguments: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    status, written = run(monkeypatch, capsys, *arguments)
    assert status == 2
    assert all(line.isprintable() and len(line) <= LONGEST for line in written.splitlines())
    assert not list(tmp_path.iterdir())


def test_a_case_of_a_long_name_gets_a_folder(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / f"{'x' * 200}{ESCAPE}.toml"
    file.write_text(tomli_w.dumps(plain_case(name="[red]a[/red]", run={"impacts": 1})))
    status, written = run(monkeypatch, capsys, "run", str(file))
    assert (status, written.count("\x1b")) == (0, 0)
    assert (tmp_path / ("x" * 60) / "report.html").is_file()
    assert "[red]a[/red]" in run(monkeypatch, capsys, "check", str(file))[1]
    (tmp_path / ("x" * 60)).rename(tmp_path / f"o{ESCAPE}")
    _, written = run(monkeypatch, capsys, "report", f"o{ESCAPE}")
    assert written.rstrip().endswith("wrote o\\x1b[31m/report.html")


def test_figures_take_no_notice_of_settings_of_others(theory: vi.Response) -> None:
    def picture() -> bytes:
        return render_png(matplotlib_figure(run_charts(result_of(theory))[0]))

    plain = picture()
    with mpl.rc_context(
        {
            "text.usetex": True,
            "font.family": "No Such Font",
            "figure.autolayout": True,
            "axes.xmargin": 0.4,
        }
    ):
        assert picture() == plain
        assert mpl.rcParams["text.usetex"]


def test_settings_of_matplotlib_that_can_not_be_read(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "matplotlibrc").write_bytes(b"\xff")
    status, written = run(monkeypatch, capsys, "demo")
    assert status == 2
    assert "matplotlibrc: this file" in written
