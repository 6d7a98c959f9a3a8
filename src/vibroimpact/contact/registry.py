"""The registry of contact laws: those of this package, and those of other packages by their entry points."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import cast

from vibroimpact.contact.law import ContactLaw
from vibroimpact.errors import InputError
from vibroimpact.registry import find_named, modules_in


@cache
def contact_laws() -> Mapping[str, type[ContactLaw]]:
    """Return all contact laws by name: those of this package and those of the entry points "vibroimpact.contact_laws".

    Raises
    ------
    InputError
        If two laws have the same name, or an entry point can't be loaded or is not a contact law.

    Examples
    --------
    >>> "hertz" in contact_laws()
    True
    """
    modules = modules_in("vibroimpact.contact.laws")
    laws = [law for module in modules for law in vars(module).values() if _is_law(law) and law.__module__ == module.__name__]
    found: dict[str, type[ContactLaw]] = {}
    for law in laws + [_loaded(point) for point in entry_points(group="vibroimpact.contact_laws")]:
        if law.name in found:
            raise InputError(
                f'two contact laws are called "{law.name}": {found[law.name].__module__} and {law.__module__}; '
                "rename one, or uninstall its package"
            )
        found[law.name] = law
    return found


def _is_law(candidate: object) -> bool:
    return isinstance(candidate, type) and issubclass(candidate, ContactLaw)


def _loaded(point: EntryPoint) -> type[ContactLaw]:
    """Return the contact law of an entry point."""
    try:
        law = point.load()
    except Exception as error:  # any error of another package is reported with the entry point's name
        raise InputError(
            f'the contact law "{point.name}" of the entry point {point.value} can\'t be loaded: {error}; mend or uninstall its package'
        ) from error
    missing = [key for key in ("name", "equation", "source") if not isinstance(getattr(law, key, None), str)]
    if not _is_law(law) or missing:
        lacks = f"; it has no {', '.join(missing)}" if _is_law(law) else ""
        raise InputError(f'the entry point "{point.name}", {point.value}, is not a contact law with name, equation and source{lacks}')
    return cast("type[ContactLaw]", law)


def find_contact_law(name: str) -> type[ContactLaw]:
    """Return the contact law with a name.

    Raises
    ------
    InputError
        If there is none; the message names the closest.
    """
    if not isinstance(name, str):
        raise InputError(f"a contact law is found by its name, a text, not {name!r}")
    return find_named("contact law", name, contact_laws())
