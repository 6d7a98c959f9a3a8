"""Estimates of the time, memory and disk space that a run of a case takes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import (
    contact_laws_of,
    deforms,
    elastic_names,
    in_liquid,
    touch_speed,
)
from vibroimpact.cases.rigid.run_ends import impact_limit
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.history_grid import MOST_POINTS
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS
from vibroimpact.structures.finite_elements.free_memory import check_memory

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case

# measured on one core of 2.5 GHz or so, by benchmarks/bench_costs.py
_PROGRAM_BYTES = 170e6  # of the program itself, with its figures
# per impact; of elastic bodies, the time for any number of modes
_IMPACT_SECONDS = 5e-3
_VIBRATING_SECONDS = 20e-3
_IMPACT_BYTES = 2.2e3
_IMPACT_ON_DISK = 1e3
# history points per impact, and bytes of each
_POINTS = 170
_POINT_BYTES = 130.0
_POINT_ON_DISK = 100.0
# per sample of a sensor
_SAMPLE_SECONDS = 2e-7
_SAMPLE_BYTES = 8.5
_SAMPLE_ON_DISK = 9.0
# modes of a sphere, computed in eighths by symmetry: time for these degrees of freedom and modes
_MODES_SECONDS = 35.0
_MODES_DOFS = 42_423
_MODES_NUMBER = 300
_WHOLE = 4.0  # factor for imported meshes, which are rarely symmetric
_DOF_BYTES = 20e3

_ELASTIC = 1e-7  # relative loss of speed per impact below which a drop counts as lossless
# impacts that take 6 s at most, which is never told: so few that are allowed count in full, and no
# contact is integrated
_FEW = 300
_DURATION_WITHOUT_GRAVITY = 10.0  # s, a guess

# costs above which they are reported
_LONG = 10.0  # s
_LARGE = 1e9  # bytes of memory
_MUCH = 500e6  # bytes on disk


class Cost(NamedTuple):
    """One contribution to the costs of a run.

    It has seconds, bytes of memory and on disk, its cause, and how to reduce it.
    """

    seconds: float
    memory: float
    disk: float
    why: str
    remedy: str


def costs_of(case: Case, *, modes_alone: bool = False) -> list[Cost]:
    """Return the estimated contributions to the costs of a run.

    Modes in the mode store cost nothing.

    Parameters
    ----------
    case : Case
        The case.
    modes_alone : bool, default False
        Estimate the costs of its modes only.
    """
    costs = list(_mode_costs(case))
    if not modes_alone:
        costs += [*_impact_costs(case), *_signal_costs(case)]
    return costs


def describe_costs(case: Case, *, modes_alone: bool = False) -> list[str]:
    """Return a sentence for each large contribution to the costs of a run.

    It takes more than ten seconds, 1 GB of memory or 500 MB on disk.

    Raises
    ------
    InputError
        If a contribution exceeds the free memory; the message gives its cause and remedy.
    """
    sentences = []
    for cost in costs_of(case, modes_alone=modes_alone):
        check_memory(_PROGRAM_BYTES + cost.memory, f"{cost.why} need", cost.remedy)
        if cost.seconds > _LONG or cost.memory > _LARGE or cost.disk > _MUCH:
            sentences.append(f"{cost.why} take about {_listed(cost)}; {cost.remedy}")
    return sentences


@derived
def impacts_expected(case: Case) -> int:
    r"""Return the estimated number of impacts of a drop with rigid bodies.

    It is an upper bound for elastic ones. Where 300 or fewer are allowed, it is this limit.

    All impacts are assumed to have the restitution e of the first. From a speed :math:`v` to the
    rest speed :math:`v_r` there are :math:`\ln(v_r/v)/\ln e` impacts; a duration :math:`T` is
    filled by the flights, which take :math:`2 v e^k / g`.
    """
    most = impact_limit(case) or MOST_IMPACTS
    speed = touch_speed(case)
    gravity = case.drop.gravity
    if not (speed > 0.0 and gravity > 0.0):
        return 1
    if most <= _FEW:
        return most
    restitution = _restitution(case)
    if restitution <= 0.0:
        return 1
    duration = case.run.duration
    if restitution >= 1.0 - _ELASTIC:
        return int(min(most, 1.0 + 0.5 * (duration or math.inf) * gravity / speed))
    rest_speed = case.run.rest_speed
    if rest_speed is None:
        rest_speed = _rest_speed(case)
    count = math.inf
    if 0.0 < rest_speed < speed:
        count = math.log(rest_speed / speed) / math.log(restitution)
    if duration is not None:
        # the flights are a geometric series: T = 2 v e (1 - e^n) / (g (1 - e))
        power = 1.0 - duration * gravity * (1.0 - restitution) / (2.0 * speed * restitution)
        if power > 0.0:
            count = min(count, math.log(power) / math.log(restitution))
    return int(min(most, max(count, 0.0) + 1.0))


def _rest_speed(case: Case) -> float:
    """Return the speed below which the sphere is at rest where a case does not state it [m/s].

    From it a sphere would rise by its static indentation, as in `core.drops.default_rest_speed`.
    """
    gravity = case.drop.gravity
    law = contact_laws_of(case)[0]
    sag = 0.0
    if isinstance(law, CompliantLaw):
        weight = float(contact_pair(case).effective_mass) * gravity
        sag = float(static_indentation(law, weight)) - float(law.touch_level)
    return max(1e-6 * touch_speed(case), math.sqrt(2.0 * gravity * max(sag, 0.0)))


def seconds_expected(case: Case) -> float:
    """Return the estimated length of a run [s].

    It is its duration, or that of its flights if all impacts have the restitution of the first.
    """
    return _seconds(case, _restitution(case))


def seconds_at_most(case: Case) -> float:
    """Return an upper bound of `seconds_expected` [s], that of flights without losses.

    For this no contact is integrated.
    """
    return _seconds(case, 1.0)


def _seconds(case: Case, restitution: float) -> float:
    """Return the length of a run [s] in which all impacts have the same restitution."""
    speed = touch_speed(case)
    gravity = case.drop.gravity
    if case.run.duration is not None or not (speed > 0.0 and gravity > 0.0):
        return case.run.duration or _DURATION_WITHOUT_GRAVITY
    number = impacts_expected(case)
    # the sum of the speeds after the impacts, over that of the first touch
    speeds = float(number)
    if restitution < 1.0 - _ELASTIC:
        speeds = restitution * (1.0 - restitution**number) / (1.0 - restitution)
    return (1.0 + 2.0 * speeds) * speed / gravity


@derived
def _restitution(case: Case) -> float:
    """Return the restitution of the last law at the speed of the first impact."""
    law = in_liquid(case, contact_laws_of(case)[-1])
    mass = float(contact_pair(case).effective_mass)
    return float(achieved_restitution(law, mass, touch_speed(case)))


def _impact_costs(case: Case) -> Iterator[Cost]:
    """Yield the costs of the impacts, and of their history."""
    number = impacts_expected(case)
    points = min(_POINTS * number, MOST_POINTS)
    seconds = _IMPACT_SECONDS
    bound = ""
    shortening = ""
    if deforms(case):
        seconds = _VIBRATING_SECONDS
        # energy lost to vibration reduces the number of impacts until the sphere is at rest, and
        # shortens the flights within a duration
        if case.run.duration is None:
            bound = "up to "
        else:
            shortening = ", or more as vibration shortens the flights"
    remedy = "give fewer run.impacts"
    if case.run.duration is not None:
        remedy += ", or a shorter run.duration"
    elif impact_limit(case) is None and case.plate.motion is None:
        remedy += ", or a higher run.rest_speed"
    rounded = f"{float(f'{number:.2g}'):,.0f}"
    noun = "impacts" if number > 1 else "impact"
    yield Cost(
        seconds * number,
        _IMPACT_BYTES * number + _POINT_BYTES * points,
        _IMPACT_ON_DISK * number + _POINT_ON_DISK * points,
        f"{bound}about {rounded} {noun}{shortening}",
        remedy,
    )


def _signal_costs(case: Case) -> Iterator[Cost]:
    """Yield the costs of the samples of sensors."""
    if case.run.duration is None or not case.sensors:
        return
    samples = case.run.duration * sum(sensor.rate for sensor in case.sensors)
    sensors = "the sensor" if len(case.sensors) == 1 else f"{len(case.sensors)} sensors"
    yield Cost(
        _SAMPLE_SECONDS * samples,
        _SAMPLE_BYTES * samples,
        _SAMPLE_ON_DISK * samples,
        f"the samples of {sensors}, {samples:.2g},",
        "give a shorter run.duration or a lower rate of the sensors",
    )


def _mode_costs(case: Case) -> Iterator[Cost]:
    """Yield the costs of the modes of each elastic body that are not in the mode store."""
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
        mesh = recipe.shape.mesh(recipe.supports)
        number = modes_expected(recipe)
        dofs = mesh.dofs_per_node * len(mesh.nodes)
        share = 0.3 + 0.7 * number / _MODES_NUMBER
        seconds = _MODES_SECONDS * (dofs / _MODES_DOFS) ** (4.0 / 3.0) * share
        if isinstance(recipe.shape, ImportedMesh):
            seconds *= _WHOLE
        fewer = f"fewer {name}.modes"
        if recipe.reduction.max_frequency is not None:
            fewer = f"a lower {name}.max_frequency"
        remedy = f"give {fewer} or larger elements; the modes are computed once and kept"
        yield Cost(
            seconds, _DOF_BYTES * dofs, 8.0 * dofs * number, f"the modes of the {name}", remedy
        )


def _listed(cost: Cost) -> str:
    """Return the amounts of a contribution in words."""
    phrase = f"{_size(_PROGRAM_BYTES + cost.memory)} of memory"
    if cost.seconds > 1.0:
        phrase = f"{_time(cost.seconds)}, {phrase}"
    if cost.disk > 1e6:
        phrase += f" and {_size(cost.disk)} on disk"
    return phrase


def _time(seconds: float) -> str:
    """Return a time with one or two digits, in seconds or minutes."""
    if seconds < 90.0:
        return f"{float(f'{seconds:.1g}'):.0f} s"
    return f"{float(f'{seconds / 60.0:.2g}'):.0f} minutes"


def _size(size: float) -> str:
    """Return a number of bytes with two digits, in MB or GB."""
    if size >= 1e9:
        return f"{size / 1e9:.2g} GB"
    return f"{float(f'{size / 1e6:.2g}'):.0f} MB"
