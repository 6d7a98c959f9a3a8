"""The result folder: whole or not at all, and read back by others."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
import sys
import tracemalloc
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import tomli_w
import xarray

import vibroimpact as vi
from pages import Page
from vibroimpact.cli import main
from vibroimpact.dynamics.motion.columns import HISTORY_COLUMNS, IMPACT_COLUMNS, LEDGER, meanings
from vibroimpact.files.hdf5 import new_array, new_hdf5, read_array
from vibroimpact.files.result_folder import new_folder
from vibroimpact.results.netcdf import read_groups

HEADER = (
    "impact,time_s,duration_s,approach_speed_m_s,separation_speed_m_s,restitution_achieved,max_indentation_m,max_force_N,"
    "max_acceleration_m_s2,rebound_height_m,energy_lost_J"
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, theory: vi.Response) -> Path:
    path = tmp_path_factory.mktemp("results") / "deep" / "theory"
    theory.save(path)
    return path


def test_holds_what_it_should(folder: Path) -> None:
    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    assert names == {"case.toml", "impacts.csv", "summary.json", "result.nc", "report.html"}
    # nothing beside it is left over
    assert [path.name for path in folder.parent.iterdir()] == ["theory"]


def test_impacts_csv_has_the_promised_header_and_every_digit(
    folder: Path, theory: vi.Response
) -> None:
    text = (folder / "impacts.csv").read_text()
    assert text.startswith(HEADER + ",")
    rows = list(csv.DictReader(text.splitlines()))
    assert [row["impact"] for row in rows] == ["1", "2", "3", "4", "5"]
    for name in IMPACT_COLUMNS:
        assert [float(row[name]) for row in rows] == theory.impacts[name].tolist()


def test_summary_has_rows_ledger_status_and_version(folder: Path, theory: vi.Response) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["status"] == theory.status
    assert summary["version"] == vi.__version__
    assert list(summary["impacts"][0]) == list(IMPACT_COLUMNS)
    assert summary["impacts"][4]["max_force_N"] == theory.impacts["max_force_N"][4]
    assert set(summary["energy"]) == {"input_J", *LEDGER, "closure_J", "closure_relative"}


def test_values_that_do_not_exist_are_null_and_empty(tmp_path: Path) -> None:
    case = {
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"material": "rigid"},
        "drop": {"speed": 1, "gravity": 0},
        "contact": {"law": "newton", "restitution": 0.5},
    }
    vi.simulate(vi.case_of(case)).save(tmp_path / "out")
    row = json.loads((tmp_path / "out" / "summary.json").read_text())["impacts"][0]
    assert row["max_force_N"] is None
    assert row["rebound_height_m"] is None
    assert ",," in (tmp_path / "out" / "impacts.csv").read_text().splitlines()[1]
    assert not re.search(
        r"\bnan\b", Page((tmp_path / "out" / "report.html").read_text()).text.lower()
    )


def test_netcdf_opens_in_xarray_with_units(folder: Path, theory: vi.Response) -> None:
    for group, columns in (("impacts", IMPACT_COLUMNS), ("history", HISTORY_COLUMNS)):
        with xarray.open_dataset(folder / "result.nc", group=group, engine="h5netcdf") as data:
            assert set(data.variables) == set(columns)
            for name, (unit, meaning) in meanings(columns).items():
                assert data[name].attrs["units"] == unit
                assert data[name].attrs["long_name"] == meaning
            assert (
                data.sizes == {"impact": 5}
                if group == "impacts"
                else {"time_s": len(theory.history()["time_s"])}
            )
    with h5py.File(folder / "result.nc") as file:
        assert file["energy"]["input_J"].attrs["units"] == "J"
        assert file.attrs["status"] == theory.status


def test_case_reads_back_as_the_same_run(folder: Path, theory: vi.Response) -> None:
    again = vi.simulate(vi.load_case(folder / "case.toml"))
    for name in IMPACT_COLUMNS:
        np.testing.assert_array_equal(again.impacts[name], theory.impacts[name])


def test_a_problem_made_in_python_keeps_its_inputs(tmp_path: Path) -> None:
    law = vi.laws.find_contact_law("newton")(restitution=0.5)
    ball = vi.Body(mass=1.25, contact_offset=0.1)
    vi.simulate(vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0)).save(
        tmp_path / "out"
    )
    assert not (tmp_path / "out" / "case.toml").exists()
    assert "mass=1.25" in vi.load_result(tmp_path / "out").provenance["problem"]
    assert "mass=1.25" in (tmp_path / "out" / "report.html").read_text()


def test_doubts_are_printed_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    case = {
        "sphere": {"radius": "5 mm", "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": "50 m"},
    }
    case["contact"] = {
        "law": "adams-impact",
        "damping_max": 10.0,
        "full_damping_penetration": "0.9 mm",
    }
    (tmp_path / "hard.toml").write_text(tomli_w.dumps(case))
    monkeypatch.setattr(
        "sys.argv", ["vibroimpact", "run", str(tmp_path / "hard.toml"), "-o", str(tmp_path / "out")]
    )
    with pytest.raises(SystemExit) as left:
        main()
    assert not left.value.code
    printed = capsys.readouterr().out
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    told = (
        "air",
        "full-damping",
        "half space",
        "the plate (steel) yields, and so does the sphere (steel)",
    )
    assert len(summary["doubts"]) == len(told)
    assert all(sum(words in doubt for doubt in summary["doubts"]) == 1 for words in told)
    page = (tmp_path / "out" / "report.html").read_text()
    assert printed.count("Warning: ") == page.count("<strong>Warning:</strong>") == 4


def test_result_reads_back(folder: Path, theory: vi.Response) -> None:
    result = vi.load_result(folder)
    np.testing.assert_array_equal(result.impacts["max_force_N"], theory.impacts["max_force_N"])
    np.testing.assert_array_equal(result.history["force_N"], theory.history()["force_N"])
    assert result.energy["input_J"] == theory.energy["input_J"]
    assert result.status == theory.status


def test_a_folder_from_before_there_was_a_column_is_read(
    folder: Path, theory: vi.Response, monkeypatch: pytest.MonkeyPatch
) -> None:
    def without(name: str) -> None:
        def read(path: Path) -> dict:
            groups = read_groups(path)
            return {
                **groups,
                "impacts": {
                    key: values for key, values in groups["impacts"].items() if key != name
                },
            }

        monkeypatch.setattr("vibroimpact.results.folder.read_groups", read)

    without("time_of_max_force_s")
    found = vi.load_result(folder).impacts
    assert np.isnan(found["time_of_max_force_s"]).all()
    np.testing.assert_array_equal(found["max_force_N"], theory.impacts["max_force_N"])
    without("max_force_N")
    with pytest.raises(
        vi.InputError, match=r"result.nc: the file is missing or damaged: no max_force_N"
    ):
        vi.load_result(folder)


def test_report_is_remade_and_other_files_stay(tmp_path: Path, theory: vi.Response) -> None:
    theory.save(tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_bytes()
    (tmp_path / "out" / "my notes.txt").write_text("mine")
    (tmp_path / "out" / "report.html").unlink()
    vi.remake_report(tmp_path / "out")
    assert (tmp_path / "out" / "report.html").read_bytes() == page
    assert (tmp_path / "out" / "my notes.txt").read_text() == "mine"
    assert not list((tmp_path / "out").glob(".*"))


def test_existing_folder_is_kept(tmp_path: Path, theory: vi.Response) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("years")
    for force, words in (
        (False, "is there and is not a result folder"),
        (True, "is not a result folder"),
    ):
        with pytest.raises(vi.InputError, match=words):
            theory.save(tmp_path / "out", force=force)
    assert (tmp_path / "out" / "thesis.tex").read_text() == "years"
    (tmp_path / "file").write_text("x")
    with pytest.raises(vi.InputError, match="not a folder"):
        theory.save(tmp_path / "file", force=True)
    with pytest.raises(vi.InputError, match="can't be made"):
        theory.save(tmp_path / "file" / "below")


def test_force_replaces_a_result(
    tmp_path: Path, folder: Path, theory: vi.Response, variable: vi.Response
) -> None:
    shutil.copytree(folder, tmp_path / "out")
    with pytest.raises(vi.InputError, match="--force"):
        variable.save(tmp_path / "out")
    assert vi.load_result(tmp_path / "out").status == theory.status
    variable.save(tmp_path / "out", force=True)
    assert vi.load_result(tmp_path / "out").status == variable.status
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_failure_leaves_nothing_and_loses_nothing(
    tmp_path: Path, folder: Path, theory: vi.Response, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(folder, tmp_path / "out")
    before = (tmp_path / "out" / "summary.json").read_bytes()

    def breaks(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr("vibroimpact.report.save_report.write_page", breaks)
    for name in ("new", "out"):
        with pytest.raises(OSError, match="no space"):
            theory.save(tmp_path / name, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert (tmp_path / "out" / "summary.json").read_bytes() == before


def test_an_interrupt_leaves_nothing(tmp_path: Path) -> None:
    def interrupted() -> None:
        with new_folder(tmp_path / "out") as working:
            (working / "half").write_text("x")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["summary.json", "case.toml", "result.nc"])
@pytest.mark.parametrize("damage", [b"", b"\x00garbage", None])
def test_damaged_results_are_named(
    name: str, damage: bytes | None, folder: Path, tmp_path: Path
) -> None:
    import shutil

    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    (copy / name).unlink() if damage is None else (copy / name).write_bytes(damage)
    if damage == b"" and name == "case.toml":
        return  # an empty case is what a problem made in Python has
    with pytest.raises(vi.InputError, match=r"damaged|not a result folder"):
        vi.load_result(copy)


def test_damage_is_named_with_its_part_and_the_remedy(folder: Path, tmp_path: Path) -> None:
    import shutil

    copy = Path(shutil.copytree(folder, tmp_path / "a copy"))
    with h5py.File(copy / "result.nc") as file:
        data = file["history/force_N"]
        assert all(
            one.fletcher32 for group in ("impacts", "history") for one in file[group].values()
        )
        place = data.id.get_chunk_info(0).byte_offset
    content = bytearray((copy / "result.nc").read_bytes())
    content[place + 5] ^= 1
    (copy / "result.nc").write_bytes(bytes(content))
    with pytest.raises(vi.InputError) as refused:
        vi.load_result(copy)
    words = "history/force_N is damaged (its check sum does not match)"
    remedy = f"make it anew with: vibroimpact run '{copy / 'case.toml'}' -o '{copy}' --force"
    assert str(refused.value) == f"{copy / 'result.nc'}: {words}; {remedy}"


def test_a_damaged_summary_is_not_mended_by_a_run_of_another_case(
    folder: Path, tmp_path: Path
) -> None:
    """Without the data of a run beside it, it may be that of a calibration, which a run
    would replace.
    """
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    (copy / "summary.json").write_text("{")
    with pytest.raises(vi.InputError, match="make it anew with: vibroimpact run"):
        vi.load_result(copy)
    (copy / "result.nc").unlink()
    with pytest.raises(vi.InputError, match=r"make the result anew$"):
        vi.load_result(copy)


def test_results_of_earlier_versions_open(
    folder: Path, tmp_path: Path, theory: vi.Response
) -> None:
    import shutil

    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    summary = json.loads((copy / "summary.json").read_text())
    del summary["sha256"], summary["check_sums"]
    (copy / "summary.json").write_text(json.dumps(summary))
    assert vi.load_result(copy).status == theory.status
    summary["energy"], summary["truncation"] = 1.0, {"plate": [1.0]}
    (copy / "summary.json").write_text(json.dumps(summary))
    with pytest.raises(
        vi.InputError,
        match=r"summary.json: the file is missing or damaged: truncation has the wrong type",
    ):
        vi.load_result(copy)


@pytest.mark.parametrize(
    "damage",
    [{"plate": {"max_displacement_m": 1e-6, "frequencies_Hz": []}}, {"truncation": {"plate": 0.1}}],
)
def test_peaks_and_truncation_without_modes_are_refused(
    folder: Path, tmp_path: Path, damage: dict[str, Any]
) -> None:
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    summary = json.loads((copy / "summary.json").read_text())
    del summary["sha256"], summary["check_sums"]
    (copy / "summary.json").write_text(json.dumps(summary | damage))
    with pytest.raises(
        vi.InputError,
        match=r"summary.json: the file is missing or damaged: frequencies_Hz has the wrong type",
    ):
        vi.load_result(copy)


def test_a_large_file_goes_to_the_disk_as_it_grows(tmp_path: Path) -> None:
    values = np.random.default_rng(1).random(2_000_000)
    tracemalloc.start()
    try:
        with new_hdf5(tmp_path / "large.nc") as file:
            for name in "abc":
                new_array(file, name, values)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert (tmp_path / "large.nc").stat().st_size > 3 * values.nbytes
    assert peak < values.nbytes / 4
    with h5py.File(tmp_path / "large.nc") as file:
        np.testing.assert_array_equal(read_array(file["c"]), values)


def test_a_file_that_finds_no_room_is_an_error_and_no_more(tmp_path: Path) -> None:
    ran = subprocess.run(
        [sys.executable, "-c", _NO_ROOM, str(tmp_path)], capture_output=True, text=True, check=True
    )
    assert ran.stdout.splitlines() == [*["File too large"] * 4, "room again"]
    assert ran.stderr == ""


_NO_ROOM = """
import resource, sys
from pathlib import Path
from typing import Any
import numpy as np
from vibroimpact.files.hdf5 import new_array, new_hdf5

def fill(size):
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
    with new_hdf5(Path(sys.argv[1], "x.nc")) as file:
        for name in "abc":
            new_array(file, name, np.ones(20_000))

for size in (0, 50, 100_000, 480_500):
    try:
        fill(size)
    except OSError as error:
        print(error.strerror)
fill(10_000_000)
print("room again")
"""
"""A process that may write files of so many bytes only, as on a disk that is full."""
