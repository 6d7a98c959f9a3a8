"""The text of a formula has the value that the same operations give with numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from vibroimpact.exporting.formula import Formula

FORMULAS: dict[str, Callable[[Any, Any], Any]] = {
    "x - (y - 1.0)": lambda x, y: x - (y - 1.0),
    "x - y - 1.0": lambda x, y: x - y - 1.0,
    "x / (y / 2.0)": lambda x, y: x / (y / 2.0),
    "x / y * 2.0": lambda x, y: x / y * 2.0,
    "x / (y * 2.0)": lambda x, y: x / (y * 2.0),
    "x ** y ** 2": lambda x, y: x ** (y**2),
    "(x ** y) ** 2": lambda x, y: (x**y) ** 2,
    "(-x) ** 2": lambda x, y: (-x) ** 2,
    "-x ** 2": lambda x, y: -(x**2),
    "-(x * y)": lambda x, y: -(x * y),
    "-(x + y) * 2.0": lambda x, y: -(x + y) * 2.0,
    "x * (-2.0)": lambda x, y: x * -2.0,
    "2.0 ** (-x)": lambda x, y: 2.0 ** (-x),
    "math.pi * x": lambda x, y: np.pi * x,
    "math.sqrt(x + y) / math.log(y)": lambda x, y: np.sqrt(x + y) / np.log(y),
    "0.1 * x": lambda x, y: np.float64(0.1) * x,
}


@pytest.mark.parametrize("compute", FORMULAS.values(), ids=FORMULAS)
def test_has_the_value_of_the_numbers(compute: Callable[[Any, Any], Any]) -> None:
    text = compute(Formula("x"), Formula("y")).text
    for x, y in ((1.5, 0.75), (0.3, 2.5), (2.0, 3.0)):
        value = eval(text, {"math": math, "x": x, "y": y})
        assert value == pytest.approx(float(compute(x, y)), rel=1e-15)


@pytest.mark.parametrize(
    "text", [text for text in FORMULAS if "pi" not in text and "-" not in text]
)
def test_has_no_more_parentheses_than_needed(text: str) -> None:
    assert FORMULAS[text](Formula("x"), Formula("y")).text == text


@pytest.mark.parametrize(
    "compute",
    [
        lambda e: e < 0.5,
        lambda e: e == 1.0,
        lambda e: 1.0 if e else 0.0,
        lambda e: np.where(e > 0.5, e, 1.0),
        np.hypot,
        np.arctan,
        math.exp,
        float,
        lambda e: e * np.array([1.0, 2.0]),
    ],
)
def test_refuses_what_is_no_single_formula(compute: Callable[..., Any]) -> None:
    e = Formula("e")
    with pytest.raises(TypeError):
        compute(e, e) if compute is np.hypot else compute(e)
