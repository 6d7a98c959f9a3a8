"""The interface of a contact law.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.laws`, where the registry finds it. It declares

* `name`, `equation` and `source`, which the command line and the documentation print;
* `departure`, if it is not as its sources have it;
* its parameters, each with `parameter(...)`: meaning, unit, range, default;
* the state variables on which its force depends, if any, each with `memory(...)`;
* and, if it is a `CompliantLaw`, when its contact ends, whether its force may be tensile, and the force: a function `scalar_forces`,
  which compiled code calls with floats and everything else with arrays, and the `coefficients` it is called with.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar, Literal, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.parameters import Parameters

ScalarForces = Callable[[Array, Array, Array, Any], tuple[Array, Array]]
"""A function of indentation [m], its rate [m/s], approach speed [m/s] and coefficients: static and dissipative force [N]."""


@dataclass(frozen=True, kw_only=True)
class ContactLaw(Parameters):
    """Base of all contact laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.find_contact_law("hertz")(stiffness=1e9)
    >>> isinstance(law, vi.ContactLaw), law.name, law.exponent
    (True, 'hertz', 1.5)
    """

    departure: ClassVar[str] = ""
    """In what the law departs from its sources, in sentences; "" if it is as published."""

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

    def memories(self) -> dict[str, Array]:
        """Return the state variables by name."""
        return {item.name: getattr(self, item.name) for item in fields(self) if item.metadata["memory"]}


@dataclass(frozen=True, kw_only=True)
class CompliantLaw(ContactLaw):
    """Base of the laws with a contact force, given as a static and a dissipative part, from which the energy ledger follows.

    Signs: indentation `delta` >= 0 in contact, `delta_dot` > 0 in compression, a positive force is repulsive. All arguments
    broadcast; the last axis is the drop.

    A law whose static force depends on the largest indentation so far declares it with `memory` and updates it in
    `after_compression`; the force then follows the unloading curve below that indentation and the loading curve beyond it.

    Examples
    --------
    A law gives its force as one function of floats or arrays, and the coefficients of this function. One that defines `forces`
    instead works as well, but is not compiled.

    >>> import vibroimpact as vi
    >>> law = vi.find_contact_law("hertz")(stiffness=2.0)
    >>> law.coefficients
    (2.0, 1.5)
    >>> type(law).scalar_forces(4.0, 1.0, 1.0, law.coefficients) == law.forces(4.0, 1.0, 1.0)
    True
    """

    contact_end: ClassVar[Literal["zero-indentation", "zero-force", "pull-off"]]
    """When the contact ends: at zero indentation, at zero force, or at the pull-off of an adhesive contact."""
    tension: ClassVar[Literal["none", "cut", "kept"]]
    """May the force of the formula be tensile in an impact on a rigid plate? No; yes, and clipped at zero; yes, and kept."""

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

    scalar_forces: ClassVar[ScalarForces | None] = None
    """The force as a function of floats, marked by `compiled.scalar`; a law that has none defines `forces`, and is not compiled."""

    _array_forces: ClassVar[ScalarForces | None] = None
    """What `forces` evaluates: `scalar_forces` of the law, or of its base where the law defines `forces` anew."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if cls.scalar_forces is not None:
            cls._array_forces = staticmethod(cls.scalar_forces)
        if "forces" in vars(cls) and "scalar_forces" not in vars(cls):
            cls.scalar_forces = None  # compiled code would pass over the new `forces`

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """The numbers from which `scalar_forces` computes the force, made once from parameters and memory.

        They are floats, or arrays with one value per drop; compiled code has them as an array of floats, one drop at a time.
        """
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
        array_forces = type(self)._array_forces
        if array_forces is None:
            raise NotImplementedError(f"{type(self).__name__} has neither `scalar_forces` nor `forces`")
        return array_forces(delta, delta_dot, approach_speed, self.coefficients)

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
