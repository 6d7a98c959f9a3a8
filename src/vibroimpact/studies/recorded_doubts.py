"""What to doubt of a study: which limits of the theory its drops are beyond, how many of them, and the worst."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from vibroimpact.files.hdf5 import read_array
from vibroimpact.studies.columns import DOUBTS, LIMIT


class StudyDoubt(NamedTuple):
    """A limit that some drops of a study are beyond.

    Attributes
    ----------
    limit : str
        Its name, such as "air_drag".
    drops : int
        How many drops are beyond it.
    worst : int
        The number of the one that is farthest beyond, from 0.
    number : float
        Of that one; `limit_NAME` of the dataset says what it is.
    """

    limit: str
    drops: int
    worst: int
    number: float


def study_doubts(dataset: Path) -> list[StudyDoubt]:
    """Return the limits that drops of a study are beyond, that of the most drops first.

    Parameters
    ----------
    dataset : Path
        The `study.nc` of the study; of one made before limits were kept there are none.
    """
    with h5py.File(dataset, "r") as file:
        if DOUBTS not in file:
            return []
        beyond, found = read_array(file[DOUBTS]).ravel(), []
        for mask, limit in zip(file[DOUBTS].attrs["flag_masks"], str(file[DOUBTS].attrs["flag_meanings"]).split(), strict=True):
            doubted = (beyond & mask) != 0
            if doubted.any():
                numbers = np.where(doubted, read_array(file[f"{LIMIT}{limit}"]).ravel(), -np.inf)
                worst = int(np.argmax(numbers))
                found.append(StudyDoubt(limit, int(doubted.sum()), worst, float(numbers[worst])))
    return sorted(found, key=lambda one: -one.drops)
