"""Types of the resolved case: the tables of `case.toml`, in SI, with all defaults resolved.

A problem carries the resolved case that it was made from, and a result the one that its folder
holds. Numbers may be arrays, with one value per drop of a batch. Keys that do not apply to a case
are absent.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from vibroimpact.arrays import Array


class ResolvedBody(TypedDict, total=False):
    """The keys that sphere and plate share."""

    material: Any  # a table of numbers, or "rigid"
    model: str
    radius: Array
    modes: int
    max_frequency: float
    damping: Any
    mesh: Mapping[str, Any]
    reduction: str
    attachment_mode: bool


class ResolvedSphere(ResolvedBody, total=False):
    """The sphere."""

    mass: Array
    inertia: Array | str


class ResolvedPlate(ResolvedBody, total=False):
    """The plate, or the sphere that takes its place."""

    size: Sequence[Array]
    element: str
    supports: Any
    inclination: Array
    motion: Mapping[str, Any]


class ResolvedDrop(TypedDict, total=False):
    """The drop: height or speed, its angle or a velocity, spin, position, gravity, air."""

    height: Array  # m
    speed: Array  # m/s
    angle: Array  # rad
    velocity: Sequence[Array]  # m/s
    spin: Sequence[Array]  # rad/s
    position: Sequence[Array]  # m
    gravity: Array  # m/s^2
    air: Mapping[str, Array]
    same_spot: bool


class ResolvedRun(TypedDict, total=False):
    """The stop rules and the tolerance."""

    impacts: int | str
    duration: float
    rest_speed: Array
    tolerance: float


class ResolvedSensor(TypedDict, total=False):
    """A sensor."""

    name: str
    position: Sequence[float] | str
    face: str
    quantity: str
    direction: Any
    rate: float
    filter: str
    corner: float
    instrument: str
    accelerometer: Mapping[str, Any]
    geophone: Mapping[str, Any]
    strain_gauge: Mapping[str, Any]
    force: Mapping[str, Any]
    microphone: Mapping[str, Any]
    amplifier: Mapping[str, Any]
    converter: Mapping[str, Any]


class ResolvedCase(TypedDict, total=False):
    """A resolved case; empty for a problem that was made in Python.

    `contact`: the name of the law, its parameters, the treatment of local compliance, and
    `friction`: its law and parameters.
    """

    schema_version: int
    name: str
    sphere: ResolvedSphere
    plate: ResolvedPlate
    drop: ResolvedDrop
    contact: dict[str, Any]
    run: ResolvedRun
    sensors: Sequence[ResolvedSensor]
    calibrate: Mapping[str, Any]
    sweep: Mapping[str, Any]
