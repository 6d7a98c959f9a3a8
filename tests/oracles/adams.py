"""An Adams model of one part that falls on the ground, as a file described it, and its
motion by SciPy in the file's own units.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from oracles.adams_functions import Refused, Scope, State, Value, parse_function

Vector = tuple[float, float, float]
LONGEST_CONTACT = 5e-3
"""Where a contact is given up [s]."""


@dataclass
class Part:
    """Where it is, its mass, the marker at its centre of mass, how fast it moves upwards,
    and VX, VY, WX, WY and WZ.
    """

    position: Vector = (0.0, 0.0, 0.0)
    mass: float = 0.0
    inertia: Vector = (0.0, 0.0, 0.0)
    centre: str = ""
    velocity: float = 0.0
    ground: bool = False
    along: tuple[float, ...] = (0.0,) * 5


@dataclass
class Sensor:
    """An event that is true where `function` is not below `value` by more than `error`;
    then it stores `evaluate`.
    """

    function: str
    value: float
    error: float
    evaluate: str


@dataclass
class Model:
    """Everything by number, or by name. `newton` is the force unit over mass unit times
    length unit per second squared.
    """

    newton: float = 0.0
    length: float = 0.0
    gravity: Vector | None = None
    parts: dict[str, Part] = field(default_factory=dict)
    markers: dict[str, tuple[str, Vector]] = field(default_factory=dict)
    sensors: dict[str, Sensor] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)
    forces: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    floating: dict[str, str] = field(default_factory=dict)
    general: list[tuple[str, str, list[str]]] = field(default_factory=list)
    requests: dict[str, list[str]] = field(default_factory=dict)
    balls: dict[str, float] = field(default_factory=dict)
    longest_step: float = 0.0
    end: float = 0.0
    output_step: float = 0.0

    def add(self, table: dict, key: str, value: object) -> None:
        """Add an element whose number or name must be new."""
        if key in table:
            raise Refused(f"{key} is there twice")
        table[key] = value

    def place(self, marker: str) -> Vector:
        """Where a marker is at the start."""
        part, offset = self.markers[marker]
        return tuple(a + b for a, b in zip(self.parts[part].position, offset, strict=True))


UNITS = {
    "length": {"mm": 1e-3, "millimeter": 1e-3, "meter": 1.0, "centimeter": 1e-2},
    "mass": {"kg": 1.0, "kilogram": 1.0, "gram": 1e-3},
    "force": {"newton": 1.0, "knewton": 1e3},
    "time": {"sec": 1.0, "second": 1.0},
}


def set_units(model: Model, length: str, mass: str, force: str, time: str) -> None:
    """Take the four units of a model."""
    given = {"length": length, "mass": mass, "force": force, "time": time}
    for kind, name in given.items():
        if name.lower() not in UNITS[kind]:
            raise Refused(f"{name} is no unit of {kind}")
    size = {kind: UNITS[kind][name.lower()] for kind, name in given.items()}
    model.length, model.newton = (
        size["length"],
        size["force"] / (size["mass"] * size["length"] / size["time"] ** 2),
    )


def real(text: str) -> float:
    """A number as Adams takes it."""
    if not re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([Ee][-+]?\d+)?", text):
        raise Refused(f"{text!r} is no number")
    return float(text)


def reals(text: str) -> Vector:
    """Three of them."""
    values = tuple(real(item.strip()) for item in text.split(","))
    if len(values) != 3:
        raise Refused(f"{text!r} is not three numbers")
    return values


@dataclass
class Bounce:
    """A contact in SI: speeds, duration, largest force, the height of the centre that the
    sphere rose to, and VX, VY, WX, WY, WZ after.
    """

    approach_speed: float
    separation_speed: float
    duration: float
    largest_force: float
    rebound_height: float = np.nan
    along: tuple[float, ...] = ()


class Motion:
    """A model made ready to move; anything that refers to nothing is refused here."""

    def __init__(self, model: Model) -> None:
        self.model = model
        if not model.newton or model.gravity is None:
            raise Refused("units or gravity are not stated")
        movable = [key for key, part in model.parts.items() if not part.ground]
        if len(movable) != 1 or len(model.parts) != 2 or len(model.forces) != 1:
            raise Refused(
                "one part that falls on the ground, and one force, are what this oracle can move"
            )
        self.key, self.part = movable[0], model.parts[movable[0]]
        if (
            self.part.centre not in model.markers
            or model.markers[self.part.centre][0] != self.key
            or not self.part.mass > 0
        ):
            raise Refused("the part has no mass, or no marker of its own at its centre")
        for one, (part, _) in model.markers.items():
            if part not in model.parts:
                raise Refused(f"marker {one} is on no part")
        self.scope = Scope(model.markers, model.sensors, {})
        self.scope.forces.update(dict.fromkeys(model.forces, lambda state: self.force(state)))
        for one, text in model.variables.items():
            self.scope.variables[one] = parse_function(text, self.scope)
        self.sensors = {
            one: (
                parse_function(sensor.function, self.scope),
                parse_function(sensor.evaluate, self.scope),
                sensor,
            )
            for one, sensor in model.sensors.items()
        }
        ((acts_on, along, text),) = model.forces.values()
        if (
            acts_on != self.part.centre
            or along not in model.markers
            or not model.parts[model.markers[along][0]].ground
        ):
            raise Refused("the force does not act from the ground on the centre of the part")
        if model.place(acts_on)[:2] != model.place(along)[:2]:
            raise Refused("the force's markers are not above each other")
        self.scope.touches.clear()
        self.force: Value = parse_function(text, self.scope)
        self.touch = self.scope.touches[0]
        self.general: list[Value] = []
        for one, seen_from, functions in model.general:
            if one != self.part.centre or not model.parts[model.markers[seen_from][0]].ground:
                raise Refused(
                    "the general force does not act on the centre of the part, "
                    "in the axes of the ground"
                )
            self.general += [parse_function(function, self.scope) for function in functions]
        for functions in model.requests.values():
            for function in functions:
                parse_function(function, self.scope)
        self.heights = {
            one: (model.place(one)[2], float(part == self.key))
            for one, (part, _) in model.markers.items()
        }
        self.held = dict.fromkeys(model.sensors, 0.0)
        self.always = True

    def state(self, moved: float, velocity: float, along: Sequence[float]) -> State:
        """The state when the part is so much higher than at the start; `along`: VX, VY,
        WX, WY and WZ.
        """
        heights = {one: start + moves * moved for one, (start, moves) in self.heights.items()}
        velocities = {one: moves * velocity for one, (_, moves) in self.heights.items()}
        names = zip(("VX", "VY", "WX", "WY", "WZ"), along, strict=True)
        measured = {
            name: {one: moves * value for one, (_, moves) in self.heights.items()}
            for name, value in names
        }
        state = State(heights, velocities, dict(self.held), measured)
        if self.always:
            for one, (function, evaluate, sensor) in self.sensors.items():
                if function(state) - sensor.value >= -sensor.error:
                    state.held[one] = evaluate(state)
        return state

    def run(self, *, always: bool = True, never: bool = False) -> list[Bounce]:
        """Move the part until the end.

        The manual does not say whether a sensor stores its value all the time that its event is
        true, or once, when it becomes true: `always` is the first, else the second, and then it
        does not yet at the start. `never`: it does not work at all.
        """
        self.always = always and not never
        (*pull, gravity), mass, unit = self.model.gravity, self.part.mass, self.model.length
        along = np.array(self.part.along)
        inertia = np.array([mass, mass, *self.part.inertia])
        centre = self.model.place(self.part.centre)[2]
        time, moved, velocity, bounces = 0.0, 0.0, self.part.velocity, []
        in_flight = self.touch(self.state(moved, velocity, along)) > 0.0 or velocity >= 0.0

        # each stretch counts its way from where it begins, so that the tolerance is one of the
        # indentation
        def state(y: np.ndarray) -> State:
            return self.state(moved + y[0], y[1], y[2:])

        def rates(_: float, y: np.ndarray) -> list[float]:
            # a trial step of a flight may end deep in the ground; that the force is zero above it
            # is checked below
            now = state(y)
            force = 0.0 if in_flight else self.force(now)
            x, y_force, z, *moments = (
                [0.0] * 6 if in_flight or not self.general else [one(now) for one in self.general]
            )
            turned = self.model.newton * np.array([x, y_force, *moments]) / inertia + [
                *pull,
                0.0,
                0.0,
                0.0,
            ]
            return [y[1], gravity + self.model.newton * (force + z) / mass, *turned]

        def gap(_: float, y: np.ndarray) -> float:
            return self.touch(state(y))

        gap.terminal = True
        while time < self.model.end:
            gap.direction = -1.0 if in_flight else 1.0
            found = solve_ivp(
                rates,
                (
                    time,
                    self.model.end if in_flight else min(self.model.end, time + LONGEST_CONTACT),
                ),
                [0.0, velocity, *along],
                method="DOP853",
                rtol=1e-12,
                atol=1e-14 / unit,
                events=[gap],
                dense_output=not in_flight,
                # the force has a kink where it is cut at zero
                max_step=np.inf if in_flight else 1e-6,
            )
            new_time, new = found.t[-1], found.y[:, -1]
            if not in_flight and found.status != 1:
                raise Refused("the contact does not end")
            if in_flight and bounces:
                bounces[-1].rebound_height = unit * (
                    centre + moved + _highest(velocity, gravity, new_time - time)
                )
            if not in_flight:
                forces = [
                    (self.force(state(found.sol(t))), t) for t in np.linspace(time, new_time, 201)
                ]
                around = max(forces)[1] + np.array([-1.0, 1.0]) * (new_time - time) / 200
                peak = minimize_scalar(
                    lambda t, f=found: -self.force(state(f.sol(t))),
                    bounds=around,
                    method="bounded",
                    options={"xatol": 1e-12},
                )
                bounces.append(Bounce(-unit * velocity, unit * new[1], new_time - time, -peak.fun))
                bounces[-1].along = (*(unit * new[2:4]), *new[4:])
            if in_flight and any(
                self.force(state(y)) != 0.0 for y in found.y.T if gap(0.0, y) > 0.0
            ):
                raise Refused("there is a force without contact")
            if in_flight and self.always:
                # in contact it holds what the solver's last step of the flight stored, wherever
                # that was: the middle, say
                half = 0.5 * (new_time - time)
                self.held = dict(
                    state(
                        np.array(
                            [
                                velocity * half + 0.5 * gravity * half**2,
                                velocity + gravity * half,
                                *along,
                            ]
                        )
                    ).held
                )
            if not in_flight and not (always or never):
                self.held = {
                    one: evaluate(state(new)) for one, (_, evaluate, _) in self.sensors.items()
                }
            time, moved, velocity, along, in_flight = (
                new_time,
                moved + new[0],
                new[1],
                new[2:],
                not in_flight,
            )
        return bounces


def _highest(velocity: float, gravity: float, span: float) -> float:
    """How far a parabola rises."""
    rise = min(velocity / -gravity, span)
    return velocity * rise + 0.5 * gravity * rise**2
