"""Whether records are those of a run of this same model of a plate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.cases.schema import CaseTable
from vibroimpact.errors import InputError
from vibroimpact.signals.record import Record

_RUN = ("result.nc", "case.toml")
"""Files of the folder of a run: its signals, and its case."""


def is_own_run(case: CaseTable, records: Sequence[Record]) -> bool:
    """Return whether records are from the folder of a run whose plate is modelled as in a
    case: then they have no errors of that model.
    """
    folders = {
        Path(record.source).parent for record in records if Path(record.source).name == _RUN[0]
    }
    if len(folders) != 1 or any(Path(record.source).name != _RUN[0] for record in records):
        return False
    file = folders.pop() / _RUN[1]
    if not file.is_file():
        return False
    try:
        other = load_case(file)
    except InputError:  # of another version, or changed by hand
        return False
    return bool(resolved_case(other)["plate"] == resolved_case(case)["plate"])
