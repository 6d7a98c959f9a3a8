"""What correlations of records and of frequency responses have in common.

They are the criteria over octaves, and the modes.
"""

from __future__ import annotations

from typing import Protocol

from vibroimpact.arrays import Complex, Floats
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.test_analysis.mode_pairs import ModePair


class Criteria(Protocol):
    """A correlation as its tables and charts of FRAC and of modes have it; see `Correlation`."""

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """The sensors."""

    @property
    def band(self) -> tuple[float, float]:
        """The band of frequencies [Hz]."""

    @property
    def octaves(self) -> tuple[tuple[float, float], ...]:
        """The octaves of the band [Hz]."""

    @property
    def frac(self) -> Floats:
        """Frequency response assurance criterion over the band, (S,)."""

    @property
    def octave_frac(self) -> Floats:
        """The criterion over each octave, (S, octaves)."""

    @property
    def modes(self) -> tuple[ModePair, ...]:
        """The modes of the case and those that were measured."""


class Responses(Protocol):
    """A correlation as its table of responses has it."""

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """The sensors."""

    @property
    def frequency(self) -> Floats:
        """Frequencies in the band [Hz], (bins,)."""

    @property
    def measured_response(self) -> Complex:
        """The measured responses, (S, bins)."""

    @property
    def simulated_response(self) -> Complex:
        """The simulated responses, (S, bins)."""

    @property
    def coherence(self) -> Floats | None:
        """Coherence of force and motion, (S, bins); None if it is not known."""


class Comparison(Criteria, Responses, Protocol):
    """A correlation as its report has it."""

    @property
    def case(self) -> CaseTable:
        """The case."""

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is not sure, and why."""
