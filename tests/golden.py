"""Golden numbers: impacts, ledgers, histories and signals of drops of every kind, kept in a file,
and compared with those computed now.

All are computed to a tolerance of 1e-12, so that two ways of solving the same equations give the
same numbers. To keep new ones, once it is understood why they are others, run this file with the
names of the drops; without a name it keeps all.
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import vibroimpact as vi
from golden_plain_drops import plain_drops
from golden_surrounded_drops import all_systems, surrounded_drops

Floats = np.ndarray
KEPT = Path(__file__).with_name("golden.npz")
TOLERANCE = 1e-12
PROBLEMS = plain_drops() | surrounded_drops()
SYSTEMS = all_systems()
NAMES = [*PROBLEMS, *SYSTEMS]
_AXIS = re.compile(r"_[xyz]_")


def numbers(name: str, times: Floats | None = None) -> dict[str, Floats]:
    """Return the numbers of a drop or a system by name; its history at times [s], which
    are chosen unless they are given.
    """
    return _numbers_of_system(name, times) if name in SYSTEMS else _numbers_of_drop(name, times)


def _numbers_of_drop(name: str, times: Floats | None) -> dict[str, Floats]:
    problem = replace(PROBLEMS[name](), tolerance=TOLERANCE)
    response = vi.simulate(problem)
    found = {f"impacts/{key}": np.asarray(value) for key, value in response.impacts.items()}
    found |= {f"energy/{key}": np.asarray(value) for key, value in response.energy.items()}
    found["outcomes"] = np.array([outcome.code for outcome in response.outcomes])
    if problem.shape == ():
        times = _moments(response) if times is None else times
        found |= {f"history/{key}": np.asarray(value) for key, value in response.at(times).items()}
        if problem.sensors:
            found |= {
                f"signal/{key}": _from_touch(signal, response)
                for key, signal in response.signals().items()
            }
        return found
    table = vi.tabulate(problem)
    return found | {f"table/{key}": np.asarray(value) for key, value in table.impacts.items()}


def _from_touch(signal: Any, response: vi.Response) -> Floats:
    """Return the samples of a signal from the first touch on, at most 500."""
    first = int(np.searchsorted(signal.time, response.impacts["time_s"][0]))
    return np.asarray(signal.value[first : first + 500])


def _numbers_of_system(name: str, times: Floats | None) -> dict[str, Floats]:
    make, duration = SYSTEMS[name]
    response = vi.simulate_system(replace(make(), tolerance=TOLERANCE), duration=duration)
    columns = {
        key: value
        for key, value in response.impacts.items()
        if np.asarray(value).dtype.kind in "if"
    }
    found = {f"impacts/{key}": np.asarray(value) for key, value in columns.items()}
    found |= {f"energy/{key}": np.asarray(value) for key, value in response.energy.items()}
    times = duration * (np.arange(60) + 0.37) / 60.0 if times is None else times
    found["history/time_s"] = times
    found |= {
        f"history/force_N of {contact}": force for contact, force in response.forces(times).items()
    }
    for body, motion in response.at(times).items():
        found |= {
            f"history/{key} of {body}": np.asarray(getattr(motion, key))
            for key in ("displacement", "velocity", "rotation", "modal")
        }
    return found


def _moments(response: vi.Response) -> Floats:
    """Return times over the whole run, and in its first contacts, away from their ends:
    at an impulse the velocity is either one.
    """
    begun, length = response.impacts["time_s"], response.impacts["duration_s"]
    contacts = [
        (first, across) for first, across in zip(begun[:2], length[:2], strict=True) if across > 0.0
    ]
    inside = [first + across * np.linspace(0.04, 0.96, 15) for first, across in contacts]
    end = begun[-1] + length[-1] if len(begun) else float(response.end_time[0])
    return np.sort(np.concatenate([*inside, end * (np.arange(25) + 0.37) / 25.0]))


def kept(name: str) -> dict[str, Floats]:
    """Return the numbers of a drop that are kept."""
    with np.load(KEPT) as file:
        values, shapes = file[name], json.loads(str(file[f"shapes of {name}"]))
    ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
    return {
        key: part.reshape(shape)
        for (key, shape), part in zip(shapes.items(), np.split(values, ends[:-1]), strict=True)
    }


def departures(name: str) -> dict[str, float]:
    """Return by how many times what is allowed each number of a drop departs from what is kept."""
    before = kept(name)
    now = numbers(name, before.get("history/time_s"))
    assert now.keys() == before.keys(), sorted(now.keys() ^ before.keys())
    growth = max(1.0, float(np.nanmax(before.get("impacts/sensitivity", 1.0))))
    found = {}
    for key, old in before.items():
        assert now[key].shape == old.shape, key
        for same in (np.isnan, np.isposinf, np.isneginf):
            assert np.array_equal(same(now[key]), same(old)), key
        finite = np.isfinite(old)
        if key.startswith("history/"):
            finite &= _beside_impulses(before).reshape(-1, *[1] * (old.ndim - 1))
        off = float(np.abs(now[key][finite] - old[finite]).max(initial=0.0))
        allowed = max(_allowance(key) * growth, _known_to(name))
        found[key] = off / ((_scale(key, before) or 1.0) * allowed)
    return found


def _beside_impulses(numbers: Mapping[str, Floats]) -> Floats:
    """Return which times of a history are not those of impacts without duration, at which a
    velocity is either one.
    """
    times = numbers["history/time_s"]
    if "impacts/duration_s" not in numbers:
        return np.ones(len(times), dtype=bool)
    impulses = numbers["impacts/time_s"][numbers["impacts/duration_s"] == 0.0]
    apart = np.abs(times[:, None] - impulses[None, :])
    return np.asarray((apart > 1e-12 * times[-1]).all(axis=1))


def _known_to(name: str) -> float:
    """Return to what relative accuracy the numbers of a drop are known, where that is less than the
    tolerance.

    So it is where friction with history acts on bodies that yield, or that are shaken; and where
    rounding errors grow in an impact of ten contacts, whose restitution changes by up to 7e-10 with
    the last digit of the height.
    """
    if name == "many contacts":
        return 2e-9
    if name.startswith("sloping in series"):
        return 5e-3
    friction = (
        "sliding on a plate",
        "spinning on a plate",
        "shaken along",
        "shaken askew",
        "shaken, sloping",
    )
    return 1e-3 if name.startswith(friction) else 0.0


def _scale(key: str, numbers: Mapping[str, Floats]) -> float:
    """Return the size of a column: of energies that of what was put in, of a component
    that of the largest of its vector.
    """
    if key.endswith("closure_relative"):
        return 1.0
    if key.endswith("_J"):
        return float(np.max(numbers["energy/input_J"]))
    vector = [_AXIS.sub(rf"_{axis}_", key) for axis in "xyz"]
    columns = [numbers[name] for name in {key, *vector} if name in numbers]
    return max(float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) for values in columns)


def _allowance(key: str) -> float:
    """Return how far a column may be off, as a part of its size, times the growth of what the drops
    differ in.

    About 1e-10, where the mathematics is the same; more where the number is known less well.
    """
    if key.endswith("sensitivity"):
        return 1e-4  # of differences
    if "time_of_max" in key:
        return 1e-6  # of a flat top
    if "max_" in key:
        return 1e-7  # read between the nodes of a stretch
    if key.startswith("signal/"):
        return 5e-5  # as of accelerations
    # likewise; the error of the ends goes with the square of that between them
    if key.startswith("history/"):
        if "plate_acceleration" in key:
            return 1e-2  # of modes that follow the force, its second derivative
        return (
            1e-4 if "plate_" in key else 1e-5 if "acceleration" in key or "force" in key else 1e-8
        )
    return 2e-10  # 1e-10 in each of two


def keep(names: list[str]) -> None:
    """Compute the numbers of some drops, or of all, and keep them: of each a row of
    numbers, and the shapes of its columns.
    """
    found = {}
    for name in NAMES:
        columns = numbers(name) if name in names or not names else kept(name)
        found[name] = np.concatenate(
            [np.ravel(values).astype(float) for values in columns.values()]
        )
        found[f"shapes of {name}"] = np.array(
            json.dumps({key: np.shape(values) for key, values in columns.items()})
        )
    np.savez_compressed(KEPT, **found)


if __name__ == "__main__":
    keep(sys.argv[1:])
