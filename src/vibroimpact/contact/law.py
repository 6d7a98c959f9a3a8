"""The interface of a contact law.

A law is a frozen dataclass in a file of its own under `vibroimpact.contact.laws`, where the
registry finds it. It declares

* `name`, `equation` and `source`, which the command line and the documentation print;
* `departure`, if it is not as its sources have it;
* its parameters, each with `parameter(...)`: meaning, unit, range, default;
* the state variables on which its force depends, if any, each with `memory(...)`;
* and, if it is a `CompliantLaw`, when its contact ends, whether its force may be tensile, and
  functions that compiled code calls with floats and everything else with arrays, and the
  `coefficients` they are called with: `scalar_forces` and `scalar_energies`, and, if it has a
  memory or breakpoints, `scalar_levels` and `scalar_compressed`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.parameters import Parameters

ScalarForces = Callable[[Array, Array, Array, Any], tuple[Array, Array]]
"""A function of indentation [m], its rate [m/s], approach speed [m/s] and coefficients:
static and dissipative force [N].
"""

ScalarEnergies = Callable[[Array, Any], tuple[Array, Array]]
"""A function of indentation [m] and coefficients: elastic energy, and plastic work since
the state of the coefficients [J].
"""

Levels = tuple[Array, Array, Array, Array, Array]
"""Indentations [m]: of touch, of release, beyond which compression changes the memory,
and two breakpoints; infinite if there is none.
"""

ScalarLevels = Callable[[Any], Levels]
"""A function of coefficients: the levels of a law."""

ScalarCompressed = Callable[[Array, Any, Any], Array]
"""A function of an indentation [m], coefficients and a copy of these, which writes what compression
to there changes into the copy.

It returns the indentation beyond which compression changes the memory again [m].
"""

_METHODS = {
    "scalar_forces": ("forces",),
    "scalar_energies": ("elastic_energy", "plastic_work"),
    "scalar_levels": ("touch_level", "release_level", "breakpoints"),
    "scalar_compressed": ("after_compression",),
}
"""The functions of floats of a law, and the methods that stand for each in a law that is
not compiled.
"""


@scalar
def levels_of_smooth_contact(coefficients: Any) -> Levels:
    """Return the levels of a law without memory and breakpoints [m].

    Its contact begins and ends at zero indentation.
    """
    return 0.0, 0.0, np.inf, np.inf, np.inf


@scalar
def unchanged(deepest: Array, coefficients: Any, changed: Any) -> Array:
    """Leave the coefficients of a law without memory as they are."""
    return np.inf


@dataclass(frozen=True, kw_only=True)
class ContactLaw(Parameters):
    """Base of all contact laws.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hertz")(stiffness=1e9)
    >>> isinstance(law, vi.laws.ContactLaw), law.name, law.exponent
    (True, 'hertz', 1.5)
    """

    departure: ClassVar[str] = ""
    """In what the law departs from its sources, in sentences; "" if it is as published."""

    @property
    def free_parameter(self) -> str | None:
        """The name of the parameter that sets the energy loss; None if there is none.

        `law_achieving` varies it.
        """
        if getattr(self, "restitution", None) is None:
            return None
        return "restitution"

    @property
    def nominal_restitution(self) -> Array:
        """The restitution that the law is given [-], NaN if it is given none."""
        restitution = getattr(self, "restitution", None)
        return np.nan if restitution is None else restitution

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


@dataclass(frozen=True, kw_only=True)
class CompliantLaw(ContactLaw):
    """Base of the laws with a contact force.

    The force is given as a static and a dissipative part, from which the energy ledger follows.

    Signs: indentation `delta` >= 0 in contact, `delta_dot` > 0 in compression, a positive force is
    repulsive. All arguments broadcast; the last axis is the drop.

    A law whose static force depends on the largest indentation so far declares it with `memory` and
    updates it in `after_compression`; the force then follows the unloading curve below that
    indentation and the loading curve beyond it.

    Examples
    --------
    A law gives its force and its energies as functions of floats or arrays, and the coefficients of
    these functions. One that defines `forces` and `elastic_energy` instead works as well, but is
    not compiled.

    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hertz")(stiffness=2.0)
    >>> law.coefficients
    (2.0, 1.5)
    >>> type(law).scalar_forces(4.0, 1.0, 1.0, law.coefficients) == law.forces(4.0, 1.0, 1.0)
    True
    """

    contact_end: ClassVar[Literal["zero-indentation", "zero-force", "pull-off"]]
    """When the contact ends: at zero indentation, at zero force, or at the pull-off of an
    adhesive contact.
    """
    tension: ClassVar[Literal["none", "cut", "kept"]]
    """May the force of the formula be tensile in an impact on a rigid plate? No; yes, and
    clipped at zero; yes, and kept.
    """

    root: ClassVar[int] = 2
    """The force is smooth in this root of the indentation: 2 with powers such as 3/2, 4
    with a power 1/4.
    """

    lasting: ClassVar[bool] = False
    """Does the state persist, as a dent does, for the next impact on the same spot?"""

    yields: ClassVar[bool] = False
    """Does the law define plastic work?"""

    scalar_forces: ClassVar[ScalarForces | None] = None
    """The force as a function of floats, marked by `compiled.scalar`; a law that has none
    defines `forces`, and is not compiled.
    """

    scalar_energies: ClassVar[ScalarEnergies | None] = None
    """Elastic energy and plastic work as a function of floats; a law that has none
    defines `elastic_energy`, and is not compiled.
    """

    scalar_levels: ClassVar[ScalarLevels | None] = staticmethod(levels_of_smooth_contact)
    """Where contact begins and ends, where compression changes the memory, and two
    breakpoints, as a function of floats.
    """

    scalar_compressed: ClassVar[ScalarCompressed | None] = staticmethod(unchanged)
    """What compression does to the coefficients, as a function of floats; a law with a
    memory defines its own.
    """

    function_methods = _METHODS

    _array_forces: ClassVar[ScalarForces | None] = None
    _array_energies: ClassVar[ScalarEnergies | None] = None
    _array_levels: ClassVar[ScalarLevels] = staticmethod(levels_of_smooth_contact)

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "plastic_work" in vars(cls):
            cls.yields = True

    @property
    def touch_level(self) -> Array:
        """Indentation [m] at which contact begins: zero, or the depth of the dent."""
        return self._levels[0]

    @property
    def release_level(self) -> Array:
        """Indentation [m] at which contact ends; negative for adhesive contacts."""
        # it then ends where it begins
        is_new = type(self).touch_level is not CompliantLaw.touch_level
        return self.touch_level if is_new else self._levels[1]

    @property
    def breakpoints(self) -> tuple[Array, ...]:
        """Indentations at which the force is not smooth, ascending [m].

        Integration steps end there.
        """
        return tuple(level for level in self._levels[3:] if np.any(np.isfinite(level)))

    @cached_property
    def _levels(self) -> Levels:
        return type(self)._array_levels(self.coefficients)

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
            raise NotImplementedError(
                f"{type(self).__name__} has neither `scalar_forces` nor `forces`"
            )
        return array_forces(delta, delta_dot, approach_speed, self.coefficients)

    def elastic_energy(self, delta: Array) -> Array:
        """Return the recoverable energy at the indentation `delta` [J].

        The sum of it and the plastic work is the integral of the static force from `touch_level`.
        """
        return self._energies(delta)[0]

    def plastic_work(self, delta: Array) -> Array:
        """Return the plastic work from the present state to the indentation `delta` [J]."""
        if not self.yields:
            return np.zeros_like(delta)
        return self._energies(delta)[1]

    def _energies(self, delta: Array) -> tuple[Array, Array]:
        array_energies = type(self)._array_energies
        if array_energies is None:
            raise NotImplementedError(
                f"{type(self).__name__} has neither `scalar_energies` nor `elastic_energy`"
            )
        return array_energies(delta, self.coefficients)

    def after_compression(self, deepest: Array) -> Self:
        """Return the law with its state after compression to the indentation `deepest` [m]."""
        return self


@dataclass(frozen=True, kw_only=True)
class InstantaneousLaw(ContactLaw):
    """Base of the laws of an impact without duration or force.

    They give the separation speed from the approach speed.
    """

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
    if unit != "N/m^n":
        return unit
    if isinstance(exponent, (int, float)) and exponent != 1:
        return f"N/m^{exponent:g}"
    return "N/m"


def default_origin(item: dataclasses.Field[Any]) -> str:
    """Return what a parameter is computed from where a case leaves it out; "" if it is not."""
    source = item.metadata["from_pair"]
    if not source:
        return ""
    if source in ("effective_radius", "effective_mass"):
        return "from the bodies"
    return "from the materials"


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
    # indentations from a nanometre to a decimetre, compressed at 1 m/s
    delta = np.geomspace(1e-9, 1e-1, 9)[:, None]
    _, dissipative_force = law.forces(delta, np.ones((9, 1)), np.ones((9, 1)))
    if np.any(dissipative_force) or np.any(law.plastic_work(delta)):
        return False
    # the elastic energy that is left at release, as at the pull-off of an adhesive contact, is lost
    return not np.any(law.elastic_energy(law.release_level))
