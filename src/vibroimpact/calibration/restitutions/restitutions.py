"""Measured restitutions at several approach speeds, and their fits."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.bounces.speed_laws import LINEAR, SpeedLaw, speed_laws
from vibroimpact.calibration.fit.fitting import half_width
from vibroimpact.calibration.records.impact_table import (
    DEVIATION,
    check_counts,
    check_positive,
    is_impact_table,
    name_in_file,
    read_impact_table,
)
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.errors import InputError
from vibroimpact.measurements.table_file import TableFile
from vibroimpact.report.reported import Reported

_MOST = 1.1
"""Largest restitution that noise can explain."""

_MOST_DIGITS = 9
"""Number of decimals that a rounding is sought in."""


@dataclass(frozen=True)
class Restitutions(Reported, reported_in="vibroimpact.calibration.restitutions.report"):
    """Measured coefficients of restitution at n approach speeds, which are taken as exact.

    Parameters
    ----------
    source : str
        The file.
    approach_speed, restitution : array, shape (n,)
        Approach speeds [m/s] and restitutions.
    deviation : array, shape (n,)
        Standard deviation of each restitution; NaN if it is not known.
    count : array, shape (n,)
        The number of impacts of which each restitution is the mean.
    rounding : float
        Step to which the restitutions are rounded, by their digits; or the separation speeds [m/s],
        if these are given.
    laws : list of SpeedLaw
        Fits of the restitution over the approach speed.
    confidence : float
        Confidence level of intervals.
    doubts : tuple of str
        Warnings, as sentences.
    by_speeds : bool
        Whether the table gives separation speeds in place of restitutions.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     with open(f"{folder}/ev.csv", "w") as file:
    ...         _ = file.write("speed [m/s],restitution\\n1,0.81\\n2,0.78\\n4,0.74\\n")
    ...     found = vi.calibration.load_restitutions(f"{folder}/ev.csv")
    >>> found.rounding, found.laws[1](2.0).round(3).item(), found.function.fastest
    (0.01, 0.784, 4.0)
    """

    source: str
    approach_speed: Floats
    restitution: Floats
    deviation: Floats
    count: Floats
    rounding: float
    laws: list[SpeedLaw]
    confidence: float
    doubts: tuple[str, ...]
    by_speeds: bool = False

    @property
    def function(self) -> SpeedFunction | None:
        """The linear fit as a function of the approach speed, as a case takes it.

        None if there is none, or it leaves 0 to 1.
        """
        linear = next((law for law in self.laws if law.name == LINEAR), None)
        if linear is None:
            return None
        function = SpeedFunction(
            (float(linear.coefficients[0]), float(linear.coefficients[1])),
            float(self.approach_speed.min()),
            float(self.approach_speed.max()),
        )
        least, largest = function.extremes
        if least > 0.0 and largest <= 1.0:
            return function
        return None

    @property
    def intervals(self) -> Floats:
        """Confidence intervals of the restitutions, (n, 2); NaN where the deviation is unknown."""
        half = half_width(self.confidence, np.inf) * self.deviation
        return np.stack([self.restitution - half, self.restitution + half], axis=1)


def load_restitutions(
    path: str | PathLike[str], *, confidence: float = 0.95, columns: str | None = None
) -> Restitutions:
    r"""Return the restitutions of a table with a row for each approach speed, and their fits.

    A row has `approach_speed` [m/s] and `restitution`, or `separation_speed` [m/s]; the standard
    deviation of that column, such as `restitution_standard_deviation`, if it is known; and `count`,
    if it is the mean of several impacts: then the standard deviation is that of one impact. Without
    standard deviations the scatter about the fit tells them; what the digits of the table leave
    open is added.

    Parameters
    ----------
    path : path
        The file.
    confidence : float, default 0.95
        Confidence level of intervals.
    columns : str, optional
        The columns in place of a header, in order, such as "speed=m/s,restitution", with - for one
        that is left out.

    Raises
    ------
    InputError
        If the file can't be read, has other columns, or a value is impossible; the message names
        the line.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "ev.csv")
    ...     _ = file.write_text("speed [m/s],restitution,count\n1,0.81,5\n2,0.78,5\n4,0.74,8\n")
    ...     found = vi.calibration.load_restitutions(file)
    >>> [(law.name, law.coefficients.round(3).tolist()) for law in found.laws]
    [('constant', [0.771]), ('linear', [0.83, -0.023]), ('power', [0.812, -0.066])]
    """
    table = read_impact_table(path, columns=columns)
    if not is_impact_table(table.columns):
        raise InputError(
            f"{path}: it has no approach_speed [m/s] with a restitution or a separation_speed [m/s]"
        )
    quantities = table.columns
    for name in quantities:
        if name != "count":
            check_positive(table, name)
    check_counts(table)
    speed = quantities["approach_speed"]
    count = quantities.get("count", np.ones(len(table.lines)))
    by_speeds = "restitution" not in quantities
    measured = "separation_speed" if by_speeds else "restitution"
    restitution = quantities[measured]
    if by_speeds:
        restitution = restitution / speed
    _check_height(table, restitution, by_speeds=by_speeds)
    _check_deviations(table, measured)
    rounding = rounding_step(quantities[measured])
    known = quantities.get(f"{measured}{DEVIATION}")
    # derivative of the restitution by what was measured
    slope = np.ones(len(speed))
    if by_speeds:
        slope = 1.0 / speed
    deviation = np.full(len(speed), np.nan)
    if known is not None:  # of one impact; a row is the mean of several
        deviation = slope * known / np.sqrt(count)
    # that of a uniform distribution over a step
    rounding_variance = (slope * rounding) ** 2 / 12.0
    variance = np.nan_to_num(deviation) ** 2 + rounding_variance
    laws = speed_laws(speed, restitution, np.diag(variance), count)
    return Restitutions(
        source=str(path),
        approach_speed=speed,
        restitution=restitution,
        deviation=deviation,
        count=count,
        rounding=rounding,
        laws=laws,
        confidence=confidence,
        doubts=_doubts(table, restitution, laws),
        by_speeds=by_speeds,
    )


def _check_deviations(table: TableFile, measured: str) -> None:
    """Check that standard deviations are those of the measured column."""
    other = "separation_speed"
    if measured == "separation_speed":
        other = "restitution"
    if f"{other}{DEVIATION}" in table.columns:
        has = name_in_file(table, f"{other}{DEVIATION}")
        column = name_in_file(table, measured)
        raise InputError(
            f"{table.path}: it has {has}, but restitutions are those of {column}; give "
            f"{column}{DEVIATION}"
        )


def rounding_step(values: Floats) -> float:
    """Return the step to which values are rounded; at least 1e-9.

    It is the largest power of ten of which all are multiples.

    Examples
    --------
    >>> rounding_step(np.array([0.81, 0.8])), rounding_step(np.array([0.8125, 1.0]))
    (0.01, 0.0001)
    """
    for decimals in range(_MOST_DIGITS):
        shifted = values * 10.0**decimals
        tolerance = 1e-9 * np.maximum(np.abs(shifted), 1.0)
        if np.all(np.abs(shifted - np.round(shifted)) <= tolerance):
            return float(10.0**-decimals)
    return float(10.0**-_MOST_DIGITS)


def _check_height(table: TableFile, restitution: Floats, *, by_speeds: bool) -> None:
    """Raise InputError if a restitution is higher than noise makes it."""
    wrong = np.flatnonzero(restitution > _MOST)
    if not wrong.size:
        return
    row = wrong[0]
    if by_speeds:
        hint = "look at the speeds and their units"
    elif restitution[row] > 10.0:
        hint = f"if it is in per cent, name its unit: {name_in_file(table, 'restitution')} [%]"
    else:
        hint = "look at the value"
    raise InputError(
        f"{table.path}, line {table.lines[row]}: the restitution is {restitution[row]:.4g}, more "
        f"than {_MOST:g}, which is not taken for noise; {hint}"
    )


def _doubts(table: TableFile, restitution: Floats, laws: list[SpeedLaw]) -> tuple[str, ...]:
    doubts = list(table.doubts)
    if np.any(restitution > 1.0):
        largest = int(np.argmax(restitution))
        doubts.append(
            f"the restitution in line {table.lines[largest]} is {restitution[largest]:.4g}: more "
            "than 1 gains energy; a case takes 1 at most"
        )
    if len(laws) == 1:
        doubts.append(
            "of fewer than three restitutions, or at one speed, nothing tells a dependence on "
            "the speed from scatter: only a constant is fitted"
        )
    return tuple(doubts)
