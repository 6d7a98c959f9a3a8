"""Description of a study before it is computed: drops, axes, kept results."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.studies.planning.axes import Axis, Listed, Normal, Spaced
from vibroimpact.studies.planning.scaled import Scaled
from vibroimpact.studies.planning.sweep import Sweep
from vibroimpact.studies.planning.unit_slips import axis_slips
from vibroimpact.units.display import digits


def explain_sweep(sweep: Sweep) -> RenderableType:
    """Return the description of a study for the terminal."""
    section = sweep.section
    drawn = f", drawn with seed {section.seed}" if section.samples else ""
    kept = " and ".join(dict.fromkeys(["peaks", *section.keep]))
    size = f"about {digits(sweep.bytes / 1e6, 2)} MB"
    drops = "drop" if sweep.size == 1 else "drops"
    heading = f"A study of {sweep.size:,} {drops}: {section.design}{drawn}; keeps {kept}, {size}."
    return Group(
        Text(heading, style="bold"),
        _axes_table(sweep),
        *(Text(f"Warning: {doubt}.", style="yellow") for doubt in axis_slips(sweep)),
        Text("The case at its first point:\n"),
    )


def _axes_table(sweep: Sweep) -> TerminalTable:
    """Return a table of the swept keys, of a population with those of each class."""
    units = _units(sweep)
    is_drawn = sweep.section.samples is not None
    # the keys of all classes come first, without a class
    axes_of_class: dict[str, Mapping[str, Axis]] = {"": sweep.axes}
    if sweep.population is not None:
        axes_of_class |= sweep.population.own
    classes = []
    keys = []
    ranges = []
    for name, axes in axes_of_class.items():
        for key, axis in axes.items():
            classes.append(name)
            keys.append(key)
            ranges.append(_description(axis, units[key], units, is_drawn=is_drawn))
    columns = [
        TerminalColumn("swept key", keys, text=True),
        TerminalColumn("over", ranges, text=True),
    ]
    if sweep.population is not None:
        columns.insert(0, TerminalColumn("class", classes, text=True))
    return TerminalTable(columns)


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
    """Return the classes of a population with the keys of a case file.

    For another design there are none.
    """
    population = sweep.population
    if population is None:
        return {}
    classes = {}
    for name, axes in population.own.items():
        classes[name] = {
            "share": population.shares[name],
            "over": {key: {"unit": units[key], **_data(axis)} for key, axis in axes.items()},
        }
    return {
        "classes": classes,
        "falls_per_rock": population.falls_per_rock,
        "rocks_per_plate": population.rocks_per_plate,
    }


def _units(sweep: Sweep) -> dict[str, str]:
    """Return the SI unit of each swept key; "" for one that is no quantity."""
    units = {}
    for key, quantity in sweep.quantities.items():
        units[key] = quantity.unit if quantity else ""
    return units


def _data(axis: Axis) -> dict[str, Any]:
    """Return the values of an axis with the keys of a case file."""
    if isinstance(axis, Listed):
        return {"values": axis.values, "weights": axis.weights}
    if isinstance(axis, Spaced):
        distribution = {}
        if axis.is_random:
            distribution = {"distribution": "uniform"}
        return {
            **distribution,
            "from": axis.start,
            "to": axis.end,
            "number": axis.number,
            "scale": axis.scale,
        }
    if isinstance(axis, Scaled):
        return {
            "value": axis.value,
            "of": axis.of,
            "at": axis.at,
            "exponent": axis.exponent,
            "factor": _data(axis.factor),
            "each": axis.each,
        }
    assert isinstance(axis, Normal)
    return {
        "distribution": _name(axis),
        "mean": axis.mean,
        "standard_deviation": axis.standard_deviation,
        "at_least": axis.at_least,
        "at_most": axis.at_most,
        "number": axis.number,
    }


def _name(axis: Normal) -> str:
    return "lognormal" if axis.lognormal else "normal"


def _value_text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _description(axis: Axis, unit: str, units: Mapping[str, str], *, is_drawn: bool) -> str:
    """Return a short description of the values of an axis.

    Parameters
    ----------
    axis : Axis
        The axis.
    unit : str
        Its unit.
    units : mapping of str to str
        The units of all swept keys.
    is_drawn : bool
        Whether its values are drawn, so that they have no levels.
    """
    if isinstance(axis, Listed):
        values = [_value_text(value) for value in axis.values]
        if len(values) <= 8:
            return f"{', '.join(values)} {unit}".rstrip()
        return f"{len(values)} values, {values[0]} to {values[-1]} {unit}".rstrip()
    number = "" if is_drawn else f"{len(axis)} values "
    if isinstance(axis, Spaced):
        limits = f"{number}from {axis.start:g} to {axis.end:g} {unit}".rstrip()
        if axis.scale == "log":
            return f"{limits}, logarithmic"
        return limits
    if isinstance(axis, Scaled):
        value = f"{axis.value:g} {unit}".rstrip()
        reference = f"{axis.at:g} {units[axis.of]}".rstrip()
        power = ""
        if axis.exponent != 1.0:
            power = f" to the power of {axis.exponent:g}"
        factor = _description(axis.factor, "", units, is_drawn=is_drawn)
        per = f" for each {axis.each}" if axis.each else ""
        return f"{value} at {axis.of} = {reference}, proportional to it{power}, times {factor}{per}"
    assert isinstance(axis, Normal)
    deviation = f"{axis.standard_deviation:g} {unit}".rstrip()
    text = f"{number}{_name(axis)}, mean {axis.mean:g}, standard deviation {deviation}"
    if math.isfinite(axis.at_least):
        text += f", at least {axis.at_least:g}"
    if math.isfinite(axis.at_most):
        text += f", at most {axis.at_most:g}"
    return text
