"""What the paper prints wrongly or leaves out."""

from __future__ import annotations

from vibroimpact.paper.printed import corrections
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.section import Section, Table


def misprints(runs: Runs) -> Section:
    """Return the corrections, which everything else here builds on."""
    cells = tuple((item.place, item.printed, item.right, item.why) for item in corrections())
    return Section(
        "What the paper prints wrongly, or leaves out",
        ("Everything above was computed with these corrections.",),
        tables=(Table(("Place", "Printed", "Right", "How that is known"), cells),),
    )
