"""What precedes the chapters of the report: what is compared, and the counts of verdicts."""

from __future__ import annotations

from collections.abc import Mapping

from vibroimpact.paper.printed import PAPER
from vibroimpact.paper.report.blocks import text_table
from vibroimpact.paper.report.counts import kind_counts, range_widths, verdict_counts
from vibroimpact.paper.report.outline import RenderedPart
from vibroimpact.paper.report_section import Verdict
from vibroimpact.report.report import Block, Facts, Paragraph
from vibroimpact.units.display import digits

OPENING: tuple[Block, ...] = (
    Paragraph(
        f"The numbers that {PAPER} prints, compared with computed ones, and its figures 3 to "
        "23, drawn from the computation. A rock sphere "
        "falls from 4 m onto a steel plate and bounces: both rigid (Type 1), the sphere elastic "
        "(Type 2), both elastic (Type 3)."
    ),
    Paragraph(
        "A value counts as reproduced if it agrees within half a unit of the last digit "
        "printed, or keeps a printed bound. It counts as "
        "explained if a hypothesis gives a value or a range with which it agrees within its "
        "digits; as fitted if the model was fitted to it, "
        "so that the agreement is no evidence; otherwise as not reproduced. The drop height and "
        "the full-damping penetration, printed with "
        "one digit, are taken as exact. The verdicts are computed. Rows are counted: a value "
        "that is computed in three ways has three rows."
    ),
    Paragraph(
        "What a verdict shows depends on the kind of the comparison, which is counted apart:"
    ),
    Facts(
        (
            (
                "result",
                "computed from the inputs of the paper, and from what was assumed or inferred from"
                " other printed numbers; the printed value itself was not used.",
            ),
            (
                "inferred",
                "the restitution of the theory is not printed, and the full-damping penetration is"
                " taken for a misprint. Both were inferred from printed numbers of this kind and "
                "then rounded. That these agree shows that two values are compatible with all of "
                "them; none of them by itself is evidence.",
            ),
            (
                "fitted model",
                "computed by a model with parameters that were fitted to printed results of Type "
                "2, the fitted ones and the others.",
            ),
            (
                "arithmetic",
                "calculated from other printed results, without a simulation; it compares the "
                "paper with itself.",
            ),
            (
                "input",
                "what the paper assumes, compared with the shipped case.",
            ),
        )
    ),
)
"""What is compared, and what a verdict shows."""

IN_SHORT = Paragraph(
    "Summary, in the interpretation of the authors of this package. Of the results printed "
    "for rigid bodies (Type 1), the contact "
    "stiffness follows from the inputs to all digits. One height, two percentages, the "
    "dampings and their function are compatible "
    "with one restitution and one full-damping penetration, which were inferred from them. "
    "Force and acceleration are not met: the "
    "computed ones are 1.3 % larger. Table 2 is not met either; it is compatible with peaks "
    "read from samples, by ranges 3.9 to 12.4 "
    "percentage points wide. The results printed for elastic bodies (Types 2 and 3) are not "
    "reproduced by any setting that was tried, "
    "neither with a consistent model nor with the superposed one of multibody programs; the "
    "results that are reproduced are bounds, or "
    "printed with one digit. An unresolved run is a hypothesis: it approximates force, "
    "rebound and strain energy of the sphere, but not "
    "its fall beyond touch, the order of the forces, or the energies of the plate."
)
"""What the whole reproduction shows."""


def summary_blocks(parts: Mapping[str, RenderedPart]) -> list[Block]:
    """Return the tables of verdicts by kind and by part, and that of the ranges; none without
    values.
    """
    by_part = verdict_counts(parts)
    if not by_part:
        return []
    verdicts = [verdict.value.capitalize() for verdict in Verdict]
    titles = {name: part.title for name, part in parts.items()}
    titles["all"] = "All"
    kinds = [_count_row(kind.capitalize(), counts) for kind, counts in kind_counts(parts).items()]
    rows = [_count_row(titles[name], counts) for name, counts in by_part.items()]
    return [
        text_table(["Kind", *verdicts], kinds),
        text_table(["Part", *verdicts], rows),
        *_range_blocks(parts),
    ]


def _count_row(title: str, counts: Mapping[str, int]) -> list[str]:
    """Return a row of a table: a title, and the number of each verdict."""
    return [title, *map(str, counts.values())]


def _range_blocks(parts: Mapping[str, RenderedPart]) -> list[Block]:
    """Return the table of the ranges that explain values; none without any."""
    rows = []
    for name, widths in range_widths(parts).items():
        ends = [f"{digits(100.0 * width, 2)} %" for width in (widths.least, widths.most)]
        rows.append([parts[name].title, str(widths.number), *ends])
    if not rows:
        return []
    headings = [
        "Part",
        "Explained",
        "Narrowest range, of the printed value",
        "Widest range, of the printed value",
    ]
    meaning = (
        "How wide the ranges are that explain a value: the wider, the less an explanation shows."
    )
    return [Paragraph(meaning), text_table(headings, rows)]
