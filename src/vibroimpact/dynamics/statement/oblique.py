"""What a drop has beside its motion along the plate's normal."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from vibroimpact.arrays import Array, Indices
from vibroimpact.bodies.ball import SOLID
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.errors import InputError


def _are_numbers(value: Any) -> bool:
    """Return whether a value is a finite number, or an array of them."""
    found = np.asarray(value)
    return found.dtype.kind in "iuf" and bool(np.isfinite(found).all())


@dataclass(frozen=True, kw_only=True, eq=False)
class Oblique:
    """Tangential velocity, spin, friction law and inclination of an oblique impact.

    Each value is a number, or an array with one value per drop.

    The axes x and y lie in the plate's upper surface, z is its normal, upwards.

    Parameters
    ----------
    velocity : tuple of two floats or arrays, default (0, 0)
        Velocity of the sphere's centre along x and y [m/s].
    spin : tuple of three floats or arrays, default (0, 0, 0)
        Angular velocity about x, y and z [rad/s].
    position : tuple of two floats or arrays, default (0, 0)
        Place of the centre over the plate, from the plate's centre [m].
    gravity : tuple of two floats or arrays, default (0, 0)
        Acceleration of gravity along x and y [m/s^2], where the plate is inclined.
    friction : FrictionLaw, optional
        The friction law; none by default.
    size : tuple of two floats, optional
        Length and width of the plate [m], beyond which the sphere falls off its edge; by default it
        never does.
    inertia_ratio : float or array, default 0.4
        Moment of inertia over mass and square of the radius [-]; 0.4 of a solid sphere. Leave it
        out where the body of the sphere has its own `inertia`.

    Raises
    ------
    InputError
        If a value is not finite, or not of the right number of values.

    Examples
    --------
    >>> Oblique(velocity=(1.5, 0.0)).shape
    ()
    """

    velocity: tuple[Array, Array] = (0.0, 0.0)
    spin: tuple[Array, Array, Array] = (0.0, 0.0, 0.0)
    position: tuple[Array, Array] = (0.0, 0.0)
    gravity: tuple[Array, Array] = (0.0, 0.0)
    friction: FrictionLaw | None = None
    size: tuple[float, float] | None = None
    inertia_ratio: Array = SOLID

    def __post_init__(self) -> None:
        for name, count in (("velocity", 2), ("spin", 3), ("position", 2), ("gravity", 2)):
            values = getattr(self, name)
            if not isinstance(values, (tuple, list, np.ndarray)) or len(values) != count:
                raise InputError(f"{name} of an oblique drop has {count} values, not {values!r}")
            if not all(_are_numbers(value) for value in values):
                raise InputError(
                    f"{name} of an oblique drop must be finite numbers in SI, not {values!r}"
                )
        if self.friction is not None and not isinstance(self.friction, FrictionLaw):
            raise InputError(
                "friction must be a friction law with its parameters, such as "
                'vi.friction.find_friction_law("coulomb")(coefficient=0.3), '
                f"not {self.friction!r}"
            )
        if not (_are_numbers(self.inertia_ratio) and np.all(np.asarray(self.inertia_ratio) > 0.0)):
            raise InputError(
                f"inertia_ratio must be greater than 0 and finite, not {self.inertia_ratio!r}"
            )
        if self.size is not None:
            pair = isinstance(self.size, (tuple, list, np.ndarray)) and len(self.size) == 2
            if not (
                pair
                and all(
                    np.ndim(side) == 0 and _are_numbers(side) and side > 0.0 for side in self.size
                )
            ):
                raise InputError(
                    "size is the length and the width of the plate, greater than 0 m and "
                    f"finite, not {self.size!r}"
                )
            if any(
                np.any(np.abs(at) > 0.5 * side)
                for at, side in zip(self.position, self.size, strict=True)
            ):
                raise InputError(
                    "position lies outside the plate: from its centre the plate reaches "
                    "half its length along x and half its width along y"
                )

    @property
    def values(self) -> list[Array]:
        """All values that may be arrays."""
        if self.friction is None:
            law = []
        else:
            law = [getattr(self.friction, item.name) for item in fields(self.friction)]
        return [*self.velocity, *self.spin, *self.position, *self.gravity, self.inertia_ratio, *law]

    @property
    def shape(self) -> tuple[int, ...]:
        """() for one drop, (B,) for a batch."""
        return np.broadcast_shapes(*(np.shape(value) for value in self.values))

    def with_weight(self, part: Array) -> Self:
        """Return the same where the sphere has a part of its weight, as in a liquid."""
        return replace(self, gravity=(self.gravity[0] * part, self.gravity[1] * part))

    def take(self, drop: int | slice | Indices) -> Self:
        """Return what one drop of a batch has, or some."""

        def one(value: Any) -> Any:
            if np.ndim(value) == 0:
                return value
            return np.asarray(value)[drop]

        vectors = {
            name: tuple(one(value) for value in getattr(self, name))
            for name in ("velocity", "spin", "position", "gravity")
        }
        friction = self.friction
        if friction is not None:
            friction = friction.take(drop)
        return replace(self, **vectors, friction=friction, inertia_ratio=one(self.inertia_ratio))
