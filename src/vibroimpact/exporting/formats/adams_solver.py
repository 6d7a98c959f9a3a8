"""Adams/Solver: the model as a dataset (.adm), and the commands that run it (.acf)."""

from __future__ import annotations

from collections.abc import Iterator

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

_NAMES = Names(
    centre="11", spot="1", sensor="1", speed="1", damping="2", slip_x="3", slip_y="4", drag="5"
)
# parts, the marker at the plate's corner, and that of the reaction to friction
_GROUND, _SPHERE, _CORNER, _OPPOSITE = 1, 2, 2, 3


def write(drop: Drop) -> dict[str, bytes]:
    """Return the dataset and the command file.

    Raises
    ------
    InputError
        If the contact law is not supported.
    """
    model = adams_model(drop)
    commands = [
        f"FILE/MODEL={model.name}",
        f"SIMULATE/DYNAMICS, END={adams_number(model.end)}, "
        f"DTOUT={adams_number(model.output_step)}",
        "STOP",
        "",
    ]
    return {
        f"{model.name}.adm": "\n".join(_dataset(model)).encode("ascii"),
        f"{model.name}.acf": "\n".join(commands).encode("ascii"),
    }


def _dataset(model: AdamsModel) -> Iterator[str]:
    contact = model.contact
    # the first line is the title; Adams View takes the model's name from it, and other names from
    # comments
    yield f"Adams View model name: {model.name}"
    yield from header_comments(model)
    yield from _statement(
        "UNITS/", FORCE="NEWTON", MASS="KILOGRAM", LENGTH="MILLIMETER", TIME="SECOND"
    )
    yield from _headed("ground", "PART", _GROUND, "GROUND")
    x, y, z = model.centre
    yield from _headed(
        "spot", "MARKER", int(_NAMES.spot), PART=str(_GROUND), QP=adams_numbers((x, y, 0.0))
    )
    if model.plate is not None:
        yield from _headed(
            "corner", "MARKER", _CORNER, PART=str(_GROUND), QP=adams_numbers(model.corner)
        )
        size = dict(zip("XYZ", map(adams_number, model.plate), strict=True))
        yield from _headed("plate", "GRAPHICS", 1, "BOX", CORNER=str(_CORNER), **size)
    velocity = {"VZ": adams_number(model.velocity)} if model.velocity else {}
    if model.motion is not None:
        parts = (*model.motion.velocity, model.velocity, *model.motion.spin)
        velocity = dict(
            zip(("VX", "VY", "VZ", "WX", "WY", "WZ"), map(adams_number, parts), strict=True)
        )
    yield from _headed(
        "sphere",
        "PART",
        _SPHERE,
        QG=adams_numbers((x, y, z)),
        **velocity,
        MASS=adams_number(model.mass),
        CM=_NAMES.centre,
        IP=adams_numbers([model.inertia] * 3),
    )
    yield from _headed(
        "cm", "MARKER", int(_NAMES.centre), PART=str(_SPHERE), QP=adams_numbers((0.0, 0.0, 0.0))
    )
    diameter = adams_number(2.0 * model.radius)
    yield from _headed(
        "ball",
        "GRAPHICS",
        2,
        "ELLIPSOID",
        CM=_NAMES.centre,
        XSCALE=diameter,
        YSCALE=diameter,
        ZSCALE=diameter,
    )
    for identifier, material in enumerate(model.materials, 1):
        yield from _headed(
            material.name,
            "MATERIAL",
            identifier,
            NAME=material.name,
            DENSITY=adams_number(material.density),
            YOUNGS_MODULUS=adams_number(material.youngs_modulus),
            POISSONS_RATIO=adams_number(material.poissons_ratio),
        )
    if contact.holds_speed:
        yield from _headed(
            "touch",
            "SENSOR",
            int(_NAMES.sensor),
            "GE",
            VALUE="0.0",
            ERROR=adams_number(SENSOR_ERROR),
            FUNCTION=contact.gap(_NAMES) + "\\",
            EVALUATE=contact.coming_speed(_NAMES),
        )
        yield from _headed(
            "approach_speed", "VARIABLE", int(_NAMES.speed), FUNCTION=contact.held_speed(_NAMES)
        )
    if contact.varies:
        yield from _headed(
            "damping", "VARIABLE", int(_NAMES.damping), FUNCTION=contact.damping_now(_NAMES)
        )
    # action only: along the z axis of marker J, on the part of marker I; the ground needs no
    # reaction
    yield from _headed(
        "contact",
        "SFORCE",
        1,
        "TRANSLATION",
        "ACTIONONLY",
        I=_NAMES.centre,
        J=_NAMES.spot,
        FUNCTION=contact.force(_NAMES),
    )
    yield from _friction(model)
    yield from _requests(model)
    yield from _statement(
        "ACCGRAV/",
        **dict(zip(("IGRAV", "JGRAV", "KGRAV"), map(adams_number, model.pull), strict=True)),
    )
    yield from _statement(
        "INTEGRATOR/",
        "GSTIFF",
        "SI2",
        ERROR=adams_number(ACCURACY),
        HMAX=adams_number(model.longest_step),
    )
    yield from _statement("OUTPUT/", "REQSAVE", "GRSAVE")
    yield from _statement("RESULTS/", "XRF")
    yield from ("END", "")


def _friction(model: AdamsModel) -> Iterator[str]:
    """Yield the statements of friction, if the sphere moves along the plate."""
    if model.motion is None:
        return
    for name, (number, expression) in model.motion.variables(_NAMES, "1").items():
        yield from _headed(name, "VARIABLE", int(number), FUNCTION=expression)
    yield from _headed("opposite", "MARKER", _OPPOSITE, "FLOATING", PART=str(_GROUND))
    *first, last = zip(
        ("FX", "FY", "FZ", "TX", "TY", "TZ"), model.motion.components(_NAMES), strict=True
    )
    functions = {name: f"{expression}\\" for name, expression in first} | dict([last])
    yield from _headed(
        "friction", "GFORCE", 1, I=_NAMES.centre, JFLOAT=str(_OPPOSITE), RM=_NAMES.spot, **functions
    )


def _requests(model: AdamsModel) -> Iterator[str]:
    """Yield the REQUEST statements for the output of a run."""
    requests = {"motion": model.contact.readings(_NAMES, "1")}
    if model.motion is not None:
        requests["along_plate"] = model.motion.readings(_NAMES)
    for number, (name, readings) in enumerate(requests.items(), 1):
        last = max(readings)
        functions = {
            f"F{column}": expression + ("" if column == last else "\\")
            for column, (_, expression) in readings.items()
        }
        yield from _headed(name, "REQUEST", number, CNAMES=column_titles(readings), **functions)


def _headed(name: str, kind: str, identifier: int, *flags: str, **arguments: str) -> Iterator[str]:
    """Yield a statement after the comment from which Adams View takes its name."""
    yield f"! adams_view_name='{name}'"
    yield from _statement(f"{kind}/{identifier}", *flags, **arguments)


def _statement(head: str, *flags: str, **arguments: str) -> Iterator[str]:
    """Yield the lines of a statement: one argument per line, each with the continuation comma in
    the first column.

    A function expression ends with a backslash instead of a comma if another argument follows.
    """
    yield head
    yield from (f", {flag}" for flag in flags)
    for name, value in arguments.items():
        yield from (f", {line}" for line in wrap_expression(f"{name} = {value}", LINE - 2))


FORMAT = ExportFormat(
    name="adams",
    program="MSC Adams/Solver",
    files="a dataset NAME.adm, and NAME.acf with the commands that run it",
    tested=TESTED,
    write=write,
    notes=adams_notes,
    dialog=adams_dialog,
    prepare=as_rigid,
)
