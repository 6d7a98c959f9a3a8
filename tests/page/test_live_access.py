"""The live page for everybody: by keyboard alone, with names for screen readers, in the
dark, on small windows, and for long.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from live_page import ELASTIC, LONG_NAMES, RIGID, open_live, row, settle, shown, type_value
from page_access import (
    assert_headings_are_in_order,
    faint_texts,
    names_of_controls,
    scrolls_sideways,
)
from plotted import names, show

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from serving import Server

MakePage = Callable[..., "Page"]

CONTROLS = "a[href], button, select, input, summary, canvas[tabindex]"


def focused(page: Page) -> str:
    """Return in words what has the focus."""
    found: str = page.evaluate(
        """() => { const at = document.activeElement, row = at.closest(".row");
        if (row) return `${row.dataset.key} ${at.type}`;
        return at.id || at.dataset.scene || at.getAttribute("aria-label") || at.textContent.trim(); }"""
    )
    return found


@pytest.mark.parametrize("case", ["rigid", "elastic"])
def test_tab_reaches_every_control_in_the_order_of_the_page(
    case: str, page: Page, server: Server
) -> None:
    open_live(page, server, {"rigid": RIGID, "elastic": ELASTIC}[case])
    wanted = page.evaluate(
        f"""() => [...document.querySelectorAll("{CONTROLS}")]
          .filter((one) => !one.disabled && one.tabIndex >= 0 && one.checkVisibility()).length"""
    )
    assert wanted > 40
    seen: list[str] = []
    order: list[int] = []
    while len(order) < wanted:
        page.keyboard.press("Tab")
        place = page.evaluate(
            f"""() => [...document.querySelectorAll("{CONTROLS}")].indexOf(document.activeElement)"""
        )
        if place < 0:  # what can be scrolled is reached as well
            assert page.evaluate(
                "() => { const at = document.activeElement; return at.scrollWidth > "
                "at.clientWidth || at.scrollHeight > at.clientHeight; }"
            )
            continue
        seen.append(focused(page))
        order.append(place)
        # what has the focus can be seen
        look = (
            "() => { const at = document.activeElement; return getComputedStyle(at.id === "
            "'file' ? at.parentElement : at).outlineStyle; }"
        )
        assert page.evaluate(look) != "none", seen[-1]
    assert order == sorted(order)
    assert len(set(order)) == wanted
    page.keyboard.press("Shift+Tab")
    assert focused(page) == seen[-2]


def test_everything_is_changed_by_keyboard_alone(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)

    def go(words: str) -> None:
        for _ in range(120):
            if focused(page) == words:
                return
            page.keyboard.press("Tab")
        raise AssertionError(f"{words} is not reached")

    go("drop.height number")
    page.keyboard.press("Control+a")
    page.keyboard.type("0.3")
    page.keyboard.press("Enter")
    settle(page)
    assert shown(page)["drop"]["height"] == 0.3
    go("contact.law select-one")
    page.keyboard.press("f")  # a second letter that comes late would begin another word
    settle(page)
    assert shown(page)["contact"]["law"] == "flores"
    assert focused(page) == "contact.law select-one"
    go("Add a sensor")
    page.keyboard.press("Enter")
    settle(page)
    assert len(shown(page)["sensors"]) == 2
    go("Remove sensor a2")
    page.keyboard.press("Space")
    settle(page)
    assert len(shown(page)["sensors"]) == 1
    go("view-after")
    page.keyboard.press("Enter")
    assert page.locator("#view").input_value() == "0"
    go("play")
    page.keyboard.press("Space")
    assert page.locator("[data-scene=play]").text_content() == "Play"
    go("place")
    page.keyboard.press("Home")
    assert page.locator("[data-scene=clock]").text_content().endswith("before first touch")
    go("theme")
    page.keyboard.press("Enter")
    assert page.locator("html").get_attribute("data-theme") == "dark"


def test_every_control_has_a_name(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    found = names_of_controls(page)
    assert len(found) > 70
    assert [role for role, name in found if not name] == []
    assert all(len(name) > 20 for role, name in found if role == "img")
    assert {("region", "Impacts"), ("region", "Energy at the end")} <= set(found)
    # a slider tells its value with the unit
    assert (
        row(page, "sphere.radius").locator("input[type=range]").get_attribute("aria-valuetext")
        == "10 mm"
    )
    labels = page.evaluate(
        "() => [...document.querySelectorAll('#controls input, #controls "
        "select')].every((one) => one.labels.length || one.ariaLabel)"
    )
    assert labels
    identities = page.evaluate("() => [...document.querySelectorAll('[id]')].map((one) => one.id)")
    assert len(identities) == len(set(identities))
    groups = [
        one.get_attribute("aria-label") or one.locator("legend").text_content()
        for one in page.locator("fieldset, [role=group]").all()
    ]
    assert groups == [
        "Sphere",
        "Drop",
        "Contact",
        "Plate",
        "Supports",
        "Sensors",
        "Sensor a1",
        "Run",
    ]


def test_status_is_told_politely_and_work_is_told(page: Page, server: Server) -> None:
    open_live(page, server, RIGID)
    status = page.locator("#status")
    assert status.get_attribute("aria-live") == "polite"
    before = status.text_content()
    type_value(page, "run.impacts", 4)
    assert status.text_content() != before
    # while it is computed the results are said to be busy
    page.evaluate(
        """() => { window.busy = []; const main = document.querySelector("main");
        new MutationObserver(() => busy.push(main.ariaBusy)).observe(main, { attributes: true }); }"""
    )
    type_value(page, "drop.height", 0.6)
    assert page.evaluate("() => busy")[0] == "true"
    assert page.evaluate("() => busy.at(-1)") == "false"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark(scheme: str, new_page: MakePage, server: Server) -> None:
    page = new_page(color_scheme=scheme)
    open_live(page, server, RIGID)

    def looks() -> tuple[Any, ...]:
        show(page, "force")
        ground = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
        return ground, page.evaluate(
            "() => vibroimpact.live.charts.get('force').element._fullLayout.font.color"
        )

    assert page.locator("html").get_attribute("data-theme") == scheme
    before = looks()
    page.get_by_role("button", name="Light or dark").click()
    assert page.locator("html").get_attribute("data-theme") == (
        "light" if scheme == "dark" else "dark"
    )
    after = looks()
    assert before[0] != after[0]
    assert before[1] != after[1]
    # what comes later is drawn in the theme chosen
    type_value(page, "drop.height", 0.6)
    assert looks() == after


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_and_headings_are_in_order(
    scheme: str, new_page: MakePage, server: Server
) -> None:
    page = new_page(color_scheme=scheme)
    open_live(page, server, ELASTIC)
    page.locator("#hold").click()
    type_value(page, "contact.restitution", 7)
    page.locator("#warnings summary").click()
    for name in names(page):
        show(page, name)
    assert page.locator("tr.held, .fault-here, .unit, .headline, #warnings .warning").count() > 10
    assert faint_texts(page) == []
    assert_headings_are_in_order(page)


@pytest.mark.parametrize("case", ["rigid", "elastic", "long names"])
@pytest.mark.parametrize("size", [(390, 844), (1024, 768), (1440, 900)])
def test_the_page_does_not_scroll_sideways(
    case: str, size: tuple[int, int], new_page: MakePage, server: Server
) -> None:
    page = new_page(*size)
    open_live(page, server, {"rigid": RIGID, "elastic": ELASTIC, "long names": LONG_NAMES}[case])
    page.locator("#hold").click()
    type_value(page, "drop.height", 0.3)
    for name in names(page):
        show(page, name)
    assert not scrolls_sideways(page)
    # nor do the numbers in the fields get cut off
    cut = page.evaluate(
        """() => [...document.querySelectorAll("#controls input[type=number]")]
          .filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.value)"""
    )
    assert cut == []
    type_value(page, "contact.restitution", 7)
    assert not scrolls_sideways(page)


def test_touch_leaves_charts_to_scrolling(new_page: MakePage, server: Server) -> None:
    page = new_page(390, 844, has_touch=True, is_mobile=True)
    open_live(page, server, RIGID)
    show(page, "force")
    assert (
        page.evaluate("() => vibroimpact.live.charts.get('force').element._fullLayout.dragmode")
        is False
    )
    row(page, "drop.height").locator("input[type=range]").scroll_into_view_if_needed()
    row(page, "drop.height").locator("input[type=range]").tap()
    settle(page)
    assert shown(page)["drop"]["height"] != 0.5


@pytest.mark.slow
def test_two_thousand_moves_take_no_more_memory(
    page: Page, server: Server, population: Callable[[int], int]
) -> None:
    open_live(page, server, RIGID)
    devtools = page.context.new_cdp_session(page)
    devtools.send("Performance.enable")

    def used() -> dict[str, float]:
        devtools.send("HeapProfiler.collectGarbage")
        found = {
            one["name"]: one["value"] for one in devtools.send("Performance.getMetrics")["metrics"]
        }
        (resident,) = re.findall(
            r"VmRSS:\s*(\d+) kB", Path(f"/proc/{server.process.pid}/status").read_text()
        )
        return {**found, "server": 1024 * float(resident)}

    def move(count: int) -> None:
        """Move the height, and wait for the drawing of each draft; every hundredth time
        it is let go, and computed in full.
        """
        for _ in range(count // 100):
            page.evaluate(
                """async () => {
                  const range = document.getElementById("c-drop-height-slider");
                  for (let number = 1; number <= 100; number++) {
                    const before = vibroimpact.drawn;
                    range.value = String(0.3 + 0.4 * (0.618 * number % 1));
                    range.dispatchEvent(new Event("input"));
                    while (vibroimpact.drawn === before) await new Promise((done) => setTimeout(done, 1));
                  }
                  range.dispatchEvent(new Event("change"));
                }"""
            )
            settle(page)

    move(200)
    before = used()
    move(100 * population(18))
    after = used()
    assert after["JSHeapUsedSize"] - before["JSHeapUsedSize"] < 5e6
    assert after["Nodes"] < 1.05 * before["Nodes"]
    assert after["JSEventListeners"] < 1.05 * before["JSEventListeners"]
    assert after["server"] - before["server"] < 30e6
