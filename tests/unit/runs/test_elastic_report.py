"""What is kept and shown of a drop whose bodies vibrate: the folder, the charts, the
files for ParaView.
"""

from __future__ import annotations

import csv
import json
import math
import shutil
from collections.abc import Iterator
from dataclasses import replace
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import xarray
from PIL import Image
from rich.console import Console

import vibroimpact as vi
from pages import Page
from support import THIN_PLATE
from vibroimpact.dynamics.motion.columns import (
    IMPACT_COLUMNS,
    LEDGER,
    VIBRATION_HISTORY_COLUMNS,
    VIBRATION_IMPACT_COLUMNS,
    VIBRATION_LEDGER,
    meanings,
)
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.results.deflection import frame_times
from vibroimpact.results.result import Result, result_of
from vibroimpact.results.surface_grid import surface_grid
from vibroimpact.runs import paraview
from vibroimpact.runs.animation import animate
from vibroimpact.runs.charts import run_charts
from vibroimpact.runs.deformation import counted_twice, deformation_rows, treatment_sentence
from vibroimpact.runs.energy_chart import bands_of
from vibroimpact.runs.paraview import write_paraview
from vibroimpact.runs.report import report_of
from vibroimpact.runs.scene import exaggeration, scene_of
from vibroimpact.runs.spectrum import amplitude_spectrum
from vibroimpact.runs.tables import impact_table
from vibroimpact.structures.finite_elements.lattice import box_mesh
from written_results import write_result

SPHERE = {
    "radius": "25 mm",
    "material": "rock-paper",
    "model": "elastic",
    "modes": 6,
    "damping": 0.02,
    "mesh": {"elements_across": 4},
}
SENSORS = [
    {"name": "fast one", "position": ["60 mm", "30 mm"], "rate": "100 kHz"},
    {"name": "slow/one", "position": [0, "-50 mm"], "quantity": "velocity", "rate": "2 kHz"},
]


def elastic_case(**changes: Any) -> vi.Case:
    case: dict[str, Any] = {
        "name": "elastic",
        "sphere": SPHERE,
        "plate": THIN_PLATE,
        "drop": {"speed": 3.0, "position": ["20 mm", "10 mm"]},
        "contact": {"law": "hunt-crossley", "restitution": 0.8},
        "run": {"impacts": 2},
        "sensors": SENSORS,
    }
    return vi.case_of({**case, **changes})


@pytest.fixture(scope="module", autouse=True)
def store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(tmp_path_factory.mktemp("store")))
        patch.setattr("vibroimpact.results.deflection._FRAMES", 48)
        yield


@pytest.fixture(scope="module")
def response(store: None) -> vi.Response:
    return vi.simulate(elastic_case())


@pytest.fixture(scope="module")
def folder(response: vi.Response, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("results") / "elastic"
    response.save(path)
    return path


@pytest.fixture(scope="module")
def result(folder: Path) -> Result:
    return vi.load_result(folder)


def printed(result: Result, width: int = 120) -> str:
    written = StringIO()
    Console(width=width, file=written).print(terminal_report(result.report))
    return " ".join(written.getvalue().split())


def names_of(result: Result) -> set[str]:
    return {chart.name for chart in run_charts(result)}


def test_charts_are_those_of_what_vibrates(result: Result) -> None:
    expected = {
        "position",
        "force",
        "velocity",
        "acceleration",
        "force_indentation",
        "energy",
        "sphere_energy",
        "plate_motion",
    }
    assert names_of(result) == expected | {
        "plate_energy",
        "deflection",
        "sensor_fast_one",
        "sensor_slow_one",
    }


def test_folder_holds_what_it_should(folder: Path) -> None:
    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    expected = {"case.toml", "impacts.csv", "summary.json", "result.nc", "report.html"}
    expected |= {
        "sensors/fast_one.csv",
        "sensors/slow_one.csv",
        "paraview/plate.pvd",
        "paraview/sphere.pvd",
    }
    assert {name for name in names if not name.endswith(".vtu")} == expected
    assert len([name for name in names if name.endswith(".vtu")]) == 80


def test_a_result_prints_the_same_from_memory_as_from_its_folder(
    result: Result, response: vi.Response
) -> None:
    assert printed(result_of(response)) == printed(result)


def test_the_energy_lost_is_told_to_be_that_of_the_contact(result: Result) -> None:
    """Where the table has the column, and bodies vibrate."""
    words = "Energy lost is the energy dissipated in the contact, without the energy of vibration."
    assert words in printed(result)
    assert words in " ".join(page_of_report(result.report).split())
    assert "Energy lost is" not in printed(result, 60)
    assert "Energy lost is" not in printed(
        result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    )


def test_summary_has_the_promised_peaks(folder: Path, response: vi.Response) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    assert list(summary["impacts"][0]) == [*IMPACT_COLUMNS, *VIBRATION_IMPACT_COLUMNS]
    assert set(summary["energy"]) == {
        "input_J",
        *LEDGER,
        *VIBRATION_LEDGER,
        "closure_J",
        "closure_relative",
    }
    for body, basis in (
        ("sphere", response.problem.sphere.modes),
        ("plate", response.problem.plate.modes),
    ):
        peaks = summary[body]
        assert basis is not None
        assert peaks["frequencies_Hz"] == basis.frequencies.tolist()
        names = (
            "max_displacement_m",
            "max_velocity_m_s",
            "max_acceleration_m_s2",
            "max_kinetic_energy_J",
            "max_strain_energy_J",
        )
        assert all(peaks[name] > 0.0 for name in names)
        assert summary["truncation"][body] == response.truncation[body]
    assert summary["deformation"]["treatment"] == "consistent"
    sensor = summary["sensors"]["slow/one"]
    assert (sensor["filter"], sensor["overload_time_s"], sensor["peak_before_range"]) == (
        "sigma-delta",
        0.0,
        None,
    )
    assert (
        0.0
        < sensor["relative_uncertainty"]
        < 0.1
        < summary["sensors"]["fast one"]["relative_uncertainty"]
    )
    assert (
        summary["sphere"]["max_acceleration_m_s2"]
        == response.impacts["max_acceleration_m_s2"].max()
    )
    assert summary["sphere"]["max_velocity_m_s"] == pytest.approx(3.0, rel=1e-3)


def test_peaks_of_the_plate_are_those_of_a_very_fine_history(
    folder: Path, response: vi.Response
) -> None:
    peaks = json.loads((folder / "summary.json").read_text())["plate"]
    touch = float(response.impacts["time_s"][0])
    fine = response.at(np.linspace(touch, touch + 0.01, 20001))
    for peak, column in (
        ("max_displacement_m", "plate_displacement_m"),
        ("max_velocity_m_s", "plate_velocity_m_s"),
        ("max_acceleration_m_s2", "plate_acceleration_m_s2"),
        ("max_kinetic_energy_J", "plate_kinetic_J"),
        ("max_strain_energy_J", "plate_strain_J"),
    ):
        assert peaks[peak] == pytest.approx(np.abs(fine[column]).max(), rel=0.01), peak


def test_impacts_csv_has_the_further_columns(folder: Path, response: vi.Response) -> None:
    rows = list(csv.DictReader((folder / "impacts.csv").read_text().splitlines()))
    for name in VIBRATION_IMPACT_COLUMNS:
        assert [float(row[name]) for row in rows] == response.impacts[name].tolist()


def test_groups_open_in_xarray_with_units(folder: Path, response: vi.Response) -> None:
    def opened(group: str) -> xarray.Dataset:
        return xarray.open_dataset(folder / "result.nc", group=group, engine="h5netcdf")

    with opened("history") as history:
        for name, (unit, meaning) in meanings(VIBRATION_HISTORY_COLUMNS).items():
            assert (history[name].attrs["units"], history[name].attrs["long_name"]) == (
                unit,
                meaning,
            )
        assert bool((np.diff(history["time_s"]) >= 0.0).all())
    with opened("sensors/slow_one") as sensor:
        assert (sensor.attrs["name"], sensor.attrs["quantity"], sensor.attrs["rate_Hz"]) == (
            "slow/one",
            "velocity",
            2000.0,
        )
        assert sensor["value"].attrs["units"] == "m/s"
        np.testing.assert_array_equal(sensor["value"], response.signals()["slow/one"].value)
    with opened("deflection") as group:
        assert group["deflection_m"].dims == ("time_s", "y_m", "x_m")
        assert group["deflection_m"].dtype == np.float32
        assert all(
            group[name].attrs["units"] in ("s", "m") and group[name].attrs["long_name"]
            for name in group.variables
        )
        at_contact = group["deflection_m"].interp(x_m=0.02, y_m=0.01)
        scale = float(np.abs(group["contact_deflection_m"]).max())
        np.testing.assert_allclose(at_contact, group["contact_deflection_m"], atol=0.01 * scale)


def test_result_reads_back(result: Result, response: vi.Response) -> None:
    fresh = result_of(response)
    for name, values in fresh.history.items():
        np.testing.assert_array_equal(result.history[name], values)
    assert (result.deformation, result.truncation, result.peaks) == (
        fresh.deformation,
        fresh.truncation,
        fresh.peaks,
    )
    assert result.doubts == fresh.doubts
    assert list(result.signals) == [sensor["name"] for sensor in SENSORS]
    for name, signal in fresh.signals.items():
        assert result.signals[name].sensor == signal.sensor
        np.testing.assert_array_equal(result.signals[name].value, signal.value)
    assert result.deflection is not None
    assert fresh.deflection is not None
    np.testing.assert_array_equal(result.deflection.height, fresh.deflection.height)
    assert result.deflection.contact == (0.02, 0.01)


def test_signals_as_csv(folder: Path, response: vi.Response) -> None:
    header, *rows = (folder / "sensors" / "fast_one.csv").read_text().splitlines()
    assert header == "time_s,acceleration_m_s2"
    values = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    signal = response.signals()["fast one"]
    np.testing.assert_array_equal(values[:, 1], signal.value)
    np.testing.assert_allclose(values[:, 0], signal.time, rtol=1e-11)


def test_a_sensor_faster_than_the_modes_is_doubted_with_numbers(
    result: Result, folder: Path
) -> None:
    (doubt,) = [doubt for doubt in result.doubts if "sensor" in doubt]
    highest, part = result.frequencies("plate")[-1], result.signals["fast one"].uncertainty
    for words in (
        '"fast one"',
        "100000 samples",
        f"{highest / 1e3:.4g}\u00a0kHz",
        f"{100.0 * part:.2g} %",
        'plate.max_frequency = "100 kHz"',
    ):
        assert words in doubt
    assert doubt.split(",")[0] in (folder / "report.html").read_text().replace("&#34;", '"')
    assert doubt.split(",")[0].replace("\u00a0", " ") in printed(result)


@pytest.mark.slow
def test_report_is_remade_from_the_folder_alone(folder: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copytree(folder, tmp_path / "copy"))
    (copy / "report.html").unlink()
    vi.remake_report(copy)
    for path in folder.rglob("*"):
        if path.is_file():
            assert (copy / path.relative_to(folder)).read_bytes() == path.read_bytes(), path


def test_paraview_reads_how_the_bodies_move(folder: Path, response: vi.Response) -> None:
    collection = (folder / "paraview" / "plate.pvd").read_text()
    times = [float(piece.split('"')[0]) for piece in collection.split('timestep="')[1:]]
    assert len(times) == 40
    assert times == sorted(times)
    number = 20
    plate = meshio.read(folder / "paraview" / "plate" / f"plate_{number:03d}.vtu")
    at = np.array(times[number : number + 1])
    shapes = response.problem.models["plate"].shapes
    moved = (response.modal(at)["plate"][0] @ shapes).reshape(len(plate.points), -1)[:, :3]
    np.testing.assert_allclose(plate.point_data["displacement_m"], moved, rtol=1e-5, atol=1e-12)
    sphere = meshio.read(folder / "paraview" / "sphere" / f"sphere_{number:03d}.vtu")
    fall = sphere.point_data["displacement_m"] - sphere.point_data["deformation_m"]
    np.testing.assert_allclose(fall[:, 2], response.at(at)["position_m"][0] - 0.025, rtol=1e-4)
    middle = 0.5 * (sphere.points.min(axis=0) + sphere.points.max(axis=0))
    # it just touches the upper side
    np.testing.assert_allclose(middle, [0.02, 0.01, 0.003 + 0.025], atol=1e-6)


def test_paraview_takes_fewer_frames_of_a_fine_mesh(
    response: vi.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(paraview, "_MOST_BYTES", 4e5)
    write_paraview(response, tmp_path / "some")
    files = list(tmp_path.rglob("*.vtu"))
    assert 4 <= len(files) < 40
    assert sum(file.stat().st_size for file in files) < 4.4e5
    monkeypatch.setattr(paraview, "_MOST_BYTES", 1e3)
    write_paraview(response, tmp_path / "none")
    assert not (tmp_path / "none").exists()


@pytest.mark.slow
def test_the_animation_is_small_and_tells_its_scale(result: Result, folder: Path) -> None:
    deflection = result.deflection
    assert deflection is not None
    animation = animate(result)
    with Image.open(BytesIO(animation)) as picture:
        assert 40 <= getattr(picture, "n_frames", 1) <= len(deflection.time)
    assert len(animation) < 3e6
    assert f"magnified {exaggeration(deflection):g} times" in (folder / "report.html").read_text()
    still = replace(deflection, height=np.zeros_like(deflection.height))
    assert exaggeration(still) == 1.0
    assert animate(replace(result, deflection=replace(still, time=still.time[:2])))


def test_the_page_has_the_plate_in_motion(result: Result, folder: Path) -> None:
    deflection = result.deflection
    assert deflection is not None
    scene = Page((folder / "report.html").read_text()).data()["scene"]
    assert scene.keys() == scene_of(result).keys()
    frames, rows, columns = deflection.height.shape
    # to a small part of a pixel
    most = float(np.abs(deflection.height).max())
    np.testing.assert_allclose(
        scene["height"].reshape(frames, rows, columns),
        deflection.height,
        rtol=0.0,
        atol=3e-4 * most,
    )
    np.testing.assert_allclose(
        scene["time"], deflection.time - result.impacts["time_s"][0], rtol=1e-6
    )
    np.testing.assert_allclose(scene["sphere"], deflection.sphere_position, rtol=1e-6)
    assert scene["radius"] == pytest.approx(0.025)
    assert scene["contact"] == [0.02, 0.01]
    assert [one["name"] for one in scene["sensors"]] == ["fast one", "slow/one"]
    assert len(scene["supports"]) == 4
    assert all(outline.shape == (4, 2) for outline in scene["supports"])


def test_bands_of_the_ledger_add_up(result: Result) -> None:
    bands = bands_of(result.history)
    total = sum(values for name, values in bands.items() if name != "time_s")
    np.testing.assert_allclose(total, result.energy["input_J"], rtol=1e-7)


def test_page_and_console_tell_the_treatment_and_the_truncation(
    result: Result, folder: Path
) -> None:
    page, console = (folder / "report.html").read_text().replace("&#39;", "'"), printed(result)
    assert treatment_sentence(result).startswith("Consistent")
    for words in (
        treatment_sentence(result),
        *(row for rows in deformation_rows(result) for row in rows),
    ):
        assert words in page
        assert " ".join(words.split()) in console
    assert {"sphere", "plate"} == {
        body for body in ("sphere", "plate") if f"due to the modes of the {body} left out" in page
    }
    assert "plate damping" in console
    assert math.isnan(counted_twice(result))


def test_superposed_says_how_much_is_counted_twice() -> None:
    response = vi.simulate(
        elastic_case(
            contact={"law": "hertz", "local_compliance": "superposed"},
            sensors=[],
            run={"impacts": 1},
        )
    )
    result = result_of(response)
    law = result.impacts["max_indentation_m"][0] / result.impacts["max_force_N"][0]
    assert counted_twice(result) == pytest.approx(
        float(response.problem.facts["sphere_modal_compliance_m_N"]) / law
    )
    assert f"{100.0 * counted_twice(result):.1f} %" in printed(result)
    assert not result.signals


def test_identified_tells_its_element(tmp_path: Path) -> None:
    contact = {
        "law": "hertz",
        "local_compliance": "identified",
        "local_stiffness": 2e6,
        "local_damping": 500.0,
    }
    sphere = {"radius": "25 mm", "material": "rock-paper"}
    response = vi.simulate(
        elastic_case(contact=contact, sphere=sphere, sensors=[], run={"impacts": 1})
    )
    write_result(result_of(response), tmp_path)
    write_paraview(response, tmp_path / "paraview")
    result = vi.load_result(tmp_path)
    assert "sphere" not in result.peaks
    assert dict(deformation_rows(result))["Stiffness of the local element"] == "2000000\u00a0N/m"
    assert not (tmp_path / "sensors").exists()
    assert [path.name for path in (tmp_path / "paraview").glob("*.pvd")] == ["plate.pvd"]


def test_a_sphere_alone_has_no_pictures_of_a_plate() -> None:
    result = result_of(
        vi.simulate(
            elastic_case(
                plate={"material": "rigid"}, drop={"speed": 3.0}, sensors=[], run={"impacts": 1}
            )
        )
    )
    assert result.deflection is None
    assert "of the plate" not in treatment_sentence(result)
    assert list(result.peaks) == ["sphere"]
    assert not {"plate_motion", "deflection"} & names_of(result)
    assert "sphere_energy" in names_of(result)


def test_a_problem_made_in_python_has_no_deflection(response: vi.Response, tmp_path: Path) -> None:
    bare = replace(response.problem, models={}, source=None, facts={}, sensors=())
    write_result(result_of(vi.simulate(bare)), tmp_path)
    result = vi.load_result(tmp_path)
    assert result.deflection is None
    assert treatment_sentence(result) == ""
    assert "plate_motion" in names_of(result)
    assert "deflection" not in names_of(result)


def test_a_run_without_impact_is_saved(response: vi.Response, tmp_path: Path) -> None:
    problem = replace(
        response.problem, speed=None, height=1.0, gravity=9.8, impacts=None, duration=0.1
    )
    response = vi.simulate(problem)
    write_result(result_of(response), tmp_path)
    write_paraview(response, tmp_path / "paraview")
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["truncation"] == {"sphere": None, "plate": None}
    result = vi.load_result(tmp_path)
    assert math.isnan(result.truncation["plate"])
    assert not (tmp_path / "paraview").exists()
    assert names_of(result) == {"position", "velocity", "energy"}
    assert "No impact" in printed(result)
    assert "No impact within the run." in Page(page_of_report(result.report)).text


def test_contacts_are_shown_where_a_visit_has_several(result: Result) -> None:
    several = replace(result, impacts={**result.impacts, "contacts": np.array([1.0, 3.0])})
    table = impact_table(several)
    headers, rows = table.headings, table.rows
    assert headers[-1] == ("Contacts in the impact", "")
    assert [row[-1] for row in rows] == ["1", "3"]
    for width in (80, 110, 120):
        assert " contacts " in printed(several, width)
        assert "…" not in printed(several, width)
    once = replace(result, impacts={**result.impacts, "contacts": np.ones(2)})
    assert ("Contacts in the impact", "") not in impact_table(once).headings


def test_frames_follow_the_visit_and_stay_in_the_run() -> None:
    times = frame_times(touch=1.0, duration=1e-3, period=0.02, end=1.03, count=96)
    steps = np.diff(times)
    assert (times[0] < 1.0, times[-1] <= 1.03) == (True, True)
    assert np.all(steps > 0.0)
    assert np.sum((times >= 1.0) & (times <= 1.001)) == 21
    assert steps.max() == pytest.approx(0.02 / 24)
    assert frame_times(0.0, 1e-3, 0.02, 1.0, 96)[0] == 0.0


def test_a_grid_lies_on_the_uppermost_face_and_leaves_holes_out() -> None:
    block = box_mesh((1.0, 0.5, 0.1), (4, 2, 2), "hex20")
    grid = surface_grid(block)
    assert grid.on_body.all()
    np.testing.assert_allclose(grid.interpolate(block.nodes[:, 2]), 0.05, atol=1e-12)
    x, y = np.meshgrid(grid.x, grid.y)
    np.testing.assert_allclose(grid.interpolate(block.nodes[:, 0]), x, atol=1e-9)
    np.testing.assert_allclose(grid.interpolate(block.nodes[:, 1]), y, atol=1e-9)
    first = block.blocks[0]
    middle = block.nodes[first.connectivity].mean(axis=1)
    kept = ~((middle[:, 0] > 0.0) & (middle[:, 1] > 0.0))
    corner = replace(block, blocks=(replace(first, connectivity=first.connectivity[kept]),))
    inside = surface_grid(corner).on_body
    assert not inside[(x > 1e-3) & (y > 1e-3)].any()
    assert inside[(x < 0.0) | (y < 0.0)].all()


def test_further_columns_are_documented() -> None:
    text = (Path(__file__).parents[3] / "docs" / "result-folder.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in text for name in (*VIBRATION_IMPACT_COLUMNS, *VIBRATION_LEDGER))


def test_a_spectrum_reads_the_amplitude_of_a_tone() -> None:
    time = np.arange(4000) / 1e4
    found = amplitude_spectrum(2.0 * np.cos(2.0 * np.pi * 500.0 * time), 1e4)
    assert found.frequency[found.amplitude.argmax()] == 500.0
    assert found.amplitude.max() == pytest.approx(2.0, rel=1e-3)
    assert found.span == pytest.approx(0.4)


@pytest.mark.slow
def test_the_page_of_the_papers_type_3_is_below_4_mb() -> None:
    """It was 7 MB, two thirds of them points that no pixel shows."""
    result = vi.result_of(vi.simulate(vi.load_case("paper:type3")))
    assert len(page_of_report(report_of(result))) < 3.9e6
