"""The tables of the page, as text that is ready to show."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vibroimpact.quantity import digits, fixed, multiple
from vibroimpact.report.excerpt import Floats
from vibroimpact.storage.result import Result

_MOST_ROWS, _FIRST, _LAST = 50, 45, 3
"""A table of more rows shows only its first and last ones."""

_CONTACTS = {"contacts": "Contacts in the visit"}
"""Shown where a visit has more than one: the plate comes back to the sphere, or the sphere's own vibration does."""

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
    shown = {**HEADERS, **(_CONTACTS if several_contacts(result.impacts) else {})}
    columns = [column(name, result.impacts[name]) for name in shown]
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


def column(name: str, values: Floats) -> tuple[str, list[str]]:
    """Return unit and cells of a column of the impact table."""
    if name in ("impact", "contacts"):
        return "", [fixed(value, 0) for value in values]
    if name.startswith("restitution"):
        return "", [fixed(value, 4) for value in values]
    scale = multiple(next(unit for end, unit in _UNITS.items() if name.endswith(end)), values)
    if name == "time_s":
        # times are compared with each other: a microsecond counts, however late it is
        return scale.unit, [fixed(value, 6 if scale.unit == "s" else 3) for value in values / scale.size]
    return scale.unit, [digits(value) for value in values / scale.size]
