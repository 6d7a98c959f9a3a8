"""The axes of a study as figures and tables show them."""

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
        Dotted, as the study has it.
    unit : str
        SI; "1" of a plain number.
    values : array
        The levels of a grid, or one value a drop; numbers [SI], or names.
    """

    key: str
    unit: str
    values: NDArray[Any]

    @property
    def numeric(self) -> bool:
        """Are its values numbers?"""
        return self.values.dtype.kind in "fiu"

    @property
    def varies(self) -> bool:
        """Has it two values or more?"""
        return bool(len(self.values) and (self.values != self.values[0]).any())


def study_axes(study: Study) -> list[StudyAxis]:
    """Return the axes in the order of the points."""
    return [StudyAxis(key, study.meanings[key][0], _as_numbers(values)) for key, values in study.coordinates.items()]


def _as_numbers(values: NDArray[Any]) -> NDArray[Any]:
    """Return texts that are all plain numbers as these; some datasets have whole numbers as texts."""
    if values.dtype != object or not len(values):
        return values
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return values
