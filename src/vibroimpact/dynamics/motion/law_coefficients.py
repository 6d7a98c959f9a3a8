"""The coefficients of the law of a batch, as the core takes them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import law_coefficients
from vibroimpact.contact.parameters import Parameters


@contextmanager
def coefficients_of(law: Parameters, size: int) -> Iterator[Floats]:
    """Give the coefficients of a law for each of B drops (B, K); laws without functions
    of floats are kept as long as they are used.
    """
    if type(law).missing_functions():
        laws = [law.take(drop) for drop in range(size)]
        yield np.array([law_coefficients(one) for one in laws])
        return
    coefficients = np.zeros((size, len(law.coefficients)))
    for number, values in enumerate(law.coefficients):
        coefficients[:, number] = values
    yield coefficients
