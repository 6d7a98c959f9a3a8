"""The scatter of Table 2 as a sampling error: ranges of peaks read off samples, the
spacing they imply, and the section on it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.paper.printed import PrintedValue, printed
from vibroimpact.paper.report_section import Explanation, ReportSection, TextTable
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs
from vibroimpact.units.display import MISSING, digits, fixed

QUANTITIES = {
    "compression": ("indentation_m", "max_indentation_m", "time_of_max_indentation_s"),
    "force": ("force_N", "max_force_N", "time_of_max_force_s"),
}
"""Quantities of Table 2: columns of the history, of the largest value and of its time in
the impact table.
"""

_ERRORS = tuple(
    (quantity, damping, impact)
    for quantity in QUANTITIES
    for damping in DAMPINGS
    for impact in IMPACTS
)

CONTACTS = tuple(
    (damping, impact)
    for damping in DAMPINGS
    for impact in IMPACTS
    if (damping, impact) != ("variable", 1)
)
"""Contacts of Table 2 by damping and impact; the first contact is the same with either
damping, and listed once.
"""

_POINTS = 1001
_LEVELS = 1001
_TAIL = 0.05


@dataclass(frozen=True)
class ContactPulse:
    """The pulse of a quantity over one contact, with a single peak.

    Parameters
    ----------
    times : array
        Times since first touch [s].
    values : array
        Values at these times.
    top : int
        Index of the peak.
    widths, levels : arrays
        Duration above each level [s], ascending, and the levels.
    """

    times: Floats
    values: Floats
    top: int
    widths: Floats
    levels: Floats

    @property
    def value(self) -> float:
        """Peak value."""
        return float(self.values[self.top])

    def instants(self, level: float) -> tuple[float, float]:
        """Return the times at which the pulse passes a level, rising and falling [s]; NaN
        for a level above the peak.
        """
        if level > self.value:
            return math.nan, math.nan
        before, after = _crossings(self.times, self.values, self.top, np.array([level]))
        return float(before[0]), float(after[0])

    def lowest(self, step: float) -> float:
        """Return the smallest possible maximum of samples spaced by `step` [s], over all
        phases of the samples.
        """
        return float(np.interp(step, self.widths, self.levels))


@lru_cache(maxsize=1)
def contact_pulses(runs: Runs) -> Mapping[tuple[str, str, int], ContactPulse]:
    """Return the pulses of the theory and the simulations, by run, quantity and impact
    number, counted from 1.
    """
    pulses = {}
    for name in ("theory", *DAMPINGS):
        response = runs.response(f"type1-{name}")
        for impact in IMPACTS:
            touch = float(response.impacts["time_s"][impact - 1])
            duration = float(response.impacts["duration_s"][impact - 1])
            times = np.linspace(0.0, duration, _POINTS)
            # slightly inside, so that both end points belong to the contact
            inside = np.clip(times, 1e-9 * duration, (1.0 - 1e-9) * duration)
            history = response.at(touch + inside)
            for quantity, (column, largest, when) in QUANTITIES.items():
                peak_time = float(response.impacts[when][impact - 1]) - touch
                peak = float(response.impacts[largest][impact - 1])
                pulse = _contact_pulse(times, history[column], peak_time, peak)
                pulses[name, quantity, impact] = pulse
    return pulses


def error_range(
    runs: Runs, step: float, quantity: str, damping: str, impact: int
) -> tuple[float, float]:
    """Return the range of the error of sampled peaks [%], over all phases of the samples of theory
    and simulation.

    Parameters
    ----------
    runs : Runs
        The simulations.
    step : float
        Time between samples [s], >= 0.
    quantity : {"compression", "force"}
        Quantity compared.
    damping : {"constant", "variable"}
        Simulation.
    impact : int
        Impact number, from 1.

    Examples
    --------
    >>> least, largest = error_range(Runs(), 0.0, "force", "constant", 1)
    >>> round(least, 3), round(largest, 3)
    (5.178, 5.178)
    """
    theory = contact_pulses(runs)["theory", quantity, impact]
    simulation = contact_pulses(runs)[damping, quantity, impact]
    # the samples of one run may meet its peak, while those of the other miss theirs by most
    lowest = theory.lowest(step)
    least = -math.inf
    if lowest > 0.0:
        least = 100.0 * (1.0 - simulation.value / lowest)
    largest = 100.0 * (1.0 - simulation.lowest(step) / theory.value)
    return least, largest


def grid_error(runs: Runs, step: float, quantity: str, damping: str, impact: int) -> float:
    """Return the error of peaks sampled at multiples of `step` [s] from the start of each
    run [%]; NaN without samples in a contact.
    """
    _, theory = grid_samples(runs, "theory", step, quantity, impact)
    _, simulation = grid_samples(runs, damping, step, quantity, impact)
    if len(theory) and len(simulation):
        return 100.0 * (1.0 - float(simulation.max()) / float(theory.max()))
    return math.nan


def grid_samples(
    runs: Runs, name: str, step: float, quantity: str, impact: int
) -> tuple[Floats, Floats]:
    """Return the samples of a contact at multiples of `step` [s] from the start of a run:
    times since first touch [s], and values.
    """
    touch = float(runs.response(f"type1-{name}").impacts["time_s"][impact - 1])
    peak = contact_pulses(runs)[name, quantity, impact]
    first = math.ceil(touch / step)
    last = math.floor((touch + peak.times[-1]) / step)
    times = np.arange(first, last + 1) * step - touch
    return times, np.interp(times, peak.times, peak.values)


def unsampled_gaps(runs: Runs, without: tuple[str, int] | None = None) -> Floats:
    """Return the time that each contact spends above the compression implied by its printed error
    [s]: no sample lies in it.

    The peak of the theory is taken as exact. The first contact is the same with either damping, and
    counts once.

    Parameters
    ----------
    runs : Runs
        The simulations.
    without : tuple of str and int, optional
        Contact to leave out, by damping and impact.
    """
    left_out = without
    if without == ("variable", 1):
        left_out = ("constant", 1)
    contacts = [contact for contact in CONTACTS if contact != left_out]
    instants = np.array([implied_instants(runs, "compression", *contact) for contact in contacts])
    # NaN, a level above the peak: no time above it
    return np.asarray(np.nan_to_num(instants[:, 1] - instants[:, 0]))


def spacing_bound(runs: Runs, without: tuple[str, int] | None = None) -> float:
    """Return the upper 95 % confidence bound of the sample spacing in contact [s], from the printed
    compressions.

    At a random phase the gap around the peak is uniformly distributed between zero and the spacing.

    Parameters
    ----------
    runs : Runs
        The simulations.
    without : tuple of str and int, optional
        Contact to leave out, by damping and impact, so that its error can be tested against the
        bound.
    """
    gaps = unsampled_gaps(runs, without)
    return float(gaps.max() * _TAIL ** (-1.0 / len(gaps)))


def output_step() -> float:
    """Return the printed output step [s]: duration over number of steps."""
    return printed("run.duration").value / printed("run.steps").value


def sampling_section(runs: Runs) -> ReportSection:
    """Return the section on the scatter of Table 2.

    Parameters
    ----------
    runs : Runs
        The simulations.
    """
    instants = _instants(runs)
    return ReportSection(
        title="Where the scatter of Table 2 comes from",
        paragraphs=_introduction(runs),
        tables=(
            _errors_table(runs),
            TextTable(
                ("contact", "by the compression [µs]", "by the force [µs]", "apart at least [µs]"),
                tuple(
                    (f"{damping} damping, impact {impact}", *instant.cells)
                    for (damping, impact), instant in instants.items()
                ),
                "When after first touch the printed errors were read, with "
                "the exact peaks of the theory",
            ),
        ),
        conclusion=_conclusion(runs, tuple(instants.values())),
    )


class ImpliedInstants(NamedTuple):
    """Least distance of the instants implied by both errors of a contact [s], NaN if one
    implies none; and the cells of its row.
    """

    distance: float
    cells: tuple[str, ...]


def _instants(runs: Runs) -> dict[tuple[str, int], ImpliedInstants]:
    """Return the instants at which each contact was sampled; an error that implies more
    than the peak has none.
    """
    instants = {}
    for contact in CONTACTS:
        both = [implied_instants(runs, quantity, *contact) for quantity in QUANTITIES]
        distance = min(abs(instant - other) for instant in both[0] for other in both[1])
        cells = []
        for early, late in both:
            cell = MISSING
            if not math.isnan(early):
                cell = f"{1e6 * early:.1f} or {1e6 * late:.1f}"
            cells.append(cell)
        instants[contact] = ImpliedInstants(distance, (*cells, fixed(1e6 * distance, 1)))
    return instants


def _introduction(runs: Runs) -> tuple[str, ...]:
    step = output_step()
    spacing = spacing_bound(runs)
    gaps = unsampled_gaps(runs)
    durations = runs.response("type1-theory").impacts["duration_s"]
    chance = float(gaps.max() / step) ** len(gaps)
    return (
        f"By the printed numbers the simulation had one output every {1e3 * step:.2f} ms, "
        "and a contact lasts "
        f"{1e3 * durations.min():.2f} to {1e3 * durations.max():.2f} ms. A peak read from "
        "samples is too low, as the samples miss the "
        "exact one. The first table compares the errors of exact peaks with those that can "
        "be read from samples of the theory and of the "
        "simulation, and with those printed [%].",
        f"Outputs every {1e3 * step:.2f} ms do not give the printed errors. If they were "
        "read off samples, these left no more "
        f"than {1e6 * gaps.max():.0f} µs free round the deepest point, in {len(gaps)} "
        "contacts; at a random phase the chance of "
        f"that is {digits(chance, 1)}. With equal steps at a random phase the likeliest "
        f"step in contact is {1e6 * gaps.max():.0f} µs, and "
        f"at 95 % it is at most {1e6 * spacing:.0f} µs.",
    )


def _errors_table(runs: Runs) -> TextTable:
    step = output_step()
    spacing = spacing_bound(runs)
    cells = []
    for quantity, damping, impact in _ERRORS:
        which = (quantity, damping, impact)
        least, most = error_range(runs, step, *which)
        low, high = error_range(runs, spacing, *which)
        cells.append(
            (
                f"{quantity}, {damping} damping, impact {impact}",
                fixed(error_range(runs, 0.0, *which)[0], 3),
                fixed(grid_error(runs, step, *which), 1),
                f"{fixed(least, 0)} to {fixed(most, 0)}",
                f"{fixed(low, 2)} to {fixed(high, 2)}",
                fixed(table2_error(*which).value, 3),
            )
        )
    headers = (
        "error [%]",
        "exact",
        f"on the grid of {1e3 * step:.2f} ms",
        f"any phase, {1e3 * step:.2f} ms",
        f"any phase, {1e6 * spacing:.0f} µs",
        "printed",
    )
    return TextTable(headers, tuple(cells), "The errors of Table 2")


def _conclusion(runs: Runs, instants: tuple[ImpliedInstants, ...]) -> tuple[str, ...]:
    step = output_step()
    spacing = spacing_bound(runs)
    theory = contact_pulses(runs)["theory", "force", 1]
    inside = sum(
        Explanation("", *error_range(runs, spacing, *which)).holds(table2_error(*which))
        for which in _ERRORS
    )
    implied = printed("type1.max_force").value / (
        1.0 - 0.01 * printed("table2.force.constant.1").value
    )
    distances = [instant.distance for instant in instants if not math.isnan(instant.distance)]
    return (
        f"{inside} of {len(_ERRORS)} printed errors lie within the range of samples "
        f"{1e6 * spacing:.0f} µs apart, which was found from the "
        "compressions; in the verdicts of Table 2 each compression is compared with the "
        "spacing implied by the other contacts. The "
        "ranges are wide: they show that sampling can be the cause, not that it is the only one.",
        "If so, the theory would have been sampled too, but more finely: the largest "
        f"force printed, {printed('type1.max_force').text} N, "
        f"and its printed error imply a peak of {implied:.3f} N, "
        f"{100.0 * (1.0 - implied / theory.value):.3f} % below the exact "
        f"{theory.value:.3f} N. Where a printed force error is less than the exact one, "
        "the peak of the theory would have been missed.",
        f"Compression and force are largest at different times. In {len(distances)} of "
        f"{len(instants)} contacts both printed errors are "
        f"those of an instant, and the nearest two lie {1e6 * min(distances):.1f} to "
        f"{1e6 * max(distances):.1f} µs apart; with so few "
        "contacts, and two instants to choose from for each error, that is no evidence that "
        "both were read at one time.",
        "Established: the printed errors of Table 2 are not those of exact peaks, as the "
        "errors in the text are; most are too large, "
        f"as missed peaks make them; and an output every {1e3 * step:.2f} ms alone would "
        "scatter them far more. A hypothesis: that the "
        "solver's own steps, or further outputs at the contact, were plotted, so that there "
        "was a sample near each peak.",
    )


def implied_instants(runs: Runs, quantity: str, damping: str, impact: int) -> tuple[float, float]:
    """Return the times after first touch at which the simulation passes the value of a printed
    error, rising and falling [s].

    NaN if the error implies more than the peak.
    """
    return contact_pulses(runs)[damping, quantity, impact].instants(
        _implied_peak(runs, quantity, damping, impact)
    )


def table2_error(quantity: str, damping: str, impact: int) -> PrintedValue:
    """Return a printed error of Table 2 [%]."""
    return printed(f"table2.{quantity}.{damping}.{impact}")


def _implied_peak(runs: Runs, quantity: str, damping: str, impact: int) -> float:
    """Return the sampled peak of the simulation that a printed error implies, for an
    exact peak of the theory.
    """
    error = table2_error(quantity, damping, impact).value
    return contact_pulses(runs)["theory", quantity, impact].value * (1.0 - 0.01 * error)


def _contact_pulse(times: Floats, values: Floats, at: float, largest: float) -> ContactPulse:
    """Return a pulse with its located peak inserted among the samples."""
    top = int(np.searchsorted(times, at))
    times = np.insert(times, top, at)
    values = np.insert(values, top, largest)
    # levels are quadratically denser towards the peak, where the width grows as the root of the
    # distance from it
    levels = largest * (1.0 - np.linspace(0.0, 1.0, _LEVELS) ** 2)
    before, after = _crossings(times, values, top, levels)
    return ContactPulse(times, values, top, np.maximum.accumulate(after - before), levels)


def _crossings(times: Floats, values: Floats, top: int, levels: Floats) -> tuple[Floats, Floats]:
    """Return the times at which levels are first reached and last left.

    Running maxima make both flanks monotonic: the force of IMPACT may rise again slightly before
    separation, as its damping fades out.
    """
    rising = np.maximum.accumulate(values[: top + 1])
    # from the end on, as np.interp needs ascending values
    falling = np.maximum.accumulate(values[top:][::-1])
    reached = np.interp(levels, rising, times[: top + 1])
    left = np.interp(levels, falling, times[top:][::-1])
    return reached, left
