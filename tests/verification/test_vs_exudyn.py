"""Against EXUDYN's record of Hunt and Crossley's law: contactSphereSphereTest, speeds after an
impact at 10 m/s.

Its spring is linear there (n = 1); the numbers are its own, to its own accuracy of 1e-4.
"""

from __future__ import annotations

import pytest

from agreement import Against, Agrees
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.dynamics.restitution import integrated_restitution

AGAINST = Against(
    "EXUDYN, reference results of contactSphereSphereTest",
    "other program",
    "damping laws",
    "EXUDYN, TestModels/contactSphereSphereTest.py; accurate to 1e-4",
)


@pytest.mark.parametrize(
    ("asked", "speed"),
    [(0.9, 9.090299), (0.8, 8.329035), (0.5, 6.629838), (0.3, 5.813176), (0.1, 5.158574)],
)
def test_outgoing_speed(agrees: Agrees, asked: float, speed: float) -> None:
    law = HuntCrossley(stiffness=1e5, restitution=asked, exponent=1.0)
    found = 10.0 * integrated_restitution(law, 0.1, 10.0)
    agrees(
        "Hunt-Crossley law, n = 1, five nominal coefficients of restitution",
        "separation speed",
        found,
        speed,
        unit="m/s",
        relative=1e-4,
    )
