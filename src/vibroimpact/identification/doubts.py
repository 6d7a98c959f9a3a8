"""What an identification could not tell, and why."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Plate
from vibroimpact.identification.pulses import Search
from vibroimpact.identification.sphere import SphereFit

_LEFT = 1.3
"""What a fit leaves, over the noise, from which on the model is doubted."""
_PART = 0.05
"""What a fit leaves, over the rms value of the records, from which on it is doubted where the noise is not known."""
_WIDE = 0.25
"""Relative standard deviation from which on a number is not told."""
_PASSED = 1.2
"""End of what an anti-alias filter passes, over the end of its band."""


def doubts_about(plate: Plate, measured: Measured, search: Search, sphere: SphereFit, sought: bool) -> Iterator[str]:
    """Yield the doubts about an identification, one sentence each without its full stop.

    Parameters
    ----------
    plate, measured, search, sphere
        As those of an `Identification`.
    sought : bool
        Whether the place was sought.
    """
    highest, passed = float(plate.problem.models["plate"].frequencies[-1]), _PASSED * measured.band
    if highest < passed:
        words = f"the modes of the plate end at {highest:,.0f} Hz, and the sensors hear up to {passed:,.0f} Hz"
        more = f'ask for plate.max_frequency = "{math.ceil(passed / 1e3):d} kHz" or so'
        yield f"{words}; the intervals do not contain what the modes above lack; {more}"
    others = ", ".join(f"({1e3 * one.place[0]:.1f}, {1e3 * one.place[1]:.1f}) mm" for one in search.candidates[1:])
    if others:
        yield f"a force at {others} explains the records about as well; add a sensor off the axes of symmetry, or give the place"
    at_edge = np.abs(sphere.parameters[:2]) >= 0.999 * np.array(plate.half)
    if sought and at_edge.any():
        yield "the place lies at the edge of the plate, where none is sought"
    if not sphere.converged:
        yield "the fit of the sphere did not come to an end; its numbers are those of its last step"
    left = np.sqrt(np.mean(sphere.residual**2, axis=1))
    if measured.quiet and (ratio := float((left / measured.noise).max())) > _LEFT:
        words = f"the fit leaves {ratio:.2g} times the noise before first touch: the model differs from the plate"
        yield f"{words}; the intervals are wider by what it leaves, but do not contain a bias; state --frequency-error"
    if not measured.quiet:
        part = float((left / np.sqrt(np.mean(measured.value**2, axis=1))).max())
        if part > _PART:
            words = f"the fit leaves {100.0 * part:.2g} % of the records, and no noise before first touch explains it"
            yield f"{words}: the plate or the contact is not that of the case, or another sphere fits better; do not use these numbers"
    for name, deviation in zip(("radius", "speed"), np.sqrt(np.diag(sphere.covariance))[2:4].tolist(), strict=True):
        if deviation > _WIDE:
            yield f"the {name} is not told: its standard deviation is {100.0 * deviation:.2g} %"
