"""Pictures of a run on a plate whose mesh was brought: an L with a hole and a rib below."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.arrays import Floats
from vibroimpact.charts.marks import Label, Line, Mark, Outline, Points
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.modes.scene import mode_scene
from vibroimpact.modes.supports import support_outlines as outlines_of_modes
from vibroimpact.results.plate_shape import lines_of
from vibroimpact.results.result import Result
from vibroimpact.runs.deflection_chart import deflection_chart
from vibroimpact.runs.scene import scene_of
from vibroimpact.runs.sensor_marks import _names, sensor_places
from vibroimpact.runs.setup import setup_chart
from vibroimpact.runs.supports import Extent, support_outlines
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.outline import outline

L_WITH_HOLE = 0.4 * 0.3 - 0.24 * 0.16 - 0.08 * 0.06
CASE = """
name = "an L-shaped plate"
sphere = {{ radius = "12 mm", material = "steel" }}
drop = {{ height = "0.5 m" }}
contact = {{ law = "hertz" }}
run = {{ impacts = 1 }}
[plate]
material = "steel"
model = "elastic"
modes = 6
mesh = {{ file = "{file}", contact = "HIT" }}
supports = [
    {{ type = "set", name = "HINGE" }},
    {{ type = "edge", edge = "y-max", condition = "clamped" }},
    {{ type = "edge", edge = "x-max", condition = "clamped" }},
]
[[sensors]]
name = "a1"
position = "HIT"
quantity = "acceleration"
rate = "50 kHz"
[[sensors]]
name = "a2"
position = [0.104, 0.104]
quantity = "acceleration"
rate = "50 kHz"
"""


def l_shaped_plate() -> Mesh:
    """An L of 400 mm by 300 mm, 10 mm thick, with a hole, and a rib of 40 mm below it; its upper
    side is at z = 25 mm.
    """
    box = box_mesh((0.4, 0.3, 0.05), (20, 15, 5))
    (block,) = box.blocks
    nodes = box.nodes + np.array([0.2, 0.15, 0.0])
    x, y, z = nodes[block.connectivity].mean(axis=1).T
    in_plate = (z > 0.015) & ((x < 0.16) | (y < 0.14))
    in_hole = (x > 0.22) & (x < 0.3) & (y > 0.04) & (y < 0.1)
    in_rib = (z < 0.015) & (x > 0.06) & (x < 0.08) & (y > 0.02) & (y < 0.28)
    used, numbers = np.unique(
        block.connectivity[(in_plate & ~in_hole) | in_rib], return_inverse=True
    )
    nodes = nodes[used]
    at_hit = np.abs(nodes - [0.1, 0.1, 0.025]).max(axis=1) < 1e-9
    sets = {"HINGE": np.flatnonzero(nodes[:, 1] < 1e-9), "HIT": np.flatnonzero(at_hit)}
    blocks = (ElementBlock(block.kind, numbers.reshape(-1, block.connectivity.shape[1])),)
    return Mesh(nodes, blocks, sets)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plate")
    write_abaqus(l_shaped_plate(), folder / "plate.inp")
    case = folder / "case.toml"
    case.write_text(CASE.format(file=(folder / "plate.inp").as_posix()))
    vi.simulate(vi.load_case(case)).save(folder / "result")
    return folder


@pytest.fixture(scope="module")
def result(folder: Path) -> Result:
    """The result as it is read from its folder."""
    return vi.load_result(folder / "result")


def area_of(lines: Floats) -> float:
    """The area inside closed lines, less that of holes, which go round the other way."""
    total = 0.0
    for line in lines_of(lines):
        x, y = line.T
        total += 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum())
    return total


def first(marks: tuple[Mark, ...], role: str) -> Outline:
    return next(mark for mark in marks if isinstance(mark, Outline) and mark.role == role)


def test_outlines_of_a_mesh_bound_its_sides() -> None:
    mesh = l_shaped_plate()
    above, below, side = (
        np.column_stack(outline(mesh, view)) for view in ("above", "below", "side")
    )
    assert area_of(above) == pytest.approx(L_WITH_HOLE)
    assert abs(area_of(below)) == pytest.approx(L_WITH_HOLE)  # the rib fills its own hole
    assert len(lines_of(above)) == 2
    assert len(lines_of(above)[0]) == 7  # six corners, the first of them again
    np.testing.assert_allclose(np.nanmin(side, axis=0), [0.0, -0.025], atol=1e-12)


def test_a_curved_edge_keeps_its_points() -> None:
    disc = box_mesh((2.0, 2.0, 0.1), (6, 6, 1))
    across = np.abs(disc.nodes[:, :2]).max(axis=1)
    radius = np.hypot(*disc.nodes[:, :2].T)
    nodes = disc.nodes.copy()
    nodes[:, :2] *= (across / np.maximum(radius, 1e-12))[:, None]
    x, y = outline(Mesh(nodes, disc.blocks))
    assert np.nanmax(np.abs(np.hypot(x, y) - 1.0)) < 2e-3


def test_the_set_up_is_drawn_as_the_mesh_is(result: Result) -> None:
    chart = setup_chart(result)
    from_side, from_above = chart.panels
    plate = first(from_above.marks, "body")
    assert area_of(np.column_stack([plate.x, plate.y])) == pytest.approx(L_WITH_HOLE)
    profile = first(from_side.marks, "body")
    assert np.nanmin(profile.y) == pytest.approx(-0.05)  # the rib, below the upper side
    assert np.nanmax(profile.y) == pytest.approx(0.0)
    hidden = next(
        mark for mark in from_above.marks if isinstance(mark, Line) and mark.role == "ghost"
    )
    assert np.nanmin(hidden.x) == pytest.approx(0.06)
    assert np.nanmax(hidden.x) == pytest.approx(0.08)
    held = next(
        mark for mark in from_above.marks if isinstance(mark, Points) and "held" in mark.name
    )
    assert np.ptp(held.x) == pytest.approx(0.4)
    assert held.y.max() == pytest.approx(0.0)
    words = [mark.words for mark in from_side.marks if isinstance(mark, Label)]
    assert "50\u00a0mm high" in words
    assert "thickness" not in chart.caption


def test_edges_are_drawn_where_the_plate_is(result: Result) -> None:
    upper, right = support_outlines(result)
    assert (upper[0].min(), upper[0].max()) == pytest.approx((0.0, 0.16))
    assert (right[1].min(), right[1].max()) == pytest.approx((0.0, 0.14))


def test_sensors_at_sets_are_drawn(result: Result) -> None:
    assert sensor_places(result) == [
        ("a1", pytest.approx(0.1), pytest.approx(0.1)),
        ("a2", 0.104, 0.104),
    ]


def test_maps_and_scenes_have_the_outline(result: Result) -> None:
    shape = result.plate_shape
    assert shape is not None
    edge = deflection_chart(result, "").panels[0].marks[1]
    assert isinstance(edge, Line)
    np.testing.assert_array_equal(edge.x, shape.above[:, 0])
    map_ = deflection_chart(result, "").panels[0].marks[0]
    drawn = np.isfinite(map_.values)  # type: ignore[union-attr]
    assert drawn.mean() == pytest.approx(L_WITH_HOLE / (0.4 * 0.3), abs=0.01)
    scene = scene_of(result)
    np.testing.assert_array_equal(scene["outline"], shape.above)
    assert len(scene["held"]) == len(shape.held)


def test_modes_are_drawn_as_the_mesh_is(folder: Path) -> None:
    body = vi.compute_modes(vi.load_case(folder / "case.toml"))["plate"]
    upper, _ = outlines_of_modes(body.body.recipe.supports, body.model.mesh)
    assert upper[0].max() == pytest.approx(0.16)
    scene = mode_scene(body, 1)
    assert scene is not None
    assert area_of(scene["outline"]) == pytest.approx(L_WITH_HOLE)


@pytest.mark.parametrize("apart", [0.0, 0.002, 0.01])
@pytest.mark.parametrize("size", [(0.5, 0.4), (0.2, 0.6)])
def test_names_of_close_sensors_do_not_collide(apart: float, size: tuple[float, float]) -> None:
    """Names of sensors at the impact point lay over each other and over the ball."""
    length, width = size
    letter = length / (38 * min(1.0, 1.6 * length / width))
    words = {
        (0.0, 0.0): "centre",
        (0.02 + apart, apart): "second",
        (0.03 + 2 * apart, 0.0): "third",
    }
    radius = 0.025
    extent = Extent((-0.5 * length, 0.5 * length), (-0.5 * width, 0.5 * width), 0.01)
    labels = [mark for mark in _names(words, extent, (0.0, 0.0, radius)) if isinstance(mark, Label)]
    assert [label.words for label in labels] == list(words.values())
    boxes = []
    for label in labels:
        wide, high, gap = len(label.words) * letter, 2.0 * letter, letter
        left = {"left": gap, "right": -wide - gap}.get(label.anchor, -0.5 * wide) + label.x
        low = {"above": 0.7 * gap, "below": -high - 0.7 * gap}.get(
            label.anchor, -0.5 * high
        ) + label.y
        boxes.append((left, left + wide, low, low + high))
    boxes.append((-radius, radius, -radius, radius))
    for number, one in enumerate(boxes):
        for other in boxes[:number]:
            is_apart = (
                one[0] >= other[1] or other[0] >= one[1] or one[2] >= other[3] or other[2] >= one[3]
            )
            assert is_apart, (one, other)
