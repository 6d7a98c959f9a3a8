"""The live page and a report as they look in windows of three sizes, on light and on dark ground.

Makes the pictures of docs/live-page.md and docs/result-folder.md: run it in docs/images. It needs
Playwright (`pip install playwright`; no browser is downloaded) and Chromium, whose path
VIBROIMPACT_CHROMIUM may give.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

CASE = "paper:type3"
SIZES = ((1440, 900), (1024, 768), (390, 844))
COLOURS = 256
CHROMIUM = Path(os.environ.get("VIBROIMPACT_CHROMIUM", "/usr/bin/chromium"))
COMMAND = [sys.executable, "-m", "vibroimpact"]


@contextmanager
def served() -> Iterator[str]:
    """Yield the address of the live page."""
    command = [*COMMAND, "serve", "--no-browser", "--port", "0"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as server:
        try:
            assert server.stdout is not None
            yield re.search(r"http://\S+?/", server.stdout.readline()).group()
        finally:
            server.terminate()


def picture(page, folder: Path, name: str) -> None:
    """Take a picture of the window."""
    shot = Image.open(BytesIO(page.screenshot())).convert("RGB")
    shot.quantize(COLOURS, kmeans=2).save(folder / f"{name}.png", optimize=True)


def pictures(browser, address: str, report: Path, folder: Path) -> None:
    """Take all pictures."""
    for width, height in SIZES:
        for scheme in ("light", "dark"):
            context = browser.new_context(
                viewport={"width": width, "height": height},
                color_scheme=scheme,
                reduced_motion="reduce",
            )
            page = context.new_page()
            page.goto(address)
            page.wait_for_selector("html[data-detail=full]")
            page.select_option("#shipped", CASE)
            page.wait_for_selector("main[aria-busy=false]", timeout=300_000)
            # the plate is bent where the scene has come nearly half its way
            page.locator("[data-scene=place]").evaluate(
                "(place) => { place.value = 420; place.dispatchEvent(new Event('input')); }"
            )
            picture(page, folder, f"live-{width}-{scheme}")
            page.goto(report.as_uri())
            page.wait_for_selector("html[data-ready=true]")
            picture(page, folder, f"report-{width}-{scheme}")
            context.close()


def main() -> None:
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        print("pictures_of_pages.py: needs Playwright: pip install playwright")
        return
    if not CHROMIUM.is_file():
        print(
            f"pictures_of_pages.py: there is no {CHROMIUM}; VIBROIMPACT_CHROMIUM names another one"
        )
        return
    folder = Path("page")
    folder.mkdir(exist_ok=True)
    with TemporaryDirectory() as place, served() as address, sync_playwright() as playwright:
        report = Path(place) / "run" / "report.html"
        subprocess.run(
            [*COMMAND, "run", CASE, "-o", str(report.parent)], check=True, capture_output=True
        )
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        )
        pictures(browser, address, report, folder)
        browser.close()
    made = sorted(folder.glob("*.png"))
    print(f"{len(made)} pictures, {sum(file.stat().st_size for file in made) / 1e6:.2f} MB in all")


if __name__ == "__main__":
    main()
