"""Figures 10 to 17: what rigid and elastic bodies do to the motion of the sphere, and to its energy."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.paper.measures import (
    column,
    energy_at_separation,
    falling_potential,
    in_first_impact,
    largest_of,
    sphere_rotation,
    sphere_strain,
)
from vibroimpact.paper.printed import printed, printed_values
from vibroimpact.paper.report.compared import Compared, beside_printed
from vibroimpact.paper.report.compared_rows import Line, draw_rows
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import TREATMENTS, Runs, history_of
from vibroimpact.units.display import digits, text

_LONGEST = 1.2
"""How much of the first impact is shown, in the durations of the longest contact."""
_HEIGHT = 1.15
"""Height of the panels [in]."""


def _fitted(runs: Runs) -> str:
    return "The local element of the identified treatment is fitted to the force and rebound height printed of Type 2."


def _energy_in_figure_14(runs: Runs) -> str:
    return "Figure 14 has the energy that it prints instead."


def _at_first_touch(runs: Runs) -> str:
    response = runs.treated(2, "consistent")
    released = digits(float(history_of(response)["potential_J"][0]), 5)
    return f"The fall to first touch releases {released} J; the rest is compression."


def _elastic_in_all(runs: Runs) -> str:
    history = history_of(runs.treated(2, "consistent"))
    whole = text(float(np.max(history["sphere_strain_J"] + history["contact_elastic_J"])), "J", 3)
    return (
        "Shown is what the modes hold, and in the identified treatment the local spring; the contact law holds the rest: "
        f"with it there are up to {whole} in Type 2, consistent."
    )


def _upright(runs: Runs) -> str:
    return "Nothing turns a sphere that is hit straight below its centre."


MOTION = (
    Compared(
        10,
        "position of the sphere's centre",
        "Position",
        "m",
        column("position_m"),
        "First rebound height",
        in_first_impact("rebound_height_m"),
        "type{}.rebound_height",
        note=_fitted,
    ),
    Compared(
        11,
        "contact force",
        "Contact force",
        "N",
        column("force_N"),
        "Largest force of the first impact",
        in_first_impact("max_force_N"),
        "type{}.max_force",
        note=_fitted,
    ),
    Compared(
        12,
        "velocity of the sphere's centre",
        "Velocity",
        "m/s",
        column("velocity_m_s"),
        "Speed at the first separation",
        in_first_impact("separation_speed_m_s"),
        note=_energy_in_figure_14,
    ),
    Compared(
        13,
        "acceleration of the sphere's centre",
        "Acceleration",
        "m/s2",
        column("acceleration_m_s2"),
        "Largest acceleration in the first impact",
        in_first_impact("max_acceleration_m_s2"),
        "type{}.max_acceleration",
        note=_fitted,
    ),
)
"""Of Types 1, 2 and 3."""

ENERGY = (
    Compared(
        14,
        "kinetic energy of the sphere",
        "Kinetic energy",
        "J",
        column("kinetic_J"),
        "Kinetic energy at the first separation",
        energy_at_separation,
        "type{}.energy_at_separation",
        note=_fitted,
    ),
    Compared(
        15,
        "potential energy of the sphere, zero where each fall begins",
        "Potential energy",
        "J",
        falling_potential,
        "Largest change",
        largest_of(falling_potential),
        "type{}.potential_energy",
        signs=(-1,),
        note=_at_first_touch,
    ),
    Compared(
        16,
        "strain energy of the sphere",
        "Strain energy",
        "J",
        sphere_strain,
        "Largest strain energy",
        largest_of(sphere_strain),
        "type{}.strain_energy",
        note=_elastic_in_all,
    ),
    Compared(
        17,
        "energy of the sphere's rotation",
        "Rotation",
        "J",
        sphere_rotation,
        "Largest energy of rotation",
        largest_of(sphere_rotation),
        "type{}.rotational_energy",
        note=_upright,
    ),
)
"""Of Types 2 and 3."""


def draw_types(shown: Compared, runs: Runs) -> Drawing:
    """Draw a quantity of the sphere, a row a treatment; of its motion beside that of the rigid sphere.

    Parameters
    ----------
    shown : Compared
        One of `MOTION` and `ENERGY`.
    runs : Runs
        The simulations.
    """
    rigid = [Line("Type 1, both rigid", 0, runs.response("type1-variable"))] if shown in MOTION else []
    rows = {
        treatment.capitalize(): [
            *rigid,
            Line("Type 2, elastic sphere", 1, runs.treated(2, treatment)),
            Line("Type 3, elastic sphere and plate", 2, runs.treated(3, treatment)),
        ]
        for treatment in TREATMENTS
    }
    longest = max(float(line.response.impacts["duration_s"][0]) for row in rows.values() for line in row)
    names = {str(kind): shown.printed.format(kind) for kind in (1, 2, 3)}
    marks = {kind: printed(name).value for kind, name in names.items() if name in printed_values()}
    head = f"{shown.heading}: whole run at the left, first impact at the right"
    figure = draw_rows(shown, rows, marks, _LONGEST * longest, _HEIGHT, head)
    title = f"Figure {shown.number}: {shown.name}, Types {'1, 2 and 3' if rigid else '2 and 3'}"
    return Drawing(figure, title, " ".join((beside_printed(shown, (2, 3), runs), *_of_type_1(shown, marks, runs), shown.note(runs))))


def _of_type_1(shown: Compared, marks: Mapping[str, float], runs: Runs) -> list[str]:
    """Say what is computed and printed of Type 1, if it is printed."""
    if "1" not in marks:
        return []
    computed = text(shown.value(runs.response("type1-variable")), shown.unit)
    return [f"In Type 1 it is {computed}; printed {text(marks['1'], shown.unit)}."]
