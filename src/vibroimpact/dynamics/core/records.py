"""What the core computes with: arrays, gathered in named tuples.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Integers, Matrix, Vector

MAPS = ("touch", "inside", "release")
"""Maps of the time of a stretch, by their numbers."""


class Basis(NamedTuple):
    """A Radau rule of N nodes under a time map, and the eigenbasis of its integration matrix with H
    eigenvalues, one of each pair.

    time (N,): of the nodes, as a part of the length. integral, integral_twice (N, N): integrals up
    to the nodes. spectrum (N, N): from values at the nodes to Legendre coefficients. at_start (N,):
    weights of the nodes in the value at the start. at_end (N,): weights in the time derivative at
    the end, times the length; zero where the nodes do not tell it. places, barycentric (N + 1,):
    the start and the nodes as parts of the stretch, and their weights in interpolation. grid (G, N
    + 1): weights of the start and the nodes in the values at evenly spaced points. forces_between,
    displacements_between (S, N): weights of the nodes at S points, as many from each node to the
    next, in a polynomial through them, and in one that is zero at the start. time_map, root: the
    map, of `MAPS`, and its power. eigenvalues, one, clock (2, H): real and imaginary parts of the
    eigenvalues, and of the function one and the time in the eigenbasis. forward (N, 2 H): from
    values at the nodes to the eigenbasis; backward (2 H, N): back to the nodes. filters (2 H, N N):
    from an operator that is diagonal in the eigenbasis to its matrix on the nodes.
    """

    time: Vector
    integral: Matrix
    integral_twice: Matrix
    spectrum: Matrix
    at_start: Vector
    at_end: Vector
    places: Vector
    barycentric: Vector
    grid: Matrix
    forces_between: Matrix
    displacements_between: Matrix
    time_map: int
    root: int
    eigenvalues: Matrix
    one: Matrix
    clock: Matrix
    forward: Matrix
    backward: Matrix
    filters: Matrix


class State(NamedTuple):
    """State of a linear system: displacement, velocity of the coordinates (n,); local:
    deformations of massless elements [m] (k,).
    """

    displacement: Vector
    velocity: Vector
    local: Vector


class Flight(NamedTuple):
    """A free motion of some time [s]: displacements of the coordinates after it by displacements
    and by velocities [s] at its start (n,).

    fading (k,): what it leaves of the deformations of the massless elements.
    """

    time: float
    by_displacement: Vector
    by_velocity: Vector
    fading: Vector


class System(NamedTuple):
    """A linear system with one contact: n coordinates of unit mass, rigid motions first, driven
    ones last, and k massless elements.

    frequency [rad/s], ratio: damping ratio, damping [1/s], load: acceleration by gravity [kg^1/2
    m/s^2] (n,). shape (n,): approach of the surfaces by each coordinate, outer_shape: by those
    outside the contact, indentation_shape: by those that count in the indentation [kg^-1/2]. rate
    [1/s], mobility [m/(N s)] (k,): of the massless elements. offset [m], gravity [m/s^2], mass
    [kg]: of the approach. compliance [m/N]: static one of modes and massless elements, and
    flexibility [s^2], the sum of the inverse squared frequencies. rigid, driven: how many
    coordinates are.
    """

    frequency: Vector
    ratio: Vector
    damping: Vector
    load: Vector
    shape: Vector
    outer_shape: Vector
    indentation_shape: Vector
    rate: Vector
    mobility: Vector
    offset: float
    gravity: float
    mass: float
    compliance: float
    flexibility: float
    rigid: int
    driven: int


class Approach(NamedTuple):
    """Approach of the surfaces of one contact in free motion [m], and its rate [m/s].

    rigid, rigid_rate: what the rigid motions contribute. Of vibration and massless elements from
    then on, reach: a bound of the displacement [m], and fastest: of the acceleration [m/s^2].
    terms: sum of the magnitudes of what the approach is the sum of [m].
    """

    approach: float
    rate: float
    rigid: float
    rigid_rate: float
    reach: float
    fastest: float
    terms: float


class Law(NamedTuple):
    """A contact law of one contact, with its memory and the compliance in series.

    addresses (4,): of its functions. coefficients (K,). series (7,). speed: closing speed at touch
    [m/s]. touch, release: indentations of the law at which contact begins and ends [m].
    release_level: approach of the surfaces at release [m]. memory_level: indentation beyond which
    compression changes the memory [m]. first_breakpoint, second_breakpoint: indentations at which
    the force is not smooth [m]. jump: energy that an adhesive law and the compliance in series
    store as they jump into contact, relative to the law alone [J].
    """

    addresses: Integers
    coefficients: Vector
    series: Vector
    speed: float
    touch: float
    release: float
    release_level: float
    memory_level: float
    first_breakpoint: float
    second_breakpoint: float
    jump: float


class Surfaces(NamedTuple):
    """What moves the surfaces at c contacts: m modes, rigid motions, and k massless elements of a
    spring parallel to a dashpot.

    frequency_squared [1/s^2], damping [1/s] (m,): of the modes. shapes (1 or 2, c, m): approach of
    the surfaces by each mode, outside the contacts and, if any lies inside, within them.
    rigid_pairs (c, c): sums of products of the shapes of rigid motions [1/kg]. mass (c,): effective
    mass of these [kg]. gravity (c,): acceleration of the approach [m/s^2]. rate (k,): stiffness
    over damping of the massless elements [1/s]. incidence (c, k): which of them is in series with
    which contact. mobility (c, k): one over their damping there [m/(N s)].
    """

    frequency_squared: Vector
    damping: Vector
    shapes: Cube
    rigid_pairs: Matrix
    mass: Vector
    gravity: Vector
    rate: Vector
    incidence: Matrix
    mobility: Matrix


class Start(NamedTuple):
    """State of the surfaces at the start of a stretch.

    displacement, velocity (m,): of the modes. local (k,): deformation of the massless elements [m].
    Of each contact (c,): approach of the surfaces [m], and its rate by coordinates outside the
    contact, outer_rate, and within it, inner_rate [m/s].
    """

    displacement: Vector
    velocity: Vector
    local: Vector
    approach: Vector
    outer_rate: Vector
    inner_rate: Vector


SPEED, TOUCH, RELEASE, RELEASE_LEVEL, MEMORY_LEVEL, FIRST_BREAKPOINT, SECOND_BREAKPOINT, JUMP = (
    range(8)
)
"""Columns of the numbers of a law, which are named as in `Law`."""


class Contacts(NamedTuple):
    """The laws at c contacts that push, one after the other.

    addresses (4 c,), coefficients (c, K), series (c, 7): as in `Law`. numbers (c, 8): the columns
    above. tension (c,): may the force be tensile? Of `events`.
    """

    addresses: Integers
    coefficients: Matrix
    series: Matrix
    numbers: Matrix
    tension: Integers


class Nodes(NamedTuple):
    """Unknowns at the nodes of c contacts (c N,): static part of the forces and force
    [N], and indentation delta of the laws [m].
    """

    static: Vector
    force: Vector
    delta: Vector


class Event(NamedTuple):
    """An event within a stretch: its kind, the indentation of the law at it [m], x, the part of the
    stretch at which it is met, and the contact that it belongs to.
    """

    kind: int
    level: float
    x: float
    contact: int


class End(NamedTuple):
    """What ends a stretch: its kind, of `stretch`; the indentation of the law then, if
    that is it [m]; and the contact it belongs to.
    """

    kind: int
    level: float
    contact: int


class ModalWeights(NamedTuple):
    """Weights of the modes in sums over them (W, m), and their extent in each row (W,).

    first: the first mode with a weight. last: the one after the last.
    """

    values: Matrix
    first: Integers
    last: Integers


class Motion(NamedTuple):
    """Motion of the surfaces at the nodes of all contacts, M = c N: without contact forces, and by
    these.

    Without contact forces (M,): approach [m], its rate by coordinates outside the contacts and
    closing, its whole rate [m/s]. To be subtracted, per force at the nodes (M, M):
    approach_by_force, rate_by_force, and, of the static forces on coordinates within the contacts,
    approach_by_static and closing_by_static; the latter are (0, 0) where there are none. weights,
    sums (2, W, H): the sums over the modes that it consists of, as `receptance.modal_sums` gives
    them.
    """

    approach: Vector
    rate: Vector
    closing: Vector
    approach_by_force: Matrix
    rate_by_force: Matrix
    approach_by_static: Matrix
    closing_by_static: Matrix
    weights: ModalWeights
    sums: Cube


class Histories(NamedTuple):
    """Motion and energy of c contacts through a stretch.

    At the start and the nodes (c, N + 1): approach of the surfaces [m], its rate at the dashpots
    and closing, its whole rate [m/s], and delta, the indentation of the laws [m]. dissipated (c,):
    work of the dissipative forces [J]. roughness: the last Legendre coefficients of the forces,
    relative to their scale.
    """

    approach: Matrix
    rate: Matrix
    closing: Matrix
    delta: Matrix
    dissipated: Vector
    roughness: float


class Coordinates(NamedTuple):
    """All n coordinates of a system: first the rigid motions, then the modes, the last of which may
    be driven.

    frequency [rad/s], damping [1/s], load: acceleration by gravity [kg^1/2 m/s^2] (n,).
    rigid_shapes (c, r): approach of the surfaces of the contacts by each rigid motion;
    driven_shapes (c, d): by each driven coordinate. rate [1/s], mobility [m/(N s)] (k,): of the
    massless elements. rounding (n,): relative rounding error of the energy of each,
    zero of rigid motions that no contact moves.
    """

    frequency: Vector
    damping: Vector
    load: Vector
    rigid_shapes: Matrix
    driven_shapes: Matrix
    rate: Vector
    mobility: Vector
    rounding: Vector


class Path(NamedTuple):
    """Motion of all coordinates through a stretch.

    At the nodes: velocity of the coordinates (N, n), their acceleration (N, n), or (0, n) where it
    is not asked for, and rates of the massless elements, massless (k, N). At the end: displacement,
    speed (n,) and local (k,). lost (n + 1,): energy lost by the damping of each coordinate, and
    last in the massless elements [J]; of a driven coordinate minus the work of its drive. energies
    (2,): increase of the energy of coordinates and massless elements, and its rounding error [J].
    """

    acceleration: Matrix
    velocity: Matrix
    massless: Matrix
    displacement: Vector
    speed: Vector
    local: Vector
    lost: Vector
    energies: Vector


class Bases(NamedTuple):
    """The Radau rule under the three maps of time."""

    touch: Basis
    inside: Basis
    release: Basis

    @property
    def is_constant(self) -> bool:
        """True: it depends on the power of time alone, so that all drops share one."""
        return True
