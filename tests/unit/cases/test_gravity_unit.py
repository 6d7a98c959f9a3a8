""" "g" is standard gravity where an acceleration is wanted, as in the data sheets of
accelerometers, and the gram where a mass is.
"""

from __future__ import annotations

from io import StringIO
from typing import Any

import pytest
from rich.console import Console
from scipy.constants import g as standard_gravity

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.case import case_schema
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.units.reading import to_si


@pytest.mark.parametrize(
    ("text", "times"),
    [
        ("500 g", 500.0),
        ("500 g0", 500.0),
        ("2 mg", 2e-3),
        ("3 ug", 3e-6),
        ("3 µg", 3e-6),
        ("1 gravity", 1.0),
    ],
)
def test_of_an_acceleration(text: str, times: float) -> None:
    assert to_si(text, "m/s^2") == pytest.approx(times * standard_gravity, rel=1e-14)


def test_of_anything_else_it_is_the_gram() -> None:
    assert to_si("90 g", "kg") == pytest.approx(0.09)
    assert to_si("1.38 g/cm^3", "kg/m^3") == pytest.approx(1380.0)
    with pytest.raises(vi.InputError, match='"90 g" is a mass; expected a length'):
        to_si("90 g", "m")
    with pytest.raises(vi.InputError, match='"1 kg" is a mass; expected an acceleration'):
        to_si("1 kg", "m/s^2")


def test_check_and_schema_say_which() -> None:
    sensor: dict[str, Any] = {
        "name": "a1",
        "position": [0.1, 0.05],
        "accelerometer": {"range": "500 g"},
    }
    plate = {
        "size": [0.52, 0.42, 0.008],
        "material": "steel",
        "model": "elastic",
        "modes": 5,
        "supports": "clamped",
    }
    case = vi.case_of(plain_case(plate=plate, sensors=[sensor]))
    assert case.sensors[0].accelerometer is not None
    assert case.sensors[0].accelerometer.range == pytest.approx(4903.325)
    written = StringIO()
    Console(file=written, width=300).print(case_explained(case))
    assert "range 4903.32 m/s2, 500 times standard gravity" in written.getvalue()
    described = case_schema()["$defs"]["AccelerometerTable"]["properties"]["range"]
    assert '"g" is standard gravity, 9.80665 m/s^2' in str(described)
