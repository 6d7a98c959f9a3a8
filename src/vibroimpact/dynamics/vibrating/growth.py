"""Growth of a small change of the drop from impact to impact, where bodies vibrate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.growth import Neighbour, Recorded, write_growth
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.drop_at_start import first_law_of
from vibroimpact.dynamics.vibrating.followed_drop import FollowedDrop
from vibroimpact.dynamics.vibrating.radau_eigenbasis import bases_of


def growth_of(drop: FollowedDrop) -> Floats:
    """Return the growth of a relative change of a drop by each of its impacts [-].

    The drop is changed in its height, or in its speed where that is given. The growth is the
    largest of the relative changes of the closing speed, of the largest force, and of the
    separation speed (relative to at least a tenth of the closing speed). For a rigid drop from a
    height it would be 0.6, as Hertz's force goes with the power 0.6 of the height.

    Parameters
    ----------
    drop : FollowedDrop
        A drop that has ended.
    """
    growth = np.empty(drop.impacts)
    view = contact_view(drop.recorded.system, (0,))
    still = view.bodies_without_load
    recorded = Recorded(
        system=view.bodies.system,
        still=still.system,
        addresses=drop.manner.addresses,
        series=drop.manner.series,
        parts=drop.recorded.parts,
        end=drop.recorded.end.record,
    )
    bases = bases_of(first_law_of(drop.problem).root)
    write_growth(bases, still, recorded, drop.manner.tension, _neighbour_of(drop), growth)
    return growth


def _neighbour_of(drop: FollowedDrop) -> Neighbour:
    """Return the neighbour of a drop at the start, per unit relative change."""
    problem = drop.problem
    system = drop.recorded.system
    displacement = np.zeros(system.number)
    velocity = np.zeros(system.number)
    root_mass = float(problem.sphere.mass) ** 0.5
    if problem.speed is None:
        assert problem.height is not None
        # height is measured upwards, the coordinate of the approach downwards
        displacement[0] = -root_mass * float(problem.height)
    else:
        velocity[0] = root_mass * float(problem.speed)
    parts = drop.recorded.parts
    return Neighbour(
        displacement=displacement,
        velocity=velocity,
        local=np.zeros(len(system.rate)),
        forces=np.zeros(parts.force.shape[1]),
        numbers=np.full(3, -1),
        values=np.zeros(7),
    )
