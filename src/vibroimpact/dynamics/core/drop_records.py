"""What the core follows rigid drops with, from their starts to the ends of their runs.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Integers, Matrix, Vector
from vibroimpact.dynamics.core.friction_records import Rubbing
from vibroimpact.dynamics.core.line_records import ContactManner

(
    MASS,
    RADIUS,
    GRAVITY,
    REST_SPEED,
    TIME,
    GAP,
    VELOCITY,
    CLOSING,
    DEEPEST,
    DENT,
    DISSIPATED,
    PLASTIC,
    STORED,
    WRITTEN_OFF,
    SAG,
    REST_TIME,
    END_TIME,
    INERTIA,
) = range(18)
"""State of a drop: mass [kg], radius [m], gravity [m/s^2] and rest speed [m/s]; time [s], gap [m]
and upward velocity [m/s]; approach speed at its touch [m/s]; deepest indentation so far, and where
it touches next [m]; energy lost in damping and in plastic work, stored in the contact and written
off at rest [J]; static indentation [m]; when rest and the end of the run are [s]; mass that is
accelerated in flight over that of the sphere.
"""

STATES = 18

RUBBED, MICROSLIP = range(2)
"""Energies that friction has taken so far, and the part of it that was lost in microslip [J]."""

FIRST_FURTHER = 15
COLUMNS = FIRST_FURTHER + 6
OBLIQUE_COLUMNS = COLUMNS + 19
"""How many numbers an impact has: those of its table; with further ones; with those of the motion
along the plate.
"""

(
    IMPACT,
    TOUCH,
    DURATION,
    APPROACH,
    SEPARATION,
    RESTITUTION,
    INDENTATION,
    FORCE,
    ACCELERATION,
    REBOUND,
    LOST,
    PLASTIC_WORK,
    ASKED,
    TIME_OF_INDENTATION,
    TIME_OF_FORCE,
) = range(FIRST_FURTHER)
"""Columns of the table of impacts, in the order of `columns.IMPACT_COLUMNS`."""

COMPRESSION, DAMPED, RELEASE_GAP, RELEASE_VELOCITY, LEFT_STORED, DENT_BEFORE = range(
    FIRST_FURTHER, COLUMNS
)
"""Further ones: duration of the compression [s], energy lost in damping [J]; gap [m], upward
velocity [m/s] and stored energy [J] at the end of the contact; the deepest indentation there before
it [m].
"""

ALONG = COLUMNS
"""The first of those of the motion along the plate, in the order of
`columns.OBLIQUE_IMPACT_COLUMNS`.
"""

TANGENTIAL_RESTITUTION, REBOUND_ANGLE, FRICTION_LOST, MICROSLIP_LOST, GROSS_SLIP_LOST = range(
    COLUMNS + 12, COLUMNS + 17
)

RELEASE_X, RELEASE_Y = range(COLUMNS + 17, OBLIQUE_COLUMNS)
"""Further ones: where the centre is at the end of the contact [m]."""

AT_START, IN_FLIGHT, AT_TOUCH = -3, -2, -1
"""Phases of the run of a drop; one that has ended has the number of its ending."""

END_BY_DURATION, END_BY_REST_SPEED, END_CAPTURED, END_STUCK, END_LEFT = range(1, 6)
END_FAILED, END_RIDING = 7, 8
"""Endings that the core decides, by the codes that they have in `Outcome`; those of stop rules come
with these.
"""


class StopRules(NamedTuple):
    """Rules that end a run in a flight (S,): kinds, of `stop_rules`, their values, and the endings
    to which they lead.
    """

    kinds: Integers
    values: Vector
    endings: Integers


class DropManner(NamedTuple):
    """What stays the same for all drops of a batch.

    contacts: how contacts are solved. has_force: has the law a force, so that there are any? lasts:
    does the memory of the law last from impact to impact? waits: does a drop wait at its touch for
    what the law is at the approach speed? is_told_flights: does it wait before each flight for
    that? stops: rules that end runs in flight.
    """

    contacts: ContactManner
    has_force: bool
    lasts: bool
    waits: bool
    is_told_flights: bool
    stops: StopRules


class Drops(NamedTuple):
    """State of B drops, and room for R impacts of each.

    phases (B,): of those above, or how the run ended. impacts, flights (B,): how many there were.
    state (B, 18). rows (B, R, 21 or 40): the table of impacts, with the further columns.

    laws (B, L, K): coefficients of the law of each impact, of which the last one goes on. at_touch
    (B, K): those at the approach speed of a touch, where they depend on it; of a law without a
    force its separation speed [m/s]. coefficients (B, K): of the next impact, with the memory of
    earlier ones.
    """

    phases: Integers
    impacts: Integers
    flights: Integers
    state: Matrix
    rows: Cube
    laws: Cube
    at_touch: Matrix
    coefficients: Matrix


class ObliqueDrops(NamedTuple):
    """What B drops have that move along the plate, too.

    rubbing: the law of their friction. half_x, half_y: half the sides of the plate [m]. spheres (B,
    8), along (B, 7): the members of `RubbedSphere` and `SphereState`. friction (B, F): coefficients
    of the law. taken (B, 2): the energies above.
    """

    rubbing: Rubbing
    half_x: float
    half_y: float
    spheres: Matrix
    along: Matrix
    friction: Matrix
    taken: Matrix


class FreeFall(NamedTuple):
    """A flight above a plate: start, top and next touch [s], and the speed of that [m/s]; times are
    infinite if they do not come. speed: NaN where bodies vibrate, and in flights of a single drop
    that Python makes (`ToldFlights`). is_beside: is the centre beside the plate at the touch?
    """

    start: float
    top: float
    touch: float
    speed: float
    is_beside: bool
