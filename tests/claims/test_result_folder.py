"""Sizes and limits that the page of the result folder states, read from what the program
writes and from the limits that it applies.
"""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
from PIL import Image

import vibroimpact as vi
from stated_numbers import ROOT, says
from vibroimpact.dynamics.change_by_impact import RELATIVE_CHANGE
from vibroimpact.dynamics.motion.energy import CLOSURE_LIMIT
from vibroimpact.files.hdf5 import FORMAT
from vibroimpact.results import deflection, fine_history, surface_grid
from vibroimpact.results.csv_files import MOST_CSV_SAMPLES
from vibroimpact.runs import paraview
from vibroimpact.signals.bounces.touches import WINDOW

PAGE = "docs/result-folder.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    response = vi.simulate(vi.load_case("paper:type1-theory"))
    return response.save(tmp_path_factory.mktemp("made") / "theory")


def test_limits_of_files() -> None:
    says(PAGE, "(the sensitivity times {}, or times", RELATIVE_CHANGE)
    says(
        PAGE,
        "at about {} points and up to {} times, starting",
        surface_grid.POINTS,
        deflection._FRAMES,
    )
    says(PAGE, "if it has at most {} samples; longer ones", MOST_CSV_SAMPLES)
    says(
        PAGE,
        "with up to {} of these times (fewer if they would take more than {} MB;",
        paraview._FRAMES,
        paraview._MOST_BYTES / 1e6,
    )
    says(
        PAGE, "with up to {} additional points per body after each of the first", fine_history._MOST
    )
    says(PAGE, "the value of largest magnitude within {} ms", 1e3 * WINDOW)
    says(PAGE, "A run in which it exceeds {} is an error", CLOSURE_LIMIT)


def test_the_page_of_a_report(folder: Path) -> None:
    says(
        PAGE, "which is included in the page ({} MB)", (folder / "report.html").stat().st_size / 1e6
    )


def test_the_format_of_results(folder: Path) -> None:
    assert FORMAT == ("v110", "v110")
    says(PAGE, "its headers have those of HDF5 {} (reading", 1.10)
    with h5py.File(folder / "result.nc") as file:
        assert all(data.fletcher32 for data in file["history"].values())


def test_figures_for_print(folder: Path, tmp_path: Path) -> None:
    vi.charts.save_charts([vi.load_result(folder).charts["force"]], tmp_path)
    with Image.open(tmp_path / "force.png") as picture:
        dots = np.array(picture.info["dpi"])
        says(PAGE, "PNG files have {} dots per inch", dots[0])
        says(PAGE, "for print, {} inches wide", picture.size[0] / dots[0])


def test_windows_that_are_shown() -> None:
    says(PAGE, "| {} by {} | ![The report of the paper's Type 3", *size("1440"))
    says(PAGE, "| {} by {} | ![The report in a narrower window]", *size("1024"))
    says(PAGE, "| {} by {} | ![The report on a telephone", *size("390"))


def size(name: str) -> tuple[int, int]:
    found = set()
    for theme in ("light", "dark"):
        with Image.open(ROOT / f"docs/images/page/report-{name}-{theme}.png") as picture:
            found.add(picture.size)
    (only,) = found
    return only
