"""What the core computes with: arrays, gathered in named tuples.

The annotations name the types of compiled code, in `vibroimpact.compiler.types`.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from vibroimpact.arrays import Complex, Floats, Integers

Vector: TypeAlias = Floats
Matrix: TypeAlias = Floats
Cube: TypeAlias = Floats
Complexes: TypeAlias = Complex
Real: TypeAlias = float


class Basis(NamedTuple):
    """A Radau rule of N nodes under a time map, and the eigenbasis of its integration matrix with H eigenvalues, one of each pair.

    time (N,): of the nodes, as a part of the length. integral, integral_twice (N, N): integrals up to the nodes. spectrum (N, N): from
    values at the nodes to Legendre coefficients. at_start (N,): weights of the nodes in the value at the start. eigenvalues, one, clock
    (2, H): real and imaginary parts of the eigenvalues, and of the function one and the time in the eigenbasis. forward (N, 2 H): from
    values at the nodes to the eigenbasis; backward (2 H, N): back to the nodes. filters (2 H, N N): from an operator that is diagonal in
    the eigenbasis to its matrix on the nodes.
    """

    time: Vector
    integral: Matrix
    integral_twice: Matrix
    spectrum: Matrix
    at_start: Vector
    eigenvalues: Matrix
    one: Matrix
    clock: Matrix
    forward: Matrix
    backward: Matrix
    filters: Matrix


class Surfaces(NamedTuple):
    """What moves the surfaces at c contacts: m modes, rigid motions, and k massless elements of a spring parallel to a dashpot.

    frequency_squared [1/s^2], damping [1/s] (m,): of the modes. shapes (1 or 2, c, m): approach of the surfaces by each mode, outside the
    contacts and, if any lies inside, within them. rigid_pairs (c, c): sums of products of the shapes of rigid motions [1/kg]. mass (c,):
    effective mass of these [kg]. gravity (c,): acceleration of the approach [m/s^2]. rate (k,): stiffness over damping of the massless
    elements [1/s]. incidence (c, k): which of them is in series with which contact. mobility (c, k): one over their damping there
    [m/(N s)].
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

    displacement, velocity (m,): of the modes. local (k,): deformation of the massless elements [m]. Of each contact (c,): approach of the
    surfaces [m], and its rate by coordinates outside the contact, outer_rate, and within it, inner_rate [m/s].
    """

    displacement: Vector
    velocity: Vector
    local: Vector
    approach: Vector
    outer_rate: Vector
    inner_rate: Vector


class Contacts(NamedTuple):
    """The laws at c contacts that push.

    laws (c,): their forces, as `native.force_of` gives them. coefficients (c, K). speed (c,): closing speed at touch [m/s]. release,
    release_level (c,): indentation of the law, and approach of the surfaces, at release [m]. series (c, 7): numbers of the compliance in
    series.
    """

    laws: Integers
    coefficients: Matrix
    speed: Vector
    release: Vector
    release_level: Vector
    series: Matrix


class Nodes(NamedTuple):
    """Unknowns at the nodes of c contacts (c N,): static part of the forces and force [N], and indentation delta of the laws [m]."""

    static: Vector
    force: Vector
    delta: Vector


class Motion(NamedTuple):
    """Motion of the surfaces at the nodes of all contacts, M = c N: without contact forces, and by these.

    Without contact forces (M,): approach [m], its rate by coordinates outside the contacts and closing, its whole rate [m/s]. To be
    subtracted, per force at the nodes (M, M): approach_by_force, rate_by_force, and, of the static forces on coordinates within the
    contacts, approach_by_static and closing_by_static; the latter are (0, 0) where there are none.
    """

    approach: Vector
    rate: Vector
    closing: Vector
    approach_by_force: Matrix
    rate_by_force: Matrix
    approach_by_static: Matrix
    closing_by_static: Matrix


class Histories(NamedTuple):
    """Motion and energy of c contacts through a stretch.

    At the start and the nodes (c, N + 1): approach of the surfaces [m], its rate at the dashpots [m/s], and delta, the indentation of the
    laws [m]. dissipated (c,): work of the dissipative forces [J]. roughness: the last Legendre coefficients of the forces, relative to
    their scale.
    """

    approach: Matrix
    rate: Matrix
    delta: Matrix
    dissipated: Vector
    roughness: Real


class Coordinates(NamedTuple):
    """All n coordinates of a system: first the rigid motions, then the modes, the last of which may be driven.

    frequency [rad/s], damping [1/s], load: acceleration by gravity [kg^1/2 m/s^2] (n,). rigid_shapes (c, r): approach of the surfaces of
    the contacts by each rigid motion; driven_shapes (c, d): by each driven coordinate. rate [1/s], mobility [m/(N s)] (k,): of the massless
    elements. rounding (n,): relative rounding error of the energy of each.
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

    At the nodes: acceleration, velocity of the coordinates (n, N), and rates of the massless elements, massless (k, N). At the end:
    displacement, speed (n,) and local (k,). lost (n + 1,): energy lost by the damping of each coordinate, and last in the massless elements
    [J]; of a driven coordinate minus the work of its drive. energies (2,): increase of the energy of coordinates and massless elements, and
    its rounding error [J].
    """

    acceleration: Matrix
    velocity: Matrix
    massless: Matrix
    displacement: Vector
    speed: Vector
    local: Vector
    lost: Vector
    energies: Vector
