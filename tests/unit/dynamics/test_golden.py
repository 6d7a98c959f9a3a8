"""Numbers that were kept before the solver was built anew are still the same."""

from __future__ import annotations

import pytest

from golden import NAMES, departures
from support import one_in


@pytest.mark.parametrize("name", one_in(9, NAMES))
def test_numbers_are_those_kept(name: str) -> None:
    found = departures(name)
    worst = max(found, key=lambda key: found[key])
    assert found[worst] <= 1.0, worst
