"""Figures 18 to 23: how the plate of Type 3 moves, and its energy."""

from __future__ import annotations

from vibroimpact.paper.measures import column, largest_of
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.compared import Compared, beside_printed
from vibroimpact.paper.report.compared_rows import Line, draw_rows
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import TREATMENTS, Runs, history_of
from vibroimpact.units.display import largest, text

_PERIODS = 3.0
"""How long the plate is shown after first touch, in periods of its lowest mode."""
_HEIGHT = 2.4
"""Height of the panels [in]."""


def _last_impact(runs: Runs) -> str:
    found = []
    for treatment in TREATMENTS:
        response = runs.treated(3, treatment)
        history = history_of(response)
        since = history["time_s"] >= response.impacts["time_s"][-1]
        found.append(f"{treatment} {text(largest(history['plate_acceleration_m_s2'][since]), 'm/s2', 3)}")
    return f"In the fifth impact: {', '.join(found)}; printed: over {printed('plate.acceleration.5').text} m/s²."


def _of_plate(number: int, name: str, unit: str, history: str, printed_name: str, swings: bool) -> Compared:
    """Return a quantity of the plate; one that swings is printed as a magnitude."""
    short = name.split(",")[0].removesuffix(" of the centre of mass").capitalize()
    timeline, signs = column(history), (-1, 1) if swings else (1,)
    return Compared(
        number, f"plate, {name}", short, unit, timeline, "Largest magnitude", largest_of(timeline), f"plate.{printed_name}", signs
    )


PLATE = (
    _of_plate(18, "displacement of the centre of mass", "m", "plate_displacement_m", "displacement", True),
    _of_plate(19, "change of the potential energy", "J", "plate_potential_J", "potential_energy", True),
    _of_plate(20, "velocity of the centre of mass", "m/s", "plate_velocity_m_s", "velocity", True),
    _of_plate(21, "kinetic energy", "J", "plate_kinetic_J", "kinetic_energy", False),
    _of_plate(22, "acceleration of the centre of mass", "m/s2", "plate_acceleration_m_s2", "acceleration", True)._replace(
        note=_last_impact
    ),
    _of_plate(23, "strain energy", "J", "plate_strain_J", "strain_energy", False),
)


def draw_plate(shown: Compared, runs: Runs) -> Drawing:
    """Draw a quantity of the plate, a line a treatment.

    Parameters
    ----------
    shown : Compared
        One of `PLATE`.
    runs : Runs
        The simulations.
    """
    lines = [Line(treatment, place, runs.treated(3, treatment)) for place, treatment in enumerate(TREATMENTS)]
    modes = lines[0].response.problem.plate.modes
    assert modes is not None  # Type 3 has an elastic plate
    head = f"{shown.heading}: whole run at the left, after the first impact at the right"
    marks = {"": printed(shown.printed).value}
    figure = draw_rows(shown, {"": lines}, marks, _PERIODS / float(modes.frequencies[0]), _HEIGHT, head)
    title = f"Figure {shown.number}: {shown.name}, Type 3"
    return Drawing(figure, title, " ".join(filter(None, (beside_printed(shown, (3,), runs), shown.note(runs)))))
