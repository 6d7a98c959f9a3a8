"""What is exported as data, read back by other programs; the folders that it comes from,
and the command.
"""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import meshio
import numpy as np
import pandas
import pytest
from scipy.io import loadmat, wavfile

import vibroimpact as vi
from support import THIN_PLATE, outcome, plain_case
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.motion.columns import HISTORY_COLUMNS, IMPACT_COLUMNS, meanings
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import find_export_format
from vibroimpact.exporting.export_result import default_output
from vibroimpact.exporting.formats.matlab import legal_names
from vibroimpact.exporting.formats.uff58 import history_rate
from vibroimpact.exporting.load_drop import drop_of_result, load_drop
from vibroimpact.exporting.resample import motion_at
from vibroimpact.results.result import result_of
from written_results import write_result

ELASTIC = {
    "name": "elastic",
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": THIN_PLATE,
    "drop": {"speed": 3.0, "position": ["20 mm", "10 mm"]},
    "contact": {"law": "hunt-crossley", "restitution": 0.8},
    "run": {"impacts": 1, "duration": 0.05},
    "sensors": [
        {"name": "fast one", "position": ["60 mm", "30 mm"], "rate": "50 kHz"},
        {
            "name": "slow/one",
            "position": [0, "-50 mm"],
            "quantity": "velocity",
            "rate": "20 kHz",
            "direction": [1, 0, 1],
        },
    ],
}


OBLIQUE = {
    "name": "oblique",
    "sphere": {
        "radius": "10 mm",
        "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.2},
    },
    "plate": {
        "size": ["2 m", "1 m", "20 mm"],
        "material": {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3},
        "inclination": "10 deg",
    },
    "drop": {
        "height": "30 mm",
        "velocity": [0.5, -0.2, 0.4],
        "spin": [10, -30, 50],
        "position": ["-300 mm", 0],
    },
    "contact": {
        "law": "hunt-crossley",
        "restitution": 0.6,
        "friction": {"law": "mdr", "coefficient": 0.2},
    },
    "run": {"impacts": 2},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A result folder of an elastic plate with sensors."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(tmp_path_factory.mktemp("store")))
        path = tmp_path_factory.mktemp("results") / "elastic"
        path.mkdir()
        write_result(result_of(vi.simulate(vi.case_of(ELASTIC))), path)
        yield path


@pytest.fixture(scope="module")
def elastic(folder: Path) -> Drop:
    return load_drop(folder)


@pytest.fixture(scope="module")
def rigid(variable: vi.Response) -> Drop:
    return drop_of_result(result_of(variable), vi.load_case("paper:type1-variable"))


@pytest.fixture(scope="module")
def oblique_response() -> vi.Response:
    return vi.simulate(vi.case_of(OBLIQUE))


@pytest.fixture(scope="module")
def oblique(oblique_response: vi.Response) -> Drop:
    return drop_of_result(result_of(oblique_response), vi.case_of(OBLIQUE))


@pytest.fixture
def result_folder(variable: vi.Response, tmp_path: Path) -> Path:
    path = tmp_path / "drop"
    path.mkdir()
    write_result(result_of(variable), path)
    return path


def files_of(format: str, drop: Drop) -> Mapping[str, bytes]:
    return find_export_format(format).write(drop)


def notes_of(format: str, drop: Drop) -> str:
    return " ".join(find_export_format(format).notes(drop))


# the drop of a folder
# --------------------------------------------------------------------------------


def test_a_result_folder_is_a_drop(elastic: Drop, folder: Path) -> None:
    result, case = vi.load_result(folder), vi.case_of(ELASTIC)
    assert (elastic.name, elastic.radius, elastic.height, elastic.speed) == (
        "elastic",
        0.025,
        0.025,
        3.0,
    )
    assert elastic.mass == pytest.approx(
        4.0 / 3.0 * np.pi * 0.025**3 * case.sphere.material.density
    )
    assert (elastic.elastic, elastic.plate_size, elastic.position) == (
        ("plate",),
        (0.3, 0.2, 0.006),
        (0.02, 0.01),
    )
    assert elastic.laws[0].name == "hunt-crossley"
    assert elastic.end_time == result.history["time_s"][-1]
    assert set(elastic.signals) == {"fast one", "slow/one"}
    assert result.deflection is not None
    np.testing.assert_array_equal(elastic.surface["height"], result.deflection.height)
    np.testing.assert_array_equal(elastic.impacts["max_force_N"], result.impacts["max_force_N"])


def test_each_impact_has_its_law(rigid: Drop) -> None:
    assert [law.damping_max for law in rigid.laws] == [179.75, 172.8, 166.3, 160.9, 156.5]
    assert (rigid.height, rigid.speed, rigid.gravity, rigid.function, rigid.elastic) == (
        4.0,
        0.0,
        9.8,
        None,
        (),
    )
    assert not rigid.surface


@pytest.mark.parametrize("coefficients", [[138.9, 6.0], [138.9]])
def test_a_calibration_folder_is_a_drop(coefficients: list[float], tmp_path: Path) -> None:
    """One number is no function: the case has it."""
    import tomli_w

    fit = {"degree": 1, "coefficients": coefficients, "from_speed_m_s": 3.2, "to_speed_m_s": 8.8}
    (tmp_path / "calibration.json").write_text(json.dumps({"parameter": "restitution", "fit": fit}))
    (tmp_path / "case.toml").write_text(tomli_w.dumps(plain_case()))
    (tmp_path / "summary.json").write_text(json.dumps({"calibration": {}}))
    drop = load_drop(tmp_path)
    assert drop.function == (
        ("restitution", SpeedFunction((138.9, 6.0), 3.2, 8.8)) if len(coefficients) > 1 else None
    )
    assert len(drop.impacts["impact"]) == 3
    assert len(drop.history["time_s"]) > 100


@pytest.mark.parametrize(
    "text", ["{", "{}", '{"fit": {"degree": 1}}', '{"fit": {"coefficients": ["a"]}}', "[]"]
)
def test_a_damaged_calibration_is_named(text: str, tmp_path: Path) -> None:
    (tmp_path / "calibration.json").write_text(text)
    with pytest.raises(
        vi.InputError, match=r"calibration\.json: the file (is (missing or )?damaged|can't be used)"
    ):
        load_drop(tmp_path)


def test_other_folders_are_refused(variable: vi.Response, tmp_path: Path) -> None:
    with pytest.raises(vi.InputError, match="this is not a result folder"):
        load_drop(tmp_path)
    others = {
        "laws": "a comparison of contact laws",
        "modes": "modes of elastic bodies",
        "majority_error": "a bound on the error",
    }
    others |= {
        "estimates": "an identified impact",
        "octaves_Hz": "a comparison of a test",
        "responses": "modes of measured frequency",
    }
    for key, words in others.items():
        (tmp_path / "summary.json").write_text(json.dumps({key: {}}))
        with pytest.raises(vi.InputError, match=words):
            load_drop(tmp_path)
    made = tmp_path / "made"
    made.mkdir()
    write_result(result_of(vi.simulate(replace(variable.problem, source=None))), made)
    with pytest.raises(vi.InputError, match="its problem was defined in Python"):
        load_drop(made)


# tables
# ----------------------------------------------------------------------------------------------


def test_csv_is_what_the_result_folder_holds_and_the_history(elastic: Drop, folder: Path) -> None:
    files = files_of("csv", elastic)
    assert set(files) == {
        "impacts.csv",
        "history.csv",
        "sensors/fast_one.csv",
        "sensors/slow_one.csv",
    }
    for name in ("impacts.csv", "sensors/fast_one.csv", "sensors/slow_one.csv"):
        assert files[name] == (folder / name).read_bytes()
    read = pandas.read_csv(BytesIO(files["history.csv"]), dtype=str).astype(float)
    assert list(read.columns) == list(elastic.history)
    for name, values in elastic.history.items():
        np.testing.assert_array_equal(read[name], values)


def test_parquet_has_values_and_units(elastic: Drop) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    files = files_of("parquet", elastic)
    history = pandas.read_parquet(BytesIO(files["history.parquet"]))
    for name, values in elastic.history.items():
        np.testing.assert_array_equal(history[name], values)
    impacts = pandas.read_parquet(BytesIO(files["impacts.parquet"]))
    for name in IMPACT_COLUMNS:
        np.testing.assert_array_equal(impacts[name].to_numpy(dtype=float), elastic.impacts[name])
    assert impacts["impact"].dtype == np.int64
    schema = parquet.read_schema(BytesIO(files["history.parquet"]))
    for name, (unit, meaning) in meanings(HISTORY_COLUMNS).items():
        assert schema.field(name).metadata == {
            b"unit": unit.encode(),
            b"long_name": meaning.encode(),
        }
    signal = parquet.read_table(BytesIO(files["sensors/slow_one.parquet"]))
    assert signal.schema.field("velocity_m_s").metadata[b"unit"] == b"m/s"
    np.testing.assert_array_equal(
        signal["velocity_m_s"].to_numpy(), elastic.signals["slow/one"].value
    )


def test_what_is_no_number_is_no_value(rigid: Drop) -> None:
    pytest.importorskip("pyarrow")
    impacts = {**rigid.impacts, "restitution_asked": np.full(5, np.nan)}
    drop = replace(rigid, impacts=impacts)
    assert (
        pandas.read_csv(BytesIO(files_of("csv", drop)["impacts.csv"]))["restitution_asked"]
        .isna()
        .all()
    )
    assert b"nan" not in files_of("csv", drop)["impacts.csv"]
    assert (
        pandas.read_parquet(BytesIO(files_of("parquet", drop)["impacts.parquet"]))[
            "restitution_asked"
        ]
        .isna()
        .all()
    )


@pytest.mark.parametrize(
    ("format", "package", "extra"), [("parquet", "pyarrow", "parquet"), ("uff58", "pyuff", "uff")]
)
def test_a_missing_package_is_named(
    format: str, package: str, extra: str, rigid: Drop, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        vi.InputError,
        match=rf'{package}, which is not installed: pip install "vibroimpact\[{extra}\]"',
    ):
        files_of(format, rigid)


def test_matlab_reads_structs_with_units(elastic: Drop) -> None:
    (content,) = files_of("mat", elastic).values()
    read: dict[str, Any] = loadmat(BytesIO(content), simplify_cells=True)
    for name, values in elastic.history.items():
        np.testing.assert_array_equal(read["history"][name], values)
        assert read["units"]["history"][name]
    assert read["units"]["history"]["force_N"] == "N"
    assert read["impacts"]["max_force_N"] == elastic.impacts["max_force_N"][0]
    signal = read["signals"]["fast_one"]
    np.testing.assert_array_equal(signal["value"], elastic.signals["fast one"].value)
    assert (signal["unit"], signal["rate_Hz"], signal["name"]) == ("m/s2", 50e3, "fast one")
    np.testing.assert_array_equal(read["surface"]["height"], elastic.surface["height"])
    assert (read["drop"]["radius"], read["drop"]["elastic"], read["drop"]["contact_law"]) == (
        0.025,
        "plate",
        "hunt-crossley",
    )
    assert read["drop"]["law"]["stiffness"] == elastic.laws[0].stiffness
    assert read["units"]["drop"]["law"]["stiffness"] == "N/m^1.5"
    assert content.startswith(b"MATLAB 5.0 MAT-file, written by vibroimpact")
    # columns
    assert loadmat(BytesIO(content))["history"]["time_s"][0, 0].shape == (
        len(elastic.history["time_s"]),
        1,
    )


def test_matlab_has_every_law_and_the_function(rigid: Drop) -> None:
    drop = replace(rigid, function=("damping_max", SpeedFunction((138.9, 6.0, -0.15), 3.2, 8.8)))
    (content,) = files_of("mat", drop).values()
    read = loadmat(BytesIO(content), simplify_cells=True)["drop"]
    assert read["law"]["damping_max"].tolist() == [179.75, 172.8, 166.3, 160.9, 156.5]
    assert read["function"]["parameter"] == "damping_max"
    assert read["function"]["coefficients_lowest_power_first"].tolist() == [138.9, 6.0, -0.15]


def test_names_are_legal_in_matlab() -> None:
    names = ["end", "End", "1st", "a-b", "a_b", "s_1st", "x" * 70, "x" * 71, "_", "§"]
    legal = legal_names(names)
    assert len(set(legal.values())) == len(names)
    for name in legal.values():
        assert name.isascii()
        assert name.isidentifier()
        assert name[0] != "_"
        assert len(name) <= 63
        assert name != "end"


def test_an_oblique_drop_has_its_motion_along_the_plate(oblique: Drop) -> None:
    assert oblique.oblique is not None
    assert (oblique.height, oblique.speed, oblique.position) == (0.03, -0.4, (-0.3, 0.0))
    assert oblique.gravity == pytest.approx(9.80665 * np.cos(np.radians(10.0)), rel=1e-15)
    assert oblique.oblique.gravity[0] == pytest.approx(
        9.80665 * np.sin(np.radians(10.0)), rel=1e-15
    )
    files = files_of("csv", oblique)
    for table, values in (("impacts", oblique.impacts), ("history", oblique.history)):
        read = pandas.read_csv(BytesIO(files[f"{table}.csv"]), dtype=str).astype(float)
        assert list(read.columns) == list(values)
        for name in values:
            np.testing.assert_array_equal(read[name], values[name])
    assert {"tangential_restitution", "spin_y_after_rad_s"} < set(oblique.impacts)
    (content,) = files_of("mat", oblique).values()
    read = loadmat(BytesIO(content), simplify_cells=True)
    assert read["drop"]["velocity_along_plate"].tolist() == [0.5, -0.2]
    assert read["drop"]["spin"].tolist() == [10.0, -30.0, 50.0]
    assert (read["drop"]["friction_law"], read["drop"]["friction"]["coefficient"]) == ("mdr", 0.2)
    assert read["units"]["drop"]["friction"]["effective_shear_modulus"] == "Pa"
    assert read["units"]["history"]["friction_x_N"] == "N"
    np.testing.assert_array_equal(read["history"]["spin_y_rad_s"], oblique.history["spin_y_rad_s"])


def test_a_rising_sphere_rises_in_what_is_exported() -> None:
    case = vi.case_of(plain_case(drop={"height": 0.5, "velocity": [0, 0, 1.5]}))
    drop = drop_of_result(result_of(vi.simulate(case)), case)
    assert (drop.height, drop.speed, drop.oblique) == (0.5, -1.5, None)


# functions of time
# -----------------------------------------------------------------------------------


def datasets(content: bytes) -> list[tuple[list[str], np.ndarray]]:
    """Read the binary datasets 58 of a universal file: their eleven lines, and the values."""
    found, at = [], 0
    while (at := content.find(b"    -1\n    58b", at)) >= 0:
        lines = []
        start = at = at + len("    -1\n")
        for _ in range(12):
            end = content.index(b"\n", at)
            lines.append(content[at:end].decode())
            at = end + 1
        size = int(content[start + 31 : start + 43])
        found.append((lines, np.frombuffer(content[at : at + size], dtype="<f8")))
        at += size
        assert content[at:].lstrip(b"\n").startswith(b"    -1\n")
    return found


def test_universal_file_holds_signals_and_motion(elastic: Drop, tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    (content,) = files_of("uff58", elastic).values()
    (tmp_path / "drop.uff").write_bytes(content)
    header, units, *functions = pyuff.UFF(str(tmp_path / "drop.uff")).read_sets()
    assert (header["type"], header["model_name"]) == (151, "elastic")
    assert (units["type"], units["units_code"], units["length"], units["force"]) == (
        164,
        1,
        1.0,
        1.0,
    )
    assert [one["ordinate_spec_data_type"] for one in functions] == [12, 11, 8, 11, 12, 13]
    assert [one["rsp_node"] for one in functions] == [2, 3, 1, 1, 1, 1]
    assert [one["rsp_dir"] for one in functions] == [3, 0, 3, 3, 3, 3]
    assert {one["abscissa_spacing"] for one in functions} == {1}
    assert {one["func_type"] for one in functions} == {1}
    for one, name in zip(functions, ("fast one", "slow/one"), strict=False):
        signal = elastic.signals[name]
        np.testing.assert_array_equal(one["data"], signal.value)
        np.testing.assert_allclose(one["x"], signal.time, rtol=1e-12)
        assert one["ordinate_axis_units_lab"] == signal.sensor.unit
    own = datasets(content)
    for one, (lines, values) in zip(functions, own, strict=True):
        np.testing.assert_array_equal(values, one["data"])
        assert lines[1].strip() == one["id1"]
        assert int(lines[7][10:20]) == len(values)
        assert float(lines[7][43:56]) == one["abscissa_inc"]
    assert "The direction of slow/one lies along no axis" in notes_of("uff58", elastic)


def test_the_history_is_sampled_as_finely_as_the_contact_needs(elastic: Drop, rigid: Drop) -> None:
    pytest.importorskip("pyuff")
    for drop in (elastic, rigid):
        rate, shortest = history_rate(drop), float(drop.impacts["duration_s"].min())
        assert rate is not None
        assert 20.0 / shortest <= rate < 70.0 / shortest
        *_, (_, position), (_, velocity), _, (_, force) = datasets(
            next(iter(files_of("uff58", drop).values()))
        )
        assert force.max() == pytest.approx(drop.impacts["max_force_N"].max(), rel=0.005)
        time = np.arange(len(velocity)) / rate
        change = drop.mass * (velocity[-1] - velocity[0] + drop.gravity * time[-1])
        assert force.sum() / rate == pytest.approx(change, rel=1e-3)
        assert position[0] == drop.history["position_m"][0]
        assert len(time) == int(drop.end_time * rate + 1e-6) + 1
    rate = history_rate(elastic)
    assert rate is not None
    assert rate % 50e3 == 0.0  # on the times of the fastest sensor


def test_universal_file_of_an_oblique_drop(
    oblique: Drop, oblique_response: vi.Response, tmp_path: Path
) -> None:
    """In directions 1 and 2 along the plate, and 4 to 6 of rotation."""
    pyuff = pytest.importorskip("pyuff")
    (content,) = files_of("uff58", oblique).values()
    (tmp_path / "drop.uff").write_bytes(content)
    functions = pyuff.UFF(str(tmp_path / "drop.uff")).read_sets()[2:]
    found = {(one["rsp_dir"], one["ordinate_spec_data_type"]): one for one in functions}
    assert len(found) == len(functions) == 4 + 3 * 2 + 3
    exact = oblique_response.at(found[3, 8]["x"])
    for axis, name in enumerate("xyz", 1):
        spin = exact[f"spin_{name}_rad_s"]
        np.testing.assert_allclose(
            found[axis + 3, 11]["data"], spin, atol=1e-3 * np.abs(spin).max()
        )
        assert found[axis + 3, 11]["ordinate_axis_units_lab"] == "rad/s"
    for axis, name in enumerate("xy", 1):
        np.testing.assert_allclose(found[axis, 8]["data"], exact[f"position_{name}_m"], atol=1e-8)
        np.testing.assert_allclose(
            found[axis, 11]["data"], exact[f"velocity_{name}_m_s"], atol=1e-4
        )
        largest = np.abs(exact[f"friction_{name}_N"]).max()
        np.testing.assert_allclose(
            found[axis, 13]["data"], exact[f"friction_{name}_N"], atol=0.01 * largest
        )


def test_a_step_that_has_more_digits_than_the_format_is_told(rigid: Drop) -> None:
    assert "rounded" not in notes_of("uff58", rigid)
    signal = Signal(Sensor("a", rate=3000.0), np.zeros(9), 0)
    assert "The time step of 3000 Hz, " in notes_of("uff58", replace(rigid, signals={"a": signal}))


def test_a_history_that_can_not_be_sampled_is_left_out(rigid: Drop) -> None:
    case = vi.case_of(plain_case(contact={"law": "newton", "restitution": 0.7}))
    instant = drop_of_result(result_of(vi.simulate(case)), case)
    with pytest.raises(
        vi.InputError,
        match="has no sensor with two samples or more, and no contact in it has a duration",
    ):
        files_of("uff58", instant)
    assert "The history is left out: no contact" in notes_of("uff58", instant)
    assert history_rate(replace(rigid, end_time=1e3)) is None
    assert "more than 2000000 samples" in notes_of("uff58", replace(rigid, end_time=1e3))
    with pytest.raises(vi.InputError, match="it has no history"):
        files_of("uff58", replace(rigid, history={}))


def test_motion_between_the_points_of_a_history(rigid: Drop, variable: vi.Response) -> None:
    touch, duration = (float(variable.impacts[name][1]) for name in ("time_s", "duration_s"))
    times = np.concatenate(
        [np.linspace(0.0, rigid.end_time, 777), touch + duration * np.linspace(-0.5, 1.5, 301)]
    )
    exact, found = variable.at(times), motion_at(rigid.history, times)
    np.testing.assert_allclose(found["position_m"], exact["position_m"], atol=1e-9)
    np.testing.assert_allclose(found["velocity_m_s"], exact["velocity_m_s"], atol=2e-4)
    np.testing.assert_allclose(
        found["force_N"], exact["force_N"], atol=2e-3 * float(exact["force_N"].max())
    )
    end = motion_at(rigid.history, np.array([0.0, rigid.end_time]))
    for name, values in end.items():
        assert values.tolist() == rigid.history[name][[0, -1]].tolist()


# sound
# -----------------------------------------------------------------------------------------------


def comment_of(wave: bytes) -> str:
    """Return the comment of a WAV file by walking its chunks."""
    assert struct.unpack("<4sI4s", wave[:12]) == (b"RIFF", len(wave) - 8, b"WAVE")
    at = 12
    while at < len(wave):
        name, size = struct.unpack("<4sI", wave[at : at + 8])
        if name == b"LIST":
            assert wave[at + 8 : at + 16] == b"INFOICMT"
            (length,) = struct.unpack("<I", wave[at + 16 : at + 20])
            assert length == size - 12
            return wave[at + 20 : at + 20 + length].rstrip(b"\0").decode()
        at += 8 + size + size % 2
    raise AssertionError("no comment")


def test_a_signal_is_heard_to_scale(elastic: Drop) -> None:
    files = files_of("wav", elastic)
    assert set(files) == {"fast_one.wav", "slow_one.wav"}
    for name, signal in (
        ("fast_one", elastic.signals["fast one"]),
        ("slow_one", elastic.signals["slow/one"]),
    ):
        rate, samples = wavfile.read(BytesIO(files[f"{name}.wav"]))
        assert (rate, samples.dtype) == (signal.sensor.rate, np.float32)
        scale = np.abs(signal.value).max()
        assert np.abs(samples).max() == 1.0
        np.testing.assert_allclose(samples * scale, signal.value, atol=1e-7 * scale)
        words = comment_of(files[f"{name}.wav"])
        assert words.startswith(
            f"1.0 is {float(scale)!r} {signal.sensor.unit} ({signal.sensor.quantity}"
        )
        assert f"1.0 in {name}.wav is {scale:.9g} {signal.sensor.unit}" in notes_of("wav", elastic)


@pytest.mark.parametrize(
    ("rate", "words"), [(0.3, "must be 1 to"), (2e9, "must be 1 to"), (44100.4, None), (1e6, None)]
)
def test_rates_that_a_wav_file_can_hold(rate: float, words: str | None, rigid: Drop) -> None:
    signal = Signal(Sensor("a", rate=rate), np.zeros(5), 0)
    drop = replace(rigid, signals={"a": signal})
    if words:
        with pytest.raises(vi.InputError, match=words):
            files_of("wav", drop)
        return
    read, samples = wavfile.read(BytesIO(files_of("wav", drop)["a.wav"]))
    assert (read, samples.tolist()) == (round(rate), [0.0] * 5)
    assert ("the signal has 44100.4" in notes_of("wav", drop)) == (rate == 44100.4)
    assert ("Players may not play" in notes_of("wav", drop)) == (rate == 1e6)


# ParaView
# --------------------------------------------------------------------------------------------


def frames(
    files: Mapping[str, bytes], name: str, folder: Path
) -> tuple[list[float], list[meshio.Mesh]]:
    """Read a .pvd file and the meshes that it names."""
    for path, content in files.items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_bytes(content)
    sets = list(ElementTree.fromstring(files[f"{name}.pvd"]).iter("DataSet"))
    return [float(one.attrib["timestep"]) for one in sets], [
        meshio.read(folder / one.attrib["file"]) for one in sets
    ]


def area(points: np.ndarray, cells: np.ndarray) -> float:
    """Area of quadrilaterals from their diagonals."""
    one, other = (
        points[cells[:, 2]] - points[cells[:, 0]],
        points[cells[:, 3]] - points[cells[:, 1]],
    )
    return float(0.5 * np.linalg.norm(np.cross(one, other), axis=1).sum())


def test_frames_of_an_elastic_plate(elastic: Drop, tmp_path: Path) -> None:
    files = files_of("vtu", elastic)
    times, plates = frames(files, "plate", tmp_path)
    assert times == elastic.surface["time"].tolist()
    for plate, height in zip(plates, elastic.surface["height"], strict=True):
        np.testing.assert_allclose(
            plate.point_data["displacement_m"][:, 2], height.ravel(), rtol=1e-6, atol=1e-12
        )
        assert not plate.point_data["displacement_m"][:, :2].any()
    assert area(plates[0].points, plates[0].cells_dict["quad"]) == pytest.approx(
        0.3 * 0.2, rel=1e-6
    )
    times, spheres = frames(files, "sphere", tmp_path)
    for sphere, height in zip(spheres, elastic.surface["sphere_position"], strict=True):
        away = sphere.points - [0.02, 0.01, height]
        np.testing.assert_allclose(np.linalg.norm(away, axis=1), 0.025, rtol=1e-5)
    assert area(spheres[0].points, spheres[0].cells_dict["quad"]) == pytest.approx(
        4.0 * np.pi * 0.025**2, rel=0.01
    )


def test_frames_of_a_rigid_drop_show_each_touch(rigid: Drop, tmp_path: Path) -> None:
    files = files_of("vtu", rigid)
    times, spheres = frames(files, "sphere", tmp_path)
    assert len(times) == 200 + 3 * 5
    assert times == sorted(times)
    lowest = min(float(sphere.points[:, 2].min()) for sphere in spheres)
    assert lowest == pytest.approx(-rigid.impacts["max_indentation_m"].max(), rel=1e-3)
    plate = meshio.read(tmp_path / "plate.vtu")
    assert plate.cells_dict["hexahedron"].shape == (1, 8)
    np.testing.assert_allclose(np.ptp(plate.points, axis=0), [0.52, 0.42, 0.008], rtol=1e-6)
    assert plate.points[:, 2].max() == 0.0
    corners = plate.points[plate.cells_dict["hexahedron"][0]]
    assert np.linalg.det(corners[[1, 3, 4]] - corners[0]) > 0.0  # VTK's order of the corners


def test_frames_of_an_oblique_drop_move_along_the_plate(
    oblique: Drop, oblique_response: vi.Response, tmp_path: Path
) -> None:
    times, spheres = frames(files_of("vtu", oblique), "sphere", tmp_path)
    exact = oblique_response.at(times)
    for index, sphere in enumerate(spheres):
        centre = [exact[name][index] for name in ("position_x_m", "position_y_m", "position_m")]
        np.testing.assert_allclose(np.linalg.norm(sphere.points - centre, axis=1), 0.01, rtol=1e-4)
    assert exact["position_x_m"][-1] > -0.2
    assert "does not turn" in notes_of("vtu", oblique)


@pytest.fixture(scope="module", params=["rigid", "elastic"])
def shaken(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Drop, vi.Response]]:
    """A drop on a plate that is shaken along a slant, and its response."""
    motion = {
        "amplitude": "1 mm",
        "frequency": "30 Hz",
        "phase": "50 deg",
        "direction": [0.6, 0, 0.8],
    }
    elastic = request.param == "elastic"
    plate = {
        **(
            ELASTIC["plate"]
            if elastic
            else {"size": ["300 mm", "200 mm", "6 mm"], "material": "steel"}
        ),
        "motion": motion,
    }
    case = vi.case_of(
        {**ELASTIC, "plate": plate, "drop": {"height": "40 mm"}, "run": {"duration": 0.2}}
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(tmp_path_factory.mktemp("store")))
        response = vi.simulate(case)
        yield drop_of_result(result_of(response), case), response


def test_data_of_a_plate_that_is_shaken(shaken: tuple[Drop, vi.Response], tmp_path: Path) -> None:
    drop, response = shaken
    assert drop.motion is not None
    history = pandas.read_csv(BytesIO(files_of("csv", drop)["history.csv"]))
    place = response.problem.surface(history["time_s"].to_numpy())[0]
    np.testing.assert_allclose(history["surface_m"], place, atol=1e-12)
    assert {"plate_velocity_m_s", "plate_work_J"} < set(
        pandas.read_csv(BytesIO(files_of("csv", drop)["impacts.csv"])).columns
    )
    (content,) = files_of("mat", drop).values()
    read = loadmat(BytesIO(content), simplify_cells=True)
    assert (read["drop"]["motion_amplitude"], read["drop"]["motion_frequency"]) == (1e-3, 30.0)
    assert (
        read["units"]["drop"]["motion_frequency"],
        read["drop"]["motion_direction"].tolist(),
    ) == ("Hz", [0.6, 0.0, 0.8])
    path = tmp_path / "drop.uff"
    (content,) = files_of("uff58", drop).values()
    path.write_bytes(content)
    pyuff = pytest.importorskip("pyuff")
    sets = pyuff.UFF(str(path)).read_sets()
    heights = next(
        one
        for one in sets
        if one["type"] == 58 and one["rsp_node"] == 1 and one["ordinate_spec_data_type"] == 8
    )
    np.testing.assert_allclose(heights["data"], response.at(heights["x"])["position_m"], atol=2e-6)
    times, plates = frames(files_of("vtu", drop), "plate", tmp_path)
    moved = 1e-3 * np.sin(60.0 * np.pi * np.array(times) + np.radians(50.0))
    for at, frame in zip(moved, plates, strict=True):
        lifted = frame.points + frame.point_data["displacement_m"] if drop.surface else frame.points
        np.testing.assert_allclose(
            [lifted[:, 0].min(), lifted[:, 0].max()], 0.6 * at + np.array([-0.15, 0.15]), atol=1e-6
        )
        edge = lifted[np.isclose(frame.points[:, 0], frame.points[:, 0].max()), 2].max()
        assert edge == pytest.approx(0.8 * at, abs=1e-6)  # clamped: it moves with the supports


@pytest.mark.parametrize("program", ["adams", "adams-view", "exudyn", "lammps", "mujoco", "yade"])
def test_programs_get_no_plate_that_moves(shaken: tuple[Drop, vi.Response], program: str) -> None:
    with pytest.raises(vi.InputError, match=r"plate\.motion: programs get a plate at rest"):
        find_export_format(program).prepare(shaken[0])


def test_holes_and_plates_without_a_size(elastic: Drop, rigid: Drop, tmp_path: Path) -> None:
    height = elastic.surface["height"].copy()
    height[:, 0, 0] = np.nan
    _, plates = frames(
        files_of("vtu", replace(elastic, surface={**elastic.surface, "height": height})),
        "plate",
        tmp_path,
    )
    assert len(plates[0].points) == height[0].size - 1
    assert len(plates[0].cells_dict["quad"]) == (height.shape[1] - 1) * (height.shape[2] - 1) - 1
    sphere = replace(rigid, plate_size=None)
    assert not any(name.startswith("plate") for name in files_of("vtu", sphere))
    assert "the sphere is written alone" in notes_of("vtu", sphere)


# the files, and the command
# --------------------------------------------------------------------------


def test_an_export_lies_beside_and_replaces_nothing(result_folder: Path, tmp_path: Path) -> None:
    written = vi.exporting.export_result(result_folder, "csv")
    assert written == [tmp_path / "drop-csv" / name for name in ("impacts.csv", "history.csv")]
    (tmp_path / "drop-csv" / "mine.txt").write_text("mine")
    (tmp_path / "drop-csv" / "impacts.csv").write_text("changed")
    with pytest.raises(vi.InputError, match=r"impacts\.csv: the file is there already"):
        vi.exporting.export_result(result_folder, "csv")
    assert (tmp_path / "drop-csv" / "impacts.csv").read_text() == "changed"
    vi.exporting.export_result(result_folder, "csv", force=True)
    assert (tmp_path / "drop-csv" / "impacts.csv").read_bytes() == (
        result_folder / "impacts.csv"
    ).read_bytes()
    assert (tmp_path / "drop-csv" / "mine.txt").read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "drop-csv"]


def test_one_file_may_be_given_a_name(result_folder: Path, tmp_path: Path) -> None:
    assert vi.exporting.export_result(result_folder, "mat", tmp_path / "new" / "a.mat") == [
        tmp_path / "new" / "a.mat"
    ]
    assert loadmat(tmp_path / "new" / "a.mat")["impacts"].size
    with pytest.raises(vi.InputError, match=r"there are 2 files to write .* name a folder"):
        vi.exporting.export_result(result_folder, "csv", tmp_path / "a.csv")
    (one,) = vi.exporting.export_result(result_folder, "mat", tmp_path / "folder")
    assert one.parent == tmp_path / "folder"
    assert (
        vi.exporting.export_result(result_folder, "csv", tmp_path / "run.2")[0]
        == tmp_path / "run.2" / "impacts.csv"
    )
    assert (
        vi.exporting.export_result(result_folder, "mat", tmp_path / "run.2")[0].parent
        == tmp_path / "run.2"
    )


def test_nothing_is_half_written(
    result_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = Path.write_bytes

    def failing(path: Path, content: bytes) -> int:
        if path.name == "history.csv":
            raise OSError(28, "No space left on device")
        return whole(path, content)

    monkeypatch.setattr(Path, "write_bytes", failing)
    (tmp_path / "there").mkdir()
    for output in (None, tmp_path / "there"):
        with pytest.raises(
            vi.InputError, match="the files can't be written: No space left on device"
        ):
            vi.exporting.export_result(result_folder, "csv", output)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "there"]
    assert not list((tmp_path / "there").iterdir())


def test_places_that_can_not_be_written_to(result_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("a file")
    with pytest.raises(vi.InputError, match="can't be written"):
        vi.exporting.export_result(result_folder, "csv", tmp_path / "file")
    (tmp_path / "folder" / "impacts.csv").mkdir(parents=True)
    with pytest.raises(vi.InputError, match="this is a folder"):
        vi.exporting.export_result(result_folder, "csv", tmp_path / "folder", force=True)


def test_a_name_of_dots_goes_beside_the_folder_itself(
    result_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(result_folder)
    assert default_output(".", "csv") == tmp_path / "drop-csv"
    assert default_output("../drop", "csv") == Path("../drop-csv")


def test_the_command(
    result_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(result_folder.parent)
    status, printed = outcome(monkeypatch, capsys, "export", "drop", "--to", "csv")
    assert status == 0
    assert "wrote drop-csv/impacts.csv wrote drop-csv/history.csv" in printed
    assert find_export_format("csv").tested in printed
    assert "Note: The tables contain the results of the drop" in printed
    for arguments in ((), ("--formats",), ("drop",)):
        status, printed = outcome(monkeypatch, capsys, "export", *arguments)
        assert status == 0
        assert all(name in printed for name in vi.exporting.export_formats())
    _, printed = outcome(monkeypatch, capsys, "export", "drop", "--to", "vtu")
    assert "and 212 more files in drop-vtu" in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("drop", "--to", "cvs"), 'there is no export format "cvs"'),
        (("--to", "csv"), "name the folder that is to be exported"),
        (("nothing", "--to", "csv"), "this is not a result folder"),
        (("drop", "--to", "wav"), "has no sensors"),
        (("drop", "-o", "there"), "name the format"),
    ],
)
def test_wrong_arguments(
    arguments: tuple[str, ...],
    message: str,
    result_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(result_folder.parent)
    status, printed = outcome(monkeypatch, capsys, "export", *arguments)
    assert status == 2
    assert message in printed
    assert [path.name for path in result_folder.parent.iterdir()] == ["drop"]
