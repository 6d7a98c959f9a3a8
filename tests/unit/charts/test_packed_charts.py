"""Charts that are packed: they come back as they were, and make the same page."""

from __future__ import annotations

import json
import re
import zlib
from base64 import b64decode
from typing import Any

import numpy as np
import pytest

from vibroimpact.charts.axis import Axis, View
from vibroimpact.charts.chart import Chart, Panel, stored_chart
from vibroimpact.charts.marks import Bars, Line, Map, Outline, Points
from vibroimpact.charts.pack import pack, unpack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Figure, Paragraph, Report, Section


def same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        alike = isinstance(other, np.ndarray) and one.shape == other.shape
        return alike and bool(np.allclose(one, other, rtol=1e-7, atol=0.0, equal_nan=True))
    if isinstance(one, dict):
        return (
            isinstance(other, dict)
            and one.keys() == other.keys()
            and all(same(one[key], other[key]) for key in one)
        )
    if isinstance(one, list | tuple):
        return isinstance(other, list) and len(one) == len(other) and all(map(same, one, other))
    return bool(one == other)


def some_chart() -> Chart:
    rng = np.random.default_rng(1)
    time = np.sort(rng.uniform(0.0, 5.0, 500))
    axis = Axis("Time", "s", views=(View("Impact 1", 1.0, 2.0, 1.0, "Since", "largest 5 N"),))
    line = Line(time, rng.normal(size=500), 'of "it" & <that>', "under", origins=(1.0,))
    points = Points(
        time[:40],
        time[:40],
        "marked",
        texts=tuple(f"point {number}" for number in range(40)),
        keys={"mass": time[:40]},
    )
    upper = Panel(
        axis,
        Axis("Force", "N"),
        (line, points, Bars(np.array([1.0, 2.0]), np.array([3.0, np.nan]), "bars")),
    )
    values = rng.normal(size=(3, 4))
    values[1, 2] = np.nan
    lower = Panel(
        Axis("x", "m"),
        Axis("y", "m"),
        (
            Map(np.arange(4.0), np.arange(3.0), values, Axis("Height", "m")),
            Outline(time[:4], time[:4]),
        ),
    )
    return Chart("some", "Some chart", ((upper,), (lower,)), "With a caption.")


DOCUMENTS = [
    {
        "text": "µ \U0001f4a5",
        "none": None,
        "true": True,
        "number": -1.5,
        "list": [1, [2.0, "three"]],
        "empty": {},
        "nothing": [],
    },
    {"texts": [f"text {number}" for number in range(100)]},
    {
        "even": np.linspace(-1.0, 1.0, 101),
        "double": 3.0 + 1e-9 * np.arange(7.0) ** 2,
        "single": np.array([1.0, np.nan, -np.inf]),
    },
    {
        "whole": np.arange(5),
        "flags": np.array([True, False]),
        "empty": np.empty(0),
        "one": np.array([0.1]),
    },
    {"table": np.arange(6.0).reshape(2, 3) ** 2, "cube": np.arange(24.0).reshape(2, 3, 4) ** 2},
]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: "-".join(document))
def test_a_document_comes_back(document: dict[str, Any]) -> None:
    expected = {
        key: value.reshape(-1, value.shape[-1]) if key == "cube" else value
        for key, value in document.items()
    }
    found = unpack(pack(document))
    assert same(expected, found)
    assert same(found, unpack(pack(found)))


def test_times_late_in_a_run_stay_apart() -> None:
    time = np.sort(4.8 + np.random.default_rng(2).uniform(0.0, 3e-4, 200))
    assert np.array_equal(unpack(pack([time]))[0], time)


def test_an_array_that_is_stored_once_stays_one() -> None:
    time = np.array([0.0, 1.0, 5.0])
    first, second, other = unpack(pack([time, time, time.copy()]))
    assert first is second
    assert other is not first
    assert len(pack([first, second])) == len(pack([time, time])) < len(pack([time, time.copy()]))


def test_not_finite_numbers_are_none() -> None:
    assert unpack(pack({"range": [0.0, np.nan], "most": np.float64("inf")})) == {
        "range": [0.0, None],
        "most": None,
    }


def test_a_chart_comes_back() -> None:
    drawn = plotly_chart(some_chart())
    assert same(drawn, unpack(pack(drawn)))


def data_of(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/octet-stream" id="data">([^<]*)</script>', page)
    assert found
    return dict(unpack(zlib.decompress(b64decode(found[1]))))


def test_a_page_of_packed_charts_is_that_of_the_charts() -> None:
    chart = some_chart()

    def page_of(shown: Chart) -> str:
        section = Section("section", "Section", (Paragraph("before"), Figure(shown)))
        return page_of_report(Report("name", (section,), {}))

    direct = page_of(chart)
    packed = page_of(stored_chart(unpack(pack(plotly_chart(chart)))))
    assert same(data_of(direct), data_of(packed))
    head, before, data = (
        '<option value="0">Impact 1</option>',
        "<p>before</p>",
        re.compile(r'id="data">[^<]*<'),
    )
    assert head in packed
    assert before in packed
    assert "<option>mass</option>" in packed
    assert data.sub("", direct) == data.sub("", packed)


def test_the_header_is_text() -> None:
    block = pack({"a": np.array([1.0, 3.0, 2.0])})
    length = int.from_bytes(block[:4], "little")
    assert (4 + length) % 8 == 0
    assert json.loads(block[4 : 4 + length]) == {"a": {"$": ["f4", 0, 3]}}
