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
from vibroimpact.cases.rigid.pair import contact_pair, is_free_sphere
from vibroimpact.cases.rigid.rigid_problem import (
    PLATE_FALLS,
    contact_laws_of,
    elastic_names,
    touch_speed,
)
from vibroimpact.cases.validity.plate_mesh import PLATE_MESH_COMPLIANCE
from vibroimpact.cases.validity.plate_waves import PLATE_THEORY_INERTIA
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.local_element import identify_local_element, local_element_deviations
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.report.result_warning import effect_of
from vibroimpact.structures.finite_elements.surface import place_of
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

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable

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
    """Return the coupling of the bodies of a case.

    Modes and compliances are computed, or read from the mode store.

    Raises
    ------
    InputError
        If a body can't be made, the plate is not held under gravity, or the modes leave too little
        compliance to the contact.
    """
    treatment = treatment_of(case)
    bodies: Mapping[str, BodyModes] = {}
    if elastic_names(case):
        bodies = compute_modes(case, progress, tell)
    modes = {name: body.basis for name, body in bodies.items()}
    facts: dict[str, float | str] = {}
    if bodies or treatment == "identified":
        facts["treatment"] = treatment
    doubts = [doubt for body in bodies.values() for doubt in body.doubts]
    if doubts:
        facts["doubts"] = "\n".join(doubts)
        facts["doubt_effects"] = "\n".join(f"{effect_of(doubt):.3g}" for doubt in doubts)
    linear = 0.0  # compliance in series
    finite_sphere = QuasiStatic()
    rigid: ModalBasis | None = None
    if "plate" in bodies:
        if not bodies["plate"].model.is_held_vertically and case.drop.gravity:
            raise InputError(PLATE_FALLS, "plate.supports")
        modes["plate"], rigid, inertia = _plate_motions(bodies["plate"], treatment)
        if inertia:
            facts[PLATE_THEORY_INERTIA] = inertia
        modal_compliance = _compliance(modes["plate"])
        facts["plate_modal_compliance_m_N"] = modal_compliance
        if treatment != "superposed":
            # what the truncated modes lack of it is put in series
            plate_compliance = _plate_compliance(bodies["plate"], tell)
            facts["plate_static_compliance_m_N"] = plate_compliance
            linear += plate_compliance - modal_compliance
            if bodies["plate"].model.mesh.is_flat:
                facts[PLATE_MESH_COMPLIANCE] = _lacking_compliance(bodies["plate"], tell)
            modes["plate"] = with_residuals(bodies["plate"], modes["plate"], tell)
    if is_free_sphere(case):
        rigid = _free_sphere(case)
    if case.contact.local.finite_sphere or ("sphere" in bodies and treatment == "consistent"):
        patch_radius = min(_contact_radius(case), FITTED[1] * case.sphere.radius)
        finite_sphere, facts["finite_sphere_factor"] = _finite_size(case, patch_radius)
        if "sphere" in bodies:
            # the law already contains the quasi-static compliance of the sphere, so that of the
            # modes is subtracted
            modes["sphere"] = _averaged_over_patch(bodies["sphere"], patch_radius)
            linear -= _compliance(modes["sphere"])
            facts["contact_patch_m"] = patch_radius
    if "sphere" in bodies:
        facts["sphere_modal_compliance_m_N"] = _compliance(modes["sphere"])
    quasi_static = replace(finite_sphere, linear=linear)
    if linear:
        facts["series_compliance_m_N"] = linear
    if quasi_static:
        _check_well_posed(case, quasi_static, facts)
    models = {name: body.model for name, body in bodies.items()}
    return Coupling(modes, rigid, quasi_static, facts, models)


def _plate_motions(body: BodyModes, treatment: str) -> tuple[ModalBasis, ModalBasis | None, float]:
    """Return modes and rigid motions of a plate, and the inertia that plate theory lacks.

    The modes are those at its contact point; the inertia is in m s^2/N.

    The treatment "superposed" reproduces multibody programs: contact at a node, without
    corrections.
    """
    rigid = None
    if not body.model.is_held_vertically:
        rigid = body.body.rigid_motions(body.model)
    if treatment == "superposed":
        return body.basis, rigid, 0.0
    modes, inertia = _basis_at_face(body)
    return modes, rigid, inertia


def _free_sphere(case: CaseTable) -> ModalBasis:
    """Return the rigid-body mode of a free sphere below.

    It is the translation along the line of impact, which passes through its centre.
    """
    assert case.plate.radius is not None  # the caller has checked it
    mass = float(rigid_sphere(case.plate.radius, case.plate.material).mass)
    zero = np.zeros(1)  # frequency and damping ratio
    momentum = np.array([[0.0, 0.0, math.sqrt(mass)]])
    return ModalBasis(
        zero, zero, np.array([mass**-0.5]), momentum, mass=mass, rotation=np.zeros((1, 3))
    )


def carried_modes(
    case: CaseTable,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> dict[str, bytes]:
    """Return the entries of the mode store that a case needs.

    They are for a process that does not share the file system.

    That process passes them to `vibroimpact.structures.store.receive`. Entries that are missing are
    computed.

    Raises
    ------
    InputError
        As `coupling_of`.
    """
    if not elastic_names(case):
        return carry([])
    keys: list[str] = []
    for name, body in compute_modes(case, progress, tell).items():
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
    recipe = body.body.recipe
    model = body.model
    place, _ = contact_place(body)

    def computed() -> float:
        material = Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)
        return mesh_compliance(model.mesh, material, model.thickness, place, is_thin(recipe))

    return stored_compliance(mesh_compliance_key(recipe, place), computed, tell)


def _finite_size(case: CaseTable, patch_radius: float) -> tuple[QuasiStatic, float]:
    """Return the correction of the compliance for a sphere of finite size, and its factor.

    It is relative to a half space; the factor is that at a contact radius [m].
    """
    material = case.sphere.material
    radius = case.sphere.radius
    term = sphere_term(material.poissons_ratio)
    # at which Hertz's contact radius would be that of the sphere
    force = 4.0 / 3.0 * contact_pair(case).effective_modulus * radius**2
    if not math.isfinite(force):
        raise InputError("the finite size of a sphere needs its modulus", "sphere.material")
    factors = (term.constant, term.logarithm, term.linear, term.square)
    unit = 1.0 / (material.youngs_modulus * radius)
    return QuasiStatic(0.0, unit, factors, force), float(term.factor(patch_radius / radius))


def _averaged_over_patch(body: BodyModes, radius: float) -> ModalBasis:
    """Return the modes of a sphere with the contact displacement averaged over the contact patch.

    The compliance at a point does not converge with the number of modes.
    """
    place, side = contact_place(body)
    shapes = body.model.averaged(place, radius, side, "the contact patch")
    return replace(body.basis, contact=shapes[:, 2])


def _basis_at_face(body: BodyModes) -> tuple[ModalBasis, float]:
    """Return the modes of a plate at its face, and the inertia that plate theory lacks.

    They are those at the contact point and the sensors; the inertia is in m s^2/N.

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
        normal = at_face(place_of(body.model.mesh, *spot), points[name][:, 2])
        points[name] = np.column_stack([points[name][:, :2], normal])
    contact = at_face(contact_place(body)[0], body.basis.contact)
    modes = replace(body.basis, contact=contact, points=points)
    return modes, inertia_beyond_bending(body.model.thickness, material)


def _first_contact(case: CaseTable) -> tuple[CompliantLaw, float]:
    """Return the law of the first impact, and its largest indentation [m].

    The latter is without damping, between rigid bodies.
    """
    law = contact_laws_of(case)[0]
    if not isinstance(law, CompliantLaw):
        raise InputError(
            f"{law.name} gives no force, and bodies that deform need one; take another law",
            "contact.law",
        )
    mass = np.array([contact_pair(case).effective_mass])
    gravity = np.array([case.drop.gravity])
    speed = np.array([touch_speed(case)])
    with interpreted():
        conditions = impact_conditions_of(law, mass, gravity, speed)
        return law, float(conditions.depth[0])


def _contact_radius(case: CaseTable) -> float:
    """Return Hertz's contact radius at the largest indentation of the first impact [m]."""
    return math.sqrt(case.sphere.radius * _first_contact(case)[1])


def _check_well_posed(
    case: CaseTable, series: QuasiStatic, facts: Mapping[str, float | str]
) -> None:
    """Check that enough compliance of the contact remains, up to the largest indentation.

    That of the modes is subtracted from it.

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
    indentation = float(delta[slopes < _LEAST_SLOPE][0])
    leaves = (
        f"leaves less than {_LEAST_SLOPE:g} of the law's own compliance from an "
        f"indentation of {indentation:.2g} m on, so that the force would not be unique"
    )
    subtracted = facts.get("sphere_modal_compliance_m_N")
    # only the correction of a rigid sphere takes from the compliance, that of a half space of its
    # material
    if subtracted is None:
        raise InputError(
            "the correction of Hertz's half space for the finite size of the sphere "
            f"{leaves}: the law is much stiffer than Hertz's contact; leave this "
            "out, or take a lower stiffness",
            "contact.finite_sphere",
        )
    sphere = case.sphere
    if sphere.attachment_mode:
        remedy = "leave this out"
        key = "attachment_mode"
    elif sphere.reduction == "craig-bampton":
        remedy = 'take "modal"'
        key = "reduction"
    else:
        remedy = "keep fewer modes"
        key = "modes" if sphere.max_frequency is None else "max_frequency"
    raise InputError(
        f"the modes of the sphere carry {subtracted:.3g} m/N of its quasi-static compliance, and "
        f"taking that out of the contact {leaves}; {remedy}, or take "
        'contact.local_compliance = "superposed"',
        f"sphere.{key}",
    )


def _rebound(case: CaseTable, measured: MeasuredImpact) -> dict[str, float]:
    """Return the measured rebound as a keyword argument of `identify_local_element`."""
    if measured.separation_speed is not None:
        return {"separation_speed": measured.separation_speed}
    if measured.restitution is not None:
        return {"separation_speed": measured.restitution * touch_speed(case)}
    height = measured.rebound_height or 0.0
    if height <= case.sphere.radius:
        raise InputError(
            f"{height:g} m is no rebound: it is the height of the centre, which rests at "
            f"{case.sphere.radius:g} m",
            "contact.measured.rebound_height",
        )
    return {"rebound_height": height}


def couple_bodies(
    case: CaseTable,
    problem: Problem,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Problem:
    """Return the problem of a case with its elastic bodies and its local element.

    It is made from the problem with rigid bodies.

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
    coupled = replace(
        problem,
        **bodies,
        sphere_inside=treatment_of(case) == "consistent",
        quasi_static=coupling.quasi_static,
        facts=coupling.facts,
        models=coupling.models,
    )
    if problem.oblique is not None and "plate" in coupling.modes:
        coupled = replace(
            coupled,
            at_place=partial(at_place, case, coupled),
            plate_at_place=partial(plate_at_place, case, coupled),
        )
    local = case.contact.local
    if local.local_compliance != "identified":
        return coupled
    if local.measured is None:
        assert local.local_stiffness is not None  # validated by the section
        assert local.local_damping is not None
        element = (local.local_stiffness, local.local_damping)
        element_facts = _element_facts(element)
    else:
        tested = problem if local.measured.plate == "rigid" else coupled
        # measured on a plate at rest
        tested = replace(tested, motion=None)
        element, element_facts = _identified(case, local.measured, tested)
    return replace(coupled, local_element=element, facts={**coupling.facts, **element_facts})


def _element_facts(element: tuple[float, float]) -> dict[str, float | str]:
    """Return the facts of a local element of a stiffness and a damping."""
    return {"local_stiffness_N_m": element[0], "local_damping_N_s_m": element[1]}


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
    """Return the plate of a case with the contact at another place [m], for its motion.

    It is without residual compliances to sensors.
    """
    body = compute_modes(_with_contact_at(case, place))["plate"]
    modes, rigid, _ = _plate_motions(body, treatment_of(case))
    return replace(problem.plate, modes=modes, rigid=rigid)


def _with_contact_at(case: CaseTable, place: tuple[float, float]) -> CaseTable:
    return case.model_copy(update={"drop": case.drop.model_copy(update={"position": place})})


def _identified(
    case: CaseTable, measured: MeasuredImpact, problem: Problem
) -> tuple[tuple[float, float], dict[str, float | str]]:
    """Return the local element identified from the measurement, and its facts.

    These are stiffness and damping, with deviations if known.
    """
    try:
        element = identify_local_element(problem, measured.max_force, **_rebound(case, measured))
    except InputError as error:
        raise InputError(error.message, error.key or "contact.measured") from None
    facts = _element_facts(element)
    relative_deviation = measured.relative_deviation
    if relative_deviation is None:
        return element, facts
    impact = simulate(replace(problem, impacts=1, duration=None, local_element=element)).impacts
    speed = float(impact["separation_speed_m_s"][0])
    if measured.rebound_height is None:
        speed_deviation = relative_deviation * speed
    else:  # v^2 = 2 g h, so that dv = g dh / v
        speed_deviation = relative_deviation * measured.rebound_height * case.drop.gravity / speed
    force_deviation = relative_deviation * measured.max_force
    deviations = local_element_deviations(problem, element, force_deviation, speed_deviation)
    facts |= {
        "local_stiffness_deviation_N_m": deviations[0],
        "local_damping_deviation_N_s_m": deviations[1],
    }
    return element, facts
