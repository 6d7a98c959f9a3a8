"""Numbers of the page on signals that the program's constants give."""

from __future__ import annotations

from stated import says
from vibroimpact.signals import baseline

PAGE = "docs/signals.md"


def test_numbers_of_the_baseline() -> None:
    says(PAGE, "divided into up to {} blocks", baseline._BLOCKS)
    says(PAGE, "only if quiet blocks span {} % of the record", 100.0 * baseline._WIDE)
    says(PAGE, "removed only if it exceeds {} of its standard deviations", baseline._SURE)
    says(PAGE, "neither does one of fewer than {} samples", baseline._LEAST)
    assert baseline._LARGE == 0.1  # "of more than a tenth of the largest magnitude"
