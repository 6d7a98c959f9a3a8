"""The relative change of each impact for a small change of the drop."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats

RELATIVE_CHANGE = 1e-9
"""A relative change of the drop that cannot be excluded in practice: 4 nm of 4 m."""


def change_by_impact(impacts: Mapping[str, Floats], tolerance: float) -> Floats:
    """Return the relative change of each impact for one of 1e-9 in the drop [-].

    It is 0 where nothing vibrates.

    The integration error, of the relative size of the tolerance, grows likewise: a tolerance above
    1e-9 takes the place of it.

    Examples
    --------
    >>> change_by_impact({"impact": np.ones(1), "sensitivity": np.array([1e6])}, 1e-9).round(
    ...     6
    ... ).tolist()
    [0.001]
    """
    return impacts.get("sensitivity", np.zeros(len(impacts["impact"]))) * max(
        RELATIVE_CHANGE, tolerance
    )
