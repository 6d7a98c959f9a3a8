"""What the modes of a case tell: frequencies and damping, shapes, and a plate in motion."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.elastic.modes import BodyModes, Modes
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import made_scene
from vibroimpact.files.result_folder import CASE, write_case
from vibroimpact.modes.charts import MOST_SHAPES, is_plate, mode_charts
from vibroimpact.modes.document import (
    MODE_COLUMNS,
    POINT_COLUMNS,
    mode_rows,
    modes_document,
    point_rows,
    summary_of_modes,
)
from vibroimpact.modes.mesh_files import mesh_files
from vibroimpact.modes.scene import mode_scene
from vibroimpact.modes.tables import MeasuredTable, body_facts, mode_table
from vibroimpact.report.case_text import case_text
from vibroimpact.report.report import (
    Block,
    Explanation,
    Facts,
    Figure,
    Quantity,
    Report,
    Scene,
    Section,
    Warnings,
)
from vibroimpact.results.csv_files import write_csv
from vibroimpact.units.display import text


def report_of(modes: Modes, measured: MeasuredTable | None = None) -> Report:
    """Return the report of the modes of a case.

    Parameters
    ----------
    modes : Modes
        The modes.
    measured : MeasuredTable, optional
        Measured modes, which are told beside them and written into `measured.csv`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> modes = vi.compute_modes(vi.load_case("paper:type2", {"sphere.modes": 5}))
    >>> list(report_of(modes).files)
    ['case.toml', 'modes.csv', 'sphere.bdf', 'sphere.inp', 'sphere.vtu']
    """
    charts = {chart.name: chart for chart in mode_charts(modes)}
    sections = []
    for name, body in modes.items():
        sections.append(_body(name, body))
        sections.append(_shapes(name, charts[f"{name}_modes"]))
    measured_quantities: Sequence[Quantity] = ()
    if measured is not None:
        sections.append(_measured(measured))
        measured_quantities = measured.quantities
    sections.extend(_motion(modes))
    sections.append(_case(modes))
    summary = summary_of_modes(modes)
    data = modes_document(modes, summary)
    if measured is not None:
        data |= {"measured": list(measured.rows), "doubts": list(measured.doubts)}
    return Report(
        title=f"Modes of {modes.case.name or 'a case'}",
        quantities=[*_answer(modes), *measured_quantities],
        sections=sections,
        files=_files(modes, measured),
        summary=summary,
        data=data,
        provenance="meshes and shapes for other programs are beside this page.",
    )


def _answer(modes: Modes) -> Iterator[Quantity]:
    """Yield the first frequency of each body with its error, and the number of its modes."""
    for name, body in modes.items():
        frequencies = body.basis.frequencies
        if not len(frequencies):
            continue
        error = float(body.model.frequency_errors[0])
        yield Quantity(f"First frequency of the {name}", float(frequencies[0]), "Hz", error)
        highest = text(float(frequencies[-1]), "Hz")
        yield Quantity(f"Modes of the {name}", len(frequencies), note=f"up to {highest}")


def _body(name: str, body: BodyModes) -> Section:
    """Return the facts of a body, and its frequencies."""
    table = mode_table(body)
    error = ""
    if any(column.heading == "within" for column in table.columns):
        error = '"Within" is the estimated error of a frequency. '
    points = ""
    if body.body.watched:
        points = ", their shapes at the sensors in points.csv"
    meaning = Explanation(
        f"{error}The shape at the contact is that of a mode of unit modal "
        f"mass. All modes are in modes.csv{points}."
    )
    blocks = (Warnings(body.doubts), Facts(body_facts(body)), table, meaning)
    return Section(name, name.capitalize(), blocks)


def _shapes(name: str, chart: Chart) -> Section:
    """Return the first shapes of a body."""
    figure = Figure(chart, has_title=False)
    return Section(f"shapes-of-{name}", chart.title, (figure,), medium="page")


def _measured(measured: MeasuredTable) -> Section:
    """Return measured modes beside those of the plate."""
    meaning = Explanation(
        "Measured frequencies and damping ratios are those of a sum of modes fitted to all "
        "measured frequency responses together; the intervals include noise alone. Modes are "
        "paired with those of the plate by frequency; mode shapes are not compared. The table is "
        "measured.csv."
    )
    blocks = (Warnings(measured.doubts), measured.table, meaning)
    return Section("measured", "Measured modes", blocks)


def _motion(modes: Modes) -> list[Section]:
    """Return the plate in motion, or the chart that says why it can't be drawn.

    There is none without a plate, and if all its modes are in its plane.
    """
    plate = next((body for body in modes.values() if is_plate(body.model)), None)
    if plate is None:
        return []
    number = min(MOST_SHAPES, len(plate.model.frequencies))
    data, lost = made_scene(partial(mode_scene, plate, number))
    blocks: list[Block] = [Figure(chart, has_title=False) for chart in lost]
    if data is not None:
        names = [mode["name"] for mode in data["modes"]]
        label = "One period of a mode of the plate"
        blocks.append(Scene(data, label, "One period of a mode, magnified.", names))
    if not blocks:
        return []
    return [Section("motion", "Plate in motion", blocks, medium="page")]


def _case(modes: Modes) -> Section:
    """Return the case as text."""
    case = case_text(resolved_case(modes.case))
    return Section("case", "Case", (case,), after_charts=True, medium="page")


def _files(modes: Modes, measured: MeasuredTable | None) -> dict[str, Callable[[Path], object]]:
    """Return the tables, the case and the meshes."""
    rows = [row for name, body in modes.items() for row in mode_rows(name, body)]
    points = [row for name, body in modes.items() for row in point_rows(name, body)]
    files: dict[str, Callable[[Path], object]] = {
        CASE: partial(write_case, resolved_case(modes.case)),
        "modes.csv": partial(write_csv, rows, MODE_COLUMNS),
    }
    if points:
        files["points.csv"] = partial(write_csv, points, POINT_COLUMNS)
    if measured is not None:
        files["measured.csv"] = partial(write_csv, measured.rows, measured.columns)
    for name, body in modes.items():
        files |= mesh_files(name, body, getattr(modes.case, name).material)
    return files
