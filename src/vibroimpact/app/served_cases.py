"""What the live page computes: cases that take seconds, and read no file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.costs import costs_of, impacts_expected, seconds_at_most, seconds_expected
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.fields.item_labels import path_in_words
from vibroimpact.cases.rigid.rigid_problem import elastic_names
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.structures.recipe import Recipe

MOST_MODES = 400
"""Largest number of modes of a body."""

MOST_IMPACTS = 300
"""Largest number of impacts."""

LONGEST_RUN = 60.0
"""Longest run [s]."""

MOST_SENSORS = 8
"""Largest number of sensors."""

MOST_SAMPLES = 4_000_000
"""Largest number of samples of all sensors."""

MOST_NODES = 100_000
"""Largest number of nodes of a mesh, about.

More take too much memory in any case, and seconds to make before that is known.
"""

MOST_SECONDS = 180.0
"""Longest time that a case may take by the estimate of its costs [s]."""

MOST_MEMORY = 3e9
"""Largest memory that a case may take by the estimate of its costs [bytes]."""

_COMMANDS_OF_SECTIONS = {"sweep": "vibroimpact sweep", "calibrate": "vibroimpact calibrate"}
"""Sections that the live page leaves out, and the commands that they are for."""

_KEYS_OF_FILES = (("sphere", "mesh"), ("plate", "mesh"), ("plate", "motion"))
"""Section and key of the values that may name a file."""


def check_table(table: dict[str, Any]) -> None:
    """Check that the table of a case could stand in TOML, and names no file of this machine.

    Raises
    ------
    InputError
        If a value is null, which TOML does not have; if it names a file; or if it has a section for
        another command.

    Examples
    --------
    >>> check_table({"plate": {"mesh": "/etc/passwd"}})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: plate.mesh: the live page reads no files; run the case with:
    vibroimpact run
    """
    _check_not_null(table)
    for section, key in _KEYS_OF_FILES:
        if _names_file(table.get(section), key):
            raise _reads_no_files(f"{section}.{key}")
    for section, command in _COMMANDS_OF_SECTIONS.items():
        if section in table:
            raise InputError(f"the live page does not read this section; use: {command}", section)


def _check_not_null(table: dict[str, Any]) -> None:
    # without recursion, as tables may be deep
    containers: list[tuple[Any, str]] = [(table, "")]
    while containers:
        container, prefix = containers.pop()
        items = container.items() if isinstance(container, dict) else enumerate(container)
        for key, value in items:
            if value is None:
                raise InputError(
                    "null is not a value of a case; leave it out",
                    path_in_words(f"{prefix}{key}", table),
                )
            if isinstance(value, (dict, list)):
                containers.append((value, f"{prefix}{key}."))


def _names_file(section: Any, key: str) -> bool:
    """Return whether a key of a section is the path of a file, or a table that has one."""
    if not isinstance(section, dict):
        return False
    value = section.get(key)
    return isinstance(value, str) or (isinstance(value, dict) and "file" in value)


def _reads_no_files(key: str) -> InputError:
    return InputError("the live page reads no files; run the case with: vibroimpact run", key)


def without_other_work(table: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the table of a case without sections for other commands, and a sentence on each.

    Examples
    --------
    >>> without_other_work({"name": "a", "sweep": {}})
    ({'name': 'a'}, ['[sweep] is left out here; use: vibroimpact sweep'])
    """
    remaining = {name: table[name] for name in table if name not in _COMMANDS_OF_SECTIONS}
    sentences = [
        f"[{section}] is left out here; use: {command}"
        for section, command in _COMMANDS_OF_SECTIONS.items()
        if section in table
    ]
    return remaining, sentences


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
    # for the expected time a contact is integrated, for its upper bound none
    if rate * seconds_at_most(case) > MOST_SAMPLES:
        _bound(rate * seconds_expected(case), MOST_SAMPLES, "sensors", "samples in all")
    costs = costs_of(case)
    seconds = sum(cost.seconds for cost in costs)
    memory = sum(cost.memory for cost in costs)
    _bound(seconds, MOST_SECONDS, "", "s of computing")
    _bound(memory / 1e9, MOST_MEMORY / 1e9, "", "GB of memory")


def _check_bodies(case: Case) -> None:
    """Check the elastic bodies of a case, before their meshes are made."""
    if not elastic_names(case):
        return
    from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies  # imports scipy.sparse
    from vibroimpact.structures.mode_count import modes_expected

    for name, body in elastic_bodies(case).items():
        if isinstance(getattr(case, name).mesh, BroughtMeshTable):
            raise _reads_no_files(f"{name}.mesh")
        has_frequency = body.recipe.reduction.max_frequency is not None
        key = "max_frequency" if has_frequency else "modes"
        _bound(modes_expected(body.recipe), MOST_MODES, f"{name}.{key}", "modes")
        _bound(_nodes_expected(body.recipe), MOST_NODES, f"{name}.mesh", "nodes")


def _nodes_expected(recipe: Recipe) -> float:
    """Return about how many nodes the mesh of a recipe has."""
    from vibroimpact.structures.recipe import PlateOfPlates, SphereOfSolids, mesh_features

    shape: Any = recipe.shape
    if isinstance(shape, SphereOfSolids):
        return 4.0 * shape.elements_across**3
    discs, lines = mesh_features(recipe.supports)
    elements = 1.0
    for side, lines_across in zip(shape.size[:2], lines, strict=True):
        regular = max(1.0, side / shape.element_size)
        elements *= regular + 3.0 * len(discs) + len(lines_across)
    nodes_per_element = 9.0
    if not isinstance(shape, PlateOfPlates):
        nodes_per_element = 8.0 * shape.layers
    return float(elements * nodes_per_element)


def _bound(value: float, most: float, key: str, what: str) -> None:
    """Raise if a value is not at most a bound; what: its unit, or what is counted."""
    if value <= most:
        return
    rounded = float(f"{value:.3g}")
    shown = rounded if rounded > most else value
    raise InputError(
        f"{shown:,.12g} {what} are more than the {most:,.12g} of the live page; "
        "vibroimpact run takes more",
        key,
    )
