"""Mesh files of several parts that share no node: the one at the contact point is the
body, and the others are named.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from solid_meshes import together
from support import plain_case
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.geometry import check_mesh
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.parts import number_of_parts, part_at
from vibroimpact.structures.finite_elements.stated_materials import StatedMaterial, StatedMaterials

SIZE = (0.2, 0.1, 0.01)
STEEL = {"density": 7850, "youngs_modulus": 210e9, "poissons_ratio": 0.3}


def box(x: float = 0.0, z: float = 0.0, size: tuple[float, float, float] = SIZE) -> Mesh:
    made = box_mesh(size, (4, 2, 1))
    return replace(made, nodes=made.nodes + np.array([x, 0.0, z]))


# a plate, one beside it, and one below
PARTS = together(box(), box(0.5), box(0.0, -0.1, (0.3, 0.2, 0.02)))


def case_of(file: Path, position: list[float] | None = None, **mesh: Any) -> vi.Case:
    plate = {
        "material": STEEL,
        "model": "elastic",
        "supports": "free",
        "modes": 3,
        "mesh": {"file": str(file), **mesh},
    }
    return vi.case_of(
        plain_case(plate=plate, drop={"speed": 1.0, "gravity": 0, "position": position or [0, 0]})
    )


@pytest.mark.parametrize("name", ["parts.inp", "parts.bdf"])
def test_the_part_at_the_contact_is_the_body(name: str, tmp_path: Path) -> None:
    (vi.meshes.write_nastran if name.endswith("bdf") else vi.meshes.write_abaqus)(
        PARTS, tmp_path / name
    )
    for _ in range(2):  # computed, and from the store, in which parts have keys of their own
        here, beside, rim = (
            vi.compute_modes(case_of(tmp_path / name, at))["plate"]
            for at in ([0, 0], [0.5, 0], [0.14, 0])
        )
        assert here.model.properties.mass == pytest.approx(7850 * 0.2 * 0.1 * 0.01)
        assert beside.model.properties.centre[0] == pytest.approx(0.5)
        assert rim.model.properties.centre[2] == pytest.approx(-0.1)
        assert here.model.frequencies == pytest.approx(beside.model.frequencies, rel=1e-6)
    alone = vi.compute_modes(
        vi.case_of(
            plain_case(
                plate={
                    "material": STEEL,
                    "model": "elastic",
                    "supports": "free",
                    "modes": 3,
                    "mesh": str(write(box(), tmp_path / "alone.inp")),
                },
                drop={"speed": 1.0, "gravity": 0},
            )
        )
    )["plate"]
    assert here.model.frequencies == pytest.approx(alone.model.frequencies, rel=1e-9)
    assert not any("parts" in doubt for doubt in alone.doubts)
    [doubt] = [doubt for doubt in here.doubts if "parts" in doubt]
    assert doubt.startswith(
        "the mesh file holds 3 parts that share no node and are not joined; the body is the "
        "one at the contact point, "
        "x -0.1 to 0.1, y -0.05 to 0.05, z -0.005 to 0.005 m, and x 0.4 to 0.6"
    )
    assert (
        "x -0.15 to 0.15, y -0.1 to 0.1, z -0.11 to -0.09 m are left out: "
        "to join parts, tie them in the file (*TIE, RBE2) or merge their coincident nodes"
    ) in doubt


def write(mesh: Mesh, file: Path) -> Path:
    vi.meshes.write_abaqus(mesh, file)
    return file


def test_the_contact_may_be_a_set(tmp_path: Path) -> None:
    file = write(PARTS, tmp_path / "parts.inp")
    assert vi.compute_modes(case_of(file, contact="nodes1"))["plate"].model.properties.centre[
        0
    ] == pytest.approx(0.5)


def test_sets_and_materials_go_with_the_part() -> None:
    stated = StatedMaterials(
        (StatedMaterial("a"), StatedMaterial("b"), StatedMaterial("c")), np.repeat([2, -1, 0], 8)
    )
    materials = (Material(1.0, 1.0, 0.1), Material(2.0, 1.0, 0.1))
    mesh = replace(
        PARTS, stated=stated, materials=materials, element_materials=np.repeat([0, 1, -1], 8)
    )
    here, beside, below = (
        part_at(mesh, at, side)
        for at, side in (((0.0, 0.0), "upper"), ((0.5, 0.0), "upper"), ((0.0, 0.0), "lower"))
    )  # type: ignore[arg-type]
    assert [part.number_of_elements for part in (here, beside, below)] == [8, 8, 8]
    assert list(beside.node_sets) == ["nodes1"]
    assert beside.element_sets["part1"].tolist() == list(range(8))
    assert here.stated is not None
    assert [one.name for one in here.stated.materials] == ["c"]
    assert beside.stated is None
    assert below.element_materials.tolist() == 8 * [-1]
    for part in (here, beside, below):
        check_mesh(part)
        assert number_of_parts(part) == 1
    assert part_at(mesh, None, "lower").nodes[:, 2].min() == pytest.approx(-0.11)
    with pytest.raises(InputError, match="the mesh consists of 3 loose parts that share no node"):
        check_mesh(PARTS)


def test_materials_of_other_parts_do_not_matter(tmp_path: Path) -> None:
    """A part without a density, which is left out, does not keep the file from being
    read; names may be those of any part.
    """
    file = write(PARTS, tmp_path / "parts.inp")
    sections = "".join(
        f"*SOLID SECTION, ELSET=part{index}, MATERIAL={name}\n"
        for index, name in enumerate(("steel", "soft", "soft"))
    )
    file.write_text(
        file.read_text()
        + sections
        + "*MATERIAL, NAME=STEEL\n*DENSITY\n7850.\n*ELASTIC\n210e9, .3\n*MATERIAL, NAME=SOFT\n"
    )
    assert meshes_of(case_of(file))["plate"].materials == ()
    named = case_of(file, materials={"soft": "aluminium", "steel": "steel"})
    assert vi.compute_modes(named)["plate"].model.properties.mass == pytest.approx(
        2e-4 * 7850, rel=0.01
    )


def test_a_point_off_the_body_is_told_where_the_body_is(tmp_path: Path) -> None:
    beside = write(box(0.5), tmp_path / "beside.inp")
    text = (
        r"drop.position: \(0, 0\) m is not on the body, which reaches from 0.4 to "
        r"0.6 m along x .*; "
    )
    text += r"the nearest node of its upper side is at \(0.4, 0\) m"
    with pytest.raises(InputError, match=text):
        meshes_of(case_of(beside))
    assert vi.compute_modes(case_of(beside, [0.4, 0]))  # what is told is accepted
    several = write(PARTS, tmp_path / "parts.inp")
    with pytest.raises(
        InputError,
        match=r"plate.mesh: \(2, 0\) m is not on the body, .* the nearest node of its upper side "
        r"is at \(0.6, 0\) m",
    ):
        case_of(several, [2, 0])
