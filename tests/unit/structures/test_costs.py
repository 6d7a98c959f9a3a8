"""What a run takes, told beforehand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import tomli_w
from typer.testing import CliRunner

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.costs import (
    costs_of,
    describe_costs,
    impacts_expected,
    seconds_at_most,
    seconds_expected,
)
from vibroimpact.cli import app
from vibroimpact.errors import InputError

PLATE = {
    "size": [0.52, 0.42, 0.008],
    "material": "steel-paper",
    "model": "elastic",
    "modes": 10,
    "supports": "simply-supported",
}
ELASTIC_SPHERE = {"radius": 0.025, "material": "rock-paper", "model": "elastic", "modes": 300}


def bouncing(restitution: float, **run: Any) -> vi.Case:
    return vi.case_of(plain_case(contact__restitution=restitution, run={"impacts": "all", **run}))


@pytest.mark.parametrize(
    ("restitution", "run"),
    [
        (0.3, {}),
        (0.9, {}),
        (0.9, {"duration": "1 s"}),
        (0.5, {"rest_speed": 0.5}),
        (0.9, {"impacts": 4}),
    ],
)
def test_about_as_many_impacts_as_there_are(restitution: float, run: dict[str, Any]) -> None:
    case = bouncing(restitution, **run)
    found = len(vi.simulate(case).impacts["impact"])
    assert 0.7 * found - 2 <= impacts_expected(case) <= 1.3 * found + 2


@pytest.mark.parametrize(
    ("restitution", "run"),
    [
        (0.3, {}),
        (0.9, {}),
        (0.5, {"impacts": 3}),
        (1.0, {"impacts": 4}),
        (0.9, {"duration": "1 s"}),
    ],
)
def test_about_as_long_as_it_takes(restitution: float, run: dict[str, Any]) -> None:
    case = bouncing(restitution, **run)
    end = vi.simulate(case).history()["time_s"][-1]
    assert seconds_expected(case) == pytest.approx(end, rel=0.3)
    assert seconds_at_most(case) >= 0.99 * end


def test_a_run_of_tens_of_thousands_of_impacts_is_told() -> None:
    (told,) = describe_costs(bouncing(0.9999))
    assert told.startswith("about 6")
    assert "impacts take about 5 minutes, " in told
    assert told.endswith("; give fewer run.impacts, or a higher run.rest_speed")


@pytest.mark.parametrize("law", ["newton", "hertz"])
def test_an_elastic_bounce_goes_on_to_the_end_or_to_the_most_impacts(law: str) -> None:
    contact = {"law": law, **({"restitution": 1.0} if law == "newton" else {})}
    case = vi.case_of(plain_case(contact=contact, run={"duration": "10 s"}))
    assert impacts_expected(case) == pytest.approx(len(vi.simulate(case).impacts["impact"]), abs=1)
    assert (
        impacts_expected(vi.case_of(plain_case(contact=contact, run={"duration": "1e7 s"})))
        == 100_000
    )


def test_a_short_run_is_not_worth_a_word() -> None:
    assert describe_costs(vi.case_of(plain_case())) == []
    assert describe_costs(vi.load_case("paper:type1-theory")) == []


def test_samples_of_a_long_run_are_told_and_refused_where_they_do_not_fit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sensors = [{"name": name, "position": [0.1, 0.0], "rate": "50 kHz"} for name in "abcdef"]
    case = vi.case_of(plain_case(plate=PLATE, run={"duration": "600 s"}, sensors=sensors))
    (told,) = (one for one in describe_costs(case) if "samples" in one)
    assert told.startswith("the samples of 6 sensors, 1.8e+08, take about")
    assert "GB of memory and 1.6 GB on disk" in told
    monkeypatch.setattr(
        "vibroimpact.structures.finite_elements.free_memory.free_memory", lambda: 1e9
    )
    with pytest.raises(
        InputError,
        match=r"about 1\.7 GB of memory, and 1 GB are free, of which 80 % .*; give a shorter "
        r"run\.duration or a lower rate",
    ):
        describe_costs(case)


def test_modes_that_take_long_are_told_until_they_are_stored(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path))
    case = vi.case_of(plain_case(sphere=ELASTIC_SPHERE))
    (told,) = describe_costs(case, modes_alone=True)
    assert told.startswith("the modes of the sphere take about 40 s, 1 GB of memory")
    monkeypatch.setattr("vibroimpact.structures.store.has_model", lambda key: True)
    assert costs_of(case, modes_alone=True) == []


def test_modes_below_a_frequency_take_as_long_as_their_number(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path))
    sphere = {
        "radius": 0.025,
        "material": "rock-paper",
        "model": "elastic",
        "mesh": {"elements_across": 12},
    }
    cases = [
        vi.case_of(plain_case(sphere={**sphere, "max_frequency": most}))
        for most in ("20 kHz", "60 kHz")
    ]
    (few,), (many,) = (costs_of(case, modes_alone=True) for case in cases)
    assert few.seconds < 0.5 * many.seconds
    assert many.remedy.startswith("give a lower sphere.max_frequency")


def test_many_impacts_of_bodies_that_vibrate_are_told() -> None:
    sphere = {**ELASTIC_SPHERE, "modes": 5, "damping": 1e-6}
    told = describe_costs(
        vi.case_of(plain_case(sphere=sphere, contact__restitution=0.9999, run={"impacts": 1000}))
    )
    assert any(one.startswith("up to about 1,000 impacts take about 20 s") for one in told), told


def test_check_says_it(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(
        tomli_w.dumps(plain_case(contact__restitution=0.9999, run={"impacts": "all"})),
        encoding="utf-8",
    )
    shown = CliRunner().invoke(app, ["check", str(file)])
    assert shown.exit_code == 0
    assert "cost" in shown.output
    assert "run.rest_speed" in shown.output
