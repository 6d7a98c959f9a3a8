"""The rule by which a printed number is held against a computed one."""

from __future__ import annotations

import pytest

from stated_numbers import says

PAGE = "docs/guides/adams-damping.md"


def test_a_number_as_it_is_rounded() -> None:
    says(PAGE, "hardened bearing steel, {} mm in diameter", 40.4)
    with pytest.raises(AssertionError, match=r"computed: 40\.6"):
        says(PAGE, "hardened bearing steel, {} mm in diameter", 40.6)


def test_a_sentence_that_is_not_there() -> None:
    with pytest.raises(AssertionError, match="does not say"):
        says(PAGE, "A steel ball of {} mm in radius", 20.0)
