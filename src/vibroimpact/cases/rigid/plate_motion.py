"""The motion of the plate's supports that a case describes, harmonic or from a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.section import derived
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.arrays import Floats
    from vibroimpact.cases.sections.schema import CaseTable
    from vibroimpact.measurements.table_file import TableFile

# samples of a motion; each takes part in every search for a touch
_FEWEST = 33
_MOST = 20_000
_EQUAL = 1e-3  # of a step: the deviation of rounded times from equal steps
_LARGEST_ERROR = 0.05  # of a sample found from its neighbours, over the range of the motion
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
    if case.plate.motion is None:
        return np.inf
    _, length = _motion(case.plate.motion)
    return length


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
    from vibroimpact.dynamics.statement.tabulated_motion import periodic_motion, tabulated_motion

    try:
        step, displacement = _samples(table.file, table.columns, table.repeat)
    except InputError as error:
        raise InputError(error.message, "plate.motion.file") from None
    if table.repeat:
        return periodic_motion(step, displacement, direction), np.inf
    return tabulated_motion(step, displacement, direction), step * (len(displacement) - 1)


def _samples(file: str, columns: str | None, repeat: bool) -> tuple[float, Floats]:
    """Return the step [s] and the displacements [m] of a file.

    Its columns may be stated. With `repeat` the file is of one period.

    Raises
    ------
    InputError
        If the file has neither displacements nor accelerations, its times have no equal steps, it
        has too few samples or too many, a sample can't be guessed from its neighbours, or a period
        does not end where it begins.
    """
    from vibroimpact.dynamics.statement.tabulated_motion import (
        integrated_twice,
        integrated_twice_over_period,
    )
    from vibroimpact.measurements.table_file import read_table_file

    table = read_table_file(
        file, {"time": "s", "displacement": "m", "acceleration": "m/s^2"}, columns=columns
    )
    name = _displacement_or_acceleration(file, table)
    time = table.columns["time"]
    values = table.columns[name]
    if not _FEWEST <= len(time) <= _MOST:
        reason = f"at least {_FEWEST} are needed"
        if len(time) > _MOST:
            reason = f"more than {_MOST:,} can't be followed; keep a part, or fewer a second"
        raise InputError(
            f"{file}: {len(time)} samples are no motion that can be followed: {reason}"
        )
    _check_steps(table, time)
    _check_sampling(table, name, values)
    if repeat:
        _check_seam(table, name, values)
    step = float(time[-1] - time[0]) / (len(time) - 1)
    if name == "displacement":
        return step, values
    if repeat:
        return step, integrated_twice_over_period(step, values)
    return step, integrated_twice(step, values)


def _displacement_or_acceleration(file: str, table: TableFile) -> str:
    """Return the name of the column beside the time.

    Raises
    ------
    InputError
        If there is no time, or not one other column.
    """
    if "time" not in table.columns:
        raise InputError(f"{file}: there is no column time")
    names = [name for name in table.columns if name != "time"]
    if not names:
        raise InputError(f"{file}: there is no column displacement [m], or acceleration [m/s^2]")
    if len(names) > 1:
        raise InputError(f"{file}: it has displacement and acceleration; leave one of them out")
    return names[0]


def _check_steps(table: TableFile, time: Floats) -> None:
    """Raise InputError unless times rise by equal steps."""
    steps = np.diff(time)
    usual = float(np.median(steps))
    rounding = 1e-12 * float(np.abs(time).max())
    unequal = np.flatnonzero((steps <= 0.0) | (np.abs(steps - usual) > _EQUAL * usual + rounding))
    if not unequal.size:
        return
    row = int(unequal[0])
    demand = f"the others come by {usual:.6g} s; a motion has equal steps, and no gaps"
    if steps[row] <= 0.0:
        demand = "times must rise"
    raise InputError(
        f"{table.path}, line {table.lines[row + 1]}: the time {time[row + 1]:.9g} s comes "
        f"{steps[row]:.6g} s after the one before, and {demand}"
    )


def _check_sampling(table: TableFile, name: str, values: Floats) -> None:
    """Raise InputError if a sample can't be guessed from its neighbours.

    Then the values jump, or are too coarse for what they show.
    """
    errors = _interpolation_errors(values)
    worst = int(errors.argmax())
    if errors[worst] > _LARGEST_ERROR * float(np.ptp(values)):
        row = worst + 2
        raise InputError(
            f"{table.path}, line {table.lines[row]}: "
            f"{_error_in_words(name, values[row], errors[worst])}; it jumps, or the samples are "
            "too coarse for the motion"
        )


def _check_seam(table: TableFile, name: str, values: Floats) -> None:
    """Raise InputError unless a period ends where it begins.

    The samples at both ends of it must follow each other as evenly as those between.
    """
    usual = max(float(_interpolation_errors(values).max()), _ROUNDING * float(np.abs(values).max()))
    errors = _interpolation_errors(np.concatenate([values[-4:], values[:4]]))
    worst = int(errors.argmax())  # the last two samples, then the first two
    if errors[worst] > _SEAM * usual:
        row = worst - 2
        raise InputError(
            f"{table.path}, line {table.lines[row]}: "
            f"{_error_in_words(name, values[row], errors[worst])} where the period repeats, and "
            f"at most {usual:.3g} {_unit(name)} within it; "
            "give one whole period, without the sample at its end that is the first of the next"
        )


def _interpolation_errors(values: Floats) -> Floats:
    """Return how far samples are from the cubic through four neighbours (samples - 4,)."""
    # Lagrange's weights of the neighbours at -2, -1, 1 and 2 steps
    weights = [-1.0 / 6.0, 2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 6.0]
    return np.abs(values[2:-2] - np.convolve(values, weights, mode="valid"))


def _error_in_words(name: str, value: float, error: float) -> str:
    """Return in words how far a sample is from its neighbours."""
    return (
        f"the {name} {value:.6g} {_unit(name)} is {error:.3g} {_unit(name)} away from the "
        "curve through its neighbours"
    )


def _unit(name: str) -> str:
    return "m" if name == "displacement" else "m/s^2"
