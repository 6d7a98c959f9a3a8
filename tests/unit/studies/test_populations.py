"""Studies of populations: rocks of several classes, falls that share a rock and a plate,
and signals cut around the first touch.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import vibroimpact as vi
from studies import coal_on_steel
from vibroimpact.dynamics.first_touch import first_touch
from vibroimpact.errors import ComputationError
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.planning.axes import Listed, Normal, Spaced
from vibroimpact.studies.planning.population import Population
from vibroimpact.studies.planning.window import Window

OWN = {
    "coal": {"sphere.material.density": Normal(1380.0, 60.0, 4)},
    "gangue": {"sphere.material.density": Normal(2600.0, 100.0, 4)},
}
COMMON = {
    "sphere.radius": Spaced(0.01, 0.04, 3, "log"),
    "drop.height": Spaced(0.5, 1.5, 3),
    "plate.size.thickness": Normal(0.008, 0.0003, 3),
    "contact.law": Listed(("hertz", "tsuji")),
}
POPULATION = Population({"coal": 3.0, "gangue": 1.0}, OWN, falls_per_rock=4, rocks_per_plate=50)


def test_falls_share_what_belongs_to_rock_and_plate() -> None:
    columns, labels = POPULATION.draw(COMMON, 4000, 1)
    assert labels["rock"].tolist() == [fall // 4 for fall in range(4000)]
    assert labels["plate"].tolist() == [fall // 200 for fall in range(4000)]
    for key, number in (
        ("sphere.radius", 1000),
        ("drop.height", 4000),
        ("plate.size.thickness", 20),
        ("sphere.material.density", 1000),
    ):
        assert len(set(columns[key].tolist())) == number
    for key, group in (
        ("sphere.radius", "rock"),
        ("sphere.material.density", "rock"),
        ("plate.size.thickness", "plate"),
        ("contact.law", "rock"),
    ):
        for one in np.unique(labels[group]):
            assert len(set(columns[key][labels[group] == one].tolist())) == 1


def test_classes_have_their_shares_and_distributions() -> None:
    columns, labels = POPULATION.draw(COMMON, 40_000, 2)
    rocks = slice(None, None, 4)
    coal = labels["class"][rocks] == "coal"
    assert stats.binomtest(int(coal.sum()), len(coal), 0.75).pvalue > 1e-3
    density = columns["sphere.material.density"][rocks]
    assert stats.kstest(density[coal], stats.norm(1380.0, 60.0).cdf).pvalue > 1e-3
    assert stats.kstest(density[~coal], stats.norm(2600.0, 100.0).cdf).pvalue > 1e-3
    # keys are independent
    assert (
        abs(stats.spearmanr(density[coal], columns["sphere.radius"][rocks][coal]).statistic) < 0.03
    )


def test_more_falls_and_other_keys_leave_what_was_drawn() -> None:
    some, labels = POPULATION.draw(COMMON, 400, 1)
    more, further = POPULATION.draw({**COMMON, "drop.position.x": Spaced(-0.1, 0.1, 2)}, 4000, 1)
    for key, values in some.items():
        np.testing.assert_array_equal(more[key][:400], values)
    np.testing.assert_array_equal(further["class"][:400], labels["class"])
    assert not np.array_equal(
        POPULATION.draw(COMMON, 400, 3)[0]["sphere.radius"], some["sphere.radius"]
    )


def test_the_window_is_cut_at_the_last_sample_before_it() -> None:
    window = Window(1e-3, 5e-3)
    rng = np.random.default_rng(0)
    for touch in rng.uniform(0.01, 0.1, 100):
        begin, end = window.samples(np.array([touch, np.nan]), 20e3, 4000)
        assert end - begin == 100
        assert 0.0 <= touch - begin / 20e3 - 1e-3 < 1.0 / 20e3 + 1e-9
    with pytest.raises(ComputationError, match="no impact"):
        window.samples(np.array([]), 20e3, 4000)
    with pytest.raises(
        ComputationError, match=r"touches 0 s after the start, less than the 0.001 s"
    ):
        window.samples(np.array([0.0]), 20e3, 4000)
    with pytest.raises(
        ComputationError,
        match=r"ends at 0.2 s, before the window does, at 0.204 s; give a longer run.duration",
    ):
        window.samples(np.array([0.2]), 20e3, 4000)


def test_a_window_after_the_last_impact_asks_for_more_impacts() -> None:
    """A longer duration was asked for, which did not help."""
    case = {**table(), "run": {"duration": 0.6, "impacts": 1}}
    sweep = {"over": {"drop.height": [0.1]}, "keep": ["signals"], "window": {"length": 0.25}}
    study = vi.studies.sweep_of({**case, "sweep": sweep})
    failures = compute_points(
        study.table, ("signals",), 0, study.plan.points(0, 1), study.window
    ).failures
    assert (
        "as the run ended before run.duration; where run.impacts ended it, allow more"
        in failures[0]
    )


def table(**sweep: Any) -> dict[str, Any]:
    """A small population on an elastic plate."""
    return {
        **coal_on_steel(),
        "drop": {"height": 0.1},
        "contact": {"law": "tsuji", "restitution": 0.5},
        "sensors": [
            {
                "name": "a1",
                "position": [0.1, 0.05],
                "rate": 20e3,
                "filter": "butterworth",
                "accelerometer": {"noise": 0.1},
            }
        ],
        "run": {"duration": 0.3},
        "sweep": {
            "design": "population",
            "samples": 12,
            "seed": 1,
            "keep": ["signals"],
            "falls_per_rock": 2,
            "rocks_per_plate": 3,
            "window": {"before": "1 ms", "length": "10 ms"},
            "over": {
                "drop.height": {"from": 0.05, "to": 0.15},
                "plate.size.thickness": {"from": 0.007, "to": 0.009},
            },
            "classes": {
                "coal": {"over": {"sphere.material.density": [1300.0, 1400.0]}},
                "dull gangue": {"over": {"sphere.material.density": [2500.0, 2700.0]}},
            },
            **sweep,
        },
    }


@pytest.mark.slow
def test_a_population_is_computed_and_read(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(table())
    study = vi.studies.load_study(vi.studies.run_sweep(sweep, tmp_path / "falls"))
    assert study.failures == {}
    assert study.labels["rock"].tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    assert study.labels["plate"].tolist() == [0] * 6 + [1] * 6
    light = study.coordinates["sphere.material.density"] < 2000.0
    assert np.array_equal(study.labels["class"] == "coal", light)
    assert set(study.labels["class"]) == {"coal", "dull_gangue"}
    signals = study.values("signal_a1")
    assert signals.shape == (12, 200)
    since = study.values("first_time_s") - study.values("a1_start_s")
    assert ((since >= 1e-3) & (since < 1e-3 + 5e-5)).all()
    # before the touch noise alone, and after it what the drop by itself gives
    assert np.abs(signals[:, :12]).max() < 0.6
    number = 7
    alone = sweep.case_of(number).to_problem()
    touch = first_touch(alone)
    assert touch == pytest.approx(float(study.values("first_time_s")[number]), rel=1e-12)
    whole = vi.simulate(alone).signals()["a1"].value
    begin = round(float(study.values("a1_start_s")[number]) * 20e3)
    assert np.abs(whole[begin : begin + 200] - signals[number]).max() < 1.0  # the noise of either
    assert np.abs(signals[number]).max() > 100.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"classes": {"coal": {"over": {"sphere.radius": [0.01]}}}},
            "sweep.classes: there is only one class",
        ),
        (
            {
                "classes": {
                    "a": {"over": {"sphere.radius": [0.01]}},
                    "b": {"over": {"sphere.density": [1.0]}},
                }
            },
            "no such key is swept",
        ),
        (
            {"design": "grid", "samples": None},
            'sweep.design: grid has no classes; give design = "population"',
        ),
        ({"classes": None}, "sweep.classes: they are missing; a population has classes"),
        (
            {
                "classes": {
                    "a": {"over": {"sphere.radius": [0.01]}},
                    "b": {"over": {"contact.restitution": [0.4]}},
                }
            },
            'sweep.classes."b".over: "contact.restitution" is not there for all classes',
        ),
        (
            {
                "classes": {
                    "a": {"over": {"drop.height": [0.1]}},
                    "b": {"over": {"drop.height": [0.4]}},
                }
            },
            'sweep.classes."a".over."drop.height": it stands in [sweep.over] too',
        ),
        (
            {
                "classes": {
                    "a": {"over": {"plate.damping": [0.1]}},
                    "b": {"over": {"plate.damping": [0.4]}},
                }
            },
            'sweep.classes."a".over."plate.damping": the plate is not of a class',
        ),
        (
            {
                "classes": {
                    "a": {"over": {"sphere.radius": [0.01]}},
                    "b": {
                        "over": {
                            "sphere.radius": {
                                "distribution": "normal",
                                "mean": 0.01,
                                "standard_deviation": 0.1,
                            }
                        }
                    },
                }
            },
            'sweep.classes."b".over."sphere.radius": -0.',
        ),
        ({"classes": {"a": {"share": 0.0, "over": {}}, "b": {"over": {}}}}, "share"),
        ({"samples": 2}, 'sweep.samples: "'),
        ({"keep": ["peaks"]}, "sweep.window: it is a part of the signals, which are not kept"),
        ({"window": {"before": "1 ms"}}, "sweep.window.length: this key is missing"),
    ],
)
def test_wrong_populations_are_refused(change: dict[str, Any], words: str) -> None:
    wrong = table(**change)
    wrong["sweep"] = {key: value for key, value in wrong["sweep"].items() if value is not None}
    with pytest.raises(vi.InputError) as error:
        vi.studies.sweep_of(wrong).plan  # noqa: B018
    assert words in str(error.value)
