"""Whether records are those of a run of this same model of a plate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.cases.schema import CaseTable
from vibroimpact.errors import InputError
from vibroimpact.signals.record import Record

_SIGNALS = "result.nc"
"""File of the signals in the folder of a run."""
_CASE = "case.toml"
"""File of its case."""


def is_own_run(case: CaseTable, records: Sequence[Record]) -> bool:
    """Return whether records are from the folder of a run whose plate is modelled as in a case.

    Then they have no errors of that model.
    """
    sources = {Path(record.source) for record in records}
    folders = {source.parent for source in sources}
    if len(folders) != 1 or any(source.name != _SIGNALS for source in sources):
        return False
    file = folders.pop() / _CASE
    if not file.is_file():
        return False
    try:
        other = load_case(file)
    except InputError:  # of another version, or changed by hand
        return False
    return bool(resolved_case(other)["plate"] == resolved_case(case)["plate"])
