"""What the run of a drop tells: set-up, impacts, energies, deformation, charts and case."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import made_charts, made_scene
from vibroimpact.dynamics.motion.energy import CLOSURE_LIMIT, closure_in_words
from vibroimpact.report.case_text import case_text
from vibroimpact.report.report import (
    Block,
    Explanation,
    Facts,
    Figure,
    Paragraph,
    Report,
    Scene,
    Section,
    Table,
    table_of,
)
from vibroimpact.results.folder import CHECKED_FILES, result_files
from vibroimpact.results.result import Result
from vibroimpact.results.summary import summary_of
from vibroimpact.runs.answer import answer_of, largest_reading
from vibroimpact.runs.below import level_below
from vibroimpact.runs.captions import left_out, scene_caption, sensor_caption, sensors_left_out
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.deformation import deformation_rows, treatment_sentence
from vibroimpact.runs.scene import scene_of
from vibroimpact.runs.sensor_charts import sensor_chart
from vibroimpact.runs.setup import setup_chart, setup_rows
from vibroimpact.runs.tables import energy_lost_sentence, energy_table, impact_table
from vibroimpact.units.display import MISSING, digits, text


def report_of(result: Result) -> Report:
    """Return the report of the run of one drop.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> result = vi.result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    >>> [section.title for section in report_of(result).sections]
    ['Set-up', 'Impacts', 'Energy at the end', 'Set-up in words', 'Case']
    """
    charts = {chart.name: chart for chart in run_charts(result)}
    sections = [_setup(result), _impacts(result), _energies(result)]
    if rows := setup_rows(result):
        facts = Facts(rows)
        sections.append(
            Section("in-words", "Set-up in words", (facts,), medium="page", is_folded=True)
        )
    if result.signals:
        sections.append(_sensors(result))
    deformation = _deformation(result)
    if deformation.blocks:
        sections.append(deformation)
    if result.deflection is not None:
        # the plate in motion takes the place of the maps of its deflection
        sections.append(_motion(result, charts.pop("deflection", None)))
    sections.append(_case(result))
    return Report(
        title=result.name,
        answer=result.status,
        quantities=answer_of(result),
        has_failed=result.status.startswith("Failed"),
        sections=sections,
        charts=list(charts.values()),
        main_chart="position",
        further_charts=_charts_of_sensors(result),
        above_charts=left_out(result),
        below_charts=sensors_left_out(result),
        files=result_files(result),
        checked_files=CHECKED_FILES,
        warnings=result.doubts,
        summary=summary_of(result),
        provenance=Facts(list(result.provenance.items())),
    )


def _setup(result: Result) -> Section:
    """Return the sketch of the set-up."""
    (sketch,) = made_charts({"setup": partial(setup_chart, result)})
    figure = Figure(sketch, has_title=False)
    return Section("set-up", "Set-up", (figure,), medium="page")


def _impacts(result: Result) -> Section:
    """Return the table of impacts, and what its columns mean."""
    if not len(result.impacts["impact"]):
        return Section("impacts", "Impacts", (Paragraph("No impact within the run."),))
    meaning = Explanation(
        "Restitution is separation speed over approach speed. Rebound height is that of the "
        f"sphere's centre above {level_below(result)}. {energy_lost_sentence(result)} A dash "
        "stands for a value that does not exist."
    )
    return Section("impacts", "Impacts", (impact_table(result), meaning))


def _energies(result: Result) -> Section:
    """Return the energy ledger at the end, and how well it closes."""
    closure = float(result.energy["closure_J"])
    relative = float(result.energy["closure_relative"])
    sentence = Explanation(
        f"Closure: the sum differs from the energy put in by {digits(closure, 2)} J; relative, "
        f"{digits(relative, 2)} (limit {digits(CLOSURE_LIMIT, 1)}).",
        short=closure_in_words(relative),
    )
    return Section("energies", "Energy at the end", (energy_table(result), sentence))


def _sensors(result: Result) -> Section:
    """Return the largest reading of each sensor, which the page says below its chart."""
    return Section("sensors", "Sensors", (sensor_table(result),), medium="terminal")


def sensor_table(result: Result) -> Table:
    """Return the largest reading of each sensor, and for how long it was beyond its range."""
    signals = result.signals
    headings = ["sensor", "largest reading"]
    rows = [[name, largest_reading(name, signal).text] for name, signal in signals.items()]
    overloads = [signal.overload_time for signal in signals.values()]
    if any(overloads):
        headings.append("beyond its range for")
        for row, overload in zip(rows, overloads, strict=True):
            duration = text(overload, "s") if overload else MISSING
            row.append(duration)
    return table_of(headings, rows, texts=headings)


def _deformation(result: Result) -> Section:
    """Return how deformation of the bodies is modelled; without blocks if they are rigid."""
    blocks: list[Block] = []
    if sentence := treatment_sentence(result):
        blocks.append(Paragraph(sentence))
    if rows := deformation_rows(result):
        blocks.append(Facts(rows))
    return Section("deformation", "Deformation of the bodies", blocks, is_folded=True)


def _motion(result: Result, maps: Chart | None) -> Section:
    """Return the plate in motion; where it can't be drawn, why, and the maps of its deflection."""
    data, lost = made_scene(partial(scene_of, result))
    blocks: list[Block] = [Figure(chart, has_title=False) for chart in lost]
    if data is None and maps is not None:
        blocks.append(Figure(maps))
    if data is not None:
        scene = Scene(
            data,
            label="Plate and ball",
            caption=scene_caption(result),
            still=maps,
            animation=partial(_animation, result),
        )
        blocks.append(scene)
    return Section("motion", "Plate in motion", blocks, medium="page")


def _animation(result: Result) -> bytes:
    """Return the plate in motion as GIF."""
    from vibroimpact.runs.animation import animate  # here, as it imports matplotlib

    return animate(result)


def _case(result: Result) -> Section:
    """Return the case as text, or that there is none."""
    block: Block = Paragraph("The run was made from Python, not from a case file.")
    if result.case:
        block = case_text(result.case)
    return Section("case", "Case", (block,), after_charts=True, medium="page")


def _charts_of_sensors(result: Result) -> dict[str, Callable[[], Chart]]:
    """Return what makes the chart of each sensor, also of those that the page does not draw."""
    if not len(result.impacts["time_s"]):
        return {}
    return {f"sensor {name}": partial(_chart_of_sensor, result, name) for name in result.signals}


def _chart_of_sensor(result: Result, name: str) -> Chart:
    return sensor_chart(result, f"sensor {name}", name, sensor_caption(result, name))
