"""One channel of a file of records."""

from __future__ import annotations

from itertools import islice
from os import PathLike

from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.files.reading import with_path
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.quoting import quoted
from vibroimpact.signals.reading.record_files import load_records
from vibroimpact.signals.record import Record

_MOST_LISTED = 10
"""Largest number of channels that a message names."""


def one_record(
    path: str | PathLike[str], channel: str | None = None, columns: str | None = None
) -> Record:
    """Read a channel of a file or folder; where there is only one, its name may be left out.

    Parameters
    ----------
    path : path
        The file, as `load_records` reads it.
    channel : str, optional
        Name of the channel, or the cell of a table's header that has it with its unit.
    columns : str, optional
        The columns of a table, as `load_records` takes them.

    Raises
    ------
    InputError
        If the file can't be read, there is no such channel, or there are several records without a
        name or of that name.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     with open(f"{folder}/hammer.csv", "w") as file:
    ...         _ = file.write("time [ms],force [kN],plate (g)\\n0,1,0\\n1,2,5\\n")
    ...     vi.signals.one_record(f"{folder}/hammer.csv", "force").value.tolist()
    [1000.0, 2000.0]
    """
    names: list[str] = []
    matching: list[Record] = []
    for record in load_records(path, columns):
        names.append(record.name)
        if channel is None or is_named(record, channel):
            matching.append(record)
        if len(matching) > 1:
            break
    if len(matching) > 1:
        raise with_path(path, InputError(_several(path, channel, columns)))
    if not matching:
        raise with_path(path, InputError(_no_channel(channel, list(dict.fromkeys(names)))))
    return matching[0]


def _no_channel(channel: str | None, names: list[str]) -> str:
    """Return the message that there is no such channel among some."""
    has = "it has no record"
    if names:
        has = f"it has {_listed(names)}.{did_you_mean(channel or '', names)}"
    if channel is None:
        return has
    return f"there is no channel {quoted(channel)}; {has}"


def _several(path: str | PathLike[str], channel: str | None, columns: str | None) -> str:
    """Return the message that there are several such channels."""
    matching = (
        record.name
        for record in islice(load_records(path, columns), _MOST_LISTED + 1)
        if channel is None or is_named(record, channel)
    )
    names = list(dict.fromkeys(matching))
    if len(names) == 1:
        return f"several signals have the name {quoted(names[0])}; take a file with one of them"
    return (
        f"it has several channels, {_listed(names)}; name one by --channel (in "
        "a case the key channel)"
    )


def is_named(record: Record, channel: str) -> bool:
    """Return whether a record has a name, or that of a header's cell.

    A column "Recording (a.u.)" is the record "recording".

    Examples
    --------
    >>> import vibroimpact as vi
    >>> [
    ...     is_named(vi.signals.Record("recording", [0.0, 1.0], 8e3, "1"), name)
    ...     for name in ("recording", "Recording (a.u.)", "record")
    ... ]
    [True, True, False]
    """
    return record.name in (channel, name_and_unit(channel)[0])


def _listed(names: list[str]) -> str:
    listed = ", ".join(quoted(name) for name in names[:_MOST_LISTED])
    if len(names) > _MOST_LISTED:
        return f"{listed} and more"
    return listed
