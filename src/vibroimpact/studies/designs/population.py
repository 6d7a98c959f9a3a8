"""Falls of rocks of several classes, in groups that share a rock and a plate."""

from __future__ import annotations

from vibroimpact.errors import InputError
from vibroimpact.studies.planning.design import Asked, Design
from vibroimpact.studies.planning.plan import Plan


def size(asked: Asked) -> int:
    """Return the number of falls.

    Raises
    ------
    InputError
        If no classes are given.
    """
    if asked.population is None:
        raise InputError(
            "they are missing; a population has classes, such as [sweep.classes.coal.over]",
            "classes",
        )
    return asked.samples


def plan(asked: Asked) -> Plan:
    """Return the falls, one plate after the other."""
    size(asked)
    assert asked.population is not None
    columns, labels = asked.population.draw(asked.axes, asked.samples, asked.seed)
    return Plan("population", columns, False, labels)


DESIGN = Design(
    "population",
    "falls of rocks drawn from classes, one or more of each rock, on one or more plates",
    True,
    size,
    plan,
)
