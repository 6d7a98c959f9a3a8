"""What the core follows rigid drops with, from their starts to the ends of their runs.

The annotations name the types of compiled code, in `vibroimpact.compiler.types`.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Integers
from vibroimpact.dynamics.core.line_records import LineManner
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase_records import PhaseRules
from vibroimpact.dynamics.core.records import Boolean, Cube, Matrix, Real, Vector

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
    DISSIPATED,
    PLASTIC,
    STORED,
    WRITTEN_OFF,
    SAG,
    REST_TIME,
    END_TIME,
) = range(16)
"""State of a drop: mass [kg], radius [m], gravity [m/s^2] and rest speed [m/s]; time [s], gap [m]
and upward velocity [m/s]; approach speed at its touch [m/s]; deepest indentation so far [m]; energy
lost in damping and in plastic work, stored in the contact and written off at rest [J]; static
indentation [m]; when rest and the end of the run are [s].
"""

STATES = 16

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
) = range(15)
"""Columns of the table of impacts, in the order of `columns.IMPACT_COLUMNS`."""

COMPRESSION, DAMPED, RELEASE_GAP, RELEASE_VELOCITY, LEFT_STORED = range(15, 20)
"""Further ones: duration of the compression [s], energy lost in damping [J], and gap [m], upward
velocity [m/s] and stored energy [J] at the end of the contact.
"""

COLUMNS = 20

AT_START, IN_FLIGHT, AT_TOUCH = -3, -2, -1
"""Phases of the run of a drop; one that has ended has a number of `ENDINGS`."""

ENDINGS = (
    "number of impacts",
    "duration",
    "at rest: rest speed",
    "at rest: contact without release",
    "at rest: stuck",
    "left for good",
    "limit of impacts",
    "failed",
)
"""Reasons for the end of a run, by their numbers."""

(
    END_BY_IMPACTS,
    END_BY_DURATION,
    END_BY_REST_SPEED,
    END_CAPTURED,
    END_STUCK,
    END_LEFT,
    END_AT_LIMIT,
    END_FAILED,
) = range(len(ENDINGS))


class StopRules(NamedTuple):
    """Rules that end a run in a flight (S,): kinds, of `stop_rules`, their values, and the endings
    to which they lead.
    """

    kinds: Integers
    values: Vector
    endings: Integers


class ContactManner(NamedTuple):
    """How contacts are solved: as `lines.follow_lines` takes it, with the addresses (4,) of the
    functions of the law.
    """

    manner: LineManner
    rules: PhaseRules
    grid: NormalGrid
    collocates: Boolean
    addresses: Integers


class DropManner(NamedTuple):
    """What stays the same for all drops of a batch.

    contacts: how contacts are solved. has_force: has the law a force, so that there are any? lasts:
    does the memory of the law last from impact to impact? waits: does a drop wait at its touch for
    what the law is at the approach speed? stops: rules that end runs in flight.
    """

    contacts: ContactManner
    has_force: Boolean
    lasts: Boolean
    waits: Boolean
    stops: StopRules


class Drops(NamedTuple):
    """State of B drops, and room for R impacts of each.

    phases (B,): of those above, or how the run ended. impacts, flights (B,): how many there were.
    state (B, 16). rows (B, R, 20): the table of impacts, with the further columns. laws (B, L, K):
    coefficients of the law of each impact, of which the last one goes on. at_touch (B, K): those at
    the approach speed of a touch, where they depend on it; of a law without a force its separation
    speed [m/s]. coefficients (B, K): of the next impact, with the memory of earlier ones.
    """

    phases: Integers
    impacts: Integers
    flights: Integers
    state: Matrix
    rows: Cube
    laws: Cube
    at_touch: Matrix
    coefficients: Matrix


class FreeFall(NamedTuple):
    """A flight above a plate at rest: start, top and next touch [s], and the speed of that [m/s];
    times are infinite if they do not come.
    """

    start: Real
    top: Real
    touch: Real
    speed: Real
