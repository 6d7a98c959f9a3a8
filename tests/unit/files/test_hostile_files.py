"""Files that ask for more than they are: short ones that grow without bound, and readable
ones that are no body and no measurement.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from hostile_runs import attack
from support import free_plate, plain_case
from vibroimpact.calibration.calibrate_case import calibration_of
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.measurements.header_cells import name_and_unit
from vibroimpact.measurements.table_file import read_table_file
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.meshes.selection import Selection
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.structures.finite_elements.lattice import box_mesh

NUMBER = 4000
NODES = "*NODE\n" + "".join(
    f"{node},{node % 7}.,{node % 11}.,{node % 13}.\n" for node in range(1, NUMBER + 1)
)
BODY = (
    NODES
    + "*ELEMENT,TYPE=C3D4\n"
    + "".join(
        f"{first},{first},{first + 1},{first + 2},{first + 3}\n" for first in range(1, NUMBER, 4)
    )
)


def test_ranges_that_overlap_cost_no_more_than_one() -> None:
    """Against the definition, number by number."""
    draw = np.random.default_rng(7)
    known = np.unique(draw.integers(0, 300, 120))
    for _ in range(50):
        firsts = draw.integers(0, 320, draw.integers(1, 8)).tolist()
        ranges = {
            (first, first + int(draw.integers(0, 90)), int(draw.integers(1, 4))) for first in firsts
        }
        numbers = set(draw.integers(0, 320, 3).tolist())
        wanted = numbers | {
            number for first, last, step in ranges for number in range(first, last + 1, step)
        }
        found = known[Selection(numbers, ranges).places(known)]
        assert found.tolist() == [number for number in known.tolist() if number in wanted]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            BODY
            + "".join(f"*NSET,NSET=a{number},GENERATE\n1,{NUMBER}\n" for number in range(8_000)),
            "the sets have more than 10,000,000 members",
        ),
        (
            BODY
            + "*NSET,NSET=a\n"
            + "".join(f"{node},\n" for node in range(1, NUMBER))
            + "".join(f"*NSET,NSET=a{n}\na\n" for n in range(10_000)),
            "the sets have more than 10,000,000 members in all; leave out "
            "those that are not needed",
        ),
    ],
    ids=["ranges", "sets of sets"],
)
def test_sets_that_grow_without_bound(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "mesh.inp"
    file.write_text(text)
    (outcome,) = attack(load_mesh, [file])
    assert outcome.kind == "refused", outcome
    assert message in outcome.text


def test_an_entity_of_many_groups(tmp_path: Path) -> None:
    groups = " ".join(map(str, range(1, 20_001)))
    nodes = "1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    parts = {
        "MeshFormat": "4.1 0 8\n",
        "Entities": f"0 0 0 1\n1 0 0 0 1 1 1 20000 {groups} 0\n",
        "Nodes": nodes,
        "Elements": "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n",
    }
    file = tmp_path / "mesh.msh"
    file.write_text("".join(f"${name}\n{body}$End{name}\n" for name, body in parts.items()))
    with pytest.raises(
        vi.InputError,
        match=r"mesh.msh:6: the entity belongs to 20000 groups; it may belong to at most 100",
    ):
        load_mesh(file)


def test_a_plate_that_is_a_mesh_needs_no_size_to_be_explained(tmp_path: Path) -> None:
    """`check` looks for the edges of the plate, and a mesh says nothing of them."""
    file = tmp_path / "plate.inp"
    vi.meshes.write_abaqus(box_mesh((0.52, 0.42, 0.008), (4, 3, 1)), file)
    plate = free_plate(file)
    case_explained(vi.case_of(plain_case(plate=plate)))


def test_faces_without_area_are_told_without_a_warning(tmp_path: Path) -> None:
    file = tmp_path / "flat.inp"
    file.write_text(
        "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,2,0,0\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n2,1,2,5,4\n"
    )
    plate = free_plate(file)
    case = vi.case_of(plain_case(plate=plate, drop={"speed": 1.0, "position": [0.2, 0.2]}))
    for use in (case_explained, vi.compute_modes):
        with pytest.raises(vi.InputError, match=r"1 of \d \w+ elements are inverted or folded"):
            use(case)


# tables
# -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "time_s\n" + "1" * 100_001,
            "line 2: it has more than 100,000 characters; this is not a table",
        ),
        (
            ",".join(["time_s"] * 1001) + "\n1\n",
            "line 1: there are 1001 columns; a table has 1000 at most",
        ),
        (
            "time_s\n1e31\n",
            'line 2, column "time_s": "1e31" is not a measurement; it must be less than '
            "1e30 in size",
        ),
        ("time [km]\n" + "1\n", "is a length; expected a time"),
        ("a\x1b[31m\n1\n", r"no column is known among a\\x1b"),
        (
            ",".join(f"column{number}" for number in range(40)) + "\n1\n",
            "column10, column11, ...; known are time [s]",
        ),
    ],
)
def test_tables_that_are_refused(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text(text)
    with pytest.raises(vi.InputError, match=message.replace("[", r"\[")) as caught:
        read_table_file(file, {"time": "s"})
    assert len(str(caught.value)) < 500
    assert str(caught.value).isprintable()


def test_a_table_of_too_many_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vibroimpact.measurements.table_file.MOST_LINES", 3)
    file = tmp_path / "table.csv"
    file.write_text("time_s\n1\n2\n")
    assert read_table_file(file, {"time": "s"}).columns["time"].tolist() == [1.0, 2.0]
    file.write_text("time_s\n1\n2\n3\n")
    with pytest.raises(
        vi.InputError,
        match="the file has more than 3 lines; keep the part with the impacts, or fewer samples a "
        "second",
    ):
        read_table_file(file, {"time": "s"})


@pytest.mark.parametrize(
    ("cell", "told"),
    [
        ("Time [ms] ", ("time", "ms")),
        ("force (N)", ("force", "N")),
        ("force (of the sensor) [N]", ("force_(of_the_sensor)", "N")),
        ("a) b [m]", ("a)_b", "m")),
        ("[m]", ("", "m")),
        ("x []", ("x", "")),
        ("x ]", ("x_]", None)),
        ("x [m] y", ("x_[m]_y", None)),
        ("radius[ mm ]", ("radius", "mm")),
        ("damping [N s/(m)]", ("damping_[n_s/(m)]", None)),
    ],
)
def test_units_in_brackets(cell: str, told: tuple[str, str | None]) -> None:
    assert name_and_unit(cell) == told


def test_a_record_of_one_moment(tmp_path: Path) -> None:
    file = tmp_path / "record.csv"
    file.write_text("time_s,force_N\n0.5,1\n0.5,2\n0.5,3\n")
    case = plain_case(
        contact={"law": "adams-impact", "damping_max": 100.0}, calibrate={"target": str(file)}
    )
    with pytest.raises(
        vi.InputError, match="all samples have the same time; a record needs at least two times"
    ):
        vi.calibration.calibrate_case(calibration_of(case))


def test_a_brought_mesh_without_volume_is_refused_at_check(tmp_path: Path) -> None:
    mesh = tmp_path / "flat.inp"
    mesh.write_text(
        "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 1., 1., 0.\n*ELEMENT, "
        "TYPE=C3D4\n1, 1, 2, 3, 4\n"
    )
    plate = {
        "material": "steel",
        "model": "elastic",
        "mesh": str(mesh),
        "supports": "free",
        "modes": 2,
    }
    case = vi.case_of(plain_case(plate=plate, drop={"speed": 1.0, "position": [0.2, 0.2]}))
    with pytest.raises(
        vi.InputError,
        match=r"plate: 1 of 1 \w+ elements are inverted or folded \(their volume is not positive "
        r"everywhere\)",
    ):
        meshes_of(case)
