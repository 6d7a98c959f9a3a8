"""Reading of a study from a case with a [sweep] section, with a check of all its values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Set
from os import PathLike
from typing import Any

import numpy as np

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.known_keys import keys_of
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, check_bounds, check_count
from vibroimpact.cases.reader import load_table, prefix_errors
from vibroimpact.cases.sections.keys import check_laws, find_quantity, holds_keys, with_values
from vibroimpact.dynamics.motion.columns import ALL_IMPACT_COLUMNS
from vibroimpact.errors import InputError, listed
from vibroimpact.quoting import quoted, shortened
from vibroimpact.studies.planning.axes import Axis, Listed, Normal, Values
from vibroimpact.studies.planning.design import MOST_DROPS, find_design
from vibroimpact.studies.planning.drop_variables import OUTCOME, PEAKS
from vibroimpact.studies.planning.kept_signals import (
    check_need_of_signals,
    check_signals,
    check_swept_sensors,
)
from vibroimpact.studies.planning.limit_columns import limit_meanings
from vibroimpact.studies.planning.population import CLASS, LABELS, Population
from vibroimpact.studies.planning.scaled import Scaled, check_scaled
from vibroimpact.studies.planning.section import ClassTable, SweepSection, read_axis, read_scaled
from vibroimpact.studies.planning.sweep import Sweep, different

MOST_KEYS = 100
"""Maximum number of swept keys."""

MOST_POINT_VALUES = 40_000_000
"""Maximum number of values (points times keys) of a study that is not a grid.

They are held in memory.
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
    >>> (
    ...     vi.studies.load_sweep("paper:sweep").size,
    ...     vi.studies.load_sweep("signals:coal-gangue", samples=10).size,
    ... )
    (140, 10)
    """
    changes = {}
    if samples is not None:
        changes = {"sweep.samples": samples}
    return prefix_errors(source, lambda: sweep_of(with_values(load_table(source), changes)))


def load_drop(
    source: str | PathLike[str], drop: int, changes: Mapping[str, Any] | None = None
) -> Case:
    """Return the case of one drop of a study.

    Parameters
    ----------
    source : path or str
        A TOML file with a [sweep] section, or a shipped study such as "paper:sweep".
    drop : int
        Number of the drop, from 0.
    changes : mapping, optional
        Other values by dotted key, swept or not.

    Raises
    ------
    InputError
        If it is not a valid study, or has no such drop.

    Examples
    --------
    >>> case = load_drop("paper:sweep", 13)
    >>> case.sphere.radius, case.contact.parameters["restitution"]
    (0.005, 0.95)
    """
    return prefix_errors(source, lambda: sweep_of(load_table(source)).case_of(drop, changes))


def sweep_of(table: Mapping[str, Any]) -> Sweep:
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
    >>> study = sweep_of(
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
    case = {key: value for key, value in table.items() if key != "sweep"}
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
    check_laws(case)
    try:
        sweep = _read_settings(case, table["sweep"])
    except InputError as error:
        raise InputError(error.message, f"sweep.{error.key}".rstrip(".")) from None
    _check_points(sweep)
    if "signals" in sweep.section.keep:
        taken_names = {
            *sweep.quantities,
            *LABELS,
            OUTCOME,
            *PEAKS,
            *limit_meanings(),
            *ALL_IMPACT_COLUMNS,
        }
        check_signals(sweep.case, taken_names)
    return sweep


def _read_settings(case: dict[str, Any], settings: Mapping[str, Any]) -> Sweep:
    """Return a study from its case and its [sweep] section, whose points are not checked yet.

    Keys in error messages are relative to the section.
    """
    section = read_table(SweepSection, settings)
    _check_samples(section)
    over, quantities, axes = _read_over(case, section.over)
    section = section.model_copy(update={"over": over})
    population = None
    axes_by_table: dict[str, Mapping[str, Axis]] = {"over": axes}
    if section.classes is not None:
        section, class_quantities, population = _read_population(case, section)
        quantities |= class_quantities
        for name, class_axes in population.own.items():
            axes_by_table[f'classes."{name}".over'] = class_axes
    elif not over:
        raise InputError("it is empty; it takes dotted keys of the case", "over")
    check_count(len(quantities), MOST_KEYS, "swept keys")
    check_scaled(section.design, axes_by_table, quantities)
    check_need_of_signals(section, quantities)
    sweep = Sweep(case, section, axes, quantities, population)
    _check_size(sweep)
    plan = sweep.plan  # of a population without a rock of some class there is none
    if plan.is_grid:
        _check_repeated_levels(axes)
    return sweep


def _check_samples(section: SweepSection) -> None:
    """Check that a number of samples is given where, and only where, points are drawn."""
    design = find_design(section.design)
    if design.is_drawn and section.samples is None:
        raise InputError(
            f"it is missing; {design.name} needs the number of points to draw", "samples"
        )
    if not design.is_drawn and section.samples is not None:
        raise InputError(
            f"{design.name} has as many points as its values give; leave this out", "samples"
        )


def _check_size(sweep: Sweep) -> None:
    """Check that a study has not too many drops, and not too many values to hold them in memory."""
    if sweep.size > MOST_DROPS:
        raise InputError(
            f"there would be {sweep.size} drops, and {MOST_DROPS} are the most; sweep in parts",
            "over",
        )
    keys = len(sweep.quantities)
    if sweep.size * keys > MOST_POINT_VALUES and sweep.section.design != "grid":
        raise InputError(
            f"there would be {sweep.size} drops of {keys} values each, and "
            f"{MOST_POINT_VALUES} values are the most; sweep in parts",
            "over",
        )


def _check_repeated_levels(axes: Mapping[str, Axis]) -> None:
    """Check that no axis of a grid has a level twice."""
    for key, axis in axes.items():
        level = _repeated_level(axis)
        if level is not None:
            raise InputError(
                f"{level} stands there twice, and a grid has each value once", f'over."{key}"'
            )


def _read_over(
    case: Mapping[str, Any], table: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, Quantity | None], dict[str, Axis]]:
    """Return the entries of swept keys in dotted form, their quantities and their axes."""
    over: dict[str, Any] = {}
    for key, value in _flat(table):
        if key in over:
            raise InputError(
                "this key stands there twice, in quotes and in a table", f'over."{key}"'
            )
        over[key] = value
    quantities: dict[str, Quantity | None] = {}
    axes: dict[str, Axis] = {}
    for key, value in over.items():
        try:
            quantities[key] = find_quantity(case, key)
            if isinstance(value, Mapping) and "of" in value:
                axes[key] = read_scaled(value, quantities[key], _followed(case, value["of"]))
            else:
                axes[key] = read_axis(value, quantities[key])
            _check_names(axes[key])
        except InputError as error:
            raise InputError(error.message, f'over."{key}".{error.key}'.rstrip(".")) from None
    return over, quantities, axes


def _followed(case: Mapping[str, Any], key: Any) -> Quantity | None:
    """Return the quantity of the key that another one follows."""
    if not isinstance(key, str):
        raise InputError(
            f'{quoted(key)} is not a text; it is the key that is followed, such as "sphere.radius"',
            "of",
        )
    try:
        return find_quantity(case, key)
    except InputError as error:
        raise InputError(error.message, "of") from None


def _read_population(
    case: Mapping[str, Any], section: SweepSection
) -> tuple[SweepSection, dict[str, Quantity | None], Population]:
    """Return the classes of a population.

    Returns
    -------
    section : SweepSection
        The section with the keys of its classes in dotted form.
    quantities : dict
        Quantities of these keys.
    population : Population
        The population.
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
    tables: dict[str, ClassTable] = {}
    axes: dict[str, dict[str, Axis]] = {}
    for name, table in section.classes.items():
        position = f'classes."{name}"'
        try:
            over, quantities, axes[name] = _read_over(case, table.over)
        except InputError as error:
            raise InputError(error.message, f"{position}.{error.key}") from None
        first_class = next(iter(axes.values()))
        _check_class_keys(over.keys(), first_class.keys(), section.over.keys(), position)
        tables[name] = table.model_copy(update={"over": over})
    if "plate" in section.over:
        raise InputError(
            "a population draws single keys of [plate], one value a plate", 'over."plate"'
        )
    all_rocks = math.ceil((section.samples or 1) / section.falls_per_rock)
    population = Population(
        shares={name: table.share for name, table in tables.items()},
        own=axes,
        falls_per_rock=section.falls_per_rock,
        rocks_per_plate=section.rocks_per_plate or max(1, all_rocks),
    )
    return section.model_copy(update={"classes": tables}), quantities, population


def _check_class_keys(
    keys: Set[str], first_class_keys: Set[str], common_keys: Set[str], position: str
) -> None:
    """Check the swept keys of a class of a population.

    They must be those of the first class, and none of those that all classes have in common.

    Raises
    ------
    InputError
        If they are not.
    """
    not_in_both = sorted(first_class_keys ^ keys)
    if not_in_both:
        message = (
            f'"{not_in_both[0]}" is not there for all classes; give the same keys for all, '
            "or leave it to [sweep.over]"
        )
        raise InputError(message, f"{position}.over")
    if not keys:
        raise InputError(
            "it is empty; give one key or more, the same for all classes", f"{position}.over"
        )
    for key in keys:
        shared = _SHARED.get(key.partition(".")[0])
        reason = ""
        if key in common_keys:
            reason = "it stands in [sweep.over] too"
        elif shared:
            reason = f"{shared} not of a class"
        if reason:
            raise InputError(f"{reason}; leave it out here", f'{position}.over."{key}"')


def _check_names(axis: Axis) -> None:
    """Check the number of distinct names and tables, for each of which a case is validated."""
    if isinstance(axis, Listed) and len(axis.values) > MOST_ITEMS and axis.levels().dtype == object:
        check_count(len(different(axis.levels())), MOST_ITEMS, "different names and tables")


def _repeated_level(axis: Axis) -> str | None:
    """Return a level that an axis has twice, None if it has none.

    It may be in a list, or in a range narrower than the precision of numbers.
    """
    levels = axis.levels()
    if levels.dtype == object:
        level, count = Counter(map(repr, levels.tolist())).most_common(1)[0]
        return shortened(level, 80) if count > 1 else None
    ordered = np.sort(levels)
    repeated = np.flatnonzero(ordered[1:] == ordered[:-1])
    if not repeated.size:
        return None
    return repr(ordered[repeated[0]].item())


def _flat(over: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the swept keys in dotted form with their entries.

    Keys that are not quoted are nested tables in TOML.
    """
    for key, value in over.items():
        dotted = f"{prefix}{key}"
        if isinstance(value, dict) and holds_keys(dotted):
            yield from _flat(value, f"{dotted}.")
        else:
            yield dotted, value


def _check_points(sweep: Sweep) -> None:
    """Check that all values are in range, and that the case is valid.

    The case is validated at the first point, and there with each axis at its ends.
    """
    columns = sweep.plan.columns
    for key, values in columns.items():
        quantity = sweep.quantities[key]
        if quantity is None or values.dtype == object:
            continue
        for position, axis, axis_values in _axes_of(sweep, key, values):
            try:
                quantity.allowed.check(axis_values, quantity.unit)
            except InputError as error:
                raise InputError(
                    f"{error.message}{_remedy(axis)}", f'sweep.{position}."{key}"'
                ) from None
    first = sweep.values_of(0)
    check_swept_sensors(sweep.table, columns, sweep.case_at(first))
    for key, values in columns.items():
        if values.dtype == object:
            tested_values = different(values)
        else:
            tested_values = [values.min(), values.max()]
        for value in tested_values:
            try:
                check_swept_sensors(sweep.table, columns, sweep.case_at({**first, key: value}))
            except InputError as error:
                raise InputError.of_several(
                    f"at {key} = {_level(value)}: {fault}" for fault in error.faults
                ) from None


def _axes_of(sweep: Sweep, key: str, values: Values) -> Iterator[tuple[str, Axis, Values]]:
    """Yield the position of a key, its axis and its values, in [sweep.over] or in each class."""
    if sweep.population is None or key in sweep.axes:
        yield "over", sweep.axes[key], values
        return
    for name, class_axes in sweep.population.own.items():
        in_class = sweep.plan.labels[CLASS] == name
        yield f'classes."{name}".over', class_axes[key], values[in_class]


def _remedy(axis: Axis) -> str:
    """Return what keeps the values of a key in range where they are drawn or follow another key."""
    if isinstance(axis, Scaled):
        return (
            "; it follows another key: choose value, exponent and factor so that "
            "it stays in this range"
        )
    if isinstance(axis, Normal):
        return "; truncate the distribution with at_least and at_most"
    return ""


def _level(value: Any) -> str:
    """Return a value of a swept key for a message."""
    if isinstance(value, float):
        return f"{value:g}"
    return quoted(value)
