"""A drop and what came of it as plain data in SI: what every export format writes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vibroimpact.arrays import Floats
from vibroimpact.calibration.speed_function import SpeedFunction
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.materials import Material


@dataclass(frozen=True, kw_only=True)
class Drop:
    """A sphere that falls on a plate which is held, as another program is told of it.

    Parameters
    ----------
    name : str
        What the case is called.
    radius, mass : float
        Of the sphere [m], [kg].
    sphere_material, plate_material : Material
        What they are made of; the plate's modulus may be infinite.
    plate_size : tuple of three floats, optional
        Length (x), width (y) and thickness (z) [m].
    position : tuple of two floats
        Where it falls, from the plate's centre [m].
    height : float
        Height of the sphere's centre above the plate's upper surface at the start [m]; the radius if it starts at first touch.
    speed : float
        Its downward speed at the start [m/s]; zero if it is let go.
    gravity : float
        Acceleration of gravity [m/s^2].
    laws : tuple of ContactLaw
        The contact law of the first impact, the second, ...; the last one goes on.
    function : tuple of str and SpeedFunction, optional
        A parameter of the law, and its value as a function of the approach speed; then it stands in place of the laws' values.
    elastic : tuple of str
        Which of "sphere" and "plate" deform in the case.
    local_element : bool
        Is a local element, which stands for the sphere's deformation, in series with the contact law?
    finite_sphere : bool
        Was Hertz's half space corrected to a sphere of finite size?
    rigid : Problem, optional
        The same drop between rigid bodies, under the contact law alone, where `impacts` are not those of it: `as_rigid` runs it for
        programs that can be told of nothing else.
    here : mapping of str to array
        The impact table of the drop of which this one was made by taking what deforms as rigid; empty if it is as it was.
    end_time : float
        When the run ends [s].
    impacts : mapping of str to array
        The impact table as computed here, (impacts,) a column, named as in `impacts.csv`.
    history : mapping of str to array
        The history, (times,) a column.
    signals : mapping of str to Signal
        What the sensors recorded.
    surface : mapping of str to array
        Of an elastic plate's upper side: `time` [s] (frames,), `x` [m] (columns,) and `y` [m] (rows,) of a grid in the plate's
        coordinates, `height`: its upward displacement [m] (frames, rows, columns), NaN beside the plate, and `sphere_position`: height
        of the sphere's centre [m] (frames,). Empty if there is none.
    """

    name: str
    radius: float
    mass: float
    sphere_material: Material
    plate_material: Material
    plate_size: tuple[float, float, float] | None = None
    position: tuple[float, float] = (0.0, 0.0)
    height: float
    speed: float = 0.0
    gravity: float
    laws: tuple[ContactLaw, ...]
    function: tuple[str, SpeedFunction] | None = None
    elastic: tuple[str, ...] = ()
    local_element: bool = False
    finite_sphere: bool = False
    rigid: Problem | None = None
    here: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    end_time: float
    impacts: Mapping[str, Floats] = field(repr=False)
    history: Mapping[str, Floats] = field(default_factory=dict, repr=False)
    signals: Mapping[str, Signal] = field(default_factory=dict, repr=False)
    surface: Mapping[str, Floats] = field(default_factory=dict, repr=False)
