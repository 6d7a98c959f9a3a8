"""What the page on drops of elastic bodies says of forces, restitutions and filters."""

from __future__ import annotations

import math
import runpy
from dataclasses import replace
from functools import cache
from unittest import mock

import matplotlib.pyplot  # noqa: F401  before what it copies from is replaced
import numpy as np
import pytest
from matplotlib.figure import Figure

import vibroimpact as vi
from oracles.three_dimensional_plate import PMMA, STEEL, Plate, drop
from stated_numbers import ROOT, says
from support import plain_case
from vibroimpact.cases import sensor_doubts
from vibroimpact.cases.fields.size_limits import MOST_ITEMS
from vibroimpact.cases.validity import modes_left_out, plate_mesh, plate_waves, small_contact
from vibroimpact.dynamics.sensors import antialias
from vibroimpact.dynamics.vibrating import drop_at_start
from vibroimpact.structures.plate_waves import bending_factor
from vibroimpact.structures.sphere_compliance import finite_sphere_factor

PAGE = "docs/elastic-drops.md"

FORCE, DURATION, RESTITUTION, SPEED = 12166.0, 246.45e-6, 0.99906, 8.826664
"""Of full finite elements: of tests/verification/test_vs_axisymmetric_contact.py."""


@cache
def on_a_rigid_plane(modes: int = 0, finite: bool = False) -> tuple[float, float, float]:
    """Return largest force [N], duration [us] and restitution of the paper's rock;
    without modes it is rigid.
    """
    case = plain_case(
        plate={"material": "rigid"}, drop={"speed": SPEED, "gravity": 9.8}, run={"impacts": 1}
    )
    sphere = {"radius": 0.025, "material": "rock-paper"} | (
        {"model": "elastic", "modes": modes} if modes else {}
    )
    contact = {"law": "hertz"} | ({"finite_sphere": True} if finite else {})
    impacts = vi.simulate(vi.case_of({**case, "sphere": sphere, "contact": contact})).impacts
    return (
        float(impacts["max_force_N"][0]),
        1e6 * float(impacts["duration_s"][0]),
        float(impacts["restitution_achieved"][0]),
    )


def beside(found: tuple[float, float, float]) -> tuple[float, float, float, float]:
    """Return force [N] and duration [us] with their deviations [%] from the finite elements."""
    force, duration, _ = found
    return (
        force,
        100.0 * (force / FORCE - 1.0),
        duration,
        100.0 * (1e-6 * duration / DURATION - 1.0),
    )


def test_the_sphere_on_a_rigid_plane() -> None:
    says(PAGE, "at {} m/s, undamped, small strain", SPEED)
    says(
        PAGE,
        "two codes of the authors | {} +- 8 | {} +- 0.1 | {} |",
        FORCE,
        1e6 * DURATION,
        RESTITUTION,
    )
    says(
        PAGE,
        "10 modes | {} ({} %) | {} ({} %) | {} |",
        *beside(on_a_rigid_plane(10)),
        on_a_rigid_plane(10)[2],
    )
    says(
        PAGE,
        "60 modes | {} ({} %) | {} ({} %) | {} |",
        *beside(on_a_rigid_plane(60)),
        on_a_rigid_plane(60)[2],
    )
    says(
        PAGE,
        "Hertz's law alone (rigid sphere) | {} ({} %) | {} ({} %) |",
        *beside(on_a_rigid_plane()),
    )
    says(PAGE, ") | {} ({} %) | {} ({} %) | 1 |", *beside(on_a_rigid_plane(finite=True)))


def test_correction_of_the_half_space() -> None:
    ratios = (0.04, 0.18)
    says(
        PAGE,
        "For {} it is {} to {} for contact radii of {} to {} radii",
        0.28,
        *finite_sphere_factor(0.28, list(ratios)),
        *ratios,
    )


def test_the_face_of_a_plate() -> None:
    waves = 2.0 * np.pi / np.array([6.0, 2.0])  # wave number times thickness
    says(PAGE, "for steel {} at six thicknesses, {} at two", *bending_factor(waves, 0.3))


@pytest.mark.slow
def test_two_drops_a_nanometre_apart() -> None:
    """Of examples/a_nanometre.py, which draws nothing here; and with damping."""
    with mock.patch.object(Figure, "savefig"):
        shown = runpy.run_path(str(ROOT / "examples" / "a_nanometre.py"))
    apart = shown["apart"]
    assert apart[0] < 1e-9
    says(PAGE, "which grows from less than {} to some per cent in four impacts", 1e-9)
    assert 0.01 < apart[3] < 0.2
    assert apart[4:].min() > 0.05
    says(PAGE, "(how much depends on rounding) and by more than {} % from the fifth on", 5.0)
    case = {**shown["case"], "plate": {**shown["case"]["plate"], "damping": 0.01}}
    problem = vi.case_of(case).to_problem()
    first, second = (
        vi.simulate(replace(problem, height=height)).impacts["max_force_N"]
        for height in (1.0, 1.0 + 1e-9)
    )
    assert len(first) == 6
    assert np.abs(second / first - 1.0).max() < 1e-8
    says(
        PAGE,
        "with {} % in every mode a change of {} in the example stays below {} for all six impacts",
        1.0,
        1e-9,
        1e-8,
    )


def test_sensitivity_of_a_rigid_drop() -> None:
    """The relative change of the largest force, the largest of all, per relative change
    of the height.
    """

    def force(height: float) -> float:
        case = plain_case(drop={"height": height}, contact={"law": "hertz"}, run={"impacts": 1})
        return float(vi.simulate(vi.case_of(case)).impacts["max_force_N"][0])

    low, high = 4.0, 4.04
    says(
        PAGE,
        "For a rigid drop from a height by Hertz's law it would be {}",
        math.log(force(high) / force(low)) / math.log(high / low),
    )


@pytest.mark.slow
def test_restitutions_of_three_dimensional_elasticity() -> None:
    def exact(side: float, plate: object, radius: float) -> float:
        return drop(
            Plate((side, 0.9 * side, 0.01), plate, (0.013, 0.007)), radius, STEEL, 1.0, times=3.0
        ).restitution

    says(
        PAGE,
        "the restitutions themselves are from {} to {}",
        exact(0.2, PMMA, 0.01),
        exact(0.12, STEEL, 0.003),
    )


@pytest.mark.slow
def test_type_3_predicted_from_type_2() -> None:
    problem = vi.load_case("paper:type3-identified").to_problem()
    stiffness, damping = problem.local_element
    says(PAGE, "(k = {} N/m, c = {} N s/m)", stiffness, damping)
    response = vi.simulate(replace(problem, impacts=1))
    history = response.history()

    def most(name: str, printed: float) -> tuple[float, float, float]:
        found = (
            response.impacts[name][0] if name in response.impacts else np.abs(history[name]).max()
        )
        return printed, float(found), 100.0 * (float(found) / printed - 1.0)

    says(PAGE, "| largest force [N] | {} | {} | {} % |", *most("max_force_N", 3680.223))
    says(PAGE, "| rebound [m] | {} | {} | {} % |", *most("rebound_height_m", 0.18278))
    says(PAGE, "displacement [m] | {} | {} | {} % |", *most("plate_displacement_m", 1e-4))
    says(PAGE, "| velocity [m/s] | {} | {} | {} % |", *most("plate_velocity_m_s", 0.1))
    says(PAGE, "| acceleration [m/s^2] | {} | {} | {} % |", *most("plate_acceleration_m_s2", 200.0))
    says(PAGE, "| largest strain energy [J] | {} | {} | {} % |", *most("plate_strain_J", 0.13225))
    says(PAGE, "| largest kinetic energy [J] | {} | {} | {} % |", *most("plate_kinetic_J", 0.29412))


def test_filters() -> None:
    length = antialias.HALF_LENGTH
    says(PAGE, "{} samples long; its delay of {} samples is removed", 2 * length, length)

    def decibels(part: float) -> float:
        """Butterworth's attenuation at a part of the rate, of order eight with the corner
        at 0.4.
        """
        return 10.0 * math.log10(1.0 + (part / 0.4) ** 16)

    assert decibels(0.3) < 0.05
    says(PAGE, "{} of the rate by default", 0.4)
    says(PAGE, "{} of the rate by {} dB, {} by {} dB", 0.6, decibels(0.6), 0.8, decibels(0.8))


def test_thresholds_of_doubts() -> None:
    says(PAGE, "or if the estimate exceeds {} %", 100.0 * modes_left_out._TRUNCATED)
    says(
        PAGE,
        "right within a third. Above {} % a warning is given",
        100.0 * plate_waves.LIMITS[0].threshold,
    )
    says(
        PAGE,
        "Above {} % a warning is given, with a smaller element size",
        100.0 * plate_mesh.LIMITS[0].threshold,
    )
    says(PAGE, "(more than {} % of the rms value", 100.0 * sensor_doubts._DOUBTED_ERROR)
    says(PAGE, "contact radii up to about {} radii", small_contact.LIMITS[0].threshold)


def test_constants() -> None:
    says(PAGE, "a ride is integrated for {} steps", drop_at_start.MOST_STEPS)
    says(PAGE, "Sensors may be at up to {} points of the plate", MOST_ITEMS)
