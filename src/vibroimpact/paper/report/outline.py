"""The parts of the reproduction, in the order of its report."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.paper.conclusions import conclusions
from vibroimpact.paper.coupled import section_5_1
from vibroimpact.paper.energies import section_5_2
from vibroimpact.paper.inputs import section_3_1, section_4, table1
from vibroimpact.paper.misprints import misprints
from vibroimpact.paper.recovery_section import recovery
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.report.paper_figures import PAPER_FIGURES
from vibroimpact.paper.report.recovery_figure import draw_recovery
from vibroimpact.paper.report.sampling_figure import draw_sampling
from vibroimpact.paper.report.unresolved_figure import draw_unresolved
from vibroimpact.paper.rigid import damping, section_3_2
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.sampling import sampling
from vibroimpact.paper.section import Section
from vibroimpact.paper.table2 import table2
from vibroimpact.paper.unresolved import unresolved
from vibroimpact.paper.vibration import section_5_3
from vibroimpact.registry import find_named


class Part(NamedTuple):
    """A part of the reproduction: words and numbers, a figure, or both.

    Parameters
    ----------
    name : str
        What `--only` calls it.
    section : callable, optional
        Makes the words and numbers.
    draw : callable, optional
        Draws the figure.
    """

    name: str
    section: Callable[[Runs], Section] | None = None
    draw: Callable[[Runs], Drawing] | None = None


def _figures(first: int, last: int) -> tuple[Part, ...]:
    names = [f"fig{number}" for number in range(first, last + 1)]
    return tuple(Part(name, draw=PAPER_FIGURES[name]) for name in names)


CHAPTERS: dict[str, tuple[Part, ...]] = {
    "The inputs": (Part("table1", table1), Part("section3.1", section_3_1), *_figures(3, 3)),
    "Type 1: repeated impacts of rigid bodies": (
        Part("section3.2", section_3_2),
        *_figures(4, 8),
        Part("damping", damping),
        Part("table2", table2),
    ),
    "Types 1, 2 and 3: elastic bodies": (Part("section4", section_4), *_figures(9, 9), Part("section5.1", section_5_1), *_figures(10, 13)),
    "The energy of the sphere": (Part("section5.2", section_5_2), *_figures(14, 17)),
    "The vibration of the plate": (Part("section5.3", section_5_3), *_figures(18, 23)),
    "The conclusions": (Part("conclusions", conclusions),),
    "Forensics: what the numbers tell that the text does not": (
        Part("recovery", recovery, draw_recovery),
        Part("sampling", sampling, draw_sampling),
        Part("unresolved", unresolved, draw_unresolved),
    ),
    "Corrections": (Part("corrections", misprints),),
}
"""The chapters of the report, and the parts of each."""

PARTS: dict[str, Part] = {part.name: part for parts in CHAPTERS.values() for part in parts}
"""All parts by their names, in the order of the report."""


def find_parts(names: Iterable[str]) -> list[Part]:
    """Return the parts of some names, in the order of the report.

    Raises
    ------
    InputError
        If there is no part of a name, or no name.

    Examples
    --------
    >>> [part.name for part in find_parts(["fig4", "table1"])]
    ['table1', 'fig4']
    """
    wanted = {find_named("part", name, PARTS).name for name in sorted(set(names))}
    if not wanted:
        raise InputError(f"name at least one of {', '.join(PARTS)}")
    return [part for name, part in PARTS.items() if name in wanted]
