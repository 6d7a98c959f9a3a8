"""No case that is meant as it stands is taken for a slip of a unit: shipped and
documented cases, and all materials in all sizes.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import pytest

import vibroimpact as vi
from support import one_in
from vibroimpact.calibration.calibrate_case import calibration_of
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_table, shipped_cases
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.wrong_units.detect import slips, swept_slips
from vibroimpact.cases.wrong_units.hertz_estimate import HertzEstimate
from vibroimpact.studies.planning.sweep_file import sweep_of

ROOT = Path(__file__).parents[2]


def documented() -> Iterator[tuple[str, dict[str, Any]]]:
    """The cases of the documents and of the examples, also those that are written as Python."""
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        text = page.read_text(encoding="utf-8")
        yield from (
            (page.name, tomllib.loads(block))
            for block in re.findall(r"```toml\n(.*?)```", text, flags=re.S)
        )
        for block in re.findall(r"```python\n(.*?)```", text, flags=re.S):
            yield from ((page.name, one) for one in written_in(block))
    for script in sorted((ROOT / "examples").rglob("*.py")):
        yield from ((script.name, one) for one in written_in(script.read_text(encoding="utf-8")))


def written_in(source: str) -> Iterator[dict[str, Any]]:
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Dict) and {"sphere", "plate", "contact"} <= {
            key.value for key in node.keys if isinstance(key, ast.Constant)
        }:
            try:
                yield ast.literal_eval(node)
            except ValueError:  # made of variables
                continue


def said_of(table: dict[str, Any]) -> list[str]:
    """What is taken for a slip in a case, and in the values of a study."""
    alone = {key: value for key, value in table.items() if key != "sweep"}
    case, given, *_ = calibration_of(alone) if "calibrate" in alone else (vi.case_of(alone), True)
    found = slips(resolved_case(case), () if given else ("contact.damping_max",))
    if "sweep" in table:
        study = sweep_of(table)
        found += swept_slips(resolved_case(study.case), study.plan.columns)
    return found


@pytest.mark.parametrize("name", shipped_cases())
def test_shipped_cases(name: str) -> None:
    assert said_of(load_table(name)) == []


def test_documented_cases() -> None:
    cases = list(documented())
    assert len(cases) > 10
    for name, table in cases:
        assert (name, said_of(table)) == (name, [])


RUBBER = {"density": 1100, "youngs_modulus": "1 MPa", "poissons_ratio": 0.49}
FOAM = {"density": 30, "youngs_modulus": "5 MPa", "poissons_ratio": 0.1}
DIAMOND = {"density": 3510, "youngs_modulus": "1050 GPa", "poissons_ratio": 0.1}
SOIL = {"density": 1800, "youngs_modulus": "20 MPa", "poissons_ratio": 0.3}
PLATES = {
    "foil": (0.3, 0.2, 1e-4),
    "sheet": (0.52, 0.42, 0.008),
    "coupon": (0.02, 0.02, 0.005),
    "slab": (6.0, 4.0, 1.0),
}


@pytest.mark.parametrize("plate", one_in(2, PLATES))
def test_every_material_size_and_height(plate: str) -> None:
    """Beads of 1 mm and boulders of 2 m, foils and slabs, dropped from 1 mm to 100 m
    above the surface.
    """
    materials: list[Any] = [*vi.materials.material_library(), RUBBER, FOAM, DIAMOND, SOIL]
    sizes = {"slab": (0.0005, 0.025, 1.0, 2.0), "coupon": (0.0005, 0.025)}.get(
        plate, (0.0005, 0.025, 0.3)
    )
    for material, radius, height in product(materials, sizes, (0.001, 1.0, 100.0)):
        table = {
            "sphere": {"radius": radius, "material": material},
            "plate": {
                "size": list(PLATES[plate]),
                "material": "concrete" if plate == "slab" else "steel",
            },
            "drop": {"height": radius + height},
            "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
            "run": {"impacts": 3},
        }
        assert slips(resolved_case(vi.case_of(table))) == [], table
        table["sphere"]["material"], table["plate"]["material"] = (
            table["plate"]["material"],
            material,
        )
        assert slips(resolved_case(vi.case_of(table))) == [], table


@pytest.mark.parametrize("law", vi.laws.contact_laws())
def test_every_law_as_its_figures_have_it(law: str) -> None:
    """A ball of 25 mm that falls a metre; soft springs, which save steps, and what is
    made softer on purpose are no slips.
    """
    table: dict[str, Any] = {
        "sphere": {"radius": "25 mm", "material": "rock-paper"},
        "plate": {"material": "steel"},
        "drop": {"height": "1 m"},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    example = vi.laws.contact_laws()[law].example(contact_pair(vi.case_of(table)))
    values = {
        name: value
        for name, value in vars(example).items()
        if value is not None and not example.__dataclass_fields__[name].metadata["memory"]
    }
    table["contact"] = {"law": law, **values}
    assert slips(resolved_case(vi.case_of(table))) == []
    if "stiffness" in values:
        table["contact"]["stiffness"] = values["stiffness"] / 20.0
        assert slips(resolved_case(vi.case_of(table))) == []


def test_adams_damping_from_nearly_none_to_critical() -> None:
    for radius, speed in product((0.0005, 0.025, 1.0), (0.1, 1.0, 10.0)):
        table: dict[str, Any] = {
            "sphere": {"radius": radius, "material": "glass"},
            "plate": {"material": "steel"},
            "drop": {"speed": speed},
            "contact": {
                "law": "adams-impact",
                "damping_max": 0.0,
                "full_damping_penetration": 1e-6,
            },
            "run": {"impacts": 1},
        }
        facts = HertzEstimate(resolved_case(vi.case_of(table)))
        for part in (1e-3, 0.05, 1.0, 5.0):
            table["contact"] |= {
                "damping_max": part * facts.critical_damping,
                "full_damping_penetration": 0.1 * facts.depth,
            }
            assert slips(resolved_case(vi.case_of(table))) == []
