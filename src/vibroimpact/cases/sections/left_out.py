"""Keys of a case that no longer apply where its contact law or the model of a body is changed."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

from vibroimpact.cases.fields.elastic_body import ELASTIC_KEYS
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.errors import LeftOutWarning, listed

_BESIDE_THE_LAW = ("law", "friction", *LocalSection.model_fields)
"""Keys of [contact] that are not parameters of its law."""


_CAUSES = {
    "contact.law": ("contact",),
    "sphere.model": ("sphere",),
    "plate.model": ("plate", "sensors"),
}
"""Changed keys with which others do not apply, and the sections of those."""


def without_inapplicable(
    table: Mapping[str, Any], changes: Mapping[str, Any]
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return a case without the keys that do not apply after changes, and these keys.

    With another contact law they are parameters that it does not have, or has in another unit; with
    a body that becomes rigid, what describes its modes, and of the plate the sensors on it. Keys
    that are changed themselves stay.

    Parameters
    ----------
    table : mapping
        The case before the changes, with the structure of a TOML case file.
    changes : mapping
        Other values by dotted key.

    Examples
    --------
    >>> without_inapplicable(
    ...     {"contact": {"law": "tsuji", "restitution": 0.7}}, {"contact.law": "hertz"}
    ... )
    ({'contact': {'law': 'tsuji'}}, ('contact.restitution',))
    """
    dropped = tuple(
        key
        for key in (*_of_other_law(table, changes), *_of_rigid_bodies(table, changes))
        if not _is_changed(key, changes)
    )
    kept = copy.deepcopy(dict(table))
    for key in dropped:
        section, _, name = key.partition(".")
        if name:
            del kept[section][name]
        else:
            del kept[section]
    return kept, dropped


def applicable(table: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a case without the keys that do not apply after changes, and warn of them.

    Warns
    -----
    LeftOutWarning
        Which keys are left out, and why.

    Examples
    --------
    >>> applicable({"contact": {"law": "hertz"}}, {"contact.law": "tsuji"})
    {'contact': {'law': 'hertz'}}
    """
    kept, dropped = without_inapplicable(table, changes)
    if dropped:
        warnings.warn(LeftOutWarning(left_out_note(dropped, changes)), stacklevel=3)
    return kept


def left_out_note(keys: tuple[str, ...], changes: Mapping[str, Any]) -> str:
    """Return the sentence on keys that were left out because of changes.

    Examples
    --------
    >>> left_out_note(("contact.restitution",), {"contact.law": "hertz", "drop.speed": 1.0})
    'left out of the case: contact.restitution; it does not apply with contact.law = hertz'
    """
    causes = []
    for cause, sections in _CAUSES.items():
        if any(key.partition(".")[0] in sections for key in keys):
            causes.append(f"{cause} = {changes[cause]}")
    reason = "they do not apply"
    if len(keys) == 1:
        reason = "it does not apply"
    return f"left out of the case: {listed(keys)}; {reason} with {' and '.join(causes)}"


def _of_other_law(table: Mapping[str, Any], changes: Mapping[str, Any]) -> Iterator[str]:
    """Yield the parameters of the contact law of a case that another one does not have."""
    contact = table.get("contact")
    laws = contact_laws()
    law = laws.get(str(changes.get("contact.law")))
    if law is None or not isinstance(contact, dict):
        return
    own = laws.get(str(contact.get("law")))
    if own is None or own is law:
        return
    units = _units(law, changes.get("contact.exponent", contact.get("exponent")))
    own_units = _units(own, contact.get("exponent"))
    for key in contact:
        if key in own_units and key not in _BESIDE_THE_LAW and units.get(key) != own_units[key]:
            yield f"contact.{key}"


def _units(law: type[Any], exponent: Any) -> dict[str, str]:
    """Return the unit of each parameter of a law, with the exponent of the case or its own."""
    parameters = {item.name: item for item in fields(law)}
    if "exponent" not in parameters or exponent is None:
        exponent = 1.5
        if "exponent" in parameters:
            exponent = parameters["exponent"].default
    return {name: unit_of(item, exponent) for name, item in parameters.items()}


def _of_rigid_bodies(table: Mapping[str, Any], changes: Mapping[str, Any]) -> Iterator[str]:
    """Yield the keys of bodies that become rigid, and the sensors on a plate that does."""
    for body in ("sphere", "plate"):
        section = table.get(body)
        if changes.get(f"{body}.model") != "rigid" or not isinstance(section, dict):
            continue
        if section.get("model") != "elastic":
            continue
        for key in ELASTIC_KEYS:
            if key in section:
                yield f"{body}.{key}"
        is_shaken = "motion" in section or "plate.motion" in changes
        if body == "plate" and "sensors" in table and not is_shaken:
            yield "sensors"


def _is_changed(key: str, changes: Mapping[str, Any]) -> bool:
    """Return whether a key, or one in its table, is changed."""
    return any(changed == key or changed.startswith(f"{key}.") for changed in changes)
