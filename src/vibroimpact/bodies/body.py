"""Body of an impact as the dynamics use it: mass, contact offset and modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices


@dataclass(frozen=True)
class Body:
    """A body that takes part in an impact: its mass, contact offset, and modes if it is elastic.

    Parameters
    ----------
    mass : float or array
        Mass [kg], > 0; infinite for a fixed body.
    contact_offset : float or array
        Distance of the contact point from the centre of mass [m], >= 0.
    modes : ModalBasis, optional
        Elastic modes; without them the body is rigid.
    rigid : ModalBasis, optional
        Rigid motions, as modes of frequency zero, of a plate that supports leave free, or of a
        sphere in its place.
    inertia : float or array, optional
        Moment of inertia of a sphere about any axis through its centre [kg m^2], > 0; by default
        that of the `inertia_ratio` of an `Oblique`, which is that of a solid ball.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> ball = vi.Body(mass=0.09, contact_offset=0.025)
    >>> table = vi.Body(mass=float("inf"), contact_offset=0.0)
    >>> law = vi.laws.find_contact_law("newton")(restitution=0.5)
    >>> vi.tabulate(vi.Problem(sphere=ball, plate=table, laws=(law,), height=1.0)).impacts[
    ...     "rebound_height_m"
    ... ].shape
    (5,)
    """

    mass: Array
    contact_offset: Array
    modes: ModalBasis | None = None
    rigid: ModalBasis | None = None
    inertia: Array | None = None

    def __post_init__(self) -> None:
        for name in ("mass", "contact_offset", "inertia"):
            value = getattr(self, name)
            if isinstance(value, (list, tuple)):
                object.__setattr__(self, name, np.asarray(value, dtype=float))
        if not np.all(np.asarray(self.mass) > 0):
            raise InputError("the mass of a body must be positive [kg]")
        if not np.all(np.asarray(self.contact_offset) >= 0):
            raise InputError("the contact offset of a body must not be negative [m]")
        if self.inertia is not None:
            is_possible = np.isfinite(self.inertia) & (np.asarray(self.inertia) > 0)
            if not np.all(is_possible):
                raise InputError(
                    "the moment of inertia of a body must be positive and finite [kg m^2]",
                    "inertia",
                )
