"""What to doubt of a drop: where its assumptions are strained, said by numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from vibroimpact.contact.elastic_plastic import ElasticPlasticLaw
from vibroimpact.contact.law import InstantaneousLaw, find_contact_law
from vibroimpact.contact.pair import effective_modulus
from vibroimpact.dynamics.recording import Signal
from vibroimpact.materials import RIGID, Material

_SMALL_CONTACT = 0.3  # of the radius: beyond it Hertz's pressure and the finite sphere differ by several per cent
_TRUNCATED = 0.05  # of the largest force
_CYCLES, _ENOUGH = 1.5, 3.0  # periods of the highest mode in a contact: too few, and enough
_YIELD = 1.6  # Johnson 1985, section 6.1: yield begins where the peak pressure is 1.6 times the yield strength


def doubts(case: Mapping[str, Any], depth: float, force: float) -> list[str]:
    """Return what to doubt of a case whose largest indentation [m] and force [N] are known or estimated.

    Parameters
    ----------
    case : mapping
        A resolved case; an empty one gives no doubts.
    depth, force : float
        Largest indentation [m] and largest contact force [N]; NaN where there is none.

    Examples
    --------
    >>> doubts({}, 1e-3, 1e4)
    []
    """
    if not case or not (depth > 0.0 and force > 0.0):
        return []
    found = []
    radius, contact = case["sphere"]["radius"], case["contact"]
    part = math.sqrt(depth / radius)
    if part > _SMALL_CONTACT:
        found.append(f"the contact radius reaches about {part:.2g} of the sphere's; Hertz's theory holds for small contacts")
    fade = contact.get("full_damping_penetration", 0.0)
    if not isinstance(fade, list) and depth < fade:
        found.append(
            f"the indentation, {depth:.2g} m, stays below the full-damping penetration, {fade:.2g} m: the damping never acts in full"
        )
    materials = [_material(case[body]["material"]) for body in ("sphere", "plate")]
    strengths = [material.yield_strength for material in materials if material.yield_strength]
    if strengths and not issubclass(find_contact_law(contact["law"]), (ElasticPlasticLaw, InstantaneousLaw)):
        pressure = (6.0 * force * effective_modulus(*materials) ** 2 / (math.pi**3 * radius**2)) ** (1.0 / 3.0)
        if pressure > _YIELD * min(strengths):
            found.append(
                f"Hertz's peak pressure would be {pressure / 1e6:.3g} MPa, above {_YIELD} times the yield strength of "
                f"{min(strengths) / 1e6:.3g} MPa: the contact would yield, and {contact['law']} does not"
            )
    return found


def sensor_doubts(signals: Iterable[Signal], frequencies: Sequence[float]) -> list[str]:
    """Return what to doubt of signals: which of them hold fewer modes than the plate has.

    Parameters
    ----------
    signals : iterable of Signal
        What sensors on the plate recorded.
    frequencies : sequence of float
        Of the modes of the plate [Hz], ascending.
    """
    return [
        f'sensor "{signal.sensor.name}" takes {signal.sensor.rate:g} samples per second, and the highest mode kept, of '
        f"{frequencies[-1]:.5g} Hz, needs more than {2.0 * frequencies[-1]:.5g}: {signal.left_out} of the {len(frequencies)} modes are "
        "left out of its signal"
        for signal in signals
        if signal.left_out
    ]


def truncation_doubts(truncation: Mapping[str, float], frequencies: Mapping[str, Sequence[float]], duration: float) -> list[str]:
    """Return which bodies have too few modes for a contact.

    Parameters
    ----------
    truncation : mapping of str to float
        About how far the largest force is off, as a part of it, by the name of the body.
    frequencies : mapping of str to sequence of float
        Of the modes of each [Hz], ascending.
    duration : float
        Of the contact [s]; NaN where there is none.
    """
    found = []
    for body, part in truncation.items():
        highest = frequencies[body][-1]
        if part > _TRUNCATED or highest * duration < _CYCLES:
            found.append(
                f"the modes of the {body} end at {highest:.4g} Hz, and the contact lasts {duration:.3g} s: those left out may change the "
                f"largest force by up to {100.0 * part:.2g} %, and rebound and vibration by more; ask for "
                f'max_frequency = "{_ENOUGH / duration / 1e3:.3g} kHz" or so'
            )
    return found


def range_doubts(sensors: Sequence[Mapping[str, Any]], signals: Mapping[str, Signal]) -> list[str]:
    """Return which accelerometers were driven to the end of their range; `sensors` are those of a resolved case."""
    found = []
    for sensor in sensors:
        end, name = sensor.get("accelerometer", {}).get("range"), sensor["name"]
        clipped = int((abs(signals[name].value) >= end).sum()) if end is not None and name in signals else 0
        if clipped:
            found.append(f'the accelerometer of sensor "{name}" is driven to the end of its range, {end:g} m/s2, in {clipped} samples')
    return found


def _material(given: Mapping[str, Any] | str) -> Material:
    return RIGID if isinstance(given, str) else Material(**given)
