"""Adams' IMPACT matched to the rebound of a run, or of its contact alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import export_formats
from vibroimpact.exporting.formats.adams_solver import FORMAT
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.exporting.matched_rebound import matched_drop

PLATE = {
    "size": ["300 mm", "200 mm", "8 mm"],
    "material": "steel",
    "model": "elastic",
    "modes": 12,
    "damping": 0.02,
    "supports": "clamped",
    "mesh": {"element_size": "50 mm"},
}


def run(contact: dict[str, Any], **plate: Any) -> tuple[Drop, vi.Case]:
    """A drop of a rock and its case, on a rigid plate unless it is told otherwise."""
    case = vi.case_of(
        {
            "sphere": {"radius": "25 mm", "material": "rock-paper"},
            "plate": {"material": "steel", **plate},
            "drop": {"height": "0.5 m"},
            "contact": contact,
            "run": {"impacts": 2},
        }
    )
    return drop_of_result(vi.result_of(vi.simulate(case)), case), case


def restitutions(drop: Drop) -> np.ndarray:
    return np.asarray(drop.impacts["restitution_achieved"])


@pytest.mark.parametrize(
    "contact",
    [
        {"law": "tsuji", "restitution": 0.7},
        {"law": "meyer"},
        {"law": "newton", "restitution": 0.4},
        {"law": "linear-spring-dashpot", "stiffness": "2 MN/m", "restitution": 0.6},
    ],
    ids=lambda contact: str(contact["law"]),
)
@pytest.mark.parametrize("target", ["rebound", "contact"])
def test_impact_rebounds_as_the_law_between_rigid_bodies(
    contact: dict[str, Any], target: str
) -> None:
    drop, case = run(contact, **({"size": PLATE["size"]} if contact["law"] == "newton" else {}))
    matched = matched_drop(drop, case, target)
    assert {law.name for law in matched.laws} == {"adams-impact"}
    np.testing.assert_allclose(restitutions(matched), restitutions(drop), rtol=1e-9)
    np.testing.assert_allclose(
        matched.impacts["rebound_height_m"], drop.impacts["rebound_height_m"], rtol=1e-9
    )
    assert "whose bodies are rigid" in matched.notes[0]


def test_an_elastic_plate_takes_energy_too() -> None:
    drop, case = run({"law": "tsuji", "restitution": 0.8}, **PLATE)
    rebound = matched_drop(drop, case, "rebound")
    contact = matched_drop(drop, case, "contact")
    np.testing.assert_allclose(restitutions(rebound)[0], restitutions(drop)[0], rtol=1e-9)
    # the plate still vibrates when the sphere comes back, a little sooner or later
    np.testing.assert_allclose(restitutions(rebound), restitutions(drop), rtol=1e-4)
    np.testing.assert_allclose(restitutions(contact), 0.8, atol=2e-3)
    assert restitutions(drop)[0] < 0.75
    assert "between rigid bodies: the damping stands for the contact and" in rebound.notes[0]
    assert "the contact of this run alone" in contact.notes[0]
    shown = ", ".join(f"{value:.3f}" for value in restitutions(drop))
    assert shown in rebound.notes[0]
    assert shown in contact.notes[0]
    # the numbers to type are those that were simulated
    (first, _) = FORMAT.dialog(rebound)
    assert 1e3 * first["damping_N_s_mm"] == pytest.approx(rebound.laws[0].damping_max)  # type: ignore[attr-defined]
    assert first["penetration_depth_mm"] < 0.1


def test_the_damping_is_full_in_most_of_each_contact() -> None:
    matched = matched_drop(*run({"law": "tsuji", "restitution": 0.7}), "contact")
    (depth,) = {law.full_damping_penetration for law in matched.laws}  # type: ignore[attr-defined]
    assert depth <= 0.11 * matched.impacts["max_indentation_m"].min()
    own = {"law": "adams-impact", "damping_max": 150.0, "full_damping_penetration": "0.07 mm"}
    matched = matched_drop(*run(own), "contact")
    assert matched.laws[0].full_damping_penetration == pytest.approx(7e-5)  # type: ignore[attr-defined]
    assert [law.damping_max for law in matched.laws] == pytest.approx([150.0, 150.0])  # type: ignore[attr-defined]


def test_what_a_single_damping_gives_is_said() -> None:
    drop, case = run({"law": "tsuji", "restitution": 0.7})
    matched = matched_drop(drop, case, "contact")
    one = matched.laws[0]
    second = float(
        vi.laws.achieved_restitution(one, drop.mass, drop.impacts["approach_speed_m_s"][1])
    )
    (note,) = (note for note in matched.notes if "throughout" in note)
    assert f"a restitution of {second:.3f} in place of 0.7" in note


def test_says_where_nothing_of_the_damping_is_known() -> None:
    drop, case = run({"law": "hertz"})
    words = "nothing is known of the contact's own damping"
    for exported in (drop, matched_drop(drop, case, "contact")):
        assert len([note for note in FORMAT.notes(exported) if words in note]) == 1
    np.testing.assert_allclose(restitutions(matched_drop(drop, case, "contact")), 1.0, atol=1e-8)
    drop, case = run({"law": "hertz"}, **PLATE)
    assert any(words in note for note in matched_drop(drop, case, "rebound").notes)
    drop, case = run({"law": "tsuji", "restitution": 0.9})
    assert not any(words in note for note in FORMAT.notes(matched_drop(drop, case, "contact")))


def test_energy_that_comes_back_is_not_matched() -> None:
    drop, case = run({"law": "tsuji", "restitution": 0.7})
    faster = dict(drop.impacts)
    faster["restitution_achieved"] = np.array([0.7, 1.2])
    faster["separation_speed_m_s"] = faster["restitution_achieved"] * faster["approach_speed_m_s"]
    matched = matched_drop(replace(drop, impacts=faster), case, "rebound")
    assert len(matched.laws) == 1
    assert any(note.startswith("Impact 2 of the run") for note in matched.notes)
    faster["restitution_achieved"] = np.array([1.1, 1.2])
    with pytest.raises(vi.InputError, match="first impact of this run"):
        matched_drop(replace(drop, impacts=faster), case, "rebound")


def test_refusals(tmp_path: Any) -> None:
    drop, case = run({"law": "tsuji", "restitution": 0.7})
    with pytest.raises(vi.InputError, match="there are rebound, contact"):
        matched_drop(drop, case, "rebounds")
    folder = vi.simulate(case).save(tmp_path / "run")
    for name, form in export_formats().items():
        if not form.simulates:
            with pytest.raises(vi.InputError, match="programs that simulate"):
                vi.exporting.export_result(folder, name, match="contact")
    files = vi.exporting.export_result(folder, "adams", tmp_path / "adams", match="contact")
    text = " ".join(files[0].read_text().replace("\n!", " ").split())
    assert "These numbers reproduce the rebound of this run" in text
