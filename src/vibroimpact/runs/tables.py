"""Impact table and energy ledger as text, with units and the number of significant
figures that are certain.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.cases.limits.limit import (
    DURATION,
    FORCE,
    REBOUND,
    RESTITUTION,
    VIBRATION,
)
from vibroimpact.dynamics.motion.columns import (
    ALL_IMPACT_COLUMNS,
    FLUID_LEDGER,
    FRICTION_PARTS,
    LEDGER,
    LEDGER_COLUMNS,
    OBLIQUE_LEDGER,
    SHAKEN_LEDGER,
    SHOWN_IMPACT_COLUMNS,
    VIBRATION_LEDGER,
)
from vibroimpact.report.report import Column, Gap, Table, table_of
from vibroimpact.results.folder import IMPACTS
from vibroimpact.results.result import Result
from vibroimpact.units.display import (
    ALL_FIGURES,
    certain,
    certain_figures,
    column_texts,
    digits,
    fixed,
    multiple,
)

_MOST_ROWS = 50
_FIRST_ROWS = 45
_LAST_ROWS = 3
"""A table of more rows shows only its first 45 and last three."""

_FIRST_IN_TERMINAL = 15
"""In a terminal it shows its first 15 and last three."""

_FIRST_LEFT_OUT = (
    "max_acceleration_m_s2",
    "energy_lost_J",
    "separation_speed_m_s",
    "restitution_asked",
    "max_indentation_m",
    "contacts",
    "rebound_height_m",
    "duration_s",
    "approach_speed_m_s",
)
"""Columns left out in a narrow terminal, in this order, until the others fit."""

_FIGURES_SHOWN = 6  # significant figures in a table of peaks
_DECIMALS_OF_RATIO = 5  # in the table of impacts
_SIGNIFICANT = 5  # figures of other values there

_ROUGH = 0.1
"""Relative error above which a result is shown in two figures."""

_CHANGE_OF_TWO_FIGURES = 0.03

ERRORS_OF_COLUMNS = {
    "max_force_N": FORCE,
    "max_indentation_m": FORCE,
    "max_acceleration_m_s2": FORCE,
    "duration_s": DURATION,
    "restitution_achieved": RESTITUTION,
    "separation_speed_m_s": RESTITUTION,
    "rebound_height_m": REBOUND,
    "energy_to_vibration_J": VIBRATION,
}
"""The results of an impact whose error columns have."""

_ERRORS_OF_ENERGIES = {"potential_J": REBOUND, "kinetic_J": REBOUND}
"""Those whose error entries of the ledger have, which are what the rebound leaves."""

_LOST = ("energy_lost_J", "plastic_work_J")

_ROUNDING = 1e-12
"""Part of the energy put in up to which an energy is a rounding error."""

# relative to the approach speed: lowest separation speed used in estimating the certainty of
# energies
_SLOW = 0.1
SUM = "Sum"
PUT_IN = "Put in at the start"


class LedgerRow(NamedTuple):
    """Row of the ledger as text: name of the entry, title, energy, and percentage of the
    energy put in.
    """

    name: str
    title: str
    energy: str
    part: str


def impact_table(result: Result) -> Table:
    """Return the impact table of the report, in suitable multiples of SI units.

    A long one lacks its middle rows; that of the terminal is shorter.
    """
    number = len(result.impacts["impact"])
    columns = {
        name: formatted_column(name, _above_rounding(result, name), changes_of(result, name))
        for name in shown_columns(result)
    }
    headings = {name: ALL_IMPACT_COLUMNS[name].label for name in columns}
    rows, gap = _rows_shown(number, _MOST_ROWS, _FIRST_ROWS)
    return Table(
        [
            Column(headings[name], [cells[row] for row in rows], unit)
            for name, (unit, cells) in columns.items()
        ],
        gap=gap,
        file=IMPACTS,
        shows_views=True,
        short=_table_for_terminal(result, columns),
    )


def _above_rounding(result: Result, name: str) -> Floats:
    """Return a column of the impact table, with zero for energies lost that are rounding errors."""
    values = result.impacts[name]
    if name not in _LOST:
        return values
    return np.where(np.abs(values) < _ROUNDING * result.energy["input_J"], 0.0, values)


def _rows_shown(number: int, most: int, first: int) -> tuple[list[int], Gap | None]:
    """Return the rows that are shown of a table: all, or the first and the last ones."""
    if number <= most:
        return list(range(number)), None
    rows = [*range(first), *range(number - _LAST_ROWS, number)]
    return rows, Gap(first, number - len(rows))


def _table_for_terminal(result: Result, columns: Mapping[str, tuple[str, list[str]]]) -> Table:
    """Return the impact table of the terminal, from the unit and the cells of each column."""
    most = _FIRST_IN_TERMINAL + _LAST_ROWS
    rows, gap = _rows_shown(len(result.impacts["impact"]), most, _FIRST_IN_TERMINAL)
    notes = {}
    if "energy_to_vibration_J" in result.impacts:
        notes["energy_lost_J"] = energy_lost_sentence(result)
    headings = {name: ALL_IMPACT_COLUMNS[name].short for name in columns}
    return Table(
        [
            Column(headings[name], [cells[row] for row in rows], unit, note=notes.get(name, ""))
            for name, (unit, cells) in columns.items()
        ],
        gap=gap,
        file=IMPACTS,
        expendable=[headings[name] for name in _FIRST_LEFT_OUT if name in headings],
    )


def energy_lost_sentence(result: Result) -> str:
    """Return a sentence on what the energy lost in an impact is."""
    others = "the energy of vibration"
    if "friction_J" in result.energy:
        others = f"friction and {others}"
    return f"Energy lost is the energy dissipated in the contact, without {others}."


def shown_columns(result: Result) -> list[str]:
    """Return the names of the columns of the impact table that are shown for a result: those that
    have a value.

    Contacts are shown only if an impact has several, and the sensitivity only if it reduces the
    number of certain figures. An instantaneous law has neither a duration nor an indentation, and a
    contact that slides throughout no microslip.
    """
    impacts = result.impacts
    shows = {
        "contacts": several_contacts(impacts),
        "sensitivity": loses_digits(result.change_by_impact),
    }
    shows |= {name: bool(np.any(impacts[name])) for name in ("duration_s", "max_indentation_m")}
    microslip = np.abs(impacts.get("microslip_lost_J", np.nan))
    shows["microslip_lost_J"] = bool(np.any(microslip > _ROUNDING * result.energy["input_J"]))
    return [
        name
        for name in SHOWN_IMPACT_COLUMNS
        if shows.get(name, True) and np.isfinite(impacts.get(name, np.nan)).any()
    ]


def several_contacts(impacts: Mapping[str, Floats]) -> bool:
    """Return whether any visit consists of more than one contact."""
    return bool(np.max(impacts.get("contacts", np.ones(1)), initial=1.0) > 1.0)


def ledger_table(result: Result) -> tuple[str, list[LedgerRow]]:
    """Return the final ledger as text: its unit, and a row for each entry, their sum and the energy
    put in, in certain figures.

    Entries that are zero but for rounding are left out. The two parts of friction stand for it,
    where the result has them.
    """
    put_in = result.energy["input_J"]
    scale = multiple("J", result.energy["input_J"])
    parts = {}
    if result.energy.keys() >= FRICTION_PARTS.keys():
        parts["friction_J"] = tuple(FRICTION_PARTS)
    entries = (*LEDGER, *VIBRATION_LEDGER, *SHAKEN_LEDGER, *OBLIQUE_LEDGER, *FLUID_LEDGER)
    values = {
        name: result.energy[name]
        for entry in entries
        for name in parts.get(entry, (entry,))
        if abs(result.energy.get(name, 0.0)) > _ROUNDING * put_in
    }
    figures = {name: _certain_figures_of_energy(name, result) for name in values}
    values |= {SUM: sum(values.values()), PUT_IN: put_in}

    def shown(name: str, value: float, whole: float) -> str:
        return certain(_to_same_decimals(value, whole, 6), value, figures.get(name, ALL_FIGURES))

    rows = []
    for name, value in values.items():
        energy = shown(name, value / scale.size, put_in / scale.size)
        part = shown(name, 100.0 * value / put_in, 100.0)
        title = LEDGER_COLUMNS[name].label if name in LEDGER_COLUMNS else name
        rows.append(LedgerRow(name, title, energy, part))
    return scale.unit, rows


def energy_table(result: Result) -> Table:
    """Return the final ledger as a table; that of the terminal has short names and no sum."""
    unit, ledger = ledger_table(result)
    entries = [row for row in ledger if row.name != SUM]
    short_names = []
    for row in entries:
        short_name = row.name.removesuffix("_J").replace("_", " ")
        short_names.append("put in" if row.name == PUT_IN else short_name)
    short = table_of(
        ["entry", ("", unit), "%"],
        [[name, row.energy, row.part] for name, row in zip(short_names, entries, strict=True)],
        bold=(len(entries) - 1,),
    )
    table = table_of(
        ["Entry", ("Energy", unit), ("Part of the input", "%")],
        [[row.title, row.energy, row.part] for row in ledger],
        bold=[number for number, row in enumerate(ledger) if row.name == SUM],
    )
    return replace(table, short=short)


def energy_text(result: Result, *entries: str) -> str:
    """Return the sum of entries of the ledger as text, with unit and percentage of the
    energy put in, in certain figures.
    """
    value = sum(result.energy[entry] for entry in entries)
    put_in = result.energy["input_J"]
    if abs(value) <= _ROUNDING * put_in:
        return "nothing"
    figures = min(_certain_figures_of_energy(entry, result) for entry in entries)
    scale = multiple("J", value)
    part = 100.0 * value / put_in
    percent = certain(fixed(part, 1), part, figures)
    return (
        f"{certain(digits(value / scale.size), value / scale.size, figures)}\u00a0{scale.unit} "
        f"({percent} %)"
    )


def _certain_figures_of_energy(entry: str, result: Result) -> int:
    """Return the number of certain significant figures of an entry of the ledger.

    The relative change of an energy is twice that of the speed. For lost energy it is the mean over
    the impacts, weighted by the energy lost in each. For energy in motion or stored it is that of
    the last impact, or more where the entry is smaller than the energy with which the sphere left:
    this changes as a whole, whatever share of it the entry is.
    """
    impacts = result.impacts
    error_name = VIBRATION if entry in VIBRATION_LEDGER else _ERRORS_OF_ENERGIES.get(entry, "")
    if result.relative_errors.get(error_name, 0.0) > _ROUGH:
        return int(certain_figures(_CHANGE_OF_TWO_FIGURES))
    change = np.minimum(np.nan_to_num(result.change_by_impact, nan=1.0), 1.0)
    if not len(change) or not change[-1] > 0.0:
        return ALL_FIGURES
    lost = np.abs(impacts["energy_lost_J"])
    if LEDGER_COLUMNS[entry].is_loss and lost.sum() > 0.0:
        return int(certain_figures(2.0 * change @ lost / lost.sum()))
    first, closing, separation = (
        float(impacts[name][place])
        for name, place in (
            ("approach_speed_m_s", 0),
            ("approach_speed_m_s", -1),
            ("separation_speed_m_s", -1),
        )
    )
    # the change of a slow separation speed is relative to a tenth of the approach speed
    energy = result.energy["input_J"] * separation * max(separation, _SLOW * closing) / first**2
    value = abs(result.energy[entry])
    magnification = 1.0
    if value > 0.0:
        magnification = max(1.0, energy / value)
    return int(certain_figures(2.0 * change[-1] * magnification))


def _to_same_decimals(value: float, whole: float, significant: int) -> str:
    """Return a part of a sum as text with the decimals of the total; a very small part
    has its own significant digits.
    """
    if abs(value) < _ROUNDING * whole:
        return "0"
    decimals = max(0, significant - 1 - math.floor(math.log10(whole)))
    if decimals > 12:
        return digits(value, significant)
    if abs(value) >= 100.0 * 10.0**-decimals:
        return fixed(value, decimals)
    return digits(value, 3)  # of which fewer than three would be left


def significant_figures(name: str, change: Floats) -> Indices:
    """Return the number of certain significant figures of a column of the impact table, for each
    impact.

    Parameters
    ----------
    name : str
        Name of the column.
    change : array, shape (impacts,)
        Relative change of each impact [-] for an unavoidable perturbation of the drop, as
        `Result.change_by_impact`.

    Examples
    --------
    >>> (
    ...     significant_figures("max_force_N", np.array([0.0, 0.003])).tolist(),
    ...     significant_figures("time_s", np.array([0.0, 0.003])).tolist(),
    ... )
    ([17, 3], [17, 17])
    """
    certain_as = ALL_IMPACT_COLUMNS[name].certain_as
    if certain_as == "exact":
        return np.full(len(change), ALL_FIGURES)
    if certain_as == "arrival":
        change = np.concatenate([change[:1], change[:-1]])
    return certain_figures(change)


def changes_of(result: Result, name: str) -> Floats:
    """Return the relative change of each impact [-] that leaves the figures of a column.

    It is that for an unavoidable perturbation of the drop. What is off by more than a tenth, by the
    estimated error of the first impact, has two figures.
    """
    error = result.relative_errors.get(ERRORS_OF_COLUMNS.get(name, ""), 0.0)
    if error > _ROUGH:
        return np.fmax(result.change_by_impact, _CHANGE_OF_TWO_FIGURES)
    return result.change_by_impact


def impact_text(result: Result, impact: int, name: str, unit: str) -> str:
    """Return an entry of the impact table as text with its unit, in certain figures."""
    value = float(result.impacts[name][impact])
    figures = int(significant_figures(name, changes_of(result, name))[impact])
    best = multiple(unit, value, figures)
    return (
        f"{certain(digits(value / best.size), value / best.size, figures)}\u00a0{best.unit}".rstrip(
            "\u00a0"
        )
    )


def loses_digits(change: Floats) -> bool:
    """Return whether some impact has fewer certain significant figures than tables show."""
    return bool(certain_figures(change).min(initial=_FIGURES_SHOWN) < _FIGURES_SHOWN)


def formatted_column(
    name: str, values: Floats, change: Floats | None = None
) -> tuple[str, list[str]]:
    """Return the unit and the cells of a column of the impact table as text, in certain figures.

    Parameters
    ----------
    name : str
        Name of the column.
    values : array, shape (rows,)
        Values in SI units.
    change : array, shape (rows,), optional
        Relative change of each row's impact [-], as `Result.change_by_impact`; by default 0, which
        leaves all figures.
    """
    kind = ALL_IMPACT_COLUMNS[name].values
    if kind == "count":
        return "", [fixed(value, 0) for value in values]
    if kind == "factor":
        return "", [digits(value, 2) for value in values]
    if change is None:
        change = np.zeros(len(values))
    figures = significant_figures(name, change).tolist()
    unit, values, cells = _cells(name, values, max(figures, default=ALL_FIGURES))
    return unit, [
        certain(cell, value, number)
        for cell, value, number in zip(cells, values, figures, strict=True)
    ]


def _cells(name: str, values: Floats, figures: int) -> tuple[str, Floats, list[str]]:
    """Return the unit in which a column is shown, its values in this unit, and their texts.

    `figures`: how many of the value that is known best are certain.
    """
    column = ALL_IMPACT_COLUMNS[name]
    if column.values == "ratio":
        return "", values, [fixed(value, _DECIMALS_OF_RATIO) for value in values]
    scale = multiple(column.unit, values, figures)
    values = values / scale.size
    if column.values == "time":
        # times are compared with each other: their absolute resolution is a microsecond, also late
        # in a run
        decimals = 6 if scale.unit == "s" else 3
        return scale.unit, values, [fixed(value, decimals) for value in values]
    return scale.unit, values, column_texts(values, _SIGNIFICANT)
