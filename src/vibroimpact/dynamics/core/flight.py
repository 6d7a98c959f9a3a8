"""Free motion of a linear system in closed form, its approach at a contact, and its energies."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.records import Flight, State, System


@compiled
def flight_of(system: System, time: float) -> Flight:
    """Return what a free motion of some time [s] does to any state, for any damping ratio."""
    # q(t) = C q_0 + S v_0 with S = exp(-zeta w t) sin(w_d t)/w_d, C = exp(-zeta w t) cos(w_d t) +
    # zeta w S and w_d = w sqrt(1 - zeta^2)
    number = len(system.frequency)
    by_displacement = np.empty(number)
    by_velocity = np.empty(number)
    for coordinate in range(number):
        frequency = system.frequency[coordinate]
        ratio = system.ratio[coordinate]
        decay = ratio * frequency
        root = frequency * math.sqrt(abs(1.0 - ratio * ratio))
        if root == 0.0:  # a rigid motion, or critical damping
            fade = math.exp(-decay * time)
            sine = fade * time
            cosine = fade
        elif ratio < 1.0:
            fade = math.exp(-decay * time)
            sine = fade * math.sin(root * time) / root
            cosine = fade * math.cos(root * time)
        else:  # overdamped: the slower exponential is factored out, so that none overflows
            slow = math.exp((root - decay) * time)
            sine = slow * -math.expm1(-2.0 * root * time) / (2.0 * root)
            cosine = 0.5 * slow * (1.0 + math.exp(-2.0 * root * time))
        by_displacement[coordinate] = cosine + decay * sine
        by_velocity[coordinate] = sine
    fading = np.exp(-system.rate * time)
    return Flight(time, by_displacement, by_velocity, fading)


@compiled
def flown(system: System, state: State, flight: Flight) -> State:
    """Return the state after a flight from a state on."""
    number = len(state.displacement)
    time = flight.time
    displacement = np.empty(number)
    velocity = np.empty(number)
    for coordinate in range(number):
        cosine = flight.by_displacement[coordinate]
        sine = flight.by_velocity[coordinate]
        place = state.displacement[coordinate]
        speed = state.velocity[coordinate]
        load = system.load[coordinate]
        frequency = system.frequency[coordinate]
        # only rigid motions have a load; v(t) = (C - 2 zeta w S) v_0 - w^2 S q_0
        displacement[coordinate] = cosine * place + sine * speed + 0.5 * load * time * time
        slowed = (cosine - system.damping[coordinate] * sine) * speed
        velocity[coordinate] = slowed - frequency * frequency * sine * place + load * time
    return State(displacement, velocity, state.local * flight.fading)


@compiled
def state_after(system: System, state: State, time: float) -> State:
    """Return the state after free motion for a time [s]."""
    return flown(system, state, flight_of(system, time))


@compiled
def approach_of(system: System, state: State) -> tuple[float, float]:
    """Return the approach of the surfaces [m], negative where there is a gap, and its
    rate without contact force [m/s].
    """
    approach = system.offset
    rate = 0.0
    for coordinate in range(len(state.displacement)):
        approach += system.shape[coordinate] * state.displacement[coordinate]
        rate += system.shape[coordinate] * state.velocity[coordinate]
    for element in range(len(state.local)):
        approach += state.local[element]
        rate -= system.rate[element] * state.local[element]
    return approach, rate


@compiled
def dashpot_rate(system: System, state: State) -> float:
    """Return the rate at the dashpot of the contact law without contact force [m/s]."""
    rate = 0.0
    for coordinate in range(len(state.velocity)):
        rate += system.outer_shape[coordinate] * state.velocity[coordinate]
    for element in range(len(state.local)):
        rate -= system.rate[element] * state.local[element]
    return rate


@compiled
def local_energy(system: System, state: State) -> float:
    """Return the energy in the springs of the massless elements [J]."""
    # k e^2/2, with the stiffness k = rate/mobility
    energy = 0.0
    for element in range(len(state.local)):
        energy += 0.5 * state.local[element] ** 2 * system.rate[element] / system.mobility[element]
    return energy


@compiled
def rigid_rate(system: System, state: State) -> float:
    """Return the rate of the approach by the rigid motions [m/s]."""
    rate = 0.0
    for coordinate in range(system.rigid):
        rate += system.shape[coordinate] * state.velocity[coordinate]
    return rate


@compiled
def driven_rate(system: System, state: State) -> float:
    """Return the rate of the approach by the driven coordinates [m/s]."""
    rate = 0.0
    number = len(state.velocity)
    for coordinate in range(number - system.driven, number):
        rate += system.shape[coordinate] * state.velocity[coordinate]
    return rate


@compiled
def separation_speed(system: System, state: State) -> float:
    """Return the speed at which the centres move apart [m/s], or the sphere from what drives the
    plate.
    """
    return -(rigid_rate(system, state) + driven_rate(system, state))


@compiled
def vibration_energy(system: System, state: State) -> float:
    """Return the kinetic and strain energy of the modes [J], without driven coordinates."""
    energy = 0.0
    for coordinate in range(system.rigid, len(state.velocity) - system.driven):
        speed = state.velocity[coordinate]
        strain = system.frequency[coordinate] * state.displacement[coordinate]
        energy += 0.5 * (speed * speed + strain * strain)
    return energy


@compiled
def mechanical_energy(system: System, state: State) -> float:
    """Return the kinetic, potential and strain energy [J], without what the contact stores."""
    energy = local_energy(system, state) + vibration_energy(system, state)
    for coordinate in range(system.rigid):
        energy += 0.5 * state.velocity[coordinate] * state.velocity[coordinate]
    for coordinate in range(len(state.velocity)):
        energy -= system.load[coordinate] * state.displacement[coordinate]
    return energy


@compiled
def energy_of_approach(system: System, state: State) -> float:
    """Return the mechanical energy [J], without what the contact stores, and without that
    of free bodies moving together.
    """
    energy = mechanical_energy(system, state)
    if system.rigid == 1:
        return energy
    # of the energy of the rigid motions there remains that of the effective mass at their rate
    along = rigid_rate(system, state)
    of_rigid = 0.0
    for coordinate in range(system.rigid):
        of_rigid += state.velocity[coordinate] * state.velocity[coordinate]
    return energy - 0.5 * (of_rigid - system.mass * along * along)


@compiled
def lost_in_flight(system: System, before: State, after: State) -> Vector:
    """Return the energy lost between two states of a free motion [J] (n + 1,): in each
    coordinate, and last in the massless elements.
    """
    # (v^2 + w^2 q^2)/2 before, less that after
    number = len(before.displacement)
    lost = np.zeros(number + 1)
    for coordinate in range(system.rigid, number - system.driven):
        frequency = system.frequency[coordinate]
        held = before.velocity[coordinate] ** 2 + (frequency * before.displacement[coordinate]) ** 2
        left = after.velocity[coordinate] ** 2 + (frequency * after.displacement[coordinate]) ** 2
        lost[coordinate] = 0.5 * (held - left)
    lost[number] = local_energy(system, before) - local_energy(system, after)
    return lost


@compiled
def greatest_vibration(system: System, state: State) -> float:
    """Return a bound of the future contribution of modes and massless elements to the
    approach [m], from their energy.
    """
    # the amplitude of a mode is at most sqrt(v^2 + w^2 q^2)/w, as its energy does not grow
    reach = 0.0
    for coordinate in range(system.rigid, len(state.velocity)):
        frequency = system.frequency[coordinate]
        peak_speed = math.sqrt(
            state.velocity[coordinate] ** 2 + (frequency * state.displacement[coordinate]) ** 2
        )
        reach += abs(system.shape[coordinate]) * peak_speed / frequency
    for element in range(len(state.local)):
        reach += abs(state.local[element])
    return reach
