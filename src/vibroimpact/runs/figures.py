"""All figures of the report of a run."""

from __future__ import annotations

from matplotlib.figure import Figure

from vibroimpact.report.style import style
from vibroimpact.results.result import Result
from vibroimpact.runs.deflection_figure import draw_deflection
from vibroimpact.runs.energy_figure import draw_ledger
from vibroimpact.runs.figure_data import contacts_with_duration
from vibroimpact.runs.force_indentation_figure import draw_loops
from vibroimpact.runs.history_figures import ACCELERATION, FORCE, POSITION, VELOCITY, draw_history
from vibroimpact.runs.sensor_figures import draw_sensor, drawn_sensors
from vibroimpact.runs.vibration_figures import draw_plate_energy, draw_plate_motion, draw_sphere_energy


def draw_figures(result: Result) -> dict[str, Figure]:
    """Draw the figures of a result.

    Parameters
    ----------
    result : Result
        Result of one drop.

    Returns
    -------
    dict of str to Figure
        Figures by name, in the order of the report: `position`, `force`, `velocity`, `acceleration`, `force_indentation` and `energy`;
        where bodies vibrate also `sphere_energy`, `plate_motion`, `plate_energy`, `deflection` and one per sensor. Force, acceleration
        and force over indentation exist only for contacts of finite duration, not with an instantaneous law.
    """
    in_contact = bool(len(contacts_with_duration(result)))
    with style():
        figures = {"position": draw_history(result, POSITION)}
        if in_contact:
            figures["force"] = draw_history(result, FORCE)
        figures["velocity"] = draw_history(result, VELOCITY)
        if in_contact:
            figures["acceleration"] = draw_history(result, ACCELERATION)
            figures["force_indentation"] = draw_loops(result)
        figures["energy"] = draw_ledger(result)
        figures |= _of_vibration(result) if result.vibrates and len(result.impacts["time_s"]) else {}
    return figures


def _of_vibration(result: Result) -> dict[str, Figure]:
    figures = {"sphere_energy": draw_sphere_energy(result)}
    if "plate" in result.peaks:
        figures |= {"plate_motion": draw_plate_motion(result), "plate_energy": draw_plate_energy(result)}
        figures |= {"deflection": draw_deflection(result)} if result.deflection is not None else {}
        figures |= {figure: draw_sensor(result, name) for figure, name in drawn_sensors(result).items()}
    return figures
