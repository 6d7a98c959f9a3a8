"""One drop of a study as a case of its own."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.reader import load_table, prefix_errors
from vibroimpact.studies.read_sweep import read_sweep


def load_drop(
    source: str | PathLike[str], drop: int, changes: Mapping[str, Any] | None = None
) -> Case:
    """Return the case of one drop of a study.

    Parameters
    ----------
    source : path or str
        A TOML file with a [sweep] section, or a shipped study such as "paper:sweep".
    drop : int
        Number of the drop, from 0.
    changes : mapping, optional
        Other values by dotted key, swept or not.

    Raises
    ------
    InputError
        If it is not a valid study, or has no such drop.

    Examples
    --------
    >>> case = load_drop("paper:sweep", 13)
    >>> case.sphere.radius, case.contact.parameters["restitution"]
    (0.005, 0.95)
    """
    return prefix_errors(source, lambda: read_sweep(load_table(source)).case_of(drop, changes))
