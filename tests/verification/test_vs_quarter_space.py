"""How much softer a contact is near a free edge, against three-dimensional finite
elements of a quarter space.
"""

from __future__ import annotations

import pytest

from agreement import Against, Agrees
from oracles.quarter_space import image_factor
from vibroimpact.cases.validity.edge import softening

AGAINST = Against(
    "finite-element analysis of an elastic quarter space",
    "own independent computation",
    "Hertz and elastic contact",
    "tests/oracles/quarter_space.py, block of 150 times the distance from the edge",
)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [pytest.param(0.0, marks=pytest.mark.whole), 0.3])
def test_what_an_edge_adds(agrees: Agrees, ratio: float) -> None:
    """Within 6 %: a block of 150 distances from the edge is 2 % too stiff."""
    # of the compliance of Hertz's contact; then the factor of the image is left
    share = 1.0 / (2.0 / (3.0 * 3.141592653589793))
    agrees(
        "contact near a free edge, Poisson's ratio 0 and 0.3",
        "factor of the image load",
        softening(1.0, 1.0, ratio, share),
        image_factor(ratio, reach=150.0),
        relative=0.06,
    )
