"""Ports of a plate: the places and directions in which contact forces act on it during a run."""

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
        """Return the forces of a stretch as pulses, with their ports; arguments are those
        of `pulses`.
        """
        port = self.of(stretch.system)
        forces = [stretch.force[0], *(() if stretch.sliding is None else stretch.sliding.force)]
        return [
            (port + number, pulses(stretch, force, fastest, until))
            for number, force in enumerate(forces)
        ]


def ports_of(segments: Sequence[VibratingSegment]) -> Ports:
    """Return the ports of the plate in a run."""
    shapes: list[Floats] = []
    residuals: list[Mapping[str, Floats]] = []
    first: dict[int, int] = {}
    for segment in segments:
        system, ground = segment.system, segment.system.ground
        if id(system) in first:
            continue
        first[id(system)] = len(shapes)
        rubs = () if system.along is None else -system.along[:, ground]
        shapes += [system.shape[0, ground], *rubs]
        residuals += [system.residuals, *({} for _ in rubs)]
    return Ports(np.array(shapes), residuals, first)
