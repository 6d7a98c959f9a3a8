"""A warning about a result, which knows how much it may change."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Literal

_LARGE = 0.1
_FAIR = 0.01
"""Relative changes from which a warning is large, and fair."""


class ResultWarning(str):
    """What may be wrong with a result: a sentence without its full stop.

    Parameters
    ----------
    text : str
        What is wrong, by how much, why, and the remedy.
    effect : float, default NaN
        The relative change that it may make of what it concerns [-]; NaN if that is not estimated,
        infinite if the input itself looks wrong.
    """

    effect: float

    def __new__(cls, text: str, effect: float = math.nan) -> ResultWarning:
        """Return a sentence with its effect."""
        warning = super().__new__(cls, text)
        warning.effect = effect
        return warning


def ranked(warnings: Iterable[str]) -> list[str]:
    """Return warnings, those first that change most.

    One whose effect is not estimated stands with those that change a tenth: it may be as large.

    Examples
    --------
    >>> ranked([ResultWarning("a little", 0.01), "perhaps", ResultWarning("much", 0.5)])
    ['much', 'perhaps', 'a little']
    """
    return sorted(warnings, key=lambda warning: -_assumed_effect(warning))


def size_of(warning: str) -> Literal["large", "fair", "small"]:
    """Return how large the effect of a warning is; fair where it is not estimated.

    Examples
    --------
    >>> size_of(ResultWarning("much", 0.5)), size_of("perhaps")
    ('large', 'fair')
    """
    effect = effect_of(warning)
    if effect >= _LARGE:
        return "large"
    return "small" if effect < _FAIR else "fair"


def effect_of(warning: str) -> float:
    """Return the relative change that a warning may make; NaN if it is not estimated."""
    return warning.effect if isinstance(warning, ResultWarning) else math.nan


def _assumed_effect(warning: str) -> float:
    effect = effect_of(warning)
    return _LARGE if math.isnan(effect) else effect
