"""The end of a run: what comes of drops at rest until then, the energy ledger, and the response."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.energy import close_ledger, ledger_holds
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.state import friction_parts
from vibroimpact.dynamics.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.rest import Rest
from vibroimpact.dynamics.run_state import RunState

_RESTS = np.array([outcome.at_rest for outcome in OUTCOMES])
"""Which outcomes, by their codes, are rest."""


def response_of(run: RunState) -> Response:
    """Return the response of the batch of a run that has ended, without a history."""
    at_rest = _RESTS[run.outcomes]
    if run.problem.duration is not None:
        run.end_time[at_rest] = np.maximum(run.end_time, run.problem.duration)[at_rest]
    resting = np.flatnonzero(at_rest)
    along = {} if run.oblique is None else _lie_on_plate(run, run.oblique, resting)
    final_gap, final_velocity = _final_motion(run, resting)
    energy, added = _ledger(run, along, final_gap, final_velocity)
    run.outcomes[~ledger_holds(energy, added)] = Outcome.FAILED.code
    rest = Rest(
        run.rest_speed,
        run.rest_time,
        run.sag,
        run.stored,
        run.written_off,
        run.bodies.remaining_energy,
        tuple(run.bodies.lying),
    )
    outcomes = tuple(OUTCOMES[code] for code in run.outcomes.tolist())
    return Response(run.problem, run.rows.table(), energy, outcomes, run.end_time, rest, None)


def _lie_on_plate(run: RunState, oblique: ObliqueMotion, resting: Drops) -> dict[str, Floats]:
    """Follow drops at rest along the plate, over whose edge they may leave it.

    Return the entries of the ledger for that motion.
    """
    if resting.size:
        lain = oblique.lie(
            resting, run.gravity[resting], np.maximum(run.end_time - run.time, 0.0)[resting]
        )
        run.end_time[resting] = np.minimum(run.end_time[resting], run.time[resting] + lain)
    kinetic, rotation, potential = oblique.energies()
    return {
        "kinetic_J": kinetic,
        "potential_J": potential,
        "rotation_J": rotation,
        "friction_J": oblique.lost,
    }


def _final_motion(run: RunState, resting: Drops) -> tuple[Floats, Floats]:
    """Return gap [m] and upward velocity [m/s] at the end of the run."""
    gap = run.gap.copy()
    velocity = run.velocity.copy()
    lain = np.maximum(run.end_time - run.time, 0.0)[resting]
    followed = run.bodies.follow(resting, lain, run.sag[resting], run.stored[resting])
    gap[resting], velocity[resting], run.stored[resting] = followed
    return gap, velocity


def _ledger(
    run: RunState, along: dict[str, Floats], gap: Floats, velocity: Floats
) -> tuple[dict[str, Floats], Floats]:
    """Return the energy ledger [J], and the energy that gravity and adhesion added [J].

    It was added to that of the start.

    `along`: the entries for the motion along the plate. `gap` [m], `velocity` upwards [m/s]: at the
    end.
    """
    fluid = run.problem.fluid
    vibration = run.bodies.energies()
    liquid = run.energy_of_liquid(velocity)
    # the stored energy is negative where it sticks
    added = run.mass * run.gravity * run.deepest + np.maximum(-run.stored, 0.0)
    if run.oblique is not None:
        added += np.maximum(-along["potential_J"], 0.0)  # what gravity did down the plate
    if run.problem.motion is not None:
        vibration = {"drive_J": np.zeros(run.size), **vibration}
        added += np.maximum(-vibration["drive_J"], 0.0)
    entries = {
        "kinetic_J": 0.5 * run.mass * velocity**2 + liquid + along.pop("kinetic_J", 0.0),
        "potential_J": run.mass * run.gravity * gap + along.pop("potential_J", 0.0),
        "contact_elastic_J": run.stored + vibration.pop("local_J", 0.0),
        "contact_dissipated_J": run.dissipated + vibration.pop("local_damping_J", 0.0),
        "plastic_work_J": run.plastic,
        "written_off_at_rest_J": run.written_off,
        **vibration,
        **along,
    }
    if fluid is not None:
        entries[f"{fluid.key}_J"] = run.to_fluid + run.liquid_at_start - liquid
    energy = close_ledger(run.energy_in, added, entries)
    if run.oblique is not None:
        energy |= friction_parts(run.oblique.lost, run.oblique.microslip)
    return energy, added
