"""The registry of contact laws: those of this package, and those of other packages by their entry
points.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import TypeVar, cast

from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.parameters import Parameters
from vibroimpact.errors import InputError
from vibroimpact.registry import find_named, modules_in

Law = TypeVar("Law", bound=Parameters)


@cache
def contact_laws() -> Mapping[str, type[ContactLaw]]:
    """Return all contact laws by name.

    They are those of this package and of the entry points "vibroimpact.contact_laws".

    Raises
    ------
    InputError
        If two laws have the same name, or an entry point can't be loaded or is not a contact law.

    Examples
    --------
    >>> "hertz" in contact_laws()
    True
    """
    return registered_laws(
        "contact law", ContactLaw, "vibroimpact.contact.laws", "vibroimpact.contact_laws"
    )


def registered_laws(kind: str, base: type[Law], package: str, group: str) -> dict[str, type[Law]]:
    """Return the laws of a kind by name.

    They are those of the modules of a package, and of a group of entry points.

    Raises
    ------
    InputError
        If two laws have the same name, or an entry point can't be loaded or is not a law of this
        kind.
    """
    laws: list[type[Law]] = []
    for module in modules_in(package):
        # a module also holds the base classes that it imports
        laws += [
            law
            for law in vars(module).values()
            if _is_law(law, base) and law.__module__ == module.__name__
        ]
    laws += [_loaded(point, kind, base) for point in entry_points(group=group)]
    by_name: dict[str, type[Law]] = {}
    for law in laws:
        if law.name in by_name:
            raise InputError(
                f'two {kind}s are called "{law.name}": {by_name[law.name].__module__} and '
                f"{law.__module__}; "
                "rename one, or uninstall its package"
            )
        by_name[law.name] = law
    return by_name


def _is_law(candidate: object, base: type[Law]) -> bool:
    return isinstance(candidate, type) and issubclass(candidate, base)


def _loaded(point: EntryPoint, kind: str, base: type[Law]) -> type[Law]:
    """Return the law of an entry point."""
    try:
        law = point.load()
    except Exception as error:
        # any error of another package is reported with the entry point's name
        raise InputError(
            f'the {kind} "{point.name}" of the entry point {point.value} can\'t be loaded: '
            f"{error}; mend or uninstall its package"
        ) from error
    missing = [
        attribute
        for attribute in ("name", "equation", "source")
        if not isinstance(getattr(law, attribute, None), str)
    ]
    is_law = _is_law(law, base)
    if not is_law or missing:
        lacks = ""
        if is_law:
            lacks = f"; it has no {', '.join(missing)}"
        raise InputError(
            f'the entry point "{point.name}", {point.value}, is not a {kind} with name, '
            f"equation and source{lacks}"
        )
    return cast("type[Law]", law)


def find_contact_law(name: str) -> type[ContactLaw]:
    """Return the contact law with a name.

    Raises
    ------
    InputError
        If there is none; the message names the closest.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("flores")(stiffness=5e8, restitution=0.7)
    >>> law.name, law.restitution
    ('flores', 0.7)
    """
    return find_law("contact law", name, contact_laws())


def find_law(kind: str, name: str, laws: Mapping[str, type[Law]]) -> type[Law]:
    """Return the law with a name, of all laws of a kind.

    Raises
    ------
    InputError
        If there is none, or the name is no text; the message names the closest.
    """
    if not isinstance(name, str):
        raise InputError(f"a {kind} is found by its name, a text, not {name!r}")
    return find_named(kind, name, laws, "laws")
