"""Numbers of the page of limits: thresholds as the program has them, and errors that are
computed again.
"""

from __future__ import annotations

import numpy as np

import vibroimpact as vi
from stated_numbers import says
from support import plain_case
from vibroimpact.cases import sensor_doubts
from vibroimpact.cases.elastic import modes
from vibroimpact.cases.limits.limit import limits
from vibroimpact.cases.validity import edge, modes_left_out, strength
from vibroimpact.cases.validity.adhesion import WORK_OF_ADHESION
from vibroimpact.cases.validity.finite_sphere import force_lacking
from vibroimpact.dynamics.change_by_impact import RELATIVE_CHANGE
from vibroimpact.dynamics.core.fall import HIGHEST_REYNOLDS
from vibroimpact.dynamics.fluids.air import AIR_DENSITY, SPEED_OF_SOUND
from vibroimpact.dynamics.fluids.liquid import CRITICAL_STOKES
from vibroimpact.structures.sphere_compliance import FITTED

PAGE = "docs/limits.md"

RADIUS, MODULUS, RATIO, DENSITY = 0.025, 2.26e9, 0.28, 1380.0
PAIR = MODULUS / (1.0 - RATIO**2)
IMPACTS = {0.115: 3270.9, 0.176: 12023.0, 0.307: 67731.0}
"""Largest forces [N] of finite elements over a/R, as test_vs_finite_sphere.py computes them."""


HERTZ = 1.5


def threshold(name: str, unit: float = 1.0) -> float:
    return unit * limits()[name].threshold


def test_thresholds() -> None:
    says(PAGE, "at the same energy | above {} %", threshold("finite_sphere", 100.0))
    says(
        PAGE,
        "contact radius over the radius of the sphere | above {} |",
        threshold("small_contact"),
    )
    says(
        PAGE,
        "as a [function of it](case-file.md#functions-of-the-approach-speed) | above {} |",
        threshold("speeds_given"),
    )
    says(PAGE, "over the tensile strength | above {} |", threshold("sphere_strength"))
    says(PAGE, "plastic flow at {} times the yield strength", strength._FULLY_PLASTIC)
    says(PAGE, "(Clift and Gauvin 1970; {} kg/m^3)", AIR_DENSITY)
    says(PAGE, "| above {} % | the loss, and the speed with drag", threshold("air_drag", 100.0))
    says(PAGE, "which `drop.air` leaves out | above {} %", threshold("air_buoyancy", 100.0))
    says(
        PAGE,
        "Reynolds number at first touch over {}, for flights in air or in a liquid, unless "
        "a drag coefficient is given | above {} |",
        HIGHEST_REYNOLDS,
        threshold("drag_coefficient"),
    )
    says(
        PAGE,
        "the speed of sound in air at 20 C, {} m/s, for flights in air | above {} |",
        SPEED_OF_SOUND,
        threshold("mach"),
    )
    says(PAGE, "distance of `exponent` from Hertz's {}, where", HERTZ)
    says(PAGE, "below a Stokes number of about {} (Joseph", CRITICAL_STOKES)
    says(PAGE, "over its thickness | above {} |", threshold("plate_deflection"))
    says(
        PAGE,
        "| {} contact radii (rigid plate) or {} thicknesses (elastic)",
        edge._RADII,
        edge._THICKNESSES,
    )
    says(
        PAGE, "a Hertzian contact as deep if that is shorter | above {} |", threshold("relaxation")
    )
    says(
        PAGE,
        "by a work of adhesion of {} J/m^2, for laws without adhesion (Thornton and Ning "
        "1998) | above {} %",
        WORK_OF_ADHESION,
        threshold("adhesion", 100.0),
    )
    says(
        PAGE,
        "above {} %; fewer than {} |",
        100.0 * modes_left_out._TRUNCATED,
        modes_left_out._CYCLES,
    )
    says(PAGE, "for a relative change of the drop of {}, or of the tolerance", RELATIVE_CHANGE)
    says(
        PAGE,
        "| above {} % | the change, and the first impact concerned",
        threshold("sensitivity", 100.0),
    )
    says(
        PAGE,
        "| above {} % | the error, and the duration of the contact",
        threshold("plate_waves", 100.0),
    )
    says(
        PAGE, "| above {} % | the error, and a smaller element size", threshold("plate_mesh", 100.0)
    )
    says(PAGE, "| above {} % | the number of modes", 100.0 * modes._FREQUENCY_OFF)
    says(
        PAGE,
        "below {}; above {} %; any; any; above {} %",
        sensor_doubts._NEAR,
        100.0 * sensor_doubts._DOUBTED_ERROR,
        100.0 * sensor_doubts._DOUBTED_SHARE,
    )
    says(
        PAGE,
        "Beyond a/R = {} the term is extrapolated; beyond {} a warning",
        FITTED[1],
        threshold("small_contact"),
    )


def force(part: float, *, corrected: bool) -> float:
    """Return the largest force of the rigid sphere that takes Hertz's contact to a radius."""
    mass = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
    speed = (0.8 * 4.0 / 3.0 * PAIR * RADIUS**0.5 * (part**2 * RADIUS) ** 2.5 / mass) ** 0.5
    bodies = {
        "sphere": {"radius": RADIUS, "material": "rock-paper"},
        "plate": {"material": "rigid"},
    }
    contact = {"law": "hertz", "finite_sphere": corrected}
    case = plain_case(
        **bodies, drop={"speed": speed, "gravity": 0.0}, contact=contact, run={"impacts": 1}
    )
    return float(vi.simulate(vi.case_of(case)).impacts["max_force_N"][0])


def test_the_finite_sphere() -> None:
    stated = [
        100.0
        * float(force_lacking(4.0 / 3.0 * PAIR * RADIUS**2 * part**3, RADIUS, PAIR, MODULUS, RATIO))
        for part in IMPACTS
    ]
    off = {}
    for corrected in (False, True):
        off[corrected] = [
            100.0 * (force(part, corrected=corrected) / exact - 1.0)
            for part, exact in IMPACTS.items()
        ]
    says(
        PAGE,
        "the force of the half space is {}, {} and {} % too small",
        *(-value for value in off[False]),
    )
    says(PAGE, "where {}, {} and {} % are printed", *stated)
    for (part, exact), without, corrected in zip(
        IMPACTS.items(), off[False], off[True], strict=True
    ):
        says(PAGE, "| {} | {} N | {} % | {} % |", part, exact, without, corrected)
