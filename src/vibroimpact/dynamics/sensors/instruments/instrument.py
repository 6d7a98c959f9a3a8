"""The interface of instruments to cases and to the measuring chain, and what they measure."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields
from typing import ClassVar, Literal, Protocol, cast

from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section

Quantity = Literal[
    "acceleration", "velocity", "displacement", "voltage", "strain", "pressure", "force"
]
UNITS: dict[Quantity, str] = {
    "acceleration": "m/s2",
    "velocity": "m/s",
    "displacement": "m",
    "voltage": "V",
    "strain": "m/m",
    "pressure": "Pa",
    "force": "N",
}
"""The SI unit of each quantity."""
MOTIONS: dict[Quantity, int] = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Order of the derivative of the displacement that each quantity of a point in motion is."""
Direction = tuple[float, float, float]
Subject = Literal["motion", "strain", "support", "sound"]
"""What an instrument is sensitive to: the motion of a point, the strain of a face, the force of a
support, or the sound in front of a face.
"""
SUBJECTS_AT_REST = ("support", "sound")
"""Subjects of instruments for plates whose supports are at rest."""


class Instrument(Protocol):
    r"""A transducer of the displacement or strain u that it sees.

    Its output is :math:`y = g\,s^n \prod_k \frac{k_k}{s^2 + d_k s + k_k}\,u`.
    """

    @property
    def subject(self) -> Subject:
        """What it is sensitive to."""

    @property
    def quantity(self) -> Quantity:
        """What it puts out."""

    @property
    def order(self) -> int:
        """Order n of the derivative, from 0 to 3; 3 only with a pair of poles."""

    @property
    def gain(self) -> float:
        """The gain g, in the unit of its output over that of the derivative."""

    @property
    def sections(self) -> tuple[Section, ...]:
        """Its pairs of poles (k, d), each with a gain of one at frequency zero."""

    @property
    def steepness(self) -> float:
        """Power of the frequency by which u grows in modes of the same deflection.

        The effect of the modes left out is estimated with it.
        """

    def components(self, direction: Direction) -> Direction:
        """Return the weights in u of the three numbers that a mode has at the instrument.

        `direction`: of the instrument.
        """


@dataclass(frozen=True)
class InstrumentInCase:
    """What a case may say of an instrument: the base of instruments, which are one file each.

    The fields of a subclass, declared with `parameter`, are the keys of its table; the first
    paragraph of its docstring describes the table.
    """

    name: ClassVar[str]
    """The value of `instrument`; with "_" for "-" the key of the table."""

    noun: ClassVar[str]
    """What it is called in a sentence, with its article."""

    properties: ClassVar[str]
    """What the table gives, in a few words."""

    measures: ClassVar[Quantity]
    """What it puts out unless a sensitivity makes this a voltage."""

    subject: ClassVar[Subject]

    @classmethod
    def key(cls) -> str:
        """Return the key of the table."""
        return cls.name.replace("-", "_")

    @classmethod
    def needs_table(cls) -> bool:
        """Return whether it has properties without a default."""
        return any(item.default is MISSING for item in fields(cls))

    def stated_properties(self) -> list[str]:
        """Return its properties in words, with their units."""
        properties = []
        for item in fields(self):
            value = getattr(self, item.name)
            if value is not None:
                unit = item.metadata["unit"].replace("^", "")
                properties.append(f"{item.name.replace('_', ' ')} {value:g} {unit}".rstrip())
        return properties

    def instrument(self) -> Instrument:
        """Return the instrument as the measuring chain takes it."""
        return cast("Instrument", self)  # of which a case says all, unless a subclass says more
