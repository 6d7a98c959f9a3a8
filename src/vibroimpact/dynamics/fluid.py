"""What air and liquids have in common: density and viscosity, of one drop or of a batch."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array, Bools, Drops
from vibroimpact.errors import InputError


@dataclass(frozen=True, kw_only=True, eq=False)
class Fluid:
    """Base of the fluids; each value is a number, or an array with one a drop.

    Raises
    ------
    InputError
        If a value is not finite, or not greater than 0.
    """

    word: ClassVar[str]
    """What messages call it."""

    density: Array
    viscosity: Array

    def __post_init__(self) -> None:
        for name, value in self._given():
            found = np.asarray(value)
            if not (found.dtype.kind in "iuf" and np.all(np.isfinite(found) & (found > 0.0))):
                raise InputError(f"{name} of {self.word} must be a finite number greater than 0 in SI, not {value!r}")

    def _given(self) -> list[tuple[str, Any]]:
        return [(item.name, value) for item in fields(self) if (value := getattr(self, item.name)) is not None]

    @property
    def values(self) -> list[Array]:
        """All values that may be arrays."""
        return [value for _, value in self._given()]

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """() for one drop, (B,) for a batch."""
        return np.broadcast_shapes(*(np.shape(value) for value in self.values))

    def take(self, drops: int | slice | Drops | Bools) -> Self:
        """Return the fluid of one drop of a batch, or of some."""
        if self.shape == ():
            return self
        return type(self)(**{name: value if np.ndim(value) == 0 else np.asarray(value)[drops] for name, value in self._given()})
