"""What of the files of a test is compared: their records over time, or their frequency
responses. A universal file may have both.
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
    """What is compared, one of `KINDS`, and what is said of the rest, sentences without
    full stops.
    """

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
    every = [(path, contents_of(path)) for path in paths]
    records = [path for path, one in every if not one.responses]
    responses = [path for path, one in every if one.responses and not one.records]
    if asked is None and records and responses:
        words = f"{responses[0]} has frequency responses, and {records[0]} records over time"
        raise InputError(f"{words}; compare them one after the other")
    kind = asked or _kind(every, hammer, windowed=windowed)
    lacking = responses if kind == "records" else records
    if lacking:
        has = "no record over time" if kind == "records" else "no frequency response"
        raise InputError(f"{lacking[0]} has {has}; leave it out", "--compare" if asked else "")
    return Compared(
        kind,
        tuple(_remark(path, one, kind) for path, one in every if one.records and one.responses),
    )


def _kind(
    every: Sequence[tuple[str | Path, Contents]], hammer: str | None, *, windowed: bool
) -> str:
    """Return what is compared where nothing is asked for."""
    if not any(one.responses for _, one in every):
        return "records"
    if not any(one.records for _, one in every):
        return "responses"
    alone = any(not one.responses for _, one in every)
    channels = () if hammer is None else (hammer, name_and_unit(hammer)[0])
    named = any(channel in one.records for _, one in every for channel in channels)
    return "records" if alone or windowed or named else "responses"


def _remark(path: str | Path, contents: Contents, kind: str) -> str:
    """Return what of a file with both is compared, and how the other is."""
    records = _counted(len(contents.records), "record over time", "records over time")
    responses = _counted(contents.responses, "frequency response", "frequency responses")
    other = KINDS[1 - KINDS.index(kind)]
    how = f"by --compare {other}, without --window and without files of {kind} alone"
    return f"{path} has {records} and {responses}: the {kind} are compared, and the {other} {how}"


def _counted(number: int, one: str, several: str) -> str:
    return f"{number} {one if number == 1 else several}"
