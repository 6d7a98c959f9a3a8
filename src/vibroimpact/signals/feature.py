"""What a feature is, and a family of features, which share their computation.

A feature is a number with a name, a unit, an equation and a source.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.reasons import Reason


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A number that describes a signal.

    Parameters
    ----------
    name : str
        Its name, in lower case with underscores.
    meaning : str
        What it is, in a few words.
    equation : str
        Its equation in plain characters: x are the samples, a the envelope, P the energy of the
        spectrum by frequency f.
    source : str
        Author, year and place of the definition.
    unit : str, default "1"
        The unit, apart from that of the signal: "s", "Hz".
    degree : int, default 0
        The power of the signal's scale, and of its unit, that it grows with: 1 for amplitudes, 2
        for energies, 0 for shapes.
    offset_free : bool, default False
        Whether it stays the same when a constant is added to the signal.
    least : int, default 1
        The least number of samples that it needs.
    lacking : Reason, default Reason.UNDEFINED
        Why a signal that is no constant, of enough samples, can have no value of it.
    """

    name: str
    meaning: str
    equation: str
    source: str
    unit: str = "1"
    degree: int = 0
    offset_free: bool = False
    least: int = 1
    lacking: Reason = Reason.UNDEFINED

    def unit_for(self, signal: str) -> str:
        """Return the unit of the feature of signals in a unit.

        Examples
        --------
        >>> energy = Feature(name="energy", meaning="", equation="", source="", unit="s", degree=2)
        >>> energy.unit_for("V"), energy.unit_for("m/s^2"), energy.unit_for("1")
        ('V^2 s', '(m/s^2)^2 s', 's')
        """
        if not self.degree or signal in ("", "1"):
            return self.unit
        if self.degree == 1:
            power = signal
        elif set("/ ^") & set(signal):
            power = f"({signal})^{self.degree}"
        else:
            power = f"{signal}^{self.degree}"
        if self.unit == "1":
            return power
        return f"{power} {self.unit}"


@dataclass(frozen=True)
class Family:
    """Features that are computed together.

    Parameters
    ----------
    features : tuple of Feature
        The features.
    of : callable
        Takes a `Block` of n signals, whose largest magnitudes are 1/2 to 1, and returns the values
        (n, features); NaN where there is none. Signals shorter than the least `least` of the
        features never reach it.
    """

    features: tuple[Feature, ...]
    of: Callable[[Block], Floats]
