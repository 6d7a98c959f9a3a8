"""What of the files of a test is compared: their records over time, or frequency responses.

A universal file may have both.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from vibroimpact.errors import InputError, choices
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.quoting import quoted
from vibroimpact.signals.reading.universal_responses import Contents, contents_of

KINDS = ("records", "responses")
"""What can be compared."""


class Compared(NamedTuple):
    """What is compared, one of `KINDS`, and sentences about the rest without full stops."""

    kind: str
    remarks: tuple[str, ...]


def compared_kind(
    paths: Sequence[str | Path], asked: str | None, hammer: str | None, *, windowed: bool
) -> Compared:
    """Return what of the files of a test is compared.

    Of files with both it is the frequency responses; the records where the channel of the hammer is
    one of them, there is a window, or another file has records alone.

    Parameters
    ----------
    paths : sequence of paths
        The files.
    asked : str, optional
        What the user asks for, one of `KINDS`.
    hammer : str, optional
        The channel with the force of the hammer, or the node where it acts.
    windowed : bool
        Whether a window of time is stated.

    Raises
    ------
    InputError
        If there is no such kind, a file has nothing of it, or without `asked` one file has records
        alone and another responses alone.
    """
    if asked is not None and asked not in KINDS:
        raise InputError(
            f"{quoted(asked)} can't be compared; there are {choices(KINDS, asked)}", "--compare"
        )
    contents = {path: contents_of(path) for path in paths}
    only_records = [path for path in paths if not contents[path].responses]
    only_responses = [
        path for path in paths if contents[path].responses and not contents[path].records
    ]
    if asked is None and only_records and only_responses:
        raise InputError(
            f"{only_responses[0]} has frequency responses, and {only_records[0]} records over "
            "time; compare them one after the other"
        )
    kind = asked or _default_kind(list(contents.values()), hammer, windowed=windowed)
    if kind == "records":
        lacking = only_responses
        what = "record over time"
    else:
        lacking = only_records
        what = "frequency response"
    if lacking:
        key = "--compare" if asked else ""
        raise InputError(f"{lacking[0]} has no {what}; leave it out", key)
    remarks = [
        _remark(path, contents[path], kind)
        for path in paths
        if contents[path].records and contents[path].responses
    ]
    return Compared(kind, tuple(remarks))


def _default_kind(contents: Sequence[Contents], hammer: str | None, *, windowed: bool) -> str:
    """Return what is compared where nothing is asked for, of the contents of all files."""
    if not any(file.responses for file in contents):
        return "records"
    if not any(file.records for file in contents):
        return "responses"
    a_file_has_records_alone = any(not file.responses for file in contents)
    hammer_is_recorded = False
    if hammer is not None:
        hammer_names = (hammer, name_and_unit(hammer)[0])
        hammer_is_recorded = any(name in file.records for file in contents for name in hammer_names)
    if a_file_has_records_alone or windowed or hammer_is_recorded:
        return "records"
    return "responses"


def _remark(path: str | Path, contents: Contents, kind: str) -> str:
    """Return what of a file with both is compared, and how the other is."""
    records = _counted(len(contents.records), "record over time", "records over time")
    responses = _counted(contents.responses, "frequency response", "frequency responses")
    other = KINDS[1 - KINDS.index(kind)]
    how = f"by --compare {other}, without --window and without files of {kind} alone"
    return f"{path} has {records} and {responses}: the {kind} are compared, and the {other} {how}"


def _counted(count: int, singular: str, plural: str) -> str:
    noun = singular if count == 1 else plural
    return f"{count} {noun}"
