"""Constants of the method that the page on identification states."""

from __future__ import annotations

from stated import says
from vibroimpact.identification import doubts, plate, sphere

PAGE = "docs/identification.md"


def test_constants() -> None:
    says(PAGE, "leaves more than {} % of the records", 100.0 * doubts._PART)
    says(PAGE, "with standard deviations of {} and one", sphere._NEXT_OCTAVE)
    says(PAGE, "the spread of this difference over {} positions", plate._PLACES)
