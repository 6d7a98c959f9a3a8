"""The modes that are chosen where a case leaves their number to the program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.elastic.chosen_modes import LEAST_MODES, MOST_MODES
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.recipe import Reduction

SENSOR = {"name": "a1", "position": ["90 mm", "40 mm"], "rate": "200 kHz"}


def table(sensors: bool = False, **plate: Any) -> dict[str, Any]:
    """A steel ball of 20 mm from 0.5 m on steel of 14 mm, with other keys of the plate."""
    elastic = {
        "size": ["300 mm", "200 mm", "14 mm"],
        "material": "steel",
        "model": "elastic",
        "supports": "clamped",
        **plate,
    }
    return {
        "sphere": {"radius": "10 mm", "material": "steel"},
        "plate": {key: value for key, value in elastic.items() if value is not None},
        "drop": {"height": "0.5 m"},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
        "sensors": [SENSOR] if sensors else [],
    }


def reduction(body: str = "plate", **changed: Any) -> Reduction:
    return elastic_bodies(vi.case_of({**table(), **changed}))[body].recipe.reduction


def of_plate(sensors: bool = False, **plate: Any) -> Reduction:
    return elastic_bodies(vi.case_of(table(sensors, **plate)))["plate"].recipe.reduction


def test_auto_is_the_default() -> None:
    assert of_plate() == of_plate(modes="auto")
    assert of_plate().max_frequency is not None


def test_what_a_case_states_is_kept() -> None:
    assert of_plate(modes=30) == Reduction(modes=30)
    assert of_plate(max_frequency="10 kHz") == Reduction(max_frequency=1e4)


def test_a_better_accuracy_a_sensor_and_a_thinner_plate_need_more() -> None:
    frequency = of_plate().max_frequency
    assert frequency is not None
    assert (of_plate(accuracy="0.3 %").max_frequency or 0.0) > frequency
    assert of_plate(sensors=True).modes == MOST_MODES["plate"]
    assert (of_plate(size=["300 mm", "200 mm", "8 mm"]).max_frequency or 0.0) > frequency


def test_a_free_edge_near_the_contact_needs_more() -> None:
    def at(x: float, **plate: Any) -> float:
        case = table(size=[0.15, 0.1, 0.014], **plate)
        case["drop"] = {"speed": 3.0, "gravity": 0.0, "position": [x, 0.0]}
        return elastic_bodies(vi.case_of(case))["plate"].recipe.reduction.max_frequency or 0.0

    assert at(0.074, supports="free") > at(0.0, supports="free")
    assert at(0.074) == at(0.0)  # clamped


def test_a_slightly_different_drop_has_the_same_modes() -> None:
    heights = [f"{height} mm" for height in (480, 490, 500, 510)]
    assert len({reduction(drop={"height": height}) for height in heights}) == 1


def test_the_number_has_limits() -> None:
    assert of_plate(size=["30 mm", "20 mm", "8 mm"]).modes == LEAST_MODES
    assert of_plate(size=["3 m", "2 m", "2 mm"]).modes == MOST_MODES["plate"]
    assert of_plate(accuracy=1e-9).modes == MOST_MODES["plate"]


def test_a_law_without_a_force_says_nothing_of_the_contact() -> None:
    assert reduction(contact={"law": "newton", "restitution": 0.5}).modes == LEAST_MODES


def test_modes_of_the_sphere_are_chosen_too() -> None:
    rock = {"density": 1380, "youngs_modulus": "2.26 GPa", "poissons_ratio": 0.28}
    sphere = {"radius": "25 mm", "material": rock, "model": "elastic"}
    assert reduction("sphere", sphere=sphere).modes == LEAST_MODES
    exact = reduction("sphere", sphere={**sphere, "accuracy": 1e-4})
    assert exact.modes == MOST_MODES["sphere"]


def test_an_imported_plate_needs_what_one_of_its_thickness_needs(tmp_path: Path) -> None:
    file = tmp_path / "plate.bdf"
    write_nastran(box_mesh((0.3, 0.2, 0.014), (18, 12, 1)), file)
    imported = of_plate(
        size=None, mesh=str(file), supports=[{"type": "point", "position": [0.1, 0.05]}]
    )
    assert imported.max_frequency == of_plate(element="solid").max_frequency


def test_the_resolved_case_has_what_was_chosen_and_the_same_modes() -> None:
    case = vi.case_of(table())
    resolved = resolved_case(case)
    assert resolved["plate"]["max_frequency"] == of_plate().max_frequency
    again = elastic_bodies(vi.case_of(dict(resolved)))["plate"].recipe
    assert again == elastic_bodies(case)["plate"].recipe


@pytest.mark.parametrize(
    ("plate", "message"),
    [
        ({"modes": "all"}, 'plate.modes: "all" is not allowed; it must be a whole number'),
        ({"modes": 0}, 'or "auto" for as many as the accuracy needs'),
        ({"modes": 30, "accuracy": 0.01}, "plate.accuracy: the modes are stated"),
        ({"accuracy": "80 %"}, "plate.accuracy: .80 %. is not allowed; it must be greater than 0"),
        ({"modes": "auto", "max_frequency": "1 kHz"}, "give either modes or max_frequency"),
    ],
)
def test_what_does_not_go_together_is_refused(plate: dict[str, Any], message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        vi.case_of(table(**plate))
