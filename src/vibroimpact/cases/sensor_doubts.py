"""Doubts about the signals of sensors, each with a number and a remedy.

There are overload, truncated modes and proximity to the contact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from vibroimpact.cases.limits.limit import in_kilohertz, two_digits
from vibroimpact.dynamics.sensors.instruments.electronics import Converter
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.report.result_warning import ResultWarning
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.units.display import text

# relative to the rms value: error of a signal by truncated modes above which it is doubted
_DOUBTED_ERROR = 0.01
_NEAR = 2.0  # thicknesses of the plate: distance from the contact within which a sensor is near it
_CUTOFF = 1.5  # over the contact duration: approximate cut-off frequency of the force spectrum
# share of the power of a microphone at frequencies that need a baffle, above which it is doubted
_DOUBTED_SHARE = 0.05
_RANGE_MARGIN = 1.2  # recommended range over the peak magnitude


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
    tables = {table["name"]: table for table in case.get("sensors", ())}
    sentences: list[str] = []
    for name, signal in signals.items():
        accelerometer = tables.get(name, {}).get("accelerometer", {})
        sentences += _range_doubts(signal, accelerometer.get("range"))
    for name, signal in signals.items():
        if "converter" in tables.get(name, {}):
            sentences += _converter_doubts(signal, tables[name]["converter"])
    for name, signal in signals.items():
        if "microphone" in tables.get(name, {}):
            speed_of_sound = tables[name]["microphone"]["speed_of_sound"]
            sentences += _baffle_doubts(case, signal, speed_of_sound)
    # sensors with the same cause and remedy share a sentence: relative errors by their names
    errors: dict[tuple[str, str], dict[str, float]] = {}
    for name, signal in signals.items():
        table = tables.get(name, {})
        position = None if "microphone" in table else table.get("position")
        distance = _distance_in_thicknesses(case, position, first_contact)
        error = signal.uncertainty
        if distance < _NEAR:
            cause = (
                f"{distance:.2g} thicknesses from the contact, the motion through the thickness "
                "and the modes left out"
            )
            remedy = f"keep a distance of {_NEAR:g} thicknesses or more"
            if error > _DOUBTED_ERROR:
                remedy = _remedy(case, signal, highest)
            error = _finite_or_zero(error) + _thickness_error(case, signal, duration)
        elif error > _DOUBTED_ERROR:
            cause = (
                f"the modes of the plate left out (above {text(highest, 'Hz')}, at "
                f"{signal.sensor.rate:g} samples per second)"
            )
            remedy = _remedy(case, signal, highest)
        else:
            continue
        errors.setdefault((cause, remedy), {})[name] = error
    return sentences + [
        _error_sentence(cause, remedy, by_name) for (cause, remedy), by_name in errors.items()
    ]


def _error_sentence(cause: str, remedy: str, errors: Mapping[str, float]) -> ResultWarning:
    """Return the sentence for sensors with the same cause and remedy.

    `errors` are relative errors by the names of the sensors.
    """
    different = list(dict.fromkeys(map(_per_cent, errors.values())))
    names = ", ".join(f'"{name}"' for name in errors)
    sensors = "sensors" if len(errors) > 1 else "sensor"
    signals = "their signals" if len(errors) > 1 else "its signal"
    return ResultWarning(
        f"{sensors} {names}: {cause} may change {signals} by about {' and '.join(different)} of "
        f"the rms value; {remedy}",
        max(errors.values()),
    )


def _range_doubts(signal: Signal, largest: float | None) -> list[str]:
    """Return the doubt about an accelerometer that is driven beyond its range, if it is.

    The range is known by its end, `largest` [m/s^2].
    """
    if not signal.overload_time:
        return []
    limit = "its range" if largest is None else f"its range of {largest:g} m/s2"
    recommended = float(f"{_RANGE_MARGIN * signal.peak:.1g}")
    if not recommended >= signal.peak:  # as it may be once rounded to a digit
        recommended = 2.0 * recommended
    return [
        ResultWarning(
            f'the accelerometer of sensor "{signal.sensor.name}" is overloaded beyond {limit} '
            f"for {text(signal.overload_time, 's', 2)} in all, with up to "
            f"{signal.peak:.4g} m/s2: the signal is clipped there, and wrong around it; take "
            f"one with a range of {recommended:g} m/s2 or so",
            math.nan if largest is None else signal.peak / largest - 1.0,
        )
    ]


def _converter_doubts(signal: Signal, table: Mapping[str, Any]) -> list[str]:
    """Return the doubt about a converter that clips its samples, or loses all below its step."""
    converter = Converter(**table)
    name = signal.sensor.name
    unit = signal.sensor.unit
    is_clipped = (signal.value >= converter.range - converter.step) | (
        signal.value <= -converter.range
    )
    clipped = int(np.count_nonzero(is_clipped))
    if clipped:
        return [
            ResultWarning(
                f'the converter of sensor "{name}" clips {clipped} of {len(signal.value)} samples '
                f"at its range of {text(converter.range, unit)}; give it "
                "a wider one, or the amplifier less gain",
                clipped / len(signal.value),
            )
        ]
    if converter.step and not signal.value.any():
        return [
            ResultWarning(
                f'the converter of sensor "{name}" reads zero all along: each sample is below '
                f"half its step, {text(converter.step, unit)}; give it "
                "more bits, or the amplifier gain",
                1.0,
            )
        ]
    return []


def _baffle_doubts(case: ResolvedCase, signal: Signal, speed_of_sound: float) -> list[str]:
    """Return the doubt about sound so low that it would go round the edges of a plate, if any.

    The plate is in no baffle there.
    """
    size = case.get("plate", {}).get("size")
    power = np.abs(np.fft.rfft(signal.value)) ** 2
    if size is None or not power.any():
        return []
    # half the wavelength is the shorter side of the plate
    lowest = speed_of_sound / (2.0 * min(size[:2]))
    frequencies = np.fft.rfftfreq(len(signal.value), 1.0 / signal.sensor.rate)
    share = float(power[frequencies < lowest].sum() / power.sum())
    if share < _DOUBTED_SHARE:
        return []
    return [
        ResultWarning(
            f"{two_digits(100.0 * share)} % of the power of the signal of microphone "
            f'"{signal.sensor.name}" lies below {text(lowest, "Hz")}, '
            "where half a wavelength is longer than the plate "
            "is wide: the plate is assumed to lie in a rigid baffle, and without one its two "
            "sides cancel there; use the signal above that frequency only",
            share,
        )
    ]


def _remedy(case: ResolvedCase, signal: Signal, highest: float) -> str:
    """Return what reduces the error by truncated modes, the highest of a frequency [Hz]."""
    if signal.sensor.filter == "none":
        return 'take filter = "sigma-delta", or more modes'
    frequency = max(signal.sensor.rate, 2.0 * highest if signal.sensor.rate <= highest else 0.0)
    change = "replace plate.modes by" if "modes" in case.get("plate", {}) else "give"
    return f'{change} plate.max_frequency = "{in_kilohertz(frequency)}" or so, or a lower rate'


def _distance_in_thicknesses(
    case: ResolvedCase, position: Any, contact: tuple[float, float] | None
) -> float:
    """Return the in-plane distance of a sensor from the contact over the plate thickness.

    It is infinite if not known, or without plate elements: a rigid plate does not deform, and solid
    elements have the motion through the thickness.
    """
    plate = case.get("plate", {})
    size = plate.get("size")
    has_plate_elements = plate.get("model") != "rigid" and plate.get("element") != "solid"
    if not has_plate_elements or size is None or "file" in plate.get("mesh", {}):
        return math.inf
    if position is None or isinstance(position, str):
        return math.inf
    origin = case["drop"]["position"] if contact is None else contact
    return math.dist(position, origin) / float(size[2])


def _thickness_error(case: ResolvedCase, signal: Signal, duration: float) -> float:
    """Return the estimated relative error by motion through the thickness.

    It is the square of the signal bandwidth over the first thickness-shear resonance, which is half
    the shear wave speed over the thickness.
    """
    material = case["plate"]["material"]
    thickness = case["plate"]["size"][2]
    shear_wave_speed = math.sqrt(
        material["youngs_modulus"]
        / (2.0 * (1.0 + material["poissons_ratio"]) * material["density"])
    )
    force_bandwidth = _CUTOFF / duration if duration > 0.0 else math.inf
    bandwidth = min(0.5 * signal.sensor.rate, force_bandwidth)
    return float((bandwidth * 2.0 * thickness / shear_wave_speed) ** 2)


def _finite_or_zero(error: float) -> float:
    return error if math.isfinite(error) else 0.0


def _per_cent(error: float) -> str:
    return f"{two_digits(100.0 * error)} %" if error < 0.995 else "100 % or more"
