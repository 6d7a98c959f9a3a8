"""TOML of this program's own files, whose text may be damaged."""

from __future__ import annotations

import tomllib
from os import PathLike
from typing import Any

from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError
from vibroimpact.files.reading import FileKind, read_text

_OWN = FileKind("it is a case in TOML", 20_000_000, "larger cases are not read")


def parse_toml(text: str) -> dict[str, Any]:
    """Return the table of a text that this program wrote.

    Raises
    ------
    DamageError
        If it is not TOML.

    Examples
    --------
    >>> parse_toml("sphere = ")
    Traceback (most recent call last):
        ...
    vibroimpact.files.check_sums.DamageError: the file is damaged: it is not TOML: Invalid value (at
    end of document)
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise DamageError(
            "the file is damaged: it is not TOML: its tables lie too deep in one another"
        ) from None
    except ValueError as error:
        raise DamageError(f"the file is damaged: it is not TOML: {error}") from None


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """Return the table of a file that this program wrote.

    Raises
    ------
    DamageError
        If it can't be read, or is not TOML; the message does not include the path.
    """
    try:
        return parse_toml(read_text(path, _OWN))
    except InputError as error:
        raise DamageError(f"the file can't be used: {error}") from None
