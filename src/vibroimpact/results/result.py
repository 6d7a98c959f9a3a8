"""A finished run as plain data: what a result folder holds, and what a report is made from."""

from __future__ import annotations

import math
import platform
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.cases.conditions import DropSummary
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.limits.plate_waves import plate_theory_error
from vibroimpact.cases.sensor_doubts import sensor_doubts
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.dynamics.vibrating.sensitivity import RELATIVE_CHANGE, change_by_impact
from vibroimpact.results.deflection import Deflection, deflection_of
from vibroimpact.results.fine_history import fine_history
from vibroimpact.results.peaks import Peaks, peaks_of


@dataclass(frozen=True)
class Result:
    """One drop's result.

    Parameters
    ----------
    case : mapping
        The resolved case, in SI, as `case.toml` holds it; empty for a problem made in Python.
    impacts : dict of str to array
        The impact table, (impacts,) a column.
    history : dict of str to array
        The history on a grid that resolves every contact, (times,) a column.
    energy : dict of str to float
        The ledger at the end.
    status : str
        Why the run ended.
    provenance : mapping
        Version, time and machine that made it.
    deformation : mapping
        How the deformation of the bodies is modelled: words and numbers, whose names end in their units.
    truncation : mapping of str to float
        About how far the largest force is off for the modes left out, as a part of it, by the name of the body.
    peaks : mapping
        Peaks and frequencies of "sphere" and "plate", where they have modes.
    signals : mapping of str to Signal
        What the sensors recorded.
    deflection : Deflection, optional
        The plate's upper side at chosen times.

    The last five are empty where nothing but the contact deforms.
    """

    case: Mapping[str, Any]
    impacts: dict[str, Floats]
    history: dict[str, Floats]
    energy: dict[str, float]
    status: str
    provenance: Mapping[str, str] = field(default_factory=dict)
    deformation: Mapping[str, float | str] = field(default_factory=dict)
    truncation: Mapping[str, float] = field(default_factory=dict)
    peaks: Mapping[str, Peaks] = field(default_factory=dict)
    signals: Mapping[str, Signal] = field(default_factory=dict)
    deflection: Deflection | None = None

    @property
    def vibrates(self) -> bool:
        """Does anything but the contact deform?"""
        return "plate_deflection_m" in self.history

    def frequencies(self, body: str) -> list[float]:
        """Return the frequencies of the modes of "sphere" or "plate" [Hz], ascending; none of a rigid one."""
        found = self.peaks.get(body, {}).get("frequencies_Hz", [])
        return found if isinstance(found, list) else []

    @property
    def change_by_impact(self) -> Floats:
        """Relative change of each impact [-] for one in the drop that nobody can rule out: of 1e-9, or of the tolerance if larger."""
        return change_by_impact(self.impacts, float(self.provenance.get("tolerance", RELATIVE_CHANGE)))

    @property
    def doubts(self) -> list[str]:
        """What to doubt of it: where its assumptions are strained."""
        found = doubts(self.case, self._seen)
        found += str(self.deformation.get("doubts", "")).splitlines()  # of the meshes
        highest = max(self.frequencies("plate"), default=math.nan)
        return found + sensor_doubts(self.case, self.signals, highest, float(self._seen.duration))

    @property
    def _seen(self) -> DropSummary:
        """What came of the drop, to which the limits of the theory are applied."""
        if not len(self.impacts["impact"]):
            return DropSummary()
        force, depth = (float(self.impacts[name].max()) for name in ("max_force_N", "max_indentation_m"))
        duration, speed = time_of_contact(self.impacts), float(self.impacts["approach_speed_m_s"][0])
        deflection = float(self.peaks.get("plate", {}).get("max_bending_m") or math.nan)
        modes = {body: (part, self.frequencies(body)[-1]) for body, part in self.truncation.items()}
        theory = plate_theory_error(self.deformation, self.impacts)
        return DropSummary(force, depth, duration, speed, deflection, modes, self.change_by_impact, theory)

    @property
    def name(self) -> str:
        """The name of the case."""
        return str(self.case.get("name", "")) or "a drop"


def result_of(response: Response) -> Result:
    """Return the result of a response to one drop.

    Raises
    ------
    InputError
        If the response is of several drops.
    """
    history = fine_history(response)
    return Result(
        case=response.problem.source or {},
        impacts=response.impacts,
        history=history,
        energy={name: float(value) for name, value in response.energy.items()},
        status=response.status,
        provenance={
            "version": __version__,
            "created": datetime.now(UTC).isoformat(timespec="seconds"),
            "python": platform.python_version(),
            "numpy": np.__version__,
            "platform": platform.platform(),
            "tolerance": f"{response.problem.tolerance:g}",
            **({} if response.problem.source else {"problem": repr(response.problem)}),
        },
        deformation=dict(response.problem.facts),
        truncation=response.truncation,
        peaks=peaks_of(response, history),
        signals=response.signals() if response.problem.sensors else {},
        deflection=deflection_of(response),
    )
