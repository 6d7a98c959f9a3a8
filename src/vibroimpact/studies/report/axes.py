"""The axes of a study in figures and tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.studies.study import Study


@dataclass(frozen=True, eq=False)
class StudyAxis:
    """A swept key.

    Attributes
    ----------
    key : str
        Dotted key.
    unit : str
        SI unit; "1" for a plain number.
    values : array
        Levels of a grid, or one value per drop; numbers in SI units, or names.
    """

    key: str
    unit: str
    values: NDArray[Any]

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers."""
        return self.values.dtype.kind in "fiu"

    @property
    def varies(self) -> bool:
        """Whether it has two or more distinct values."""
        return bool(len(self.values) and (self.values != self.values[0]).any())


def study_axes(study: Study) -> list[StudyAxis]:
    """Return the axes of a study in order."""
    return [StudyAxis(key, study.meanings[key][0], _as_numbers(values)) for key, values in study.coordinates.items()]


def _as_numbers(values: NDArray[Any]) -> NDArray[Any]:
    """Return strings that are all numbers as numbers, as some datasets store integers as strings."""
    if values.dtype != object or not len(values):
        return values
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return values
