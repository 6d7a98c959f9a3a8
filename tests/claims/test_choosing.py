"""Numbers of the guide on the choice of a law, a treatment and a number of modes."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import ROOT, says
from vibroimpact.cases.validity.modes_left_out import _TRUNCATED
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.meyer import Meyer
from vibroimpact.contact.laws.storakers import Storakers
from vibroimpact.contact.pair import effective_modulus

PAGE = "docs/guides/choosing.md"
TEXT = (ROOT / PAGE).read_text(encoding="utf-8")
RIGID = {"material": "steel"}


@cache
def drop(modes: int | None, finite_sphere: bool = False) -> vi.Response:
    """Return the drop of the page on a plate with so many modes; None: rigid."""
    block = re.search(r"```toml\n(.*?)```", TEXT, flags=re.S)
    assert block
    case: dict[str, Any] = tomllib.loads(block[1])
    case["plate"] = RIGID if modes is None else case["plate"] | {"modes": modes}
    case["contact"]["finite_sphere"] = finite_sphere
    return vi.simulate(vi.case_of(case))


def first(response: vi.Response, column: str) -> float:
    return float(response.impacts[column][0])


@pytest.mark.slow
def test_treatments() -> None:
    def row(response: vi.Response) -> tuple[float, float, float]:
        return (
            first(response, "max_force_N"),
            1e6 * first(response, "duration_s"),
            first(response, "restitution_achieved"),
        )

    says(PAGE, "| rigid | {} | {} | {} |", *row(drop(None)))
    quasi_static, elastic = row(drop(None, finite_sphere=True)), row(drop(150))
    says(
        PAGE,
        "| {} | {} | {} | | elastic plate, 150 modes | {} | {} | {} |",
        *quasi_static,
        *elastic,
    )


@pytest.mark.slow
def test_nothing_yields() -> None:
    for response in (drop(None), drop(None, finite_sphere=True), drop(150)):
        assert not any(
            "yield" in doubt or "strength" in doubt for doubt in vi.result_of(response).doubts
        )


@pytest.mark.slow
def test_numbers_of_modes() -> None:
    def row(modes: int) -> tuple[float, float, float]:
        response = drop(modes)
        return (
            first(response, "max_force_N"),
            first(response, "restitution_achieved"),
            100 * response.truncation["plate"],
        )

    says(PAGE, "| 10 | {} | {} | {} % |", *row(10))
    says(PAGE, "| 40 | {} | {} | {} % |", *row(40))
    says(PAGE, "| 150 | {} | {} | {} % |", *row(150))
    says(PAGE, "gives a warning above {} %", 100 * _TRUNCATED)


def test_steel_yields_early() -> None:
    steel, radius = vi.find_material("steel"), 0.02
    mass = 4 / 3 * pi * radius**3 * steel.density

    def speed(strength: float) -> float:
        law = Meyer(
            effective_modulus=effective_modulus(steel, steel),
            effective_radius=radius,
            yield_strength=strength,
        )
        return float(sqrt(0.8 * law.stiffness * law.yield_indentation**2.5 / mass))

    mild = steel.yield_strength
    assert mild is not None
    says(
        PAGE,
        "yields from {} mm/s on if it is mild, of {} MPa, and from {} m/s on if "
        "it is hard, of 1 GPa",
        1e3 * speed(mild),
        1e-6 * mild,
        speed(1e9),
    )


def test_laws_that_dent() -> None:
    """Those that the page names are those whose dent lasts, in the order in which the
    program of the page finds them.
    """
    denting = [
        name
        for name, law in vi.laws.contact_laws().items()
        if issubclass(law, CompliantLaw) and law.lasting
    ]
    assert f"# laws that leave a dent: {', '.join(denting)}" in TEXT
    rows = [line.split("|") for line in TEXT.splitlines() if "a dent remains" in line]
    assert sorted(re.findall(r"`([a-z-]+)`", "".join(row[2] for row in rows))) == sorted(denting)


def test_restitutions_that_fall_with_the_speed() -> None:
    speed = np.array([1e5, 1e6])

    def power(law: vi.laws.ContactLaw, loss: bool = False) -> float:
        found = vi.laws.achieved_restitution(law, 0.01, speed if not loss else 1e-11 * speed)
        found = 1.0 - found if loss else found
        return float(np.log10(found[1] / found[0]))

    viscous = vi.laws.find_contact_law("kuwabara-kono")(stiffness=1e8, dissipation_time=1e-6)
    assert power(viscous, loss=True) == pytest.approx(1 / 5, abs=0.01)
    plastic = vi.laws.find_contact_law("thornton")(
        effective_modulus=1e11, effective_radius=0.01, yield_pressure=1e9
    )
    assert power(plastic) == pytest.approx(-1 / 4, abs=0.01)
    hardening = Storakers(
        effective_modulus=1e11, effective_radius=0.01, yield_strength=1e8, hardening_exponent=5.0
    )
    assert -0.24 < power(hardening) < -0.15
