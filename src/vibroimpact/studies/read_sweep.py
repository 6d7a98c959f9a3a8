"""Reading of a study from a case with a [sweep] section, with a check of all its values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from os import PathLike
from typing import Any

import numpy as np

from vibroimpact.cases.fields.known_keys import keys_of
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, check_bounds, check_count
from vibroimpact.cases.keys import check_laws, find_quantity, holds_keys, with_values
from vibroimpact.cases.reader import load_table, prefix_errors
from vibroimpact.dynamics.columns import ALL_IMPACT_COLUMNS
from vibroimpact.errors import InputError, listed
from vibroimpact.quoting import quoted, shortened
from vibroimpact.studies.axes import Axis, Listed, Normal, Values
from vibroimpact.studies.design import MOST_DROPS, find_design
from vibroimpact.studies.drop_variables import OUTCOME, PEAKS
from vibroimpact.studies.kept_signals import (
    check_need_of_signals,
    check_signals,
    check_swept_sensors,
)
from vibroimpact.studies.limit_columns import limit_meanings
from vibroimpact.studies.population import CLASS, LABELS, Population
from vibroimpact.studies.scaled import Scaled, check_scaled
from vibroimpact.studies.section import SweepSection, read_axis, read_scaled
from vibroimpact.studies.sweep import Sweep, different

MOST_KEYS = 100
"""Maximum number of swept keys."""

MOST_POINT_VALUES = 40_000_000
"""Maximum number of values (points times keys) of a study that is not a grid; they are
held in memory.
"""

_SHARED = {"plate": "the plate is", "sensors": "the sensors are"}
"""What rocks of all classes share, for a message."""


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
        If it can't be read or is not a valid study; the message names the key, the value and what
        is allowed.

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
    >>> study = read_sweep(
    ...     {
    ...         **case,
    ...         "sweep": {
    ...             "over": {
    ...                 "sphere.radius": ["10 mm", "25 mm"],
    ...                 "contact.restitution": [0.5, 0.6, 0.7],
    ...             }
    ...         },
    ...     }
    ... )
    >>> study.size
    6
    """
    if not isinstance(table, Mapping):
        raise InputError(f"a study is a table, as a TOML file holds it, not {quoted(table)}")
    check_bounds(table)
    base = {key: value for key, value in table.items() if key != "sweep"}
    if "sweep" not in table:
        raise InputError(
            "it is missing; it specifies the swept keys and their values, such as "
            '"sphere.radius" = ["10 mm", "25 mm"] under [sweep.over]',
            "sweep",
        )
    if not isinstance(table["sweep"], dict):
        raise InputError(
            f"{quoted(table['sweep'])} is not a table; it takes {listed(keys_of(SweepSection))}",
            "sweep",
        )
    check_laws(base)
    try:
        section = read_table(SweepSection, table["sweep"])
        design = find_design(section.design)
        if design.is_drawn and section.samples is None:
            raise InputError(
                f"it is missing; {design.name} needs the number of points to draw", "samples"
            )
        if not design.is_drawn and section.samples is not None:
            raise InputError(
                f"{design.name} has as many points as its values give; leave this out", "samples"
            )
        over, quantities, axes = _read_over(base, section.over)
        section = section.model_copy(update={"over": over})
        population = None
        if section.classes is not None:
            section, of_classes, population = _read_population(base, section)
            quantities |= of_classes
        elif not over:
            raise InputError("it is empty; it takes dotted keys of the case", "over")
        check_count(len(quantities), MOST_KEYS, "swept keys")
        own = (
            {}
            if population is None
            else {f'classes."{name}".over': of_class for name, of_class in population.own.items()}
        )
        check_scaled(section.design, {"over": axes, **own}, quantities)
        check_need_of_signals(section, quantities)
        sweep = Sweep(base, section, axes, quantities, population)
        if sweep.size > MOST_DROPS:
            raise InputError(
                f"there would be {sweep.size} drops, and {MOST_DROPS} are the most; sweep in parts",
                "over",
            )
        if sweep.size * len(quantities) > MOST_POINT_VALUES and section.design != "grid":
            words = (
                f"there would be {sweep.size} drops of {len(quantities)} values each, and "
                f"{MOST_POINT_VALUES} values are the most"
            )
            raise InputError(f"{words}; sweep in parts", "over")
        plan = sweep.plan  # of a population without a rock of some class there is none
        for key, axis in axes.items() if plan.is_grid else ():
            again = _twice(axis)
            if again is not None:
                raise InputError(
                    f"{again} stands there twice, and a grid has each value once", f'over."{key}"'
                )
    except InputError as error:
        raise InputError(error.message, f"sweep.{error.key}".rstrip(".")) from None
    _check_points(sweep)
    if "signals" in section.keep:
        check_signals(
            sweep.case,
            {*sweep.quantities, *LABELS, OUTCOME, *PEAKS, *limit_meanings(), *ALL_IMPACT_COLUMNS},
        )
    return sweep


def _read_over(
    base: Mapping[str, Any], table: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, Quantity | None], dict[str, Axis]]:
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
        raise InputError(
            f'{quoted(key)} is not a text; it is the key that is followed, such as "sphere.radius"',
            "of",
        )
    try:
        return find_quantity(base, key)
    except InputError as error:
        raise InputError(error.message, "of") from None


def _read_population(
    base: Mapping[str, Any], section: SweepSection
) -> tuple[SweepSection, dict[str, Quantity | None], Population]:
    """Return the section with the keys of its classes in dotted form, the quantities of
    these, and the population.
    """
    assert section.classes is not None
    if section.design != "population":
        raise InputError(f'{section.design} has no classes; give design = "population"', "design")
    if len(section.classes) < 2:
        raise InputError(
            "there is only one class, so that there is nothing to classify; give two or more",
            "classes",
        )
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
                words = (
                    f'"{wrong[0]}" is not there for all classes; give the same keys for all, '
                    "or leave it to [sweep.over]"
                )
            raise InputError(words, f"{where}.over")
        for key in over:
            shared = _SHARED.get(key.partition(".")[0])
            if key in section.over or shared:
                words = (
                    "it stands in [sweep.over] too"
                    if key in section.over
                    else f"{shared} not of a class"
                )
                raise InputError(f"{words}; leave it out here", f'{where}.over."{key}"')
        tables[name] = table.model_copy(update={"over": over})
    for key in section.over:
        if key == "plate":
            raise InputError(
                "a population draws single keys of [plate], one value a plate", 'over."plate"'
            )
    falls = section.falls_per_rock
    shares = {name: table.share for name, table in tables.items()}
    population = Population(
        shares,
        own,
        falls,
        section.rocks_per_plate or max(1, math.ceil((section.samples or 1) / falls)),
    )
    return section.model_copy(update={"classes": tables}), quantities, population


def _check_names(axis: Axis) -> None:
    """Check the number of distinct names and tables, each of which requires the
    validation of a case.
    """
    if isinstance(axis, Listed) and len(axis.values) > MOST_ITEMS and axis.levels().dtype == object:
        check_count(len(different(axis.levels())), MOST_ITEMS, "different names and tables")


def _twice(axis: Axis) -> str | None:
    """Return a level that an axis has twice: in a list, or in a range narrower than the
    precision of numbers.
    """
    levels = axis.levels()
    if levels.dtype == object:
        again, often = Counter(map(repr, levels.tolist())).most_common(1)[0]
        return shortened(again, 80) if often > 1 else None
    ordered = np.sort(levels)
    same = np.flatnonzero(ordered[1:] == ordered[:-1])
    return repr(ordered[same[0]].item()) if same.size else None


def _flat(over: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the swept keys in dotted form with their entries, also where unquoted keys
    became nested TOML tables.
    """
    for key, value in over.items():
        dotted = f"{above}{key}"
        if isinstance(value, dict) and holds_keys(dotted):
            yield from _flat(value, f"{dotted}.")
        else:
            yield dotted, value


def _check_points(sweep: Sweep) -> None:
    """Check that all values are in range, and that the case is valid at the first point
    and with each axis at its ends.
    """
    columns = sweep.plan.columns
    for key, values in columns.items():
        quantity = sweep.quantities[key]
        if quantity is None or values.dtype == object:
            continue
        for where, axis, own in _stated(sweep, key, values):
            try:
                quantity.allowed.check(own, quantity.unit)
            except InputError as error:
                raise InputError(
                    f"{error.message}{_remedy(axis)}", f'sweep.{where}."{key}"'
                ) from None
    first = sweep.values_of(0)
    check_swept_sensors(sweep.table, columns, sweep.case_at(first))
    for key, values in columns.items():
        several = different(values) if values.dtype == object else [values.min(), values.max()]
        for value in several:
            try:
                check_swept_sensors(sweep.table, columns, sweep.case_at({**first, key: value}))
            except InputError as error:
                raise InputError.of_several(
                    f"at {key} = {_level(value)}: {fault}" for fault in error.faults
                ) from None


def _stated(sweep: Sweep, key: str, values: Values) -> Iterator[tuple[str, Axis, Values]]:
    """Yield where a key stands, in [sweep.over] or in each class, with its axis and its
    values there.
    """
    if sweep.population is None or key in sweep.axes:
        yield "over", sweep.axes[key], values
        return
    for name, own in sweep.population.own.items():
        yield f'classes."{name}".over', own[key], values[sweep.plan.labels[CLASS] == name]


def _remedy(axis: Axis) -> str:
    """Return what keeps the values of a key in their range, where they are drawn or
    follow another key.
    """
    if isinstance(axis, Scaled):
        return (
            "; it follows another key: choose value, exponent and factor so that "
            "it stays in this range"
        )
    return (
        "; truncate the distribution with at_least and at_most" if isinstance(axis, Normal) else ""
    )


def _level(value: Any) -> str:
    """Return a value of a swept key for a message."""
    return f"{value:g}" if isinstance(value, float) else quoted(value)
