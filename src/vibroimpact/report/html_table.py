"""A table as a piece of HTML without styles and scripts, as notebooks show it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from markupsafe import Markup

from vibroimpact.quoting import visible


def html_table(
    headers: Sequence[str | tuple[str, str]], rows: Iterable[Sequence[str] | str]
) -> Markup:
    """Return a table as HTML; texts are escaped.

    Parameters
    ----------
    headers : sequence of str or tuple of str
        Header of each column: a text, or a text and a unit, which may be empty.
    rows : iterable
        Cells of each row, or a text that spans all columns.

    Examples
    --------
    >>> print(html_table(["Key", ("Force", "N")], [["a", "1"]]))
    <table><thead><tr><th>Key</th><th>Force<br>[N]</th></tr></thead><tbody><tr><td>a</td><td>1</td></tr></tbody></table>
    """
    head = _joined(_header(header) for header in headers)
    lines = []
    for row in rows:
        if isinstance(row, str):  # over the whole width
            cells = Markup('<td colspan="{}">{}</td>').format(len(headers), visible(row))
        else:
            cells = _cells(row)
        lines.append(Markup("<tr>{}</tr>").format(cells))
    body = _joined(lines)
    return Markup("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>").format(head, body)


def _header(header: str | tuple[str, str]) -> Markup:
    if isinstance(header, str):
        return Markup("<th>{}</th>").format(visible(header))
    name, unit = header
    bracketed = f"[{visible(unit)}]" if unit else ""
    return Markup("<th>{}<br>{}</th>").format(visible(name), bracketed)


def _cells(row: Sequence[str]) -> Markup:
    return _joined(Markup("<td>{}</td>").format(visible(cell)) for cell in row)


def _joined(parts: Iterable[Markup]) -> Markup:
    return Markup("").join(parts)
