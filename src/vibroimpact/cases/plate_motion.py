"""The motion of the plate's supports that a case describes, harmonic or from a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.section import derived
from vibroimpact.dynamics.shaken.statement import PlateMotion
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.arrays import Floats
    from vibroimpact.cases.schema import CaseTable
    from vibroimpact.measurements.table_file import TableFile

_FEWEST, _MOST = 33, 20_000  # samples of a motion; each takes part in every search for a touch
_EQUAL = 1e-3  # of a step: the deviation of rounded times from equal steps
_UNKNOWN = 0.05  # of the range of a motion: the largest error of a sample found from its neighbours
_SEAM = 2.0  # times the largest of these errors within a period: the largest where it repeats
_ROUNDING = 1e-9  # of the largest sample: an error that means nothing


def motion_of(case: CaseTable) -> PlateMotion | None:
    """Return the motion of the plate's supports; None if they are at rest.

    Raises
    ------
    InputError
        If the file can't be read, or does not tell a motion.
    """
    table = case.plate.motion
    return None if table is None else _motion(table)[0]


def motion_length(case: CaseTable) -> float:
    """Return how long the motion of a file lasts [s]; infinite without one, or if it repeats."""
    return np.inf if case.plate.motion is None else _motion(case.plate.motion)[1]


@derived
def _motion(table: MotionTable) -> tuple[PlateMotion, float]:
    """Return a motion, and how long it lasts [s]."""
    size = float(np.linalg.norm(table.direction))
    direction = (table.direction[0] / size, table.direction[1] / size, table.direction[2] / size)
    if table.file is None:
        assert table.amplitude is not None
        assert table.frequency is not None
        return PlateMotion(
            amplitude=table.amplitude,
            frequency=table.frequency,
            phase=table.phase,
            direction=direction,
        ), np.inf
    # here, as few plates are shaken
    from vibroimpact.dynamics.shaken.tabulated import periodic_motion, tabulated_motion

    try:
        step, displacement = _samples(table.file, table.columns, table.repeat)
    except InputError as error:
        raise InputError(error.message, "plate.motion.file") from None
    if table.repeat:
        return periodic_motion(step, displacement, direction), np.inf
    return tabulated_motion(step, displacement, direction), step * (len(displacement) - 1)


def _samples(file: str, columns: str | None, repeat: bool) -> tuple[float, Floats]:
    """Return the step [s] and the displacements [m] of a file, whose columns may be stated;
    `repeat`: of one period.

    Raises
    ------
    InputError
        If the file has neither displacements nor accelerations, its times have no equal steps, it
        has too few samples or too many, a sample can't be guessed from its neighbours, or a period
        does not end where it begins.
    """
    from vibroimpact.dynamics.shaken.tabulated import integrated_twice, integrated_twice_over_period
    from vibroimpact.measurements.table_file import read_table_file

    table = read_table_file(
        file, {"time": "s", "displacement": "m", "acceleration": "m/s^2"}, columns=columns
    )
    missing = (
        "time"
        if "time" not in table.columns
        else "displacement [m], or acceleration [m/s^2]"
        if len(table.columns) == 1
        else ""
    )
    if missing or len(table.columns) > 2:
        words = (
            f"there is no column {missing}"
            if missing
            else "it has displacement and acceleration; leave one of them out"
        )
        raise InputError(f"{file}: {words}")
    name = next(name for name in table.columns if name != "time")
    time, values = table.columns["time"], table.columns[name]
    if not _FEWEST <= len(time) <= _MOST:
        many = (
            f"at least {_FEWEST} are needed"
            if len(time) < _FEWEST
            else f"more than {_MOST:,} can't be followed; keep a part, or fewer a second"
        )
        raise InputError(f"{file}: {len(time)} samples are no motion that can be followed: {many}")
    _check_steps(table, time)
    _check_sampling(table, name, values)
    if repeat:
        _check_seam(table, name, values)
    step = float(time[-1] - time[0]) / (len(time) - 1)
    if name == "displacement":
        return step, values
    return step, integrated_twice_over_period(step, values) if repeat else integrated_twice(
        step, values
    )


def _check_steps(table: TableFile, time: Floats) -> None:
    """Raise InputError unless times rise by equal steps."""
    steps = np.diff(time)
    usual, rounding = float(np.median(steps)), 1e-12 * float(np.abs(time).max())
    odd = np.flatnonzero((steps <= 0.0) | (np.abs(steps - usual) > _EQUAL * usual + rounding))
    if odd.size:
        at = int(odd[0])
        words = (
            "times must rise"
            if steps[at] <= 0.0
            else f"the others come by {usual:.6g} s; a motion has equal steps, and no gaps"
        )
        where = f"{table.path}, line {table.lines[at + 1]}"
        raise InputError(
            f"{where}: the time {time[at + 1]:.9g} s comes {steps[at]:.6g} s after the one "
            f"before, and {words}"
        )


def _check_sampling(table: TableFile, name: str, values: Floats) -> None:
    """Raise InputError if a sample can't be guessed from its neighbours: the values jump,
    or are too coarse for what they show.
    """
    wrong = _off_neighbours(values)
    worst = int(wrong.argmax())
    if wrong[worst] > _UNKNOWN * float(np.ptp(values)):
        words = (
            f"{_off(name, values[worst + 2], wrong[worst])}; it jumps, or the samples are too "
            "coarse for the motion"
        )
        raise InputError(f"{table.path}, line {table.lines[worst + 2]}: {words}")


def _check_seam(table: TableFile, name: str, values: Floats) -> None:
    """Raise InputError if the samples at both ends of a period follow each other less
    evenly than those between.
    """
    usual = max(float(_off_neighbours(values).max()), _ROUNDING * float(np.abs(values).max()))
    wrong = _off_neighbours(np.concatenate([values[-4:], values[:4]]))
    worst = int(wrong.argmax())  # the last two samples, then the first two
    if wrong[worst] > _SEAM * usual:
        row = worst - 2
        words = (
            f"{_off(name, values[row], wrong[worst])} where the period repeats, and at most "
            f"{usual:.3g} {_unit(name)} within it"
        )
        remedy = (
            "give one whole period, without the sample at its end that is the first of the next"
        )
        raise InputError(f"{table.path}, line {table.lines[row]}: {words}; {remedy}")


def _off_neighbours(values: Floats) -> Floats:
    """Return how far samples are from the cubic through four neighbours (samples - 4,)."""
    return np.abs(
        values[2:-2]
        - np.convolve(values, [-1.0 / 6.0, 2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 6.0], mode="valid")
    )


def _off(name: str, value: float, wrong: float) -> str:
    """Return in words how far a sample is from its neighbours."""
    return (
        f"the {name} {value:.6g} {_unit(name)} is {wrong:.3g} {_unit(name)} away from the "
        "curve through its neighbours"
    )


def _unit(name: str) -> str:
    return "m" if name == "displacement" else "m/s^2"
