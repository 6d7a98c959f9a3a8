"""What is said of the modes of a body: its facts, the table of its lowest modes, and measured ones
beside them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.report.report import Column, Gap, Quantity, Table
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.units.display import MISSING, column_texts, fixed, text

ROWS = 20
"""Lowest modes in a table."""

_UNKNOWN = "not known"
_ROUNDING = 1e-6  # of a reference value: what is less is shown as zero


def body_facts(modes: BodyModes) -> list[tuple[str, str]]:
    """Return mass and mesh of a body, how it is held, its rigid motions and its damping:
    what each is, and words.
    """
    properties = modes.model.properties
    facts = modes.model.facts
    rows = [
        (
            "mesh",
            f"{properties.mass:.6g} kg, {facts['elements']}, {facts['degrees of freedom']} "
            "degrees of freedom",
        ),
        ("held by", supports_text(modes.body)),
        ("rigid motions", str(len(modes.model.rigid_coefficients))),
        ("damping", modes.body.damping.description),
    ]
    return rows + [
        (what, facts[what]) for what in ("materials", "left out of the file") if what in facts
    ]


def mode_table(modes: BodyModes) -> Table:
    """Return the table of the lowest modes, and of the highest one if some are left out;
    without columns that say nothing.
    """
    basis = modes.basis
    number = len(basis.frequencies)
    shown = list(range(min(ROWS, number)))
    if number > ROWS:
        shown.append(number - 1)
    left_out = number - len(shown)
    gap = Gap(ROWS, left_out) if left_out else None
    # effective modal mass along z: the square of the participation of a mode of unit mass
    effective = basis.participation[:, 2] ** 2
    errors = _error_texts(modes.model.frequency_errors[shown])
    shapes = _fixed_texts(basis.contact[shown], float(np.abs(basis.contact).max()))
    masses = _fixed_texts(effective[shown], modes.model.properties.mass)
    columns = [
        Column("mode", [str(mode + 1) for mode in shown]),
        Column("frequency", column_texts(basis.frequencies[shown], 6), "Hz"),
        Column("within", errors, "%"),
        Column("damping ratio", column_texts(basis.damping_ratios[shown], 4)),
        Column("shape at contact", shapes, "1/sqrt kg"),
        Column("effective mass, vertical", masses, "kg"),
    ]
    return Table(
        [column for column in columns if set(column.cells) - {"0", _UNKNOWN}],
        title="Frequencies",
        gap=gap,
        file="modes.csv",
    )


def supports_text(body: ElasticBody) -> str:
    """Return in words how a body is held."""
    return (
        "; ".join(support.description for support in body.recipe.supports) or "nothing: it is free"
    )


def _error_texts(errors: Floats) -> list[str]:
    """Return relative frequency errors in per cent, as text."""
    cells = column_texts(100.0 * errors, 2)
    return [_UNKNOWN if cell == MISSING else cell for cell in cells]


def _fixed_texts(values: Floats, reference: float) -> list[str]:
    """Return numbers with four decimals, or 0 where they are rounding errors relative to
    a reference value.
    """
    texts = []
    for value in values:
        is_rounding = not abs(value) > _ROUNDING * reference
        texts.append("0" if is_rounding else fixed(float(value), 4))
    return texts


def mode_title(model: ModalModel, mode: int) -> str:
    """Return the number of a mode, counted from 1, and its frequency."""
    return f"{mode + 1}: {text(float(model.frequencies[mode]), 'Hz', 5)}"


class MeasuredTable(NamedTuple):
    """Measured modes beside those of a case.

    `table` is what is shown; `columns` and `rows` are the table of `measured.csv`; `doubts` is
    what is not sure; and `quantities` are the main results.
    """

    table: Table
    columns: Sequence[str]
    rows: Sequence[Mapping[str, Any]]
    doubts: Sequence[str]
    quantities: Sequence[Quantity] = ()
