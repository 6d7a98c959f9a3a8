"""Keys of a study that follow another key by a power, times a factor that is drawn."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import vibroimpact as vi
from support import plain_case
from vibroimpact.studies.planning.explain_sweep import sweep_document
from vibroimpact.studies.report.card import data_card

FACTOR = {"distribution": "lognormal", "mean": 1.0, "standard_deviation": 0.2}
SPEED = {
    "value": "1.2 m/s",
    "of": "sphere.radius",
    "at": "10 mm",
    "exponent": 0.5,
    "factor": FACTOR,
}
RADIUS = {"from": "5 mm", "to": "20 mm", "scale": "log"}


def table(over: dict[str, Any], **sweep: Any) -> dict[str, Any]:
    stated = {"design": "latin-hypercube", "samples": 400, "seed": 3, "over": over, **sweep}
    return {
        **plain_case(drop={"speed": 1.0}),
        "sweep": {key: value for key, value in stated.items() if value is not None},
    }


def population(
    over: dict[str, Any], own: dict[str, Any], other: dict[str, Any] | None = None
) -> dict[str, Any]:
    classes = {"round": {"over": own}, "flat": {"over": own if other is None else other}}
    return table(
        over,
        design="population",
        samples=2000,
        falls_per_rock=4,
        rocks_per_plate=50,
        classes=classes,
    )


@pytest.mark.parametrize(("design", "samples"), [("latin-hypercube", 400), ("sobol", 512)])
def test_a_speed_follows_the_size(design: str, samples: int) -> None:
    columns = vi.studies.sweep_of(
        table({"drop.speed": SPEED, "sphere.radius": RADIUS}, design=design, samples=samples)
    ).plan.columns
    assert list(columns) == ["drop.speed", "sphere.radius"]
    factor = columns["drop.speed"] / (1.2 * np.sqrt(columns["sphere.radius"] / 0.01))
    spread = np.sqrt(np.log1p(0.04))
    assert (
        stats.kstest(factor, stats.lognorm(spread, scale=np.exp(-0.5 * spread**2)).cdf).pvalue
        > 1e-3
    )
    assert abs(stats.spearmanr(factor, columns["sphere.radius"]).statistic) < 0.15
    assert stats.spearmanr(columns["drop.speed"], columns["sphere.radius"]).statistic > 0.6


@pytest.mark.parametrize(
    ("each", "number"), [("rock", 500), ("fall", 2000), (None, 2000), ("plate", 10)]
)
def test_the_factor_belongs_to_rock_or_fall(each: str | None, number: int) -> None:
    speed = SPEED if each is None else {**SPEED, "each": each}
    columns = vi.studies.sweep_of(
        population({"drop.speed": speed}, {"sphere.radius": RADIUS})
    ).plan.columns
    factor = columns["drop.speed"] / np.sqrt(columns["sphere.radius"])
    assert len(np.unique(factor.round(9))) == number


def test_classes_have_laws_of_their_own() -> None:
    flat = {
        "sphere.radius": RADIUS,
        "drop.speed": {**SPEED, "value": "0.6 m/s", "exponent": 1.0, "factor": [1.0]},
    }
    plain = {"sphere.radius": RADIUS, "drop.speed": {**SPEED, "factor": [1.0]}}
    plan = vi.studies.sweep_of(population({}, plain, flat)).plan
    radius, speed, there = (
        plan.columns["sphere.radius"],
        plan.columns["drop.speed"],
        plan.labels["class"] == "flat",
    )
    np.testing.assert_allclose(speed[there], 0.6 * radius[there] / 0.01, rtol=1e-12)
    np.testing.assert_allclose(speed[~there], 1.2 * np.sqrt(radius[~there] / 0.01), rtol=1e-12)


def test_what_others_draw_stays() -> None:
    own = {"sphere.radius": RADIUS}
    alone = vi.studies.sweep_of(
        population({"drop.gravity": {"from": 9.0, "to": 10.0}}, own)
    ).plan.columns
    beside = vi.studies.sweep_of(
        population({"drop.gravity": {"from": 9.0, "to": 10.0}, "drop.speed": SPEED}, own)
    ).plan.columns
    for key, values in alone.items():
        np.testing.assert_array_equal(beside[key], values)


def test_the_card_of_a_data_set_says_what_follows_what(tmp_path: Path) -> None:
    stated = population({"drop.speed": SPEED}, {"sphere.radius": RADIUS})
    study = vi.studies.load_study(
        vi.studies.run_sweep(vi.studies.sweep_of(stated), tmp_path / "study")
    )
    assert study.failures == {}
    card = data_card(study)
    assert "each independently. `drop.speed` follows `sphere.radius`." in card
    assert "Values and labels, without signals, are in `study.nc`" in card
    assert "## Signals" not in card


def test_a_description_says_what_follows_what() -> None:
    told = sweep_document(
        vi.studies.sweep_of(table({"drop.speed": SPEED, "sphere.radius": RADIUS}))
    )["over"]["drop.speed"]
    assert (told["value"], told["of"], told["at"], told["exponent"]) == (
        1.2,
        "sphere.radius",
        0.01,
        0.5,
    )
    assert told["factor"]["distribution"] == "lognormal"


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (
            table({"drop.speed": SPEED}),
            r'sweep.over."drop.speed".of: sphere.radius is not swept here',
        ),
        (table({"drop.speed": {**SPEED, "of": "sphere.radus"}}), "no such key is swept"),
        (
            table({"drop.speed": SPEED, "sphere.radius": RADIUS}, design="grid", samples=None),
            "in a grid no key follows another",
        ),
        (
            table({"drop.speed": SPEED, "sphere.radius": RADIUS}, design="saltelli", samples=8),
            "in a saltelli no key follows another",
        ),
        (
            table({"drop.speed": {**SPEED, "of": "drop.speed", "at": "1 m/s"}}),
            "drop.speed follows another key itself",
        ),
        (
            table({"drop.speed": {**SPEED, "each": "rock"}, "sphere.radius": RADIUS}),
            "has neither plates nor rocks",
        ),
        (table({"drop.speed": {**SPEED, "at": "10 m/s"}, "sphere.radius": RADIUS}), "drop.speed"),
        (
            table({"drop.speed": {**SPEED, "factor": [-1.0]}, "sphere.radius": RADIUS}),
            r'"drop.speed".factor: -1',
        ),
        (
            table({"plate.model": SPEED, "sphere.radius": RADIUS}),
            "a key can follow another only if both are quantities",
        ),
        (
            population(
                {
                    "sphere.radius": {**SPEED, "value": "1 mm", "of": "drop.speed", "at": 1.0},
                    "drop.speed": [1.0, 2.0],
                },
                {"contact.restitution": [0.5]},
            ),
            "drop.speed differs from fall to fall, and sphere.radius has one value a rock",
        ),
        (
            population(
                {"contact.restitution": {**SPEED, "value": 0.5, "each": "fall"}},
                {"sphere.radius": RADIUS},
            ),
            "contact.restitution has one value a rock; its factor can't differ from fall to fall",
        ),
    ],
)
def test_what_can_not_follow_is_refused(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.studies.sweep_of(wrong)


def test_a_place_below_zero_has_no_root() -> None:
    place = {"from": "-60 mm", "to": "60 mm"}
    speed = {**SPEED, "of": "drop.position.x"}
    with pytest.raises(
        vi.InputError,
        match=r'^sweep\.over\."drop\.speed": -\S+ to the power of 0\.5 is no finite number; it '
        r"is drop\.position\.x over at$",
    ):
        vi.studies.sweep_of(table({"drop.position.x": place, "drop.speed": speed}))
