"""The cases of the drops of a study: values at dotted keys, of one drop or of many as arrays."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.air import AirTable
from vibroimpact.cases.fields.contact import ContactSection
from vibroimpact.cases.fields.liquid import LiquidTable
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.reader import case_of
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.studies.planning.axes import Values

_OF_THE_RUN = ("run.duration", "run.tolerance")  # the same for all drops of a batch
# on rigid bodies, unless the sphere may fall off the edge
_WITHOUT_EFFECT = ("plate.size.", "sensors.")


def case_at(table: Mapping[str, Any], values: Mapping[str, Any]) -> Case:
    """Return the validated case of a table with values at dotted keys.

    Raises
    ------
    InputError
        If it is not a valid case.
    """
    plain = dict(values)
    for key, value in values.items():
        if isinstance(value, np.generic):
            plain[key] = value.item()
    return case_of(with_values(table, plain))


def is_array_key(key: str, values: Values) -> bool:
    """Return whether the values of a key may differ within a batch of drops with rigid bodies."""
    return values.dtype.kind == "f" and key not in _OF_THE_RUN


def with_arrays(case: Case, arrays: Mapping[str, Values]) -> Case:
    """Return a case whose numbers at dotted keys are arrays, one value per drop.

    The arrays are not validated.

    Examples
    --------
    >>> import numpy as np
    >>> from vibroimpact.cases.rigid.rigid_problem import rigid_problem
    >>> from vibroimpact.cases.reader import load_case
    >>> case = with_arrays(
    ...     load_case("paper:type1-theory"), {"drop.height": np.array([1.0, 2.0, 4.0])}
    ... )
    >>> rigid_problem(case).shape
    (3,)
    """
    arrays_by_section: dict[str, dict[str, Values]] = defaultdict(dict)
    for key, values in arrays.items():
        if not key.startswith(_WITHOUT_EFFECT):
            section, _, field = key.partition(".")
            arrays_by_section[section][field] = values
    changed: dict[str, Any] = {}
    for section, numbers in arrays_by_section.items():
        if section == "contact":
            changed[section] = _contact_with(case.contact, numbers)
        else:
            changed[section] = _section_with(section, getattr(case, section), numbers)
    return case.model_copy(update=changed)


def _section_with(name: str, section: Any, numbers: Mapping[str, Values]) -> Any:
    """Return a section of a case, such as "drop", with arrays at its fields.

    A field may be that of a table inside the section, such as `material.density`, or the component
    of a vector, such as `velocity.x`.
    """
    fields: dict[str, Any] = {}
    material: dict[str, Values] = {}
    for field, values in numbers.items():
        outer, _, inner = field.partition(".")
        if inner and outer == "material":
            material[inner] = values
        elif inner and outer == "air":
            air = fields.get("air", section.air or read_table(AirTable, {}))
            fields["air"] = air.model_copy(update={inner: values})
        elif inner and name == "drop":
            vector = list(fields.get(outer, getattr(section, outer) or (0.0, 0.0, 0.0)))
            vector["xyz".index(inner)] = values
            fields[outer] = tuple(vector)
        else:
            fields[field] = values
    if material:
        fields["material"] = replace(section.material, **material)
    return section.model_copy(update=fields)


def _contact_with(contact: ContactSection, numbers: Mapping[str, Values]) -> ContactSection:
    """Return the contact of a case with arrays as parameters of its law, liquid and friction."""
    parameters: dict[str, Any] = {}
    liquid: dict[str, Any] = {}
    friction: dict[str, Any] = {}
    for field, values in numbers.items():
        if field.startswith("liquid."):
            liquid[field.removeprefix("liquid.")] = values
        elif field.startswith("friction."):
            friction[field.removeprefix("friction.")] = values
        else:
            parameters[field] = values
    if liquid:
        film = contact.local.liquid or read_table(LiquidTable, {})
        local = contact.local.model_copy(update={"liquid": film.model_copy(update=liquid)})
        contact = replace(contact, local=local)
    contact = replace(contact, parameters={**contact.parameters, **parameters})
    law = contact.friction
    if friction and law is not None:
        law = replace(law, parameters={**law.parameters, **friction})
        contact = replace(contact, friction=law)
    return contact
