"""Where the legends of a page's charts stand: ahead of rows of panels, or beside each of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from drawn_points import NODE, in_a_page
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Line

pytestmark = pytest.mark.skipif(NODE is None, reason="runs the script of a page, which needs node")
TIME = Axis("Time", "s")


def panel(*names: str) -> Panel:
    lines = [
        Line(np.array([0.0, 1.0]), np.array([0.0, float(number)]), name, f"series {number}")
        for number, name in enumerate(names)
    ]
    return Panel(TIME, Axis("Force", "N"), tuple(lines), "A panel")


def drawn(*rows: tuple[Panel, ...], **state: Any) -> dict[str, Any]:
    return in_a_page(Chart("chart", "Chart", rows), **state)


def legends(figure: dict[str, Any]) -> dict[str, str]:
    """Return in which legend each name stands."""
    return {
        trace["name"]: trace.get("legend", "legend")
        for trace in figure["data"]
        if trace.get("showlegend")
    }


def test_of_one_row_it_is_below_and_of_several_above() -> None:
    shared = panel("a", "b")
    assert drawn((shared,))["layout"]["legend"]["y"] < 0.0
    above = drawn((shared,), (shared,))["layout"]
    assert above["legend"]["y"] > 1.0
    assert above["margin"]["t"] > drawn((shared,))["layout"]["margin"]["t"]


def test_rows_of_marks_of_their_own_have_a_legend_each() -> None:
    figure = drawn((panel("all", "median"),), (panel("drop 1", "drop 2"),), width=1200)
    assert legends(figure) == {
        "all": "legend",
        "median": "legend",
        "drop 1": "legend2",
        "drop 2": "legend2",
    }
    layout = figure["layout"]
    for name, axis in (("legend", "yaxis"), ("legend2", "yaxis2")):
        # right above the panel, beside its title
        assert 0.0 < layout[name]["y"] - layout[axis]["domain"][1] < 0.02
        assert (layout[name]["x"], layout[name]["xanchor"]) == (1, "right")


@pytest.mark.parametrize(
    ("first", "second", "width"),
    [
        (("all", "median"), ("all", "drop 2"), 1200),  # a name in both rows
        (("all", "median"), (), 1200),  # an empty row
        (("all", "median"), ("drop 1", "drop 2"), 500),  # no room on a phone
        (("all",), tuple(f"a drop with a long name {number}" for number in range(5)), 1200),
    ],
)
def test_otherwise_there_is_one_for_all(
    first: tuple[str, ...], second: tuple[str, ...], width: int
) -> None:
    figure = drawn((panel(*first),), (panel(*second),), width=width)
    assert set(legends(figure).values()) == {"legend"}
    assert "legend2" not in figure["layout"]
