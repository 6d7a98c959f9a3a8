"""The comparison of texts with numbers that guards the documented report: it must not let a change pass."""

from __future__ import annotations

import pytest

from same_numbers import other_numbers


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("2.41132 m", "2.41132 m"),
        ("2.41132 m", "2.41133 m"),
        ("| 5.115·10⁸ |", "| 5.116·10⁸ |"),
        ("1.20·10⁻⁷", "1.19·10⁻⁷"),
        ("\u22120.5 %", "\u22120.6 %"),
        ("0.99", "1.00"),
    ],
)
def test_rounding_may_differ_by_a_unit_of_the_last_digit(old: str, new: str) -> None:
    assert not other_numbers(old, new)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("2.41132 m", "2.41134 m"),
        ("5.115·10⁸", "5.115·10⁷"),
        ("+5.5 %", "\u22125.5 %"),
        ("reproduced", "explained"),
        ("fig4", "fig5"),
        ("a 1 b 2", "a 1 b 4"),
        ("one line", "one line\nanother"),
        ("0.5 %", "0.5"),
    ],
)
def test_anything_else_is_found(old: str, new: str) -> None:
    assert other_numbers(old, new)
    assert other_numbers(new, old)
