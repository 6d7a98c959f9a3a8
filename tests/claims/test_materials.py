"""What the library of materials says of the origin of its values."""

from __future__ import annotations

import pytest

import vibroimpact as vi


def test_values_of_an_exercise_are_marked_as_such() -> None:
    library = vi.materials.material_library()
    given = {
        name
        for name, material in library.items()
        if any("exercise" in source for source in material.sources.values())
    }
    assert given == {"granite", "limestone", "sandstone-porous"}
    assert given == {
        name
        for name, material in library.items()
        if any("problem 2.4" in source for source in material.sources.values())
    }
    for name in given:
        assert "exercise" in library[name].description
        assert "given in an exercise of a textbook" in library[name].note


def test_strengths_of_the_library_are_plausible() -> None:
    for name, material in vi.materials.material_library().items():
        compressive = material.compressive_strength
        tensile = material.tensile_strength
        if material.yield_strength is not None and tensile is not None:
            assert material.yield_strength < tensile, name
        if compressive is not None and tensile is not None:
            assert 1.0 < compressive / tensile < 100.0, name
        if material.yield_strength is not None:
            assert 1e-4 < material.yield_strength / material.youngs_modulus < 0.05, name


@pytest.mark.parametrize(
    ("name", "vickers"),
    [("bearing-steel", 746), ("wear-resistant-steel", 473), ("steel-42crmo4", 340)],
)
def test_hardness_of_hardened_steels_is_near_their_yield_strength(name: str, vickers: int) -> None:
    """Tabor 1951: 2.8 times the flow stress, which is above the yield strength."""
    steel = vi.find_material(name)
    assert steel.hardness == pytest.approx(vickers * 9.80665e6, rel=3e-3)
    assert 1.0 < steel.hardness / 2.8 / steel.yield_strength < 2.0


def test_hardness_exceeds_the_yield_strength_of_softer_metals_more() -> None:
    for name, material in vi.materials.material_library().items():
        if material.hardness is not None and material.yield_strength is not None:
            assert 2.8 < material.hardness / material.yield_strength < 8.4, name


def test_numbers_of_other_units_are_converted_right() -> None:
    """Of the sources in pounds, inches and kilograms-force."""
    psi = 6894.757
    ball = vi.find_material("bearing-steel")
    assert ball.density == pytest.approx(0.283 * 27679.905, rel=1e-3)
    assert ball.youngs_modulus == pytest.approx(29.5e6 * psi, rel=3e-3)
    assert ball.yield_strength == pytest.approx(295e3 * psi, rel=3e-3)
    polyamide = vi.find_material("polyamide-6")
    assert polyamide.youngs_modulus == pytest.approx(400e3 * psi, rel=2e-3)
    assert polyamide.yield_strength == pytest.approx(12e3 * psi, rel=2e-3)
    acrylic = vi.find_material("polymethylmethacrylate")
    assert acrylic.compressive_strength == pytest.approx(13.7e3 * psi, rel=2e-3)
    assert acrylic.tensile_strength == pytest.approx(8.8e3 * psi, rel=2e-3)
    nitride = vi.find_material("silicon-nitride")
    assert nitride.hardness == pytest.approx(1580 * 9.80665e6, rel=2e-3)


@pytest.mark.parametrize(
    ("name", "bulk", "shear"), [("sandy-mudstone", 18.9e9, 9.73e9), ("pyrite", 142.7e9, 125.7e9)]
)
def test_moduli_worked_out_from_bulk_and_shear_modulus(
    name: str, bulk: float, shear: float
) -> None:
    material = vi.find_material(name)
    youngs_modulus = 9.0 * bulk * shear / (3.0 * bulk + shear)
    assert material.youngs_modulus == pytest.approx(youngs_modulus, rel=2e-3)
    assert material.poissons_ratio == pytest.approx(0.5 * youngs_modulus / shear - 1.0, abs=5e-3)


@pytest.mark.parametrize(
    ("name", "bulk"), [("natural-rubber", 1.15e9), ("polyurethane", 2e9), ("polyamide-6", 4.4e9)]
)
def test_poissons_ratio_worked_out_from_the_bulk_modulus(name: str, bulk: float) -> None:
    material = vi.find_material(name)
    poissons_ratio = 0.5 - material.youngs_modulus / (6.0 * bulk)
    assert material.poissons_ratio == pytest.approx(poissons_ratio, abs=5e-3)


def test_alloys_have_a_yield_strength_and_aluminium_in_general_has_none() -> None:
    assert vi.find_material("aluminium").yield_strength is None
    assert "aluminium-6082-t6" in vi.find_material("aluminium").note
