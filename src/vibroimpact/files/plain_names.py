"""Sanitizing of names for files of other programs, which must not interpret them as syntax.

They are names of cases, sensors and materials.

`plain_words` is for comments, `plain_names` for names of files, groups and columns, `identifier`
for identifiers of a program, and `one_line` for text that only people read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 80
# reserved file names of Windows, with any suffix
_DEVICES = {
    "con",
    "prn",
    "aux",
    "nul",
    *(f"{port}{number}" for port in ("com", "lpt") for number in range(10)),
}


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Return for each name a distinct name for a file or a group.

    It consists of letters, digits and a few signs.

    Names are distinct ignoring case, as some file systems require.

    Examples
    --------
    >>> plain_names(["a1", "left/upper", "left upper"])
    {'a1': 'a1', 'left/upper': 'left_upper', 'left upper': 'left_upper_2'}
    """
    return _distinct({name: identifier(name, r"\w-", "sensor") for name in names})


def _distinct(names: dict[str, str]) -> dict[str, str]:
    """Return names with a number appended where one is taken already, by the same keys."""
    distinct: dict[str, str] = {}
    taken: set[str] = set()
    numbers: dict[str, int] = {}
    for key, name in names.items():
        candidate = name
        while candidate.lower() in taken:
            numbers[name.lower()] = numbers.get(name.lower(), 1) + 1
            candidate = f"{name}_{numbers[name.lower()]}"
        taken.add(candidate.lower())
        distinct[key] = candidate
    return distinct


def identifier(
    name: str, allowed: str, otherwise: str, between: str = "_", longest: int = _LONGEST
) -> str:
    """Return a name in the characters that a program allows, of limited length.

    Parameters
    ----------
    name : str
        The given name.
    allowed : str
        Allowed ASCII characters, as in a character set of a regular expression.
    otherwise : str
        Replacement for a name without allowed characters; also the prefix of a name that Windows
        reserves for a device.
    between : str, default "_"
        Replacement for other characters.
    longest : int, default 80
        Largest length; the name is cut at the end of a word if possible.

    Examples
    --------
    >>> (
    ...     identifier("the paper's Type 1", "A-Za-z0-9", "drop", "-"),
    ...     identifier("NUL", "A-Z", "drop"),
    ...     identifier("$&", "A-Z", "drop"),
    ... )
    ('the-paper-s-Type-1', 'drop_NUL', 'drop')
    """
    plain = re.sub(f"[^{allowed}]+", between, name, flags=re.ASCII).strip("_-") or otherwise
    if len(plain) > longest:  # at the end of a word if possible
        plain = plain[:longest].rpartition(between)[0].rstrip("_-") or plain[:longest]
    if plain.lower() in _DEVICES:
        return f"{otherwise}{between}{plain}"
    return plain


def plain_words(name: str) -> str:
    """Return a name for a comment in a file, of at most 80 characters.

    It has no characters that any of the programs could interpret.

    ASCII letters, digits and `.,'()+=%/_-` remain. So there are no line breaks, double quotes, `$`
    and `&` (variables and continuation lines of LAMMPS and Adams), `<`, `--` and `*/` (ends of
    comments).

    Examples
    --------
    >>> plain_words('a "hard" rock, 4 m --> $HOME &')
    'a hard rock, 4 m - HOME'
    """
    phrase = re.sub(r"[^A-Za-z0-9.,'()+=%/_-]+", " ", name)
    return re.sub("-{2,}", "-", phrase)[:_LONGEST].strip(" .,'+=%/_-") or "without a name"


def one_line(name: str) -> str:
    """Return a name on one line, with its printable characters, of at most 80 characters.

    Examples
    --------
    >>> one_line("a hard rock,\\ndropped")
    'a hard rock, dropped'
    """
    text = "".join(letter for letter in " ".join(name.split()) if letter.isprintable())
    if len(text) <= _LONGEST:
        return text
    return f"{text[: _LONGEST - 3]}..."
