"""What a comparison of contact laws tells: the first impact under each law, and the charts."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.motion.columns import ALL_IMPACT_COLUMNS, impact_columns
from vibroimpact.files.result_folder import write_case
from vibroimpact.law_comparison.charts import comparison_charts
from vibroimpact.law_comparison.comparison import Comparison
from vibroimpact.report.report import (
    Column,
    Explanation,
    Facts,
    Note,
    Quantity,
    Report,
    Section,
    Table,
)
from vibroimpact.results.csv_files import impact_rows, write_csv
from vibroimpact.results.result import Result
from vibroimpact.runs.tables import formatted_column
from vibroimpact.units.display import MISSING, text

_COLUMNS = ("max_indentation_m", "max_force_N", "duration_s", "rebound_height_m", "energy_lost_J")
"""Columns of the first impact that are compared."""


def report_of(comparison: Comparison) -> Report:
    """Return the report of a comparison of contact laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> comparison = vi.laws.compare_laws(vi.load_case("paper:type1-theory"), ["tsuji", "flores"])
    >>> report = report_of(comparison)
    >>> report.title, list(report.files)
    ('One drop with 2 contact laws', ['comparison.csv', 'cases/tsuji.toml', 'cases/flores.toml'])
    """
    number = len(comparison.results)
    laws = "law" if number == 1 else "laws"
    summary = _summary(comparison)
    cases = {
        name: {**entries, "case": comparison.results[name].case}
        for name, entries in summary["laws"].items()
    }
    free_parameters = [
        (name, free_parameter_of(law), comparison.results[name].status)
        for name, law in comparison.laws.items()
    ]
    impact = Section(
        "impact",
        "First impact and restitution",
        (
            first_impacts(comparison),
            Note(
                "Indentation, force, duration, height and energy are those of the first impact; "
                "energy lost is dissipated in its contact."
            ),
            Explanation(
                "Restitution is separation speed over approach speed; the restitution asked is a "
                "parameter of the law, the one achieved a result. Energy lost is the energy "
                "dissipated in the contact, without friction and the energy of vibration. All "
                "impacts are in comparison.csv. A dash stands for a value that does not exist."
            ),
        ),
    )
    loss = Section("loss", "Loss parameters, and end of each run", (Facts(free_parameters),))
    return Report(
        # without the name of the case, which may mention a law that is not compared
        title=f"One drop with {number} contact {laws}",
        answer=_drop(comparison),
        quantities=list(_answer(comparison)),
        sections=(impact, loss),
        charts=comparison_charts(comparison),
        warnings=comparison_warnings(comparison),
        files={
            "comparison.csv": partial(_write_impacts, comparison),
            **{
                f"cases/{name}.toml": partial(write_case, result.case)
                for name, result in comparison.results.items()
            },
        },
        summary=summary,
        data={**summary, "laws": cases},
        provenance="the case under each law is in the folder cases.",
    )


def _answer(comparison: Comparison) -> Iterator[Quantity]:
    """Yield how far results of the first impact differ between the laws, and which laws do."""
    names = list(comparison.results)
    for column in ("restitution_achieved", *_COLUMNS):
        values = np.array(
            [_first(result.impacts[column], np.nan) for result in comparison.results.values()]
        )
        if not np.isfinite(values).any():
            continue
        smallest = int(np.nanargmin(values))
        largest = int(np.nanargmax(values))
        note = f"smallest by {names[smallest]}, largest by {names[largest]}"
        if smallest == largest:
            note = f"by {names[smallest]}"
        label = ALL_IMPACT_COLUMNS[column].label
        unit = ALL_IMPACT_COLUMNS[column].unit
        yield Quantity(
            label, float(values[smallest]), unit, note=note, largest=float(values[largest])
        )


def _drop(comparison: Comparison) -> str:
    """Return the sentence on the drop: its case and its first approach speed."""
    speeds = next(iter(comparison.results.values())).impacts["approach_speed_m_s"]
    phrase = f'The drop is that of the case "{comparison.name}"'
    if len(speeds):
        phrase += f", which arrives at {text(float(speeds[0]), 'm/s')}"
    return f"{phrase}."


def first_impacts(comparison: Comparison) -> Table:
    """Return the table of the laws: restitution asked and achieved, and the first impact.

    Columns in which no law has a value are left out.
    """
    results = list(comparison.results.values())
    columns = [
        Column("Law", list(comparison.results), is_text=True),
        Column("Impacts", [str(len(result.impacts["impact"])) for result in results]),
        Column(
            "Restitution asked",
            [_restitution(result, "restitution_asked", 0) for result in results],
        ),
        Column(
            "Restitution achieved, first",
            [_restitution(result, "restitution_achieved", 0) for result in results],
        ),
        Column(
            "achieved, last",
            [_restitution(result, "restitution_achieved", -1) for result in results],
        ),
    ]
    for name in _COLUMNS:
        first_values = np.array([_first(result.impacts[name], np.nan) for result in results])
        changes = np.array([_first(result.change_by_impact, 0.0) for result in results])
        unit, cells = formatted_column(name, first_values, changes)
        columns.append(Column(ALL_IMPACT_COLUMNS[name].label, cells, unit))
    return Table([column for column in columns if any(cell != MISSING for cell in column.cells)])


def _first(values: np.ndarray, without: float) -> float:
    """Return the first of some values, or another one where there is none."""
    return float(values[0]) if len(values) else without


def _restitution(result: Result, name: str, impact: int) -> str:
    """Return the restitution of an impact, rounded to its significant digits."""
    values = result.impacts[name]
    if not len(values):
        return MISSING
    return formatted_column(name, values, result.change_by_impact)[1][impact]


def comparison_warnings(comparison: Comparison) -> list[str]:
    """Return the distinct warnings of all drops, each with the laws that it concerns."""
    laws: dict[str, list[str]] = {}
    for name, result in comparison.results.items():
        for warning in result.doubts:
            laws.setdefault(warning, []).append(name)
    warnings = []
    for warning, names in laws.items():
        concerned = ", ".join(names)
        if len(names) == len(comparison.results) > 1:
            concerned = "every law"
        warnings.append(f"{concerned}: {warning}")
    return warnings


def free_parameter_of(law: ContactLaw) -> str:
    """Return the free parameter of a law with its value and unit, or "nothing to set"."""
    name = law.free_parameter
    if name is None:
        return "nothing to set"
    declared = next(item for item in law.__dataclass_fields__.values() if item.name == name)
    return f"{name} = {float(getattr(law, name)):.6g} {declared.metadata['unit']}".rstrip()


def _summary(comparison: Comparison) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    laws = {
        name: {
            "status": result.status,
            "impacts": impact_rows(result.impacts),
            "energy": result.energy,
            "doubts": result.doubts,
        }
        for name, result in comparison.results.items()
    }
    return {"name": comparison.name, "version": __version__, "laws": laws}


def _write_impacts(comparison: Comparison, path: Path) -> None:
    """Write all impacts under all laws as a table."""
    rows = [
        {"law": name, **row}
        for name, result in comparison.results.items()
        for row in impact_rows(result.impacts)
    ]
    columns = impact_columns(
        name for result in comparison.results.values() for name in result.impacts
    )
    write_csv(rows, ["law", *columns], path)
