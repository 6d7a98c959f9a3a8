"""Figures 10 to 23: motion and energy of the sphere in Types 1, 2 and 3, and of the plate
in Type 3, by treatment.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.charts.chart import Chart
from vibroimpact.paper.measures import (
    energy_at_separation,
    falling_potential,
    history_column,
    in_first_impact,
    largest_of,
    sphere_rotation,
    sphere_strain,
)
from vibroimpact.paper.printed import printed, printed_values
from vibroimpact.paper.report.compared_quantity import ComparedQuantity, comparison_sentence
from vibroimpact.paper.report.comparison_chart import ResponseLine, comparison_rows
from vibroimpact.paper.report.impact_views import longest_contact
from vibroimpact.paper.runs import TREATMENTS, Runs, history_of
from vibroimpact.units.display import digits, largest, text

_CONTACT_DURATIONS = 1.2
"""Time shown after first touch, in durations of the longest contact."""
_BEFORE = 0.06
"""Time shown before first touch, relative to that after it."""
_SPHERE_ROW = 1.75
"""Height of the row of a treatment [in]."""
_ROLES = ("under", "series 1", "series 2")
"""Roles of up to three curves that may coincide."""


def _fitted_note(runs: Runs) -> str:
    return (
        "The local element of the identified treatment is fitted to the force and rebound "
        "height printed for Type 2."
    )


def _figure_14_note(runs: Runs) -> str:
    return "Figure 14 shows the energy that it prints instead."


def _first_touch_note(runs: Runs) -> str:
    response = runs.treated(2, "consistent")
    released = digits(float(history_of(response)["potential_J"][0]), 5)
    beyond = (
        "the rest is the fall beyond it, by compression and, in Type 3, by deflection of the plate."
    )
    return f"The fall to first touch releases {released} J; {beyond}"


def _strain_energy_note(runs: Runs) -> str:
    history = history_of(runs.treated(2, "consistent"))
    whole = text(float(np.max(history["sphere_strain_J"] + history["contact_elastic_J"])), "J", 3)
    return (
        "Shown is what the modes hold, and in the identified treatment the local spring; "
        "the contact law holds the rest: "
        f"with it the strain energy of Type 2 is up to {whole} in the consistent treatment."
    )


def _rotation_note(runs: Runs) -> str:
    return "A contact force through the centre of the sphere causes no rotation."


SPHERE_MOTION = (
    ComparedQuantity(
        10,
        "position of the sphere's centre",
        "Position",
        "m",
        history_column("position_m"),
        "First rebound height",
        in_first_impact("rebound_height_m"),
        "type{}.rebound_height",
        note=_fitted_note,
    ),
    ComparedQuantity(
        11,
        "contact force",
        "Contact force",
        "N",
        history_column("force_N"),
        "Largest force of the first impact",
        in_first_impact("max_force_N"),
        "type{}.max_force",
        note=_fitted_note,
    ),
    ComparedQuantity(
        12,
        "velocity of the sphere's centre",
        "Velocity",
        "m/s",
        history_column("velocity_m_s"),
        "Speed at the first separation",
        in_first_impact("separation_speed_m_s"),
        note=_figure_14_note,
    ),
    ComparedQuantity(
        13,
        "acceleration of the sphere's centre",
        "Acceleration",
        "m/s2",
        history_column("acceleration_m_s2"),
        "Largest acceleration in the first impact",
        in_first_impact("max_acceleration_m_s2"),
        "type{}.max_acceleration",
        note=_fitted_note,
    ),
)
"""Motion of the sphere in Types 1, 2 and 3."""

SPHERE_ENERGY = (
    ComparedQuantity(
        14,
        "kinetic energy of the sphere",
        "Kinetic energy",
        "J",
        history_column("kinetic_J"),
        "Kinetic energy at the first separation",
        energy_at_separation,
        "type{}.energy_at_separation",
        note=_fitted_note,
    ),
    ComparedQuantity(
        15,
        "potential energy of the sphere, zero where each fall begins",
        "Potential energy",
        "J",
        falling_potential,
        "Largest change",
        largest_of(falling_potential),
        "type{}.potential_energy",
        signs=(-1,),
        note=_first_touch_note,
    ),
    ComparedQuantity(
        16,
        "strain energy of the sphere",
        "Strain energy",
        "J",
        sphere_strain,
        "Largest strain energy",
        largest_of(sphere_strain),
        "type{}.strain_energy",
        note=_strain_energy_note,
    ),
    ComparedQuantity(
        17,
        "energy of the sphere's rotation",
        "Rotation",
        "J",
        sphere_rotation,
        "Largest energy of rotation",
        largest_of(sphere_rotation),
        "type{}.rotational_energy",
        note=_rotation_note,
    ),
)
"""Energy of the sphere in Types 2 and 3."""


def sphere_chart(shown: ComparedQuantity, runs: Runs) -> Chart:
    """Return the chart of a quantity of the sphere, with a row for each treatment; its motion also
    for the rigid sphere.

    Parameters
    ----------
    shown : ComparedQuantity
        One of `SPHERE_MOTION` and `SPHERE_ENERGY`.
    runs : Runs
        The simulations.
    """
    if shown in SPHERE_MOTION:
        rigid = [ResponseLine("Type 1, both rigid", _ROLES[0], runs.response("type1-variable"))]
    else:
        rigid = []
    rows = {
        treatment.capitalize(): [
            *rigid,
            ResponseLine("Type 2, elastic sphere", _ROLES[1], runs.treated(2, treatment)),
            ResponseLine("Type 3, elastic sphere and plate", _ROLES[2], runs.treated(3, treatment)),
        ]
        for treatment in TREATMENTS
    }
    responses = [line.response for row in rows.values() for line in row]
    names = {str(kind): shown.printed.format(kind) for kind in (1, 2, 3)}
    marks = {kind: printed(name).value for kind, name in names.items() if name in printed_values()}
    panels = comparison_rows(
        shown,
        rows,
        marks,
        lambda impact: _window(_CONTACT_DURATIONS * longest_contact(responses, impact)),
    )
    types = "1, 2 and 3" if rigid else "2 and 3"
    title = f"Figure {shown.number}: {shown.name}, Types {types}"
    caption = " ".join(
        (
            comparison_sentence(shown, (2, 3), runs),
            *_type_1_words(shown, marks, runs),
            shown.note(runs),
        )
    )
    return Chart(f"fig{shown.number}", title, panels, caption, _SPHERE_ROW)


def _window(after: float) -> tuple[float, float]:
    """Return the times shown before and after first touch [s]."""
    return _BEFORE * after, after


def _type_1_words(shown: ComparedQuantity, marks: Mapping[str, float], runs: Runs) -> list[str]:
    """Return the sentence on the computed and printed value of Type 1, in a list that is
    empty if none is printed.
    """
    if "1" not in marks:
        return []
    computed = text(shown.value(runs.response("type1-variable")), shown.unit)
    return [f"In Type 1 it is {computed}; printed {text(marks['1'], shown.unit)}."]


_PERIODS = 3.0
"""Time shown of the plate after first touch, in periods of its lowest mode."""


def _last_impact_note(runs: Runs) -> str:
    accelerations = []
    for treatment in TREATMENTS:
        response = runs.treated(3, treatment)
        history = history_of(response)
        since = history["time_s"] >= response.impacts["time_s"][-1]
        accelerations.append(
            f"{treatment} {text(largest(history['plate_acceleration_m_s2'][since]), 'm/s2', 3)}"
        )
    return (
        f"In the fifth impact: {', '.join(accelerations)}; printed: over "
        f"{printed('plate.acceleration.5').text} m/s²."
    )


def _plate_quantity(
    number: int, name: str, unit: str, history: str, printed_name: str, oscillates: bool
) -> ComparedQuantity:
    """Return a quantity of the plate; an oscillating one is printed as a magnitude, and
    marked on both sides of zero.
    """
    short = name.removeprefix("change of the ").removesuffix(" of the centre of mass").capitalize()
    timeline = history_column(history)
    signs = (-1, 1) if oscillates else (1,)
    return ComparedQuantity(
        number,
        f"plate, {name}",
        short,
        unit,
        timeline,
        "Largest magnitude",
        largest_of(timeline),
        f"plate.{printed_name}",
        signs,
    )


PLATE_QUANTITIES = (
    _plate_quantity(
        18, "displacement of the centre of mass", "m", "plate_displacement_m", "displacement", True
    ),
    _plate_quantity(
        19, "change of the potential energy", "J", "plate_potential_J", "potential_energy", True
    ),
    _plate_quantity(
        20, "velocity of the centre of mass", "m/s", "plate_velocity_m_s", "velocity", True
    ),
    _plate_quantity(21, "kinetic energy", "J", "plate_kinetic_J", "kinetic_energy", False),
    _plate_quantity(
        22,
        "acceleration of the centre of mass",
        "m/s2",
        "plate_acceleration_m_s2",
        "acceleration",
        True,
    )._replace(note=_last_impact_note),
    _plate_quantity(23, "strain energy", "J", "plate_strain_J", "strain_energy", False),
)


def plate_chart(shown: ComparedQuantity, runs: Runs) -> Chart:
    """Return the chart of a quantity of the plate, with a line for each treatment.

    Parameters
    ----------
    shown : ComparedQuantity
        One of `PLATE_QUANTITIES`.
    runs : Runs
        The simulations.
    """
    lines = [
        ResponseLine(treatment, role, runs.treated(3, treatment))
        for treatment, role in zip(TREATMENTS, _ROLES, strict=True)
    ]
    modes = lines[0].response.problem.plate.modes
    assert modes is not None  # Type 3 has an elastic plate
    after = _PERIODS / float(modes.frequencies[0])
    panels = comparison_rows(
        shown, {"": lines}, {"": printed(shown.printed).value}, lambda impact: _window(after)
    )
    title = f"Figure {shown.number}: {shown.name}, Type 3"
    caption = " ".join(filter(None, (comparison_sentence(shown, (3,), runs), shown.note(runs))))
    return Chart(f"fig{shown.number}", title, panels, caption)
