"""What a bound on the error of classifiers tells: errors by what is measured, and charts."""

from __future__ import annotations

from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.bayes_error.bound import BANDWIDTHS, PROPERTIES, SIGNAL_TO_NOISE, Bound
from vibroimpact.bayes_error.charts import bound_charts
from vibroimpact.bayes_error.error_estimate import BayesError
from vibroimpact.bayes_error.observations import OBSERVATIONS
from vibroimpact.report.report import (
    Explanation,
    Facts,
    Note,
    Quantity,
    Report,
    Section,
    Table,
    table_of,
)
from vibroimpact.results.csv_files import write_rows
from vibroimpact.units.display import MISSING

_FEW = 5.0
"""Median number of neighbours below which more falls would narrow a bracket."""
_COARSE = 0.02
"""Standard error from which on an error has no decimals."""
_LEAST = 300
"""Number of falls below which none wrong among them is said to be compatible with an
error of 3 over their number (95 %) or less.
"""


def report_of(bound: Bound) -> Report:
    """Return the report of a bound.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> report = report_of(
    ...     vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", samples=100))
    ... )
    >>> list(report.files), report.sections[0].title
    (['bound.csv', 'map.csv'], 'Classification error by measured quantities')
    """
    measured = Section(
        "measured",
        "Classification error by measured quantities",
        (
            error_table(bound),
            Note(
                '"Without scatter" is the error with the noise, but without the scatter of the '
                'amplitude. "Remaining" is the part of the scatter of a property, the standard '
                "deviation of its logarithm, that the best linear estimate from the measured "
                "quantities does not explain."
            ),
            Note(channel_sentences(bound)),
            Note(sampling_sentence(bound)),
            Explanation(
                "Classification error: the share of falls that the best possible classifier of "
                "these quantities misclassifies, between a lower and an upper bound. With all "
                "digits: bound.csv."
            ),
        ),
    )
    quantities = Section(
        "quantities",
        "The measured quantities",
        (Facts([(observation.name, observation.meaning) for observation in OBSERVATIONS]),),
    )
    return Report(
        title=f"Bounds on the classification error: {bound.name}",
        answer=headline(bound),
        quantities=answer_of(bound),
        sentences=(scatter_sentences(bound),),
        sections=(measured, quantities),
        charts=bound_charts(bound),
        files={"bound.csv": partial(_write_bound, bound), "map.csv": partial(_write_map, bound)},
        summary=_summary(bound),
        provenance=(
            "the plate is a linear system that does not depend on the falling body: no signal of a "
            "sensor on it contains more information on the rock than the force itself. Signals of "
            "several falls of one rock can contain more information than one fall."
        ),
    )


def error_interval(error: BayesError) -> str:
    """Return the bracket of a Bayes error in per cent, without tenths if it is of few falls.

    Examples
    --------
    >>> error_interval(BayesError(0.0044, 0.0101, 0.002, 20.0))
    '0.4 to 1.0 %'
    >>> error_interval(BayesError(0.0, 0.004, 0.002, 1.0))
    'at most 0.4 %'
    >>> error_interval(BayesError(0.21, 0.24, 0.043, 20.0))
    '21 to 24 %'
    """
    decimals = 1 if error.standard_error < _COARSE else 0
    low = f"{100.0 * error.lower:.{decimals}f}"
    high = f"{100.0 * error.upper:.{decimals}f}"
    if error.neighbours < _FEW:
        return f"at most {high} %"
    if low == high:
        return f"{high} %"
    return f"{low} to {high} %"


_ANSWERED = ("contact time", "one impact", "one impact, place unknown", "height, bounce and size")
"""Measured quantities whose error the answer states."""


def answer_of(bound: Bound) -> list[Quantity]:
    """Return the lowest errors of classifiers of some quantities, and of one that sees nothing."""
    meanings = {observation.name: observation.meaning for observation in OBSERVATIONS}
    quantities = []
    for name in _ANSWERED:
        error = bound.errors[name]
        # of few neighbours the lower bound tells nothing
        lowest = error.lower if error.neighbours >= _FEW else 0.0
        quantities.append(
            Quantity(
                f"Lowest error: {name}",
                100.0 * lowest,
                "%",
                note=f"from {meanings[name]}",
                largest=100.0 * error.upper,
                figures=2,
            )
        )
    majority = "always naming the most frequent class"
    blind = Quantity("Error without a measurement", 100.0 * bound.majority, "%", note=majority)
    most = max(error.standard_error for error in bound.errors.values())
    note = f"standard error of the upper bounds up to {100.0 * most:.1f} %"
    return [*quantities, replace(blind, figures=3), Quantity("Falls", len(bound.falls), note=note)]


def headline(bound: Bound) -> str:
    """Return the finding in a sentence."""
    contact_time = error_interval(bound.errors["contact time"])
    one_impact = error_interval(bound.errors["one impact"])
    number = len(bound.falls)
    few = ""
    if number < _LEAST:
        # so large an error leaves all of them right once in twenty times
        most = 100.0 * (1.0 - 0.05 ** (1.0 / number))
        few = (
            f" {number:,} falls are few: even an error of 0 may in truth be up to {most:.1f} % "
            "(95 %)."
        )
    names = np.unique(bound.falls.classes).tolist()
    frequent = "more" if len(names) == 2 else "most"
    return (
        f"For {number:,} falls of {' and '.join(names)}, the lowest error of a classifier that "
        f"sees only the contact time is {contact_time}, and that of one that sees only impulse and "
        f"contact time of one impact at a known position {one_impact}; always naming the "
        f"{frequent} frequent class has an error of {100.0 * bound.majority:.1f} %.{few}"
    )


def scatter_sentences(bound: Bound) -> str:
    """Return the share of the assumed scatter of the amplitude in the error, and for whom
    the bound holds.
    """
    channel = bound.channel
    far = "one impact, place unknown"
    return (
        f"The scatter of the amplitude is assumed, {100.0 * channel.gain:g} % of the sensitivity "
        f"and {100.0 * channel.place:g} % where the position is unknown: with it the lowest error "
        f"from {far}, is {error_interval(bound.errors[far])}, and without it "
        f"{error_interval(bound.without_scatter[far])}. Each error holds for classifiers that see "
        "only the quantities named, with this scatter. A signal contains more, such as the "
        "position of the impact, the shape of the pulse and further impacts; a classifier that "
        "uses it can have a lower error."
    )


def channel_sentences(bound: Bound) -> str:
    """Return the measuring channel, and how falls and bounces were computed."""
    channel = bound.channel
    rigid = ""
    if bound.on_rigid_plate:
        rigid = " The falls are computed on the plate as a rigid body."
    return (
        f"Measured up to {channel.bandwidth / 1e3:g} kHz, with the peak force of the median fall "
        f"{channel.signal_to_noise:g} dB above the noise in 10 kHz. Assumed relative standard "
        f"deviations: sensitivity {100.0 * channel.gain:g} %, amplitude at an unknown position "
        f"{100.0 * channel.place:g} %, speed where it is measured {100.0 * channel.height:g} %, "
        f"radius where it is measured {100.0 * channel.size:g} %, time to the next impact "
        f"{100.0 * channel.interval:g} %, which is that of a bounce on a level plate in standard "
        f"gravity.{rigid}"
    )


def sampling_sentence(bound: Bound) -> str:
    """Return the largest standard error of the upper bounds."""
    most = max(error.standard_error for error in bound.errors.values())
    return (
        f"The upper bounds have standard errors of up to {100.0 * most:.1f} %, from the number "
        "of falls tested."
    )


def error_table(bound: Bound) -> Table:
    """Return the errors with and without assumed scatter, and what remains of each property."""
    errors = ["Classification error", "Without scatter"]
    headings = ["Measured", *errors, *(f"{name}, remaining" for name in PROPERTIES)]
    rows = [
        [
            observation.name,
            error_interval(bound.errors[observation.name]),
            error_interval(bound.without_scatter[observation.name]),
            *(_per_cent(ratio) for ratio in bound.remaining[observation.name]),
        ]
        for observation in OBSERVATIONS
    ]
    return table_of(headings, rows, texts=errors)


def _per_cent(ratio: float) -> str:
    return f"{100.0 * ratio:.0f} %" if np.isfinite(ratio) else MISSING


def bound_rows(bound: Bound) -> list[dict[str, str | float]]:
    """Return the rows of `bound.csv`."""
    rows: list[dict[str, str | float]] = []
    for observation in OBSERVATIONS:
        error = bound.errors[observation.name]
        without_scatter = bound.without_scatter[observation.name]
        remaining = bound.remaining[observation.name]
        row: dict[str, str | float] = {
            "measured": observation.name,
            "meaning": observation.meaning,
            "error_lower": error.lower,
            "error_upper": error.upper,
            "standard_error": error.standard_error,
            "neighbours": error.neighbours,
        }
        for name, ratio in zip(PROPERTIES, remaining, strict=True):
            row[f"{name}_remaining"] = float(ratio)
        row["error_lower_without_scatter"] = without_scatter.lower
        row["error_upper_without_scatter"] = without_scatter.upper
        rows.append(row)
    return rows


def _write_bound(bound: Bound, path: Path) -> None:
    """Write the errors of all observations."""
    rows = bound_rows(bound)
    write_rows(rows, path)


def _write_map(bound: Bound, path: Path) -> None:
    """Write the error from one impact over bandwidth and ratio of signal to noise."""
    rows = [
        {
            "bandwidth_Hz": float(bandwidth),
            "signal_to_noise_dB": float(ratio),
            "error_upper": float(bound.map[row, column]),
        }
        for row, bandwidth in enumerate(BANDWIDTHS)
        for column, ratio in enumerate(SIGNAL_TO_NOISE)
    ]
    write_rows(rows, path)


def _summary(bound: Bound) -> dict[str, Any]:
    """Return the content of `summary.json`; a value that is not known is null."""
    rows = []
    for row in bound_rows(bound):
        unknown = {name: None for name, value in row.items() if value != value}  # NaN
        rows.append({**row, **unknown})
    return {
        "name": bound.name,
        "version": __version__,
        "falls": len(bound.falls),
        "majority_error": bound.majority,
        "channel": asdict(bound.channel),
        "bound": rows,
    }
