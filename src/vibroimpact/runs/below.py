"""What the sphere falls on, in words: a plate, one that is shaken or free, or a sphere in
its place.
"""

from __future__ import annotations

from vibroimpact.results.result import Result


def body_below(result: Result) -> str:
    """Return what the sphere falls on: "plate" or "lower sphere"."""
    if result.case.get("plate", {}).get("radius") is None:
        return "plate"
    return "lower sphere"


def level_below(result: Result) -> str:
    """Return from where the height of the sphere's centre is measured, which is fixed in space.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> level_below(vi.result_of(vi.simulate(vi.load_case("paper:type1-theory"))))
    'the plate'
    """
    if "surface_m" in result.history:
        return "the mean position of the plate"
    if is_free_below(result):
        return f"the initial position of the {body_below(result)}"
    return f"the {body_below(result)}"


def is_free_below(result: Result) -> bool:
    """Return whether what the sphere falls on is free to fly off."""
    return bool(result.case.get("plate", {}).get("supports") == "free")
