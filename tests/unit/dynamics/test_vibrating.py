"""What every drop on bodies that vibrate keeps: energy, momentum, order in time, and
surfaces that do not pass through each other.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from support import one_in, plain_case
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.motion.columns import LEDGER, VIBRATION_LEDGER
from vibroimpact.dynamics.statement.outcome import Outcome

HERTZ = Hertz(stiffness=STIFFNESS)
LOSSY = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.65)
PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)
LAWS = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]


def unbalanced(response: vi.Response, history: dict[str, np.ndarray]) -> float:
    """How much of the energy put in is missing, at worst, in the history."""
    total = sum(history[name] for name in (*LEDGER, *VIBRATION_LEDGER))
    return float(np.abs(total / response.energy["input_J"] - 1.0).max())


@pytest.mark.parametrize("seed", one_in(3, (5, 4, 3, 2, 1, 0)))
def test_energy_is_conserved_without_damping(seed: int) -> None:
    """Five impacts, plates from 1 to 40 modes and every second time a sphere of 6, to
    1e-9 of the input; within stretches to 1e-7.
    """
    plate = random_modes(seed, (1, 3, 8, 15, 25, 40)[seed], 100.0, 2e4, 1.2)
    sphere = random_modes(seed + 100, 6, 12e3, 60e3, 2.0) if seed % 2 else None
    response = vi.simulate(
        drop_on(HERTZ, plate, sphere, height=0.5, impacts=5, sphere_inside=seed < 3)
    )
    assert len(response.impacts["impact"]) == 5
    assert response.energy["closure_relative"] < 1e-9
    history = response.history()
    assert unbalanced(response, history) < 1e-7
    for name in ("plate_damping_J", "sphere_damping_J", "contact_dissipated_J"):
        assert abs(response.energy[name]) < 1e-13 * response.energy["input_J"]


@pytest.mark.parametrize(
    "law", [LOSSY, AdamsImpact(stiffness=STIFFNESS, damping_max=180.0)], ids=lambda law: law.name
)
@pytest.mark.parametrize("local", one_in(2, [((1.2e6, 586.0),), (None,)]))
def test_the_ledger_closes_with_damping(
    law: LankaraniNikravesh | AdamsImpact, local: tuple[float, float] | None
) -> None:
    plate, sphere = (
        random_modes(1, 20, 100.0, 2e4, 1.2, 0.03),
        random_modes(2, 6, 12e3, 60e3, 2.0, 1.0),
    )
    response = vi.simulate(drop_on(law, plate, sphere, height=0.5, impacts=5, local_element=local))
    assert response.energy["closure_relative"] < 1e-9
    history = response.history()
    assert unbalanced(response, history) < 1e-7
    for name in ("plate_damping_J", "sphere_damping_J", "contact_dissipated_J"):
        assert np.diff(history[name]).min() > -1e-8 * response.energy["input_J"]


def test_a_history_of_many_times_is_that_of_each_time() -> None:
    """The times of a long flight are evaluated in blocks; the modes are of all kinds:
    light, critical and heavy damping.
    """
    plate = random_modes(3, 30, 100.0, 2e4, 1.2, 0.02)
    plate = replace(
        plate,
        damping_ratios=np.where(np.arange(30) < 10, 0.02, np.where(np.arange(30) < 20, 1.0, 1.7)),
    )
    response = vi.simulate(drop_on(LOSSY, plate, height=0.3, impacts=2))
    touch, duration = response.impacts["time_s"][0], response.impacts["duration_s"][0]
    times = np.linspace(touch, touch + 50.0 * duration, 1000)
    together = response.at(times)
    for index in (0, 3, 127, 128, 129, 255, 256, 700, 999):
        for name, value in response.at(times[index]).items():
            assert value == pytest.approx(
                together[name][index], rel=1e-12, abs=1e-14 * np.abs(together[name]).max()
            ), name


def test_columns_of_a_history_are_the_same_alone() -> None:
    """Those of motion and force alone are found from less; a column that there is not is named."""
    response = vi.simulate(
        drop_on(LOSSY, random_modes(3, 30, 100.0, 2e4, 1.2, 0.02), height=0.3, impacts=2)
    )
    history, times = response.history(), np.linspace(0.0, float(response.end_time[0]), 50)
    whole = response.at(times)
    for columns in (
        ("force_N",),
        ("plate_deflection_m", "time_s"),
        ("plate_strain_J", "position_m"),
        tuple(history),
    ):
        for found, expected in (
            (response.history(columns=columns), history),
            (response.at(times, columns), whole),
        ):
            assert tuple(found) == columns
            for name in columns:
                np.testing.assert_array_equal(found[name], expected[name])
    with pytest.raises(
        vi.InputError,
        match=r"no column 'force_kN'; it has force_N, time_s, position_m.*\. Did you mean "
        r"\"force_N\"\?",
    ):
        response.history(columns=["force_kN"])


def test_without_sensitivity_the_run_is_the_same() -> None:
    problem = drop_on(LOSSY, random_modes(3, 30, 100.0, 2e4, 1.2, 0.02), height=0.3, impacts=3)
    whole, part = vi.simulate(problem), vi.simulate(replace(problem, sensitivity=False))
    assert set(whole.impacts) - set(part.impacts) == {"sensitivity"}
    for name, values in part.impacts.items():
        np.testing.assert_array_equal(values, whole.impacts[name])


def test_the_motion_of_a_stretch_is_kept_for_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of stretches that are no longer kept the motion is found again, and is the same."""
    problem = drop_on(LOSSY, random_modes(3, 30, 100.0, 2e4, 1.2, 0.02), height=0.3, impacts=3)
    kept = vi.simulate(problem).history()
    monkeypatch.setattr("vibroimpact.dynamics.vibrating.stretch._KEPT", 2)
    response = vi.simulate(problem)
    stretches = [
        piece.motion
        for bounce in response.bounces or ()
        if bounce.contact is not None
        for piece in bounce.contact.pieces
    ]
    assert sum("motion" in vars(motion) for motion in stretches) <= 2 < len(stretches)
    for name, values in response.history().items():
        np.testing.assert_array_equal(values, kept[name])


@pytest.mark.slow
def test_runs_of_other_threads_leave_the_motions_that_are_kept() -> None:
    problem = drop_on(LOSSY, random_modes(3, 30, 100.0, 2e4, 1.2, 0.02), height=0.3, impacts=3)

    def kept(response: vi.Response) -> list[bool]:
        return [
            "motion" in vars(piece.motion)
            for bounce in response.bounces or ()
            if bounce.contact is not None
            for piece in bounce.contact.pieces
        ]

    def read(problem: vi.Problem) -> None:
        vi.simulate(problem).history()

    response = vi.simulate(problem)
    response.history()
    before = kept(response)
    assert any(before)
    with ThreadPoolExecutor(1) as thread:
        list(thread.map(read, [problem] * 5))
    assert kept(response) == before
    list(map(read, [problem] * 5))
    assert not any(kept(response))


@pytest.mark.parametrize("seed", range(3))
def test_the_impulse_is_the_change_of_momentum(seed: int) -> None:
    """The integral of the force over a contact, by Gauss's rule in a time smooth at both
    ends, less the weight's.
    """
    problem = drop_on(HERTZ, random_modes(seed, 12, 300.0, 2e4, 0.8), height=0.4, impacts=2)
    response = vi.simulate(problem)
    nodes, weights = np.polynomial.legendre.leggauss(300)
    x, found = 0.5 * (nodes + 1.0), response.impacts
    for start, length, before, after, contacts in zip(
        *(
            found[f"{name}"]
            for name in (
                "time_s",
                "duration_s",
                "approach_speed_m_s",
                "separation_speed_m_s",
                "contacts",
            )
        ),
        strict=True,
    ):
        if contacts > 1:
            continue
        force = response.at(start + length * x * x * (3.0 - 2.0 * x))["force_N"]
        impulse = length * float(0.5 * weights @ (6.0 * x * (1.0 - x) * force))
        mass = float(problem.sphere.mass)
        assert impulse - mass * 9.8 * length == pytest.approx(mass * (before + after), rel=1e-8)


def check_order(response: vi.Response, history: dict[str, np.ndarray]) -> None:
    """Contacts do not overlap, and position and velocity do not jump."""
    impacts = response.impacts
    assert np.all(impacts["time_s"][1:] >= (impacts["time_s"] + impacts["duration_s"])[:-1] - 1e-13)
    speed = np.abs(impacts["approach_speed_m_s"]).max()
    # not where it is laid to rest
    same = (np.diff(history["time_s"]) <= 1e-15) & (history["acceleration_m_s2"][1:] != 0.0)
    for name, scale in (
        ("position_m", 1e-3),
        ("velocity_m_s", speed),
        ("plate_deflection_m", 1e-3),
        ("plate_velocity_m_s", speed),
    ):
        assert np.abs(np.diff(history[name])[same]).max(initial=0.0) < 1e-9 * scale, name
    assert all(np.isfinite(values).all() for values in history.values())


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("law", one_in(4, LAWS, lambda law: law.name))
def test_every_law_goes_with_modes(law: type[CompliantLaw], inside: bool) -> None:
    """Three impacts of an elastic sphere on an elastic plate, on fresh surfaces and on
    the same: the ledger closes, nothing jumps.
    """
    plate, sphere = (
        random_modes(5, 6, 200.0, 8e3, 1.0, 0.01),
        modes_of([13.4e3, 22e3], [2.0, -2.5], 0.05),
    )
    problem = drop_on(
        law.example(PAIR),
        plate,
        sphere,
        height=0.2,
        impacts=3,
        sphere_inside=inside,
        same_spot=inside,
    )
    response = vi.simulate(problem)
    assert response.energy["closure_relative"] < 2e-9
    history = response.history()
    assert unbalanced(response, history) < 1e-7
    check_order(response, history)
    lost = np.diff(history["plastic_work_J"])
    assert lost.min() > -1e-8 * response.energy["input_J"]


@pytest.mark.parametrize("seed", one_in(3, range(22)))
def test_drops_at_random(seed: int) -> None:
    """Modes of 20 Hz to 200 kHz and any damping, any law, with and without gravity,
    stopped by number or by time.
    """
    random = np.random.default_rng(seed)
    law = LAWS[seed % len(LAWS)].example(PAIR)
    damping = (0.0, 0.03, 1.0, 2.5)[seed % 4]
    plate = random_modes(seed, int(random.integers(1, 25)), 20.0, 2e5, 0.8, damping)
    sphere = random_modes(seed + 50, 5, 5e3, 2e5, 0.8, 0.02) if random.random() < 0.5 else None
    more: dict[str, object] = (
        {"duration": float(random.uniform(0.01, 0.3))} if seed % 3 == 0 else {}
    )
    more |= {
        "speed": float(np.exp(random.uniform(-2.0, 2.0))),
        "gravity": (0.0, 9.8)[seed % 2],
        "sphere_inside": seed % 5 > 1,
    }
    response = vi.simulate(drop_on(law, plate, sphere, impacts=2, **more))
    assert response.energy["closure_relative"] < 1e-8
    history = response.history()
    assert unbalanced(response, history) < 1e-6
    check_order(response, history)


@pytest.mark.parametrize("seed", range(4))
def test_surfaces_do_not_pass_through_each_other(seed: int) -> None:
    """Where they do not touch, the sphere is above the surface, at fifty times of a
    period of the fastest mode.
    """
    plate = random_modes(seed, 6, 100.0, 3e3, 1.5, 0.001)
    response = vi.simulate(drop_on(LOSSY, plate, speed=1.0, impacts=3))
    times = np.arange(0.0, min(float(response.end_time[0]), 0.3), 1.0 / 3e3 / 50.0)
    found = response.at(times)
    apart = (found["force_N"] == 0.0) & (found["indentation_m"] == 0.0)
    assert apart.mean() > 0.5
    assert (found["position_m"] - 0.025 - found["plate_deflection_m"])[apart].min() > -1e-12


@pytest.mark.slow
def test_a_foil_is_integrated_to_any_tolerance() -> None:
    """A ball on a foil of 20 um sinks by thousands of thicknesses."""
    foil = {
        "size": [0.1, 0.1, 20e-6],
        "material": "steel",
        "model": "elastic",
        "modes": 20,
        "supports": "simply-supported",
    }
    case = plain_case(
        sphere={"radius": 0.01, "material": "steel"},
        plate=foil,
        drop={"height": 0.3},
        run={"impacts": 2},
    )
    speeds = []
    for tolerance in (1e-8, 1e-10, 1e-12):
        case["run"]["tolerance"] = tolerance
        speeds.append(vi.simulate(vi.case_of(case)).impacts["separation_speed_m_s"])
    np.testing.assert_allclose(speeds[:2], [speeds[2]] * 2, rtol=1e-7)


def test_a_visit_that_ends_while_the_law_still_yields_closes_its_ledger() -> None:
    """A dashpot in series so stiff that the limit of stretches is reached before the
    deepest point.
    """
    law = WaltonBraun(stiffness=2e6, restitution=0.5)
    response = vi.simulate(drop_on(law, local_element=(1e6, 1.0), tolerance=1e-12))
    assert response.outcomes[0] is Outcome.RIDING
    assert response.energy["closure_relative"] < 1e-12
    assert response.energy["plastic_work_J"] > 0.0
