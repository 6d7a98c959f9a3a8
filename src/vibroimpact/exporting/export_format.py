"""The registry of export formats: each module of `vibroimpact.exporting.formats` defines
one `ExportFormat`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.files.plain_names import identifier
from vibroimpact.registry import find_named, modules_in

Rows: TypeAlias = list[dict[str, str | float]]
"""Rows of a table, each by the names of the columns."""


@dataclass(frozen=True)
class ExportFormat:
    """A file format for drops.

    Parameters
    ----------
    name : str
        The argument of `vibroimpact export --to`.
    program : str
        The programs that read it.
    files : str
        The files that are written, in a few words.
    tested : str
        What the writer was tested against.
    write : callable
        Takes a `Drop`, returns the bytes of each file by its name. Raises InputError if the format
        can't hold the drop.
    notes : callable
        Takes a `Drop`, returns the limitations of the format for it, one sentence each.
    dialog : callable
        Takes a `Drop`, returns the fields of the dialog of a contact in Adams View for each impact
        (`dialog_rows`); none by default.
    rows : callable
        Takes a `Drop`, returns the rows of tables by their names, which the command prints; none by
        default.
    prepare : callable
        Takes a `Drop`, returns the one that is passed to `write` and `notes`: `as_rigid` for
        programs that simulate the motion of rigid bodies; by default the drop unchanged.
    """

    name: str
    program: str
    files: str
    tested: str
    write: Callable[[Drop], Mapping[str, bytes]]
    notes: Callable[[Drop], list[str]] = lambda drop: []
    dialog: Callable[[Drop], list[dict[str, Any]]] = lambda drop: []
    rows: Callable[[Drop], Mapping[str, Rows]] = lambda drop: {}
    prepare: Callable[[Drop], Drop] = lambda drop: drop

    @property
    def simulates(self) -> bool:
        """Whether a program simulates the drop from the files, between rigid bodies."""
        return self.prepare is as_rigid


@cache
def export_formats() -> Mapping[str, ExportFormat]:
    """Return all export formats by name.

    Examples
    --------
    >>> "adams" in export_formats()
    True
    """
    modules = modules_in("vibroimpact.exporting.formats")
    formats = [
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, ExportFormat)
    ]
    return {
        export_format.name: export_format
        for export_format in sorted(formats, key=lambda export_format: export_format.name)
    }


def find_export_format(name: str) -> ExportFormat:
    """Return the export format called `name`.

    Raises
    ------
    InputError
        If there is none; the message suggests the closest name.
    """
    return find_named("export format", name, export_formats())


def file_name(drop: Drop, ending: str) -> str:
    """Return the name of a file: the drop's name in plain characters, and an ending.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> file_name(SimpleNamespace(name="the paper's Type 1"), ".in")
    'the-paper-s-type-1.in'
    """
    return f"{identifier(drop.name.lower(), 'a-z0-9', 'drop', '-')}{ending}"
