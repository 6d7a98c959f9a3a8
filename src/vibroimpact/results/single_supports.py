"""The supports of a case one by one."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any

from vibroimpact.resolved_case import ResolvedCase

EDGES = ("x-min", "x-max", "y-min", "y-max")


def single_supports(case: ResolvedCase) -> list[Mapping[str, Any]]:
    """Return the supports of a case one by one: of types patch, bar, edge, point, spring and set.

    Examples
    --------
    >>> [one["edge"] for one in single_supports({"plate": {"supports": "clamped"}})]
    ['x-min', 'x-max', 'y-min', 'y-max']
    >>> four = {"type": "patches", "spacing": [0.4, 0.2], "radius": 0.01}
    >>> single_supports({"plate": {"supports": [four]}})[0]
    {'type': 'patch', 'spacing': [0.4, 0.2], 'radius': 0.01, 'position': (-0.2, -0.1)}
    """
    given = case.get("plate", {}).get("supports", ())
    if isinstance(given, str):
        if given == "free":
            return []
        return [{"type": "edge", "edge": edge, "condition": given} for edge in EDGES]
    supports: list[Mapping[str, Any]] = []
    for support in given:
        if "spacing" in support:  # four of them, at the corners of a rectangle
            across, up = (0.5 * float(side) for side in support["spacing"])
            kind = {"patches": "patch", "bars": "bar"}[support["type"]]
            supports += [
                {**support, "type": kind, "position": (x * across, y * up)}
                for x, y in product((-1.0, 1.0), repeat=2)
            ]
        else:
            supports.append(support)
    return supports
