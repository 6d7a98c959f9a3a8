"""What the printed numbers tell of the paper's mesh of the sphere: its mass, and how deep it fell."""

from __future__ import annotations

from vibroimpact.paper.printed import printed


def mesh_mass(kind: int, gravity: float) -> tuple[float, float]:
    """Return between which values the mass of the sphere lies [kg], from the force and the acceleration printed of one instant.

    Parameters
    ----------
    kind : int
        2 or 3.
    gravity : float
        Acceleration of gravity [m/s^2].

    Examples
    --------
    >>> [round(mass, 6) for mass in mesh_mass(3, 9.8)]
    [0.090305, 0.090305]
    """
    force, acceleration = printed(f"type{kind}.max_force"), printed(f"type{kind}.max_acceleration")
    return (
        (force.value - force.half) / (acceleration.value + acceleration.half + gravity),
        (force.value + force.half) / (acceleration.value - acceleration.half + gravity),
    )


def fall_beyond_touch(kind: int, gravity: float) -> float:
    """Return how far the sphere falls after first touch [m], by the energies printed of Type 2 or 3."""
    released, touch = printed(f"type{kind}.potential_energy"), printed(f"type{kind}.energy_at_touch")
    return (released.value - touch.value) / (mesh_mass(kind, gravity)[0] * gravity)
