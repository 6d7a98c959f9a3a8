"""Studies over sensors: where they are mounted, how they hear, and what must be the same
for all drops.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import vibroimpact as vi
from studies import coal_on_steel
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.errors import InputError
from vibroimpact.studies.planning.axes import Listed, Normal
from vibroimpact.studies.planning.population import Population

SENSORS = [
    {
        "name": "a1",
        "position": [0.1, 0.05],
        "direction": [0, 0, 1],
        "rate": 20e3,
        "accelerometer": {"sensitivity": 0.01, "noise": 0.0},
    },
    {
        "name": "g.2",
        "position": [0.0, 0.05],
        "rate": 20e3,
        "geophone": {"natural_frequency": 10.0, "sensitivity": 28.0},
    },
]


def table(**over: Any) -> dict[str, Any]:
    """A grid over sensors of an elastic plate."""
    return {
        **coal_on_steel(),
        "drop": {"speed": 2.0},
        "contact": {"law": "tsuji", "restitution": 0.5},
        "sensors": SENSORS,
        "run": {"duration": 0.01},
        "sweep": {"keep": ["signals"], "over": over},
    }


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> vi.studies.Study:
    over = {
        "sensors.a1.position.x": ["100 mm", "97 mm"],
        "sensors.a1.accelerometer.sensitivity": ["10 mV s^2/m", "20 mV s^2/m"],
        "sensors.g.2.amplifier.noise": ["0 mV", "3 mV"],
    }
    return vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of(table(**over)), tmp_path_factory.mktemp("sensors") / "study"
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize("place", [0, 1])
def test_a_swept_sensor_reads_what_one_mounted_there_reads(
    study: vi.studies.Study, place: int
) -> None:
    case = vi.case_of(
        with_values(
            table(),
            {
                "sensors.a1.position.x": [0.1, 0.097][place],
                "sweep": {"over": {"sphere.radius": [0.02]}},
            },
        )
    )
    alone = vi.simulate(case).signals()["a1"].value
    np.testing.assert_allclose(
        study.values("signal_a1")[place, 0, 0], alone, rtol=0, atol=1e-6 * np.abs(alone).max()
    )


def test_sensitivity_scales_what_is_read(study: vi.studies.Study) -> None:
    signals = study.values("signal_a1")
    np.testing.assert_allclose(signals[:, 1], 2.0 * signals[:, 0], rtol=1e-6)
    assert not np.allclose(signals[0], signals[1], rtol=1e-2)


def test_swept_noise_is_in_the_samples_as_stated(study: vi.studies.Study) -> None:
    signals = study.values("signal_g.2")
    noise = (signals[..., 1, :] - signals[..., 0, :]).ravel()
    assert stats.kstest(noise, stats.norm(0.0, 3e-3).cdf).pvalue > 1e-3


def test_keys_have_units_and_words(study: vi.studies.Study) -> None:
    assert study.meanings["sensors.a1.position.x"] == ("m", "position of the sensor, x")
    assert study.meanings["sensors.g.2.amplifier.noise"][0] == "V"


def test_a_sensor_is_mounted_once_on_a_plate() -> None:
    own = {"coal": {"sphere.radius": Listed((0.01,))}, "gangue": {"sphere.radius": Listed((0.02,))}}
    population = Population({"coal": 1.0, "gangue": 1.0}, own, falls_per_rock=2, rocks_per_plate=10)
    columns, labels = population.draw({"sensors.a1.position.x": Normal(0.1, 0.003, 3)}, 400, 0)
    drawn = columns["sensors.a1.position.x"]
    assert len(set(drawn.tolist())) == 20
    assert all(len(set(drawn[labels["plate"] == plate].tolist())) == 1 for plate in range(20))


@pytest.mark.parametrize(
    ("over", "words"),
    [
        ({"sensors.a2.rate": [1e3]}, 'there is no sensor called "a2"; there are a1, g.2.'),
        (
            {"sensors.a1.positoin.x": [0.1]},
            'such as "sensors.a1.position". Did you mean "sensors.a1.position.x"?',
        ),
        ({"sensors.a1.name": ["b"]}, 'sweep.over."sensors.a1.name": no such key is swept'),
        (
            {"sensors.a1.rate": [20e3, 10e3]},
            r"sensors.a1: it would give voltage \[V\] at 10000 Hz, and voltage \[V\] at "
            r"20000 Hz by the case",
        ),
        (
            {"sensors.a1.accelerometer": [{"noise": 1.0}]},
            r"acceleration \[m/s2\] at 20000 Hz, and voltage \[V\] at 20000 Hz by the case",
        ),
        ({"sensors.a1.position.x": [0.1, 0.3]}, 'sensors."a1".position: .* lies outside the plate'),
        (
            {"sensors.g.2.direction.x": [0.1]},
            "sensors.g.2.direction: it is missing, so that it has no x",
        ),
        ({"sensors.g.2.geophone.sensitivity": ["3 m/s"]}, "sweep.over"),
        ({"sensors.a1.accelerometer.noise": {"from": -1.0, "to": 1.0}}, "noise.*-1"),
    ],
)
def test_what_can_not_be_swept_is_refused(over: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        vi.studies.sweep_of(table(**over))


def test_sensors_matter_to_signals_alone() -> None:
    with pytest.raises(
        InputError, match=r'sensors.a1.position.x": it changes signals alone, which are not kept'
    ):
        vi.studies.sweep_of(
            table(**{"sensors.a1.position.x": [0.1]})
            | {"sweep": {"over": {"sensors.a1.position.x": [0.1]}}}
        )


def test_sensors_are_not_of_a_class() -> None:
    classes = {
        name: {"over": {"sensors.a1.accelerometer.noise": {"from": 0.1, "to": 0.2}}}
        for name in ("a", "b")
    }
    sweep = {
        "design": "population",
        "samples": 8,
        "keep": ["signals"],
        "over": {},
        "classes": classes,
    }
    with pytest.raises(InputError, match="the sensors are not of a class; leave it out here"):
        vi.studies.sweep_of({**table(), "sweep": sweep})


def test_unquoted_keys_reach_sensors() -> None:
    nested = {
        "sensors": {
            "a1": {
                "position": {"x": [0.1, 0.097]},
                "accelerometer": {"noise": {"from": 0.1, "to": 0.2, "number": 3}},
            }
        }
    }
    assert vi.studies.sweep_of(table(**nested)).size == 6


def test_single_keys_of_sensors_are_set() -> None:
    case = vi.case_of(
        with_values(
            {**table(), "sweep": {"over": {"sphere.radius": [0.02]}}},
            {"sensors.g.2.geophone.sensitivity": "30 V s/m"},
        )
    )
    assert case.sensors[1].geophone is not None
    assert case.sensors[1].geophone.sensitivity == 30.0
    with pytest.raises(
        InputError, match='there is no sensor called "b"; the case has none with a name'
    ):
        with_values({"sphere": {}}, {"sensors.b.rate": 1.0})
