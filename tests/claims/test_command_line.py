"""Numbers on the page of the command line."""

from __future__ import annotations

from math import erf, sqrt

from stated_numbers import says
from vibroimpact.law_sheets.text import SPEED
from vibroimpact.signals.estimate import Estimate

PAGE = "docs/command-line.md"


def test_intervals_of_an_identification() -> None:
    says(PAGE, "({} %); ", 100.0 * erf(Estimate(0.0, 1.0).interval[1] / sqrt(2.0)))


def test_restitution_in_the_sheets_of_laws() -> None:
    says(PAGE, "(asked and achieved, for the paper's sphere at {} m/s)", SPEED)
