"""Damaged tables and records: each is read or refused with a sentence, quickly; and what
is read goes on to what it is used for.
"""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import pyuff

import vibroimpact as vi
from hostile_runs import failures, number, seed
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibration_of
from vibroimpact.calibration.targets import target_of
from vibroimpact.cases.build import problem_of
from vibroimpact.measurements.table_file import read_table_file
from vibroimpact.studies.planning.sweep_file import sweep_of

HEIGHTS = "impact,rebound_height [mm]\n1,310\n2,190\n3,130\n"
IMPACTS = "approach_speed_m_s,restitution,restitution_standard_deviation\n1,0.7,0.01\n2,0.65,0.02\n3,0.6,0.02\n"
SWEPT = "# pebbles from the belt\nradius (mm);mass [g];share\n5;1,2;10\n7,5;4;20\n10;9;5\n20;70;1\n"


def force_record() -> str:
    """Two half sines, as a force sensor records them."""
    time = np.arange(0.0, 0.6, 2e-4)
    force = sum(
        np.where(np.abs(time - at) < 2e-3, most * np.cos(math.pi * (time - at) / 4e-3), 0.0)
        for at, most in ((0.01, 800.0), (0.45, 500.0))
    )
    return "time [ms],force (N)\n" + "".join(
        f"{1e3 * at:.6g},{value:.5g}\n" for at, value in zip(time, force, strict=True)
    )


def position_record() -> str:
    """A ball that bounces, as a camera sees it."""
    rows, speed, start = [], 3.0, 0.0
    for _ in range(3):
        flight = 2.0 * speed / 9.80665
        for at in np.arange(0.0, flight, 0.004):
            rows.append(f"{start + at:.5f}\t{0.025 + speed * at - 0.5 * 9.80665 * at**2:.6f}")
        start, speed = start + flight, 0.7 * speed
    return "\n".join(["time_s\tposition_m", *rows, ""])


def universal_record(binary: int) -> bytes:
    """The position as a universal file, as programs of vibration testing write it."""
    rows = [line.split("\t") for line in position_record().splitlines()[1:]]
    place = np.interp(np.arange(0.0, 1.0, 0.002), *np.array(rows, dtype=float).T)
    function = {
        "type": 58, "id1": "height", "id2": "NONE", "func_type": 1, "rsp_ent_name": "NONE", "rsp_node": 1, "rsp_dir": 3,
        "ref_ent_name": "NONE", "ref_node": 0, "ref_dir": 0, "abscissa_spacing": 1, "abscissa_spec_data_type": 17, "binary": binary,
        "ordinate_spec_data_type": 8, "orddenom_spec_data_type": 0, "z_axis_spec_data_type": 0, "ordinate_axis_units_lab": "m",
        "abscissa_axis_lab": "time", "abscissa_axis_units_lab": "s", "x": np.arange(0.0, 1.0, 0.002), "data": place,
    }  # fmt: skip
    scales = {"length": 1.0, "force": 1.0, "temp": 1.0, "temp_offset": 273.15}
    units = {"type": 164, "units_code": 1, "units_description": "SI", "temp_mode": 1, **scales}
    with TemporaryDirectory() as folder:
        file = Path(folder, "record.uff")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResourceWarning)  # pyuff leaves the file open
            pyuff.UFF(str(file)).write_sets([units, function], "overwrite")
        return file.read_bytes()


HOSTILE = [
    "[" * 90_000, "(" * 50_000, " " * 90_000, "[ " * 40_000, "a" * 90_000, "," * 90_000, "time_s," * 10_000, "x\n" * 20_000, "1," * 2000,
    "[]" * 40_000, "time [s^9^9^9]", "force [N^9^9^9^9]", "[ms]", "[", "]", "(", ")", "((", "))", "[s)", "force_N", "time_s", "time_m",
    "position_um", "radius [mm]", "rebound_height_m", "approach_speed_m_s", "restitution", "restitution [%]", "max_force_kN",
    "force_standard_deviation", "1e308", "-1e308", "1e-308", "5e-324", "1e999", "nan", "inf", "-inf", "1_0", "0", "-0", "-1", "1e15",
    "9" * 400, "0." + "0" * 400 + "1", "0x10", "1e", "1,5", "1.2.3", "\u0663", "\x00", "\x1b[31m", "\x0b", "\x1c", "\u2028", "\u202e",
    "\ufeff", '"', '""', '"a', "'", "#", "# ", ";", ",", "\t", "\n", "\r", "\r\n", "\n\n", "=1+1", "$", "\\", "%", "/",
    "time[" + "s" * 200 + "]",
]  # fmt: skip


def damaged(data: bytes, choose: random.Random) -> bytes:
    """A table with a few faults: of bytes, of lines, of cells."""
    for _ in range(choose.randint(1, 4)):
        kind, at = choose.randrange(8), choose.randrange(len(data) + 1)
        if choose.random() < 0.3:  # the header is hit as often as all of a long record
            at = min(at, choose.randrange(60))
        rows = data.split(b"\n")
        row, other = (choose.randrange(len(rows)) for _ in range(2))
        if kind == 0:
            data = data[:at] + bytes([choose.randrange(256)]) + data[at + 1 :]
        elif kind == 1:
            data = data[:at] + data[at + choose.randint(0, 60) :]
        elif kind == 2:
            data = data[:at]
        elif kind == 3:
            data = data[:at] + choose.choice(HOSTILE).encode("utf-8", "surrogatepass") + data[at:]
        elif kind == 4:
            cells = rows[row].split(b",")
            cells[choose.randrange(len(cells))] = choose.choice(HOSTILE).encode(
                "utf-8", "surrogatepass"
            )
            data = b"\n".join([*rows[:row], b",".join(cells), *rows[row + 1 :]])
        elif kind == 5:
            rows[row], rows[other] = rows[other], rows[row]
            data = b"\n".join(rows)
        elif kind == 6:
            data = b"\n".join(rows[:row] + rows[min(row, other) : max(row, other)] + rows[row:])
        else:  # one column by a factor, as a wrong unit is
            factor = choose.choice([0.0, 1e3, 1e-6, 1e12, -1.0, 1e300])
            cells_of = [line.split(b",") for line in rows]
            data = b"\n".join(b",".join(scaled(cell, factor) for cell in line) for line in cells_of)
    return data


def scaled(cell: bytes, factor: float) -> bytes:
    """Return a cell, multiplied if it is a number."""
    try:
        return repr(float(cell) * factor).encode()
    except ValueError:
        return cell


def observed(file: Path) -> None:
    """Take what a file tells as the target of a calibration, up to where the fit begins."""
    section = {"target": str(file)}
    case = calibration_of(
        plain_case(contact={"law": "adams-impact", "damping_max": 100.0}, calibrate=section)
    ).case
    assert case.calibrate is not None
    target_of(case, problem_of(case), case.calibrate)


def swept(file: Path) -> None:
    """Take columns of a file as what a study runs over."""
    over = {"sphere": {"radius": {"file": str(file), "column": "radius [mm]", "weights": "share"}}}
    sweep = sweep_of(plain_case(sweep={"design": "latin-hypercube", "samples": 8, "over": over}))
    _ = sweep.plan.points(0, 8)


def read(file: Path) -> None:
    read_table_file(
        file, {"time": "s", "force": "N", "radius": "m", "share": "", "restitution": ""}
    )


USES: dict[str, tuple[Callable[[Path], None], Callable[[], bytes]]] = {
    "heights": (observed, lambda: HEIGHTS.encode()),
    "impacts": (observed, lambda: IMPACTS.encode()),
    "force": (observed, lambda: force_record().encode()),
    "position": (observed, lambda: position_record().encode()),
    "universal": (observed, lambda: universal_record(0)),
    "universal, binary": (observed, lambda: universal_record(1)),
    "swept": (swept, lambda: SWEPT.encode()),
    "plain": (read, lambda: SWEPT.replace("mass", "force").replace("[g]", "[kN]").encode()),
}


@pytest.mark.parametrize("use", USES)
def test_tables_are_good(use: str, tmp_path: Path) -> None:
    work, made = USES[use]
    file = tmp_path / "table.csv"
    file.write_bytes(made())
    work(file)


@pytest.mark.parametrize("use", USES)
def test_damaged_tables(use: str, tmp_path: Path) -> None:
    work, made = USES[use]
    whole, file = made(), tmp_path / "table.csv"

    def attempt(data: bytes) -> None:
        file.write_bytes(data)
        work(file)

    told = failures(
        attempt, [damaged(whole, random.Random(f"{use} {seed(one)}")) for one in range(number(50))]
    )
    assert not told, told


@pytest.mark.parametrize(
    "header",
    ["[" * 90_000, "(" * 90_000, " " * 90_000 + "]", "[ " * 45_000, "a," * 45_000, "a" * 90_000],
)
def test_a_hostile_header(header: str, tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text(f"{header}\n1\n")
    told = failures(lambda _: read(file), [None])
    assert not told, told
    with pytest.raises(vi.InputError):
        read(file)
