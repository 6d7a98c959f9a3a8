"""Records from CSV, WAV, universal files, NetCDF and folders."""

from __future__ import annotations

import struct
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import wavfile

import vibroimpact as vi
from vibroimpact.files.reading import FileKind, read_bytes, received
from vibroimpact.signals.reading.record_files import records_in

PLATE = {"size": ["300 mm", "200 mm", "8 mm"], "material": "steel"}
SIGNAL = np.round(np.sin(np.arange(50) / 3.0) * np.exp(-np.arange(50) / 20.0), 6)


def only(path: Path) -> vi.signals.Record:
    (record,) = vi.signals.load_records(path)
    assert record.source == str(path)
    return record


def test_a_table_with_units(tmp_path: Path) -> None:
    path = tmp_path / "hammer.csv"
    rows = "\n".join(
        f"{0.02 * place:.3f};{value};{2 * value}" for place, value in enumerate(SIGNAL)
    )
    path.write_text(f"# a test\ntime [ms];geophone [mV];Plate acceleration (g)\n{rows}\n")
    geophone, plate = vi.signals.load_records(path)
    assert (geophone.name, geophone.unit, geophone.rate, geophone.start) == (
        "geophone",
        "V",
        50e3,
        0.0,
    )
    np.testing.assert_allclose(geophone.value, 1e-3 * SIGNAL)
    assert (plate.name, plate.unit) == ("plate_acceleration", "m/s2")
    np.testing.assert_allclose(plate.value, 2.0 * 9.80665 * SIGNAL)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("time_s,force\n0,1\n1,2\n", "the unit is missing; write it in brackets, such as force"),
        ("time_s,force [banana]\n0,1\n1,2\n", "is no unit of a signal"),
        ("force_N\n1\n2\n", "there is no column time"),
        ("time_s\n1\n2\n", "no column beside the time"),
        ("time_s,force_N\n0,1\n", "two samples or more"),
        ("time_s,force_N\n0,1\n1,2\n5,3\n", "do not rise by equal steps"),
        ("time_s,force_N\n1,1\n0,2\n", "the times do not rise"),
        ("time_s,force_N\n0,1\n1,nan\n", "two samples or more"),
        ("time_s,force_N\n0,1\n1,1e31\n", "it must be less than 1e30"),
        ("time_s,force_N\n0,1\n1,x\n", "line 3"),
    ],
)
def test_a_wrong_table_says_what_is_wrong(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.csv"
    path.write_text(text)
    with pytest.raises(vi.InputError, match=message) as error:
        list(vi.signals.load_records(path))
    assert "wrong.csv" in str(error.value)


def test_a_table_of_this_program(tmp_path: Path) -> None:
    path = tmp_path / "a1.csv"
    path.write_text("time_s,acceleration_m_s2\n0,1.5\n0.00002,-2.5\n0.00004,0\n")
    record = only(path)
    assert (record.name, record.unit, record.rate, record.value.tolist()) == (
        "acceleration",
        "m/s2",
        50e3,
        [1.5, -2.5, 0.0],
    )


@pytest.mark.parametrize(
    ("kind", "step"),
    [("int16", 2**-15), ("int32", 2**-31), ("uint8", 2**-7), ("float32", 1e-7), ("float64", 1e-15)],
)
def test_wav_files(kind: str, step: float, tmp_path: Path) -> None:
    path = tmp_path / "taps.wav"
    full = {"int16": 2**15 - 1, "int32": 2**31 - 1, "uint8": 127}.get(kind, 1)
    wavfile.write(path, 44100, (SIGNAL * full + (128 if kind == "uint8" else 0)).astype(kind))
    record = only(path)
    assert (record.name, record.unit, record.rate) == ("taps", "1", 44100.0)
    np.testing.assert_allclose(record.value, SIGNAL, atol=2.0 * step)


def test_wav_of_24_bits_with_two_channels(tmp_path: Path) -> None:
    path = tmp_path / "taps.wav"
    left = np.round(SIGNAL * (2**23 - 1)).astype(int)
    data = b"".join(
        int(value).to_bytes(3, "little", signed=True)
        for pair in zip(left, -left, strict=True)
        for value in pair
    )
    head = struct.pack(
        "<4sI4s4sIHHIIHH4sI",
        b"RIFF",
        36 + len(data),
        b"WAVE",
        b"fmt ",
        16,
        1,
        2,
        48000,
        288000,
        6,
        24,
        b"data",
        len(data),
    )
    path.write_bytes(head + data)
    one, other = vi.signals.load_records(path)
    assert (one.name, other.name) == ("taps 1", "taps 2")
    np.testing.assert_allclose(one.value, SIGNAL, atol=2**-22)
    np.testing.assert_array_equal(other.value, -one.value)


@pytest.mark.parametrize(
    "data", [b"", b"no sound", b"RIFF\0\0\0\0WAVEfmt ", b"RIFF" + 200 * b"\xff"]
)
def test_damaged_wav_files(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "damaged.wav"
    path.write_bytes(data)
    with pytest.raises(vi.InputError, match=r"damaged\.wav"):
        list(vi.signals.load_records(path))


@pytest.fixture(scope="module")
def elastic(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a run with a sensor."""
    place = tmp_path_factory.mktemp("records") / "run"
    case = vi.case_of(
        {
            "name": "two bounces",
            "sphere": {"radius": "25 mm", "material": "steel"},
            "plate": {
                "size": ["300 mm", "200 mm", "8 mm"],
                "material": "steel",
                "model": "elastic",
                "modes": 6,
                "supports": "simply-supported",
            },
            "drop": {"speed": "1 m/s"},
            "contact": {"law": "hunt-crossley", "restitution": 0.5},
            "run": {"duration": "20 ms"},
            "sensors": [
                {
                    "name": "a1",
                    "position": ["50 mm", "20 mm"],
                    "quantity": "velocity",
                    "rate": "20 kHz",
                }
            ],
        }
    )
    vi.simulate(case).save(place)
    return place


@pytest.mark.parametrize(
    ("format", "file", "close"),
    [("uff58", "*.uff", 1e-12), ("wav", "*.wav", 1e-7), ("mat", None, 0.0)],
)
def test_what_this_program_exports(
    format: str, file: str | None, close: float, elastic: Path, tmp_path: Path
) -> None:
    signal = vi.load_result(elastic).signals["a1"]
    vi.exporting.export_result(elastic, format, tmp_path / "out")
    if file is None:
        with pytest.raises(vi.InputError, match="no file of records in this folder"):
            list(vi.signals.load_records(tmp_path / "out"))
        return
    found = [
        one
        for one in vi.signals.load_records(next((tmp_path / "out").glob(file)))
        if one.unit == "m/s" and "sphere" not in one.name
    ]
    assert len(found) == 1
    assert found[0].rate == pytest.approx(signal.sensor.rate)
    np.testing.assert_allclose(found[0].value, signal.value, atol=close * signal.largest)


def test_a_result_folder(elastic: Path) -> None:
    (record,) = vi.signals.load_records(elastic)
    assert (record.name, record.unit, record.rate, record.start) == ("a1", "m/s", 20e3, 0.0)
    assert record.source.endswith("result.nc")
    np.testing.assert_array_equal(record.value, vi.load_result(elastic).signals["a1"].value)
    (table,) = vi.signals.load_records(elastic / "sensors" / "a1.csv")
    np.testing.assert_allclose(table.value, record.value, rtol=1e-12)


def dataset(path: Path, units: str = "V", unequal: bool = False) -> np.ndarray:
    """Write signals as a data set has them, and return them."""
    signals = np.random.default_rng(1).standard_normal((7, 50)).astype("f4")
    with h5py.File(path, "w") as file:
        file["signal"] = np.arange(7)
        file["time_geophone"] = (np.arange(50) ** (1.2 if unequal else 1.0)) / 10e3
        file["time_geophone"].attrs["units"] = "s"
        file["signal_geophone"], file["sphere.radius"] = signals, np.ones(7)
        for name in ("signal", "time_geophone"):
            file[name].make_scale(name)
        for place, name in enumerate(("signal", "time_geophone")):
            file["signal_geophone"].dims[place].attach_scale(file[name])
        file["sphere.radius"].dims[0].attach_scale(file["signal"])
        file["signal_geophone"].attrs["units"] = units
    return signals


def test_a_data_set(tmp_path: Path) -> None:
    signals = dataset(tmp_path / "dataset.nc", "mV")
    found = list(vi.signals.load_records(tmp_path))
    assert {(one.name, one.unit, one.rate) for one in found} == {("geophone", "V", 10e3)}
    np.testing.assert_allclose([one.value for one in found], 1e-3 * signals, rtol=1e-6)


def test_signals_that_are_filled_at_their_ends(tmp_path: Path) -> None:
    signals = dataset(tmp_path / "study.nc")
    with h5py.File(tmp_path / "study.nc", "r+") as file:
        (
            file["signal_geophone"][1, 30:],
            file["signal_geophone"][2],
            file["signal_geophone"][3, 10],
        ) = np.nan, np.nan, np.nan
    whole, cut, none, spoilt, *_ = vi.signals.load_records(tmp_path)
    assert [len(one.value) for one in (whole, cut, none, spoilt)] == [50, 30, 0, 50]
    np.testing.assert_array_equal(cut.value, signals[1, :30])


def test_a_channel_that_is_filled_at_its_end(tmp_path: Path) -> None:
    """Channels of different lengths share one time."""
    with h5py.File(tmp_path / "channels.nc", "w") as file:
        time = file.create_dataset("time", data=np.arange(50) / 1e3)
        time.attrs["units"] = "s"
        time.make_scale("time")
        for name, length in (("long", 50), ("short", 30)):
            data = file.create_dataset(name, data=np.where(np.arange(50) < length, SIGNAL, np.nan))
            data.dims[0].attach_scale(time)
    assert {
        one.name: len(one.value) for one in vi.signals.load_records(tmp_path / "channels.nc")
    } == {
        "long": 50,
        "short": 30,
    }


def test_netcdf_by_xarray(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    time = ("time", 0.5 + np.arange(50) / 1e3, {"units": "s"})
    data = xarray.Dataset(
        {"acc": (("sensor", "time"), np.stack([SIGNAL, -SIGNAL]), {"units": "m s-2"})},
        {"time": time},
    )
    # whatever a cluster of another test has left set
    with pytest.importorskip("dask").config.set(scheduler="synchronous"):
        data.to_netcdf(tmp_path / "x.nc", engine="h5netcdf")
    one, other = vi.signals.load_records(tmp_path / "x.nc")
    assert (one.name, one.unit, one.rate, one.start) == ("acc", "m/s2", 1e3, 0.5)
    np.testing.assert_array_equal(other.value, -SIGNAL)


def test_netcdf_packed_by_a_filter_that_is_not_installed_is_not_called_damaged(
    tmp_path: Path,
) -> None:
    blosc, optional, path = 32001, h5py.h5z.FLAG_OPTIONAL, tmp_path / "packed.nc"
    with h5py.File(path, "w") as file:
        time = file.create_dataset("time", data=np.arange(100) / 1e3)
        time.attrs["units"] = "s"
        time.make_scale("time")
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        properties.set_chunk((100,))
        properties.set_filter(blosc, optional, (3,))
        space = h5py.h5s.create_simple((100,))
        data = h5py.Dataset(
            h5py.h5d.create(file.id, b"acceleration", h5py.h5t.IEEE_F64LE, space, properties)
        )
        data.id.write_direct_chunk((0,), b"packed", 0)
        data.dims[0].attach_scale(time)
    with pytest.raises(
        vi.InputError, match=r"packed\.nc: acceleration is packed by a filter that HDF5 lacks here"
    ):
        list(vi.signals.load_records(path))


def test_wrong_netcdf(tmp_path: Path) -> None:
    dataset(tmp_path / "unequal.nc", unequal=True)
    dataset(tmp_path / "unit.nc", "banana")
    (tmp_path / "classic.nc").write_bytes(b"CDF\x01" + bytes(100))
    (tmp_path / "damaged.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    messages = {
        "unequal": "no variable whose last dimension is a time",
        "unit": "variable geophone.*no unit of a signal",
        "classic": "nccopy",
        "damaged": "can't be read",
    }
    for name, message in messages.items():
        with pytest.raises(vi.InputError, match=message) as error:
            list(vi.signals.load_records(tmp_path / f"{name}.nc"))
        assert f"{name}.nc" in str(error.value)


def test_a_universal_file_without_units(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    path = str(tmp_path / "x.uff")
    numbers = {
        "binary": 0,
        "func_type": 1,
        "rsp_node": 1,
        "rsp_dir": 3,
        "ref_node": 1,
        "ref_dir": 3,
        "ver_num": 0,
        "load_case_id": 0,
    }
    axis = {
        "abscissa_spec_data_type": 17,
        "abscissa_inc": 1e-3,
        "abscissa_min": 0.0,
        "abscissa_spacing": 1,
        "orddenom_spec_data_type": 0,
    }
    # data type 0 is general, such as the voltage of a channel that was not calibrated
    channel = pyuff.prepare_58(
        **numbers,
        **axis,
        id1="channel 1",
        x=np.arange(50) / 1e3,
        data=SIGNAL,
        ordinate_spec_data_type=0,
    )
    pyuff.UFF(path).write_sets(channel, "overwrite")
    (record,) = vi.signals.load_records(path)
    assert (record.name, record.unit, record.rate) == ("channel 1", "1", 1000.0)
    np.testing.assert_allclose(record.value, SIGNAL, rtol=1e-5)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("nothing.csv", "there is no such file"),
        ("photo.png", "records are read from files ending in"),
        ("", "no file of records"),
    ],
)
def test_what_is_no_record_is_said(name: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "photo.png").write_bytes(b"\x89PNG")
    with pytest.raises(vi.InputError, match=message):
        list(vi.signals.load_records(tmp_path / name))


def test_a_file_in_memory_is_read_as_one_on_the_disk(tmp_path: Path) -> None:
    table = "time [ms];force [kN]\n" + "".join(f"{place};{place % 3}\n" for place in range(9))
    sound = tmp_path / "tap.wav"
    wavfile.write(sound, 8000, (1000.0 * SIGNAL).astype(np.int16))
    (tmp_path / "hammer.csv").write_text(table, encoding="utf-16")
    for path in (sound, tmp_path / "hammer.csv"):
        (record,) = records_in(path.name, path.read_bytes())
        expected = only(path)
        assert (record.name, record.unit, record.rate) == (
            expected.name,
            expected.unit,
            expected.rate,
        )
        np.testing.assert_array_equal(record.value, expected.value)
        assert record.source == path.name


def test_a_file_in_memory_is_bounded_as_one_on_the_disk() -> None:
    kind = FileKind("a table is text", 5, "keep a part")
    with received("a.csv", b"123456"), pytest.raises(vi.InputError, match="larger than 5e-06 MB"):
        read_bytes("a.csv", kind)
