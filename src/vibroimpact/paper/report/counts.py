"""How many values have each verdict, by part and by kind, and how wide the ranges are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from vibroimpact.paper.report.outline import RenderedPart
from vibroimpact.paper.report_section import Kind, Verdict


def verdict_counts(parts: Mapping[str, RenderedPart]) -> dict[str, dict[str, int]]:
    """Return the number of rows with each verdict, by part and for "all"; an empty dict
    if no part has rows.
    """
    verdicts = {
        name: [row["verdict"] for row in part.rows] for name, part in parts.items() if part.rows
    }
    if verdicts:
        verdicts["all"] = [verdict for of_part in list(verdicts.values()) for verdict in of_part]
    return {
        name: {verdict.value: of_part.count(verdict.value) for verdict in Verdict}
        for name, of_part in verdicts.items()
    }


def kind_counts(parts: Mapping[str, RenderedPart]) -> dict[str, dict[str, int]]:
    """Return the number of rows with each verdict, by the kind of the comparison; an
    empty dict if no part has rows.
    """
    rows = [(row["kind"], row["verdict"]) for part in parts.values() for row in part.rows]
    if not rows:
        return {}
    return {
        kind.value: {verdict.value: rows.count((kind.value, verdict.value)) for verdict in Verdict}
        for kind in Kind
    }


class RangeWidths(NamedTuple):
    """The widths of the ranges that explain the printed values of a part.

    Parameters
    ----------
    number : int
        Number of explained values.
    least, most : float
        Smallest and largest width, relative to the printed value.
    """

    number: int
    least: float
    most: float


def range_widths(parts: Mapping[str, RenderedPart]) -> dict[str, RangeWidths]:
    """Return the widths of the ranges by which values are explained, by part; only parts
    with explained values.
    """
    widths_of_parts = {}
    for name, part in parts.items():
        widths = [
            (row["range_high"] - row["range_low"]) / abs(float(row["printed"]))
            for row in part.rows
            if row["verdict"] == Verdict.EXPLAINED.value
        ]
        if widths:
            widths_of_parts[name] = RangeWidths(len(widths), min(widths), max(widths))
    return widths_of_parts
