"""The result of one drop as plain data: content of a result folder and input of its report."""

from __future__ import annotations

import math
import platform
from collections.abc import Container, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cached_property

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.cases.doubts import doubts, errors_of
from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.cases.sensor_doubts import sensor_doubts
from vibroimpact.cases.validity.plate_mesh import plate_mesh_error
from vibroimpact.cases.validity.plate_waves import plate_theory_error
from vibroimpact.dynamics.change_by_impact import RELATIVE_CHANGE, change_by_impact
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.report.html_report import html_summary
from vibroimpact.report.reported import Reported
from vibroimpact.report.result_warning import ResultWarning, ranked
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.results.deflection import Deflection, deflection_of
from vibroimpact.results.fine_history import fine_history
from vibroimpact.results.peaks import Peaks, peaks_of
from vibroimpact.results.plate_shape import PlateShape, plate_shape_of


@dataclass(frozen=True)
class Result(Reported, reported_in="vibroimpact.runs.report"):
    """Result of one drop: impact table, histories, energy balance and signals.

    Its last five fields are empty where nothing but the contact deforms.

    Its charts, which `plot` draws by their names, are "setup", "position", "force", "velocity",
    "acceleration", "force_indentation" and "energy"; where bodies vibrate also "sphere_energy",
    "plate_motion", "plate_energy", "deflection", and "sensor NAME" for each sensor.

    Parameters
    ----------
    case : ResolvedCase
        Resolved case in SI units, as in `case.toml`; empty for a problem defined in Python.
    impacts : dict of str to array
        Impact table: columns of shape (impacts,).
    history : mapping of str to array
        History on a time grid that resolves every contact, but for very long runs: columns of shape
        (times,).
    energy : dict of str to float
        Energy ledger at the end of the run: energies [J], and the relative closure.
    status : str
        Sentence stating why and when the run ended.
    provenance : mapping
        Software versions, platform, time of creation and tolerance.
    deformation : mapping
        Facts about how the deformation of the bodies is modelled: words, and numbers whose keys end
        in their units.
    truncation : mapping of str to float
        Estimated relative error of the largest force due to modal truncation, by body name.
    peaks : mapping
        Peak values and frequencies of "sphere" and "plate", where these have modes.
    signals : mapping of str to Signal
        Sensor signals, by sensor name.
    deflection : Deflection, optional
        Deflection of the plate's upper side at selected times.
    plate_shape : PlateShape, optional
        Outlines of a plate whose mesh was brought.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> result = vi.result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    >>> result.status
    'Stopped after 5 impacts, at the top of the last rebound, at 5.11709 s.'
    >>> len(result.doubts), result.plot("energy").layout.title.text
    (3, 'Energy')
    """

    case: ResolvedCase
    impacts: dict[str, Floats]
    history: Mapping[str, Floats]
    energy: dict[str, float]
    status: str
    provenance: Mapping[str, str] = field(default_factory=dict)
    deformation: Mapping[str, float | str] = field(default_factory=dict)
    truncation: Mapping[str, float] = field(default_factory=dict)
    peaks: Mapping[str, Peaks] = field(default_factory=dict)
    signals: Mapping[str, Signal] = field(default_factory=dict)
    deflection: Deflection | None = None
    plate_shape: PlateShape | None = None

    @property
    def vibrates(self) -> bool:
        """Whether anything but the contact deforms, or anything but the sphere moves.

        The history then has further columns.
        """
        return "plate_deflection_m" in self.history

    def frequencies(self, body: str) -> list[float]:
        """Return the modal frequencies of "sphere" or "plate" [Hz], ascending.

        The list of a rigid body is empty.
        """
        frequencies = self.peaks.get(body, {}).get("frequencies_Hz", [])
        return frequencies if isinstance(frequencies, list) else []

    @property
    def change_by_impact(self) -> Floats:
        """Relative change of each impact [-] for a relative perturbation of the drop.

        The perturbation is 1e-9, or the tolerance if that is larger.
        """
        tolerance = float(self.provenance.get("tolerance", RELATIVE_CHANGE))
        return change_by_impact(self.impacts, tolerance)

    @property
    def doubts(self) -> list[str]:
        """Warnings of assumptions and ranges of validity that the run exceeds.

        Those that change most are first.
        """
        return self.doubts_but()

    def doubts_but(self, aside: Container[str] = ()) -> list[str]:
        """Return the doubts, without slips of units in the values of some keys.

        Parameters
        ----------
        aside : container of str
            Dotted keys whose values are not checked for slips.
        """
        summary = self._drop_summary
        highest_frequency = max(self.frequencies("plate"), default=math.nan)
        of_sensors = sensor_doubts(
            self.case,
            self.signals,
            highest_frequency,
            float(summary.duration),
            self._first_contact(),
        )
        of_drop = doubts(self.case, summary, aside)
        return ranked([*of_drop, *self._doubts_of_meshes(), *of_sensors])

    def _doubts_of_meshes(self) -> list[str]:
        """Return the warnings about the meshes of the bodies."""
        sentences = str(self.deformation.get("doubts", "")).splitlines()
        # results of earlier versions do not have them
        effects = str(self.deformation.get("doubt_effects", "")).splitlines()
        effects += ["nan"] * (len(sentences) - len(effects))
        return [
            ResultWarning(sentence, float(effect))
            for sentence, effect in zip(sentences, effects, strict=True)
        ]

    @cached_property
    def relative_errors(self) -> Mapping[str, float]:
        """Estimated relative errors of results of the first impact, by their names.

        They are what the limits of the theory, modes left out and meshes change; what is not
        estimated is not in them.
        """
        return errors_of(self.case, self._impact_summary)

    def _first_contact(self) -> tuple[float, float] | None:
        """Return x and y of the first contact on the plate [m], of a sphere that moves along it."""
        columns = (
            ("place_on_plate_x_m", "place_on_plate_y_m"),
            ("position_x_m", "position_y_m"),
        )
        for column_x, column_y in columns:
            if column_x in self.impacts and len(self.impacts[column_x]):
                return float(self.impacts[column_x][0]), float(self.impacts[column_y][0])
        return None

    @property
    def _drop_summary(self) -> DropSummary:
        """The outcomes of the drop that the limits of the theory are checked against."""
        deflection = float(self.peaks.get("plate", {}).get("max_bending_m") or math.nan)
        return replace(self._impact_summary, deflection=deflection)

    @property
    def _impact_summary(self) -> DropSummary:
        """Those of them that the history of the plate is not needed for."""
        impacts = self.impacts
        if not len(impacts["impact"]):
            return DropSummary()
        # the largest error by truncation and the highest retained frequency of each elastic body
        modes = {
            body: (error, self.frequencies(body)[-1]) for body, error in self.truncation.items()
        }
        return DropSummary(
            force=float(impacts["max_force_N"].max()),
            depth=float(impacts["max_indentation_m"].max()),
            duration=time_of_contact(impacts),
            speed=float(impacts["approach_speed_m_s"][0]),
            modes=modes,
            changes=self.change_by_impact,
            plate_theory=plate_theory_error(self.deformation, impacts),
            plate_mesh=plate_mesh_error(self.deformation, impacts),
            slowest=float(impacts["approach_speed_m_s"].min()),
        )

    @property
    def name(self) -> str:
        """Name of the case; "a drop" if it has none."""
        return str(self.case.get("name", "")) or "a drop"

    def _repr_html_(self) -> str:
        return html_summary(self.report)


def result_of(response: Response) -> Result:
    """Return the result of a response to one drop.

    It holds its tables, the refined history, peaks, signals and deflection.

    Parameters
    ----------
    response : Response
        Response to one drop, as `simulate` returns it.

    Raises
    ------
    InputError
        If the response is of several drops, or keeps no history.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> result = vi.result_of(vi.simulate(vi.load_case("paper:type1-theory")))
    >>> len(result.impacts["time_s"]), round(float(result.history["force_N"].max()), 1)
    (5, 10239.2)
    """
    problem = response.problem
    history = fine_history(response)
    peaks = peaks_of(response, history)
    signals = response.signals() if problem.sensors else {}
    result = bare_result(response, history, peaks, signals, deflection_of(response))
    provenance = {
        "version": __version__,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": platform.platform(),
        "tolerance": f"{problem.tolerance:g}",
    }
    if not problem.source:
        # there is no case to repeat the drop from: the problem is described in words
        provenance["problem"] = repr(problem)
    return replace(result, provenance=provenance)


def bare_result(
    response: Response,
    history: Mapping[str, Floats],
    peaks: Mapping[str, Peaks],
    signals: Mapping[str, Signal],
    deflection: Deflection | None,
) -> Result:
    """Return the result of a response to one drop, without provenance.

    History, peaks, signals and deflection may be coarser than those of `result_of`.
    """
    return Result(
        case=response.problem.source or {},
        impacts=response.impacts,
        history=history,
        energy={name: float(value) for name, value in response.energy.items()},
        status=response.status,
        deformation=dict(response.problem.facts),
        truncation=response.truncation,
        peaks=peaks,
        signals=signals,
        deflection=deflection,
        plate_shape=plate_shape_of(response),
    )
