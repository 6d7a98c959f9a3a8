"""Points of a scrambled Sobol sequence, a low-discrepancy sequence."""

from __future__ import annotations

from vibroimpact.errors import InputError
from vibroimpact.studies.planning.design import MOST_DROPS, Asked, Design, drawn_plan, generator
from vibroimpact.studies.planning.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of samples.

    Raises
    ------
    InputError
        If it is not a power of two, for which alone the sequence is balanced.
    """
    check_power_of_two(asked.samples)
    return asked.samples


def check_power_of_two(samples: int, blocks: int = 1) -> None:
    """Check that a number of samples in each of some blocks is a power of two."""
    if samples & (samples - 1):
        largest = 1 << ((MOST_DROPS // blocks).bit_length() - 1)
        below = 1 << (samples.bit_length() - 1)
        if 2 * below <= largest:
            remedy = f"take {below} or {2 * below}"
        else:
            remedy = f"take {min(below, largest)}"
        raise InputError(
            f"{samples} is not a power of two, which the sequence needs to be balanced; {remedy}",
            "samples",
        )


def plan(asked: Asked) -> Plan:
    """Return the points of the sequence."""
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(asked.axes), rng=generator(asked.seed))
    return drawn_plan("sobol", asked.axes, sequence.random(asked.samples))


DESIGN = Design("sobol", "a Sobol sequence, evenly spread in all axes together", True, size, plan)
