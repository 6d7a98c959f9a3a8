"""What tests do with the live page: open it with a case, wait for what comes, read what
it shows.
"""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

from plotted import until
from serving import Server
from vibroimpact.app.address import fragment_of

if TYPE_CHECKING:
    from playwright.sync_api import Page

RIGID: dict[str, Any] = {
    "name": "a rigid drop",
    "sphere": {"radius": "20 mm", "material": "steel"},
    "plate": {"size": ["200 mm", "150 mm", "6 mm"], "material": "steel"},
    "drop": {"height": "0.5 m"},
    "contact": {"law": "hunt-crossley", "restitution": 0.6},
    "run": {"impacts": 3},
}
ELASTIC: dict[str, Any] = {
    "name": "an elastic drop",
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {
        "size": ["200 mm", "150 mm", "6 mm"],
        "material": "steel",
        "model": "elastic",
        "modes": 6,
        "damping": 0.02,
        "mesh": {"element_size": "50 mm", "margin": 0},
        "supports": "simply-supported",
    },
    "drop": {"height": "0.2 m", "position": ["10 mm", 0]},
    "contact": {"law": "hunt-crossley", "restitution": 0.6},
    "run": {"impacts": 2},
    "sensors": [{"name": "a1", "position": ["30 mm", "20 mm"], "rate": "20 kHz"}],
}
LONG_NAMES: dict[str, Any] = ELASTIC | {
    "name": "AName" * 14,
    "sensors": [
        {
            "name": "beside_the_third_bolt" + 39 * "_",
            "position": ["90 mm", "20 mm"],
            "rate": "20 kHz",
        }
    ],
}
"""Names of which each is one long word."""
PATCHES = {"type": "patches", "spacing": ["170 mm", "120 mm"], "radius": "8 mm"}
"""Supports that are costlier to compute."""


def open_live(page: Page, server: Server, table: dict[str, Any] | None = None) -> None:
    """Open the live page with a case, or with the one with which it begins, and wait
    until it is shown.
    """
    page.goto(server.address + ("" if table is None else fragment_of(table)))
    page.wait_for_selector("html[data-detail=full]")
    settle(page)


def settle(page: Page) -> None:
    """Wait until what the controls ask for is shown in full, and drawn, or refused."""
    page.wait_for_selector("main[aria-busy=false]")


def shown(page: Page) -> dict[str, Any]:
    """Return the resolved case of what is shown."""
    found: dict[str, Any] = page.evaluate(
        "() => JSON.parse(JSON.stringify(vibroimpact.live.state.last.case))"
    )
    return found


def toml(page: Page) -> str:
    """Return the case that is shown as TOML, as it is downloaded."""
    with page.expect_download() as download:
        page.locator("#get-toml").click()
    assert download.value.suggested_filename == "case.toml"
    return download.value.path().read_text(encoding="utf-8")


def faults(page: Page) -> list[str]:
    """Return the lines of the message that is shown."""
    found: list[str] = page.locator("#faults p").all_text_contents()
    return found


def value_at(case: Any, key: str) -> Any:
    """Return a value of a resolved case by the key of its control."""
    for part in key.replace("plate.supports.", "plate.supports.0.").split("."):
        case = case[int(part)] if isinstance(case, list) else case.get(part)
    return case[0] if isinstance(case, list) else case


def row(page: Page, key: str) -> Any:
    """Return the row of controls of a key."""
    return page.locator(f'[data-key="{key}"]')


def type_value(page: Page, key: str, value: object) -> None:
    """Type a number into the field of a key, and wait for what comes of it."""
    field = row(page, key).locator("input[type=number], input[type=text]")
    field.fill(str(value))
    field.press("Tab")
    settle(page)


def tables(page: Page, which: str) -> list[list[str]]:
    """Return the rows of a table of the page."""
    return [
        line.locator("th, td").all_text_contents()
        for line in page.locator(f"#{which} tbody tr").all()
    ]


def wait_for_fault(page: Page) -> list[str]:
    until(page, "() => !document.getElementById('faults').hidden")
    return faults(page)


def drop_file(page: Page, name: str, content: bytes) -> None:
    """Drop a file over the page, as from the desktop."""
    transfer = page.evaluate_handle(
        """([name, content]) => { const transfer = new DataTransfer();
        const bytes = Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0));
        transfer.items.add(new File([bytes], name)); return transfer; }""",
        [name, base64.b64encode(content).decode()],
    )
    page.dispatch_event("body", "dragenter", {"dataTransfer": transfer})
    assert page.locator("#drop").is_visible()
    page.dispatch_event("body", "dragover", {"dataTransfer": transfer})
    page.dispatch_event("body", "drop", {"dataTransfer": transfer})
    assert page.locator("#drop").is_hidden()
