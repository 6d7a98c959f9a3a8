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
        self._at = 0

    @property
    def has_more(self) -> bool:
        """Whether lines remain to be read."""
        return self._at < len(self.body)

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
        line = self.body[self._at]
        self._at += 1
        words = line.text.split()
        if len(words) < least:
            raise line.wrong(f"the line has {len(words)} of the {least} entries that it must have")
        return line, words

    def take(self, count: int, least: int) -> Iterator[tuple[TextLine, list[str]]]:
        """Yield the next `count` lines and their words.

        Raises
        ------
        InputError
            If there are fewer lines, or one has fewer words than `least`.
        """
        left = len(self.body) - self._at
        if count > left:
            are = "is" if left == 1 else "are"
            words = f"{self.line.text.strip()} states {count} lines where {left} {are} left"
            raise self.line.wrong(f"{words}; the file is truncated or its counts are wrong")
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
            raise self.body[self._at].wrong(
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
    found: dict[str, GmshSection] = {}
    name, section = "", None
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
            name, section = text[1:], GmshSection(line)
        elif text == f"$End{name}":
            if name not in known:
                skipped[f"${name}"] += 1
            elif name in found:
                raise section.line.wrong(f"this is a second ${name}; a file may have only one")
            else:
                found[name] = section
            section = None
        else:
            section.body.append(line)
    if section is not None:
        cause = "the file is cut short, or its format is none of 2, 4.0 and 4.1"
        raise section.line.wrong(f"{quoted('$' + name)} has no {quoted('$End' + name)}; {cause}")
    return found
