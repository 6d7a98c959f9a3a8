"""A study to be computed, as it is stated: case, axes, and kept results."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.rigid.rigid_problem import deforms
from vibroimpact.cases.rigid.run_ends import impact_limit
from vibroimpact.cases.sections.left_out import applicable
from vibroimpact.dynamics.motion.columns import ALL_IMPACT_COLUMNS, IMPACT_COLUMNS, meanings
from vibroimpact.errors import InputError
from vibroimpact.meshes.mesh_digest import mesh_digest
from vibroimpact.studies.planning.axes import Axis, Values
from vibroimpact.studies.planning.design import Asked, find_design
from vibroimpact.studies.planning.drop_variables import (
    OUTCOME,
    PEAKS,
    SENSOR_PEAK,
    SIGNAL,
    SIGNAL_START,
)
from vibroimpact.studies.planning.limit_columns import limit_meanings
from vibroimpact.studies.planning.plan import Plan
from vibroimpact.studies.planning.population import Population
from vibroimpact.studies.planning.section import SweepSection
from vibroimpact.studies.planning.swept_keys import case_at
from vibroimpact.studies.planning.window import Window

LONG = 100
"""Assumed number of impacts of a drop that goes on until it is at rest."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """A parameter study, validated and not yet computed.

    Attributes
    ----------
    table : dict
        The case without its [sweep] section, with the structure of a TOML case file.
    section : SweepSection
        The [sweep] section.
    axes : dict of str to Axis
        Values of each swept key; without those of the classes of a population.
    quantities : dict of str to Quantity or None
        Quantity of each swept key; None if it is not a quantity.
    population : Population, optional
        Classes of rocks, with the axes of their keys.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> sweep = vi.studies.load_sweep("signals:coal-gangue", samples=10)
    >>> sweep.name, sweep.size, sweep.case_of(3).contact.law
    ('coal and gangue on a tail-beam plate', 10, 'tsuji')
    """

    table: dict[str, Any]
    section: SweepSection
    axes: dict[str, Axis]
    quantities: dict[str, Quantity | None]
    population: Population | None = None

    @cached_property
    def size(self) -> int:
        """The number of drops."""
        return find_design(self.section.design).size(self._asked)

    @cached_property
    def plan(self) -> Plan:
        """The points of the study."""
        return find_design(self.section.design).plan(self._asked)

    @property
    def _asked(self) -> Asked:
        """The settings of the study that its design takes."""
        return Asked(self.axes, self.section.samples or 0, self.section.seed, self.population)

    @cached_property
    def case(self) -> Case:
        """The case at the first point."""
        return self.case_at(self.values_of(0))

    def values_of(self, drop: int) -> dict[str, Any]:
        """Return the values of the swept keys for a drop, by its number from 0."""
        return {key: values[0] for key, values in self.plan.points(drop, 1).items()}

    def case_at(self, values: Mapping[str, Any]) -> Case:
        """Return the case with given values of the swept keys.

        Raises
        ------
        InputError
            If it is not a valid case.
        """
        return case_at(self.table, values)

    @cached_property
    def deforms(self) -> bool:
        """Whether anything but the contact deforms, at any level of the swept keys."""
        if deforms(self.case):
            return True
        first = self.values_of(0)
        for key, values in self.plan.columns.items():
            # numbers make no body elastic, names and tables may
            if values.dtype == object:
                for level in different(values):
                    if deforms(self.case_at({**first, key: level})):
                        return True
        return False

    def case_of(self, drop: int, changes: Mapping[str, Any] | None = None) -> Case:
        """Return the case of a drop by its number from 0, such as to run it separately.

        Parameters
        ----------
        drop : int
            The number.
        changes : mapping, optional
            Other values by dotted key, swept or not.

        Raises
        ------
        InputError
            If there is no such drop, or its case is not valid.
        """
        if not 0 <= drop < self.size:
            raise InputError(
                f"there is no drop {drop}; the study has {self.size:,}, counted from 0"
            )
        changes = changes or {}
        table = applicable(self.table, changes)
        return case_at(table, {**self.values_of(drop), **changes})

    @property
    def window(self) -> Window | None:
        """The part of the signals that is kept; None for all."""
        window = self.section.window
        if window is None:
            return None
        return Window(window.before, window.length)

    @property
    def bytes(self) -> float:
        """Approximate size of the results [bytes]."""
        impacts = 0
        if "impacts" in self.section.keep:
            impacts = impact_limit(self.case) or LONG
        samples: float = 0
        if "signals" in self.section.keep:
            kept_time = self.case.run.duration or 0.0
            if self.window:
                kept_time = self.window.length
            samples = sum(sensor.rate * kept_time for sensor in self.case.sensors)
        # numbers of a drop in double precision, and in single precision
        double = len(self.quantities) + len(PEAKS) + impacts * len(IMPACT_COLUMNS)
        single = len(limit_meanings()) + samples
        return self.size * (8.0 * double + 4.0 * single)

    @property
    def name(self) -> str:
        """Title of the study."""
        return self.case.name or "a study of drops"

    @property
    def whole_table(self) -> dict[str, Any]:
        """The case with its [sweep] section, with the structure of a TOML case file."""
        return {**self.table, "sweep": self.section.model_dump(exclude_none=True, mode="json")}

    @property
    def meanings(self) -> dict[str, tuple[str, str]]:
        """Unit and meaning of every swept key and of all variables that may be kept.

        They are in the order of the files.
        """
        keys = {}
        for key, quantity in self.quantities.items():
            keys[key] = ("1", key)  # of names, say, that are no quantity
            if quantity:
                keys[key] = (quantity.unit or "1", quantity.meaning)
        sensors = {}
        if "signals" in self.section.keep:
            sensors = {sensor.name: sensor.sensor() for sensor in self.case.sensors}
        largest = {}
        starts = {}
        signals = {}
        for name, sensor in sensors.items():
            meaning = f"largest magnitude of the signal of {name}"
            largest[f"{name}{SENSOR_PEAK}"] = (sensor.unit, meaning)
            if self.window:
                starts[f"{name}{SIGNAL_START}"] = ("s", f"time of the first sample of {name}")
            signals[f"{SIGNAL}{name}"] = (sensor.unit, f"{sensor.quantity} measured by {name}")
        impacts = meanings(ALL_IMPACT_COLUMNS)
        del impacts["impact"]  # a dimension, not a variable
        return {
            **keys,
            OUTCOME: ("1", "reason for the end of the run of the drop"),
            **PEAKS,
            **largest,
            **limit_meanings(),
            **impacts,
            **starts,
            **signals,
        }

    @cached_property
    def digest(self) -> str:
        """Fingerprint (SHA-256) of the case, its meshes, the points and the kept results."""
        meshes = [mesh_digest(file) for file in _meshes(self.table)]
        content = json.dumps([self.table, meshes, self.section.keep], sort_keys=True, default=str)
        text = f"{self.plan.digest()} {content}"
        if self.window:
            text += f" {self.window}"
        return sha256(text.encode()).hexdigest()


def different(values: Values) -> list[Any]:
    """Return the distinct values, which may be tables, in order."""
    return list({repr(value): value for value in values.tolist()}.values())


def _meshes(table: Mapping[str, Any]) -> Iterator[Path]:
    """Yield the mesh files of a case."""
    for body in ("sphere", "plate"):
        section = table.get(body)
        if not isinstance(section, dict):
            continue
        file = section.get("mesh")
        if isinstance(file, dict):
            file = file.get("file")
        if isinstance(file, str) and Path(file).is_file():
            yield Path(file)
