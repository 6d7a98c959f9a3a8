"""The equation that a hysteretic law prints has the damping factor that it computes with."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest

from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.registry import contact_laws

LAWS = {name: law for name, law in contact_laws().items() if issubclass(law, HystereticLaw)}
TOKEN = re.compile(r"\d+(?:\.\d+)?|[a-z]+|[-+/()^]")


def written_factor(equation: str) -> str:
    """Return the damping factor of an equation as Python: products are written by a blank."""
    (factor,) = re.findall(r"\[1 \+ (.*?) delta_dot / v0\]", equation)
    tokens = TOKEN.findall(factor)
    assert "".join(tokens) == factor.replace(" ", "")
    python = tokens[0]
    for previous, token in pairwise(tokens):
        ends = previous == ")" or previous == "e" or previous[0].isdigit()
        begins = token == "(" or token.isalpha() or token[0].isdigit()
        python += (" * " if ends and begins else " ") + token
    return python.replace("^", "**")


@pytest.mark.parametrize("name", LAWS)
def test_the_equation_has_the_damping_factor(name: str) -> None:
    formula = written_factor(LAWS[name].equation)
    for e in np.random.default_rng(3).uniform(0.05, 1.0, 20):
        law = LAWS[name](stiffness=1.0, restitution=float(e))
        value = eval(formula, {"exp": math.exp, "e": float(e)})
        assert value == pytest.approx(float(law.damping_factor), rel=1e-14), formula


def test_there_are_laws() -> None:
    assert len(LAWS) >= 9
