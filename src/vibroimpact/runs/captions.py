"""Captions of the charts of a run and of its plate in motion, with its numbers."""

from __future__ import annotations

import numpy as np

from vibroimpact.results.result import Result
from vibroimpact.runs.below import body_below, is_free_below, level_below
from vibroimpact.runs.chart_data import contacts_with_duration
from vibroimpact.runs.scene import exaggeration
from vibroimpact.runs.sensor_charts import MOST, drawn_sensors
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response
from vibroimpact.runs.tables import energy_text, impact_text, significant_figures
from vibroimpact.units.display import STANDARD_GRAVITY, certain, digits, fixed, text

_NOTHING_LEFT = 1e-9  # of the energy put in


def caption(name: str, result: Result) -> str:
    """Return the caption of a chart of the result, by the name of the chart."""
    if name in (sensors := drawn_sensors(result)):
        return sensor_caption(result, sensors[name])
    return _WRITERS[name](result)


def left_out(result: Result) -> str:
    """Return a sentence stating which figures of contact do not exist and why; empty if
    all exist.
    """
    if len(contacts_with_duration(result)):
        return ""
    if not len(result.impacts["time_s"]):
        below = body_below(result)
        return (
            f"The sphere does not reach the {below} in this run, so that there are no "
            "charts of contact force, acceleration and indentation."
        )
    return (
        "The contact law is instantaneous: the contact has no duration, force, acceleration "
        "or indentation, so that there are no charts of them."
    )


def _position(result: Result) -> str:
    start = text(float(result.history["position_m"][0]), "m")
    phrase = f"The sphere's centre starts {start} above {level_below(result)}"
    if not len(result.impacts["time_s"]):
        return f"{phrase}; the sphere has not touched the {body_below(result)} when the run ends."
    phrase += "."
    deepest = int(np.argmax(result.impacts["max_indentation_m"]))
    if len(contacts_with_duration(result)):
        depth = text(float(result.impacts["max_indentation_m"][deepest]), "m")
        phrase += f" The largest indentation, {depth}, is that of impact {deepest + 1}."
    rebound = float(result.impacts["rebound_height_m"][0])
    if np.isfinite(rebound) and result.impacts["separation_speed_m_s"][0] > 0.0:
        phrase += f" The first rebound takes it to {text(rebound, 'm')}."
    return phrase


def _force(result: Result) -> str:
    impacts = result.impacts
    most = int(np.nanargmax(result.impacts["max_force_N"]))
    lead = float(impacts["time_of_max_indentation_s"][most] - impacts["time_of_max_force_s"][most])
    phrase = (
        f"The largest force, {impact_text(result, most, 'max_force_N', 'N')}, "
        f"acts in impact {most + 1}"
    )
    if lead > 0.001 * impacts["duration_s"][most]:
        causes = []
        if _loses_in_contact(result):
            causes.append("damping adds to the force during loading")
        if "sphere" in result.peaks:
            causes.append("the sphere vibrates")
        phrase += f", {text(lead, 's', 3)} before the largest indentation"
        if causes:
            phrase += f": {', and '.join(causes)}"
    return f"{phrase}. {_in_whole_run(result)}".strip()


def _loses_in_contact(result: Result) -> bool:
    """Return whether an impact loses energy in its contact, apart from rounding."""
    return bool(np.max(result.impacts["energy_lost_J"]) >= _NOTHING_LEFT * result.energy["input_J"])


def _velocity(result: Result) -> str:
    impacts = result.impacts
    if not len(impacts["time_s"]):
        return f"The sphere does not touch the {body_below(result)} in this run."
    columns = {
        "approach_speed_m_s": "m/s",
        "separation_speed_m_s": "m/s",
        "restitution_achieved": "",
    }
    approach, separation, restitution = (
        impact_text(result, 0, name, unit) for name, unit in columns.items()
    )
    phrase = f"In impact 1 the sphere arrives at {approach} and leaves at {separation}"
    if "tangential_restitution" in impacts:
        phrase += ", along the normal"
    if _moves_below(result):
        phrase += f", relative to the {body_below(result)}"
    return f"{phrase}: a restitution of {restitution}."


def _moves_below(result: Result) -> bool:
    """Return whether what the sphere falls on is shaken or free, so that speeds are
    relative to it.
    """
    return "plate_velocity_m_s" in result.impacts or is_free_below(result)


def _acceleration(result: Result) -> str:
    most = int(np.nanargmax(result.impacts["max_acceleration_m_s2"]))
    value = float(result.impacts["max_acceleration_m_s2"][most]) / STANDARD_GRAVITY
    times = certain(
        digits(value, 3),
        value,
        int(significant_figures("max_acceleration_m_s2", result.change_by_impact)[most]),
    )
    return (
        "The largest magnitude, "
        f"{impact_text(result, most, 'max_acceleration_m_s2', 'm/s2')} in impact {most + 1}, "
        f"is {times} times "
        f"standard gravity. {_in_whole_run(result)}"
    ).strip()


def _loops(result: Result) -> str:
    contacts = contacts_with_duration(result)
    if result.impacts["separation_speed_m_s"][contacts[-1]] == 0.0:
        below = body_below(result)
        return (
            f"In impact {contacts[-1] + 1} the sphere does not leave the {below} again; its curve "
            "ends where that is certain."
        )
    if not _loses_in_contact(result) and "sphere" in result.peaks:
        return (
            "No energy is lost in contact: the area that a loop encloses is the energy that the "
            "sphere's vibration took up."
        )
    if not _loses_in_contact(result):
        return "Loading and unloading coincide: no energy is lost in contact."
    first, last = (
        impact_text(result, impact, "energy_lost_J", "J") for impact in (contacts[0], contacts[-1])
    )
    also = ""
    if result.deformation.get("treatment") == "identified":
        also = " and the energy stored in the local element at release. Lost"
    elif "sphere" in result.peaks:
        also = " and the energy that the sphere's vibration took up. Lost"
    phrase = (
        f"The area that a loop encloses is the energy lost in that contact{also}: {first} in "
        f"impact {contacts[0] + 1}"
    )
    if len(contacts) > 1:
        phrase += f", {last} in impact {contacts[-1] + 1}"
    return f"{phrase}."


def _energy(result: Result) -> str:
    put_in = result.energy["input_J"]
    lost = energy_text(result, "contact_dissipated_J", "plastic_work_J")
    phrase = f"Of {text(put_in, 'J')} put in, {lost} is lost in contact by the end."
    if "friction_J" in result.energy:
        friction = energy_text(result, "friction_J")
        phrase = (
            f"Of {text(put_in, 'J')} put in, {lost} is lost in contact along the normal by the "
            f"end, and {friction} by friction."
        )
    phrase += _vibration(result)
    if result.energy.get("drive_J"):
        drawn = result.energy["drive_J"]
        verb = "added" if drawn < 0.0 else "removed"
        phrase += f" The moving plate {verb} {text(abs(drawn), 'J')}."
    if np.min(result.history["potential_J"]) < -0.01 * put_in:
        phrase += (
            " Below the height of first touch the potential energy is negative; the other bands "
            "then begin below zero."
        )
    supplied = "the energy put in"
    if "drive_J" in result.energy:
        supplied += " and the work of the plate"
    return f"{phrase} The bands add up to {supplied} at all times."


def _vibration(result: Result) -> str:
    """Return sentences on what the damping of the bodies dissipated, and on the energy
    left in their motion; empty if none moves.
    """
    least = _NOTHING_LEFT * result.energy["input_J"]
    bodies = {}
    if "sphere" in result.peaks:
        bodies["the vibration of the sphere"] = ["sphere_vibration_J", "sphere_strain_J"]
    of_plate = ["plate_kinetic_J", "plate_strain_J"]
    plate_energy = sum(abs(result.energy.get(name, 0.0)) for name in of_plate)
    # a plate that is free and rigid moves without having peaks of a vibration
    if "plate" in result.peaks or plate_energy > least:
        # without that of the supports
        kind = "vibration" if "surface_m" in result.history else "motion"
        bodies[f"the {kind} of the {body_below(result)}"] = of_plate
    if not bodies:
        return ""
    where = next(iter(bodies))
    if len(bodies) > 1:
        where = f"the {kind} of both"
    names = [name for entries in bodies.values() for name in entries if name in result.energy]
    remaining_energy = sum(abs(result.energy[name]) for name in names)
    remaining = f"less than {text(least, 'J', 1)}"
    if remaining_energy > least:
        remaining = energy_text(result, *names)
    if not result.peaks:
        return f" At the end {remaining} remains in {where}."
    damped = energy_text(result, "sphere_damping_J", "plate_damping_J")
    return f" The damping of the bodies dissipated {damped}, and {remaining} remains in {where}."


def _in_whole_run(result: Result) -> str:
    """Return a sentence stating that contacts are too short to be resolved in the whole
    run; empty if they take over 2 % of it.
    """
    contacts = contacts_with_duration(result)
    span = result.history["time_s"][-1]
    part = float(np.sum(result.impacts["duration_s"][contacts])) / span
    if part > 0.02:
        return ""
    return (
        f"Contacts take {digits(100.0 * part, 2)} % of the run, and appear as "
        "thin lines in the whole run."
    )


def sphere_energy_caption(result: Result) -> str:
    """Return the caption of the figure of the sphere's energies."""
    history = result.history
    put_in = result.energy["input_J"]
    sentences = (
        "The largest kinetic energy of the sphere's centre is "
        f"{text(float(history['kinetic_J'].max()), 'J')}."
    )
    if "sphere" not in result.peaks:
        return f"{sentences} The sphere has no modes in this run."
    strain = float(history["sphere_strain_J"].max())
    vibration = _after_first(result, "sphere_strain_J", "sphere_vibration_J")
    sentences += (
        f" The strain energy of its modes is at most {_part(strain, put_in)}; its energy "
        f"of vibration at the first release is {_part(vibration, put_in)}."
    )
    turning = float(history["sphere_rotational_J"].max())
    return (
        f"{sentences} The energy of its rotation is at most "
        f"{text(max(turning, 1e-15 * put_in), 'J', 2)}."
    )


def plate_motion_caption(result: Result) -> str:
    """Return the caption of the figure of the plate's motion."""
    peaks = result.peaks["plate"]
    names = (
        ("max_displacement_m", "m"),
        ("max_velocity_m_s", "m/s"),
        ("max_acceleration_m_s2", "m/s2"),
    )
    most = [text(float(np.max(peaks[name])), unit) for name, unit in names]
    deflection = text(float(np.abs(result.history["plate_deflection_m"]).max()), "m")
    sentences = (
        f"The plate's centre of mass moves by up to {most[0]}, with up to {most[1]} and "
        f"{most[2]}; the contact point by up to {deflection}."
    )
    lowest = result.frequencies("plate")[0]
    periods = lowest * float(result.impacts["duration_s"][0])
    return (
        f"{sentences} The first impact lasts {digits(periods, 2)} periods of the lowest mode, of "
        f"{digits(lowest)}\u00a0Hz."
    )


def plate_energy_caption(result: Result) -> str:
    """Return the caption of the figure of the plate's energies."""
    peaks = result.peaks["plate"]
    put_in = result.energy["input_J"]
    kinetic, strain = (
        _part(float(np.max(peaks[name])), put_in)
        for name in ("max_kinetic_energy_J", "max_strain_energy_J")
    )
    change = text(float(np.abs(result.history["plate_potential_J"]).max()), "J")
    sentences = (
        f"At most {kinetic} of the energy put in is kinetic energy of the plate, and {strain} "
        "strain energy."
    )
    if not result.history["plate_potential_J"].any():  # without gravity
        return sentences
    return (
        f"{sentences} Its potential energy changes by up to {change}, which the strain energy due "
        "to its own weight balances."
    )


def deflection_caption(result: Result) -> str:
    """Return the caption of the maps of the plate's deflection."""
    assert result.deflection is not None  # as the figure exists
    largest = float(np.nanmax(np.abs(result.deflection.height)))
    return (
        f"Displacement of the upper side, up to {text(largest, 'm')}, on a common scale; solid "
        "contours up, dashed down, thick zero."
    )


def scene_caption(result: Result) -> str:
    """Return the caption of the plate in motion."""
    assert result.deflection is not None  # as the scene exists
    factor = exaggeration(result.deflection)
    return (
        f"The first impact in slow motion. The plate's deflection is magnified {factor:g} "
        "times; the ball and its gap to the plate "
        "are to scale. Time is slowed down most around the contact."
    )


_FILTERS = {
    "sigma-delta": "after the filter of a sigma-delta converter, whose delay is removed",
    "butterworth": "after a Butterworth filter of order eight, with its delay",
    "none": "without an anti-alias filter: frequencies above half the rate are aliased",
}


def sensor_caption(result: Result, name: str) -> str:
    """Return the caption of the figure of a sensor."""
    signal = result.signals[name]
    sensor = signal.sensor
    part = first_response(result, name)
    sentences = (
        f"Largest magnitude {text(signal.largest, sensor.unit)}, of {len(signal.value)} "
        f"samples at {digits(sensor.rate)}"
        f"\u00a0Hz, {_FILTERS[sensor.filter]}."
    )
    if signal.overload_time > 0.0:
        sentences += " Its accelerometer is overloaded: values beyond its range are clipped"
        if sensor.filter != "none":
            sentences += " before the filter, which may overshoot the range"
        sentences += "."
    values = signal.value[part]
    if len(values) < 4 or not np.any(values):
        return sentences
    spectrum = amplitude_spectrum(values, sensor.rate)
    top = 1 + int(spectrum.amplitude[1:].argmax())
    ticks = ""
    if result.frequencies("plate"):
        ticks = "; ticks mark the plate's modes"
    return (
        f"{sentences} The spectrum is one-sided, of {text(spectrum.span, 's', 3)} from the first "
        "touch on, with the falling half of a Hann "
        f"window, scaled to the amplitude of a steady sinusoid. Its maximum lies at "
        f"{digits(float(spectrum.frequency[top]), 3)}\u00a0Hz{ticks}."
    )


def sensors_left_out(result: Result) -> str:
    """Return a sentence stating that only some sensors are drawn; empty if all are."""
    more = len(result.signals) - MOST
    if more > 0:
        return (
            f"Of the {len(result.signals)} sensors the first {MOST} are drawn; the signals of "
            "all are in result.nc."
        )
    return ""


def _after_first(result: Result, *names: str) -> float:
    """Return the sum of columns of the history at the first release."""
    release = float(result.impacts["time_s"][0] + result.impacts["duration_s"][0])
    last = np.searchsorted(result.history["time_s"], release, side="right") - 1
    return float(sum(result.history[name][last] for name in names))


def _part(value: float, whole: float) -> str:
    return f"{text(value, 'J')} ({fixed(100.0 * value / whole, 2)}\u00a0%)"


def _along_plate(result: Result) -> str:
    friction = result.case.get("contact", {}).get("friction")
    motion = "the sphere moves freely"
    if "air_J" in result.energy:
        motion = "the drag of air slows the sphere"
    elif "liquid_J" in result.energy:
        motion = "the drag of the liquid slows the sphere"
    phrase = f"Along the plate {motion} between impacts"
    if friction is None:
        return f"{phrase}; there is no friction."
    phrase += (
        f"; in contact, friction ({friction['law']}, coefficient "
        f"{float(friction['coefficient']):g}) acts on it."
    )
    ratio = result.impacts["tangential_restitution"]
    if len(ratio) and np.isfinite(ratio[0]):
        phrase += f" The tangential restitution of impact 1 is {fixed(float(ratio[0]), 4)}."
    return phrase


def _path(result: Result) -> str:
    impacts = result.impacts
    history = result.history
    phrase = "Seen from above, to scale, with the sphere at its final position"
    if result.case.get("plate", {}).get("inclination"):
        phrase += ", and +x downhill"
    number = len(impacts["time_s"])
    if number > 1:
        first, last = (
            np.array([impacts[f"position_{axis}_m"][place] for axis in "xy"]) for place in (0, -1)
        )
        phrase += (
            f". From impact 1 to impact {number} it moves "
            f"{text(float(np.hypot(*(last - first))), 'm')}"
        )
    elif not number:
        phrase += ". It has not touched the plate"
    length = float(
        np.hypot(np.diff(history["position_x_m"]), np.diff(history["position_y_m"])).sum()
    )
    return f"{phrase}; the length of its path over the plate is {text(length, 'm')}."


_WRITERS = {
    "position": _position,
    "force": _force,
    "velocity": _velocity,
    "acceleration": _acceleration,
    "force_indentation": _loops,
    "energy": _energy,
    "along_plate": _along_plate,
    "path": _path,
    "sphere_energy": sphere_energy_caption,
    "plate_motion": plate_motion_caption,
    "plate_energy": plate_energy_caption,
    "deflection": deflection_caption,
}
