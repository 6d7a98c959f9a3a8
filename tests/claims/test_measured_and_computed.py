"""Numbers of the guide that sets measured values beside computed ones."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from bounces_in_oil import (
    OIL_DENSITY,
    TRACKS,
    VISCOSITY,
    computed_restitution,
    fall_in,
    speed_at_touch,
)
from oblique_measured import (
    ALL,
    ANGLES,
    FRICTION,
    MEASURED,
    RADIUS,
    SLIPPING,
    SPEED,
    STICKING,
    fitted_friction,
    tangential_restitution,
)
from river_plate import amplitudes, class_limit
from stated_numbers import says

PAGE = "docs/guides/measured-and-computed.md"


def mean_error(friction: str, rows: slice) -> float:
    return float(np.abs(tangential_restitution(friction) - MEASURED)[rows].mean())


def test_oblique_impacts() -> None:
    says(
        PAGE,
        "alumina, {} mm in diameter, on thick glass, {} m/s; four angles of {} to {} degrees",
        2e3 * RADIUS,
        SPEED,
        *np.degrees(ANGLES[STICKING])[[0, -1]],
    )
    says(PAGE, "the same, four angles of {} to {} degrees", *np.degrees(ANGLES[SLIPPING])[[0, -1]])
    springs = [mean_error(law, STICKING) for law in ("mindlin", "mindlin-rescale", "mindlin-force")]
    says(PAGE, "mean error {} with microslip", mean_error("mdr", STICKING))
    says(
        PAGE,
        "{} with Coulomb's friction alone, {} to {} with single springs",
        mean_error("coulomb", STICKING),
        min(springs),
        max(springs),
    )
    for law in ("mdr", "mindlin", "mindlin-rescale", "mindlin-force"):
        says(
            PAGE,
            "mean error {} with `mdr` and with single springs, {} with Coulomb's friction alone",
            mean_error(law, SLIPPING),
            mean_error("coulomb", SLIPPING),
        )
    above = np.array(
        [
            tangential_restitution(law) - MEASURED
            for law in ("mindlin", "mindlin-rescale", "mindlin-force")
        ]
    ).max(axis=0)
    worst = int(above.argmax())
    says(
        PAGE,
        "is up to {} above the measured one, which is {} there, at {} degrees",
        above[worst],
        MEASURED[worst],
        np.degrees(ANGLES[worst]),
    )


@pytest.mark.slow
def test_the_friction_that_fits() -> None:
    found = fitted_friction("mdr", ALL)
    assert found.intervals is not None
    says(
        PAGE,
        "to such a table: {} ({} to {}) from all eight angles",
        float(found.values[0]),
        *found.intervals[0],
    )
    says(PAGE, "the authors obtained {} from impacts that slide throughout", FRICTION)


@pytest.mark.slow
def test_the_river_plate() -> None:
    sizes = [10.0, 12.3, 17.4, 21.8, 28.0, 37.6]
    off = [100.0 * (np.median(amplitudes(size)) / class_limit(size) - 1.0) for size in sizes]
    says(
        PAGE,
        "At an assumed {} m/s: {} % ({} mm), {} % ({} mm), {} % ({} mm), {} % ({} mm), {} % "
        "({} mm), {} % ({} mm)",
        1.0,
        *(value for pair in zip(off, sizes, strict=True) for value in pair),
    )


def test_three_bounces_in_oil() -> None:
    off = []
    for track in TRACKS.values():
        before, after = map(speed_at_touch, track)
        off.append(100.0 * (computed_restitution(before) * before / after - 1.0))
    says(PAGE, "to these and other measurements | {} %, {} %, {} %", *off)


def test_the_falls_before_bounces_in_oil() -> None:
    oil = vi.Liquid(density=OIL_DENSITY, viscosity=VISCOSITY)
    off = [1e6 * float(np.abs(np.subtract(*fall_in(stokes, oil))).max()) for stokes in (152, 82)]
    says(PAGE, "height and speed at the first measured point | at most {} µm and {} µm", *off)
