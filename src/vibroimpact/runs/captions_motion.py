"""What to see in the figures of bodies that vibrate, with the numbers of the run."""

from __future__ import annotations

import numpy as np

from vibroimpact.results.result import Result
from vibroimpact.runs.animation import exaggeration
from vibroimpact.runs.sensor_figures import MOST
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response
from vibroimpact.units.display import digits, fixed, text


def sphere_energy_caption(result: Result) -> str:
    """Return the caption of the figure of the sphere's energy."""
    history, put_in = result.history, result.energy["input_J"]
    words = f"The fall gives the centre {text(float(history['kinetic_J'].max()), 'J')} of kinetic energy."
    if "sphere" not in result.peaks:
        return f"{words} The sphere has no modes in this run."
    strain, left = float(history["sphere_strain_J"].max()), _after_first(result, "sphere_strain_J", "sphere_vibration_J")
    words += (
        f" Its modes hold up to {_part(strain, put_in)} as strain; {_part(left, put_in)} are left in its vibration at the first release."
    )
    turning = float(history["sphere_rotational_J"].max())
    return f"{words} The energy of its rotation stays below {digits(max(turning, 1e-15 * put_in), 1)}\u00a0J."


def plate_motion_caption(result: Result) -> str:
    """Return the caption of the figure of the plate's motion."""
    peaks = result.peaks["plate"]
    names = (("max_displacement_m", "m"), ("max_velocity_m_s", "m/s"), ("max_acceleration_m_s2", "m/s2"))
    most = [text(float(np.max(peaks[name])), unit) for name, unit in names]
    there = text(float(np.abs(result.history["plate_deflection_m"]).max()), "m")
    words = f"The centre of mass moves by up to {most[0]}, at up to {most[1]} and {most[2]}; the contact point by up to {there}."
    lowest = result.frequencies("plate")[0]
    if lowest * float(result.impacts["duration_s"][0]) > 0.25:
        return words
    return f"{words} The lowest mode, of {digits(lowest)}\u00a0Hz, is slow: the sphere has left before the plate turns back."


def plate_energy_caption(result: Result) -> str:
    """Return the caption of the figure of the plate's energy."""
    peaks, put_in = result.peaks["plate"], result.energy["input_J"]
    kinetic, strain = (_part(float(np.max(peaks[name])), put_in) for name in ("max_kinetic_energy_J", "max_strain_energy_J"))
    change = text(float(np.abs(result.history["plate_potential_J"]).max()), "J")
    words = f"At most {kinetic} of what was put in is kinetic energy of the plate, and {strain} strain energy."
    return f"{words} Its potential energy changes by up to {change}, which the strain of its own weight makes up for."


def deflection_caption(result: Result) -> str:
    """Return the caption of the pictures of the plate's deflection."""
    assert result.deflection is not None  # there is a picture of it
    largest = float(np.nanmax(np.abs(result.deflection.height)))
    words = "All pictures are in one scale; the numbers in the corners are the least and the largest displacement upwards, in its unit."
    watched = " Triangles: sensors." if result.signals else ""
    return f"Displacement of the upper side, up to {text(largest, 'm')} in all frames. {words}{watched}"


def animation_caption(result: Result) -> str:
    """Return the caption of the animation."""
    assert result.deflection is not None  # there is an animation of it
    factor = exaggeration(result.deflection)
    return (
        f"The first visit in slow motion, from above and aside. The plate's deflection is drawn {factor:g} times too large; the ball "
        "and its gap to the plate are to scale. Frames follow each other the closer the faster things happen: each tells its time."
    )


_FILTERS = {
    "sigma-delta": "behind the filter of a sigma-delta converter, whose delay is taken out",
    "butterworth": "behind a Butterworth filter of order eight, with its delay",
    "none": "without an anti-alias filter: what is faster than half of that is folded back",
}


def sensor_caption(result: Result, name: str) -> str:
    """Return the caption of the figure of a sensor."""
    signal = result.signals[name]
    sensor, part = signal.sensor, first_response(result, name)
    words = (
        f"Largest magnitude {text(signal.largest, sensor.unit)}, of {len(signal.value)} samples at {digits(sensor.rate)}"
        f"\u00a0Hz, {_FILTERS[sensor.filter]}."
    )
    if signal.overload_time > 0.0:
        words += " Its accelerometer is overdriven: what is beyond its range is cut off before the filter, which may overshoot the cut."
    values = signal.value[part]
    if len(values) < 4 or not np.any(values):
        return words
    found = amplitude_spectrum(values, sensor.rate)
    top = 1 + int(found.amplitude[1:].argmax())
    return (
        f"{words} The spectrum is one-sided, of {text(found.span, 's', 3)} from the first touch on, faded out by the falling half of "
        f"Hann's window; a steady tone would read its amplitude. Its highest point lies at "
        f"{digits(float(found.frequency[top]), 3)}\u00a0Hz; ticks mark the plate's modes."
    )


def sensors_left_out(result: Result) -> str:
    """Return a sentence about sensors that are not drawn; empty if all are."""
    more = len(result.signals) - MOST
    return f"Of the {len(result.signals)} sensors the first {MOST} are drawn; the signals of all are in result.nc." if more > 0 else ""


def _after_first(result: Result, *names: str) -> float:
    """Return the sum of columns at the first release."""
    release = float(result.impacts["time_s"][0] + result.impacts["duration_s"][0])
    last = np.searchsorted(result.history["time_s"], release, side="right") - 1
    return float(sum(result.history[name][last] for name in names))


def _part(value: float, whole: float) -> str:
    return f"{text(value, 'J')} ({fixed(100.0 * value / whole, 2)}\u00a0%)"
