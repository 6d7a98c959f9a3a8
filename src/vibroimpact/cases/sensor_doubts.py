"""Doubts about the signals of sensors: overload, truncated modes and proximity to the
contact, each with a number and a remedy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from vibroimpact.cases.limit import in_kilohertz, two_digits
from vibroimpact.dynamics.sensors.electronics import Converter
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.units.display import text

# relative to the rms value: error of a signal by truncated modes above which it is doubted
_PROMISED = 0.01
_NEAR = 2.0  # thicknesses of the plate: distance from the contact within which a sensor is near it
_CUTS = 1.5  # over the contact duration: approximate cut-off frequency of the force spectrum
# part of the power of a microphone at frequencies that need a baffle, above which it is doubted
_LOW = 0.05
_ENOUGH = 1.2  # recommended range over the peak magnitude


def sensor_doubts(
    case: ResolvedCase,
    signals: Mapping[str, Signal],
    highest: float,
    duration: float,
    first_contact: tuple[float, float] | None = None,
) -> list[str]:
    """Return a sentence for each doubt about the signals of sensors.

    Parameters
    ----------
    case : mapping
        The resolved case; if empty, the positions of the sensors are not known.
    signals : mapping of str to Signal
        Signals of the sensors on the plate.
    highest : float
        Frequency of the highest mode of the plate [Hz].
    duration : float
        Duration of the first contact [s]; NaN if there is none.
    first_contact : tuple of two floats, optional
        Its x and y on the plate [m]; by default `drop.position`.

    Examples
    --------
    >>> sensor_doubts({}, {}, 1e4, 1e-4)
    []
    """
    places = {
        one["name"]: one["position"] for one in case.get("sensors", ()) if "microphone" not in one
    }
    speeds = {
        one["name"]: one["microphone"]["speed_of_sound"]
        for one in case.get("sensors", ())
        if "microphone" in one
    }
    ranges = {
        one["name"]: one.get("accelerometer", {}).get("range") for one in case.get("sensors", ())
    }
    converters = {
        one["name"]: one["converter"] for one in case.get("sensors", ()) if "converter" in one
    }
    found = [
        doubt
        for name, signal in signals.items()
        for doubt in _range_doubts(signal, ranges.get(name))
    ]
    found += [
        doubt
        for name, signal in signals.items()
        if name in converters
        for doubt in _converter_doubts(signal, converters[name])
    ]
    found += [
        doubt
        for name, signal in signals.items()
        if name in speeds
        for doubt in _baffle_doubts(case, signal, speeds[name])
    ]
    # sensors with the same cause and remedy share a sentence: relative errors by their names
    alike: dict[tuple[str, str], dict[str, float]] = {}
    for name, signal in signals.items():
        apart = _distance_in_thicknesses(case, places.get(name), first_contact)
        if apart < _NEAR:
            part = _finite_or_zero(signal.uncertainty) + _thickness_error(case, signal, duration)
            cause = (
                f"{apart:.2g} thicknesses from the contact, the motion through the thickness "
                "and the modes left out"
            )
            remedy = (
                _remedy(case, signal, highest)
                if signal.uncertainty > _PROMISED
                else f"keep a distance of {_NEAR:g} thicknesses or more"
            )
            alike.setdefault((cause, remedy), {})[name] = part
        elif signal.uncertainty > _PROMISED:
            cause = (
                f"the modes of the plate left out (above {text(highest, 'Hz')}, at "
                f"{signal.sensor.rate:g} samples per second)"
            )
            alike.setdefault((cause, _remedy(case, signal, highest)), {})[name] = signal.uncertainty
    return found + [_sentence(cause, remedy, parts) for (cause, remedy), parts in alike.items()]


def _sentence(cause: str, remedy: str, parts: dict[str, float]) -> str:
    """Return the sentence for sensors with the same cause and remedy; `parts` are
    relative errors by the names of the sensors.
    """
    each = list(dict.fromkeys(map(_per_cent, parts.values())))
    names = ", ".join(f'"{name}"' for name in parts)
    sensors, signal = ("sensors", "their signals") if len(parts) > 1 else ("sensor", "its signal")
    return (
        f"{sensors} {names}: {cause} may change {signal} by about {' and '.join(each)} of the "
        f"rms value; {remedy}"
    )


def _range_doubts(signal: Signal, end: float | None) -> list[str]:
    """Return the doubt about an accelerometer that is driven beyond its range; none if it
    is not.
    """
    limit = "its range" if end is None else f"its range of {end:g} m/s2"
    if not signal.overload_time:
        return []
    least, long = float(f"{_ENOUGH * signal.peak:.1g}"), text(signal.overload_time, "s", 2)
    least = least if least >= signal.peak else 2.0 * least
    return [
        f'the accelerometer of sensor "{signal.sensor.name}" is overloaded beyond {limit} '
        f"for {long} in all, with up to "
        f"{signal.peak:.4g} m/s2: the signal is clipped there, and wrong around it; take "
        f"one with a range of {least:g} m/s2 or so"
    ]


def _converter_doubts(signal: Signal, converter: Mapping[str, Any]) -> list[str]:
    """Return the doubts about a converter that clips its samples, or whose step is larger
    than all of them.
    """
    read, unit = Converter(**converter), signal.sensor.unit
    clipped = int(
        np.count_nonzero((signal.value >= read.range - read.step) | (signal.value <= -read.range))
    )
    name, end = signal.sensor.name, text(read.range, unit)
    if clipped:
        part = f"{clipped} of {len(signal.value)} samples"
        return [
            f'the converter of sensor "{name}" clips {part} at its range of {end}; give it '
            "a wider one, or the amplifier less gain"
        ]
    if read.step and not signal.value.any():
        return [
            f'the converter of sensor "{name}" reads zero all along: each sample is below '
            f"half its step, {text(read.step, unit)}; give it "
            "more bits, or the amplifier gain"
        ]
    return []


def _baffle_doubts(case: ResolvedCase, signal: Signal, speed: float) -> list[str]:
    """Return the doubt about sound so low that it would go round the edges of a plate
    that is in no baffle; none if there is little.
    """
    size = case.get("plate", {}).get("size")
    power = np.abs(np.fft.rfft(signal.value)) ** 2
    if size is None or not power.any():
        return []
    lowest = speed / (2.0 * min(size[:2]))
    part = float(
        power[np.fft.rfftfreq(len(signal.value), 1.0 / signal.sensor.rate) < lowest].sum()
        / power.sum()
    )
    if part < _LOW:
        return []
    share, below = f"{two_digits(100.0 * part)} % of the power", text(lowest, "Hz")
    return [
        f'{share} of the signal of microphone "{signal.sensor.name}" lies below {below}, '
        "where half a wavelength is longer than the plate "
        "is wide: the plate is assumed to lie in a rigid baffle, and without one its two "
        "sides cancel there; use the signal above that frequency only"
    ]


def _remedy(case: ResolvedCase, signal: Signal, highest: float) -> str:
    if signal.sensor.filter == "none":
        return 'take filter = "sigma-delta", or more modes'
    wanted = max(signal.sensor.rate, 2.0 * highest if signal.sensor.rate <= highest else 0.0)
    change = "replace plate.modes by" if "modes" in case.get("plate", {}) else "give"
    return f'{change} plate.max_frequency = "{in_kilohertz(wanted)}" or so, or a lower rate'


def _distance_in_thicknesses(
    case: ResolvedCase, place: Any, contact: tuple[float, float] | None
) -> float:
    """Return the in-plane distance of a sensor from the contact over the plate thickness; infinite
    if not known, or without plate elements.

    A rigid plate does not deform, and solid elements have the motion through the thickness.
    """
    plate = case.get("plate", {})
    size, mesh = plate.get("size"), plate.get("mesh", {})
    if (
        plate.get("model") == "rigid"
        or plate.get("element") == "solid"
        or size is None
        or place is None
        or isinstance(place, str)
        or "file" in mesh
    ):
        return math.inf
    return math.dist(place, case["drop"]["position"] if contact is None else contact) / float(
        size[2]
    )


def _thickness_error(case: ResolvedCase, signal: Signal, duration: float) -> float:
    """Return the estimated relative error by thickness motion: square of the signal
    bandwidth over the first thickness-shear resonance.
    """
    material, thickness = case["plate"]["material"], case["plate"]["size"][2]
    shear = math.sqrt(
        material["youngs_modulus"]
        / (2.0 * (1.0 + material["poissons_ratio"]) * material["density"])
    )
    band = min(0.5 * signal.sensor.rate, _CUTS / duration if duration > 0.0 else math.inf)
    return float((band * 2.0 * thickness / shear) ** 2)


def _finite_or_zero(part: float) -> float:
    return part if math.isfinite(part) else 0.0


def _per_cent(part: float) -> str:
    return f"{two_digits(100.0 * part)} %" if part < 0.995 else "100 % or more"
