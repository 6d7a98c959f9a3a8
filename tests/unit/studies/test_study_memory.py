"""What memory a study may be given: not so little that it becomes far dearer."""

from __future__ import annotations

from pathlib import Path

import pytest

import vibroimpact as vi
from studies import RANDOM, study_table
from vibroimpact.errors import InputError
from vibroimpact.studies.computation.compute_study import chunk_size, compute_study, least_memory

LARGE = vi.studies.sweep_of(study_table({**RANDOM, "samples": 100_000}))


def test_memory_with_which_most_of_the_time_would_go_to_chunks_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as told:
        compute_study(LARGE, tmp_path / "study", memory=1e6)
    assert told.value.key == "memory"
    expected = (
        "1 MB is too little for 100,000 drops: computed 155 at a time they take over a third "
        "longer; give 17 MB or more"
    )
    assert told.value.message == expected
    assert not (tmp_path / "study").exists()


def test_the_least_memory_makes_at_most_forty_chunks() -> None:
    """One takes 50 ms beside its drops, which take 50 us each: 40 for 100,000 drops are
    two seconds in addition to five.
    """
    assert 100_000 / chunk_size(LARGE, least_memory(LARGE)) <= 40


def test_a_small_study_may_have_as_little_as_there_is() -> None:
    small = vi.studies.sweep_of(study_table({**RANDOM, "samples": 2000}))
    assert least_memory(small) == 1e6
    assert chunk_size(small, 1e6) < 2000


def test_what_was_begun_with_little_goes_on(tmp_path: Path) -> None:
    """The size of its chunks is fixed by then."""
    small = vi.studies.sweep_of(study_table({**RANDOM, "samples": 400}))
    folder = compute_study(small, tmp_path / "study", memory=1e6)
    assert compute_study(small, folder, resume=True, memory=1e6) == folder
