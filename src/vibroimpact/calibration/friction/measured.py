"""Measured oblique impacts, one a row of a table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.matchable import ALONG_PLATE, DIRECTIONS
from vibroimpact.calibration.observed.observations import Observations, from_table
from vibroimpact.calibration.observed.section import FileTarget
from vibroimpact.calibration.records.impact_table import DEVIATION, check_positive
from vibroimpact.calibration.records.measured_case import check_restitutions
from vibroimpact.calibration.records.measured_file import in_file, known_deviations
from vibroimpact.cases.case import Case
from vibroimpact.errors import InputError
from vibroimpact.measurements.record_file import is_universal
from vibroimpact.measurements.table_file import TableFile, read_table_file

_COLUMNS = {
    "angle": "deg",
    "speed": "m/s",
    "approach_speed": "m/s",
    "approach_velocity_x": "m/s",
    "spin_y_before": "rad/s",
    "restitution": "",
    "restitution_achieved": "",
    "separation_speed": "m/s",
    **{name: quantity.unit for name, quantity in ALONG_PLATE.items()},
    **{f"{name}{DEVIATION}": quantity.unit for name, quantity in ALONG_PLATE.items()},
}
_APPROACH = "angle and speed, or approach_speed (along the normal) and approach_velocity_x"


@dataclass(frozen=True)
class ObliqueImpacts:
    """Measured oblique impacts in the plane of x and the plate's normal.

    Parameters
    ----------
    seen : Observations
        Approach speeds along the normal, and the quantities that are matched by the names of
        `ALONG_PLATE`.
    velocity : array, shape (n,)
        Velocities of the centre along x at first touch [m/s].
    spin : array, shape (n,)
        Angular velocities about y at first touch [rad/s].
    measured : mapping of str to array, shape (n,)
        All measured quantities, matched or not, by the names of `ALONG_PLATE`.
    separation_speed : array, shape (n,), optional
        Measured separation speeds along the normal [m/s].

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> seen = vi.calibration.Observations(
    ...     speeds=np.array([3.0, 2.0]), wanted={"separation_velocity_x": np.array([2.1, 1.6])}
    ... )
    >>> vi.calibration.ObliqueImpacts(
    ...     seen, np.array([3.0, 2.0]), np.zeros(2), seen.wanted
    ... ).angle.round(3).tolist()
    [45.0, 45.0]
    """

    seen: Observations
    velocity: Floats
    spin: Floats
    measured: Mapping[str, Floats]
    separation_speed: Floats | None = None

    @property
    def angle(self) -> Floats:
        """Angles of incidence from the normal [deg]."""
        return np.asarray(np.degrees(np.arctan2(self.velocity, self.seen.speeds)))


def default_weights(measured: Iterable[str]) -> dict[str, float]:
    """Return the quantities that are matched by default.

    They are the first measure of the motion along the plate, and the spin.

    Examples
    --------
    >>> default_weights(["spin_y_after", "rebound_angle", "tangential_restitution"])
    {'tangential_restitution': 1.0, 'spin_y_after': 1.0}
    """
    available = set(measured)
    directions = [name for name in DIRECTIONS if name in available]
    redundant = set(directions[1:])
    return {name: 1.0 for name in ALONG_PLATE if name in available - redundant}


def oblique_impacts_in_file(
    case: Case, target: FileTarget, match: Iterable[str] | None
) -> ObliqueImpacts:
    """Return the oblique impacts of a file.

    `match`: the names of the quantities that are matched, by default those of `default_weights`.

    Raises
    ------
    InputError
        If it can't be read, lacks columns, or has an impossible value; the message names the line.
    """
    if is_universal(target.file) or target.function is not None:
        raise InputError(
            f"oblique impacts are rows of a table, with {_APPROACH}, and what was measured after",
            "target",
        )
    try:
        table = read_table_file(target.file, _COLUMNS, columns=target.columns)
    except InputError as error:
        raise InputError(error.message, "target") from None
    speeds, velocity = _approach(table)
    measured = {name: table.columns[name] for name in ALONG_PLATE if name in table.columns}
    if not measured:
        raise InputError(
            f"{table.path}: what was measured after the impacts is missing; give one of "
            f"{', '.join(ALONG_PLATE)}",
            "target",
        )
    if "tangential_restitution" in measured and not velocity.all():
        line = table.lines[int(np.argmin(np.abs(velocity)))]
        raise InputError(
            f"{table.path}, line {line}: a sphere that does not move along the plate has no "
            "tangential restitution",
            "target",
        )
    if match is None:
        match = default_weights(measured)
    names = tuple(match)
    _check_names(names, measured)
    wanted = {name: measured[name] for name in names}
    for name in names:
        if f"{name}{DEVIATION}" in table.columns:
            check_positive(table, f"{name}{DEVIATION}")
    deviations = known_deviations(table.path, table.columns, names)
    sizes = deviations
    if not sizes:
        # of unknown magnitude: the same for all impacts, and of several quantities the same part of
        # the largest of each
        sizes = {
            name: np.full(len(speeds), np.abs(quantity).max() or 1.0)
            for name, quantity in wanted.items()
        }
    labels = tuple(f"line {line}" for line in table.lines)
    seen = from_table(speeds, wanted, sizes, labels)
    return ObliqueImpacts(
        seen=replace(seen, deviations_known=deviations is not None),
        velocity=velocity,
        spin=table.columns.get("spin_y_before", np.zeros(len(speeds))),
        measured=measured,
        separation_speed=_separation_speed(case, table, speeds, labels),
    )


def _check_names(names: Sequence[str], measured: Mapping[str, Floats]) -> None:
    """Check that quantities to be matched follow from friction, and were measured."""
    others = [name for name in names if name not in ALONG_PLATE]
    if others:
        raise InputError(
            f"friction is not fitted to {', '.join(others)}; match {', '.join(measured)}", "match"
        )
    missing = [name for name in names if name not in measured]
    if missing:
        raise InputError(
            f"the file has no column {', '.join(missing)}; there is {', '.join(measured)}", "match"
        )


def _approach(table: TableFile) -> tuple[Floats, Floats]:
    """Return approach speeds along the normal, and velocities along x [m/s]."""
    columns = table.columns
    if {"angle", "speed"} <= set(columns):
        check_positive(table, "speed")
        steep = np.flatnonzero(np.abs(columns["angle"]) >= 90.0)
        if steep.size:
            row = steep[0]
            raise InputError(
                f"{table.path}, line {table.lines[row]}: angle is {columns['angle'][row]:g} deg; "
                "it is that from the plate's normal, greater than -90 and less than 90 deg",
                "target",
            )
        angle = np.radians(columns["angle"])
        return columns["speed"] * np.cos(angle), columns["speed"] * np.sin(angle)
    if {"approach_speed", "approach_velocity_x"} <= set(columns):
        check_positive(table, "approach_speed")
        return columns["approach_speed"], columns["approach_velocity_x"]
    raise InputError(
        f"{table.path}: the columns {', '.join(columns)} do not give the approach of the "
        f"sphere; it needs {_APPROACH}",
        "target",
    )


def _separation_speed(
    case: Case, table: TableFile, speeds: Floats, labels: tuple[str, ...]
) -> Floats | None:
    """Return the measured separation speeds along the normal [m/s], if there are any."""
    names = ("separation_speed", "restitution", "restitution_achieved")
    name = next((name for name in names if name in table.columns), None)
    if name is None:
        return None
    check_positive(table, name)
    separation_speed = table.columns[name]
    if name != "separation_speed":
        separation_speed = separation_speed * speeds
    wanted = {"separation_speed": separation_speed}
    try:
        check_restitutions(from_table(speeds, wanted, None, labels), case)
    except InputError as error:
        raise in_file(str(table.path), error) from None
    return separation_speed
