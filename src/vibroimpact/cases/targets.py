"""What the impacts of a calibration are to be like: from the case, or from a file of measurements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.calibration.force_record import impacts_in_force
from vibroimpact.calibration.observations import Floats, Observations, from_heights, from_table
from vibroimpact.calibration.outcomes import OUTCOMES, REBOUND, REBOUNDS
from vibroimpact.calibration.position_record import impacts_in_position
from vibroimpact.cases.build import contact_laws_of, contact_pair, first_speed
from vibroimpact.cases.calibrate_section import CalibrateSection, HeightsTarget, ImpactTarget, RestitutionTarget
from vibroimpact.cases.contact_section import ContactSection
from vibroimpact.cases.schema import Case
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exchange.table_file import TableFile, read_table_file, rising

_OUTCOMES = {name: outcome.unit for name, outcome in OUTCOMES.items()}
_DEVIATION = "_standard_deviation"
_COLUMNS = {
    "time": "s",
    "position": "m",
    "force": "N",
    "approach_speed": "m/s",
    "restitution": "",
    "restitution_achieved": "",
    "rebound_height": "m",
    **_OUTCOMES,
    **{f"{name}{_DEVIATION}": unit for name, unit in {"restitution": "", "rebound_height": "m", **_OUTCOMES}.items()},
}
_NOISE_OF_RESTITUTION = 0.1
_KINDS = (
    "approach_speed with restitution, separation_speed, rebound_height, max_force, max_indentation or duration; rebound_height; "
    "or a record of time with position or force"
)


def target_of(case: Case, problem: Problem, section: CalibrateSection) -> Problem | Observations:
    """Return what impacts are to be like: the drop under another law, or what was measured.

    Raises
    ------
    InputError
        If a file can't be read, or does not tell of impacts; with the line.
    """
    target, speed = section.target, first_speed(case)
    if isinstance(target, ContactSection):
        try:
            return replace(problem, laws=contact_laws_of(case.model_copy(update={"contact": target})))
        except InputError as error:
            raise InputError(error.message, error.key.replace("contact", "target", 1)) from None
    if isinstance(target, HeightsTarget):
        heights = np.array(target.rebound_heights)
        deviation = None if target.standard_deviation is None else np.full(len(heights), target.standard_deviation)
        labels = tuple(f"impact {number + 1}" for number in range(len(heights)))
        return _from_heights(case, heights, deviation, labels)
    if isinstance(target, ImpactTarget):
        return _of_first(case, target)
    if isinstance(target, RestitutionTarget):
        if isinstance(target.restitution, tuple):
            return _of_speeds(target)
        if problem.vibrates:  # where a law without a force has no meaning: the first impact, on a plate at rest
            return from_table(
                np.array([speed]), {"separation_speed": np.array([target.restitution * speed])}, None, ("impact 1",), of_the_drop=True
            )
        return replace(problem, laws=(Newton(restitution=target.restitution),))
    return _of_file(case, read_table_file(target.file, _COLUMNS), set(section.match or REBOUND) <= set(REBOUNDS))


def _of_file(case: Case, table: TableFile, by_rebound: bool) -> Observations:
    """Return what a file tells; of a record of both, the position if only the rebound is matched."""
    columns = table.columns
    if "approach_speed" in columns:
        return _of_rows(table)
    try:
        if "rebound_height" in columns:
            if table.empty:
                words = "the line is empty; rebound heights are those of one impact after another, and none can be missing"
                raise InputError(f"line {table.empty[0]}: {words}")
            labels = tuple(f"line {line}" for line in table.lines)
            return _from_heights(case, columns["rebound_height"], columns.get(f"rebound_height{_DEVIATION}"), labels)
        if "time" not in columns or not ("position" in columns or "force" in columns):
            raise InputError(f"the columns {', '.join(columns)} do not tell of impacts; a file has {_KINDS}")
        table = rising(table, "time")
        columns, gravity, speed = table.columns, case.drop.gravity, first_speed(case)
        time, lines = columns["time"], table.lines
        if "position" not in columns or ("force" in columns and not by_rebound):
            mass = contact_pair(case).effective_mass
            return impacts_in_force(time, columns["force"], mass=mass, gravity=gravity, first_speed=speed, lines=lines)
        if gravity == 0.0:
            raise InputError("without gravity a sphere rises for ever; a record of its position tells nothing")
        radius = case.sphere.radius
        return impacts_in_position(time, columns["position"], radius=radius, gravity=gravity, first_speed=speed, lines=lines)
    except InputError as error:
        told = error.message if str(table.path) in error.message else f"{table.path}: {error.message}"
        raise InputError(told, "target") from None


def _from_heights(case: Case, heights: Floats, deviation: Floats | None, labels: tuple[str, ...]) -> Observations:
    if case.drop.gravity == 0.0:
        raise InputError("without gravity a sphere rises for ever; its rebound height tells nothing", "target")
    low = np.flatnonzero(heights <= case.sphere.radius)
    if low.size:
        what = f"{heights[low[0]]:g} m is not above where the sphere lies on the plate, with its centre at {case.sphere.radius:g} m"
        raise InputError(f"{labels[low[0]]}: {what}", "target")
    fallen = np.append(case.drop.height or case.sphere.radius + 0.5 * first_speed(case) ** 2 / case.drop.gravity, heights[:-1])
    noise = 0.0 if deviation is None else 6.0 * deviation  # of both heights
    higher = np.flatnonzero(heights > fallen + noise)
    if higher.size:
        at = int(higher[0])
        raise InputError(f"{labels[at]}: {heights[at]:g} m is higher than the {fallen[at]:g} m from which the sphere fell", "target")
    speed, gravity = first_speed(case), case.drop.gravity
    return from_heights(heights, deviation, first_speed=speed, radius=case.sphere.radius, gravity=gravity, labels=labels)


def _of_first(case: Case, target: ImpactTarget) -> Observations:
    """Return the first impact of the drop."""
    speed, found = first_speed(case), {name: getattr(target, name) for name in OUTCOMES}
    if target.restitution is not None:
        found["separation_speed"] = target.restitution * speed
    if target.rebound_height is not None:
        _from_heights(case, np.array([target.rebound_height]), None, ("impact 1",))  # which looks at it
    wanted = {name: np.array([value]) for name, value in found.items() if value is not None}
    part = target.relative_deviation
    deviations = None if part is None else {name: part * value for name, value in wanted.items()}
    return from_table(np.array([speed]), wanted, deviations, ("impact 1",), of_the_drop=True)


def _of_speeds(target: RestitutionTarget) -> Observations:
    assert isinstance(target.restitution, tuple)
    speeds, restitutions = np.array(target.approach_speed), np.array(target.restitution)
    deviations = None if target.standard_deviation is None else {"separation_speed": target.standard_deviation * speeds}
    labels = tuple(f"restitution {number + 1}" for number in range(len(speeds)))
    return from_table(speeds, {"separation_speed": restitutions * speeds}, deviations, labels)


def _of_rows(table: TableFile) -> Observations:
    """Return impacts that a file gives one a row."""
    columns, speeds = dict(table.columns), table.columns["approach_speed"]
    if "restitution_achieved" in columns:  # as the impact table of a result calls it
        columns.setdefault("restitution", columns["restitution_achieved"])
    for name in ("approach_speed", *(name for name in columns if name.endswith(_DEVIATION))):
        _positive(table, name)
    over = np.flatnonzero(columns.get("restitution", np.zeros(1)) > 1.0 + _NOISE_OF_RESTITUTION)
    if over.size:
        value = columns["restitution"][over[0]]
        raise InputError(f"{table.path}, line {table.lines[over[0]]}: restitution is {value:g}; it is 1 at most", "target")
    for ending in ("", _DEVIATION):  # a restitution is a separation speed over the approach speed
        if f"restitution{ending}" in columns:
            columns.setdefault(f"separation_speed{ending}", columns[f"restitution{ending}"] * speeds)
    wanted = {name: columns[name] for name in OUTCOMES if name in columns}
    if not wanted:
        raise InputError(f"{table.path}: beside approach_speed a column is missing: restitution, {', '.join(OUTCOMES)}", "target")
    for name in wanted:
        _positive(table, next(column for column in (name, "restitution", "restitution_achieved") if column in table.columns))
    known = [name for name in wanted if f"{name}{_DEVIATION}" in columns]
    if known and len(known) < len(wanted):
        without = next(name for name in wanted if name not in known)
        raise InputError(f"{table.path}: {known[0]} has a standard deviation and {without} has none; give {without}{_DEVIATION}", "target")
    deviations = {name: columns[f"{name}{_DEVIATION}"] for name in wanted} if known else None
    return from_table(speeds, wanted, deviations, tuple(f"line {line}" for line in table.lines))


def _positive(table: TableFile, column: str) -> None:
    wrong = np.flatnonzero(~(table.columns[column] > 0.0))
    if wrong.size:
        value = table.columns[column][wrong[0]]
        raise InputError(f"{table.path}, line {table.lines[wrong[0]]}: {column} is {value:g}; it must be greater than 0", "target")
