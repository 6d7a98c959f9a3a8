"""Measured restitutions as a table and sentences, for the terminal and the page."""

from __future__ import annotations

import math
from pathlib import Path

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.calibration.bounces.tables import law_sentences
from vibroimpact.calibration.report import Cells
from vibroimpact.calibration.restitutions.restitutions import Restitutions
from vibroimpact.calibration.text import cells_table
from vibroimpact.contact.speed_function import toml_of
from vibroimpact.units.display import MISSING, column_texts


def restitution_cells(found: Restitutions) -> Cells:
    """Return headers with units, and a row per row of the table."""
    interval = f"Interval, {100.0 * found.confidence:g} %"
    headers = [
        ("Row", ""),
        ("Approach speed", "m/s"),
        ("Restitution", ""),
        (interval, ""),
        ("Impacts", ""),
    ]
    decimals = max(0, -round(math.log10(found.rounding))) + 1
    intervals = [
        f"{low:.{decimals}f} to {high:.{decimals}f}" if math.isfinite(low) else MISSING
        for low, high in found.intervals
    ]
    columns = [
        [str(row + 1) for row in range(len(found.count))],
        column_texts(found.approach_speed, 4),
        column_texts(found.restitution, 4),
        intervals,
        [f"{number:.0f}" for number in found.count],
    ]
    return headers, [list(row) for row in zip(*columns, strict=True)]


def status_sentence(found: Restitutions) -> str:
    """Return how many restitutions there are."""
    number = int(found.count.sum())
    of = "" if number == len(found.count) else f", means of {number} impacts"
    return (
        f"{len(found.count)} restitution{'s' if len(found.count) > 1 else ''} over the "
        f"approach speed{of}."
    )


def noise_sentence(found: Restitutions) -> str:
    """Return from where the intervals are."""
    many = len(found.count) > 1
    of = ["the scatter about each fit"] if many else []
    if not math.isnan(found.deviation[0]):
        of = [
            "the standard "
            f"deviation{'s of the table and the scatter beyond them' if many else ' of the table'}"
        ]
    what = (
        f"{found.rounding:g} m/s to which the separation speeds"
        if found.by_speeds
        else f"{found.rounding:g} to which the values"
    )
    of.append(f"the step of {what} are rounded")
    means = "" if (found.count == 1.0).all() else " A scatter is that of single impacts."
    exact = "approach speeds" if found.by_speeds else "speeds"
    return (
        f"The intervals of the fits follow from {', and from '.join(of)}; {exact} "
        f"are taken as exact.{means}"
    )


def case_sentence(found: Restitutions) -> str:
    """Return the linear fit as a case takes it; "" without one."""
    return (
        ""
        if found.function is None
        else f'In a case: law = "newton", restitution = {toml_of(found.function)}'
    )


def restitution_summary(found: Restitutions) -> RenderableType:
    """Return the restitutions, the fits and the warnings."""
    parts: list[RenderableType] = [
        Text(Path(found.source).name, style="bold"),
        Text(status_sentence(found)),
        Text(),
        cells_table(restitution_cells(found)),
        Text(),
        Text("Restitution over the approach speed", style="bold"),
        *(
            Text(f" {sentence}")
            for sentence in (*law_sentences(found), case_sentence(found))
            if sentence
        ),
        Text(),
        Text(noise_sentence(found)),
    ]
    parts += [Text(), *(Text(f"Doubt: {doubt}.") for doubt in found.doubts)] if found.doubts else []
    return Group(*parts)
