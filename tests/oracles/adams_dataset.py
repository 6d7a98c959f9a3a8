"""A strict reader of Adams/Solver datasets (.adm) and command files (.acf), from the statements'
documentation.

It takes one argument a line, each with the comma of continuation in the first column: less than
Adams does. What it does not know it refuses: statements, arguments, numbers given twice, elements
that are not there, lines beyond 80 columns.
"""

from __future__ import annotations

import re

from oracles.adams import Model, Part, Sensor, real, reals, set_units
from oracles.adams_functions import Refused

# what each argument is; "!" before it: it must be there
_STATEMENTS: dict[str, dict[str, str]] = {
    "UNITS": {"FORCE": "!word", "MASS": "!word", "LENGTH": "!word", "TIME": "!word"},
    "PART": {"GROUND": "flag", "QG": "reals", "MASS": "real", "CM": "id", "IP": "reals"}
    | dict.fromkeys(("VX", "VY", "VZ", "WX", "WY", "WZ"), "real"),
    "MARKER": {"PART": "!id", "QP": "reals", "FLOATING": "flag"},
    "GRAPHICS": {"BOX": "flag", "ELLIPSOID": "flag", "CORNER": "id", "CM": "id"}
    | dict.fromkeys(("X", "Y", "Z", "XSCALE", "YSCALE", "ZSCALE"), "real"),
    "MATERIAL": {
        "NAME": "!word",
        "DENSITY": "!real",
        "YOUNGS_MODULUS": "!real",
        "POISSONS_RATIO": "!real",
    },
    "SENSOR": {
        "GE": "!flag",
        "VALUE": "!real",
        "ERROR": "!real",
        "FUNCTION": "!function",
        "EVALUATE": "!function",
    },
    "VARIABLE": {"FUNCTION": "!function"},
    "SFORCE": {
        "TRANSLATION": "!flag",
        "ACTIONONLY": "!flag",
        "I": "!id",
        "J": "!id",
        "FUNCTION": "!function",
    },
    "GFORCE": {"I": "!id", "JFLOAT": "!id", "RM": "!id"}
    | dict.fromkeys(("FX", "FY", "FZ", "TX", "TY", "TZ"), "!function"),
    "REQUEST": {"CNAMES": "strings"} | {f"F{column}": "function" for column in range(1, 9)},
    "ACCGRAV": {"IGRAV": "!real", "JGRAV": "!real", "KGRAV": "!real"},
    "INTEGRATOR": {"GSTIFF": "!flag", "SI2": "flag", "ERROR": "!real", "HMAX": "!real"},
    "OUTPUT": {"REQSAVE": "flag", "GRSAVE": "flag"},
    "RESULTS": {"XRF": "flag"},
}
_WITHOUT_NUMBER = {"UNITS", "ACCGRAV", "INTEGRATOR", "OUTPUT", "RESULTS"}


def read_dataset(text: str) -> Model:
    """Return the model of a dataset."""
    lines = text.split("\n")
    for count, line in enumerate(lines, 1):
        if len(line) > 80 or not line.isascii() or "\t" in line:
            raise Refused(f"line {count} is longer than 80 columns, or not plain")
    statements: list[list[str]] = []
    for line in lines[1:]:  # the first is the title
        line = line.split("!")[0].rstrip()
        if not line:
            continue
        if line.startswith(","):
            if not statements:
                raise Refused("the file begins with a continuation")
            statements[-1].append(line[1:].strip())
        else:
            statements.append([line])
    if statements[-1:] != [["END"]]:
        raise Refused("the last statement is not END")
    model, seen = Model(), set()
    for head, *rest in statements[:-1]:
        found = re.fullmatch(r"([A-Z]+)/(\d*)", head)
        if (
            not found
            or found[1] not in _STATEMENTS
            or (found[1] in _WITHOUT_NUMBER) != (found[2] == "")
        ):
            raise Refused(f"{head!r} is no statement")
        if head in seen:
            raise Refused(f"{head} is there twice")
        seen.add(head)
        _take(model, found[1], found[2], _arguments(found[1], rest))
    for needed in ("UNITS/", "ACCGRAV/", "INTEGRATOR/"):
        if needed not in seen:
            raise Refused(f"there is no {needed}")
    return model


def _arguments(kind: str, lines: list[str]) -> dict[str, str]:
    """Return the arguments of a statement; a function goes on until it is ended by a backslash."""
    known, found, open_function = _STATEMENTS[kind], {}, ""
    for line in lines:
        if open_function:
            found[open_function] += " " + line
        else:
            name, equals, value = (part.strip() for part in line.partition("="))
            if name not in known:
                raise Refused(f"{kind} has no argument {name!r}")
            if name in found or (known[name].endswith("flag") != (equals == "")):
                raise Refused(f"{kind}: {line!r}")
            found[name] = value
            open_function = name if known[name].endswith("function") else ""
        if open_function and found[open_function].endswith("\\"):
            found[open_function] = found[open_function][:-1]
            open_function = ""
    if missing := [name for name, what in known.items() if what[0] == "!" and name not in found]:
        raise Refused(f"{kind} lacks {missing[0]}")
    for name, value in found.items():
        what = known[name].lstrip("!")
        if what == "real":
            real(value)
        patterns = {
            "id": r"\d+",
            "word": r"[A-Za-z_]\w*",
            "strings": r'"\w*"(, "\w*")*',
            "function": r"[^=\\]+",
        }
        if what in patterns and not re.fullmatch(patterns[what], value):
            raise Refused(f"{kind}: {name} = {value}")
    return found


def _take(model: Model, kind: str, number: str, given: dict[str, str]) -> None:
    if kind == "UNITS":
        set_units(model, given["LENGTH"], given["MASS"], given["FORCE"], given["TIME"])
    elif kind == "PART":
        if "GROUND" in given:
            if len(given) > 1 or any(part.ground for part in model.parts.values()):
                raise Refused("the ground takes nothing, and there is one")
            model.parts[number] = Part(ground=True)
        elif missing := {"QG", "MASS", "CM", "IP"} - set(given):
            raise Refused(f"PART lacks {', '.join(sorted(missing))}")
        else:
            x, y, z, *spin = (
                real(given.get(name, "0")) for name in ("VX", "VY", "VZ", "WX", "WY", "WZ")
            )
            inertia, along = reals(given["IP"]), (x, y, *spin)
            model.parts[number] = Part(
                reals(given["QG"]), real(given["MASS"]), inertia, given["CM"], z, along=along
            )
    elif kind == "MARKER":
        if ("QP" in given) == ("FLOATING" in given):
            raise Refused(f"MARKER/{number} has a place, or floats")
        if "FLOATING" in given:
            model.floating[number] = given["PART"]
        else:
            model.markers[number] = given["PART"], reals(given["QP"])
    elif kind == "GRAPHICS":
        at = given.get("CORNER" if "BOX" in given else "CM", "")
        shape = (
            {"BOX", "CORNER", "X", "Y", "Z"}
            if "BOX" in given
            else {"ELLIPSOID", "CM", "XSCALE", "YSCALE", "ZSCALE"}
        )
        if at not in model.markers or set(given) != shape:
            raise Refused(f"GRAPHICS/{number}: there is no marker {at}, or it is no shape")
        if "ELLIPSOID" in given:
            model.balls[at] = real(given["XSCALE"])
    elif kind == "SENSOR":
        model.sensors[number] = Sensor(
            given["FUNCTION"], real(given["VALUE"]), real(given["ERROR"]), given["EVALUATE"]
        )
    elif kind == "VARIABLE":
        model.variables[number] = given["FUNCTION"]
    elif kind == "SFORCE":
        model.forces[number] = given["I"], given["J"], given["FUNCTION"]
    elif kind == "GFORCE":
        if (
            given["JFLOAT"] not in model.floating
            or not model.parts[model.floating[given["JFLOAT"]]].ground
        ):
            raise Refused(f"GFORCE/{number} has no floating marker on the ground")
        model.general.append(
            (
                given["I"],
                given["RM"],
                [given[name] for name in ("FX", "FY", "FZ", "TX", "TY", "TZ")],
            )
        )
    elif kind == "REQUEST":
        model.requests[number] = [value for name, value in given.items() if name != "CNAMES"]
    elif kind == "ACCGRAV":
        model.gravity = real(given["IGRAV"]), real(given["JGRAV"]), real(given["KGRAV"])
    elif kind == "INTEGRATOR":
        model.longest_step = real(given["HMAX"])


def read_solver_commands(text: str, model: Model) -> str:
    """Take end and output step from a command file; return the dataset that it loads."""
    lines = text.rstrip("\n").split("\n")
    loads = re.fullmatch(r"FILE/MODEL=(\w+)", lines[0])
    if len(lines) != 3 or not loads or lines[2] != "STOP":
        raise Refused("a command file loads a model, simulates and stops")
    take_simulation(lines[1], model)
    return loads[1]


def take_simulation(line: str, model: Model) -> None:
    """Take end and output step from SIMULATE."""
    found = re.fullmatch(r"SIMULATE/DYNAMICS, END=([^,]+), DTOUT=([^,]+)", line)
    if not found:
        raise Refused(f"{line!r} does not simulate")
    model.end, model.output_step = real(found[1]), real(found[2])
