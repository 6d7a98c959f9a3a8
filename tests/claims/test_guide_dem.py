"""Numbers of the guide on restitution in discrete-element codes."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import says
from support import blocks, example, names_of_page
from vibroimpact.cases.validity.relaxation import LIMITS as RELAXATION
from vibroimpact.cases.validity.strength import demands
from vibroimpact.cli import main
from vibroimpact.contact.kelvin_voigt import (
    damping_ratio_from_restitution,
    restitution_from_damping_ratio,
)
from vibroimpact.exporting.yade_damping import ClippedTsuji

PAGE = "docs/guides/restitution-in-dem.md"
ASKED = (0.9, 0.7, 0.5)


def achieved(name: str) -> list[float]:
    return [example("pictures_of_guides").restitution_of(name, asked) for asked in ASKED]


def test_laws() -> None:
    assert achieved("linear-spring-dashpot") == pytest.approx(achieved("tsuji"), abs=1e-6)
    says(PAGE, "| linear-spring-dashpot, tsuji | {} | {} | {} |", *achieved("tsuji"))
    says(PAGE, "| flores | {} | {} | {} |", *achieved("flores"))
    says(PAGE, "| gonthier | {} | {} | {} |", *achieved("gonthier"))
    says(PAGE, "| herbert-mcwhannell | {} | {} | {} |", *achieved("herbert-mcwhannell"))
    says(PAGE, "| hunt-crossley | {} | {} | {} |", *achieved("hunt-crossley"))
    says(PAGE, "| lankarani-nikravesh | {} | {} | {} |", *achieved("lankarani-nikravesh"))
    says(PAGE, "| lee-wang | {} | {} | {} |", *achieved("lee-wang"))


def test_program_of_the_page() -> None:
    law = names_of_page(PAGE)["law"]
    says(
        PAGE,
        "vi.laws.achieved_restitution(law, mass=0.1, speed=1.0) # {}",
        float(vi.laws.achieved_restitution(law, mass=0.1, speed=1.0)),
    )
    asked = vi.laws.law_achieving(law, 0.7, mass=0.1, speed=1.0)
    says(PAGE, "# {} achieves 0.7", float(asked.restitution))


def test_steps() -> None:
    names = names_of_page(PAGE)

    def errors(asked: float) -> list[float]:
        law = vi.laws.find_contact_law("tsuji")(
            stiffness=1e8, restitution=asked, effective_mass=0.1
        )
        return [
            names["restitution_in_steps"](law, 0.1, 1.0, steps) - asked
            for steps in (10, 20, 50, 100)
        ]

    nearly, half = errors(0.9), errors(0.5)
    says(PAGE, "| error of 0.9 | {} | {} | {} | {} |", *nearly)
    says(PAGE, "| error of 0.5 | {} | {} | {} | {} |", *half)
    says(
        PAGE,
        "with 50 steps in the *shortest* contact the restitution is accurate to {}",
        max(nearly[2], half[2]),
    )


def test_dashpots() -> None:
    """Of the sizes and speeds of the table; it scales as the page says."""
    names = names_of_page(PAGE)
    mass, speed = names["mass"] * names["each"], names["speed"] * names["each"]
    damping = vi.laws.law_achieving(names["dashpot"], 0.9, mass=mass, speed=speed).damping_max
    says(PAGE, "| radius | {} m/s | {} m/s | {} m/s | {} m/s |", *names["speed"][0])
    says(PAGE, "| 0.5 mm | {} | {} | {} | {} |", *damping[0])
    says(PAGE, "| 1 mm | {} | {} | {} | {} |", *damping[1])
    says(PAGE, "| 2 mm | {} | {} | {} | {} |", *damping[2])
    says(PAGE, "| 5 mm | {} | {} | {} | {} |", *damping[3])
    scale = names["radius"] ** 2 * names["speed"] ** 0.2
    assert damping / scale == pytest.approx(float(damping[0, 0] / scale[0, 0]), rel=1e-3)


def test_viscoelastic_grains() -> None:
    names = names_of_page(PAGE)
    mass, speed = names["mass"] * names["each"], names["speed"] * names["each"]
    law = vi.laws.find_contact_law("kuwabara-kono")(
        stiffness=names["dashpot"].stiffness, dissipation_time=0.2e-6
    )
    found = vi.laws.achieved_restitution(law, mass=mass, speed=speed)
    assert (found.min(), found.max()) == (found[0, -1], found[-1, 0])
    says(
        PAGE,
        "a dissipation time of 0.2 µs the restitution of the same grains ranges from {} "
        "(0.5 mm, 1 m/s) to {} (5 mm, 0.03 m/s)",
        found[0, -1],
        found[-1, 0],
    )
    hertz = vi.laws.find_contact_law("hertz")(stiffness=float(law.stiffness[0, -1]))
    body = vi.Body(mass=float(mass[0, -1]), contact_offset=1e-3)
    alone = vi.Problem(
        sphere=body, plate=vi.rigid_plate(), laws=(hertz,), speed=1.0, gravity=0.0, impacts=1
    )
    (limit,) = RELAXATION
    assert 0.2e-6 / float(vi.simulate(alone).impacts["duration_s"][0]) < limit.threshold


def test_glass_is_within_its_strength() -> None:
    names = names_of_page(PAGE)
    stiffness, radius = names["dashpot"].stiffness[:, -1], 0.5 * names["radius"][:, 0]
    depth = (1.25 * names["mass"][:, 0] * 1.0**2 / stiffness) ** 0.4
    pressure = 1.5 * stiffness * depth**1.5 / (np.pi * radius * depth)
    assert pressure == pytest.approx(pressure[0])
    glass = demands(names["glass"], float(pressure[0]))
    crushed, torn = (
        glass[name][0] / glass[name][1] for name in ("compressive_strength", "tensile_strength")
    )
    says(PAGE, "At 1 m/s Hertz's pressure is {} of that at which glass is crushed", crushed)
    says(
        PAGE, "the tension beside the contact is {} times the tensile strength of float glass", torn
    )


def test_exported_line(tmp_path: Path) -> None:
    """The line that the page shows is in the exported file."""
    vi.simulate(vi.load_case("paper:type1-constant")).save(tmp_path / "run")
    (script,) = vi.exporting.export_result(tmp_path / "run", "lammps", tmp_path / "rock.in")
    shown = " ".join(blocks(PAGE, "text")[0].removesuffix("...\n").split())
    assert shown in " ".join(script.read_text(encoding="utf-8").split())


def test_what_is_typed(
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
    Path("grain.toml").write_text(blocks(PAGE, "toml")[0], encoding="utf-8")
    printed("run", "grain.toml", "-o", "grain")
    lines = printed("export", "grain", "--to", "dem", "-o", "grain-dem")
    _, typed, softened = blocks(PAGE, "text")
    shown = [*typed.splitlines(), *softened.splitlines()]
    assert [line for line in shown if line.rstrip() not in lines] == []


def test_restitutions_of_programs() -> None:
    half = float(damping_ratio_from_restitution(0.5))
    mfix = float(restitution_from_damping_ratio(2.0 / np.sqrt(5.0) * half))
    says(PAGE, "2/√5 = {} of that, so that 0.5 typed gives {}", 2.0 / np.sqrt(5.0), mfix)
    clipped = ClippedTsuji(stiffness=1e8, restitution=0.5, effective_mass=0.1)
    says(
        PAGE,
        "never pulls either, and then rebounds with {} where 0.5 is typed",
        float(vi.laws.achieved_restitution(clipped, mass=0.1, speed=1.0)),
    )
