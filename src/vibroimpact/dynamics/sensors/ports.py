"""Ports of a plate: the positions and directions in which contact forces act on it in a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.pulses import Pulses, pulses
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment


@dataclass(frozen=True)
class Ports:
    """Ports of a plate, to each of which minus a force is an input.

    `shapes`: displacement in each coordinate of the plate against the force at each port (ports, n)
    [kg^-1/2]. `residuals`: residual compliances between each and the sensors, by their names (3,)
    [m/N]. `first`: the port of the normal force for each system of a run, by its identity; those of
    friction, and of its moments, follow it.
    """

    shapes: Floats
    residuals: Sequence[Mapping[str, Floats]]
    first: Mapping[int, int]

    def of(self, system: LinearSystem) -> int:
        """Return the port of the normal force of a system."""
        return self.first[id(system)]

    def pulses(
        self, stretch: VibratingStretch, fastest: float, until: Floats | None = None
    ) -> list[tuple[int, Pulses]]:
        """Return the forces of a stretch as pulses, with their ports.

        Arguments are those of `pulses`.
        """
        normal_port = self.of(stretch.system)
        forces = [stretch.force[0]]
        if stretch.sliding is not None:
            forces += list(stretch.sliding.force)
        return [
            (normal_port + number, pulses(stretch, force, fastest, until))
            for number, force in enumerate(forces)
        ]


def ports_of(segments: Sequence[VibratingSegment]) -> Ports:
    """Return the ports of the plate in a run."""
    shapes: list[Floats] = []
    residuals: list[Mapping[str, Floats]] = []
    first: dict[int, int] = {}
    for segment in segments:
        system = segment.system
        ground = system.ground
        if id(system) in first:
            continue
        first[id(system)] = len(shapes)
        shapes.append(system.shape[0, ground])
        residuals.append(system.residuals)
        if system.along is not None:  # friction, without residual compliances
            tangential_shapes = -system.along[:, ground]
            shapes += list(tangential_shapes)
            residuals += [{}] * len(tangential_shapes)
    return Ports(np.array(shapes), residuals, first)
