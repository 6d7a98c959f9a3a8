"""Instruments of sensors in a case: what is read, what is refused and in which words, and
where it is told.
"""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.elastic.meshes import meshes_of as check_meshes
from vibroimpact.cases.sensor_doubts import sensor_doubts
from vibroimpact.dynamics.sensors.instruments.instrument import UNITS
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.exporting.formats.uff58 import _QUANTITIES
from vibroimpact.results.csv_files import signal_csv
from vibroimpact.runs.case_explained import case_explained

MICROPHONE = {"distance": "300 mm"}
GEOPHONE = {"natural_frequency": "10 Hz", "sensitivity": "27.6 V s/m"}


def case(**sensor: Any) -> vi.Case:
    """A drop on an elastic plate with one sensor."""
    plate = {
        "size": [0.52, 0.42, 0.008],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 10,
        "supports": "clamped",
    }
    return vi.case_of(
        {
            "sphere": {"radius": "25 mm", "material": "rock-paper"},
            "plate": plate,
            "drop": {"height": 1.0},
            "contact": {"law": "hertz"},
            "run": {"impacts": 1},
            "sensors": [{"name": "a1", "position": [0.1, 0.05], **sensor}],
        }
    )


@pytest.mark.parametrize(
    ("sensor", "message"),
    [
        (
            {"instrument": "geofone"},
            r'"a1"\.instrument: "geofone" is not allowed; .* Did you mean "geophone"',
        ),
        (
            {"instrument": "geophone"},
            r'"a1"\.geophone: a geophone has properties; give them in a table geophone = '
            r"\{ \.\.\. \}",
        ),
        (
            {"geophone": {"natural_frequency": 10}},
            r'"a1"\.geophone\.sensitivity: this key is missing',
        ),
        (
            {"geophone": {**GEOPHONE, "sensitivity": "27.6 V/m"}},
            "is another kind of quantity; expected a voltage over velocity",
        ),
        (
            {"geophone": {**GEOPHONE, "lowpas": 1}},
            r'unknown key "lowpas"; .* Did you mean "low_pass"',
        ),
        (
            {"instrument": "accelerometer", "geophone": GEOPHONE},
            "its instrument is an accelerometer; leave out this table, or take instrument",
        ),
        (
            {"accelerometer": {}, "geophone": GEOPHONE},
            "its instrument is an accelerometer; leave out this table, or the table accelerometer",
        ),
        (
            {"accelerometer": {}, "strain_gauge": {}},
            r'"a1"\.strain_gauge: its instrument is an accelerometer',
        ),
        (
            {"quantity": "velocity", "geophone": GEOPHONE},
            "a geophone measures voltage; leave out quantity, or the geophone",
        ),
        (
            {"quantity": "voltage"},
            r"voltage is the output of an instrument; name one, such as geophone = \{ \.\.\. \}",
        ),
        (
            {"instrument": "strain-gauge", "direction": "z"},
            r'"a1"\.direction: a strain gauge lies in the face; give a direction along it',
        ),
        ({"instrument": "strain-gauge", "direction": [1, 0, 1]}, "a strain gauge lies in the face"),
        (
            {"instrument": "strain-gauge", "quantity": "voltage"},
            "a strain gauge measures strain; leave out quantity",
        ),
        (
            {"strain_gauge": {"sensitivty": 1}},
            r'unknown key "sensitivty"; .* Did you mean "sensitivity"',
        ),
        (
            {"instrument": "microphone"},
            r'"a1"\.microphone: a microphone has properties; give them in a table microphone',
        ),
        (
            {"microphone": {"distance": "0.1 mm"}},
            r'"a1"\.microphone\.distance: "0.1 mm" is not allowed',
        ),
        (
            {"microphone": {"distanse": "10 mm"}},
            r'unknown key "distanse"; .* Did you mean "distance"',
        ),
        (
            {"microphone": MICROPHONE, "direction": "x"},
            r'"a1"\.direction: a microphone is omnidirectional',
        ),
        (
            {"microphone": MICROPHONE, "filter": "none"},
            r'"a1"\.filter: a microphone has the filter "sigma-delta"',
        ),
        (
            {"microphone": MICROPHONE, "position": "a set"},
            r'"a1"\.position: only a plate with a mesh file has sets, such as "a set"',
        ),
        (
            {"microphone": {**MICROPHONE, "sensitivity": "50 mV"}},
            "is a voltage; expected a voltage over pressure",
        ),
        (
            {"instrument": "force", "quantity": "voltage"},
            "a force sensor measures force; leave out quantity",
        ),
        ({"force": {"sensitivity": "10 mV"}}, "is a voltage; expected a voltage over force"),
        (
            {"force": {"sensitivitty": 1}},
            r'unknown key "sensitivitty"; .* Did you mean "sensitivity"',
        ),
        (
            {"amplifier": {"noise": "1 mV"}},
            r'"a1"\.amplifier\.noise: "1 mV" is a voltage; expected an acceleration',
        ),
        ({"amplifier": {"gain": 0}}, r'"a1"\.amplifier\.gain: 0 is not allowed'),
        (
            {"geophone": GEOPHONE, "converter": {"range": -1}},
            r'"a1"\.converter\.range: -1 is not allowed; it must be greater than 0 V',
        ),
        (
            {"converter": {"range": 1, "bit": 3}},
            r'unknown key "bit"; .* takes range, bits\. Did you mean "bits"',
        ),
    ],
)
def test_what_does_not_fit_is_named(sensor: dict[str, Any], message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        case(**sensor)


@pytest.mark.parametrize(
    "sensor",
    [
        {
            "geophone": GEOPHONE,
            "amplifier": {"noise": "1 uV", "hum": "1 mV", "mains": 60},
            "converter": {"range": "10 V", "bits": 24},
        },
        {
            "accelerometer": {"sensitivity": "100 mV/g", "range": "50 g"},
            "converter": {"range": "5 V"},
        },
        {"instrument": "accelerometer", "amplifier": {"noise": "1 g"}},
        {"instrument": "strain-gauge", "face": "lower", "converter": {"range": 1e-3}},
        {
            "strain_gauge": {"sensitivity": "2 V"},
            "direction": [1, 2, 0],
            "amplifier": {"gain": 1000},
        },
        {"microphone": MICROPHONE, "face": "lower", "amplifier": {"noise": "1 mPa"}},
        {
            "microphone": {**MICROPHONE, "sensitivity": "50 mV/Pa", "speed_of_sound": 340},
            "position": [2, 0],
            "converter": {"range": "1 V"},
        },
        {"instrument": "force", "position": [-0.26, 0], "amplifier": {"noise": "10 mN"}},
        {
            "force": {"sensitivity": "10 mV/N"},
            "direction": "x",
            "position": [-0.26, 0],
            "converter": {"range": "5 V", "bits": 16},
        },
        {"quantity": "velocity", "converter": {"range": "1 m/s", "bits": 12}},
    ],
)
def test_the_resolved_case_is_the_same_case(sensor: dict[str, Any]) -> None:
    given = case(**sensor)
    (resolved,) = resolved_case(given)["sensors"]
    assert (
        case(**{key: value for key, value in resolved.items() if key != "name"}).sensors
        == given.sensors
    )
    (again,) = vi.case_of(dict(resolved_case(given))).sensors
    assert again.sensor() == given.sensors[0].sensor()


def test_standard_gravity_in_a_sensitivity() -> None:
    (sensor,) = case(accelerometer={"sensitivity": "100 mV/g"}).sensors
    assert sensor.quantity == "voltage"
    assert sensor.accelerometer is not None
    assert sensor.accelerometer.sensitivity == pytest.approx(0.1 / 9.80665, rel=1e-12)


def test_a_converter_that_clips_or_reads_nothing_is_doubted() -> None:
    sensor = {"name": "a1", "position": [0.1, 0.05], "converter": {"range": 1.0, "bits": 8}}
    signal = Signal(vi.sensors.Sensor("a1", "voltage"), np.array([0.0, 0.5, 127 / 128, -1.0]))
    (clipped,) = sensor_doubts({"sensors": [sensor]}, {"a1": signal}, 1e4, 1e-4)  # type: ignore[list-item]
    assert 'the converter of sensor "a1" clips 2 of 4 samples at its range of 1.000' in clipped
    (silent,) = sensor_doubts(
        {"sensors": [sensor]}, {"a1": Signal(signal.sensor, np.zeros(4))}, 1e4, 1e-4
    )  # type: ignore[list-item]
    assert "reads zero all along: each sample is below half its step, 7.812" in silent


def test_solid_elements_have_the_motion_through_the_thickness_near_the_contact() -> None:
    steel = {"density": 7850.0, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3}
    plate = {"model": "elastic", "size": [0.3, 0.2, 0.02], "material": steel}
    sensor = {"name": "a1", "position": [0.0, 0.01]}
    signal = Signal(vi.sensors.Sensor("a1", rate=50e3), np.ones(4), uncertainty=0.001)
    for element, words in (
        ("plate", "0.5 thicknesses from the contact, the motion through the thickness"),
        ("solid", ""),
    ):
        case = {
            "plate": {**plate, "element": element},
            "drop": {"position": [0.0, 0.0]},
            "sensors": [sensor],
        }
        found = "".join(sensor_doubts(case, {"a1": signal}, 1e5, 1e-4))  # type: ignore[arg-type]
        assert words in found
        assert bool(found) == bool(words)


def test_every_quantity_has_a_type_in_universal_files_and_a_header() -> None:
    assert _QUANTITIES.keys() == UNITS.keys()
    assert signal_csv(Signal(vi.sensors.Sensor("a1", "voltage"), np.zeros(1))).startswith(
        "time_s,voltage_V\n"
    )


def test_a_run_with_instruments_is_told_and_read_back(tmp_path: Path) -> None:
    """In the folder, the page, universal files and the explanation of the case; voltage
    and strain are what the sensors' parts say.
    """
    given = case(
        geophone=GEOPHONE,
        amplifier={"hum": "1 mV"},
        converter={"range": "10 V", "bits": 16},
        rate="10 kHz",
    )
    whole = dict(resolved_case(given))
    whole["sensors"] = [
        *whole["sensors"],
        {"name": "e", "position": [0.1, 0.05], "instrument": "strain-gauge"},
        {"name": "m", "position": [0.0, 0.0], "microphone": MICROPHONE},
        {"name": "r", "position": [-0.26, 0.0], "instrument": "force"},
    ]
    response = vi.simulate(vi.case_of(whole))
    response.save(tmp_path / "run")
    again = vi.load_result(tmp_path / "run")
    assert {
        name: (one.sensor.quantity, one.sensor.unit) for name, one in again.signals.items()
    } == {
        "a1": ("voltage", "V"),
        "e": ("strain", "m/m"),
        "m": ("pressure", "Pa"),
        "r": ("force", "N"),
    }
    for name, signal in response.signals().items():
        np.testing.assert_array_equal(again.signals[name].value, signal.value)
        assert np.isfinite(signal.uncertainty)
        assert signal.largest > 0.0
    assert (tmp_path / "run" / "sensors" / "e.csv").read_text().startswith("time_s,strain_m_m\n")
    assert (tmp_path / "run" / "sensors" / "m.csv").read_text().startswith("time_s,pressure_Pa\n")
    assert (tmp_path / "run" / "sensors" / "r.csv").read_text().startswith("time_s,force_N\n")
    words = case_text_of(whole)
    assert "force of the support at (-0.26, 0) m, by a force sensor (ideal)" in words
    assert (
        "pressure at (0, 0) m, upper face, by a microphone (distance 0.3 m; air density 1.2 "
        "kg/m3; speed of sound 343.2 m/s)" in words
    )
    assert "strain at (0.1, 0.05) m, upper face, by a strain gauge (ideal)" in words
    assert (
        "by a geophone (natural frequency 10 Hz; sensitivity 27.6 V s/m; damping ratio 0.6)"
        in words
    )
    assert (
        "amplifier (gain 1; noise 0 V; hum of 0.001 V at 50 Hz), converter (range 10 V; 16 bits)"
        in words
    )


def case_text_of(table: dict[str, Any]) -> str:
    """What `check` says of a case, without line breaks."""
    console = Console(width=400, file=StringIO())
    console.print(case_explained(vi.case_of(table)))
    return " ".join(console.file.getvalue().split())  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("sensor", "name"),
    [
        ({"microphone": MICROPHONE}, "a microphone"),
        ({"instrument": "force", "position": [-0.26, 0]}, "a force sensor"),
    ],
)
def test_what_is_for_plates_at_rest(sensor: dict[str, Any], name: str) -> None:
    shaken = dict(resolved_case(case(**sensor)))
    shaken["plate"] = {**shaken["plate"], "motion": {"amplitude": "0.1 mm", "frequency": "50 Hz"}}
    with pytest.raises(
        vi.InputError,
        match=rf'"a1"\.instrument: {name} is for plates whose supports are at rest; leave out '
        r"the sensor",
    ):
        vi.simulate(vi.case_of(shaken))


def test_low_sound_of_a_plate_in_no_baffle_is_doubted() -> None:
    """Half a wavelength of 343.2 m/s is as long as 0.42 m at 409 Hz."""
    resolved = resolved_case(case(microphone=MICROPHONE))
    time = np.arange(5000) / 50e3
    low, high = (np.sin(2.0 * np.pi * frequency * time) for frequency in (300.0, 2000.0))
    said = sensor_doubts(
        resolved, {"a1": Signal(vi.sensors.Sensor("a1", "pressure"), low + high, 0.0)}, 1e3, 1e-3
    )
    assert len(said) == 1
    assert (
        '50 % of the power of the signal of microphone "a1" lies below 408.6\N{NO-BREAK SPACE}Hz'
        in said[0]
    )
    assert not sensor_doubts(
        resolved,
        {"a1": Signal(vi.sensors.Sensor("a1", "pressure"), 0.1 * low + high, 0.0)},
        1e3,
        1e-3,
    )


def test_microphones_of_the_plates_modes_are_needed() -> None:
    response = vi.simulate(case(microphone=MICROPHONE, rate="10 kHz"))
    microphone = vi.sensors.Microphone()
    with pytest.raises(vi.InputError, match='have no paths of sound to a microphone "other"'):
        response.signals(vi.sensors.Sensor("other", "pressure", instrument=microphone))
    with pytest.raises(
        vi.InputError,
        match="are valid for 10000 samples per second at most; ask for a lower rate than 20000 Hz",
    ):
        response.signals(vi.sensors.Sensor("a1", "pressure", rate=20e3, instrument=microphone))
    slower = response.signals(vi.sensors.Sensor("a1", "pressure", rate=5e3, instrument=microphone))[
        "a1"
    ]
    assert slower.largest > 0.0


def test_a_free_plate_sounds_as_a_whole_too() -> None:
    """Far away its rigid rise is heard as its area."""
    case_of_free = dict(resolved_case(case(microphone={"distance": 50.0})))
    case_of_free["plate"] = {**case_of_free["plate"], "supports": "free"}
    case_of_free["drop"] = {"speed": 1.0, "gravity": 0.0}
    plate = vi.simulate(vi.case_of(case_of_free)).problem.plate
    assert plate.rigid is not None
    heard = plate.rigid.sounds["a1"].weights.sum(axis=1)
    rise = plate.rigid.participation[:, 2] / plate.rigid.mass
    np.testing.assert_allclose(
        heard, 0.52 * 0.42 / (2.0 * np.pi * 50.0) * rise, rtol=0.0, atol=1e-4 * np.abs(heard).max()
    )


@pytest.mark.parametrize(
    ("position", "message"),
    [
        (
            [0.0, 0.0],
            r'"a1"\.position: there is no support at \(0, 0\) m; there are: edge x-min '
            r"clamped; edge x-max clamped; edge y-min",
        ),
        (
            [0.26, 0.21],
            r"\(0\.26, 0\.21\) m is as near .* of edge x-max clamped and edge y-max "
            r"clamped; give a place",
        ),
    ],
)
def test_a_force_sensor_is_under_one_support(position: list[float], message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        check_meshes(case(instrument="force", position=position))
