"""What the command recognise prints."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.recognition.apply import Recognised
from vibroimpact.recognition.recognise import Recognition
from vibroimpact.recognition.tables import SCORE_HEADERS, score_cells, sentences
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, numbers


def recognition_summary(found: Recognition) -> RenderableType:
    """Return the console report of a recognition: a row for each classifier, what they
    say, and the doubts.
    """
    names, *cells = zip(*score_cells(found), strict=True)
    headings = [(one, "") if isinstance(one, str) else one for one in SCORE_HEADERS[1:]]
    columns = [
        numbers(heading, unit, one) for (heading, unit), one in zip(headings, cells, strict=True)
    ]
    table = TerminalTable(
        [TerminalColumn("Classifier", names, text=True), *columns], bold=[names.index(found.best)]
    )
    title = (
        f"{found.name}: {found.groups} {found.group}s, {found.folds} folds, {len(found.seeds)} "
        f"seed{'s' if len(found.seeds) > 1 else ''}"
    )
    return Group(
        Text(title, style="bold"),
        table,
        Text(),
        *(Text(f" {one}") for one in sentences(found)),
        *_doubts(found.doubts),
    )


def recognised_summary(found: Recognised) -> RenderableType:
    """Return the console report of signals that a saved model was applied to: the
    fraction of each class, and the doubts.
    """
    columns = [
        TerminalColumn("Class", found.class_names, text=True),
        numbers("Counted", "%", [f"{100.0 * one:.1f}" for one in found.counted]),
        numbers("Fraction", "%", [f"{100.0 * one.value:.1f}" for one in found.fractions.values()]),
        numbers(
            "95 % interval",
            "%",
            [
                f"{100.0 * one.low:.1f} to {100.0 * one.high:.1f}"
                for one in found.fractions.values()
            ],
        ),
    ]
    title = Text(
        f"{found.name}: {len(found.probabilities)} signals, classified by {found.classifier}",
        style="bold",
    )
    words = (
        []
        if found.accuracy is None
        else [Text(f" Balanced accuracy {found.accuracy:.1%}, by the classes in the data set.")]
    )
    return Group(title, TerminalTable(columns), *words, *_doubts(found.doubts))


def _doubts(doubts: tuple[str, ...]) -> list[Text]:
    return [Text(f" Doubt: {doubt}.", style="yellow") for doubt in doubts]
