"""What was drawn of a chart: the places of all its points, by matplotlib, by plotly in
Python, and by the script of a page.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import vibroimpact
from vibroimpact.arrays import Floats
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.charts.pack import pack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.report.page import palette

SCRIPTS = Path(vibroimpact.__file__).parent / "charts" / "scripts"
NODE = shutil.which("node")

_COMPLETE = """
const fs = require("fs"), vm = require("vm");
globalThis.performance ??= { now: () => 0 };
for (const script of JSON.parse(process.argv[1])) vm.runInThisContext(fs.readFileSync(script, "utf8"));
const plain = (key, value) => ArrayBuffer.isView(value) ? Array.from(value) : value;
for (const file of process.argv.slice(2)) {
  const block = fs.readFileSync(file);
  const { chart, palette, state } = vibroimpact.unpack(block.buffer.slice(block.byteOffset, block.byteOffset + block.length));
  vibroimpact.setPalette(palette);
  console.log(JSON.stringify(vibroimpact.complete(chart, state), plain));
}
"""


def in_a_page(chart: Chart, **state: Any) -> dict[str, Any]:
    """Return the figure that the script of a page makes of a chart; needs node."""
    return in_pages([chart], **state)[0]


def in_pages(charts: Sequence[Chart], **state: Any) -> list[dict[str, Any]]:
    """Return the figures that the script of a page makes of charts; needs node."""
    assert NODE is not None
    state = {"view": None, "ranges": {}, "key": "", "width": 900, **state}
    scripts = [str(SCRIPTS / name) for name in ("arrays.js", "charts.js")]
    with TemporaryDirectory() as folder:
        blocks = [Path(folder, f"block-{number}") for number in range(len(charts))]
        for block, chart in zip(blocks, charts, strict=True):
            block.write_bytes(
                pack({"chart": plotly_chart(chart), "palette": palette(), "state": state})
            )
        done = subprocess.run(
            [NODE, "-e", _COMPLETE, json.dumps(scripts), *blocks],
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.rstrip("\n").split("\n")]


def in_python(chart: Chart) -> dict[str, Any]:
    """Return the figure of plotly's Python library, as what plotly is given."""
    figure = plotly_figure(chart)
    return {
        "data": [trace.to_plotly_json() for trace in figure.data],
        "layout": figure.layout.to_plotly_json(),
    }


def points_of_plotly(figure: dict[str, Any]) -> Floats:
    """Return x and y of everything that plotly is given; NaN where a place has but one of
    the two.
    """
    found = [_points_of_trace(trace) for trace in figure["data"]]
    for shape in figure["layout"].get("shapes", ()):
        if shape["type"] == "path":
            found.append(
                np.array(
                    [[float(place), np.nan] for place in re.findall(r"M([^,]*),", shape["path"])]
                )
            )
            continue
        x = np.nan if str(shape.get("xref")).endswith("domain") else 1.0
        y = np.nan if str(shape.get("yref")).endswith("domain") else 1.0
        found.append(np.array([[x * shape[f"x{end}"], y * shape[f"y{end}"]] for end in (0, 1)]))
    for note in figure["layout"].get("annotations", ()):
        if not note["xref"].endswith("domain"):
            found.append(
                np.array(
                    [
                        [note["x"], note["y"]],
                        [note.get("ax", note["x"]), note.get("ay", note["y"])],
                    ],
                    dtype=float,
                )
            )
    return np.concatenate([part for part in found if len(part)])


def _points_of_trace(trace: dict[str, Any]) -> Floats:
    x, y = (
        np.array([np.nan if value is None else value for value in trace[side]], dtype=float)
        for side in "xy"
    )
    if trace["type"] in ("heatmap", "contour"):
        return np.empty((0, 2))
    base = np.array(trace.get("base", 0.0), dtype=float)
    if trace["type"] == "bar" and trace.get("orientation") == "h":
        return np.column_stack([base + x, y])
    return np.column_stack([x, base + y])


def points_of_print(figure: Figure) -> Floats:
    """Return x and y of everything that matplotlib draws in the panels, of bars the
    corners and the middles of their sides.
    """
    found = []
    for axes in figure.axes:
        found += [line.get_xydata() for line in axes.lines]
        found += [
            path.vertices for collection in axes.collections for path in collection.get_paths()
        ]
        for patch in axes.patches:
            corners = patch.get_path().vertices
            if isinstance(patch, Rectangle):
                corners = patch.get_patch_transform().transform(corners)
            found += [corners, 0.5 * (corners[1:] + corners[:-1])]
        for words in axes.texts:
            found.append(
                np.array(
                    [words.xy, words.xyann if words.anncoords != "offset points" else words.xy]
                )
            )  # type: ignore[attr-defined]
    return np.concatenate([np.asarray(part, dtype=float) for part in found if len(part)])


def missing(expected: Floats, drawn: Floats) -> list[list[float]]:
    """Return the expected points that were not drawn; NaN stands for any value."""
    apart = np.abs(expected[:, None] - drawn[None])
    apart[np.isnan(expected)[:, None].repeat(len(drawn), axis=1)] = 0.0
    nearest = np.nan_to_num(apart, nan=np.inf).max(axis=2).min(axis=1)
    return [
        point.tolist()
        for point, away in zip(expected, nearest, strict=True)
        if away > 1e-5 * (1.0 + np.nanmax(np.abs(point)))
    ]
