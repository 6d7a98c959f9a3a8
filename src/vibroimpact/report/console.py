"""The console of the command line: it transliterates text to the encoding of the
terminal, and escapes control characters.
"""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from vibroimpact.quoting import visible
from vibroimpact.report.encodable import encodable


class TerminalConsole(Console):
    r"""A console that transliterates text to the encoding of the terminal, and shows control
    characters as escapes.

    Examples
    --------
    >>> from io import StringIO
    >>> screen = TerminalConsole(file=StringIO())
    >>> screen.print(Text("a\x1b[2Jb"))
    >>> print(screen.file.getvalue().rstrip())
    a\x1b[2Jb
    """

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterator[Segment]:
        """Yield the segments of a renderable."""
        if isinstance(renderable, Text):
            # before wrapping, since the width may change
            phrase = encodable(renderable.plain, self.encoding)
            if phrase != renderable.plain:
                renderable = Text(
                    phrase,
                    renderable.style,
                    justify=renderable.justify,
                    overflow=renderable.overflow,
                )
        for segment in super().render(renderable, options):
            if segment.control or segment.text.isprintable() or segment.text == "\n":
                yield segment
            else:
                yield Segment("\n".join(map(visible, segment.text.split("\n"))), segment.style)
