"""Checks that the supports and sensors of a plate lie on it, before it is meshed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.wrong_units.lengths import likely_lengths
from vibroimpact.errors import InputError
from vibroimpact.structures.rectangle import CLOSEST

if TYPE_CHECKING:
    from vibroimpact.cases.schema import CaseTable

_ROUNDING = 1.0 + 1e-9  # relative tolerance
_RIGID = ("patch", "patches", "bar", "bars")  # the mesh follows their rims


def check_positions(case: CaseTable) -> None:
    """Check that the sensors of a plate, and the supports of an elastic one with a generated mesh,
    lie on it.

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
            if sensor.microphone is None:
                _check_point(sensor.position, half, "position")
        except InputError as error:
            names = [{"name": sensor.name} for sensor in case.sensors]
            raise InputError(
                error.message, f"{item_label('sensors', names, number)}.position"
            ) from None
    tables = (
        plate.supports if plate.model == "elastic" and isinstance(plate.supports, tuple) else ()
    )
    for number, table in enumerate(tables):
        try:
            _check_support(table, half)
        except InputError as error:
            kinds = [{"type": table.type} for table in tables]
            raise InputError(
                error.message,
                f"{item_label('plate.supports', kinds, number)}.{error.key}".rstrip("."),
            ) from None


def _check_point(position: Sequence[float], half: tuple[float, float], key: str) -> None:
    if any(abs(at) > _ROUNDING * end for at, end in zip(position, half, strict=True)):
        raise InputError(
            f"{_shown(position)} m lies outside the plate, "
            f"{_reaches(half)}{likely_lengths(position, half)}",
            key,
        )


def _check_support(table: Any, half: tuple[float, float]) -> None:
    """Check that a support lies on the plate: its centre, or those of a group of four,
    and its rim.
    """
    if table.type == "set":
        raise InputError(
            f'a plate that is meshed here has no set "{table.name}"; give patches, bars, '
            "edges, points or springs"
        )
    centre = getattr(table, "position", None)
    if centre is not None:
        _check_point(centre, half, "position")
    elif (spacing := getattr(table, "spacing", None)) is not None:
        if any(0.5 * apart > _ROUNDING * end for apart, end in zip(spacing, half, strict=True)):
            sides = (2.0 * half[0], 2.0 * half[1])
            raise InputError(
                f"{_shown(spacing)} m is wider than the plate, {_shown(sides)} "
                f"m{likely_lengths(spacing, sides)}",
                "spacing",
            )
        centre = (0.5 * spacing[0], 0.5 * spacing[1])
    if centre is None:
        return
    room = [end - abs(at) for at, end in zip(centre, half, strict=True)]
    if getattr(table, "size", None) is not None:
        if any(
            0.5 * side > left + 1e-9 * end
            for side, left, end in zip(table.size, room, half, strict=True)
        ):
            hint = likely_lengths(table.size, [2.0 * end for end in half])
            raise InputError(
                f"{_shown(table.size)} m around {_shown(centre)} m reaches beyond the "
                f"plate, {_reaches(half)}{hint}",
                "size",
            )
        return
    radius = getattr(table, "radius", None) or 0.0
    is_rigid = table.type in _RIGID
    # with the tolerance of supports on meshes
    least = CLOSEST * radius if is_rigid else radius - 1e-9 * max(half)
    if least > min(room):
        margin = (
            f"; between it and the edge must be at least {CLOSEST - 1.0:.2g} radii"
            if is_rigid
            else ""
        )
        beyond = "is too near the edge of" if is_rigid and radius <= min(room) else "reaches beyond"
        words = (
            f"{radius:g} m around {_shown(centre)} m {beyond} the plate, {_reaches(half)}{margin}"
        )
        raise InputError(f"{words}{likely_lengths([radius], [min(half)])}", "radius")


def _reaches(half: Sequence[float]) -> str:
    """Return the extent of a plate from its centre in words."""
    return f"which reaches to {_shown(half)} m from its centre"


def _shown(pair: Sequence[float]) -> str:
    return f"({pair[0]:g}, {pair[1]:g})"
