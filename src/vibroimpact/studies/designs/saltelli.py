"""Saltelli's design: the points for the estimation of Sobol indices."""

from __future__ import annotations

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.studies.designs.sobol import check_power_of_two
from vibroimpact.studies.planning.design import Asked, Design, drawn_plan, generator
from vibroimpact.studies.planning.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of points: `samples` in each of 2 + axes blocks.

    Raises
    ------
    InputError
        If the number of samples is not a power of two, or there is only one axis.
    """
    check_power_of_two(asked.samples, 2 + len(asked.axes))
    if len(asked.axes) < 2:
        raise InputError(
            "there is one key alone, so that everything depends on it; sweep two or more", "over"
        )
    return asked.samples * (2 + len(asked.axes))


def plan(asked: Asked) -> Plan:
    """Return the points: block A, block B, and one block for each axis.

    The block of an axis is block A with the values of B on that axis.

    References
    ----------
    Saltelli, A. et al. (2010). Variance based sensitivity analysis of model output. Comput. Phys.
    Commun. 181, 259-270.
    """
    from scipy.stats import qmc

    count = len(asked.axes)
    # both blocks from one sequence, so that they are even together
    sequence = qmc.Sobol(2 * count, rng=generator(asked.seed)).random(asked.samples)
    block_a = sequence[:, :count]
    block_b = sequence[:, count:]
    blocks = [block_a, block_b]
    for axis in range(count):
        mixed = block_a.copy()
        mixed[:, axis] = block_b[:, axis]
        blocks.append(mixed)
    return drawn_plan("saltelli", asked.axes, np.concatenate(blocks))


DESIGN = Design(
    "saltelli",
    "the points for Sobol's indices: samples in each of 2 + keys blocks",
    True,
    size,
    plan,
)
