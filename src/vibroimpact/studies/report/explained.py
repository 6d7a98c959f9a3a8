"""A study explained: how many drops, over what, and what is kept."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.studies.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.slips import slips_of_axes
from vibroimpact.studies.sweep import Sweep


def sweep_explained(sweep: Sweep) -> RenderableType:
    """Return what a study would do, for a terminal."""
    section = sweep.section
    drawn = f", drawn with seed {section.seed}" if section.samples else ""
    kept = " and ".join(dict.fromkeys(["peaks", *section.keep])) + f", about {sweep.bytes / 1e6:.3g} MB"
    units = {key: quantity.unit if quantity else "" for key, quantity in sweep.quantities.items()}
    over = [_words(axis, units[key], is_drawn=section.samples is not None) for key, axis in sweep.axes.items()]
    table = TerminalTable([TerminalColumn("swept key", list(sweep.axes), words=True), TerminalColumn("over", over, words=True)])
    return Group(
        Text(f"A study of {sweep.size:,} drops: {section.design}{drawn}; keeps {kept}.", style="bold"),
        table,
        *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in slips_of_axes(sweep)),
        Text("The case at its first point:\n"),
    )


def _words(axis: Axis, unit: str, *, is_drawn: bool) -> str:
    """Return in a few words what an axis runs over."""
    if isinstance(axis, Listed):
        shown = [f"{value:g}" if isinstance(value, float) else str(value) for value in axis.values]
        text = ", ".join(shown) if len(shown) <= 8 else f"{len(shown)} values, {shown[0]} to {shown[-1]}"
        return f"{text} {unit}".rstrip()
    number = "" if is_drawn else f"{len(axis)} values "
    if isinstance(axis, Spaced):
        return f"{number}from {axis.start:g} to {axis.end:g} {unit}".rstrip() + (", logarithmic" if axis.scale == "log" else "")
    assert isinstance(axis, Normal)
    name = "lognormal" if axis.lognormal else "normal"
    ends = [f"{word} {end:g}" for word, end in (("at least", axis.at_least), ("at most", axis.at_most)) if abs(end) < float("inf")]
    return f"{number}{name}, mean {axis.mean:g}, standard deviation {axis.standard_deviation:g} {unit}".rstrip() + "".join(
        f", {one}" for one in ends
    )
