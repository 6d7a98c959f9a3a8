"""The chart of a contact law: force over indentation, and restitution over approach
speed; and its picture.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.cases.reader import case_of
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Level, Line, Mark, Points
from vibroimpact.charts.palette import series
from vibroimpact.contact.law import CompliantLaw, ContactLaw, unit_of
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.recover import recover
from vibroimpact.law_sheets.text import paper_pair
from vibroimpact.units.display import brief, text

_SPEEDS = np.geomspace(1e-3, 30.0, 60)
_POINTS = 600
_HEIGHT = 3.6
_ELASTIC = 1.0 - 1e-9
"""Restitutions above this value count as one."""

_PER_LINE = 4
"""Parameters in a line below the title."""


@dataclass(frozen=True)
class _Example:
    """The example that a chart shows: the bodies in words, their pair, and the law."""

    words: str
    pair: ContactPair
    law: ContactLaw


def law_chart(law: type[ContactLaw]) -> Chart:
    """Return the curves of a contact law with typical parameters, for a sphere on a plate without
    gravity.

    Left the force over the indentation at three approach speeds (not for an instantaneous law),
    right the restitution over the approach speed. Laws with a yield strength or yield pressure are
    shown with a steel sphere, adhesive laws with a small sphere, all others with the paper's rock
    sphere.

    Parameters
    ----------
    law : type of ContactLaw
        The law's class.

    Examples
    --------
    >>> chart = law_chart(find_contact_law("hertz"))
    >>> [panel.title for panel in chart.panels]
    ['Force over indentation', 'Restitution over approach speed']
    """
    example = _example(law)
    restitution = achieved_restitution(example.law, example.pair.effective_mass, _SPEEDS)
    speeds = _typical_speeds(law, restitution)
    panels = [_restitution_panel(example, restitution, speeds)]
    caption = "Right: the restitution achieved at any approach speed."
    if isinstance(example.law, CompliantLaw):
        panels.insert(0, _force_panel(example, speeds))
        caption = (
            "Left: one impact at each of three approach speeds; the area enclosed by a loop "
            f"is the energy lost. {caption}"
        )
    return Chart(law.name, law.name, (tuple(panels),), caption, _HEIGHT, _subtitle(example))


def check_picture(target: Path, *, force: bool) -> None:
    """Check that a picture of a law can be written to a path.

    Raises
    ------
    InputError
        If the path is not that of a PNG file in an existing folder, or the file exists and `force`
        is false.

    Examples
    --------
    >>> check_picture(Path("hertz.svg"), force=False)
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: hertz.svg: the image is a PNG file; give a name that ends in .png
    """
    if target.suffix.lower() != ".png":
        raise InputError(f"{target}: the image is a PNG file; give a name that ends in .png")
    if target.is_dir():
        raise InputError(f"{target}: this is a folder; name a file in it")
    if not target.parent.is_dir():
        raise InputError(
            f"{target}: there is no folder {target.parent}; make it, or name another place"
        )
    if target.exists() and not force:
        raise InputError(f"{target} is there already; --force replaces it")


def save_law_picture(name: str, target: Path) -> Path:
    """Draw the curves of a contact law and write them as a PNG file; an existing file is replaced.

    Raises
    ------
    InputError
        If the law is unknown, or the file can't be written.
    """
    from vibroimpact.charts.files import render_png  # here, as it imports matplotlib
    from vibroimpact.charts.matplotlib import matplotlib_figure

    picture = render_png(matplotlib_figure(law_chart(find_contact_law(name))))
    try:
        recover(target)
        write_file(target, picture)
    except OSError as error:
        raise InputError(f"{target}: the image can't be written: {error.strerror}") from None
    return target


def _example(law: type[ContactLaw]) -> _Example:
    """Return the bodies and the law of the chart, by the kind of the law."""
    if {item.metadata["from_pair"] for item in fields(law)} & {"yield_pressure", "yield_strength"}:
        pair = _pair_of(0.025, "steel", "steel")
        return _Example("Steel sphere, radius 25 mm, on a steel plate", pair, law.example(pair))
    if getattr(law, "contact_end", "") == "pull-off":
        pair = _pair_of(1e-4, "rock-paper", "steel-paper")
        example = law.example(pair)
        # contacts of the smaller sphere are shorter in proportion
        if hasattr(example, "dissipation_time"):
            example = example.changed(
                {
                    "dissipation_time": example.dissipation_time
                    * pair.effective_radius
                    / paper_pair().effective_radius
                }
            )
        return _Example("Rock sphere, radius 0.1 mm, on a steel plate", pair, example)
    pair = paper_pair()
    return _Example("Rock sphere, radius 25 mm, on a steel plate", pair, law.example(pair))


def _pair_of(radius: float, sphere: str, plate: str) -> ContactPair:
    case = {"sphere": {"radius": radius, "material": sphere}, "plate": {"material": plate}}
    return contact_pair(case_of({**case, "drop": {"speed": 1.0}, "contact": {"law": "hertz"}}))


def _typical_speeds(law: type[ContactLaw], restitution: Floats) -> tuple[float, ...]:
    """Return three approach speeds [m/s] for the force curves, from the sticking or the
    yield speed on where there is one.
    """
    first = 1.0
    factors = (1.0, 3.0, 9.0)
    if getattr(law, "contact_end", "") == "pull-off" and np.any(restitution > 0.0):
        first = _SPEEDS[np.argmax(restitution > 0.0)]
        factors = (1.0, 2.0, 4.0)
    elif restitution[0] > _ELASTIC > restitution[-1]:
        first = _SPEEDS[np.argmin(restitution > _ELASTIC) - 1]
    return tuple(float(f"{factor * first:.2g}") for factor in factors)


def _force_panel(example: _Example, speeds: tuple[float, ...]) -> Panel:
    loops = [_loop(example, speed) for speed in speeds]
    marks: list[Mark] = []
    if min(np.min(part) for loop in loops for part in loop) < 0.0:
        marks += [Level(0.0, role="dotted"), Level(0.0, role="dotted", upright=True)]
    lines = [
        Line(*loop, f"approach at {text(speed, 'm/s', 2)}", series(number))
        for number, (loop, speed) in enumerate(zip(loops, speeds, strict=True))
    ]
    marks += reversed(lines)  # small loops on top, or larger ones would cover them
    return Panel(
        Axis("Indentation", "m"), Axis("Contact force", "N"), tuple(marks), "Force over indentation"
    )


def _loop(example: _Example, speed: float) -> tuple[Floats, Floats]:
    """Return indentation [m] and force [N] of one impact, including the jumps of the
    force at first touch and at the end.
    """
    sphere = Body(mass=example.pair.effective_mass, contact_offset=example.pair.effective_radius)
    response = simulate(
        Problem(
            sphere=sphere,
            plate=rigid_plate(),
            laws=(example.law,),
            speed=speed,
            gravity=0.0,
            impacts=1,
        )
    )
    duration = float(response.impacts["duration_s"][0])
    # Chebyshev points, dense at both ends, where the force jumps or is steep; the end itself
    # belongs to the next flight
    part = response.at(
        duration * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS))) * (1.0 - 1e-12)
    )
    indentation = part["indentation_m"]
    force = part["force_N"]
    return np.concatenate([indentation[:1], indentation, indentation[-1:]]), np.concatenate(
        [[0.0], force, [0.0]]
    )


def _restitution_panel(example: _Example, restitution: Floats, speeds: tuple[float, ...]) -> Panel:
    marks: list[Mark] = [Line(_SPEEDS, restitution, "restitution achieved", "detail")]
    asked = getattr(example.law, "restitution", None)
    if asked is not None:
        marks.append(Level(float(asked), "restitution asked"))
    if isinstance(example.law, CompliantLaw):
        at = achieved_restitution(example.law, example.pair.effective_mass, np.array(speeds))
        marks += [
            Points(np.array([speed]), at[number : number + 1], role=series(number))
            for number, speed in enumerate(speeds)
        ]
    speed = Axis("Approach speed", "m/s", log=True, range=(_SPEEDS[0] / 1.1, _SPEEDS[-1] * 1.1))
    return Panel(
        speed,
        Axis("Restitution", range=(0.0, 1.05)),
        tuple(marks),
        "Restitution over approach speed",
    )


def _subtitle(example: _Example) -> str:
    """Return the bodies, and the parameters, four per line."""
    values = [
        (item, getattr(example.law, item.name))
        for item in fields(example.law)
        if not item.metadata["memory"]
    ]
    exponent = getattr(example.law, "exponent", 1.5)
    parts = [
        f"{item.name} {brief(float(value), unit_of(item, exponent))}"
        for item, value in values
        if value is not None
    ]
    lines = [
        ", ".join(parts[start : start + _PER_LINE]) for start in range(0, len(parts), _PER_LINE)
    ]
    return "\n".join([f"{example.words}, without gravity", *lines])
