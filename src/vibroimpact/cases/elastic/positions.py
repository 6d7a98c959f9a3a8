"""Checks that the supports and sensors of a plate lie on it, before it is meshed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.wrong_units.lengths import likely_lengths
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.rectangle import CLOSEST

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable

_ROUNDING = 1.0 + 1e-9  # relative tolerance
_RIGID = ("patch", "patches", "bar", "bars")  # the mesh follows their rims


def check_positions(case: CaseTable) -> None:
    """Check that the sensors and supports of a plate lie on it.

    The supports are those of an elastic plate with a generated mesh.

    Raises
    ------
    InputError
        With the key of the first that does not.
    """
    plate = case.plate
    if plate.size is None or isinstance(plate.mesh, BroughtMeshTable):
        return
    half = (0.5 * plate.size[0], 0.5 * plate.size[1])
    for number, sensor in enumerate(case.sensors):
        try:
            if isinstance(sensor.position, str):
                raise InputError(
                    f'only a plate with a mesh file has sets, such as "{sensor.position}"; '
                    "give x and y"
                )
            if sensor.subject != "sound":
                _check_point(sensor.position, half, "position")
        except InputError as error:
            names = [{"name": sensor.name} for sensor in case.sensors]
            key = f"{item_label('sensors', names, number)}.position"
            raise InputError(error.message, key) from None
    if plate.model != "elastic" or not isinstance(plate.supports, tuple):
        return
    for number, table in enumerate(plate.supports):
        try:
            _check_support(table, half)
        except InputError as error:
            types = [{"type": table.type} for table in plate.supports]
            key = f"{item_label('plate.supports', types, number)}.{error.key}".rstrip(".")
            raise InputError(error.message, key) from None


def _check_point(position: Sequence[float], half: tuple[float, float], key: str) -> None:
    """Raise InputError if a point lies outside the plate, of which `half` are the half sides."""
    if any(abs(x) > _ROUNDING * end for x, end in zip(position, half, strict=True)):
        raise InputError(
            f"{_shown(position)} m lies outside the plate, "
            f"{_reaches(half)}{likely_lengths(position, half)}",
            key,
        )


def _check_support(table: Any, half: tuple[float, float]) -> None:
    """Check that a support lies on the plate with its rim.

    Of a group of four it is their centres that lie on it.
    """
    if table.type == "set":
        raise InputError(
            f'a plate that is meshed here has no set "{table.name}"; give patches, bars, '
            "edges, points or springs"
        )
    centre = getattr(table, "position", None)
    spacing = getattr(table, "spacing", None)
    if centre is not None:
        _check_point(centre, half, "position")
    elif spacing is not None:
        _check_spacing(spacing, half)
        centre = (0.5 * spacing[0], 0.5 * spacing[1])
    else:
        return
    if getattr(table, "size", None) is not None:
        _check_size(table.size, centre, half)
    else:
        radius = getattr(table, "radius", None) or 0.0
        _check_radius(radius, centre, half, is_rigid=table.type in _RIGID)


def _check_spacing(spacing: Sequence[float], half: tuple[float, float]) -> None:
    """Raise InputError if a group of four supports is wider than the plate."""
    if any(0.5 * width > _ROUNDING * end for width, end in zip(spacing, half, strict=True)):
        sides = (2.0 * half[0], 2.0 * half[1])
        raise InputError(
            f"{_shown(spacing)} m is wider than the plate, {_shown(sides)} "
            f"m{likely_lengths(spacing, sides)}",
            "spacing",
        )


def _check_size(size: Sequence[float], centre: Sequence[float], half: tuple[float, float]) -> None:
    """Raise InputError if a rectangular support reaches beyond the plate."""
    for side, x, end in zip(size, centre, half, strict=True):
        if 0.5 * side > end - abs(x) + 1e-9 * end:
            hint = likely_lengths(size, [2.0 * end for end in half])
            raise InputError(
                f"{_shown(size)} m around {_shown(centre)} m reaches beyond the "
                f"plate, {_reaches(half)}{hint}",
                "size",
            )


def _check_radius(
    radius: float, centre: Sequence[float], half: tuple[float, float], *, is_rigid: bool
) -> None:
    """Raise InputError if a round support reaches beyond the plate.

    The mesh follows the rim of a rigid one, which needs a margin to the edge.
    """
    distance = min(end - abs(x) for x, end in zip(centre, half, strict=True))  # from the edge
    # with the tolerance of supports on meshes
    least = CLOSEST * radius if is_rigid else radius - 1e-9 * max(half)
    if least <= distance:
        return
    fault = "reaches beyond"
    margin = ""
    if is_rigid:
        margin = f"; between it and the edge must be at least {CLOSEST - 1.0:.2g} radii"
        if radius <= distance:
            fault = "is too near the edge of"
    raise InputError(
        f"{radius:g} m around {_shown(centre)} m {fault} the plate, {_reaches(half)}{margin}"
        f"{likely_lengths([radius], [min(half)])}",
        "radius",
    )


def _reaches(half: Sequence[float]) -> str:
    """Return the extent of a plate from its centre in words."""
    return f"which reaches to {_shown(half)} m from its centre"


def _shown(pair: Sequence[float]) -> str:
    return f"({pair[0]:g}, {pair[1]:g})"
