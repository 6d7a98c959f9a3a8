"""Truncation of modes at a frequency that is too low for the contact."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import DURATION, FORCE, Effects, Limit, in_kilohertz, two_digits
from vibroimpact.units.display import text

_TRUNCATED = 0.05  # allowed relative change of the largest force by truncated modes
_CYCLES = 1.5  # periods of the highest mode in a contact, below which there is a doubt
_ENOUGH = 3.0  # periods that the remedy asks for


def _number(body: str, drops: Conditions) -> Array:
    if body not in drops.summary.modes or (
        body == "sphere" and drops.case.get("contact", {}).get("local_compliance") == "superposed"
    ):
        # with superposition, more modes of the sphere would only make the contact softer
        return math.nan
    part, highest = drops.summary.modes[body]
    return np.fmax(part / _TRUNCATED, np.divide(_CYCLES, highest * drops.summary.duration))


def _effects(body: str, drop: Conditions, _: float) -> Effects:
    """Return what the modes left out may change; the rebound by more, which is not estimated."""
    part, _highest = drop.summary.modes[body]
    return {FORCE: part, DURATION: part}


def _sentence(body: str, drop: Conditions, _: float) -> str:
    part, highest = drop.summary.modes[body]
    duration = float(drop.summary.duration)
    enough = _ENOUGH / duration
    wanted = 2.0 * highest  # the modes of a very compliant body may matter beyond
    if highest < enough:
        wanted = enough
    instead = ""
    if drop.case and "modes" in drop.case[body]:  # type: ignore[literal-required]
        instead = f", in place of {body}.modes"
    return (
        f"the modes of the {body} end at {text(highest, 'Hz')}, and the contact lasts "
        f"{text(duration, 's', 3)}: the modes left out may "
        f"change the largest force by up to {two_digits(100.0 * part)} %, and rebound and "
        "vibration by more; ask for "
        f'{body}.max_frequency = "{in_kilohertz(wanted)}" or so{instead}'
    )


LIMITS = tuple(
    Limit(
        name=f"{body}_modes",
        title=f"modes of the {body} left out",
        meaning=f"change of the largest force by the modes of the {body} left out, over "
        f"{100.0 * _TRUNCATED:g} %; or {_CYCLES} over the periods of the highest in the contact, "
        "if that is more",
        threshold=1.0,
        number=partial(_number, body),
        sentence=partial(_sentence, body),
        effects=partial(_effects, body),
        shown=lambda ratio: (
            f"{two_digits(ratio)} times the limit ({100.0 * _TRUNCATED:g} % of the largest force, "
            f"or {_CYCLES} periods of the highest mode in a contact)"
        ),
        without_case=True,
    )
    for body in ("sphere", "plate")
)
