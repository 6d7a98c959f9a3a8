r"""The dimensionless map of oblique impacts: the velocity of the contact point after the impact
over that before.

.. math:: \psi = \frac{G^*}{\mu E^*}\, \frac{v_s}{v_n}

with the approach speed :math:`v_n` along the normal. For equal materials :math:`G^*/E^*` is
:math:`2(1-\nu)/(2-\nu)`. Impacts that do not
lose energy along the normal lie on one curve, whatever their speeds, sizes and coefficients, and on
a straight line where they slip throughout.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Level, Line, Mark
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw

_ABOVE = 1.5
"""The line of sliding is drawn from this ψ below zero; impacts without loss slip
throughout from 1 below zero on.
"""

_ALIKE = 0.01
"""Relative spread of restitutions up to which one line of sliding is drawn."""


def moduli_ratio(law: FrictionLaw, case: Case | None) -> float:
    """Return E*/G* of a friction law, or of the materials of a case where the law has no
    moduli; NaN where neither tells it.
    """
    if isinstance(law, CompliantFriction):
        return float(law.effective_modulus / law.effective_shear_modulus)
    pair = None if case is None else contact_pair(case)
    if (
        pair is None
        or pair.effective_shear_modulus is None
        or not np.isfinite(pair.effective_modulus)
    ):
        return np.nan
    return float(pair.effective_modulus / pair.effective_shear_modulus)


def slips(impacts: Mapping[str, Floats], radius: Floats | float) -> tuple[Floats, Floats]:
    """Return the speed of the contact point along the plate before impacts, and its velocity after
    them in the same direction [m/s].

    Parameters
    ----------
    impacts : mapping of str to array, shape (n,)
        Columns of the impact table.
    radius : float or array, shape (n,)
        Radius of the sphere [m].
    """
    before, after = (
        np.stack(
            [
                impacts[f"{motion}_velocity_x_m_s"] - radius * impacts[f"spin_y_{when}_rad_s"],
                impacts[f"{motion}_velocity_y_m_s"] + radius * impacts[f"spin_x_{when}_rad_s"],
            ]
        )
        for motion, when in (("approach", "before"), ("separation", "after"))
    )
    speed = np.hypot(*before)
    with np.errstate(invalid="ignore"):
        return speed, np.asarray((before * after).sum(axis=0) / speed)


def slip_map(
    marks: Sequence[Mark],
    before: Floats,
    restitution: Floats,
    ratio: Floats,
    inertia_ratio: Floats | float,
    caption: str,
) -> Chart:
    r"""Return the chart of the dimensionless map, with the line of impacts that slip throughout, if
    there is one for all of them.

    Parameters
    ----------
    marks : sequence of marks
        The impacts.
    before, restitution, ratio : array, shape (n,)
        Dimensionless slips before the impacts, their restitutions along the normal, and E*/G*.
    inertia_ratio : float or array, shape (n,)
        Moment of inertia of the spheres over mass and square of the radius.
    caption : str
        What the marks are.

    References
    ----------
    Maw, N., Barber, J. R. and Fawcett, J. N. (1976). The oblique impact of elastic spheres. Wear
    38, 101-114.
    """
    lines: list[Mark] = [Level(0.0)]
    lost = (1.0 + 1.0 / inertia_ratio) * (1.0 + restitution) / ratio
    if len(before) and np.ptp(lost) <= _ALIKE * lost.mean():
        ends = np.array([max(float(lost.mean()) - _ABOVE, 0.0), float(before.max())])
        lines.append(Line(ends, ends - lost.mean(), "slips throughout", "reference"))
    across = Axis("ψ before, G* v / (μ E* vₙ)")
    up = Axis("ψ after")
    phrase = (
        "v is the velocity of the contact point along the plate, vₙ the approach speed along "
        "the normal (Maw, Barber and Fawcett 1976)."
    )
    panel = Panel(across, up, (*lines, *marks))
    return Chart(
        "slip_map",
        "Slip after the impact over slip before",
        ((panel,),),
        f"{caption} {phrase}",
        height=3.4,
    )
