"""What is said of the modes of a body, as text for the terminal and the page: its facts,
and the table of its lowest modes.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.units.display import MISSING, column_texts, fixed

ROWS = 20
"""Lowest modes in a table."""

_UNKNOWN = "not known"

Cells = tuple[list[tuple[str, str]], list[list[str]]]
"""Headings with units, and rows."""


def body_facts(name: str, found: BodyModes) -> list[tuple[str, str]]:
    """Return mass and mesh of a body, how it is held, its rigid motions and its damping:
    what each is, and words.
    """
    properties, facts = found.model.properties, found.model.facts
    rows = [
        (
            name,
            f"{properties.mass:.6g} kg, {facts['elements']}, {facts['degrees of freedom']} "
            "degrees of freedom",
        ),
        ("held by", supports_text(found.body)),
        ("rigid motions", str(len(found.model.rigid_coefficients))),
        ("damping", found.body.damping.description),
    ]
    return rows + [
        (what, facts[what]) for what in ("materials", "left out of the file") if what in facts
    ]


def mode_table(found: BodyModes) -> Cells:
    """Return the table of the lowest modes, and of the highest one if some are left out;
    without columns that say nothing.
    """
    basis, number = found.basis, len(found.basis.frequencies)
    shown = list(range(min(ROWS, number))) + ([number - 1] if number > ROWS else [])
    effective = basis.participation[:, 2] ** 2
    headers = [
        ("mode", ""),
        ("frequency", "Hz"),
        ("within", "%"),
        ("damping ratio", ""),
        ("shape at contact", "1/sqrt kg"),
        ("effective mass, vertical", "kg"),
    ]
    columns = [
        [str(mode + 1) for mode in shown],
        column_texts(basis.frequencies[shown], 6),
        _error_texts(found.model.frequency_errors[shown]),
        column_texts(basis.damping_ratios[shown], 4),
        _fixed_texts(basis.contact[shown], float(np.abs(basis.contact).max())),
        _fixed_texts(effective[shown], found.model.properties.mass),
    ]
    told = [number for number, cells in enumerate(columns) if set(cells) - {"0", _UNKNOWN}]
    return [headers[number] for number in told], [
        list(row) for row in zip(*(columns[number] for number in told), strict=True)
    ]


def rows_left_out(found: BodyModes) -> int:
    """Return how many modes the table leaves out, before the highest one."""
    return max(0, len(found.basis.frequencies) - ROWS - 1)


def supports_text(body: ElasticBody) -> str:
    """Return in words how a body is held."""
    return (
        "; ".join(support.description for support in body.recipe.supports) or "nothing: it is free"
    )


def _error_texts(errors: Floats) -> list[str]:
    """Return relative frequency errors in per cent, as text."""
    return [cell if cell != MISSING else _UNKNOWN for cell in column_texts(100.0 * errors, 2)]


def _fixed_texts(values: Floats, reference: float) -> list[str]:
    """Return numbers with four decimals, or 0 where they are rounding errors relative to
    a reference value.
    """
    return [fixed(float(value), 4) if abs(value) > 1e-6 * reference else "0" for value in values]
