"""Estimates of the time, memory and disk space that a run of a case takes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.pair import contact_pair
from vibroimpact.cases.rigid_problem import (
    contact_laws_of,
    deforms,
    elastic_names,
    impact_limit,
    in_liquid,
    touch_speed,
)
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.history_grid import MOST_POINTS
from vibroimpact.dynamics.problem import MOST_IMPACTS
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.structures.free_memory import check_memory

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case

# measured on one core of 2.5 GHz or so, by benchmarks/bench_costs.py
_PROGRAM = 170e6  # bytes of the program itself, with its figures
_IMPACT_SECONDS, _IMPACT_BYTES, _IMPACT_ON_DISK = 5e-3, 2.2e3, 1e3
_VIBRATING_SECONDS = 20e-3  # per impact of elastic bodies, for any number of modes
# history points per impact, and bytes of each
_POINTS, _POINT_BYTES, _POINT_ON_DISK = 170, 130.0, 100.0
_SAMPLE_SECONDS, _SAMPLE_BYTES, _SAMPLE_ON_DISK = 2e-7, 8.5, 9.0
# of a sphere, computed in eighths by symmetry
_MODES_SECONDS, _MODES_DOFS, _MODES_NUMBER = 35.0, 42_423, 300
_WHOLE = 4.0  # factor for imported meshes, which are rarely symmetric
_DOF_BYTES = 20e3
_ELASTIC = 1e-7  # relative loss of speed per impact below which a drop counts as lossless
# impacts that take 6 s at most, which is never told: so few that are allowed count in full, and no
# contact is integrated
_FEW = 300
_ONE_BLOW = 10.0  # seconds of a run without gravity, a guess
_LONG, _LARGE, _MUCH = 10.0, 1e9, 500e6
"""Seconds, bytes of memory and bytes on disk above which costs are reported."""


class Cost(NamedTuple):
    """One contribution to the costs of a run: seconds, bytes of memory and on disk, its
    cause, and how to reduce it.
    """

    seconds: float
    memory: float
    disk: float
    why: str
    remedy: str


def costs_of(case: Case, *, modes_alone: bool = False) -> list[Cost]:
    """Return the estimated contributions to the costs of a run; modes in the mode store cost
    nothing.

    Parameters
    ----------
    case : Case
        The case.
    modes_alone : bool, default False
        Estimate the costs of its modes only.
    """
    return [
        *_mode_costs(case),
        *(() if modes_alone else (*_impact_costs(case), *_signal_costs(case))),
    ]


def describe_costs(case: Case, *, modes_alone: bool = False) -> list[str]:
    """Return a sentence for each contribution of more than ten seconds, 1 GB of memory or 500 MB on
    disk.

    Raises
    ------
    InputError
        If a contribution exceeds the free memory; the message gives its cause and remedy.
    """
    told = []
    for cost in costs_of(case, modes_alone=modes_alone):
        check_memory(_PROGRAM + cost.memory, f"{cost.why} need", cost.remedy)
        if cost.seconds > _LONG or cost.memory > _LARGE or cost.disk > _MUCH:
            told.append(f"{cost.why} take about {_listed(cost)}; {cost.remedy}")
    return told


@derived
def impacts_expected(case: Case) -> int:
    r"""Return the estimated number of impacts of a drop with rigid bodies, an upper bound for
    elastic ones; of 300 or fewer their limit.

    All impacts are assumed to have the restitution e of the first: from a speed :math:`v` to the
    rest speed :math:`v_r` there are
    :math:`\ln(v_r/v)/\ln e` impacts; a duration :math:`T` is filled by the flights, which take
    :math:`2 v e^k / g`.
    """
    most, speed, gravity = impact_limit(case) or MOST_IMPACTS, touch_speed(case), case.drop.gravity
    if not (speed > 0.0 and gravity > 0.0):
        return 1
    if most <= _FEW:
        return most
    kept = _restitution(case)
    if kept <= 0.0:
        return 1
    if kept >= 1.0 - _ELASTIC:
        return int(min(most, 1.0 + 0.5 * (case.run.duration or math.inf) * gravity / speed))
    rest, law = case.run.rest_speed, contact_laws_of(case)[-1]
    if rest is None:
        weight = float(contact_pair(case).effective_mass) * gravity
        sag = (
            float(static_indentation(law, weight)) - float(law.touch_level)
            if isinstance(law, CompliantLaw)
            else 0.0
        )
        rest = max(1e-6 * speed, math.sqrt(2.0 * gravity * max(sag, 0.0)))
    count = math.log(rest / speed) / math.log(kept) if 0.0 < rest < speed else math.inf
    if case.run.duration is not None:
        left = 1.0 - case.run.duration * gravity * (1.0 - kept) / (2.0 * speed * kept)
        count = min(count, math.log(left) / math.log(kept) if left > 0.0 else math.inf)
    return int(min(most, max(count, 0.0) + 1.0))


def seconds_expected(case: Case) -> float:
    """Return the estimated length of a run [s]: its duration, or that of its flights if
    all impacts have the restitution of the first.
    """
    return _seconds(case, _restitution(case))


def seconds_at_most(case: Case) -> float:
    """Return an upper bound of `seconds_expected` [s], that of flights without losses,
    which integrates no contact.
    """
    return _seconds(case, 1.0)


def _seconds(case: Case, kept: float) -> float:
    speed, gravity = touch_speed(case), case.drop.gravity
    if case.run.duration is not None or not (speed > 0.0 and gravity > 0.0):
        return case.run.duration or _ONE_BLOW
    number = impacts_expected(case)
    flights = number if kept >= 1.0 - _ELASTIC else kept * (1.0 - kept**number) / (1.0 - kept)
    return (1.0 + 2.0 * flights) * speed / gravity


@derived
def _restitution(case: Case) -> float:
    """Return the restitution of the last law at the speed of the first impact."""
    law = in_liquid(case, contact_laws_of(case)[-1])
    return float(
        achieved_restitution(law, float(contact_pair(case).effective_mass), touch_speed(case))
    )


def _impact_costs(case: Case) -> Iterator[Cost]:
    number = impacts_expected(case)
    vibrate = deforms(case)
    # energy lost to vibration reduces the number of impacts until the sphere is at rest, and
    # shortens the flights within a duration
    most = "up to " if vibrate and case.run.duration is None else ""
    more = (
        ", or more as vibration shortens the flights"
        if vibrate and case.run.duration is not None
        else ""
    )
    points = min(_POINTS * number, MOST_POINTS)
    less = "give fewer run.impacts"
    if case.run.duration is not None:
        less += ", or a shorter run.duration"
    elif impact_limit(case) is None and case.plate.motion is None:
        less += ", or a higher run.rest_speed"
    yield Cost(
        (_VIBRATING_SECONDS if vibrate else _IMPACT_SECONDS) * number,
        _IMPACT_BYTES * number + _POINT_BYTES * points,
        _IMPACT_ON_DISK * number + _POINT_ON_DISK * points,
        f"{most}about {float(f'{number:.2g}'):,.0f} impact{'s' if number > 1 else ''}{more}",
        less,
    )


def _signal_costs(case: Case) -> Iterator[Cost]:
    if case.run.duration is None or not case.sensors:
        return
    samples = case.run.duration * sum(sensor.rate for sensor in case.sensors)
    which = (
        "the samples of the sensor"
        if len(case.sensors) == 1
        else f"the samples of {len(case.sensors)} sensors"
    )
    remedy = "give a shorter run.duration or a lower rate of the sensors"
    yield Cost(
        _SAMPLE_SECONDS * samples,
        _SAMPLE_BYTES * samples,
        _SAMPLE_ON_DISK * samples,
        f"{which}, {samples:.2g},",
        remedy,
    )


def _mode_costs(case: Case) -> Iterator[Cost]:
    if not elastic_names(case):
        return
    from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies  # imports scipy.sparse
    from vibroimpact.structures.mode_count import modes_expected
    from vibroimpact.structures.recipe import ImportedMesh, model_key
    from vibroimpact.structures.store import has_model

    for name, body in elastic_bodies(case).items():
        recipe = body.recipe
        if has_model(model_key(recipe)):
            continue
        mesh, number = recipe.shape.mesh(recipe.supports), modes_expected(recipe)
        dofs = mesh.dofs_per_node * len(mesh.nodes)
        share = 0.3 + 0.7 * number / _MODES_NUMBER
        seconds = (
            _MODES_SECONDS
            * (dofs / _MODES_DOFS) ** (4.0 / 3.0)
            * share
            * (_WHOLE if isinstance(recipe.shape, ImportedMesh) else 1.0)
        )
        fewer = (
            f"fewer {name}.modes"
            if recipe.reduction.max_frequency is None
            else f"a lower {name}.max_frequency"
        )
        remedy = f"give {fewer} or larger elements; the modes are computed once and kept"
        yield Cost(
            seconds, _DOF_BYTES * dofs, 8.0 * dofs * number, f"the modes of the {name}", remedy
        )


def _listed(cost: Cost) -> str:
    """Return the amounts of a contribution in words."""
    parts = [_time(cost.seconds)] if cost.seconds > 1.0 else []
    parts.append(f"{_size(_PROGRAM + cost.memory)} of memory")
    disk = f" and {_size(cost.disk)} on disk" if cost.disk > 1e6 else ""
    return ", ".join(parts) + disk


def _time(seconds: float) -> str:
    return (
        f"{float(f'{seconds:.1g}'):.0f} s"
        if seconds < 90.0
        else f"{float(f'{seconds / 60.0:.2g}'):.0f} minutes"
    )


def _size(size: float) -> str:
    return f"{size / 1e9:.2g} GB" if size >= 1e9 else f"{float(f'{size / 1e6:.2g}'):.0f} MB"
