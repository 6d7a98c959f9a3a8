"""Two hundred tables at random: separators, decimal signs, headers, units, lines above,
encodings, and cells without numbers.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import vibroimpact as vi

UNITS = {"N": 1.0, "V": 1.0, "m/s²": 1.0, "µm": 1e-6, "Volt": 1.0}
ABOVE = [
    lambda mark: ["Recorder 3", "Model: X1, Serial: 44, Mode: fast", "Date;2026-01-01;12:00"],
    lambda mark: ["Messung 4", ""],
    lambda mark: [f"Rate{mark}1000", f"Channels{mark}1"],
]


class Table(NamedTuple):
    """A table: its bytes, and the record that is in it."""

    data: bytes
    rate: float
    start: float
    value: np.ndarray


def table_at_random(seed: int) -> Table:
    random = np.random.default_rng(seed)

    def is_so(part: float) -> bool:
        return bool(random.random() < part)

    count, rate = int(random.integers(60, 300)), float(random.choice([200.0, 1000.0, 48e3, 51.2e3]))
    time = np.arange(count) / rate + float(random.choice([0.0, -0.01, 3.0]))
    value = np.sin(np.arange(count) / 4.0) * float(random.choice([1.0, 1e-3, 2500.0]))
    mark = str(random.choice([",", ";", "\t", " "]))
    digits = int(random.choice([6, 9, 12]))
    cells = [[f"{at:.9f}", f"{one:.{digits}e}"] for at, one in zip(time, value, strict=True)]
    cut = int(random.integers(1, 9)) if mark != " " and is_so(0.3) else 0
    for row in cells[:cut]:
        row[1] = str(random.choice(["", "NaN"]))
    if mark != " " and is_so(0.3):
        cells[int(random.integers(20, count - 20))][1] = str(
            random.choice(["", "nan", "-", "#N/A"])
        )
    if mark != "," and is_so(0.4):
        cells = [[cell.replace(".", ",") for cell in row] for row in cells]
    if mark in ",;" and is_so(0.2):
        cells = [[f'"{cell}"' for cell in row] for row in cells]
    unit = str(random.choice(list(UNITS)))
    times = str(random.choice(["time", "t", "Zeit", "Time", "temps"]))
    name = (
        "CH1"
        if mark == " "
        else str(random.choice(["force", "Kraft", "CH1", "Acc x", "Beschleunigung (z)"]))
    )
    form = 0 if mark == " " else int(random.integers(4))
    header = [
        [mark.join([f"{times} [s]", f"{name} [{unit}]"])],
        [mark.join([times, name]), mark.join(["(s)", f"({unit})"]), ""],
        [mark.join([times, name]), mark.join(["s", unit])],
        ["# " + mark.join([f"{times} [s]", f"{name} [{unit}]"])],
    ][form]
    end = mark if mark != " " and form != 3 and is_so(0.3) else ""
    above = ABOVE[int(random.integers(3))](mark) if form != 3 and is_so(0.4) else []
    rows = [mark.join(row) + end for row in cells]
    if is_so(0.2):
        rows.insert(30, rows[29])
    lines = [*above, *(line + end if line else line for line in header), *rows, ""]
    encoding = str(random.choice(["utf-8", "utf-8-sig", "utf-16", "latin-1"]))
    return Table(
        str(random.choice(["\n", "\r\n"])).join(lines).encode(encoding),
        rate,
        float(time[cut]),
        UNITS[unit] * value[cut:],
    )


@pytest.mark.parametrize("tens", range(20))
def test_tables_at_random_are_read_right(tens: int, tmp_path: Path) -> None:
    """As they were written, and where a cell is empty within 2 % of the range."""
    for seed in range(10 * tens, 10 * tens + 10):
        made = table_at_random(seed)
        (tmp_path / "table.csv").write_bytes(made.data)
        (record,) = vi.signals.load_records(tmp_path / "table.csv")
        assert record.rate == pytest.approx(made.rate, rel=1e-6), seed
        assert record.start == pytest.approx(made.start, abs=1e-9), seed
        np.testing.assert_allclose(
            record.value, made.value, atol=0.02 * np.ptp(made.value), err_msg=str(seed)
        )
        assert np.sum(np.abs(record.value - made.value) > 1e-5 * np.ptp(made.value)) <= 1, seed
