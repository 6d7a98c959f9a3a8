"""Numbers of the introduction to the numerical method, which its example prints."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

from stated_numbers import NUMBER, ROOT, says

PAGE = "docs/how-it-works.md"


def test_what_the_example_prints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(ROOT / "examples" / "how_it_works.py"))
    printed = capsys.readouterr().out

    def numbers(begin: str) -> list[float]:
        (line,) = (line for line in printed.splitlines() if line.lstrip().startswith(begin))
        return [float(number) for number in re.findall(NUMBER, line.replace(begin, "", 1))]

    in_time, in_root = (
        numbers(f"Hertz's force over {of}: the coefficient of order 20 of its Legendre series is")[
            0
        ]
        for of in "tx"
    )
    says(PAGE, "that of order {} is {} in t and {} in x", 20, in_time, in_root)
    says(PAGE, "Of {} mJ the ball regains {}", *numbers("energy of")[:2])
    says(
        PAGE,
        "The amplitude of the pulse is {} N within the row and {} N at the wall",
        *numbers("row of 12 beads:")[:2],
    )
    for modes in (5, 50, 500):
        highest, force, steps, _ = numbers(f"{modes} modes to")
        says(
            PAGE, "| {} | {} kHz | {} | {} ms | {} N |", modes, highest, steps, TIMES[modes], force
        )
    highest, force, steps, _ = numbers("5000 modes to")
    says(
        PAGE, "| {} | {} MHz | {} | {} ms | {} N |", 5000, 1e-3 * highest, steps, TIMES[5000], force
    )


TIMES = {5: 5, 50: 5, 500: 9, 5000: 60}
"""Milliseconds on the day that the page tells."""
