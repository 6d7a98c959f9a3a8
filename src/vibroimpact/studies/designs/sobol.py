"""Points of a scrambled Sobol sequence, a low-discrepancy sequence."""

from __future__ import annotations

from collections.abc import Mapping

from vibroimpact.errors import InputError
from vibroimpact.studies.axes import Axis
from vibroimpact.studies.design import Design, drawn_plan, generator
from vibroimpact.studies.plan import Plan


def size(axes: Mapping[str, Axis], samples: int) -> int:
    """Return the number of samples.

    Raises
    ------
    InputError
        If it is not a power of two, for which alone the sequence is balanced.
    """
    check_power_of_two(samples)
    return samples


def check_power_of_two(samples: int) -> None:
    """Check that a number of samples is a power of two."""
    if samples & (samples - 1):
        below = 1 << (samples.bit_length() - 1)
        raise InputError(
            f"{samples} is not a power of two, which the sequence needs to be balanced; take {below} or {2 * below}", "samples"
        )


def plan(axes: Mapping[str, Axis], samples: int, seed: int) -> Plan:
    """Return the points of the sequence."""
    from scipy.stats import qmc

    return drawn_plan("sobol", axes, qmc.Sobol(len(axes), rng=generator(seed)).random(samples))


DESIGN = Design("sobol", "a Sobol sequence, evenly spread in all axes together", True, size, plan)
