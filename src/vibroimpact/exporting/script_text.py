"""Names and comments of the files that are written for other programs."""

from __future__ import annotations

from vibroimpact.exporting.drop import Drop
from vibroimpact.files.plain_names import identifier


def file_name(drop: Drop, ending: str) -> str:
    """Return a file name made of the drop's name and an ending.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> file_name(SimpleNamespace(name="the paper's Type 1"), ".in")
    'the-paper-s-type-1.in'
    """
    return f"{identifier(drop.name.lower(), 'a-z0-9', 'drop', '-')}{ending}"


def comment_lines(notes: list[str]) -> str:
    """Return notes as comment lines of a script.

    Examples
    --------
    >>> comment_lines(["one thing", "another"])
    '# one thing\\n# another'
    """
    return "\n".join(f"# {note}" for note in notes)
