"""Sections of a Gmsh mesh file, from $Name to $EndName."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator

from vibroimpact.meshes.text_files import TextLine
from vibroimpact.quoting import quoted


class GmshSection:
    """The lines of a section, read in turn and split into words."""

    def __init__(self, line: TextLine) -> None:
        self.line = line
        self.body: list[TextLine] = []
        self._next = 0

    @property
    def has_more(self) -> bool:
        """Whether lines remain to be read."""
        return self._next < len(self.body)

    def words(self, least: int) -> tuple[TextLine, list[str]]:
        """Return the next line and its words.

        Raises
        ------
        InputError
            If there is no line, or it has fewer words than `least`.
        """
        if not self.has_more:
            raise self.line.wrong(
                f"{self.line.text.strip()} ends too soon; the file is cut short or its "
                "counts are wrong"
            )
        line = self.body[self._next]
        self._next += 1
        entries = line.text.split()
        if len(entries) < least:
            raise line.wrong(
                f"the line has {len(entries)} of the {least} entries that it must have"
            )
        return line, entries

    def take(self, count: int, least: int) -> Iterator[tuple[TextLine, list[str]]]:
        """Yield the next `count` lines and their words.

        Raises
        ------
        InputError
            If there are fewer lines, or one has fewer words than `least`.
        """
        remaining = len(self.body) - self._next
        if count > remaining:
            are = "is" if remaining == 1 else "are"
            raise self.line.wrong(
                f"{self.line.text.strip()} states {count} lines where {remaining} {are} left; "
                "the file is truncated or its counts are wrong"
            )
        for _ in range(count):
            yield self.words(least)

    def end(self) -> None:
        """Check that all lines were read.

        Raises
        ------
        InputError
            If lines remain.
        """
        if self.has_more:
            raise self.body[self._next].wrong(
                f"{self.line.text.strip()} has more lines than it states; the two must agree"
            )


def sections(
    lines: Iterable[TextLine], known: Collection[str], skipped: Counter[str]
) -> dict[str, GmshSection]:
    """Return the known sections by name, and count the others.

    Raises
    ------
    InputError
        If a section has no end or occurs twice, or there is text outside sections.
    """
    by_name: dict[str, GmshSection] = {}
    name = ""
    section: GmshSection | None = None  # that is being read
    for line in lines:
        text = line.text.strip()
        if not text:
            continue
        if section is None:
            if not text.startswith("$"):
                raise line.wrong(
                    f"{quoted(text)} stands outside a section; a mesh file of Gmsh has "
                    "sections from $Name to $EndName"
                )
            name = text[1:]
            section = GmshSection(line)
        elif text == f"$End{name}":
            if name not in known:
                skipped[f"${name}"] += 1
            elif name in by_name:
                raise section.line.wrong(f"this is a second ${name}; a file may have only one")
            else:
                by_name[name] = section
            section = None
        else:
            section.body.append(line)
    if section is not None:
        raise section.line.wrong(
            f"{quoted('$' + name)} has no {quoted('$End' + name)}; the file is cut short, or its "
            "format is none of 2, 4.0 and 4.1"
        )
    return by_name
