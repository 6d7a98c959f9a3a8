"""Shared drops and a shared calibration, and the commands, which are made once."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import pytest
import typer.main

import vibroimpact as vi


@pytest.fixture(autouse=True, scope="session")
def commands_once() -> Iterator[None]:
    """Typer makes all commands anew each time that one is called, which the tests do a thousand times in a process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(typer.main, "get_command", cache(typer.main.get_command))
        yield


@pytest.fixture(scope="session")
def theory() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-theory"))


@pytest.fixture(scope="session")
def variable() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-variable"))


@pytest.fixture(scope="session")
def damping() -> vi.Calibration:
    """The damping that the paper calibrates."""
    return vi.calibrate_case(vi.load_calibration("paper:calibration"))
