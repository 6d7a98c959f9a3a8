"""Measurements in a file: one impact per row, rebound heights, or a record.

A record is one of position, of force, of the sphere's acceleration, or one in which bounces are
heard.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.observed.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.observed.matchable import MATCHABLE
from vibroimpact.calibration.observed.noise import scaled
from vibroimpact.calibration.observed.observations import Observations, from_table
from vibroimpact.calibration.observed.section import FileTarget
from vibroimpact.calibration.records.bounce_record import impacts_in_bounces
from vibroimpact.calibration.records.evaluate_measurement import Measurement, speed_at_touch
from vibroimpact.calibration.records.force_record import impacts_in_force
from vibroimpact.calibration.records.impact_table import (
    DEVIATION,
    ImpactTable,
    check_counts,
    check_positive,
    name_in_file,
    read_impact_table,
)
from vibroimpact.calibration.records.measured_case import check_restitutions, heights_measurement
from vibroimpact.calibration.records.position_record import impacts_in_position
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import mass_of_sphere
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.errors import InputError
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.record_file import (
    SPHERE_ACCELERATION,
    is_universal,
    read_universal_record,
)
from vibroimpact.measurements.recorded_table import RecordedChannel, recorded_channels, rising
from vibroimpact.measurements.table_file import factor_to_si, header_of, layout_of
from vibroimpact.measurements.table_layout import Layout
from vibroimpact.signals.bounces.find import find_bounces
from vibroimpact.signals.reading.coded_sound import FORMATS as CODED_SOUND
from vibroimpact.signals.reading.equal_steps import behind_decimals
from vibroimpact.signals.reading.one_record import one_record

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
_SOUND_ENDINGS = (".wav", *CODED_SOUND, ".nc", ".nc4", ".h5")
"""Endings of files that are records of sound or vibration, in which bounces are heard."""

_SAME = 1e-6
"""Difference, as a fraction of the range of a record, within which two samples at one time are the
same.
"""

_RECORDED = ("position", "force", "sphere_acceleration")
_DESCRIPTIONS = (
    "approach_speed with restitution, separation_speed, rebound_height, max_force, "
    "max_indentation or duration; rebound_height; "
    "or a record of time with position, force or sphere_acceleration"
)
_ACCELERATION_OF_SPHERE = (
    "only the acceleration of the sphere determines a rebound: call the column "
    "sphere_acceleration (upwards, measured in the sphere), "
    "mass times which is the force. That of the plate does not; give rebound heights or "
    "restitutions instead"
)


class Recorded(NamedTuple):
    """A record.

    Times [s]; the available columns of position [m], force [N] and acceleration of the sphere
    [m/s^2] by name; line numbers of the samples, None for a universal file.
    """

    time: Floats
    values: dict[str, Floats]
    lines: Sequence[int] | None


def file_measurement(case: Case, target: FileTarget, by_rebound: bool) -> Measurement:
    """Return the measurement in a file.

    If only the rebound is matched, position takes precedence over force.

    Raises
    ------
    InputError
        If it can't be read or contains no impacts; the message names the line.
    """
    if target.channel is not None or Path(target.file).suffix.lower() in _SOUND_ENDINGS:
        return _naming_file(target.file, _bounce_measurement(case, target))
    if target.contact_duration is not None:
        raise InputError(
            "it applies to a record of bounces; give its channel, or leave this out",
            "target.contact_duration",
        )
    if is_universal(target.file):
        return _universal_measurement(case, target, by_rebound)
    if target.function is not None:
        raise InputError(
            "only a universal file has functions; the columns of a table are named in its header",
            "target.function",
        )
    names = _column_names(target)
    if set(_RECORDED) & names and not {"approach_speed", "rebound_height"} & names:
        return _naming_file(target.file, _table_record_measurement(case, target, by_rebound))
    table = _table(target)
    if "approach_speed" in table.columns:
        return _naming_file(target.file, _rows_measurement(case, table), table.doubts)
    try:
        if "rebound_height" in table.columns:
            measurement = _heights_in_table(case, table)
            return _naming_file(target.file, measurement, table.doubts)
        if "acceleration" in table.columns:
            raise InputError(_ACCELERATION_OF_SPHERE)
        layout = layout_of(target.file, target.columns)
        raise InputError(
            f"the columns {', '.join(table.columns)} do not describe impacts; a file has "
            f"{_DESCRIPTIONS}; {layout.understood}. Name them so, or state them beside file: "
            'columns = "time=s,position=m"'
        )
    except InputError as error:
        raise in_file(target.file, error) from None


def _universal_measurement(case: Case, target: FileTarget, by_rebound: bool) -> Measurement:
    """Return the measurement of a record in a universal file."""
    if target.columns is not None:
        raise InputError(
            "a universal file has functions, and no columns; leave this out", "target.columns"
        )
    function = read_universal_record(target.file, target.function, by_rebound)
    column: str = function.quantity
    if column == "acceleration":
        if function.identification != SPHERE_ACCELERATION:
            raise InputError(
                f'{target.file}: "{function.identification}": in a table, '
                f"{_ACCELERATION_OF_SPHERE}",
                "target",
            )
        column = "sphere_acceleration"
    record = Recorded(function.time, {column: function.values}, None)
    return _naming_file(target.file, _record_measurement(case, record, by_rebound))


def _heights_in_table(case: Case, table: ImpactTable) -> Measurement:
    """Return the measurement of successive rebound heights, one per row."""
    if table.empty:
        raise InputError(
            f"line {table.empty[0]}: the line is empty; rebound heights are those of one impact "
            "after another, and none can be missing"
        )
    labels = tuple(f"line {line}" for line in table.lines)
    deviation = table.columns.get(f"rebound_height{DEVIATION}")
    return heights_measurement(case, table.columns["rebound_height"], deviation, labels)


def _column_names(target: FileTarget) -> set[str]:
    """Return the names of the columns of a table.

    There are none if its header can't be read, which its reader reports.
    """
    try:
        return {name_and_unit(cell)[0] for cell in header_of(target.file, target.columns)}
    except InputError:
        return set()


def _table_record_measurement(case: Case, target: FileTarget, by_rebound: bool) -> Measurement:
    """Return the measurement of a record in a table: position, force or sphere's acceleration.

    The times are those of this column.
    """
    doubts: list[str] = []
    try:
        channels = recorded_channels(target.file, _unit_of, doubts, target.columns)
    except InputError as error:
        raise InputError(_with_acceleration_hint(error), "target") from None
    channel_of: dict[str, RecordedChannel] = {}
    for channel in channels:
        name, unit = name_and_unit(channel.cell)
        if name in channel_of:
            message = (
                f'several columns are called "{name}"; state them all by columns = '
                f'"time=s,-,{name}={unit or channel.unit}", with - for one left out'
            )
            raise in_file(target.file, InputError(message))
        channel_of[name] = channel
    channel = channel_of[_evaluated_quantity(channel_of, by_rebound)]
    try:
        rises = rising(channel)
    except InputError as error:
        raise in_file(target.file, error) from None
    of_channel = (*channel.doubts, *_omitted_samples(channel, rises))
    doubts += [f"{channel.name}: {doubt}" for doubt in of_channel]
    record = Recorded(
        channel.time[rises],
        {channel.name: channel.value[rises]},
        np.asarray(channel.lines)[rises].tolist(),
    )
    return _naming_file(target.file, _record_measurement(case, record, by_rebound), doubts)


def _unit_of(layout: Layout, cell: str) -> tuple[float, str] | None:
    name, unit = name_and_unit(cell)
    if name not in _RECORDED:
        return None
    return factor_to_si(layout, cell, unit, _COLUMNS[name]), _COLUMNS[name]


def _evaluated_quantity(names: Iterable[str], by_rebound: bool) -> str:
    """Return which quantity of a record is evaluated.

    If only the rebound is matched, it is the position.
    """
    recorded = [name for name in _RECORDED if name in names]
    if "position" in recorded and (by_rebound or len(recorded) == 1):
        return "position"
    return next(name for name in recorded if name != "position")


def _omitted_samples(channel: RecordedChannel, rises: Bools) -> list[str]:
    """Return sentences on the samples of a record that are not evaluated.

    They are those without a number, and those at the time of the one before.
    """
    sentences = []
    missing = channel.missing
    if len(missing) > 1:
        sentences.append(
            f"{len(missing)} of its samples have no number, the first in line {missing[0]}: the "
            "record is evaluated without them"
        )
    elif missing:
        sentences.append(
            f"1 of its samples has no number, in line {missing[0]}: the record is "
            "evaluated without it"
        )
    change = np.append(0.0, np.abs(np.diff(channel.value)))
    different = np.flatnonzero(~rises & (change > _SAME * float(np.ptp(channel.value))))
    if different.size:
        line = channel.lines[int(different[0])]
        if different.size > 1:
            have = "samples have"
            first = f"the first in line {line}: they are"
        else:
            have = "sample has"
            first = f"in line {line}: it is"
        sentences.append(
            f"{different.size} {have} the time of the one before and another value, {first} "
            "left out"
        )
    return sentences


def _bounce_measurement(case: Case, target: FileTarget) -> Measurement:
    """Return the measurement of a record in which bounces are heard."""
    if target.function is not None:
        raise InputError("the record is selected by its channel; leave this out", "target.function")
    gravity = case.drop.gravity
    if gravity == 0.0:
        raise InputError("without gravity a sphere rises for ever, and does not bounce", "target")
    try:
        record = one_record(target.file, target.channel, target.columns)
        bounces = find_bounces(record, target.contact_duration or 0.0)
    except InputError as error:
        raise in_file(target.file, error) from None

    def evaluated(flights: Flights | None) -> Observations:
        return impacts_in_bounces(
            bounces, gravity=gravity, first_speed=speed_at_touch(case, flights), flights=flights
        )

    # a flight of the time T rises by g T^2 / 8
    return Measurement(evaluated, gravity * float(bounces.flight.max()) ** 2 / 8.0)


def _record_measurement(case: Case, record: Recorded, by_rebound: bool) -> Measurement:
    if _evaluated_quantity(record.values, by_rebound) == "position":
        return _position_measurement(case, record)
    return _force_measurement(case, record)


def _position_measurement(case: Case, record: Recorded) -> Measurement:
    gravity = case.drop.gravity
    if gravity == 0.0:
        raise InputError(
            "without gravity a sphere rises for ever; a record of its position does not "
            "determine a rebound"
        )
    time = record.time
    position = record.values["position"]
    doubts: tuple[str, ...] = ()
    rounded = behind_decimals(time)
    if rounded is not None:
        time, step = rounded
        doubts = (
            f"the times are rounded to {step:g} s: they are replaced by times in equal steps",
        )
    pair = contact_pair(case)
    # largest indentation of an elastic impact at 1 m/s, by Hertz's law
    indentation = (1.25 * pair.effective_mass / pair.hertz_stiffness) ** 0.4

    def evaluated(flights: Flights | None) -> Observations:
        observations = impacts_in_position(
            time,
            position,
            radius=case.sphere.radius,
            gravity=gravity,
            contact_duration=HERTZ_TIME * float(indentation),
            first_speed=speed_at_touch(case, flights),
            lines=record.lines,
            flights=flights,
        )
        return replace(observations, doubts=(*doubts, *observations.doubts))

    return Measurement(evaluated, float(np.ptp(position)))


def _force_measurement(case: Case, record: Recorded) -> Measurement:
    mass = float(contact_pair(case).effective_mass)
    if "force" in record.values:
        force = record.values["force"]
    else:
        force = mass_of_sphere(case) * record.values["sphere_acceleration"]

    def evaluated(flights: Flights | None) -> Observations:
        return impacts_in_force(
            record.time,
            force,
            mass=mass,
            gravity=case.drop.gravity,
            first_speed=speed_at_touch(case, flights),
            lines=record.lines,
            flights=flights,
        )

    # a flight over the whole record, of the time T, rises by g T^2 / 8
    duration = float(record.time[-1] - record.time[0])
    return Measurement(evaluated, case.drop.gravity * duration**2 / 8.0)


def _rows_measurement(case: Case, table: ImpactTable) -> Measurement:
    """Return the measurement of a file with one impact per row."""
    columns = _checked_columns(table)
    speeds = columns["approach_speed"]
    wanted = {name: columns[name] for name in MATCHABLE if name in columns}
    if not wanted:
        raise InputError(
            f"{table.path}: beside approach_speed a column is missing; give one of "
            f"restitution, {', '.join(MATCHABLE)}",
            "target",
        )
    for name in wanted:
        # a separation speed may be given by a restitution
        names = (name, "restitution", "restitution_achieved")
        check_positive(table, next(column for column in names if column in table.columns))
    name_of = dict(table.written)
    if "separation_speed" not in table.columns:
        name_of.setdefault("separation_speed", name_in_file(table, "restitution"))
    deviations = known_deviations(table.path, columns, wanted, name_of)
    sizes = deviations
    if sizes is None:
        # of unknown magnitude: the same relative noise for all
        sizes = {name: np.abs(quantity) for name, quantity in wanted.items()}
    # the noise of a mean of several is smaller
    sizes = {name: size / np.sqrt(columns.get("count", 1.0)) for name, size in sizes.items()}
    labels = tuple(f"line {line}" for line in table.lines)
    radius = case.sphere.radius

    def evaluated(flights: Flights | None) -> Observations:
        seen = from_table(speeds, wanted, sizes, labels)
        seen = replace(seen, deviations_known=deviations is not None)
        seen = _with_vacuum_heights(seen, radius, case.drop.gravity, flights)
        if "restitution" in columns:
            check_restitutions(seen, case)
        return seen

    return Measurement(evaluated, float(np.max(wanted.get("rebound_height", radius))) - radius)


def _checked_columns(table: ImpactTable) -> dict[str, Floats]:
    """Return the columns of a table of impacts, with restitutions as separation speeds, too."""
    columns = dict(table.columns)
    if "restitution_achieved" in columns:  # name of the column in the impact table of a result
        columns.setdefault("restitution", columns["restitution_achieved"])
    deviations = [name for name in columns if name.endswith(DEVIATION)]
    for name in ("approach_speed", *deviations):
        check_positive(table, name)
    check_counts(table)
    for ending in ("", DEVIATION):  # by the definition of restitution
        if f"restitution{ending}" in columns:
            columns.setdefault(
                f"separation_speed{ending}",
                columns[f"restitution{ending}"] * columns["approach_speed"],
            )
    return columns


def _with_vacuum_heights(
    seen: Observations, radius: float, gravity: float, flights: Flights | None
) -> Observations:
    """Return observations with rebound heights as in a vacuum, where they can be converted."""
    heights = seen.wanted.get("rebound_height")
    if heights is None or not (gravity > 0.0 and np.all(heights > radius)):
        return seen
    rises, slopes = vacuum_height(flights or VacuumFlights(gravity), heights - radius)
    noise = {**seen.noise, "rebound_height": scaled(slopes, seen.noise["rebound_height"])}
    return replace(seen, wanted={**seen.wanted, "rebound_height": radius + rises}, noise=noise)


def known_deviations(
    path: Path,
    columns: Mapping[str, Floats],
    wanted: Iterable[str],
    written: Mapping[str, str] | None = None,
) -> dict[str, Floats] | None:
    """Return the standard deviations of quantities, None if no column has them.

    All quantities must have a column of them, or none. `written`: the names that quantities have in
    the file, where they have others.

    Raises
    ------
    InputError
        If only some have one.
    """
    names = list(wanted)
    with_deviation = [name for name in names if f"{name}{DEVIATION}" in columns]
    without = [name for name in names if name not in with_deviation]
    if not with_deviation:
        return None
    if without:
        name_of = written or {}
        has_one = name_of.get(with_deviation[0], with_deviation[0])
        has_none = name_of.get(without[0], without[0])
        raise InputError(
            f"{path}: {has_one} has a standard deviation and {has_none} has none; give "
            f"{has_none}{DEVIATION}",
            "target",
        )
    return {name: columns[f"{name}{DEVIATION}"] for name in names}


def _table(target: FileTarget) -> ImpactTable:
    try:
        return read_impact_table(target.file, _COLUMNS, target.columns)
    except InputError as error:
        raise InputError(_with_acceleration_hint(error), "target") from None


def _with_acceleration_hint(error: InputError) -> str:
    """Return the message of an error, with a hint where an acceleration is in place of a force.

    Or it is in place of a position.
    """
    if "acceleration; expected a " not in error.message:
        return error.message
    message = error.message.partition(" (a number in ")[0]  # without the hint how to write a force
    return f"{message}. In a record {_ACCELERATION_OF_SPHERE}"


def _naming_file(file: str, measurement: Measurement, doubts: Sequence[str] = ()) -> Measurement:
    """Return the measurement with messages that name the file, and with doubts about the file."""

    def evaluated(flights: Flights | None) -> Observations:
        try:
            observations = measurement.evaluated(flights)
        except InputError as error:
            raise in_file(file, error) from None
        return replace(observations, doubts=(*doubts, *observations.doubts))

    return Measurement(evaluated, measurement.highest)


def in_file(file: str, error: InputError) -> InputError:
    """Return an error with a message that names the file."""
    if file in error.message:
        return InputError(error.message, "target")
    between = ": "
    if error.message.startswith("line "):
        between = ", "
    return InputError(f"{file}{between}{error.message}", "target")
