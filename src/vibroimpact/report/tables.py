"""The tables of the page, as text that is ready to show."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.quantity import certain, digits, fixed, multiple
from vibroimpact.report.excerpt import Floats
from vibroimpact.storage.result import Result

_MOST_ROWS, _FIRST, _LAST = 50, 45, 3
"""A table of more rows shows only its first and last ones."""

_CONTACTS = {"contacts": "Contacts in the visit"}
"""Shown where a visit has more than one: the plate comes back to the sphere, or the sphere's own vibration does."""

_SHOWN, _ALL = 6, 17  # significant figures in a table, and of a number

_SENSITIVITY = {"sensitivity": "Sensitivity"}
"""Shown where it takes digits away."""

_EXACT = ("impact", "contacts", "restitution_asked", "sensitivity")
_ARRIVAL = ("time_s", "approach_speed_m_s")
"""Columns of which a change of the drop takes no digits, and those that have the digits of the impact before."""

HEADERS = {
    "impact": "Impact",
    "time_s": "First touch",
    "duration_s": "Contact duration",
    "approach_speed_m_s": "Approach speed",
    "separation_speed_m_s": "Separation speed",
    "restitution_asked": "Restitution asked",
    "restitution_achieved": "Restitution achieved",
    "max_indentation_m": "Largest indentation",
    "max_force_N": "Largest force",
    "max_acceleration_m_s2": "Largest acceleration",
    "rebound_height_m": "Rebound height",
    "energy_lost_J": "Energy lost",
}
"""The columns of the impact table that are shown, and how they are headed."""

_ENTRIES = {
    "kinetic_J": "Kinetic energy of the sphere",
    "potential_J": "Potential energy of the sphere, zero at the height of first touch",
    "contact_elastic_J": "Stored in the contact",
    "contact_dissipated_J": "Lost in the damping of the contact, or where a sticking contact broke",
    "plastic_work_J": "Lost in plastic deformation",
    "written_off_at_rest_J": "Written off when the sphere was found to be at rest",
}
_OF_VIBRATION = {
    "sphere_vibration_J": "Kinetic energy of the sphere's vibration, beside that of its centre",
    "sphere_strain_J": "Strain energy of the sphere's modes",
    "sphere_damping_J": "Lost in the damping of the sphere's modes",
    "plate_kinetic_J": "Kinetic energy of the plate",
    "plate_strain_J": "Strain energy of the plate's modes, from where it rests",
    "plate_damping_J": "Lost in the damping of the plate's modes",
}
_UNITS = {"_m_s2": "m/s2", "_m_s": "m/s", "_s": "s", "_m": "m", "_N": "N", "_J": "J"}
"""Units by the ends of column names, the longest first."""


class Table(NamedTuple):
    """A table: headers with their units, rows, and what is left out between `head` and `tail`."""

    headers: list[tuple[str, str]]
    head: list[list[str]]
    left_out: int
    tail: list[list[str]]


def impact_table(result: Result) -> Table:
    """Return the impact table in multiples of units; a long one without its middle."""
    change = result.change_by_impact
    shown = {**HEADERS, **(_CONTACTS if several_contacts(result.impacts) else {}), **(_SENSITIVITY if takes_digits(change) else {})}
    columns = [column(name, result.impacts[name], change) for name in shown]
    headers = [(header, unit) for header, (unit, _) in zip(shown.values(), columns, strict=True)]
    rows = [list(row) for row in zip(*(cells for _, cells in columns), strict=True)]
    if len(rows) <= _MOST_ROWS:
        return Table(headers, rows, 0, [])
    return Table(headers, rows[:_FIRST], len(rows) - _FIRST - _LAST, rows[-_LAST:])


def several_contacts(impacts: Mapping[str, Floats]) -> bool:
    """Has any visit more than one contact?"""
    return bool(np.max(impacts.get("contacts", np.ones(1)), initial=1.0) > 1.0)


def ledger_table(result: Result) -> list[tuple[str, str, str]]:
    """Return the ledger at the end: entry, energy [J] and part of the energy put in [%]."""
    put_in = result.energy["input_J"]
    entries = [(title, result.energy[name]) for name, title in {**_ENTRIES, **_OF_VIBRATION}.items() if name in result.energy]
    lines = [*entries, ("Sum", sum(value for _, value in entries)), ("Put in at the start", put_in)]
    return [(title, _beside(value, put_in, 6), _beside(100.0 * value / put_in, 100.0, 6)) for title, value in lines]


def _beside(value: float, whole: float, significant: int) -> str:
    """Return a part with the decimals of its whole, so that they add up by eye; a very small one in digits of its own."""
    if abs(value) < 1e-12 * whole:
        return "0"
    decimals = max(0, significant - 1 - math.floor(math.log10(whole)))
    if decimals > 12:
        return digits(value, significant)
    return fixed(value, decimals) if abs(value) >= 100.0 * 10.0**-decimals else digits(value, 3)


def certain_figures(change: Floats, name: str = "max_force_N") -> NDArray[np.intp]:
    """Return how many significant figures of a column of the impact table are certain; the last may be off by three.

    Parameters
    ----------
    change : array, shape (impacts,)
        Relative change of each impact [-] for one in the drop that nobody can rule out.
    name : str
        The column.

    Examples
    --------
    >>> certain_figures(np.array([0.0, 1e-9, 0.003, 0.12, 0.5])).tolist()
    [17, 9, 3, 1, 0]
    """
    if name in _EXACT:
        return np.full(len(change), _ALL)
    if name in _ARRIVAL:
        change = np.concatenate([change[:1], change[:-1]])
    with np.errstate(divide="ignore", invalid="ignore"):
        figures = np.floor(0.5 - np.log10(np.nan_to_num(change, nan=np.inf)))
    return np.clip(figures, 0, _ALL).astype(np.intp)


def takes_digits(change: Floats) -> bool:
    """Do some impacts have fewer significant figures than tables show, as a change of the drop grows?"""
    return bool(certain_figures(change).min(initial=_SHOWN) < _SHOWN)


def column(name: str, values: Floats, change: Floats | None = None) -> tuple[str, list[str]]:
    """Return unit and cells of a column of the impact table, with the digits that they have where a change of the drop grows."""
    if name in ("impact", "contacts"):
        return "", [fixed(value, 0) for value in values]
    if name == "sensitivity":
        return "", [digits(value, 2) for value in values]
    unit, values, cells = _cells(name, values)
    figures = certain_figures(np.zeros(len(values)) if change is None else change, name).tolist()
    return unit, [certain(cell, value, number) for cell, value, number in zip(cells, values, figures, strict=True)]


def _cells(name: str, values: Floats) -> tuple[str, Floats, list[str]]:
    """Return the unit in which a column is shown, its values in it, and these as texts."""
    if name.startswith("restitution"):
        return "", values, [fixed(value, 4) for value in values]
    scale = multiple(next(unit for end, unit in _UNITS.items() if name.endswith(end)), values)
    values = values / scale.size
    if name == "time_s":
        # times are compared with each other: a microsecond counts, however late it is
        return scale.unit, values, [fixed(value, 6 if scale.unit == "s" else 3) for value in values]
    return scale.unit, values, [digits(value) for value in values]
