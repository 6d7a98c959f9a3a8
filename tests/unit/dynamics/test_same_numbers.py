"""The comparison of texts with numbers that guards the documented report: it must not let
a change pass.
"""

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
        ("3.1e-08", "3.2e-08"),
        ("\u22120.5 %", "\u22120.6 %"),
        ("9.99 m", "10.0 m"),
        ("10561 N", "10562 N"),
    ],
)
def test_rounding_may_differ_by_a_unit_of_the_last_digit(old: str, new: str) -> None:
    assert not other_numbers(old, new)
    assert not other_numbers(new, old)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("2.41132 m", "2.41134 m"),
        ("2.41132 m", "2 m"),
        ("0.29412 J", "1 J"),
        ("2.678 J", "2.7 J"),
        ("5.115·10⁸", "5.115·10⁷"),
        ("3e-08", "2e-07"),
        ("7.929e-05", "7.929e-06"),
        ("+5.5 %", "\u22125.5 %"),
        ("0.77477", "0"),
        ("76.1 %", "76 %"),
        ("Type 2", "Type 3"),
        ("5 of 9", "4 of 9"),
        ("| 53 | 40 |", "| 54 | 39 |"),
        ("reproduced", "explained"),
        ("fig4", "fig5"),
        ("one line", "one line\nanother"),
        ("0.5 %", "0.5"),
    ],
)
def test_anything_else_is_found(old: str, new: str) -> None:
    assert other_numbers(old, new)
    assert other_numbers(new, old)
