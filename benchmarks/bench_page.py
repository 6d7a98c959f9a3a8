"""The pages in Debian's Chromium: from a slider's move to the last chart drawn on the live page,
and the opening of a report.

    python benchmarks/bench_page.py

It needs Playwright (`pip install playwright`; no browser is downloaded) and Chromium, whose path
VIBROIMPACT_CHROMIUM may give.
"""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MOVES, SECONDS, OPENINGS = 50, 5, 7
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-sync",
]
MOVE = """async (moves) => {
  const range = document.querySelector('[data-key="drop.height"] input[type=range]'), times = [];
  for (let move = 0; move < moves; move++) {
    const before = vibroimpact.drawn || 0, start = performance.now();
    range.value = String(0.4 + 0.3 * move / moves);
    range.dispatchEvent(new Event("input"));
    while ((vibroimpact.drawn || 0) === before) await new Promise((done) => setTimeout(done, 1));
    times.push(performance.now() - start);
  }
  return times;
}"""
HOLD = """async (seconds) => {
  const range = document.querySelector('[data-key="drop.height"] input[type=range]');
  const before = vibroimpact.drawn || 0, begin = performance.now();
  let move = 0;
  while (performance.now() - begin < 1000 * seconds) {   // as fast as a pointer moves
    range.value = String(0.4 + 0.3 * (move++ % 100) / 100);
    range.dispatchEvent(new Event("input"));
    await new Promise((done) => setTimeout(done, 16));
  }
  return ((vibroimpact.drawn || 0) - before) / seconds;
}"""


def moves(browser, address: str, case: str) -> None:
    """Print the times of a case on the live page."""
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.goto(address)
    page.wait_for_selector("html[data-detail=full]")
    drawn = page.evaluate("document.documentElement.dataset.drawn")
    page.select_option("#shipped", case)
    page.wait_for_selector(f"html[data-detail=full]:not([data-drawn='{drawn}'])", timeout=300_000)
    page.wait_for_timeout(1500)
    for place in ("#results", "#charts"):
        page.evaluate("place => document.querySelector(place).scrollIntoView()", place)
        page.wait_for_timeout(500)
        times = sorted(page.evaluate(MOVE, MOVES))
        median = statistics.median(times)
        seen = page.evaluate(
            "[...vibroimpact.live.charts.values()].filter((chart) => chart.seen).length"
        )
        print(
            f"{case}: a move of the height until the last of {seen} charts in the window "
            f"is drawn: median {median:.0f} ms "
            f"of {MOVES}, {times[0]:.0f} to {times[-1]:.0f} ms; "
            f"{page.evaluate(HOLD, SECONDS):.1f} pictures a second while it moves"
        )
    page.close()


def opening(browser, report: Path) -> None:
    """Print size and time of opening of a report."""
    times = []
    for _ in range(OPENINGS):
        context = browser.new_context(viewport={"width": 1440, "height": 900})
        page = context.new_page()
        begin = time.perf_counter()
        page.goto(report.as_uri())
        page.wait_for_selector("html[data-ready=true]")
        times.append(time.perf_counter() - begin)
        context.close()
    size, median = report.stat().st_size / 1e6, statistics.median(times)
    print(
        f"report of paper:type3: {size:.2f} MB, opened and drawn in {median:.2f} s, median "
        f"of {OPENINGS}"
    )


def main() -> None:
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        print("bench_page.py: needs Playwright: pip install playwright")
        return
    chromium = os.environ.get("VIBROIMPACT_CHROMIUM", "/usr/bin/chromium")
    if not Path(chromium).is_file():
        print(f"bench_page.py: there is no {chromium}; VIBROIMPACT_CHROMIUM names another one")
        return
    command = [sys.executable, "-m", "vibroimpact"]
    with tempfile.TemporaryDirectory() as place, sync_playwright() as playwright:
        report = Path(place) / "type3" / "report.html"
        subprocess.run(
            [*command, "run", "paper:type3", "-o", str(report.parent)],
            check=True,
            capture_output=True,
        )
        server = subprocess.Popen(
            [*command, "serve", "--no-browser", "--port", "0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            assert server.stdout is not None
            address = re.search(r"http://\S+?/", server.stdout.readline()).group()
            browser = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS)
            for case in ("paper:type1-variable", "paper:type3"):
                moves(browser, address, case)
            opening(browser, report)
            browser.close()
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
