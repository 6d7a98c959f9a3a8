"""Tables of twelve instruments, from the file to the number; cells without numbers,
several rates, and columns that are stated.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from instrument_files import (
    BOUNCES,
    INSTRUMENTS,
    RADIUS,
    RATE,
    RESTITUTION,
    SPEED,
    TIME,
    Instrument,
    height,
    labview,
    ringing,
    tracker,
)
from support import plain_case
from vibroimpact.calibration.bounces.rebounds import rebounds_of
from vibroimpact.measurements.table_file import read_table_file
from vibroimpact.signals.bounces.find import find_bounces

RINGING = [make for make in INSTRUMENTS if make.__name__ not in ("phyphox", "tracker")]
TIMED = "time [s],force [N]\n"
VALUE = np.sin(np.arange(50) / 3.0)


def written(folder: Path, one: Instrument) -> Path:
    path = folder / one.name
    path.write_bytes(one.data)
    return path


def channel(path: Path, name: str, columns: str | None = None) -> vi.signals.Record:
    return next(record for record in vi.signals.load_records(path, columns) if record.name == name)


def read(folder: Path, text: str, columns: str | None = None) -> list[vi.signals.Record]:
    (folder / "record.csv").write_text(text, encoding="utf-8")
    return list(vi.signals.load_records(folder / "record.csv", columns))


def refused(folder: Path, text: str, columns: str | None = None) -> str:
    with pytest.raises(vi.InputError) as caught:
        read(folder, text, columns)
    told = str(caught.value)
    assert len(told) < 490
    return told.removeprefix(f"{folder}/")


# twelve instruments
# -----------------------------------------------------------------------------------


@pytest.mark.parametrize("make", RINGING, ids=lambda make: make.__name__)
def test_from_the_file_to_the_restitution(make: Callable[[], Instrument], tmp_path: Path) -> None:
    one = make()
    record = channel(written(tmp_path, one), one.channel, one.columns)
    assert record.rate == pytest.approx(RATE, rel=1e-9)
    np.testing.assert_allclose(record.value / one.factor, ringing(), atol=5e-4)
    found = rebounds_of(find_bounces(record), height=SPEED**2 / (2.0 * 9.80665))
    assert len(found.restitution) == BOUNCES
    np.testing.assert_allclose(found.restitution[:-1], RESTITUTION, atol=5e-4)


def test_the_phone(tmp_path: Path) -> None:
    phone = next(make() for make in INSTRUMENTS if make.__name__ == "phyphox")
    record = channel(written(tmp_path, phone), "linear_acceleration_x")
    assert record.rate == pytest.approx(400.0, rel=1e-3)
    assert "jitter" in record.doubts[0]
    assert vi.signals.feature_table([record.value], record.rate)["peak_frequency"][
        0
    ] == pytest.approx(40.0, abs=4.0)


def test_the_track_of_a_video_calibrates_a_case(tmp_path: Path) -> None:
    track = tracker()
    section = {
        "target": {"file": str(written(tmp_path, track)), "columns": track.columns},
        "degree": 0,
        "air": False,
    }
    sphere, contact = {"radius": RADIUS, "material": "steel"}, {"law": "newton", "restitution": 0.5}
    case = plain_case(
        sphere=sphere, drop={"speed": SPEED, "gravity": 9.80665}, contact=contact, calibrate=section
    )
    found = vi.calibration.calibrate_case(vi.calibration.calibration_of(case))
    assert found.values == pytest.approx(RESTITUTION, abs=2e-3)
    assert (
        "position: 2 of its samples have no number, the first in line 43: the record is "
        "evaluated without them" in found.doubts
    )


def test_the_units_of_a_track_are_asked_for(
    command: Callable[..., tuple[int, str, str]], tmp_path: Path
) -> None:
    written(tmp_path, tracker())
    code, _, err = command("features", "tracker.txt")
    assert code == 2
    assert 'line 2, column "t": the unit is missing; write it in brackets, such as t [s]' in err
    assert '--columns "time=s,mass_a_x=UNIT,mass_a_y=UNIT,mass_b_x=UNIT,mass_b_y=UNIT"' in err
    assert (
        command(
            "features",
            "tracker.txt",
            "--columns",
            "time=s,mass_a_x=m,mass_a_y=m,mass_b_x=m,mass_b_y=m",
            "--only",
            "rms",
        )[0]
        == 0
    )


# LabVIEW
# ----------------------------------------------------------------------------------------------

SAMPLES = 40


def lvm(
    columns: str,
    rows: str,
    *,
    decimal: str = ".",
    more: str = "",
    dimension: str = "Time",
    apart: str = "\t",
) -> bytes:
    of_file = f"Separator\tTab\nDecimal_Separator\t{decimal}\nMulti_Headings\tNo\nX_Columns\t{columns}\nTime_Pref\tRelative\n"
    two = apart.join(["\t{0}", "{1}"]) + "\t\n"
    head = (
        "Channels\t2\t\t\nSamples"
        + two.format(SAMPLES, SAMPLES)
        + "Y_Unit_Label"
        + two.format("g", "Volts")
    )
    head += (
        f"X_Dimension\t{dimension}{apart}Time\t\n"
        + "X0"
        + two.format("1.0", "0.0")
        + "Delta_X"
        + two.format("0.000250", "0.000500")
    )
    text = (
        "LabVIEW "
        f"Measurement\t\nWriter_Version\t2\n{of_file}***End_of_Header***\t\n\t\n{head}***End_of_Header***\t\t\t\n{rows}{more}"
    )
    return text.replace(".0", f"{decimal}0").encode()


def lvm_records(folder: Path, data: bytes) -> dict[str, vi.signals.Record]:
    (folder / "record.lvm").write_bytes(data)
    return {record.name: record for record in vi.signals.load_records(folder / "record.lvm")}


def lvm_rows(columns: str) -> str:
    header = {
        "No": "X_Value\tax\tay\tComment\n",
        "Multi": "X_Value\tax\tX_Value\tay\tComment\n",
        "One": "X_Value\tax\tay\tComment\n",
    }[columns]
    for row in range(SAMPLES):
        first, second = f"{1.0 + 0.00025 * row:.6f}", f"{0.0005 * row:.6f}"
        times = {"No": ("", ""), "Multi": (f"{first}", f"\t{second}"), "One": (first, "")}[columns]
        header += f"{times[0]}\t{row}.0{times[1]}\t{2 * row}.0\n"
    return header


@pytest.mark.parametrize("columns", ["No", "Multi", "One"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_the_columns_of_times_of_labview(columns: str, decimal: str, tmp_path: Path) -> None:
    rows = lvm_rows(columns)
    data = lvm(columns, rows, apart="\t\t" if columns == "Multi" else "\t")
    data = (
        data
        if decimal == "."
        else data.replace(b".", b",").replace(b"Decimal_Separator\t.", b"Decimal_Separator\t,")
    )
    found = lvm_records(tmp_path, data)
    ax, ay = found["ax"], found["ay"]
    assert (ax.rate, ax.start, ax.unit, ax.doubts) == (4000.0, 1.0, "m/s2", ())
    assert (ay.rate, ay.start, ay.unit) == (2000.0, 0.0, "V")
    np.testing.assert_allclose(ax.value, 9.80665 * np.arange(SAMPLES))
    np.testing.assert_allclose(ay.value, 2.0 * np.arange(SAMPLES))


def test_what_labview_leaves_open(tmp_path: Path) -> None:
    rows = lvm_rows("One")
    further = "\nChannels\t2\t\t\nSamples\t40\t40\t\n***End_of_Header***\n"
    for data, message in (
        (
            lvm("One", rows, more=further),
            "a further segment of the LabVIEW file begins, with a header of its own; a "
            "record is one segment",
        ),
        (
            lvm("One", rows, dimension="Frequency"),
            "line 13: X_Dimension is Frequency; a record is over time",
        ),
        (
            lvm("No", rows).replace(b"Delta_X", b"Delta"),
            'the channel "ax" has neither times (X_Columns is No) nor X0 and a positive Delta_X',
        ),
        (
            b"LabVIEW Measurement\nSeparator\tTab\n0\t1\n",
            "the header of the LabVIEW file does not end",
        ),
    ):
        with pytest.raises(vi.InputError) as caught:
            lvm_records(tmp_path, data)
        assert message in str(caught.value)


def test_a_channel_of_labview_without_unit_is_a_plain_number(tmp_path: Path) -> None:
    records = {
        record.name: record for record in vi.signals.load_records(written(tmp_path, labview()))
    }
    assert (records["untitled"].unit, records["untitled"].rate, len(records["untitled"].value)) == (
        "1",
        1.0,
        5,
    )
    assert (
        "states no unit for it (Y_Unit_Label): it is read as a plain number; --columns (in "
        "a case the key columns) states" in records["untitled"].doubts[0]
    )
    assert records["plate"].doubts == ()


# further layouts
# --------------------------------------------------------------------------------------


def test_an_older_tektronix_oscilloscope(tmp_path: Path) -> None:
    stated = [
        "Record Length,2.5e+03",
        "Sample Interval,1e-03",
        "Source,CH2",
        "Vertical Units,V",
        "Horizontal Units,s",
    ]
    rows = [
        f"{stated[at] if at < 5 else ','},,{at / 1e3:.6f},{value:.6f},"
        for at, value in enumerate(VALUE)
    ]
    (record,) = read(tmp_path, "\n".join(rows) + "\n")
    assert (record.name, record.unit, record.rate) == ("ch2", "V", 1000.0)
    np.testing.assert_allclose(record.value, VALUE, atol=1e-6)


def test_a_siglent_oscilloscope(tmp_path: Path) -> None:
    head = (
        "Record Length,Analog:50\nVertical Units,CH1:V\nHorizontal Units,s\nModel "
        "Number,SDS1104X-E\nSource,CH1\nSecond,Volt\n"
    )
    (record,) = read(
        tmp_path,
        head + "".join(f"{at / 1e4 - 0.01:.6f},{value:.6f}\n" for at, value in enumerate(VALUE)),
    )
    assert (record.name, record.unit, record.rate, record.start) == ("ch1", "V", 10e3, -0.01)
    np.testing.assert_allclose(record.value, VALUE, atol=1e-6)


def test_audacity_in_decibels_is_refused(tmp_path: Path) -> None:
    assert refused(
        tmp_path,
        "a.wav   1 channel (mono)\nSample Rate: 8000 Hz. Sample values on dB scale.\n-6.0\n-7.0\n",
    ).startswith(
        "record.csv, line 2: the samples are in dB, without their sign; export "
        "them on the linear scale"
    )


def test_a_hash_in_the_name_of_a_channel(tmp_path: Path) -> None:
    (record,) = read(
        tmp_path, "time [s],Channel #1 [V]  # of the plate\n0,#N/A\n1,2 # begin\n2,3#end\n3,4\n"
    )
    assert record.name == "channel_#1"
    assert record.value.tolist() == [2.0, 3.0, 4.0]


def test_decimal_commas_between_quotes(tmp_path: Path) -> None:
    (record,) = read(tmp_path, 'time [s],force [N]\n"0,5","1,2"\n"0,6","1,25"\n')
    assert (record.rate, record.value.tolist()) == (10.0, [1.2, 1.25])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "time [s];force [N]\n0,5;1.234\n0,6;1,2\n",
            'line 2: "1.234" has a point, and a number in line 2 a comma: either may group digits',
        ),
        (
            "time [s];force [N]\n0,5;1,2\n0,6;1,2\n0,7;1.234\n",
            'line 4: "1.234" has a point, and a number in line 2 a comma',
        ),
        (
            'time [s],force [N]\n0,"1,234"\n1,"1,2"\n',
            '"1,234" is not a number; a comma is the decimal point or groups digits there',
        ),
    ],
)
def test_numbers_with_two_meanings_are_refused(text: str, message: str, tmp_path: Path) -> None:
    """A German spreadsheet writes 1234 as 1.234, which was read as 1.234."""
    assert message in refused(tmp_path, text)


# cells without numbers
# --------------------------------------------------------------------------------


def table(cells: list[str]) -> str:
    return TIMED + "".join(f"{at / 1e3:.3f},{cell}\n" for at, cell in enumerate(cells))


CELLS = [f"{value:.6f}" for value in VALUE]


@pytest.mark.parametrize("blank", ["", "NaN", "nan", "-", "#N/A", "9.91E+37"])
def test_cells_without_numbers_at_the_ends_are_cut(blank: str, tmp_path: Path) -> None:
    (record,) = read(tmp_path, table([blank] * 3 + CELLS[3:45] + [blank] * 5))
    assert (record.start, record.rate, len(record.value), record.doubts) == (0.003, 1000.0, 42, ())
    np.testing.assert_allclose(record.value, VALUE[3:45], atol=1e-6)


@pytest.mark.parametrize("blank", ["", "NaN", "--"])
def test_a_few_within_are_filled_in_with_a_doubt(blank: str, tmp_path: Path) -> None:
    cells = [blank if at in (20, 21) else cell for at, cell in enumerate(CELLS)]
    (record,) = read(tmp_path, table(cells))
    (doubt,) = record.doubts
    assert doubt.startswith(
        '"force": 2 of its samples are missing, the first in line 22: filled in by cubic '
        "splines, which adds an error"
    )
    stated = float(doubt.partition("up to ")[2].partition(" %")[0]) / 100.0 * np.ptp(VALUE)
    assert 0.0 < np.abs(record.value - VALUE).max() < stated


def test_many_within_are_refused(tmp_path: Path) -> None:
    told = refused(
        tmp_path, table(["" if 20 <= at < 26 else cell for at, cell in enumerate(CELLS)])
    )
    assert told.startswith(
        'record.csv, line 22, column "force [N]": 6 cells from there on have no number, up '
        "to 6 in a row; only 3 in a row"
    )
    assert "Fill them in, or keep the part before or after them" in told
    assert refused(tmp_path, table(["" for _ in CELLS])).startswith(
        'record.csv: column "force [N]": there is no number in it'
    )
    assert refused(tmp_path, f"{TIMED}0,1\n,2\n2,3\n").startswith(
        'record.csv, line 3, column "force [N]": the sample has no time'
    )


@pytest.mark.parametrize(
    ("above", "below"), [("∞", "-∞"), ("inf", "-inf"), ("9.9E+37", "-9.9E+37")]
)
def test_samples_over_the_range_are_at_the_range(above: str, below: str, tmp_path: Path) -> None:
    cells = [above if value > 0.9 else below if value < -0.9 else f"{value:.6f}" for value in VALUE]
    (record,) = read(tmp_path, table(cells))
    assert np.abs(record.value).max() < 0.9
    assert (
        f"{int((np.abs(VALUE) > 0.9).sum())} of its samples are over the range (infinite)"
        in record.doubts[0]
    )
    assert refused(tmp_path, table([above] * 5)).endswith(
        "all samples are over the range; record it with a larger one"
    )


def test_a_table_of_impacts_takes_none(tmp_path: Path) -> None:
    (tmp_path / "ev.csv").write_text("speed [m/s],restitution\n1,0.8\n2,\n")
    with pytest.raises(
        vi.InputError,
        match='line 3, column "restitution": the cell is empty; fill it in, or leave out the line',
    ):
        vi.calibration.load_restitutions(tmp_path / "ev.csv")


# several rates, and times that are doubled
# ------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "time [s],a [V],b [V]\n"
        + "".join(f"{at / 1e3},{at % 7},{at if at % 10 == 0 else ''}\n" for at in range(50)),
        "time [s],a [V],time [s],b [V]\n"
        + "".join(
            f"{at / 1e3},{at % 7},{at / 100 if at < 5 else ''},{10 * at if at < 5 else ''}\n"
            for at in range(50)
        ),
        "Zeit a [s],a [V],time_b [ms],b [V]\n"
        + "".join(
            f"{at / 1e3},{at % 7}" + (f",{10 * at},{10 * at}\n" if at < 5 else "\n")
            for at in range(50)
        ),
        "time [s],a [V],b [V]\n"
        + "".join(
            f"{at / 1e3},{at % 7},\n" + (f"{at / 1e3},,{at}\n" if at % 10 == 0 else "")
            for at in range(50)
        ),
    ],
    ids=["blank cells between", "two columns of times", "by their unit", "rows in turns"],
)
def test_two_channels_at_different_rates(text: str, tmp_path: Path) -> None:
    a, b = read(tmp_path, text)
    assert (a.name, a.rate, len(a.value), a.doubts) == ("a", 1000.0, 50, ())
    assert (b.name, b.rate, b.value.tolist(), b.doubts) == (
        "b",
        100.0,
        [0.0, 10.0, 20.0, 30.0, 40.0],
        (),
    )


def test_rows_that_a_logger_wrote_twice_are_left_out(tmp_path: Path) -> None:
    rows = [
        f"{at / 1e3},{value:.6f}\n" * (2 if at in (20, 30) else 1) for at, value in enumerate(VALUE)
    ]
    (record,) = read(tmp_path, TIMED + "".join(rows))
    assert record.rate == 1000.0
    np.testing.assert_allclose(record.value, VALUE, atol=1e-6)
    assert record.doubts == (
        '"force": 2 samples have time and value of the one before, the first is sample 22 '
        "(line 23): they are left out",
    )


def test_doubled_times_with_other_values_are_rounded_ones(tmp_path: Path) -> None:
    (record,) = read(
        tmp_path,
        TIMED + "".join(f"{at // 2 / 1e3},{value:.6f}\n" for at, value in enumerate(VALUE)),
    )
    assert record.rate == pytest.approx(2000.0, rel=0.01)
    assert "its times are rounded to 0.001 s, 2 steps" in record.doubts[0]


def test_a_record_for_a_case_with_its_own_times(tmp_path: Path) -> None:
    """Force and position at different rates; the position is evaluated, with the times
    beside it.
    """
    slow = np.arange(132) / 240.0
    rows = [
        f"{at / 1e3},{np.sin(at / 9.0):.4f}"
        + (f",{slow[at]:.6f},{height(slow)[at]:.7f}\n" if at < len(slow) else ",,\n")
        for at in range(400)
    ]
    (tmp_path / "record.csv").write_text(
        "time [s],force [N],time [s],position [m]\n" + "".join(rows)
    )
    section = {"target": str(tmp_path / "record.csv"), "degree": 0, "air": False}
    sphere, contact = {"radius": RADIUS, "material": "steel"}, {"law": "newton", "restitution": 0.5}
    case = plain_case(
        sphere=sphere, drop={"speed": SPEED, "gravity": 9.80665}, contact=contact, calibrate=section
    )
    assert vi.calibration.calibrate_case(
        vi.calibration.calibration_of(case)
    ).values == pytest.approx(RESTITUTION, abs=2e-3)


# columns that are stated
# ------------------------------------------------------------------------------

BARE = "".join(f"{at / 1e3},{value:.6f}\n" for at, value in enumerate(VALUE))


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        (BARE, "time=s,force=N"),
        (BARE, "-,rate=1 kHz,force=N"),
        (BARE.replace(",", ";").replace(".", ","), "time=s; force=N".replace(";", ",")),
        ("t,x\n" + BARE, "time=s,force=N"),
        ("A recorder, of mine\nwith, three, words\n" + BARE, "t=s,Kraft=N"),
        (
            "number,stamp,t,F\n"
            + "".join(f"{at},12:{at:02d},{row}\n" for at, row in enumerate(BARE.split())),
            "-,-,time=s,force=N",
        ),
        ("".join(f"{value:.6f}\n" for value in VALUE), "rate=1000 Hz,force=N"),
        (BARE, "-,rate=1000,force=N"),
    ],
    ids=[
        "no header",
        "a rate",
        "decimal commas",
        "without units",
        "a preamble",
        "text in other columns",
        "one column",
        "a bare rate",
    ],
)
def test_columns_are_stated(text: str, columns: str, tmp_path: Path) -> None:
    (record,) = read(tmp_path, text, columns)
    assert (record.name, record.unit, record.rate) == ("force", "N", 1000.0)
    np.testing.assert_allclose(record.value, VALUE, atol=1e-6)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (
            "time=s,force=N,way=m",
            "--columns: line 1 has 2 fields, separated by commas, and 3 columns are stated; "
            "state each column, and -",
        ),
        (
            "time=s,force=",
            '--columns "time=s,force=": "force=" is no column; state NAME=UNIT for each, '
            "and - for one that is left out",
        ),
        ("", '--columns "": "" is no column'),
        ("-,-", "it names no column; state NAME=UNIT for each"),
        (
            "time=s,force",
            '--columns, column "force": the unit is missing; state it, such as force=V, or '
            "1 for a plain number",
        ),
        ("time=s,force=kg", '--columns, column "force [kg]": "kg" is no unit of a signal'),
        (
            "-,force=N",
            "there is no column time [s]; the columns are those stated, and the first row "
            "is line 1. State time=s for it",
        ),
        (
            "rate=1 kHz,time=s,force=N",
            "the rate follows from the column of times; leave rate out, or - for that column",
        ),
        ("rate=5 m,force=N", '--columns: rate: "5 m" is a length; expected a frequency'),
        ("rate=0 Hz,force=N", "it must be greater than 0"),
    ],
)
def test_columns_that_are_not_those_of_the_table(
    columns: str, message: str, tmp_path: Path
) -> None:
    assert message in refused(tmp_path, BARE, columns)


def test_the_option_of_features_and_calibrate(command: Callable[..., tuple[int, str, str]]) -> None:
    np.savetxt("bounces.txt", np.stack([TIME, ringing()], axis=1))
    for words in (("features", "bounces.txt"), ("calibrate", "bounces.txt", "-o", "none")):
        code, _, err = command(*words)
        assert code == 2
        assert (
            "line 1: it has 2 numbers, and no header is above it; write a header, such as "
            'time [s],force [N], or give --columns "time=s,f' in err
        )
    code, out, _ = command(
        "features", "bounces.txt", "--columns", "time=s,plate=V", "--only", "peak", "--json"
    )
    assert code == 0
    assert json.loads(out)["signals"][0]["peak"] == pytest.approx(np.abs(ringing()).max(), rel=1e-3)
    code, out, _ = command(
        "calibrate", "bounces.txt", "--columns", "time=s,plate=V", "-o", "found", "--json"
    )
    assert code == 0
    assert json.loads(out)["bounces"]["impacts"][1]["restitution"] == pytest.approx(
        RESTITUTION, abs=5e-4
    )
    Path("ev.csv").write_text("1,0.81\n2,0.78\n4,0.74\n")
    code, out, _ = command(
        "calibrate", "ev.csv", "--columns", "speed=m/s,restitution", "-o", "fitted", "--json"
    )
    assert code == 0
    assert [row["restitution"] for row in json.loads(out)["restitutions"]["rows"]] == [
        0.81,
        0.78,
        0.74,
    ]
    assert (
        "--columns goes with a table of restitutions or of bounces"
        in command("calibrate", "paper:calibration", "--columns", "time=s,force=N")[2]
    )
    assert (
        "and this is none; leave it out"
        in command("features", "found/summary.wav", "--columns", "time=s,force=N")[2]
    )


def test_the_keys_of_a_case(tmp_path: Path) -> None:
    (tmp_path / "bare.csv").write_text(BARE)
    columns = "time=s,displacement=mm"
    with pytest.raises(
        vi.InputError,
        match=r'plate\.motion\.file.*give --columns "time=s,force=N", .* \(in a case the key '
        r"columns\)",
    ):
        vi.case_of(plain_case(plate__motion={"file": str(tmp_path / "bare.csv")})).to_problem()
    (tmp_path / "named.csv").write_text(f"time [s],displacement [mm]\n{BARE}")
    stated, named = (
        vi.case_of(plain_case(plate__motion=motion)).to_problem().motion
        for motion in (
            {"file": str(tmp_path / "bare.csv"), "columns": columns},
            {"file": str(tmp_path / "named.csv")},
        )
    )
    assert stated is not None
    assert named is not None
    assert stated.at(TIME[:900])[0] == pytest.approx(named.at(TIME[:900])[0], abs=1e-12)
    with pytest.raises(vi.InputError, match=r"plate\.motion\.columns: only a file has columns"):
        vi.case_of(
            plain_case(plate__motion={"amplitude": 1e-3, "frequency": 20.0, "columns": columns})
        )
    (tmp_path / "sieve.csv").write_text("12,0.5\n15,0.5\n")
    over = {
        "sphere.radius": {
            "file": str(tmp_path / "sieve.csv"),
            "column": "radius",
            "columns": "radius=mm,share",
            "weights": "share",
        }
    }
    (axis,) = vi.studies.sweep_of(plain_case(sweep={"over": over})).axes.values()
    assert axis.levels().tolist() == [0.012, 0.015]
    (tmp_path / "drop.uff").write_text("    -1\n   164\n    -1\n")
    section = {"target": {"file": str(tmp_path / "drop.uff"), "columns": columns}}
    what = vi.calibration.calibration_of(
        plain_case(calibrate=section, contact={"law": "newton", "restitution": 0.5})
    )
    with pytest.raises(
        vi.InputError, match=r"target\.columns: a universal file has functions, and no columns"
    ):
        vi.calibration.calibrate_case(what)


def test_a_table_file_with_stated_columns(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("1;2\n3;4\n")
    found = read_table_file(tmp_path / "table.csv", {"force": "N"}, columns="-,force=kN")
    assert found.columns["force"].tolist() == [2000.0, 4000.0]


# what is understood is said
# ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "t,x\n" + BARE,
            'line 1, column "t": the unit is missing; write it in brackets, such as t [s], '
            'or give --columns "time=s,x=UNIT"',
        ),
        (
            "a,b,c\n1,2,3\n4,5,6\n",
            "there is no column time [s]; line 1 was taken for the header: a, b, c, "
            "separated by commas. Name the times so",
        ),
        (
            f"{TIMED}0,1,2\n1,2,3\n",
            "line 2: there are 3 fields, and the header has 2; where a comma is the decimal "
            "point, semicolons",
        ),
        (
            TIMED,
            "there are no rows under the header; line 1 was taken for the header: time [s], "
            "force [N], separated by commas",
        ),
        (
            TIMED + BARE + BARE,
            'column "time [s]": the times do not rise: sample 51 (line 52) is 0.049 s '
            "before the one above, at 0 s; if the file",
        ),
        (
            TIMED + "0,1\n" * 20 + "0,2\n",
            'column "time [s]": the times do not rise: all are 0 s; write them with more digits',
        ),
        (
            TIMED + BARE.replace("0.049", "9"),
            "leads to sample 50 (line 51); keep the part before or after "
            "it, or resample the record",
        ),
        ("time [s],force [banana]\n" + BARE, '"banana" is no unit of a signal'),
        (
            "time [kg],force [N]\n" + BARE,
            'line 1, column "time [kg]": "kg" is a mass; expected a time, such as s',
        ),
        (
            "time [foo],force [N]\n" + BARE,
            'column "time [foo]": "foo" is not a unit that is known; expected a time, such as s',
        ),
        ("force [N]\n1\n2\n", "line 1 was taken for the header: force [N], of one column"),
        ("time\n1\n2\n", 'write it in brackets, such as time [s], or give --columns "time=s"'),
    ],
)
def test_what_was_understood_is_said(text: str, told: str, tmp_path: Path) -> None:
    assert told in refused(tmp_path, text)


def test_what_was_done_to_a_record_is_a_doubt_of_its_calibration(tmp_path: Path) -> None:
    """A sample written twice with another value, and a byte of Latin-1."""
    slow = np.arange(132) / 240.0
    rows = [f"{at:.6f};{up:.7f}\n" for at, up in zip(slow, height(slow), strict=True)]
    rows.insert(30, rows[29].replace("\n", "1\n"))
    rows.insert(60, f"{slow[58]:.6f};0.5\n")
    (tmp_path / "record.csv").write_bytes(
        "# Prüfstand\nZeit [s];position [m]\n".encode("latin-1")
        + "".join(rows).replace(".", ",").encode()
    )
    section = {"target": str(tmp_path / "record.csv"), "degree": 0, "air": False}
    sphere, contact = {"radius": RADIUS, "material": "steel"}, {"law": "newton", "restitution": 0.5}
    case = plain_case(
        sphere=sphere, drop={"speed": SPEED, "gravity": 9.80665}, contact=contact, calibrate=section
    )
    found = vi.calibration.calibrate_case(vi.calibration.calibration_of(case))
    assert found.values == pytest.approx(RESTITUTION, abs=2e-3)
    doubts = " ".join(found.doubts)
    assert "line 1 has the byte FC, which is not UTF-8" in doubts
    assert (
        "position: 1 sample has the time of the one before and another value, in line 63: "
        "it is left out" in doubts
    )
