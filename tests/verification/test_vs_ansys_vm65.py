"""Against Ansys verification case VM65: a mass falls on a spring (lb, in, s), by its closed form.
Tolerance 1e-5.

m = 0.5, k = 1973.92, gap 1, g = 386: touch at 0.07198 s with 27.785, largest deflection 0.550666 at
0.100445 s.
"""

from __future__ import annotations

import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot

AGAINST = Against(
    "Ansys verification case VM65, mass falling on a spring",
    "closed form",
    "flight, bounces and shaken plates",
    "case of the Ansys Mechanical APDL Verification Manual, VM65 (US customary units: lb, "
    "in, s), of which this is the closed form",
)


def test_mass_on_spring(agrees: Agrees) -> None:
    law = LinearSpringDashpot(stiffness=1973.92, damping=0.0)
    ball = vi.Body(mass=0.5, contact_offset=0.0)
    response = vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0, gravity=386.0, impacts=1
        )
    )
    row = {name: column[0] for name, column in response.impacts.items()}
    agrees(
        "VM65, mass falling on a spring",
        "time of first contact",
        row["time_s"],
        0.07198,
        unit="s",
        absolute=5e-6,
    )
    agrees(
        "VM65, mass falling on a spring",
        "approach speed",
        row["approach_speed_m_s"],
        27.785,
        unit="in/s",
        absolute=5e-4,
    )
    agrees(
        "VM65, mass falling on a spring",
        "maximum spring deflection",
        row["max_indentation_m"],
        0.550666,
        unit="in",
        relative=1e-6,
    )
    agrees(
        "VM65, mass falling on a spring",
        "time of maximum spring deflection",
        row["time_of_max_indentation_s"],
        0.100445,
        unit="s",
        absolute=5e-7,
    )
    assert row["restitution_achieved"] == pytest.approx(1.0, rel=1e-9)
    assert response.energy["closure_relative"] <= 1e-9
