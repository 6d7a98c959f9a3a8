"""Registries of plug-in modules, and look-up of their entries by name."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from types import ModuleType
from typing import TypeVar

from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted

Entry = TypeVar("Entry")


def modules_in(package: str) -> list[ModuleType]:
    """Import and return the modules of a package, sorted by name.

    Examples
    --------
    >>> modules_in("vibroimpact.studies.designs")[0].__name__
    'vibroimpact.studies.designs.grid'
    """
    folders = importlib.import_module(package).__path__
    names = sorted(module.name for module in pkgutil.iter_modules(folders))
    return [importlib.import_module(f"{package}.{name}") for name in names]


def find_named(kind: str, name: str, known: Mapping[str, Entry], command: str = "") -> Entry:
    """Return the entry of a registry with a given name.

    Parameters
    ----------
    kind : str
        The kind of entry, for messages.
    name : str
        The name.
    known : mapping
        The registry: entries by name.
    command : str, optional
        The arguments of the command that lists them all, for the message.

    Raises
    ------
    InputError
        If there is none; the message suggests the closest name.

    Examples
    --------
    >>> find_named("law", "herz", {"hertz": 1})
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: there is no law "herz"; there are hertz. Did you mean "hertz"?
    """
    if name not in known:
        raise InputError(
            f"there is no {kind} {quoted(name)}; there are {choices(known, name, command)}"
        )
    return known[name]


def class_named(registered: Mapping[str, type[Entry]], name: str, module: str) -> type[Entry]:
    """Return a registered class by the name of the class, as a module has it as an attribute.

    Parameters
    ----------
    registered : mapping of str to type
        The registry.
    name : str
        Name of the class.
    module : str
        Name of the module, for the message.

    Raises
    ------
    AttributeError
        If there is none.

    Examples
    --------
    >>> class_named({"whole": int}, "int", "numbers")
    <class 'int'>
    """
    for registered_class in registered.values():
        if registered_class.__name__ == name:
            return registered_class
    raise AttributeError(f"module {module!r} has no attribute {name!r}")
