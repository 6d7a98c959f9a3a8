"""One case under several laws: which parameters they get, what is written, and what is refused."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.cli import main
from vibroimpact.comparison.laws import cases_under

CASE = vi.read_case(plain_case())


def test_parameters_of_the_same_name_and_unit_are_taken_from_the_case() -> None:
    case = vi.read_case(plain_case(contact={"law": "hunt-crossley", "restitution": 0.6, "stiffness": 3e8}))
    under = cases_under(case, ["flores", "hunt-crossley", "tsuji"])
    for one in under.values():
        assert one.contact.parameters["restitution"] == 0.6
        assert one.contact.parameters["stiffness"] == 3e8
    with pytest.raises(vi.InputError, match=r"walton-braun: contact\.stiffness: this key is missing"):
        cases_under(case, ["walton-braun"])  # its stiffness is another one, in N/m


def test_given_parameters_come_first_and_a_laws_own_before_all() -> None:
    under = cases_under(CASE, ["flores", "gonthier"], {"restitution": 0.5, "gonthier.restitution": 0.4})
    assert [one.contact.parameters["restitution"] for one in under.values()] == [0.5, 0.4]
    stiff = cases_under(CASE, ["hertz"], {"stiffness": "16000 N/mm^1.5"})["hertz"]
    assert stiff.contact.parameters["stiffness"] == pytest.approx(5.0596e8, rel=1e-4)


@pytest.mark.parametrize(
    ("laws", "given", "achieving", "message"),
    [
        (["flors"], {}, None, 'Did you mean "flores"'),
        ([], {}, None, "at least one"),
        (["flores", "flores"], {}, None, "named twice"),
        (["flores"], {"restitutoin": 0.5}, None, 'Did you mean "restitution"'),
        (
            ["tsuji", "walton-braun"],
            {"stiffness": 1e7},
            None,
            '"stiffness" is not the same in all laws: tsuji [N/m^1.5], walton-braun [N/m]',
        ),
        (["flores"], {"hertz.exponent": 1.5}, None, '"hertz.exponent" is no parameter of flores'),
        (["flores"], {"restitution": 0}, None, "flores: contact.restitution: 0 is not allowed; it must be greater than 0 and at most 1"),
        (["adams-impact"], {}, None, "adams-impact needs largest damping C"),
        (["thornton"], {}, None, "no yield_strength is known of the materials"),
        (["lankarani-nikravesh"], {}, 0.5, "lankarani-nikravesh: reaches restitutions from 0.663"),
        (["walton-braun"], {}, 0.5, "walton-braun: contact.stiffness: this key is missing"),
        (["krijt"], {}, 0.5, "krijt: contact.work_of_adhesion: this key is missing"),
        (["flores"], {"restitution": 0.6}, 0.5, "restitution is what is tuned to achieve 0.5, so it can't be given too"),
    ],
)
def test_what_is_refused(laws: list[str], given: dict, achieving: float | None, message: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        cases_under(CASE, laws, given, achieving)
    assert message in str(raised.value)


def test_all_laws_tuned_to_one_restitution() -> None:
    names = [name for name in vi.contact_laws() if name not in ("hertz", "jkr", "krijt")]
    linear = [name for name in names if name in ("linear-spring-dashpot", "anagnostopoulos", "walton-braun")]
    others = [name for name in names if name not in linear]
    comparison = vi.compare_laws(CASE, others, {"penalty": 2e6}, achieving=0.8)
    linear_comparison = vi.compare_laws(CASE, linear, {"stiffness": 2e6}, achieving=0.8)
    for one in (*comparison.results.values(), *linear_comparison.results.values()):
        assert one.impacts["restitution_achieved"][0] == pytest.approx(0.8, abs=3e-3)  # gravity acts in the contact too


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", "compare", "paper:type1-theory", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


def test_the_command_writes_a_whole_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "compared"
    arguments = ["--laws", "hertz, newton,adams-impact", "--set", "adams-impact.damping_max=180", "-o", str(folder)]
    assert run(monkeypatch, *arguments) == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in ("hertz", "newton", "adams-impact", "achieved"))
    rows = list(csv.DictReader((folder / "comparison.csv").read_text().splitlines()))
    assert [row["law"] for row in rows] == ["hertz"] * 5 + ["newton"] * 5 + ["adams-impact"] * 5
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["laws"]["newton"]["impacts"][0]["max_force_N"] is None
    again = vi.simulate(vi.load_case(folder / "cases" / "adams-impact.toml"))
    np.testing.assert_allclose(again.impacts["max_force_N"], [float(row["max_force_N"]) for row in rows[-5:]], rtol=1e-12)
    page = (folder / "report.html").read_text()
    assert page.count("<img") == 4
    assert "http" not in page.replace("http-equiv", "")
    figures = {"position", "force", "force_indentation", "restitution"}
    assert {file.stem for file in (folder / "figures").glob("*.png")} == figures
    assert run(monkeypatch, *arguments) == 2
    assert "is there already" in capsys.readouterr().err
    assert run(monkeypatch, *arguments, "--force") == 0


def test_settings_that_are_none_are_refused(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert run(monkeypatch, "--laws", "flores", "--set", "restitution", "-o", str(tmp_path / "x")) == 2
    assert "give KEY=VALUE" in capsys.readouterr().err
