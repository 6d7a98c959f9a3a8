"""Latin hypercube sampling: random points, stratified along each axis."""

from __future__ import annotations

from vibroimpact.studies.planning.design import Asked, Design, generator
from vibroimpact.studies.planning.plan import Plan
from vibroimpact.studies.planning.scaled import scaled_columns


def size(asked: Asked) -> int:
    """Return the number of samples."""
    return asked.samples


def plan(asked: Asked) -> Plan:
    """Return the points: on each axis one in each of `samples` equally likely intervals.

    The values of the axes are paired at random. Each axis is sampled separately from its own random
    stream, which avoids a second copy of all samples in memory.
    """
    from scipy.stats import qmc

    columns = {}
    for number, (key, axis) in enumerate(asked.axes.items()):
        sampler = qmc.LatinHypercube(1, rng=generator(asked.seed, number))
        columns[key] = axis.quantiles(sampler.random(asked.samples)[:, 0])
    return Plan("latin-hypercube", scaled_columns(asked.axes, columns), False)


DESIGN = Design("latin-hypercube", "random points, evenly spread along each axis", True, size, plan)
