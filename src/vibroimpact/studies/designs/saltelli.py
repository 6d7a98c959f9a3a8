"""The points that Sobol's indices of sensitivity are estimated from."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.studies.axes import Axis
from vibroimpact.studies.design import Design, drawn_plan, generator
from vibroimpact.studies.designs.sobol import check_power_of_two
from vibroimpact.studies.plan import Plan


def size(axes: Mapping[str, Axis], samples: int) -> int:
    """Return how many points there are: as many samples as asked for in each of 2 + axes blocks.

    Raises
    ------
    InputError
        If the number of samples is no power of two, or there is one axis alone.
    """
    check_power_of_two(samples)
    if len(axes) < 2:
        raise InputError("there is one key alone, so that everything depends on it; sweep two or more", "over")
    return samples * (2 + len(axes))


def plan(axes: Mapping[str, Axis], samples: int, seed: int) -> Plan:
    """Return the points: a block A, a block B, and for each axis the block A with the values of B on that axis.

    References
    ----------
    Saltelli, A. et al. (2010). Variance based sensitivity analysis of model output. Comput. Phys. Commun. 181, 259-270.
    """
    from scipy.stats import qmc

    both = qmc.Sobol(2 * len(axes), rng=generator(seed)).random(samples)
    a, b = both[:, : len(axes)], both[:, len(axes) :]
    blocks = [a, b]
    for place in range(len(axes)):
        mixed = a.copy()
        mixed[:, place] = b[:, place]
        blocks.append(mixed)
    return drawn_plan("saltelli", axes, np.concatenate(blocks))


DESIGN = Design("saltelli", "the points for Sobol's indices: samples in each of 2 + keys blocks", True, size, plan)
