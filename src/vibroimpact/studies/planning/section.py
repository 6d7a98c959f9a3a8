"""The [sweep] section of a case: swept keys with their values, design, and kept results."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from vibroimpact.cases.fields.quantities import Quantity, read_quantity
from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.cases.fields.size_limits import FileName, Name
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.table_file import TableFile, read_table_file
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range
from vibroimpact.studies.planning.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.planning.design import MOST_DROPS, designs, find_design
from vibroimpact.studies.planning.scaled import Each, Scaled

_LEVELS = 10  # default number of levels of a range or a distribution in a grid
_Levels = Annotated[int, Field(ge=2, le=MOST_DROPS, strict=True)]


def _read_design(value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(
            f"{quoted(value)} is not allowed; it must be one of {', '.join(designs())}"
        )
    return find_design(value).name


class WindowTable(Section):
    """The part of a signal around the first touch."""

    before: Annotated[float, Quantity("s", "kept before the first touch", Range(at_least=0))] = 0.0
    length: Annotated[float, Quantity("s", "length of the part that is kept", Range(above=0))]


class ClassTable(Section):
    """A class of rocks of a population."""

    share: Annotated[
        float,
        Quantity("", "share of the rocks, relative to those of the other classes", Range(above=0)),
    ] = 1.0
    over: dict[str, Any] = Field(
        description="the distributions of this class by dotted keys, the same keys for all classes"
    )


class SweepSection(Section):
    """Settings of `vibroimpact sweep`; a run ignores them."""

    design: Annotated[
        str, BeforeValidator(_read_design), WithJsonSchema({"enum": list(designs())})
    ] = Field(
        "grid",
        description="design, the choice of the points: "
        + "; ".join(f"{design.name}: {design.meaning}" for design in designs().values()),
    )
    over: dict[str, Any] = Field(
        description='the values of dotted keys of the case, such as "sphere.radius": a list, a '
        "range { from, to, number, scale }, "
        'a distribution { distribution = "normal", "lognormal" or "uniform", ... }, a '
        "column of a file { file, column, weights }, "
        "or a dependence on another key { value, of, at, exponent, factor }"
    )
    samples: Annotated[int, Field(ge=1, le=MOST_DROPS, strict=True)] | None = Field(
        None, description="number of sampled points"
    )
    seed: Annotated[int, Field(ge=0, strict=True)] = Field(0, description="seed of the sampling")
    keep: tuple[Literal["peaks", "impacts", "signals"], ...] = Field(
        ("impacts",),
        description="stored results of each drop: peaks (always stored), the impact table, the "
        "signals of the sensors",
    )
    window: WindowTable | None = Field(
        None, description="the part of the signals that is kept; by default all, from the start"
    )
    classes: dict[Name, ClassTable] | None = Field(
        None, description="classes of a population, by name, with the distributions of each"
    )
    falls_per_rock: Annotated[int, Field(ge=1, le=MOST_DROPS, strict=True)] = Field(
        1,
        description="number of falls of each rock of a population, with all keys in common but "
        "those of [drop]",
    )
    rocks_per_plate: Annotated[int, Field(ge=1, le=MOST_DROPS, strict=True)] | None = Field(
        None,
        description="number of rocks of a population on each plate, with the keys of [plate] "
        "and of sensors in common; by default all",
    )


class RangeTable(Section):
    """Values from one to another."""

    start: Any = Field(alias="from")
    end: Any = Field(alias="to")
    number: _Levels = _LEVELS
    scale: Literal["linear", "log"] = "linear"


class UniformTable(RangeTable):
    """A uniform distribution, on a linear or a logarithmic scale."""

    distribution: Literal["uniform"]


class NormalTable(Section):
    """A normal or a lognormal distribution, perhaps truncated."""

    distribution: Literal["normal", "lognormal"]
    mean: Any
    standard_deviation: Any
    at_least: Any = None
    at_most: Any = None
    number: _Levels = _LEVELS


class ColumnTable(Section):
    """The values in a column of a CSV file, and their weights in another."""

    file: FileName
    column: str
    weights: str | None = None
    columns: str | None = Field(
        None,
        description="columns of the file in place of its header, in order, such as "
        '"radius=mm,-,share", '
        "with - for one left out",
    )


class ScaledTable(Section):
    """A value that follows another key by a power, times a factor."""

    value: Any
    at: Any
    of: str
    exponent: Annotated[float, Quantity("", "exponent")] = 1.0
    factor: Any = Field(default_factory=lambda: [1.0])
    each: Each | None = None


_DISTRIBUTIONS: dict[str, type[Section]] = {
    "normal": NormalTable,
    "lognormal": NormalTable,
    "uniform": UniformTable,
}
_ASKED = (
    "a list of values, a range { from, to, number, scale }, a distribution or a column { file, "
    "column, weights, columns }"
)
_DEPENDENCE = ", or a dependence on another key { value, of, at, exponent, factor }"


def read_axis(value: Any, quantity: Quantity | None, otherwise: str = _DEPENDENCE) -> Axis:
    """Return the axis of a swept key.

    Parameters
    ----------
    value : any
        Its entry in the TOML file.
    quantity : Quantity or None
        The quantity of the key; None if it is not a quantity, so that only a list is allowed.
    otherwise : str
        What is allowed in addition, for a message.

    Raises
    ------
    InputError
        If the entry is invalid, or the distribution is unknown.

    Examples
    --------
    >>> read_axis(
    ...     {"from": "5 mm", "to": "50 mm", "number": 2}, Quantity("m", "radius")
    ... ).levels().tolist()
    [0.005, 0.05]
    """
    if isinstance(value, list):
        if not value:
            raise InputError("the list is empty; it must have one value or more")
        if quantity is None:
            return Listed(tuple(value))
        return Listed(tuple(_read_item(item, quantity) for item in value))
    if quantity is None:
        raise InputError("this key holds no quantity, so that it takes a list of values alone")
    if not isinstance(value, Mapping):
        raise InputError(f"{quoted(value)} is not allowed; it must be {_ASKED}{otherwise}")
    if "file" in value:
        return _read_column(read_table(ColumnTable, value), quantity)
    if "distribution" in value:
        return _read_distribution(value, quantity)
    if "from" not in value and "to" not in value:
        raise InputError(f"{quoted(value)} has no values; it must be {_ASKED}{otherwise}")
    return _spaced(read_table(RangeTable, value), quantity, is_random=False)


def _read_distribution(value: Mapping[str, Any], quantity: Quantity) -> Axis:
    """Return the axis of a key with a distribution."""
    name = value["distribution"]
    if not isinstance(name, str) or name not in _DISTRIBUTIONS:
        hint = did_you_mean(str(name), _DISTRIBUTIONS)
        raise InputError(
            f"{quoted(name)} is not allowed; it must be one of {', '.join(_DISTRIBUTIONS)}.{hint}",
            "distribution",
        )
    table = read_table(_DISTRIBUTIONS[name], value)
    if isinstance(table, NormalTable):
        return _normal(table, quantity)
    return _spaced(table, quantity, is_random=True)


def read_scaled(
    value: Mapping[str, Any], quantity: Quantity | None, followed: Quantity | None
) -> Scaled:
    """Return the axis of a swept key that follows another one.

    Parameters
    ----------
    value : mapping
        Its entry in the TOML file.
    quantity, followed : Quantity or None
        The quantities of the key and of the one that it follows; None of a key that is not a
        quantity.

    Raises
    ------
    InputError
        If the entry is invalid, or a key is not a quantity.
    """
    if quantity is None or followed is None:
        raise InputError(
            "a key can follow another only if both are quantities; take a list of values"
        )
    table = read_table(ScaledTable, value)
    reference_value = _number(table.value, quantity, quantity.allowed, "value")
    at = _number(table.at, followed, Range(above=0), "at")
    try:
        factor = _factor(table.factor)
    except InputError as error:
        raise InputError(error.message, f"factor.{error.key}".rstrip(".")) from None
    return Scaled(reference_value, at, table.of, table.exponent, factor, table.each)


def _factor(value: Any) -> Axis:
    """Return the axis of a factor, whose list has numbers alone."""
    quantity = Quantity("", "factor", Range(above=0))
    if isinstance(value, list):
        value = [_number(item, quantity, quantity.allowed) for item in value]
    return read_axis(value, quantity, otherwise="")


def _read_item(item: Any, quantity: Quantity) -> Any:
    """Return one value of a list.

    Keys with plain numbers, such as the damping, may also take names and tables.
    """
    if isinstance(item, (list, dict)) or (isinstance(item, str) and not quantity.unit):
        return item
    return quantity.read(item)


def _number(value: Any, quantity: Quantity, allowed: Range, key: str = "") -> float:
    try:
        return read_quantity(value, quantity.unit, allowed)
    except InputError as error:
        raise InputError(error.message, key) from None


def _spaced(table: Section, quantity: Quantity, *, is_random: bool) -> Spaced:
    assert isinstance(table, RangeTable)
    start = _number(table.start, quantity, quantity.allowed, "from")
    end = _number(table.end, quantity, quantity.allowed, "to")
    if not end > start:
        raise InputError(f"{end:.16g} is not greater than from, {start:.16g}", "to")
    if table.scale == "log" and start <= 0.0:
        raise InputError(f"{start:g} has no logarithm; it must be greater than 0", "from")
    return Spaced(start, end, table.number, table.scale, is_random)


def _normal(table: NormalTable, quantity: Quantity) -> Normal:
    # the mean itself need not be allowed: the distribution may be truncated
    mean = _number(table.mean, quantity, Range(), "mean")
    deviation = _number(table.standard_deviation, quantity, Range(above=0), "standard_deviation")
    at_least = -math.inf
    if table.at_least is not None:
        at_least = _number(table.at_least, quantity, Range(), "at_least")
    at_most = math.inf
    if table.at_most is not None:
        at_most = _number(table.at_most, quantity, Range(), "at_most")
    if table.at_least is not None and table.at_most is not None and not at_most > at_least:
        raise InputError(f"{at_most:.16g} is not more than at_least, {at_least:.16g}", "at_most")
    return Normal(
        mean,
        deviation,
        table.number,
        at_least=at_least,
        at_most=at_most,
        lognormal=table.distribution == "lognormal",
    )


def _read_column(table: ColumnTable, quantity: Quantity) -> Listed:
    """Return the values, and optionally weights, in columns of a CSV file.

    Its header gives the units.
    """
    name = name_and_unit(table.column)[0]
    weights = None
    if table.weights is not None:
        weights = name_and_unit(table.weights)[0]
    units = {name: quantity.unit}
    if weights:
        units[weights] = ""
    try:
        file = read_table_file(table.file, units, columns=table.columns)
    except InputError as error:
        raise InputError(error.message, "file") from None
    if name not in file.columns:
        raise InputError(f'there is no column "{name}" in {table.file}', "column")
    if weights is not None and weights not in file.columns:
        raise InputError(f'there is no column "{weights}" in {table.file}', "weights")
    _check_column(table, file, name, quantity.allowed, quantity.unit)
    values = tuple(float(value) for value in file.columns[name])
    if weights is None:
        return Listed(values)
    _check_column(table, file, weights, Range(at_least=0), "")
    if not file.columns[weights].any():
        raise InputError("all weights are zero", "weights")
    return Listed(values, tuple(file.columns[weights].tolist()))


def _check_column(
    table: ColumnTable, file: TableFile, name: str, allowed: Range, unit: str
) -> None:
    """Check that the values of a column are in their range; a message names the line."""
    for value, line in zip(file.columns[name].tolist(), file.lines, strict=True):
        try:
            allowed.check(value, unit)
        except InputError as error:
            raise InputError(f"{table.file}, line {line}: {error.message}", "file") from None
