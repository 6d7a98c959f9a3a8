"""What `check --json` prints of a case: the resolved case, and what is expected of it."""

from __future__ import annotations

from collections.abc import Container
from typing import Any

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.costs import describe_costs
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.rigid.expected import expected_of, first_restitution
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import (
    contact_laws_of,
    elastic_names,
    mass_of_sphere,
    touch_speed,
)


def case_document(case: Case, aside: Container[str] = ()) -> dict[str, Any]:
    """Return a case as its results would hold it, with its expected first contact, its cost and its
    doubts.

    The restitution is that of rigid bodies without gravity, indentation and force are those of
    rigid bodies without losses.

    Parameters
    ----------
    case : Case
        The case; it is not run.
    aside : container of str
        Keys of the case whose implausible values are reported elsewhere, and not doubted here.
    """
    law = contact_laws_of(case)[0]
    pair = contact_pair(case)
    speed = touch_speed(case)
    expected = expected_of(case)
    resolved = resolved_case(case)
    restitution = first_restitution(case)
    return {
        "name": case.name,
        "mass_kg": mass_of_sphere(case),
        "effective_modulus_Pa": pair.effective_modulus,
        "equation": law.equation,
        "first_impact": {
            "approach_speed_m_s": speed,
            "restitution_asked": restitution.asked,
            "restitution_achieved": restitution.achieved,
            "restitution_to_ask": restitution.to_ask,
        },
        "without_losses": {"max_indentation_m": expected.depth, "max_force_N": expected.force},
        "meshes": _meshes(case),
        "costs": describe_costs(case),
        "doubts": doubts(resolved, expected, aside),
        "case": resolved,
    }


def _meshes(case: Case) -> dict[str, Any]:
    if not elastic_names(case):
        return {}
    from vibroimpact.modes.document import mesh_facts  # here, as it imports scipy.sparse

    return mesh_facts(case)
