"""Numbers of the guide on the damping of Adams' IMPACT."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

import pytest

import vibroimpact as vi
from stated_numbers import says
from support import blocks, example
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import numbers_of
from vibroimpact.cli import main

PAGE = "docs/guides/adams-damping.md"
MILD = {
    "sphere": {"radius": "20 mm", "material": "steel"},
    "plate": {"material": "steel"},
    "drop": {"height": "0.5 m"},
    "run": {"impacts": 1},
}
"""The same ball and plate of structural steel, and the height that the page says."""


def first(response: vi.Response, column: str) -> float:
    return float(response.impacts[column][0])


def test_the_ball() -> None:
    found, response = example("pictures_of_guides").found_for_adams()
    assert found.doubts == () == tuple(vi.result_of(response).doubts)
    says(
        PAGE,
        "The restitution is {} at {} m/s.",
        first(response, "restitution_achieved"),
        first(response, "approach_speed_m_s"),
    )
    says(
        PAGE,
        "the interval of the damping: {} to {} N s/mm at {} %",
        *(1e-3 * found.intervals[0]),
        100 * found.confidence,
    )
    says(PAGE, "the ball indents by {} mm", 1e3 * first(response, "max_indentation_m"))
    says(
        PAGE,
        "with the calibrated values {} and more",
        min(achieved(response.problem.laws[0], response)),
    )


def achieved(law: vi.laws.ContactLaw, response: vi.Response) -> list[float]:
    """The restitution of the ball over the speeds of the figure."""
    mass = float(response.problem.sphere.mass)
    return [
        float(vi.laws.achieved_restitution(law, mass=mass, speed=speed))
        for speed in (0.1, 0.3, 0.767, 3.0, 10.0)
    ]


def test_the_defaults_of_the_dialog() -> None:
    pictures = example("pictures_of_guides")
    defaults = vi.laws.find_contact_law("adams-impact")(**pictures.DIALOG)
    law, (_, response) = pictures.DIALOG, pictures.found_for_adams()
    says(
        PAGE,
        "({}e5 N/mm^2.2, {}, {} N s/mm, {} mm) this ball has a restitution of {}",
        law["stiffness"] / 1000 ** law["exponent"] / 1e5,
        law["exponent"],
        1e-3 * law["damping_max"],
        1e3 * law["full_damping_penetration"],
        float(
            vi.laws.achieved_restitution(
                defaults,
                mass=float(response.problem.sphere.mass),
                speed=first(response, "approach_speed_m_s"),
            )
        ),
    )
    faster = float(
        vi.laws.achieved_restitution(defaults, mass=float(response.problem.sphere.mass), speed=3.0)
    )
    says(PAGE, "and of {} at 3 m/s", faster)
    says(
        PAGE,
        "with the dialog's defaults below {} everywhere",
        round(max(achieved(defaults, response)) + 0.05, 1),
    )
    part = float(vi.laws.achieved_restitution(defaults, mass=1.0, speed=1.0))
    says(PAGE, "a mass of 1 kg has {} at 1 m/s", part)
    says(PAGE, "speed=1.0) # {}", part)


@cache
def rock() -> vi.calibration.Calibration:
    return vi.calibration.calibrate(
        vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory")
    )


def off(column: str, way: str) -> list[float]:
    """Relative difference of each impact from the target [%]."""
    return [
        100.0 * float(part)
        for part in rock().drops[way][column] / rock().drops["target"][column] - 1.0
    ]


def test_the_rock() -> None:
    says(
        PAGE,
        "With the first throughout, the fifth rebound is {} % too low",
        -off("rebound_height_m", "constant")[4],
    )
    forces = off("max_force_N", "variable")
    says(
        PAGE,
        "for the rock it is {} to {} % below that of the target law",
        -max(forces),
        -min(forces),
    )
    says(
        PAGE,
        '"N/mm^1.5") # {}',
        vi.units.convert_units(float(rock().problem.laws[0].stiffness), "N/m^1.5", "N/mm^1.5"),
    )


def test_steel_that_yields() -> None:
    yields = vi.simulate(vi.case_of({**MILD, "contact": {"law": "meyer"}}))
    says(
        PAGE,
        "gives a restitution of {} there and {} kN",
        first(yields, "restitution_achieved"),
        1e-3 * first(yields, "max_force_N"),
    )
    table = {
        **MILD,
        "contact": {"law": "adams-impact"},
        "calibrate": {"target": {"rebound_heights": ["0.337 m"]}},
    }
    question = vi.calibration.calibration_of(table)
    found = vi.calibration.calibrate_case(question)
    response = vi.simulate(found.calibrated_case)
    assert any("(steel) yields" in doubt for doubt in found.doubts)
    says(
        PAGE,
        "calibrated to a rebound of 0.337 m all the same, a restitution of {}",
        first(response, "restitution_achieved"),
    )
    says(PAGE, "the {} kN that IMPACT then gives", 1e-3 * first(response, "max_force_N"))
    result = vi.result_of(response)
    says(
        PAGE,
        "from {} m, have {} times the pressure of first yield",
        0.5,
        float(numbers_of(Conditions(result.case, result._drop_summary))["plate_strength"]),
    )
    says(
        PAGE,
        "Structural steel ({} MPa)",
        1e-6 * float(vi.find_material("steel").yield_strength or 0.0),
    )


@pytest.mark.slow
def test_what_the_commands_print(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The tables of the page, line by line."""

    def printed(*words: str) -> list[str]:
        monkeypatch.setattr(sys, "argv", ["vibroimpact", *words])
        with pytest.raises(SystemExit) as left:
            main()
        assert not left.value.code
        return [line.rstrip() for line in capsys.readouterr().out.splitlines()]

    monkeypatch.chdir(tmp_path)
    Path("ball.toml").write_text(blocks(PAGE, "toml")[0], encoding="utf-8")
    ball, rocks, nylon, mild = blocks(PAGE, "text")
    for lines in (
        printed("calibrate", "ball.toml", "-o", "ball"),
        printed("export", "ball", "--to", "adams", "-o", "ball-adams"),
    ):
        assert [line for line in ball.splitlines() if line.rstrip() not in lines] == []
    lines = printed("calibrate", "paper:calibration", "-o", "rock")
    assert [line for line in rocks.splitlines() if line.rstrip() not in lines] == []
    for text in blocks(PAGE, "toml")[1:]:
        Path(text.splitlines()[0].removeprefix("# ")).write_text(text, encoding="utf-8")
    printed("run", "nylon.toml", "-o", "nylon")
    printed("run", "mild.toml", "-o", "mild")
    match = ("--to", "adams", "--match")
    for lines, table in (
        (printed("export", "nylon", *match, "rebound", "-o", "rigid"), nylon),
        (printed("export", "mild", *match, "rebound", "-o", "mild-adams"), mild),
    ):
        assert [line for line in table.splitlines() if line.rstrip() not in lines] == []
    (row,) = (
        line
        for line in printed("export", "nylon", *match, "contact", "-o", "flexible")
        if line.startswith(" every impact")
    )
    says(PAGE, "and the second a damping of {} N s/mm", float(row.split()[4]))
    estimate = vi.load_result("mild").impacts
    says(
        PAGE,
        "The law gives a restitution of {} at {} m/s",
        float(estimate["restitution_achieved"][0]),
        float(estimate["approach_speed_m_s"][0]),
    )


def test_the_hardness_of_structural_steel() -> None:
    says(
        PAGE,
        "of a hardness of {} HV",
        2.8 * float(vi.find_material("steel").yield_strength or 0.0) / 9.80665e6,
    )
