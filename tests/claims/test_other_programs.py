"""What pages say of files for other programs, and of contacts with these programs' own
values; none of the programs is run here.
"""

from __future__ import annotations

import math
import re
import runpy
from unittest import mock

import matplotlib.pyplot  # noqa: F401  before what it copies from is replaced
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import vibroimpact as vi
from exported_drops import MASS, RADIUS, ROCK, STEEL, told, told_case
from stated_numbers import ROOT, says
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.pair import ContactPair, effective_modulus
from vibroimpact.contact.registry import contact_laws
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import find_export_format
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.files.plain_names import plain_words
from vibroimpact.results.result import result_of

INDEX = "docs/index.md"
EXPORT = "docs/export.md"

PAIR = ContactPair(
    effective_modulus=effective_modulus(ROCK, STEEL), effective_radius=RADIUS, effective_mass=MASS
)
FORCES = re.compile(r"largest force (\S+) N, where the law has (\S+) N")


def law(name: str, **parameters: float) -> ContactLaw:
    return contact_laws()[name].for_pair(PAIR, **parameters)


def force_error(drop: Drop) -> float:
    """Return by how much the largest force of MuJoCo's contact is too large [%], as the
    exported model states both forces.
    """
    (text,) = find_export_format("mujoco").write(drop).values()
    theirs, ours = map(float, FORCES.search(text.decode()).groups())
    return 100.0 * (theirs / ours - 1.0)


def test_the_defaults_of_adams() -> None:
    steel = vi.materials.material_library()["steel"]
    impact = vi.laws.find_contact_law("adams-impact")
    defaults = impact(
        stiffness=1e5 * 1000**2.2, exponent=2.2, damping_max=10e3, full_damping_penetration=1e-4
    )
    mass = steel.density * 4.0 / 3.0 * math.pi * 0.020**3
    says(
        INDEX,
        "With the defaults of *Impact* a {} mm steel ball at {} m/s has a [restitution of {}]",
        40.0,
        3.0,
        vi.laws.achieved_restitution(defaults, mass=mass, speed=3.0),
    )


def test_largest_force_of_a_linear_contact() -> None:
    """Which has the restitution and the duration of the law; the height of the drop does
    not matter.
    """
    hertz = [force_error(told(law("hertz"), number=1, height=height)) for height in (0.1, 1.0, 4.0)]
    np.testing.assert_allclose(hertz, hertz[0], rtol=1e-3)
    says(EXPORT, "For Hertz's law without damping it is {} % low", -hertz[0])
    says(
        EXPORT,
        "for the first impact of the paper's drop {} %",
        -force_error(told_case("paper:type1-variable")),
    )
    errors = {
        (name, restitution): force_error(
            told(law(name, restitution=restitution), number=1, height=1.0)
        )
        for name in ("hunt-crossley", "flores", "tsuji")
        for restitution in (0.9, 0.7, 0.5, 0.3)
    }

    def low(name: str) -> tuple[float, float]:
        found = [-error for (one, _), error in errors.items() if one == name]
        return min(found), max(found)

    says(EXPORT, "with Hunt and Crossley's law it is {} to {} % low", *low("hunt-crossley"))
    says(
        EXPORT,
        "with Flores' {} to {} % (restitution parameters {} to {})",
        *low("flores"),
        0.9,
        0.3,
    )
    says(
        EXPORT,
        "with Tsuji's law it is {} % low for {} and {} % high for {}",
        *(-errors["tsuji", 0.9], 0.9),
        *(errors["tsuji", 0.3], 0.3),
    )


def test_units_of_adams() -> None:
    stiffness = 5.115e8
    says(
        EXPORT,
        "({} N/m^1.5 is {} N/mm^1.5)",
        stiffness,
        vi.units.convert_units(stiffness, "N/m^1.5", "N/mm^1.5"),
    )
    says(
        EXPORT,
        "A stiffness in N/m^n is therefore divided by {}^n",
        vi.units.convert_units(1.0, "m", "mm"),
    )
    says(EXPORT, "a damping in N s/m by {}", 1.0 / vi.units.convert_units(1.0, "N*s/m", "N*s/mm"))


def test_samples_of_a_universal_file() -> None:
    """The worst place of two samples about the peak of a half-sine is half a step to
    either side.
    """
    samples = 20
    says(EXPORT, "with at least {} samples in the shortest contact", samples)
    says(
        EXPORT,
        "the peak of a half-sine is then accurate to {} %",
        100.0 * (1.0 - math.cos(0.5 * math.pi / samples)),
    )


def test_names() -> None:
    says(EXPORT, "at most {} characters. Files, materials", len(plain_words("x" * 1000)))


def test_frames_of_a_drop_with_many_impacts() -> None:
    case = vi.case_of(
        {
            "sphere": {"radius": "25 mm", "material": "rock-paper"},
            "plate": {"material": "steel-paper", "size": ["520 mm", "420 mm", "8 mm"]},
            "drop": {"height": "1 m"},
            "contact": {"law": "tsuji", "restitution": 0.95},
            "run": {"impacts": 25},
        }
    )
    files = find_export_format("vtu").write(drop_of_result(result_of(vi.simulate(case)), case))
    even, events = 200, 3 * 20  # first touch, maximum indentation and release
    assert sum(name.startswith("sphere/") for name in files) == even + events
    says(EXPORT, "there are {} equally spaced frames over the run", even)
    says(EXPORT, "maximum indentation and release of the first {} impacts", events / 3)


def test_impedance_of_mujoco() -> None:
    (text,) = find_export_format("mujoco").write(told(law("hertz"), number=1)).values()
    least, most = map(float, re.search(r'solimp="(\S+) (\S+) ', text.decode()).groups())
    assert least == most
    says(EXPORT, "with an impedance of {}", most)


@pytest.mark.slow
def test_the_moving_picture() -> None:
    """That of examples/ringing_plate.py, without drawing it."""
    with mock.patch.object(Figure, "savefig"), mock.patch.object(Image, "open"):
        shown = runpy.run_path(str(ROOT / "examples" / "ringing_plate.py"))
    case, times, pauses = shown["CASE"], shown["times"], shown["pauses"]
    slower = 1e-3 * sum(pauses[:-1]) / (times[-1] - times[0])
    says(
        INDEX,
        "A rock of {} mm in diameter, dropped from {} m onto a steel plate of {} mm on four "
        "feet: {} ms, slowed down {2} times, "
        "deflection magnified {} times ({} mm at most)",
        2e3 * shown["RADIUS"],
        float(case["drop"]["height"].removesuffix(" m")),
        float(case["plate"]["size"][2].removesuffix(" mm")),
        1e3 * (times[-1] - times[0]),
        slower,
        shown["EXAGGERATION"],
        -1e3 * shown["heights"].min(),
    )
