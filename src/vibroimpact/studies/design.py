"""The registry of study designs: one file of `vibroimpact.studies.designs` each, which names itself with a `Design`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.registry import find_named, modules_in
from vibroimpact.studies.axes import Axis
from vibroimpact.studies.plan import Plan


@dataclass(frozen=True)
class Design:
    """A way to choose the points of a study.

    Parameters
    ----------
    name : str
        As a case has it.
    meaning : str
        Which points they are, in a few words.
    is_drawn : bool
        Does it take a number of samples and a seed?
    size : callable
        Takes the axes by their keys and the number of samples, returns how many points there would be. Raises InputError
        if they do not fit the design.
    plan : callable
        Takes the same and the seed, returns the points.
    """

    name: str
    meaning: str
    is_drawn: bool
    size: Callable[[Mapping[str, Axis], int], int]
    plan: Callable[[Mapping[str, Axis], int, int], Plan]


@cache
def designs() -> Mapping[str, Design]:
    """Return every design by its name.

    Examples
    --------
    >>> list(designs())
    ['grid', 'latin-hypercube', 'saltelli', 'sobol', 'zip']
    """
    found = [value for module in modules_in("vibroimpact.studies.designs") for value in vars(module).values() if isinstance(value, Design)]
    return {one.name: one for one in sorted(found, key=lambda one: one.name)}


def find_design(name: str) -> Design:
    """Return the design called `name`.

    Raises
    ------
    InputError
        If there is none; the message names the closest.
    """
    return find_named("design", name, designs())


def drawn_plan(name: str, axes: Mapping[str, Axis], parts: Floats) -> Plan:
    """Return the plan whose points lie at parts (points, axes) of the distributions of the axes."""
    return Plan(name, {key: axis.quantiles(parts[:, place]) for place, (key, axis) in enumerate(axes.items())}, False)


def generator(seed: int, *stream: int) -> np.random.Generator:
    """Return a generator of random numbers for a seed, and for a stream of its own."""
    return np.random.default_rng([seed, *stream])
