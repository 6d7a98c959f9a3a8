"""Plates that are shaken: statements, cases, tabulated motions, rides, batches, histories
and elastic plates.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import signal

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.charts.marks import Line
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.dynamics.motion.columns import ALL_HISTORY_COLUMNS
from vibroimpact.dynamics.statement.tabulated_motion import tabulated_motion
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.history_charts import _touch_and_release, tops_of_rebounds
from vibroimpact.runs.scene import rigid_scene
from vibroimpact.structures.modal_model import ModalBasis

SOFT = KuwabaraKono(stiffness=1e8, dissipation_time=1e-5)
CASE: dict[str, Any] = {
    "sphere": {"radius": "20 mm", "material": "granite"},
    "plate": {
        "size": ["0.4 m", "0.3 m", "10 mm"],
        "material": "steel",
        "motion": {"amplitude": "2 mm", "frequency": "25 Hz"},
    },
    "drop": {"height": "60 mm"},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.8},
    "run": {"impacts": 4},
}
IN_LEDGER = {name for name, column in ALL_HISTORY_COLUMNS.items() if column.in_ledger}
SPRINGS = [
    {"type": "spring", "position": [x, y], "stiffness": "2 kN/m"}
    for x in (-0.15, 0.15)
    for y in (-0.1, 0.1)
]


def problem(law: vi.laws.ContactLaw = SOFT, **changes: Any) -> vi.Problem:
    start = {} if "speed" in changes else {"height": 0.05}
    values: dict[str, Any] = {
        "motion": vi.PlateMotion(amplitude=2e-3, frequency=25.0),
        "gravity": 9.8,
        "impacts": 6,
        **start,
        **changes,
    }
    values = {"laws": (law,), "plate": vi.rigid_plate(), **values}
    return vi.Problem(sphere=vi.Body(mass=0.1, contact_offset=0.01), **values)


def case(**values: Any) -> vi.Problem:
    return vi.case_of(with_values(CASE, values)).to_problem()


# statements
# ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"amplitude": -1.0}, "must not be negative"),
        ({"frequency": 0.0}, "greater than 0 Hz"),
        ({"phase": math.nan}, "finite number"),
        ({"amplitude": "2 mm"}, "finite number"),
        ({"amplitude": [1e-3, 1e-4], "frequency": [1.0, 2.0, 3.0]}, "agree in number"),
        ({"direction": (0.0, 0.0, 2.0)}, "vector of length 1"),
        ({"direction": (0.0, 1.0)}, "vector of length 1"),
    ],
)
def test_refused_motions(values: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.PlateMotion(**{"amplitude": 1e-3, "frequency": 25.0, **values})


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"motion": 25.0}, "must be a PlateMotion"),
        (
            {
                "oblique": vi.Oblique(
                    friction=vi.friction.find_friction_law("coulomb")(coefficient=0.3)
                )
            },
            "no tangential compliance",
        ),
        (
            {"height": 0.0115, "motion": vi.PlateMotion(amplitude=2e-3, frequency=25.0, phase=1.5)},
            "begins its motion at or above",
        ),
        (
            {"speed": 0.1, "motion": vi.PlateMotion(amplitude=2e-3, frequency=25.0, phase=np.pi)},
            "recedes",
        ),
        (
            {"motion": vi.PlateMotion(amplitude=[1e-3, 1e-3], frequency=[20.0, 31.0])},
            "give the duration",
        ),
    ],
)
def test_refused_problems(values: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        problem(**values)


def test_a_mode_that_would_grow_without_bound_is_refused() -> None:
    modes = ModalBasis(
        frequencies=np.array([25.0]),
        damping_ratios=np.zeros(1),
        contact=np.array([0.5]),
        participation=np.array([[0.0, 0.0, 1.0]]),
    )
    with pytest.raises(vi.InputError, match="without damping is driven at its own frequency"):
        problem(plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=modes))


def test_only_the_part_along_the_normal_matters_without_friction() -> None:
    tilted = vi.PlateMotion(amplitude=2e-3, frequency=25.0, direction=(0.6, 0.0, 0.8))
    straight = vi.PlateMotion(amplitude=1.6e-3, frequency=25.0)
    one, other = (vi.simulate(problem(motion=motion)).impacts for motion in (tilted, straight))
    assert one["time_s"] == pytest.approx(other["time_s"], rel=1e-9)
    sideways = vi.simulate(
        problem(motion=vi.PlateMotion(amplitude=2e-3, frequency=25.0, direction=(1.0, 0.0, 0.0)))
    ).impacts
    assert np.array_equal(sideways["time_s"], vi.simulate(problem(motion=None)).impacts["time_s"])


# runs
# ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [SOFT, Newton(restitution=0.7)], ids=["soft", "hard"])
def test_a_batch_is_its_drops(law: vi.laws.ContactLaw) -> None:
    heights = np.array([0.03, 0.05, 0.07])
    batch, alone = (
        vi.simulate(problem(law, height=heights)),
        [vi.simulate(problem(law, height=height)) for height in heights],
    )
    table = vi.tabulate(problem(law, height=heights))
    for number, one in enumerate(alone):
        drop = batch.drop(number)
        assert drop.impacts["time_s"] == pytest.approx(one.impacts["time_s"], rel=1e-9)
        assert drop.at([0.2])["drive_J"] == pytest.approx(one.at([0.2])["drive_J"], rel=1e-7)
        assert table.impacts["plate_work_J"][number] == pytest.approx(
            one.impacts["plate_work_J"], rel=1e-6
        )


@pytest.mark.parametrize(
    "law", [SOFT, Newton(restitution=0.4), Newton(restitution=0.0)], ids=["soft", "hard", "plastic"]
)
@pytest.mark.parametrize("strength", [0.7, 1.4, 4.0])
def test_the_ledger_closes_at_every_moment(law: vi.laws.ContactLaw, strength: float) -> None:
    motion = vi.PlateMotion(amplitude=strength * 9.8 / (50.0 * np.pi) ** 2, frequency=25.0)
    response = vi.simulate(problem(law, motion=motion, impacts=None, duration=0.6))
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER)
    assert total == pytest.approx(total[0], abs=2e-7 * response.energy["input_J"])
    assert response.energy["closure_relative"] <= 1e-9
    work = response.impacts["plate_work_J"].sum()
    if not response.outcomes[0].at_rest:
        assert work == pytest.approx(-response.energy["drive_J"], rel=1e-9)


def test_a_soft_sphere_comes_to_rest_on_a_plate_that_moves() -> None:
    motion = vi.PlateMotion(amplitude=2e-4, frequency=25.0)
    law = vi.laws.find_contact_law("lankarani-nikravesh")(stiffness=1e7, restitution=0.5)
    response = vi.simulate(problem(law, motion=motion, impacts=None, duration=1.5))
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    later = response.at(np.linspace(1.4, 1.5, 11))
    sag = (0.1 * 9.8 / 1e7) ** (2.0 / 3.0)
    # to the tolerance of the run
    assert later["position_m"] - 0.01 == pytest.approx(later["surface_m"] - sag, abs=1e-9 * sag)
    assert later["velocity_m_s"] == pytest.approx(later["surface_velocity_m_s"], abs=1e-12)
    assert later["force_N"] == pytest.approx(
        0.1 * (9.8 - (50.0 * np.pi) ** 2 * later["surface_m"]), rel=1e-9
    )
    assert response.status.endswith(
        "on the sphere moves with the plate, which does not fall away from "
        "under it before the run ends."
    )


def test_a_run_that_ends_in_a_ride_ends_on_time() -> None:
    strong = vi.PlateMotion(amplitude=5e-4, frequency=25.0)
    response = vi.simulate(
        problem(Newton(restitution=0.0), impacts=None, duration=0.121, motion=strong)
    )
    assert response.end_time[0] == 0.121
    last = response.at(0.121)
    assert last["position_m"] - 0.01 == pytest.approx(last["surface_m"], abs=1e-15)
    assert last["indentation_m"] == 0.0
    touch = float(response.impacts["time_s"][-1])
    assert response.impacts["rebound_height_m"][-1] == pytest.approx(
        0.01 + response.problem.surface(touch)[0], abs=1e-12
    )


def test_a_hard_ball_rides_on_a_tabulated_motion(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 2001)
    table = written(tmp_path, time, 2e-4 * np.sin(50.0 * np.pi * time))
    hard = {"contact": {"law": "newton", "restitution": 0.3}, "run": {}}
    response = vi.simulate(vi.case_of(with_values(table, hard)))
    assert response.outcomes == (vi.Outcome.REST_SPEED,)
    assert response.end_time[0] == pytest.approx(2.0)
    assert response.energy["closure_relative"] <= 1e-9
    assert not np.any(response.at(np.linspace(1.5, 2.0, 50))["indentation_m"])


def test_without_gravity_a_sphere_leaves_a_plate_that_moves() -> None:
    response = vi.simulate(problem(Newton(restitution=0.5), speed=1.0, gravity=0.0))
    assert response.outcomes == (vi.Outcome.LEFT,)
    assert response.impacts["separation_speed_m_s"] == pytest.approx(
        [0.5 * (1.0 + 2e-3 * 50.0 * np.pi)], rel=1e-12
    )


@pytest.mark.parametrize("kind", ["hard", "elastic", "oblique", "carried"])
def test_the_ledger_closes_in_air(kind: str) -> None:
    values: dict[str, Any] = {
        "sphere.material": {"density": 84, "youngs_modulus": 2e9, "poissons_ratio": 0.3},
        "drop.air": True,
        "run.impacts": 6,
    }
    values |= {
        "hard": {"contact": {"law": "newton", "restitution": 0.3}},
        "elastic": {
            "plate.model": "elastic",
            "plate.supports": "clamped",
            "plate.modes": 12,
            "plate.damping": 0.01,
            "run.impacts": 3,
        },
        "oblique": {
            "drop.spin": [0, 100, 0],
            "plate.inclination": "5 deg",
            "contact.friction": {"law": "mdr", "coefficient": 0.3},
        },
        "carried": {
            "plate.motion.amplitude": "0.2 mm",
            "contact.restitution": 0.4,
            "run.impacts": "all",
            "run.duration": "1 s",
        },
    }[kind]
    response = vi.simulate(case(**values))
    assert response.energy["closure_relative"] <= 1e-9
    assert response.energy["air_J"] > 1e-3 * response.energy["input_J"]
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER or name == "air_J")
    assert total == pytest.approx(total[0], abs=2e-7 * response.energy["input_J"])
    if kind == "carried":
        assert response.outcomes == (vi.Outcome.CAPTURED,)
        height = float(response.at(float(response.rest.time[0]))["position_m"])
        assert response.impacts["rebound_height_m"][-1] == pytest.approx(height, abs=1e-7)


# tabulated motions
# -----------------------------------------------------------------------------------


def deck(time: np.ndarray) -> np.ndarray:
    return 2e-3 * np.sin(2.0 * np.pi * 16.0 * time) + 1e-3 * np.sin(2.0 * np.pi * 5.3 * time + 1.0)


def written(
    folder: Path,
    time: np.ndarray,
    values: np.ndarray,
    header: str = "time [s],displacement [mm]",
    scale: float = 1e3,
) -> dict[str, Any]:
    path = folder / "deck.csv"
    path.write_text(
        header
        + "\n"
        + "".join(
            f"{at:.9g},{value * scale:.12g}\n" for at, value in zip(time, values, strict=True)
        )
    )
    return with_values(CASE, {"plate.motion": {"file": str(path)}, "run": {}})


def test_a_tabulated_motion_passes_through_its_samples_and_between_them() -> None:
    time, dense = np.linspace(0.0, 2.0, 1001), np.linspace(0.0, 2.0, 4003)
    motion = tabulated_motion(0.002, deck(time))
    mean = float((motion.at(time)[0] - deck(time)).mean())
    assert motion.at(time)[0] - mean == pytest.approx(deck(time), abs=1e-10)
    assert motion.at(dense)[0] - mean == pytest.approx(deck(dense), abs=1e-9)
    fast, slow = 32.0 * np.pi, 10.6 * np.pi
    accelerations = -2e-3 * fast**2 * np.sin(fast * dense) - 1e-3 * slow**2 * np.sin(
        slow * dense + 1.0
    )
    assert motion.at(dense)[2] == pytest.approx(accelerations, abs=1e-3)
    assert abs(np.trapezoid(motion.at(dense)[0], dense)) < 1e-8


@pytest.mark.parametrize("law", ["newton", "lankarani-nikravesh"])
def test_a_table_of_a_harmonic_motion_shakes_as_it_does(tmp_path: Path, law: str) -> None:
    """Two seconds of 25 Hz are 50 periods: the mean is that of the harmonic motion."""
    time = np.linspace(0.0, 2.0, 2001)
    table = written(tmp_path, time, 2e-3 * np.sin(50.0 * np.pi * time))
    found = vi.simulate(
        vi.case_of(
            with_values(table, {"contact": {"law": law, "restitution": 0.8}, "run.impacts": 4})
        )
    )
    expected = vi.simulate(
        vi.case_of(with_values(CASE, {"contact": {"law": law, "restitution": 0.8}}))
    )
    assert found.impacts["time_s"] == pytest.approx(expected.impacts["time_s"], rel=2e-6)
    assert found.energy["closure_relative"] <= 1e-9


def test_accelerations_are_integrated(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 2001)
    table = written(
        tmp_path,
        time,
        -((50.0 * np.pi) ** 2) * 2e-3 * np.cos(50.0 * np.pi * time),
        "time_s,acceleration_m_s2",
        1.0,
    )
    motion = vi.case_of(table).to_problem().motion
    assert motion is not None
    assert motion.at(time)[0] == pytest.approx(2e-3 * np.cos(50.0 * np.pi * time), abs=1e-5)


def test_a_run_ends_with_its_table(tmp_path: Path) -> None:
    time = np.linspace(0.0, 0.5, 501)
    table = written(tmp_path, time, deck(time))
    assert vi.case_of(table).to_problem().duration == pytest.approx(0.5)
    assert vi.simulate(vi.case_of(table)).end_time[0] >= 0.5
    with pytest.raises(
        vi.InputError, match=r"run\.duration: the motion of the plate ends at 0\.5 s"
    ):
        vi.case_of(with_values(table, {"run.duration": 0.6}))


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (
            lambda t, s: (np.delete(t, 40), np.delete(s, 40)),
            r"line 42: the time 0\.041 s comes 0\.002 s after the one before.*no gaps",
        ),
        (lambda t, s: (np.where(t == t[50], t[49], t), s), r"line 52: .* times must rise"),
        (lambda t, s: (t[::-1], s), "times must rise"),
        (
            lambda t, s: (t, s + 5e-3 * (t > 0.1)),
            r"line 10\d: the displacement .* it jumps, or the samples are too coarse",
        ),
        (lambda t, s: (t[::30], s[::30] + 0.0), "samples are no motion"),
        (lambda t, s: (np.arange(200) / 50.0, deck(np.arange(200) / 50.0)), "too coarse"),
        (
            lambda t, s: (t, np.where(t == t[7], np.nan, s)),
            r'line 9, column "displacement \[mm\]": "nan" is not finite',
        ),
    ],
    ids=["gap", "twice", "backwards", "jump", "few", "coarse", "nan"],
)
def test_bad_tables(tmp_path: Path, spoil: Any, words: str) -> None:
    time = np.linspace(0.0, 0.5, 501)
    with pytest.raises(vi.InputError, match=words):
        vi.case_of(written(tmp_path, *spoil(time, deck(time))))


def period(count: int, length: float = 0.2) -> tuple[np.ndarray, np.ndarray]:
    """Samples of one period of 0.2 s: 5 and 25 Hz."""
    time = np.arange(count) * length / count
    return time, 1e-3 * np.sin(10.0 * np.pi * time + 1.0) + 4e-4 * np.cos(50.0 * np.pi * time)


@pytest.mark.parametrize("count", [200, 201])
@pytest.mark.parametrize("quantity", ["displacement", "acceleration"])
def test_a_period_repeats(tmp_path: Path, count: int, quantity: str) -> None:
    time, moved = period(count)
    slow, fast = 10.0 * np.pi, 50.0 * np.pi
    if quantity == "acceleration":
        # with a zero of its own
        felt = (
            -1e-3 * slow**2 * np.sin(slow * time + 1.0) - 4e-4 * fast**2 * np.cos(fast * time) + 9.8
        )
        table = written(tmp_path, time, felt, "time [s],acceleration [m/s^2]", 1.0)
    else:
        table = written(tmp_path, time, moved)
    found = vi.case_of(
        with_values(table, {"plate.motion.repeat": True, "run.duration": "3 s"})
    ).to_problem()
    assert found.motion is not None
    assert found.motion.frequency == pytest.approx([5.0, 25.0])
    later = 2.31 + np.linspace(0.0, 0.2, 77)
    expected = 1e-3 * np.sin(slow * later + 1.0) + 4e-4 * np.cos(fast * later)
    assert found.motion.at(later)[0] == pytest.approx(expected, abs=1e-9)
    named = found.source
    assert named is not None
    assert (
        vi.case_of(named).to_problem().motion.at(later).tolist() == found.motion.at(later).tolist()
    )  # type: ignore[union-attr]


def test_a_period_of_a_harmonic_motion_shakes_as_it_does(tmp_path: Path) -> None:
    time = np.arange(64) / 25.0 / 64.0
    table = written(tmp_path, time, 2e-3 * np.sin(50.0 * np.pi * time))
    found = vi.simulate(
        vi.case_of(with_values(table, {"plate.motion.repeat": True, "run.impacts": 4}))
    )
    expected = vi.simulate(vi.case_of(CASE))
    assert found.impacts["time_s"] == pytest.approx(expected.impacts["time_s"], rel=1e-9)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (
            lambda t, s: (np.append(t, 0.2), np.append(s, s[0])),
            r"line \d+: the displacement .* where the period repeats, and at most \S+ m within it",
        ),
        (lambda t, s: (t[:-1], s[:-1]), "one whole period"),
        (lambda t, s: (t, s + 1e-5 * t / t[-1]), "where the period repeats"),
        (lambda t, s: (t, s + 0.02 * (t - 0.1) ** 2), "where the period repeats"),
    ],
    ids=["first sample again", "one missing", "drift", "kink"],
)
def test_a_period_that_does_not_close(tmp_path: Path, spoil: Any, words: str) -> None:
    table = written(tmp_path, *spoil(*period(200)))
    with pytest.raises(vi.InputError, match=words):
        vi.case_of(with_values(table, {"plate.motion.repeat": True, "run.duration": "1 s"}))


def test_a_measured_period_closes_within_its_noise(tmp_path: Path) -> None:
    time, moved = period(200)
    noisy = moved + 1e-6 * np.random.default_rng(1).standard_normal(200)
    table = with_values(
        written(tmp_path, time, noisy), {"plate.motion.repeat": True, "run.duration": "1 s"}
    )
    motion = vi.case_of(table).to_problem().motion
    assert motion is not None
    assert motion.at(time + 0.6)[0] + noisy.mean() == pytest.approx(noisy, abs=1e-9)


def test_a_repeated_motion_needs_a_duration(tmp_path: Path) -> None:
    with pytest.raises(vi.InputError, match="give the duration of the run"):
        vi.case_of(with_values(written(tmp_path, *period(200)), {"plate.motion.repeat": True}))


def test_tables_without_their_columns(tmp_path: Path) -> None:
    time = np.linspace(0.0, 0.5, 501)
    with pytest.raises(vi.InputError, match="there is no column displacement"):
        vi.case_of(written(tmp_path, time, deck(time), "time [s],height [mm]"))
    with pytest.raises(vi.InputError, match="there is no column time"):
        vi.case_of(written(tmp_path, time, deck(time), "when [s],displacement [mm]"))
    with pytest.raises(vi.InputError, match="unit is missing"):
        vi.case_of(written(tmp_path, time, deck(time), "time [s],displacement"))
    with pytest.raises(vi.InputError, match=r"plate\.motion\.file"):
        vi.case_of(with_values(CASE, {"plate.motion": {"file": str(tmp_path / "none.csv")}}))


# cases
# -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"plate.motion": {"amplitude": "2 mm"}}, r"plate\.motion: this key needs frequency"),
        (
            {"plate.motion": {"amplitude": "2 mm", "frequency": "25 Hz", "file": "deck.csv"}},
            "either a file or a harmonic motion; leave out amplitude and frequency",
        ),
        (
            {"plate.motion.repeat": True},
            r"plate\.motion\.repeat: only the motion of a file is repeated",
        ),
        ({"plate.motion.frequenzy": "25 Hz"}, 'Did you mean "frequency"'),
        ({"plate.motion.direction": [0, 0, 0]}, "length 0"),
        ({"plate.motion.amplitude": "2 Hz"}, r"plate\.motion\.amplitude"),
        ({"contact.friction": {"law": "rigid", "coefficient": 0.3}}, "no tangential compliance"),
        ({"drop.height": "21 mm", "plate.motion.phase": "90 deg"}, "begins its motion at or above"),
        ({"plate.motion": 3}, "not a table"),
    ],
)
def test_refused_cases(values: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        case(**values)


def test_a_case_says_its_motion_again() -> None:
    read = vi.case_of(
        with_values(
            CASE,
            {
                "plate.motion": {
                    "amplitude": "2 mm",
                    "frequency": "25 Hz",
                    "phase": "90 deg",
                    "direction": [0, 3, 4],
                }
            },
        )
    )
    motion = read.to_problem().motion
    assert motion is not None
    assert motion.direction == pytest.approx((0.0, 0.6, 0.8))
    assert motion.phase == pytest.approx([0.5 * np.pi])
    again = vi.case_of(read.to_problem().source).to_problem()
    assert (
        vi.simulate(again).impacts["time_s"].tolist()
        == vi.simulate(read).impacts["time_s"].tolist()
    )


def test_a_result_is_written_read_and_drawn(tmp_path: Path) -> None:
    response = vi.simulate(vi.case_of(CASE))
    response.save(tmp_path / "run")
    result = vi.load_result(tmp_path / "run")
    assert result.impacts["plate_velocity_m_s"] == pytest.approx(
        response.impacts["plate_velocity_m_s"]
    )
    assert result.energy["drive_J"] == pytest.approx(response.energy["drive_J"])
    assert "surface_m" in result.history


def test_studies_over_amplitude_and_frequency(tmp_path: Path) -> None:
    sweep = {
        "over": {
            "plate.motion.amplitude": [0.0, "1 mm", "2 mm"],
            "plate.motion.frequency": ["20 Hz", "25 Hz"],
        }
    }
    vi.studies.run_sweep(vi.studies.sweep_of({**CASE, "sweep": sweep}), tmp_path / "study")
    study = vi.studies.load_study(tmp_path / "study")
    alone = case(**{"plate.motion.amplitude": "1 mm", "plate.motion.frequency": "25 Hz"})
    assert study.values("time_s", 1, 1) == pytest.approx(
        vi.simulate(alone).impacts["time_s"], rel=1e-9
    )


# sensors
# -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ["newton", "lankarani-nikravesh"])
@pytest.mark.parametrize("filtered", ["sigma-delta", "butterworth", "none"])
def test_a_sensor_on_a_rigid_table_reads_its_motion(
    tmp_path: Path, law: str, filtered: str
) -> None:
    """Through the transfer functions of a seismic mass and of SciPy's filter, at each instant."""
    motion = {
        "amplitude": "2 mm",
        "frequency": "25 Hz",
        "phase": "40 deg",
        "direction": [0.6, 0, 0.8],
    }
    meter = {"resonance": "60 Hz", "damping_ratio": 0.3}
    slanting = {
        "name": "a1",
        "position": [0.1, 0.1],
        "direction": [0, 0.6, 0.8],
        "rate": 500,
        "filter": filtered,
        "accelerometer": meter,
    }
    along = {
        "name": "v1",
        "position": [0.1, 0.1],
        "direction": [1, 0, 0],
        "rate": 500,
        "filter": filtered,
        "quantity": "velocity",
    }
    values = {
        "plate.motion": motion,
        "contact": {"law": law, "restitution": 0.8},
        "sensors": [slanting, along],
    }
    response = vi.simulate(vi.case_of(with_values(CASE, values)))
    response.save(tmp_path / "run")
    result = vi.load_result(tmp_path / "run")
    omega = 50.0 * np.pi
    gain = 0.64 / (1.0 - (25.0 / 60.0) ** 2 + 0.6j * 25.0 / 60.0)
    corner, passed = 2.0 * np.pi * 200.0, 1.0 + 0.0j
    if filtered == "butterworth":
        _, found = signal.freqs(*signal.butter(8, corner, analog=True), [omega])
        passed = complex(found[0])
    for name, factor in (("a1", -gain * omega**2), ("v1", 0.6j * omega)):
        heard = result.signals[name]
        expected = (
            passed * factor * 2e-3 * np.exp(1j * (omega * heard.time + math.radians(40.0)))
        ).imag
        assert heard.value == pytest.approx(expected, abs=2e-5 * abs(factor) * 2e-3), name
        assert heard.uncertainty == 0.0
        assert f"sensor_{name}" in {chart.name for chart in run_charts(result)}


def test_a_sensor_on_a_table_is_fixed_on_it() -> None:
    with pytest.raises(vi.InputError, match=r'sensors\."a1"\.position: .* outside the plate'):
        case(sensors=[{"name": "a1", "position": [0.3, 0.0]}])


def test_a_plate_without_amplitude_is_heard_as_one_at_rest() -> None:
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.01,
    }
    still = case(
        **elastic,
        **{"plate.motion.amplitude": 0.0},
        sensors=[{"name": "a1", "position": [0.1, 0.1]}],
    )
    one, other = (
        vi.simulate(each).signals()["a1"] for each in (still, replace(still, motion=None))
    )
    assert np.array_equal(one.value, other.value)
    assert one.uncertainty == other.uncertainty


@pytest.mark.parametrize("frequency", ["740 Hz", "25 Hz"])
def test_a_sensor_on_an_elastic_plate_that_carries_a_sphere_reads_its_motion(
    frequency: str,
) -> None:
    """Also near the resonance of the first mode, 787 Hz; the filter of a converter takes
    away what is left of fast oscillations.
    """
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.02,
    }
    amplitude = {"740 Hz": "4 nm", "25 Hz": "0.2 mm"}[frequency]
    shaken = {
        **elastic,
        "plate.motion": {"amplitude": amplitude, "frequency": frequency},
        "contact.restitution": 0.3,
    }
    sensors = [
        {
            "name": name,
            "position": [0.0, 0.0],
            "quantity": "displacement",
            "rate": 2e4,
            "filter": name,
        }
        for name in ("none", "sigma-delta")
    ]
    response = vi.simulate(
        case(
            **shaken,
            **{"drop.height": "30 mm", "run": {"impacts": "all", "duration": "0.4 s"}},
            sensors=sensors,
        )
    )
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    modes = response.problem.plate.modes
    assert modes is not None
    for name, heard in response.signals().items():
        rests = (heard.time > response.rest.time[0]) & (heard.time < 0.395)
        motion = response.at(heard.time[rests])
        expected = motion["plate_deflection_m"] - modes.residuals[name][2] * motion["force_N"]
        # places of 10 mm are rounded to 2e-18 m
        error = {"none": 3e-11, "sigma-delta": 5e-3}[name] * np.ptp(expected)
        assert heard.value[rests] == pytest.approx(expected, abs=error), name


# along the plate
# -----------------------------------------------------------------------------------


def sliding_sphere(
    velocity: tuple[float, float], motion: vi.PlateMotion, law: str = "mdr", **changes: Any
) -> vi.Response:
    pair = {"effective_modulus": 1e9, "effective_shear_modulus": 0.8e9, "effective_radius": 0.01}
    along: dict[str, Any] = {
        "spin": changes.pop("spin", (10.0, -30.0, 50.0)),
        "gravity": changes.pop("gravity_along", (0.0, 0.0)),
    }
    oblique = vi.Oblique(
        velocity=velocity,
        friction=vi.friction.find_friction_law(law)(coefficient=0.3, **pair),
        **along,
    )
    normal = vi.laws.find_contact_law("hunt-crossley")(stiffness=1.3e8, restitution=0.7)
    return vi.simulate(
        problem(
            normal, **{"speed": 2.0, "impacts": 1, "motion": motion, "oblique": oblique, **changes}
        )
    )


STILL = vi.PlateMotion(amplitude=1e-14, frequency=25.0, direction=(1.0, 0.0, 0.0))


@pytest.mark.parametrize("law", ["mdr", "mindlin"])
@pytest.mark.parametrize("speed", [0.3, 1.5])
def test_friction_feels_the_velocity_of_the_plate_alone(law: str, speed: float) -> None:
    """A plate that drifts along itself at a steady speed, of a motion of 1 mHz, is one at
    rest seen by an observer who drifts.
    """
    drift = vi.PlateMotion(
        amplitude=speed / (2e-3 * np.pi), frequency=1e-3, direction=(0.6, 0.8, 0.0)
    )
    moving, still = (
        sliding_sphere((1.0, 0.4), drift, law),
        sliding_sphere((1.0 - 0.6 * speed, 0.4 - 0.8 * speed), STILL, law),
    )
    for axis, part in (("x", 0.6), ("y", 0.8)):
        name = f"separation_velocity_{axis}_m_s"
        assert moving.impacts[name] == pytest.approx(still.impacts[name] + part * speed, abs=1e-10)
    for name in (
        "spin_x_after_rad_s",
        "spin_y_after_rad_s",
        "spin_z_after_rad_s",
        "friction_lost_J",
        "separation_speed_m_s",
    ):
        assert moving.impacts[name] == pytest.approx(still.impacts[name], rel=1e-9), name
    assert moving.energy["closure_relative"] <= 1e-9


def test_a_plate_that_accelerates_along_itself_is_a_pull() -> None:
    motion = vi.PlateMotion(
        amplitude=5.0 / (2.0 * np.pi) ** 2,
        frequency=1.0,
        phase=0.5 * np.pi,
        direction=(1.0, 0.0, 0.0),
    )
    moving, pulled = (
        sliding_sphere((0.3, 0.0), motion),
        sliding_sphere((0.3, 0.0), STILL, gravity_along=(5.0, 0.0)),
    )
    drift = 5.0 * float(moving.impacts["duration_s"][0])
    expected = pulled.impacts["separation_velocity_x_m_s"] - drift
    assert moving.impacts["separation_velocity_x_m_s"] == pytest.approx(expected, abs=1e-8)
    assert moving.impacts["spin_y_after_rad_s"] == pytest.approx(
        pulled.impacts["spin_y_after_rad_s"], rel=1e-7
    )


def test_the_ledger_of_an_inclined_screen_closes() -> None:
    screen = vi.PlateMotion(amplitude=2e-3, frequency=25.0, direction=(0.6, 0.0, 0.8))
    response = sliding_sphere(
        (0.3, 0.0), screen, gravity_along=(1.0, 0.0), impacts=None, duration=1.0
    )
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER)
    assert total == pytest.approx(total[0], abs=1e-6 * response.energy["input_J"])
    assert response.energy["closure_relative"] <= 1e-9
    assert len(response.impacts["time_s"]) >= 3


@pytest.mark.slow
def test_a_ball_that_rolls_on_a_table_moves_with_two_sevenths_of_its_velocity() -> None:
    """The centre of a solid sphere that rolls follows 2/7 of the velocity of what it
    rolls on; within its tangential deformation.
    """
    pair = {"effective_modulus": 1e7, "effective_shear_modulus": 0.8e7, "effective_radius": 0.01}
    friction = vi.friction.find_friction_law("mdr")(coefficient=0.5, **pair)
    sideways = vi.PlateMotion(amplitude=2e-3, frequency=5.0, direction=(1.0, 0.0, 0.0))
    law = KuwabaraKono(stiffness=4.0 / 3.0 * 1e6, dissipation_time=1e-3)
    drop = {
        "height": 0.0105,
        "impacts": None,
        "duration": 0.5,
        "motion": sideways,
        "oblique": vi.Oblique(friction=friction),
    }
    response = vi.simulate(
        replace(problem(law, **drop), sphere=vi.Body(mass=0.02, contact_offset=0.01))
    )
    times = np.linspace(0.2, 0.5, 301)
    speeds = 2e-3 * 10.0 * np.pi * np.cos(10.0 * np.pi * times)
    share, rest = np.polyfit(speeds, response.at(times)["velocity_x_m_s"], 1)
    assert share == pytest.approx(2.0 / 7.0, rel=3e-3)
    assert abs(rest) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "most", "kept"),
    [("rigid", 0.2, 0.3), ("rigid", 1e9, 0.3), ("coulomb", 0.2, 0.0)],
    ids=["rigid", "sticking", "coulomb"],
)
def test_a_billiard_on_a_table_that_moves_along_itself_too(
    law: str, most: float, kept: float
) -> None:
    """Every impact of 1,000 reverses the slip over the table as Walton has it, and the
    ledger closes.
    """
    friction = vi.friction.find_friction_law(law)(
        coefficient=most, **({"slip_restitution": kept} if law == "rigid" else {})
    )
    oblique = vi.Oblique(velocity=(0.3, 0.1), spin=(10.0, -30.0, 5.0), friction=friction)
    table = vi.PlateMotion(amplitude=5e-3, frequency=25.0, direction=(0.6, 0.0, 0.8))
    response = vi.simulate(
        problem(Newton(restitution=0.8), oblique=oblique, motion=table, impacts=1000)
    )
    rows, mass, radius = response.impacts, 0.1, 0.01
    assert len(rows["time_s"]) == 1000
    assert response.energy["closure_relative"] <= 1e-9
    assert rows["plate_work_J"].sum() == pytest.approx(-response.energy["drive_J"], rel=1e-12)
    surface = np.array([0.6, 0.0])[:, None] * table.at(rows["time_s"])[1]

    def slip(when: str, side: str) -> np.ndarray:
        spins = np.array([-rows[f"spin_y_{side}_rad_s"], rows[f"spin_x_{side}_rad_s"]])
        return (
            np.array([rows[f"{when}_velocity_{axis}_m_s"] for axis in "xy"])
            + radius * spins
            - surface
        )

    before, after = slip("approach", "before"), slip("separation", "after")
    impulse = mass * (rows["approach_speed_m_s"] + rows["separation_speed_m_s"])
    speed = np.hypot(*before)
    change = np.minimum((1.0 + kept) * speed, most * impulse / (2.0 / 7.0 * mass))
    assert after == pytest.approx(before * (1.0 - change / speed), abs=1e-10)


def test_a_hard_ball_under_friction_is_followed_until_it_rides() -> None:
    friction = vi.friction.find_friction_law("rigid")(coefficient=0.2)
    sideways = vi.PlateMotion(amplitude=1e-4, frequency=25.0, direction=(1.0, 0.0, 0.0))
    oblique = vi.Oblique(velocity=(0.3, 0.1), friction=friction)
    response = vi.simulate(
        problem(
            Newton(restitution=0.3), oblique=oblique, motion=sideways, impacts=None, duration=0.5
        )
    )
    assert response.outcomes == (vi.Outcome.RIDING,)
    assert response.status.endswith(
        "rides on the plate, which is shaken, and a law without a force does not determine "
        "its motion along the plate then."
    )
    assert response.energy["closure_relative"] <= 1e-9


# elastic plates
# --------------------------------------------------------------------------------------


def test_an_elastic_plate_on_springs_moves_as_its_mass_does() -> None:
    """A stiff plate on four springs, driven at 0.8 and at 1.6 times its frequency on them."""
    on_springs = {
        "plate.model": "elastic",
        "plate.supports": SPRINGS,
        "plate.modes": 6,
        "plate.damping": 0.0,
        "plate.motion.amplitude": "0.1 mm",
    }
    mass = 7850.0 * 0.4 * 0.3 * 0.01
    own = math.sqrt(4.0 * 2e3 / mass) / (2.0 * math.pi)
    for ratio in (0.8, 1.6):
        found = case(**on_springs, **{"plate.motion.frequency": ratio * own})
        assert found.surface_phasors[0] == pytest.approx(1e-4 / (1.0 - ratio**2), rel=2e-3)


def test_an_elastic_plate_is_followed_with_its_motion() -> None:
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.01,
    }
    response = vi.simulate(case(**elastic))
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER)
    assert total == pytest.approx(total[0], abs=1e-7 * response.energy["input_J"])
    assert response.energy["closure_relative"] <= 1e-9
    assert response.impacts["plate_velocity_m_s"] == pytest.approx(
        response.problem.surface(response.impacts["time_s"])[1]
    )
    touch = response.at(response.impacts["time_s"])
    assert touch["plate_deflection_m"] == pytest.approx(touch["position_m"] - 0.02, abs=1e-12)


def test_an_amplitude_of_zero_leaves_an_elastic_plate_as_it_is() -> None:
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.01,
        "plate.motion.amplitude": 0.0,
    }
    still = case(**elastic)
    one, other = vi.simulate(still), vi.simulate(replace(still, motion=None))
    for name, values in other.impacts.items():
        assert np.array_equal(values, one.impacts[name], equal_nan=True), name


@pytest.mark.parametrize("oblique", [{}, {"plate.inclination": "3 deg"}])
def test_a_sphere_comes_to_rest_on_an_elastic_plate_that_is_shaken(oblique: dict[str, Any]) -> None:
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.01,
    }
    gentle = {
        "plate.motion.amplitude": "0.1 mm",
        "drop.height": "22 mm",
        "run": {"duration": 0.3},
        "contact.restitution": 0.5,
    }
    response = vi.simulate(case(**elastic, **gentle, **oblique))
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    assert response.energy["closure_relative"] <= 1e-9
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER)
    assert total == pytest.approx(total[0], abs=1e-7 * response.energy["input_J"])
    times = np.linspace(0.25, 0.3, 301)
    rest, mass, gravity = (
        response.at(times),
        float(response.problem.sphere.mass),
        float(response.problem.gravity),
    )
    # it moves with the surface, which its mass hardly changes, and the force is that of its
    # acceleration
    assert rest["force_N"] == pytest.approx(
        mass * (gravity + response.problem.surface(times)[2]), rel=2e-3
    )
    assert np.gradient(rest["velocity_m_s"], times, edge_order=2) == pytest.approx(
        rest["acceleration_m_s2"], abs=2e-3
    )
    assert rest["plate_deflection_m"] - rest["position_m"] + 0.02 == pytest.approx(
        rest["indentation_m"], abs=1e-7
    )


def test_modal_coordinates_and_deflections_are_those_of_the_whole_motion() -> None:
    elastic = {
        "plate.model": "elastic",
        "plate.supports": "clamped",
        "plate.modes": 12,
        "plate.damping": 0.01,
        "run.impacts": 1,
    }
    response = vi.simulate(case(**elastic))
    times = np.linspace(0.0, float(response.end_time[0]), 7)
    modes, motion = response.problem.plate.modes, response.problem.motion
    assert modes is not None
    assert motion is not None
    surface = motion.at(times)[0] + response.modal(times)["plate"] @ modes.contact
    assert surface == pytest.approx(response.at(times)["plate_deflection_m"], abs=1e-12)


OBLIQUE: dict[str, Any] = {
    "plate.model": "elastic",
    "plate.supports": "clamped",
    "plate.modes": 12,
    "plate.damping": 0.01,
    "drop": {
        "speed": 0.9,
        "angle": "20 deg",
        "spin": [10.0, -30.0, 50.0],
        "position": ["-60 mm", "20 mm"],
    },
    "contact.friction": {"law": "mindlin", "coefficient": 0.3},
}


@pytest.mark.slow
def test_an_amplitude_of_zero_leaves_an_oblique_drop_on_an_elastic_plate_as_it_is() -> None:
    still = case(**OBLIQUE, **{"plate.motion.amplitude": 0.0})
    one, other = vi.simulate(still), vi.simulate(replace(still, motion=None))
    for name, values in other.impacts.items():
        assert np.array_equal(values, one.impacts[name], equal_nan=True), name
    for name, values in other.history().items():
        assert np.array_equal(values, one.history()[name], equal_nan=True), name


@pytest.mark.slow
def test_the_ledger_of_oblique_impacts_on_an_elastic_screen_closes() -> None:
    screen = {
        "plate.motion.direction": [3, 0, 4],
        "plate.inclination": "5 deg",
        "plate.element": "solid",
        "run.impacts": 8,
    }
    response = vi.simulate(case(**OBLIQUE, **screen))
    history = response.history()
    total = sum(history[name] for name in history if name in IN_LEDGER)
    assert total == pytest.approx(total[0], abs=1e-6 * response.energy["input_J"])
    assert response.energy["closure_relative"] <= 1e-9
    assert response.impacts["plate_work_J"].sum() == pytest.approx(
        -response.energy["drive_J"], rel=1e-9
    )
    touch = response.at(response.impacts["time_s"])
    assert touch["surface_velocity_m_s"] == pytest.approx(
        response.impacts["plate_velocity_m_s"], abs=1e-12
    )
    assert touch["plate_deflection_m"] == pytest.approx(touch["position_m"] - 0.02, abs=1e-12)


@pytest.mark.parametrize("law", ["newton", "hunt-crossley"])
def test_the_place_of_an_impact_on_a_plate_that_moves_along_itself(law: str) -> None:
    """Positions are in space; the plate has moved away under them by its motion, and the
    plate's own places tell where it is hit.
    """
    table = plain_case(
        contact={"law": law, "restitution": 0.6},
        drop={"velocity": [0.3, 0.0, -1.0], "position": [0.01, 0.02]},
        run={"impacts": 3},
    )
    table["plate"] |= {
        "motion": {"amplitude": "4 mm", "frequency": "7 Hz", "direction": [1, 0, 0]},
        "size": [1.0, 1.0, 0.02],
    }
    impacts = vi.simulate(vi.case_of(table)).impacts
    moved = 4e-3 * np.sin(2.0 * np.pi * 7.0 * impacts["time_s"])
    assert np.abs(moved).max() > 1e-3
    assert impacts["place_on_plate_x_m"] == pytest.approx(
        impacts["position_x_m"] - moved, abs=1e-12
    )
    assert impacts["place_on_plate_y_m"] == pytest.approx(impacts["position_y_m"], abs=1e-15)
    assert impacts["place_on_plate_x_m"][0] == pytest.approx(0.01, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("drive", ["slow", "table"])
def test_an_elastic_plate_that_drifts_is_one_at_rest_to_an_observer_who_drifts(
    tmp_path: Path, drive: str
) -> None:
    """A steady velocity along the plate, of a slow motion, or of a table, whose cosines have it to
    3e-5: the place on the plate counts.

    What friction does on an elastic plate depends on the steps in which a contact begins to slide:
    it is known to 1e-4 at any tolerance.
    """
    times, drift = np.linspace(0.0, 0.2, 201), 0.25
    path = tmp_path / "drift.csv"
    path.write_text(
        "time [s],displacement [m]\n" + "".join(f"{at:.6g},{drift * at:.12g}\n" for at in times)
    )
    table = (
        {"file": str(path)}
        if drive == "table"
        else {"amplitude": drift / (2e-4 * math.pi), "frequency": 1e-4}
    )
    moving = {
        "plate.motion": {**table, "direction": [1, 0, 0]},
        "drop.velocity": [0.4, 0.1, -0.9],
        "run": {"duration": 0.2},
    }
    # the zero of a table is its mean
    accuracy, begun = (1e-4, -0.1 * drift) if drive == "table" else (1e-5, 0.0)
    still = {
        "drop.velocity": [0.4 - drift, 0.1, -0.9],
        "drop.position": [-0.06 - begun, 0.02],
        "run": {"duration": 0.2},
    }
    oblique = with_values(
        CASE, {**OBLIQUE, "drop": {"spin": [10.0, -30.0, 50.0], "position": [-0.06, 0.02]}}
    )
    unshaken = with_values(oblique, still)
    del unshaken["plate"]["motion"]
    seen, found = (
        vi.simulate(vi.case_of(unshaken)),
        vi.simulate(vi.case_of(with_values(oblique, moving))),
    )
    assert len(found.impacts["time_s"]) >= 2
    for name in ("time_s", "separation_speed_m_s"):
        assert found.impacts[name] == pytest.approx(seen.impacts[name], rel=2.0 * accuracy), name
    for name in (
        "spin_x_after_rad_s",
        "spin_y_after_rad_s",
        "spin_z_after_rad_s",
        "friction_lost_J",
    ):
        assert found.impacts[name] == pytest.approx(seen.impacts[name], rel=2e-4), name
    sideways = seen.impacts["separation_velocity_x_m_s"] + drift
    assert found.impacts["separation_velocity_x_m_s"] == pytest.approx(sideways, abs=1e-4 * drift)
    away = begun + drift * found.impacts["time_s"]
    assert found.impacts["position_x_m"] == pytest.approx(
        seen.impacts["position_x_m"] + away, abs=accuracy * drift
    )
    for axis in "xy":
        place, still_there = (
            found.impacts[f"place_on_plate_{axis}_m"],
            seen.impacts[f"position_{axis}_m"],
        )
        assert place == pytest.approx(still_there, abs=accuracy * drift), (
            "an observer on the plate sees where it is hit"
        )
    assert found.energy["closure_relative"] <= 1e-9


def test_a_shaken_plate_whose_modes_hardly_move_is_a_rigid_one() -> None:
    number = 5
    modes = ModalBasis(
        np.linspace(500.0, 5e3, number),
        np.full(number, 0.02),
        np.full(number, 1e-9),
        np.zeros((number, 3)),
        mass=4.0,
        along=np.full((number, 2), 1e-9),
    )
    screen = vi.PlateMotion(amplitude=2e-3, frequency=25.0, direction=(0.6, 0.0, 0.8))
    stiff = vi.Body(mass=np.inf, contact_offset=0.0, modes=modes)
    elastic, rigid = (
        sliding_sphere((0.3, 0.0), screen, impacts=4, plate=plate)
        for plate in (stiff, vi.rigid_plate())
    )
    for name in (
        "time_s",
        "separation_velocity_x_m_s",
        "spin_y_after_rad_s",
        "plate_work_J",
        "friction_lost_J",
    ):
        assert elastic.impacts[name] == pytest.approx(rigid.impacts[name], rel=1e-6), name


def test_a_sphere_falls_off_a_plate_that_moves_away() -> None:
    """Over the edge as it moves: 0.1 m from the middle of the plate, which is 0.05 m from
    its mean position by the second impact.
    """
    oblique = vi.Oblique(position=(0.07, 0.0), size=(0.2, 0.2))
    away = vi.PlateMotion(amplitude=0.1, frequency=0.5, direction=(-1.0, 0.0, 0.0))
    response = vi.simulate(problem(oblique=oblique, motion=away, impacts=None, duration=1.0))
    assert response.outcomes == (vi.Outcome.FELL,)
    assert 0.1 * np.sin(np.pi * response.end_time[0]) > 0.03
    assert 0.1 * np.sin(np.pi * response.impacts["time_s"][-1]) <= 0.03


@pytest.mark.parametrize("law", ["newton", "lankarani-nikravesh"])
def test_charts_of_a_shaken_plate(law: str) -> None:
    result = vi.result_of(
        vi.simulate(vi.case_of(with_values(CASE, {"contact": {"law": law, "restitution": 0.8}})))
    )
    position = next(chart for chart in run_charts(result) if chart.name == "position")
    (ball, surface) = (mark for mark in position.rows[0][0].marks if isinstance(mark, Line))
    # both curves are thinned to what is seen: a tenth of a pixel, 3e-4 of the range
    gap = np.interp(surface.x, ball.x, ball.y) - surface.y
    seen = 6e-4 * float(np.ptp(ball.y))
    assert gap.min() >= -1.1 * float(result.impacts["max_indentation_m"].max()) - seen
    times, velocities = _touch_and_release(result)
    around = np.array([times[0] - 1e-6, times[1] + 1e-6])
    assert np.interp(
        around, result.history["time_s"], result.history["velocity_m_s"]
    ) == pytest.approx(velocities[:2], abs=1e-4)
    tops, heights = tops_of_rebounds(result)
    assert len(tops) >= 1
    assert np.interp(tops, result.history["time_s"], result.history["position_m"]) == pytest.approx(
        heights, rel=1e-3
    )
    scene = rigid_scene(result)
    assert np.ptp(scene["contact_height"]) == pytest.approx(4e-3, rel=0.02)


def test_no_law_is_calibrated_on_a_plate_that_moves() -> None:
    with pytest.raises(vi.InputError, match=r"plate\.motion: only impacts on a plate at rest"):
        vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**CASE, "calibrate": {"target": {"restitution": 0.7}}})
        )
