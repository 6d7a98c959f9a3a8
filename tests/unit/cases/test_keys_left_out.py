"""Keys that no longer apply where the contact law or the model of a body is changed."""

from __future__ import annotations

import sys
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.cases.changed_text import changed_text
from vibroimpact.cases.reader import shipped_cases
from vibroimpact.cases.sections.left_out import without_inapplicable
from vibroimpact.cli import main
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.errors import LeftOutWarning
from vibroimpact.studies.planning.sweep_file import load_drop

STUDY = """
[sphere]
radius = "25 mm"
material = "rock-paper"
[plate]
size = ["300 mm", "200 mm", "6 mm"]
material = "steel-paper"
model = "elastic"
modes = 12   # few
supports = "clamped"
mesh = { element_size = "50 mm" }
[drop]
height = "1 m"
[contact]
law = "adams-impact"   # of Adams
damping_max = 180.0
[[sensors]]
name = "below"
position = [0, 0]
[sweep.over]
"drop.height" = ["0.5 m", "1 m"]
"""


@pytest.mark.parametrize(
    ("name", "body"),
    [
        (name, body)
        for name in shipped_cases()
        if name.startswith("paper:")
        for body in ("sphere", "plate")
        if getattr(vi.load_case(name), body).model == "elastic"
    ],
)
def test_a_body_becomes_rigid(name: str, body: str) -> None:
    with pytest.warns(LeftOutWarning, match=rf"left out of the case: .*{body}\.model = rigid"):
        case = vi.load_case(name, {f"{body}.model": "rigid"})
    assert getattr(case, body).model == "rigid"
    assert getattr(case, body).radius == getattr(vi.load_case(name), body).radius
    if body == "plate":
        assert not case.sensors
        assert case.plate.size == vi.load_case(name).plate.size


@pytest.mark.parametrize("law", sorted(contact_laws()))
def test_what_remains_means_the_same(law: str) -> None:
    """Every parameter of every other law is left out, or the law has it in the same unit."""
    items = _parameters(contact_laws()[law])
    for own, kind in contact_laws().items():
        own_items = _parameters(kind)
        contact = {"law": own, "friction": {}, "liquid": True, **dict.fromkeys(own_items, 1.0)}
        contact.pop("exponent", None)
        kept, dropped = without_inapplicable({"contact": contact}, {"contact.law": law})
        if own == law:
            assert not dropped
            continue
        rest = set(kept["contact"]) - {"law", "friction", "liquid"}
        assert rest <= set(items)
        assert set(contact) == set(kept["contact"]) | {key.split(".")[1] for key in dropped}
        for name in rest:
            assert unit_of(items[name], _exponent(items)) == unit_of(
                own_items[name], _exponent(own_items)
            )


def _parameters(law: Any) -> dict[str, Any]:
    return {item.name: item for item in fields(law)}


def _exponent(items: dict[str, Any]) -> Any:
    return items["exponent"].default if "exponent" in items else 1.5


def test_a_parameter_in_another_unit_is_left_out() -> None:
    table = {"contact.stiffness": "5e8 N/m^1.5"}
    same = vi.load_case("paper:type1-theory", table)
    with pytest.warns(LeftOutWarning, match=r"contact\.restitution; it does not apply"):
        kept = vi.load_case("paper:type1-theory", {"contact.law": "hertz"})
    assert "restitution" in same.contact.parameters
    assert not kept.contact.parameters
    case = {"contact": {"law": "hertz", "stiffness": 5e8}}
    assert without_inapplicable(case, {"contact.law": "flores"})[1] == ()
    assert without_inapplicable(case, {"contact.law": "linear-spring-dashpot"})[1] == (
        "contact.stiffness",
    )
    assert (
        without_inapplicable(
            case, {"contact.law": "linear-spring-dashpot", "contact.stiffness": 1e6}
        )[1]
        == ()
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plate.model": "rigid", "plate.modes": 20}, "plate.modes: a rigid body does not take it"),
        (
            {"plate.model": "rigid", "plate.mesh.element_size": "2 cm"},
            "plate.mesh: a rigid body does not take it",
        ),
        ({"contact.law": "hertz", "contact.damping_max": 3.0}, 'unknown key "damping_max"'),
        ({"contact.law": "herz"}, "there is no contact law"),
    ],
)
@pytest.mark.filterwarnings("ignore::vibroimpact.errors.LeftOutWarning")
def test_what_is_set_stays_and_is_an_error(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.load_case("paper:type3", changes)


def test_nothing_is_left_out_without_need() -> None:
    vi.load_case("paper:type3", {"plate.model": "elastic", "contact.law": "adams-impact"})
    vi.load_case("paper:type1-theory", {"plate.model": "rigid"})


def test_a_drop_of_a_study(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    with pytest.warns(LeftOutWarning, match="plate.modes, plate.supports, plate.mesh, sensors"):
        case = load_drop(tmp_path / "study.toml", 1, {"plate.model": "rigid"})
    assert case.plate.model == "rigid"
    assert case.drop.height == 1.0


def test_the_text_of_a_case_keeps_its_comments() -> None:
    text = STUDY.partition("[[sensors]]")[0]
    changed = changed_text(text, {"plate.model": "rigid", "contact.law": "hertz"})
    assert "# of Adams" in changed
    assert "few" not in changed
    table = tomllib.loads(changed)
    assert set(table["plate"]) == {"size", "material", "model"}
    assert table["contact"] == {"law": "hertz"}
    whole = tomllib.loads(changed_text(STUDY, {"plate.model": "rigid"}))
    assert "sensors" not in whole


def test_a_command_says_it_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["check", "paper:type3", "--set", "plate.model=rigid", "--set", "contact.law=hertz"]
    monkeypatch.setattr(sys, "argv", ["vibroimpact", *words])
    with pytest.raises(SystemExit) as left:
        main()
    assert not left.value.code
    (line,) = (
        line for line in capsys.readouterr().err.splitlines() if "left out of the case" in line
    )
    assert line.endswith(
        "contact.damping_max, contact.full_damping_penetration, plate.modes, plate.damping, "
        "plate.supports, sensors; they do not apply with contact.law = hertz and "
        "plate.model = rigid"
    )
