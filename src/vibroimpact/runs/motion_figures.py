"""The figures of bodies that vibrate: energies of the sphere, motion and energies of the plate."""

from __future__ import annotations

from matplotlib.figure import Figure

from vibroimpact.results.fine_history import close_span
from vibroimpact.results.result import Result
from vibroimpact.runs.panels import Panel, draw_panels

_SPHERE = (
    Panel(("kinetic_J",), "J", "Kinetic energy of the centre"),
    Panel(("potential_J",), "J", "Potential energy, zero at first touch"),
)
_SPHERE_MODES = (
    Panel(("sphere_strain_J",), "J", "Strain energy of its modes"),
    Panel(("sphere_strain_J", "sphere_vibration_J"), "J", "Energy of its vibration: strain and kinetic"),
    Panel(("sphere_rotational_J",), "J", "Energy of rotation"),
)
_PLATE_MOTION = (
    Panel(("plate_displacement_m",), "m", "Displacement of the centre of mass"),
    Panel(("plate_velocity_m_s",), "m/s", "Velocity of the centre of mass"),
    Panel(("plate_acceleration_m_s2",), "m/s2", "Acceleration of the centre of mass"),
    Panel(("plate_deflection_m",), "m", "Displacement at the contact point"),
)
_PLATE_ENERGY = (
    Panel(("plate_kinetic_J",), "J", "Kinetic energy"),
    Panel(("plate_strain_J",), "J", "Strain energy, from where it rests"),
    Panel(("plate_kinetic_J", "plate_strain_J"), "J", "Energy of its vibration: strain and kinetic"),
    Panel(("plate_potential_J",), "J", "Change of the potential energy"),
)
_VISIT = 1.6
"""How much of the first visit is shown, in its durations."""


def draw_sphere_energy(result: Result) -> Figure:
    """Draw where the energy of the sphere is."""
    rows = _SPHERE + (tuple(panel for panel in _SPHERE_MODES if shows(result, panel.columns[0])) if "sphere" in result.peaks else ())
    return draw_panels(result, "Energy of the sphere", rows, _VISIT * float(result.impacts["duration_s"][0]))


def draw_plate_motion(result: Result) -> Figure:
    """Draw how the plate moves, as a whole and where it is hit."""
    return draw_panels(result, "Motion of the plate, upwards", _PLATE_MOTION, plate_span(result))


def draw_plate_energy(result: Result) -> Figure:
    """Draw where the energy of the plate is."""
    return draw_panels(result, "Energy of the plate", _PLATE_ENERGY, plate_span(result))


def plate_span(result: Result) -> float:
    """Return how long after first touch the plate is shown [s]: until it has moved up and down, or is hit again."""
    touches, duration = result.impacts["time_s"], float(result.impacts["duration_s"][0])
    until = float(touches[1]) if len(touches) > 1 else float(result.history["time_s"][-1])
    return max(min(close_span(1.0 / result.frequencies("plate")[0]), until - float(touches[0])), 1.2 * duration)


def shows(result: Result, column: str) -> bool:
    """Is an energy more than rounding of what was put in?"""
    return bool(result.history[column].max() > 1e-12 * result.energy["input_J"])
