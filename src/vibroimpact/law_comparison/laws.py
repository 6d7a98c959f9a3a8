"""Variants of a case under several contact laws."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, fields
from typing import Any

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.contact import in_table
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.reader import case_of
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import contact_laws_of, touch_speed
from vibroimpact.contact.law import ContactLaw, unit_of
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.restitution import law_achieving
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

_BESIDE_THE_LAW = (*LocalSection.model_fields, "friction")
"""Keys of the [contact] section that stay under each law: the liquid, friction, and how
the law is combined with elastic bodies.
"""


def cases_under(
    case: Case,
    laws: Iterable[str],
    given: Mapping[str, Any] | None = None,
    achieving: float | None = None,
) -> dict[str, Case]:
    """Return a case under each of several contact laws.

    A law takes each parameter from `given`, or else from the law of the case where that has one of
    the same name and unit, or else from the bodies. Friction, a liquid and the treatment of local
    indentation are those of the case.

    Parameters
    ----------
    case : Case
        The case.
    laws : iterable of str
        Names of laws.
    given : mapping of str, optional
        Parameters, as a case file would hold them: "KEY" for every law that has it, "LAW.KEY" for
        one.
    achieving : float, optional
        Give each law the value of its free parameter with which it achieves this restitution [-] at
        the speed of the first impact, without gravity, and without the losses in a liquid.

    Returns
    -------
    dict of str to Case
        The cases by name of the law, in the order given.

    Raises
    ------
    InputError
        If a law or key is unknown, a parameter is missing, or a law can't achieve the restitution.
        A law without a free parameter is not tuned.

    Examples
    --------
    >>> from vibroimpact.cases.reader import load_case
    >>> cases = cases_under(
    ...     load_case("paper:type1-theory"), ["hertz", "flores"], {"flores.restitution": 0.7}
    ... )
    >>> cases["flores"].contact.parameters["restitution"]
    0.7
    """
    names = list(laws)
    table = dict(given or {})
    if not names:
        raise InputError("name at least one contact law")
    if achieving is not None:
        Range(at_least=0, at_most=1).check(
            achieving, shown=f"a restitution of {achieving:g} to achieve"
        )
    for name in names:
        if names.count(name) > 1:
            raise InputError(f'"{name}" is named twice; a law can only be compared with others')
    classes = {name: find_contact_law(name) for name in names}
    _check_given(table, classes)
    return {name: _case_under(case, law, table, achieving) for name, law in classes.items()}


def _case_under(
    case: Case, law: type[ContactLaw], given: Mapping[str, Any], achieving: float | None
) -> Case:
    contact: dict[str, Any] = {"law": law.name, **_shared_parameters(case, law)}
    placeholders = []
    for item in fields(law):
        key = item.name
        value = given.get(f"{law.name}.{key}", given.get(key))
        if value is not None:
            contact[key] = value
        elif achieving is not None and not _can_be_left_out(case, law, contact, item):
            # placeholder, valid only for the parameter that is tuned: which one it is, only a
            # complete law tells
            contact[key] = item.metadata["example"]
            placeholders.append(key)
    name = case.name or "a drop"
    if law.name != case.contact.law:
        name = f"{law.name} on the drop of: {name}"  # as it may mention the law of the case
    of_case = resolved_case(case)
    for key in _BESIDE_THE_LAW:
        if key in of_case["contact"]:
            contact[key] = of_case["contact"][key]
    table: dict[str, Any] = {**of_case, "name": name, "contact": contact}
    try:
        found = case_of(table)
        tuned = contact_laws_of(found)[0].free_parameter
        # placeholders of other parameters are dropped, so that these are reported as missing
        if any(key != tuned for key in placeholders):
            table["contact"] = {
                key: value
                for key, value in table["contact"].items()
                if key not in placeholders or key == tuned
            }
            found = case_of(table)
        if achieving is None or tuned is None:
            return found
        if tuned in given or f"{law.name}.{tuned}" in given:
            raise InputError(f"{tuned} is tuned to achieve {achieving:g}, so it can't be given too")
        return _tuned(found, table, tuned, achieving)
    except InputError as error:
        message = str(error).removeprefix(f"{law.name} ")
        if "missing" in error.message or "needs" in error.message:
            message += " (give parameters with LAW.KEY=VALUE)"
        raise InputError(f"{law.name}: {message}") from None


def _shared_parameters(case: Case, law: type[ContactLaw]) -> dict[str, Any]:
    """Return the parameters of a case that mean the same in another law."""
    if law.name == case.contact.law:
        return {key: in_table(value) for key, value in case.contact.parameters.items()}
    own_units = {item.name: _unit(item) for item in fields(find_contact_law(case.contact.law))}
    units = {item.name: _unit(item) for item in fields(law)}
    return {
        key: in_table(value)
        for key, value in case.contact.parameters.items()
        if units.get(key) == own_units[key]
    }


def _can_be_left_out(
    case: Case, law: type[ContactLaw], contact: Mapping[str, Any], item: Field[Any]
) -> bool:
    """Return whether a parameter is given, has no typical value, a default, or another
    one that is given in its place.
    """
    if item.name in contact or item.metadata["example"] is None:
        return True
    if item.default is not None:
        return item.default is not MISSING
    try:
        law.for_pair(
            contact_pair(case),
            **{
                key: value
                for key, value in contact.items()
                if isinstance(value, (int, float, list))
            },
        )
    except InputError:
        return False
    return True


def _tuned(case: Case, table: Mapping[str, Any], parameter: str, achieving: float) -> Case:
    """Return a case with the free parameter of its law tuned to a restitution at the
    speed of the first impact.
    """
    law = contact_laws_of(case)[0]
    speed = touch_speed(case)
    tuned = law_achieving(law, achieving, contact_pair(case).effective_mass, speed)
    return case_of({**table, "contact": {**table["contact"], parameter: getattr(tuned, parameter)}})


def _check_given(given: Mapping[str, Any], laws: Mapping[str, type[ContactLaw]]) -> None:
    """Raise InputError unless every given parameter belongs to a compared law, with one
    unit in all of them.
    """
    keys = {item.name for law in laws.values() for item in fields(law)}
    known = [*keys, *(f"{name}.{item.name}" for name, law in laws.items() for item in fields(law))]
    for key, value in given.items():
        if key not in known:
            raise InputError(
                f"{quoted(key)} is not a parameter of {', '.join(laws)}.{did_you_mean(key, known)}"
            )
        units = {
            name: _unit(item)
            for name, law in laws.items()
            for item in fields(law)
            if item.name == key
        }
        if len(set(units.values())) > 1 and not isinstance(value, str):
            of_each = ", ".join(f"{name} [{unit}]" for name, unit in units.items())
            raise InputError(
                f'"{key}" does not have the same unit in all laws: {of_each}; give '
                f"LAW.{key} for each"
            )


def _unit(item: Field[Any]) -> str:
    # at one exponent, so that stiffnesses of laws with different exponents compare by their form
    return unit_of(item, 1.5)
