"""Shared drops and a shared calibration, and the commands, which are made once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
import typer.main

import vibroimpact as vi
from support import run_command


@pytest.fixture(autouse=True, scope="session")
def commands_once() -> Iterator[None]:
    """Typer makes all commands anew each time that one is called, which the tests do a
    thousand times in a process.
    """
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
def damping() -> vi.calibration.Calibration:
    """The damping that the paper calibrates."""
    return vi.calibration.calibrate_case(vi.calibration.load_calibration("paper:calibration"))


@pytest.fixture(scope="session")
def tiny_models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a small data set in `data`, and a model of each classifier that was
    trained on it.
    """
    from trained_models import write_tiny_models

    return write_tiny_models(tmp_path_factory.mktemp("tiny"))


@pytest.fixture
def command(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., tuple[int, str, str]]:
    """Run `vibroimpact` with words in the folder of the test, and return its exit status,
    its output and its errors.
    """
    monkeypatch.chdir(tmp_path)

    def run(*words: object) -> tuple[int, str, str]:
        return run_command(monkeypatch, capsys, *words)

    return run
