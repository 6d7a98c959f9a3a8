"""The energy that friction takes while a part of a contact sticks."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import CompliantFriction


def lost_in_microslip(law: CompliantFriction, normal: Floats, friction: Floats, moved: Floats, slid: Floats) -> float:
    """Return what friction took on a way [J], but while all of the contact slid; less its elastic energy, where it slides at the end.

    `normal`: forces [N] (T,). `friction`: forces [N] (T, 2). `moved`: displacements between them [m] (T - 1, 2). `slid`: on the way to
    each of them [m] (T,).
    """
    normal = np.maximum(normal, 0.0)
    mean, slides = 0.5 * (normal[1:] + normal[:-1]), (slid > 0.0) | (normal == 0.0)
    taken = 0.5 * ((friction[1:] + friction[:-1]) * moved).sum(axis=1) - law.coefficient * mean * slid[1:]
    return float(np.where(slides[1:] & slides[:-1], np.diff(law.energy_in_sliding(normal)), taken).sum())
