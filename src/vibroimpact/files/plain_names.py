"""Names that people give to cases, sensors and materials, made so that no other program takes more from them than a name.

Every name on its way to a file of another program goes through here: `plain_words` where it is a remark, `plain_names` where it is a
file's, a group's or a column's, `identifier` where the program calls something by it, and `one_line` where people alone read it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 80
# files of these names can't be made on Windows, whatever their endings
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Return for each name one that can be a file's and a group's: letters, digits and a few signs, and no two alike.

    Two that differ in capitals alone are alike, as they are to some file systems.

    Examples
    --------
    >>> plain_names(["a1", "left/upper", "left upper"])
    {'a1': 'a1', 'left/upper': 'left_upper', 'left upper': 'left_upper_2'}
    """
    return _apart({name: identifier(name, r"\w-", "sensor") for name in names})


def _apart(wanted: dict[str, str]) -> dict[str, str]:
    """Return the names that are wanted, numbered where another has it already."""
    found: dict[str, str] = {}
    taken: set[str] = set()
    numbers: dict[str, int] = {}
    for name, plain in wanted.items():
        tried = plain
        while tried.lower() in taken:
            numbers[plain.lower()] = numbers.get(plain.lower(), 1) + 1
            tried = f"{plain}_{numbers[plain.lower()]}"
        taken.add(tried.lower())
        found[name] = tried
    return found


def identifier(name: str, allowed: str, otherwise: str, between: str = "_", longest: int = _LONGEST) -> str:
    """Return a name in letters that a program allows, and not too many of them.

    Parameters
    ----------
    name : str
        The name that was given.
    allowed : str
        ASCII letters that may be in it, as in a set of a regular expression.
    otherwise : str
        What it is called where nothing is left of the name; also put before a name that Windows keeps for a device.
    between : str, default "_"
        What stands for all else.
    longest : int, default 80
        How many letters it has at most; it ends with a whole word where it can.

    Examples
    --------
    >>> identifier("the paper's Type 1", "A-Za-z0-9", "drop", "-"), identifier("NUL", "A-Z", "drop"), identifier("$&", "A-Z", "drop")
    ('the-paper-s-Type-1', 'drop_NUL', 'drop')
    """
    plain = re.sub(f"[^{allowed}]+", between, name, flags=re.ASCII).strip("_-") or otherwise
    if len(plain) > longest:  # where a word ends, if there is one
        plain = plain[:longest].rpartition(between)[0].rstrip("_-") or plain[:longest]
    return f"{otherwise}{between}{plain}" if plain.lower() in _DEVICES else plain


def plain_words(name: str) -> str:
    """Return a name for a remark in a file: what could mean anything to any program is left out, and what is longer than 80 letters.

    There remain ASCII letters and digits with `.,'()+=%/_-` between them. So there are no line breaks, no quotes that a program would
    pair, no `$` and `&` (variables and continued lines of LAMMPS and Adams), no `<`, `--` and `*/` (ends of comments).

    Examples
    --------
    >>> plain_words('a "hard" rock, 4 m --> $HOME &')
    'a hard rock, 4 m - HOME'
    """
    words = re.sub(r"[^A-Za-z0-9.,'()+=%/_-]+", " ", name)
    return re.sub("-{2,}", "-", words)[:_LONGEST].strip(" .,'+=%/_-") or "without a name"


def one_line(name: str) -> str:
    """Return a name as people read it: in its own letters, on one line, no longer than 80 letters.

    Examples
    --------
    >>> one_line("a hard rock,\\ndropped")
    'a hard rock, dropped'
    """
    text = "".join(letter for letter in " ".join(name.split()) if letter.isprintable())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
