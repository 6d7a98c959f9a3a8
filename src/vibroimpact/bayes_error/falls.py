"""The falls of a population as a bound needs them: what is known of their first impacts."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Integers
from vibroimpact.bodies.ball import ball_volume, mean_density
from vibroimpact.cases.case import Case
from vibroimpact.errors import InputError
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.axes import Values
from vibroimpact.studies.planning.population import CLASS, ROCK
from vibroimpact.studies.planning.sweep import Sweep
from vibroimpact.studies.planning.swept_keys import case_at
from vibroimpact.units.display import STANDARD_GRAVITY

_COLUMNS = ("first_approach_speed_m_s", "first_restitution_achieved", "first_duration_s")
_KEYS_OF_RIGID_PLATE = ("size", "material", "inclination")
_KEYS_OF_RIGID_SPHERE = ("radius", "material", "mass", "inertia")


@dataclass(frozen=True, eq=False)
class Falls:
    """First impacts of falls, (falls,) each.

    Parameters
    ----------
    classes : array of str
        Class of the rock.
    rocks : array of int
        Number of the rock; falls of one rock are alike.
    radius, density, modulus : array
        Of the sphere [m], its mean density [kg/m^3], and Young's modulus of its material [Pa].
    speed, restitution, duration : array
        Approach speed [m/s], restitution achieved, and duration of the contact [s].
    """

    classes: NDArray[Any]
    rocks: Integers
    radius: Floats
    density: Floats
    modulus: Floats
    speed: Floats
    restitution: Floats
    duration: Floats

    @property
    def mass(self) -> Floats:
        """Mass of the sphere [kg]."""
        return np.asarray(ball_volume(self.radius) * self.density)

    @property
    def impulse(self) -> Floats:
        """Impulse of the contact force [N s]."""
        return self.mass * self.speed * (1.0 + self.restitution)

    @property
    def interval(self) -> Floats:
        """Time from the first touch to the next, under standard gravity [s]."""
        return self.duration + 2.0 * self.restitution * self.speed / STANDARD_GRAVITY

    def __len__(self) -> int:
        return len(self.classes)


def falls_of_study(study: Study) -> Falls:
    """Return the falls of a computed data set; those that failed are left out.

    Raises
    ------
    InputError
        If the study has no classes.
    """
    if not {CLASS, ROCK} <= set(study.labels):
        raise InputError(
            f"{study.path.parent}: this study has no classes; a bound needs a population, "
            "as vibroimpact dataset computes it"
        )
    speed, restitution, duration = (
        np.asarray(study.values(name), dtype=float) for name in _COLUMNS
    )
    table = {key: value for key, value in study.table.items() if key != "sweep"}
    return _falls(study.labels, table, study.coordinates, speed, restitution, duration)


def falls_of_sweep(sweep: Sweep) -> Falls:
    """Return the falls of a stated population on its plate as a rigid body.

    A hundred thousand of them take seconds.

    Raises
    ------
    InputError
        If the study has no classes.
    """
    if sweep.population is None:
        raise InputError(
            'the study has no classes; a bound needs design = "population"', "sweep.design"
        )
    table = {
        **sweep.table,
        "plate": _only(sweep.table["plate"], _KEYS_OF_RIGID_PLATE),
        "sphere": _only(sweep.table["sphere"], _KEYS_OF_RIGID_SPHERE),
        "run": {"impacts": 1},
    }
    table.pop("sensors", None)
    columns = {
        key: values
        for key, values in sweep.plan.columns.items()
        if not key.startswith(("plate.", "sensors."))
    }
    result = compute_points(table, (), 0, columns)
    failed = np.array(sorted(result.failures), dtype=int)
    speed, restitution, duration = (
        np.asarray(result.arrays[name], dtype=float).copy() for name in _COLUMNS
    )
    for values in (speed, restitution, duration):
        values[failed] = np.nan
    return _falls(sweep.plan.labels, table, columns, speed, restitution, duration)


def _only(table: Mapping[str, Any], keys: Collection[str]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key in keys}


def _falls(
    labels: Mapping[str, NDArray[Any]],
    table: Mapping[str, Any],
    columns: Mapping[str, Values],
    speed: Floats,
    restitution: Floats,
    duration: Floats,
) -> Falls:
    """Return the falls that touched, with radius and mass from the values of the keys."""
    first = case_at(table, {key: values[0] for key, values in columns.items()})
    count = len(labels[CLASS])
    radius = np.broadcast_to(columns.get("sphere.radius", first.sphere.radius), count).astype(float)
    density = _material_property("density", first, table, columns, count)
    modulus = _material_property("youngs_modulus", first, table, columns, count)
    mass = columns.get("sphere.mass", first.sphere.mass)
    if mass is not None:
        density = np.broadcast_to(mean_density(mass, radius), count).astype(float)
    touched = np.isfinite(speed) & np.isfinite(duration)
    return Falls(
        classes=labels[CLASS][touched],
        rocks=labels[ROCK][touched],
        radius=radius[touched],
        density=density[touched],
        modulus=modulus[touched],
        speed=speed[touched],
        restitution=restitution[touched],
        duration=duration[touched],
    )


def _material_property(
    name: str, first: Case, table: Mapping[str, Any], columns: Mapping[str, Values], count: int
) -> Floats:
    """Return a property of the material of the sphere of each fall.

    It may be swept itself, or with the name of the material, or be that of the first fall.
    """
    if f"sphere.material.{name}" in columns:
        return np.asarray(columns[f"sphere.material.{name}"], dtype=float)
    if "sphere.material" in columns:
        materials = columns["sphere.material"].tolist()
        by_material = {}
        for material in materials:
            case = case_at(table, {"sphere.material": material})
            by_material[repr(material)] = float(getattr(case.sphere.material, name))
        return np.array([by_material[repr(material)] for material in materials])
    return np.full(count, float(getattr(first.sphere.material, name)))
