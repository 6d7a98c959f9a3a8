"""Measurements in a file: one impact per row, rebound heights, or a record: position,
force, the sphere's acceleration, bounces heard.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.bounce_record import impacts_in_bounces
from vibroimpact.calibration.evaluate_measurement import Measurement, speed_at_touch
from vibroimpact.calibration.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.force_record import impacts_in_force
from vibroimpact.calibration.impact_table import (
    DEVIATION,
    ImpactTable,
    check_counts,
    check_positive,
    name_in_file,
    read_impact_table,
)
from vibroimpact.calibration.matchable import MATCHABLE
from vibroimpact.calibration.measured_case import check_restitutions, heights_measurement
from vibroimpact.calibration.noise import scaled
from vibroimpact.calibration.observations import Observations, from_table
from vibroimpact.calibration.position_record import impacts_in_position
from vibroimpact.calibration.section import FileTarget
from vibroimpact.cases.case import Case
from vibroimpact.cases.pair import contact_pair
from vibroimpact.cases.rigid_problem import mass_of_sphere
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.record_file import (
    SPHERE_ACCELERATION,
    is_universal,
    read_universal_record,
)
from vibroimpact.measurements.recorded_table import RecordedChannel, recorded_channels, rising
from vibroimpact.measurements.table_file import factor_to_si, header_of
from vibroimpact.measurements.table_layout import Layout
from vibroimpact.signals.bounces.find import find_bounces
from vibroimpact.signals.one_record import one_record
from vibroimpact.signals.reading.coded_sound import FORMATS as CODED_SOUND
from vibroimpact.signals.reading.equal_steps import behind_decimals

_MATCHABLE = {name: quantity.unit for name, quantity in MATCHABLE.items()}
_COLUMNS = {
    "time": "s",
    "position": "m",
    "force": "N",
    "sphere_acceleration": "m/s^2",
    "acceleration": "m/s^2",
    "approach_speed": "m/s",
    "restitution": "",
    "restitution_achieved": "",
    "rebound_height": "m",
    "count": "",
    **_MATCHABLE,
    **{
        f"{name}{DEVIATION}": unit
        for name, unit in {"restitution": "", "rebound_height": "m", **_MATCHABLE}.items()
    },
}
_HEARD = (".wav", *CODED_SOUND, ".nc", ".nc4", ".h5")
"""Endings of files that are records of sound or vibration, in which bounces are heard."""

_SAME = 1e-6
"""Difference, as a part of the range of a record, within which two samples at one time
are the same.
"""

_RECORDED = ("position", "force", "sphere_acceleration")
_KINDS = (
    "approach_speed with restitution, separation_speed, rebound_height, max_force, "
    "max_indentation or duration; rebound_height; "
    "or a record of time with position, force or sphere_acceleration"
)
_WHOSE = (
    "only the acceleration of the sphere determines a rebound: call the column "
    "sphere_acceleration (upwards, measured in the sphere), "
    "mass times which is the force. That of the plate does not; give rebound heights or "
    "restitutions instead"
)


class Recorded(NamedTuple):
    """A record: times [s]; the available columns of position [m], force [N] and acceleration of the
    sphere [m/s^2] by name; line numbers of the samples, None for a universal file.
    """

    time: Floats
    values: dict[str, Floats]
    lines: Sequence[int] | None


def file_measurement(case: Case, target: FileTarget, by_rebound: bool) -> Measurement:
    """Return the measurement in a file; if only the rebound is matched, position takes precedence
    over force.

    Raises
    ------
    InputError
        If it can't be read or contains no impacts; the message names the line.
    """
    if target.channel is not None or Path(target.file).suffix.lower() in _HEARD:
        return _naming_file(target.file, _heard_measurement(case, target))
    if target.contact_duration is not None:
        raise InputError(
            "it applies to a record of bounces; give its channel, or leave this out",
            "target.contact_duration",
        )
    if is_universal(target.file):
        if target.columns is not None:
            raise InputError(
                "a universal file has functions, and no columns; leave this out", "target.columns"
            )
        found = read_universal_record(target.file, target.function, by_rebound)
        if found.quantity == "acceleration" and found.identification != SPHERE_ACCELERATION:
            raise InputError(
                f'{target.file}: "{found.identification}": in a table, {_WHOSE}', "target"
            )
        column = "sphere_acceleration" if found.quantity == "acceleration" else found.quantity
        return _naming_file(
            target.file,
            _record_measurement(
                case, Recorded(found.time, {column: found.values}, None), by_rebound
            ),
        )
    if target.function is not None:
        raise InputError(
            "only a universal file has functions; the columns of a table are named in its header",
            "target.function",
        )
    names = _names(target)
    if set(_RECORDED) & names and not {"approach_speed", "rebound_height"} & names:
        return _naming_file(target.file, _table_record_measurement(case, target, by_rebound))
    table = _table(target)
    columns = table.columns
    if "approach_speed" in columns:
        return _naming_file(target.file, _rows_measurement(case, table), table.doubts)
    try:
        if "rebound_height" in columns:
            if table.empty:
                words = (
                    "the line is empty; rebound heights are those of one impact after another, "
                    "and none can be missing"
                )
                raise InputError(f"line {table.empty[0]}: {words}")
            labels = tuple(f"line {line}" for line in table.lines)
            deviation = columns.get(f"rebound_height{DEVIATION}")
            return _naming_file(
                target.file,
                heights_measurement(case, columns["rebound_height"], deviation, labels),
                table.doubts,
            )
        if "acceleration" in columns:
            raise InputError(_WHOSE)
        raise InputError(
            f"the columns {', '.join(columns)} do not describe impacts; a file has {_KINDS}"
        )
    except InputError as error:
        raise in_file(target.file, error) from None


def _names(target: FileTarget) -> set[str]:
    """Return the names of the columns of a table; none if its header can't be read, which
    its reader reports.
    """
    try:
        return {name_and_unit(cell)[0] for cell in header_of(target.file, target.columns)}
    except InputError:
        return set()


def _table_record_measurement(case: Case, target: FileTarget, by_rebound: bool) -> Measurement:
    """Return the measurement of a record in a table: of its position, force or the
    sphere's acceleration, with the times of this column.
    """
    doubts: list[str] = []
    try:
        channels = recorded_channels(target.file, _unit_of, doubts, target.columns)
    except InputError as error:
        raise InputError(_told(error), "target") from None
    found: dict[str, RecordedChannel] = {}
    for channel in channels:
        name = name_and_unit(channel.cell)[0]
        if name in found:
            unit = name_and_unit(channel.cell)[1] or channel.unit
            words = (
                f'several columns are called "{name}"; state them all by columns = '
                f'"time=s,-,{name}={unit}", with - for one left out'
            )
            raise in_file(target.file, InputError(words))
        found[name] = channel
    channel = found[_evaluated(found, by_rebound)]
    try:
        rises = rising(channel)
    except InputError as error:
        raise in_file(target.file, error) from None
    doubts += [f"{channel.name}: {doubt}" for doubt in (*channel.doubts, *_without(channel, rises))]
    record = Recorded(
        channel.time[rises],
        {channel.name: channel.value[rises]},
        np.asarray(channel.lines)[rises].tolist(),
    )
    return _naming_file(target.file, _record_measurement(case, record, by_rebound), doubts)


def _unit_of(layout: Layout, cell: str) -> tuple[float, str] | None:
    name, unit = name_and_unit(cell)
    return (
        (factor_to_si(layout, cell, unit, _COLUMNS[name]), _COLUMNS[name])
        if name in _RECORDED
        else None
    )


def _evaluated(names: Iterable[str], by_rebound: bool) -> str:
    """Return which quantity of a record is evaluated; if only the rebound is matched, the
    position.
    """
    there = [name for name in _RECORDED if name in names]
    return (
        "position"
        if "position" in there and (by_rebound or len(there) == 1)
        else next(name for name in there if name != "position")
    )


def _without(channel: RecordedChannel, rises: Bools) -> list[str]:
    """Return what a record lacks, as sentences: samples that are missing, and others at
    the time of the one before.
    """
    told, missing = [], channel.missing
    if missing:
        have, them = (
            ("have no number, the first", "them") if len(missing) > 1 else ("has no number,", "it")
        )
        told.append(
            f"{len(missing)} of its samples {have} in line {missing[0]}: the record is "
            f"evaluated without {them}"
        )
    change = np.append(0.0, np.abs(np.diff(channel.value)))
    other = np.flatnonzero(~rises & (change > _SAME * float(np.ptp(channel.value))))
    if other.size:
        line = channel.lines[int(other[0])]
        have, first = (
            ("samples have", f"the first in line {line}: they are")
            if other.size > 1
            else ("sample has", f"in line {line}: it is")
        )
        told.append(
            f"{other.size} {have} the time of the one before and another value, {first} left out"
        )
    return told


def _heard_measurement(case: Case, target: FileTarget) -> Measurement:
    """Return the measurement of a record in which bounces are heard."""
    if target.function is not None:
        raise InputError("the record is selected by its channel; leave this out", "target.function")
    gravity = case.drop.gravity
    if gravity == 0.0:
        raise InputError("without gravity a sphere rises for ever, and does not bounce", "target")
    try:
        bounces = find_bounces(
            one_record(target.file, target.channel, target.columns), target.contact_duration or 0.0
        )
    except InputError as error:
        raise in_file(target.file, error) from None

    def evaluated(flights: Flights | None) -> Observations:
        return impacts_in_bounces(
            bounces, gravity=gravity, first_speed=speed_at_touch(case, flights), flights=flights
        )

    return Measurement(evaluated, gravity * float(bounces.flight.max()) ** 2 / 8.0)


def _record_measurement(case: Case, record: Recorded, by_rebound: bool) -> Measurement:
    time, values, lines = record
    if _evaluated(values, by_rebound) == "position":
        if case.drop.gravity == 0.0:
            raise InputError(
                "without gravity a sphere rises for ever; a record of its position does not "
                "determine a rebound"
            )
        radius, position, pair = case.sphere.radius, values["position"], contact_pair(case)
        # of an elastic impact at 1 m/s
        depth = (1.25 * pair.effective_mass / pair.hertz_stiffness) ** 0.4
        doubts: tuple[str, ...] = ()
        if (rounded := behind_decimals(time)) is not None:
            time, last = rounded
            doubts = (
                f"the times are rounded to {last:g} s: they are replaced by times in equal steps",
            )
        sphere = {
            "radius": radius,
            "gravity": case.drop.gravity,
            "contact_duration": HERTZ_TIME * float(depth),
        }

        def in_position(flights: Flights | None) -> Observations:
            first_speed = speed_at_touch(case, flights)
            found = impacts_in_position(
                time, position, **sphere, first_speed=first_speed, lines=lines, flights=flights
            )
            return replace(found, doubts=(*doubts, *found.doubts))

        return Measurement(in_position, float(np.ptp(position)))
    mass = float(contact_pair(case).effective_mass)
    force = (
        values["force"]
        if "force" in values
        else mass_of_sphere(case) * values["sphere_acceleration"]
    )

    def in_force(flights: Flights | None) -> Observations:
        given = {
            "mass": mass,
            "gravity": case.drop.gravity,
            "first_speed": speed_at_touch(case, flights),
        }
        return impacts_in_force(time, force, **given, lines=lines, flights=flights)

    return Measurement(in_force, case.drop.gravity * float(time[-1] - time[0]) ** 2 / 8.0)


def _rows_measurement(case: Case, table: ImpactTable) -> Measurement:
    """Return the measurement of a file with one impact per row."""
    columns, speeds = dict(table.columns), table.columns["approach_speed"]
    if "restitution_achieved" in columns:  # name of the column in the impact table of a result
        columns.setdefault("restitution", columns["restitution_achieved"])
    for name in ("approach_speed", *(name for name in columns if name.endswith(DEVIATION))):
        check_positive(table, name)
    check_counts(table)
    for ending in ("", DEVIATION):  # as separation speed, by the definition of restitution
        if f"restitution{ending}" in columns:
            columns.setdefault(
                f"separation_speed{ending}", columns[f"restitution{ending}"] * speeds
            )
    wanted = {name: columns[name] for name in MATCHABLE if name in columns}
    if not wanted:
        raise InputError(
            f"{table.path}: beside approach_speed a column is missing; give one of "
            f"restitution, {', '.join(MATCHABLE)}",
            "target",
        )
    for name in wanted:
        check_positive(
            table,
            next(
                column
                for column in (name, "restitution", "restitution_achieved")
                if column in table.columns
            ),
        )
    by_restitution = (
        {}
        if "separation_speed" in table.columns
        else {"separation_speed": name_in_file(table, "restitution")}
    )
    deviations = known_deviations(table.path, columns, wanted, {**by_restitution, **table.written})
    # of unknown magnitude: the same relative noise for all; less for the mean of several
    sizes = {
        name: size / np.sqrt(columns.get("count", 1.0))
        for name, size in (deviations or {k: np.abs(v) for k, v in wanted.items()}).items()
    }
    labels, radius, gravity = (
        tuple(f"line {line}" for line in table.lines),
        case.sphere.radius,
        case.drop.gravity,
    )

    def evaluated(flights: Flights | None) -> Observations:
        seen = replace(
            from_table(speeds, wanted, sizes, labels), deviations_known=deviations is not None
        )
        if (
            "rebound_height" in wanted
            and gravity > 0.0
            and np.all(wanted["rebound_height"] > radius)
        ):
            rises, scales = vacuum_height(
                flights or VacuumFlights(gravity), wanted["rebound_height"] - radius
            )
            noise = {**seen.noise, "rebound_height": scaled(scales, seen.noise["rebound_height"])}
            seen = replace(seen, wanted={**wanted, "rebound_height": radius + rises}, noise=noise)
        if "restitution" in columns:
            check_restitutions(seen, case)
        return seen

    return Measurement(evaluated, float(np.max(wanted.get("rebound_height", radius))) - radius)


def known_deviations(
    path: Path,
    columns: Mapping[str, Floats],
    wanted: Iterable[str],
    written: Mapping[str, str] | None = None,
) -> dict[str, Floats] | None:
    """Return the standard deviations of quantities, which all have a column of them or none; None
    without.

    `written`: the names that quantities have in the file, where they have others.

    Raises
    ------
    InputError
        If only some have one.
    """
    known = {name: f"{name}{DEVIATION}" in columns for name in wanted}
    if not any(known.values()):
        return None
    for name, has in known.items():
        if not has:
            one = next(other for other, there in known.items() if there)
            has_one, has_none = (
                (written or {}).get(quantity, quantity) for quantity in (one, name)
            )
            raise InputError(
                f"{path}: {has_one} has a standard deviation and {has_none} has none; give "
                f"{has_none}{DEVIATION}",
                "target",
            )
    return {name: columns[f"{name}{DEVIATION}"] for name in known}


def _table(target: FileTarget) -> ImpactTable:
    try:
        return read_impact_table(target.file, _COLUMNS, target.columns)
    except InputError as error:
        raise InputError(_told(error), "target") from None


def _told(error: InputError) -> str:
    """Return the message of an error, with what else to give where an acceleration is
    given in place of a force or a position.
    """
    if "acceleration; expected a " not in error.message:
        return error.message
    what = error.message.partition(" (a number in ")[0]  # without the hint how to write a force
    return f"{what}. In a record {_WHOSE}"


def _naming_file(file: str, measurement: Measurement, doubts: Sequence[str] = ()) -> Measurement:
    """Return the measurement with error messages that name the file, and with the doubts
    about the file.
    """

    def evaluated(flights: Flights | None) -> Observations:
        try:
            found = measurement.evaluated(flights)
        except InputError as error:
            raise in_file(file, error) from None
        return replace(found, doubts=(*doubts, *found.doubts)) if doubts else found

    return Measurement(evaluated, measurement.highest)


def in_file(file: str, error: InputError) -> InputError:
    """Return an error with a message that names the file."""
    if file in error.message:
        return InputError(error.message, "target")
    between = ", " if error.message.startswith("line ") else ": "
    return InputError(f"{file}{between}{error.message}", "target")
