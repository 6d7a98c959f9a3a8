"""Bad input of a study: one message that names the key and what is allowed, before
anything runs.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest

import vibroimpact as vi
from studies import RANDOM, study_file, study_table
from vibroimpact.cli import main


def over(**changes: object) -> dict:
    return {"over": {key.replace("__", "."): value for key, value in changes.items()}}


def normal(**changes: object) -> dict:
    return over(
        sphere__radius={
            "distribution": "normal",
            "mean": "25 mm",
            "standard_deviation": "5 mm",
            **changes,
        }
    )


def drawn(**changes: object) -> dict:
    return {**RANDOM, **changes}


RADIUS = 'sweep.over."sphere.radius"'
FAULTS: list[tuple[object, str]] = [
    (3, "sweep: 3 is not a table"),
    ({}, "sweep.over: this key is missing: the values of dotted keys of the case"),
    ({"over": {}}, "sweep.over: it is empty; it takes dotted keys of the case"),
    ({"over": [1]}, "sweep.over: [1] is not a table"),
    (
        {"ovr": {}},
        'sweep.ovr: unknown key "ovr"; it takes design, over, samples, seed, keep, window, '
        "classes, falls_per_rock, rocks_per_plate. "
        'Did you mean "over"?',
    ),
    (
        over(sphere__raduis=[0.01]),
        'sweep.over."sphere.raduis": no such key is swept; it must be one of [sphere]',
    ),
    (over(sphere__raduis=[0.01]), 'Did you mean "sphere.radius"?'),
    (over(contact__measured__max_force=["1 kg"]), '"1 kg" is a mass; expected a force'),
    (over(radius=[0.01]), 'sweep.over."radius": no such key is swept'),
    (over(contact__restitutoin=[0.5]), 'Did you mean "contact.restitution"?'),
    (over(sphere__material__young_modulus=[1e9]), 'Did you mean "sphere.material.youngs_modulus"?'),
    (over(sensors__0__rate=[1e3]), 'there is no sensor called "0"; the case has none with a name'),
    (
        over(tube__radius=[1e3]),
        "no such key is swept; it must be one of [sphere], [plate], [drop], [contact], "
        "[run] or of a sensor",
    ),
    (over(sphere__radius=[]), f"{RADIUS}: the list is empty"),
    (
        over(sphere__radius=0.01),
        f"{RADIUS}: 0.01 is not allowed; it must be a list of values, a range",
    ),
    (
        over(sphere__radius=[0.01, -0.02]),
        f"{RADIUS}: -0.02 is not allowed; it must be greater than 0 m",
    ),
    (over(sphere__radius=["1 kg"]), f'{RADIUS}: "1 kg" is a mass; expected a length'),
    (over(sphere__radius={"from": 0.01}), f"{RADIUS}.to: this key is missing"),
    (
        over(sphere__radius={"fro": 0.01, "to": 0.02}),
        f'{RADIUS}.fro: unknown key "fro"; it takes from, to, number, scale. Did you mean "from"?',
    ),
    (
        over(sphere__radius={"form": 0.01}),
        f"{RADIUS}: {{ form = 0.01 }} has no values; it must be a list of values, a range",
    ),
    (
        over(sphere__radius={"from": 0.02, "to": 0.01}),
        f"{RADIUS}.to: 0.01 is not greater than from, 0.02",
    ),
    (over(sphere__radius={"from": 0.01, "to": 0.02, "number": 0}), f"{RADIUS}.number"),
    (
        over(sphere__radius={"from": 0.01, "to": 0.02, "scale": "cubic"}),
        f'{RADIUS}.scale: "cubic" is not allowed; it must be "linear" or "log"',
    ),
    (
        over(drop__position__x={"from": -0.1, "to": 0.1, "scale": "log"}),
        'sweep.over."drop.position.x".from: -0.1 has no logarithm',
    ),
    (
        over(run__impacts={"from": 1, "to": 5}),
        'sweep.over."run.impacts": this key holds no quantity, so that it takes a list',
    ),
    (
        normal(distribution="gaussian"),
        f'{RADIUS}.distribution: "gaussian" is not allowed; it must be one of normal, '
        "lognormal, uniform",
    ),
    (
        normal(standard_deviation="0 mm"),
        f'{RADIUS}.standard_deviation: "0 mm" is not allowed; it must be greater than 0 m',
    ),
    (normal(standard_deviation="-1 mm"), f'{RADIUS}.standard_deviation: "-1 mm" is not allowed'),
    (normal(standard_deviation="5 s"), f'{RADIUS}.standard_deviation: "5 s" is a time'),
    (
        normal(sigma="5 mm"),
        f'{RADIUS}.sigma: unknown key "sigma"; it takes distribution, mean, standard_deviation',
    ),
    (
        normal(at_least="30 mm", at_most="20 mm"),
        f"{RADIUS}.at_most: 0.02 is not more than at_least, 0.03",
    ),
    (
        normal(at_least="300 mm"),
        f"{RADIUS}.at_least: 0 % of the distribution is at least 0.3; it must be truncated less",
    ),
    (
        normal(distribution="lognormal", mean="-25 mm"),
        f"{RADIUS}.mean: -0.025 is not allowed; the mean of a lognormal",
    ),
    (
        normal(standard_deviation="25 mm"),
        f"{RADIUS}: -0.0161213 is not allowed; it must be greater than 0 "
        "m; truncate the distribution",
    ),
    ({"design": "gird", **over(sphere__radius=[0.01])}, 'sweep.design: there is no design "gird"'),
    (
        {"design": "sobol", **over(sphere__radius=[0.01])},
        "sweep.samples: it is missing; sobol needs the number of points to draw",
    ),
    (
        {"samples": 10, **over(sphere__radius=[0.01])},
        "sweep.samples: grid has as many points as its values give; leave this out",
    ),
    (drawn(samples=0), "sweep.samples: 0 is not allowed"),
    (drawn(samples=10.5), "sweep.samples: 10.5 is not allowed"),
    (
        drawn(samples=20_000_000),
        "sweep.samples: 20000000 is not allowed; it must be a whole number from 1 to 10000000",
    ),
    (
        drawn(design="sobol", samples=100),
        "sweep.samples: 100 is not a power of two, which the sequence needs "
        "to be balanced; take 64 or 128",
    ),
    (
        drawn(design="sobol", samples=9_000_000),
        "which the sequence needs to be balanced; take 8388608",
    ),
    (
        {
            "design": "latin-hypercube",
            "samples": 4,
            **over(
                sphere__radius=[0.01, 0.03],
                contact__restitution={"value": 0.5, "of": "sphere.radius", "at": 0.01},
            ),
        },
        'sweep.over."contact.restitution": 1.5 is not allowed; it must be at least 0 and at '
        "most 1; it follows another key: choose",
    ),
    (drawn(seed=-1), "sweep.seed: -1 is not allowed"),
    (
        {"design": "saltelli", "samples": 8, **over(sphere__radius={"from": 0.01, "to": 0.02})},
        "sweep.over: there is one key alone",
    ),
    (
        {"design": "zip", **over(sphere__radius=[0.01], drop__height=[1.0, 2.0])},
        "sphere.radius has 1, drop.height has 2",
    ),
    ({"design": "zip", **normal()}, f"{RADIUS}: a distribution has no values in an order"),
    (
        {"keep": ["impact"], **over(sphere__radius=[0.01])},
        'sweep.keep.0: "impact" is not allowed; it must be',
    ),
    (
        {"keep": ["signals"], **over(sphere__radius=[0.01])},
        'sweep.keep: "signals" needs [[sensors]], on a plate that is elastic or shaken',
    ),
    (
        over(
            sphere__radius={"from": 1e-3, "to": 2e-3, "number": 10_000},
            drop__height={"from": 1, "to": 2, "number": 10_000},
        ),
        "there would be 100000000",
    ),
    # cases that are wrong
    (
        over(drop__height=[1.0, 0.01]),
        "at drop.height = 0.01: drop.height: 0.01 m does not lift the sphere off the surface",
    ),
    (over(drop__speed=[1.0]), "drop: give either height or speed; both are given"),
    (
        over(contact__law=["flores", "hertzz"]),
        'at contact.law = "hertzz": contact.law: there is no contact law "hertzz"',
    ),
    (over(contact__law=["flores", "thornton"]), 'at contact.law = "thornton"'),
    (over(contact__restitution=[0.5, 1.5]), 'sweep.over."contact.restitution": 1.5 is not allowed'),
    (over(sphere__material=["rock-paper", "stel"]), 'there is no material "stel"'),
    (over(plate__model=["rigid", "elastic"]), 'at plate.model = "elastic": plate'),
    (over(sphere__radius__deep=[1.0]), "no such key is swept"),
    (
        over(plate__size__thickness=[0.01]),
        "plate.size: it is missing, so that it has no thickness that could be swept",
    ),
    (
        {"over": {"sphere.radius": [0.01], "sphere": {"radius": [0.02]}}},
        f"{RADIUS}: this key stands there twice",
    ),
    (
        over(drop__height=[1.0, 2.0, "100 cm"]),
        'sweep.over."drop.height": 1.0 stands there twice, and a grid has each value once',
    ),
    (
        over(sphere__radius={"from": 0.01, "to": 0.02, "number": 1}),
        f"{RADIUS}.number: 1 is not allowed",
    ),
    (over(run__impacts=[1, 2.5]), "at run.impacts = 2.5: run.impacts: 2.5 is not allowed"),
    (
        over(sphere__radius={"file": "nothing.csv", "column": "radius"}),
        "nothing.csv: there is no such file",
    ),
    (over(sphere__radius={"file": "nothing.csv"}), f"{RADIUS}.column: this key is missing"),
]


@pytest.mark.parametrize(("sweep", "words"), FAULTS)
def test_what_is_wrong_is_told(sweep: object, words: str) -> None:
    with pytest.raises(vi.InputError) as caught:
        vi.studies.sweep_of(study_table(sweep))
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1, "one fault, one line"


def test_a_case_without_a_sweep_is_told_what_is_missing() -> None:
    with pytest.raises(
        vi.InputError, match=r"sweep: it is missing; it specifies the swept keys and their values"
    ):
        vi.studies.load_sweep("paper:type1-theory")


def test_a_case_that_is_wrong_everywhere_is_told_once() -> None:
    with pytest.raises(vi.InputError, match=r"^plate.material: this key is missing"):
        vi.studies.sweep_of(study_table(plate={}))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b\n1,2\n", "line 1: no column is known among a, b"),
        ("radius [kg]\n1\n", 'column "radius [kg]"'),
        ("radius\n1\n", "the unit is missing; write it in brackets"),
        ("radius [mm]\n5\n-5\n", "line 3: -0.005 is not allowed; it must be greater than 0 m"),
        ("radius [mm]\nx\n", "line 2"),
        ("radius [mm]\n", "there are no rows under the header"),
    ],
)
def test_a_file_of_values_that_is_wrong_is_told(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "sieve.csv").write_text(text, encoding="utf-8")
    file = study_file(tmp_path, over(sphere__radius={"file": "sieve.csv", "column": "radius"}))
    with pytest.raises(vi.InputError, match=r'sweep.over."sphere.radius".file') as caught:
        vi.studies.load_sweep(file)
    assert words in str(caught.value)


def command(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", "sweep", *map(str, arguments)])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


@pytest.mark.parametrize(
    ("sweep", "options", "words"),
    [
        (
            over(sphere__raduis=[0.01]),
            [],
            'study.toml: sweep.over."sphere.raduis": no such key is swept',
        ),
        (
            over(sphere__radius={"from": 1e-3, "to": 2e-3, "number": 100_001}),
            [],
            "there would be 100,001 drops, more than 100,000; confirm",
        ),
        (None, ["--memory", "10"], "--memory: 10 is too little; it must be 1 MB or more"),
        (None, ["--memory", "5 kB"], "--memory: 5 kB is too little; it must be 1 MB or more"),
        (None, ["--memory", "much"], '--memory: "much" is not a memory size'),
        (None, ["--scheduler", "tcp://127.0.0.1"], "--scheduler: tcp://127.0.0.1"),
        (None, ["--scheduler", "nonsense://"], "--scheduler: nonsense://"),
        (None, ["--processes", "0"], "--processes"),
    ],
)
def test_the_command_says_it_in_one_line_and_leaves_nothing(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    sweep: object,
    options: list[str],
    words: str,
) -> None:
    assert command(monkeypatch, study_file(tmp_path, sweep), "-o", tmp_path / "out", *options) == 2
    told = capfd.readouterr().err
    assert words in told.replace("│ ", "").replace("\n", " ")
    assert "Traceback" not in told
    assert not (tmp_path / "out").exists()


def test_the_command_runs_a_study_and_says_what_came_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["vibroimpact", "sweep", str(study_file(tmp_path))])
    with suppress(SystemExit):
        main()
    assert "12 drops" in capsys.readouterr().out
    assert (tmp_path / "study-sweep" / "report.html").is_file()
