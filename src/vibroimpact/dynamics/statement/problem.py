"""The statement of a drop or of a batch of drops, validated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from vibroimpact.arrays import Array, Complex, Floats, Indices
from vibroimpact.bodies.ball import SOLID, mean_density
from vibroimpact.bodies.body import Body
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.speed_function import BySpeed, held
from vibroimpact.dynamics.fluids.air import Air, check_thin
from vibroimpact.dynamics.fluids.fluid import Fluid
from vibroimpact.dynamics.fluids.liquid import Liquid, check_sinks
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.dynamics.statement.steady import steady_phasors
from vibroimpact.dynamics.statement.tolerance import DEFAULT_TOLERANCE, check_tolerance
from vibroimpact.errors import InputError
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.units.display import STANDARD_GRAVITY

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalModel  # which loads sparse matrices


MOST_IMPACTS = 100_000
"""Number of impacts at which a run without a given number is stopped, if it has not come
to rest.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """A sphere that falls on a plate: one drop, or a batch with one value per drop.

    Parameters
    ----------
    sphere, plate : Body
        The bodies. The plate is held fixed: its mass is infinite; or it moves as a rigid body,
        without gravity, as its `rigid` says. They vibrate in the modes that they have.
    laws : tuple of ContactLaw
        The contact law of the first impact, the second, ...; the last one goes on. All of one kind.
    by_speed : mapping of str to SpeedFunction or SpeedTable, optional
        Parameters of the law that are functions of the approach speed of each impact, in place of
        their values in `laws`; beyond the range of a function its value at the nearest end holds.
    height : float or array, optional
        Height of the sphere's centre above the plate's upper surface at rest, at the start [m].
    velocity : float or array, default 0
        Upward velocity at that height [m/s].
    speed : float or array, optional
        Downward speed at first touch, where the run then begins [m/s]. Give this or `height`.
    gravity : float or array, default 9.80665
        Acceleration of gravity [m/s^2], >= 0; with an inclined plate its part along the normal.
    oblique : Oblique, optional
        Velocity along the plate, spin, friction and an inclination of the plate. By default the
        sphere falls along the normal and does not turn.
    motion : PlateMotion, optional
        Prescribed motion of the plate's supports. Heights are then above the mean position of the
        plate's surface, and approach and separation speeds relative to it. By default the supports
        are at rest.
    air : Air, optional
        What the sphere falls through: its drag slows it down in flight. By default nothing.
    liquid : Liquid, optional
        What is around sphere and plate, in place of air: buoyancy, drag and added mass act in
        flight, and a film takes from the restitution of the law, which is that in air. By default
        nothing.
    impacts : int, default 5
        Stop after so many impacts, at the top of the last rebound. None: go on to rest.
    duration : float, optional
        Stop at this time [s]; an impact under way is finished first, but not a sphere that rides on
        what vibrates.
    rest_speed : float or array, optional
        A sphere that leaves more slowly is at rest [m/s]. By default the speed from which it would
        rise no higher than the static indentation under its own weight, but at least 1e-6 of
        the first approach speed. Zero: only a sphere that does not leave at all is at rest. On what
        vibrates it must also be true that nothing that still moves can make it leave faster.
    same_spot : bool, default True
        Does each impact fall where the last one did, with the same part of the sphere? Then a law
        whose memory lasts (a permanent dent) goes on with it; else each impact finds fresh
        surfaces.
    sphere_inside : bool, default True
        Do the modes of the sphere lie inside the contact: in series with the spring of the law, and
        spanned by its dashpot? Then what the law loses does not depend on how many there are. Else
        they are in series with all of it.
    quasi_static : QuasiStatic, optional
        Quasi-static compliance in series with the law.
    local_element : tuple of two floats, optional
        Stiffness [N/m] and damping [N s/m], > 0, of a spring and a dashpot side by side, in series
        with the law.
    sensors : tuple of Sensor, optional
        What watches the plate.
    tolerance : float, default 1e-9
        Relative error allowed in the state at the end of a contact; 1e-13 to 1e-6.
    sensitivity : bool, default True
        Follow, where bodies vibrate, how a small change of the drop grows from impact to impact? It
        takes a fifth of the time; without it the impact table has no such column, and all figures
        count as certain.
    source : ResolvedCase, optional
        The case that the problem was made from, for provenance.
    facts : mapping, optional
        What is told of how the deformation is modelled; names end in their units.
    models : mapping, optional
        The modes of "sphere" and "plate" on their meshes, for pictures of their deflection.
    at_place : callable, optional
        The problem with its contact at another place of the plate, x and y [m]; without it a sphere
        that moves along a plate that vibrates finds it everywhere as where it touches first.
    plate_at_place : callable, optional
        The plate with its contact there, which tells its motion; the compliance in series is left
        out, which takes more time.

    Raises
    ------
    InputError
        If a value is impossible, or array values do not agree in shape.

    Examples
    --------
    >>> from vibroimpact.bodies.rigid_bodies import rigid_plate
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> ball = Body(mass=1.0, contact_offset=0.1)
    >>> Problem(
    ...     sphere=ball, plate=rigid_plate(), laws=(Newton(restitution=0.5),), height=[1.0, 2.0]
    ... ).shape
    (2,)
    """

    sphere: Body
    plate: Body
    laws: tuple[ContactLaw, ...]
    by_speed: Mapping[str, BySpeed] = field(default_factory=dict)
    height: Array | None = None
    velocity: Array = 0.0
    speed: Array | None = None
    gravity: Array = STANDARD_GRAVITY
    oblique: Oblique | None = None
    motion: PlateMotion | None = None
    air: Air | None = None
    liquid: Liquid | None = None
    impacts: int | None = 5
    duration: float | None = None
    rest_speed: Array | None = None
    same_spot: bool = True
    sphere_inside: bool = True
    quasi_static: QuasiStatic = QuasiStatic()
    local_element: tuple[float, float] | None = None
    sensors: tuple[Sensor, ...] = ()
    tolerance: float = DEFAULT_TOLERANCE
    sensitivity: bool = True
    source: ResolvedCase | None = field(default=None, compare=False)
    facts: Mapping[str, float | str] = field(default_factory=dict, compare=False)
    models: Mapping[str, ModalModel] = field(default_factory=dict, compare=False)
    at_place: Callable[[tuple[float, float]], Problem] | None = field(default=None, compare=False)
    plate_at_place: Callable[[tuple[float, float]], Body] | None = field(
        default=None, compare=False
    )

    def __post_init__(self) -> None:
        if isinstance(self.laws, ContactLaw):
            object.__setattr__(self, "laws", (self.laws,))
        self._check_laws()
        self._check_kinds_of_numbers()
        self._check_bodies()
        self._check_ranges()
        self._check_start()
        self._check_end()
        self._check_elastic_bodies()
        if self.oblique is not None:
            self._check_oblique(self.oblique)
        if self.air is not None:
            self._check_air(self.air)
        if self.liquid is not None:
            self._check_liquid(self.liquid)
        self._check_shape()

    def _check_laws(self) -> None:
        """Check that the laws are of one kind, and have the parameters that change with speed."""
        one_kind = (
            isinstance(self.laws, (tuple, list)) and len({type(law) for law in self.laws}) == 1
        )
        if not one_kind or not isinstance(self.laws[0], ContactLaw):
            example = 'such as vi.laws.find_contact_law("newton")(restitution=0.7)'
            raise InputError(
                f"laws must be one or more contact laws with their parameters, {example}, "
                "all of one kind"
            )
        parameters = {item.name for item in fields(self.laws[0])}
        for name in self.by_speed:
            if name not in parameters:
                raise InputError(
                    f"{self.laws[0].name} has no parameter {name} that could be a function "
                    "of the approach speed"
                )

    def _check_kinds_of_numbers(self) -> None:
        """Check that numbers are numbers: arrays with one per drop, or one for all drops."""
        for name in ("height", "velocity", "speed", "gravity", "rest_speed"):
            value = getattr(self, name)
            if value is not None and np.asarray(value).dtype.kind not in "iuf":
                raise InputError(
                    f"{name} must be a number in SI, or an array of them, not {value!r}"
                )
        for name in ("duration", "tolerance"):
            value = getattr(self, name)
            if value is not None and (
                np.asarray(value).dtype.kind not in "iuf" or np.ndim(value) > 0
            ):
                raise InputError(
                    f"{name} must be a number in SI, one for all drops of a batch, not {value!r}"
                )
        if (self.height is None) == (self.speed is None):
            raise InputError("give either height [m] or speed [m/s] of the drop, and not both")

    def _check_bodies(self) -> None:
        """Check that the sphere can move, and that the plate is held."""
        sphere_is_finite = np.all(np.isfinite(self.sphere.mass)) and np.all(
            np.isfinite(self.sphere.contact_offset)
        )
        if not sphere_is_finite:
            raise InputError("the sphere's mass and radius must be finite")
        if np.any(np.isfinite(self.plate.mass)):
            raise InputError("the plate must be held fixed: a body with an infinite mass")

    def _check_ranges(self) -> None:
        """Check that numbers are finite, and those of magnitudes not negative."""
        least_values = {
            "height": -np.inf,
            "velocity": -np.inf,
            "speed": 0.0,
            "gravity": 0.0,
            "rest_speed": 0.0,
        }
        for name, least in least_values.items():
            value = getattr(self, name)
            if value is not None and not np.all(np.isfinite(value) & (np.asarray(value) >= least)):
                sign = "" if np.isinf(least) else " and not negative"
                raise InputError(f"{name} must be finite{sign}")

    def _check_start(self) -> None:
        """Check that the sphere meets the plate: the speed at touch, or the height of the fall."""
        if self.speed is not None and not np.all(np.asarray(self.speed) > 0):
            raise InputError("speed must be greater than 0 m/s")
        if self.speed is not None and np.any(self.velocity):
            raise InputError(
                "velocity is that at a height; with speed, at first touch, leave it out"
            )
        if self.height is None:
            return
        if not np.all(np.asarray(self.height) > self.sphere.contact_offset):
            raise InputError(
                "height must be greater than the sphere's radius: it is the height of "
                "the centre above the plate's upper surface"
            )
        if not np.all(np.asarray(self.gravity) > 0):
            raise InputError("without gravity a sphere does not fall: give speed instead of height")

    def _check_end(self) -> None:
        """Check the number of impacts and the duration that end the run, and the tolerance."""
        if self.impacts is not None and not (
            isinstance(self.impacts, Integral) and 1 <= self.impacts <= MOST_IMPACTS
        ):
            raise InputError(f"impacts must be a whole number from 1 to {MOST_IMPACTS}")
        if self.duration is not None and not 0 < self.duration < np.inf:
            raise InputError("duration must be greater than 0 s and finite")
        check_tolerance(self.tolerance)

    def _check_elastic_bodies(self) -> None:
        """Check what bodies that deform, move or are free can do in a drop."""
        if self.local_element is not None and not all(
            0.0 < value < np.inf for value in self.local_element
        ):
            raise InputError(
                "stiffness and damping of the local element must be greater than 0 and finite"
            )
        if self.plate.rigid is not None and np.any(np.asarray(self.gravity) > 0):
            raise InputError(
                "the supports let the plate fall or tilt: under gravity it falls away from "
                "under the sphere; set gravity to 0, and give speed"
            )
        self._check_motion()
        if self.vibrates and isinstance(self.laws[0], InstantaneousLaw):
            raise InputError(
                f"{self.laws[0].name} gives no force, and bodies that deform or are free "
                "need one; take another law"
            )

    def _check_oblique(self, oblique: Oblique) -> None:
        """Check the sphere and the laws of a drop with motion along the plate."""
        if not isinstance(oblique, Oblique):
            raise InputError(f"oblique must be an Oblique, not {oblique!r}")
        if not np.all(np.asarray(self.sphere.contact_offset) > 0.0):
            raise InputError(
                "a sphere that may turn needs a radius: its contact_offset, greater than 0 m"
            )
        if self.sphere.inertia is not None and np.any(np.asarray(oblique.inertia_ratio) != SOLID):
            raise InputError(
                "the moment of inertia is given twice; leave out the inertia_ratio, or the "
                "inertia of the sphere"
            )
        if self.vibrates:
            self._check_surface_friction(oblique)
        friction = oblique.friction
        if isinstance(friction, CompliantFriction) and isinstance(self.laws[0], InstantaneousLaw):
            raise InputError(
                f"{self.laws[0].name} gives no normal force for {friction.name} "
                "to follow; take another contact law, or friction by the impulse, as of "
                "coulomb or rigid"
            )

    def _check_shape(self) -> None:
        """Check that the arrays of a batch agree in shape."""
        try:
            shape = self.shape
        except ValueError:
            raise InputError(
                "the arrays of a batch must agree in shape: one value a drop"
            ) from None
        if len(shape) > 1 or 0 in shape:
            raise InputError(f"a batch has one axis with at least one drop, not the shape {shape}")

    def _check_surface_friction(self, oblique: Oblique) -> None:
        """Check that bodies that deform can move along each other.

        Raises
        ------
        InputError
            If the plate's modes do not tell how it moves along its surface, or the friction law has
            no tangential compliance.
        """
        bases = [basis for basis in (self.plate.rigid, self.plate.modes) if basis is not None]
        if any(basis.along is None for basis in bases):
            raise InputError(
                "modes of a plate that is hit obliquely need `along`, the motion of their "
                "contact point along the plate"
            )
        if oblique.friction is not None and not isinstance(oblique.friction, CompliantFriction):
            words = (
                f"{oblique.friction.name} has no tangential compliance, which friction needs "
                "on bodies that deform or are shaken"
            )
            raise InputError(f'{words}; take "mdr" or one of the "mindlin" laws')

    def _check_motion(self) -> None:
        """Check what a plate on supports that move may have."""
        if self.motion is None:
            return
        if not isinstance(self.motion, PlateMotion):
            raise InputError(f"motion must be a PlateMotion, not {self.motion!r}")
        if self.plate.rigid is not None:
            words = (
                "the supports let the plate fall or tilt, and a motion of supports is that of a "
                "plate that they hold"
            )
            raise InputError(f"{words}; leave out its motion")
        if len(self.motion.phasors) > 1 and self.duration is None:
            raise InputError(
                "a sphere may ride for ever on a motion of several harmonics: give the "
                "duration of the run"
            )
        modes = self.plate.modes
        if (
            modes is not None
            and np.isin(
                modes.angular_frequencies[modes.damping_ratios == 0.0],
                self.motion.angular_frequency,
            ).any()
        ):
            words = (
                "a mode of the plate without damping is driven at its own "
                "frequency, and grows without bound"
            )
            raise InputError(f"{words}; give it damping, or change the frequency of the motion")
        place, speed, _ = self.surface(0.0)
        if self.height is not None and not np.all(
            np.asarray(self.height) - self.sphere.contact_offset > place
        ):
            raise InputError(
                "the plate begins its motion at or above the lowest point of the sphere; "
                "let it fall from higher, or change the phase"
            )
        if self.speed is not None and not np.all(np.asarray(self.speed) > -speed):
            raise InputError(
                "the plate recedes at least as fast as the sphere comes down; give a higher "
                "speed, or another phase of the motion"
            )

    def _check_air(self, air: Air) -> None:
        """Raise InputError unless drag is what matters of the air."""
        if not isinstance(air, Air):
            raise InputError(f"air must be an Air, not {air!r}")
        if not np.all(np.asarray(self.sphere.contact_offset) > 0.0):
            raise InputError(
                "a sphere that flies through air needs a radius: its contact_offset, "
                "greater than 0 m"
            )
        check_thin(air.density, self.sphere_density)

    def _check_liquid(self, liquid: Liquid) -> None:
        """Raise InputError unless it is known what a liquid leaves of the restitution."""
        if not isinstance(liquid, Liquid):
            raise InputError(f"liquid must be a Liquid, not {liquid!r}")
        if not np.all(np.asarray(self.sphere.contact_offset) > 0.0):
            raise InputError(
                "a sphere that touches in a liquid needs a radius: its contact_offset, "
                "greater than 0 m"
            )
        if self.laws[0].free_parameter != "restitution":
            optional = any(item.name == "restitution" for item in fields(self.laws[0]))
            words, remedy = "takes no", "take another law"
            if optional:
                words, remedy = (
                    "is given without a",
                    f"give it one in place of {self.laws[0].free_parameter}, or take another law",
                )
            raise InputError(
                f"{self.laws[0].name} {words} restitution, of which a "
                f"liquid leaves a part; {remedy}"
            )
        if self.air is not None:
            raise InputError("the sphere is either in a liquid or in air; leave one of them out")
        if np.any(np.asarray(self.gravity) > 0.0):
            check_sinks(liquid.density, self.sphere_density)

    @property
    def fluid(self) -> Fluid | None:
        """What the sphere flies through; None for a vacuum."""
        return self.air if self.liquid is None else self.liquid

    @property
    def sphere_density(self) -> Array:
        """Mass of the sphere over its volume [kg/m^3]."""
        return mean_density(self.sphere.mass, self.sphere.contact_offset)

    @property
    def sphere_inertia(self) -> Array:
        """Moment of inertia of the sphere about an axis through its centre [kg m^2]."""
        if self.sphere.inertia is None:
            return self._unit_inertia * self.inertia_ratio
        return self.sphere.inertia

    @property
    def inertia_ratio(self) -> Array:
        """Moment of inertia of the sphere over its mass and the square of its radius [-]."""
        if self.sphere.inertia is not None:
            return self.sphere.inertia / self._unit_inertia
        if self.oblique is None:
            return SOLID
        return self.oblique.inertia_ratio

    @property
    def _unit_inertia(self) -> Array:
        """Mass of the sphere times the square of its radius [kg m^2]."""
        return self.sphere.mass * np.square(self.sphere.contact_offset)

    @property
    def net_weight(self) -> Array:
        """Weight of the sphere, less its buoyancy, over that in a vacuum [-]."""
        if self.fluid is None:
            return 1.0
        return self.fluid.weight(self.sphere_density)

    @property
    def net_gravity(self) -> Array:
        """Acceleration of gravity along the normal, less buoyancy [m/s^2]."""
        return self.gravity * self.net_weight

    @property
    def flight_inertia(self) -> Array:
        """Mass that is accelerated in flight over that of the sphere [-].

        It includes that of a liquid that moves along.
        """
        if self.fluid is None:
            return 1.0
        return self.fluid.inertia(self.sphere_density)

    @property
    def vibrates(self) -> bool:
        """Whether anything but the contact of the law deforms, or anything but the sphere moves."""
        modes = (self.sphere.modes, self.plate.modes, self.plate.rigid, self.local_element)
        shaken = self.shaken and not isinstance(self.laws[0], InstantaneousLaw)
        return any(part is not None for part in modes) or bool(self.quasi_static) or shaken

    @property
    def shaken(self) -> bool:
        """Whether the surface of the plate moves without being hit.

        It moves along its normal, or along itself where the drop is oblique.
        """
        along = (
            self.motion is not None
            and self.oblique is not None
            and bool(np.any(self.motion.amplitude))
        )
        return self.motion is not None and (along or bool(np.any(self.surface_phasors)))

    @cached_property
    def surface_phasors(self) -> Complex:
        """Phasors of the surface at the contact point where nothing hits it [m] (k,).

        They are as `PlateMotion.at` takes them.
        """
        if self.motion is None:
            return np.zeros(0, dtype=complex)
        return steady_phasors(self.motion, self.plate.modes)

    def surface(self, time: Array) -> Floats:
        """Return the motion of that surface upwards at times [s] (...), (3, ...).

        It is displacement [m], velocity [m/s] and acceleration [m/s^2].
        """
        if self.motion is None:
            return np.zeros((3, *np.shape(time)))
        return self.motion.at(time, self.surface_phasors)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """() for one drop, (B,) for a batch."""
        values = [self.height, self.velocity, self.speed, self.gravity, self.rest_speed]
        values += [self.sphere.mass, self.sphere.contact_offset, self.sphere.inertia]
        values += [getattr(law, item.name) for law in self.laws for item in fields(law)]
        if self.oblique is not None:
            values += self.oblique.values
        values += [
            value
            for fluid in (self.air, self.liquid)
            if fluid is not None
            for value in fluid.values
        ]
        return np.broadcast_shapes(*(np.shape(value) for value in values if value is not None))

    @property
    def memory_lasts(self) -> bool:
        """Whether a law goes on with its memory of the last impact, as on a permanent dent."""
        law = self.laws[0]
        return self.same_spot and isinstance(law, CompliantLaw) and law.lasting

    def law_of(self, impact: int) -> ContactLaw:
        """Return the law of an impact, counted from 0; the last one goes on."""
        return self.laws[min(impact, len(self.laws) - 1)]

    def law_at(self, law: ContactLaw, speed: Array) -> ContactLaw:
        """Return a law with its parameters at an approach speed [m/s].

        They may be functions of it.
        """
        return law.changed(
            {name: held(function, speed) for name, function in self.by_speed.items()}
        )

    def law_at_touch(self, law: ContactLaw, speed: Array) -> ContactLaw:
        """Return a law at an approach speed [m/s], with what a liquid leaves of its restitution."""
        law = self.law_at(law, speed)
        if self.liquid is None:
            return law
        return self.liquid.around(law, speed, self.sphere.contact_offset, self.sphere_density)

    def alone(self) -> list[Problem]:
        """Return the problems of the drops, one by one."""
        if self.shape == ():
            return [self]
        return [self.take(drop) for drop in range(self.shape[0])]

    def take(self, drop: int | slice | Indices) -> Problem:
        """Return the problem of one drop of a batch, or of some."""

        def one(value: Any) -> Any:
            if np.ndim(value) == 0:
                return value
            return np.asarray(value)[drop]

        def of_drop(stated: Any) -> Any:
            return None if stated is None else stated.take(drop)

        def part(body: Body) -> Body:
            return replace(
                body,
                **{
                    name: one(getattr(body, name)) for name in ("mass", "contact_offset", "inertia")
                },
            )

        return replace(
            self,
            sphere=part(self.sphere),
            plate=part(self.plate),
            laws=tuple(law.take(drop) for law in self.laws),
            height=one(self.height),
            velocity=one(self.velocity),
            speed=one(self.speed),
            gravity=one(self.gravity),
            rest_speed=one(self.rest_speed),
            oblique=of_drop(self.oblique),
            air=of_drop(self.air),
            liquid=of_drop(self.liquid),
        )

    def on_plate(self, plate: Body, quasi_static: QuasiStatic) -> Problem:
        """Return the problem of a drop under way whose contact is elsewhere on the plate.

        Its start is not checked against that.
        """
        found = copy(self)
        vars(found).pop("surface_phasors", None)
        vars(found).update(plate=plate, quasi_static=quasi_static)
        return found

    def to_problem(self) -> Problem:
        """Return the problem itself."""
        return self


class StatesProblem(Protocol):
    """Anything that can be stated as a `Problem`: a problem itself, or a case that was read."""

    def to_problem(self) -> Problem:
        """Return the problem."""
        ...
