"""The console of the command line: what it prints has stand-ins for letters that the terminal lacks."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from vibroimpact.report.encodable import encodable


class TerminalConsole(Console):
    """A console whose texts are wrapped after letters that the terminal lacks have got their stand-ins."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Return what a renderable comes to, a text in letters that the terminal has."""
        if isinstance(renderable, Text):
            words = encodable(renderable.plain, self.encoding)
            if words != renderable.plain:
                renderable = Text(words, renderable.style, justify=renderable.justify, overflow=renderable.overflow)
        return super().render(renderable, options)
