"""The figure of a contact law: its force over the indentation, and its restitution over the approach speed."""

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
from vibroimpact.contact.law import CompliantLaw, ContactLaw, find_contact_law, unit_of
from vibroimpact.contact.pair import ContactPair
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError
from vibroimpact.files.recover import recover
from vibroimpact.files.write_file import write_file
from vibroimpact.laws.text import paper_pair
from vibroimpact.report.figure_files import render_png
from vibroimpact.report.layout import label_vertical, new_figure, row_of_axes
from vibroimpact.report.style import ACCENT, INK, LOOPS, style
from vibroimpact.units.display import multiple, text

_SPEEDS = np.geomspace(1e-3, 30.0, 60)
_POINTS = 600
_BOTTOM, _HEIGHT = 0.55, 3.3
_ELASTIC = 1.0 - 1e-9
"""A restitution above it is one."""


@dataclass(frozen=True)
class _Scene:
    """What a law is shown with: the bodies in words, their pair, and the law."""

    words: str
    pair: ContactPair
    law: ContactLaw


def draw_law(law: type[ContactLaw]) -> Figure:
    """Draw what is typical of a contact law, with typical parameters, for a sphere on a plate without gravity.

    Left the force over the indentation at three approach speeds, right the restitution over the approach speed; of an
    instantaneous law the latter alone. Laws that yield are shown with a steel sphere, from the speed at which it yields;
    laws that stick with a small one, from the speed at which it gets away; all others with the paper's rock sphere.

    Parameters
    ----------
    law : type of ContactLaw
        The law's class.
    """
    scene = _scene(law)
    restitution = achieved_restitution(scene.law, scene.pair.effective_mass, _SPEEDS)
    speeds = _typical_speeds(law, restitution)
    with style():
        figure = new_figure(4.9)
        *left, right = row_of_axes(figure, 2 if isinstance(scene.law, CompliantLaw) else 1, _BOTTOM, _HEIGHT)
        for axes in left:
            _draw_forces(axes, scene, speeds)
        _draw_restitution(right, scene, restitution, speeds)
        if not left:
            label_vertical(right, "Restitution [-]")
        top = figure.get_figheight()
        figure.text(0.1, (top - 0.2) / top, law.name, fontsize=11.0, fontweight="bold", va="top")
        figure.text(0.1, (top - 0.43) / top, _caption(scene), fontsize=8.0, va="top", linespacing=1.35)
    return figure


def check_picture(target: Path, *, force: bool) -> None:
    """Refuse a place where no picture of a law can be made, or where a file is there already.

    Raises
    ------
    InputError
        If no PNG file can be made there, or one is there and must not be replaced.

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
    """Draw a contact law and write it as PNG; takes the place of a file that is there.

    Raises
    ------
    InputError
        If there is no such law, or the file can't be written.
    """
    picture = render_png(draw_law(find_contact_law(name)))
    try:
        recover(target)
        write_file(target, picture)
    except OSError as error:
        raise InputError(f"{target}: the picture can't be written: {error.strerror}") from None
    return target


def _scene(law: type[ContactLaw]) -> _Scene:
    """Return what shows the law's character."""
    if {item.metadata["from_pair"] for item in fields(law)} & {"yield_pressure", "yield_strength"}:
        pair = _pair_of(0.025, "steel", "steel")
        return _Scene("Steel sphere, radius 25 mm, on a steel plate", pair, law.example(pair))
    if getattr(law, "contact_end", "") == "pull-off":
        pair = _pair_of(1e-4, "rock-paper", "steel-paper")
        one = law.example(pair)
        if hasattr(one, "dissipation_time"):  # a contact of this sphere is so much shorter than one of the paper's
            one = one.changed({"dissipation_time": one.dissipation_time * pair.effective_radius / paper_pair().effective_radius})
        return _Scene("Rock sphere, radius 0.1 mm, on a steel plate", pair, one)
    pair = paper_pair()
    return _Scene("Rock sphere, radius 25 mm, on a steel plate", pair, law.example(pair))


def _pair_of(radius: float, sphere: str, plate: str) -> ContactPair:
    case = {"sphere": {"radius": radius, "material": sphere}, "plate": {"material": plate}}
    return contact_pair(read_case({**case, "drop": {"speed": 1.0}, "contact": {"law": "hertz"}}))


def _typical_speeds(law: type[ContactLaw], restitution: Floats) -> tuple[float, ...]:
    """Return three approach speeds [m/s] at which the law shows its character."""
    first, factors = 1.0, (1.0, 3.0, 9.0)
    if getattr(law, "contact_end", "") == "pull-off" and np.any(restitution > 0.0):
        first, factors = _SPEEDS[np.argmax(restitution > 0.0)], (1.0, 2.0, 4.0)
    elif restitution[0] > _ELASTIC > restitution[-1]:
        first = _SPEEDS[np.argmin(restitution > _ELASTIC) - 1]
    return tuple(float(f"{factor * first:.2g}") for factor in factors)


def _draw_forces(axes: Axes, scene: _Scene, speeds: tuple[float, ...]) -> None:
    loops = [_loop(scene, speed) for speed in speeds]
    depth, force = multiple("m", loops[-1][0]), multiple("N", loops[-1][1])
    for number, ((x, y), speed, (colour, dashes)) in enumerate(zip(loops, speeds, LOOPS, strict=False)):
        line = axes.plot(x / depth.size, y / force.size, color=colour, linestyle=dashes, linewidth=1.5, label=text(speed, "m/s", 2))[0]
        line.set_zorder(2.5 - 0.1 * number)  # the short loops above the long ones, which may hide them
    if min(np.min(part) for loop in loops for part in loop) < 0.0:
        axes.axhline(0.0, color="#555555", linewidth=0.7, zorder=1.5)
        axes.axvline(0.0, color="#555555", linewidth=0.7, zorder=1.5)
    axes.set_title("Force over indentation")
    axes.set_xlabel(f"Indentation [{depth.unit}]")
    label_vertical(axes, f"Contact force [{force.unit}]")
    axes.margins(x=0.03, y=0.05)
    legend = axes.legend(loc="upper left", title="Approach speed", alignment="left", handlelength=4.0, frameon=True)
    legend.get_frame().set(facecolor="white", edgecolor="none", alpha=1.0)  # or the axes' zero lines run through it


def _loop(scene: _Scene, speed: float) -> tuple[Floats, Floats]:
    """Return indentation [m] and force [N] of one impact, with the jumps at touch and release."""
    sphere = Body(mass=scene.pair.effective_mass, contact_offset=scene.pair.effective_radius)
    response = simulate(Problem(sphere=sphere, plate=rigid_plate(), laws=(scene.law,), speed=speed, gravity=0.0, impacts=1))
    duration = float(response.impacts["duration_s"][0])
    # close together at both ends, where the force jumps or is steep; not the very end, which belongs to the flight after it
    part = response.at(duration * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS))) * (1.0 - 1e-12))
    indentation, force = part["indentation_m"], part["force_N"]
    return np.concatenate([indentation[:1], indentation, indentation[-1:]]), np.concatenate([[0.0], force, [0.0]])


def _draw_restitution(axes: Axes, scene: _Scene, restitution: Floats, speeds: tuple[float, ...]) -> None:
    axes.plot(_SPEEDS, restitution, color=ACCENT, linewidth=1.5, label="achieved")
    asked = getattr(scene.law, "restitution", None)
    if asked is not None:
        axes.axhline(asked, color=INK, linewidth=0.8, linestyle=(0, (4, 3)), label="asked")
        axes.legend(loc="lower left")
    if isinstance(scene.law, CompliantLaw):
        at = achieved_restitution(scene.law, scene.pair.effective_mass, np.array(speeds))
        for speed, value, (colour, _) in zip(speeds, at, LOOPS, strict=False):
            axes.plot(speed, value, "o", color=colour, markersize=5.0, zorder=3)
    axes.set_xscale("log")
    axes.set_xlim(_SPEEDS[0] / 1.1, _SPEEDS[-1] * 1.1)
    axes.set_ylim(0.0, 1.05)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_title("Restitution over approach speed")
    axes.set_xlabel("Approach speed [m/s]")


def _caption(scene: _Scene) -> str:
    """Return the bodies and the parameters, three a line."""
    values = [(item, getattr(scene.law, item.name)) for item in fields(scene.law) if not item.metadata["memory"]]
    exponent = getattr(scene.law, "exponent", 1.5)
    parts = [f"{item.name} {value:.4g} {unit_of(item, exponent)}".rstrip() for item, value in values if value is not None]
    lines = [", ".join(parts[start : start + 4]) for start in range(0, len(parts), 4)]
    return "\n".join([f"{scene.words}, without gravity", *lines])
