"""Where the scatter of Table 2 comes from: peaks that were read off samples."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.paper.printed import Printed, printed
from vibroimpact.paper.printed_and_computed import Account
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs
from vibroimpact.paper.section import Section, Table
from vibroimpact.units.display import MISSING, digits, fixed

QUANTITIES = {
    "compression": ("indentation_m", "max_indentation_m", "time_of_max_indentation_s"),
    "force": ("force_N", "max_force_N", "time_of_max_force_s"),
}
"""What Table 2 compares: its columns in a history and in the impact table."""

_ERRORS = tuple((quantity, damping, impact) for quantity in QUANTITIES for damping in DAMPINGS for impact in IMPACTS)

CONTACTS = tuple((damping, impact) for damping in DAMPINGS for impact in IMPACTS if (damping, impact) != ("variable", 1))
"""The contacts that Table 2 is about: the first is the same with either damping."""

_POINTS = 1001
_LEVELS = 1001
_TAIL = 0.05


@dataclass(frozen=True)
class Peak:
    """A quantity over one contact, which rises to a peak and falls again.

    Parameters
    ----------
    times : array
        Times since first touch [s].
    values : array
        The values.
    top : int
        Where the peak is among them.
    widths, levels : arrays
        How long the quantity is above each level [s], narrowest first, and the levels.
    """

    times: Floats
    values: Floats
    top: int
    widths: Floats
    levels: Floats

    @property
    def value(self) -> float:
        """The value at the peak."""
        return float(self.values[self.top])

    def instants(self, level: float) -> tuple[float, float]:
        """Return when the level is passed on the way up and down [s]; NaN of a level above the peak."""
        if level > self.value:
            return math.nan, math.nan
        before, after = _crossings(self.times, self.values, self.top, np.array([level]))
        return float(before[0]), float(after[0])

    def lowest(self, step: float) -> float:
        """Return the least that the largest of samples `step` [s] apart can be, whatever their phase."""
        return float(np.interp(step, self.widths, self.levels))


@lru_cache(maxsize=1)
def peaks(runs: Runs) -> Mapping[tuple[str, str, int], Peak]:
    """Return the peaks of the theory and of the simulations, by name of the run, quantity and impact, counted from 1."""
    found = {}
    for name in ("theory", *DAMPINGS):
        response = runs.response(f"type1-{name}")
        for impact in IMPACTS:
            touch, duration = (float(response.impacts[column][impact - 1]) for column in ("time_s", "duration_s"))
            times = np.linspace(0.0, duration, _POINTS)
            # a hair inside, so that both ends belong to the contact
            history = response.at(touch + np.clip(times, 1e-9 * duration, (1.0 - 1e-9) * duration))
            for quantity, (column, largest, when) in QUANTITIES.items():
                at = float(response.impacts[when][impact - 1]) - touch
                found[name, quantity, impact] = _peak(times, history[column], at, float(response.impacts[largest][impact - 1]))
    return found


def error_range(runs: Runs, step: float, quantity: str, damping: str, impact: int) -> tuple[float, float]:
    """Return the least and the largest error [%] that can be read off samples, at any phase of those of the theory and the simulation.

    Parameters
    ----------
    runs : Runs
        The cases.
    step : float
        Time between samples [s], >= 0.
    quantity : {"compression", "force"}
        What is compared.
    damping : {"constant", "variable"}
        Which simulation.
    impact : int
        Which impact, from 1.

    Examples
    --------
    >>> least, largest = error_range(Runs(), 0.0, "force", "constant", 1)
    >>> round(least, 3), round(largest, 3)
    (5.178, 5.178)
    """
    theory, simulation = peaks(runs)["theory", quantity, impact], peaks(runs)[damping, quantity, impact]
    lowest = theory.lowest(step)
    least = 100.0 * (1.0 - simulation.value / lowest) if lowest > 0.0 else -math.inf
    return least, 100.0 * (1.0 - simulation.lowest(step) / theory.value)


def grid_error(runs: Runs, step: float, quantity: str, damping: str, impact: int) -> float:
    """Return the error [%] of peaks read off samples at whole multiples of `step` [s] from the start of each run; NaN without any."""
    theory, simulation = (grid_samples(runs, name, step, quantity, impact)[1] for name in ("theory", damping))
    return 100.0 * (1.0 - float(simulation.max()) / float(theory.max())) if len(theory) and len(simulation) else math.nan


def grid_samples(runs: Runs, name: str, step: float, quantity: str, impact: int) -> tuple[Floats, Floats]:
    """Return the samples in a contact at whole multiples of `step` [s] from the start of a run: times since first touch, and values."""
    touch = float(runs.response(f"type1-{name}").impacts["time_s"][impact - 1])
    peak = peaks(runs)[name, quantity, impact]
    times = np.arange(math.ceil(touch / step), math.floor((touch + peak.times[-1]) / step) + 1) * step - touch
    return times, np.interp(times, peak.times, peak.values)


def gaps(runs: Runs, leaving: tuple[str, int] | None = None) -> Floats:
    """Return how long the contacts with a printed compression error were above it [s]: in none of these times was a sample.

    The peak of the theory is taken as exact. The first contact is the same with either damping, and counts once.

    Parameters
    ----------
    runs : Runs
        The cases.
    leaving : tuple of str and int, optional
        A contact that is left out: its damping and impact.
    """
    left_out = ("constant", 1) if leaving == ("variable", 1) else leaving
    contacts = [contact for contact in CONTACTS if contact != left_out]
    instants = np.array([implied_instants(runs, "compression", *contact) for contact in contacts])
    return np.asarray(np.nan_to_num(instants[:, 1] - instants[:, 0]))  # never above what is more than the peak


def found_spacing(runs: Runs, leaving: tuple[str, int] | None = None) -> float:
    """Return the upper bound, at 95 %, of the time between samples in contact [s], from the printed compressions.

    Of samples at a random phase, a gap round the peak is as likely to be of any length up to the time between them.

    Parameters
    ----------
    runs : Runs
        The cases.
    leaving : tuple of str and int, optional
        A contact that is left out, so that its error can be tested: its damping and impact.
    """
    free = gaps(runs, leaving)
    return float(free.max() * _TAIL ** (-1.0 / len(free)))


def output_step() -> float:
    """Return the output step that the paper prints [s]."""
    return printed("run.duration").value / printed("run.steps").value


def sampling(runs: Runs) -> Section:
    """Return the section on the scatter of Table 2.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    instants = _instants(runs)
    return Section(
        title="Where the scatter of Table 2 comes from",
        words=_words(runs),
        tables=(
            _errors_table(runs),
            Table(
                ("contact", "by the compression [µs]", "by the force [µs]", "apart at least [µs]"),
                tuple((f"{damping} damping, impact {impact}", *one.cells) for (damping, impact), one in instants.items()),
                "When after first touch the printed errors were read, with the exact peaks of the theory",
            ),
        ),
        conclusion=_conclusion(runs, tuple(instants.values())),
    )


class Instant(NamedTuple):
    """How far apart the instants lie that the two errors of a contact tell [s], NaN where one is of no instant; and its cells."""

    apart: float
    cells: tuple[str, ...]


def _instants(runs: Runs) -> dict[tuple[str, int], Instant]:
    """Return when each contact was read; of an error that implies more than the peak there is no instant."""
    found = {}
    for contact in CONTACTS:
        both = [implied_instants(runs, quantity, *contact) for quantity in QUANTITIES]
        apart = min(abs(one - other) for one in both[0] for other in both[1])
        told = [MISSING if math.isnan(early) else f"{1e6 * early:.1f} or {1e6 * late:.1f}" for early, late in both]
        found[contact] = Instant(apart, (*told, fixed(1e6 * apart, 1)))
    return found


def _words(runs: Runs) -> tuple[str, ...]:
    step, spacing, free = output_step(), found_spacing(runs), gaps(runs)
    durations = runs.response("type1-theory").impacts["duration_s"]
    chance = float(free.max() / step) ** len(free)
    return (
        f"The simulation had one output every {1e3 * step:.2f} ms, and a contact lasts {1e3 * durations.min():.2f} to "
        f"{1e3 * durations.max():.2f} ms. A peak read off samples is too low, by as much as the samples miss it. The first table sets "
        "the errors of exact peaks beside those that can be read off samples of the theory and of the simulation, and beside those "
        "printed [%].",
        f"Outputs every {1e3 * step:.2f} ms do not give the printed errors. If they were read off samples, these left no more "
        f"than {1e6 * free.max():.0f} µs free round the deepest point, in {len(free)} contacts; at a random phase the chance of "
        f"that is {digits(chance, 1)}. With equal steps at a random phase the likeliest step in contact is {1e6 * free.max():.0f} µs, and "
        f"at 95 % it is at most {1e6 * spacing:.0f} µs.",
    )


def _errors_table(runs: Runs) -> Table:
    step, spacing, cells = output_step(), found_spacing(runs), []
    for quantity, damping, impact in _ERRORS:
        which = (quantity, damping, impact)
        (least, most), (low, high) = (error_range(runs, size, *which) for size in (step, spacing))
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
    return Table(headers, tuple(cells), "The errors of Table 2")


def _conclusion(runs: Runs, instants: tuple[Instant, ...]) -> tuple[str, ...]:
    step, spacing, theory = output_step(), found_spacing(runs), peaks(runs)["theory", "force", 1]
    inside = sum(Account("", *error_range(runs, spacing, *which)).holds(table2_error(*which)) for which in _ERRORS)
    implied = printed("type1.max_force").value / (1.0 - 0.01 * printed("table2.force.constant.1").value)
    apart = [one.apart for one in instants if not math.isnan(one.apart)]
    return (
        f"{inside} of {len(_ERRORS)} printed errors lie within the range of samples {1e6 * spacing:.0f} µs apart, which was found from the "
        "compressions; in the verdicts of Table 2 each compression is held against the spacing that the other contacts tell. The ranges "
        "are wide: they tell that sampling can be the cause, not that nothing else is.",
        f"If so, the theory was sampled too, but more finely: the largest force printed, {printed('type1.max_force').text} N, and its "
        f"printed error imply a peak of {implied:.3f} N, {100.0 * (1.0 - implied / theory.value):.3f} % below the exact "
        f"{theory.value:.3f} N. Where a printed force error is less than the exact one, it is the peak of the theory that was missed.",
        f"Compression and force are largest at different times. In {len(apart)} of {len(instants)} contacts both printed errors are those "
        f"of an instant, and the two lie {1e6 * min(apart):.1f} to {1e6 * max(apart):.1f} µs apart; with so few contacts, and two "
        "instants to choose from for each error, that is no evidence that both were read at one time.",
        "Established: the printed errors of Table 2 are not those of exact peaks, as the errors in the text are; most are too large, "
        f"as missed peaks make them; and a plain output every {1e3 * step:.2f} ms would scatter them far more. A reading: that the "
        "solver's own steps, or further outputs at the contact, were drawn, so that there was a sample near each peak.",
    )


def implied_instants(runs: Runs, quantity: str, damping: str, impact: int) -> tuple[float, float]:
    """Return when after first touch the simulation passes the value that a printed error implies, on the way up and down [s].

    NaN if it implies more than the peak.
    """
    return peaks(runs)[damping, quantity, impact].instants(_level(runs, quantity, damping, impact))


def table2_error(quantity: str, damping: str, impact: int) -> Printed:
    """Return an error that Table 2 prints [%]."""
    return printed(f"table2.{quantity}.{damping}.{impact}")


def _level(runs: Runs, quantity: str, damping: str, impact: int) -> float:
    """Return what was read off the simulation if the peak of the theory is exact."""
    error = table2_error(quantity, damping, impact).value
    return peaks(runs)["theory", quantity, impact].value * (1.0 - 0.01 * error)


def _peak(times: Floats, values: Floats, at: float, largest: float) -> Peak:
    """Return a peak with its top put in where it was located."""
    top = int(np.searchsorted(times, at))
    times, values = np.insert(times, top, at), np.insert(values, top, largest)
    # closer together towards the top, where the width goes as the root of what is missing
    levels = largest * (1.0 - np.linspace(0.0, 1.0, _LEVELS) ** 2)
    before, after = _crossings(times, values, top, levels)
    return Peak(times, values, top, np.maximum.accumulate(after - before), levels)


def _crossings(times: Floats, values: Floats, top: int, levels: Floats) -> tuple[Floats, Floats]:
    """Return when levels are first reached and last left.

    The force of IMPACT may rise a little once more before release, when its damping fades out.
    """
    up, down = np.maximum.accumulate(values[: top + 1]), np.maximum.accumulate(values[top:][::-1])
    return np.interp(levels, up, times[: top + 1]), np.interp(levels, down, times[top:][::-1])
