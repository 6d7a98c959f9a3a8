"""The cases of the drops of a study: values at dotted keys, one by one, or as arrays over
many drops.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.air import AirTable
from vibroimpact.cases.fields.liquid import LiquidTable
from vibroimpact.cases.fields.section import read_table
from vibroimpact.cases.keys import with_values
from vibroimpact.cases.reader import read_case
from vibroimpact.studies.axes import Values

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
    plain = {
        key: value.item() if isinstance(value, np.generic) else value
        for key, value in values.items()
    }
    return read_case(with_values(table, plain))


def is_array_key(key: str, values: Values) -> bool:
    """Return whether the values of a key may differ within a batch of drops with rigid bodies."""
    return values.dtype.kind == "f" and key not in _OF_THE_RUN


def with_arrays(case: Case, arrays: Mapping[str, Values]) -> Case:
    """Return a case whose numbers at dotted keys are arrays, one value per drop, without
    validation.

    Examples
    --------
    >>> import numpy as np
    >>> from vibroimpact.cases.rigid_problem import rigid_problem
    >>> from vibroimpact.cases.reader import load_case
    >>> case = with_arrays(
    ...     load_case("paper:type1-theory"), {"drop.height": np.array([1.0, 2.0, 4.0])}
    ... )
    >>> rigid_problem(case).shape
    (3,)
    """
    fields: dict[str, dict[str, Any]] = defaultdict(dict)
    materials: dict[str, dict[str, Any]] = defaultdict(dict)
    for key, values in arrays.items():
        section, _, field = key.partition(".")
        if field.startswith("material."):
            materials[section][field.removeprefix("material.")] = values
        elif field.startswith("air."):
            air = fields[section].get("air", case.drop.air or read_table(AirTable, {}))
            fields[section]["air"] = air.model_copy(update={field.removeprefix("air."): values})
        elif section == "drop" and "." in field:
            whole, _, part = field.partition(".")
            now = list(fields[section].get(whole, getattr(case.drop, whole) or (0.0, 0.0, 0.0)))
            now["xyz".index(part)] = values
            fields[section][whole] = tuple(now)
        elif not key.startswith(_WITHOUT_EFFECT):
            fields[section][field] = values
    for section, numbers in materials.items():
        fields[section]["material"] = replace(getattr(case, section).material, **numbers)
    changed: dict[str, Any] = {
        name: getattr(case, name).model_copy(update=given)
        for name, given in fields.items()
        if name != "contact"
    }
    if "contact" in fields:
        wet = {
            key: fields["contact"].pop(key)
            for key in list(fields["contact"])
            if key.startswith("liquid.")
        }
        if wet:
            numbers = {key.removeprefix("liquid."): values for key, values in wet.items()}
            liquid = (case.contact.local.liquid or read_table(LiquidTable, {})).model_copy(
                update=numbers
            )
            case = case.model_copy(
                update={
                    "contact": replace(
                        case.contact, local=case.contact.local.model_copy(update={"liquid": liquid})
                    )
                }
            )
        friction = {
            key: fields["contact"].pop(key)
            for key in list(fields["contact"])
            if key.startswith("friction.")
        }
        changed["contact"] = replace(
            case.contact, parameters={**case.contact.parameters, **fields["contact"]}
        )
        if friction and case.contact.friction is not None:
            inner = {key.removeprefix("friction."): values for key, values in friction.items()}
            table = replace(
                case.contact.friction, parameters={**case.contact.friction.parameters, **inner}
            )
            changed["contact"] = replace(changed["contact"], friction=table)
    return case.model_copy(update=changed)
