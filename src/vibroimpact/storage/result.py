"""A finished run as plain data: what a result folder holds, and what a report is made from."""

from __future__ import annotations

import math
import platform
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact._version import __version__
from vibroimpact.cases.doubts import doubts
from vibroimpact.dynamics.response import Response


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
    """

    case: Mapping[str, Any]
    impacts: dict[str, NDArray[np.float64]]
    history: dict[str, NDArray[np.float64]]
    energy: dict[str, float]
    status: str
    provenance: Mapping[str, str] = field(default_factory=dict)

    @property
    def doubts(self) -> list[str]:
        """What to doubt of it: where its assumptions are strained."""
        peaks = (self.impacts[name] for name in ("max_indentation_m", "max_force_N"))
        return doubts(self.case, *(float(peak.max()) if len(peak) else math.nan for peak in peaks))

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
    return Result(
        case=response.problem.source or {},
        impacts=response.impacts,
        history=response.history(),
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
    )
