"""The next meeting with a surface that moves is the first one: against fine sampling, of
motions made to be missed.
"""

from __future__ import annotations

import numpy as np
import pytest

from support import one_in
from vibroimpact.dynamics.core.touch import approach_in, time_apart
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch

NONE = np.zeros(0)


def motion(
    omega: object,
    displacement: object,
    velocity: object,
    *,
    approach: float = -1e-3,
    speed: float = -1.0,
    gravity: float = 9.8,
    damping: float = 0.0,
    local: tuple[float, float] | None = None,
) -> FreeMotion:
    """A sphere that leaves a surface that is the sum of its oscillators; `local`: how far
    an element is pressed in, and its rate.
    """
    omega, displacement, velocity = (
        np.atleast_1d(np.asarray(part, dtype=float)) for part in (omega, displacement, velocity)
    )
    pressed, rate = (np.array([value]) for value in local) if local else (NONE, NONE)
    # the first coordinate is the fall of the sphere, of 1 kg
    ground = np.arange(len(omega) + 1) > 0
    of = LinearSystem(
        np.append(0.0, omega),
        np.append(0.0, np.full(len(omega), damping)),
        np.ones((1, len(omega) + 1)),
        np.zeros(1),
        np.where(ground, 0.0, gravity),
        ~ground & False,
        ground[None],
        rate,
        np.ones(len(rate)),
        np.zeros(len(rate), dtype=np.intp),
    )
    return FreeMotion(
        of, State(np.append(approach, displacement), np.append(speed, velocity), pressed)
    )


def first_meeting(free: FreeMotion, level: float, end: float, number: int = 1_000_001) -> float:
    """The first sample beyond the level, by brute force."""
    step = end / (number - 1)
    for block in np.array_split(np.arange(1, number), 100):
        beyond = free.motion(block * step)[0][:, 0] > level
        if beyond.any():
            return float(block[beyond.argmax()]) * step
    return np.inf


@pytest.mark.parametrize("seed", one_in(2, range(11, -1, -1)))
def test_against_brute_force(seed: int) -> None:
    """Surfaces of one to twelve modes of 30 Hz to 5 kHz that nearly reach, or just do not
    reach, a sphere that comes and goes.
    """
    random = np.random.default_rng(seed)
    number = seed + 1
    omega = 2.0 * np.pi * np.exp(random.uniform(np.log(30.0), np.log(5e3), number))
    size = 10.0 ** random.uniform(-5.0, -3.0)
    free = motion(
        omega,
        size * random.normal(size=number) * (seed % 3 > 0),
        size * omega * random.normal(size=number),
        approach=-6.0 * size * np.sqrt(number),
        speed=-float(random.uniform(0.0, 0.3)),
        damping=(0.0, 0.01, 1.3)[seed % 3],
    )
    found, step = next_touch(free, 0.0, np.inf), 0.1 / 1e6
    brute = first_meeting(free, 0.0, 0.1)
    assert found == pytest.approx(brute, abs=1.01 * step) if np.isfinite(brute) else found > 0.1
    assert abs(float(free.motion(np.array(found))[0][0])) < 1e-12
    assert float(free.motion(np.array(found))[1][0]) > 0.0


def test_a_wave_that_grazes() -> None:
    """A wave that reaches a nanometre beyond the sphere meets it, one that stays as far
    below does not: but a later one does.
    """
    omega, size = 2.0 * np.pi * 1e4, 1e-5
    quarter = 0.5 * np.pi / omega
    for excess, meets in ((1e-9, True), (-1e-9, False)):
        free = motion(omega, 0.0, size * omega, approach=-size + excess, speed=0.0, gravity=0.0)
        found = next_touch(free, 0.0, 10.0)
        assert (found < quarter) if meets else np.isinf(found)
    # and comes down a nanometre in 1.4 ms
    falling = motion(omega, 0.0, size * omega, approach=-size - 1e-9, speed=0.0, gravity=1e-3)
    found = next_touch(falling, 0.0, np.inf)
    assert found == pytest.approx(first_meeting(falling, 0.0, 2e-3, 2_000_001), abs=2e-9)
    assert 1e-3 < found < 1.5e-3


def test_many_waves_before_the_touch() -> None:
    """A small fast ripple under a long flight: found within a hundred steps, not by
    following every wave.
    """
    free = motion(2.0 * np.pi * 2e5, 0.0, 1e-9 * 2.0 * np.pi * 2e5, approach=0.0, speed=-5.0)
    calls = 0
    counted = FreeMotion.state

    def counting(self: FreeMotion, time: np.ndarray) -> State:
        nonlocal calls
        calls += 1
        return counted(self, time)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FreeMotion, "state", counting)
        found = next_touch(free, 0.0, np.inf)
    assert found == pytest.approx(2.0 * 5.0 / 9.8, abs=1e-8)
    assert calls < 100


def test_without_modes_it_is_the_parabola() -> None:
    free = motion(NONE, NONE, NONE, approach=-0.5, speed=-2.0)
    assert next_touch(free, 0.0, np.inf) == pytest.approx(
        (2.0 + np.sqrt(4.0 + 2.0 * 9.8 * 0.5)) / 9.8, rel=1e-14
    )
    assert np.isinf(next_touch(free, 0.0, 0.1))
    assert np.isinf(next_touch(motion(NONE, NONE, NONE, gravity=0.0), 0.0, np.inf))
    assert next_touch(
        motion(NONE, NONE, NONE, speed=2.0, gravity=0.0), 0.0, np.inf
    ) == pytest.approx(5e-4, rel=1e-14)


def test_right_after_a_release_it_is_not_the_release_again() -> None:
    """From approach zero, however slowly the surfaces part."""
    for speed in (-1.0, -1e-3, -1e-6):
        free = motion(2.0 * np.pi * 300.0, 0.0, -0.1, approach=0.0, speed=speed)
        assert next_touch(free, 0.0, np.inf) == pytest.approx(
            first_meeting(free, 0.0, 1.0, 4_000_001), abs=3e-7
        )


def test_a_dent_that_the_next_contact_does_not_find_again() -> None:
    """Surfaces that overlap beyond the level part first."""
    free = motion(2.0 * np.pi * 300.0, 0.0, 0.0, approach=2e-4, speed=-1.0)
    assert next_touch(free, 0.0, np.inf) == pytest.approx(
        (1.0 + np.sqrt(1.0 - 2.0 * 9.8 * 2e-4)) / 9.8, rel=1e-9
    )
    gone = motion(2.0 * np.pi * 300.0, 0.0, 0.0, approach=2e-4, speed=0.0, gravity=0.0)
    assert np.isinf(next_touch(gone, 0.0, np.inf))


def test_a_local_element_creeps_back() -> None:
    """Slower than the sphere leaves: a gap opens and closes when the sphere comes back to
    the recovered element.
    """
    free = motion(NONE, NONE, NONE, approach=-3e-4, speed=-0.1, local=(3e-4, 2000.0))
    found = next_touch(free, 0.0, np.inf)
    assert found == pytest.approx(first_meeting(free, 0.0, 0.1), abs=1.1e-7)


@pytest.mark.parametrize("approach", [0.0, 1e-22, -1e-22])
def test_what_leaves_and_is_not_turned_back_never_meets_again(approach: float) -> None:
    """Without gravity and without anything that vibrates, also where rounding leaves the
    surfaces just together.
    """
    assert (
        next_touch(
            motion(NONE, NONE, NONE, approach=approach, speed=-30.0, gravity=0.0), 0.0, np.inf
        )
        == np.inf
    )
    assert next_touch(
        motion(NONE, NONE, NONE, approach=-1e-3, speed=2.0, gravity=0.0), 0.0, np.inf
    ) == pytest.approx(5e-4)


def test_surfaces_stay_apart_for_the_time_that_is_stated() -> None:
    rng = np.random.default_rng(5)
    shorter = 0
    for _ in range(200):
        omega = 10.0 ** rng.uniform(0.0, 4.0, 3)
        vibration = 10.0 ** rng.uniform(-6.0, -3.0)
        free = motion(
            omega,
            vibration * rng.normal(size=3),
            omega * vibration * rng.normal(size=3),
            approach=-1e-3 - rng.uniform(0.0, 1e-2),
            speed=rng.normal(),
            gravity=rng.choice([-9.8, 0.0, 9.8]),
            damping=rng.choice([0.0, 0.1]),
            local=(1e-4 * rng.random(), 100.0),
        )
        level = max(0.0, float(free.system.approach(free.start)[0]))
        record = free.system.record_of(0)
        apart = time_apart(approach_in(record, free.start.record), level, record.gravity)
        touch = next_touch(free, level, np.inf)
        assert apart <= touch * (1.0 + 1e-12)
        shorter += 0.1 * touch < apart < touch < np.inf
    assert shorter > 20
