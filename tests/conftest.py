"""Shared drops."""

from __future__ import annotations

import pytest

import vibroimpact as vi


@pytest.fixture(scope="session")
def theory() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-theory"))


@pytest.fixture(scope="session")
def variable() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-variable"))
