"""The interface of a contact law.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.laws`, where the registry finds it. It declares

* `name`, `equation` and `source`, which the command line and the documentation print;
* its parameters, each with `parameter(...)`: meaning, unit, range, default;
* the state variables on which its force depends, if any, each with `memory(...)`;
* and, if it is a `CompliantLaw`, when its contact ends and whether its force may be tensile.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.docstring import with_parameters
from vibroimpact.contact.pair import ContactPair
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.ranges import Range


def parameter(
    meaning: str,
    unit: str = "",
    *,
    detail: str = "",
    from_pair: str | None = None,
    default: Any = dataclasses.MISSING,
    example: float | None = None,
    **bounds: float,
) -> Any:
    """Declare a parameter of a law.

    Parameters
    ----------
    meaning : str
        What it is, in a few words of plain text; messages and the JSON schema print it.
    unit : str, default ""
        SI unit; "N/m^n" follows the exponent.
    detail : str, optional
        What it is, in sentences with reStructuredText markup; the law's docstring, sheet and page print it. Left out, it is
        the meaning as a sentence.
    from_pair : str, optional
        The attribute of `ContactPair` from which the parameter is taken where a case leaves it out.
    default : optional
        The default value.
    example : float, optional
        A typical value, for figures and tests, of a parameter with neither `from_pair` nor `default`.
    **bounds : float
        The range, in the arguments of `Range`.
    """
    return dataclasses.field(default=default, metadata=_metadata(meaning, unit, detail, Range(**bounds), from_pair, example))


def memory(meaning: str, unit: str = "", *, detail: str = "") -> Any:
    """Declare a state variable that a law carries through a contact; at least zero, and zero in a fresh contact.

    Parameters
    ----------
    meaning, unit, detail : str
        As those of `parameter`.
    """
    return dataclasses.field(default=0.0, metadata={**_metadata(meaning, unit, detail, Range(at_least=0)), "memory": True})


def inherited_parameter(base: type[ContactLaw], name: str, *, detail: str = "", **bounds: float) -> Any:
    """Declare a parameter or state of a base class again, with another detail or range; the rest is kept.

    Parameters
    ----------
    base : type of ContactLaw
        The class that declares it.
    name : str
        Its name.
    detail : str, optional
        As that of `parameter`.
    **bounds : float
        The new range; left out, the range is kept.
    """
    item = base.__dataclass_fields__[name]
    changes = {"detail": detail or item.metadata["detail"], "range": Range(**bounds) if bounds else item.metadata["range"]}
    return dataclasses.field(default=item.default, metadata={**item.metadata, **changes})


def _metadata(
    meaning: str, unit: str, detail: str, allowed: Range, from_pair: str | None = None, example: float | None = None
) -> dict[str, Any]:
    return {
        "meaning": meaning,
        "detail": detail or f"{meaning[:1].upper()}{meaning[1:]}.",
        "unit": unit,
        "range": allowed,
        "from_pair": from_pair,
        "example": example,
        "memory": False,
    }


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """Base of all contact laws. Parameters are floats, or arrays with one value per drop."""

    name: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        items: dict[str, dataclasses.Field[Any]] = {}
        for base in reversed(cls.__mro__[1:]):
            items |= getattr(base, "__dataclass_fields__", {})
        # `dataclass` decorates the class after this: its own fields are still class attributes
        items |= {key: value for key, value in vars(cls).items() if isinstance(value, dataclasses.Field)}
        declared = {key: item for key, item in items.items() if "meaning" in item.metadata}  # class variables are fields as well
        if cls.__doc__:  # None under python -OO
            cls.__doc__ = with_parameters(cls.__doc__, declared)

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
        """Return the law of a pair, with typical values of the parameters that the pair does not give, for figures and tests."""
        given = {item.name for item in fields(cls) if item.metadata["from_pair"] and getattr(pair, item.metadata["from_pair"]) is not None}
        typical = {item.name: item.metadata["example"] for item in fields(cls) if item.metadata["example"] is not None}
        return cls.for_pair(pair, **{name: value for name, value in typical.items() if name not in given})

    @property
    def free_parameter(self) -> str | None:
        """The name of the parameter that sets the energy loss, which `law_achieving` varies; None if there is none."""
        return "restitution" if getattr(self, "restitution", None) is not None else None

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array | None:
        """Return the restitution without gravity where there is a closed form, else None.

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
        """Return the law of two bodies; parameters that are not given come from the pair or from their defaults.

        Raises
        ------
        InputError
            If a parameter is unknown, missing, outside its range, or can't be taken from the pair.
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
                        f"{cls.name} needs {_with_unit(item)}, and no yield_strength is known of the materials to take it from; "
                        f"give it here, or give one of the materials a yield_strength",
                        key,
                    )
                if np.any(np.isinf(given[key])):
                    raise InputError("it must be given, since two rigid materials have no contact stiffness of their own", key)
            if key not in given and item.default is dataclasses.MISSING:
                raise InputError(f"this key is missing; {cls.name} needs {_with_unit(item)}", key)
        return cls(**given)

    def take(self, drops: Any) -> Self:
        """Return the law of selected drops of a batch: array parameters are indexed by `drops`."""
        return self.changed({item.name: value[drops] for item in fields(self) if np.ndim(value := getattr(self, item.name))})

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with some fields replaced; the new values are not checked."""
        if not changes:
            return self
        copy = object.__new__(type(self))
        for item in fields(self):
            object.__setattr__(copy, item.name, changes.get(item.name, getattr(self, item.name)))
        return copy

    def memories(self) -> dict[str, Array]:
        """Return the state variables by name."""
        return {item.name: getattr(self, item.name) for item in fields(self) if item.metadata["memory"]}


@dataclass(frozen=True, kw_only=True)
class CompliantLaw(ContactLaw):
    """Base of the laws with a contact force, given as a static and a dissipative part, from which the energy ledger follows.

    Signs: indentation `delta` >= 0 in contact, `delta_dot` > 0 in compression, a positive force is repulsive. All arguments
    broadcast; the last axis is the drop.

    A law whose static force depends on the largest indentation so far declares it with `memory` and updates it in
    `after_compression`; `forces` then follow the unloading curve below that indentation and the loading curve beyond it.
    """

    contact_end: ClassVar[Literal["zero-indentation", "zero-force", "pull-off"]]
    """When the contact ends: at zero indentation, at zero force, or at the pull-off of an adhesive contact."""
    tension: ClassVar[Literal["none", "cut", "kept"]]
    """Is the force of the formula tensile near the end of the contact? Never; yes, and clipped at zero; yes, and kept."""

    root: ClassVar[int] = 2
    """The force is smooth in this root of the indentation: 2 with powers such as 3/2, 4 with a power 1/4."""

    lasting: ClassVar[bool] = False
    """Does the state persist, as a dent does, for the next impact on the same spot?"""

    @property
    def touch_level(self) -> Array:
        """Indentation [m] at which contact begins: zero, or the depth of the dent."""
        return 0.0

    @property
    def release_level(self) -> Array:
        """Indentation [m] at which contact ends; negative for adhesive contacts."""
        return self.touch_level

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """Indentations [m], ascending, at which the force is not smooth; integration steps end there."""
        return ()

    def forces(self, delta: Array, delta_dot: Array, approach_speed: Array) -> tuple[Array, Array]:
        """Return the static and the dissipative part of the force [N], before any clipping at zero.

        Parameters
        ----------
        delta, delta_dot : float or array
            Indentation [m] and its rate [m/s].
        approach_speed : float or array
            Approach speed at the beginning of this contact [m/s], > 0.
        """
        raise NotImplementedError

    def elastic_energy(self, delta: Array) -> Array:
        """Return the recoverable energy at the indentation `delta` [J].

        The sum of it and the plastic work is the integral of the static force from `touch_level`.
        """
        raise NotImplementedError

    @property
    def yields(self) -> bool:
        """Does the law define plastic work?"""
        return type(self).plastic_work is not CompliantLaw.plastic_work

    def plastic_work(self, delta: Array) -> Array:
        """Return the plastic work from the present state to the indentation `delta` [J]."""
        return np.zeros_like(delta)

    def after_compression(self, deepest: Array) -> Self:
        """Return the law with its state after compression to the indentation `deepest` [m]."""
        return self


@dataclass(frozen=True, kw_only=True)
class InstantaneousLaw(ContactLaw):
    """Base of the laws of an impact without duration or force, which give the separation speed from the approach speed."""

    def separation_speed(self, approach_speed: Array, mass: Array) -> Array:
        """Return the separation speed [m/s].

        Parameters
        ----------
        approach_speed : float or array
            Approach speed [m/s].
        mass : float or array
            Effective mass of the pair [kg].
        """
        raise NotImplementedError

    def closed_form_restitution(self, mass: Array, speed: Array) -> Array:
        """Return the separation speed over the approach speed."""
        return self.separation_speed(speed, mass) / speed + 0.0 * mass


def unit_of(item: dataclasses.Field[Any], exponent: Any) -> str:
    """Return the SI unit of a parameter, with the force exponent inserted in "N/m^n".

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> stiffness = find_contact_law("hertz").__dataclass_fields__["stiffness"]
    >>> unit_of(stiffness, 1.5), unit_of(stiffness, 1.0)
    ('N/m^1.5', 'N/m')
    """
    unit = str(item.metadata["unit"])
    if unit == "N/m^n":
        return f"N/m^{exponent:g}" if isinstance(exponent, (int, float)) and exponent != 1 else "N/m"
    return unit


def default_origin(item: dataclasses.Field[Any]) -> str:
    """Return what a parameter is computed from where a case leaves it out, in words; "" if it is not."""
    source = item.metadata["from_pair"]
    return "" if not source else "from the bodies" if source in ("effective_radius", "effective_mass") else "from the materials"


def is_conservative(law: ContactLaw) -> bool:
    """Is the law conservative, so that a ball bounces for ever?

    Examples
    --------
    >>> from vibroimpact.contact.registry import find_contact_law
    >>> is_conservative(find_contact_law("newton")(restitution=1.0))
    True
    """
    if isinstance(law, InstantaneousLaw):
        return bool(np.all(law.separation_speed(1.0, 1.0) >= 1.0))
    assert isinstance(law, CompliantLaw)
    deltas = np.geomspace(1e-9, 1e-1, 9)[:, None]
    _, dissipative = law.forces(deltas, np.ones((9, 1)), np.ones((9, 1)))
    return not (np.any(dissipative) or np.any(law.plastic_work(deltas)) or np.any(law.elastic_energy(law.release_level)))


def _with_unit(item: dataclasses.Field[Any]) -> str:
    """Return the meaning of a parameter with its unit, for messages."""
    return f"{item.metadata['meaning']} [{item.metadata['unit']}]" if item.metadata["unit"] else str(item.metadata["meaning"])
