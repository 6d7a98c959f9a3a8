"""Columns of the history of one drop whose bodies vibrate."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.columns import MOTION_COLUMNS
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.shaken.statement import PlateMotion
from vibroimpact.dynamics.shaken.steady import steady_phasors
from vibroimpact.dynamics.vibrating.fluid_motion import FluidMotion
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.segments import VibratingSegment
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.vibrating_bodies import bases_of_plate, centre_of, slices_of

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_BLOCK = 128
"""Number of times evaluated together: their states lie in the processor's cache, which
halves the time of a flight of many modes.
"""


def vibrating_history(
    problem: Problem, segment: VibratingSegment, time: Floats, columns: Collection[str]
) -> dict[str, Floats]:
    """Return columns, by their names, at times since the start of a segment [s] (T,)."""
    # it is known from the stretch, without the states of the modes
    if set(columns).issubset({"force_N"}):
        return {name: _force(segment, time) for name in columns}
    further, blocks = not set(columns).issubset(MOTION_COLUMNS), []
    for part in np.split(time, range(_BLOCK, len(time) - _BLOCK + 1, _BLOCK)):
        state = segment.state(part)
        block = _motion_columns(problem, segment, part, state)
        blocks.append(
            {**block, **_further_columns(problem, segment, part, state, block["force_N"])}
            if further
            else block
        )
    return {name: np.concatenate([block[name] for block in blocks]) for name in columns}


def _motion_columns(
    problem: Problem, segment: VibratingSegment, time: Floats, state: State
) -> dict[str, Floats]:
    """Return the columns of motion and force at times since the start of a segment [s]
    (T,), from the states then.
    """
    system, motion = segment.system, segment.motion
    mass, gravity = float(problem.sphere.mass), float(problem.net_gravity)
    force = _force(segment, time)
    depth, fall_speed = centre_of(state, mass)
    indentation = (
        np.maximum(state.displacement @ system.indentation_shape[0], 0.0)
        if segment.in_contact
        else np.zeros_like(time)
    )
    return {
        "time_s": segment.start + time,
        "position_m": float(problem.sphere.contact_offset) - depth,
        "velocity_m_s": -fall_speed,
        "acceleration_m_s2": motion.flight.acceleration(segment.start + time[:, None])[:, 0]
        if isinstance(motion, FluidMotion)
        else force / mass - gravity,
        "force_N": force,
        "indentation_m": indentation,
        "kinetic_J": 0.5 * mass * fall_speed**2,
        "potential_J": -mass * gravity * depth,
        "plate_deflection_m": state.displacement[:, system.ground] @ system.shape[0, system.ground]
        + system.driven_motion(state)[0],
    }


def _force(segment: VibratingSegment, time: Floats) -> Floats:
    """Return the contact force at times since the start of a segment [N] (T,)."""
    motion = segment.motion
    if isinstance(motion, VibratingStretch):
        return motion.contacts[0].force_at(motion.rule.unmap_time(time / motion.length))
    if isinstance(motion, RestMotion):
        return motion.force(time)
    return np.zeros_like(time)


def _further_columns(
    problem: Problem, segment: VibratingSegment, time: Floats, state: State, force: Floats
) -> dict[str, Floats]:
    """Return the other columns: energies of the contact, and motion and energies of the
    bodies that vibrate.
    """
    system, motion, same = segment.system, segment.motion, np.ones_like(time)
    stored, plastic, lost = system.local_energy(state), 0.0 * same, segment.lost_before[:-1]
    if isinstance(motion, VibratingStretch):
        lost = lost + motion.lost_by(time)
    elif isinstance(motion, RestMotion):
        lost, stored = lost + motion.lost_by(time), stored + motion.stored(time)
    else:
        lost = lost + motion.lost_at(state)
    local = (
        motion.local
        if isinstance(motion, FreePhase)
        else motion.contacts[0].local
        if isinstance(motion, VibratingStretch)
        else None
    )
    if local is not None:
        contact_energy, plastic = _contact_energies(local, system, state)
        stored = stored + contact_energy
        if isinstance(motion, VibratingStretch):
            plastic = plastic - local.plastic_work(
                max(float(motion.contacts[0].approach[0]), local.release_level)
            )
    found = {
        "contact_elastic_J": stored,
        # a view would keep the losses of all modes in memory
        "contact_dissipated_J": lost[:, -1].copy(),
        "plastic_work_J": segment.lost_before[-1] + plastic,
        "written_off_at_rest_J": (motion.written_off if isinstance(motion, RestMotion) else 0.0)
        * same,
        **_body_columns(problem, system, state, lost, force),
    }
    if problem.motion is not None:
        found |= _shaken_columns(
            problem, problem.motion, segment.start + time, found, lost[:, -1 - system.driven : -1]
        )
        if problem.at_place is not None:  # the contact is where the sphere falls
            found["surface_m"], found["surface_velocity_m_s"], _ = system.driven_motion(state)
    return found


def _shaken_columns(
    problem: Problem, motion: PlateMotion, time: Floats, columns: dict[str, Floats], lost: Floats
) -> dict[str, Floats]:
    """Return the columns that only shaken plates have, and those of the plate's centre with its own
    motion.

    `time`: since the start of the run [s] (T,). `columns`: with what impacts excite. `lost`: by the
    driven coordinates [J] (T, k).
    """
    place, velocity, _ = problem.surface(time)
    modes = problem.plate.modes
    centre = motion.at(
        time,
        steady_phasors(
            motion, modes, None if modes is None else modes.participation[:, 2] / modes.mass
        ),
    )
    names = ("plate_displacement_m", "plate_velocity_m_s", "plate_acceleration_m_s2")
    moving = {name: columns[name] + part for name, part in zip(names, centre, strict=True)}
    return {
        **moving,
        "surface_m": place,
        "surface_velocity_m_s": velocity,
        "drive_J": lost.sum(axis=1),
    }


def _contact_energies(
    local: LocalContact, system: LinearSystem, state: State
) -> tuple[Floats, Floats]:
    """Return the energy stored by the contact, and its plastic work since the last update
    of the law's memory [J].
    """
    delta = local.indentation_at(np.maximum(system.approach(state)[:, 0], local.release_level))
    plastic = local.law.plastic_work(delta) if local.law.yields else np.zeros_like(delta)
    return np.asarray(local.energy_at_indentation(delta)), np.asarray(plastic)


def _body_columns(
    problem: Problem, system: LinearSystem, state: State, lost: Floats, force: Floats
) -> dict[str, Floats]:
    """Return the columns that only vibrating bodies have."""
    (_, sphere, _), bases, gravity = (
        slices_of(problem),
        bases_of_plate(problem),
        float(problem.gravity),
    )
    kinetic, strain = system.energies(state)
    displacement, velocity, acceleration = (
        part[:, system.ground]
        for part in (
            state.displacement,
            state.velocity,
            system.accelerations(state, force[:, None]),
        )
    )
    translation = np.concatenate([np.zeros(0), *(basis.participation[:, 2] for basis in bases)])
    mass = bases[0].mass if bases else np.inf
    return {
        "sphere_vibration_J": kinetic[:, sphere].sum(axis=1),
        "sphere_strain_J": strain[:, sphere].sum(axis=1),
        "sphere_damping_J": lost[:, sphere].sum(axis=1),
        "sphere_rotational_J": _rotational([problem.sphere.modes], state.velocity[:, sphere]),
        "plate_kinetic_J": kinetic[:, system.ground].sum(axis=1),
        "plate_strain_J": strain[:, system.ground].sum(axis=1),
        "plate_damping_J": lost[:, :-1][:, system.ground].sum(axis=1),
        "plate_rotational_J": _rotational(bases, velocity),
        "plate_potential_J": gravity * (displacement @ translation),
        "plate_displacement_m": displacement @ translation / mass,
        "plate_velocity_m_s": velocity @ translation / mass,
        "plate_acceleration_m_s2": acceleration @ translation / mass,
    }


def _rotational(bases: Sequence[ModalBasis | None], velocity: Floats) -> Floats:
    """Return the rotational energy of a body [J], from the velocities of its coordinates (T, n)."""
    turning = [
        basis.rotation for basis in bases if basis is not None and basis.rotation is not None
    ]
    if sum(map(len, turning)) != velocity.shape[1] or not turning:
        return np.zeros(len(velocity))
    return np.asarray(0.5 * ((velocity @ np.concatenate(turning)) ** 2).sum(axis=1))
