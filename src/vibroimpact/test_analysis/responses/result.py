"""A correlation of measured frequency responses with those of a case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.report.reported import Reported
from vibroimpact.test_analysis.mode_pairs import ModePair


@dataclass(frozen=True, eq=False)
class ResponseCorrelation(Reported, reported_in="vibroimpact.test_analysis.responses.report"):
    """Comparison of measured frequency responses with those of a case.

    Parameters
    ----------
    case : Case
        The case.
    sensors : tuple of Sensor
        The sensors that have a response.
    units : tuple of str
        Unit of each response.
    reference : str
        Name in the file of the place that is that of the case's impact.
    reciprocal : bool
        Whether the hammer was at the sensors, and the motion was measured at the place of the
        impact.
    band : tuple of two floats
        The band of frequencies that is compared [Hz].
    polarity : array, shape (S,)
        1, or -1 where a response is upside down.
    frequency : array, shape (bins,)
        Frequencies in the band [Hz].
    measured_response, simulated_response : array of complex, shape (S, bins)
        The responses; measured ones with the polarity of the simulation.
    coherence : array, shape (S, bins), or None
        Coherence of force and motion; NaN for a response without, None if none has any.
    octaves : tuple of (float, float)
        The octaves of the band [Hz].
    frac, octave_frac : array, shape (S,) and (S, octaves)
        Frequency response assurance criterion over the band, and over each octave; NaN with fewer
        than four frequencies in it.
    scaled_frac : array, shape (S,)
        The criterion with the frequencies of the case scaled by what all of them have in common.
    damped_frac : array, shape (S,)
        The criterion with these frequencies and the measured damping ratios, where they differ from
        the case's.
    modes : tuple of ModePair
        The modes of the case and of the responses.
    doubts : tuple of str
        What is not sure, and why.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> measured = vi.test_analysis.responses_of_case(case, np.arange(50.0, 400.0))
    >>> found = vi.test_analysis.correlate_responses(case, measured)
    >>> found.sensors[0].name, found.frac.round(6).tolist(), found.scale.round(6).tolist()
    ('a1', [1.0], [1.0])
    """

    case: CaseTable
    sensors: tuple[Sensor, ...]
    units: tuple[str, ...]
    reference: str
    reciprocal: bool
    band: tuple[float, float]
    polarity: Floats
    frequency: Floats
    measured_response: Complex
    simulated_response: Complex
    coherence: Floats | None
    octaves: tuple[tuple[float, float], ...]
    frac: Floats
    octave_frac: Floats
    scaled_frac: Floats
    damped_frac: Floats
    modes: tuple[ModePair, ...]
    doubts: tuple[str, ...]

    @property
    def scale(self) -> Floats:
        """The size of the multiple of the simulated response nearest to the measured one, (S,).

        It is nearest by least squares.
        """
        return np.abs(_multiple(self.measured_response, self.simulated_response))

    @property
    def level_difference(self) -> Floats:
        """Median of the absolute difference of levels over the band, (S,) [dB]."""
        ratio = _sizes(self.measured_response) / _sizes(self.simulated_response)
        return np.asarray(np.median(np.abs(20.0 * np.log10(ratio)), axis=1))

    @property
    def phase_difference(self) -> Floats:
        """Median of the absolute difference of phases over the band, (S,) [rad]."""
        phase = np.angle(self.measured_response * self.simulated_response.conj())
        return np.asarray(np.median(np.abs(phase), axis=1))


def _multiple(measured: Complex, simulated: Complex) -> Complex:
    """Return the multiples of simulated responses that are nearest to the measured ones, (S,)."""
    products = np.sum(measured * simulated.conj(), axis=1)
    return np.asarray(products / np.sum(np.abs(simulated) ** 2, axis=1))


def _sizes(response: Complex) -> Floats:
    return np.maximum(np.abs(response), 1e-300)
