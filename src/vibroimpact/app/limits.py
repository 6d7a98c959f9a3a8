"""What the live page computes: cases that take seconds, and read no file."""

from __future__ import annotations

from typing import Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.costs import costs_of, impacts_expected
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.rigid import elastic_names
from vibroimpact.errors import InputError
from vibroimpact.shown import shown

MOST_MODES, MOST_IMPACTS, LONGEST_RUN, MOST_SENSORS, MOST_SAMPLES = 400, 300, 60.0, 8, 4_000_000
"""Largest number of modes of a body and of impacts, longest run [s], largest number of sensors and of samples."""

MOST_SECONDS, MOST_MEMORY = 180.0, 3e9
"""Longest time [s] and largest memory [bytes] that a case may take by the estimate of its costs."""

_ELSEWHERE = {"sweep": "vibroimpact sweep", "calibrate": "vibroimpact calibrate"}


def check_table(table: dict[str, Any]) -> None:
    """Check that the table of a case names no file of this machine.

    Raises
    ------
    InputError
        If it does.

    Examples
    --------
    >>> check_table({"plate": {"mesh": "/etc/passwd"}})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: plate.mesh: the live page reads no files; run the case with: vibroimpact run
    """
    for body in ("sphere", "plate"):
        section = table.get(body)
        mesh = section.get("mesh") if isinstance(section, dict) else None
        if isinstance(mesh, str) or (isinstance(mesh, dict) and "file" in mesh):
            raise InputError("the live page reads no files; run the case with: vibroimpact run", f"{body}.mesh")
    for name, command in _ELSEWHERE.items():
        if name in table:
            raise InputError(f"the live page does not read this section; use: {command}", name)


def without_other_work(table: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the table of a case without the sections for other commands, and a sentence on each of them.

    Examples
    --------
    >>> without_other_work({"name": "a", "sweep": {}})
    ({'name': 'a'}, ['[sweep] is left out here; use: vibroimpact sweep'])
    """
    left = [f"[{name}] is left out here; use: {command}" for name, command in _ELSEWHERE.items() if name in table]
    return {name: value for name, value in table.items() if name not in _ELSEWHERE}, left


def check_bounds(case: Case) -> None:
    """Check that a case is small enough to be computed while somebody waits.

    Raises
    ------
    InputError
        If it is not; the message gives the bound, and the command that has none.
    """
    for name in elastic_names(case):
        body = getattr(case, name)
        if isinstance(body.mesh, BroughtMeshTable):
            raise InputError("the live page reads no files; run the case with: vibroimpact run", f"{name}.mesh")
        _bound(body.modes or 0, MOST_MODES, f"{name}.modes", "modes")
    _bound(case.run.duration or 0.0, LONGEST_RUN, "run.duration", "s")
    _bound(impacts_expected(case), MOST_IMPACTS, "run.impacts", "impacts")
    _bound(len(case.sensors), MOST_SENSORS, "sensors", "sensors")
    _bound(sum(sensor.rate for sensor in case.sensors) * (case.run.duration or 10.0), MOST_SAMPLES, "sensors", "samples in all")
    costs = costs_of(case)
    _bound(sum(cost.seconds for cost in costs), MOST_SECONDS, "", "s of computing")
    _bound(sum(cost.memory for cost in costs) / 1e9, MOST_MEMORY / 1e9, "", "GB of memory")


def _bound(value: float, most: float, key: str, what: str) -> None:
    if value > most:
        raise InputError(
            f"{shown(float(f'{value:.3g}'))} {what} are more than the {most:g} of the live page; vibroimpact run takes more", key
        )
