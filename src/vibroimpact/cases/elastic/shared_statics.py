"""Statics of a plate at the contact points of several cases, solved together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import TYPE_CHECKING

from vibroimpact.cases.elastic.coupling import treatment_of
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.elastic.residuals import hold_residuals
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.structures.finite_elements.surface import place_of
from vibroimpact.structures.recipe import modal_model_of, plate_key
from vibroimpact.structures.static_compliance import hold_compliances

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable


def solve_together(cases: Iterable[CaseTable]) -> None:
    """Solve the statics of plates at the contact points of cases together.

    This is for cases of which several share a plate and its sensors.

    Their problems then take them from memory. A case that can't be solved is left to be refused by
    itself.
    """
    groups = defaultdict(list)
    for case in cases:
        if case.plate.model == "elastic" and treatment_of(case) != "superposed":
            body = elastic_bodies(case)["plate"]
            groups[plate_key(body.recipe), repr(body.watched)].append(body)
    for bodies in groups.values():
        recipe = bodies[0].recipe
        side = bodies[0].side
        try:
            mesh = modal_model_of(recipe).mesh
            places = list({place_of(mesh, body.contact, body.side): None for body in bodies})
            if len(places) > 1:
                hold_compliances(recipe, places, side)
                hold_residuals(bodies[0], mesh, places)
        except (InputError, ComputationError):
            continue
