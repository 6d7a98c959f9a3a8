"""The response of drops: impacts, motion, energy ledger, signals of sensors, and status."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.fluid_history import MOTION, fluid_history
from vibroimpact.dynamics.history_grid import points_kept, thinned
from vibroimpact.dynamics.motion.bounce import Bounce, BouncesOfDrops
from vibroimpact.dynamics.motion.columns import (
    FLUID_HISTORY_COLUMNS,
    HISTORY_COLUMNS,
    OBLIQUE_HISTORY_COLUMNS,
    SHAKEN_HISTORY_COLUMNS,
    VIBRATION_HISTORY_COLUMNS,
    meanings,
)
from vibroimpact.dynamics.motion.ended_run import EndedRun
from vibroimpact.dynamics.motion.energy import why_failed
from vibroimpact.dynamics.motion.ride import RideSegment
from vibroimpact.dynamics.oblique.history import oblique_history
from vibroimpact.dynamics.rigid.history import rigid_history
from vibroimpact.dynamics.rigid.segments import RestSegment
from vibroimpact.dynamics.rigid.timeline import Timeline, end_of, timeline_of
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor, sample_count
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.steady import steady_modes
from vibroimpact.dynamics.status import end_in_words, status_of
from vibroimpact.dynamics.truncation import truncation_estimates
from vibroimpact.errors import InputError, choices
from vibroimpact.report.html_report import html_summary
from vibroimpact.report.reported import Reported

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.recorded_drop import VibratingBounce
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

# what vibrates is imported in the methods: a drop of rigid bodies does not load it


@dataclass(frozen=True, eq=False)
class Response(Reported, EndedRun, reported_in="vibroimpact.runs.response_report"):
    """Response of one drop, or of a batch.

    Of one drop with histories it has the report of its `Result`, with charts by the same names.

    Attributes
    ----------
    problem : Problem
        What was simulated.
    impacts : dict of str to array
        One entry a column of `impacts.csv`. For one drop an array with one value an impact; for a
        batch (B, impacts), NaN where a drop had fewer.
    energy : dict of str to float or array
        The ledger at the end [J], what was put in, and the closure; `closure_relative` is without
        dimension.
    outcomes : tuple of Outcome
        Which rule ended each drop.
    end_time : array, shape (B,)
        When each run ended [s].
    rest : Rest
        State of the drops that have come to rest. `rest.left` is what they, and those that ride,
        have left in vibration [J], (B,).
    bounces : sequence of Bounce or BouncesOfDrops, optional
        Flights and contacts, from which histories are read; None where none are kept, as by
        `tabulate`.

    See Also
    --------
    simulate, tabulate : make one, the latter without histories.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> response.impacts["restitution_achieved"].round(4).tolist()
    [0.7748, 0.7748, 0.7747, 0.7747, 0.7746]
    >>> response.at([0.0])["position_m"].tolist()
    [4.0]
    """

    def __len__(self) -> int:
        """Return the number of drops."""
        return len(self.outcomes)

    def __repr__(self) -> str:
        if len(self) == 1:
            return f"<Response: {self.status}>"
        return f"<Response of {len(self)} drops>"

    def drop(self, index: int) -> Response:
        """Return the response of one drop of a batch, counted from 0.

        Raises
        ------
        InputError
            If there is no such drop.
        """
        if not isinstance(index, Integral) or not 0 <= index < len(self):
            raise InputError(f"there is no drop {index}; the batch has {len(self)}, counted from 0")
        if self.problem.shape == ():
            return self
        happened = np.isfinite(self.impacts["impact"][index])
        bounces = self.bounces
        if bounces is not None:
            bounces = _bounces_of(bounces, index)
        return Response(
            problem=self.problem.take(index),
            impacts={name: column[index, happened] for name, column in self.impacts.items()},
            energy={name: np.asarray(value)[index] for name, value in self.energy.items()},
            outcomes=self.outcomes[index : index + 1],
            end_time=self.end_time[index : index + 1],
            rest=self.rest.take(index),
            bounces=bounces,
        )

    def squeezed(self) -> Response:
        """Return the response of a batch of one as that of a single drop."""
        impacts = {name: column[0] for name, column in self.impacts.items()}
        energy = {name: value[0] for name, value in self.energy.items()}
        bounces = self.bounces
        if bounces is not None:
            bounces = _bounces_of(bounces, 0)
        return replace(self, impacts=impacts, energy=energy, bounces=bounces)

    @property
    def failures(self) -> dict[int, str]:
        """Reasons of failed drops, a sentence each, by the index of the drop."""
        energies = {name: np.atleast_1d(values) for name, values in self.energy.items()}
        reasons = {}
        for drop, outcome in enumerate(self.outcomes):
            if outcome is Outcome.FAILED:
                ledger = {name: values[drop] for name, values in energies.items()}
                reasons[drop] = why_failed(ledger)
        return reasons

    @property
    def history_columns(self) -> dict[str, tuple[str, str]]:
        """Unit and meaning of the columns of a history."""
        columns = dict(HISTORY_COLUMNS)
        if self.problem.vibrates:
            columns |= VIBRATION_HISTORY_COLUMNS
        if self.problem.motion is not None:
            columns |= SHAKEN_HISTORY_COLUMNS
        if self.problem.oblique is not None:
            columns |= OBLIQUE_HISTORY_COLUMNS
        if self.problem.fluid is not None:
            name = f"{self.problem.fluid.key}_J"
            if name in FLUID_HISTORY_COLUMNS:
                columns[name] = FLUID_HISTORY_COLUMNS[name]
        return meanings(columns)

    @property
    def status(self) -> str:
        """Reason and time of the end of the run, in a sentence.

        For a batch, how many drops ended by each rule, and the most that is left in vibration where
        they rest or ride.
        """
        return status_of(self)

    def at(self, times: Any, columns: Collection[str] | None = None) -> dict[str, Floats]:
        """Return the motion, force and energies of one drop at given times.

        Parameters
        ----------
        times : array_like
            Times since the start [s], within the run.
        columns : collection of str, optional
            Names of the columns to compute; by default all. Where bodies vibrate, those of motion
            and force alone take half the time.

        Returns
        -------
        dict of str to array
            One entry a column (`history_columns`), in the shape of `times`.

        Raises
        ------
        InputError
            If a time lies outside the run, there is no such column, or the response is of several
            drops or without histories.
        """
        times = np.asarray(times, dtype=float)
        flat = times.ravel()
        end = float(self.end_time[0])
        if not np.all((flat >= 0.0) & (flat <= end)):
            raise InputError(f"times must lie within the run, 0 to {end_in_words(end)} s")
        starts = self._starts
        segment_of_time = self._segment_of(flat)
        history = {name: np.empty(flat.shape) for name in self._names(columns)}
        for number in np.unique(segment_of_time).tolist():
            inside = segment_of_time == number
            segment_columns = self._history(number, flat[inside] - starts[number], history)
            for name, values in segment_columns.items():
                history[name][inside] = values
        return {name: values.reshape(times.shape) for name, values in history.items()}

    def sample(self, rate: float) -> dict[str, Floats]:
        """Return the motion, force and energies of one drop at a constant sampling rate.

        Sampling hides what happens between samples; for peaks use `impacts`, for figures `history`.

        Parameters
        ----------
        rate : float
            Samples per second [Hz], > 0.
        """
        if isinstance(rate, str) or not 0.0 < rate < np.inf:
            raise InputError(f"rate must be greater than 0 Hz and finite, not {rate}")
        count = float(self.end_time[0]) * rate
        if count > 1e8:
            raise InputError(
                f"{count:.3g} samples are more than 1e8; ask for a lower rate, or for parts by at()"
            )
        times = np.arange(sample_count(float(self.end_time[0]), rate)) / rate
        return self.at(np.minimum(times, self.end_time[0]))

    def history(
        self, most: int | None = None, columns: Collection[str] | None = None
    ) -> dict[str, Floats]:
        """Return the history of one drop on a grid that resolves every contact.

        It has both sides of each event.

        Parameters
        ----------
        most : int, optional
            How many points there may be, about. Of a longer history the first impacts keep all of
            theirs, as many as fill a quarter; each flight and each part of a contact after them
            keeps its ends and equally many points between. Each impact takes about 220 points, and
            each point 100 bytes, or twice as many where bodies vibrate.
        columns : collection of str, optional
            As in `at`.

        Raises
        ------
        InputError
            If there is no such column, or the response is of several drops or without histories.
        """
        segments = self._segments
        kept = np.array([len(segment.grid()) for segment in segments])
        if most is not None:
            kept = points_kept(kept, most)
        history = {name: np.empty(int(kept.sum())) for name in self._names(columns)}
        begin = 0
        for number, segment in enumerate(segments):
            count = int(kept[number])
            times = thinned(segment.grid(), count)
            of_segment = self._history(number, times, history)
            for name, values in of_segment.items():
                history[name][begin : begin + count] = values
            begin += count
        if "time_s" in history:  # the times of both sides of an event may differ by rounding
            np.maximum.accumulate(history["time_s"], out=history["time_s"])
        return history

    def modal(self, times: Any) -> dict[str, Floats]:
        """Return the modal coordinates of the bodies that vibrate at times within the run.

        Parameters
        ----------
        times : array_like
            Times since the start [s] (T,).

        Returns
        -------
        dict of str to array
            "sphere" and "plate", (T, modes) [kg^1/2 m]; times a mode's shape they are
            displacements, of a plate relative to its supports.
        """
        from vibroimpact.dynamics.vibrating.drop_system import slices_of

        flat = np.atleast_1d(np.asarray(times, dtype=float))
        _, sphere, plate = slices_of(self.problem)
        coordinates = np.zeros((len(flat), plate.stop))
        segments = self._segments
        if not isinstance(segments, Timeline):  # which has no modes
            segment_of_time = self._segment_of(flat)
            for number in np.unique(segment_of_time).tolist():
                segment = segments[number]
                inside = segment_of_time == number
                state = segment.state(np.minimum(flat[inside], segment.end) - segment.start)
                coordinates[inside] = state.displacement[:, : plate.stop]
        motion = self.problem.motion
        modes = self.problem.plate.modes
        if motion is not None and modes is not None:
            rotation = np.exp(1j * motion.angular_frequency * flat[:, None])
            coordinates[:, plate] += (rotation @ steady_modes(motion, modes).T).imag
        return {"sphere": coordinates[:, sphere], "plate": coordinates[:, plate]}

    def signals(self, *sensors: Sensor) -> dict[str, Signal]:
        """Return what sensors on the plate record over the whole run, by their names.

        Parameters
        ----------
        *sensors : Sensor
            What is watched; by default the sensors of the problem.

        Raises
        ------
        InputError
            If the plate is rigid and at rest or has no such point, there would be too many samples,
            or the response is of several drops or without histories.
        """
        from vibroimpact.dynamics.sensors.record import record

        segments = self._segments
        if isinstance(segments, Timeline):  # of rigid bodies
            segments = ()
        return record(
            self.problem, segments, sensors or self.problem.sensors, float(self.end_time[0])
        )

    @cached_property
    def truncation(self) -> dict[str, float]:
        """Estimated relative error of the largest force by modal truncation, by the body's name."""
        if not self.problem.vibrates:
            return {}
        return truncation_estimates(self.problem, self.impacts)

    def _repr_html_(self) -> str | None:
        has_report = self.problem.shape == () and self.bounces is not None
        if not has_report:
            return None
        return html_summary(self.report)

    # the history of one drop, segment by segment
    # ---------------------------------------------------

    def _names(self, columns: Collection[str] | None) -> Collection[str]:
        """Return the names of columns of a history that were asked for, checked; by default all."""
        known = self.history_columns
        for name in columns or ():
            if name not in known:
                raise InputError(f"a history has no column {name!r}; it has {choices(known, name)}")
        return known if columns is None else columns

    def _history(self, number: int, times: Floats, columns: Collection[str]) -> dict[str, Floats]:
        """Return columns at times since the start of one segment."""
        problem = self.problem
        segments = self._segments
        segment = segments[number]
        if isinstance(segments, Timeline):
            written_off = float(self.rest.written_off[0])
            history = rigid_history(problem, segments, number, times, written_off)
            resting = isinstance(segment, RestSegment)
        else:
            from vibroimpact.dynamics.vibrating.history import vibrating_history
            from vibroimpact.dynamics.vibrating.rest_motion import RestMotion

            others = {**OBLIQUE_HISTORY_COLUMNS, **FLUID_HISTORY_COLUMNS}
            of_bodies = [name for name in columns if name not in others]
            if problem.fluid is not None:
                of_bodies += MOTION
            history = vibrating_history(problem, segments[number], times, of_bodies)
            resting = isinstance(segments[number].motion, RestMotion)
        run_times = segment.start + times
        if problem.oblique is not None:
            bounce = self._bounce_of(number)
            lost = float(self.impacts["friction_lost_J"][:bounce].sum())
            rests_at = segment.start if resting else np.inf
            along = oblique_history(problem, self._bounces[bounce], lost, run_times, rests_at)
            for name, values in along.items():
                if name in history:
                    values = values + history[name]
                history[name] = values
        if problem.fluid is not None:
            history |= fluid_history(problem, self._bounces, run_times, history)
        return {name: history[name] for name in columns}

    def _bounce_of(self, number: int) -> int:
        """Return the number of the bounce to which a segment belongs."""
        segments = self._segments
        if isinstance(segments, Timeline):
            return segments.bounce_of(number)
        flight_starts = [float(bounce.flight.start[0]) for bounce in self._bounces]
        return int(np.searchsorted(flight_starts, segments[number].start, side="right")) - 1

    @property
    def _bounces(self) -> Sequence[Bounce]:
        """Flights and contacts of one drop."""
        assert isinstance(self.bounces, Sequence)
        return self.bounces

    def _segment_of(self, times: Floats) -> Indices:
        """Return the numbers of the segments in which times since the start lie [s]."""
        return np.maximum(np.searchsorted(self._starts, times, side="right") - 1, 0)

    @cached_property
    def _segments(self) -> Sequence[VibratingSegment] | Timeline:
        """Segments of the history of one drop, in order of time."""
        if self.problem.shape != ():
            raise InputError(
                "a history belongs to one drop: ask response.drop(0), response.drop(1), ..."
            )
        if self.bounces is None:
            raise InputError("tabulate keeps no histories; ask simulate")
        end = float(self.end_time[0])
        if self.problem.vibrates:
            from vibroimpact.dynamics.vibrating.segments import vibrating_timeline

            bounces = cast("Sequence[VibratingBounce]", self._bounces)
            return vibrating_timeline(bounces, self.rest.lying[0], end)
        rest: RestSegment | RideSegment | None = None
        if self.outcomes[0].at_rest:
            begin = end_of(self._bounces[-1])
            ride = self._bounces[-1].ride
            if ride is not None:
                rest = RideSegment(begin, end, ride, begin)
            else:
                # along the plate a sphere may move on after its bounces
                points = 2 if self.problem.oblique is None else 97
                rest = RestSegment(
                    start=begin,
                    end=end,
                    sag=float(self.rest.sag[0]),
                    weight=float(self.problem.sphere.mass) * float(self.problem.net_gravity),
                    stored=float(self.rest.stored[0]),
                    points=points,
                )
        plastic = self.impacts["plastic_work_J"]
        drive_work = self.impacts.get("plate_work_J", np.zeros(len(plastic)))
        dissipated = self.impacts["energy_lost_J"] - plastic
        return timeline_of(
            self._bounces, rest, np.stack([dissipated, plastic, -drive_work], axis=1)
        )

    @cached_property
    def _starts(self) -> Floats:
        """Start times of the segments [s]."""
        segments = self._segments
        if isinstance(segments, Timeline):
            return segments.starts
        return np.array([segment.start for segment in segments])


def _bounces_of(bounces: Sequence[Bounce] | BouncesOfDrops, drop: int) -> Sequence[Bounce]:
    """Return the flights and contacts of one drop of a batch."""
    if isinstance(bounces, Sequence):
        return bounces
    return bounces.of(drop)
