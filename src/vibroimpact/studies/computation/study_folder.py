"""The folder of a study: its files, its recovery after a crash, and its TOML text."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from vibroimpact.files.recover import clear, recover
from vibroimpact.files.working_files import remove
from vibroimpact.studies.computation.chunk_file import CHUNK
from vibroimpact.studies.computation.chunk_file import FOLDER as CHUNKS
from vibroimpact.studies.computation.ledger import LEDGER, is_held

DATASET = "study.nc"
STUDY = "study.toml"


def is_study(folder: Path) -> bool:
    """Return whether a folder contains a study, complete or not."""
    return (folder / STUDY).is_file() or (folder / LEDGER).is_file()


def has_study(folder: Path) -> bool:
    """Return whether a folder contains a study, after recovery of an interrupted replacement."""
    recover(folder)
    return is_study(folder)


def recover_study(folder: Path) -> None:
    """Clean up after processes that died while computing a study.

    Nothing is done while another process is computing it.
    """
    recover(folder)
    if (folder / LEDGER).is_file() and not is_held(folder):
        clear_study(folder)
        if (folder / DATASET).is_file():
            remove(folder / CHUNKS)


def clear_study(folder: Path) -> None:
    """Remove partly written files of a study that no process is computing.

    In the folder of the chunks only complete chunks are kept.
    """
    clear(folder)
    for path in (folder / CHUNKS).glob("*"):
        if path.suffix != CHUNK:
            remove(path)


def study_toml(table: Mapping[str, Any]) -> str:
    """Return the text of `study.toml`, with the swept keys in the order of the dimensions.

    Parameters
    ----------
    table : mapping
        The case with its [sweep] section.
    """
    settings = {key: value for key, value in table["sweep"].items() if key != "over"}
    without_over = tomli_w.dumps({**table, "sweep": settings}).rstrip()
    lines = [
        f"{json.dumps(key)} = {_inline(value)}" for key, value in table["sweep"]["over"].items()
    ]
    return "\n".join([without_over, "", "[sweep.over]", *lines, ""])


def swept_keys(table: Mapping[str, Any]) -> list[str]:
    """Return the swept keys of a study in the order of its dimensions.

    Of a population, those of its classes come last.

    Examples
    --------
    >>> swept_keys(
    ...     {
    ...         "sweep": {
    ...             "over": {"drop.height": [1.0]},
    ...             "classes": {"coal": {"over": {"sphere.radius": [0.01]}}},
    ...         }
    ...     }
    ... )
    ['drop.height', 'sphere.radius']
    """
    keys = list(table["sweep"]["over"])
    classes = table["sweep"].get("classes")
    if classes:
        # all classes have the same keys
        first_class = next(iter(classes.values()))
        keys += first_class["over"]
    return keys


def _inline(value: Any) -> str:
    """Return a value as inline TOML.

    The library would move tables behind the other keys and so change their order.
    """
    if isinstance(value, dict):
        entries = [f"{json.dumps(key)} = {_inline(entry)}" for key, entry in value.items()]
        return "{ " + ", ".join(entries) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip()
