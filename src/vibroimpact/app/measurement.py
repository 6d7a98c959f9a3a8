"""A measurement that is opened on the live page: its records over what the case computes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.overlay import Overlay, contact_overlay
from vibroimpact.calibration.record_chart import record_chart
from vibroimpact.calibration.records.force_pulses import DetectedPulses, find_pulses
from vibroimpact.cases.case import Case
from vibroimpact.charts.chart import Chart
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.errors import InputError
from vibroimpact.files.plain_names import plain_names
from vibroimpact.files.reading import with_path
from vibroimpact.identification.measured import has_unit_of
from vibroimpact.quoting import quoted
from vibroimpact.report.report import Table, table_of
from vibroimpact.signals.reading.one_record import is_named
from vibroimpact.signals.reading.record_files import records_in
from vibroimpact.signals.record import Record
from vibroimpact.test_analysis.charts import overlay_chart
from vibroimpact.test_analysis.correlate import correlate
from vibroimpact.test_analysis.report import record_table
from vibroimpact.units.display import digits

MOST_RECORDED = 500_000
"""Largest number of samples of all records of a measurement: ten seconds at 50 kHz."""

_MOST_CONTACTS = 20
"""Number of contacts that are compared."""

_POINTS = 801
"""Points of a computed contact."""

_MARGIN = 0.25
"""Time shown beside a contact, and gap below which two contacts are one, as parts of a contact."""

_UNCALIBRATED = ("", "1", "V")
"""Units of records whose scale is not known, such as sound."""

_MOST_NAMED = 8
"""Number of names in a message."""


class Compared(NamedTuple):
    """A measurement over what was computed: charts, tables, and sentences without full stops."""

    charts: list[Chart]
    tables: list[Table]
    notes: list[str]


def read_measurement(name: str, content: bytes) -> list[Record]:
    """Return the records of a file that came through the browser.

    Raises
    ------
    InputError
        If it is no table and no WAV file, can't be read, or has too many samples.

    Examples
    --------
    >>> read_measurement("a1.csv", b"time [s],a1 [m/s2]\\n0,1\\n0.1,2\\n0.2,1\\n")[0].rate
    10.0
    """
    records = records_in(name, content)
    samples = sum(len(record.value) for record in records)
    if samples > MOST_RECORDED:
        raise with_path(
            name,
            InputError(
                f"there are {samples:,} samples in all, more than the {MOST_RECORDED:,} of the "
                "live page; keep the part with the impacts, or use: vibroimpact correlate"
            ),
        )
    return records


def compared(records: Sequence[Record], case: Case, response: Response) -> Compared:
    """Return the records of a measurement over what was computed.

    Records of motion are those of the sensors that they match, and are compared by `correlate`; one
    of a force is that of the contact.

    Parameters
    ----------
    records : sequence of Record
        The records of one file.
    case : Case
        The case.
    response : Response
        What was computed of it.

    Raises
    ------
    InputError
        If no record matches a sensor and none is a force, or the case can't be compared.
    """
    sensors = response.problem.sensors
    motions: dict[str, Record] = {}
    forces: list[Record] = []
    left_out: list[Record] = []
    for record in records:
        sensor = _sensor_of(record, records, sensors)
        if sensor is not None and sensor.name not in motions:
            motions[sensor.name] = record
        elif sensor is None and record.unit == "N" and not forces:
            forces.append(record)
        else:
            left_out.append(record)
    if not motions and not forces:
        raise _none_matches(records, sensors)
    parts = []
    if motions:
        parts.append(_compared_motions(motions, case, sensors))
    if forces:
        parts.append(_compared_force(forces[0], response))
    notes = [note for part in parts for note in part.notes]
    if left_out:
        names = _listed([record.name for record in left_out])
        notes.append(f"not compared, as no sensor of the case is left for it: {names}")
    return Compared(
        [chart for part in parts for chart in part.charts],
        [table for part in parts for table in part.tables],
        notes,
    )


def _sensor_of(
    record: Record, records: Sequence[Record], sensors: Sequence[Sensor]
) -> Sensor | None:
    """Return the sensor that a record matches; None if there is none.

    It is the one of its name; or of those of its unit, where it is the only record of a file the
    one of the file's name, and where no other record has this unit the only one.
    """
    for sensor in sensors:
        if is_named(record, sensor.name):
            return sensor
    of_unit = [
        sensor for sensor in sensors if record.unit in _UNCALIBRATED or has_unit_of(record, sensor)
    ]
    if len(records) == 1:
        plain = plain_names([sensor.name for sensor in sensors])
        stem = Path(record.source).stem
        for sensor in of_unit:
            if stem in (sensor.name, plain[sensor.name]):
                return sensor
    alike = [other for other in records if other.unit == record.unit]
    if len(of_unit) == len(alike) == 1:
        return of_unit[0]
    return None


def _none_matches(records: Sequence[Record], sensors: Sequence[Sensor]) -> InputError:
    """Return the error that no record is of a sensor."""
    has = _listed([record.name for record in records])
    if sensors:
        first = sensors[0]
        words = (
            f"it has {has}, which is of none of the sensors "
            f"{_listed([sensor.name for sensor in sensors])}; name a column after its sensor with "
            f'its unit, such as "{first.name} [{first.unit}]"'
        )
    else:
        words = (
            f"it has {has}, and the case has no sensors; add the sensor to the case, on an "
            "elastic plate"
        )
    error = InputError(f"{words}, or open a record of the contact force in N")
    return with_path(records[0].source, error)


def _listed(names: Sequence[str]) -> str:
    listed = ", ".join(quoted(name) for name in names[:_MOST_NAMED])
    if len(names) > _MOST_NAMED:
        return f"{listed} and {len(names) - _MOST_NAMED} more"
    return listed


def _compared_motions(
    motions: dict[str, Record], case: Case, sensors: Sequence[Sensor]
) -> Compared:
    """Return the records of sensors, by the names of these, over the signals of the case."""
    units = {sensor.name: sensor.unit for sensor in sensors}
    uncalibrated = [
        name
        for name, record in motions.items()
        if record.unit in _UNCALIBRATED and record.unit != units[name]
    ]
    records = [
        replace(record, name=name, unit=units[name] if name in uncalibrated else record.unit)
        for name, record in motions.items()
    ]
    correlation = correlate(case, records)
    notes = []
    if uncalibrated:
        scales = dict(zip(motions, correlation.scale.tolist(), strict=True))
        records = [
            replace(record, value=record.value / scales[record.name])
            if record.name in uncalibrated
            else record
            for record in records
        ]
        correlation = correlate(case, records)
        notes = [
            f"{quoted(name)} is recorded {_in_what(motions[name])}: it is drawn with the scale "
            f"that fits the simulation best, {digits(1.0 / scales[name], 4)} {units[name]} "
            f"{_per_what(motions[name])}"
            for name in uncalibrated
        ]
    return Compared(
        [overlay_chart(correlation)],
        [record_table(correlation)],
        [*notes, *correlation.doubts],
    )


def _in_what(record: Record) -> str:
    return "in V" if record.unit == "V" else "without a unit"


def _per_what(record: Record) -> str:
    return "per V" if record.unit == "V" else "for 1.0 of the record"


def _compared_force(record: Record, response: Response) -> Compared:
    """Return the record of a force over the computed contact force, contact by contact."""
    try:
        measured = _measured_contacts(record)
    except InputError as error:
        raise with_path(record.source, error) from None
    computed = _computed_contacts(response)
    overlays = [
        contact_overlay(f"impact {number}", one, other)
        for number, (one, other) in enumerate(zip(measured, computed, strict=False), start=1)
    ]
    notes = list(record.named_doubts)
    if len(measured) != len(computed):
        notes.append(
            f"the record has {len(measured)} {_contacts(len(measured))} and the run "
            f"{len(computed)}; only those that both have are compared"
        )
    chart = replace(
        record_chart(overlays),
        caption="The record around each contact, less its baseline, and the computed contact "
        "force: each contact is aligned in time by its centroid.",
    )
    return Compared([chart], [_force_table(overlays)], notes)


def _contacts(count: int) -> str:
    return "contact" if count == 1 else "contacts"


def _measured_contacts(record: Record) -> list[tuple[Floats, Floats]]:
    """Return times [s] and forces above the baseline [N] around each complete contact."""
    if not np.isfinite(record.value).all():
        raise InputError(
            f"the record {quoted(record.name)} has samples that are not finite numbers; give it "
            "without gaps"
        )
    detected = find_pulses(record.time, record.value)
    pieces = [
        _piece(record, detected, begin, end)
        for begin, end in detected.runs
        if begin > 0 and end < len(record.value)
    ]
    if not pieces:
        raise InputError(
            f"the record {quoted(record.name)} begins or ends in the middle of its only impact; "
            "record some time before and after it"
        )
    return pieces[:_MOST_CONTACTS]


def _piece(record: Record, detected: DetectedPulses, begin: int, end: int) -> tuple[Floats, Floats]:
    """Return times and forces of some samples and of those beside them."""
    margin = int(_MARGIN * (end - begin)) + 1
    piece = slice(max(0, begin - margin), end + margin)
    return record.time[piece], detected.above[piece]


def _computed_contacts(response: Response) -> list[tuple[Floats, Floats]]:
    """Return times since first touch [s] and forces [N] of each contact.

    Contacts that follow each other at once, as on a plate that vibrates, are one as in a record.
    """
    begins = response.impacts["time_s"].ravel()
    # a contact may be cut off by the end of the run
    ends = np.fmin(begins + response.impacts["duration_s"].ravel(), response.end_time[0])
    if not len(begins):
        raise InputError("the run has no impact, and so no contact force", "run")
    if not np.all(response.impacts["max_force_N"] > 0.0):
        raise InputError(
            "this law has no force over time to compare with; choose one with a stiffness",
            "contact.law",
        )
    visits: list[tuple[float, float]] = []
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        if visits:
            last_begin, last_end = visits[-1]
            if begin - last_end < _MARGIN * max(end - begin, last_end - last_begin):
                visits[-1] = (last_begin, end)
                continue
        visits.append((begin, end))
    contacts = []
    for begin, end in visits[:_MOST_CONTACTS]:
        time = np.linspace(0.0, end - begin, _POINTS)
        contacts.append((time, response.at(begin + time, ["force_N"])["force_N"]))
    return contacts


def _force_table(overlays: Sequence[Overlay]) -> Table:
    """Return the table of the largest forces."""
    rows = []
    for number, overlay in enumerate(overlays, start=1):
        measured = float(overlay.measured[1].max())
        computed = float(overlay.simulated[1].max())
        rows.append(
            [
                str(number),
                digits(measured, 4),
                digits(computed, 4),
                digits(measured / computed, 4),
            ]
        )
    return table_of(
        [
            "Impact",
            ("Largest force measured", "N"),
            ("Largest force computed", "N"),
            "Measured over computed",
        ],
        rows,
    )
