"""The report of a run in a browser: what it draws is what was computed, and its controls
do what they say.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image

import vibroimpact as vi
from live_page import LONG_NAMES
from page_access import (
    assert_headings_are_in_order,
    faint_texts,
    names_of_controls,
    scrolls_sideways,
)
from plotted import (
    COLUMNS,
    ROWS,
    UNITS,
    assert_history_is_drawn,
    assert_is_line,
    assert_loops_are_drawn,
    names,
    plot_area,
    plotted,
    show,
    unit_size,
    until,
    zoom,
)
from vibroimpact.charts.palette import DIVERGING, DIVERGING_ON_DARK
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.spectrum import amplitude_spectrum, first_response
from vibroimpact.runs.tables import impact_table, ledger_table

if TYPE_CHECKING:
    from playwright.sync_api import Page

MakePage = Callable[..., "Page"]

HOSTILE = """<script>document.title = "taken"</script><img src=x onerror="document.title='taken'">$x_2$ "'`&amp; \U0001f4a5"""

CASES: dict[str, Any] = {
    "type1": "paper:type1-variable",
    "type3": "paper:type3",
    "newton": {
        "sphere": {"radius": 0.02, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": 1.0},
        "contact": {"law": "newton", "restitution": 0.6},
        "run": {"impacts": 4},
    },
    "no impact": {
        "sphere": {"radius": 0.02, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": 1.0},
        "contact": {"law": "hunt-crossley", "restitution": 0.6},
        "run": {"duration": 0.1},
    },
    "hostile": {
        "name": HOSTILE,
        "sphere": {"radius": 0.02, "material": "steel"},
        "plate": {
            "size": [0.2, 0.15, 0.006],
            "material": "steel",
            "model": "elastic",
            "modes": 6,
            "supports": [
                {"type": "point", "position": [x, y]} for x in (-0.09, 0.09) for y in (-0.07, 0.07)
            ],
        },
        "drop": {"height": 0.2},
        "contact": {"law": "hertz"},
        "run": {"impacts": 2},
        "sensors": [
            {"name": HOSTILE, "position": [0.02, 0.01]},
            {"name": "'; drop $\\alpha$ \U0001f600", "position": [0, 0], "quantity": "velocity"},
        ],
    },
    "long names": LONG_NAMES,
}
CHARTS = {
    "type1": [
        "setup",
        "position",
        "force",
        "velocity",
        "acceleration",
        "force_indentation",
        "energy",
    ],
    "newton": ["setup", "position", "velocity", "energy"],
    "no impact": ["setup", "position", "velocity", "energy"],
}


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Result, Path]]:
    """Return the result of a case and the file of its report."""
    made: dict[str, tuple[Result, Path]] = {}
    folder = tmp_path_factory.mktemp("reports")

    def make(name: str) -> tuple[Result, Path]:
        if name not in made:
            result = result_of(
                vi.simulate(
                    vi.load_case(CASES[name])
                    if isinstance(CASES[name], str)
                    else vi.case_of(CASES[name])
                )
            )
            path = folder / f"{name}.html"
            path.write_text(page_of_report(result.report), encoding="utf-8")
            made[name] = result, path
        return made[name]

    return make


def open_report(page: Page, path: Path) -> None:
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]")


@pytest.mark.parametrize("case", CASES)
def test_every_chart_is_drawn_with_the_numbers_of_the_result(
    case: str, page: Page, report: Any
) -> None:
    result, path = report(case)
    open_report(page, path)
    assert (
        page.evaluate("document.title")
        == f"{result.name[:1].upper()}{result.name[1:]} \u2013 vibroimpact report"
    )
    found = names(page)
    if case in CHARTS:
        assert found == CHARTS[case]
    else:
        assert found[:7] == CHARTS["type1"]
        assert len(found) == 10 + len(result.signals)
    history = result.history
    assert_history_is_drawn(page, result, history)
    if "force_indentation" in found:
        assert_loops_are_drawn(page, result, history)
    for name in ("sphere_energy", "plate_motion", "plate_energy"):
        if name in found:
            assert_rows_are_drawn(page, name, history)
    for name, chart in zip(
        result.signals, [one for one in found if one.startswith("sensor_")], strict=True
    ):
        assert_sensor_is_drawn(page, result, name, chart)
    sketch = plotted(page, "setup")
    assert any("radius" in note for note in sketch.notes)
    # every chart has letters and lines on the page
    for name in found:
        show(page, name)
        assert page.locator(f'[data-chart="{name}"] svg path').count() > 3
        assert page.locator(
            f'[data-chart="{name}"] .js-line, [data-chart="{name}"] .point, '
            f'[data-chart="{name}"] .js-fill'
        ).count()


def rows_of(page: Page, name: str, view: int | None = None) -> list[tuple[str, Any]]:
    chart = plotted(page, name)
    panels = [title for title in chart.notes if title]
    found = []
    for number, title in enumerate(panels):
        panel = "y" if number == 0 else f"y{number + 1}"
        key = (
            f"{title} of the plate"
            if name == "plate_energy" and title.endswith("strain and kinetic")
            else title
        )
        unit = next(
            one
            for one in ("m/s2", "m/s", "m", "J")
            if chart.titles[panel].replace("²", "2").endswith(one)
        )
        found.append((key, plotted(page, name, {panel: ("s", unit)}).lines(panel)))
    return found


def assert_rows_are_drawn(page: Page, name: str, history: Any) -> None:
    rows = rows_of(page, name)
    assert len(rows) >= 2
    for title, (line,) in rows:
        assert_is_line(line, history["time_s"], ROWS[title](history), whole=True, tolerance=3e-6)


def assert_sensor_is_drawn(page: Page, result: Result, name: str, chart: str) -> None:
    signal = result.signals[name]
    shown = plotted(page, chart, {"y": ("s", signal.sensor.unit), "y2": ("Hz", signal.sensor.unit)})
    (line,), (spectrum,) = shown.lines("y"), shown.lines("y2")
    assert_is_line(line, signal.time, signal.value, whole=True)
    own = amplitude_spectrum(signal.value[first_response(result, name)], signal.sensor.rate)
    assert_is_line(spectrum, own.frequency[1:], own.amplitude[1:], whole=True, tolerance=1e-5)


@pytest.mark.parametrize("case", ["type1", "type3"])
def test_views_show_contacts_to_a_tenth_of_a_pixel(case: str, page: Page, report: Any) -> None:
    result, path = report(case)
    open_report(page, path)
    impacts, history = result.impacts, result.history
    for number in range(len(impacts["impact"])):
        page.select_option("#view", str(number))
        touch = impacts["time_s"][number]
        until(
            page,
            "(wanted) => "
            "document.querySelector('[data-headline=force]').textContent.startsWith(wanted)",
            f"Impact {number + 1}:",
        )
        for name, column in COLUMNS.items():
            chart = plotted(page, name, ("s", UNITS[name]))
            assert chart.titles["x"].startswith(f"Time since first touch of impact {number + 1} [")
            (line,) = chart.lines()
            level = (
                history["position_m"][np.searchsorted(history["time_s"], impacts["time_s"][0])]
                if name == "position"
                else 0.0
            )
            time = history["time_s"] - touch
            seen = (time >= line.x[0]) & (time <= line.x[-1])
            drawn = np.interp(time[seen], line.x, line.y)
            away = np.abs(drawn - (history[column] - level)[seen])
            assert away.max() <= 3.1e-4 * np.ptp(line.y)
            # all of the contact is there, and it fills the window
            assert line.x[0] <= 0.0
            assert line.x[-1] >= impacts["duration_s"][number]
            wide = chart.ranges["x"][1] - chart.ranges["x"][0]
            # and its values fill the height
            high = (chart.ranges["y"][1] - chart.ranges["y"][0]) * unit_size(
                chart.titles["y"], UNITS[name]
            )
            assert high < 1.5 * np.ptp(line.y)
            scale = {"s": 1.0, "ms": 1e-3, "µs": 1e-6}[
                re.search(r"\[(.+)\]", chart.titles["x"]).group(1)
            ]
            assert 1.29 <= wide * scale / impacts["duration_s"][number] <= 1.31
        headline = page.locator("[data-headline=force]").text_content()
        force = float(re.search(r"force ([\d.]+)", headline).group(1))
        assert force == pytest.approx(impacts["max_force_N"][number] / 1e3, rel=1e-3)
    page.select_option("#view", "-1")
    assert_history_is_drawn(page, result, history)


def test_views_of_what_the_plate_does(page: Page, report: Any) -> None:
    result, path = report("type3")
    open_report(page, path)
    page.select_option("#view", "2")
    touch, history = result.impacts["time_s"][2], result.history
    for name in ("sphere_energy", "plate_motion", "plate_energy"):
        for title, (line,) in rows_of(page, name):
            # a view of the plate holds more points than are drawn at once: of these there are the
            # extremes
            inside = (history["time_s"] - touch >= line.x[0] - 1e-9) & (
                history["time_s"] - touch <= line.x[-1] + 1e-9
            )
            values = ROWS[title](history)
            assert_is_line(
                line,
                (history["time_s"] - touch)[inside],
                values[inside],
                whole=True,
                tolerance=3e-6 * np.abs(values).max() / max(np.abs(values[inside]).max(), 1e-30),
            )


def test_buttons_of_the_table_show_the_impact(page: Page, report: Any) -> None:
    result, path = report("type1")
    open_report(page, path)
    table = impact_table(result)
    rows = page.locator("table.impacts tbody tr")
    assert [
        [cell.strip() for cell in row.locator("td").all_text_contents()] for row in rows.all()
    ] == table.rows
    page.get_by_role("button", name="Show impact 3 in the charts").click()
    assert page.locator("#view").input_value() == "2"
    assert page.locator("tr.chosen td").first.text_content().strip() == "3"
    until(page, "() => document.getElementById('charts').getBoundingClientRect().top < 200")
    assert (
        plotted(page, "force", ("s", "N"))
        .titles["x"]
        .startswith("Time since first touch of impact 3")
    )
    page.get_by_role("button", name="Later").click()
    assert page.locator("#view").input_value() == "3"
    page.get_by_role("button", name="Later").click()
    assert page.get_by_role("button", name="Later").is_disabled()
    for _ in range(5):
        page.get_by_role("button", name="Earlier").click()
    assert page.locator("#view").input_value() == "-1"
    assert page.get_by_role("button", name="Earlier").is_disabled()
    ledger = [
        row.all_text_contents()
        for row in (
            page.locator(f"table.ledger tbody tr:nth-child({n + 1}) > *")
            for n in range(len(ledger_table(result)[1]))
        )
    ]
    assert ledger == [[row.title, row.energy, row.part] for row in ledger_table(result)[1]]


def test_zoom_reads_all_points_and_a_double_click_goes_back(page: Page, report: Any) -> None:
    result, path = report("type3")
    open_report(page, path)
    name = next(one for one in names(page) if one.startswith("sensor_"))
    signal = next(iter(result.signals.values()))
    (whole,) = plotted(page, name, {"y": ("s", signal.sensor.unit), "y2": ("Hz", "")}).lines("y")
    assert len(whole.x) < 3000 < len(signal.value)  # decimated
    for _ in range(3):
        zoom(page, name, 0.26, 0.36)
    (near,) = plotted(page, name, {"y": ("s", signal.sensor.unit), "y2": ("Hz", "")}).lines("y")
    assert near.x[-1] - near.x[0] < 0.01 * (whole.x[-1] - whole.x[0])
    assert_is_line(near, signal.time, signal.value, whole=False)
    assert len(near.x) == pytest.approx((near.x[-1] - near.x[0]) * signal.sensor.rate, abs=2)
    area = plot_area(page, name)
    page.mouse.dblclick(area["left"] + 0.5 * area["width"], area["top"] + 0.5 * area["height"])
    until(page, "(name) => !Object.keys(vibroimpact.charts.get(name).state.ranges).length", name)
    (again,) = plotted(page, name, {"y": ("s", signal.sensor.unit), "y2": ("Hz", "")}).lines("y")
    np.testing.assert_array_equal(again.x, whole.x)


def test_a_zoom_survives_the_theme_and_ends_with_the_view(page: Page, report: Any) -> None:
    _, path = report("type1")
    open_report(page, path)
    zoom(page, "force", 0.1, 0.3)
    ranges = plotted(page, "force", ("s", "N")).ranges["x"]
    page.get_by_role("button", name="Light or dark").click()
    assert plotted(page, "force", ("s", "N")).ranges["x"] == pytest.approx(ranges)
    page.select_option("#view", "0")
    page.select_option("#view", "-1")
    assert plotted(page, "force", ("s", "N")).ranges["x"] != pytest.approx(ranges)


def test_a_zoom_of_logarithmic_axes_survives_the_theme(page: Page, report: Any) -> None:
    result, path = report("type3")
    open_report(page, path)
    name = next(one for one in names(page) if one.startswith("sensor_"))
    plotted(
        page, name, {"y": ("s", next(iter(result.signals.values())).sensor.unit), "y2": ("Hz", "")}
    )
    ranges = """(name) => { const { layout } = vibroimpact.charts.get(name).element;
        return Object.keys(layout).filter((key) => layout[key].type === "log").map((key) => [key, Array.from(layout[key].range)]); }"""
    whole = dict(page.evaluate(ranges, name))
    assert whole
    inside = {
        key: [low + 0.2 * (high - low), high - 0.3 * (high - low)]
        for key, (low, high) in whole.items()
    }
    page.evaluate(
        """([name, change]) => Plotly.relayout(vibroimpact.charts.get(name).element, change)""",
        [
            name,
            {
                f"{key}.range[{end}]": value
                for key, ends in inside.items()
                for end, value in enumerate(ends)
            },
        ],
    )
    page.get_by_role("button", name="Light or dark").click()
    page.evaluate("(name) => vibroimpact.charts.get(name).drawing", name)
    for key, ends in page.evaluate(ranges, name):
        assert ends == pytest.approx(inside[key], abs=1e-9)


def test_hover_tells_value_and_unit(page: Page, report: Any) -> None:
    result, path = report("type1")
    open_report(page, path)
    show(page, "force")
    crest = [result.impacts["time_of_max_force_s"][1], result.impacts["max_force_N"][1] / 1e3]
    words = ""
    for _ in range(60):
        # charts above may still be drawn, and move the place
        place = page.evaluate(
            """([time, force]) => { const element = vibroimpact.charts.get("force").element, box = element.getBoundingClientRect();
            const { xaxis, yaxis } = element._fullLayout;
            return [box.left + xaxis._offset + xaxis.d2p(time), box.top + yaxis._offset + yaxis.d2p(force)]; }""",
            crest,
        )
        page.mouse.move(place[0] - 30, place[1] + 10)
        page.mouse.move(*place, steps=4)
        page.wait_for_timeout(500)
        labels = page.locator('[data-chart="force"] .hoverlayer .hovertext').all_text_contents()
        words = next((label for label in labels if "impact 2" in label), "")
        if words:
            break
    assert re.search(r"\d kN", words)
    assert re.search(r"\d s", words)
    told = float(re.search(r"([\d.]+) kN", words).group(1))
    assert told == pytest.approx(result.impacts["max_force_N"][1] / 1e3, rel=1e-4)


def test_charts_are_offered_to_be_sent_nowhere(page: Page, report: Any) -> None:
    _, path = report("type1")
    open_report(page, path)
    show(page, "force")
    buttons = page.locator('[data-chart="force"] .modebar-btn').all()
    assert [one.get_attribute("data-title") for one in buttons] == [
        "Download plot as a PNG",
        "Zoom",
        "Pan",
        "Zoom in",
        "Zoom out",
        "Reset axes",
    ]
    page.locator('[data-chart="force"]').hover()
    with page.expect_download() as download:
        buttons[0].click()
    assert download.value.path().read_bytes()[:4] == b"\x89PNG"
    (before,) = plotted(page, "force", ("s", "N")).lines()
    for button in (buttons[3], buttons[5]):  # zoom in, and back
        button.click()
    (after,) = plotted(page, "force", ("s", "N")).lines()
    np.testing.assert_array_equal(after.x, before.x)


def test_theme_follows_the_system_and_the_button(new_page: MakePage, report: Any) -> None:
    _, path = report("type1")
    for scheme, other in (("light", "dark"), ("dark", "light")):
        page = new_page(color_scheme=scheme)
        open_report(page, path)
        assert page.locator("html").get_attribute("data-theme") == scheme
        grounds = []
        for theme in (scheme, other):
            assert page.locator("html").get_attribute("data-theme") == theme
            show(page, "force")
            ground = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
            line = page.evaluate(
                "() => vibroimpact.charts.get('force').element._fullLayout.font.color"
            )
            grounds.append((ground, line))
            page.get_by_role("button", name="Light or dark").click()
        assert grounds[0][0] != grounds[1][0]
        assert grounds[0][1] != grounds[1][1]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_everything_has_a_name_and_stands_out(scheme: str, new_page: MakePage, report: Any) -> None:
    _, path = report("type3")
    page = new_page(color_scheme=scheme)
    open_report(page, path)
    page.select_option("#view", "0")
    for name in names(page):
        show(page, name)
    found = names_of_controls(page)
    assert len(found) > 40
    assert [role for role, name in found if not name] == []
    assert_headings_are_in_order(page)
    assert page.locator("tr.chosen").count() == 1
    assert faint_texts(page) == []


def test_scene_plays_pauses_scrubs_and_turns(page: Page, report: Any) -> None:
    _, path = report("type3")
    open_report(page, path)
    page.locator("#scene").scroll_into_view_if_needed()
    play, place, clock = (
        page.locator("[data-scene=play]"),
        page.locator("[data-scene=place]"),
        page.locator("[data-scene=clock]"),
    )
    # it begins as it comes into sight
    until(page, "() => document.querySelector('[data-scene=play]').textContent === 'Pause'")
    before = clock.text_content()
    until(
        page,
        "(before) => document.querySelector('[data-scene=clock]').textContent !== before",
        before,
    )
    play.click()
    assert play.text_content() == "Play"
    still = clock.text_content()
    picture = "() => document.querySelector('#scene canvas').toDataURL()"
    first = page.evaluate(picture)
    page.evaluate(
        "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    assert page.evaluate(picture) == first
    place.fill("800")
    assert clock.text_content() != still
    assert page.evaluate(picture) != first
    place.press("Home")
    assert clock.text_content().endswith("before first touch")
    first = page.evaluate(picture)
    canvas = page.locator("#scene canvas")
    canvas.focus()
    page.keyboard.press("ArrowLeft")
    turned = page.evaluate(picture)
    assert turned != first
    page.keyboard.press("ArrowUp")
    assert page.evaluate(picture) != turned
    box = canvas.bounding_box()
    first = page.evaluate(picture)
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.4 * box["height"], steps=4)
    page.mouse.up()
    assert page.evaluate(picture) != first
    # it is not turned any more once it is let go
    first = page.evaluate(picture)
    page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.2 * box["height"], steps=4)
    assert page.evaluate(picture) == first


def test_a_plate_at_rest_has_the_colour_of_the_theme(new_page: MakePage, report: Any) -> None:
    """Beside the ball, of a plate that stands still: also after the theme was changed."""
    page = new_page(reduced_motion="reduce", color_scheme="dark")
    _, path = report("type3")
    open_report(page, path)

    def near(colour: str) -> bool:
        picture = Image.open(BytesIO(page.locator("#scene canvas").screenshot())).convert("RGB")
        seen = picture.getpixel((picture.width // 2, 7 * picture.height // 10))
        wanted = [int(colour[at : at + 2], 16) for at in (1, 3, 5)]
        return max(abs(one - other) for one, other in zip(seen, wanted, strict=True)) < 12

    assert near(DIVERGING_ON_DARK[2][1])
    page.get_by_role("button", name="Light or dark").click()
    assert near(DIVERGING[2][1])


def test_less_motion_is_respected(new_page: MakePage, report: Any) -> None:
    page = new_page(reduced_motion="reduce")
    _, path = report("type3")
    open_report(page, path)
    page.locator("#scene").scroll_into_view_if_needed()
    page.evaluate(
        "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    assert page.locator("[data-scene=play]").text_content() == "Play"


def test_case_can_be_copied(new_page: MakePage, report: Any) -> None:
    result, path = report("type1")
    page = new_page()
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    open_report(page, path)
    page.locator("summary", has_text="Case").click()
    button = page.locator("button[data-copy]")
    button.click()
    until(page, "() => document.querySelector('button[data-copy]').textContent !== 'Copy'")
    found = {
        "Copied": "() => navigator.clipboard.readText()",
        "Selected: press Ctrl+C": "() => getSelection().toString()",
    }
    copied = page.evaluate(found[button.text_content()])
    assert vi.case_of(tomllib.loads(copied)) == vi.case_of(result.case)


def test_hostile_texts_are_shown_as_they_are(page: Page, report: Any) -> None:
    result, path = report("hostile")
    open_report(page, path)
    assert page.locator("h1").text_content() == HOSTILE
    assert page.locator("main script, main img[src=x], [data-chart] a").count() == 0
    charts = [one for one in names(page) if one.startswith("sensor_")]
    shown = page.locator("h3").all_text_contents()
    for name, chart in zip(result.signals, charts, strict=True):
        assert any(name[:20] in title for title in shown)
        show(page, chart)
    show(page, "setup")
    letters = " ".join(page.locator('[data-chart="setup"] .annotation-text').all_text_contents())
    assert "<script>" in letters
    assert "$\\alpha$" in letters
    for number in range(2):
        page.select_option("#view", str(number))
        for name in names(page):
            show(page, name)
    assert page.evaluate("() => document.title.startsWith('<script>')")
    # nothing runs but the scripts of the page itself
    policy = page.locator("meta[http-equiv=Content-Security-Policy]").get_attribute("content")
    assert "unsafe-eval" not in policy
    assert "'unsafe-inline'" not in policy.split("style-src")[0]


def test_a_script_that_is_put_into_the_page_does_not_run(
    page: Page, report: Any, tmp_path: Path, complaints: list[str]
) -> None:
    _, path = report("type1")
    text = path.read_text(encoding="utf-8").replace(
        "</main>",
        "<script>document.title = 'taken'</script><img src='https://example.org/a.png' "
        "onerror='document.title = 2'></main>",
    )
    (tmp_path / "changed.html").write_text(text, encoding="utf-8")
    open_report(page, tmp_path / "changed.html")
    assert "vibroimpact report" in page.evaluate("document.title")
    assert complaints
    assert all("Content Security Policy" in one or "example.org" in one for one in complaints)
    complaints.clear()


@pytest.mark.parametrize("case", ["type1", "type3"])
def test_without_scripts_there_are_tables_and_a_notice(
    case: str, new_page: MakePage, report: Any, complaints: list[str]
) -> None:
    result, path = report(case)
    page = new_page(java_script_enabled=False)
    page.goto(path.as_uri())
    notice = page.locator("noscript p")
    assert "need scripts" in notice.text_content()
    assert notice.is_visible()
    assert page.locator("table.impacts tbody tr").count() == len(result.impacts["impact"])
    page.locator("summary", has_text="Case").click()
    assert page.locator("#case-text").is_visible()
    assert (
        page.locator(":not(td) > button, select, canvas, .chart").filter(visible=True).count() == 0
    )
    complaints[:] = [one for one in complaints if "script" not in one.lower()]


@pytest.mark.parametrize(("case", "pages"), [("type1", 4), ("type3", 8), ("hostile", 8)])
def test_on_paper_pages_are_full(case: str, pages: int, new_page: MakePage, report: Any) -> None:
    """The numbers of pages are those of a print that was looked at."""
    _, path = report(case)
    page = new_page(color_scheme="dark")
    open_report(page, path)
    printed = page.pdf(format="A4", print_background=True, prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) <= pages
    assert page.locator("html").get_attribute("data-theme") == "dark"  # as before


def test_on_paper_everything_is_there(new_page: MakePage, report: Any) -> None:
    _, path = report("type3")
    page = new_page(color_scheme="dark")
    open_report(page, path)
    closed = page.locator("details:not([open])").count()
    assert closed
    page.emulate_media(media="print", color_scheme="dark")
    page.evaluate("() => dispatchEvent(new Event('beforeprint'))")
    assert page.locator("html").get_attribute("data-theme") == "light"
    assert page.locator("details:not([open])").count() == 0
    assert page.locator("[data-view] td:first-child").first.is_visible()
    assert page.locator("[data-view] button").first.is_visible()
    assert page.locator("#theme, .tools, .player").filter(visible=True).count() == 0
    widths = page.evaluate(
        "() => [...vibroimpact.charts].map(([name, one]) => [name, one.element._fullLayout.width])"
    )
    assert dict(widths) == {name: 680 if name == "setup" else 330 for name in names(page)}
    page.emulate_media(media="screen", color_scheme="dark")
    page.evaluate("() => dispatchEvent(new Event('afterprint'))")
    assert page.locator("html").get_attribute("data-theme") == "dark"
    assert page.locator("details:not([open])").count() == closed
    show(page, "force")
    assert page.evaluate("() => vibroimpact.charts.get('force').element._fullLayout.width") > 700


@pytest.mark.parametrize("size", [(390, 844), (1024, 768), (1440, 900)])
@pytest.mark.parametrize("case", ["type3", "hostile", "long names"])
def test_the_page_does_not_scroll_sideways(
    case: str, size: tuple[int, int], new_page: MakePage, report: Any
) -> None:
    _, path = report(case)
    page = new_page(*size)
    open_report(page, path)
    for name in names(page):
        show(page, name)
    assert not scrolls_sideways(page)


@pytest.mark.parametrize("case", ["type1", "type3", "newton", "no impact", "hostile"])
def test_the_page_is_four_screens_long_until_something_is_opened(
    case: str, new_page: MakePage, report: Any
) -> None:
    _, path = report(case)
    page = new_page(1440, 900)
    open_report(page, path)
    assert page.evaluate("() => document.documentElement.scrollHeight") <= 4 * 900


def test_a_link_opens_what_it_leads_to(new_page: MakePage, report: Any) -> None:
    _, path = report("type3")
    page = new_page(1440, 900)
    open_report(page, path)
    chart = page.locator("#plate_energy")
    assert not chart.is_visible()
    page.locator("nav a", has_text="Energy of the plate").click()
    assert chart.is_visible()
    until(page, "() => vibroimpact.charts.get('plate_energy').near")
    assert not page.locator("#case-text").is_visible()
    page.locator("nav a", has_text="Case").click()
    assert page.locator("#case-text").is_visible()
    # also one that is followed from elsewhere
    page.goto("about:blank")
    page.goto(f"{path.as_uri()}#sensor_a1")
    page.wait_for_selector("html[data-ready=true]")
    assert page.locator("#sensor_a1").is_visible()


def test_charts_follow_the_width_of_the_window(page: Page, report: Any) -> None:
    _, path = report("type1")
    open_report(page, path)
    show(page, "force")
    page.set_viewport_size({"width": 700, "height": 800})
    until(
        page,
        "() => { const at = vibroimpact.charts.get('force').element; return "
        "Math.abs(at._fullLayout.width - at.clientWidth) < 2; }",
    )
    assert page.evaluate("() => vibroimpact.charts.get('force').element.clientWidth") < 700
