"""Sentences on the end of a run."""

from __future__ import annotations

from decimal import ROUND_FLOOR, Context, Decimal

import numpy as np

from vibroimpact.contact.law import InstantaneousLaw
from vibroimpact.dynamics.change_by_impact import change_by_impact
from vibroimpact.dynamics.motion.ended_run import EndedRun
from vibroimpact.dynamics.motion.energy import why_failed
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.units.display import certain, certain_figures

_DIGITS = Context(prec=6, rounding=ROUND_FLOOR)


def status_of(run: EndedRun) -> str:
    """Return the reason and time of the end of a run, in certain digits.

    For a batch it is the number of drops that each rule ended.
    """
    if len(run.outcomes) > 1 or run.problem.shape != ():
        return "; ".join(_ended_by(run, outcome) for outcome in Outcome if outcome in run.outcomes)
    number = len(run.impacts["impact"])
    end = float(run.end_time[0])
    outcome = run.outcomes[0]
    after = f"after {number} impact{'' if number == 1 else 's'}"
    if outcome is Outcome.IMPACTS:
        return f"Stopped {after}, {_top_or_touch(run)}, at {_time(run, end, 6)} s."
    if outcome is Outcome.RIDING and isinstance(run.problem.laws[0], InstantaneousLaw):
        words = "a law without a force does not determine its motion along the plate then"
        return f"Stopped {after}, at {_time(run, end, 6)} s: {_riding(run)}, and {words}."
    if outcome is Outcome.RIDING:
        # where bodies vibrate
        from vibroimpact.dynamics.vibrating.drop_at_start import MOST_STEPS, MOST_STEPS_TO_A_TIME

        steps = f"{MOST_STEPS} steps of the integration; give a duration to follow it for longer"
        if run.problem.duration is not None:
            steps = f"{MOST_STEPS_TO_A_TIME} steps of the integration"
        return (
            f"Stopped {after}, at {_time(run, end, 6)} s: {_riding(run)}. A ride is followed "
            f"for at most {steps}."
        )
    if outcome is Outcome.DURATION:
        asked = float(run.problem.duration or end)
        sentence = f"Stopped {after} at {asked:.6g} s, the end of the run"
        if end > asked:
            sentence += f", and the contact under way was finished, at {_time(run, end, 9)} s"
        rides = run.problem.shaken and number and np.isnan(run.impacts["separation_speed_m_s"][-1])
        if np.isfinite(run.rest.left[0]) or rides:
            sentence += f"; {_riding(run)}"
        return f"{sentence}."
    if outcome is Outcome.LIMIT:
        return (
            f"Stopped {after}, the most that are followed, at {_time(run, end, 6)} s; the "
            "sphere is not at rest."
        )
    if outcome is Outcome.LEFT:
        return f"The sphere leaves {after} and, without gravity, never comes back."
    if outcome is Outcome.FELL:
        return (
            f"The sphere falls off the edge of the plate {after}, and is level with its "
            f"surface at {_time(run, end, 6)} s."
        )
    if outcome is Outcome.FAILED:
        return f"Failed {after}: {why_failed(run.energy)}"
    assert outcome.at_rest, outcome
    if run.problem.shaken:
        when = _time(run, float(run.rest.time[0]), 7)
        until = "before the run ends" if run.problem.duration else "again"
        return (
            f"At rest {after}: from {when} s on the sphere moves with the plate, which does "
            f"not fall away from under it {until}."
        )
    return f"At rest {after}: {_at_rest(run)}{_moves_on(run)}"


def _ended_by(run: EndedRun, outcome: Outcome) -> str:
    """Return the number of drops of a batch that a rule ended, and the energy left in vibration."""
    ended = np.array([run_outcome is outcome for run_outcome in run.outcomes])
    energy = run.rest.left[ended & np.isfinite(run.rest.left)]
    counted = f"{np.count_nonzero(ended)} of {len(run.outcomes)} drops: {outcome.value}"
    if not energy.size:
        return counted
    riding = "" if outcome.at_rest else f"{energy.size} of them riding, "
    return f"{counted} ({riding}at most {energy.max():.3g} J left in vibration)"


def _top_or_touch(run: EndedRun) -> str:
    """Return where a run stops after its last impact.

    It is the top of the rebound, or where a plate that is shaken touches sooner.
    """
    top = "at the top of the last rebound"
    if not run.problem.shaken:
        return top
    if run.problem.oblique is not None:
        return f"{top}, or at the next touch if that is sooner"
    mass = float(run.problem.sphere.mass)
    first_speed = float(run.impacts["approach_speed_m_s"][0])
    # at the top the sphere stands still
    if float(run.energy["kinetic_J"]) <= _STANDING**2 * 0.5 * mass * first_speed**2:
        return top
    return "at the next touch, before the top of the last rebound"


def _riding(run: EndedRun) -> str:
    """Return the sentence on a sphere that is still in contact and not at rest."""
    if run.problem.shaken:
        return "the sphere rides on the plate, which is shaken"
    return (
        "the sphere rides on the plate and is not at rest, with "
        f"{_shown(run, float(run.rest.left[0]), 3)} J left in vibration"
    )


def _moves_on(run: EndedRun) -> str:
    """Return the sentence on a sphere that bounces no more and moves on along the plate.

    It is empty if the sphere does not.
    """
    if run.problem.oblique is None:
        return ""
    mass = float(run.problem.sphere.mass)
    if run.problem.fluid is not None:  # a liquid moves along
        mass *= float(run.problem.fluid.inertia(run.problem.sphere_density))
    speed = float(np.sqrt(2.0 * max(float(run.energy["kinetic_J"]), 0.0) / mass))
    if speed < _STANDING * float(run.impacts["approach_speed_m_s"][0]):
        return ""
    return f" It moves on along the plate, at {speed:.4g} m/s when the run ends."


_STANDING = 1e-9  # of the first approach speed


def _at_rest(run: EndedRun) -> str:
    """Return the rule by which the sphere is at rest, and the energy left in what carries it."""
    time = float(run.rest.time[0])
    energy = float(run.rest.left[0])
    vibration = ""
    if not np.isnan(energy):
        vibration = (
            f" {_shown(run, energy, 3)} J are left in vibration, too little at the contact to "
            "lift it."
        )
    when = _time(run, time, 7)
    if run.outcomes[0] is Outcome.CAPTURED:
        if vibration:
            return f"from {when} s on it stays in its indentation.{vibration}"
        return (
            f"from {when} s on it has too little energy left to get out of its indentation, "
            "and stays in it."
        )
    if run.outcomes[0] is Outcome.STUCK:
        return (
            f"from {when} s on it has too little energy left to break the adhesion, and "
            f"sticks.{vibration}"
        )
    rest_speed = float(run.rest.speed[0])
    last_speed = float(run.impacts["separation_speed_m_s"][-1])
    if not last_speed:
        return f"it did not leave again (rest-speed rule).{vibration}"
    limit = ""
    if np.isfinite(time):
        limit = f" Bounces with the last restitution would end at {when} s."
    return (
        f"it left at {_shown(run, last_speed, 3)} m/s, below the rest speed of "
        f"{rest_speed:.3g} m/s (rest-speed rule).{limit}{vibration}"
    )


def _time(run: EndedRun, time: float, significant: int) -> str:
    """Return an end time in the given number of digits, or in fewer that are certain.

    Each flight is as certain as the impact before it.
    """
    begin = run.impacts["time_s"]
    if not len(begin) or not np.isfinite(time) or time == 0.0:
        return f"{time:.{significant}g}"
    change = change_by_impact(run.impacts, run.problem.tolerance)
    flights = np.diff(begin, append=max(time, float(begin[-1])))
    change_of_time = float(np.minimum(np.nan_to_num(change, nan=1.0), 1.0) @ flights)
    return _digits(time, change_of_time / time, significant)


def _shown(run: EndedRun, value: float, significant: int) -> str:
    """Return a quantity of the last impact in some digits, or in fewer that are certain."""
    change = change_by_impact(run.impacts, run.problem.tolerance)
    last_change = 0.0
    if len(change):
        last_change = float(change[-1])
    return _digits(value, last_change, significant)


def _digits(value: float, change: float, significant: int) -> str:
    """Return a value in some digits, or in fewer that are certain under a relative change."""
    figures = int(certain_figures(change))
    if not figures:
        return f"about {value:.1g}"
    return certain(f"{value:.{significant}g}", value, figures)


def end_in_words(end: float) -> str:
    """Return the end of a run [s] in six digits.

    It is rounded down, so that the time that is named lies within the run.

    Examples
    --------
    >>> end_in_words(0.5), end_in_words(2.0 / 3.0)
    ('0.5', '0.666666')
    """
    return f"{float(_DIGITS.create_decimal(Decimal(float(end)))):.6g}"
