"""A linear system reduced to some of its contacts, as the core takes it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.core.contact_records import Bodies
from vibroimpact.dynamics.core.records import Coordinates, Start, Surfaces
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State

# relative rounding error of the kinetic energy of the rigid motions that move the contacts
_RIGID_ROUNDING = 2e-15
# relative rounding error of the energy of the modes, which may far exceed that of a soft contact
_ROUNDING = 2e-14


class ContactModes:
    """The modes and massless elements of a system, restricted to some of its contacts.

    `rigid`: number of rigid motions, which are the first coordinates. `inside`: does a mode lie
    within the contacts? `shapes` (1 or 2, c, m), `frequency_squared`, `damping` (m,), `rate` (k,),
    `incidence`, `mobility` (c, k): as in `core.records.Surfaces`.
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int]) -> None:
        rows = list(contacts)
        self.rigid = int(system.rigid.sum())
        assert system.rigid[: self.rigid].all()  # rigid motions come first
        vibrating = slice(self.rigid, None)
        self.frequency_squared = system.angular_frequency[vibrating] ** 2
        self.damping = np.ascontiguousarray(system.damping[vibrating])
        outer = system.outer_shape[rows][:, vibrating]
        inner = system.inner_shape[rows][:, vibrating]
        self.inside = bool(inner.any())
        parts = [outer, inner] if self.inside else [outer]
        self.shapes = np.stack(parts)
        self.rate = system.rate
        self.incidence = np.ascontiguousarray(system.local_incidence[rows])
        self.mobility = self.incidence * system.mobility


class ContactView:
    """A linear system reduced to some of its contacts.

    `modes`: its modes, which several systems may share. `surfaces`, `coordinates`: what the core
    computes with.
    """

    def __init__(self, system: LinearSystem, contacts: Sequence[int], modes: ContactModes) -> None:
        rows = list(contacts)
        self.system = system
        self.contacts = rows
        self.modes = modes
        self.rigid_shapes = np.ascontiguousarray(system.shape[rows][:, : modes.rigid])
        self.offset = system.offset[rows]
        self.surfaces = Surfaces(
            frequency_squared=modes.frequency_squared,
            damping=modes.damping,
            shapes=modes.shapes,
            rigid_pairs=self.rigid_shapes @ self.rigid_shapes.T,
            mass=np.ascontiguousarray(system.mass[rows]),
            gravity=np.ascontiguousarray(system.gravity[rows]),
            rate=modes.rate,
            incidence=modes.incidence,
            mobility=modes.mobility,
        )

    @property
    def mass(self) -> Floats:
        """Effective masses of the rigid motions at the contacts [kg] (c,)."""
        return self.surfaces.mass

    @property
    def active_rigid(self) -> Bools:
        """Mask of the rigid motions that move the contacts (n,)."""
        return np.asarray(self.system.rigid_shape[self.contacts].any(axis=0))

    @cached_property
    def coordinates(self) -> Coordinates:
        """All coordinates of the system."""
        system = self.system
        return Coordinates(
            frequency=system.angular_frequency,
            damping=system.damping,
            load=system.load,
            rigid_shapes=self.rigid_shapes,
            driven_shapes=np.ascontiguousarray(
                system.shape[self.contacts][:, system.number - system.driven :]
            ),
            rate=system.rate,
            mobility=system.mobility,
            rounding=np.where(system.rigid, _RIGID_ROUNDING * self.active_rigid, _ROUNDING),
        )

    @property
    def sliding(self) -> ContactView:
        """The system reduced to its contact and the directions of friction at it, of a drop.

        It is the view itself where there are none.
        """
        if self.system.along is None:
            return self
        return contact_view(self.system.sliding, range(1 + len(self.system.along)))

    @cached_property
    def bodies(self) -> Bodies:
        """The system as the core takes it.

        The directions of friction are further contacts where there are any.
        """
        system = self.system.record_of(self.contacts[0])
        return Bodies(
            system, self.surfaces, self.coordinates, self.sliding.surfaces, self.sliding.coordinates
        )

    @property
    def bodies_without_load(self) -> Bodies:
        """The same without gravity and gaps, for the difference of two motions.

        It is that of a drop without friction: one with friction has no sensitivity.
        """
        bodies = self.bodies
        load = np.zeros_like(bodies.system.load)
        surfaces = bodies.surfaces._replace(gravity=np.zeros_like(bodies.surfaces.gravity))
        coordinates = bodies.coordinates._replace(load=load)
        return Bodies(
            bodies.system._replace(load=load, offset=0.0, gravity=0.0),
            surfaces,
            coordinates,
            surfaces,
            coordinates,
        )

    def start(self, state: State) -> Start:
        """Return the state of the surfaces in a state of the system."""
        modes = self.modes
        rigid = slice(0, modes.rigid)
        vibrating = slice(modes.rigid, None)
        displacement = np.ascontiguousarray(state.displacement[vibrating])
        velocity = np.ascontiguousarray(state.velocity[vibrating])
        # y = y_0 + sum of chi q over rigid motions and modes + sum of r over massless elements
        rigid_approach = self.rigid_shapes @ state.displacement[rigid]
        approach = rigid_approach + modes.shapes.sum(axis=0) @ displacement
        approach = self.offset + approach + modes.incidence @ state.local
        # the dashpot of the law has the rate outside the contact alone
        rigid_rate = self.rigid_shapes @ state.velocity[rigid]
        outer_rate = rigid_rate + modes.shapes[0] @ velocity
        inner_rate = np.zeros_like(outer_rate)
        if modes.inside:
            inner_rate = modes.shapes[1] @ velocity
        return Start(displacement, velocity, state.local, approach, outer_rate, inner_rate)


def contact_view(system: LinearSystem, contacts: Iterable[int]) -> ContactView:
    """Return a system reduced to some of its contacts; cached."""
    numbers = tuple(contacts)
    if numbers not in system.views:
        if numbers not in system.shared_modes:
            system.shared_modes[numbers] = ContactModes(system, numbers)
        system.views[numbers] = ContactView(system, numbers, system.shared_modes[numbers])
    view: ContactView = system.views[numbers]
    return view
