"""Names that mean something to some program do nothing in any: what a program reads is
the same whatever things are called.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from deck_values import check_file_names, named, said
from exported_drops import STEEL
from vibroimpact.exporting.export_format import ExportFormat, export_formats, find_export_format
from vibroimpact.files.plain_names import one_line, plain_names, plain_words
from vibroimpact.structures.finite_elements.lattice import box_mesh

NAMES = [
    *("", " ", ".", "..", "../../etc/passwd", "/", "\\", "a\\", "C:\\nul"),
    *(
        '"',
        "'",
        '"""',
        "'''",
        'a """ b',
        "`id`",
        "$x",
        "${x}",
        "$(quit)",
        "a $",
        "&",
        "rock &",
        "a &\t",
        "#",
        "! rock",
        "%",
        "%s",
        "{0}",
        ";",
    ),
    *(
        "a\nrun 1000",
        "a\r\nquit",
        "a\x0bb\x0cc\x85d\u2028e",
        "\x1b[31mred\x07",
        "a\x00b",
        "\x7f",
        "\ud800",
        "\u202eright to left",
    ),
    *(
        "-->",
        "--",
        "a---b",
        "----",
        "*/",
        "/*",
        "]]>",
        "<a>&amp;",
        "<!--",
        "&#10;",
        "\\u000a",
        "\\N{DOLLAR SIGN}",
    ),
    *(
        "-1",
        "    -1",
        "-rf",
        "151",
        "58",
        "2411",
        "CON",
        "nul",
        "com1.txt",
        "Aux",
        "end",
        "END",
        "function",
    ),
    *(
        "ground",
        "sphere",
        "Contact",
        "touch",
        "damping",
        "gravity",
        "motion",
        "drop",
        "approach_speed",
        "mass",
    ),
    *(
        "# coding: rot13",
        "-*- coding: utf-16 -*-",
        "coding=utf-16",
        "vim: set modeline:",
        "adams_view_name='ground'",
        "include deck.in",
    ),
    *("x" * 300, "xy " * 100, "x_" * 200, "Größe", "岩石落下", "𝛿 = ½", "e\u0301", "İ", "ß" * 90),
]
# where no name goes
FORMATS = [format for format in export_formats().values() if format.name != "vtu"]
SENSORS = list(dict.fromkeys(NAMES))


@pytest.mark.parametrize(
    "every", [pytest.param(1, marks=pytest.mark.slow, id="all"), pytest.param(4, id="some")]
)
@pytest.mark.parametrize("format", FORMATS, ids=lambda format: format.name)
def test_a_name_does_nothing(format: ExportFormat, every: int) -> None:
    if format.name == "parquet":
        pytest.importorskip("pyarrow")
    if format.name == "uff58":
        pytest.importorskip("pyuff")
    few = [f"s{number}" for number in range(3)]
    plain = said(format, named("plain", few, ("rock", "steel")))
    for place, name in list(enumerate(NAMES))[::every]:
        sensors = [name, f"{name} ", NAMES[place - 1] + "2"]
        found = said(format, named(name, sensors, (name, NAMES[place - 1])))
        assert found == plain, repr(name)


@pytest.mark.parametrize(
    "format",
    [format for format in FORMATS if format.name in ("csv", "parquet", "mat", "uff58", "wav")],
    ids=lambda f: f.name,
)
def test_all_names_at_once(format: ExportFormat) -> None:
    if format.name == "parquet":
        pytest.importorskip("pyarrow")
    if format.name == "uff58":
        pytest.importorskip("pyuff")
    plain = said(
        format, named("plain", [f"s{number}" for number in range(len(SENSORS))], ("rock", "steel"))
    )
    drop = named("plain", SENSORS, ("rock", "steel"))
    check_file_names(format.write(drop))
    assert len(" ".join(format.notes(drop))) < 40_000
    assert _read(format, drop) == plain


def _read(format: ExportFormat, drop: object) -> object:
    return said(replace(format, notes=lambda _: []), drop)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", NAMES, ids=range(len(NAMES)))
def test_a_message_shows_a_name_on_one_line(name: str) -> None:
    drop = replace(named(name, [], ("rock", "steel")), impacts={})
    for format in ("csv", "wav", "uff58", "vtu"):
        with pytest.raises(vi.InputError) as refused:
            find_export_format(format).write(drop)
        assert str(refused.value).isprintable()
        assert len(str(refused.value)) < 500


@pytest.mark.parametrize("ending", ["inp", "bdf"])
def test_a_name_does_nothing_in_a_mesh(ending: str, tmp_path: Path) -> None:
    """Nor do those of sets and materials, which are read back but for what is no letter."""
    mesh = box_mesh((0.5, 0.4, 0.01), (1, 1, 1))
    for place, name in enumerate(name for name in NAMES if one_line(name)):
        file = tmp_path / f"{place}.{ending}"
        sets = replace(mesh, node_sets={name: np.arange(4)}, element_sets={})
        (vi.meshes.write_abaqus if ending == "inp" else vi.meshes.write_nastran)(
            sets, file, replace(STEEL, name=name)
        )
        text = file.read_bytes().decode()
        assert all(line.isprintable() for line in text.split("\n")), repr(name)
        assert max(map(len, text.split("\n"))) <= 200
        found = vi.meshes.load_mesh(file)
        np.testing.assert_allclose(found.nodes, mesh.nodes, rtol=0.0, atol=1e-15)
        assert [block.connectivity.tolist() for block in found.blocks] == [
            block.connectivity.tolist() for block in mesh.blocks
        ]
        assert [nodes.tolist() for nodes in found.node_sets.values()] == [[0, 1, 2, 3]], repr(name)


def test_plain_words_keep_what_is_plain() -> None:
    for name in (
        "the paper's Type 1, variable damping",
        "4 m (e = 0.65)",
        "drop_4m",
        "5 % of 10 m/s - 2",
        "x" * 80,
    ):
        assert plain_words(name) == name
    assert plain_words("x" * 81) == "x" * 80
    assert one_line("岩石\n落下") == "岩石 落下"


def test_many_names_take_no_long_time() -> None:
    """20,000 sensors that are called alike: in the square of their number it would take minutes."""
    names = plain_names(
        [f"a{'?' * (number % 7)}{'!' * (number // 7)}" for number in range(7_000)]
        + [f"s{number}" for number in range(20_000)]
    )
    assert len(set(names.values())) == len(names)


def test_a_name_that_is_numbered_meets_no_other() -> None:
    names = plain_names(["a b", "a_b", "a_b_2", "a/b", "A B"])
    assert len({name.lower() for name in names.values()}) == 5
