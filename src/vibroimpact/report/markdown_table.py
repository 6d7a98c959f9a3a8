"""Tables in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def markdown_table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown; headings and cells are inserted as Markdown, without escaping.

    Examples
    --------
    >>> print(markdown_table(("law", "ends"), [("`hertz`", "at zero")]))
    | law | ends |
    | --- | --- |
    | `hertz` | at zero |
    """
    return "\n".join(
        f"| {' | '.join(line)} |" for line in (headings, ["---"] * len(headings), *rows)
    )
