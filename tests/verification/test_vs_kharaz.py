"""Oblique impacts of an alumina sphere on glass, against the measurements of Kharaz, Gorham and
Salman (Powder Technol. 120:281, 2001).

The measured values are read off their figure, by others: they are those of the test DEM05 of MFiX,
rounded.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from agreement import Against, Agrees
from oblique_measured import (
    ALL,
    ANGLES,
    FRICTION,
    MEASURED,
    SLIPPING,
    SPEED,
    STICKING,
    fitted_friction,
    tangential_restitution,
)

SOURCE = (
    "Kharaz, Gorham and Salman 2001, Powder Technol. 120, 281, doi 10.1016/S0032-5910(01)00283-2; "
    "their coefficient of friction, 0.092, is from their impacts that slide throughout, from 30° on"
)
AGAINST = Against(
    "Kharaz, Gorham and Salman, oblique impacts of alumina spheres on glass, 2° to 20°",
    "experiment",
    "oblique impact and friction",
    SOURCE,
)
SLIDING = Against(
    "Kharaz, Gorham and Salman, oblique impacts of alumina spheres on glass, 30° to 60°",
    "fitted to measurements",
    "oblique impact and friction",
    SOURCE,
)


DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize(
    ("friction", "error", "sticking", "slipping"),
    [
        ("mdr", 0.0094, 0.0147, 0.0042),
        ("mindlin", 0.0664, 0.1286, 0.0042),
        ("mindlin-rescale", 0.0441, 0.0841, 0.0040),
        ("mindlin-force", 0.0513, 0.0986, 0.0042),
        ("coulomb", 0.0390, 0.0676, 0.0105),
    ],
)
def test_mean_error_of_the_tangential_restitution(
    agrees: Agrees, friction: str, error: float, sticking: float, slipping: float
) -> None:
    """Single springs miss the measurements by five to seven times as much as Mindlin's
    contact; friction is from steep impacts.
    """
    computed = tangential_restitution(friction)
    for rows, mean, against in ((STICKING, sticking, AGAINST), (SLIPPING, slipping, SLIDING)):
        agrees(
            f"friction law {friction}, four impact angles",
            "tangential coefficient of restitution",
            computed[rows],
            MEASURED[rows],
            against=against,
            mean=mean + 2e-4,
        )
    found = np.abs(computed - MEASURED).mean()
    assert found == pytest.approx(error, abs=2e-4)
    assert (found < 0.010) == (friction == "mdr")


def test_the_table_of_the_documentation() -> None:
    rows = re.findall(
        r"^\| ([\d.]+)° \| (.+) \|$", (DOCS / "oblique.md").read_text(encoding="utf-8"), re.M
    )
    laws = ("mdr", "mindlin", "mindlin-rescale", "mindlin-force", "coulomb")
    computed = np.stack([MEASURED, *(tangential_restitution(law) for law in laws)], axis=1)
    assert [float(angle) for angle, _ in rows] == np.degrees(ANGLES).round(2).tolist()
    np.testing.assert_allclose(
        [[float(cell) for cell in cells.split(" | ")] for _, cells in rows], computed, atol=5.1e-4
    )


def test_steep_impacts_do_not_depend_on_the_tangential_compliance() -> None:
    """From 39 degrees on the contact slips throughout, and all laws agree with the
    impulse of sliding.
    """
    for friction in ("mdr", "mindlin", "mindlin-force", "mindlin-rescale"):
        np.testing.assert_allclose(
            tangential_restitution(friction)[6:], tangential_restitution("coulomb")[6:], atol=1e-6
        )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "rows", "coefficient", "interval"),
    [
        ("mdr", ALL, 0.0942, (0.0876, 0.1009)),
        ("mindlin", ALL, 0.0627, (0.0293, 0.1350)),
        ("coulomb", ALL, 0.0920, (0.0617, 0.1503)),
        ("mdr", SLIPPING, 0.0919, (0.0880, 0.0958)),
        ("mindlin", SLIPPING, 0.0919, (0.0880, 0.0958)),
    ],
)
def test_the_coefficient_that_fits(
    friction: str, rows: slice, coefficient: float, interval: tuple[float, float]
) -> None:
    """That of Kharaz, 0.092 from steep impacts, is what steep impacts give under any law, and all
    impacts under Mindlin's contact.

    Numbers beside it are records of what the fit gives; in gross sliding it is a straight line.
    """
    found = fitted_friction(friction, rows)
    assert found.values == pytest.approx([coefficient], abs=2e-4)
    assert found.intervals is not None
    assert found.intervals[0] == pytest.approx(interval, abs=1e-3)
    assert found.intervals[0, 0] < FRICTION < found.intervals[0, 1]
    if rows == SLIPPING:
        x = (1.0 + found.outcomes["separation_speed"] / (SPEED * np.cos(ANGLES[rows]))) / np.tan(
            ANGLES[rows]
        )
        assert found.values == pytest.approx(
            [x[1:] @ (1.0 - MEASURED[rows][1:]) / (x[1:] @ x[1:])], rel=0.02
        )
