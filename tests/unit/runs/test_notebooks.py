"""What a notebook shows of a run: charts by their names, and a summary."""

from __future__ import annotations

from html.parser import HTMLParser

import numpy as np
import pytest

import vibroimpact as vi
from many_runs import HOSTILE, RUNS, run_of
from support import one_in, plain_case
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.tables import impact_table


class Cells(HTMLParser):
    """Tags and texts of a piece of HTML."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.texts: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        assert not [name for name, _ in attributes if name != "colspan"]

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def test_a_chart_is_plotted_by_its_name(theory: vi.Response) -> None:
    figure = theory.plot("force")
    assert figure.layout.yaxis.title.text == "Force [kN]"
    line = max(figure.data, key=lambda trace: len(trace.y))
    np.testing.assert_allclose(1e3 * np.max(line.y), theory.impacts["max_force_N"].max(), rtol=1e-3)
    marked = next(
        trace
        for trace in figure.data
        if trace.name == "largest force of a contact" and trace.x[0] is not None
    )
    np.testing.assert_allclose(1e3 * np.asarray(marked.y), theory.impacts["max_force_N"])
    assert theory.plot().layout.title.text == "Height of the sphere's centre above the plate"


@pytest.mark.parametrize("name", one_in(3, RUNS))
def test_every_chart_of_every_run_can_be_plotted(name: str) -> None:
    result = run_of(name)
    for chart in run_charts(result):
        figure = result.plot(chart.name)
        assert len(figure.data)
        assert figure.to_json()


def test_a_sensor_is_plotted_by_its_own_name() -> None:
    result = run_of("sensors")
    figure = result.plot("sensor v")
    assert figure.layout.title.text == "Sensor v"
    values = result.signals["v"].value
    signal = max(
        (trace for trace in figure.data if trace.yaxis == "y"), key=lambda trace: len(trace.y)
    )
    assert len(signal.x) == len(values)
    assert figure == result.plot("sensor_v")


def test_more_sensors_than_a_page_draws_can_be_plotted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vibroimpact.runs.sensor_charts.MOST", 1)
    result = run_of("sensors")
    assert "sensor_v" not in {chart.name for chart in run_charts(result)}
    assert result.plot("sensor v").layout.title.text == "Sensor v"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("forse", 'Did you mean "force"'),
        ("sensor a3", "sensor a1, sensor a2, sensor v"),
        ("", "setup, position, force"),
        ("x" * 999, "..."),
    ],
)
def test_a_chart_that_is_not_there_is_told_with_those_that_are(name: str, words: str) -> None:
    with pytest.raises(vi.InputError) as refused:
        run_of("sensors").plot(name)
    assert words in str(refused.value)


def test_charts_of_contact_are_not_there_without_contact() -> None:
    with pytest.raises(vi.InputError, match="there are setup, position, velocity, energy"):
        run_of("no impact").plot("force")
    with pytest.raises(vi.InputError, match="there is no chart"):
        run_of("an elastic plate without impact").plot("sensor a1")


def test_names_are_text_in_plotly() -> None:
    figure = run_of("hostile names").plot(f"sensor {HOSTILE}")
    assert "<script" not in figure.to_json().replace("\\u003c", "<")
    assert "&lt;script&gt;" in figure.layout.title.text


@pytest.mark.parametrize("name", RUNS)
def test_a_summary_has_name_status_table_and_doubts(name: str) -> None:
    result = run_of(name)
    cells = Cells(result._repr_html_())
    text = "\n".join(cells.texts)
    assert set(cells.tags) <= {"p", "strong", "br", "table", "thead", "tbody", "tr", "th", "td"}
    assert result.name in text
    assert result.status in text
    # of each table that has rows also that of its head: the answer and the impacts
    rows = [len(result.report.quantities), len(result.impacts["impact"])]
    assert cells.tags.count("tr") == sum(number + 1 for number in rows if number)
    assert text.count("Warning: ") == len(result.doubts)
    for row in impact_table(result).rows:
        assert all(cell in cells.texts for cell in row)


def test_a_summary_of_hostile_names_is_text() -> None:
    html = run_of("hostile names")._repr_html_()
    assert "<script" not in html
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in html


def test_a_long_table_leaves_its_middle_out() -> None:
    case = plain_case(contact={"law": "newton", "restitution": 0.99}, run={"impacts": 80})
    result = vi.result_of(vi.simulate(vi.case_of(case)))
    html = result._repr_html_()
    assert "… 32 more …" in html
    answer_rows = len(result.report.quantities) + 1
    assert Cells(html).tags.count("tr") - answer_rows == 50


def test_a_response_shows_what_its_result_does(theory: vi.Response) -> None:
    assert theory._repr_html_() == vi.result_of(theory)._repr_html_()
    law = vi.laws.find_contact_law("hertz")(stiffness=1e8)
    ball = vi.Body(mass=0.1, contact_offset=0.02)
    batch = vi.Problem(
        sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=[0.5, 1.0], impacts=1
    )
    assert vi.simulate(batch)._repr_html_() is None  # its repr is shown instead
    assert vi.simulate(batch).drop(0)._repr_html_()
    assert vi.tabulate(batch).drop(0)._repr_html_() is None
    with pytest.raises(vi.InputError, match=r"response.drop\(0\)"):
        vi.simulate(batch).plot("force")
