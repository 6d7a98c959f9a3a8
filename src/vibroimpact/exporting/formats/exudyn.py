"""EXUDYN: a Python script with a point mass and a contact force as user function, exact
for most laws.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import approach_speeds, first_contact, shared_notes
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, comment_lines, file_name
from vibroimpact.exporting.program_friction import COULOMB, friction_in, friction_notes
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.files.plain_names import plain_words
from vibroimpact.ranges import Range

# damping factor D of the laws F = K delta^n (1 + D rate / approach), as a function of the requested
# restitution e
_FACTORS = {
    "flores": "1.6 * (1.0 - e) / e",
    "gonthier": "(1.0 - e * e) / e",
    "herbert-mcwhannell": "6.0 * (1.0 - e) / ((2.0 * e - 1.0) ** 2 + 3.0)",
    "hu-guo": "1.5 * (1.0 - e) / e",
    "hunt-crossley": "1.5 * (1.0 - e)",
    "lankarani-nikravesh": "0.75 * (1.0 - e * e)",
    "lee-wang": "0.75 * (1.0 - e)",
    "safaeifar": "1.25 * (1.0 - e) / e",
    "zhiying-qishao": "0.75 * (1.0 - e * e) * math.exp(2.0 * (1.0 - e))",
}

_DAMPING_RATIO = "ratio = -math.log(p.restitution) / math.hypot(math.pi, math.log(p.restitution))"
_LINEAR = (
    f"{_DAMPING_RATIO}\nreturn p.stiffness * delta + 2.0 * ratio * math.sqrt(p.stiffness * "
    "p.effective_mass) * rate"
)

# without adams-poisson: its force jumps at maximum compression, where an integrator with adaptive
# steps gets stuck
_FORCES = {
    "adams-impact": """\
s = min(delta / p.full_damping_penetration, 1.0)
damping = p.damping_max * s * s * (3.0 - 2.0 * s)
return max(0.0, p.stiffness * delta**p.exponent + damping * rate)""",
    "anagnostopoulos": _LINEAR,
    "hertz": "return p.stiffness * delta**p.exponent",
    "jankowski": """\
e = p.restitution
ratio = 4.5 * math.sqrt(5.0) * (1.0 - e * e) / (e * (e * (9.0 * math.pi - 16.0) + 16.0))
damping = 2.0 * ratio * math.sqrt(p.effective_mass * p.stiffness) * delta**0.25
return p.stiffness * delta**1.5 + (damping * rate if rate > 0.0 else 0.0)""",
    "kuwabara-kono": "return max(0.0, p.stiffness * (delta**1.5 + 1.5 * p.dissipation_time * "
    "math.sqrt(delta) * rate))",
    "linear-spring-dashpot": _LINEAR,
    "tsuji": f"""\
{_DAMPING_RATIO}
damping = math.sqrt(5.0 * p.effective_mass * p.stiffness) * ratio * delta**0.25
return p.stiffness * delta**1.5 + damping * rate""",
    **{
        name: f"e = p.restitution\nfactor = {factor}\nreturn p.stiffness * delta**p.exponent * "
        "(1.0 + factor * rate / approach)"
        for name, factor in _FACTORS.items()
    },
}


_CREEP = 1e-4
"""Slip below which friction is proportional to it, over the first approach speed."""


def _force(law: ContactLaw) -> str:
    """Return the body of the Python function of a law's contact force."""
    if isinstance(law, LinearSpringDashpot) and law.damping is not None:
        return "return p.stiffness * delta + p.damping * rate"
    if isinstance(law, HuntCrossley) and law.dissipation is not None:
        return "return p.stiffness * delta**p.exponent * (1.0 + p.dissipation * rate)"
    if law.name not in _FORCES:
        raise InputError(
            f"{law.name} can't be written for EXUDYN; {', '.join(sorted(_FORCES))} can. "
            'Take one of them, with the parameter that "vibroimpact calibrate" finds'
        )
    return _FORCES[law.name]


def _parameters(drop: Drop) -> str:
    """Return the lines of the law's parameters: the values of each parameter, one for all
    impacts or one for each.
    """
    rows = []
    for item in fields(drop.laws[0]):
        values = [getattr(law, item.name) for law in drop.laws]
        if values[0] is None or item.metadata["memory"]:
            continue
        given = [float(value) for value in values] if len(set(values)) > 1 else [float(values[0])]
        rows.append(
            f'    "{item.name}": {given},  # {item.metadata["meaning"]}, '
            f"{item.metadata['unit'] or '-'}"
        )
    return "\n".join(rows)


def _function(drop: Drop) -> str:
    """Return the line that evaluates a parameter as function of the approach speed,
    clipped to its range; "" if there is none.
    """
    if drop.function is None:
        return ""
    name, polynomial = drop.function
    terms = " + ".join(
        f"{value!r} * approach**{power}"
        for power, value in enumerate(map(float, polynomial.coefficients))
    )
    allowed: Range = next(item for item in fields(drop.laws[0]) if item.name == name).metadata[
        "range"
    ]
    low, high = float(allowed.clip(-math.inf)), float(allowed.clip(math.inf))
    inside = f"max({terms}, {low!r})" if math.isfinite(low) else terms
    inside = f"min({inside}, {high!r})" if math.isfinite(high) else inside
    return (
        f"    p.{name} = {inside}  # of the approach speed, fitted from "
        f"{polynomial.slowest:.6g} to {polynomial.fastest:.6g} m/s\n"
    )


def _friction(drop: Drop) -> FrictionLaw | None:
    return friction_in(drop, "EXUDYN", COULOMB)


def _along_plate(drop: Drop) -> tuple[str, str]:
    """Return the lines of the motion along the plate and the spin, and those that print
    them; none if there is no such motion.
    """
    if drop.oblique is None:
        return "", ""
    law, oblique = _friction(drop), drop.oblique
    coefficient = 0.0 if law is None else float(law.coefficient)
    (x, y), (about_x, about_y, about_z) = (
        tuple(map(float, values)) for values in (oblique.velocity, oblique.spin)
    )
    return (
        f'''
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

# along the plate, and about x and y; the spin about the normal stays
FRICTION, PULL = {coefficient!r}, {tuple(map(float, oblique.gravity))!r}  # coefficient, and gravity along the plate
CREEP = {_CREEP * approach_speeds(drop)[0]!r}  # m/s; below this slip friction is proportional to it
SPIN_ABOUT_NORMAL = {about_z!r}


def forces_along_plate(mbs, t, item, angles, rates):
    """The forces along x and y, and the moments about x and y."""
    gap, velocity = state()
    pressing = max(contact_force(-gap, -velocity, now.approach, now.p), 0.0) if now.in_contact and gap < 0.0 else 0.0
    slip = rates[0] - RADIUS * rates[3], rates[1] + RADIUS * rates[2]
    x, y = (-FRICTION * pressing * part / max(math.hypot(*slip), CREEP) for part in slip)
    return [x + MASS * PULL[0], y + MASS * PULL[1], RADIUS * y, -RADIUS * x]


INERTIA = {drop.inertia_ratio!r} * MASS * RADIUS**2
rates = {[x, y, about_x, about_y]!r}
start = {{"referenceCoordinates": [0] * 4, "initialCoordinates": [0] * 4, "initialCoordinates_t": rates}}
moving = mbs.AddNode(NodeGenericODE2(**start, numberOfODE2Coordinates=4))
masses = [[(MASS, MASS, INERTIA, INERTIA)[i] if i == j else 0.0 for j in range(4)] for i in range(4)]
mbs.AddObject(ObjectGenericODE2(nodeNumbers=[moving], massMatrix=masses, forceUserFunction=forces_along_plate))
''',
        """\
    x, y, about_x, about_y = mbs.systemData.GetODE2Coordinates_t()[1:]
    print(
        f"impact {impact + 1}: velocity along the plate {x:.9g} {y:.9g} m/s, "
        f"spin {about_x:.9g} {about_y:.9g} {SPIN_ABOUT_NORMAL:.9g} rad/s"
    )
""",
    )


def _notes(drop: Drop) -> list[str]:
    return [*shared_notes(drop), *friction_notes(drop, "EXUDYN", _friction(drop))]


def _write(drop: Drop) -> Mapping[str, bytes]:
    law, speeds = drop.laws[0], approach_speeds(drop)
    body = "\n".join(f"    {line}" for line in _force(law).splitlines())
    duration, _ = first_contact(law, drop)
    objects, print_motion = _along_plate(drop)
    # in the script a fall is integrated to the known time of first touch, and each contact
    # separately, with steps of its scale
    return {
        file_name(drop, "-exudyn.py"): f'''\
"""A sphere that falls on a plate, for EXUDYN 1.13 or later. Units: m, kg, s, N."""
# The contact law is {law.name}: {law.equation}
# The case "{plain_words(drop.name)}"
{comment_lines(_notes(drop))}
import math
from types import SimpleNamespace

import exudyn as exu
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
)

RADIUS, MASS, GRAVITY = {drop.radius!r}, {drop.mass!r}, {drop.gravity!r}
HEIGHT, SPEED = {drop.height!r}, {drop.speed!r}  # of the centre above the plate, and downwards
IMPACTS = {len(speeds)}
CONTACT = {duration!r}  # about how long a contact takes, s

# the parameters of the law, one value an impact; the last goes on
PARAMETERS = {{
{_parameters(drop)}
}}


def parameters(impact, approach):
    """Return the parameters of an impact, counted from 0, at an approach speed."""
    p = SimpleNamespace(**{{name: values[min(impact, len(values) - 1)] for name, values in PARAMETERS.items()}})
{_function(drop)}    return p


def contact_force(delta, rate, approach, p):
    """Return the force that pushes the sphere off the plate, at an indentation delta > 0 that grows at a rate."""
{body}


now = SimpleNamespace(approach=0.0, p=None, in_contact=False, largest=0.0)


def spring_force(mbs, t, item, position, velocity, *unused):
    """The force of the contact as EXUDYN takes it: positive pulls the sphere down."""
    return -contact_force(-position, -velocity, now.approach, now.p) if now.in_contact and position < 0.0 else 0.0


def goes_on(mbs, t):
    """Before each step: stop once the surfaces are apart."""
    gap, velocity = state()
    if now.in_contact and gap < 0.0:
        now.largest = max(now.largest, contact_force(-gap, -velocity, now.approach, now.p))
    return not (now.in_contact and gap > 0.0 and velocity > 0.0)


container = exu.SystemContainer()
mbs = container.AddSystem()
ground = mbs.AddNode(NodePointGround())
node = mbs.AddNode(Node1D(initialCoordinates=[HEIGHT - RADIUS], initialVelocities=[-SPEED]))  # the gap
mbs.AddObject(Mass1D(mass=MASS, nodeNumber=node))
plate = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
sphere = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
mbs.AddObject(CoordinateSpringDamper(markerNumbers=[plate, sphere], springForceUserFunction=spring_force))
mbs.AddLoad(LoadCoordinate(markerNumber=sphere, load=-MASS * GRAVITY))
{objects}mbs.SetPreStepUserFunction(goes_on)
mbs.Assemble()


def state():
    """Return the gap and the velocity, upwards."""
    data = mbs.systemData
    return float(data.GetODE2Coordinates()[0]), float(data.GetODE2Coordinates_t()[0])


def advance(duration, steps):
    """Integrate from the state now, in so many steps or more."""
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.minimumStepSize = 1e-9 * CONTACT
    settings.timeIntegration.relativeTolerance = 1e-10
    settings.timeIntegration.absoluteTolerance = 1e-14
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.DOPRI5)
    initial = exu.ConfigurationType.Initial
    mbs.systemData.SetODE2Coordinates(mbs.systemData.GetODE2Coordinates(), initial)
    mbs.systemData.SetODE2Coordinates_t(mbs.systemData.GetODE2Coordinates_t(), initial)


def speed_at_touch():
    """Return the speed that the sphere has, or had, where the gap is zero."""
    gap, velocity = state()
    return math.sqrt(velocity**2 + 2.0 * GRAVITY * gap)


gap, velocity = HEIGHT - RADIUS, -SPEED
for impact in range(IMPACTS):
    if gap > 0.0:
        advance((velocity + math.sqrt(velocity**2 + 2.0 * GRAVITY * gap)) / GRAVITY, 1)
        gap, velocity = state()
    now.in_contact, now.approach, now.largest = True, -velocity, 0.0
    now.p = parameters(impact, now.approach)
    advance(20.0 * CONTACT, 20000)
    now.in_contact = False
    gap, velocity = state()
    if gap <= 0.0:
        print("the sphere stays in contact")
        break
    speed = speed_at_touch()
    print(
        f"impact {{impact + 1}}: approach speed {{now.approach:.9g}} m/s, restitution {{speed / now.approach:.9g}}, "
        f"rebound height {{RADIUS + speed**2 / (2.0 * GRAVITY):.9g}} m, largest force {{now.largest:.9g}} N"
    )
{print_motion}'''.encode()
    }


FORMAT = ExportFormat(
    name="exudyn",
    program="EXUDYN",
    files="a Python script (.py)",
    tested="run with EXUDYN 1.13.6, compared with vibroimpact's drops between rigid bodies, "
    "oblique ones too",
    write=_write,
    notes=_notes,
    prepare=as_rigid,
)
