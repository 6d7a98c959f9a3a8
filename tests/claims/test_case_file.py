"""Defaults and limits that the page of the case file states, read from a case and from
the limits that the program applies.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

import vibroimpact as vi
from stated_numbers import ROOT, says
from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.calibration.observed.section import CalibrateSection
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.elastic.chosen_modes import LEAST_MODES, MOST_MODES
from vibroimpact.cases.fields import elastic_body, quantities, size_limits
from vibroimpact.cases.limits.limit import limits
from vibroimpact.cases.rigid.expected import expected_of
from vibroimpact.cases.rigid.rigid_problem import touch_speed
from vibroimpact.cli import main
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS
from vibroimpact.materials import find_material
from vibroimpact.structures.recipe import Reduction
from vibroimpact.units.reading import to_si

PAGE = "docs/case-file.md"


@pytest.fixture(scope="module")
def blocks() -> list[str]:
    """The cases of the page."""
    return re.findall(
        r"^```toml\n(.*?)^```", (ROOT / PAGE).read_text(encoding="utf-8"), re.M | re.S
    )


def case_of(folder: Path, text: str, **changes: Any) -> vi.Case:
    file = folder / "case.toml"
    file.write_text(text, encoding="utf-8")
    return vi.load_case(file, changes)


def test_defaults_of_the_drop(tmp_path: Path, blocks: list[str]) -> None:
    problem, newton = (
        case_of(tmp_path, blocks[0].replace("gravity = 9.8\n", "")).to_problem(),
        vi.laws.find_contact_law("newton"),
    )
    says(PAGE, "| {} by default; 0 is allowed", problem.gravity)
    says(PAGE, "at the end of a contact: {} by default", problem.tolerance)
    says(PAGE, "or the motion of the plate is a table that ends; {} at most", MOST_IMPACTS)
    with pytest.raises(vi.InputError, match="impacts"):
        case_of(tmp_path, blocks[0], **{"run.impacts": MOST_IMPACTS + 1})
    bounced = vi.simulate(
        vi.Problem(
            sphere=vi.Body(1.0, 0.1),
            plate=vi.rigid_plate(),
            laws=(newton(restitution=0.5),),
            speed=2.0,
        )
    )
    says(PAGE, "but at least {} of the first approach speed", float(bounced.rest.speed[0]) / 2.0)
    says(
        PAGE,
        "with a [warning](limits.md) from {} % beyond them on",
        100.0 * (limits()["speeds_given"].threshold - 1.0),
    )
    air, water = vi.Air(), vi.Liquid()
    says(PAGE, "({} kg/m^3), ", air.density)
    says(PAGE, "({} Pa s), or a constant", air.viscosity)
    says(PAGE, "({} kg/m^3) and", water.density)
    says(PAGE, "({} Pa s); ", water.viscosity)


def test_hollow_balls(tmp_path: Path, blocks: list[str]) -> None:
    text = next(block for block in blocks if '"hollow"' in block)
    case = case_of(tmp_path, text)
    says(PAGE, "the mass over the volume, here {} kg/m^3", 0.0027 / (4.0 / 3.0 * math.pi * 0.02**3))
    says(
        PAGE,
        "with the drag of `air` alone, and at {} m/s in",
        touch_speed(in_air_as_liquid(tmp_path, text)),
    )
    says(PAGE, "this one touches at {} m/s with the drag", touch_speed(case))
    assert any("buoyancy" in doubt for doubt in doubts(resolved_case(case), expected_of(case)))
    says(PAGE, "its material by more than {} % is refused", 100.0 * elastic_body._ROUNDED)
    shell, solid = ({"sphere.inertia": word} for word in ("hollow", "solid"))
    for changes, part in ((shell, 3 / 5), (solid, 5 / 7)):
        rolling = case_of(
            tmp_path,
            text,
            **changes,
            **{
                "contact.friction": {"law": "coulomb", "coefficient": 5.0},
                "drop.air": False,
                "run.impacts": 1,
            },
        )
        left = vi.simulate(rolling).impacts["separation_velocity_x_m_s"][0]
        assert left == pytest.approx(part * 1.0, rel=1e-6)


def in_air_as_liquid(folder: Path, text: str) -> vi.Case:
    """Return the drop of the page in a liquid with the density and the viscosity of air."""
    air = vi.Air()
    liquid = {"density": air.density, "viscosity": air.viscosity}
    return case_of(folder, text.replace("air = true", ""), **{"contact.liquid": liquid})


@pytest.mark.parametrize(
    ("given", "is_allowed"), [(1e-13, True), (0.99e-13, False), (1e-6, True), (1.01e-6, False)]
)
def test_range_of_the_tolerance(
    tmp_path: Path, blocks: list[str], given: float, is_allowed: bool
) -> None:
    says(PAGE, "by default, {} to {}", 1e-13, 1e-6)
    changes = {"run.tolerance": given}
    if is_allowed:
        assert case_of(tmp_path, blocks[0], **changes).to_problem().tolerance == given
    else:
        with pytest.raises(vi.InputError, match="tolerance"):
            case_of(tmp_path, blocks[0], **changes)


def test_defaults_of_instruments() -> None:
    sensor = vi.sensors.Sensor("a", filter="butterworth")
    says(
        PAGE,
        "corner frequency of a Butterworth filter: {} of the rate",
        sensor.passed / sensor.rate,
    )
    says(PAGE, "({} by default), ", vi.sensors.Accelerometer(resonance=1e4).damping_ratio)
    says(PAGE, '"g" is standard gravity, {} m/s^2', to_si("1 g", "m/s^2"))
    says(
        PAGE,
        "({} by default), ",
        vi.sensors.Geophone(natural_frequency=10.0, sensitivity=28.0).damping_ratio,
    )


def test_default_of_a_confidence_level() -> None:
    says(
        PAGE,
        "confidence level of the intervals: {}",
        CalibrateSection.model_fields["confidence"].default,
    )


def test_default_of_a_margin() -> None:
    shape = plate_recipe(
        (0.52, 0.42, 0.008), find_material("steel-paper"), Reduction(modes=20)
    ).shape
    says(PAGE, "along edges and straight rims: {} thicknesses", shape.margin / 0.008)


def test_limits_of_size() -> None:
    """Each limit itself is tested in tests/unit/results/test_hostile_input.py."""
    most = size_limits
    says(
        PAGE,
        "files larger than {} MB, tables and lists nested more than {} deep",
        most.MOST_BYTES / 1e6,
        most.DEEPEST,
    )
    says(
        PAGE,
        "more than {} values, strings of more than {} characters",
        most.MOST_VALUES,
        most.LONGEST_TEXT,
    )
    says(
        PAGE,
        "and keys of more than {}, more than {} sensors or supports",
        most.LONGEST_KEY,
        most.MOST_ITEMS,
    )
    says(
        PAGE,
        "more than {} values of a parameter, integers beyond {} bits",
        most.MOST_OF_A_LIST,
        most.LARGEST_WHOLE.bit_length() + 1,
    )
    says(
        PAGE,
        "whose magnitude is smaller than {} or larger than {} in SI",
        quantities.SMALLEST,
        quantities.LARGEST,
    )
    says(PAGE, "Names are one line of at most {} printable characters", most.LONGEST_NAME)


@pytest.mark.parametrize(
    "changes",
    [{"contact.stiffness": 16176}, {"contact.damping_max": 180000}, {"run.duration": 0.001}],
)
def test_doubts_about_units(
    tmp_path: Path,
    blocks: list[str],
    changes: dict[str, float],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The page shows the warning as the case of its beginning gives it, with one value changed."""
    told = re.findall(r"^Warning: (.+)$", (ROOT / PAGE).read_text(encoding="utf-8"), re.M)
    ((key, value),) = changes.items()
    (tmp_path / "case.toml").write_text(blocks[0], encoding="utf-8")
    monkeypatch.setattr(
        "sys.argv",
        ["vibroimpact", "check", str(tmp_path / "case.toml"), "--set", f"{key}={value}", "--json"],
    )
    with pytest.raises(SystemExit):
        main()
    (shown,) = (line for line in told if line.startswith(f"{key}: "))
    assert shown.removesuffix(".") in json.loads(capsys.readouterr().out)["doubts"]


def test_how_many_modes_are_chosen() -> None:
    of_sphere, of_plate = MOST_MODES["sphere"], MOST_MODES["plate"]
    says(PAGE, "from {} to {} of a sphere and to {} of a plate", LEAST_MODES, of_sphere, of_plate)
    says(PAGE, "chooses the modes; {} by default", elastic_body.DEFAULT_ACCURACY)
    says(
        "docs/elastic-drops.md",
        "At least {} modes are taken, and at most {} of a sphere and {} of a plate",
        LEAST_MODES,
        of_sphere,
        of_plate,
    )
    accuracy = 100.0 * elastic_body.DEFAULT_ACCURACY
    says("docs/elastic-drops.md", "by less than `accuracy`, {} % by default", accuracy)
