"""Elements of second order of which a Nastran file leaves out nodes in the middle of edges."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from solid_meshes import pyramid_box
from vibroimpact.materials import Material
from vibroimpact.meshes.read_nastran import read_nastran
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.geometry import check_mesh
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.structure import solid_structure
from vibroimpact.structures.mirrored import elastic_system
from vibroimpact.structures.supports.support import held_by

STEEL = Material(7850.0, 210e9, 0.3)
SIZE, COUNTS = (0.4, 0.2, 0.1), (3, 2, 1)
FULL = {"CTETRA": 10, "CPYRAM": 13, "CPENTA": 15, "CHEXA": 20}
CORNERS = {"CTETRA": 4, "CPYRAM": 5, "CPENTA": 6, "CHEXA": 8}


def without(deck: str, omitted: set[int], mark: str) -> str:
    """The deck without the nodes that are omitted, where they are no corners: blank or 0
    in elements, and their cards left out.
    """
    rows, lines = [], deck.splitlines()
    at = 0
    while at < len(lines):
        name = lines[at][:8].strip("* ")
        end = at + 1
        while end < len(lines) and lines[end][:1] in "+*":
            end += 1
        fields = [
            line[start : start + 8].strip() for line in lines[at:end] for start in range(8, 72, 8)
        ]
        if name in FULL:
            nodes = [mark if int(node) in omitted else node for node in fields[2:] if node]
            kept = [*fields[:2], *nodes]
            rows += [
                ",".join([name if start == 0 else "", *kept[start : start + 8]])
                for start in range(0, len(kept), 8)
            ]
        elif not (name == "GRID" and int(lines[at][8:24]) in omitted):
            rows += lines[at:end]
        at = end
    return "\n".join([*rows, ""])


def frequencies(mesh: Mesh) -> np.ndarray:
    check_mesh(mesh)
    held = held_by(solid_structure(mesh, STEEL))
    assert held.rigid.shape[1] == 6
    return elastic_system(held).modes(6).angular_frequencies


@pytest.mark.parametrize("kind", ["tet10", "pyramid13", "wedge15", "hex20"])
@pytest.mark.parametrize(("part", "mark"), [(0.5, ""), (1.0, ""), (0.7, "0")])
def test_omitted_nodes_are_made_halfway(kind: str, part: float, mark: str, tmp_path: Path) -> None:
    """Of straight edges, the frequencies are those of the complete mesh; of all nodes in
    the middle, some in each element stay.
    """
    mesh = (pyramid_box if kind == "pyramid13" else box_mesh)(SIZE, COUNTS, kind)
    write_nastran(mesh, tmp_path / "whole.bdf", STEEL)
    corners = np.unique(mesh.blocks[0].connectivity[:, : mesh.blocks[0].element.corners])
    middle = np.setdiff1d(np.arange(len(mesh.nodes)), corners)
    choose = np.random.default_rng(1)
    omitted = set((choose.permutation(middle)[: int(part * len(middle))] + 1).tolist())
    for row in mesh.blocks[0].connectivity + 1:  # an element without any is of first order
        omitted -= {int(row[-1])}
    (tmp_path / "part.bdf").write_text(without((tmp_path / "whole.bdf").read_text(), omitted, mark))
    read = read_nastran(tmp_path / "part.bdf")
    assert [block.kind for block in read.blocks] == [kind]
    assert len(read.nodes) == len(mesh.nodes)
    assert read.joints is None
    (remark,) = read.remarks
    assert f"{len(omitted)} were made halfway between the corners; a curved edge" in remark
    np.testing.assert_allclose(frequencies(read), frequencies(mesh), rtol=1e-9)


def test_a_node_that_a_neighbour_has_is_used(tmp_path: Path) -> None:
    """Also where the edge is curved: the neighbour's node is that of both."""
    cards = brick(0, range(1, 9), range(101, 113)) + brick(
        1, (2, 9, 10, 3, 6, 11, 12, 7), [113, *[""] * 11]
    )
    points = {
        1: (0, 0, 0),
        2: (1, 0, 0),
        3: (1, 1, 0),
        4: (0, 1, 0),
        5: (0, 0, 1),
        6: (1, 0, 1),
        7: (1, 1, 1),
        8: (0, 1, 1),
    }
    points |= {9: (2, 0, 0), 10: (2, 1, 0), 11: (2, 0, 1), 12: (2, 1, 1)}
    element = ELEMENT_KINDS["hex20"]
    order = [8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15]
    points |= {101 + index: tuple(element.reference[node]) for index, node in enumerate(order)}
    points |= {113: (1.5, 0, 0)}
    # the edge from 2 to 6, of which the second brick has a node of its own
    points[106] = (1.0, 0.0, 0.55)
    text = (
        "".join(
            f"GRID,{number},," + ",".join(f"{value:.3f}" for value in at) + "\n"
            for number, at in points.items()
        )
        + cards
    )
    (tmp_path / "two.bdf").write_text(text)
    read = read_nastran(tmp_path / "two.bdf")
    first, second = read.blocks[0].connectivity
    # edges of the common face: of the first brick, and of the second
    shared = {9: 11, 13: 15, 18: 19, 17: 16}
    assert [int(second[theirs]) for theirs in shared.values()] == [
        int(first[ours]) for ours in shared
    ]
    assert len(read.nodes) == 8 + 12 + 4 + 8
    assert "7 were made halfway" in read.remarks[0]


def brick(number: int, corners: object, edges: object) -> str:
    nodes = [*map(str, corners), *map(str, edges)]  # type: ignore[call-overload]
    fields = [str(number + 1), "1", *nodes]
    return (
        "\n".join(
            ",".join(["CHEXA" if at == 0 else "", *fields[at : at + 8]])
            for at in range(0, len(fields), 8)
        )
        + "\n"
    )


def test_an_edge_of_an_element_of_first_order_stays_straight(tmp_path: Path) -> None:
    """A node made there moves as the mean of the two corners, so that the mesh has no
    gap: as Nastran's element does.
    """
    first = box_mesh((0.2, 0.1, 0.1), (2, 1, 1), "hex8")
    second = box_mesh((0.2, 0.1, 0.1), (2, 1, 1), "hex20")
    nodes, count = (
        np.concatenate([first.nodes, second.nodes + np.array([0.2, 0.0, 0.0])]),
        len(first.nodes),
    )
    apart = np.linalg.norm(nodes[count:, None] - nodes[None, :count], axis=2)
    same = np.where(
        apart.min(axis=1) < 1e-9, apart.argmin(axis=1), count + np.arange(len(second.nodes))
    )
    mesh = Mesh(
        nodes, (first.blocks[0], ElementBlock("hex20", same[second.blocks[0].connectivity]))
    )
    used = np.unique(np.concatenate([block.connectivity.ravel() for block in mesh.blocks]))
    write_nastran(mesh, tmp_path / "whole.bdf")
    on_face = np.flatnonzero((np.abs(nodes[used, 0] - 0.1) < 1e-9) & (used >= count)) + 1
    assert len(on_face) == 4
    (tmp_path / "part.bdf").write_text(
        without((tmp_path / "whole.bdf").read_text(), set(on_face.tolist()), "")
    )
    read = read_nastran(tmp_path / "part.bdf")
    assert read.joints is not None
    assert len(read.joints.followers) == 12
    assert (
        "4 were made halfway between the corners, of which 4 move as the straight edges of "
        "neighbours of first order" in read.remarks[0]
    )
    for follower, weights in read.joints.rows():
        assert list(weights.values()) == [0.5, 0.5]
        ends = [read.nodes[unknown // 3] for unknown in weights]
        np.testing.assert_allclose(read.nodes[follower // 3], np.mean(ends, axis=0), atol=1e-12)
    with_gap = frequencies(read_nastran(tmp_path / "whole.bdf"))
    assert (frequencies(read) > with_gap).all()
