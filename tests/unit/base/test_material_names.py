"""Materials by the names that people have for them: the library tells which it knows."""

from __future__ import annotations

import pytest

import vibroimpact as vi
from support import plain_case

NAMES = {
    "pmma": "polymethylmethacrylate",
    "PMMA": "polymethylmethacrylate",
    "Plexiglas": "polymethylmethacrylate",
    "POM-C": "polyoxymethylene",
    "delrin": "polyoxymethylene",
    "PA 6.6": "nylon",
    "alu": "aluminium",
    "aluminum": "aluminium",
    "Ti6Al4V": "titanium-alloy",
    "stainless steel": "stainless-steel",
    "1.4301": "stainless-steel",
    "STEEL": "steel",
    "Al2O3": "alumina",
    "WC": "tungsten-carbide",
    "graniet": "granite",
    "100Cr6": "bearing-steel",
    "AISI 52100": "bearing-steel",
    "S355": "steel-s355",
    "16Mn": "steel-q345",
    "Q345": "steel-q345",
    "42CrMo4": "steel-42crmo4",
    "AISI 4140": "steel-42crmo4",
    "Hardox 450": "wear-resistant-steel",
    "6061-T6": "aluminium-6061-t6",
    "6082": "aluminium-6082-t6",
    "PA6": "polyamide-6",
    "PA66": "nylon",
    "rubber": "natural-rubber",
    "PU": "polyurethane",
    "FeS2": "pyrite",
}


@pytest.mark.parametrize("name", NAMES)
def test_another_name_leads_to_that_of_the_library(name: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(plain_case(sphere__material=name))
    assert str(raised.value).startswith(
        f'sphere.material: there is no material "{name}" in the library'
    )
    assert str(raised.value).endswith(f'Did you mean "{NAMES[name]}"?')


@pytest.mark.parametrize("name", ["PVC", "PTFE", "cork", "kryptonite"])
def test_what_the_library_does_not_have_can_be_given_by_numbers(name: str) -> None:
    with pytest.raises(vi.InputError, match="or give its numbers") as raised:
        vi.find_material(name)
    assert "Did you mean" not in str(raised.value)


def test_every_material_is_found_by_its_own_name_and_no_other_name_is_two_materials() -> None:
    from vibroimpact.materials import _library_file, _names_in_library, _plain

    assert all(vi.find_material(name).name == name for name in vi.materials.material_library())
    others = [
        _plain(other)
        for entry in _library_file().values()
        for other in entry.get("other_names", ())
    ]
    assert len(others) == len(set(others))
    assert not {_plain(name) for name in vi.materials.material_library()} & set(others)
    assert set(_names_in_library().values()) == set(vi.materials.material_library())
