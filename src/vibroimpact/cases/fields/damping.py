"""The damping field of an elastic body: a damping ratio, a keyword, or a table."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator

from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import read_quantity
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range
from vibroimpact.structures.damping import (
    AdamsDefault,
    ConstantRatio,
    Damping,
    LossFactor,
    RatioOfEach,
    RatioTable,
    Rayleigh,
)

ADAMS = "adams-default"
MATERIAL = "loss-factor"
_DAMPINGS = (AdamsDefault, ConstantRatio, LossFactor, RatioOfEach, RatioTable, Rayleigh)
_NOT_NEGATIVE = Range(at_least=0)
_ALLOWED = (
    f'a damping ratio, "{ADAMS}", "{MATERIAL}" (of the material), {{ rayleigh = [1/s, s] '
    f"}}, {{ loss_factor = x }}, "
    "{ ratios = [...] } mode by mode, or { frequencies = [...], ratios = [...] }"
)


def _read_damping(value: Any) -> Any:
    if isinstance(value, _DAMPINGS) or value == MATERIAL:
        return value
    if isinstance(value, str):
        if value != ADAMS:
            raise InputError(
                f"{quoted(value)} is not allowed; it must be "
                f"{_ALLOWED}.{did_you_mean(value, (ADAMS, MATERIAL))}"
            )
        return AdamsDefault()
    if isinstance(value, dict):
        return _read_table(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{quoted(value)} is not allowed; it must be {_ALLOWED}")
    _NOT_NEGATIVE.check(value)
    return ConstantRatio(float(value))


def _read_table(value: dict[str, Any]) -> Damping:
    def numbers(key: str, unit: str = "") -> tuple[float, ...]:
        given = value[key]
        if not isinstance(given, list) or not given:
            raise InputError("it must be a list of numbers", key)
        try:
            return tuple(read_quantity(item, unit, _NOT_NEGATIVE) for item in given)
        except InputError as error:
            raise InputError(error.message, key) from None

    keys = set(value)
    if keys == {"rayleigh"}:
        pair = value["rayleigh"]
        if not isinstance(pair, list) or len(pair) != 2:
            raise InputError(
                "it must be a pair, [a, b]: a [1/s] times the mass and b [s] times the stiffness",
                "rayleigh",
            )
        return Rayleigh(
            read_quantity(pair[0], "1/s", _NOT_NEGATIVE), read_quantity(pair[1], "s", _NOT_NEGATIVE)
        )
    if keys == {"loss_factor"}:
        return LossFactor(read_quantity(value["loss_factor"], "", _NOT_NEGATIVE))
    if keys == {"ratios"}:
        return RatioOfEach(numbers("ratios"))
    if keys == {"frequencies", "ratios"}:
        return RatioTable(numbers("frequencies", "Hz"), numbers("ratios"))
    raise InputError(
        f"a table with {', '.join(sorted(keys)) or 'nothing'} is not a damping; "
        f"it must be {_ALLOWED}"
    )


DampingField = Annotated[
    Any,
    BeforeValidator(_read_damping),
    JsonSchema(
        _ALLOWED,
        lambda: {"anyOf": [{"type": "number"}, {"enum": [ADAMS, MATERIAL]}, {"type": "object"}]},
    ),
]


def damping_of(value: Any, loss_factor: float | None) -> Damping:
    """Return the damping model of a validated field; zero damping if the field is None.

    Raises
    ------
    InputError
        If the field refers to the loss factor of the material, which has none.
    """
    if value is None:
        return ConstantRatio(0.0)
    if value == MATERIAL:
        if loss_factor is None:
            raise InputError(
                f'"{MATERIAL}" needs a loss_factor of the material, and it has none; give '
                f"{{ loss_factor = x }}",
                "damping",
            )
        return LossFactor(loss_factor)
    damping: Damping = value
    return damping


def damping_table(value: Any) -> Any:
    """Return a damping model as it is written in a case file."""
    match value:
        case ConstantRatio():
            return value.ratio
        case AdamsDefault():
            return ADAMS
        case LossFactor():
            return {"loss_factor": value.loss_factor}
        case Rayleigh():
            return {"rayleigh": [value.mass_coefficient, value.stiffness_coefficient]}
        case RatioOfEach():
            return {"ratios": list(value.damping_ratios)}
        case RatioTable():
            return {"frequencies": list(value.frequencies), "ratios": list(value.damping_ratios)}
        case None:
            return None
    raise AssertionError(f"{value!r} is none of the damping models")
