"""What the core computes the contact of two rigid bodies with.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Bools, Integers, Matrix, Vector
from vibroimpact.compiled import Address
from vibroimpact.dynamics.core.normal_records import NormalGrid
from vibroimpact.dynamics.core.phase_records import PhaseRules


class Line(NamedTuple):
    """Two rigid bodies in contact, with the indentation as their only coordinate.

    force, energies: addresses of the functions of the law. coefficients (K,): of the law, with its
    memory. speed: at touch [m/s]. release: indentation at release [m]. root: power of the
    indentation in whose root the force is smooth, 2 or 4. mass: effective [kg]. gravity [m/s^2].
    span: approximate duration of a contact [s]. Errors allowed in a step: root_scale of the root of
    the indentation, speed_scale [m/s], time_scale [s], energy_scale [J].
    """

    force: Address
    energies: Address
    coefficients: Vector
    speed: float
    release: float
    root: int
    mass: float
    gravity: float
    span: float
    root_scale: float
    speed_scale: float
    time_scale: float
    energy_scale: float


class LineState(NamedTuple):
    """State of the contact of two rigid bodies: time since touch [s], indentation delta
    [m], its rate [m/s], energy lost in damping [J].
    """

    time: float
    delta: float
    rate: float
    lost: float


class Advance(NamedTuple):
    """A step of the contact of two rigid bodies: the state after it, its error over the
    tolerance, its least and its last force [N].
    """

    state: LineState
    error: float
    least_force: float
    force: float


class Bracket(NamedTuple):
    """Two places between which a function changes its sign, its values there, and which
    end was moved last, of `line_events`.
    """

    low: float
    high: float
    low_value: float
    high_value: float
    moved: int


class LineManner(NamedTuple):
    """Two rigid bodies as they touch, and what stays the same through their contact.

    root: power of the indentation in whose root the force is smooth. tension, contact_end: numbers
    of the law's, of `events`. mass: effective [kg]. gravity [m/s^2]. depth: largest indentation
    without damping [m]. speed_scale: of the speed in contact [m/s]. tolerance: relative error
    allowed in a step. most_steps: how many steps are tried.
    """

    root: int
    tension: int
    contact_end: int
    mass: float
    gravity: float
    depth: float
    speed_scale: float
    tolerance: float
    most_steps: int


class LineSteps(NamedTuple):
    """Room for P steps of the contact of two rigid bodies.

    variable (P,): of `line_step`. after (P,): has the deepest point been passed, so that the law
    has its memory of it? begun (P, 4): time [s], indentation [m], its rate [m/s] and energy lost
    [J] at the start. length (P,): in the variable. written (1,): number of steps; those for which
    there is no room are counted.
    """

    variable: Integers
    after: Bools
    begun: Matrix
    length: Vector
    written: Integers


class LineContact(NamedTuple):
    """The contact of two rigid bodies: its outcome, of `core.line`, and how it ended.

    end: the state at its end. deepest: largest indentation [m]. time_of_deepest [s]. peak_force
    [N], time_of_peak_force [s]. plastic: plastic work [J]. stored: energy left in the contact [J].
    All times are since touch.
    """

    outcome: int
    end: LineState
    deepest: float
    time_of_deepest: float
    peak_force: float
    time_of_peak_force: float
    plastic: float
    stored: float


class LineContacts(NamedTuple):
    """Room for the contacts of B pairs of rigid bodies.

    outcomes (B,): of `core.line`. ends (10, B): duration [s], indentation [m] and its rate at the
    end [m/s], energy lost in damping [J], deepest indentation [m] and its time [s], largest force
    [N] and its time [s], plastic work and stored energy [J].
    """

    outcomes: Integers
    ends: Matrix


class ContactManner(NamedTuple):
    """How contacts are solved.

    manner: what all have in common, without bodies. rules: the Gauss rules of the collocation.
    grid: that of normal motions. collocates: is collocation tried? addresses (4,): the functions of
    the law.
    """

    manner: LineManner
    rules: PhaseRules
    grid: NormalGrid
    collocates: bool
    addresses: Integers


class ContactRoom(NamedTuple):
    """Room in which contacts are solved one after the other.

    nodes (19, M): of a collocated segment. steps: none, which are counted only. series (7,): a
    compliance in series that is none.
    """

    nodes: Matrix
    steps: LineSteps
    series: Vector
