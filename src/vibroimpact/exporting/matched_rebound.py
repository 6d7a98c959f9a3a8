"""Adams' IMPACT with the rebound of a run, or of the contact of a run alone, between rigid bodies.

A model of rigid bodies needs the first: its contact stands for the vibration of the bodies too.
One whose bodies deform needs the second.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.contact_law.unreachable import check_reached
from vibroimpact.calibration.fit.calibrated_drops import impact_count, limited_to
from vibroimpact.calibration.fit.matching import match
from vibroimpact.calibration.fit.single_impacts import single_impacts
from vibroimpact.calibration.fit.tunables import law_parameter
from vibroimpact.calibration.observed.matchable import REBOUND
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import contact_laws_of, rigid_problem
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import (
    is_lossless,
    restitution_words,
    spring_of,
    unknown_damping_note,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.rigid_drop import check_in_vacuum_at_rest
from vibroimpact.registry import find_named

_DEPTH_PART = 0.1
"""Penetration of full damping, over the indentation of the slowest impact: the damping then acts
in nearly all of each contact.
"""

_DEEPEST = 1e-4
"""Largest penetration of full damping [m], that of the dialog of Adams View."""

_SAME = 1e-9
"""Relative difference of rebounds up to which they are the same."""

_SAME_FORCE = 1e-3
"""Relative difference of largest forces that is not worth a note."""

MATCHES = {
    "rebound": "the rebound of the run: what the contact and the vibration of elastic bodies take",
    "contact": "the contact law of the run alone, between rigid bodies",
}
"""What the rebound of IMPACT can be matched to."""


def matched_drop(drop: Drop, case: Case, target: str) -> Drop:
    """Return the drop of a run between rigid bodies, with IMPACT matched to its rebound.

    Each impact is matched by the damping, at its own approach speed and with gravity. Stiffness
    and exponent are those of the spring of the contact law; Hertz's if it is not a power law.

    Parameters
    ----------
    drop : Drop
        The drop of the run.
    case : Case
        Its case.
    target : str
        A key of `MATCHES`: "rebound" or "contact".

    Raises
    ------
    InputError
        If there is no such target, there is no rebound, or no damping reaches it: with a
        restitution above 1.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.exporting.load_drop import drop_of_result
    >>> case = vi.load_case("paper:type1-theory", {"run.impacts": 1})
    >>> drop = drop_of_result(vi.result_of(vi.simulate(case)), case)
    >>> (law,) = matched_drop(drop, case, "contact").laws
    >>> law.name, round(law.damping_max, 2)
    ('adams-impact', 177.3)
    """
    find_named("rebound to match", target, MATCHES)
    check_in_vacuum_at_rest(drop)
    problem = replace(rigid_problem(case), sensors=())
    contact = simulate(problem).impacts
    impacts: Mapping[str, Floats] = contact
    if target == "rebound":
        impacts = drop.impacts
    start = _impact_law(case, contact["max_indentation_m"])
    stated = replace(problem, laws=(start,), by_speed={}, duration=None)
    rest_speed = float(simulate(limited_to(stated, 1)).rest.speed[0])
    rebounds = impacts["separation_speed_m_s"] > rest_speed
    impacts = {name: column[rebounds][: impact_count(problem)] for name, column in impacts.items()}
    if not len(impacts["approach_speed_m_s"]):
        raise InputError("the sphere does not rebound in this run; there is nothing to match")
    impacts, gains = _until_energy_comes_back(impacts)
    speeds = impacts["approach_speed_m_s"]
    separation_speeds = impacts["separation_speed_m_s"]
    dampings = _matched_dampings(stated, speeds, separation_speeds)
    laws = tuple(start.changed({"damping_max": float(damping)}) for damping in dampings)
    response = simulate(replace(stated, laws=laws, impacts=len(laws)))
    notes = [
        *_target_notes(drop, target, contact),
        *gains,
        *_force_note(response.impacts, impacts),
        *_one_damping_note(stated, laws, impacts),
    ]
    if is_lossless(contact):
        notes.append(unknown_damping_note(contact_laws_of(case)[0]))
    name = drop.name
    if drop.elastic:
        name = f"{drop.name}, rigid"
    return replace(
        drop,
        name=name,
        laws=laws,
        function=None,
        elastic=(),
        local_element=False,
        finite_sphere=False,
        rigid=None,
        end_time=float(response.end_time[0]),
        impacts=response.impacts,
        history={},
        signals={},
        surface={},
        notes=tuple(notes),
    )


def _until_energy_comes_back(
    impacts: Mapping[str, Floats],
) -> tuple[Mapping[str, Floats], list[str]]:
    """Return the impacts before the first with a restitution above 1, and a note on that one.

    A plate that still vibrates gives energy back; a contact of rigid bodies can't.
    """
    restitutions = impacts["restitution_achieved"]
    gains = np.flatnonzero(restitutions > 1.0 + _SAME)
    if not len(gains):
        return impacts, []
    first = int(gains[0])
    if first == 0:
        raise InputError(
            f"the first impact of this run has a restitution of {restitutions[0]:.4g}, above 1, "
            "which no contact of rigid bodies has"
        )
    note = (
        f"Impact {first + 1} of the run has a restitution of {restitutions[first]:.4g}, above 1: "
        "the plate gives energy back. No contact of rigid bodies does; the impacts before it are "
        "matched."
    )
    return {name: column[:first] for name, column in impacts.items()}, [note]


def _impact_law(case: Case, indentations: Floats) -> AdamsImpact:
    """Return IMPACT with the spring of a case, and a damping to begin with."""
    law = contact_laws_of(case)[0]
    stiffness, exponent = spring_of(law) or (float(contact_pair(case).hertz_stiffness), 1.5)
    if not np.isfinite(stiffness):
        raise InputError(
            "both materials are rigid, and the law has no stiffness of a power law; give the "
            "materials their moduli",
            "contact",
        )
    if isinstance(law, AdamsImpact):
        penetration = float(law.full_damping_penetration)
    else:
        # laws of an impulse have no indentation
        depths = indentations[indentations > 0.0]
        penetration = float(np.min(_DEPTH_PART * depths, initial=_DEEPEST))
        penetration = float(f"{penetration:.1e}")
    example = AdamsImpact.__dataclass_fields__["damping_max"].metadata["example"]
    return AdamsImpact(
        stiffness=stiffness,
        exponent=exponent,
        damping_max=example,
        full_damping_penetration=penetration,
    )


def _matched_dampings(problem: Problem, speeds: Floats, separation_speeds: Floats) -> Floats:
    """Return the damping of each impact [N s/m]."""
    damping = law_parameter(problem)
    labels = tuple(f"impact {impact}" for impact in range(1, len(speeds) + 1))
    seen = Observations(
        speeds=speeds, wanted={"separation_speed": separation_speeds}, labels=labels
    )
    found = match(damping, speeds, seen.wanted, REBOUND, seen.which)
    # a contact without losses is met by no damping, to rounding
    undamped = np.isnan(found.values) & (np.abs(separation_speeds - found.most) <= _SAME * speeds)
    found = replace(found, values=np.where(undamped, 0.0, found.values))
    try:
        return check_reached(damping, problem, seen, REBOUND, found)
    except InputError as error:
        raise InputError(error.message) from None


def _target_notes(drop: Drop, target: str, contact: Mapping[str, Floats]) -> list[str]:
    """Return which rebound the numbers reproduce, and which they do not."""
    of_run = restitution_words(drop.impacts)
    of_contact = restitution_words(contact)
    deforms = drop.rigid is not None and drop.function is None
    if not deforms:
        return [
            "These numbers reproduce the rebound of this run, whose bodies are rigid: that of its "
            f"contact. Restitution from impact to impact: {of_run}."
        ]
    if target == "rebound":
        return [
            "These numbers reproduce the rebound of this run between rigid bodies: the damping "
            "stands for the contact and for what the elastic bodies take together. Restitution "
            f"from impact to impact: {of_run}; of the contact alone {of_contact}.",
            "Where the plate is flexible in the other model too, it takes its energy there a "
            "second time: use --match contact.",
        ]
    return [
        "These numbers reproduce the contact of this run alone, for a model whose bodies deform "
        f"as here. Restitution from impact to impact between rigid bodies: {of_contact}; in the "
        f"run {of_run}.",
        "Where both bodies are rigid in the other model, it rebounds higher than the run: use "
        "--match rebound.",
    ]


def _force_note(matched: Mapping[str, Floats], wanted: Mapping[str, Floats]) -> list[str]:
    """Return the largest forces of the first impact; none if they agree, or the law has none."""
    force = float(wanted["max_force_N"][0])
    own = float(matched["max_force_N"][0])
    if not force > 0.0 or abs(own - force) <= _SAME_FORCE * force:
        return []
    return [
        "The rebound is matched, not the force: the largest of the first impact is "
        f"{own:.4g} N with IMPACT, in place of {force:.4g} N."
    ]


def _one_damping_note(
    problem: Problem, laws: tuple[ContactLaw, ...], impacts: Mapping[str, Floats]
) -> list[str]:
    """Return what the damping of the first impact makes of the last; none of one impact."""
    if len(laws) < 2:
        return []
    speeds = impacts["approach_speed_m_s"]
    last = len(laws) - 1
    rebound = single_impacts(problem, laws[0], speeds[last : last + 1])["separation_speed"]
    with_first = float(rebound[0] / speeds[last])
    wanted = float(impacts["restitution_achieved"][last])
    return [
        f"With the damping of the first impact throughout, impact {last + 1} has a restitution of "
        f"{with_first:.3f} in place of {wanted:.3f}."
    ]
