"""Terminal output of the calibrate command for a record of bounces."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.tables import (
    contact_sentence,
    drop_sentence,
    impact_cells,
    law_sentences,
    other_sentences,
)
from vibroimpact.calibration.inputs import inputs_sentence
from vibroimpact.calibration.text import cells_table


def bounce_summary(found: Rebounds) -> RenderableType:
    """Return the impacts, the fits, what else is heard and the warnings."""
    parts: list[RenderableType] = [
        Text(found.bounces.record.name, style="bold"),
        Text(f"{len(found.bounces.time)} touches of a bouncing ball"),
        Text(),
        cells_table(impact_cells(found)),
        Text(),
        Text("Restitution over the approach speed", style="bold"),
        *(Text(f" {sentence}") for sentence in law_sentences(found)),
        Text(),
        Text(drop_sentence(found)),
        Text(contact_sentence(found)),
        Text(inputs_sentence(found.inputs)),
        *(Text(sentence) for sentence in other_sentences(found)),
    ]
    parts += [Text(), *(Text(f"Doubt: {doubt}.") for doubt in found.doubts)] if found.doubts else []
    return Group(*parts)
