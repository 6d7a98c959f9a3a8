"""What to see in each figure, in a sentence or two, with the numbers of the run."""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.problem import STANDARD_GRAVITY
from vibroimpact.report.style import ENLARGED
from vibroimpact.results.result import Result
from vibroimpact.runs.captions_motion import (
    deflection_caption,
    plate_energy_caption,
    plate_motion_caption,
    sensor_caption,
    sphere_energy_caption,
)
from vibroimpact.runs.sensor_figures import drawn_sensors
from vibroimpact.runs.tables import energy_text, entry_text, figures_of
from vibroimpact.runs.windows import contacts, enlarged
from vibroimpact.units.display import certain, digits, fixed, text


def caption(name: str, result: Result) -> str:
    """Return the caption of a figure that the result has."""
    if name in (sensors := drawn_sensors(result)):
        return sensor_caption(result, sensors[name])
    return _WRITERS[name](result)


def left_out(result: Result) -> str:
    """Return a sentence about figures that this run does not have; empty if it has all."""
    if len(contacts(result)):
        return ""
    if not len(result.impacts["time_s"]):
        return "The sphere does not reach the plate in this run, so there are no figures of contact force, acceleration and indentation."
    return (
        "The contact law is instantaneous: contact has no duration, and force, acceleration and indentation in it "
        "do not exist, so there are no figures of them."
    )


def _position(result: Result) -> str:
    start = text(float(result.history["position_m"][0]), "m")
    if not len(result.impacts["time_s"]):
        return f"The sphere's centre starts {start} above the plate and has not touched it when the run ends."
    words = f"The sphere's centre starts {start} above the plate's surface."
    deepest = int(np.argmax(result.impacts["max_indentation_m"]))
    if len(contacts(result)):
        depth = text(float(result.impacts["max_indentation_m"][deepest]), "m")
        words += f" The largest indentation, {depth}, is that of impact {deepest + 1}."
    rebound = float(result.impacts["rebound_height_m"][0])
    if np.isfinite(rebound) and result.impacts["separation_speed_m_s"][0] > 0.0:
        words += f" The first rebound takes it to {text(rebound, 'm')}."
    return f"{words} {_enlarged(result)}".strip()


def _force(result: Result) -> str:
    impacts, most = result.impacts, int(np.nanargmax(result.impacts["max_force_N"]))
    lead = float(impacts["time_of_max_indentation_s"][most] - impacts["time_of_max_force_s"][most])
    words = f"The largest force, {entry_text(result, most, 'max_force_N', 'N')}, acts in impact {most + 1}"
    if lead > 0.001 * impacts["duration_s"][most]:
        words += f", {text(lead, 's', 3)} before the largest indentation: damping adds to the force on the way in"
    return f"{words}. {_in_whole_run(result)}".strip()


def _velocity(result: Result) -> str:
    impacts = result.impacts
    if not len(impacts["time_s"]):
        return "The sphere falls freely through the whole run."
    approach, separation = float(impacts["approach_speed_m_s"][0]), float(impacts["separation_speed_m_s"][0])
    return (
        f"In impact 1 the sphere arrives at {text(approach, 'm/s')} and leaves at {text(separation, 'm/s')}: "
        f"a restitution of {fixed(separation / approach, 4)}. Between impacts the line's slope is gravity alone."
    )


def _acceleration(result: Result) -> str:
    most = int(np.nanargmax(result.impacts["max_acceleration_m_s2"]))
    value = float(result.impacts["max_acceleration_m_s2"][most]) / STANDARD_GRAVITY
    times = certain(digits(value, 3), value, int(figures_of("max_acceleration_m_s2", result.change_by_impact)[most]))
    return (
        f"The largest magnitude, {entry_text(result, most, 'max_acceleration_m_s2', 'm/s2')} in impact {most + 1}, is {times} times "
        f"standard gravity. {_in_whole_run(result)}"
    ).strip()


def _loops(result: Result) -> str:
    found, lost = contacts(result), result.impacts["energy_lost_J"]
    if result.impacts["separation_speed_m_s"][found[-1]] == 0.0:
        return (
            f"In impact {found[-1] + 1} the sphere stays; what energy it still has is written off in the ledger, and its curve ends there."
        )
    if np.max(lost) < 1e-9 * result.energy["input_J"]:
        return "The way in and the way out coincide: no energy is lost in contact."
    first, last = (entry_text(result, impact, "energy_lost_J", "J") for impact in (found[0], found[-1]))
    also = " and what goes into the sphere's own vibration. Lost" if "sphere" in result.peaks else ""
    if result.deformation.get("treatment") == "identified":
        also = " and what the local element still holds at release. Lost"
    words = f"The area that a loop encloses is the energy lost in that contact{also}: {first} in impact {found[0] + 1}"
    return f"{words}, {last} in impact {found[-1] + 1}." if len(found) > 1 else f"{words}."


def _energy(result: Result) -> str:
    put_in = result.energy["input_J"]
    words = (
        f"Of {text(put_in, 'J')} put in, {energy_text(result, 'contact_dissipated_J', 'plastic_work_J')} are lost in contact by the end."
    )
    words += _vibration(result) if result.vibrates else ""
    if np.min(result.history["potential_J"]) < -0.01 * put_in:
        words += " Below the height of first touch the potential energy is negative; there the other bands begin below zero."
    return words + " The bands add up to the energy put in at all times."


def _vibration(result: Result) -> str:
    """Tell where the energy of vibration went: what is left of it, and what its damping took."""
    damped = energy_text(result, "sphere_damping_J", "plate_damping_J")
    left = energy_text(result, "sphere_vibration_J", "sphere_strain_J", "plate_kinetic_J", "plate_strain_J")
    return f" The damping of the bodies took {damped}, and {left} are still in their motion."


def _enlarged(result: Result) -> str:
    total = len(contacts(result))
    return f"Of the {total} contacts the first {ENLARGED} are enlarged." if len(enlarged(result)) < total and total > ENLARGED else ""


def _in_whole_run(result: Result) -> str:
    """Tell that contacts look like lines in the whole run, where they do."""
    found, span = contacts(result), result.history["time_s"][-1]
    part = float(np.sum(result.impacts["duration_s"][found])) / span
    if part > 0.02:
        return ""
    return f"Contact takes {digits(100.0 * part, 2)} % of the run, so it shows as thin lines in the whole run and is enlarged beneath."


_WRITERS = {
    "position": _position,
    "force": _force,
    "velocity": _velocity,
    "acceleration": _acceleration,
    "force_indentation": _loops,
    "energy": _energy,
    "sphere_energy": sphere_energy_caption,
    "plate_motion": plate_motion_caption,
    "plate_energy": plate_energy_caption,
    "deflection": deflection_caption,
}
