"""What hit a plate, from its records: responses, pulses, fits, the command, and what is refused."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import tomli_w
from scipy.integrate import solve_ivp

import vibroimpact as vi
from identifying import (
    DELAY,
    RATE,
    SENSORS,
    THICKNESS,
    WINDOW,
    a_case,
    an_impact,
    drawn,
    plate,
    records_of,
)
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.contact import contact_forces
from vibroimpact.identification.force import whitening
from vibroimpact.identification.identify import identify_on
from vibroimpact.identification.plate import compliances_of, plate_of, shapes_of
from vibroimpact.signals.inverse.deconvolve import deconvolve
from vibroimpact.signals.inverse.hertz_pulse import hertz_impulses, sphere_of_pulse

SMALL: dict[str, Any] = {
    "name": "a small plate",
    "sphere": {"radius": 0.02, "material": "rock-paper"},
    "plate": {
        "size": [0.3, 0.3, 0.02],
        "material": "steel",
        "model": "elastic",
        "modes": 20,
        "supports": "clamped",
        "damping": 0.01,
    },
    "drop": {"speed": 2.0, "position": [0.02, 0.01]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1, "duration": 0.01},
    "sensors": [
        {"name": "a", "position": [0.1, 0.03], "rate": 20e3},
        {"name": "b", "position": [-0.05, 0.08], "rate": 20e3},
    ],
}


ON_AXIS = [{"name": "a", "position": [0.1, 0.0], "rate": 20e3}]


def small(**changed: Any) -> vi.Case:
    return vi.case_of({**SMALL, **changed})


def its_records(case: vi.Case) -> list[vi.signals.Record]:
    return [
        vi.signals.Record(name, one.value, one.sensor.rate, one.sensor.unit)
        for name, one in vi.simulate(case).signals().items()
    ]


@pytest.mark.parametrize(
    "sensor",
    [
        {},
        {"quantity": "velocity"},
        {"accelerometer": {"resonance": 12e3}},
        {"filter": "butterworth"},
        {"filter": "butterworth", "accelerometer": {"resonance": 12e3}},
        {"geophone": {"natural_frequency": 10.0, "sensitivity": 27.6}},
    ],
    ids=["converter", "velocity", "resonance", "butterworth", "both", "geophone"],
)
def test_responses_at_a_place_are_those_of_the_simulation(sensor: dict[str, Any]) -> None:
    case = small(sensors=[{**one, **sensor} for one in SMALL["sensors"]])
    signals = [one.value for one in vi.simulate(case).signals().values()]
    found = plate_of(case, WINDOW)
    there = found.at((0.02, 0.01))
    (force,) = contact_forces(case, there, np.array([0.02]), np.array([2.0]))
    names = ["a", "b"]
    answers = found.heard(names).at(shapes_of(there), compliances_of(there, names))
    samples = round(WINDOW * 20e3)
    values = sampled_responses(answers, 20e3, force.time, force.impulse, samples)
    for value, signal in zip(values, signals, strict=True):
        assert np.abs(value - signal[:samples]).max() < 1e-4 * np.abs(signal).max()


def test_a_hertzian_pulse_is_that_of_the_equation_of_motion() -> None:
    radius, speed, density, modulus = 0.02, 3.0, 2600.0, 20e9
    mass, stiffness = 4.0 / 3.0 * np.pi * radius**3 * density, 4.0 / 3.0 * modulus * np.sqrt(radius)

    def release(_: float, state: np.ndarray) -> float:
        return state[0] if state[1] < 0.0 else 1.0

    release.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(
        lambda _, state: [
            state[1],
            -stiffness * max(state[0], 0.0) ** 1.5 / mass,
            stiffness * max(state[0], 0.0) ** 1.5,
        ],
        (0.0, 1e-2),
        [0.0, speed, 0.0],
        events=release,
        rtol=1e-10,
        atol=1e-14,
        dense_output=True,
    )
    duration = run.t[-1]
    times, impulses = hertz_impulses(duration)
    for frequency in (0.0, 1e3, 5e3):  # the pulse as a linear system sees it
        nodes, weights = np.polynomial.legendre.leggauss(200)
        at = 0.5 * duration * (1.0 + nodes)
        force = 0.5 * duration * weights * stiffness * np.maximum(run.sol(at)[0], 0.0) ** 1.5
        exact = force @ np.exp(-2j * np.pi * frequency * at)
        assert (
            abs(force.sum() * impulses @ np.exp(-2j * np.pi * frequency * times) - exact)
            < 1e-5 * force.sum()
        )
    found = sphere_of_pulse(run.y[2, -1], duration, density, modulus, 1.0)
    assert found == pytest.approx((radius, speed), rel=2e-3)


def third_differences(nodes: int, roughness: np.ndarray) -> np.ndarray:
    found = np.zeros((nodes + 3, nodes))
    for node in range(nodes):
        found[node : node + 4, node] = 1.0, -3.0, 3.0, -1.0
    return found / roughness[:, None]


def test_a_deconvolved_force_is_the_least_squares_solution_with_its_prior() -> None:
    random = np.random.default_rng(3)
    matrix, record, roughness = (
        random.standard_normal((60, 12)),
        random.standard_normal(60),
        random.uniform(1.0, 20.0, 15),
    )
    found = deconvolve(matrix, record, roughness)
    bend = third_differences(12, roughness)
    # the strength that was found, from the covariance
    precision = np.linalg.inv(found.covariance) - matrix.T @ matrix
    strength = np.trace(precision) / np.trace(bend.T @ bend)
    assert precision == pytest.approx(strength * bend.T @ bend, abs=1e-6 * strength)
    stacked = np.concatenate([matrix, np.sqrt(strength) * bend])
    assert found.force == pytest.approx(
        np.linalg.lstsq(stacked, np.append(record, np.zeros(15)), rcond=None)[0]
    )


def test_the_marginal_likelihood_is_that_of_the_records() -> None:
    random = np.random.default_rng(4)
    matrix, record, rough = (
        random.standard_normal((30, 6)),
        3.0 * random.standard_normal(30),
        np.linspace(1.0, 8.0, 9),
    )
    bend, chosen = third_differences(6, np.ones(9)), deconvolve(matrix, record)
    precision = np.linalg.inv(chosen.covariance) - matrix.T @ matrix
    strength = np.trace(precision) / np.trace(bend.T @ bend)

    def evidence(at: float, bend: np.ndarray = bend) -> float:
        covariance = np.eye(30) + matrix @ np.linalg.inv(at * bend.T @ bend) @ matrix.T
        return float(
            -0.5 * (record @ np.linalg.solve(covariance, record) + np.linalg.slogdet(covariance)[1])
        )

    assert evidence(strength) >= max(evidence(1.5 * strength), evidence(strength / 1.5))
    other, bent = deconvolve(matrix, record, rough), third_differences(6, rough)
    its_strength = np.trace(np.linalg.inv(other.covariance) - matrix.T @ matrix) / np.trace(
        bent.T @ bent
    )
    assert other.evidence - chosen.evidence == pytest.approx(
        evidence(its_strength, bent) - evidence(strength), rel=1e-9
    )


def test_errors_of_the_model_are_made_white_with_the_noise() -> None:
    random = np.random.default_rng(5)
    errors = random.standard_normal((40, 7)) * random.uniform(0.1, 9.0, 7)
    white = whitening(errors)(np.eye(40))
    assert white @ (np.eye(40) + errors @ errors.T) @ white.T == pytest.approx(
        np.eye(40), abs=1e-12
    )


@pytest.mark.slow
def test_force_place_size_and_speed_at_40_decibels() -> None:
    """Simulated with twice the modes of the model: largest force 5 %, impulse 2 %, place
    half a thickness.
    """
    within = []
    for number, (radius, speed, place) in enumerate(drawn(3, seed=11)):
        impact = an_impact(radius, speed, place)
        found = identify_on(plate(), records_of(impact, 40.0, seed=number))
        told = found.estimates
        assert told["recovered_max_force_N"].value == pytest.approx(impact.peak, rel=0.05)
        assert told["recovered_impulse_N_s"].value == pytest.approx(impact.impulse, rel=0.02)
        assert (
            np.hypot(told["place_x_m"].value - place[0], told["place_y_m"].value - place[1])
            < 0.5 * THICKNESS
        )
        assert told["first_touch_s"].value == pytest.approx(DELAY, abs=0.01 / RATE)
        truth = {
            "place_x_m": place[0],
            "place_y_m": place[1],
            "radius_m": radius,
            "speed_m_s": speed,
            "impulse_N_s": impact.impulse,
        }
        within += [
            told[name].interval[0] <= value <= told[name].interval[1]
            for name, value in truth.items()
        ]
        assert not found.doubts
    assert np.mean(within) > 0.8


@pytest.mark.slow
def test_a_force_of_no_contact_law_is_found_from_one_sensor_at_a_known_place() -> None:
    """Two taps that overlap, as no sphere makes them."""
    model, place, touch = plate(280), (0.05, 0.03), 2e-3
    time = np.linspace(0.0, 400e-6, 801)
    taps = ((900.0, 0.0), (600.0, 150e-6))
    force = np.sum(
        [
            peak * np.sin(np.pi * np.clip((time - begin) / 250e-6, 0.0, 1.0)) ** 2
            for peak, begin in taps
        ],
        axis=0,
    )
    there = model.at(place)
    answers = model.heard(["b"]).at(shapes_of(there), compliances_of(there, ["b"]))
    (value,) = sampled_responses(answers, RATE, touch + time, force * (time[1] - time[0]), 300)
    noise = 0.01 * value[52:].std() * np.random.default_rng(5).standard_normal(300)
    found = vi.identification.identify_force(
        a_case(), [vi.signals.Record("b", value + noise, RATE, "m/s2")], place
    )
    assert found.peak[0] == pytest.approx(force.max(), rel=0.05)
    assert found.impulse[0] == pytest.approx(np.trapezoid(force, time), rel=0.02)


@pytest.mark.slow
def test_a_plate_of_another_thickness_is_doubted_without_noise_too() -> None:
    thicker = small(plate={**SMALL["plate"], "size": [0.3, 0.3, 0.025]})
    doubts = vi.identification.identify(small(), its_records(thicker)).doubts
    assert any(
        "% of the rms value of a record, and the records do not show the noise before first touch"
        in doubt
        for doubt in doubts
    )


@pytest.mark.slow
def test_a_sphere_that_hardly_leaves_the_plate_is_found_from_a_start_that_touches_again() -> None:
    case = vi.case_of(
        {
            "sphere": {"radius": 0.03, "material": "granite"},
            "plate": {
                "size": [0.6, 0.4, 0.012],
                "material": "aluminium",
                "model": "elastic",
                "supports": {"type": "patches", "spacing": [0.5, 0.3], "radius": 0.02},
                "damping": 0.01,
            },
            "drop": {"height": 1.0, "position": [0.05, 0.03]},
            "contact": {"law": "tsuji", "restitution": 0.7},
            "run": {"impacts": 1},
            "sensors": [
                {
                    "name": "g",
                    "position": [0.12, 0.08],
                    "rate": 20e3,
                    "geophone": {"natural_frequency": 10.0, "sensitivity": 27.6},
                },
                {"name": "a", "position": [-0.15, 0.06], "rate": 20e3},
            ],
        }
    )
    found = vi.identification.identify(case, its_records(case)).estimates
    expected = {"radius_m": 0.03, "speed_m_s": 4.36175, "place_x_m": 0.05, "place_y_m": 0.03}
    assert {name: found[name].value for name in expected} == pytest.approx(expected, rel=1e-3)


def brought_plate(folder: Path, corner: tuple[float, float]) -> Path:
    """Write the mesh of a plate of 0.3 x 0.24 x 0.02 m, by its corner of least x and y."""
    at_x, at_y, at_z = (
        np.linspace(0.0, 0.3, 11) + corner[0],
        np.linspace(0.0, 0.24, 9) + corner[1],
        np.array([-0.02, 0.0]),
    )
    points = np.array([[x, y, z] for z in at_z for y in at_y for x in at_x])
    low = np.array([99 * k + 11 * j + i for k in (0,) for j in range(8) for i in range(10)])
    bricks = low[:, None] + np.array([0, 1, 12, 11, 99, 100, 111, 110])
    file = folder / "plate.msh"
    meshio.Mesh(points, [("hexahedron", bricks)]).write(file, file_format="gmsh22", binary=False)
    return file


@pytest.mark.slow
def test_the_origin_of_a_mesh_may_be_a_corner_of_the_plate(tmp_path: Path) -> None:
    mesh = {"file": str(brought_plate(tmp_path, (0.0, 0.0))), "unit": "m"}
    places = {"a": [0.25, 0.15], "b": [0.1, 0.2], "c": [0.08, 0.06]}
    case = small(
        plate={
            "material": "steel",
            "model": "elastic",
            "modes": 20,
            "damping": 0.01,
            "supports": "free",
            "mesh": mesh,
        },
        drop={"speed": 2.0, "gravity": 0.0, "position": [0.17, 0.13]},
        sensors=[{"name": name, "position": place, "rate": 20e3} for name, place in places.items()],
    )
    found = vi.identification.identify(case, its_records(case)).estimates
    assert (found["place_x_m"].value, found["place_y_m"].value) == pytest.approx(
        (0.17, 0.13), abs=1e-4
    )
    with pytest.raises(
        vi.InputError, match=r"x must be from 0\.03 to 0\.27 m, and y from 0\.03 to 0\.21 m"
    ):
        vi.identification.identify(case, its_records(case), place=(-0.1, 0.1))


@pytest.mark.slow
def test_the_frequency_that_is_asked_for_ends_the_doubt() -> None:
    def doubts(**modes: Any) -> list[str]:
        case = small(
            plate={
                **{key: value for key, value in SMALL["plate"].items() if key != "modes"},
                **modes,
            }
        )
        return [
            one
            for one in vi.identification.identify(case, its_records(case)).doubts
            if "the modes of the plate end at" in one
        ]

    (doubt,) = doubts(modes=12)
    asked = re.search(r'ask for plate\.max_frequency = "(\d+ kHz)" in place of plate\.modes', doubt)
    assert asked is not None
    assert not doubts(max_frequency=asked[1])


@pytest.mark.slow
def test_too_few_modes_are_told() -> None:
    radius, speed, place = 0.02, 3.0, (0.06, 0.04)
    found = vi.identification.identify(
        a_case(60), records_of(an_impact(radius, speed, place), 40.0, seed=1)
    )
    assert any("the modes of the plate end at" in doubt for doubt in found.doubts)
    assert any("times the noise before first touch" in doubt for doubt in found.doubts)
    told = found.estimates
    assert (
        np.hypot(told["place_x_m"].value - place[0], told["place_y_m"].value - place[1])
        < 0.5 * THICKNESS
    )


@pytest.mark.slow
def test_places_that_sensors_do_not_tell_apart_are_named() -> None:
    case = small(
        sensors=[
            {"name": "a", "position": [0.1, 0.0], "rate": 20e3},
            {"name": "b", "position": [-0.06, 0.0], "rate": 20e3},
        ]
    )
    found = vi.identification.identify(case, its_records(case))
    (doubt,) = (one for one in found.doubts if "explains the records about as well" in one)
    x, y = map(float, re.findall(r"-?\d+\.\d", doubt))
    # of a pulse, before the contact is fitted
    assert (x, abs(y)) == pytest.approx((20.0, 10.0), abs=1.0)
    assert y * found.estimates["place_y_m"].value < 0.0


@pytest.mark.slow
def test_a_place_that_is_known_is_kept() -> None:
    case = small()
    found = vi.identification.identify(case, its_records(case), place=(0.02, 0.01))
    assert found.estimates["place_x_m"].value == 0.02
    assert found.estimates["place_x_m"].deviation == 0.0
    assert found.estimates["radius_m"].value == pytest.approx(0.02, rel=1e-3)
    assert found.search.misfit.size == 1


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda one: replace(one, name="aa"),
            'has no sensor "aa"; it has "a", "b". Did you mean "a"',
        ),
        (lambda one: replace(one, unit="V"), "is in V, and the sensor of that name reads m/s2"),
        (lambda one: replace(one, rate=10e3), "write rate = 10000 in the case"),
        (lambda one: replace(one, value=one.value[:40]), "64 are needed"),
        (lambda one: replace(one, value=0.0 * one.value), "is constant; it shows no impact"),
        (
            lambda one: replace(one, unit=""),
            "is without a unit, and the sensor of that name reads m/s2",
        ),
        (
            lambda one: replace(
                one, value=np.where(np.arange(len(one.value)) == 9, np.nan, one.value)
            ),
            "not finite",
        ),
        (lambda one: replace(one, start=1.3 / 20e3), "not sampled at the same instants"),
        (lambda one: replace(one, name="b"), "there are two records"),
    ],
)
def test_records_that_are_refused(change: Any, words: str) -> None:
    first, *others = its_records(small())
    with pytest.raises(vi.InputError, match=words.replace(".", r"\.")):
        vi.identification.identify(small(), [change(first), *others])


def test_a_column_of_a_table_is_named_after_its_sensor() -> None:
    (record, *_) = its_records(small())
    with pytest.raises(
        vi.InputError, match=r'named after its sensor and has its unit, such as "a \[m/s2\]"'
    ):
        vi.identification.identify(
            small(), [replace(record, name="acceleration", source="one/a.csv")]
        )


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"plate": {"material": "steel", "size": [0.3, 0.3, 0.02]}}, "rigid"),
        ({"sensors": []}, "no sensors"),
        (
            {
                "plate": {**SMALL["plate"], "size": [0.3, 0.06, 0.02]},
                "sensors": ON_AXIS,
                "drop": {"speed": 2.0},
            },
            "at most 3 thicknesses long",
        ),
        (
            {"sphere": {"radius": 0.02, "material": "rock-paper", "model": "elastic", "modes": 3}},
            "change with its size",
        ),
        ({"drop": {"speed": 2.0, "angle": 0.2}}, "along the normal alone|is identified"),
        (
            {"sensors": [{**SMALL["sensors"][0], "filter": "none"}, SMALL["sensors"][1]]},
            "anti-alias",
        ),
        ({"contact": {"law": "hertz", "finite_sphere": True}}, "size of the sphere"),
        (
            {
                "sensors": [
                    {**SMALL["sensors"][0], "microphone": {"distance": 0.2}},
                    SMALL["sensors"][1],
                ]
            },
            "the sound of the whole plate|is in m/s2",
        ),
    ],
)
def test_cases_that_are_refused(changed: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.identification.identify(small(**changed), its_records(small()))


@pytest.mark.slow
def test_sampling_that_is_too_slow_is_told_with_the_number() -> None:
    sensors = [
        {"name": name, "position": list(place), "rate": 2000.0}
        for name, place in list(SENSORS.items())[:2]
    ]
    drop = {"speed": 3.0, "position": [0.06, 0.04]}
    case = a_case(20, sensors=sensors, run={"impacts": 1, "duration": 0.06}, drop=drop)
    with pytest.raises(
        vi.InputError,
        match="hear up to 900 Hz, enough for contacts of 556 us or longer; sample faster than at "
        "2000 Hz",
    ):
        vi.identification.identify(case, its_records(case), window=0.05)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"place": (0.5, 0.0)},
            "is off the plate, or too near its edge; x must be from -0.12 to 0.12 m, and y "
            "from -0.12 to 0.12 m",
        ),
        ({"window": 0.0}, "window of 0 s"),
        ({"frequency_error": 1.0}, "0.01 is 1 %"),
    ],
)
def test_options_that_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.identification.identify(small(), its_records(small()), **options)


def test_the_command(command: Callable[..., tuple[int, str, str]]) -> None:
    Path("case.toml").write_text(tomli_w.dumps(SMALL))
    assert command("run", "case.toml", "-o", "run")[0] == 0
    code, out, _ = command("identify", "case.toml", "run", "-o", "found")
    assert code == 0
    assert "radius" in out
    assert "95 % from" in out
    assert {one.name for one in Path("found").iterdir()} == {
        "case.toml",
        "force.csv",
        "report.html",
        "summary.json",
    }
    rows = list(csv.DictReader(Path("found/force.csv").read_text().splitlines()))
    force = np.array(
        [[float(row[name]) for name in ("force_low_N", "force_N", "force_high_N")] for row in rows]
    )
    assert (np.diff(force, axis=1) >= 0.0).all()
    code, out, _ = command(
        "identify", "case.toml", "run", "-o", "known", "--place", "20 mm, 10 mm", "--json"
    )
    assert code == 0
    told = json.loads(out)
    assert told["estimates"]["radius_m"]["value"] == pytest.approx(0.02, rel=1e-3)
    assert {key: value for key, value in told.items() if key != "folder"} == json.loads(
        Path("known/summary.json").read_text()
    )
    Path("bare.csv").write_text("0,1\n1,2\n")
    for words, message in (
        (("run", "-o", "found"), "there already"),
        (("run", "-o", "new", "--place", "20 mm"), "give x and y"),
        (
            ("bare.csv", "-o", "new", "--columns", "time=s,a1=m/s^2,a2=m/s^2"),
            "--columns: line 1 has 2 fields, separated by commas, and 3 columns",
        ),
        (("nowhere", "-o", "new"), "nowhere"),
    ):
        code, _, err = command("identify", "case.toml", *words)
        assert code == 2
        assert message in err
    assert not Path("new").exists()
