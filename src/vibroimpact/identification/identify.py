"""Identification: from records of sensors on a plate to the impact, with intervals.

It gives the force, its place, and the size and speed of the sphere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.cases.rigid.pair import ball_of, resized
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.errors import InputError
from vibroimpact.identification.doubts import contradiction, doubts_about
from vibroimpact.identification.force import Force, force_behind
from vibroimpact.identification.measured import Measured, is_own_run, measured_of
from vibroimpact.identification.plate import Place, Plate, plate_of
from vibroimpact.identification.polarity import upright
from vibroimpact.identification.pulses import Search
from vibroimpact.identification.setup import (
    MOUNTED_RESONANCES,
    SetupErrors,
    mounted_resonance,
)
from vibroimpact.identification.sphere import SphereFit, fit_sphere
from vibroimpact.report.reported import Reported
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.estimate import Estimate
from vibroimpact.signals.record import Record
from vibroimpact.units.display import digits

WINDOW = 5e-3
"""Time from first touch on that is used unless another is given [s]."""
_ALWAYS_CERTAIN = (
    "damping",
    "supports",
    "density of the plate",
    "material of the sphere",
    "contact law",
)
"""What is always taken as certain."""
_LEAST_CYCLES = 0.5
"""Least product of band and duration for which a force has a shape that is heard."""
_VAGUE = 0.5
"""Standard deviation of the logarithm of the duration from which on it is not determined."""


@dataclass(frozen=True, eq=False)
class Identification(Reported, reported_in="vibroimpact.identification.report"):
    """An impact identified from sensor records: its force, place, size and speed.

    Parameters
    ----------
    plate : Plate
        The plate.
    measured : Measured
        The records around first touch.
    search : Search
        The search for the place.
    sphere : SphereFit
        The sphere whose contact explains the records.
    force : Force, optional
        The force from the records alone, without a contact law; None where it contradicts the
        contact that was fitted.
    estimates : dict of str to Estimate
        What was found, by names that end in their units: `place_x_m`, `place_y_m`, `first_touch_s`,
        `radius_m`, `mass_kg`, `speed_m_s`, `duration_s`, `max_force_N` and `impulse_N_s` from the
        contact that was fitted; `recovered_max_force_N` and `recovered_impulse_N_s` from the
        records alone, unless they contradict the contact. A place that was given has no deviation.
    doubts : tuple of str
        What could not be told, and why.

    Notes
    -----
    `certain` lists what is taken as certain: errors of it are in no interval.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 30})
    >>> record = vi.signals.Record("a1", vi.simulate(case).signals()["a1"].value, 25.6e3, "m/s2")
    >>> found = vi.identification.identify(case, [record], place=(0.0, 0.0))
    >>> round(found.estimates["radius_m"].value, 3), found.estimates["radius_m"].interval[0] < 0.025
    (0.025, True)
    """

    plate: Plate
    measured: Measured
    search: Search
    sphere: SphereFit
    force: Force | None
    estimates: dict[str, Estimate]
    doubts: tuple[str, ...]

    @property
    def certain(self) -> tuple[str, ...]:
        """What is taken as certain."""
        of_setup = self.plate.errors.certain
        if all(mounted_resonance(sensor) is None for sensor in self.plate.problem.sensors):
            of_setup = tuple(item for item in of_setup if item != MOUNTED_RESONANCES)
        return (*of_setup, *_ALWAYS_CERTAIN)


def identify(
    case: CaseTable,
    records: Sequence[Record],
    *,
    place: Place | None = None,
    window: float = WINDOW,
    frequency_error: float = 0.0,
    errors: SetupErrors | None = None,
    progress: Callable[[float], None] | None = None,
) -> Identification:
    """Return force, place, size and speed of an impact, identified from records of a plate.

    The plate is elastic, and the records are those of its sensors.

    Parameters
    ----------
    case : Case
        The plate with its supports and damping, the sensors, the material of the sphere and the
        contact law. Radius, speed and place in it are not used.
    records : sequence of Record
        Records of one fall, named after the sensors.
    place : tuple of two floats, optional
        x and y of the impact [m]; by default it is sought.
    window : float, default 5e-3
        Time from first touch on that is used [s]; it must end before the next impact.
    frequency_error : float, default 0
        Standard deviation of the relative error of the plate's frequencies, beside the estimated
        error of the mesh [-].
    errors : SetupErrors, optional
        Standard deviations of what the case states about the plate and its sensors; by default all
        of it is taken as certain.
    progress : callable, optional
        Called with the fraction done while modes are computed.

    Raises
    ------
    InputError
        If the plate is rigid, a record has no sensor, is too short, or its sampling is too slow for
        the contact.

    Notes
    -----
    First a Hertzian pulse is sought over the plate, its impulse, duration and instant being
    eliminated at each place. From there the case's contact, computed on the elastic plate, is
    fitted to the records by least squares: place, radius, speed and first touch. Intervals follow
    from what the fit leaves, with the errors of the plate's frequencies and of the modes left out
    as unknowns with a prior, and with those of the set-up that are given. Records read from the
    folder of a run of the same plate have no errors of mesh and modes.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 20,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.case_of(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "rock-paper"},
    ...         "plate": plate,
    ...         "drop": {"speed": 2.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "run": {"impacts": 1},
    ...         "sensors": [
    ...             {"name": "a", "position": [0.1, 0.03], "rate": 20e3},
    ...             {"name": "b", "position": [-0.05, 0.08], "rate": 20e3},
    ...         ],
    ...     }
    ... )
    >>> signals = vi.simulate(case).signals()
    >>> found = identify(
    ...     case, [Record(name, one.value, 20e3, "m/s2") for name, one in signals.items()]
    ... )
    >>> [
    ...     round(found.estimates[name].value, 3)
    ...     for name in ("radius_m", "speed_m_s", "place_x_m", "place_y_m")
    ... ]
    [0.02, 2.0, 0.02, 0.01]
    """
    model_error = 0.0 if is_own_run(case, records) else 1.0
    plate = prepared_plate(
        case, window, frequency_error, progress, errors=errors, model_error=model_error
    )
    return identify_on(plate, records, place)


def prepared_plate(
    case: CaseTable,
    window: float = WINDOW,
    frequency_error: float = 0.0,
    progress: Callable[[float], None] | None = None,
    *,
    errors: SetupErrors | None = None,
    model_error: float = 1.0,
) -> Plate:
    """Return the plate of a case for `identify_on`, which identifies many impacts on it.

    Parameters
    ----------
    case, window, frequency_error, progress, errors
        As those of `identify`.
    model_error : float, default 1
        Part of the estimated errors of the mesh and of the modes left out that the records have: 0
        for those of a run of this model.

    Raises
    ------
    InputError
        If the plate is rigid, the case has no sensors, or a number is not allowed.
    """
    if not 0.0 < window <= 1.0:
        raise InputError(
            f"a window of {window:g} s is not allowed; it must be greater than 0 and at most 1 s"
        )
    if not 0.0 <= frequency_error < 0.5:
        raise InputError(
            f"an error of frequencies of {frequency_error:g} is not allowed; it must be at "
            "least 0 and less than 0.5 (0.01 is 1 %)"
        )
    return plate_of(case, window, frequency_error, progress, errors=errors, model_error=model_error)


def identify_on(
    plate: Plate, records: Sequence[Record], place: Place | None = None
) -> Identification:
    """Return what records tell of an impact on a plate.

    Parameters
    ----------
    plate : Plate
        The plate, from `prepared_plate`.
    records, place
        As those of `identify`.

    Raises
    ------
    InputError
        As `identify`.
    """
    records = [without_baseline(record) for record in records]
    measured, search = _started(plate, records, place)
    sphere = fit_sphere(plate, measured, search.candidates[0], place)
    x, y, _, _, touch = sphere.parameters.tolist()
    _, _, duration = sphere.force.facts.tolist()
    # with the noise about the fit, where that is larger
    noise = np.maximum(measured.noise, sphere.noise)
    setting = None if plate.errors.is_none else sphere.setting
    force = force_behind(
        sphere.plate,
        replace(measured, noise=noise),
        (x, y),
        touch,
        duration,
        setting,
    )
    doubts = [doubt for record in records for doubt in record.named_doubts]
    doubts = list(dict.fromkeys(doubts))  # of a file with several records, once
    doubts += doubts_about(plate, measured, search, sphere, place)
    contradicts = contradiction(sphere, force)
    if contradicts:
        doubts.append(contradicts)
    force_told = None if contradicts else force
    estimates = _estimates(plate.case, measured, sphere, force_told)
    return Identification(plate, measured, search, sphere, force_told, estimates, tuple(doubts))


def identify_force(
    case: CaseTable, records: Sequence[Record], place: Place, *, window: float = WINDOW
) -> Force:
    """Reconstruct the force history of an impact at a known place from sensor records alone.

    No contact law is assumed.

    Parameters
    ----------
    case, records, place, window
        As those of `identify`.

    Raises
    ------
    InputError
        As `identify`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 30})
    >>> response = vi.simulate(case)
    >>> signal = response.signals()["a1"]
    >>> record = vi.signals.Record("a1", signal.value, signal.sensor.rate, "m/s2")
    >>> force = vi.identification.identify_force(case, [record], (0.0, 0.0))
    >>> speeds = response.impacts["approach_speed_m_s"] + response.impacts["separation_speed_m_s"]
    >>> round(float(force.impulse[0] / (response.problem.sphere.mass * speeds[0])), 1)
    1.0
    """
    plate = prepared_plate(case, window)
    measured, search = _started(plate, records, place)
    pulse = search.candidates[0]
    return force_behind(plate, measured, place, pulse.touch, pulse.duration)


def _started(
    plate: Plate, records: Sequence[Record], place: Place | None
) -> tuple[Measured, Search]:
    """Return records around first touch, and the pulse that explains them.

    Raises
    ------
    InputError
        If a place lies outside the plate, a record is not one of a sensor, or its sampling is too
        slow for the contact.
    """
    low, high = plate.bounds
    if place is not None and not ((low <= place) & (place <= high)).all():
        raise InputError(
            f"the position ({place[0]:.10g}, {place[1]:.10g}) m is off the plate, or too near its "
            f"edge; x must be from {low[0]:.10g} to {high[0]:.10g} m, and y from "
            f"{low[1]:.10g} to {high[1]:.10g} m"
        )
    measured, search = upright(
        plate, measured_of(plate.problem.sensors, records, plate.window), place
    )
    pulse = search.candidates[0]
    if pulse.duration * measured.band < _LEAST_CYCLES:
        shortest = digits(1e6 * _LEAST_CYCLES / measured.band, 3)
        raise InputError(
            "the records do not determine the duration of the contact: the sensors hear up to "
            f"{measured.band:,.0f} Hz, enough for contacts of {shortest} us or longer; sample "
            f"faster than at {measured.rate:.10g} Hz, with an anti-alias filter that passes more"
        )
    if pulse.spread > _VAGUE:
        raise InputError(
            "the records do not determine the duration of the contact: the standard deviation of "
            f"its logarithm is {digits(pulse.spread, 2)}, by the residual of the best pulse; "
            "measure with less noise, or check that they are of an impact on the plate of the case"
        )
    return measured, search


def _estimates(
    case: CaseTable, measured: Measured, sphere: SphereFit, force: Force | None
) -> dict[str, Estimate]:
    """Return what was found, by names that end in their units."""
    x, y, log_radius, log_speed, touch = sphere.parameters.tolist()
    of_x, of_y, of_log_radius, of_log_speed, of_touch = np.sqrt(np.diag(sphere.covariance)).tolist()
    peak, impulse, duration = sphere.force.facts.tolist()
    of_peak, of_impulse, of_duration = np.sqrt(np.diag(sphere.force_covariance)).tolist()
    radius = math.exp(log_radius)
    mass = float(ball_of(resized(case.sphere, radius)).mass)
    estimates = {
        "place_x_m": Estimate(x, of_x),
        "place_y_m": Estimate(y, of_y),
        "first_touch_s": Estimate(measured.start + touch, of_touch),
        "radius_m": Estimate(radius, of_log_radius, logarithmic=True),
        # the mass is proportional to the cube of the radius
        "mass_kg": Estimate(mass, 3.0 * of_log_radius, logarithmic=True),
        "speed_m_s": Estimate(math.exp(log_speed), of_log_speed, logarithmic=True),
        "duration_s": Estimate(duration, of_duration),
        "max_force_N": Estimate(peak, of_peak),
        "impulse_N_s": Estimate(impulse, of_impulse),
    }
    if force is not None:
        estimates["recovered_max_force_N"] = Estimate(*force.peak)
        estimates["recovered_impulse_N_s"] = Estimate(*force.impulse)
    return estimates
