"""The plate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.body import Body


def rigid_plate(thickness: Array = 0.0) -> Body:
    """Make a plate that is held fixed and does not bend.

    Parameters
    ----------
    thickness : float or array, default 0
        Thickness [m]; the contact lies half of it above the centre.

    Examples
    --------
    >>> rigid_plate(0.008).mass
    inf
    """
    return Body(mass=np.inf, contact_offset=0.5 * thickness)
