"""A key of a section is one field: the schema's other readers take it from there."""

from __future__ import annotations

import re
import tomllib
from typing import Annotated, Any

import pytest

import vibroimpact as vi
from vibroimpact.cases import template
from vibroimpact.cases.fields.material import InlineMaterial
from vibroimpact.cases.fields.quantities import Quantity, UncertainQuantity, quantity_of
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.sections import keys, resolved_types
from vibroimpact.cases.sections.schema import SECTIONS, DropSection
from vibroimpact.ranges import Range


class WindTable(Section):
    """Wind that blows along the plate."""

    speed: Annotated[float, Quantity("m/s", "speed of the wind", Range(at_least=0))]


class WindyDrop(DropSection):
    """How the sphere comes down, with keys of each kind more."""

    charge: Annotated[float, Quantity("V", "voltage of the sphere", Range(at_least=0))] = 2.0
    wind: WindTable | None = None
    tilt: tuple[Annotated[float, Quantity("rad", "x")], Annotated[float, Quantity("rad", "z")]] = (
        0.0,
        0.0,
    )


def test_a_key_of_a_section_is_one_field(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(SECTIONS, "drop", WindyDrop)
    monkeypatch.setitem(template._SECTIONS, "drop", WindyDrop)
    # messages, and what `case.toml` has
    drop = WindyDrop.model_validate({"speed": 1.0, "charge": "3 mV", "wind": {"speed": "1 km/h"}})
    assert drop.charge == pytest.approx(3e-3)
    with pytest.raises(ValueError, match="-1 is not allowed; it must be at least 0 V"):
        WindyDrop.model_validate({"speed": 1.0, "charge": -1})
    # types of the resolved case
    types = resolved_types.resolved_types()
    assert "    charge: Array\n    wind: Mapping[str, Any]\n    tilt: Sequence[Array]\n" in types
    # sweeps and --set
    quantities = keys.quantity_keys({})
    units = {key: quantity and quantity.unit for key, quantity in quantities.items()}
    assert {key: units[f"drop.{key}"] for key in ("charge", "wind.speed", "tilt.x", "tilt.z")} == {
        "charge": "V",
        "wind.speed": "m/s",
        "tilt.x": "rad",
        "tilt.z": "rad",
    }
    # the template
    text = template.case_template()
    assert re.search(r"^# charge = 2\.0 +# voltage of the sphere \[V\]$", text, re.MULTILINE)
    assert tomllib.loads(text.replace("# charge = 2.0", "charge = 2.0"))["drop"]["charge"] == 2.0


def test_a_deviation_may_stand_where_the_message_says() -> None:
    tables: dict[str, type[Section]] = {**SECTIONS, "material": InlineMaterial}
    uncertain = {
        f"{name}.{key}"
        for name, section in tables.items()
        for key, info in section.model_fields.items()
        if isinstance(quantity_of(info), UncertainQuantity)
    }
    with pytest.raises(vi.InputError) as refusal:
        vi.load_case("paper:type1-theory", {"run.rest_speed": "1 mm/s +- 1 %"})
    allowed_keys = str(refusal.value).split("may stand at ")[1].split(" alone")[0]
    assert set(allowed_keys.replace(" and ", ", ").split(", ")) == uncertain


@pytest.mark.parametrize("name", ["position", "velocity", "spin", "size"])
def test_numbers_of_lists_have_the_names_of_the_schema(name: str) -> None:
    section: Any = SECTIONS["plate" if name == "size" else "drop"]
    components = keys._COMPONENTS[name]
    assert len(components) == len(keys._elements(section.model_fields[name].annotation))
    assert components[:2] in (("x", "y"), ("length", "width"))
