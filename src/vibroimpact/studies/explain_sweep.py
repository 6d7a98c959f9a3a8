"""Terminal description of a study before it is computed: drops, axes, kept results."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.studies.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.sweep import Sweep
from vibroimpact.studies.unit_slips import axis_slips


def explain_sweep(sweep: Sweep) -> RenderableType:
    """Return the description of a study for the terminal."""
    section = sweep.section
    drawn = f", drawn with seed {section.seed}" if section.samples else ""
    kept = " and ".join(dict.fromkeys(["peaks", *section.keep])) + f", about {sweep.bytes / 1e6:.3g} MB"
    units = {key: quantity.unit if quantity else "" for key, quantity in sweep.quantities.items()}
    over = [_words(axis, units[key], is_drawn=section.samples is not None) for key, axis in sweep.axes.items()]
    table = TerminalTable([TerminalColumn("swept key", list(sweep.axes), text=True), TerminalColumn("over", over, text=True)])
    return Group(
        Text(f"A study of {sweep.size:,} drops: {section.design}{drawn}; keeps {kept}.", style="bold"),
        table,
        *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in axis_slips(sweep)),
        Text("The case at its first point:\n"),
    )


def _words(axis: Axis, unit: str, *, is_drawn: bool) -> str:
    """Return a short description of the values of an axis."""
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
