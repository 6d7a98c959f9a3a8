"""The problem that a case describes, and the resolved case: checks across sections,
conversion to `Problem`, and back to a table.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Literal, cast

from vibroimpact.calibration.section import calibrate_table
from vibroimpact.cases.elastic.positions import check_positions
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.fields.instruments import AT_REST, INSTRUMENTS
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.cases.fields.material import material_table
from vibroimpact.cases.oblique import friction_law_of, oblique_keys
from vibroimpact.cases.pair import is_free_sphere, sphere_density
from vibroimpact.cases.plate_motion import motion_length
from vibroimpact.cases.rigid_problem import (
    PLATE_FALLS,
    by_speed_of,
    contact_laws_of,
    deforms,
    elastic_names,
    impact_limit,
    rigid_problem,
    run_duration,
)
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw, ContactLaw, is_conservative
from vibroimpact.contact.speed_function import held
from vibroimpact.dynamics.air import check_thin
from vibroimpact.dynamics.liquid import check_sinks
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.resolved_case import ResolvedCase

if TYPE_CHECKING:
    from vibroimpact.cases.schema import CaseTable, PlateSection, SphereSection


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
    # without a limit of impacts or time only losses in the contact end a run
    if impact_limit(case) is None and run_duration(case) is None:
        remedy = "give a number, or run.duration"
        # what a function of the approach speed is for the slowest impacts, the last ones
        slow = {key: held(function, 0.0) for key, function in by_speed_of(case).items()}
        if is_conservative(law.changed(slow)):
            words = f"and this {law.name} loses none{' of slow impacts' if slow else ''}"
            raise InputError(
                f'"all" needs a law that loses energy, {words}; {remedy}', "run.impacts"
            )
        if (
            isinstance(law, CompliantLaw)
            and law.lasting
            and case.drop.same_spot
            and is_conservative(law.after_compression(1.0))
        ):
            words = f"and {law.name} loses none on a dent that it has made"
            raise InputError(
                f'"all" needs a law that loses energy, {words}; {remedy}, or '
                "drop.same_spot = false",
                "run.impacts",
            )
    _check_oblique(case, law)
    _check_liquid(case, law)
    if case.drop.air is not None:
        check_thin(case.drop.air.density, sphere_density(case.sphere), "drop.air.density")
    _check_motion(case)
    if case.sensors and case.plate.model == "rigid" and case.plate.motion is None:
        if case.plate.radius is not None:
            raise InputError(
                "sensors are on a plate, and a sphere takes its place; leave out the "
                "sensors, or plate.radius",
                "sensors",
            )
        movable = not any(sensor.instrument in AT_REST for sensor in case.sensors)
        remedy = (
            f'give it model = "elastic"{" or motion" if movable else ""}, or leave out the sensors'
        )
        raise InputError(
            f"the plate is rigid and at rest, so that its points do not move; {remedy}", "sensors"
        )
    for number, sensor in enumerate(case.sensors):
        if case.plate.motion is not None and sensor.instrument in AT_REST:
            words = (
                f"{INSTRUMENTS[sensor.instrument]} is for plates whose supports are at rest; "
                "leave out the sensor, or the motion"
            )
            names = [{"name": sensor.name} for sensor in case.sensors]
            raise InputError(words, f"{item_label('sensors', names, number)}.instrument")
    local = case.contact.local
    if local.local_compliance == "identified" and case.sphere.model == "elastic":
        raise InputError(
            'the local element of "identified" stands for the deformation of the sphere; '
            'leave it "rigid"',
            "sphere.model",
        )
    if local.finite_sphere and case.sphere.model == "elastic":
        words = (
            'an elastic sphere deforms in its modes, and local_compliance = "consistent" '
            "corrects the rest"
        )
        raise InputError(
            f"this is for a rigid sphere: {words}; leave this out", "contact.finite_sphere"
        )
    if local.finite_sphere and not isinstance(law, CompliantLaw):
        raise InputError(
            f"{law.name} gives no force that a finite sphere would change; leave this out",
            "contact.finite_sphere",
        )
    check_positions(case)
    if elastic_names(case):
        from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies  # imports scipy.sparse

        elastic_bodies(case)


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
        words = (
            "this is for drops along the normal, without spin and friction; leave it out, or "
            f"{' and '.join(keys)}"
        )
        raise InputError(words, "contact.finite_sphere")
    if case.plate.radius is not None:
        raise InputError(
            "a sphere may fall obliquely, spin or rub on a flat plate only, not on another "
            "sphere; leave this out",
            keys[0],
        )
    if isinstance(case.plate.mesh, BroughtMeshTable):
        words = (
            "an imported mesh does not define the edges of the plate, over which a sphere may fall"
        )
        raise InputError(f"{words}; give size and leave out mesh, or leave this out", keys[0])
    friction = friction_law_of(case)
    shaken = case.plate.motion is not None and isinstance(law, CompliantLaw)
    if (
        (deforms(case) or shaken)
        and friction is not None
        and not isinstance(friction, CompliantFriction)
    ):
        words = (
            f"{friction.name} has no tangential compliance, which friction needs on bodies "
            "that deform or are shaken"
        )
        raise InputError(
            f'{words}; take "mdr" or one of the "mindlin" laws', "contact.friction.law"
        )
    if isinstance(friction, CompliantFriction) and not isinstance(law, CompliantLaw):
        words = f"{law.name} gives no normal force, which {friction.name} follows"
        # bodies that deform take no friction by the impulse
        remedy = "" if deforms(case) else ', or friction by the impulse: "coulomb" or "rigid"'
        raise InputError(f"{words}; take another contact law{remedy}", "contact.friction.law")


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
        words = f"{law.name} takes no restitution, of which a liquid leaves a part"
        remedy = 'take a law that does, such as "tsuji" or "flores"'
        if "restitution" in {item.name for item in fields(law)}:
            words = f"{law.name} is given without a restitution, of which a liquid leaves a part"
            remedy = f"give contact.restitution in place of contact.{law.free_parameter}"
        raise InputError(f"{words}; {remedy}, or leave this out", "contact.liquid")
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
    """Check that no free plate is hit under gravity; the modes of such a plate may still be
    computed.

    Raises
    ------
    InputError
        If the plate is free and gravity is not zero.
    """
    if case.plate.supports == "free" and case.drop.gravity:
        raise InputError(
            PLATE_FALLS if case.plate.radius is None else _BALL_FALLS, "plate.supports"
        )


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
    """Return a case as a table in SI with all defaults resolved, as written to
    `case.toml`; reading it gives the same case.
    """
    laws = contact_laws_of(case)
    contact: dict[str, Any] = {"law": case.contact.law}
    # a parameter is a list only if its values differ between impacts; derived ones are written out,
    # so that the file is complete
    functions = by_speed_of(case)
    for item in fields(laws[0]):
        if item.name in functions:
            contact[item.name] = functions[item.name].table()
            continue
        values = [getattr(law, item.name) for law in laws]
        if item.name in case.contact.parameters or values[0] is not None:
            contact[item.name] = values if len(values) > 1 and len(set(values)) > 1 else values[0]
    number = impact_limit(case)
    table = {
        "schema_version": case.schema_version,
        "name": case.name,
        "sphere": _body(case, "sphere"),
        "plate": _body(case, "plate"),
        "drop": {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in case.drop.model_dump(exclude_none=True).items()
        },
        "contact": {
            **contact,
            **case.contact.local.model_dump(exclude_none=True),
            **_friction(case),
        },
        "run": {
            **case.run.model_dump(exclude_none=True, exclude={"impacts"}),
            "impacts": "all" if number is None else number,
        },
        **(
            {
                "sensors": [
                    sensor.model_dump(exclude_none=True, mode="json") for sensor in case.sensors
                ]
            }
            if case.sensors
            else {}
        ),
        **({"calibrate": calibrate_table(case.calibrate)} if case.calibrate else {}),
        **({"sweep": case.sweep.model_dump(exclude_none=True, mode="json")} if case.sweep else {}),
    }
    return cast("ResolvedCase", table)


def _friction(case: CaseTable) -> dict[str, Any]:
    """Return the friction table of a case under its key, with all parameters; nothing
    without friction.
    """
    law = friction_law_of(case)
    return (
        {}
        if law is None
        else {
            "friction": {
                "law": law.name,
                **{item.name: getattr(law, item.name) for item in fields(law)},
            }
        }
    )


def _body(case: CaseTable, name: Literal["sphere", "plate"]) -> dict[str, Any]:
    """Return the table of a body, without the keys that do not apply to its model."""
    section: SphereSection | PlateSection = getattr(case, name)
    found = section.model_dump(
        exclude_none=True, exclude={"material", "supports", "damping", "mesh"}
    )
    if section.model == "rigid":
        found = {
            key: found[key]
            for key in ("radius", "mass", "inertia", "size", "model", "inclination", "motion")
            if key in found
        }
        found |= {"supports": "free"} if name == "plate" and is_free_sphere(case) else {}
    else:
        from vibroimpact.cases.elastic.elastic_bodies import elastic_table  # imports scipy.sparse

        found |= elastic_table(case, name)
    if "size" in found:
        found["size"] = list(found["size"])
    if "motion" in found:
        motion = {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in found["motion"].items()
        }
        other = "phase" if "file" in motion else "repeat"
        found["motion"] = {key: value for key, value in motion.items() if key != other}
    return {**found, "material": material_table(section.material)}
