"""Coordinate systems of a Nastran file, and the grid points that stand in them.

The systems are those of CORD1R, CORD1C, CORD1S, CORD2R, CORD2C and CORD2S.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.meshes.nastran_cards import Card, nastran_real
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.text_files import TextLine, parse_integer

_DEEPEST = 100  # systems that refer to one another
# sine of the angle between the axis and the third point, below which the plane is not defined
_LEAST_SINE = 1e-9
_BY_NODES = ("CORD1R", "CORD1C", "CORD1S")
_BY_POINTS = ("CORD2R", "CORD2C", "CORD2S")


class _Grid(NamedTuple):
    """A grid point in a system of its own."""

    line: TextLine
    number: int
    system: int | None
    point: tuple[float, float, float]


@dataclass(frozen=True)
class _Definition:
    """A system by three points of a reference system, or by three nodes.

    They are its origin, one on its axis z, and one in its half plane of x and z.
    """

    line: TextLine
    kind: str
    reference: int
    points: tuple[tuple[float, float, float], ...]
    nodes: tuple[int, ...] = ()


class _System(NamedTuple):
    """A system in the basic one: its kind R, C or S, origin, and its axes as rows."""

    kind: str
    origin: Floats
    axes: Floats

    def basic(self, point: tuple[float, float, float]) -> Floats:
        """Return a point in the basic system."""
        if self.kind == "C":
            radius, angle, height = point
            angle = math.radians(angle)  # from the plane x z
            local = (radius * math.cos(angle), radius * math.sin(angle), height)
        elif self.kind == "S":
            radius, polar, azimuth = point
            polar = math.radians(polar)
            azimuth = math.radians(azimuth)
            local = (
                radius * math.sin(polar) * math.cos(azimuth),
                radius * math.sin(polar) * math.sin(azimuth),
                radius * math.cos(polar),
            )
        else:
            local = point
        return np.asarray(self.origin + np.array(local) @ self.axes)


_BASIC = _System("R", np.zeros(3), np.eye(3))


class NastranGrids:
    """Collected GRID, GRDSET and CORD cards; a system may be defined after the points in it."""

    def __init__(self) -> None:
        self._grids: list[_Grid] = []
        self._definitions: dict[int, _Definition] = {}
        self._systems: dict[int, _System] = {0: _BASIC}
        # of GRDSET, where a point has no system of its own
        self._default_system = 0
        self._default_system_of_motion = ""
        self._systems_of_motion: dict[int, str] = {}

    def take(self, card: Card) -> bool:
        """Read a card if it is one of these; return whether it was.

        Raises
        ------
        InputError
            If it can't be read.
        """
        line = card.line
        fields = [*card.fields, *12 * [""]]
        if card.name == "GRID":
            self._grid(line, fields, len(card.fields))
        elif card.name == "GRDSET":
            self._default_system = _number(fields[1], line)
            self._default_system_of_motion = fields[5]
        elif card.name in _BY_POINTS:
            values = [nastran_real(field, line) for field in fields[2:11]]
            points = tuple((values[at], values[at + 1], values[at + 2]) for at in (0, 3, 6))
            self._definitions[_number(fields[0], line)] = _Definition(
                line, card.name[-1], _number(fields[1], line), points
            )
        elif card.name in _BY_NODES:
            for start in (0, 4):  # two systems on a card
                if fields[start]:
                    nodes = tuple(
                        parse_integer(field, line, "the number of a node")
                        for field in fields[start + 1 : start + 4]
                    )
                    self._definitions[_number(fields[start], line)] = _Definition(
                        line, card.name[-1], 0, (), nodes
                    )
        else:
            return False
        return True

    def _grid(self, line: TextLine, fields: list[str], count: int) -> None:
        """Read a GRID card, which has `count` fields."""
        number = parse_integer(fields[0], line, "the number of a node")
        if count < 5:
            raise line.wrong(
                f"GRID* {number} has two coordinates; the third must stand in a second "
                "line, which starts with *"
            )
        x, y, z = (nastran_real(field, line) for field in fields[2:5])
        system = _number(fields[1], line) if fields[1] else None
        self._grids.append(_Grid(line, number, system, (x, y, z)))
        if fields[5]:
            self._systems_of_motion[number] = fields[5]

    @property
    def turned(self) -> set[int]:
        """The points whose components of motion are along axes other than the basic ones."""
        points = {number for number, system in self._systems_of_motion.items() if system != "0"}
        if self._default_system_of_motion not in ("", "0"):
            points |= {
                grid.number for grid in self._grids if grid.number not in self._systems_of_motion
            }
        return points

    def add_to(self, parts: Parts) -> None:
        """Add the grid points in the basic system.

        Raises
        ------
        InputError
            If a system is not defined, refers to itself, or its points lie on one line.
        """
        for grid in self._grids:
            parts.add_node(grid.line, grid.number, self._basic(grid, 0))

    def _basic(self, grid: _Grid, depth: int) -> tuple[float, float, float]:
        """Return the coordinates of a grid point in the basic system."""
        system = grid.system
        if system is None:
            system = self._default_system
        if system == 0:
            return grid.point
        x, y, z = self._system(system, grid.line, depth).basic(grid.point).tolist()
        return x, y, z

    def _system(self, number: int, line: TextLine, depth: int) -> _System:
        """Return a system to which a line refers.

        `depth` counts the systems that refer to it in a chain.
        """
        if number in self._systems:
            return self._systems[number]
        definition = self._definitions.get(number)
        if definition is None:
            cards = f"{', '.join((*_BY_NODES, *_BY_POINTS[:-1]))} or {_BY_POINTS[-1]}"
            raise line.wrong(
                f"the coordinate system {number} is not in the file; its {cards} must be"
            )
        if depth > _DEEPEST:
            raise definition.line.wrong(
                f"the coordinate system {number} refers to itself, or to more than "
                f"{_DEEPEST} others in a chain"
            )
        if definition.nodes:
            points = np.array(
                [self._position(node, definition.line, depth + 1) for node in definition.nodes]
            )
        else:
            reference = self._system(definition.reference, definition.line, depth + 1)
            points = np.array([reference.basic(point) for point in definition.points])
        # the origin, a point of the axis z, and one of the plane x z
        origin = points[0]
        axis = points[1] - origin
        in_plane = points[2] - origin
        normal = np.cross(axis, in_plane)
        least = _LEAST_SINE * np.linalg.norm(axis) * np.linalg.norm(in_plane)
        if not np.linalg.norm(normal) > least:
            raise definition.line.wrong(
                f"the three points of the coordinate system {number} lie on one line; the "
                "third must lie beside its axis z"
            )
        z = axis / np.linalg.norm(axis)
        y = normal / np.linalg.norm(normal)
        self._systems[number] = _System(definition.kind, origin, np.stack([np.cross(y, z), y, z]))
        return self._systems[number]

    def _position(self, number: int, line: TextLine, depth: int) -> tuple[float, float, float]:
        """Return the position of a grid point that defines a system."""
        grid = next((grid for grid in self._grids if grid.number == number), None)
        if grid is None:
            raise line.wrong(
                f"the GRID {number} that defines the coordinate system is not in the file"
            )
        return self._basic(grid, depth)


def _number(text: str, line: TextLine) -> int:
    """Return the number of a coordinate system; the basic one, 0, for a blank field."""
    if not text:
        return 0
    return parse_integer(text, line, "the number of a coordinate system")
