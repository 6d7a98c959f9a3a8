"""The motion along the plate in a contact of rigid bodies, driven by its normal motion.

The normal motion does not feel friction.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.followed_motion import followed_path
from vibroimpact.dynamics.core.friction_records import ELASTIC, Rubbing
from vibroimpact.dynamics.core.law import law_at_touch
from vibroimpact.dynamics.core.line_records import ContactManner, LineManner
from vibroimpact.dynamics.core.lines import room_of, solve_pair, with_bodies
from vibroimpact.dynamics.core.normal_motion import written_path
from vibroimpact.dynamics.core.normal_records import TIME, NormalGrid, NormalPath
from vibroimpact.dynamics.core.records import (
    Law,
)
from vibroimpact.dynamics.core.resisted_contact import resisted_end, resisted_path
from vibroimpact.dynamics.core.sliding_paths import DISPLACEMENT, VELOCITY, slide_elastically
from vibroimpact.dynamics.core.sphere_contact import (
    Change,
    FirstSlip,
    change_beside,
    first_slip,
    slide_impulsively,
    state_along,
)
from vibroimpact.dynamics.core.sphere_records import (
    RubbedSphere,
    SphereState,
    sphere_of,
    state_of,
    tangential_mass,
    write_state,
)


class SlidPath(NamedTuple):
    """The motion along the plate in a contact, along its first slip.

    slip: at first touch. path (3, G): velocities of the contact point [m/s], displacements [m] and
    friction against the slip [N]. change: what else changes by the end. microslip: energy lost
    while a part of the contact sticks [J].
    """

    slip: FirstSlip
    path: Matrix
    change: Change
    microslip: float


class Rubbed(NamedTuple):
    """The end of a contact: the state of the sphere, and the energy lost in microslip [J]."""

    end: SphereState
    microslip: float


@compiled
def normal_path(solved: bool, law: Law, bodies: LineManner, grid: NormalGrid) -> NormalPath:
    """Return the normal motion of a contact, which is on the grid if it was solved by
    collocation.
    """
    if solved:
        return written_path(grid)
    return followed_path(law, bodies, grid.steps)


@compiled
def solved_path(law: Law, bodies: LineManner, contacts: ContactManner) -> NormalPath:
    """Solve a contact again, and return its normal motion."""
    room = room_of(contacts.rules)
    solved, _ = solve_pair(law, bodies, contacts.rules, contacts.grid, contacts.collocates, room)
    return normal_path(solved, law, bodies, contacts.grid)


@compiled
def slid_path(
    rubbing: Rubbing,
    coefficients: Vector,
    sphere: RubbedSphere,
    begun: SphereState,
    normal: NormalPath,
) -> SlidPath:
    """Return the motion along the plate in a contact, along its first slip; see `rub`."""
    slip = first_slip(sphere, begun)
    mass = tangential_mass(sphere)
    path = np.empty((3, normal.rows.shape[1]))
    microslip = 0.0
    if rubbing.kind == ELASTIC:
        microslip = slide_elastically(
            rubbing, coefficients, slip.speed, slip.pull, mass, normal, path
        )
    else:
        slide_impulsively(rubbing.addresses, coefficients, slip, mass, normal, path)
    change = change_beside(sphere, begun, slip, normal, path)
    return SlidPath(slip, path, change, microslip)


@compiled
def rub(
    rubbing: Rubbing,
    coefficients: Vector,
    sphere: RubbedSphere,
    begun: SphereState,
    normal: NormalPath,
) -> Rubbed:
    """Return the end of a contact with friction.

    Where rolling is resisted while friction is elastic, both have to be followed together.

    Parameters
    ----------
    rubbing : Rubbing
        The friction law.
    coefficients : array, shape (K,)
        Of it in this contact.
    sphere : RubbedSphere
        The sphere.
    begun : SphereState
        Its state at first touch.
    normal : NormalPath
        The normal motion.
    """
    if rubbing.kind == ELASTIC and sphere.rolling_coefficient > 0.0:
        resisted = resisted_path(rubbing, coefficients, sphere, begun, normal)
        return Rubbed(resisted_end(sphere, begun, resisted), resisted.microslip)
    slid = slid_path(rubbing, coefficients, sphere, begun, normal)
    last = len(normal.steps)
    end = state_along(
        sphere,
        begun,
        slid.slip,
        slid.change,
        normal.rows[TIME, last],
        slid.path[VELOCITY, last],
        slid.path[DISPLACEMENT, last],
        1.0,
    )
    return Rubbed(end, slid.microslip)


@compiled
def rub_pairs(
    contacts: ContactManner,
    coefficients: Matrix,
    touches: Matrix,
    rubbing: Rubbing,
    friction: Matrix,
    spheres: Matrix,
    states: Matrix,
    ends: Matrix,
    microslips: Vector,
) -> None:
    """Write the ends of B contacts with friction.

    Parameters
    ----------
    contacts : ContactManner
        How contacts are solved.
    coefficients, touches : array, shape (B, K), (5, B)
        Of the contact law in each, and the bodies as they touch; see `lines.follow_lines`.
    rubbing : Rubbing
        The friction law.
    friction : array, shape (B, K)
        Its coefficients in each contact.
    spheres, states : array, shape (B, 8), (B, 7)
        Of each the members of `RubbedSphere` and `SphereState`, at first touch.
    ends, microslips : array, shape (B, 7), (B,)
        Room for the states at the end, and for the energies lost in microslip [J].
    """
    series = np.zeros(7)
    for pair in range(len(states)):
        law = law_at_touch(contacts.addresses, coefficients[pair], series, touches[2, pair])
        bodies = with_bodies(
            contacts.manner, touches[0, pair], touches[1, pair], touches[3, pair], touches[4, pair]
        )
        normal = solved_path(law, bodies, contacts)
        rubbed = rub(
            rubbing, friction[pair], sphere_of(spheres[pair]), state_of(states[pair]), normal
        )
        write_state(ends[pair], rubbed.end)
        microslips[pair] = rubbed.microslip
