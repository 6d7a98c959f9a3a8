"""Coordinate systems of a Nastran file (CORD1R, CORD1C, CORD1S, CORD2R, CORD2C, CORD2S),
and the grid points that stand in them.
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
_LEAST = 1e-9
_OF_POINTS, _OF_NUMBERS = ("CORD1R", "CORD1C", "CORD1S"), ("CORD2R", "CORD2C", "CORD2S")


class _Grid(NamedTuple):
    """A grid point in a system of its own."""

    line: TextLine
    number: int
    system: int | None
    point: tuple[float, float, float]


@dataclass(frozen=True)
class _Given:
    """A system by three points, or three nodes: its origin, one on its axis z, and one in
    its half plane of x and z.
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
        a, b, c = point
        if self.kind == "C":
            angle = math.radians(b)
            local = (a * math.cos(angle), a * math.sin(angle), c)
        elif self.kind == "S":
            polar, azimuth = math.radians(b), math.radians(c)
            local = (
                a * math.sin(polar) * math.cos(azimuth),
                a * math.sin(polar) * math.sin(azimuth),
                a * math.cos(polar),
            )
        else:
            local = point
        return np.asarray(self.origin + np.array(local) @ self.axes)


_BASIC = _System("R", np.zeros(3), np.eye(3))


class NastranGrids:
    """Collected GRID, GRDSET and CORD cards; a system may be defined after the points in it."""

    def __init__(self) -> None:
        self._grids: list[_Grid] = []
        self._given: dict[int, _Given] = {}
        self._made: dict[int, _System] = {0: _BASIC}
        self._default = 0
        self._default_of_motion = ""
        self._of_motion: dict[int, str] = {}

    def take(self, card: Card) -> bool:
        """Read a card if it is one of these; return whether it was.

        Raises
        ------
        InputError
            If it can't be read.
        """
        line, name, fields = card.line, card.name, [*card.fields, *12 * [""]]
        if name == "GRID":
            self._grid(line, fields, len(card.fields))
        elif name == "GRDSET":
            self._default = _number(fields[1], line)
            self._default_of_motion = fields[5]
        elif name in _OF_NUMBERS:
            values = [nastran_real(field, line) for field in fields[2:11]]
            points = tuple((values[at], values[at + 1], values[at + 2]) for at in (0, 3, 6))
            self._given[_number(fields[0], line)] = _Given(
                line, name[-1], _number(fields[1], line), points
            )
        elif name in _OF_POINTS:
            for start in (0, 4):  # two systems on a card
                if fields[start]:
                    numbers = tuple(
                        parse_integer(field, line, "the number of a node")
                        for field in fields[start + 1 : start + 4]
                    )
                    self._given[_number(fields[start], line)] = _Given(
                        line, name[-1], 0, (), numbers
                    )
        else:
            return False
        return True

    def _grid(self, line: TextLine, fields: list[str], count: int) -> None:
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
            self._of_motion[number] = fields[5]

    @property
    def turned(self) -> set[int]:
        """The points whose components of motion are along axes other than those of the
        basic system.
        """
        default = (
            [grid.number for grid in self._grids if grid.number not in self._of_motion]
            if self._default_of_motion not in ("", "0")
            else []
        )
        return {number for number, system in self._of_motion.items() if system != "0"} | set(
            default
        )

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
        system = self._default if grid.system is None else grid.system
        if system == 0:
            return grid.point
        x, y, z = self._system(system, grid.line, depth).basic(grid.point).tolist()
        return x, y, z

    def _system(self, number: int, line: TextLine, depth: int) -> _System:
        """Return a system, which a line refers to."""
        if number in self._made:
            return self._made[number]
        given = self._given.get(number)
        if given is None:
            cards = f"{', '.join((*_OF_POINTS, *_OF_NUMBERS[:-1]))} or {_OF_NUMBERS[-1]}"
            raise line.wrong(
                f"the coordinate system {number} is not in the file; its {cards} must be"
            )
        if depth > _DEEPEST:
            raise given.line.wrong(
                f"the coordinate system {number} refers to itself, or to more than "
                f"{_DEEPEST} others in a chain"
            )
        if given.nodes:
            at = np.array([self._place(node, given.line, depth + 1) for node in given.nodes])
        else:
            reference = self._system(given.reference, given.line, depth + 1)
            at = np.array([reference.basic(point) for point in given.points])
        axis, third = at[1] - at[0], at[2] - at[0]
        normal = np.cross(axis, third)
        if not np.linalg.norm(normal) > _LEAST * np.linalg.norm(axis) * np.linalg.norm(third):
            raise given.line.wrong(
                f"the three points of the coordinate system {number} lie on one line; the "
                "third must lie beside its axis z"
            )
        z, y = axis / np.linalg.norm(axis), normal / np.linalg.norm(normal)
        self._made[number] = _System(given.kind, at[0], np.stack([np.cross(y, z), y, z]))
        return self._made[number]

    def _place(self, number: int, line: TextLine, depth: int) -> tuple[float, float, float]:
        """Return the place of a grid point that defines a system."""
        grid = next((one for one in self._grids if one.number == number), None)
        if grid is None:
            raise line.wrong(
                f"the GRID {number} that defines the coordinate system is not in the file"
            )
        return self._basic(grid, depth)


def _number(text: str, line: TextLine) -> int:
    """Return the number of a coordinate system; the basic one, 0, for a blank field."""
    return parse_integer(text, line, "the number of a coordinate system") if text else 0
