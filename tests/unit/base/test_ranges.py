"""Ranges: a number is inside of one exactly where the array of it alone is."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

from vibroimpact.errors import InputError
from vibroimpact.ranges import Range

RANGES = [
    Range(),
    Range(above=0),
    Range(at_least=0),
    Range(above=0, at_most=1),
    Range(at_least=-1, below=1),
    Range(at_least=2, at_most=2),
]
NUMBERS = [
    -math.inf,
    -1.0,
    -0.0,
    0.0,
    5e-324,
    1.0,
    2.0,
    1e308,
    math.inf,
    math.nan,
    np.float64(1.0),
    np.float64("nan"),
]


def told(allowed: Range, values: object) -> str:
    try:
        allowed.check(values, "m")
    except InputError as error:
        return error.message
    return ""


@pytest.mark.parametrize(("allowed", "number"), list(product(RANGES, NUMBERS)), ids=repr)
def test_a_number_and_an_array_of_it(allowed: Range, number: float) -> None:
    assert told(allowed, number) == told(allowed, np.array([number])) == told(allowed, [number])
    inside = (
        math.isfinite(number)
        and allowed.above < number < allowed.below
        and allowed.at_least <= number <= allowed.at_most
    )
    assert (told(allowed, number) == "") == inside
