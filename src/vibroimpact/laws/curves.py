"""The figure of a contact law: force over indentation, and restitution over approach speed."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from vibroimpact.arrays import Floats
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid import rigid_plate
from vibroimpact.cases.reader import read_case
from vibroimpact.cases.rigid import contact_pair
from vibroimpact.contact.law import CompliantLaw, ContactLaw, unit_of
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.recover import recover
from vibroimpact.laws.text import paper_pair
from vibroimpact.report.figure_files import render_png
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import ACCENT, INK, LOOPS, style
from vibroimpact.units.display import multiple, text

_SPEEDS = np.geomspace(1e-3, 30.0, 60)
_POINTS = 600
_BOTTOM, _HEIGHT = 0.55, 3.3
_ELASTIC = 1.0 - 1e-9
"""Restitutions above this value count as one."""


@dataclass(frozen=True)
class _Example:
    """The example that a figure shows: the bodies in words, their pair, and the law."""

    words: str
    pair: ContactPair
    law: ContactLaw


def draw_law(law: type[ContactLaw]) -> Figure:
    """Draw the curves of a contact law with typical parameters, for a sphere on a plate without gravity.

    Left the force over the indentation at three approach speeds (not for an instantaneous law), right the restitution over the
    approach speed. Elastic-plastic laws are shown with a steel sphere, from about the yield speed on; adhesive laws with a small
    sphere, from about the sticking speed on; all others with the paper's rock sphere.

    Parameters
    ----------
    law : type of ContactLaw
        The law's class.
    """
    example = _example(law)
    restitution = achieved_restitution(example.law, example.pair.effective_mass, _SPEEDS)
    speeds = _typical_speeds(law, restitution)
    with style():
        figure = new_figure(4.9)
        *left, right = row_of_axes(figure, 2 if isinstance(example.law, CompliantLaw) else 1, _BOTTOM, _HEIGHT)
        for axes in left:
            _draw_forces(axes, example, speeds)
        _draw_restitution(right, example, restitution, speeds)
        if not left:
            label_vertical(right, "Restitution [-]")
        top = figure.get_figheight()
        figure.text(0.1, (top - 0.2) / top, law.name, fontsize=11.0, fontweight="bold", va="top")
        figure.text(0.1, (top - 0.43) / top, _caption(example), fontsize=8.0, va="top", linespacing=1.35)
    return figure


def check_picture(target: Path, *, force: bool) -> None:
    """Check that a picture of a law can be written to a path.

    Raises
    ------
    InputError
        If the path is not that of a PNG file in an existing folder, or the file exists and `force` is false.

    Examples
    --------
    >>> check_picture(Path("hertz.svg"), force=False)
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: hertz.svg: the picture is a PNG file; give a name that ends in .png
    """
    if target.suffix.lower() != ".png":
        raise InputError(f"{target}: the picture is a PNG file; give a name that ends in .png")
    if target.is_dir():
        raise InputError(f"{target}: this is a folder; name a file in it")
    if not target.parent.is_dir():
        raise InputError(f"{target}: there is no folder {target.parent}; make it, or name another place")
    if target.exists() and not force:
        raise InputError(f"{target} is there already; --force replaces it")


def save_law_picture(name: str, target: Path) -> Path:
    """Draw the curves of a contact law and write them as a PNG file; an existing file is replaced.

    Raises
    ------
    InputError
        If the law is unknown, or the file can't be written.
    """
    picture = render_png(draw_law(find_contact_law(name)))
    try:
        recover(target)
        write_file(target, picture)
    except OSError as error:
        raise InputError(f"{target}: the picture can't be written: {error.strerror}") from None
    return target


def _example(law: type[ContactLaw]) -> _Example:
    """Return the bodies and the law of the figure, by the kind of the law."""
    if {item.metadata["from_pair"] for item in fields(law)} & {"yield_pressure", "yield_strength"}:
        pair = _pair_of(0.025, "steel", "steel")
        return _Example("Steel sphere, radius 25 mm, on a steel plate", pair, law.example(pair))
    if getattr(law, "contact_end", "") == "pull-off":
        pair = _pair_of(1e-4, "rock-paper", "steel-paper")
        one = law.example(pair)
        if hasattr(one, "dissipation_time"):  # contacts of the smaller sphere are shorter in proportion
            one = one.changed({"dissipation_time": one.dissipation_time * pair.effective_radius / paper_pair().effective_radius})
        return _Example("Rock sphere, radius 0.1 mm, on a steel plate", pair, one)
    pair = paper_pair()
    return _Example("Rock sphere, radius 25 mm, on a steel plate", pair, law.example(pair))


def _pair_of(radius: float, sphere: str, plate: str) -> ContactPair:
    case = {"sphere": {"radius": radius, "material": sphere}, "plate": {"material": plate}}
    return contact_pair(read_case({**case, "drop": {"speed": 1.0}, "contact": {"law": "hertz"}}))


def _typical_speeds(law: type[ContactLaw], restitution: Floats) -> tuple[float, ...]:
    """Return three approach speeds [m/s] for the force curves, from the sticking or the yield speed on where there is one."""
    first, factors = 1.0, (1.0, 3.0, 9.0)
    if getattr(law, "contact_end", "") == "pull-off" and np.any(restitution > 0.0):
        first, factors = _SPEEDS[np.argmax(restitution > 0.0)], (1.0, 2.0, 4.0)
    elif restitution[0] > _ELASTIC > restitution[-1]:
        first = _SPEEDS[np.argmin(restitution > _ELASTIC) - 1]
    return tuple(float(f"{factor * first:.2g}") for factor in factors)


def _draw_forces(axes: Axes, example: _Example, speeds: tuple[float, ...]) -> None:
    loops = [_loop(example, speed) for speed in speeds]
    depth, force = multiple("m", loops[-1][0]), multiple("N", loops[-1][1])
    for number, ((x, y), speed, (colour, dashes)) in enumerate(zip(loops, speeds, LOOPS, strict=False)):
        line = axes.plot(x / depth.size, y / force.size, color=colour, linestyle=dashes, linewidth=1.5, label=text(speed, "m/s", 2))[0]
        line.set_zorder(2.5 - 0.1 * number)  # small loops on top, or larger ones would cover them
    if min(np.min(part) for loop in loops for part in loop) < 0.0:
        axes.axhline(0.0, color="#555555", linewidth=0.7, zorder=1.5)
        axes.axvline(0.0, color="#555555", linewidth=0.7, zorder=1.5)
    axes.set_title("Force over indentation")
    axes.set_xlabel(f"Indentation [{depth.unit}]")
    label_vertical(axes, f"Contact force [{force.unit}]")
    axes.margins(x=0.03, y=0.05)
    legend = axes.legend(loc="upper left", title="Approach speed", alignment="left", handlelength=4.0, frameon=True)
    legend.get_frame().set(facecolor="white", edgecolor="none", alpha=1.0)  # or the zero lines would cross it


def _loop(example: _Example, speed: float) -> tuple[Floats, Floats]:
    """Return indentation [m] and force [N] of one impact, including the jumps of the force at first touch and at the end."""
    sphere = Body(mass=example.pair.effective_mass, contact_offset=example.pair.effective_radius)
    response = simulate(Problem(sphere=sphere, plate=rigid_plate(), laws=(example.law,), speed=speed, gravity=0.0, impacts=1))
    duration = float(response.impacts["duration_s"][0])
    # Chebyshev points, dense at both ends, where the force jumps or is steep; the end itself belongs to the next flight
    part = response.at(duration * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS))) * (1.0 - 1e-12))
    indentation, force = part["indentation_m"], part["force_N"]
    return np.concatenate([indentation[:1], indentation, indentation[-1:]]), np.concatenate([[0.0], force, [0.0]])


def _draw_restitution(axes: Axes, example: _Example, restitution: Floats, speeds: tuple[float, ...]) -> None:
    axes.plot(_SPEEDS, restitution, color=ACCENT, linewidth=1.5, label="achieved")
    asked = getattr(example.law, "restitution", None)
    if asked is not None:
        axes.axhline(asked, color=INK, linewidth=0.8, linestyle=(0, (4, 3)), label="asked")
        axes.legend(loc="lower left")
    if isinstance(example.law, CompliantLaw):
        at = achieved_restitution(example.law, example.pair.effective_mass, np.array(speeds))
        for speed, value, (colour, _) in zip(speeds, at, LOOPS, strict=False):
            axes.plot(speed, value, "o", color=colour, markersize=5.0, zorder=3)
    axes.set_xscale("log")
    axes.set_xlim(_SPEEDS[0] / 1.1, _SPEEDS[-1] * 1.1)
    axes.set_ylim(0.0, 1.05)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_title("Restitution over approach speed")
    axes.set_xlabel("Approach speed [m/s]")


def _caption(example: _Example) -> str:
    """Return the caption: the bodies, and the parameters, four per line."""
    values = [(item, getattr(example.law, item.name)) for item in fields(example.law) if not item.metadata["memory"]]
    exponent = getattr(example.law, "exponent", 1.5)
    parts = [f"{item.name} {value:.4g} {unit_of(item, exponent)}".rstrip() for item, value in values if value is not None]
    lines = [", ".join(parts[start : start + 4]) for start in range(0, len(parts), 4)]
    return "\n".join([f"{example.words}, without gravity", *lines])
