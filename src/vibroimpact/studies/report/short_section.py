"""What the terminal shows of a study: main results, and the key with the largest effect on each."""

from __future__ import annotations

from vibroimpact.report.report import Block, Column, Note, Section, Table
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.labels import percent, with_unit
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.percentiles import PERCENTILES
from vibroimpact.studies.report.sensitivity_table import (
    RANKS,
    SOBOL,
    Sensitivity,
    sensitivity_of,
    strongest,
)
from vibroimpact.studies.report.tables import reason_sentences
from vibroimpact.units.display import digits

_RESULTS = 5
_REASONS = 3
_PERCENTILES = (5, 50, 95)  # those shown
_NARROW = 70  # width of a terminal below which sensitivities are not shown


def short_section(study: Study, outputs: list[Output], sensitivity: Sensitivity | None) -> Section:
    """Return the main results, after the reasons of drops that failed; they fit on a screen.

    Parameters
    ----------
    study : Study
        The study.
    outputs : list of Output
        All its results, the most important first.
    sensitivity : Sensitivity, optional
        The sensitivity of those that describe the response.
    """
    blocks: list[Block] = [
        Note(reason, is_warning=True) for reason in reason_sentences(study)[:_REASONS]
    ]
    shown = _main_results(outputs)
    if shown:
        strongest_keys = _strongest_keys(study, shown, sensitivity)
        blocks.append(Table((*_distribution_columns(shown), *strongest_keys)))
    return Section("results", "", blocks, medium="terminal")


def _main_results(outputs: list[Output]) -> list[Output]:
    """Return the first results that vary; if none does, the first that have a value."""
    with_values = [output for output in outputs[: _RESULTS + 3] if output.spread.drops]
    varying = [output for output in with_values if output.spread.varies]
    return (varying or with_values)[:_RESULTS]


def _distribution_columns(outputs: list[Output]) -> list[Column]:
    """Return the columns of the names of results, and of their percentiles."""
    names = [with_unit(output.title, output.scale.unit) for output in outputs]
    columns = [Column("result", names, is_text=True)]
    for percentile in _PERCENTILES:
        number = PERCENTILES.index(percentile)
        cells = [
            digits(output.spread.percentiles[number] / output.scale.size) for output in outputs
        ]
        columns.append(Column(f"{percentile}\u00a0%", cells))
    return columns


def _strongest_keys(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> list[Column]:
    """Return the column of the keys with the largest effects, for terminals that are wide enough;
    none without a sensitivity.
    """
    if not any(output.spread.varies for output in outputs):
        return []
    others = [output for output in outputs if not output.is_informative]
    sensitivities = [
        known for known in (sensitivity, sensitivity_of(study, others)) if known is not None
    ]
    if not sensitivities:
        return []
    has_names = any(not axis.numeric for axis in study_axes(study))
    of_numbers = ""
    if sensitivities[0].way == RANKS and has_names:  # names have no ranks
        of_numbers = ", of numeric keys,"
    cells = [
        "".join(_strongest_key(known, output.name) for known in sensitivities) for output in outputs
    ]
    return [Column(f"most sensitive{of_numbers} to", cells, is_text=True, least_width=_NARROW)]


def _strongest_key(sensitivity: Sensitivity, output: str) -> str:
    """Return the key with the largest effect on a result, with its magnitude; "" if
    undetermined.
    """
    key = strongest(sensitivity, output)
    if key is None:
        return ""
    number = sensitivity.keys.index(key)
    if sensitivity.way == RANKS:
        correlation = float(sensitivity.rows[output]["rank_correlation"][number])
        return f"{key} (rank correlation {digits(correlation, 2)})"
    measure = "index" if sensitivity.way == SOBOL else "range"
    strength = float(sensitivity.strength[output][number])
    return f"{key} ({measure} {percent(strength)})"
