"""Columns of the history of one drop whose bodies vibrate."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import MOTION_COLUMNS
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.statement.steady import steady_phasors
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate, centre_of, slices_of
from vibroimpact.dynamics.vibrating.fluid_motion import FluidMotion
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.segments import VibratingSegment
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_BLOCK = 128
"""Number of times evaluated together.

Their states lie in the processor's cache, which halves the time of a flight of many modes.
"""


def vibrating_history(
    problem: Problem, segment: VibratingSegment, time: Floats, columns: Collection[str]
) -> dict[str, Floats]:
    """Return columns, by their names, at times since the start of a segment [s] (T,)."""
    # it is known from the stretch, without the states of the modes
    if set(columns).issubset({"force_N"}):
        return {name: _force(segment, time) for name in columns}
    only_motion = set(columns).issubset(MOTION_COLUMNS)
    blocks = []
    for times in np.split(time, range(_BLOCK, len(time) - _BLOCK + 1, _BLOCK)):
        state = segment.state(times)
        block = _motion_columns(problem, segment, times, state)
        if not only_motion:
            block |= _further_columns(problem, segment, times, state, block["force_N"])
        blocks.append(block)
    return {name: np.concatenate([block[name] for block in blocks]) for name in columns}


def _motion_columns(
    problem: Problem, segment: VibratingSegment, time: Floats, state: State
) -> dict[str, Floats]:
    """Return the columns of motion and force at times since the start of a segment [s] (T,).

    `state`: the states at these times.
    """
    system = segment.system
    motion = segment.motion
    mass = float(problem.sphere.mass)
    gravity = float(problem.net_gravity)
    force = _force(segment, time)
    depth, fall_speed = centre_of(state, mass)
    if isinstance(motion, FluidMotion):
        acceleration = motion.flight.acceleration(segment.start + time[:, None])[:, 0]
    else:
        acceleration = force / mass - gravity
    if segment.in_contact:
        indentation = np.maximum(state.displacement @ system.indentation_shape[0], 0.0)
    else:
        indentation = np.zeros_like(time)
    ground = system.ground
    driven_deflection, _, _ = system.driven_motion(state)
    own_deflection = state.displacement[:, ground] @ system.shape[0, ground]
    return {
        "time_s": segment.start + time,
        "position_m": float(problem.sphere.contact_offset) - depth,
        "velocity_m_s": -fall_speed,
        "acceleration_m_s2": acceleration,
        "force_N": force,
        "indentation_m": indentation,
        "kinetic_J": 0.5 * mass * fall_speed**2,
        "potential_J": -mass * gravity * depth,
        "plate_deflection_m": own_deflection + driven_deflection,
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
    """Return the columns of energies, and of the motion of the bodies that vibrate."""
    system = segment.system
    stored, plastic, lost = _energies(segment, time, state)
    written_off = 0.0
    if isinstance(segment.motion, RestMotion):
        written_off = segment.motion.written_off
    columns = {
        "contact_elastic_J": stored,
        # a view would keep the losses of all modes in memory
        "contact_dissipated_J": lost[:, -1].copy(),
        "plastic_work_J": segment.lost_before[-1] + plastic,
        "written_off_at_rest_J": written_off * np.ones_like(time),
        **_body_columns(problem, system, state, lost, force),
    }
    if problem.motion is not None:
        lost_by_driven = lost[:, -1 - system.driven : -1]
        columns |= _shaken_columns(
            problem, problem.motion, segment.start + time, columns, lost_by_driven
        )
        if problem.at_place is not None:  # the contact is where the sphere falls
            displacement, velocity, _ = system.driven_motion(state)
            columns["surface_m"] = displacement
            columns["surface_velocity_m_s"] = velocity
    return columns


def _energies(
    segment: VibratingSegment, time: Floats, state: State
) -> tuple[Floats, Floats, Floats]:
    """Return the energy stored at the contact (T,), the plastic work (T,) and the losses [J].

    The plastic work is that since the start of the segment; the losses are those since the start of
    the run, (T, n + 1), in each coordinate and in the contact.
    """
    motion = segment.motion
    system = segment.system
    stored = system.local_energy(state)
    lost = segment.lost_before[:-1]
    local = None
    if isinstance(motion, VibratingStretch):
        lost = lost + motion.lost_by(time)
        local = motion.contacts[0].local
    elif isinstance(motion, RestMotion):
        lost = lost + motion.lost_by(time)
        stored = stored + motion.stored(time)
    else:
        lost = lost + motion.lost_at(state)
        if isinstance(motion, FreePhase):
            local = motion.local
    if local is None:
        return stored, np.zeros_like(time), lost
    contact_energy, plastic = _contact_energies(local, system, state)
    if isinstance(motion, VibratingStretch):
        initial_approach = max(float(motion.contacts[0].approach[0]), local.release_level)
        plastic = plastic - local.plastic_work(initial_approach)
    return stored + contact_energy, plastic, lost


def _shaken_columns(
    problem: Problem, motion: PlateMotion, time: Floats, columns: dict[str, Floats], lost: Floats
) -> dict[str, Floats]:
    """Return the columns of shaken plates, and those of the plate's centre with its own motion.

    `time`: since the start of the run [s] (T,). `columns`: with what impacts excite. `lost`: by the
    driven coordinates [J] (T, k).
    """
    surface, surface_velocity, _ = problem.surface(time)
    modes = problem.plate.modes
    mean_shape = None
    if modes is not None:
        mean_shape = modes.participation[:, 2] / modes.mass
    displacement, velocity, acceleration = motion.at(
        time, steady_phasors(motion, modes, mean_shape)
    )
    return {
        "plate_displacement_m": columns["plate_displacement_m"] + displacement,
        "plate_velocity_m_s": columns["plate_velocity_m_s"] + velocity,
        "plate_acceleration_m_s2": columns["plate_acceleration_m_s2"] + acceleration,
        "surface_m": surface,
        "surface_velocity_m_s": surface_velocity,
        "drive_J": lost.sum(axis=1),
    }


def _contact_energies(
    local: LocalContact, system: LinearSystem, state: State
) -> tuple[Floats, Floats]:
    """Return the energy stored by the contact, and its plastic work [J].

    The work is that since the last update of the law's memory.
    """
    delta = local.indentation_at(np.maximum(system.approach(state)[:, 0], local.release_level))
    plastic = np.zeros_like(delta)
    if local.law.yields:
        plastic = local.law.plastic_work(delta)
    return np.asarray(local.energy_at_indentation(delta)), np.asarray(plastic)


def _body_columns(
    problem: Problem, system: LinearSystem, state: State, lost: Floats, force: Floats
) -> dict[str, Floats]:
    """Return the columns that only vibrating bodies have."""
    _, sphere, _ = slices_of(problem)
    plate = system.ground
    bases = bases_of_plate(problem)
    gravity = float(problem.gravity)
    kinetic, strain = system.energies(state)
    displacement = state.displacement[:, plate]
    velocity = state.velocity[:, plate]
    acceleration = system.accelerations(state, force[:, None])[:, plate]
    # mass times the displacement of the plate's centre of mass along the normal, by each coordinate
    translation = np.concatenate([np.zeros(0), *(basis.participation[:, 2] for basis in bases)])
    mass = bases[0].mass if bases else np.inf
    return {
        "sphere_vibration_J": kinetic[:, sphere].sum(axis=1),
        "sphere_strain_J": strain[:, sphere].sum(axis=1),
        "sphere_damping_J": lost[:, sphere].sum(axis=1),
        "sphere_rotational_J": _rotational([problem.sphere.modes], state.velocity[:, sphere]),
        "plate_kinetic_J": kinetic[:, plate].sum(axis=1),
        "plate_strain_J": strain[:, plate].sum(axis=1),
        "plate_damping_J": lost[:, :-1][:, plate].sum(axis=1),
        "plate_rotational_J": _rotational(bases, velocity),
        "plate_potential_J": gravity * (displacement @ translation),
        "plate_displacement_m": displacement @ translation / mass,
        "plate_velocity_m_s": velocity @ translation / mass,
        "plate_acceleration_m_s2": acceleration @ translation / mass,
    }


def _rotational(bases: Sequence[ModalBasis | None], velocity: Floats) -> Floats:
    """Return the rotational energy of a body [J], from the velocities of its coordinates (T, n)."""
    rotations = [
        basis.rotation for basis in bases if basis is not None and basis.rotation is not None
    ]
    known = sum(len(rotation) for rotation in rotations) == velocity.shape[1]
    if not rotations or not known:
        return np.zeros(len(velocity))
    return np.asarray(0.5 * ((velocity @ np.concatenate(rotations)) ** 2).sum(axis=1))
