"""A printed value beside the computed one: how far rounding reaches, what the verdict is,
and how a table shows it.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal
from html import escape
from typing import Any, get_args

import pytest
from markdown_it import MarkdownIt

from vibroimpact.errors import InputError
from vibroimpact.paper import printed as library
from vibroimpact.paper.printed import (
    PrintedValue,
    Relation,
    Role,
    corrections,
    printed,
    printed_values,
)
from vibroimpact.paper.report.markdown import (
    allowed_text,
    computed_text,
    difference_text,
    escape_markdown,
    printed_text,
    rows_table,
    section_text,
    table,
    verdict_text,
)
from vibroimpact.paper.report_section import (
    ComparedValue,
    Explanation,
    Kind,
    ReportSection,
    TextTable,
    Verdict,
)


def value(
    text: str, relation: Relation = "=", digits: int | None = None, unit: str = "m"
) -> PrintedValue:
    return PrintedValue("a.value", "a value", text, unit, "section 1", "text", relation, digits)


def row(computed: float, text: str = "2.5", relation: Relation = "=", **more: Any) -> ComparedValue:
    return ComparedValue(value(text, relation), computed, by="a calculation", **more)


# what is printed
#
#
#
# ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "digits", "half"),
    [
        ("1380", None, 0.5),
        ("0.28", None, 0.005),
        ("2.50", None, 0.005),
        ("-0.013", None, 0.0005),
        ("2.26e9", None, 5e6),
        ("5.1154524848e8", None, 0.005),
        ("6e-7", None, 5e-8),
        ("200", None, 0.5),
        ("200", 1, 50.0),
        ("200", 2, 5.0),
        ("4", 6, 5e-6),
        ("0.00001", 5, 5e-10),
        ("-31.5", 2, 0.5),
    ],
)
def test_half_a_unit_of_the_last_digit(text: str, digits: int | None, half: float) -> None:
    assert value(text, digits=digits).half == half


def test_every_value_is_whole() -> None:
    for name, held in printed_values().items():
        assert held.name == name
        assert all(
            isinstance(part, str) and part for part in (held.what, held.unit, held.place, held.read)
        ), name
        assert re.fullmatch(r"-?\d+(\.\d+)?(e-?\d+)?", held.text), name
        assert held.value == float(Decimal(held.text)), name
        assert held.relation in get_args(Relation), name
        assert held.role in get_args(Role), name
        assert held.digits is None or held.digits > 0, name
        assert "{" not in held.what, name
        assert held.half > 0.0, name


def test_every_correction_is_whole() -> None:
    assert corrections()
    for one in corrections():
        assert all((one.place, one.printed, one.right, one.why)), one
        assert one.printed != one.right, one


def test_a_list_is_held_one_by_one() -> None:
    assert [printed(f"plate.size.{number}").text for number in (1, 2, 3)] == ["520", "420", "8"]
    assert printed("plate.size.2").what.startswith("size 2 of the plate")


@pytest.mark.parametrize(
    "second", [{"name": "twice", "text": "2"}, {"name": "twice", "text": ["2", "3"]}]
)
def test_names_are_held_once(monkeypatch: pytest.MonkeyPatch, second: dict[str, Any]) -> None:
    about = {"what": "a length", "unit": "m", "place": "Table 1", "read": "table"}
    entries = [
        {"name": "twice", "text": "1", **about},
        {"name": "twice.2", "text": "1", **about},
        {**second, **about},
    ]
    monkeypatch.setattr(library, "_library", lambda: {"value": entries})
    with pytest.raises(ValueError, match=r"twice(\.2)? is held twice"):
        printed_values.__wrapped__()


def test_an_unknown_name_is_told() -> None:
    with pytest.raises(
        InputError,
        match=r'no value "type1.rebound_hight" here. Did you mean "type1.rebound_height"',
    ):
        printed("type1.rebound_hight")


# what a difference means
# ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "inside", "outside"),
    [
        ("2.41132", (2.411315, 2.41132, 2.411325), (2.4113149, 2.4113251)),
        ("-0.013", (-0.0135, -0.0125), (-0.01351, -0.01249, 0.013)),
        ("2.26e9", (2.255e9, 2.265e9), (2.2549e9, 2.2651e9)),
    ],
)
def test_a_value_is_reproduced_up_to_half_a_unit(
    text: str, inside: tuple[float, ...], outside: tuple[float, ...]
) -> None:
    assert {row(computed, text).verdict for computed in inside} == {Verdict.REPRODUCED}
    assert {row(computed, text).verdict for computed in outside} == {Verdict.NOT_REPRODUCED}


@pytest.mark.parametrize(
    ("relation", "computed", "verdict"),
    [
        ("<", 2.49, Verdict.REPRODUCED),
        ("<", 2.5, Verdict.NOT_REPRODUCED),
        ("<", 2.51, Verdict.NOT_REPRODUCED),
        (">", 2.51, Verdict.REPRODUCED),
        (">", 2.5, Verdict.NOT_REPRODUCED),
        (">", 2.49, Verdict.NOT_REPRODUCED),
    ],
)
def test_a_bound_is_kept_or_not(relation: Relation, computed: float, verdict: Verdict) -> None:
    assert row(computed, relation=relation, tolerance=1.0).verdict == verdict


@pytest.mark.parametrize("relation", get_args(Relation))
def test_what_is_not_a_number_is_never_reproduced(relation: Relation) -> None:
    assert row(math.nan, relation=relation).verdict == Verdict.NOT_REPRODUCED


def test_a_tolerance_takes_the_place_of_the_digits() -> None:
    assert row(2.6).verdict == Verdict.NOT_REPRODUCED
    assert row(2.6, tolerance=0.1).verdict == Verdict.REPRODUCED
    assert row(2.54, tolerance=0.01).verdict == Verdict.NOT_REPRODUCED
    assert (row(2.6).allowed, row(2.6, tolerance=0.1).allowed) == (0.05, 0.1)


@pytest.mark.parametrize(
    ("low", "high", "holds"),
    [
        (2.0, 3.0, True),
        (2.5625, 3.0, False),  # half a unit of 2.5 is 0.05
        (2.53125, 3.0, True),
        (2.0, 2.4375, False),
        (2.0, 2.46875, True),
        (math.nan, 3.0, False),
        (3.0, 2.0, False),
    ],
)
def test_an_account_holds_if_the_printed_value_lies_in_its_range(
    low: float, high: float, holds: bool
) -> None:
    explanation = Explanation("read off samples", low, high)
    assert explanation.holds(value("2.5")) == holds
    found = row(9.0, explanations=(explanation,), otherwise="unknown")
    assert found.verdict == (Verdict.EXPLAINED if holds else Verdict.NOT_REPRODUCED)
    assert found.reason == ("read off samples" if holds else "unknown")


def test_the_first_account_that_holds_counts() -> None:
    fails, first, second = (
        Explanation("fails", 0.0, 1.0),
        Explanation("first", 2.0, 3.0),
        Explanation("second", 2.0, 3.0),
    )
    assert row(9.0, explanations=(fails, first, second)).reason == "first"
    assert row(9.0, explanations=(fails,)).reason == ""


def test_what_agrees_needs_no_reason() -> None:
    agrees = row(
        2.5, explanations=(Explanation("read off samples", 2.0, 3.0),), otherwise="unknown"
    )
    assert agrees.verdict == Verdict.REPRODUCED
    assert agrees.explanation is None
    assert agrees.reason == ""


@pytest.mark.parametrize("computed", [2.5, 9.0])
def test_what_was_fitted_proves_nothing(computed: float) -> None:
    found = row(
        computed,
        explanations=(Explanation("read off samples", 2.0, 3.0),),
        otherwise="unknown",
        fitted=True,
    )
    assert found.verdict == Verdict.FITTED
    assert found.reason == ""
    assert verdict_text(found) == "fitted"


# how it is shown
#
#
#
# ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("held", "shown"),
    [
        (value("-0.013", unit="%"), "\u22120.013\u00a0%"),
        (value("2.1e11", unit="Pa"), "2.1·10¹¹\u00a0Pa"),
        (value("6e-7", "<", unit="J"), "<\u00a06·10⁻⁷\u00a0J"),
        (value("11", ">", unit="%"), ">\u00a011\u00a0%"),
        (value("0.30", unit="1"), "0.30"),
        (value("8.5", unit="N s/m"), "8.5\u00a0N\u00a0s/m"),
        (value("9.8", unit="m/s^2"), "9.8\u00a0m/s²"),
    ],
)
def test_a_printed_value_is_shown_as_printed(held: PrintedValue, shown: str) -> None:
    assert printed_text(held) == shown


@pytest.mark.parametrize(
    ("text", "computed", "digits", "shown"),
    [
        ("2.41132", 2.4113190123, 13, "2.411319\u00a0m"),
        ("0.00001", 1e-4, 13, "0.0001000\u00a0m"),
        ("-0.189", -0.18912, 13, "\u22120.1891\u00a0m"),
        ("2.26e9", 2.26e9, 13, "2.260·10⁹\u00a0m"),
        ("3582.036", 3751.3724, 4, "3751\u00a0m"),
    ],
)
def test_a_computed_value_has_one_digit_more(
    text: str, computed: float, digits: int, shown: str
) -> None:
    assert computed_text(row(computed, text, digits=digits)) == shown


def test_a_difference_has_its_sign_and_a_bound_has_none() -> None:
    assert difference_text(row(3.0)) == "+20\u00a0%"
    assert difference_text(row(2.0)) == "\u221220\u00a0%"
    assert difference_text(row(2.5)) == "0"
    assert difference_text(row(2.5 * (1.0 + 1e-12))) == "below 1·10⁻⁷\u00a0%"
    assert difference_text(row(2.5 * (1.0 + 1e-12), tolerance=2.5e-11)) == "below 1·10⁻⁹\u00a0%"
    assert difference_text(row(-1.0, "-0.5")) == "+100\u00a0%"
    assert allowed_text(row(3.0)) == allowed_text(row(3.0, "-2.5")) == "±\u00a02\u00a0%"
    assert allowed_text(row(3.0, tolerance=0.25)) == "±\u00a010\u00a0%"
    assert (
        difference_text(row(3.0, relation="<")) == allowed_text(row(3.0, relation="<")) == "\u2013"
    )


def test_verdicts_in_words() -> None:
    assert verdict_text(row(2.5)) == "reproduced"
    assert verdict_text(row(9.0)) == "not reproduced"
    assert (
        verdict_text(row(9.0, otherwise="a mesh of our own")) == "not reproduced: a mesh of our own"
    )
    assert (
        verdict_text(row(9.0, explanations=(Explanation("read off samples", 2.0, 3.0),)))
        == "explained: read off samples"
    )


def test_a_value_is_said_once_where_several_things_compute_it() -> None:
    held, other = value("2.5"), value("2.5")
    lines = rows_table(
        [
            ComparedValue(held, 2.5, by="one"),
            ComparedValue(held, 9.0, by="another"),
            ComparedValue(other, 2.5, by="a third"),
        ]
    ).splitlines()
    said = [line.strip("|").split("|")[:4] for line in lines[2:]]
    whole = [" a value ", " section 1 ", " 2.5\u00a0m "]
    assert said == [[*whole, " one "], ["  ", "  ", "  ", " another "], [*whole, " a third "]]


@pytest.mark.parametrize("role", get_args(Role))
def test_the_role_of_a_printed_value_is_its_kind_unless_it_was_computed_otherwise(
    role: Role,
) -> None:
    held = PrintedValue("a.value", "a value", "2.5", "m", "section 1", "text", role=role)
    assert ComparedValue(held, 2.5, by="a calculation").kind.value == role
    assert (
        ComparedValue(held, 2.5, by="a model", made_by=Kind.FITTED_MODEL).kind == Kind.FITTED_MODEL
    )
    (line,) = rows_table(
        [ComparedValue(held, 2.5, by="a sum", made_by=Kind.ARITHMETIC)]
    ).splitlines()[2:]
    assert line.endswith("| arithmetic | reproduced |")


@pytest.mark.parametrize(
    "text", ["a|b", "*a* and _b_", "a \\| b", "1 < 2 <b>", "[a](b)", "`a`", "\u22122\u00a0%"]
)
def test_words_come_through_markdown_as_they_stand(text: str) -> None:
    page = MarkdownIt("commonmark", {"html": False}).enable("table")
    assert page.render(escape_markdown(text)).strip() == f"<p>{escape(text)}</p>"
    assert page.render(table((text, "b"), [("a", text)])).count(escape(text)) == 2
    assert page.render(table((text, "b"), [("a", text)])).count("<td>") == 2


def test_a_section_keeps_its_order() -> None:
    further = TextTable(("one", "two"), (("1", "2"),), "Further")
    text = section_text(
        ReportSection("A title", ("First.", "Second."), (row(2.5),), (further,), ("At last.",))
    )
    pieces = [
        "### A title\n",
        "First.\n",
        "Second.\n",
        "| What |",
        "**Further**\n",
        "| one | two |",
        "At last.\n",
    ]
    assert sorted(pieces, key=text.index) == pieces
    assert section_text(ReportSection("A title", ("First.",))) == "### A title\n\nFirst.\n"
