"""Types of the resolved case: the tables of `case.toml`, in SI, with all defaults.

A problem carries the resolved case that it was made from, and a result the one that its folder
holds. Numbers may be arrays, with one value per drop of a batch. Keys that do not apply to a case
are absent.

`vibroimpact.cases.sections.resolved_types` writes this file from the schema.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from vibroimpact.arrays import Array


class ResolvedSphere(TypedDict, total=False):
    """The body that falls."""

    radius: Array
    material: Any
    mass: Array
    inertia: Array
    model: str
    modes: int | str
    max_frequency: Array
    accuracy: Array
    damping: Any
    mesh: Any
    reduction: str
    attachment_mode: bool


class ResolvedPlate(TypedDict, total=False):
    """What the sphere falls on: a plate, or another sphere; held fixed, or free."""

    material: Any
    radius: Array
    size: Sequence[Array]
    model: str
    element: str
    modes: int | str
    max_frequency: Array
    accuracy: Array
    damping: Any
    supports: Any
    inclination: Array
    motion: Mapping[str, Any]
    mesh: Any
    reduction: str
    attachment_mode: bool


class ResolvedDrop(TypedDict, total=False):
    """How the sphere comes down: from a height, or with a speed or velocity at first touch."""

    height: Array
    speed: Array
    angle: Array
    velocity: Sequence[Array]
    spin: Sequence[Array]
    position: Sequence[Array]
    gravity: Array
    air: Mapping[str, Any]
    same_spot: bool


class ResolvedRun(TypedDict, total=False):
    """When to stop, and how exact to be."""

    impacts: int | str
    duration: Array
    rest_speed: Array
    tolerance: Array


class ResolvedSensor(TypedDict, total=False):
    """A sensor at a point of the plate, or a microphone in the air."""

    name: str
    position: Sequence[Array] | str
    face: str
    instrument: str
    quantity: str
    direction: str | Sequence[Array]
    rate: Array
    filter: str
    corner: Array
    accelerometer: Mapping[str, Any]
    geophone: Mapping[str, Any]
    strain_gauge: Mapping[str, Any]
    force: Mapping[str, Any]
    microphone: Mapping[str, Any]
    amplifier: Mapping[str, Any]
    converter: Mapping[str, Any]


class ResolvedCase(TypedDict, total=False):
    """A case as a file has it: its sections, validated, in SI."""

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
