"""What the live page computes: cases that take seconds, and read no file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.costs import costs_of, impacts_expected, seconds_at_most, seconds_expected
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.fields.item_labels import path_in_words
from vibroimpact.cases.rigid_problem import elastic_names
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.structures.recipe import Recipe

MOST_MODES, MOST_IMPACTS, LONGEST_RUN, MOST_SENSORS, MOST_SAMPLES = 400, 300, 60.0, 8, 4_000_000
"""Largest number of modes of a body and of impacts, longest run [s], largest number of
sensors and of samples.
"""

MOST_NODES = 100_000
"""Largest number of nodes of a mesh, about: more take too much memory in any case, and
seconds to make before that is known.
"""

MOST_SECONDS, MOST_MEMORY = 180.0, 3e9
"""Longest time [s] and largest memory [bytes] that a case may take by the estimate of its costs."""

_ELSEWHERE = {"sweep": "vibroimpact sweep", "calibrate": "vibroimpact calibrate"}


def check_table(table: dict[str, Any]) -> None:
    """Check that the table of a case names no file of this machine, and that it could stand in
    TOML, which has no null.

    Raises
    ------
    InputError
        If it does.

    Examples
    --------
    >>> check_table({"plate": {"mesh": "/etc/passwd"}})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: plate.mesh: the live page reads no files; run the case with:
    vibroimpact run
    """
    left: list[tuple[Any, str]] = [(table, "")]
    while left:
        within, where = left.pop()
        for key, value in within.items() if isinstance(within, dict) else enumerate(within):
            if value is None:
                raise InputError(
                    "null is not a value of a case; leave it out",
                    path_in_words(f"{where}{key}", table),
                )
            if isinstance(value, (dict, list)):
                left.append((value, f"{where}{key}."))
    for body, key in (("sphere", "mesh"), ("plate", "mesh"), ("plate", "motion")):
        section = table.get(body)
        part = section.get(key) if isinstance(section, dict) else None
        if isinstance(part, str) or (isinstance(part, dict) and "file" in part):
            raise InputError(
                "the live page reads no files; run the case with: vibroimpact run", f"{body}.{key}"
            )
    for name, command in _ELSEWHERE.items():
        if name in table:
            raise InputError(f"the live page does not read this section; use: {command}", name)


def without_other_work(table: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the table of a case without the sections for other commands, and a sentence on each of
    them.

    Examples
    --------
    >>> without_other_work({"name": "a", "sweep": {}})
    ({'name': 'a'}, ['[sweep] is left out here; use: vibroimpact sweep'])
    """
    left = [
        f"[{name}] is left out here; use: {command}"
        for name, command in _ELSEWHERE.items()
        if name in table
    ]
    return {name: value for name, value in table.items() if name not in _ELSEWHERE}, left


def check_bounds(case: Case) -> None:
    """Check that a case is small enough to be computed while somebody waits.

    Raises
    ------
    InputError
        If it is not; the message gives the bound, and the command that has none.
    """
    _check_bodies(case)
    _bound(case.run.duration or 0.0, LONGEST_RUN, "run.duration", "s")
    _bound(impacts_expected(case), MOST_IMPACTS, "run.impacts", "impacts")
    _bound(len(case.sensors), MOST_SENSORS, "sensors", "sensors")
    rate = sum(sensor.rate for sensor in case.sensors)
    if rate * seconds_at_most(case) > MOST_SAMPLES:
        _bound(rate * seconds_expected(case), MOST_SAMPLES, "sensors", "samples in all")
    costs = costs_of(case)
    _bound(sum(cost.seconds for cost in costs), MOST_SECONDS, "", "s of computing")
    _bound(sum(cost.memory for cost in costs) / 1e9, MOST_MEMORY / 1e9, "", "GB of memory")


def _check_bodies(case: Case) -> None:
    """Check the elastic bodies of a case, before their meshes are made."""
    if not elastic_names(case):
        return
    from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies  # imports scipy.sparse
    from vibroimpact.structures.mode_count import modes_expected

    for name, body in elastic_bodies(case).items():
        if isinstance(getattr(case, name).mesh, BroughtMeshTable):
            raise InputError(
                "the live page reads no files; run the case with: vibroimpact run", f"{name}.mesh"
            )
        by_number = body.recipe.reduction.max_frequency is None
        _bound(
            modes_expected(body.recipe),
            MOST_MODES,
            f"{name}.{'modes' if by_number else 'max_frequency'}",
            "modes",
        )
        _bound(_nodes(body.recipe), MOST_NODES, f"{name}.mesh", "nodes")


def _nodes(recipe: Recipe) -> float:
    """Return about how many nodes the mesh of a recipe has."""
    from vibroimpact.structures.recipe import PlateOfPlates, SphereOfSolids, mesh_features

    shape: Any = recipe.shape
    if isinstance(shape, SphereOfSolids):
        return 4.0 * shape.elements_across**3
    discs, lines = mesh_features(recipe.supports)
    across = [
        max(1.0, side / shape.element_size) + 3.0 * len(discs) + len(at)
        for side, at in zip(shape.size[:2], lines, strict=True)
    ]
    return float(
        across[0] * across[1] * (9.0 if isinstance(shape, PlateOfPlates) else 8.0 * shape.layers)
    )


def _bound(value: float, most: float, key: str, what: str) -> None:
    if not value <= most:
        rounded = float(f"{value:.3g}")
        there = rounded if rounded > most else value
        raise InputError(
            f"{there:,.12g} {what} are more than the {most:,.12g} of the live page; "
            "vibroimpact run takes more",
            key,
        )
