"""Names of sensors that are no names: pictures, files and groups of a result of them, and
the way back.
"""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import pytest
from matplotlib.text import Text

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.files import render_png, render_svg
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.print_style import lettering
from vibroimpact.files.plain_names import plain_names
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.sensor_charts import drawn_sensors
from vibroimpact.runs.setup import setup_chart

NAMES = [
    r"a$\frac{$b",
    "a" * 300,
    "left\nupper",
    "../../up",
    "a/b",
    ".",
    "CON",
    "a\tb\x1b[31m",
    "$",
    r"back\$slash",
    "-o",
    "two $x$ and _y^",
]

IN_A_CASE = [r"a$\frac{$b", "a" * 200, "../../up", "$", "CON"]


@pytest.fixture(scope="module")
def response() -> vi.Response:
    plate = {
        "size": [0.52, 0.42, 0.008],
        "material": "steel-paper",
        "model": "elastic",
        "supports": "clamped",
        "modes": 4,
    }
    sensors = [
        {"name": name, "position": [0.01 * place, 0.05], "rate": 20e3}
        for place, name in enumerate(IN_A_CASE)
    ]
    return vi.simulate(
        vi.case_of(plain_case(plate=plate, sensors=sensors, run={"impacts": 1, "duration": 0.33}))
    )


@pytest.fixture(scope="module")
def folder(response: vi.Response, tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("vibroimpact.charts.files._DPI", 40)
        patch.setattr("vibroimpact.results.deflection._FRAMES", 24)
        place = tmp_path_factory.mktemp("results") / "named"
        response.save(place)
        vi.save_figures(place, ["png", "svg"])
        return place


@pytest.fixture(scope="module")
def result(response: vi.Response) -> Result:
    return result_of(response)


@pytest.mark.slow
def test_the_folder_holds_a_picture_and_a_table_of_each(folder: Path) -> None:
    assert list(vi.load_result(folder).signals) == IN_A_CASE  # as they were given
    for place, ending in (("sensors", ".csv"), ("figures", ".png"), ("figures", ".svg")):
        begins = "" if place == "sensors" else "sensor_"
        files = [
            name
            for name in os.listdir(folder / place)
            if name.endswith(ending) and name.startswith(begins)
        ]
        assert len(files) == len(IN_A_CASE)
        assert all(
            name.isascii()
            and name.isprintable()
            and len(name) < 100
            and not name.startswith((".", "-"))
            for name in files
        )
    assert {path.parent for path in folder.parent.rglob("*.csv")} <= {folder, folder / "sensors"}
    with h5py.File(folder / "result.nc") as file:
        assert len(file["sensors"]) == len(IN_A_CASE)
        assert all("value" in group for group in file["sensors"].values())


@pytest.mark.slow
def test_figures_show_every_name_in_one_line(result: Result) -> None:
    charts = {chart.name: chart for chart in (setup_chart(result), *run_charts(result))}
    names = drawn_sensors(result)
    assert len(names) == len(IN_A_CASE)
    for chart, name in [
        *((charts[one], name) for one, name in names.items()),
        (charts["deflection"], ""),
        (charts["setup"], ""),
    ]:
        check_figure(chart, name)


def check_figure(chart: Chart, name: str) -> None:
    """Look at the titles of a figure: one line each, inside the figure."""
    figure = matplotlib_figure(chart)
    render_png(figure)
    render_svg(figure)
    titles = [text for text in figure.findobj(Text) if text.get_text().startswith("Sensor ")]
    assert bool(titles) == bool(name)
    for title in titles:
        assert lettering(name) in title.get_text()
        box = title.get_window_extent()
        assert box.x1 <= figure.bbox.x1
        assert box.height < 40


@pytest.mark.parametrize("name", NAMES)
def test_lettering_is_read_letter_by_letter(name: str) -> None:
    from matplotlib.figure import Figure

    shown = lettering(name)
    assert len(shown.replace(r"\$", "$")) <= 60
    text = Figure().text(0.5, 0.5, shown)
    plain, is_mathematics = text._preprocess_math(shown)  # type: ignore[attr-defined]
    assert not is_mathematics
    assert plain == shown.replace(r"\$", "$")


def test_plain_names_differ_and_can_be_files(tmp_path: Path) -> None:
    names = [
        *NAMES,
        *(f"{name}!" for name in NAMES),
        "A1",
        "a1",
        "a1_2",
        "a1 ",
        *(f"s{'/' * number}" for number in range(2000)),
    ]
    found = plain_names(names)
    assert list(found) == list(dict.fromkeys(names))
    assert len({plain.lower() for plain in found.values()}) == len(found)
    for plain in list(found.values())[:40]:
        (tmp_path / f"sensor_{plain}.csv").touch()
    assert len(os.listdir(tmp_path)) == 40
