"""Points of a scrambled Sobol sequence, a low-discrepancy sequence."""

from __future__ import annotations

from vibroimpact.errors import InputError
from vibroimpact.studies.design import Asked, Design, drawn_plan, generator
from vibroimpact.studies.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of samples.

    Raises
    ------
    InputError
        If it is not a power of two, for which alone the sequence is balanced.
    """
    check_power_of_two(asked.samples)
    return asked.samples


def check_power_of_two(samples: int) -> None:
    """Check that a number of samples is a power of two."""
    if samples & (samples - 1):
        below = 1 << (samples.bit_length() - 1)
        raise InputError(
            f"{samples} is not a power of two, which the sequence needs to be balanced; take {below} or {2 * below}", "samples"
        )


def plan(asked: Asked) -> Plan:
    """Return the points of the sequence."""
    from scipy.stats import qmc

    return drawn_plan("sobol", asked.axes, qmc.Sobol(len(asked.axes), rng=generator(asked.seed)).random(asked.samples))


DESIGN = Design("sobol", "a Sobol sequence, evenly spread in all axes together", True, size, plan)
