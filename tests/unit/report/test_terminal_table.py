"""Tables and letters for terminals of any width and encoding: nothing is cut, and nothing
fails to be printed.
"""

from __future__ import annotations

import io
import re
import unicodedata

import numpy as np
import pytest
from rich.text import Text

from vibroimpact.report.console import TerminalConsole
from vibroimpact.report.encodable import encodable
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable, facts, numbers
from vibroimpact.units.display import column_texts

WIDE = [
    TerminalColumn("Law", ["hunt-crossley", "flores"], text=True),
    *(numbers(f"Largest quantity {place}", "m/s²", ["12345.6789", "0.5"]) for place in range(9)),
]


def printed(what: object, width: int, encoding: str = "utf-8") -> list[str]:
    file = io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors="strict", newline="\n")
    TerminalConsole(width=width, file=file).print(what)
    file.flush()
    return file.buffer.getvalue().decode(encoding).splitlines()


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_numbers_that_do_not_fit_go_on_in_a_second_block(width: int) -> None:
    lines = printed(TerminalTable(WIDE), width)
    words = " ".join(lines).split()
    assert max(map(len, lines)) <= width
    assert words.count("12345.6789") == words.count("0.5") == 9
    blocks = 1 + sum(not line for line in lines)
    assert words.count("flores") == blocks > 1  # each block names its rows


def test_numbers_are_aligned_at_their_points() -> None:
    _, *lines = printed(
        TerminalTable(
            [
                TerminalColumn("row", list("abcd"), text=True),
                TerminalColumn("x", ["2.26", "210", "\u221270.5", "\u2013"]),
            ]
        ),
        60,
    )
    assert [line.find(".") for line in lines if "." in line] == [lines[0].index(".")] * 2
    assert lines[1].rstrip().endswith("210")
    assert lines[1].index("210") + 3 == lines[0].index(".")


def test_long_words_go_below_their_row() -> None:
    said = "a sentence that is far too long to stand beside the numbers of its row"
    columns = [
        TerminalColumn("name", ["steel"], text=True),
        numbers("density", "kg/m3", ["7850"]),
        TerminalColumn("what", [said], text=True),
    ]
    wide, narrow = printed(TerminalTable(columns), 120), printed(TerminalTable(columns), 40)
    assert said in wide[-1]
    assert " ".join(" ".join(narrow[2:]).split()) == f"steel 7850 what: {said}"
    assert len(narrow) > len(wide)


@pytest.mark.parametrize("width", [40, 60, 80])
def test_facts_keep_names_whole(width: int) -> None:
    lines = printed(
        facts(
            [
                (
                    "lankarani-nikravesh",
                    "restitution = 0.65",
                    "Stopped after 5 impacts, at 4.67886 s.",
                )
            ]
        ),
        width,
    )
    assert "lankarani-nikravesh" in lines[0]
    assert "4.67886" in " ".join(lines)


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([0.900679, 3.3782, 4.0], ["0.9007", "3.3782", "4.0000"]),
        ([9.7, 0.0, -1e-9], None),
        ([330.0, 3.18], ["330.00", "3.18"]),
        ([1e9, 1.0], ["1.0000·10⁹", "1.0000"]),
        ([np.nan, 12.0], ["\u2013", "12.000"]),
    ],
)
def test_a_column_has_one_number_of_decimals(values: list[float], texts: list[str] | None) -> None:
    found = column_texts(values)
    if texts is not None:
        assert found == texts
    for value, text in zip(values, found, strict=True):
        if "·" not in text and text != "\u2013":
            assert float(text.replace("\u2212", "-")) == pytest.approx(value, rel=5e-3)


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1", "utf-8", "no-such-encoding"])
def test_every_letter_has_a_readable_stand_in(encoding: str) -> None:
    named = "no" not in encoding
    for words in (
        "µs",
        "m/s²",
        "N/m¹·⁵",
        "\u00d7 10⁻⁷",
        "1.2·10⁻⁷",
        "± 3 °",
        "ε ≤ ω",
        "\u2212 \u2013 …",
        "naïve Müller",
        "粒子",
        "\udc80",
        "\u00a0",
    ):
        shown = encodable(words, encoding)
        shown.encode(encoding if named else "ascii")
        assert "?" not in shown
    every = "".join(
        chr(code) for code in range(0x20, 0x3000) if unicodedata.category(chr(code)) != "Cn"
    )
    encodable(every, encoding).encode(encoding if named else "ascii")


def test_stand_ins_read_as_they_should() -> None:
    pairs = {
        "269.1 µs \u00d7 2 \u2212 3": "269.1 us x 2 - 3",
        "9.7·10³ N/m¹·⁵, 1.2·10⁻⁷ m/s²": "9.7e3 N/m^1.5, 1.2e-7 m/s^2",
        "ε = 0.7 ± 0.1 \u2013 ω": "e = 0.7 +- 0.1 - omega",
        "Müller, ±∞": "Muller, +-inf",
    }
    for words, plain in pairs.items():
        assert encodable(words, "ascii") == plain
    assert encodable("269 µs ± 1 m/s², 10⁻⁷ N/m¹·⁵", "cp1252") == "269 µs ± 1 m/s², 10^-7 N/m^1.5"


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_lines_fit_after_letters_have_their_stand_ins(encoding: str) -> None:
    table = TerminalTable(
        [
            TerminalColumn("row", ["a"], text=True),
            *(numbers("x", "m/s²", ["1.2·10⁻⁷"]) for _ in range(6)),
        ]
    )
    for width in (30, 40, 60):
        lines = printed(table, width, encoding) + printed(
            Text("2.0·10⁻⁷ m/s² ≤ 3 " * 8), width, encoding
        )
        assert max(map(len, lines)) <= width
        assert len(re.findall(r"1\.2e-7", " ".join(lines))) == 6
