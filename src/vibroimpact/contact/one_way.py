"""Laws that are one thing on the way in and another on the way out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.law import CompliantLaw, memory


@dataclass(frozen=True, kw_only=True)
class OneWayLaw(CompliantLaw):
    """Base of the laws that only remember that the contact has turned."""

    turned: Array = memory("has the contact passed its deepest point? 1 if so")

    def after_compression(self, deepest: Array) -> Self:
        """Return the law for the way out, of the drops that have been deeper than zero."""
        return self.changed({"turned": np.where(deepest > 0.0, 1.0, self.turned)})
