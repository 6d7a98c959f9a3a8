"""The shapes of modes as they are drawn: those of the finite elements, on a grid and on
facets; and the page that shows them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Facets, Label, Line, Map, Outline, Points
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.notebook import plotly_figure
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.modes.charts import mode_charts
from vibroimpact.modes.scene import mode_scene
from vibroimpact.modes.tables import mode_table
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.outline import outline

HOSTILE = ["<img src=x onerror=alert(1)>", r"$\frac{a$", "s" * 200]


def plate_case(**changes: Any) -> vi.Case:
    plate = {
        "size": [0.3, 0.2, 0.004],
        "material": "steel",
        "model": "elastic",
        "modes": 6,
        "supports": "simply-supported",
    }
    return vi.case_of(plain_case(plate={**plate, **changes.pop("plate", {})}, **changes))


def marks(panel: Panel, kind: type) -> list[Any]:
    return [mark for mark in panel.marks if isinstance(mark, kind)]


@pytest.fixture(scope="module")
def simple() -> tuple[vi.BodyModes, Chart]:
    """A simply supported plate, whose shapes are products of sines."""
    body = vi.compute_modes(plate_case())["plate"]
    (chart,) = mode_charts({"plate": body})
    return body, chart


@pytest.mark.slow
def test_the_shapes_of_a_simply_supported_plate_are_sines(
    simple: tuple[vi.BodyModes, Chart],
) -> None:
    """Between the nodes too; and panels are numbered with their frequencies."""
    body, chart = simple
    halves = [(1, 1), (2, 1), (1, 2), (3, 1), (2, 2), (3, 2)]
    for number, (panel, (across, up)) in enumerate(zip(chart.panels, halves, strict=False)):
        (shape,) = marks(panel, Map)
        x, y = np.meshgrid(shape.x, shape.y)
        wanted = np.sin(across * np.pi * (x / 0.3 + 0.5)) * np.sin(up * np.pi * (y / 0.2 + 0.5))
        wanted *= np.sign(np.sum(wanted * shape.values))
        assert np.nanmax(np.abs(shape.values)) == 1.0
        assert np.abs(shape.values - wanted).max() < 0.01
        assert panel.title.startswith(f"{number + 1}: ")
        _, frequency, unit = panel.title.split()
        assert float(frequency) * {"Hz": 1.0, "kHz": 1e3}[unit] == pytest.approx(
            body.model.frequencies[number], rel=1e-4
        )
    assert len({shape.scale for panel in chart.panels for shape in marks(panel, Map)}) == 1


def test_the_grid_is_that_of_the_elements(simple: tuple[vi.BodyModes, Chart]) -> None:
    """At points of it, the shape functions of the elements give the same."""
    body, chart = simple
    (shape,) = marks(chart.panels[4], Map)
    places = np.random.default_rng(1).integers(0, [len(shape.y), len(shape.x)], size=(40, 2))
    exact = body.model.at(np.array([[shape.x[column], shape.y[row]] for row, column in places]))[0][
        4, :, 2
    ]
    drawn = np.array([shape.values[row, column] for row, column in places])
    ratio = np.abs(exact).max() / np.abs(drawn).max()
    np.testing.assert_allclose(exact * np.sign(exact @ drawn) / ratio, drawn, atol=2e-3)


@pytest.mark.slow
def test_edge_supports_contact_and_sensors_are_marked() -> None:
    supports = [
        {"type": "patches", "spacing": [0.2, 0.12], "radius": 0.01},
        {"type": "edge", "edge": "x-max", "condition": "clamped"},
    ]
    sensors = [
        {"name": name, "position": [0.05, 0.01 * place], "rate": 50e3}
        for place, name in enumerate(HOSTILE)
    ]
    plate = {"supports": supports, "mesh": {"element_size": 0.03}}
    case = plate_case(plate=plate, drop={"speed": 1.0, "position": [0.03, -0.02]}, sensors=sensors)
    modes = vi.compute_modes(case)
    (chart,) = mode_charts(modes)
    for panel in chart.panels[:6]:
        drawn = marks(panel, Outline)
        assert len(drawn) == 5
        assert {round(float(np.mean(one.x[:-1])), 9) for one in drawn[:4]} == {-0.1, 0.1}
        edge = next(mark for mark in marks(panel, Line))
        assert (
            np.nanmin(edge.x),
            np.nanmax(edge.x),
            np.nanmin(edge.y),
            np.nanmax(edge.y),
        ) == pytest.approx((-0.15, 0.15, -0.1, 0.1))
        contact, sensor = marks(panel, Points)
        assert (contact.x[0], contact.y[0]) == (0.03, -0.02)
        np.testing.assert_allclose(sensor.y, [0.0, 0.01, 0.02])
        assert list(sensor.texts) == HOSTILE
        (shape,) = marks(panel, Map)
        at_patch = shape.values[np.argmin(np.abs(shape.y - 0.06)), np.argmin(np.abs(shape.x - 0.1))]
        assert at_patch == 0.0
    figure = matplotlib_figure(chart)
    figure.canvas.draw()
    assert plotly_figure(chart).layout.title.text == "Modes of the plate"
    page = page_of_report(modes.report)
    assert "<img" not in page
    assert page.count('<option value="0">1: ') == 1


def test_a_mode_in_the_plane_is_a_deformed_grid() -> None:
    case = plate_case(
        plate={"size": [0.12, 0.1, 0.02], "supports": "free", "modes": 11},
        drop={"speed": 1.0, "gravity": 0.0},
    )
    modes = vi.compute_modes(case)
    (chart,) = mode_charts(modes)
    shown = [panel for panel in chart.panels if panel.marks]
    flat = [panel for panel in shown if marks(panel, Label)]
    assert len(shown) == 11
    assert 0 < len(flat) < 11
    for panel in flat:
        assert not marks(panel, Map)
        (words,) = marks(panel, Label)
        assert words.words == "in its plane"
        grid, edge = marks(panel, Line)
        # displaced by 6 mm at most
        assert 1.01 < max(np.nanmax(np.abs(grid.x)) / 0.06, np.nanmax(np.abs(grid.y)) / 0.05) < 1.13
        assert np.nanmax(edge.x) == pytest.approx(0.06)
    scene = mode_scene(modes["plate"], 11)
    assert scene is not None
    assert len(scene["modes"]) == 11 - len(flat)
    frequency = 1.0 / scene["modes"][0]["period"]
    assert frequency == pytest.approx(modes["plate"].model.frequencies[0])
    assert np.nanmax(np.abs(scene["modes"][0]["shape"])) == pytest.approx(0.12 * 0.12)


@pytest.fixture(scope="module")
def sphere() -> tuple[vi.Modes, Chart]:
    body = {
        "radius": 0.025,
        "material": "rock-paper",
        "model": "elastic",
        "modes": 12,
        "mesh": {"elements_across": 4},
    }
    modes = vi.compute_modes(vi.case_of(plain_case(sphere=body)))
    (chart,) = mode_charts(modes)
    return modes, chart


def test_facets_of_a_sphere_are_those_that_are_seen(
    sphere: tuple[vi.Modes, Chart],
) -> None:
    """They cover its disc once, and tell how far the surface moves outwards, relative to
    where it moves most.
    """
    modes, chart = sphere
    model = modes["sphere"].model
    for mode, panel in enumerate(chart.panels):
        (facets,) = marks(panel, Facets)
        a, b = (
            facets.corners[:, 2] - facets.corners[:, 0],
            facets.corners[:, 3] - facets.corners[:, 1],
        )
        area = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()
        (rest,) = marks(panel, Line)
        np.testing.assert_allclose(np.hypot(rest.x, rest.y), 0.025, rtol=5e-3)
        assert area == pytest.approx(np.pi * 0.025**2, rel=0.35)
        moved, outward = model.displacements(mode), model.mesh.nodes / 0.025
        on_surface = np.linalg.norm(outward, axis=1) > 0.999
        radial = np.einsum("ni,ni->n", moved, outward)[on_surface]
        twists = np.abs(radial).max() < 0.05 * np.linalg.norm(moved[on_surface], axis=1).max()
        assert [label.words for label in marks(panel, Label)] == (["twisting"] if twists else [])
        assert facets.diverging is not twists
        assert np.abs(facets.values).max() <= 1.0
        if twists:  # but for the displacements along the surface, which are drawn large
            assert area == pytest.approx(np.pi * 0.025**2, rel=0.05)
    assert any(marks(panel, Label) for panel in chart.panels)


def test_facets_with_a_scale_have_its_bar_and_tell_their_values(
    sphere: tuple[vi.Modes, Chart],
) -> None:
    _, chart = sphere
    drawn = plotly_chart(chart)
    assert drawn["layout"]["coloraxis"]["cmax"] == pytest.approx(1.0)
    assert "outwards" in drawn["layout"]["coloraxis"]["colorbar"]["title"]["text"]
    told = [float(trace["text"]) for trace in drawn["data"] if trace.get("hoveron") == "fills"]
    assert len(told) > 40
    assert -1.0 <= min(told) < -0.9
    assert 0.9 < max(told) <= 1.0
    figure = matplotlib_figure(chart)
    assert [axes.get_xlabel() for axes in figure.axes if axes.get_xlabel()] == [
        "Displacement outwards, part of the largest"
    ]


def test_a_sphere_alone_has_a_page_without_a_plate_in_motion(
    sphere: tuple[vi.Modes, Chart],
) -> None:
    modes, _ = sphere
    case = vi.case_of(
        plain_case(
            name="<script>alert(1)</script>", sphere={"radius": 0.025, "material": "rock-paper"}
        )
    )
    page = page_of_report(replace(modes, case=case).report)
    assert "<script>alert" not in page
    assert "Plate in motion" not in page
    table = mode_table(modes["sphere"])
    # free, undamped, of a mesh too coarse for estimates
    assert [name for name, _ in table.headings] == ["mode", "frequency", "shape at contact"]
    assert len(table.rows) == 12
    assert all(f"<td>{row[1]}</td>" in page for row in table.rows)


def test_the_outline_goes_around_holes_and_follows_curved_edges() -> None:
    whole = box_mesh((0.5, 0.5, 0.1), (5, 5, 1))
    block = whole.blocks[0]
    middle = np.abs(whole.nodes[block.connectivity].mean(axis=1)[:, :2]).max(axis=1) < 0.01
    holed = Mesh(whole.nodes, (ElementBlock(block.kind, block.connectivity[~middle]),))
    assert middle.sum() == 1
    for mesh, length in ((whole, 2.0), (holed, 2.0 + 4 * 0.1)):
        x, y = outline(mesh)
        assert np.nansum(np.hypot(np.diff(x), np.diff(y))) == pytest.approx(length)
    bent = Mesh(
        whole.nodes
        + np.column_stack(
            [0.0 * whole.nodes[:, 0], 0.1 * whole.nodes[:, 0] ** 2, 0.0 * whole.nodes[:, 0]]
        ),
        whole.blocks,
    )
    x, y = outline(bent)
    upper = np.isfinite(y) & (y > 0.2499) & (np.abs(x) < 0.2499)
    on_a_curve = np.isclose(y[upper], 0.25 + 0.1 * x[upper] ** 2, atol=1e-3)
    assert on_a_curve.all()


def test_the_caption_of_a_single_mode_counts_none() -> None:
    (one,) = mode_charts({"plate": vi.compute_modes(plate_case(plate={"modes": 1}))["plate"]})
    assert one.caption == "The lowest mode; which way is up is arbitrary."
