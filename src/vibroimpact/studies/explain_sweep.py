"""Description of a study before it is computed: drops, axes, kept results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.studies.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.scaled import Scaled
from vibroimpact.studies.sweep import Sweep
from vibroimpact.studies.unit_slips import axis_slips
from vibroimpact.units.display import digits


def explain_sweep(sweep: Sweep) -> RenderableType:
    """Return the description of a study for the terminal."""
    section = sweep.section
    drawn = f", drawn with seed {section.seed}" if section.samples else ""
    kept = (
        " and ".join(dict.fromkeys(["peaks", *section.keep]))
        + f", about {digits(sweep.bytes / 1e6, 2)} MB"
    )
    units = _units(sweep)
    axes = [("", key, axis) for key, axis in sweep.axes.items()]
    if sweep.population is not None:
        axes += [
            (name, key, axis)
            for name, own in sweep.population.own.items()
            for key, axis in own.items()
        ]
    over = [
        _words(axis, units[key], units, is_drawn=section.samples is not None)
        for _, key, axis in axes
    ]
    classes = (
        [TerminalColumn("class", [name for name, _, _ in axes], text=True)]
        if sweep.population is not None
        else []
    )
    table = TerminalTable(
        [
            *classes,
            TerminalColumn("swept key", [key for _, key, _ in axes], text=True),
            TerminalColumn("over", over, text=True),
        ]
    )
    return Group(
        Text(
            f"A study of {sweep.size:,} drop{'' if sweep.size == 1 else 's'}: "
            f"{section.design}{drawn}; keeps {kept}.",
            style="bold",
        ),
        table,
        *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in axis_slips(sweep)),
        Text("The case at its first point:\n"),
    )


def sweep_document(sweep: Sweep) -> dict[str, Any]:
    """Return the description of a study as data; its axes in SI, with the keys of a case file."""
    section = sweep.section
    units = _units(sweep)
    return {
        "design": section.design,
        "drops": sweep.size,
        "samples": section.samples,
        "seed": section.seed,
        "keep": list(dict.fromkeys(["peaks", *section.keep])),
        "size_byte": sweep.bytes,
        "over": {key: {"unit": units[key], **_data(axis)} for key, axis in sweep.axes.items()},
        **_classes(sweep, units),
        "doubts": axis_slips(sweep),
    }


def _classes(sweep: Sweep, units: Mapping[str, str]) -> dict[str, Any]:
    """Return the classes of a population with the keys of a case file; nothing for
    another design.
    """
    population = sweep.population
    if population is None:
        return {}
    told = {
        name: {
            "share": population.shares[name],
            "over": {key: {"unit": units[key], **_data(axis)} for key, axis in own.items()},
        }
        for name, own in population.own.items()
    }
    return {
        "classes": told,
        "falls_per_rock": population.falls_per_rock,
        "rocks_per_plate": population.rocks_per_plate,
    }


def _units(sweep: Sweep) -> dict[str, str]:
    """Return the SI unit of each swept key; "" for one that is no quantity."""
    return {key: quantity.unit if quantity else "" for key, quantity in sweep.quantities.items()}


def _data(axis: Axis) -> dict[str, Any]:
    """Return the values of an axis with the keys of a case file."""
    if isinstance(axis, Listed):
        return {"values": axis.values, "weights": axis.weights}
    if isinstance(axis, Spaced):
        drawn = {"distribution": "uniform"} if axis.is_random else {}
        return {
            **drawn,
            "from": axis.start,
            "to": axis.end,
            "number": axis.number,
            "scale": axis.scale,
        }
    if isinstance(axis, Scaled):
        follows = {
            "value": axis.value,
            "of": axis.of,
            "at": axis.at,
            "exponent": axis.exponent,
            "factor": _data(axis.factor),
        }
        return {**follows, "each": axis.each}
    assert isinstance(axis, Normal)
    return {
        "distribution": "lognormal" if axis.lognormal else "normal",
        "mean": axis.mean,
        "standard_deviation": axis.standard_deviation,
        "at_least": axis.at_least,
        "at_most": axis.at_most,
        "number": axis.number,
    }


def _words(axis: Axis, unit: str, units: Mapping[str, str], *, is_drawn: bool) -> str:
    """Return a short description of the values of an axis, with its unit and those of the
    swept keys.
    """
    if isinstance(axis, Listed):
        shown = [f"{value:g}" if isinstance(value, float) else str(value) for value in axis.values]
        text = (
            ", ".join(shown)
            if len(shown) <= 8
            else f"{len(shown)} values, {shown[0]} to {shown[-1]}"
        )
        return f"{text} {unit}".rstrip()
    number = "" if is_drawn else f"{len(axis)} values "
    if isinstance(axis, Spaced):
        return f"{number}from {axis.start:g} to {axis.end:g} {unit}".rstrip() + (
            ", logarithmic" if axis.scale == "log" else ""
        )
    if isinstance(axis, Scaled):
        power = f" to the power of {axis.exponent:g}" if axis.exponent != 1.0 else ""
        per = f" for each {axis.each}" if axis.each else ""
        factor = f"times {_words(axis.factor, '', units, is_drawn=is_drawn)}{per}"
        at = f"{axis.at:g} {units[axis.of]}".rstrip()
        return (
            f"{axis.value:g} {unit}".rstrip()
            + f" at {axis.of} = {at}, proportional to it{power}, {factor}"
        )
    assert isinstance(axis, Normal)
    name = "lognormal" if axis.lognormal else "normal"
    ends = [
        f"{word} {end:g}"
        for word, end in (("at least", axis.at_least), ("at most", axis.at_most))
        if abs(end) < float("inf")
    ]
    return (
        f"{number}{name}, mean {axis.mean:g}, standard deviation "
        f"{axis.standard_deviation:g} {unit}".rstrip()
        + "".join(f", {one}" for one in ends)
    )
