"""Test-analysis correlation of records with the simulation of a case."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy import fft

from vibroimpact.arrays import Complex, Floats
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.decay.find import DecayMode, modes_in_decay
from vibroimpact.signals.delay import Delay, band_limited
from vibroimpact.signals.frac import frac
from vibroimpact.signals.onset import onset_time
from vibroimpact.signals.record import Record, Removed
from vibroimpact.test_analysis.acquired import LEAD, Acquired, acquired_of
from vibroimpact.test_analysis.alignment import LEAST, aligned_time, delay_of
from vibroimpact.test_analysis.doubts import doubts_about
from vibroimpact.test_analysis.excitation import Excited, force_ends, is_excited
from vibroimpact.test_analysis.mode_pairs import ModePair, pairs_of
from vibroimpact.test_analysis.octaves import frac_of_octaves, octaves_of
from vibroimpact.test_analysis.shared_differences import (
    SharedDifferences,
    doubts_of_differences,
    shared_differences,
)
from vibroimpact.test_analysis.simulated import (
    ForceImpulses,
    ImpulseResponses,
    impact_force,
    impulse_responses,
    plate_problem,
)

_LEAST_POWER = 1e-300
"""Power that keeps quotients of spectral densities finite where a force has none."""


@dataclass(frozen=True, eq=False)
class Correlation(Reported, reported_in="vibroimpact.test_analysis.report"):
    """Comparison of the records of a test with the simulation of its case.

    Parameters
    ----------
    case : Case
        The case.
    sensors : tuple of Sensor
        The sensors that have a record, with its rate.
    band : tuple of two floats
        The band of frequencies that is compared [Hz].
    first_touch : float
        First touch in the time of the records [s].
    delay : float
        How much later the records are than the simulation [s], whose time begins with its first
        touch; under a measured force with the records, so that there is none if all were sampled
        together.
    polarity, coefficient : array, shape (S,)
        1, or -1 where a record is upside down; and the correlation coefficient of the time by which
        records are aligned.
    time : array, shape (samples,)
        Times since first touch [s].
    measured, simulated : array, shape (S, samples)
        The signals within the band; measured ones with the polarity of the simulation.
    frequency : array, shape (bins,)
        Frequencies in the band [Hz].
    measured_response, simulated_response : array of complex, shape (S, bins)
        Frequency responses to the force where it was measured; else the spectra of both signals.
    coherence : array, shape (S, bins), or None
        Coherence of force and record, of two hits and more.
    hits : int
        Hits of the hammer; 0 if no force was measured.
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
        The modes of the case and of the records.
    removed : dict of str to Removed
        The baseline that was removed from each record, that of the force last.
    skew : array, shape (S,)
        How much later each record is than the others and its own simulation, as channels that were
        not sampled together are [s].
    doubts : tuple of str
        What is not sure, and why.
    aligned : float
        Time from the first touch on by which records and simulation are aligned [s]: 5 ms, or the
        window if it is shorter, but 64 samples at least.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> record = vi.signals.Record("a1", vi.simulate(case).signals()["a1"].value, 25.6e3, "m/s2")
    >>> found = vi.test_analysis.correlate(case, [record], window=0.05)
    >>> found.sensors[0].name, round(float(found.frac[0]), 3)
    ('a1', 0.999)
    """

    case: CaseTable
    sensors: tuple[Sensor, ...]
    band: tuple[float, float]
    first_touch: float
    delay: float
    polarity: Floats
    coefficient: Floats
    time: Floats
    measured: Floats
    simulated: Floats
    frequency: Floats
    measured_response: Complex
    simulated_response: Complex
    coherence: Floats | None
    hits: int
    octaves: tuple[tuple[float, float], ...]
    frac: Floats
    octave_frac: Floats
    scaled_frac: Floats
    damped_frac: Floats
    modes: tuple[ModePair, ...]
    removed: Mapping[str, Removed]
    skew: Floats
    doubts: tuple[str, ...]
    aligned: float

    @property
    def residual(self) -> Floats:
        """What the simulation leaves of the records, (S, samples)."""
        return self.measured - self.simulated

    @property
    def relative_residual(self) -> Floats:
        """The rms value of the residual, relative to that of the record, (S,)."""
        return np.asarray(_rms(self.residual) / _rms(self.measured))

    @property
    def scale(self) -> Floats:
        """The multiple of the simulation that is nearest to the record, by least squares, (S,)."""
        return np.asarray(
            np.sum(self.measured * self.simulated, axis=1) / np.sum(self.simulated**2, axis=1)
        )


def correlate(
    case: CaseTable,
    records: Sequence[Record],
    *,
    force: Record | None = None,
    window: float | None = None,
    band: tuple[float, float] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Correlation:
    r"""Compare records of a test with the simulation of a case.

    Compared are the signals, the frequency responses, and the modes of both.

    Parameters
    ----------
    case : Case
        The plate with its supports and damping, the sensors, and the impact; with a measured force
        the impact's place alone.
    records : sequence of Record
        Records of one acquisition, named after the sensors.
    force : Record, optional
        The force of the hammer [N], of the same acquisition, with one hit or several.
    window : float, optional
        Time from the first touch on that is compared [s]; by default to the next impact, or to the
        end of the records.
    band : tuple of two floats, optional
        The band of frequencies [Hz]; by default from half the lowest mode of the plate to its
        highest, or to what the sensors pass, or to where the spectrum of the force, measured or
        that of the case's impact, has fallen by 20 dB. Modes are sought beyond that too.
    progress : callable, optional
        Called with the fraction done while modes are computed.

    Raises
    ------
    InputError
        If the plate is rigid or moves, the impact is oblique, a record has no sensor, rates differ,
        records do not overlap or are constant, or there is too little in the window or the band.

    Notes
    -----
    The case is simulated at the rate of the records. Without a measured force its own impact is;
    with one, its plate answers to that force. Both are brought to one time by the cross-correlation
    of the first 5 ms, or 64 samples, within the band. Frequency responses are those of the
    estimator :math:`H_1 = S_{aF} / S_{FF}` (Bendat and Piersol, Random Data), of the same window
    for both, so that they leak alike. Modes are those of `modes_in_decay`, from the end of the
    force on.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> signal = vi.simulate(case).signals()["a1"]
    >>> record = Record("a1", signal.value, signal.sensor.rate, "m/s2")
    >>> found = correlate(case, [record], window=0.05)
    >>> bool(found.relative_residual[0] < 0.1), round(float(found.frac[0]), 3)
    (True, 0.999)
    """
    problem = plate_problem(case, progress)
    records = [without_baseline(record) for record in records]
    if force is not None:
        force = without_baseline(force)
    acquired = acquired_of(problem.sensors, records, force)
    rate = acquired.rate
    sample_count = acquired.value.shape[1]
    sought = _band(problem, acquired, band)
    responses = impulse_responses(problem, acquired.sensors, sample_count)
    acting = _acting_force(problem, acquired, responses, window)
    ends = force_ends(acting.force, sought[1])
    compared = sought
    if band is None and ends is not None and is_excited(sought, ends):
        compared = (sought[0], ends)
    plain = _simulation(responses, acquired, acting, compared)
    delay = plain.delay
    measured = delay.polarity[:, None] * acquired.value
    onsets = acquired.onsets
    if acquired.force is None:
        first_touch = acting.start + delay.time
        delay_time = acquired.start + first_touch
        onsets = (max(0, round(first_touch * rate)),)
    else:
        first_touch = onsets[0] / rate
        delay_time = delay.time
    pieces = _pieces(onsets, int(acting.length * rate), sample_count)
    hits = 0 if acquired.force is None else len(pieces)
    decays = _decays(acquired, measured, pieces, acting.end, sought)
    pairs = pairs_of(problem, acquired.sensors, decays, sought)
    differences = shared_differences(pairs)
    scaled, damped = _corrected(plain, problem, differences, acquired, acting, compared)
    measured_response, coherence = _responses(measured, acquired.force, pieces)
    frequency = np.arange(measured_response.shape[1]) * rate / (pieces[0].stop - pieces[0].start)
    inside = (frequency >= compared[0]) & (frequency <= compared[1])
    frequency = frequency[inside]
    measured_response = measured_response[:, inside]
    if coherence is not None:
        coherence = coherence[:, inside]

    def response_of(simulation: _Simulation) -> Complex:
        return _responses(simulation.signals, acquired.force, pieces)[0][:, inside]

    simulated_response = response_of(plain)
    plain_frac = frac(measured_response, simulated_response)
    scaled_frac = frac(measured_response, response_of(scaled))
    damped_frac = frac(measured_response, response_of(damped))
    octaves = octaves_of(compared)
    aligned = aligned_time(rate, acting.length)
    # records of one file share its doubts, each of which is said once
    all_records = list(records)
    if force is not None:
        all_records.append(force)
    doubts = (
        *dict.fromkeys(doubt for record in all_records for doubt in record.named_doubts),
        *doubts_of_differences(differences, plain_frac, scaled_frac, damped_frac),
        *doubts_about(
            problem,
            acquired,
            delay,
            damped.delay,
            plain.skew,
            Excited(compared, sought, ends),
            aligned,
        ),
    )
    return Correlation(
        case=case,
        sensors=acquired.sensors,
        band=compared,
        first_touch=acquired.start + first_touch,
        delay=delay_time,
        polarity=delay.polarity,
        coefficient=delay.correlation,
        time=np.arange(pieces[0].start, pieces[0].stop) / rate - first_touch,
        measured=band_limited(measured, rate, compared)[:, pieces[0]],
        simulated=band_limited(plain.signals, rate, compared)[:, pieces[0]],
        frequency=frequency,
        measured_response=measured_response,
        simulated_response=simulated_response,
        coherence=coherence,
        hits=hits,
        octaves=octaves,
        frac=plain_frac,
        octave_frac=frac_of_octaves(octaves, frequency, measured_response, simulated_response),
        scaled_frac=scaled_frac,
        damped_frac=damped_frac,
        modes=pairs,
        removed={
            record.name: baseline
            for record, baseline in zip(all_records, acquired.removed, strict=True)
        },
        skew=plain.skew,
        doubts=doubts,
        aligned=aligned,
    )


class _Simulation(NamedTuple):
    """A simulation in the time of the records.

    How much later the records are, as `delay_of` returns it, and its samples, (S, samples).
    """

    delay: Delay
    skew: Floats
    signals: Floats


def _simulation(
    responses: ImpulseResponses,
    acquired: Acquired,
    acting: _ActingForce,
    band: tuple[float, float],
) -> _Simulation:
    """Return the response to a force, aligned with the records within a band."""
    unaligned = responses.signals(acting.force, acting.start)
    delay, skew = delay_of(acquired, unaligned, band, acting.length)
    return _Simulation(delay, skew, responses.signals(acting.force, acting.start + delay.time))


def _corrected(
    plain: _Simulation,
    problem: Problem,
    differences: SharedDifferences,
    acquired: Acquired,
    acting: _ActingForce,
    band: tuple[float, float],
) -> tuple[_Simulation, _Simulation]:
    """Return simulations with frequencies as they were measured, and with the damping too.

    `plain` is that of the problem itself, which is taken where nothing differs.
    """

    def simulation_of(changed: Problem) -> _Simulation:
        responses = impulse_responses(changed, acquired.sensors, acquired.value.shape[1])
        return _simulation(responses, acquired, acting, band)

    scaled_problem = differences.scaled(problem)
    damped_problem = differences.damped(scaled_problem)
    scaled = plain
    if scaled_problem is not problem:
        scaled = simulation_of(scaled_problem)
    damped = scaled
    if damped_problem is not scaled_problem:
        damped = simulation_of(damped_problem)
    return scaled, damped


@dataclass(frozen=True)
class _ActingForce:
    """The force that the simulation answers to.

    Parameters
    ----------
    force : ForceImpulses
        The force.
    start : float
        About when its time begins, after the first sample of the records [s].
    length : float
        Time from the first touch on that is compared [s].
    end : float
        When the force is over, after the first touch [s].
    """

    force: ForceImpulses
    start: float
    length: float
    end: float


def _acting_force(
    problem: Problem, acquired: Acquired, responses: ImpulseResponses, window: float | None
) -> _ActingForce:
    """Return the force that was measured, or that of the case's impact.

    Raises
    ------
    InputError
        If the window is not above 0, or there are too few samples in it.
    """
    if window is not None and not window > 0.0:
        raise InputError(f"a window of {window:g} s is not allowed; it must be longer than 0 s")
    if acquired.force is None:
        acting = _simulated_force(problem, acquired, responses, window)
    else:
        acting = _measured_force(acquired, acquired.force, window)
    if acting.length * acquired.rate < LEAST:
        raise InputError(_too_short(acquired, window, acting.length))
    return acting


def _simulated_force(
    problem: Problem, acquired: Acquired, responses: ImpulseResponses, window: float | None
) -> _ActingForce:
    """Return the contact force of the case's impact, and without a window up to the next one."""
    rate = acquired.rate
    length = _compared_length(acquired, window)
    # a second impact is computed only to end the comparison before it
    impacts = 2 if window is None else None
    force = impact_force(problem, rate, length, impacts=impacts)
    if window is None and len(force.contacts) > 1:
        second_touch = float(force.contacts[1, 0])
        length = min(length, second_touch - HALF_LENGTH / rate)
    begins = force.contacts[:, 0]
    force = replace(force, contacts=force.contacts[begins < max(length, 0.0)])
    # records and simulation reach a tenth of their largest at the same time
    onset = min(
        onset_time(Record("", signal, rate, "")) for signal in responses.signals(force, 0.0)
    )
    return _ActingForce(
        force,
        start=acquired.onsets[0] / rate - onset,
        length=length,
        end=float(force.contacts[:, 1].max(initial=0.0)),
    )


def _measured_force(acquired: Acquired, samples: Floats, window: float | None) -> _ActingForce:
    """Return the force of the hammer, an impulse at each of its samples."""
    rate = acquired.rate
    time = np.arange(len(samples)) / rate
    durations = [end - onset for end, onset in zip(acquired.ends, acquired.onsets, strict=True)]
    return _ActingForce(
        ForceImpulses(time, samples / rate, acquired.pulse_times),
        start=0.0,
        length=_compared_length(acquired, window),
        end=max(durations) / rate,
    )


def _compared_length(acquired: Acquired, window: float | None) -> float:
    """Return the time from the first touch on that is compared [s], as far as the records go."""
    longest = _longest(acquired)
    if window is None:
        return longest
    return min(window, longest)


def _too_short(acquired: Acquired, window: float | None, length: float) -> str:
    """Return the message that too few samples are compared, with a remedy."""
    if window is not None and length == window:
        until = f"within the window of {window:g} s"
        remedy = "give a longer one"
    else:
        until = "to the next one, or to the end of the records"
        remedy = "give longer records"
        if acquired.force is None:
            if length != _longest(acquired):
                remedy = "state a window"
        elif len(acquired.onsets) > 1:
            remedy += ", or of hits that are further apart"
    rate = acquired.rate
    return (
        f"there are {max(0, int(length * rate))} samples from the first touch on {until}; "
        f"{LEAST} are needed, that is {1e3 * LEAST / rate:.3g} ms at {rate:g} Hz; {remedy}"
    )


def _pieces(onsets: Sequence[int], length: int, samples: int) -> list[slice]:
    """Return the samples that are compared of each hit.

    They are of equal lengths, so that hits too near to an end of the records are left out.
    """
    complete = [
        slice(onset - LEAD, onset + length)
        for onset in onsets
        if onset >= LEAD and onset + length <= samples
    ]
    return complete or [slice(max(0, onsets[0] - LEAD), min(samples, onsets[0] + length))]


def _rms(value: Floats) -> Floats:
    return np.asarray(np.sqrt(np.mean(value**2, axis=1)))


def _band(
    problem: Problem, acquired: Acquired, band: tuple[float, float] | None
) -> tuple[float, float]:
    """Return the band of frequencies that is compared.

    Raises
    ------
    InputError
        If it reaches beyond what the sensors pass, or the plate has no mode there.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_problem` has seen to it
    if band is not None:
        if not 0.0 < band[0] < band[1] <= acquired.passed:
            raise InputError(
                f"a band from {band[0]:g} to {band[1]:g} Hz is not allowed; it must rise from "
                f"above 0 to at most {acquired.passed:g} Hz, which the sensors pass at "
                f"{acquired.rate:g} samples per second"
            )
        return band
    lowest = float(modes.frequencies[0])
    highest = float(modes.frequencies[-1])
    if lowest >= acquired.passed:
        remedy = "sample faster"
        if any(sensor.corner == acquired.passed for sensor in acquired.sensors):
            remedy = "raise the corner of the anti-alias filter"
        raise InputError(
            f"the lowest mode of the plate has {lowest:.5g} Hz, and the sensors pass "
            f"{acquired.passed:g} Hz; {remedy}"
        )
    return 0.5 * lowest, min(max(highest, 1.5 * lowest), acquired.passed)


def _longest(acquired: Acquired) -> float:
    """Return the time that every hit has before the next one, or the end of the records [s].

    A last one with less than half is left out.
    """
    gaps = [next_onset - onset - LEAD for onset, next_onset in itertools.pairwise(acquired.onsets)]
    last = acquired.value.shape[1] - acquired.onsets[-1]
    length = min(gaps, default=last)
    if 0.5 * length <= last < length:
        length = last
    return length / acquired.rate


def _responses(
    value: Floats, force: Floats | None, pieces: Sequence[slice]
) -> tuple[Complex, Floats | None]:
    """Return frequency responses of records and their coherence from the pieces of each hit.

    Without a force they are the spectra of the first piece. With one hit there is no coherence.
    """
    samples = pieces[0].stop - pieces[0].start
    # keeps the onset, and fades the end
    window = 0.5 + 0.5 * np.cos(np.pi * np.arange(samples) / samples)
    spectra = _spectra(value, pieces, window)
    if force is None:
        # a tone of amplitude 1 has the line 1, whatever the window
        return spectra[0] * 2.0 / window.sum(), None
    force_spectra = _spectra(force[None], pieces, window)
    # the sums over the hits estimate the spectral densities S_aF, S_FF and S_aa
    cross_power = (spectra * force_spectra.conj()).sum(axis=0)
    force_power = (np.abs(force_spectra) ** 2).sum(axis=0)
    response = cross_power / np.maximum(force_power, _LEAST_POWER)  # H_1
    if len(pieces) == 1:
        # of one hit, force and response are coherent whatever the noise
        return response, None
    record_power = (np.abs(spectra) ** 2).sum(axis=0)
    both_powers = np.maximum(force_power * record_power, _LEAST_POWER)
    return response, np.abs(cross_power) ** 2 / both_powers


def _spectra(value: Floats, pieces: Sequence[slice], window: Floats) -> Complex:
    """Return the spectra of the windowed pieces of records, (hits, S, frequencies)."""
    return np.stack([fft.rfft(window * value[:, piece]) for piece in pieces])


def _decays(
    acquired: Acquired,
    value: Floats,
    pieces: Sequence[slice],
    force_end: float,
    band: tuple[float, float],
) -> Sequence[DecayMode]:
    """Return the modes in the free decay of records, from the end of the force on [s]."""
    skipped = LEAD + int(np.ceil(force_end * acquired.rate)) + HALF_LENGTH + 1
    decays = []
    for piece in pieces:
        free = value[:, piece.start + skipped : piece.stop]
        for sensor, signal in zip(acquired.sensors, free, strict=True):
            decays.append(Record(sensor.name, signal, acquired.rate, sensor.unit))
    return modes_in_decay(decays, band)
