"""A browser for the tests of pages, and servers of the live page.

The tests drive a Chromium that is installed: that of Debian, or the program named by
VIBROIMPACT_CHROMIUM. They wait on conditions.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import vibroimpact as vi
from live_page import ELASTIC, RIGID
from serving import Server

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page, Request

CHROMIUM = os.environ.get("VIBROIMPACT_CHROMIUM", "/usr/bin/chromium")
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-precise-memory-info",
]

MakePage = Callable[..., "Page"]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.page)


@pytest.fixture(scope="session", autouse=True)
def compiled() -> None:
    """Compile the solver before a page waits for it: that may take longer than a page is
    given to show a drop.
    """
    for table in (RIGID, ELASTIC):
        vi.simulate(vi.case_of(table).to_problem())


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    # one for each file: other tests of the same process need the event loop for themselves
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="make test-page installs Playwright"
    )
    if not Path(CHROMIUM).exists():
        pytest.skip(
            f"there is no {CHROMIUM}; make test-page installs it, and VIBROIMPACT_CHROMIUM "
            "names another one"
        )
    with playwright.sync_playwright() as driver:
        launched = driver.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield launched
        launched.close()


@pytest.fixture
def complaints() -> list[str]:
    """What pages complain of: messages on the console, errors, and requests to elsewhere.
    A test empties it of what it expects.
    """
    return []


@pytest.fixture
def new_page(browser: Browser, complaints: list[str]) -> Iterator[MakePage]:
    """Open pages, in a window of their own each, whose complaints fail the test."""
    contexts: list[BrowserContext] = []

    def make(width: int = 1280, height: int = 900, **options: Any) -> Page:
        context = browser.new_context(
            viewport={"width": width, "height": height}, accept_downloads=True, **options
        )
        context.set_default_timeout(60_000)
        contexts.append(context)
        context.on("console", lambda message: complaints.append(f"{message.type}: {message.text}"))
        context.on("weberror", lambda error: complaints.append(f"error: {error.error}"))
        context.on("request", lambda request: complaints.extend(_elsewhere(request)))
        return context.new_page()

    yield make
    for context in contexts:
        context.close()
    assert complaints == []


def _elsewhere(request: Request) -> list[str]:
    own = request.url.startswith(
        ("http://127.0.0.1:", "ws://127.0.0.1:", "file://", "data:", "blob:")
    )
    return [] if own else [f"request: {request.url}"]


@pytest.fixture
def page(new_page: MakePage) -> Page:
    """An empty page of a window of 1280 by 900."""
    return new_page()


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    """A live page that is served as a user does, with the modes of the tests."""
    with Server() as started:
        yield started


@pytest.fixture
def new_server() -> Iterator[Callable[..., Server]]:
    """Start servers of the live page with arguments of their own."""
    with ExitStack() as stack:
        yield lambda *arguments, port=0: stack.enter_context(Server(*arguments, port=port))
