"""One channel of a file of records."""

from __future__ import annotations

from itertools import islice
from os import PathLike

from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.files.reading import with_path
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.quoting import quoted
from vibroimpact.signals.read_records import read_records
from vibroimpact.signals.record import Record

_TOLD = 10
"""Channels that a message names at most."""


def one_record(
    path: str | PathLike[str], channel: str | None = None, columns: str | None = None
) -> Record:
    """Return the record of a channel of a file, or of a folder; of its only one without a name.

    Parameters
    ----------
    path : path
        The file, as `read_records` reads it.
    channel : str, optional
        Name of the channel, or the cell of a table's header that has it with its unit.
    columns : str, optional
        The columns of a table, as `read_records` takes them.

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
    ...     vi.one_record(f"{folder}/hammer.csv", "force").value.tolist()
    [1000.0, 2000.0]
    """
    names, found = [], []
    for record in read_records(path, columns):
        names.append(record.name)
        if channel is None or is_named(record, channel):
            found.append(record)
        if len(found) > 1:
            break
    if not found:
        every = list(dict.fromkeys(names))
        there = (
            f"it has {_listed(every)}.{did_you_mean(channel or '', every)}"
            if every
            else "it has no record"
        )
        raise with_path(
            path,
            InputError(
                f"there is no channel {quoted(channel)}; {there}" if channel is not None else there
            ),
        )
    if len(found) > 1:
        alike = (
            record.name
            for record in islice(read_records(path, columns), _TOLD + 1)
            if channel is None or is_named(record, channel)
        )
        every = list(dict.fromkeys(alike))
        several = (
            f"it has several channels, {_listed(every)}; name one by --channel (in "
            "a case the key channel)"
        )
        one = f"several signals have the name {quoted(every[0])}; take a file with one of them"
        raise with_path(path, InputError(several if len(every) > 1 else one))
    return found[0]


def is_named(record: Record, channel: str) -> bool:
    """Return whether a record has a name, or that of a header's cell: a column "Recording (a.u.)"
    is the record "recording".

    Examples
    --------
    >>> import vibroimpact as vi
    >>> [
    ...     is_named(vi.Record("recording", [0.0, 1.0], 8e3, "1"), name)
    ...     for name in ("recording", "Recording (a.u.)", "record")
    ... ]
    [True, True, False]
    """
    return record.name in (channel, name_and_unit(channel)[0])


def _listed(names: list[str]) -> str:
    return ", ".join(quoted(name) for name in names[:_TOLD]) + (
        " and more" if len(names) > _TOLD else ""
    )
