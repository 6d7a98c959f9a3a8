"""Units in the spellings that people and instruments write: one reader for cases, tables,
universal files and the command `units`.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import ROOT
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.cases.build import problem_of
from vibroimpact.cases.rigid.plate_motion import motion_of
from vibroimpact.cli import main
from vibroimpact.identification.measured import sensors_of
from vibroimpact.measurements.record_file import read_universal_record
from vibroimpact.signals.reading.si_units import in_si

_SIGNALS = {"m/s^2": "m/s2", "m/s": "m/s", "m": "m", "N": "N", "Pa": "Pa", "V": "V", "1": "1"}
"""Units of the page that a signal can have, and as a record has them."""

_FACTORS = {
    "mm/s²": 1e-3,
    "cm/s2": 1e-2,
    "Gal": 1e-2,
    **dict.fromkeys(("g", "gn", "g_n", "g0", "G"), 9.80665),
    "mg": 9.80665e-3,
    "µg": 9.80665e-6,
    "mm/s": 1e-3,
    "km/h": 1.0 / 3.6,
    "in/s": 0.0254,
    "mm": 1e-3,
    **dict.fromkeys(("µm", "μm", "um", "micron", "µs", "μs", "us", "µPa", "µV", "μV", "uV"), 1e-6),
    "in": 0.0254,
    "ms": 1e-3,
    "min": 60.0,
    "kN": 1e3,
    "lbf": 4.4482216152605,
    "kgf": 9.80665,
    "N/mm2": 1e6,
    "MPa": 1e6,
    "GPa": 1e9,
    "bar": 1e5,
    "psi": 4.4482216152605 / 0.0254**2,
    **dict.fromkeys(("g/cm³", "g/cc"), 1e3),
    "N mm^-1.5": 1e3**1.5,
    "kN/mm^1.5": 1e3**2.5,
    "Ns/mm": 1e3,
    "mV": 1e-3,
    **dict.fromkeys(("mV/g", "mV/gn", "mV/G"), 1e-3 / 9.80665),
    **dict.fromkeys(("mV/(m/s^2)", "mV/(m/s²)"), 1e-3),
    "mV/(mm/s)": 1.0,
    **dict.fromkeys(("mPa·s", "mPas", "cP"), 1e-3),
    **dict.fromkeys(("deg", "°"), np.pi / 180.0),
    "mm/m": 1e-3,
    **dict.fromkeys(("um/m", "µm/m", "microstrain", "µε"), 1e-6),
    "%": 1e-2,
}
"""What a spelling is in the SI unit of its row; the others are 1."""


def spellings() -> list[tuple[str, str]]:
    """Return the rows of the page's table, as SI unit and spelling."""
    page = Path(ROOT, "docs/conventions.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"^\| [a-z ]+, (\S+(?: s(?:\^2)?/m)?) \| (.*) \|$",
        page.partition("## Spellings of units")[2],
        re.MULTILINE,
    )
    return [(unit, word) for unit, words in rows for word in re.findall(r"`([^`]+)`", words)]


QUANTITIES = [(unit, word) for unit, word in spellings() if unit != "1"]
OF_SIGNALS = [(unit, word) for unit, word in spellings() if unit in _SIGNALS]


def test_the_page_has_all_rows() -> None:
    assert len({unit for unit, _ in spellings()}) == 15
    assert _FACTORS.keys() <= {word for _, word in spellings()}
    assert "m/s2" in {word for _, word in spellings()}


@pytest.mark.parametrize(("unit", "word"), QUANTITIES)
def test_in_a_case(unit: str, word: str) -> None:
    assert vi.units.to_si(f"2.5 {word}", unit) == pytest.approx(
        2.5 * _FACTORS.get(word, 1.0), rel=1e-14
    )


@pytest.mark.parametrize(("unit", "word"), QUANTITIES)
def test_by_the_command(
    unit: str, word: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert vi.units.convert_units(2.5, word, unit) == pytest.approx(
        2.5 * _FACTORS.get(word, 1.0), rel=1e-14
    )
    monkeypatch.setattr("sys.argv", ["vibroimpact", "units", "2.5", word, "--to", unit])
    with pytest.raises(SystemExit) as left:
        main()
    assert not left.value.code
    assert f"{2.5 * _FACTORS.get(word, 1.0):.10g} {unit}" in " ".join(
        capsys.readouterr().out.split()
    )


@pytest.mark.parametrize(("unit", "word"), OF_SIGNALS)
def test_in_a_table_and_a_universal_file(unit: str, word: str, tmp_path: Path) -> None:
    factor = _FACTORS.get(word, 1.0)
    table, universal = tmp_path / "a.csv", tmp_path / "a.uff"
    table.write_text(f"Zeit [ms];Kanal 1 [{word}]\n0;1,5\n0,5;-2\n", encoding="utf-8")
    universal.write_bytes(universal_file(word.encode()))
    for path in (table, universal):
        (found,) = vi.signals.load_records(path)
        assert (found.unit, found.rate) == (_SIGNALS[unit], 2000.0)
        np.testing.assert_allclose(found.value, factor * np.array([1.5, -2.0]), rtol=1e-14)


def universal_file(unit: bytes, kind: int = 1) -> bytes:
    """Return a universal file of two samples at 2 kHz, whose label of the unit has any encoding."""
    head = [
        b"    -1",
        b"    58",
        b"channel 1",
        *4 * [b"NONE"],
        b"    1         0    0         0 NONE               0   0 NONE               0   0",
    ]
    head += [b"         4         2         1  0.00000e+00  5.00000e-04  0.00000e+00"]
    head += [
        b"        17    0    0    0 time                 s",
        f"{kind:10d}    0    0    0 channel 1            ".encode() + unit,
    ]
    return b"\n".join(
        [
            *head,
            *2 * [b"         0    0    0    0 NONE                 NONE"],
            f"{1.5:20.11e}{-2.0:20.11e}".encode(),
            b"    -1",
            b"",
        ]
    )


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_a_label_in_either_encoding(encoding: str, tmp_path: Path) -> None:
    """UTF-8 as HBM catman writes it, and Latin-1; the standard has ASCII only."""
    path = tmp_path / "a.uff"
    path.write_bytes(universal_file("m/s²".encode(encoding)))
    (found,) = vi.signals.load_records(path)
    assert (found.unit, found.value.tolist()) == ("m/s2", [1.5, -2.0])
    path.write_bytes(universal_file("µm".encode(encoding), kind=8))
    np.testing.assert_allclose(
        read_universal_record(path, None, True).values, [1.5e-6, -2e-6], rtol=1e-14
    )


def test_a_measured_table_in_another_spelling(tmp_path: Path) -> None:
    def calibrated(header: str) -> np.ndarray:
        (path := tmp_path / "e.csv").write_text(
            f"{header}\n1,0.8\n2,0.75\n4,0.7\n", encoding="utf-8"
        )
        contact = {"law": "lankarani-nikravesh", "restitution": 0.7}
        return calibrate_case(
            calibration_of(
                plain_case(
                    contact=contact, calibrate={"target": str(path), "degree": 1, "air": False}
                )
            )
        ).values

    np.testing.assert_array_equal(
        calibrated("approach speed [m·s⁻¹],restitution [-]"),
        calibrated("approach_speed_m_s,restitution"),
    )


def test_a_motion_of_the_supports_in_another_spelling(tmp_path: Path) -> None:
    time = 1e-3 * np.arange(50)
    rows = "".join(f"{1e3 * t:g};{1e3 * np.cos(60.0 * t):.9g}\n" for t in time)
    found = []
    for header in ("time [ms];acceleration [mm/s^2]", "Zeit [ms];acceleration [mm·s⁻²]"):
        (path := tmp_path / "motion.csv").write_text(f"{header}\n{rows}", encoding="utf-8")
        plate = {"material": "steel", "model": "rigid", "motion": {"file": str(path)}}
        motion = motion_of(vi.case_of(plain_case(plate=plate)))
        assert motion is not None
        found.append(motion.at(time[3:-3]))
    np.testing.assert_array_equal(found[0], found[1])
    assert np.abs(found[0][2]).max() == pytest.approx(1.0, rel=0.02)  # in m/s^2


def test_a_channel_by_the_cell_of_the_header(tmp_path: Path) -> None:
    path = tmp_path / "audio.csv"
    path.write_text(
        '"Time (s)","Recording (a.u.)","Zweiter Kanal [V]"\n0,1,2\n0.1,3,4\n', encoding="utf-8"
    )
    for name in ("recording", "Recording", "Recording (a.u.)"):
        found = vi.signals.one_record(path, name)
        assert (found.value.tolist(), found.unit) == ([1.0, 3.0], "1")
    assert vi.signals.one_record(path, "Zweiter Kanal").unit == "V"
    with pytest.raises(vi.InputError, match="no channel"):
        vi.signals.one_record(path, "Recordings")


def test_a_sensor_whose_name_has_capitals(tmp_path: Path) -> None:
    """The names of a table's columns are read in small letters, with "_" for blanks."""
    path = tmp_path / "a.csv"
    path.write_text(
        "time [s],Acc 1 [m/s²]\n" + "".join(f"{0.001 * n:.3f},{n % 7}\n" for n in range(100)),
        encoding="utf-8",
    )
    sensors = [{"name": "Acc 1", "position": [0.1, 0.05], "rate": 1000.0}]
    plate = {
        "size": [0.52, 0.42, 0.008],
        "material": "steel",
        "model": "elastic",
        "modes": 5,
        "supports": "clamped",
    }
    problem = problem_of(vi.case_of(plain_case(plate=plate, sensors=sensors)))
    assert [
        one.name for one in sensors_of(problem.sensors, list(vi.signals.load_records(path)))
    ] == ["Acc 1"]


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("1 kg", "m/s^2"),
        ("1 m/s³", "m/s^2"),
        ("1 g", "m"),
        ("1 m²", "m"),
        ("1 mV/kg", "V s^2/m"),
        ("1 s²²", "s"),
    ],
)
def test_what_is_still_refused(text: str, unit: str) -> None:
    with pytest.raises(vi.InputError):
        vi.units.to_si(text, unit)


@pytest.mark.parametrize(
    ("text", "unit", "remedy", "value"),
    [
        ("1,5", "m", 'write a point: "1.5 m"', 1.5),
        ("1,5 mm", "m", 'write a point: "1.5 mm"', 0.0015),
        ("1,234,567 mm", "m", 'leave the commas out: "1234567 mm"', 1234.567),
        ("1,234.5 mm", "m", 'leave the commas out: "1234.5 mm"', 1.2345),
        ("1,234,567", "", "leave the commas out: 1234567", 1234567.0),
        ("5 mm/m", "", "write 0.005", 0.005),
        ("5 ppm", "", "write 5e-06", 5e-6),
    ],
)
def test_a_remedy_is_accepted(text: str, unit: str, remedy: str, value: float) -> None:
    with pytest.raises(vi.InputError) as refused:
        vi.units.to_si(text, unit)
    assert str(refused.value).endswith(remedy)
    written = remedy.partition('"')[2].rstrip('"') or float(remedy.split()[-1])
    assert vi.units.to_si(written, unit) == pytest.approx(value)


def test_a_plain_number_may_be_in_per_cent() -> None:
    assert vi.units.to_si("30 %", "") == pytest.approx(0.3)


def test_a_list_of_numbers_is_no_number_with_commas() -> None:
    with pytest.raises(vi.InputError, match="write one number, with a point before its decimals"):
        vi.units.to_si("1,2,3", "m")


@pytest.mark.parametrize(
    ("text", "kinds"),
    [
        ("50 mJ/m^2", "a stiffness or a work of adhesion"),
        ("100 rad/s", "a frequency or an angular velocity"),
    ],
)
def test_all_kinds_of_a_dimension_are_named(text: str, kinds: str) -> None:
    with pytest.raises(vi.InputError, match=f'"{re.escape(text)}" is {kinds}; expected a length'):
        vi.units.to_si(text, "m")


def test_the_message_names_what_is_accepted() -> None:
    with pytest.raises(vi.InputError) as refused:
        in_si("banana")
    named = str(refused.value).partition("known are ")[2].partition(" and their multiples, ")
    for unit in (*named[0].split(", "), "g", "strain", "1", "a.u."):
        in_si(unit)
