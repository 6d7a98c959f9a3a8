"""Test-analysis correlation of records with the simulation of a case."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy import fft

from vibroimpact.arrays import Complex, Floats
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.sensor import Sensor
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
from vibroimpact.test_analysis.shared_differences import doubts_of_differences, shared_differences
from vibroimpact.test_analysis.simulated import (
    Listening,
    Pushes,
    listening,
    plate_problem,
    pushes_of_impact,
)


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
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 10,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "steel"},
    ...         "plate": plate,
    ...         "drop": {"speed": 1.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "run": {"duration": 0.1},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03], "rate": 20e3}],
    ...     }
    ... )
    >>> record = vi.Record("a", vi.simulate(case).signals()["a"].value, 20e3, "m/s2")
    >>> found = vi.correlate(case, [record], window=0.05)
    >>> found.sensors[0].name, round(float(found.frac[0]), 4)
    ('a', 1.0)
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
    r"""Compare records of a test with the simulation of a case: overlay, residual, frequency
    responses, and the modes of both.

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
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 10,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "steel"},
    ...         "plate": plate,
    ...         "drop": {"speed": 1.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "run": {"duration": 0.1},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03], "rate": 20e3}],
    ...     }
    ... )
    >>> signal = vi.simulate(case).signals()["a"]
    >>> found = correlate(case, [Record("a", signal.value, 20e3, "m/s2")], window=0.05)
    >>> bool(found.relative_residual[0] < 0.01), round(float(found.frac[0]), 4)
    (True, 1.0)
    """
    problem = plate_problem(case, progress)
    records, force = (
        [without_baseline(one) for one in records],
        None if force is None else without_baseline(force),
    )
    acquired = acquired_of(problem.sensors, records, force)
    sought = _band(problem, acquired, band)
    rate, samples = acquired.rate, acquired.value.shape[1]
    hears = listening(problem, acquired.sensors, samples)
    acting = _acting(problem, acquired, hears, window)
    ends = force_ends(acting.pushes, sought[1])
    used = (
        (sought[0], ends)
        if band is None and ends is not None and is_excited(sought, ends)
        else sought
    )
    heard = _heard(hears, acquired, acting, used)
    delay, simulated = heard.delay, heard.value
    value = delay.polarity[:, None] * acquired.value
    touch = acting.about + delay.time if acquired.force is None else acquired.onsets[0] / rate
    onsets = acquired.onsets if acquired.force is not None else (max(0, round(touch * rate)),)
    pieces = _pieces(onsets, int(acting.length * rate), samples)
    measured_response, coherence = _responses(value, acquired.force, pieces)
    frequency = np.arange(measured_response.shape[1]) * rate / (pieces[0].stop - pieces[0].start)
    inside = (frequency >= used[0]) & (frequency <= used[1])
    measured_response = measured_response[:, inside]
    pairs = pairs_of(
        problem, acquired.sensors, _decays(acquired, value, pieces, acting.over, sought), sought
    )
    differences = shared_differences(pairs)
    as_scaled = differences.scaled(problem)
    as_damped = differences.damped(as_scaled)
    scaled = (
        heard
        if as_scaled is problem
        else _heard(listening(as_scaled, acquired.sensors, samples), acquired, acting, used)
    )
    damped = (
        scaled
        if as_damped is as_scaled
        else _heard(listening(as_damped, acquired.sensors, samples), acquired, acting, used)
    )
    responses = [
        _responses(one.value, acquired.force, pieces)[0][:, inside]
        for one in (heard, scaled, damped)
    ]
    plain_frac, scaled_frac, damped_frac = (frac(measured_response, one) for one in responses)
    octaves = octaves_of(used)
    whole = [*records, *([] if force is None else [force])]
    of_files = dict.fromkeys(doubt for record in whole for doubt in record.named_doubts)
    aligned = aligned_time(rate, acting.length)
    of_test = doubts_about(
        problem, acquired, delay, damped.delay, heard.skew, Excited(used, sought, ends), aligned
    )
    return Correlation(
        case=case,
        sensors=acquired.sensors,
        band=used,
        first_touch=acquired.start + touch,
        delay=delay.time if acquired.force is not None else acquired.start + touch,
        polarity=delay.polarity,
        coefficient=delay.correlation,
        time=np.arange(pieces[0].start, pieces[0].stop) / rate - touch,
        measured=band_limited(value, rate, used)[:, pieces[0]],
        simulated=band_limited(simulated, rate, used)[:, pieces[0]],
        frequency=frequency[inside],
        measured_response=measured_response,
        simulated_response=responses[0],
        coherence=None if coherence is None else coherence[:, inside],
        hits=len(pieces) if acquired.force is not None else 0,
        octaves=octaves,
        frac=plain_frac,
        octave_frac=frac_of_octaves(octaves, frequency[inside], measured_response, responses[0]),
        scaled_frac=scaled_frac,
        damped_frac=damped_frac,
        modes=pairs,
        removed={one.name: part for one, part in zip(whole, acquired.removed, strict=True)},
        skew=heard.skew,
        doubts=(
            *of_files,
            *doubts_of_differences(differences, plain_frac, scaled_frac, damped_frac),
            *of_test,
        ),
        aligned=aligned,
    )


class _Heard(NamedTuple):
    """A simulation in the time of the records: how much later they are, as `delay_of`
    returns it, and its samples, (S, samples).
    """

    delay: Delay
    skew: Floats
    value: Floats


def _heard(
    hears: Listening, acquired: Acquired, acting: _Acting, band: tuple[float, float]
) -> _Heard:
    """Return what sensors hear of a force, aligned with the records within a band."""
    delay, skew = delay_of(acquired, hears.to(acting.pushes, acting.about), band, acting.length)
    return _Heard(delay, skew, hears.to(acting.pushes, acting.about + delay.time))


@dataclass(frozen=True)
class _Acting:
    """The force that the simulation answers to.

    Parameters
    ----------
    pushes : Pushes
        The force.
    about : float
        About when its time begins, after the first sample of the records [s].
    length : float
        Time from the first touch on that is compared [s].
    over : float
        When the force is over, after the first touch [s].
    """

    pushes: Pushes
    about: float
    length: float
    over: float


def _acting(
    problem: Problem, acquired: Acquired, hears: Listening, window: float | None
) -> _Acting:
    """Return the force that was measured, or that of the case's impact.

    Raises
    ------
    InputError
        If the window is not above 0, or there are too few samples in it.
    """
    if window is not None and not window > 0.0:
        raise InputError(f"a window of {window:g} s is not allowed; it must be longer than 0 s")
    rate = acquired.rate
    length = min(np.inf if window is None else window, _longest(acquired))
    if acquired.force is None:
        pushes = pushes_of_impact(problem, rate, length, 2 if window is None else None)
        if window is None and len(pushes.contacts) > 1:
            length = min(length, float(pushes.contacts[1, 0]) - HALF_LENGTH / rate)
        pushes = replace(pushes, contacts=pushes.contacts[pushes.contacts[:, 0] < max(length, 0.0)])
        over = float(pushes.contacts[:, 1].max(initial=0.0))
        # both reach a tenth of their largest at the same time
        reached = min(onset_time(Record("", one, rate, "")) for one in hears.to(pushes, 0.0))
        acting = _Acting(pushes, acquired.onsets[0] / rate - reached, length, over)
    else:
        time = np.arange(len(acquired.force)) / rate
        over = (
            max(end - onset for end, onset in zip(acquired.ends, acquired.onsets, strict=True))
            / rate
        )
        acting = _Acting(
            Pushes(time, acquired.force / rate, acquired.pulse_times), 0.0, length, over
        )
    if length * rate < LEAST:
        until, remedy = "to the next one, or to the end of the records", "give longer records"
        if len(acquired.onsets) > 1:
            remedy += ", or of hits that are further apart"
        if window is not None and length == window:
            until, remedy = f"within the window of {window:g} s", "give a longer one"
        elif acquired.force is None:
            remedy = "give longer records" if length == _longest(acquired) else "state a window"
        words = f"there are {max(0, int(length * rate))} samples from the first touch on {until}"
        raise InputError(
            f"{words}; {LEAST} are needed, that is {1e3 * LEAST / rate:.3g} ms at {rate:g} "
            f"Hz; {remedy}"
        )
    return acting


def _pieces(onsets: Sequence[int], length: int, samples: int) -> list[slice]:
    """Return what is compared of each hit: of equal lengths, so that hits too near to an
    end of the records are left out.
    """
    whole = [
        slice(onset - LEAD, onset + length)
        for onset in onsets
        if onset >= LEAD and onset + length <= samples
    ]
    return whole or [slice(max(0, onsets[0] - LEAD), min(samples, onsets[0] + length))]


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
            words = (
                f"a band from {band[0]:g} to {band[1]:g} Hz is not allowed; it must rise from "
                f"above 0 to at most {acquired.passed:g} Hz"
            )
            raise InputError(
                f"{words}, which the sensors pass at {acquired.rate:g} samples per second"
            )
        return band
    lowest, highest = float(modes.frequencies[0]), float(modes.frequencies[-1])
    if lowest >= acquired.passed:
        held = any(sensor.corner == acquired.passed for sensor in acquired.sensors)
        faster = "raise the corner of the anti-alias filter" if held else "sample faster"
        raise InputError(
            f"the lowest mode of the plate has {lowest:.5g} Hz, and the sensors pass "
            f"{acquired.passed:g} Hz; {faster}"
        )
    return 0.5 * lowest, min(max(highest, 1.5 * lowest), acquired.passed)


def _longest(acquired: Acquired) -> float:
    """Return the time that every hit has before the next one, or the end of the records
    [s]; a last one with less than half is left out.
    """
    gaps = [after - onset - LEAD for onset, after in itertools.pairwise(acquired.onsets)]
    last = acquired.value.shape[1] - acquired.onsets[-1]
    shortest = min(gaps, default=last)
    return (last if 0.5 * shortest <= last < shortest else shortest) / acquired.rate


def _responses(
    value: Floats, force: Floats | None, pieces: Sequence[slice]
) -> tuple[Complex, Floats | None]:
    """Return frequency responses and their coherence from the pieces of a record; of a
    record without a force the spectrum of the first.
    """
    samples = pieces[0].stop - pieces[0].start
    # keeps the onset, and fades the end
    window = 0.5 + 0.5 * np.cos(np.pi * np.arange(samples) / samples)
    spectra = np.stack([fft.rfft(window * value[:, piece]) for piece in pieces])
    if force is None:
        return spectra[0] * 2.0 / window.sum(), None
    push = np.stack([fft.rfft(window * force[piece]) for piece in pieces])[:, None]
    cross, power = (spectra * push.conj()).sum(axis=0), (np.abs(push) ** 2).sum(axis=0)
    response = cross / np.maximum(power, 1e-300)
    if len(pieces) == 1:
        return response, None
    return response, np.abs(cross) ** 2 / np.maximum(
        power * (np.abs(spectra) ** 2).sum(axis=0), 1e-300
    )


def _decays(
    acquired: Acquired,
    value: Floats,
    pieces: Sequence[slice],
    over: float,
    band: tuple[float, float],
) -> Sequence[DecayMode]:
    """Return the modes in the free decay of records: from the end of the force on."""
    after = LEAD + int(np.ceil(over * acquired.rate)) + HALF_LENGTH + 1
    free = [
        Record(sensor.name, part, acquired.rate, sensor.unit)
        for piece in pieces
        for sensor, part in zip(
            acquired.sensors, value[:, piece.start + after : piece.stop], strict=True
        )
    ]
    return modes_in_decay(free, band)
