"""What the signals that a study keeps ask of its sensors and its run."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.cases.sections.sensor_keys import sensors_of
from vibroimpact.errors import InputError
from vibroimpact.studies.planning.drop_variables import SENSOR_PEAK, SIGNAL, SIGNAL_START
from vibroimpact.studies.planning.section import SweepSection


def check_need_of_signals(section: SweepSection, keys: Collection[str]) -> None:
    """Check that signals are kept where a window or a swept sensor needs them.

    Raises
    ------
    InputError
        If they are not.
    """
    if "signals" in section.keep:
        return
    if section.window is not None:
        raise InputError(
            'it is a part of the signals, which are not kept; give keep = ["signals"]', "window"
        )
    of_sensor = next((key for key in keys if key.startswith("sensors.")), None)
    if of_sensor is not None:
        raise InputError(
            'it changes signals alone, which are not kept; give keep = ["signals"]',
            f'over."{of_sensor}"',
        )


def check_signals(case: Case, taken: Collection[str]) -> None:
    """Check that the signals of a case can be kept, and that the names of sensors suit.

    The variables of their signals may not have the names of other variables.

    Raises
    ------
    InputError
        If there are no sensors, the run has no duration, or a sensor has a name that can't be used.
    """
    # names of sensors become names of variables of the dataset
    sensors = [sensor.name for sensor in case.sensors]
    variables = []
    for sensor in sensors:
        variables += [
            f"{SIGNAL}{sensor}",
            f"{sensor}{SENSOR_PEAK}",
            f"{sensor}{SIGNAL_START}",
            f"time_{sensor}",
        ]
    for variable in variables:
        is_name = variable.isprintable() and "/" not in variable
        if not is_name or variables.count(variable) > 1 or variable in taken:
            message = (
                f'"{variable}" can\'t be the name of a variable of the dataset, or is that of '
                "another; call the sensor otherwise"
            )
            raise InputError(message, "sensors")
    if not sensors:
        raise InputError(
            '"signals" needs [[sensors]], on a plate that is elastic or shaken', "sweep.keep"
        )
    if case.run.duration is None:
        raise InputError(
            "it is missing; signals need it, so that those of all drops are of one length",
            "run.duration",
        )


def check_swept_sensors(table: Mapping[str, Any], keys: Collection[str], case: Case) -> None:
    """Check that swept sensors put out signals as those of the case by itself do.

    The signals of all drops are to fit into one array.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file.
    keys : collection of str
        The swept keys.
    case : Case
        The case at a point of the study.

    Raises
    ------
    InputError
        If a sensor differs in quantity, unit or rate.
    """
    if not any(key.startswith("sensors.") for key in keys):
        return
    for sensor, swept_sensor in zip(sensors_of(table).values(), case.sensors, strict=True):
        signal = _signal_description(sensor)
        swept_signal = _signal_description(swept_sensor)
        if swept_signal != signal:
            message = (
                f"it would give {swept_signal}, and {signal} by the case; signals of a study have "
                "one quantity, unit and rate"
            )
            raise InputError(message, f"sensors.{sensor.name}")


def _signal_description(section: SensorSection) -> str:
    """Return quantity, unit and rate of the signal of a sensor in words."""
    sensor = section.sensor()
    return f"{sensor.quantity} [{sensor.unit}] at {section.rate:.10g} Hz"
