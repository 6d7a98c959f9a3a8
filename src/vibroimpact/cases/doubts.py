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


def _material(given: Mapping[str, Any] | str) -> Material:
    return RIGID if isinstance(given, str) else Material(**given)
