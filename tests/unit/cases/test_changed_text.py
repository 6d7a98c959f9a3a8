"""Other values in the text of a case: it says what the changed case says, and all else
stays as it was written.
"""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.cases.changed_text import changed_text
from vibroimpact.cases.reader import case_text
from vibroimpact.cases.sections.keys import with_values

CHANGES: list[dict[str, Any]] = [
    {"name": 'a "name" # of [mine]\twith \\ and é'},
    {"sphere.radius": "30 mm", "drop.height": 2.0, "run.impacts": 3},
    {"plate.size": [1, "2 m", "9 mm"], "drop.position.y": "1 cm"},
    {
        "sphere.material.density": 1500,
        "plate.material": {"density": 1e3, "youngs_modulus": "1 GPa", "poissons_ratio": 0.3},
    },
    {"plate.supports": [{"type": "point", "position": [0.1, "5 cm"]}], "drop.same_spot": False},
    {"contact": {"law": "newton", "restitution": 0.5}},
    {"sensors": [{"name": "a # b", "position": [0.0, 0.0], "rate": "20 kHz"}]},
    {"calibrate.target.restitution": 0.7, "calibrate.degree": 1},
]


@pytest.mark.parametrize("name", vi.shipped_cases())
@pytest.mark.parametrize("changes", CHANGES, ids=lambda changes: next(iter(changes)))
def test_the_text_says_what_the_changed_case_says(name: str, changes: dict[str, Any]) -> None:
    text = case_text(name)
    assert tomllib.loads(changed_text(text, changes)) == with_values(tomllib.loads(text), changes)


CASE = """# A rock
name = "rock"   # of mine

[sphere]   # falls
radius = "25 mm"  # not "24 mm"
material = "rock-paper"
[[sensors]]
name = "a"
[contact]
law = "adams-impact"
damping_max = [
    1.0,  # first
    2.0,
]
full_damping_penetration = "#0.1 mm"

[plate.mesh]
size = "1 cm"
"""


def test_comments_and_all_other_lines_stay() -> None:
    changes = {
        "name": "b",
        "sphere.radius": "3 cm",
        "contact.damping_max": [5.0, 6.0],
        "contact.full_damping_penetration": 1e-4,
    }
    expected = (
        CASE.replace('"rock"   ', '"b"   ')
        .replace('"25 mm"', '"3 cm"')
        .replace("[\n    1.0,  # first\n    2.0,\n]", "[5.0, 6.0]")
        .replace('"#0.1 mm"', "0.0001")
    )
    assert changed_text(CASE, changes) == expected


def test_keys_and_sections_that_were_not_there_are_added() -> None:
    found = changed_text(CASE, {"sphere.model": "elastic", "drop.speed": 2.0, "schema_version": 1})
    assert 'material = "rock-paper"\nmodel = "elastic"\n[[sensors]]' in found
    assert found.endswith('[plate.mesh]\nsize = "1 cm"\n\n[drop]\nspeed = 2.0')
    assert "# of mine\nschema_version = 1\n\n[sphere]" in found


@pytest.mark.parametrize(
    ("text", "changes"),
    [
        ('sphere = { radius = "25 mm", model = "rigid" }', {"sphere.radius": 1.0}),
        ("sphere.radius = 2.0", {"sphere.radius": 1.0}),
        ('[plate.mesh]\nsize = "1 cm"', {"plate.mesh.size": 2.0}),
        ('[sphere]\nnote = """\n[sphere]\nradius = 5\n"""\nradius = 2.0', {"sphere.radius": 1.0}),
        ('["sphere"]\n"radius" = 2.0', {"sphere.radius": 1.0}),
        ('[[sensors]]\nname = "a"', {"sensors": []}),
    ],
)
def test_what_stands_otherwise_is_written_anew(text: str, changes: dict[str, Any]) -> None:
    assert tomllib.loads(changed_text(text, changes)) == with_values(tomllib.loads(text), changes)
