"""A study to be computed, read from a case with a [sweep] section: case, axes, and kept results."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.known_keys import keys_of
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, check_bounds, check_count
from vibroimpact.cases.keys import check_laws, find_quantity, holds_keys, with_values
from vibroimpact.cases.reader import load_table, prefix_errors
from vibroimpact.cases.rigid import deforms, impact_limit
from vibroimpact.dynamics.columns import ALL_IMPACT_COLUMNS, IMPACT_COLUMNS, meanings
from vibroimpact.errors import InputError, listed
from vibroimpact.meshes.mesh_digest import mesh_digest
from vibroimpact.shown import shortened, shown
from vibroimpact.studies.axes import Axis, Listed, Normal, Values
from vibroimpact.studies.design import MOST_DROPS, Asked, find_design
from vibroimpact.studies.drop_variables import OUTCOME, PEAKS, SENSOR_PEAK, SIGNAL, SIGNAL_START
from vibroimpact.studies.kept_signals import check_need_of_signals, check_signals, check_swept_sensors
from vibroimpact.studies.limit_columns import limit_meanings
from vibroimpact.studies.plan import Plan
from vibroimpact.studies.population import CLASS, LABELS, Population
from vibroimpact.studies.scaled import Scaled, check_scaled
from vibroimpact.studies.section import SweepSection, read_axis, read_scaled
from vibroimpact.studies.swept_keys import case_at
from vibroimpact.studies.window import Window

MOST_KEYS = 100
"""Maximum number of swept keys."""

MOST_POINT_VALUES = 40_000_000
"""Maximum number of values (points times keys) of a study that is not a grid; they are held in memory."""

_SHARED = {"plate": "the plate is", "sensors": "the sensors are"}
"""What rocks of all classes share, for a message."""

LONG = 100
"""Assumed number of impacts of a drop that goes on until it is at rest."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """A study, read and validated.

    Attributes
    ----------
    table : dict
        The case without its [sweep] section, with the structure of a TOML case file.
    section : SweepSection
        The [sweep] section.
    axes : dict of str to Axis
        Values of each swept key; without those of the classes of a population.
    quantities : dict of str to Quantity or None
        Quantity of each swept key; None if it is not a quantity.
    population : Population, optional
        Classes of rocks, with the axes of their keys.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> sweep = vi.load_sweep("signals:coal-gangue", samples=10)
    >>> sweep.name, sweep.size, sweep.case_of(3).contact.law
    ('coal and gangue on a tail-beam plate', 10, 'tsuji')
    """

    table: dict[str, Any]
    section: SweepSection
    axes: dict[str, Axis]
    quantities: dict[str, Quantity | None]
    population: Population | None = None

    @cached_property
    def size(self) -> int:
        """The number of drops."""
        return find_design(self.section.design).size(self._asked)

    @cached_property
    def plan(self) -> Plan:
        """The points of the study."""
        return find_design(self.section.design).plan(self._asked)

    @property
    def _asked(self) -> Asked:
        """What it asks of its design."""
        return Asked(self.axes, self.section.samples or 0, self.section.seed, self.population)

    @cached_property
    def case(self) -> Case:
        """The case at the first point."""
        return self.case_at(self.values_of(0))

    def values_of(self, drop: int) -> dict[str, Any]:
        """Return the values of the swept keys for a drop, by its number from 0."""
        return {key: values[0] for key, values in self.plan.points(drop, 1).items()}

    def case_at(self, values: Mapping[str, Any]) -> Case:
        """Return the case with given values of the swept keys.

        Raises
        ------
        InputError
            If it is not a valid case.
        """
        return case_at(self.table, values)

    @cached_property
    def deforms(self) -> bool:
        """Whether anything but the contact deforms, at any level of the swept keys."""
        first = self.values_of(0)
        names = {key: values for key, values in self.plan.columns.items() if values.dtype == object}
        cases = (self.case_at({**first, key: level}) for key, values in names.items() for level in _different(values))
        return deforms(self.case) or any(map(deforms, cases))

    def case_of(self, drop: int, changes: Mapping[str, Any] | None = None) -> Case:
        """Return the case of a drop by its number from 0, such as to run it separately.

        Parameters
        ----------
        drop : int
            The number.
        changes : mapping, optional
            Other values by dotted key, swept or not.

        Raises
        ------
        InputError
            If there is no such drop, or its case is not valid.
        """
        if not 0 <= drop < self.size:
            raise InputError(f"there is no drop {drop}; the study has {self.size:,}, counted from 0")
        return self.case_at({**self.values_of(drop), **(changes or {})})

    @property
    def window(self) -> Window | None:
        """The part of the signals that is kept; None for all."""
        return None if self.section.window is None else Window(self.section.window.before, self.section.window.length)

    @property
    def bytes(self) -> float:
        """Approximate size of the results [bytes]."""
        impacts = (impact_limit(self.case) or LONG) if "impacts" in self.section.keep else 0
        kept = self.case.sensors if "signals" in self.section.keep else ()
        samples = sum(sensor.rate * (self.window.length if self.window else self.case.run.duration or 0.0) for sensor in kept)
        double, single = len(self.quantities) + len(PEAKS) + impacts * len(IMPACT_COLUMNS), len(limit_meanings()) + samples
        return self.size * (8.0 * double + 4.0 * single)

    @property
    def name(self) -> str:
        """Title of the study."""
        return self.case.name or "a study of drops"

    @property
    def whole_table(self) -> dict[str, Any]:
        """The case with its [sweep] section, with the structure of a TOML case file."""
        return {**self.table, "sweep": self.section.model_dump(exclude_none=True, mode="json")}

    @property
    def meanings(self) -> dict[str, tuple[str, str]]:
        """Unit and meaning of every swept key and of all variables that may be kept, in the order of the files."""
        sensors = {sensor.name: sensor.sensor() for sensor in self.case.sensors} if "signals" in self.section.keep else {}
        keys = {key: (quantity.unit or "1", quantity.meaning) if quantity else ("1", key) for key, quantity in self.quantities.items()}
        largest = {f"{name}{SENSOR_PEAK}": (one.unit, f"largest magnitude of the signal of {name}") for name, one in sensors.items()}
        signals = {f"{SIGNAL}{name}": (one.unit, f"{one.quantity} measured by {name}") for name, one in sensors.items()}
        starts = {f"{name}{SIGNAL_START}": ("s", f"time of the first sample of {name}") for name in sensors} if self.window else {}
        impacts = meanings(ALL_IMPACT_COLUMNS)
        del impacts["impact"]  # a dimension, not a variable
        ended = {OUTCOME: ("1", "reason for the end of the run of the drop")}
        return {**keys, **ended, **PEAKS, **largest, **limit_meanings(), **impacts, **starts, **signals}

    @cached_property
    def digest(self) -> str:
        """Fingerprint (SHA-256) of the case, its meshes, the points and the kept results."""
        meshes = [mesh_digest(file) for file in _meshes(self.table)]
        rest = json.dumps([self.table, meshes, self.section.keep], sort_keys=True, default=str)
        return sha256(f"{self.plan.digest()} {rest}{f' {self.window}' if self.window else ''}".encode()).hexdigest()


def load_sweep(source: str | PathLike[str], samples: int | None = None) -> Sweep:
    """Return a study, read from a case file with a [sweep] section.

    Parameters
    ----------
    source : path or str
        A TOML file, or a shipped study such as "paper:sweep".
    samples : int, optional
        Number of samples in place of that of the study.

    Raises
    ------
    InputError
        If it can't be read or is not a valid study; the message names the key, the value and what is allowed.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> vi.load_sweep("paper:sweep").size, vi.load_sweep("signals:coal-gangue", samples=10).size
    (140, 10)
    """
    changes = {} if samples is None else {"sweep.samples": samples}
    return prefix_errors(source, lambda: read_sweep(with_values(load_table(source), changes)))


def read_sweep(table: Mapping[str, Any]) -> Sweep:
    """Return a study, read from a mapping with the structure of a TOML case file.

    Nothing is computed, but the case is validated at the first point and at the ends of every axis.

    Raises
    ------
    InputError
        If it is not a valid study.

    Examples
    --------
    >>> from vibroimpact.cases.reader import load_table
    >>> case = load_table("paper:type1-theory")
    >>> study = read_sweep({**case, "sweep": {"over": {"sphere.radius": ["10 mm", "25 mm"], "contact.restitution": [0.5, 0.6, 0.7]}}})
    >>> study.size
    6
    """
    if not isinstance(table, Mapping):
        raise InputError(f"a study is a table, as a TOML file holds it, not {shown(table)}")
    check_bounds(table)
    base = {key: value for key, value in table.items() if key != "sweep"}
    if "sweep" not in table:
        raise InputError(
            'it is missing; it specifies the swept keys and their values, such as "sphere.radius" = ["10 mm", "25 mm"] under [sweep.over]',
            "sweep",
        )
    if not isinstance(table["sweep"], dict):
        raise InputError(f"{shown(table['sweep'])} is not a table; it takes {listed(keys_of(SweepSection))}", "sweep")
    check_laws(base)
    try:
        section = read_table(SweepSection, table["sweep"])
        design = find_design(section.design)
        if design.is_drawn and section.samples is None:
            raise InputError(f"it is missing; {design.name} needs the number of points to draw", "samples")
        if not design.is_drawn and section.samples is not None:
            raise InputError(f"{design.name} has as many points as its values give; leave this out", "samples")
        over, quantities, axes = _read_over(base, section.over)
        section = section.model_copy(update={"over": over})
        population = None
        if section.classes is not None:
            section, of_classes, population = _read_population(base, section)
            quantities |= of_classes
        elif not over:
            raise InputError("it is empty; it takes dotted keys of the case", "over")
        check_count(len(quantities), MOST_KEYS, "swept keys")
        own = {} if population is None else {f'classes."{name}".over': of_class for name, of_class in population.own.items()}
        check_scaled(section.design, {"over": axes, **own}, quantities)
        check_need_of_signals(section, quantities)
        sweep = Sweep(base, section, axes, quantities, population)
        if sweep.size > MOST_DROPS:
            raise InputError(f"there would be {sweep.size} drops, and {MOST_DROPS} are the most; sweep in parts", "over")
        if sweep.size * len(quantities) > MOST_POINT_VALUES and section.design != "grid":
            words = f"there would be {sweep.size} drops of {len(quantities)} values each, and {MOST_POINT_VALUES} values are the most"
            raise InputError(f"{words}; sweep in parts", "over")
        plan = sweep.plan  # of a population without a rock of some class there is none
        for key, axis in axes.items() if plan.is_grid else ():
            again = _twice(axis)
            if again is not None:
                raise InputError(f"{again} stands there twice, and a grid has each value once", f'over."{key}"')
    except InputError as error:
        raise InputError(error.message, f"sweep.{error.key}".rstrip(".")) from None
    _check_points(sweep)
    if "signals" in section.keep:
        check_signals(sweep.case, {*sweep.quantities, *LABELS, OUTCOME, *PEAKS, *limit_meanings(), *ALL_IMPACT_COLUMNS})
    return sweep


def _read_over(base: Mapping[str, Any], table: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Quantity | None], dict[str, Axis]]:
    """Return the entries of swept keys in dotted form, their quantities and their axes."""
    keys = list(_flat(table))
    over = dict(keys)
    twice = next((key for number, (key, _) in enumerate(keys) if key in dict(keys[:number])), None)
    if twice is not None:
        raise InputError("this key stands there twice, in quotes and in a table", f'over."{twice}"')
    quantities: dict[str, Quantity | None] = {}
    axes: dict[str, Axis] = {}
    for key, value in over.items():
        try:
            quantities[key] = find_quantity(base, key)
            if isinstance(value, Mapping) and "of" in value:
                axes[key] = read_scaled(value, quantities[key], _followed(base, value["of"]))
            else:
                axes[key] = read_axis(value, quantities[key])
            _check_names(axes[key])
        except InputError as error:
            raise InputError(error.message, f'over."{key}".{error.key}'.rstrip(".")) from None
    return over, quantities, axes


def _followed(base: Mapping[str, Any], key: Any) -> Quantity | None:
    """Return the quantity of the key that another one follows."""
    if not isinstance(key, str):
        raise InputError(f'{shown(key)} is not a text; it is the key that is followed, such as "sphere.radius"', "of")
    try:
        return find_quantity(base, key)
    except InputError as error:
        raise InputError(error.message, "of") from None


def _read_population(base: Mapping[str, Any], section: SweepSection) -> tuple[SweepSection, dict[str, Quantity | None], Population]:
    """Return the section with the keys of its classes in dotted form, the quantities of these, and the population."""
    assert section.classes is not None
    if section.design != "population":
        raise InputError(f'{section.design} has no classes; give design = "population"', "design")
    if len(section.classes) < 2:
        raise InputError("there is only one class, so that there is nothing to classify; give two or more", "classes")
    quantities: dict[str, Quantity | None] = {}
    tables, own = {}, {}
    for name, table in section.classes.items():
        where = f'classes."{name}"'
        try:
            over, quantities, own[name] = _read_over(base, table.over)
        except InputError as error:
            raise InputError(error.message, f"{where}.{error.key}") from None
        first = next(iter(own.values()))
        wrong = sorted(first.keys() ^ over.keys())
        if wrong or not over:
            words = "it is empty; give one key or more, the same for all classes"
            if wrong:
                words = f'"{wrong[0]}" is not there for all classes; give the same keys for all, or leave it to [sweep.over]'
            raise InputError(words, f"{where}.over")
        for key in over:
            shared = _SHARED.get(key.partition(".")[0])
            if key in section.over or shared:
                words = "it stands in [sweep.over] too" if key in section.over else f"{shared} not of a class"
                raise InputError(f"{words}; leave it out here", f'{where}.over."{key}"')
        tables[name] = table.model_copy(update={"over": over})
    for key in section.over:
        if key == "plate":
            raise InputError("a population draws single keys of [plate], one value a plate", 'over."plate"')
    falls = section.falls_per_rock
    shares = {name: table.share for name, table in tables.items()}
    population = Population(shares, own, falls, section.rocks_per_plate or max(1, math.ceil((section.samples or 1) / falls)))
    return section.model_copy(update={"classes": tables}), quantities, population


def _check_names(axis: Axis) -> None:
    """Check the number of distinct names and tables, each of which requires the validation of a case."""
    if isinstance(axis, Listed) and len(axis.values) > MOST_ITEMS and axis.levels().dtype == object:
        check_count(len(_different(axis.levels())), MOST_ITEMS, "different names and tables")


def _twice(axis: Axis) -> str | None:
    """Return a level that an axis has twice: in a list, or in a range narrower than the precision of numbers."""
    levels = axis.levels()
    if levels.dtype == object:
        again, often = Counter(map(repr, levels.tolist())).most_common(1)[0]
        return shortened(again, 80) if often > 1 else None
    ordered = np.sort(levels)
    same = np.flatnonzero(ordered[1:] == ordered[:-1])
    return repr(ordered[same[0]].item()) if same.size else None


def _flat(over: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the swept keys in dotted form with their entries, also where unquoted keys became nested TOML tables."""
    for key, value in over.items():
        dotted = f"{above}{key}"
        if isinstance(value, dict) and holds_keys(dotted):
            yield from _flat(value, f"{dotted}.")
        else:
            yield dotted, value


def _check_points(sweep: Sweep) -> None:
    """Check that all values are in range, and that the case is valid at the first point and with each axis at its ends."""
    columns = sweep.plan.columns
    for key, values in columns.items():
        quantity = sweep.quantities[key]
        if quantity is None or values.dtype == object:
            continue
        for where, axis, own in _stated(sweep, key, values):
            try:
                quantity.allowed.check(own, quantity.unit)
            except InputError as error:
                raise InputError(f"{error.message}{_remedy(axis)}", f'sweep.{where}."{key}"') from None
    first = sweep.values_of(0)
    check_swept_sensors(sweep.table, columns, sweep.case_at(first))
    for key, values in columns.items():
        several = _different(values) if values.dtype == object else [values.min(), values.max()]
        for value in several:
            try:
                check_swept_sensors(sweep.table, columns, sweep.case_at({**first, key: value}))
            except InputError as error:
                raise InputError.of_several(f"at {key} = {_level(value)}: {fault}" for fault in error.faults) from None


def _stated(sweep: Sweep, key: str, values: Values) -> Iterator[tuple[str, Axis, Values]]:
    """Yield where a key stands, in [sweep.over] or in each class, with its axis and its values there."""
    if sweep.population is None or key in sweep.axes:
        yield "over", sweep.axes[key], values
        return
    for name, own in sweep.population.own.items():
        yield f'classes."{name}".over', own[key], values[sweep.plan.labels[CLASS] == name]


def _remedy(axis: Axis) -> str:
    """Return what keeps the values of a key in their range, where they are drawn or follow another key."""
    if isinstance(axis, Scaled):
        return "; it follows another key: choose value, exponent and factor so that it stays in this range"
    return "; truncate the distribution with at_least and at_most" if isinstance(axis, Normal) else ""


def _level(value: Any) -> str:
    """Return a value of a swept key for a message."""
    return f"{value:g}" if isinstance(value, float) else shown(value)


def _different(values: Values) -> list[Any]:
    """Return the distinct values, which may be tables, in order."""
    return list({repr(value): value for value in values.tolist()}.values())


def _meshes(table: Mapping[str, Any]) -> Iterator[Path]:
    """Yield the mesh files of a case."""
    for body in ("sphere", "plate"):
        mesh = table[body].get("mesh") if isinstance(table.get(body), dict) else None
        file = mesh.get("file") if isinstance(mesh, dict) else mesh
        if isinstance(file, str) and Path(file).is_file():
            yield Path(file)
