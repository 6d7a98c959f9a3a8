"""Warnings about calibrated friction.

They are about what the impacts do not determine, and laws that do not follow them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.friction.measured import ObliqueImpacts
from vibroimpact.calibration.friction.parameters import FrictionParameters
from vibroimpact.calibration.observed.observations import Observations, impact_label
from vibroimpact.calibration.observed.section import FRICTION
from vibroimpact.units.display import digits, text

_WIDE = 1.0
"""Width of an interval, over its value or half its range, above which a value counts as
undetermined.
"""

_DETERMINING_IMPACTS = {
    "coefficient": "; impacts at larger angles from the normal, which slip throughout, would "
    "determine it",
    "slip_restitution": "; impacts at smaller angles from the normal, which do not slip "
    "throughout, would determine it",
    "effective_shear_modulus": "; impacts at smaller angles from the normal, which do not slip "
    "throughout, would determine it",
}
"""Impacts that would determine a parameter which others do not."""

_MISSED = 1e-3
"""Relative deviation of a separation speed above which the contact law counts as not
reaching it.
"""


def rebound_doubts(impacts: ObliqueImpacts, separation_speed: Floats, law: str) -> Iterator[str]:
    """Yield a warning about measured normal rebounds that the contact law does not reach.

    It does not reach them with any value of its parameter.

    Parameters
    ----------
    impacts : ObliqueImpacts
        The measured impacts.
    separation_speed : array, shape (n,)
        Separation speeds along the normal that the contact law achieves [m/s].
    law : str
        Name of the contact law.
    """
    if impacts.separation_speed is None:
        return
    deviation = np.abs(separation_speed - impacts.separation_speed)
    missed = deviation > _MISSED * impacts.seen.speeds
    if not missed.any():
        return
    worst = int(np.argmax(np.where(missed, deviation / impacts.seen.speeds, -1.0)))
    label = impact_label(impacts.seen, worst)
    yield (
        f"{law} does not reach the normal rebound of {int(missed.sum())} of {len(deviation)} "
        f"impacts, least that of {label}: its "
        f"separation speed is {text(float(separation_speed[worst]), 'm/s')} instead of "
        f"{text(float(impacts.separation_speed[worst]), 'm/s')}; take another contact "
        "law, as friction is fitted with this impulse"
    )


def friction_doubts(
    parameters: FrictionParameters,
    values: Floats,
    intervals: Floats | None,
    seen: Observations,
    confidence: float,
    freedom: float,
    scatter: float,
    slips: Bools,
    *,
    known: bool,
) -> Iterator[str]:
    """Yield warnings about what the measurement does not determine, and a law that does not follow.

    `slips`: which impacts slip throughout, (n,).
    """
    if intervals is None:
        yield (
            "there are no more measured values than parameters, and no standard deviations: "
            "their uncertainty is unknown"
        )
        return
    at_confidence = f"at {100.0 * confidence:g} %"
    for row, name in enumerate(parameters.names):
        doubt = _parameter_doubt(
            name,
            parameters.units[row],
            float(values[row]),
            intervals[row],
            parameters.allowed[row],
            slips,
            at_confidence,
        )
        if doubt:
            yield doubt
    if seen.deviations_known and freedom > 0 and not known:
        yield (
            f"residuals are {digits(scatter, 3)} times as large as their standard "
            f"deviations: {parameters.law.name} does not fit the "
            "measurement, or its noise is larger; the intervals are widened accordingly"
        )


def _parameter_doubt(
    name: str,
    unit: str,
    value: float,
    interval: Floats,
    allowed: Floats,
    slips: Bools,
    at_confidence: str,
) -> str:
    """Return a warning about a parameter that the measurement does not determine, or an empty text.

    Impacts that stick throughout say nothing of the coefficient, and those that slip throughout
    nothing of the other parameters. Only where all are such, others would determine it.
    """
    open_below, open_above = interval == allowed
    low, high = (text(float(end), unit) for end in interval)
    full_name = f"{FRICTION}{name}"
    is_coefficient = name == "coefficient"
    # impacts that stick tell nothing of the coefficient, and those that slip of nothing else
    silent = ~slips if is_coefficient else slips
    all_silent = bool(silent.all())
    hint = ""
    if all_silent:
        hint = _DETERMINING_IMPACTS.get(name, "")
    scale = abs(value)
    if np.isfinite(allowed).all():
        scale = 0.5 * np.ptp(allowed)
    wide = interval[1] - interval[0] > _WIDE * scale
    if open_below and open_above:
        return (
            f"these impacts do not determine {full_name}, which is left at its first value, "
            f"{text(value, unit)}: {at_confidence} they exclude none{hint}"
        )
    if open_above:
        stick = ""
        if is_coefficient and all_silent:
            stick = " (they stick with more friction)"
        return (
            f"these impacts give only a lower bound of {full_name}, {low} {at_confidence}"
            f"{stick}{hint}"
        )
    if open_below and wide:
        if is_coefficient:
            hint = ""
        return (
            f"these impacts give only an upper bound of {full_name}, {high} {at_confidence}{hint}"
        )
    if wide:
        return (
            f"these impacts do not determine {full_name}: {text(value, unit)}, but {low} to {high} "
            f"{at_confidence}"
        )
    return ""
