"""What is said where a drop is written for a program that takes as rigid what deforms."""

from __future__ import annotations

from collections.abc import Mapping

from vibroimpact.arrays import Floats
from vibroimpact.exporting.drop import Drop

_SHOWN = 5
"""Impacts whose restitutions are told."""


def rigid_notes(drop: Drop) -> list[str]:
    """Return what a drop has lost where what deforms is taken as rigid, what that does to its restitution, and a remedy."""
    lost, remedy = [], []
    if drop.elastic:
        verb = "is" if len(drop.elastic) == 1 else "are"
        lost.append(f"The {' and '.join(drop.elastic)} {verb} written as rigid, and the contact law alone, without what vibrates.")
        remedy.append('model = "rigid"')
    if drop.local_element:
        lost.append("The local element in series with the contact law, which stands for the sphere's deformation, is left out.")
        remedy.append("no contact.local_compliance")
    if drop.finite_sphere:
        lost.append("The contact law is written with Hertz's half space for the sphere, whose finite size was corrected here.")
        remedy.append("no contact.finite_sphere")
    if not drop.here:
        return lost
    written, here = (_restitutions(impacts) for impacts in (drop.impacts, drop.here))
    return [
        *lost,
        "So what is written is another drop than the one that was run: the same case between rigid bodies, with the first "
        "value of the contact law at its first impact, and so on.",
        f"Restitution from impact to impact: {written} as written, {here} in the run.",
        f"For rigid bodies that rebound as in the run, calibrate the case with {' and '.join(remedy)} to the run's impacts.csv as "
        "[calibrate] target, and export the calibration.",
    ]


def _restitutions(impacts: Mapping[str, Floats]) -> str:
    values = impacts["restitution_achieved"].tolist()
    return ", ".join(f"{value:.3f}" for value in values[:_SHOWN]) + (", ..." if len(values) > _SHOWN else "") if values else "none"
