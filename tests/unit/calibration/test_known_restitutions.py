"""Known restitutions of 200 records: of positions, forces and sound, with faults of
sensors and clocks, in files as they are written.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

import vibroimpact as vi
from people_record import FAULTS, NORMAL, errors_without_a_file, made, standard_errors

RECORDS, OF_A_KIND = 200, 300
SMALLEST = {
    ("force", "offset and drift"): 0.7,
    ("force", "gain"): 0.7,
    ("force", "clipped"): 0.7,
    ("sound", "clipped"): 0.6,
}
"""Sizes of errors, in standard deviations, where part of the deviation is a bound; 0.85
elsewhere.
"""


@pytest.mark.slow
def test_the_intervals_hold_or_the_file_is_refused_with_a_remedy(
    tmp_path: Path, population: Callable[..., int]
) -> None:
    """Of those that are read 95 % of the intervals hold; of the others the sentence names
    what would read them.
    """
    errors: list[float] = []
    refused: list[str] = []
    records = population(RECORDS, share=6)
    for seed in range(records):
        record = made(seed, tmp_path)
        try:
            errors += standard_errors(record).tolist()
        except vi.InputError as error:
            refused.append(str(error))
        record.file.unlink()
    assert records - len(refused) >= 0.75 * records
    for sentence in refused:
        assert any(
            remedy in sentence
            for remedy in ("columns", "sample faster", "time and gravity those of the record")
        ), sentence
        assert len(sentence) < 490 + len(str(tmp_path))
    held = float(np.mean(np.abs(errors) <= NORMAL))
    if records == RECORDS:
        assert 0.93 <= held <= 0.98
    else:  # of so few intervals, which are not independent in a record, all may hold
        assert held >= binom.ppf(1e-3, records - len(refused), 0.95) / (records - len(refused))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "fault"), [(kind, fault) for kind, faults in FAULTS.items() for fault in ("", *faults)]
)
def test_intervals_are_as_wide_as_the_errors(
    population: Callable[..., int], kind: str, fault: str
) -> None:
    """Of 300 records of a kind, with all of its faults or with one alone.

    Where a force has little noise, the unknown contact law is what is left, whose deviation is that
    of a bound; where sound is clipped, what the filter spreads of that counts as noise.
    """
    errors: list[float] = []
    records = population(OF_A_KIND, share=15)
    for seed in range(records):
        with suppress(vi.InputError):
            errors += errors_without_a_file(made(seed, None, kind, fault)).tolist()
    size = float(np.sqrt(np.mean(np.square(errors))))
    held = float(np.mean(np.abs(errors) <= NORMAL))
    told = (
        f"{kind}, {fault or 'all faults'}: {size:.2f} standard deviations, {100.0 * held:.1f} "
        f"% of {len(errors)} hold"
    )
    assert held >= binom.ppf(1e-3, records, 0.95) / records, told
    if records == OF_A_KIND:
        assert fault or 0.93 <= held <= 0.98, told
        assert SMALLEST.get((kind, fault), 0.85) <= size <= 1.1, told
