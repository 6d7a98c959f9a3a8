"""What a contact law is: parameters with units, an equation, a source, and a force.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.laws`; being there is
all the registration it needs. It declares

* `name`, `equation` and `source`, which the command line and the documentation print;
* its parameters, each with `parameter(...)`: unit, meaning, range, where a default comes from;
* if its force depends on what the contact has been through, that state, each with `memory(...)`;
* and, if it is a `CompliantLaw`, how its contact ends and whether it may pull.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, ClassVar, Literal, Self, cast

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.pair import ContactPair
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.ranges import Range
from vibroimpact.registry import find_named, modules_in


def parameter(
    meaning: str,
    unit: str = "",
    *,
    from_pair: str | None = None,
    default: Any = dataclasses.MISSING,
    example: float | None = None,
    **bounds: float,
) -> Any:
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
    example : float, optional
        A typical value, for figures and tests, of a parameter that has neither.
    **bounds : float
        The range, as `Range` takes it.
    """
    metadata = {"meaning": meaning, "unit": unit, "range": Range(**bounds), "from_pair": from_pair, "example": example, "memory": False}
    return dataclasses.field(default=default, metadata=metadata)


def memory(meaning: str, unit: str = "") -> Any:
    """Declare a state that a law carries through a contact, zero of a fresh one; takes what `parameter` takes."""
    metadata = {"meaning": meaning, "unit": unit, "range": Range(at_least=0), "from_pair": None, "example": None, "memory": True}
    return dataclasses.field(default=0.0, metadata=metadata)


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
    def example(cls, pair: ContactPair) -> Self:
        """Return the law of a pair with typical values of what the pair does not tell, for figures and tests."""
        told = {item.name for item in fields(cls) if item.metadata["from_pair"] and getattr(pair, item.metadata["from_pair"]) is not None}
        typical = {item.name: item.metadata["example"] for item in fields(cls) if item.metadata["example"] is not None}
        return cls.for_pair(pair, **{name: value for name, value in typical.items() if name not in told})

    @property
    def free_parameter(self) -> str | None:
        """The parameter that sets how much is lost, which `law_achieving` may change; None if there is none."""
        return "restitution" if getattr(self, "restitution", None) is not None else None

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array | None:
        """Return the restitution achieved without gravity, if there is a closed form; else None.

        Parameters
        ----------
        mass : float or array
            Effective mass of the pair [kg].
        speed : float or array
            Approach speed [m/s].
        """
        return None

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
                if given[key] is None:
                    raise InputError(
                        f"{cls.name} needs {_described(item)}, and no yield_strength is known of the materials to take it from; "
                        f"give it here, or give one of the materials a yield_strength",
                        key,
                    )
                if np.any(np.isinf(given[key])):
                    raise InputError("it must be given, since two rigid materials have no contact stiffness of their own", key)
            if key not in given and item.default is dataclasses.MISSING:
                raise InputError(f"this key is missing; {cls.name} needs {_described(item)}", key)
        return cls(**given)

    def take(self, drops: Any) -> Self:
        """Return the law of some drops of a batch: parameters that are arrays are indexed."""
        return self.changed({item.name: value[drops] for item in fields(self) if np.ndim(value := getattr(self, item.name))})

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return the law with other values, which are known to be in range and are not checked."""
        if not changes:
            return self
        copy = object.__new__(type(self))
        for item in fields(self):
            object.__setattr__(copy, item.name, changes.get(item.name, getattr(self, item.name)))
        return copy

    def memories(self) -> dict[str, Array]:
        """Return the state that the law carries, by name."""
        return {item.name: getattr(self, item.name) for item in fields(self) if item.metadata["memory"]}


@dataclass(frozen=True, kw_only=True)
class CompliantLaw(ContactLaw):
    """A law with a force: static and dissipative part apart, so that the ledger is free.

    Signs: indentation `delta` >= 0 in contact, `delta_dot` > 0 on approach, a positive force pushes the
    bodies apart. All arguments broadcast; the last axis is the drop.

    A law whose static force depends on how deep the contact has been declares that depth with `memory`
    and returns itself with it from `after_compression`; its `forces` then follow the unloading path below
    that depth and the loading path beyond it.
    """

    contact_end: ClassVar[Literal["zero-indentation", "zero-force", "pull-off"]]
    """When the contact is over: when the bodies no longer overlap, no longer push, or have been torn apart."""
    tension: ClassVar[Literal["none", "cut", "kept"]]
    """Does the formula pull near the end? It never does; it does and is clipped at zero; it does and may."""

    root: ClassVar[int] = 2
    """The force is smooth in this root of the indentation: 2 for powers such as 3/2, 4 where there is a power 1/4."""

    lasting: ClassVar[bool] = False
    """Does the memory outlast the contact, as a dent does, when the next impact falls on the same spot?"""

    @property
    def touch_level(self) -> Array:
        """Indentation [m] at which the surfaces meet: zero, or the depth of the dent."""
        return 0.0

    @property
    def release_level(self) -> Array:
        """Indentation [m] at which they part again; below zero if they stick and are drawn out."""
        return self.touch_level

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """Indentations [m], rising, at which the force is not smooth; integration stops there."""
        return ()

    def forces(self, delta: Array, delta_dot: Array, approach_speed: Array) -> tuple[Array, Array]:
        """Return the static and the dissipative part of the force [N], before any clip at zero.

        Parameters
        ----------
        delta, delta_dot : float or array
            Indentation [m] and its rate [m/s].
        approach_speed : float or array
            Speed at the first touch of this impact [m/s], > 0.
        """
        raise NotImplementedError

    def elastic_energy(self, delta: Array) -> Array:
        """Return the energy stored at the indentation `delta` [J], all of which can be got back.

        With the plastic work it is the integral of the static force from `touch_level`.
        """
        raise NotImplementedError

    @property
    def yields(self) -> bool:
        """Does it do plastic work?"""
        return type(self).plastic_work is not CompliantLaw.plastic_work

    def plastic_work(self, delta: Array) -> Array:
        """Return the work spent on plastic deformation, from the state remembered to the indentation `delta` [J]."""
        return np.zeros_like(delta)

    def after_compression(self, deepest: Array) -> Self:
        """Return the law as it is once the contact has been as deep as `deepest` [m]."""
        return self


@dataclass(frozen=True, kw_only=True)
class InstantaneousLaw(ContactLaw):
    """A law without a duration: it gives the speed after the impact from the speed before."""

    def separation_speed(self, approach_speed: Array, mass: Array) -> Array:
        """Return the speed at which the bodies part [m/s].

        Parameters
        ----------
        approach_speed : float or array
            Speed at the touch [m/s].
        mass : float or array
            Effective mass of the pair [kg].
        """
        raise NotImplementedError

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the separation speed over the approach speed."""
        return self.separation_speed(speed, mass) / speed + 0.0 * mass


def unit_of(item: dataclasses.Field[Any], exponent: Any) -> str:
    """Return a parameter's SI unit, with the exponent of the force filled in.

    Examples
    --------
    >>> stiffness = find_contact_law("hertz").__dataclass_fields__["stiffness"]
    >>> unit_of(stiffness, 1.5), unit_of(stiffness, 1.0)
    ('N/m^1.5', 'N/m')
    """
    unit = str(item.metadata["unit"])
    if unit == "N/m^n":
        return f"N/m^{exponent:g}" if isinstance(exponent, (int, float)) and exponent != 1 else "N/m"
    return unit


def loses_nothing(law: ContactLaw) -> bool:
    """Is the law without any loss, so that a ball under it bounces for ever?

    Examples
    --------
    >>> loses_nothing(find_contact_law("newton")(restitution=1.0))
    True
    """
    if isinstance(law, InstantaneousLaw):
        return bool(np.all(law.separation_speed(1.0, 1.0) >= 1.0))
    assert isinstance(law, CompliantLaw)
    deltas = np.geomspace(1e-9, 1e-1, 9)[:, None]
    _, dissipative = law.forces(deltas, np.ones((9, 1)), np.ones((9, 1)))
    return not (np.any(dissipative) or np.any(law.plastic_work(deltas)) or np.any(law.elastic_energy(law.release_level)))


@cache
def contact_laws() -> Mapping[str, type[ContactLaw]]:
    """Return every contact law by its name.

    Those of this package, and those of any installed package that names its laws under the entry point
    "vibroimpact.contact_laws".

    Raises
    ------
    InputError
        If two laws have the same name, or an entry point does not lead to a law.

    Examples
    --------
    >>> "hertz" in contact_laws()
    True
    """
    modules = modules_in("vibroimpact.contact.laws")
    laws = [law for module in modules for law in vars(module).values() if _is_law(law) and law.__module__ == module.__name__]
    found: dict[str, type[ContactLaw]] = {}
    for law in laws + [_brought(point) for point in entry_points(group="vibroimpact.contact_laws")]:
        if law.name in found:
            raise InputError(
                f'two contact laws are called "{law.name}": {found[law.name].__module__} and {law.__module__}; '
                "rename one, or uninstall its package"
            )
        found[law.name] = law
    return found


def _is_law(candidate: object) -> bool:
    return isinstance(candidate, type) and issubclass(candidate, ContactLaw)


def _brought(point: EntryPoint) -> type[ContactLaw]:
    """Return the law that an installed package brings."""
    try:
        law = point.load()
    except Exception as error:  # whatever a foreign package does, say whose fault it is
        raise InputError(
            f'the contact law "{point.name}" of the entry point {point.value} can\'t be loaded: {error}; mend or uninstall its package'
        ) from error
    missing = [key for key in ("name", "equation", "source") if not isinstance(getattr(law, key, None), str)]
    if not _is_law(law) or missing:
        lacks = f"; it has no {', '.join(missing)}" if _is_law(law) else ""
        raise InputError(f'the entry point "{point.name}", {point.value}, is not a contact law with name, equation and source{lacks}')
    return cast("type[ContactLaw]", law)


def _described(item: dataclasses.Field[Any]) -> str:
    """Return a parameter's meaning and unit."""
    return f"{item.metadata['meaning']} [{item.metadata['unit']}]" if item.metadata["unit"] else str(item.metadata["meaning"])


def find_contact_law(name: str) -> type[ContactLaw]:
    """Return the contact law called `name`.

    Raises
    ------
    InputError
        If there is none; the message names the closest.
    """
    if not isinstance(name, str):
        raise InputError(f"a contact law is found by its name, a text, not {name!r}")
    return find_named("contact law", name, contact_laws())
