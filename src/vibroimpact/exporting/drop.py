"""A drop and its computed response as plain data in SI units: the input of every export format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vibroimpact.arrays import Floats
from vibroimpact.bodies.ball import SOLID
from vibroimpact.bodies.body import Body
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.materials import Material

_SAME = 1e-9  # relative difference of moments of inertia that is rounding


@dataclass(frozen=True, kw_only=True)
class Drop:
    """A sphere that falls on a plate which is held, or moved, and the computed response, as they
    are exported.

    Parameters
    ----------
    name : str
        Name of the case.
    radius, mass : float
        Radius [m] and mass [kg] of the sphere.
    inertia_ratio : float, default 0.4
        Moment of inertia of the sphere over mass and square of the radius [-]; that of a solid one
        by default.
    sphere_material, plate_material : Material
        Their materials; the plate's modulus may be infinite.
    plate_size : tuple of three floats, optional
        Length (x), width (y) and thickness (z) [m].
    position : tuple of two floats
        Point of impact, relative to the plate's centre [m]; where the sphere moves along the plate,
        that over which it starts.
    height : float
        Initial height of the sphere's centre above the plate's upper surface [m]; the radius if the
        run starts at first touch.
    speed : float
        Initial downward speed [m/s]; zero if the sphere is released from rest, negative if it
        rises.
    gravity : float
        Acceleration of gravity [m/s^2]; with an inclined plate its part along the normal.
    oblique : Oblique, optional
        Motion along the plate, spin, friction and gravity along the plate; none by default.
    motion : PlateMotion, optional
        Motion of the plate's supports, above whose mean position heights are told; at rest by
        default.
    in_air : bool, default False
        Does air slow the sphere down in flight?
    in_liquid : bool, default False
        Does a liquid take from the restitution of the laws?
    laws : tuple of ContactLaw
        The contact law of the first impact, the second, ...; the last one holds for all further
        impacts.
    function : tuple of str and SpeedFunction, optional
        Name of a parameter of the law, and its value as a function of the approach speed, which
        replaces the value in `laws`.
    elastic : tuple of str
        Which of "sphere" and "plate" are elastic in the case.
    local_element : bool
        Whether a local element, which represents the sphere's deformation, is in series with the
        contact law.
    finite_sphere : bool
        Whether Hertz's half-space solution was corrected for the finite size of the sphere.
    rigid : Problem, optional
        The same drop between rigid bodies under the contact law alone, where `impacts` do not
        already come from it; `as_rigid` simulates it for programs that support rigid bodies only.
    original_impacts : mapping of str to array
        The impact table of the drop with elastic bodies from which `as_rigid` derived this one;
        empty otherwise.
    end_time : float
        End of the run [s].
    impacts : mapping of str to array
        The computed impact table, columns of shape (impacts,), named as in `impacts.csv`.
    history : mapping of str to array
        The history, columns of shape (times,).
    signals : mapping of str to Signal
        The signals of the sensors.
    surface : mapping of str to array
        Motion of an elastic plate's upper surface: `time` [s] (frames,), grid coordinates `x` [m]
        (columns,) and `y` [m] (rows,) in the plate's frame, `height`: upward displacement [m]
        (frames, rows, columns), NaN outside the plate, and `sphere_position`: height of the
        sphere's centre [m] (frames,). Empty if there is none.
    doubts : tuple of str
        Doubts about the result, as the run states them.
    notes : tuple of str
        What its contact law reproduces, where it is not that of the run.
    """

    name: str
    radius: float
    mass: float
    inertia_ratio: float = SOLID
    sphere_material: Material
    plate_material: Material
    plate_size: tuple[float, float, float] | None = None
    position: tuple[float, float] = (0.0, 0.0)
    height: float
    speed: float = 0.0
    gravity: float
    oblique: Oblique | None = None
    motion: PlateMotion | None = None
    in_air: bool = False
    in_liquid: bool = False
    laws: tuple[ContactLaw, ...]
    function: tuple[str, SpeedFunction] | None = None
    elastic: tuple[str, ...] = ()
    local_element: bool = False
    finite_sphere: bool = False
    rigid: Problem | None = None
    original_impacts: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    end_time: float
    impacts: Mapping[str, Floats] = field(repr=False)
    history: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    signals: Mapping[str, Signal] = field(default_factory=dict, repr=False)
    surface: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    doubts: tuple[str, ...] = field(default=(), repr=False)
    notes: tuple[str, ...] = field(default=(), repr=False)

    @property
    def ball(self) -> Body:
        """The sphere as a rigid body."""
        return Body(mass=self.mass, contact_offset=self.radius, inertia=self.inertia)

    @property
    def inertia(self) -> float:
        """Moment of inertia of the sphere about an axis through its centre [kg m^2]."""
        return self.inertia_ratio * self.mass * self.radius**2

    @property
    def is_solid(self) -> bool:
        """Whether the sphere turns like a solid one."""
        return abs(self.inertia_ratio - SOLID) < _SAME * SOLID
