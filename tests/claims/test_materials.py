"""What the library of materials says of the origin of its values."""

from __future__ import annotations

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
