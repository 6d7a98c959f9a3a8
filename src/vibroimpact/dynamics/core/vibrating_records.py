"""What the core follows drops with whose bodies vibrate.

The annotations name the types of compiled code. The numbers of a
drop, its phases and endings, and the columns of its impacts are those of `drop_records`, and these.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Integers, Matrix, Vector
from vibroimpact.dynamics.core.contact_records import Manner, Progress
from vibroimpact.dynamics.core.drop_records import COLUMNS, StopRules
from vibroimpact.dynamics.core.records import (
    Law,
    State,
)

IN_CONTACT, NEAR_REST, HELD = -4, -5, -6
"""Further phases of a run: in a contact; in one near equilibrium, which is to be looked at; in one
that holds the sphere for good, as was found.
"""

CLOSING_SPEED, CONTACTS, TO_VIBRATION, DRIVE_WORK, SURFACE_VELOCITY, FIRST_PART, FIRST_LAW = range(
    COLUMNS, COLUMNS + 7
)
"""Further columns of an impact: closing speed of the surfaces [m/s]; number of contacts; energy
that the impact gave to vibration [J]; work of what drives the plate [J], and the velocity with
which that moves the surface at touch [m/s]; numbers of its first part and of its first law.
"""

VIBRATING_COLUMNS = COLUMNS + 7


class ImpactManner(NamedTuple):
    """What stays the same through the run of a drop.

    addresses, series (7,): of the law, as in `Law`. tension, contact_end, tolerance: as in
    `Manner`. lasts: does the law keep its memory from impact to impact? recovers: does it lose it
    as soon as the surfaces part? longest: length of a stretch [s], and of_contact: with friction,
    as a part of the duration of a contact. most_steps: how many stretches are tried in an impact.
    run_end [s]. waits: does a drop wait before each flight and at each touch? stops: rules that end
    runs in flight.
    """

    addresses: Integers
    series: Vector
    tension: int
    contact_end: int
    tolerance: float
    lasts: bool
    recovers: bool
    longest: float
    of_contact: float
    most_steps: int
    run_end: float
    waits: bool
    stops: StopRules


class VibratingDrop(NamedTuple):
    """A drop whose bodies vibrate, and what is written of it.

    counts (1,): impacts so far. state (18,): the numbers of `drop_records`. lost (n +
    1,): energy lost so far in each coordinate, and last in massless elements [J]. lost_in_impact (n
    + 1,): in the impact under way, last in its contacts. rows (R, 28): the table of impacts. laws
    (I, K): coefficients of the law of each impact, of which the last one goes on. coefficients
    (K,): of the next contact, with the memory of earlier ones.
    """

    counts: Integers
    state: Vector
    lost: Vector
    lost_in_impact: Vector
    rows: Matrix
    laws: Matrix
    coefficients: Vector


IMPACTS = 0
"""Place of `VibratingDrop.counts`."""


class Now(NamedTuple):
    """Where a drop is: its phase, and the state of its bodies. In an impact: begun, the state at
    first touch; law, manner, progress: of the contact; contacts: how many there were.
    """

    phase: int
    state: State
    begun: State
    law: Law
    manner: Manner
    progress: Progress
    contacts: int
