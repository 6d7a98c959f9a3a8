"""Formulas as text of a program: what a law computes where its parameters are symbols."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vibroimpact.exporting.deck import number

_SUM, _PRODUCT, _POWER, _ATOM = range(4)
"""How strongly the last operation of a formula binds."""

_OPERATORS = {
    np.add: ("+", _SUM),
    np.subtract: ("-", _SUM),
    np.multiply: ("*", _PRODUCT),
    np.divide: ("/", _PRODUCT),
    np.power: ("**", _POWER),
}


@dataclass(frozen=True, eq=False)
class Formula(np.lib.mixins.NDArrayOperatorsMixin):
    """A formula in Python, which operators and functions of NumPy extend.

    A comparison raises TypeError, as one formula is for all numbers.

    Examples
    --------
    >>> e = Formula("e")
    >>> (0.75 * (1.0 - e * e) * np.exp(2.0 * (1.0 - e))).text
    '0.75 * (1.0 - e * e) * math.exp(2.0 * (1.0 - e))'
    >>> ((1.0 - (e - 1.0)) / (2.0 * e - 1.0) ** 2).text
    '(1.0 - (e - 1.0)) / (2.0 * e - 1.0) ** 2'
    """

    text: str
    binding: int = _ATOM

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *values: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        operands = [_formula_of(value) for value in values]
        if ufunc is np.negative:
            return Formula(f"-{operands[0]._bound(_PRODUCT)}", _SUM)
        if ufunc in _OPERATORS:
            first, second = operands
            sign, binding = _OPERATORS[ufunc]
            is_power = binding == _POWER
            # operators of equal rank are taken from the left, powers from the right
            first_text = first._bound(binding + is_power)
            second_text = second._bound(binding + (not is_power))
            return Formula(f"{first_text} {sign} {second_text}", binding)
        if ufunc.nin == 1 and hasattr(math, ufunc.__name__):
            return Formula(f"math.{ufunc.__name__}({operands[0].text})")
        return NotImplemented

    def __bool__(self) -> bool:
        raise TypeError("a formula stands for all numbers, and is neither true nor false")

    def _bound(self, binding: int) -> str:
        """Return the text, in parentheses unless it binds as strongly."""
        if self.binding >= binding:
            return self.text
        return f"({self.text})"


def _formula_of(value: Any) -> Formula:
    if isinstance(value, Formula):
        return value
    # a whole number stays one, as an exponent
    text = repr(value) if isinstance(value, int) else number(value)
    binding = _ATOM if value >= 0 else _SUM  # a minus binds like a difference
    return Formula(text, binding)
