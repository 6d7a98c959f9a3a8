"""Rebounds as text, for the terminal and the page."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.speed_laws import CONSTANT, LINEAR, POWER, Fitted, SpeedLaw
from vibroimpact.calibration.report import Cells
from vibroimpact.units.display import MISSING, digits, known_text, known_texts, multiple, text

_MOST = 20
"""Touches that are no bounces, told one by one."""


def impact_cells(found: Rebounds) -> Cells:
    """Return headers with units, and a row per impact."""
    per_cent = f"{100.0 * found.confidence:g} %"
    headers = [
        ("Impact", ""),
        ("Time", "s"),
        ("Approach speed", "m/s"),
        ("Separation speed", "m/s"),
        ("Restitution", ""),
        (f"Interval, {per_cent}", ""),
    ]
    ends = [known_texts(end, found.deviation) for end in found.intervals.T]
    columns = [
        [str(number + 1) for number in range(len(found.restitution))],
        known_texts(found.bounces.time, found.bounces.deviation),
        known_texts(found.approach_speed, found.approach_deviation),
        known_texts(found.separation_speed, found.separation_deviation),
        known_texts(found.restitution, found.deviation),
        [low if low == MISSING else f"{low} to {high}" for low, high in zip(*ends, strict=True)],
    ]
    return headers, [list(row) for row in zip(*columns, strict=True)]


def law_sentences(found: Fitted) -> list[str]:
    """Return the fits over the approach speed, a sentence each."""
    return [_sentence(law, found.confidence) for law in found.laws]


def drop_sentence(found: Rebounds) -> str:
    """Return from how high the ball fell before the first touch."""
    if found.height is not None:
        return (
            f"The ball fell by {_length(found.height, found.drop_deviation)} before the first "
            "touch, as given."
        )
    about = _length(found.drop_height, found.drop_deviation)
    return (
        f"The ball fell by about {about} before the first touch, if it bounced there with "
        "the mean restitution; the height of the fall, if "
        "given, yields the restitution of that impact."
    )


def contact_sentence(found: Rebounds) -> str:
    """Return what a contact changes, whose duration is part of the time between touches."""
    contact, flight = found.bounces.contact, found.bounces.flight
    if contact:
        return f"Flights are the times between touches less {text(contact, 's')} of contact."
    by_contact = (1.0 - found.bounces.restitution) / flight[:-1]
    if found.height is not None:  # the speed after the fall is known without a contact
        by_contact = np.append(by_contact, 0.5 * found.gravity / found.approach_speed[0])
    shift = 1e-4 * float(np.max(by_contact))
    return (
        "Contacts are taken as instantaneous: each 0.1 ms of contact time makes a restitution "
        f"too large, by {digits(shift, 2)} at most."
    )


def other_sentences(found: Rebounds) -> list[str]:
    """Return what else is heard."""
    pairs = list(zip(found.bounces.others, found.bounces.reasons, strict=True))
    told = [
        f"Not a bounce, at {text(float(time), 's')}: {reason}." for time, reason in pairs[:_MOST]
    ]
    more = len(pairs) - _MOST
    rest = (
        "1 other sound is no bounce either; summary.json lists it."
        if more == 1
        else f"{more} other sounds are no bounces either"
    )
    return (
        told if more <= 0 else [*told, rest if more == 1 else f"{rest}; summary.json lists them."]
    )


def _sentence(law: SpeedLaw, confidence: float) -> str:
    ends = law.intervals(confidence)
    first, *second = [
        _known(value, low, high) for value, (low, high) in zip(law.coefficients, ends, strict=True)
    ]
    said = {
        CONSTANT: f"Constant: e = {first}",
        LINEAR: f"Linear: e = a + b v with a = {first} and b = {''.join(second)} s/m",
        POWER: f"Power: e = a v^b with a = {first}, v in m/s, and b = {''.join(second)}",
    }[law.name]
    if not law.scatter:
        return f"{said}."
    scatter = f"{digits(100.0 * law.scatter, 2)} %" if law.name == POWER else digits(law.scatter, 2)
    return f"{said}; the restitutions scatter by {scatter} about it."


def _length(value: float, spread: float) -> str:
    best = multiple("m", value)
    return f"{known_text(value / best.size, spread / best.size, 3)}\u00a0{best.unit}"


def _known(value: float, low: float, high: float) -> str:
    """Return a value with its interval, in as many digits as that leaves."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return f"{digits(value, 4)} (interval unknown)"
    shown, first, last = (known_text(end, 0.5 * (high - low)) for end in (value, low, high))
    return f"{shown} ({first} to {last})"
