"""What a run says of impacts that can't be predicted: digits, doubts, keys."""

from __future__ import annotations

import re
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

import vibroimpact as vi
from support import plain_case
from vibrating import STIFFNESS, drop_on, random_modes
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.results.result import Result, result_of
from vibroimpact.results.summary import summary_of
from vibroimpact.runs.history_charts import ACCELERATION, FORCE, POSITION, VELOCITY
from vibroimpact.runs.tables import impact_table

CHANGES = np.array([1e-9, 2e-3, 0.1, 10.0])


@pytest.fixture(scope="module")
def undamped() -> Result:
    result = result_of(
        vi.simulate(
            drop_on(
                Hertz(stiffness=STIFFNESS),
                random_modes(3, 10, 150.0, 15e3, 1.2),
                speed=3.0,
                impacts=4,
            )
        )
    )
    return replace(result, impacts={**result.impacts, "sensitivity": CHANGES / 1e-9})


def printed(result: Result, width: int = 140) -> list[list[str]]:
    """Return the words of the name and of the lines from the head of the table on."""
    written = StringIO()
    Console(width=width, file=written).print(terminal_report(result.report))
    lines = [line.split() for line in written.getvalue().splitlines()]
    units = next(number for number, line in enumerate(lines) if line[:1] == ["#"])
    return [lines[0], *lines[units - 1 :]]


def test_the_terminal_prints_only_digits_that_are_there(undamped: Result) -> None:
    heads, rows = printed(undamped)[1:3], printed(undamped)[3:7]
    assert "sensitivity" in heads[1]
    force = heads[0].index("force") + 1  # after the number of the impact
    digits = [len(row[force].split("·")[0].replace(".", "").lstrip("0")) for row in rows]
    assert digits[0] == 5
    assert digits[1] == 3
    assert digits[2] == 1
    assert rows[3][force] == "?"
    # the fourth touch is as certain as what the third impact left: one digit
    assert len(rows[3][1].split("·")[0].replace(".", "").lstrip("0")) == 1


def test_the_page_prints_only_digits_that_are_there(undamped: Result) -> None:
    table = impact_table(undamped)
    headers, rows = table.headings, table.rows
    force, time = (
        next(place for place, (name, _) in enumerate(headers) if name == wanted)
        for wanted in ("Largest force", "First touch")
    )
    assert [row[force] for row in rows][3] == "?"
    assert len(rows[1][force].replace(".", "").lstrip("0")) == 3
    # as certain as what the first impact left
    assert rows[1][time] == f"{1e3 * undamped.impacts['time_s'][1]:.3f}"
    assert headers[-1] == ("Sensitivity", "")


def test_the_figures_print_only_digits_that_are_there(undamped: Result) -> None:
    assert undamped.change_by_impact[3] > 0.3
    for quantity in (POSITION, FORCE, VELOCITY, ACCELERATION):
        headlines = [quantity.headline(undamped, impact) for impact in range(4)]
        assert "?" not in headlines[0]
        assert "?" in headlines[3]
    assert len(re.sub(r"\D", "", FORCE.headline(undamped, 1)).lstrip("0")) == 3


@pytest.mark.parametrize("width", [60, 80, 100, 130, 160])
def test_a_narrow_terminal_has_fewer_columns_and_whole_numbers(
    undamped: Result, width: int
) -> None:
    lines = printed(undamped, width)
    assert all("\u2026" not in word for line in lines for word in line)
    assert [line[0] for line in lines[2:7]] == ["#", "1", "2", "3", "4"]
    assert {"time", "force"} < set(lines[1])
    assert "sensitivity" in lines[2]
    assert ("indentation" in lines[1]) == (width > 80)


@pytest.mark.parametrize(
    ("sphere", "damping", "asked"),
    [
        ("rigid", None, "give the plate its damping, or judge"),
        ("elastic", None, "give the plate and the sphere their damping, or judge"),
        ("elastic", 0.02, "give the sphere its damping, or judge"),
        ("rigid", 0.02, "predictable; judge"),
    ],
)
def test_only_what_has_no_damping_is_asked_for_it(
    sphere: str, damping: float | None, asked: str
) -> None:
    plate = {
        "model": "elastic",
        "material": "steel",
        "size": [0.3, 0.2, 0.01],
        "supports": "clamped",
        "damping": damping,
    }
    case = resolved_case(
        vi.case_of(
            plain_case(
                sphere__model=sphere, plate={key: value for key, value in plate.items() if value}
            )
        )
    )
    (found,) = (
        doubt
        for doubt in doubts(case, DropSummary(changes=np.array([1e-9, 0.5])))
        if "sensitive" in doubt
    )
    assert asked in found
    assert found.endswith("them by their distribution in a study over drop.height")


def test_the_study_is_over_what_the_case_gives() -> None:
    case = resolved_case(vi.case_of(plain_case(drop={"speed": 1.0})))
    (found,) = (
        doubt
        for doubt in doubts(case, DropSummary(changes=np.array([1e-9, 0.5])))
        if "sensitive" in doubt
    )
    assert found.endswith("in a study over drop.speed")


def test_a_drop_that_is_not_sensitive_is_printed_as_before(variable: vi.Response) -> None:
    result = result_of(variable)
    assert not result.change_by_impact.any()
    assert not any("sensi-" in line for line in printed(result))
    assert "change_by_impact" not in summary_of(result)


def test_the_doubt_names_the_impact_and_the_remedy(undamped: Result) -> None:
    (found,) = (doubt for doubt in undamped.doubts if "sensitive" in doubt)
    assert "from impact 2 on" in found
    assert "to 0.2 % of impact 2 and to 30 % or more of impact 4" in found
    assert "damping" in found
    assert not doubts({}, DropSummary(changes=np.array([1e-9, 5e-4])))
    assert (
        "grows to 30 % or more of impact 1,"
        in doubts({}, DropSummary(changes=np.array([np.inf])))[0]
    )


def test_a_loose_tolerance_counts(undamped: Result) -> None:
    loose = replace(undamped, provenance={"tolerance": "1e-06"})
    assert loose.change_by_impact == pytest.approx(1e3 * CHANGES)


def test_the_summary_has_it(undamped: Result) -> None:
    summary = summary_of(undamped)
    assert summary["change_by_impact"] == pytest.approx(CHANGES)
    assert [row["sensitivity"] for row in summary["impacts"]] == pytest.approx(CHANGES / 1e-9)
    endless = replace(
        undamped, impacts={**undamped.impacts, "sensitivity": np.array([1.0, np.inf, np.nan, 1.0])}
    )
    assert summary_of(endless)["change_by_impact"][1:3] == [None, None]
