"""Measurements that are opened on the live page, and files that it saves."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
    settle,
    tables,
    type_value,
    wait_for_fault,
)
from plotted import until
from serving import Server
from vibroimpact.figures import save_figures
from vibroimpact.results.csv_files import signal_csv

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

MakePage = Callable[..., "Page"]


def wait_for_overlay(page: Page) -> Locator:
    """Wait until what was computed last lies under the measurement, or a message tells why not."""
    settle(page)
    overlay = page.locator("#overlay")
    overlay.wait_for()
    until(page, "() => document.getElementById('overlay').getAttribute('aria-busy') === 'false'")
    return overlay


def lines_of(page: Page, chart: str) -> dict[str, Any]:
    """Return the largest magnitude of each line of a chart of the measurement, as drawn."""
    until(
        page,
        "(name) => { const one = vibroimpact.live.overlays.get(name); "
        "one.element.scrollIntoView({ block: 'center', behavior: 'instant' }); "
        "return one.near && !one.stale && !one.drawing; }",
        chart,
    )
    return page.evaluate(
        """(name) => Object.fromEntries(vibroimpact.live.overlays.get(name).element.data.map((one) =>
            [one.name, Math.max(...Array.from(one.y, (value) => Math.abs(value) || 0))]))""",
        chart,
    )


def signal_of(table: dict[str, Any]) -> bytes:
    response = vi.simulate(vi.case_of(table).to_problem())
    return signal_csv(response.signals()["a1"]).encode()


LONG = {**ELASTIC, "run": {"duration": "0.25 s"}}


def test_a_measured_signal_lies_over_the_computed_one(page: Page, server: Server) -> None:
    open_live(page, server, LONG)
    drop_file(page, "a1.csv", signal_of(LONG))
    overlay = wait_for_overlay(page)
    assert overlay.locator("#overlay-title").text_content() == "Measurement: a1.csv"
    assert overlay.locator("#overlay-faults p").count() == 0
    ((name, polarity, *_, scale, residual, frac),) = tables(page, "overlay-tables")
    assert (name, polarity) == ("a1", "as simulated")
    assert float(frac) > 0.99
    assert float(scale) == pytest.approx(1.0, abs=0.01)
    assert float(residual) < 10.0
    sizes = lines_of(page, "overlay")
    assert sizes["measured"] == pytest.approx(sizes["simulated"], rel=0.02)
    # another drop is laid under the same measurement, without the file
    type_value(page, "drop.height", 0.05)
    wait_for_overlay(page)
    lower = lines_of(page, "overlay")
    assert lower["measured"] == pytest.approx(sizes["measured"], rel=0.05)
    assert lower["simulated"] < 0.7 * sizes["simulated"]
    overlay.get_by_role("button", name="Close").click()
    assert overlay.is_hidden()
    type_value(page, "drop.height", 0.1)
    assert overlay.is_hidden()
    assert faults(page) == []


def test_a_force_is_chosen_by_the_button_and_viewed_impact_by_impact(
    page: Page, server: Server
) -> None:
    open_live(page, server, RIGID)
    response = vi.simulate(vi.case_of(RIGID).to_problem())
    time = np.arange(0.2, float(response.end_time[0]), 4e-6)
    force = 1.5 * response.at(time, ["force_N"])["force_N"]
    rows = "\n".join(f"{at!r},{value!r}" for at, value in np.stack([time, force], axis=1).tolist())
    page.locator("#file").set_input_files(
        {
            "name": "hammer.csv",
            "mimeType": "text/csv",
            "buffer": f"time [s],force [N]\n{rows}\n".encode(),
        }
    )
    wait_for_overlay(page)
    found = tables(page, "overlay-tables")
    assert [float(cells[3]) for cells in found] == pytest.approx([1.5] * 3, rel=0.01)
    headline = page.locator("#chart-record .headline")
    # a contact is too short to be seen in the whole run
    assert str(headline.text_content()).startswith("Impact 1: largest force: simulated")
    page.locator("#view").select_option("1")
    largest = float(response.impacts["max_force_N"][1])
    assert str(headline.text_content()).startswith("Impact 2: largest force: simulated")
    assert f"{largest / 1e3:.3g}" in str(headline.text_content())


def test_a_file_that_is_not_understood(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    drop_file(page, "notes.pdf", b"%PDF")
    (line,) = wait_for_fault(page)
    assert line.startswith("notes.pdf: the page reads the TOML file of a case, and of a measure")
    for name, content, words in (
        ("tap.wav", b"no sound", "tap.wav: this is no WAV file, which would begin with RIFF"),
        ("a1.csv", b"time [s],b [Pa]\n0,1\n1,2\n2,1\n", 'such as "a1 [m/s2]"'),
        ("large.csv", b" " * 16_000_001, "large.csv: the file has 16000001 bytes, more than the"),
    ):
        drop_file(page, name, content)
        overlay = wait_for_overlay(page)
        (line,) = overlay.locator("#overlay-faults p").all_text_contents()
        assert words in line
        assert overlay.locator(".chart").count() == 0
        # the results are those of the case that is shown
        assert not page.locator("#results.older").count()
    drop_file(page, "mine.toml", tomli_w.dumps(RIGID).encode())
    until(page, "() => document.title.startsWith('a rigid drop')")
    settle(page)
    # what can't be computed leaves older results, which say so
    type_value(page, "drop.height", -1)
    wait_for_fault(page)
    assert page.locator("#results.older").count() == 1
    assert page.locator("#older").is_visible()
    type_value(page, "drop.height", 0.3)
    assert page.locator("#results.older").count() == 0
    assert page.locator("#older").is_hidden()


def test_a_measurement_outlives_a_case_that_it_can_not_be_compared_with(
    page: Page, server: Server
) -> None:
    open_live(page, server, LONG)
    drop_file(page, "a1.csv", signal_of(LONG))
    overlay = wait_for_overlay(page)
    page.get_by_role("button", name="Remove sensor a1").click()
    wait_for_overlay(page)
    (line,) = overlay.locator("#overlay-faults p").all_text_contents()
    assert "the case has no sensors; add the sensor to the case" in line
    page.get_by_role("button", name="Add a sensor").click()
    wait_for_overlay(page)
    assert overlay.locator("#overlay-faults p").count() == 0
    assert lines_of(page, "overlay")["measured"] > 0.0


def test_exports_and_figures_are_saved(page: Page, server: Server, tmp_path: Path) -> None:
    open_live(page, server, RIGID)
    folder = vi.simulate(vi.case_of(RIGID).to_problem()).save(tmp_path / "run")
    page.locator("#export").select_option("csv")
    with page.expect_download() as download:
        page.get_by_role("button", name="Export", exact=True).click()
    assert download.value.suggested_filename == "a-rigid-drop-csv.zip"
    with zipfile.ZipFile(io.BytesIO(download.value.path().read_bytes())) as archive:
        assert archive.read("impacts.csv") == (folder / "impacts.csv").read_bytes()
    assert "The tables contain the results" in str(page.locator("#saved").text_content())
    figures = save_figures(folder, ["png", "svg", "pdf"])
    section = page.locator("#chart-force")
    section.locator("summary").click()
    for kind in ("PNG", "SVG", "PDF"):
        with page.expect_download() as download:
            section.locator(".save").get_by_role("button", name=kind).click()
        assert download.value.suggested_filename == f"a-rigid-drop-force.{kind.lower()}"
        expected = (figures / f"force.{kind.lower()}").read_bytes()
        assert download.value.path().read_bytes() == expected
    page.locator("#export").select_option("wav")
    page.get_by_role("button", name="Export", exact=True).click()
    page.locator("#saved.failed p").wait_for()
    assert "no sensors" in str(page.locator("#saved").text_content())
    assert not page.locator("#results.older").count()


@pytest.mark.parametrize("width", [1440, 1024, 390])
def test_nothing_of_a_measurement_lies_over_another_part(
    width: int, new_page: MakePage, server: Server
) -> None:
    page = new_page(width, 900)
    open_live(page, server, LONG)
    drop_file(page, "a1_" + 60 * "x" + ".csv", signal_of(LONG))
    wait_for_overlay(page)
    lines_of(page, "overlay")
    page.locator("#chart-overlay summary").click()
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    crossed = page.evaluate(
        """() => {
          const parts = [...document.querySelectorAll("#overlay > *, #overlay .heading > *, #overlay section > *, .bar > *")]
            .filter((one) => one.offsetWidth && one.offsetHeight && !one.closest("[hidden]"));
          const boxes = parts.map((one) => one.getBoundingClientRect());
          const found = [];
          for (let first = 0; first < parts.length; first++) for (let second = first + 1; second < parts.length; second++) {
            if (parts[first].contains(parts[second]) || parts[second].contains(parts[first])) continue;
            const [a, b] = [boxes[first], boxes[second]];
            if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1)
              found.push(`${parts[first].outerHTML.slice(0, 80)} / ${parts[second].outerHTML.slice(0, 80)}`);
          }
          return found;
        }"""
    )
    assert crossed == []
