"""A strict reader of Adams View command files (.cmd), from the documentation of the command
language.

Keywords, then `parameter = value` pairs; a command goes on while lines end in an ampersand; `!`
begins a comment. Commands, parameters and values that are not known here are refused, and so are
names that are new and taken, or used and not there.
"""

from __future__ import annotations

import math
import re

from oracles.adams import Model, Part, Sensor, real, reals, set_units
from oracles.adams_dataset import take_simulation
from oracles.adams_functions import Refused

_ON_OFF = "on|off"
# what each parameter is: "new KIND" names an element, "KIND" refers to one, "a|b" is a choice; "!"
# before it: it must be there
_COMMANDS: dict[str, dict[str, str]] = {
    "defaults units": dict.fromkeys(
        ("length", "angle", "force", "mass", "time", "coordinate_system_type", "orientation_type"),
        "word",
    ),
    "model create": {"model_name": "!new model"},
    "material create": {
        "material_name": "!new material",
        "density": "!real",
        "youngs_modulus": "!real",
        "poissons_ratio": "!real",
    },
    "defaults coordinate_system": {"default_coordinate_system": "!part"},
    "marker create": {"marker_name": "!new marker", "location": "!reals", "orientation": "!angles"},
    "geometry create shape block": {
        "block_name": "!new geometry",
        "corner_marker": "!marker",
        "diag_corner_coords": "!reals",
    },
    "geometry create shape ellipsoid": {
        "ellipsoid_name": "!new geometry",
        "center_marker": "!marker",
    }
    | dict.fromkeys(("x_scale_factor", "y_scale_factor", "z_scale_factor"), "!real"),
    "part create rigid_body name_and_position": {
        "part_name": "!new part",
        "location": "!reals",
        "orientation": "!angles",
    },
    "part create rigid_body mass_properties": {
        "part_name": "!part",
        "mass": "!real",
        "center_of_mass_marker": "!marker",
    }
    | dict.fromkeys(("ixx", "iyy", "izz", "ixy", "izx", "iyz"), "!real"),
    "part create rigid_body initial_velocity": {"part_name": "!part"}
    | dict.fromkeys(("vx", "vy", "vz", "wx", "wy", "wz"), "real"),
    "executive_control create sensor": {
        "sensor_name": "!new sensor",
        "compare": "!ge",
        "value": "!real",
        "error": "!real",
    }
    | dict.fromkeys(("codgen", "halt", "print", "restart", "return", "yydump"), _ON_OFF)
    | {"function": "!function", "evaluate": "!function"},
    "data_element create variable": {"variable_name": "!new variable", "function": "!function"},
    "force create direct single_component_force": {
        "single_component_force_name": "!new force",
        "type_of_freedom": "!translational",
        "i_marker_name": "!marker",
        "j_marker_name": "!marker",
        "action_only": "!on",
        "function": "!function",
    },
    "force create direct general_force": {
        "general_force_name": "!new force",
        "i_marker_name": "!marker",
        "j_part_name": "!part",
        "ref_marker_name": "!marker",
    }
    | {f"{axis}_{kind}_function": "!function" for kind in ("force", "torque") for axis in "xyz"},
    "force create body gravitational": {"gravity_field_name": "!word"}
    | dict.fromkeys(("x_component_gravity", "y_component_gravity", "z_component_gravity"), "!real"),
    "output_control create request": {
        "request_name": "!new request",
        "component_names": "strings",
        "results_name": "strings",
    }
    | {f"f{column}": "function" for column in range(1, 9)},
    "executive_control set numerical_integration_parameters": {
        "model_name": "!model",
        "integrator_type": "gstiff|wstiff|si2_gstiff",
        "error_tolerance": "!real",
        "hmax_time_step": "!real",
    },
    "simulation script create": {"sim_script_name": "!new script", "solver_commands": "!strings"},
}
_ITEM = re.compile(r'\s*("[^"]*"|[=,]|[^\s=,"]+)')


class _Session:
    """What the commands so far have made."""

    def __init__(self) -> None:
        self.model, self.kinds, self.origin = Model(), {}, ""

    def check(self, name: str, what: str, items: list[str]) -> None:
        """Check a value; a new name is entered."""
        one = items[0] if len(items) == 1 else ""
        what = what.lstrip("!")
        if what.startswith("new "):
            if not re.fullmatch(r"\.?[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", one):
                raise Refused(f"{name} = {items} is no name")
            full = one if one.startswith(".") else f".{one}"
            if full in self.kinds:
                raise Refused(f"{full} is there twice")
            if what != "new model" and full.rpartition(".")[0] not in self.kinds:
                raise Refused(f"{full}: what it belongs to is not there")
            self.kinds[full] = what[4:]
        elif what in ("model", "part", "marker"):
            if self.kinds.get(one) != what:
                raise Refused(f"{name}: there is no {what} {one}")
        elif what == "real":
            real(one)
        elif what == "reals":
            reals(",".join(items))
        elif what == "angles":
            if items != ["0.0d"] * 3:
                raise Refused(f"{name}: this oracle does not turn anything")
        elif what in ("function", "strings"):
            if not all(item.startswith('"') for item in items):
                raise Refused(f"{name} is no series of quoted strings")
        elif what == "word":
            if not re.fullmatch(r"\w+", one):
                raise Refused(f"{name} = {items}")
        elif one not in what.split("|"):
            raise Refused(f"{name} = {items}; it must be {what}")

    def offset(self, location: str) -> tuple[float, float, float]:
        """A location, given from the default coordinate system, in the ground's."""
        return tuple(
            a + b
            for a, b in zip(self.model.parts[self.origin].position, reals(location), strict=True)
        )


def read_commands(text: str) -> Model:
    """Return the model that the commands build."""
    session = _Session()
    for words, given in _split(text):
        known = _COMMANDS[words]
        for name, items in given.items():
            session.check(name, known[name], items)
        values = {name: _joined(known[name], items) for name, items in given.items()}
        _do(session, words, values)
    return session.model


def _split(text: str) -> list[tuple[str, dict[str, list[str]]]]:
    """Return each command's words, and its parameters with the items of their values."""
    logical, going_on = [], False
    for line in text.split("\n"):
        if line.lstrip().startswith("!") or not line.strip():
            if going_on:
                raise Refused("a command is continued by a comment or an empty line")
            continue
        bare = line.rstrip()
        goes_on = bare.endswith("&")
        logical[len(logical) - going_on :] = [
            (logical[-1] if going_on else "") + " " + bare.rstrip("&")
        ]
        going_on = goes_on
    if going_on:
        raise Refused("the last command is not finished")
    return [_command(line) for line in logical]


def _command(line: str) -> tuple[str, dict[str, list[str]]]:
    items, position, line = [], 0, line.strip()
    while position < len(line):
        found = _ITEM.match(line, position)
        if not found:
            raise Refused(f"a quote is not closed: {line[position:]!r}")
        items.append(found[1])
        position = found.end()
    first = items.index("=") - 1 if "=" in items else len(items)
    words = " ".join(items[:first])
    if words not in _COMMANDS:
        raise Refused(f"{words!r} is no command")
    known, given, rest = _COMMANDS[words], {}, items[first:]
    while rest:
        if len(rest) < 3 or rest[1] != "=" or rest[0] not in known or rest[0] in given:
            raise Refused(f"{words}: {' '.join(rest[:3])}")
        name, values, rest = rest[0], [rest[2]], rest[3:]
        while rest[:1] == [","]:
            values, rest = [*values, *rest[1:2]], rest[2:]
        if any(value in ("=", ",") for value in values):
            raise Refused(f"{words}: {name}")
        given[name] = values
    if missing := [name for name, what in known.items() if what[0] == "!" and name not in given]:
        raise Refused(f"{words} lacks {missing[0]}")
    return words, given


def _joined(what: str, items: list[str]) -> str:
    """A function is the strings of its series, one after the other."""
    return (
        "".join(item[1:-1] for item in items)
        if what.lstrip("!") in ("function", "strings")
        else ", ".join(items)
    )


def _do(session: _Session, words: str, given: dict[str, str]) -> None:
    model = session.model
    if words == "defaults units" and "length" in given:
        if session.kinds:
            raise Refused("the units are stated after the model is begun")
        set_units(model, given["length"], given["mass"], given["force"], given["time"])
    elif words == "model create":
        ground = f".{given['model_name']}.ground"
        session.kinds[ground], model.parts[ground] = "part", Part(ground=True)
    elif words == "defaults coordinate_system":
        session.origin = given["default_coordinate_system"]
    elif words == "marker create":
        name = given["marker_name"]
        part = name.rpartition(".")[0]
        at = model.parts[part].position
        model.markers[name] = (
            part,
            tuple(a - b for a, b in zip(session.offset(given["location"]), at, strict=True)),
        )
    elif words.endswith("name_and_position"):
        model.parts[given["part_name"]] = Part(session.offset(given["location"]))
    elif words.endswith("mass_properties"):
        part = model.parts[given["part_name"]]
        part.mass, part.centre = real(given["mass"]), given["center_of_mass_marker"]
        part.inertia = real(given["ixx"]), real(given["iyy"]), real(given["izz"])
    elif words.endswith("initial_velocity"):
        part = model.parts[given["part_name"]]
        x, y, part.velocity, *spin = (
            real(given.get(name, "0")) for name in ("vx", "vy", "vz", "wx", "wy", "wz")
        )
        part.along = (x, y, *(math.radians(one) for one in spin))  # the unit of angle is the degree
    elif words.endswith("ellipsoid"):
        model.balls[given["center_marker"]] = real(given["x_scale_factor"])
    elif words.endswith("create sensor"):
        model.sensors[given["sensor_name"]] = Sensor(
            given["function"], real(given["value"]), real(given["error"]), given["evaluate"]
        )
    elif words.endswith("create variable"):
        model.variables[given["variable_name"]] = given["function"]
    elif words.endswith("single_component_force"):
        model.forces[given["single_component_force_name"]] = (
            given["i_marker_name"],
            given["j_marker_name"],
            given["function"],
        )
    elif words.endswith("general_force"):
        if not model.parts[given["j_part_name"]].ground:
            raise Refused("the friction is not that of the ground")
        functions = [
            given[f"{axis}_{kind}_function"] for kind in ("force", "torque") for axis in "xyz"
        ]
        model.general.append((given["i_marker_name"], given["ref_marker_name"], functions))
    elif words.endswith("gravitational"):
        model.gravity = tuple(real(given[f"{axis}_component_gravity"]) for axis in "xyz")
    elif words.endswith("create request"):
        model.requests[given["request_name"]] = [
            value for name, value in given.items() if re.fullmatch(r"f\d", name)
        ]
    elif words.endswith("numerical_integration_parameters"):
        model.longest_step = real(given["hmax_time_step"])
    elif words == "simulation script create":
        take_simulation(given["solver_commands"], model)
