"""Universal files as measured records: those of this program, and those that pyuff writes."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
import pyuff

import vibroimpact as vi
from support import plain_case
from thin_plate_responses import HEADER
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.exporting.export_result import export_result
from vibroimpact.measurements.record_file import read_universal_record
from vibroimpact.measurements.universal_file import is_universal, read_universal_file

CONTACT = {"law": "adams-impact", "damping_max": 200.0}
NEWTON = {"law": "newton", "restitution": 0.5}
SI = {
    "type": 164,
    "units_code": 1,
    "units_description": "SI",
    "temp_mode": 1,
    "length": 1.0,
    "force": 1.0,
    "temp": 1.0,
    "temp_offset": 273.15,
}
VALUES = np.array([1.0, -2.5, 3.0e5, -4.0e-5, 5.0, 6.5, -7.25])
TIME = 1e-3 * np.arange(7)


def case(**changes: object) -> dict:
    return plain_case(contact=CONTACT, run={"impacts": 3}, **changes)


def calibrated(target: object, contact: dict = NEWTON) -> Calibration:
    table = {
        **case(),
        "contact": contact,
        "calibrate": {"target": target, "degree": 0, "air": False},
    }
    return calibrate_case(calibration_of(table))


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    vi.simulate(vi.case_of(case())).save(folder / "run")
    export_result(folder / "run", "uff58", folder / "out.uff")
    return folder / "out.uff"


RESTITUTIONS = vi.simulate(vi.case_of(case())).impacts["restitution_achieved"]


def by_pyuff(path: Path, *functions: dict, units: dict | None = SI) -> Path:
    common = {
        "type": 58,
        "id1": "a record",
        "id2": "NONE",
        "func_type": 1,
        "rsp_ent_name": "NONE",
        "rsp_node": 1,
        "rsp_dir": 3,
    }
    common |= {
        "ref_ent_name": "NONE",
        "ref_node": 0,
        "ref_dir": 0,
        "abscissa_spacing": 1,
        "abscissa_spec_data_type": 17,
        "binary": 1,
    }
    common |= {
        "ordinate_spec_data_type": 13,
        "orddenom_spec_data_type": 0,
        "z_axis_spec_data_type": 0,
        "x": TIME,
        "data": VALUES,
    }
    common |= {
        "abscissa_axis_lab": "time",
        "abscissa_axis_units_lab": "s",
        "ordinate_axis_units_lab": "N",
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        sets = [units or HEADER]
        pyuff.UFF(str(path)).write_sets(
            [*sets, *({**common, **one} for one in functions)], "overwrite"
        )
    return path


@pytest.mark.slow
def test_the_programs_own(exported: Path) -> None:
    """A position tells rebounds, a force also how hard the impacts are; the damping that
    was simulated is found again.
    """
    assert read_universal_record(exported, None, False).quantity == "force"
    found = calibrated(str(exported), CONTACT)
    assert found.overlays[0].quantity == "position"
    np.testing.assert_allclose(found.values, 200.0, rtol=0.02)
    assert found.values[0] == pytest.approx(200.0, rel=2e-3)


def test_a_function_by_its_name_or_number(exported: Path) -> None:
    for name in ("contact force on the sphere", "4", "acceleration of the sphere"):
        found = calibrated({"file": str(exported), "function": name})
        assert found.observations.record.quantity == "force"
        np.testing.assert_allclose(found.values, RESTITUTIONS, rtol=5e-3)
    with pytest.raises(
        vi.InputError,
        match=r'there is no function "contact fore on the sphere".*Did you mean "contact force '
        r'on the sphere"',
    ):
        calibrated({"file": str(exported), "function": "contact fore on the sphere"})
    with pytest.raises(vi.InputError, match="is no force, displacement or acceleration"):
        calibrated({"file": str(exported), "function": "velocity of the sphere"})


def test_it_reads_what_pyuff_reads(exported: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        theirs = [one for one in pyuff.UFF(str(exported)).read_sets() if one["type"] == 58]
    ours = read_universal_file(exported).functions
    assert [one.identification for one in ours] == [one["id1"] for one in theirs]
    for one, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(one.values, other["data"])
        np.testing.assert_allclose(one.time, other["x"], rtol=1e-12)


@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.parametrize("even", [0, 1])
def test_the_forms_of_pyuff(tmp_path: Path, binary: int, even: int) -> None:
    time = TIME if even else TIME**1.5
    file = by_pyuff(tmp_path / "a.uff", {"binary": binary, "abscissa_spacing": even, "x": time})
    record = read_universal_record(file, None, False)
    np.testing.assert_allclose(record.values, VALUES, rtol=1e-11)
    np.testing.assert_allclose(record.time, time, rtol=1e-5 if not binary else 1e-12, atol=1e-12)


def test_single_precision_of_either_order(tmp_path: Path) -> None:
    """As a text by hand, and as binary data of a machine with the large end first."""
    whole = by_pyuff(tmp_path / "a.uff", {"binary": 0}).read_bytes().split(b"\n")
    at = next(
        number for number, line in enumerate(whole) if line.startswith(b"         4         7")
    )
    whole[at] = whole[at].replace(b"         4", b"         2", 1)
    text = "".join(f"{value:13.5e}" for value in VALUES)
    (tmp_path / "b.uff").write_bytes(
        b"\n".join([*whole[: at + 5], text[:78].encode(), text[78:].encode(), b"    -1", b""])
    )
    np.testing.assert_allclose(
        read_universal_record(tmp_path / "b.uff", None, False).values, VALUES, rtol=1e-5
    )
    data = struct.pack(">7f", *VALUES)
    kind = next(number for number, line in enumerate(whole) if line.strip() == b"58")
    whole[kind] = (
        f"    58b     2     2          11{len(data):12d}     0     0           0           "
        "0".encode()
    )
    (tmp_path / "c.uff").write_bytes(b"\n".join(whole[: at + 5]) + b"\n" + data + b"\n    -1\n")
    np.testing.assert_array_equal(
        read_universal_record(tmp_path / "c.uff", None, False).values, VALUES.astype(np.float32)
    )


def test_units(tmp_path: Path) -> None:
    """By dataset 164, by the label, and by neither."""
    milli = {**SI, "units_code": 9, "length": 1000.0, "force": 1000.0}
    label = {"ordinate_axis_units_lab": "kN"}
    none = {"ordinate_axis_units_lab": "NONE"}
    for units, one, factor in (
        (milli, none, 1e-3),
        (None, label, 1e3),
        (SI, none, 1.0),
        (milli, {"ordinate_axis_units_lab": "mN"}, 1e-3),
    ):
        record = read_universal_record(by_pyuff(tmp_path / "a.uff", one, units=units), None, False)
        np.testing.assert_allclose(record.values, factor * VALUES, rtol=1e-12)
    with pytest.raises(vi.InputError, match="it has no unit, and there is no dataset 164"):
        read_universal_record(by_pyuff(tmp_path / "b.uff", none, units=None), None, False)
    with pytest.raises(vi.InputError, match='its unit is "kN", and by dataset 164'):
        read_universal_record(by_pyuff(tmp_path / "c.uff", label), None, False)


def test_which_function_is_asked_for(tmp_path: Path) -> None:
    two = by_pyuff(
        tmp_path / "two.uff", {"id1": "load cell 1"}, {"id1": "load cell 2", "data": 2.0 * VALUES}
    )
    with pytest.raises(
        vi.InputError, match='name the function to use: there are 1 "load cell 1", 2 "load cell 2"'
    ):
        calibrated(str(two))
    assert read_universal_record(two, "2", False).values[0] == 2.0
    acceleration = by_pyuff(
        tmp_path / "a.uff",
        {"id1": "plate", "ordinate_spec_data_type": 12, "ordinate_axis_units_lab": "m/s2"},
    )
    with pytest.raises(
        vi.InputError,
        match='"plate": in a table, only the acceleration of the sphere determines a rebound',
    ):
        calibrated(str(acceleration))
    velocity = by_pyuff(
        tmp_path / "v.uff",
        {"id1": "vibrometer", "ordinate_spec_data_type": 11, "ordinate_axis_units_lab": "m/s"},
    )
    with pytest.raises(
        vi.InputError,
        match='no force, displacement or acceleration over time in it; there are 1 "vibrometer"',
    ):
        calibrated(str(velocity))
    (tmp_path / "t.csv").write_text("time_s,force_N\n0,1\n")
    with pytest.raises(vi.InputError, match="only a universal file has functions"):
        calibrated({"file": str(tmp_path / "t.csv"), "function": "1"})


def test_damaged_files_are_told(exported: Path, tmp_path: Path) -> None:
    """Every hundredth byte cut off, and 200 bytes of the headers changed: one message, or
    numbers.
    """
    whole, random = exported.read_bytes()[:20000], np.random.default_rng(0)
    damaged = [whole[:end] for end in range(0, 2000, 100)]
    for _ in range(200):
        changed = bytearray(whole)
        changed[random.integers(0, 1500)] = random.integers(0, 256)
        damaged.append(bytes(changed))
    told = []
    for one in damaged:
        (tmp_path / "d.uff").write_bytes(one)
        if not is_universal(tmp_path / "d.uff"):
            continue
        try:
            read_universal_file(tmp_path / "d.uff")
        except vi.InputError as error:
            told.append(str(error))
    assert len(told) > 10
    assert all("d.uff" in words and "\n" not in words for words in told)
