"""Measured restitutions at several approach speeds, and their fits."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.bounces.speed_laws import LINEAR, SpeedLaw, speed_laws
from vibroimpact.calibration.fitting import half_width
from vibroimpact.calibration.impact_table import (
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


@dataclass(frozen=True)
class Restitutions(Reported, reported_in="vibroimpact.calibration.restitutions.report"):
    """Restitutions at n approach speeds, which are taken as exact.

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
    ...     found = vi.read_restitutions(f"{folder}/ev.csv")
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
        """The linear fit as a function of the approach speed, as a case takes it; None if
        there is none, or it leaves 0 to 1.
        """
        linear = [law for law in self.laws if law.name == LINEAR]
        if not linear:
            return None
        ends = float(self.approach_speed.min()), float(self.approach_speed.max())
        found = SpeedFunction(
            (float(linear[0].coefficients[0]), float(linear[0].coefficients[1])), *ends
        )
        return found if found.extremes[0] > 0.0 and found.extremes[1] <= 1.0 else None

    @property
    def intervals(self) -> Floats:
        """Confidence intervals of the restitutions, (n, 2); NaN where the deviation is
        not known.
        """
        half = half_width(self.confidence, np.inf) * self.deviation
        return np.stack([self.restitution - half, self.restitution + half], axis=1)


def read_restitutions(
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
    ...     found = vi.read_restitutions(file)
    >>> [(law.name, law.coefficients.round(3).tolist()) for law in found.laws]
    [('constant', [0.771]), ('linear', [0.83, -0.023]), ('power', [0.812, -0.066])]
    """
    table = read_impact_table(path, columns=columns)
    if not is_impact_table(table.columns):
        raise InputError(
            f"{path}: it has no approach_speed [m/s] with a restitution or a separation_speed [m/s]"
        )
    given = table.columns
    for name in given:
        if name != "count":
            check_positive(table, name)
    check_counts(table)
    speed, count = given["approach_speed"], given.get("count", np.ones(len(table.lines)))
    by_speeds = "restitution" not in given
    restitution = given["separation_speed"] / speed if by_speeds else given["restitution"]
    _check_height(table, restitution, by_speeds=by_speeds)
    measured, other = (
        ("separation_speed", "restitution") if by_speeds else ("restitution", "separation_speed")
    )
    if f"{other}{DEVIATION}" in given:
        has, of = (name_in_file(table, name) for name in (f"{other}{DEVIATION}", measured))
        raise InputError(
            f"{path}: it has {has}, but restitutions are those of {of}; give {of}{DEVIATION}"
        )
    known = given.get(f"{measured}{DEVIATION}")
    rounding = rounding_step(given["separation_speed"] if by_speeds else restitution)
    scale = 1.0 / speed if by_speeds else np.ones(len(speed))
    deviation = np.full(len(speed), np.nan) if known is None else scale * known / np.sqrt(count)
    variance = np.nan_to_num(deviation) ** 2 + (scale * rounding) ** 2 / 12.0
    laws = speed_laws(speed, restitution, np.diag(variance), count)
    doubts = _doubts(table, restitution, laws)
    return Restitutions(
        str(path),
        speed,
        restitution,
        deviation,
        count,
        rounding,
        laws,
        confidence,
        doubts,
        by_speeds,
    )


def rounding_step(values: Floats) -> float:
    """Return the largest power of ten of which all values are multiples: the step to which they are
    rounded; at least 1e-9.

    Examples
    --------
    >>> rounding_step(np.array([0.81, 0.8])), rounding_step(np.array([0.8125, 1.0]))
    (0.01, 0.0001)
    """
    for places in range(_MOST_DIGITS):
        shifted = values * 10.0**places
        if np.all(np.abs(shifted - np.round(shifted)) <= 1e-9 * np.maximum(np.abs(shifted), 1.0)):
            return float(10.0**-places)
    return float(10.0**-_MOST_DIGITS)


def _check_height(table: TableFile, restitution: Floats, *, by_speeds: bool) -> None:
    """Raise InputError if a restitution is higher than noise makes it."""
    wrong = np.flatnonzero(restitution > _MOST)
    if wrong.size:
        value = restitution[wrong[0]]
        words = f"the restitution is {value:.4g}, more than {_MOST:g}, which is not taken for noise"
        hint = "look at the speeds and their units" if by_speeds else "look at the value"
        if value > 10.0 and not by_speeds:
            hint = f"if it is in per cent, name its unit: {name_in_file(table, 'restitution')} [%]"
        raise InputError(f"{table.path}, line {table.lines[wrong[0]]}: {words}; {hint}")


def _doubts(table: TableFile, restitution: Floats, laws: list[SpeedLaw]) -> tuple[str, ...]:
    found = list(table.doubts)
    above = np.flatnonzero(restitution > 1.0)
    if above.size:
        worst = int(np.argmax(restitution))
        words = (
            f"the restitution in line {table.lines[worst]} is {restitution[worst]:.4g}: more "
            "than 1 gains energy"
        )
        found.append(f"{words}; a case takes 1 at most")
    if len(laws) == 1:
        words = (
            "of fewer than three restitutions, or at one speed, nothing tells a dependence on "
            "the speed from scatter"
        )
        found.append(f"{words}: only a constant is fitted")
    return tuple(found)
