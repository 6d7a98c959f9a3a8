"""Parameters of a friction law fitted together, and oblique impacts as a function of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.fit.matching import match
from vibroimpact.calibration.fit.single_impacts import oblique_impacts
from vibroimpact.calibration.fit.tunables import law_parameter
from vibroimpact.calibration.fit.uncertainty import with_nearest_bound
from vibroimpact.calibration.friction.least_squares import Bounds
from vibroimpact.calibration.friction.measured import ObliqueImpacts
from vibroimpact.calibration.observed.observations import from_table
from vibroimpact.calibration.observed.section import FRICTION
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.law import ContactLaw, InstantaneousLaw
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.tabulate import BLOCK
from vibroimpact.errors import InputError, choices
from vibroimpact.ranges import Range

_FAR = 1e4
"""Multiple of the size of a value at which a contact sticks, or is stiff."""

_SMALL = 1e-2
"""Fraction of the size of a value below which it counts as small."""


@dataclass(frozen=True)
class FrictionParameters:
    """Parameters of a friction law to be fitted.

    Parameters
    ----------
    law : FrictionLaw
        The law as given.
    names : tuple of str
        Names of its fields.
    """

    law: FrictionLaw
    names: tuple[str, ...]

    @property
    def units(self) -> tuple[str, ...]:
        """SI units."""
        return tuple(self._metadata(name)["unit"] for name in self.names)

    @property
    def given(self) -> Floats:
        """The values of the law as given, (K,)."""
        return np.array([float(getattr(self.law, name)) for name in self.names])

    @property
    def bounds(self) -> Bounds:
        """Bounds of the values within which they matter."""
        sizes = np.array([self._size(name) for name in self.names])
        lower, upper = self.allowed.T
        # the end of a range that is open below is not allowed itself
        open_below = [np.isfinite(self._range(name).above) for name in self.names]
        return Bounds(
            least=np.where(open_below, sizes / _FAR, lower),
            most=np.minimum(upper, _FAR * sizes),
            small=_SMALL * sizes,
        )

    @property
    def allowed(self) -> Floats:
        """The ends of their ranges, (K, 2)."""
        return np.array(
            [self._range(name).bounded(np.array([-np.inf, np.inf])) for name in self.names]
        )

    def starts(self) -> Floats:
        """Return the grid of values from which the search begins, (S, K)."""
        axes = []
        for name, (lower, upper) in zip(self.names, self.allowed, strict=True):
            if np.isfinite(lower) and np.isfinite(upper):
                axes.append(np.linspace(float(lower), float(upper), 5)[1:-1])
            else:
                axes.append(self._size(name) * 2.0 ** np.arange(-4.0, 4.0))
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        return grid.reshape(-1, len(self.names))

    def with_values(self, values: Floats) -> FrictionLaw:
        """Return the law with values of the parameters, (K,) or (n, K)."""
        return self.law.changed(
            {name: values[..., column] for column, name in enumerate(self.names)}
        )

    def _metadata(self, name: str) -> Any:
        return self.law.__dataclass_fields__[name].metadata

    def _range(self, name: str) -> Range:
        allowed: Range = self._metadata(name)["range"]
        return allowed

    def _size(self, name: str) -> float:
        """Return a typical value: that of the example, or that of the law as given."""
        return float(self._metadata(name)["example"] or getattr(self.law, name) or 1.0)


def friction_parameters(problem: Problem, names: Sequence[str]) -> FrictionParameters:
    """Return parameters of the friction law of a drop by names such as "friction.coefficient".

    Raises
    ------
    InputError
        If there is no friction law, or it has no such parameter.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> ball, wall = vi.Body(mass=0.02, contact_offset=0.01), vi.rigid_plate()
    >>> oblique = vi.Oblique(
    ...     velocity=(1.0, 0.0), friction=vi.friction.find_friction_law("coulomb")(coefficient=0.2)
    ... )
    >>> law = vi.laws.find_contact_law("newton")(restitution=0.8)
    >>> friction_parameters(
    ...     vi.Problem(sphere=ball, plate=wall, laws=(law,), speed=2.0, oblique=oblique),
    ...     ["friction.coefficient"],
    ... ).given
    array([0.2])
    """
    law = None
    if problem.oblique is not None:
        law = problem.oblique.friction
    if law is None:
        example = "mdr"
        if isinstance(problem.laws[0], InstantaneousLaw):
            example = "coulomb"
        raise InputError(
            f"the case has no friction; give contact.friction a law, such as {{ law = "
            f'"{example}" }}',
            "parameter",
        )
    known = [f"{FRICTION}{item.name}" for item in fields(law)]
    for name in names:
        if name in known:
            continue
        if not name.startswith(FRICTION):
            raise InputError(f"{name} is not fitted together with friction", "parameter")
        raise InputError(
            f'{law.name} has no parameter "{name.removeprefix(FRICTION)}"; there are '
            f"{choices(known, name)}",
            "parameter",
        )
    if len(set(names)) < len(names):
        raise InputError("a parameter is named twice", "parameter")
    return FrictionParameters(law, tuple(name.removeprefix(FRICTION) for name in names))


@dataclass(frozen=True)
class ImpactModel:
    """Oblique impacts as a function of the parameters of the friction law.

    Parameters
    ----------
    problem : Problem
        The drop, whose bodies and gravity the impacts have.
    law : ContactLaw
        The contact law; its arrays have one value an impact.
    parameters : FrictionParameters
        The parameters of the friction law.
    speeds, velocity, spin : array, shape (n,)
        Approach speeds along the normal [m/s], velocities along x [m/s] and angular velocities
        about y [rad/s] of the impacts.
    """

    problem: Problem
    law: ContactLaw
    parameters: FrictionParameters
    speeds: Floats
    velocity: Floats
    spin: Floats

    def __call__(self, values: Floats) -> dict[str, Floats]:
        """Return the quantities of the impacts (S, n) with values (S, K) of the parameters.

        The quantities are those of `oblique_impacts`.
        """
        shape = (len(values), len(self.speeds))
        pairs = np.arange(len(values) * len(self.speeds))
        blocks = [
            self._impacts(values, pairs[begin : begin + BLOCK])
            for begin in range(0, len(pairs), BLOCK)
        ]
        return {
            name: np.concatenate([block[name] for block in blocks]).reshape(shape)
            for name in blocks[0]
        }

    def _impacts(self, values: Floats, pairs: Indices) -> dict[str, Floats]:
        """Return the quantities of pairs of values and impacts, numbered along rows of (S, n)."""
        assert self.problem.oblique is not None
        chains, impacts = np.divmod(pairs, len(self.speeds))
        oblique = Oblique(
            velocity=(self.velocity[impacts], 0.0),
            spin=(0.0, self.spin[impacts], 0.0),
            gravity=self.problem.oblique.gravity,
            friction=self.parameters.with_values(values[chains]),
            inertia_ratio=self.problem.oblique.inertia_ratio,
        )
        return oblique_impacts(self.problem, self.law.take(impacts), self.speeds[impacts], oblique)


def impact_model(
    problem: Problem, parameters: FrictionParameters, impacts: ObliqueImpacts
) -> ImpactModel:
    """Return the measured impacts as a function of the parameters.

    With measured separation speeds, the contact law meets each of them.
    """
    law = problem.laws[0]
    if impacts.separation_speed is not None:
        law = _law_with_separation_speeds(problem, law, impacts, impacts.separation_speed)
    return ImpactModel(
        problem, law, parameters, impacts.seen.speeds, impacts.velocity, impacts.spin
    )


def _law_with_separation_speeds(
    problem: Problem, law: ContactLaw, impacts: ObliqueImpacts, separation_speed: Floats
) -> ContactLaw:
    """Return the contact law with which spheres leave at measured speeds [m/s].

    Its free parameter has one value an impact.
    """
    if law.free_parameter is None:
        raise InputError(
            f"the normal rebound was measured too, and {law.name} has no "
            "parameter to meet it with; take another contact law, or leave that column out",
            "target",
        )
    # the normal rebound is that of a drop without motion along the plate
    tuned = law_parameter(replace(problem, oblique=None, laws=(law,)))
    speeds = impacts.seen.speeds
    wanted = {"separation_speed": separation_speed}
    weights = {"separation_speed": 1.0}
    which = from_table(speeds, wanted, None, impacts.seen.labels).which
    values = match(tuned, speeds, wanted, weights, which).values
    values = with_nearest_bound(tuned, values, speeds, wanted, weights, which)
    return law.changed({tuned.name: values})
