"""Conversion factors on the page of the conventions."""

from __future__ import annotations

import vibroimpact as vi
from stated_numbers import says

PAGE = "docs/conventions.md"


def test_factors_of_conversion() -> None:
    says(
        PAGE,
        ": by {} for n = 1.5, not by {}.",
        factor("N/m^1.5", "N/mm^1.5"),
        factor("N/m", "N/mm"),
    )
    says(PAGE, "The damping of a dashpot, in N s/m, is divided by {}.", factor("N s/m", "N s/mm"))


def test_standard_gravity() -> None:
    says(PAGE, "; standard gravity, {} m/s^2: `g`, `gn`", vi.units.to_si("1 gn", "m/s^2"))


def factor(unit: str, to: str) -> float:
    return 1.0 / vi.units.convert_units(1.0, unit, to)
