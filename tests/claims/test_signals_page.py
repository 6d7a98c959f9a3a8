"""Numbers of the page on signals that the program's constants give."""

from __future__ import annotations

from stated_numbers import says
from vibroimpact.measurements import recorded_table
from vibroimpact.signals import baseline, registry
from vibroimpact.signals.bounces import touches
from vibroimpact.signals.reading import coded_sound, equal_steps

PAGE = "docs/signals.md"


def test_numbers_of_the_baseline() -> None:
    says(
        PAGE, "A drift is sought only if these parts span {} % of it", 100.0 * baseline._DRIFT_SPAN
    )
    says(PAGE, "removed only if it exceeds {} of its standard deviations", baseline._SURE)
    says(
        PAGE, "Of a record of fewer than {} samples no baseline is removed", baseline._LEAST_SAMPLES
    )
    says(PAGE, "of {} samples or more, that are not equally spaced", equal_steps._FEWEST)
    assert equal_steps._LONGEST_STEP == 3.0
    assert equal_steps._LARGEST_JITTER == 0.5
    assert baseline._LARGE == 0.1  # "of more than a tenth of the largest magnitude"


def test_numbers_of_cells_without_a_number() -> None:
    says(
        PAGE,
        "else up to {} in a row, and {} % of all, are filled in by cubic splines",
        recorded_table._LONGEST_GAP,
        100.0 * recorded_table._MOST_MISSING,
    )


def test_numbers_of_coded_sound() -> None:
    assert touches._FLOOR_OF_CODED == 1e-3  # "down to a thousandth of the largest power"
    says(PAGE, "largest power and refines their times within {} ms", 1e3 * coded_sound._BLUR)


def test_number_of_features() -> None:
    says(PAGE, "`vibroimpact features` computes {} features", len(registry.signal_features()))
