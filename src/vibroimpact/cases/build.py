"""The problem that a case describes, and the resolved case.

There are checks across sections, conversion to `Problem`, and back to a table.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Literal, cast

from vibroimpact.calibration.observed.section import calibrate_table
from vibroimpact.cases.elastic.positions import check_positions
from vibroimpact.cases.fields.elastic_body import ELASTIC_KEYS, BroughtMeshTable
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.fields.material import material_table
from vibroimpact.cases.rigid.oblique import friction_law_of, oblique_keys
from vibroimpact.cases.rigid.pair import is_free_sphere, sphere_density
from vibroimpact.cases.rigid.plate_motion import motion_length
from vibroimpact.cases.rigid.rigid_problem import (
    PLATE_FALLS,
    by_speed_of,
    contact_laws_of,
    deforms,
    elastic_names,
    rigid_problem,
)
from vibroimpact.cases.rigid.run_ends import ends_of_run, impact_limit
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw, ContactLaw, is_conservative
from vibroimpact.contact.speed_function import held
from vibroimpact.dynamics.fluids.air import check_thin
from vibroimpact.dynamics.fluids.liquid import check_sinks
from vibroimpact.dynamics.sensors.instruments.instrument import SUBJECTS_AT_REST
from vibroimpact.dynamics.sensors.instruments.registry import instruments
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.resolved_case import ResolvedCase

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable, PlateSection, SphereSection


_BALL_FALLS = (
    "under gravity a sphere that is free falls away from under the other; hold it, or give "
    "drop.gravity = 0 and drop.speed or drop.velocity"
)


def check_case(case: CaseTable) -> None:
    """Check the sections of a case against each other, without computing modes.

    Raises
    ------
    InputError
        If the contact law or an elastic body can't be made, the run would not end, keys contradict
        each other, or a sensor or a support lies outside the plate.
    """
    law = contact_laws_of(case)[-1]
    # without a rule only losses in the contact end a run
    if not ends_of_run(case):
        _check_losses(case, law)
    _check_oblique(case, law)
    _check_liquid(case, law)
    if case.drop.air is not None:
        check_thin(case.drop.air.density, sphere_density(case.sphere), "drop.air.density")
    _check_motion(case)
    _check_sensors(case)
    _check_local(case, law)
    check_positions(case)
    if elastic_names(case):
        from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies  # imports scipy.sparse

        elastic_bodies(case)


def _check_losses(case: CaseTable, law: ContactLaw) -> None:
    """Check that a law loses energy until the sphere is at rest.

    Raises
    ------
    InputError
        If not; then the run would not end.
    """
    demand = '"all" needs a law that loses energy'
    remedy = "give a number, or run.duration"
    # what a function of the approach speed is for the slowest impacts, the last ones
    slowest = {key: held(function, 0.0) for key, function in by_speed_of(case).items()}
    if is_conservative(law.changed(slowest)):
        of_which = " of slow impacts" if slowest else ""
        raise InputError(
            f"{demand}, and this {law.name} loses none{of_which}; {remedy}", "run.impacts"
        )
    if (
        isinstance(law, CompliantLaw)
        and law.lasting
        and case.drop.same_spot
        and is_conservative(law.after_compression(1.0))
    ):
        raise InputError(
            f"{demand}, and {law.name} loses none on a dent that it has made; {remedy}, or "
            "drop.same_spot = false",
            "run.impacts",
        )


def _check_sensors(case: CaseTable) -> None:
    """Check that sensors have a plate that moves, and of a kind that their instruments take.

    Raises
    ------
    InputError
        If not.
    """
    if not case.sensors:
        return
    if case.plate.model == "rigid" and case.plate.motion is None:
        if case.plate.radius is not None:
            raise InputError(
                "sensors are on a plate, and a sphere takes its place; leave out the "
                "sensors, or plate.radius",
                "sensors",
            )
        may_be_shaken = not any(sensor.subject in SUBJECTS_AT_REST for sensor in case.sensors)
        motion = " or motion" if may_be_shaken else ""
        raise InputError(
            "the plate is rigid and at rest, so that its points do not move; "
            f'give it model = "elastic"{motion}, or leave out the sensors',
            "sensors",
        )
    if case.plate.motion is None:
        return
    for number, sensor in enumerate(case.sensors):
        if sensor.instrument is not None and sensor.subject in SUBJECTS_AT_REST:
            names = [{"name": sensor.name} for sensor in case.sensors]
            noun = instruments()[sensor.instrument].noun
            raise InputError(
                f"{noun} is for plates whose supports are at rest; "
                "leave out the sensor, or the motion",
                f"{item_label('sensors', names, number)}.instrument",
            )


def _check_local(case: CaseTable, law: ContactLaw) -> None:
    """Check the treatment of local compliance against the model of the sphere and the law.

    Raises
    ------
    InputError
        If it does not go with them.
    """
    local = case.contact.local
    if local.local_compliance == "identified" and case.sphere.model == "elastic":
        raise InputError(
            'the local element of "identified" stands for the deformation of the sphere; '
            'leave it "rigid"',
            "sphere.model",
        )
    if not local.finite_sphere:
        return
    if case.sphere.model == "elastic":
        raise InputError(
            "this is for a rigid sphere: an elastic sphere deforms in its modes, and "
            'local_compliance = "consistent" corrects the rest; leave this out',
            "contact.finite_sphere",
        )
    if not isinstance(law, CompliantLaw):
        raise InputError(
            f"{law.name} gives no force that a finite sphere would change; leave this out",
            "contact.finite_sphere",
        )


def _check_oblique(case: CaseTable, law: ContactLaw) -> None:
    """Check a drop that is not along the normal alone.

    Raises
    ------
    InputError
        If a sphere takes the place of the plate, the mesh of a plate is brought along, or the
        friction law does not go with the contact law or with bodies that deform.
    """
    keys = oblique_keys(case)
    if not keys:
        return
    if case.contact.local.finite_sphere:
        raise InputError(
            "this is for drops along the normal, without spin and friction; leave it out, or "
            f"{' and '.join(keys)}",
            "contact.finite_sphere",
        )
    if case.plate.radius is not None:
        raise InputError(
            "a sphere may fall obliquely, spin or rub on a flat plate only, not on another "
            "sphere; leave this out",
            keys[0],
        )
    if isinstance(case.plate.mesh, BroughtMeshTable):
        raise InputError(
            "an imported mesh does not define the edges of the plate, over which a sphere may "
            "fall; give size and leave out mesh, or leave this out",
            keys[0],
        )
    friction = friction_law_of(case)
    if friction is None:
        return
    is_shaken = case.plate.motion is not None and isinstance(law, CompliantLaw)
    if (deforms(case) or is_shaken) and not isinstance(friction, CompliantFriction):
        raise InputError(
            f"{friction.name} has no tangential compliance, which friction needs on bodies "
            'that deform or are shaken; take "mdr" or one of the "mindlin" laws',
            "contact.friction.law",
        )
    if isinstance(friction, CompliantFriction) and not isinstance(law, CompliantLaw):
        # bodies that deform take no friction by the impulse
        remedy = ""
        if not deforms(case):
            remedy = ', or friction by the impulse: "coulomb" or "rigid"'
        raise InputError(
            f"{law.name} gives no normal force, which {friction.name} follows; take another "
            f"contact law{remedy}",
            "contact.friction.law",
        )


def _check_liquid(case: CaseTable, law: ContactLaw) -> None:
    """Check that what is known of impacts in a liquid holds for a case.

    Raises
    ------
    InputError
        If the law takes no restitution, or the sphere falls on another one or through air, or
        floats.
    """
    if case.contact.local.liquid is None:
        return
    if law.free_parameter != "restitution":
        fault = "takes no restitution"
        remedy = 'take a law that does, such as "tsuji" or "flores"'
        if "restitution" in {item.name for item in fields(law)}:
            fault = "is given without a restitution"
            remedy = f"give contact.restitution in place of contact.{law.free_parameter}"
        raise InputError(
            f"{law.name} {fault}, of which a liquid leaves a part; {remedy}, or leave this out",
            "contact.liquid",
        )
    if case.plate.radius is not None:
        raise InputError(
            "what a liquid leaves of the restitution is known for a sphere that meets a "
            "plate; leave this out",
            "contact.liquid",
        )
    if case.drop.air is not None:
        raise InputError(
            "the sphere meets the plate in a liquid, and can't fall through air to it; "
            "leave one of them out",
            "drop.air",
        )
    if case.drop.gravity:
        check_sinks(
            case.contact.local.liquid.density, sphere_density(case.sphere), "contact.liquid.density"
        )


def _check_motion(case: CaseTable) -> None:
    """Check the motion of the plate's supports against the rest of a case.

    Raises
    ------
    InputError
        If the motion can't be read or reaches nothing, or the drop does not begin above the plate.
    """
    if case.plate.motion is None:
        return
    if case.plate.radius is not None or case.plate.supports == "free":
        raise InputError(
            "only a plate that supports hold moves with them; leave this out", "plate.motion"
        )
    length = motion_length(case)
    if case.run.duration is not None and case.run.duration > length:
        raise InputError(
            f"the motion of the plate ends at {length:.9g} s; stop the run by then", "run.duration"
        )
    try:
        rigid_problem(case)
    except InputError as error:
        raise InputError(error.message, error.key or "plate.motion") from None


def check_drop(case: CaseTable) -> None:
    """Check that no free plate is hit under gravity.

    The modes of such a plate may still be computed.

    Raises
    ------
    InputError
        If the plate is free and gravity is not zero.
    """
    if case.plate.supports == "free" and case.drop.gravity:
        fault = PLATE_FALLS if case.plate.radius is None else _BALL_FALLS
        raise InputError(fault, "plate.supports")


def problem_of(
    case: CaseTable,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Problem:
    """Return the problem that a case describes.

    Parameters
    ----------
    case : CaseTable
        The case.
    progress : callable, optional
        Called with the fraction done, 0 to 1, while modes of elastic bodies are computed.
    tell : callable, optional
        Called with a warning if the mode store is faulty.

    Raises
    ------
    InputError
        From `check_case` and `check_drop`; and if the elastic bodies are incompatible with the
        treatment of local compliance, or no local element fits the measurement.
    """
    check_case(case)
    check_drop(case)
    problem = replace(rigid_problem(case), source=resolved_case(case))
    if not deforms(case):
        return problem
    from vibroimpact.cases.elastic.coupling import couple_bodies  # imports the finite-element code

    return couple_bodies(case, problem, progress, tell)


def resolved_case(case: CaseTable) -> ResolvedCase:
    """Return a case as a table in SI with all defaults resolved, as in `case.toml`.

    Reading it gives the same case.
    """
    impacts = impact_limit(case)
    table = {
        "schema_version": case.schema_version,
        "name": case.name,
        "sphere": _body(case, "sphere"),
        "plate": _body(case, "plate"),
        "drop": _lists(case.drop.model_dump(exclude_none=True)),
        "contact": {
            **_law(case),
            **case.contact.local.model_dump(exclude_none=True),
            **_friction(case),
        },
        "run": {
            **case.run.model_dump(exclude_none=True, exclude={"impacts"}),
            "impacts": "all" if impacts is None else impacts,
        },
    }
    if case.sensors:
        table["sensors"] = [
            sensor.model_dump(exclude_none=True, mode="json") for sensor in case.sensors
        ]
    if case.calibrate:
        table["calibrate"] = calibrate_table(case.calibrate)
    if case.sweep:
        table["sweep"] = case.sweep.model_dump(exclude_none=True, mode="json")
    return cast("ResolvedCase", table)


def _law(case: CaseTable) -> dict[str, Any]:
    """Return the name of the contact law of a case, and its parameters.

    Derived ones are written out too, so that the file is complete.
    """
    laws = contact_laws_of(case)
    functions = by_speed_of(case)
    table: dict[str, Any] = {"law": case.contact.law}
    for item in fields(laws[0]):
        if item.name in functions:
            table[item.name] = functions[item.name].table()
            continue
        values = [getattr(law, item.name) for law in laws]
        if item.name not in case.contact.parameters and values[0] is None:
            continue
        # a list only if the values differ between impacts
        differ = len(values) > 1 and len(set(values)) > 1
        table[item.name] = values if differ else values[0]
    return table


def _friction(case: CaseTable) -> dict[str, Any]:
    """Return the friction table of a case under its key, with all parameters.

    Nothing without friction.
    """
    law = friction_law_of(case)
    if law is None:
        return {}
    parameters = {item.name: getattr(law, item.name) for item in fields(law)}
    return {"friction": {"law": law.name, **parameters}}


def _body(case: CaseTable, name: Literal["sphere", "plate"]) -> dict[str, Any]:
    """Return the table of a body, without the keys that do not apply to its model."""
    section: SphereSection | PlateSection = getattr(case, name)
    table = section.model_dump(
        exclude_none=True, exclude={"material", "supports", "damping", "mesh"}
    )
    if section.model == "rigid":
        table = {key: value for key, value in table.items() if key not in ELASTIC_KEYS}
        if name == "plate" and is_free_sphere(case):
            table["supports"] = "free"
    else:
        from vibroimpact.cases.elastic.elastic_bodies import elastic_table  # imports scipy.sparse

        table |= elastic_table(case, name)
    if "size" in table:
        table["size"] = list(table["size"])
    if "motion" in table:
        motion = _lists(table["motion"])
        # a file has no phase, and a harmonic motion no period to repeat
        motion.pop("phase" if "file" in motion else "repeat", None)
        table["motion"] = motion
    return {**table, "material": material_table(section.material)}


def _lists(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table with lists in place of tuples."""
    of_tuples = {key: list(value) for key, value in table.items() if isinstance(value, tuple)}
    return {**table, **of_tuples}
