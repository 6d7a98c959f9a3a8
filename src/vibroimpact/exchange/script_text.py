"""Names and comments of the files that are written for other programs."""

from __future__ import annotations

import re

from vibroimpact.exchange.drop import Drop


def file_name(drop: Drop, ending: str) -> str:
    """Return a file name made of the drop's name and an ending.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> file_name(SimpleNamespace(name="the paper's Type 1"), ".in")
    'the-paper-s-type-1.in'
    """
    words = re.findall(r"[a-z0-9]+", drop.name.lower())
    return f"{'-'.join(words) or 'drop'}{ending}"


def one_line(text: str) -> str:
    """Return a text without line breaks and double quotes, for a comment.

    Examples
    --------
    >>> one_line('a "hard" rock,\\ndropped')
    "a 'hard' rock, dropped"
    """
    return "".join(letter for letter in " ".join(text.split()) if letter.isprintable()).replace('"', "'")


def comment_lines(notes: list[str]) -> str:
    """Return notes as comment lines of a script.

    Examples
    --------
    >>> comment_lines(["one thing", "another"])
    '# one thing\\n# another'
    """
    return "\n".join(f"# {note}" for note in notes)
