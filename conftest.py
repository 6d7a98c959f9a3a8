"""What every test has, and every example in a docstring."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from _pytest.doctest import DoctestItem

pytest_plugins = ["agreement"]


_SHARE = 5
"""Of a large population of cases, one in so many is taken where not all are asked for."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option by which slow tests take whole populations of cases."""
    parser.addoption(
        "--whole",
        action="store_true",
        help="take whole populations of cases in slow tests, not the first fifth of them, and the tests marked `whole`",
    )


@pytest.fixture
def population(request: pytest.FixtureRequest) -> Callable[..., int]:
    """How many of a population of cases are taken: continuous integration takes one in five, or in `share`; `make test-whole` takes all."""
    whole = request.config.getoption("--whole")
    return lambda size, share=_SHARE: size if whole else -(-size // share)


@pytest.fixture(autouse=True, scope="session")
def own_store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Keep the modes that tests compute apart from those of the user; all processes of a run share them."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "modes"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(folder))
        yield folder


@pytest.fixture(autouse=True, scope="session")
def shared_code_store() -> Iterator[None]:
    """Share the compiled code of the user in processes with another home too: it is found by its content, and takes long to make."""
    from vibroimpact.compiler.code_store import PLACE, code_folder

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(PLACE, str(code_folder()))
        yield


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out tests marked `whole` where not all are asked for; mark examples of docstrings that train classifiers as slow."""
    if not config.getoption("--whole"):
        repeated = [item for item in items if item.get_closest_marker("whole")]
        config.hook.pytest_deselected(items=repeated)
        items[:] = [item for item in items if item not in set(repeated)]
    for item in items:
        if isinstance(item, DoctestItem) and _says(item, 'recognise("falls"', '"recognised"'):
            item.add_marker("slow")


@pytest.fixture(scope="session")
def recognise_once() -> Callable[..., object]:
    """Recognise a data set, which takes half a minute, only once."""
    from vibroimpact.recognition.recognise import recognise

    return cache(recognise)


@pytest.fixture(autouse=True)
def folders_of_examples(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Let examples of docstrings find the data set `falls`, and `recognised`, what was recognised of it, where they name them."""
    item = request.node
    if not isinstance(item, DoctestItem) or not _says(item, '"falls"', '"recognised"'):
        return
    import vibroimpact as vi
    from knock_data import write_knocks

    folder = tmp_path_factory.mktemp("recognition")
    monkeypatch.chdir(folder)
    write_knocks(folder / "falls", rocks=16, falls=6)
    once = request.getfixturevalue("recognise_once")
    # the module of this name is hidden by its function
    monkeypatch.setattr(import_module("vibroimpact.recognition.recognise"), "recognise", once)
    monkeypatch.setattr(vi.recognition, "recognise", once)
    if _says(item, '"recognised"'):
        once("falls", folds=2, seeds=1).save(folder / "recognised")


def _says(item: DoctestItem, *words: str) -> bool:
    return any(word in example.source for example in item.dtest.examples for word in words)
