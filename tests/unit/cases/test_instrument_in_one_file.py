"""An instrument is one file: with it a case has the instrument, its table, unit and signal."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import vibroimpact as vi
from vibroimpact.dynamics.sensors.instruments.registry import instruments

INSTRUMENT = '''
"""A laser vibrometer, which follows the velocity of a spot."""

from dataclasses import dataclass

from vibroimpact.contact.parameters import parameter
from vibroimpact.dynamics.sensors.instruments.instrument import InstrumentInCase


@dataclass(frozen=True)
class Vibrometer(InstrumentInCase):
    """A vibrometer: the velocity of a spot by its light."""

    name = "laser-vibrometer"
    noun = "a laser vibrometer"
    properties = "sensitivity of a laser vibrometer"
    measures = "velocity"
    subject = "motion"

    sensitivity: float = parameter("voltage over velocity", "V s/m", above=0, default=2.5)

    quantity = "voltage"
    order = 1
    sections = ()
    steepness = 0.0

    @property
    def gain(self):
        return self.sensitivity

    def components(self, direction):
        return direction
'''

USE = """
import sys

import numpy as np

import vibroimpact.dynamics.sensors.instruments as folder

folder.__path__.append(sys.argv[1])

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import case_schema
from vibroimpact.cases.sections.keys import find_quantity
from vibroimpact.cases.template import case_template
from vibroimpact.runs.setup import setup_rows

sensor = case_schema()["$defs"]["SensorSection"]["properties"]
assert "laser-vibrometer" in sensor["instrument"]["anyOf"][0]["enum"]
assert sensor["laser_vibrometer"]["description"] == "sensitivity of a laser vibrometer"
assert "# laser_vibrometer = " in case_template()

table = {
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {
        "material": "steel",
        "size": ["0.3 m", "0.2 m", "8 mm"],
        "model": "elastic",
        "supports": "clamped",
        "modes": 6,
        "mesh": {"element_size": "20 mm"},
    },
    "drop": {"speed": 1.0},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1, "duration": "2 ms"},
    "sensors": [
        {"name": "v1", "position": [0.05, 0.02], "quantity": "velocity"},
        {"name": "v2", "position": [0.05, 0.02], "instrument": "laser-vibrometer"},
        {"name": "v3", "position": [0.05, 0.02], "laser_vibrometer": {"sensitivity": "4 V s/m"}},
    ],
}
assert find_quantity(table, "sensors.v3.laser_vibrometer.sensitivity").unit == "V s/m"
case = vi.case_of(table)
resolved = resolved_case(case)["sensors"][2]
assert resolved["instrument"] == "laser-vibrometer", resolved
assert resolved["quantity"] == "voltage", resolved
assert resolved["laser_vibrometer"] == {"sensitivity": 4.0}, resolved
result = vi.result_of(vi.simulate(case))
motion, ideal, given = (result.signals[name].value for name in ("v1", "v2", "v3"))
assert np.abs(motion).max() > 0.0
np.testing.assert_allclose(ideal, 2.5 * motion, rtol=1e-12)
np.testing.assert_allclose(given, 4.0 * motion, rtol=1e-12)
description = dict(setup_rows(result))["Sensor v3"]
assert description.startswith("voltage by a laser vibrometer at "), description

try:
    vi.case_of({**table, "sensors": [{**table["sensors"][2], "geophone": {}}]})
except vi.InputError as error:
    print(error)
"""


@pytest.mark.slow
def test_an_instrument_is_one_file(tmp_path: Path) -> None:
    (tmp_path / "vibrometer.py").write_text(INSTRUMENT, encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-c", USE, str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert "geophone" in run.stdout


def test_python_has_all_instruments() -> None:
    names = {kind.__name__.removesuffix("InCase") for kind in instruments().values()}
    assert len(names) >= 5
    assert names <= set(vi.sensors.__all__)
