"""Laws ranked by their fit to measured restitutions."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cli import main
from vibroimpact.contact.registry import contact_laws
from vibroimpact.law_comparison.ranking import FittedLaw, Ranking, rank_laws

CASE = vi.case_of(plain_case(contact={"law": "hertz"}))
MASS = float(contact_pair(CASE).effective_mass)
SPEED = np.array([0.2, 0.5, 1.0, 2.0, 4.0])


def of(ranking: Ranking, name: str) -> FittedLaw:
    return next(law for law in ranking.laws if law.name == name)


@pytest.mark.parametrize(
    ("name", "given", "value"),
    [
        ("kuwabara-kono", {}, 5e-6),
        ("tsuji", {}, 0.8),
        ("flores", {}, 0.7),
        ("adams-impact", {"full_damping_penetration": 1e-5}, 20.0),
        ("thornton", {}, 3e7),
        ("walton-braun", {"walton-braun.stiffness": 1e6}, 0.8),
    ],
)
def test_the_law_that_made_the_restitutions_is_first(
    name: str, given: dict[str, Any], value: float
) -> None:
    start = rank_laws(CASE, SPEED, np.full(5, 0.8), [name], given).functions[name]
    parameter = str(start.free_parameter)
    law = start.changed({parameter: value})
    measured = np.asarray(vi.laws.achieved_restitution(law, MASS, SPEED))
    found = rank_laws(CASE, SPEED, measured, [name, "newton", "lee-wang"], given)
    best = of(found, name)
    # laws whose restitution does not depend on the speed can't be told apart
    assert best.residual == pytest.approx(found.laws[0].residual, abs=1e-6)
    assert best.residual < 1e-6
    assert best.value == pytest.approx(value, rel=1e-4)
    np.testing.assert_allclose(best.own_values[measured < 1.0 - 1e-9], value, rtol=1e-4)
    if np.ptp(measured) > 0.01:
        assert found.laws[0].name == name
        assert of(found, "newton").residual > 0.003


def test_the_residual_is_the_least() -> None:
    measured = np.array([0.9, 0.88, 0.8, 0.79, 0.7])
    for law in rank_laws(CASE, SPEED, measured).laws:
        if not law.parameter:
            continue
        ranking = rank_laws(CASE, SPEED, measured, [law.name])
        function = ranking.functions[law.name]
        for factor in (0.97, 1.03):
            value = law.value * factor
            try:
                other = function.changed({law.parameter: value})
            except vi.InputError:
                continue
            moved = np.asarray(vi.laws.achieved_restitution(other, MASS, SPEED)) - measured
            assert np.sqrt(np.mean(moved**2)) >= law.residual - 1e-9, law.name
        np.testing.assert_allclose(
            law.restitution, vi.laws.achieved_restitution(function, MASS, SPEED)
        )
        assert law.largest == pytest.approx(np.max(np.abs(law.restitution - measured)))


def test_own_values_achieve_each_restitution() -> None:
    measured = np.array([0.9, 0.88, 0.8, 0.79, 0.7])
    found = rank_laws(CASE, SPEED, measured, ["adams-impact", "lee-wang", "hertz"])
    law = of(found, "adams-impact")
    for speed, restitution, value in zip(SPEED, measured, law.own_values, strict=True):
        own = found.functions["adams-impact"].changed({"damping_max": float(value)})
        assert vi.laws.achieved_restitution(own, MASS, speed) == pytest.approx(restitution)
    hertz = of(found, "hertz")
    assert hertz.parameter == ""
    assert np.isnan(hertz.value)
    # a restitution that no value of a law achieves
    low = rank_laws(CASE, SPEED, np.array([0.9, 0.8, 0.7, 0.6, 0.3]), ["lee-wang"])
    assert np.isnan(low.laws[0].own_values[-1])
    assert np.isfinite(low.laws[0].own_values[:-2]).all()
    assert np.isfinite(low.laws[0].value)


def test_rows_count_by_their_impacts() -> None:
    measured = np.array([0.9, 0.9, 0.9, 0.9, 0.5])
    count = np.array([1.0, 1.0, 1.0, 1.0, 4.0])
    (law,) = rank_laws(CASE, SPEED, measured, ["newton"], count=count).laws
    assert law.value == pytest.approx(0.7, abs=1e-6)
    assert law.residual == pytest.approx(0.2, abs=1e-6)


def test_laws_that_need_more_are_left_out_and_say_why() -> None:
    found = rank_laws(CASE, SPEED, np.full(5, 0.8))
    assert {law.name for law in found.laws} | set(found.left_out) == set(contact_laws())
    assert "stiffness" in found.left_out["walton-braun"]
    with pytest.raises(vi.InputError, match=r"walton-braun: contact\.stiffness"):
        rank_laws(CASE, SPEED, np.full(5, 0.8), ["walton-braun"])


@pytest.mark.parametrize(
    ("speed", "restitution", "words"),
    [
        ([1.0, 1.0], [0.8, 0.7], "several speeds"),
        ([1.0, 2.0], [0.8], "2 speeds and 1 restitutions"),
        ([1.0, 2.0], [0.8, 1.2], "a restitution of 1.2"),
        ([1.0, 2.0], [0.8, 0.0], "a restitution of 0 "),
        ([1.0, -2.0], [0.8, 0.7], "approach speed"),
    ],
)
def test_refusals(speed: list[float], restitution: list[float], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        rank_laws(CASE, speed, restitution)


def command(monkeypatch: pytest.MonkeyPatch, *words: str) -> Any:
    monkeypatch.setattr(sys, "argv", ["vibroimpact", *words])
    with pytest.raises(SystemExit) as left:
        main()
    return left.value.code


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ev.csv").write_text("speed [m/s],restitution\n0.1,0.93\n0.3,0.91\n1,0.88\n3,0.85\n")
    measured = ("compare", "paper:type1-theory", "--measured", "ev.csv")
    assert not command(monkeypatch, *measured, "--laws", "tsuji,kuwabara-kono", "-o", "out")
    assert "kuwabara-kono fits the 4 restitutions best" in capsys.readouterr().out
    with open("out/ranking.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    assert rows[0]["law"] == "kuwabara-kono"
    summary = json.loads(Path("out/summary.json").read_text())["ranking"]
    assert [law["law"] for law in summary["laws"]] == ["kuwabara-kono", "tsuji"]
    for words, said in (
        (("compare", "paper:type1-theory"), "name the laws"),
        ((*measured, "--achieving", "0.7"), "give one of them"),
        (("compare", "paper:type1-theory", "--laws", "tsuji", "--columns", "a"), "--columns"),
    ):
        assert command(monkeypatch, *words, "-o", "other") == 2
        assert said in capsys.readouterr().err
