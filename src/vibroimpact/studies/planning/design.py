"""Registry of study designs: each file of `vibroimpact.studies.designs` defines one `Design`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.registry import find_named, modules_in
from vibroimpact.studies.planning.axes import Axis
from vibroimpact.studies.planning.plan import Plan
from vibroimpact.studies.planning.population import Population
from vibroimpact.studies.planning.scaled import scaled_columns

MOST_DROPS = 10_000_000
"""Maximum number of drops of a study."""


@dataclass(frozen=True)
class Asked:
    """What a study asks of its design.

    Parameters
    ----------
    axes : mapping of str to Axis
        Values by swept key.
    samples : int, default 0
        Number of samples, of a design that draws points.
    seed : int, default 0
        Of the drawing.
    population : Population, optional
        Classes of rocks, and how many falls share a rock and a plate.
    """

    axes: Mapping[str, Axis]
    samples: int = 0
    seed: int = 0
    population: Population | None = None


@dataclass(frozen=True)
class Design:
    """A design of experiments: a rule that chooses the points of a study.

    Parameters
    ----------
    name : str
        Name in a case file.
    meaning : str
        Short description of the points.
    is_drawn : bool
        Whether it takes a number of samples and a seed.
    size : callable
        Takes what is asked of it, returns the number of points. Raises InputError if that does not
        suit the design.
    plan : callable
        Takes the same, returns the points.
    """

    name: str
    meaning: str
    is_drawn: bool
    size: Callable[[Asked], int]
    plan: Callable[[Asked], Plan]


@cache
def designs() -> Mapping[str, Design]:
    """Return all designs by name.

    Examples
    --------
    >>> list(designs())
    ['grid', 'latin-hypercube', 'population', 'saltelli', 'sobol', 'zip']
    """
    by_name = {}
    for module in modules_in("vibroimpact.studies.designs"):
        for value in vars(module).values():
            if isinstance(value, Design):
                by_name[value.name] = value
    return dict(sorted(by_name.items()))


def find_design(name: str) -> Design:
    """Return the design called `name`.

    Raises
    ------
    InputError
        If there is none; the message suggests the closest name.
    """
    return find_named("design", name, designs())


def drawn_plan(name: str, axes: Mapping[str, Axis], probabilities: Floats) -> Plan:
    """Return the plan of the quantiles of the axes at probabilities, (points, axes)."""
    columns = {}
    for key, axis_probabilities in zip(axes, probabilities.T, strict=True):
        columns[key] = axes[key].quantiles(axis_probabilities)
    return Plan(name, scaled_columns(axes, columns), False)


def generator(seed: int, *stream: int) -> np.random.Generator:
    """Return a random number generator for a seed and an independent stream."""
    return np.random.default_rng([seed, *stream])
