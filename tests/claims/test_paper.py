"""What the pages say about the reproduction of the paper, counted on its page and computed again.

The page itself is compared with a whole reproduction in tests/published/test_reproduction_page.py.
"""

from __future__ import annotations

import re
from functools import cache

import vibroimpact as vi
from stated_numbers import ROOT, says
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report.counts import range_widths
from vibroimpact.paper.report.outline import PARTS, RenderedPart, render_part
from vibroimpact.paper.runs import Runs

GUIDE = "docs/guides/reproduce-the-paper.md"
PAGE = "docs/reproduction.md"
README = "README.md"


@cache
def runs() -> Runs:
    return Runs()


@cache
def counts() -> dict[str, dict[str, int]]:
    """The numbers of verdicts by the kind of the comparison, in the first table of the
    page of the reproduction.
    """
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    headers, _, *lines = re.search(r"^\| Kind \|.*?(?=^$)", text, re.M | re.S)[0].splitlines()  # type: ignore[index]
    verdicts, *kinds = (
        [cell.strip().lower() for cell in line.strip("|").split("|")] for line in (headers, *lines)
    )
    return {
        kind: dict(zip(verdicts[1:], map(int, numbers), strict=True)) for kind, *numbers in kinds
    }


def by_verdict(kind: str) -> list[int]:
    return list(counts()[kind].values())


def test_the_guide_counts_each_kind() -> None:
    result, inferred, model, arithmetic, taken = (by_verdict(kind) for kind in counts())
    says(GUIDE, "computed without the printed value | {} | {} | {} | {} |", *result)
    says(GUIDE, "from which they were inferred | {} | {} | {} | {} |", *inferred)
    says(GUIDE, "fitted to printed results of Type 2 | {} | {} | {} | {} |", *model)
    says(GUIDE, "from other printed results | {} | {} | {} | {} |", *arithmetic)
    says(GUIDE, "input of the paper | {} | {} | {} | {} |", *taken)
    says(GUIDE, "Its {} agreements are the contact stiffness", result[0])
    says(GUIDE, "All {} results that are not reproduced are of these", result[-1])


def test_the_front_page_counts_results() -> None:
    met, explained, _, missed = by_verdict("result")
    total = met + explained + missed
    says(
        README,
        "Of the {} comparisons with its results {} agree as printed: "
        "the contact stiffness, four numbers",
        total,
        met,
    )
    assert met == 1 + 4 + 8
    says(
        README,
        "A further {}, among them all other results of rigid bodies, differ, but a hypothesis",
        explained,
    )
    says(
        README,
        "such as peaks read from samples; {}, all of elastic bodies, agree with nothing",
        missed,
    )


def test_results_that_are_not_reproduced_are_of_elastic_bodies() -> None:
    """No result of rigid bodies is missed, so that all that are missed are of the others."""
    rigid = [
        row
        for part in ("section3.1", "section3.2", "damping", "table2")
        for row in render_part(PARTS[part], runs()).rows
    ]
    assert not [
        row for row in rigid if (row["kind"], row["verdict"]) == ("result", "not reproduced")
    ]


def test_force_and_acceleration_of_type_1() -> None:
    impacts = runs().response("type1-variable").impacts
    more = {
        name: 100 * (impacts[column][0] / printed(f"type1.{name}").value - 1)
        for name, column in COLUMNS.items()
    }
    for off in more.values():
        says(GUIDE, "The largest force and acceleration are {} % larger than printed", off)
        says(PAGE, "Force and acceleration are not met: the computed ones are {} % larger", off)


COLUMNS = {"max_force": "max_force_N", "max_acceleration": "max_acceleration_m_s2"}


def test_ranges_of_table_2() -> None:
    rows = [
        row for row in render_part(PARTS["table2"], runs()).rows if row["verdict"] == "explained"
    ]
    assert (
        len(rows)
        == range_widths({"table2": RenderedPart("", "", rows, None)})["table2"].number
        == 20
    )
    width = [row["range_high"] - row["range_low"] for row in rows]
    error = [float(row["printed"]) for row in rows]
    says(GUIDE, "with ranges {} to {} percentage points wide", min(width), max(width))
    says(GUIDE, "percentage points wide for errors of {} to {} %", min(error), max(error))
    says(PAGE, "by ranges {} to {} percentage points wide", min(width), max(width))


def test_the_drop_that_the_guide_describes() -> None:
    case = vi.load_case("paper:type1-theory")
    problem, impacts = case.to_problem(), vi.simulate(case).impacts
    says(GUIDE, "a rock sphere of {} mm radius", 1e3 * problem.sphere.contact_offset)
    says(GUIDE, "five rebounds, the first to {} m", impacts["rebound_height_m"][0])
    says(GUIDE, "Its numbers are those of {}, which is the parameter", problem.laws[0].restitution)
    says(GUIDE, "the sphere rebounds with {}", impacts["restitution_achieved"][0])
    says(
        GUIDE,
        "The full-damping penetration is printed as {} mm",
        1e3 * printed("full_damping_penetration").value,
    )
    penetration = vi.load_case("paper:type1-variable").to_problem().laws[0].full_damping_penetration
    says(GUIDE, "The printed rebounds of rigid bodies are those for {} mm", 1e3 * penetration)
    higher = vi.simulate(vi.load_case("paper:type1-theory", {"drop.height": "6 m"})).impacts
    says(
        GUIDE,
        "# {}: force grows as speed^1.2",
        higher["max_force_N"][0] / impacts["max_force_N"][0],
    )
