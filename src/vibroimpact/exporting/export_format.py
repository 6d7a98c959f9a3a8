"""The registry of export formats: one file of this package each, which names itself with an `ExportFormat`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

from vibroimpact.exporting.drop import Drop
from vibroimpact.registry import find_named, modules_in


@dataclass(frozen=True)
class ExportFormat:
    """A format that a drop can be written in.

    Parameters
    ----------
    name : str
        As `vibroimpact export --to` takes it.
    program : str
        What reads it.
    files : str
        What is written, in a few words.
    tested : str
        What the writer was tested against.
    write : callable
        Takes a `Drop`, returns the bytes of each file by its name. Raises InputError if the format can't hold the drop.
    notes : callable
        Takes a `Drop`, returns what the format can't represent of it, one sentence each.
    told : callable
        Takes a `Drop`, returns the one that the program can be told of, which `write` and `notes` take: `as_rigid` of a program that
        is to move the bodies itself and knows rigid ones alone; the drop itself by default.
    """

    name: str
    program: str
    files: str
    tested: str
    write: Callable[[Drop], Mapping[str, bytes]]
    notes: Callable[[Drop], list[str]] = lambda drop: []
    told: Callable[[Drop], Drop] = lambda drop: drop


@cache
def export_formats() -> Mapping[str, ExportFormat]:
    """Return every export format by its name.

    Examples
    --------
    >>> "adams" in export_formats()
    True
    """
    modules = modules_in("vibroimpact.exporting.formats")
    found = [value for module in modules for value in vars(module).values() if isinstance(value, ExportFormat)]
    return {one.name: one for one in sorted(found, key=lambda one: one.name)}


def find_export_format(name: str) -> ExportFormat:
    """Return the export format called `name`.

    Raises
    ------
    InputError
        If there is none; the message names the closest.
    """
    return find_named("export format", name, export_formats())
