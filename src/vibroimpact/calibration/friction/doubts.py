"""Warnings about calibrated friction: what the impacts do not determine, and a law that does not follow them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.friction.parameters import FrictionParameters
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.section import FRICTION
from vibroimpact.units.display import digits, text

_WIDE = 1.0
"""Width of an interval, over its value or half its range, above which a value counts as undetermined."""

_WOULD_TELL = {
    "coefficient": "; impacts at larger angles from the normal, which slip throughout, would determine it",
    "slip_restitution": "; impacts at smaller angles from the normal, which do not slip throughout, would determine it",
    "effective_shear_modulus": "; impacts at smaller angles from the normal, which do not slip throughout, would determine it",
}


def friction_doubts(
    parameters: FrictionParameters,
    values: Floats,
    intervals: Floats | None,
    seen: Observations,
    confidence: float,
    freedom: float,
    scatter: float,
    *,
    known: bool,
) -> Iterator[str]:
    """Yield warnings about parameters that the measurement does not determine, and about a law that does not follow it."""
    if intervals is None:
        yield "there are no more measured values than parameters, and no standard deviations: their uncertainty is unknown"
        return
    at = f"at {100.0 * confidence:g} %"
    for name, unit, value, interval, ends in zip(parameters.names, parameters.units, values, intervals, parameters.allowed, strict=True):
        low, high, shown = *(text(float(end), unit) for end in interval), text(float(value), unit)
        below, above = interval == ends
        full, more = f"{FRICTION}{name}", _WOULD_TELL.get(name, "")
        wide = interval[1] - interval[0] > _WIDE * (0.5 * np.ptp(ends) if np.isfinite(ends).all() else abs(value))
        if below and above:
            yield f"these impacts do not determine {full}, which stays {shown}: {at} any value agrees with them{more}"
        elif above:
            stick = " (they stick with more friction)" if name == "coefficient" else ""
            yield f"these impacts give only a lower bound of {full}, {low} {at}{stick}{more}"
        elif below and wide:
            yield f"these impacts give only an upper bound of {full}, {high} {at}{more}"
        elif wide:
            yield f"these impacts do not determine {full}: {shown}, but {low} to {high} {at}"
    if seen.deviations_known and freedom > 0 and not known:
        yield (
            f"residuals are {digits(scatter, 3)} times as large as their standard deviations: {parameters.law.name} does not fit the "
            "measurement, or its noise is larger; the intervals are widened by that factor"
        )
