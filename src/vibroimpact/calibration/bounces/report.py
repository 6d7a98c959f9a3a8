"""What bounces in a record tell: restitutions with intervals, fits over the speed, and charts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.charts import bounce_charts
from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.speed_laws import CONSTANT, LINEAR, POWER, Fitted, SpeedLaw
from vibroimpact.calibration.fit.fitting import half_width
from vibroimpact.calibration.observed.inputs import inputs_document, inputs_sentence
from vibroimpact.report.report import (
    Column,
    Note,
    Paragraph,
    Quantity,
    Report,
    Section,
    Table,
    finite_interval,
)
from vibroimpact.results.csv_files import write_rows
from vibroimpact.units.display import MISSING, digits, known_text, known_texts, multiple, text

_MOST_SOUNDS = 20
"""Sounds that are no bounces, named one by one."""


def report_of(rebounds: Rebounds) -> Report:
    """Return the report of the bounces in a record."""
    record = rebounds.bounces.record
    notes = [
        drop_sentence(rebounds),
        contact_sentence(rebounds),
        inputs_sentence(rebounds.inputs),
        *other_sentences(rebounds),
    ]
    impacts = Section(
        "impacts",
        "Impact by impact",
        (impact_table(rebounds), *(Note(sentence) for sentence in notes)),
    )
    fits = Section(
        "fits",
        "Fits over the approach speed",
        [Paragraph(sentence) for sentence in law_sentences(rebounds)],
    )
    return Report(
        title=f"Bounces in {record.name}",
        answer=f"{len(rebounds.bounces.time)} touches of a bouncing ball.",
        quantities=[*answer_of_fits(rebounds), _drop_height(rebounds)],
        sections=(fits, impacts),
        charts=bounce_charts(rebounds),
        warnings=rebounds.doubts,
        files={"bounces.csv": partial(_write_bounces, rebounds)},
        summary=_summary(rebounds),
        provenance=record.source,
    )


def _interval_cell(low: str, high: str) -> str:
    return MISSING if low == MISSING else f"{low} to {high}"


def impact_table(rebounds: Rebounds) -> Table:
    """Return the table of the impacts: times, speeds, and restitutions with their intervals."""
    lows, highs = (known_texts(end, rebounds.deviation) for end in rebounds.intervals.T)
    intervals = [_interval_cell(low, high) for low, high in zip(lows, highs, strict=True)]
    numbers = [str(number + 1) for number in range(len(rebounds.restitution))]
    times = known_texts(rebounds.bounces.time, rebounds.bounces.deviation)
    approach = known_texts(rebounds.approach_speed, rebounds.approach_deviation)
    separation = known_texts(rebounds.separation_speed, rebounds.separation_deviation)
    restitutions = known_texts(rebounds.restitution, rebounds.deviation)
    return Table(
        (
            Column("Impact", numbers, is_text=True),
            Column("Time", times, "s"),
            Column("Approach speed", approach, "m/s"),
            Column("Separation speed", separation, "m/s"),
            Column("Restitution", restitutions),
            Column(f"Interval, {100.0 * rebounds.confidence:g} %", intervals),
        )
    )


def law_sentences(rebounds: Fitted) -> list[str]:
    """Return the fits over the approach speed, a sentence each."""
    return [_sentence(law, rebounds.confidence) for law in rebounds.laws]


def answer_of_fits(fitted: Fitted) -> Iterator[Quantity]:
    """Yield the mean restitution, and how it changes with the approach speed, if that is fitted."""
    for law in fitted.laws:
        intervals = law.intervals(0.95)
        if law.name == CONSTANT:
            interval = finite_interval(*intervals[0])
            yield Quantity("Restitution", float(law.coefficients[0]), interval=interval)
        elif law.name == LINEAR:
            interval = finite_interval(*intervals[1])
            slope = float(law.coefficients[1])
            yield Quantity(
                "Restitution over approach speed",
                slope,
                "s/m",
                note="slope of the linear fit",
                interval=interval,
            )


def _drop_height(rebounds: Rebounds) -> Quantity:
    """Return the height of the fall before the first touch."""
    height = rebounds.drop_height
    if rebounds.height is not None:
        return Quantity("Height of the fall", height, "m", note="given")
    half = half_width(0.95, math.inf) * rebounds.drop_deviation
    interval = finite_interval(height - half, height + half)
    return Quantity("Height of the fall", height, "m", interval=interval)


def drop_sentence(rebounds: Rebounds) -> str:
    """Return from how high the ball fell before the first touch."""
    if rebounds.height is not None:
        return (
            f"The ball fell by {_length(rebounds.height, rebounds.drop_deviation)} "
            "before the first "
            "touch, as given."
        )
    about = _length(rebounds.drop_height, rebounds.drop_deviation)
    return (
        f"The ball fell by about {about} before the first touch, if it bounced there with "
        "the mean restitution; the height of the fall, if "
        "given, yields the restitution of that impact."
    )


def contact_sentence(rebounds: Rebounds) -> str:
    """Return what a contact changes, whose duration is part of the time between touches."""
    contact = rebounds.bounces.contact
    flight = rebounds.bounces.flight
    if contact:
        return f"Flights are the times between touches less {text(contact, 's')} of contact."
    by_contact = (1.0 - rebounds.bounces.restitution) / flight[:-1]
    if rebounds.height is not None:  # the speed after the fall is known without a contact
        by_contact = np.append(by_contact, 0.5 * rebounds.gravity / rebounds.approach_speed[0])
    shift = 1e-4 * float(np.max(by_contact))
    return (
        "Contacts are taken as instantaneous: each 0.1 ms of contact time makes a restitution "
        f"too large, by {digits(shift, 2)} at most."
    )


def other_sentences(rebounds: Rebounds) -> list[str]:
    """Return what else is heard."""
    pairs = list(zip(rebounds.bounces.others, rebounds.bounces.reasons, strict=True))
    sentences = [
        f"Not a bounce, at {text(float(time), 's')}: {reason}."
        for time, reason in pairs[:_MOST_SOUNDS]
    ]
    more = len(pairs) - _MOST_SOUNDS
    if more == 1:
        sentences.append("1 other sound is no bounce either; summary.json lists it.")
    elif more > 1:
        sentences.append(f"{more} other sounds are no bounces either; summary.json lists them.")
    return sentences


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
    scatter = digits(law.scatter, 2)
    if law.name == POWER:  # fitted in logarithms, its scatter is relative
        scatter = f"{digits(100.0 * law.scatter, 2)} %"
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


def bounce_rows(rebounds: Rebounds) -> list[dict[str, Any]]:
    """Return the impacts, one mapping each; None where there is no value."""
    bounces = rebounds.bounces
    columns = {
        "time_s": bounces.time,
        "time_standard_deviation_s": bounces.deviation,
        "peak": bounces.peak,
        "approach_speed_m_s": rebounds.approach_speed,
        "separation_speed_m_s": rebounds.separation_speed,
        "restitution": rebounds.restitution,
        "restitution_standard_deviation": rebounds.deviation,
        "restitution_low": rebounds.intervals[:, 0],
        "restitution_high": rebounds.intervals[:, 1],
    }
    return [
        {
            "impact": number + 1,
            **{name: _finite(values[number]) for name, values in columns.items()},
        }
        for number in range(len(bounces.time))
    ]


def _write_bounces(rebounds: Rebounds, path: Path) -> None:
    """Write the impacts as a table."""
    rows = bounce_rows(rebounds)
    write_rows(rows, path)


def _summary(rebounds: Rebounds) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    record = rebounds.bounces.record
    return {
        "name": record.name,
        "version": __version__,
        "bounces": {
            "file": record.source,
            "channel": record.name,
            "unit": record.unit,
            "rate_Hz": record.rate,
            "duration_s": record.duration,
            "gravity_m_s2": rebounds.gravity,
            "contact_duration_s": rebounds.bounces.contact,
            "confidence": rebounds.confidence,
            "drop_height_m": rebounds.drop_height,
            "drop_height_given": rebounds.height is not None,
            "drop_height_standard_deviation_m": rebounds.drop_deviation,
            "inputs": inputs_document(rebounds.inputs),
            "impacts": bounce_rows(rebounds),
            "fits": fits_document(rebounds.laws, rebounds.confidence),
            "others": [
                {"time_s": float(time), "reason": reason}
                for time, reason in zip(
                    rebounds.bounces.others, rebounds.bounces.reasons, strict=True
                )
            ],
            "doubts": list(rebounds.doubts),
        },
    }


def fits_document(laws: list[SpeedLaw], confidence: float) -> dict[str, Any]:
    """Return the fits of a restitution over the approach speed by name; None where there
    is no finite number.
    """
    return {
        law.name: {
            "coefficients": law.coefficients.tolist(),
            "intervals": [[_finite(end) for end in ends] for ends in law.intervals(confidence)],
            "scatter": law.scatter,
            "degrees_of_freedom": _finite(law.freedom),
        }
        for law in laws
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
