"""What the uncertainty of the numbers of a case, such as the height of fall, changes.

It changes a measurement, and the impacts that match it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.observed.inputs import EARTH, Input, as_input
from vibroimpact.calibration.observed.observations import Effects, Observations
from vibroimpact.cases.case import Case
from vibroimpact.errors import InputError
from vibroimpact.materials import material_library
from vibroimpact.units.display import STANDARD_GRAVITY
from vibroimpact.units.written import Written

_KEYS = {
    "drop.height": "m",
    "drop.speed": "m/s",
    "drop.gravity": "m/s^2",
    "sphere.radius": "m",
    "sphere.material.density": "kg/m^3",
    "plate.material.density": "kg/m^3",
}
"""Keys whose numbers evaluate a measurement, with their units. That of the plate counts
only where its standard deviation is given.
"""

_NAMED = 0.01
"""Standard deviation of the density of a material that is given by its name, as a part of it."""

_STEP = 1e-4
"""Relative step of the differences."""


class Moved(NamedTuple):
    """An input, a step from its value in SI, and measurement and impacts after the step."""

    typed: Input
    step: float
    seen: Observations
    tunable: Tunable


def typed_inputs(case: Case) -> list[Input]:
    """Return the numbers of a case that evaluate a measurement, except those that are exact.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case(
    ...     "paper:type1-theory", {"drop.height": "4 m +- 1 cm", "sphere.radius": "25.0 mm +- 0"}
    ... )
    >>> [(typed.name, round(typed.value.deviation, 5)) for typed in typed_inputs(case)]
    [('drop.height', 0.01), ('drop.gravity', 0.02887), ('sphere.material.density', 13.8)]
    """
    inputs = []
    for key, unit in _KEYS.items():
        value = _number(case, key)
        if value is None or not isinstance(value, Written) or not value * value.deviation:
            continue
        if value.stated or not key.startswith("plate."):
            inputs.append(as_input(key, value, unit))
    return inputs


def moved_inputs(
    case: Case, evaluated: Callable[[Case], tuple[Observations, Tunable]], seen: Observations
) -> list[Moved]:
    """Return measurement and impacts with each uncertain number of a case changed a little.

    Parameters
    ----------
    case : Case
        The case.
    evaluated : callable
        Takes a case, and returns the measurement as it is evaluated with it, and its impacts.
    seen : Observations
        The measurement with the numbers as they are given.

    Raises
    ------
    InputError
        If the measurement can't be evaluated a little above the number nor below it; the message is
        that of the evaluation.
    """
    steps = []
    for typed in typed_inputs(case):
        # a little above the number, or if it can't be evaluated there, below it
        for step in (_STEP * typed.value, -_STEP * typed.value):
            try:
                moved, tunable = evaluated(_with_number(case, typed.name, typed.value + step))
            except InputError:
                if step < 0.0:
                    raise
                continue
            if len(moved.speeds) == len(seen.speeds):
                steps.append(Moved(typed, step, moved, tunable))
                break
    return steps


def effects_of(
    moved: Sequence[Moved],
    tunable: Tunable,
    seen: Observations,
    weights: Mapping[str, float],
    values: Floats,
) -> Effects | None:
    """Return what one standard deviation of each input changes; None if nothing changes.

    Parameters
    ----------
    moved : sequence of Moved
        Measurement and impacts with each input changed a little.
    tunable : Tunable
        The parameter.
    seen : Observations
        The measurement.
    weights : mapping of str to float
        The matched quantities.
    values : array, shape (n,)
        The values of the parameter.
    """
    values = np.where(np.isfinite(values), values, tunable.start)
    computed: dict[str, Floats] = {}
    if moved:
        computed = tunable.respond(seen.speeds, values, seen.which)
    inputs = []
    speed_effects = []
    wanted_effects: dict[str, list[Floats]] = {name: [] for name in weights}
    for typed, step, moved_seen, moved_tunable in moved:
        deviations_per_step = typed.value.deviation / step
        speed_effect = deviations_per_step * (moved_seen.speeds - seen.speeds)
        moved_computed = moved_tunable.respond(seen.speeds, values, seen.which)
        # of the targets beyond that of the computed quantities
        effects = {
            name: deviations_per_step
            * (moved_seen.wanted[name] - seen.wanted[name] - moved_computed[name] + computed[name])
            for name in weights
        }
        if np.any(speed_effect) or any(np.any(effect) for effect in effects.values()):
            inputs.append(typed)
            speed_effects.append(speed_effect)
            for name, effect in effects.items():
                wanted_effects[name].append(effect)
    if not inputs:
        return None
    return Effects(
        inputs=tuple(inputs),
        speeds=np.stack(speed_effects, axis=1),
        wanted={name: np.stack(effects, axis=1) for name, effects in wanted_effects.items()},
    )


def _number(case: Case, key: str) -> float | None:
    """Return a number of a case with its standard deviation, None if there is none.

    It is a plain number if it is exact.
    """
    section, field, *_ = key.split(".")
    body = getattr(case, section)
    of_material = field == "material"
    quantity = getattr(body, field)
    value: float | None = quantity.density if of_material else quantity
    if value is None or (isinstance(value, Written) and value.stated):
        return value
    if key == "drop.gravity" and value == STANDARD_GRAVITY:
        return EARTH
    if of_material and body.material.name in material_library():
        name = body.material.name
        return Written(
            value, _NAMED * value, name, stated=False, why=f"as of a material by its name, {name}"
        )
    return value


def _with_number(case: Case, key: str, value: float) -> Case:
    """Return a case with another number at a key."""
    section, field, *_ = key.split(".")
    body = getattr(case, section)
    changes = {field: value}
    if field == "material":
        changes = {"material": replace(body.material, density=value)}
    return case.model_copy(update={section: body.model_copy(update=changes)})
