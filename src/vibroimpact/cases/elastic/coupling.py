"""Coupling of elastic bodies to the contact law: the three treatments of local compliance.

`consistent` counts each part of the deformation once: the static compliance that the retained modes
of the plate lack is put in series with the law, and that of the modes of the sphere, which the law
contains, is subtracted. `superposed` puts modes and law in series as they are. `identified` treats
the plate as `consistent` does, and represents the sphere by a spring and a dashpot in series with
the law.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_sphere
from vibroimpact.cases.elastic.modes import BodyModes, compute_modes, contact_place
from vibroimpact.cases.elastic.residuals import residual_keys, with_residuals
from vibroimpact.cases.fields.local import MeasuredImpact
from vibroimpact.cases.pair import contact_pair, is_free_sphere
from vibroimpact.cases.rigid_problem import PLATE_FALLS, contact_laws_of, elastic_names, touch_speed
from vibroimpact.cases.validity.plate_mesh import PLATE_MESH_COMPLIANCE
from vibroimpact.cases.validity.plate_waves import PLATE_THEORY_INERTIA
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.local_element import identify_local_element, local_element_deviations
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.mesh_compliance import mesh_compliance, mesh_compliance_key
from vibroimpact.structures.modal_model import ModalBasis, ModalModel
from vibroimpact.structures.plate_face import face_shapes
from vibroimpact.structures.plate_waves import inertia_beyond_bending
from vibroimpact.structures.recipe import is_thin, model_key
from vibroimpact.structures.sphere_compliance import FITTED, sphere_term
from vibroimpact.structures.static_compliance import (
    compliance_key,
    static_compliance,
    stored_compliance,
)
from vibroimpact.structures.store import carry
from vibroimpact.structures.surface import place_of

if TYPE_CHECKING:
    from vibroimpact.cases.schema import CaseTable

# least part of the contact's own compliance that must remain after the modal compliance is
# subtracted
_LEAST_SLOPE = 0.25


@dataclass(frozen=True)
class Coupling:
    """Elastic bodies as the simulation needs them, and a record of how they are modelled.

    Parameters
    ----------
    modes : mapping of str to ModalBasis
        Modal basis by the name of the body.
    rigid : ModalBasis or None
        Rigid-body modes of a plate that its supports leave free to move vertically, or of a free
        sphere that replaces it.
    quasi_static : QuasiStatic
        Compliance in series with the contact law.
    facts : mapping of str to float or str
        Record of the treatment and its values; names end in their units.
    models : mapping of str to ModalModel
        Modes on their meshes by the name of the body.
    """

    modes: Mapping[str, ModalBasis]
    rigid: ModalBasis | None
    quasi_static: QuasiStatic
    facts: Mapping[str, float | str]
    models: Mapping[str, ModalModel]


def treatment_of(case: CaseTable) -> str:
    """Return the treatment of local compliance of a case."""
    return case.contact.local.local_compliance or "consistent"


def coupling_of(
    case: CaseTable,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Coupling:
    """Return the coupling of the bodies of a case; modes and compliances are computed, or read from
    the mode store.

    Raises
    ------
    InputError
        If a body can't be made, the plate is not held under gravity, or the modes leave too little
        compliance to the contact.
    """
    treatment = treatment_of(case)
    bodies = compute_modes(case, progress, tell) if elastic_names(case) else {}
    modes = {name: body.basis for name, body in bodies.items()}
    facts: dict[str, float | str] = (
        {"treatment": treatment} if bodies or treatment == "identified" else {}
    )
    if told := [doubt for body in bodies.values() for doubt in body.doubts]:
        facts["doubts"] = "\n".join(told)
    linear, finite, rigid = 0.0, QuasiStatic(), None
    if "plate" in bodies:
        if not bodies["plate"].model.is_held_vertically and case.drop.gravity:
            raise InputError(PLATE_FALLS, "plate.supports")
        modes["plate"], rigid, beyond = _plate_motions(bodies["plate"], treatment)
        if beyond:
            facts[PLATE_THEORY_INERTIA] = beyond
        carried = _compliance(modes["plate"])
        facts["plate_modal_compliance_m_N"] = carried
        if treatment != "superposed":
            # what the truncated modes lack of it is put in series
            static = _plate_compliance(bodies["plate"], tell)
            facts["plate_static_compliance_m_N"] = static
            linear += static - carried
            if bodies["plate"].model.mesh.is_flat:
                facts[PLATE_MESH_COMPLIANCE] = _lacking_compliance(bodies["plate"], tell)
            modes["plate"] = with_residuals(bodies["plate"], modes["plate"], tell)
    if is_free_sphere(case):
        rigid = _free_sphere(case)
    if case.contact.local.finite_sphere or ("sphere" in bodies and treatment == "consistent"):
        patch = min(_contact_radius(case), FITTED[1] * case.sphere.radius)
        finite, facts["finite_sphere_factor"] = _finite_size(case, patch)
        if "sphere" in bodies:
            # the law already contains the quasi-static compliance of the sphere, so that of the
            # modes is subtracted
            modes["sphere"] = _averaged_over_patch(bodies["sphere"], patch)
            linear -= _compliance(modes["sphere"])
            facts["contact_patch_m"] = patch
    if "sphere" in bodies:
        facts["sphere_modal_compliance_m_N"] = _compliance(modes["sphere"])
    series = replace(finite, linear=linear)
    if linear:
        facts["series_compliance_m_N"] = linear
    if series:
        _check_well_posed(case, series, facts)
    return Coupling(
        modes, rigid, series, facts, {name: body.model for name, body in bodies.items()}
    )


def _plate_motions(body: BodyModes, treatment: str) -> tuple[ModalBasis, ModalBasis | None, float]:
    """Return modes and rigid motions of a plate at its contact point, and the inertia that plate
    theory lacks [m s^2/N].

    The treatment "superposed" reproduces multibody programs: contact at a node, without
    corrections.
    """
    rigid = None if body.model.is_held_vertically else body.body.rigid_motions(body.model)
    modes, beyond = (body.basis, 0.0) if treatment == "superposed" else _basis_at_face(body)
    return modes, rigid, beyond


def _free_sphere(case: CaseTable) -> ModalBasis:
    """Return the rigid-body mode of a free sphere below: translation along the line of
    impact, which passes through its centre.
    """
    assert case.plate.radius is not None  # the caller has checked it
    mass = float(rigid_sphere(case.plate.radius, case.plate.material).mass)
    along, up = np.zeros(1), np.array([[0.0, 0.0, math.sqrt(mass)]])
    return ModalBasis(
        along, along, np.array([mass**-0.5]), up, mass=mass, rotation=np.zeros((1, 3))
    )


def carried_modes(
    case: CaseTable,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> dict[str, bytes]:
    """Return the entries of the mode store that a case needs, for a process that does not share the
    file system.

    That process passes them to `vibroimpact.structures.store.receive`. Entries that are missing are
    computed.

    Raises
    ------
    InputError
        As `coupling_of`.
    """
    keys: list[str] = []
    for name, body in (compute_modes(case, progress, tell) if elastic_names(case) else {}).items():
        keys.append(model_key(body.body.recipe))
        if name == "plate" and treatment_of(case) != "superposed":
            _plate_compliance(body, tell)
            keys.append(compliance_key(body.body.recipe, *contact_place(body)))
            if body.model.mesh.is_flat:
                _lacking_compliance(body, tell)
                keys.append(mesh_compliance_key(body.body.recipe, contact_place(body)[0]))
            if body.body.sensors:
                with_residuals(body, body.basis, tell)
                keys += residual_keys(body)
    return carry(keys)


def _compliance(basis: ModalBasis) -> float:
    """Return the static compliance of modes at their contact point [m/N]."""
    return float(((basis.contact / basis.angular_frequencies) ** 2).sum())


def _plate_compliance(body: BodyModes, tell: Callable[[str], None] | None) -> float:
    """Return the static compliance of a plate at the contact point, with all its modes [m/N]."""
    return static_compliance(body.body.recipe, *contact_place(body), tell)


def _lacking_compliance(body: BodyModes, tell: Callable[[str], None] | None) -> float:
    """Return the compliance that the plate elements lack at the contact point [m/N]."""
    recipe, model, place = body.body.recipe, body.model, contact_place(body)[0]

    def computed() -> float:
        material = Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)
        return mesh_compliance(model.mesh, material, model.thickness, place, is_thin(recipe))

    return stored_compliance(mesh_compliance_key(recipe, place), computed, tell)


def _finite_size(case: CaseTable, patch: float) -> tuple[QuasiStatic, float]:
    """Return the compliance correction of a sphere of finite size relative to a half
    space, and its factor at a contact radius [m].
    """
    ratio, radius = case.sphere.material.poissons_ratio, case.sphere.radius
    term, force = sphere_term(ratio), 4.0 / 3.0 * contact_pair(case).effective_modulus * radius**2
    if not math.isfinite(force):
        raise InputError("the finite size of a sphere needs its modulus", "sphere.material")
    factors = (term.constant, term.logarithm, term.linear, term.square)
    unit = 1.0 / (case.sphere.material.youngs_modulus * radius)
    return QuasiStatic(0.0, unit, factors, force), float(term.factor(patch / radius))


def _averaged_over_patch(body: BodyModes, radius: float) -> ModalBasis:
    """Return the modes of a sphere with the contact displacement averaged over the contact patch.

    The compliance at a point does not converge with the number of modes.
    """
    place, side = contact_place(body)
    shapes = body.model.averaged(place, radius, side, "the contact patch")
    return replace(body.basis, contact=shapes[:, 2])


def _basis_at_face(body: BodyModes) -> tuple[ModalBasis, float]:
    """Return the modes of a plate at its face, at the contact point and the sensors, and the
    inertia that plate theory lacks [m s^2/N].

    The modes of solid elements, and of thin plate theory, in which all points of a normal move
    alike, are returned unchanged.
    """
    recipe = body.body.recipe
    if not body.model.mesh.is_flat or is_thin(recipe):
        return body.basis, 0.0
    material = Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)

    def at_face(place: tuple[float, float], deflection: Floats) -> Floats:
        return face_shapes(body.model, material, place, deflection)

    points = dict(body.basis.points)
    for name, spot in body.body.watched.items():
        at = at_face(place_of(body.model.mesh, *spot), points[name][:, 2])
        points[name] = np.column_stack([points[name][:, :2], at])
    contact = at_face(contact_place(body)[0], body.basis.contact)
    return replace(body.basis, contact=contact, points=points), inertia_beyond_bending(
        body.model.thickness, material
    )


def _first_contact(case: CaseTable) -> tuple[CompliantLaw, float]:
    """Return the law of the first impact, and its largest indentation without damping
    between rigid bodies [m].
    """
    law = contact_laws_of(case)[0]
    if not isinstance(law, CompliantLaw):
        raise InputError(
            f"{law.name} gives no force, and bodies that deform need one; take another law",
            "contact.law",
        )
    mass, gravity, speed = (
        np.array([value])
        for value in (contact_pair(case).effective_mass, case.drop.gravity, touch_speed(case))
    )
    with interpreted():
        return law, float(impact_conditions_of(law, mass, gravity, speed).depth[0])


def _contact_radius(case: CaseTable) -> float:
    """Return Hertz's contact radius at the largest indentation of the first impact [m]."""
    return math.sqrt(case.sphere.radius * _first_contact(case)[1])


def _check_well_posed(
    case: CaseTable, series: QuasiStatic, facts: Mapping[str, float | str]
) -> None:
    """Check that enough compliance of the contact remains after that of the modes is subtracted, up
    to the largest indentation.

    Raises
    ------
    InputError
        If not; the message gives the cause and a remedy.
    """
    law, depth = _first_contact(case)
    local = LocalContact(law, series, touch_speed(case))
    delta = np.linspace(0.0, 1.2 * depth, 200)[1:]
    slopes = np.gradient(local.approach_at(delta), delta)
    if slopes.min() >= _LEAST_SLOPE:
        return
    place = float(delta[slopes < _LEAST_SLOPE][0])
    leaves = (
        f"leaves less than {_LEAST_SLOPE:g} of the law's own compliance from an "
        f"indentation of {place:.2g} m on, so that the force would not be unique"
    )
    taken = facts.get("sphere_modal_compliance_m_N")
    # only the correction of a rigid sphere takes from the compliance, that of a half space of its
    # material
    if taken is None:
        words = "the correction of Hertz's half space for the finite size of the sphere"
        raise InputError(
            f"{words} {leaves}: the law is much stiffer than Hertz's contact; leave this "
            "out, or take a lower stiffness",
            "contact.finite_sphere",
        )
    words = (
        f"the modes of the sphere carry {taken:.3g} m/N of its quasi-static compliance, and "
        f"taking that out of the contact {leaves}"
    )
    sphere = case.sphere
    remedy, key = "keep fewer modes", "modes" if sphere.max_frequency is None else "max_frequency"
    if sphere.attachment_mode:
        remedy, key = "leave this out", "attachment_mode"
    elif sphere.reduction == "craig-bampton":
        remedy, key = 'take "modal"', "reduction"
    raise InputError(
        f'{words}; {remedy}, or take contact.local_compliance = "superposed"', f"sphere.{key}"
    )


def _rebound(case: CaseTable, measured: MeasuredImpact) -> dict[str, float]:
    """Return the measured rebound as a keyword argument of `identify_local_element`."""
    if measured.separation_speed is not None:
        return {"separation_speed": measured.separation_speed}
    if measured.restitution is not None:
        return {"separation_speed": measured.restitution * touch_speed(case)}
    height = measured.rebound_height or 0.0
    if height <= case.sphere.radius:
        words = (
            f"{height:g} m is no rebound: it is the height of the centre, which rests at "
            f"{case.sphere.radius:g} m"
        )
        raise InputError(words, "contact.measured.rebound_height")
    return {"rebound_height": height}


def couple_bodies(
    case: CaseTable,
    problem: Problem,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Problem:
    """Return the problem of a case with its elastic bodies and its local element, made from the
    problem with rigid bodies.

    Raises
    ------
    InputError
        As `coupling_of`; and if no local element fits the measurement.
    """
    coupling = coupling_of(case, progress, tell)
    bodies = {
        name: replace(getattr(problem, name), modes=basis) for name, basis in coupling.modes.items()
    }
    if coupling.rigid is not None:
        bodies["plate"] = replace(bodies.get("plate", problem.plate), rigid=coupling.rigid)
    found = replace(
        problem,
        **bodies,
        sphere_inside=treatment_of(case) == "consistent",
        quasi_static=coupling.quasi_static,
        facts=coupling.facts,
        models=coupling.models,
    )
    if problem.oblique is not None and "plate" in coupling.modes:
        found = replace(
            found,
            at_place=partial(at_place, case, found),
            plate_at_place=partial(plate_at_place, case, found),
        )
    local = case.contact.local
    if local.local_compliance != "identified":
        return found
    if local.measured is None:
        assert local.local_stiffness is not None  # validated by the section
        assert local.local_damping is not None
        given = (local.local_stiffness, local.local_damping)
        facts = {**coupling.facts, "local_stiffness_N_m": given[0], "local_damping_N_s_m": given[1]}
        return replace(found, local_element=given, facts=facts)
    element, facts = _identified(
        case,
        local.measured,
        # measured on a plate at rest
        replace(problem if local.measured.plate == "rigid" else found, motion=None),
    )
    return replace(found, local_element=element, facts={**coupling.facts, **facts})


def at_place(case: CaseTable, problem: Problem, place: tuple[float, float]) -> Problem:
    """Return the problem of a case with the contact at another place of its plate [m].

    Raises
    ------
    InputError
        If too little compliance is left to the contact there.
    """
    moved = _with_contact_at(case, place)
    body = compute_modes(moved)["plate"]
    treatment = treatment_of(case)
    modes, rigid, _ = _plate_motions(body, treatment)
    linear = 0.0
    facts: dict[str, float | str] = {}
    if treatment != "superposed":
        linear = _plate_compliance(body, None) - _compliance(modes)
        modes = with_residuals(body, modes, None)
    if problem.sphere.modes is not None:
        facts["sphere_modal_compliance_m_N"] = _compliance(problem.sphere.modes)
        if treatment == "consistent":
            linear -= _compliance(problem.sphere.modes)
    series = replace(problem.quasi_static, linear=linear)
    if series:
        _check_well_posed(moved, series, facts)
    return problem.on_plate(replace(problem.plate, modes=modes, rigid=rigid), series)


def plate_at_place(case: CaseTable, problem: Problem, place: tuple[float, float]) -> Body:
    """Return the plate of a case with the contact at another place [m], for its motion:
    without residual compliances to sensors.
    """
    body = compute_modes(_with_contact_at(case, place))["plate"]
    modes, rigid, _ = _plate_motions(body, treatment_of(case))
    return replace(problem.plate, modes=modes, rigid=rigid)


def _with_contact_at(case: CaseTable, place: tuple[float, float]) -> CaseTable:
    return case.model_copy(update={"drop": case.drop.model_copy(update={"position": place})})


def _identified(
    case: CaseTable, measured: MeasuredImpact, problem: Problem
) -> tuple[tuple[float, float], dict[str, float | str]]:
    """Return the local element identified from the measurement, and its facts: stiffness
    and damping, with deviations if known.
    """
    try:
        element = identify_local_element(problem, measured.max_force, **_rebound(case, measured))
    except InputError as error:
        raise InputError(error.message, error.key or "contact.measured") from None
    facts: dict[str, float | str] = {
        "local_stiffness_N_m": element[0],
        "local_damping_N_s_m": element[1],
    }
    if measured.relative_deviation is not None:
        speed = float(
            simulate(replace(problem, impacts=1, duration=None, local_element=element)).impacts[
                "separation_speed_m_s"
            ][0]
        )
        part = measured.relative_deviation
        height = measured.rebound_height
        of_speed = part * speed if height is None else part * height * case.drop.gravity / speed
        deviations = local_element_deviations(problem, element, part * measured.max_force, of_speed)
        facts |= {
            "local_stiffness_deviation_N_m": deviations[0],
            "local_damping_deviation_N_s_m": deviations[1],
        }
    return element, facts
