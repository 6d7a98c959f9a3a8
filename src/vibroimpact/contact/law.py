"""What a contact law is: parameters with units, an equation, a source, and a force.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.laws`; being there is
all the registration it needs. It declares

* `name`, `equation` and `source`, which the command line and the documentation print;
* its parameters, each with `parameter(...)`: unit, meaning, range, where a default comes from;
* and, if it is a `CompliantLaw`, how its contact ends and whether it may pull.
"""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from typing import Any, ClassVar, Literal, Self

import numpy as np

from vibroimpact.contact.pair import Array, ContactPair
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.ranges import Range


def parameter(meaning: str, unit: str = "", *, from_pair: str | None = None, default: Any = dataclasses.MISSING, **bounds: float) -> Any:
    """Declare a parameter of a law.

    Parameters
    ----------
    meaning : str
        What it is, in a few words.
    unit : str, default ""
        SI unit; "N/m^n" follows the exponent.
    from_pair : str, optional
        The attribute of `ContactPair` that serves where a case leaves the parameter out.
    default : optional
        The value where it is left out.
    **bounds : float
        The range, as `Range` takes it.
    """
    return dataclasses.field(default=default, metadata={"meaning": meaning, "unit": unit, "range": Range(**bounds), "from_pair": from_pair})


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """Base of all contact laws; parameters are floats, or arrays with one value a drop."""

    name: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, (str, bytes)):
                raise InputError(f'"{value!s}" is a text; it must be a number in SI, or an array of them', item.name)
            if isinstance(value, (list, tuple)):
                value = np.asarray(value, dtype=float)
                object.__setattr__(self, item.name, value)
            try:
                if value is not None:
                    item.metadata["range"].check(value, item.metadata["unit"])
            except InputError as error:
                raise InputError(error.message, item.name) from None

    @classmethod
    def for_pair(cls, pair: ContactPair, **parameters: Any) -> Self:
        """Make the law for two bodies: what is not given is taken from the pair where it can be.

        Raises
        ------
        InputError
            If a parameter is unknown, missing, or outside its range.
        """
        known = {item.name: item for item in fields(cls)}
        for key in parameters:
            if key not in known:
                raise InputError(f'unknown key "{key}"; {cls.name} takes {", ".join(known)}.{did_you_mean(key, known)}', key)
        given = dict(parameters)
        for key, item in known.items():
            if key not in given and item.metadata["from_pair"]:
                given[key] = getattr(pair, item.metadata["from_pair"])
                if np.any(np.isinf(given[key])):
                    raise InputError("it must be given, since two rigid materials have no contact stiffness of their own", key)
            if key not in given and item.default is dataclasses.MISSING:
                unit = f" [{item.metadata['unit']}]" if item.metadata["unit"] else ""
                raise InputError(f"this key is missing; {cls.name} needs {item.metadata['meaning']}{unit}", key)
        return cls(**given)

    def take(self, drops: Any) -> Self:
        """Return the law of some drops of a batch: parameters that are arrays are indexed."""
        changes = {item.name: value[drops] for item in fields(self) if np.ndim(value := getattr(self, item.name))}
        if not changes:
            return self
        copy = object.__new__(type(self))
        for item in fields(self):
            object.__setattr__(copy, item.name, changes.get(item.name, getattr(self, item.name)))
        return copy


@dataclass(frozen=True, kw_only=True)
class CompliantLaw(ContactLaw):
    """A law with a force: elastic and dissipative part apart, so that the ledger is free.

    Signs: indentation `delta` >= 0 in contact, `delta_dot` > 0 on approach, a positive force pushes the
    bodies apart. All arguments broadcast; the last axis is the drop.
    """

    contact_end: ClassVar[Literal["zero-indentation", "zero-force"]]
    """Where the contact is over: when the bodies no longer overlap, or when they no longer push."""
    tension: ClassVar[Literal["none", "cut", "kept"]]
    """Does the formula pull near the end? It never does; it does and is clipped at zero; it does and may."""

    root: ClassVar[int] = 2
    """The force is smooth in this root of the indentation: 2 for powers such as 3/2, 4 where there is a power 1/4."""

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """Indentations [m], rising, at which the force is not smooth; integration stops there."""
        return ()

    def forces(self, delta: Array, delta_dot: Array, approach_speed: Array) -> tuple[Array, Array]:
        """Return the elastic and the dissipative part of the force [N], before any clip at zero.

        Parameters
        ----------
        delta, delta_dot : float or array
            Indentation [m] and its rate [m/s].
        approach_speed : float or array
            Speed at the first touch of this impact [m/s], > 0.
        """
        raise NotImplementedError

    def elastic_energy(self, delta: Array) -> Array:
        """Return the energy stored at the indentation `delta` [J], the integral of the elastic force."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class InstantaneousLaw(ContactLaw):
    """A law without a duration: it gives the speed after the impact from the speed before."""

    def separation_speed(self, approach_speed: Array) -> Array:
        """Return the speed at which the bodies part [m/s]."""
        raise NotImplementedError


def loses_nothing(law: ContactLaw) -> bool:
    """Is the law without any loss, so that a ball under it bounces for ever?

    Examples
    --------
    >>> loses_nothing(find_contact_law("newton")(restitution=1.0))
    True
    """
    if isinstance(law, InstantaneousLaw):
        return bool(np.all(law.separation_speed(1.0) >= 1.0))
    assert isinstance(law, CompliantLaw)
    _, dissipative = law.forces(np.geomspace(1e-9, 1e-1, 9)[:, None], np.ones((9, 1)), np.ones((9, 1)))
    return not np.any(dissipative)


@cache
def contact_laws() -> Mapping[str, type[ContactLaw]]:
    """Return every contact law by its name.

    Raises
    ------
    InputError
        If two laws have the same name.

    Examples
    --------
    >>> "hertz" in contact_laws()
    True
    """
    package = importlib.import_module("vibroimpact.contact.laws")
    found: dict[str, type[ContactLaw]] = {}
    for info in sorted(pkgutil.iter_modules(package.__path__), key=lambda info: info.name):
        module = importlib.import_module(f"{package.__name__}.{info.name}")
        for law in vars(module).values():
            if isinstance(law, type) and issubclass(law, ContactLaw) and law.__module__ == module.__name__:
                if law.name in found:
                    raise InputError(f'two contact laws are called "{law.name}": {found[law.name].__module__} and {law.__module__}')
                found[law.name] = law
    return found


def find_contact_law(name: str) -> type[ContactLaw]:
    """Return the contact law called `name`.

    Raises
    ------
    InputError
        If there is none; the message names the closest.
    """
    laws = contact_laws()
    if name not in laws:
        raise InputError(f'there is no contact law "{name}"; there are {", ".join(laws)}.{did_you_mean(name, laws)}')
    return laws[name]
