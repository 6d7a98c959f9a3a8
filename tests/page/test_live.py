"""The live page in a browser: its numbers are those of the library, and windows, links,
files and downloads do what they say.
"""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from live_page import (
    ELASTIC,
    RIGID,
    drop_file,
    faults,
    open_live,
    row,
    settle,
    shown,
    tables,
    toml,
    type_value,
    wait_for_fault,
)
from plotted import (
    ROWS,
    assert_history_is_drawn,
    assert_is_line,
    assert_loops_are_drawn,
    names,
    plotted,
    until,
    zoom,
)
from serving import Server
from support import plain_case
from vibroimpact.cases.build import resolved_case
from vibroimpact.cli import main
from vibroimpact.report.terminal_report import warning_lines
from vibroimpact.results.csv_files import signal_csv
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.tables import impact_table, ledger_table

if TYPE_CHECKING:
    from playwright.sync_api import Page

MakePage = Callable[..., "Page"]


def computed(page: Page, folder: Path) -> Result:
    """Return what the library computes of the case that the page lets one download."""
    (folder / "case.toml").write_text(toml(page), encoding="utf-8")
    return result_of(vi.simulate(vi.load_case(folder / "case.toml")))


def assert_tables_are_those_of(page: Page, result: Result) -> None:
    found = impact_table(result)
    assert tables(page, "impacts") == found.rows
    assert tables(page, "ledger") == [
        [one.title, one.energy, one.part] for one in ledger_table(result)[1]
    ]
    assert page.locator("#status").text_content() == result.status
    assert page.locator("#warnings .warning").all_text_contents() == [
        str(line) for line in warning_lines(result.doubts)
    ]


@pytest.mark.parametrize("case", ["rigid", "elastic"])
def test_numbers_are_those_of_the_library(
    case: str, page: Page, server: Server, tmp_path: Path
) -> None:
    open_live(page, server, {"rigid": RIGID, "elastic": ELASTIC}[case])
    for key, value in {
        "drop.height": 0.3,
        "contact.restitution": 0.7,
        "sphere.material.density": 7000,
    }.items():
        type_value(page, key, value)
    result = computed(page, tmp_path)
    assert result.case["drop"]["height"] == 0.3
    assert_tables_are_those_of(page, result)
    history = result.history
    assert_history_is_drawn(page, result, history)
    assert_loops_are_drawn(page, result, history)
    for name in {"sphere_energy", "plate_motion", "plate_energy"} & set(names(page)):
        panels = plotted(page, name)
        for number, title in enumerate(note for note in panels.notes if note):
            panel = "y" if number == 0 else f"y{number + 1}"
            unit = next(
                one
                for one in ("m/s2", "m/s", "m", "J")
                if panels.titles[panel].replace("²", "2").endswith(one)
            )
            (line,) = plotted(page, name, {panel: ("s", unit)}).lines(panel)
            key = (
                f"{title} of the plate"
                if name == "plate_energy" and title.endswith("strain and kinetic")
                else title
            )
            assert_is_line(line, history["time_s"], ROWS[key](history), whole=True, tolerance=3e-6)
    for name, signal in result.signals.items():
        (line,) = plotted(page, f"sensor_{name}", {"y": ("s", signal.sensor.unit)}).lines("y")
        assert_is_line(line, signal.time, signal.value, whole=True)


def test_views_and_zoom(page: Page, server: Server, tmp_path: Path) -> None:
    open_live(page, server, RIGID)
    result = computed(page, tmp_path)
    page.get_by_role("button", name="Later").click()
    page.get_by_role("button", name="Later").click()
    assert page.locator("#view").input_value() == "1"
    chart = plotted(page, "force", ("s", "N"))
    assert chart.titles["x"].startswith("Time since first touch of impact 2")
    (line,) = chart.lines()
    assert_is_line(
        line,
        result.history["time_s"] - result.impacts["time_s"][1],
        result.history["force_N"],
        whole=False,
        tolerance=2e-6,
    )
    # the view stays while the case is changed
    type_value(page, "drop.height", 0.4)
    assert (
        plotted(page, "force", ("s", "N"))
        .titles["x"]
        .startswith("Time since first touch of impact 2")
    )
    assert (
        page.locator("#chart-force .headline").text_content().startswith("Impact 2: largest force")
    )
    page.locator("#view").select_option("-1")
    zoom(page, "force", 0.1, 0.3)
    # an instantaneous law has no contacts to be shown
    page.locator("#view").select_option("2")
    row(page, "contact.law").locator("select").select_option("newton")
    settle(page)
    assert page.locator("#view option").all_text_contents() == ["whole run"]
    assert page.locator("#view").input_value() == "-1"
    assert page.get_by_role("button", name="Later").is_disabled()
    assert names(page) == ["position", "velocity", "energy"]
    row(page, "contact.law").locator("select").select_option("flores")
    settle(page)
    in_order = [one.get_attribute("id") for one in page.locator("#charts section").all()]
    assert in_order == [
        f"chart-{name}"
        for name in ("force", "velocity", "acceleration", "force_indentation", "energy")
    ]


def place_on_plate(page: Page, x: float, y: float) -> tuple[float, float]:
    """Return where a place on the plate [m] is seen in the window."""
    found: list[float] = page.evaluate(
        """([x, y]) => {
          const scene = vibroimpact.live.scene, { centre, scale, middle } = scene.seen, box = scene.canvas.getBoundingClientRect();
          const u = x - middle[0], v = y - middle[1], sin = Math.sin(scene.turn), cos = Math.cos(scene.turn);
          const [across, down] = [centre[0] + scale * (u * cos - v * sin), centre[1] - scale * (u * sin + v * cos) * Math.sin(scene.tilt)];
          return [box.left + across, box.top + down];
        }""",
        [x, y],
    )
    return found[0], found[1]


@pytest.mark.parametrize("case", ["rigid", "elastic"])
def test_the_ball_is_dragged_over_the_plate(case: str, page: Page, server: Server) -> None:
    open_live(page, server, {"rigid": RIGID, "elastic": ELASTIC}[case])
    page.locator("[data-scene=play]").click()
    start = shown(page)["drop"].get("position", [0.0, 0.0])
    page.mouse.move(*place_on_plate(page, *start))
    page.mouse.down()
    for part in (0.5, 1.0):
        page.mouse.move(
            *place_on_plate(
                page, start[0] + part * (0.06 - start[0]), start[1] + part * (-0.04 - start[1])
            ),
            steps=3,
        )
    page.mouse.up()
    settle(page)
    assert shown(page)["drop"]["position"] == pytest.approx([0.06, -0.04], abs=6e-4)
    assert page.evaluate(
        "() => Array.from(vibroimpact.live.state.last.scene.contact)"
    ) == pytest.approx([0.06, -0.04], abs=6e-4)
    told = [
        float(row(page, f"drop.position.{side}").locator("input[type=number]").input_value())
        for side in range(2)
    ]
    assert told == pytest.approx([60, -40], abs=0.6)
    # beside the plate it stays on its edge
    page.mouse.move(*place_on_plate(page, *shown(page)["drop"]["position"]))
    page.mouse.down()
    page.mouse.move(*place_on_plate(page, 0.3, -0.04), steps=4)
    page.mouse.up()
    settle(page)
    assert shown(page)["drop"]["position"][0] == pytest.approx(0.1, abs=1e-12)
    # elsewhere the plate is turned, and the ball stays
    turn = page.evaluate("() => vibroimpact.live.scene.turn")
    page.mouse.move(*place_on_plate(page, -0.07, 0.05))
    page.mouse.down()
    page.mouse.move(*place_on_plate(page, -0.09, -0.07), steps=4)
    page.mouse.up()
    assert page.evaluate("() => vibroimpact.live.scene.turn") != turn
    assert shown(page)["drop"]["position"][0] == pytest.approx(0.1, abs=1e-12)


def test_the_ball_stays_under_the_pointer_while_progress_is_shown(
    page: Page, server: Server
) -> None:
    open_live(page, server, ELASTIC)
    page.locator("[data-scene=play]").click()
    page.mouse.move(*place_on_plate(page, *shown(page)["drop"]["position"]))
    page.mouse.down()
    (x, y), top = (
        place_on_plate(page, 0.05, -0.03),
        "() => document.querySelector('canvas').getBoundingClientRect().top",
    )
    page.mouse.move(x, y, steps=3)
    before = page.evaluate(top)
    page.evaluate("() => { document.getElementById('work').hidden = false; }")
    assert page.evaluate(top) == before
    page.evaluate(
        "() => document.getElementById('warnings').append(vibroimpact.make('p', { text: 'a "
        "line that comes meanwhile' }))"
    )
    assert page.evaluate(top) > before
    page.mouse.move(x, y, steps=1)
    page.mouse.up()
    settle(page)
    assert shown(page)["drop"]["position"] == pytest.approx([0.05, -0.03], abs=6e-4)


def test_a_file_is_dropped_or_chosen(page: Page, server: Server) -> None:
    open_live(page, server)
    assert page.locator("#shipped").input_value() == "paper:type1-theory"
    drop_file(page, "mine.toml", tomli_w.dumps(RIGID).encode())
    until(page, "() => document.title.startsWith('a rigid drop')")
    settle(page)
    assert shown(page)["sphere"]["radius"] == 0.02
    assert page.locator("#shipped").input_value() == ""
    other = {
        **RIGID,
        "name": "another drop",
        "sweep": {"design": "grid", "over": {"drop.height": [1, 2]}},
    }
    page.locator("#file").set_input_files(
        {
            "name": "other.toml",
            "mimeType": "application/toml",
            "buffer": tomli_w.dumps(other).encode(),
        }
    )
    until(page, "() => document.title.startsWith('another drop')")
    settle(page)
    assert page.locator("#warnings > p:not(.warning)").all_text_contents() == [
        "[sweep] is left out here; use: vibroimpact sweep"
    ]
    for content, words in (
        (b"\x00\xff\xfe", "TOML"),
        (b"x" * 200_000, "page of text"),
        (b"", "missing"),
    ):
        drop_file(page, "bad.toml", content)
        assert any(words in line for line in wait_for_fault(page)), words
        # what was shown is still there, and goes on
        assert page.evaluate("document.title").startswith("another drop")
        type_value(page, "drop.height", 0.1 + 0.01 * len(content) ** 0.25)
        assert faults(page) == []


FAULTS: list[str] = [
    tomli_w.dumps(plain_case(sphere__raduis=1)),
    tomli_w.dumps(plain_case(contakt={})),
    tomli_w.dumps(plain_case(sphere__radius="25 kg")),
    tomli_w.dumps(plain_case(sphere__radius=-1, drop__height="4 lightyears per second")),
    tomli_w.dumps(plain_case(contact__law="lankarani")),
    tomli_w.dumps(plain_case(contact__restitution=1.5)),
    tomli_w.dumps(plain_case(drop__gravity=0)),
    tomli_w.dumps(plain_case(plate__size=[0.1, 0.1, 0.01], drop__position=[0.06, 0])),
    tomli_w.dumps(plain_case(sphere__material="steal")),
    tomli_w.dumps(plain_case(sphere=None, drop=None)),
    tomli_w.dumps(plain_case(run__impacts=0)),
    tomli_w.dumps(plain_case(plate={**ELASTIC["plate"], "supports": "glued"})),
    tomli_w.dumps(plain_case(plate={**ELASTIC["plate"], "supports": "free"})),
    tomli_w.dumps(
        plain_case(plate=ELASTIC["plate"], sensors=[{"name": "a", "position": [1.0, 0.0]}])
    ),
    "[sphere\nradius = 1",
    "name = '<img src=x onerror=alert(1)>'\n[sphere]\nradius = '<b>$x$</b>'",
]


def test_messages_are_those_of_the_command_line(
    page: Page,
    server: Server,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    open_live(page, server, RIGID)
    monkeypatch.chdir(tmp_path)
    for number, text in enumerate(FAULTS):
        # a short name, as it takes a part of the length of a message
        path = Path(f"case{number}.toml")
        path.write_text(text, encoding="utf-8")
        monkeypatch.setattr("sys.argv", ["vibroimpact", "check", str(path)])
        with pytest.raises(SystemExit) as ended:
            main()
        assert ended.value.code == 2
        told = [
            line.removeprefix("vibroimpact: ").removeprefix(f"{path}: ")
            for line in capsys.readouterr().err.splitlines()
        ]
        page.evaluate("() => document.getElementById('faults').replaceChildren()")
        drop_file(page, path.name, text.encode())
        until(page, "() => document.querySelectorAll('#faults p').length > 0")
        assert faults(page) == told, text
        settle(page)
        assert page.evaluate("document.title").startswith("a rigid drop")
    assert page.locator("#faults").get_attribute("role") == "alert"
    assert page.locator("#faults img, #faults b").count() == 0


def test_a_wrong_value_is_told_at_its_control_until_it_is_mended(
    page: Page, server: Server
) -> None:
    open_live(page, server, RIGID)
    type_value(page, "contact.restitution", 1.5)
    message = "contact.restitution: 1.5 is not allowed; it must be at least 0 and at most 1"
    assert faults(page) == [message]
    field = row(page, "contact.restitution").locator("input[type=number]")
    assert field.get_attribute("aria-invalid") == "true"
    assert page.locator(f"#{field.get_attribute('aria-describedby')}").text_content() == message
    assert field.input_value() == "1.5"
    assert shown(page)["contact"]["restitution"] == 0.6
    type_value(page, "plate.size.2", -3)
    assert len(faults(page)) == 2
    assert row(page, "plate.size.2").locator("[aria-invalid=true]").count() == 1
    type_value(page, "plate.size.2", 5)
    type_value(page, "contact.restitution", 0.5)
    assert faults(page) == []
    assert page.locator("[aria-invalid], .fault-here").count() == 0
    assert shown(page)["contact"]["restitution"] == 0.5
    assert shown(page)["plate"]["size"][2] == pytest.approx(0.005)


def test_shipped_cases(page: Page, server: Server) -> None:
    open_live(page, server)
    select = page.locator("#shipped")
    assert select.input_value() == "paper:type1-theory"
    select.select_option("paper:type1-variable")
    until(page, "() => vibroimpact.live.state.last.name.includes('variable')")
    settle(page)
    assert select.input_value() == "paper:type1-variable"
    assert shown(page) == resolved_case(vi.case_of(tomllib.loads(toml(page))))
    type_value(page, "drop.height", 3)
    assert select.input_value() == ""
    # the same one can be chosen again
    select.select_option("paper:type1-variable")
    until(page, "() => vibroimpact.live.state.last.case.drop.height === 4")
    settle(page)
    assert select.input_value() == "paper:type1-variable"


def test_reload_back_and_a_second_window(new_page: MakePage, server: Server) -> None:
    page = new_page()
    open_live(page, server, RIGID)
    first = shown(page)
    type_value(page, "drop.height", 0.7)
    type_value(page, "sphere.radius", 15)
    last = shown(page)
    until(page, "() => location.hash.length > 20")
    page.reload()
    page.wait_for_selector("html[data-detail=full]")
    settle(page)
    assert shown(page) == last
    other = new_page()
    other.goto(page.url)
    other.wait_for_selector("html[data-detail=full]")
    settle(other)
    assert shown(other) == last
    page.go_back()
    until(page, "() => vibroimpact.live.state.last.case.sphere.radius === 0.02")
    settle(page)
    assert shown(page) == {**last, "sphere": first["sphere"], "contact": shown(page)["contact"]}
    page.go_back()
    until(page, "() => vibroimpact.live.state.last.case.drop.height === 0.5")
    settle(page)
    assert shown(page) == first
    page.go_forward()
    until(page, "() => vibroimpact.live.state.last.case.drop.height === 0.7")
    # the other window was not disturbed, and does not disturb
    assert shown(other) == last
    for value in (0.31, 0.32):
        row(page, "drop.height").locator("input[type=number]").fill(str(value))
        row(other, "drop.height").locator("input[type=number]").fill(str(value + 0.5))
        page.keyboard.press("Enter")
        other.keyboard.press("Enter")
        settle(page)
        settle(other)
        assert shown(page)["drop"]["height"] == value
        assert shown(other)["drop"]["height"] == value + 0.5


def test_an_address_without_a_case(page: Page, server: Server) -> None:
    # no compression, a list, no letters
    for fragment in ("#case=AAAA", "#case=eJyLjgUAARUAuQ", "#case=!!"):
        page.goto("about:blank")
        page.goto(server.address + fragment)
        assert wait_for_fault(page) == ["the address does not hold a case; choose one above"]
        page.locator("#shipped").select_option("paper:type1-theory")
        page.wait_for_selector("html[data-detail=full]")
        settle(page)
        assert faults(page) == []


def test_the_link_to_the_results_leaves_the_address(page: Page, server: Server) -> None:
    open_live(page, server, RIGID)
    address = page.url
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("() => document.activeElement.id") == "results"
    assert page.url == address
    page.goto("about:blank")
    page.goto(f"{server.address}#results")
    page.wait_for_selector("html[data-detail=full]")
    settle(page)
    assert page.locator("#shipped").input_value() == "paper:type1-theory"


def test_the_page_goes_on_after_the_server_was_started_again(
    page: Page, new_server: Callable[..., Server], complaints: list[str]
) -> None:
    first = new_server()
    open_live(page, first, RIGID)
    type_value(page, "drop.height", 0.7)
    before = page.evaluate("() => document.documentElement.dataset.drawn")
    first.stop()
    until(
        page,
        "() => "
        "document.getElementById('status').textContent.startsWith('The server does not answer')",
    )
    # what is changed meanwhile is computed afterwards
    field = row(page, "drop.height").locator("input[type=number]")
    field.fill("0.8")
    field.press("Enter")
    new_server(port=first.port)
    page.wait_for_selector(f"html[data-detail=full]:not([data-drawn='{before}'])")
    settle(page)
    assert shown(page)["drop"]["height"] == 0.8
    type_value(page, "drop.height", 0.9)
    assert shown(page)["drop"]["height"] == 0.9
    complaints[:] = [one for one in complaints if "WebSocket connection to" not in one]


def test_cancel_keeps_the_last_plate(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    before, charts = shown(page), page.evaluate("() => document.documentElement.dataset.drawn")
    slow = {
        **ELASTIC,
        "plate": {**ELASTIC["plate"], "mesh": {"element_size": "5 mm"}, "modes": 400},
    }
    drop_file(page, "slow.toml", tomli_w.dumps(slow).encode())
    page.locator("#work").wait_for()
    until(page, "() => document.getElementById('work-words').textContent === 'computing modes'")
    page.locator("#cancel").click()
    settle(page)
    assert page.locator("#status").text_content() == "Given up; the last case is shown."
    assert page.locator("#work").is_hidden()
    assert shown(page) == before
    assert page.evaluate("() => document.documentElement.dataset.drawn") == charts
    assert row(page, "plate.modes").locator("input[type=number]").input_value() == "6"
    type_value(page, "drop.height", 0.25)
    assert shown(page) == {**before, "drop": {**before["drop"], "height": 0.25}}


def test_cancel_while_the_case_in_full_waits(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    before = shown(page)
    page.evaluate(
        """() => vibroimpact.live.controls.change(
            (table) => { table.plate.mesh = { element_size: "4.9 mm" }; table.plate.modes = 400; }, true)"""
    )
    until(
        page,
        "() => document.getElementById('work-words').textContent === 'computing modes' && "
        "vibroimpact.live.state.detail === 'full'",
    )
    page.locator("#cancel").click()
    settle(page)
    assert page.locator("#status").text_content() == "Given up; the last case is shown."
    assert page.locator("#work").is_hidden()
    assert page.locator("#get-report").is_enabled()
    assert not page.evaluate("() => vibroimpact.live.scene.waiting")
    assert shown(page) == before


def test_a_change_while_modes_are_computed_wins(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    slow = {
        **ELASTIC,
        "plate": {**ELASTIC["plate"], "mesh": {"element_size": "6.1 mm"}, "modes": 120},
    }
    drop_file(page, "slow.toml", tomli_w.dumps(slow).encode())
    page.locator("#work").wait_for()
    page.locator("#shipped").select_option("paper:type1-theory")
    until(page, "() => vibroimpact.live.state.last.case.plate.model === 'rigid'")
    settle(page)
    assert page.locator("#work").is_hidden()
    assert faults(page) == []


def test_hold_shows_the_case_of_before_beside_the_new_one(
    page: Page, server: Server, tmp_path: Path
) -> None:
    open_live(page, server, RIGID)
    held = computed(page, tmp_path)
    hold = page.get_by_role("button", name="Hold to compare")
    hold.click()
    type_value(page, "drop.height", 0.8)
    result = computed(page, tmp_path)
    ghost, own = plotted(page, "position", ("s", "m")).lines()
    assert_is_line(ghost, held.history["time_s"], held.history["position_m"], whole=True)
    assert_is_line(own, result.history["time_s"], result.history["position_m"], whole=True)
    look = page.evaluate("() => vibroimpact.live.charts.get('position').element.data[0].line")
    assert look["dash"] == "4px,3px"
    lines = tables(page, "impacts")
    kept = impact_table(held).rows
    assert lines == [
        *impact_table(result).rows,
        *([f"held {cells[0]}", *cells[1:]] for cells in kept),
    ]
    assert [cells[3] for cells in tables(page, "ledger")] == [
        one.energy for one in ledger_table(held)[1]
    ]
    release = page.get_by_role("button", name="Release")
    assert release.get_attribute("aria-pressed") == "true"
    release.click()
    assert len(plotted(page, "position", ("s", "m")).lines()) == 1
    assert len(tables(page, "impacts")) == len(kept)


def test_what_is_held_is_aligned_at_first_touch_in_a_view(
    page: Page, server: Server, tmp_path: Path
) -> None:
    """The impact of the case held, from its own first touch and height; a smaller ball
    falls longer, and its energies have other units.
    """
    open_live(page, server, RIGID)
    held = computed(page, tmp_path)
    page.get_by_role("button", name="Hold to compare").click()
    type_value(page, "sphere.radius", 2)
    type_value(page, "drop.height", 0.1)
    result = computed(page, tmp_path)
    page.locator("#view").select_option("1")
    ghost, own = plotted(page, "position", ("s", "m")).lines()
    for line, one, radius in ((ghost, held, 0.02), (own, result, 0.002)):
        touch = one.impacts["time_s"][1]
        near = np.abs(one.history["time_s"] - touch) < 2e-4
        expected = np.interp(
            line.x, one.history["time_s"][near] - touch, one.history["position_m"][near] - radius
        )
        inside = (line.x > one.history["time_s"][near][0] - touch) & (
            line.x < one.history["time_s"][near][-1] - touch
        )
        assert inside.sum() > 10
        np.testing.assert_allclose(
            line.y[inside], expected[inside], rtol=0, atol=1e-3 * np.abs(line.y[inside]).max()
        )
    table, kept = impact_table(result), impact_table(held)
    place = [name for name, _ in kept.headings].index("Largest force")
    (now, before), cell = (one.headings[place][1] for one in (table, kept)), kept.rows[0][place]
    assert now != before
    assert tables(page, "impacts")[len(table.rows)][place] == f"{cell} {before}"
    units = [ledger_table(one)[0] for one in (result, held)]
    assert units[0] != units[1]
    assert [cells[3] for cells in tables(page, "ledger")] == [
        f"{one.energy} {units[1]}" for one in ledger_table(held)[1]
    ]


SOUNDS = """
window.sounds = { started: 0, stopped: 0, ended: 0, buffers: [] };
const { start, stop } = AudioBufferSourceNode.prototype;
AudioBufferSourceNode.prototype.start = function (...given) {
  sounds.started += 1;
  sounds.buffers.push({ rate: this.buffer.sampleRate, speed: this.playbackRate.value, values: Array.from(this.buffer.getChannelData(0)) });
  return start.apply(this, given);
};
AudioBufferSourceNode.prototype.stop = function (...given) { sounds.stopped += 1; return stop.apply(this, given); };
"""


def test_the_sound_of_a_sensor_is_played_and_stopped(
    page: Page, server: Server, tmp_path: Path
) -> None:
    page.add_init_script(SOUNDS)
    open_live(page, server, ELASTIC)
    (signal,) = computed(page, tmp_path).signals.values()
    page.locator("#sound-slowed").select_option("16")
    play = page.locator("#sound-play")
    play.click()
    assert play.text_content() == "Stop"
    play.click()
    until(page, "() => document.getElementById('sound-play').textContent === 'Play the sound'")
    page.locator("#sound-slowed").select_option("1")
    play.click()
    # by itself, at its end
    until(page, "() => document.getElementById('sound-play').textContent === 'Play the sound'")
    sounds = page.evaluate("() => sounds")
    assert (sounds["started"], sounds["stopped"]) == (2, 1)
    assert sounds["buffers"][1]["speed"] * sounds["buffers"][1]["rate"] == pytest.approx(
        signal.sensor.rate
    )
    assert sounds["buffers"][0]["speed"] == pytest.approx(sounds["buffers"][1]["speed"] / 16)
    values = np.array(sounds["buffers"][0]["values"])
    np.testing.assert_allclose(values, 0.9 * signal.value / np.abs(signal.value).max(), atol=1e-6)
    page.get_by_role("button", name="Remove sensor a1").click()
    settle(page)
    assert page.locator("#sound").is_hidden()


def download(page: Page, button: str) -> list[tuple[str, str]]:
    """Press a button, and return name and text of the file that comes."""
    with page.expect_download() as found:
        page.locator(button).click()
    return [(found.value.suggested_filename, found.value.path().read_text(encoding="utf-8"))]


def test_downloads_are_what_the_library_writes(
    page: Page, server: Server, tmp_path: Path, new_page: MakePage
) -> None:
    open_live(page, server, ELASTIC)
    type_value(page, "drop.height", 0.22)
    result = computed(page, tmp_path)
    ((name, text),) = download(page, "#get-signals")
    assert name == "a1.csv"
    assert text == signal_csv(result.signals["a1"])
    assert len(list(csv.reader(io.StringIO(text)))) > len(result.signals["a1"].value)
    ((name, text),) = download(page, "#get-report")
    assert name == "an-elastic-drop.html"
    (tmp_path / name).write_text(text, encoding="utf-8")
    report = new_page()
    report.goto((tmp_path / name).as_uri())
    report.wait_for_selector("html[data-ready=true]")
    assert_history_is_drawn(report, result, result.history)
    assert (
        resolved_case(vi.case_of(tomllib.loads(report.locator("#case-text").text_content())))
        == result.case
    )


def test_reports_and_signals_wait_for_the_case_that_is_shown(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    assert page.locator("#get-report").is_enabled()
    move = (
        "(id) => { const range = document.getElementById(id); range.value = '0.6'; "
        "range.dispatchEvent(new Event('input')); }"
    )
    page.evaluate(move, "c-drop-height-slider")
    assert page.locator("#get-report").is_disabled()
    assert page.locator("#get-signals").is_disabled()


def test_a_thirteenth_window_is_told_why_it_waits(
    page: Page, new_page: MakePage, server: Server
) -> None:
    open_live(page, server, RIGID)
    page.evaluate(
        """() => { window.others = Array.from({ length: 11 }, () => new WebSocket(`ws://${location.host}/live`));
        return Promise.all(others.map((one) => new Promise((done) => { one.onopen = done; }))).then(() => true); }"""
    )
    last = new_page()
    last.goto(server.address)
    until(
        last,
        "() => document.getElementById('status').textContent === 'there are 12 windows "
        "already; close one'",
    )
    page.evaluate("() => others[0].close()")
    last.wait_for_selector("html[data-detail=full]")
    settle(last)
    assert re.match(r"Stopped after 5 impacts", last.locator("#status").text_content())


def test_a_case_that_is_too_long_for_a_message(page: Page, server: Server) -> None:
    open_live(page, server, RIGID)
    drop_file(page, "long.toml", b"\n" * 149_000)
    assert wait_for_fault(page) == [
        "the case has 298036 bytes; 200000 are the most of the live page"
    ]
    type_value(page, "drop.height", 0.6)
    assert faults(page) == []
