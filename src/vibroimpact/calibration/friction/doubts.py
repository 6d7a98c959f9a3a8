"""Warnings about calibrated friction: what the impacts do not determine, and laws that do
not follow them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.calibration.friction.measured import ObliqueImpacts
from vibroimpact.calibration.friction.parameters import FrictionParameters
from vibroimpact.calibration.observations import Observations
from vibroimpact.calibration.section import FRICTION
from vibroimpact.units.display import digits, text

_WIDE = 1.0
"""Width of an interval, over its value or half its range, above which a value counts as
undetermined.
"""

_WOULD_TELL = {
    "coefficient": "; impacts at larger angles from the normal, which slip throughout, would "
    "determine it",
    "slip_restitution": "; impacts at smaller angles from the normal, which do not slip "
    "throughout, would determine it",
    "effective_shear_modulus": "; impacts at smaller angles from the normal, which do not slip "
    "throughout, would determine it",
}


_MISSED = 1e-3
"""Relative deviation of a separation speed above which the contact law counts as not
reaching it.
"""


def rebound_doubts(impacts: ObliqueImpacts, separation_speed: Floats, law: str) -> Iterator[str]:
    """Yield a warning about measured normal rebounds that the contact law does not reach with any
    value of its parameter.

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
    off = np.abs(separation_speed - impacts.separation_speed)
    missed = off > _MISSED * impacts.seen.speeds
    if missed.any():
        worst = int(np.argmax(np.where(missed, off / impacts.seen.speeds, -1.0)))
        label = impacts.seen.labels[worst] if impacts.seen.labels else f"impact {worst + 1}"
        yield (
            f"{law} does not reach the normal rebound of {int(missed.sum())} of {len(off)} "
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
    """Yield warnings about parameters that the measurement does not determine, and about a law that
    does not follow it.

    `slips`: which impacts slip throughout, (n,). Only where all are of the kind that tells nothing
    of a parameter, others would tell it.
    """
    if intervals is None:
        yield (
            "there are no more measured values than parameters, and no standard deviations: "
            "their uncertainty is unknown"
        )
        return
    at = f"at {100.0 * confidence:g} %"
    for name, unit, value, interval, ends in zip(
        parameters.names, parameters.units, values, intervals, parameters.allowed, strict=True
    ):
        low, high, shown = *(text(float(end), unit) for end in interval), text(float(value), unit)
        below, above = interval == ends
        silent = not slips.any() if name == "coefficient" else bool(slips.all())
        full, more = f"{FRICTION}{name}", _WOULD_TELL.get(name, "") if silent else ""
        wide = interval[1] - interval[0] > _WIDE * (
            0.5 * np.ptp(ends) if np.isfinite(ends).all() else abs(value)
        )
        if below and above:
            yield (
                f"these impacts do not determine {full}, which is left at its first value, "
                f"{shown}: {at} they exclude none{more}"
            )
        elif above:
            stick = " (they stick with more friction)" if name == "coefficient" and silent else ""
            yield f"these impacts give only a lower bound of {full}, {low} {at}{stick}{more}"
        elif below and wide:
            yield (
                f"these impacts give only an upper bound of {full}, {high} "
                f"{at}{more if name != 'coefficient' else ''}"
            )
        elif wide:
            yield f"these impacts do not determine {full}: {shown}, but {low} to {high} {at}"
    if seen.deviations_known and freedom > 0 and not known:
        yield (
            f"residuals are {digits(scatter, 3)} times as large as their standard "
            f"deviations: {parameters.law.name} does not fit the "
            "measurement, or its noise is larger; the intervals are widened accordingly"
        )
