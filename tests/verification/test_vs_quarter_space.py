"""How much softer a contact is near a free edge, against three-dimensional finite elements of a quarter space."""

from __future__ import annotations

import pytest

from oracles.quarter_space import image_factor
from vibroimpact.cases.limits.edge import softening


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.0, 0.3])
def test_what_an_edge_adds(ratio: float) -> None:
    """Within 6 %: a block of 150 distances from the edge is 2 % too stiff."""
    share = 1.0 / (2.0 / (3.0 * 3.141592653589793))  # of the compliance of Hertz's contact; then the factor of the image is left
    assert softening(1.0, 1.0, ratio, share) == pytest.approx(image_factor(ratio, reach=150.0), rel=0.06)
