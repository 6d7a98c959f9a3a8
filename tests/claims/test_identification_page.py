"""Constants of the method that the page on identification states."""

from __future__ import annotations

from stated_numbers import says
from vibroimpact.identification import doubts, polarity

PAGE = "docs/identification.md"


def test_constants() -> None:
    says(PAGE, "leaves more than {} % of the records", 100.0 * doubts._MISFIT_OVER_RMS)
    says(
        PAGE,
        "found if the best pulse leaves more than {} % of the energy of the records",
        100.0 * polarity._POOR,
    )
    says(PAGE, "with the opposite sign at most {} % of that", 100.0 * polarity._BETTER)
    says(
        PAGE,
        "where the fit leaves more than {} times the noise before first touch",
        doubts._MISFIT_OVER_NOISE,
    )
