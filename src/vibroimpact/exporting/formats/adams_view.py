"""Adams View: a command file that builds the model (.cmd)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from vibroimpact.exporting.adams_contact import Names, adams_number, adams_numbers, column_titles
from vibroimpact.exporting.adams_model import (
    ACCURACY,
    LINE,
    SENSOR_ERROR,
    TESTED,
    AdamsModel,
    adams_dialog,
    adams_model,
    adams_notes,
    header_comments,
    wrap_expression,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.exporting.rigid_drop import as_rigid

_UPRIGHT = "0.0d, 0.0d, 0.0d"


def write(drop: Drop) -> dict[str, bytes]:
    """Return the command file.

    Raises
    ------
    InputError
        If the contact law is not supported.
    """
    model = adams_model(drop)
    return {f"{model.name}.cmd": "\n".join([*_commands(model), ""]).encode("ascii")}


def _commands(model: AdamsModel) -> Iterator[str]:
    contact, top = model.contact, f".{model.name}"
    ground, sphere = f"{top}.ground", f"{top}.sphere"
    names = Names(
        f"{sphere}.cm",
        f"{ground}.spot",
        *(
            f"{top}.{name}"
            for name in ("touch", "approach_speed", "damping", "slip_x", "slip_y", "drag")
        ),
    )
    yield from header_comments(model)
    yield from _command(
        "defaults units", length="mm", angle="deg", force="newton", mass="kg", time="sec"
    )
    yield from _command(
        "defaults units", coordinate_system_type="cartesian", orientation_type="body313"
    )
    yield from _command("model create", model_name=model.name)
    for material in model.materials:
        yield from _command(
            "material create",
            material_name=f"{top}.{material.name}",
            density=adams_number(material.density),
            youngs_modulus=adams_number(material.youngs_modulus),
            poissons_ratio=adams_number(material.poissons_ratio),
        )
    yield from _inside(ground)
    x, y, z = model.centre
    yield from _marker(names.spot, (x, y, 0.0))
    if model.plate is not None:
        yield from _marker(f"{ground}.corner", model.corner)
        yield from _command(
            "geometry create shape block",
            block_name=f"{ground}.plate",
            corner_marker=f"{ground}.corner",
            diag_corner_coords=adams_numbers(model.plate),
        )
    yield from _command(
        "part create rigid_body name_and_position",
        part_name=sphere,
        location=adams_numbers((x, y, z)),
        orientation=_UPRIGHT,
    )
    yield from _inside(sphere)
    yield from _marker(names.centre, (0.0, 0.0, 0.0))
    moments = dict.fromkeys(("ixx", "iyy", "izz"), adams_number(model.inertia)) | dict.fromkeys(
        ("ixy", "izx", "iyz"), "0.0"
    )
    yield from _command(
        "part create rigid_body mass_properties",
        part_name=sphere,
        mass=adams_number(model.mass),
        center_of_mass_marker=names.centre,
        **moments,
    )
    velocity = {"vz": adams_number(model.velocity)} if model.velocity else {}
    if model.motion is not None:
        parts = (
            *model.motion.velocity,
            model.velocity,
            *(math.degrees(part) for part in model.motion.spin),
        )
        velocity = dict(
            zip(("vx", "vy", "vz", "wx", "wy", "wz"), map(adams_number, parts), strict=True)
        )
    if velocity:
        yield from _command("part create rigid_body initial_velocity", part_name=sphere, **velocity)
    scale = {f"{axis}_scale_factor": adams_number(2.0 * model.radius) for axis in "xyz"}
    yield from _command(
        "geometry create shape ellipsoid",
        ellipsoid_name=f"{sphere}.ball",
        center_marker=names.centre,
        **scale,
    )
    if contact.holds_speed:
        yield from _command(
            "executive_control create sensor",
            sensor_name=names.sensor,
            compare="ge",
            value="0.0",
            error=adams_number(SENSOR_ERROR),
            **dict.fromkeys(("codgen", "halt", "print", "restart", "return", "yydump"), "off"),
            function=_quoted(contact.gap(names)),
            evaluate=_quoted(contact.coming_speed(names)),
        )
        yield from _variable(names.speed, contact.held_speed(names))
    if contact.varies:
        yield from _variable(names.damping, contact.damping_now(names))
    # action only: along the z axis of marker J, on the part of marker I; the ground needs no
    # reaction
    yield from _command(
        "force create direct single_component_force",
        single_component_force_name=f"{top}.contact",
        type_of_freedom="translational",
        i_marker_name=names.centre,
        j_marker_name=names.spot,
        action_only="on",
        function=_quoted(contact.force(names)),
    )
    yield from _friction(model, names)
    gravity = {
        f"{axis}_component_gravity": adams_number(part)
        for axis, part in zip("xyz", model.pull, strict=True)
    }
    yield from _command("force create body gravitational", gravity_field_name="gravity", **gravity)
    yield from _requests(model, names)
    yield from _command(
        "executive_control set numerical_integration_parameters",
        model_name=top,
        integrator_type="si2_gstiff",
        error_tolerance=adams_number(ACCURACY),
        hmax_time_step=adams_number(model.longest_step),
    )
    run = (
        f"SIMULATE/DYNAMICS, END={adams_number(model.end)}, DTOUT={adams_number(model.output_step)}"
    )
    yield from _command(
        "simulation script create", sim_script_name=f"{top}.drop", solver_commands=f'"{run}"'
    )


def _friction(model: AdamsModel, names: Names) -> Iterator[str]:
    """Yield the commands of friction, if the sphere moves along the plate."""
    if model.motion is None:
        return
    for name, expression in model.motion.variables(names, f".{model.name}.contact").values():
        yield from _variable(name, expression)
    functions = [f"{axis}_{kind}_function" for kind in ("force", "torque") for axis in "xyz"]
    yield from _command(
        "force create direct general_force",
        general_force_name=f".{model.name}.friction",
        i_marker_name=names.centre,
        j_part_name=f".{model.name}.ground",
        ref_marker_name=names.spot,
        **dict(zip(functions, map(_quoted, model.motion.components(names)), strict=True)),
    )


def _requests(model: AdamsModel, names: Names) -> Iterator[str]:
    """Yield the commands that create the requests for the output of a run."""
    requests = {"motion": model.contact.readings(names, f".{model.name}.contact")}
    if model.motion is not None:
        requests["along_plate"] = model.motion.readings(names)
    for name, readings in requests.items():
        yield from _command(
            "output_control create request",
            request_name=f".{model.name}.{name}",
            component_names=column_titles(readings),
            results_name=f'"{name}"',
            **{f"f{column}": _quoted(expression) for column, (_, expression) in readings.items()},
        )


def _inside(part: str) -> Iterator[str]:
    """Yield the command that makes a part's coordinate system the default one for locations."""
    return _command("defaults coordinate_system", default_coordinate_system=part)


def _marker(name: str, location: Sequence[float]) -> Iterator[str]:
    return _command(
        "marker create", marker_name=name, location=adams_numbers(location), orientation=_UPRIGHT
    )


def _variable(name: str, function: str) -> Iterator[str]:
    return _command("data_element create variable", variable_name=name, function=_quoted(function))


def _command(words: str, **parameters: str) -> Iterator[str]:
    """Yield the lines of a command: one parameter per line, all but the last continued by
    an ampersand.
    """
    lines = [line for name, value in parameters.items() for line in f"{name} = {value}".split("\n")]
    yield "!"
    yield f"{words}  &"
    yield from (f"   {line}  &" for line in lines[:-1])
    yield f"   {lines[-1]}"


def _quoted(function: str) -> str:
    """Return a function as a series of quoted strings, one per line, which Adams View
    concatenates.
    """
    *first, last = wrap_expression(function, LINE - 20)
    return ",\n".join([*(f'"{line} "' for line in first), f'"{last}"'])


FORMAT = ExportFormat(
    name="adams-view",
    program="MSC Adams View",
    files="a command file NAME.cmd",
    tested=TESTED,
    write=write,
    notes=adams_notes,
    dialog=adams_dialog,
    prepare=as_rigid,
)
