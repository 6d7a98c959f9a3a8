"""The axes of a study in charts and tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.population import CLASS

_WORDS = {
    "contact": "contact law",
    "contact.friction.coefficient": "coefficient of friction",
    "contact.friction.law": "friction law",
    "contact.friction.slip_restitution": "restitution of the slip",
    "contact.finite_sphere": "correction for a finite sphere",
    "contact.full_damping_penetration": "full damping penetration",
    "contact.law": "contact law",
    "contact.local_compliance": "treatment of local indentation",
    "contact.local_damping": "damping of the local element",
    "contact.local_stiffness": "stiffness of the local element",
    "contact.restitution": "restitution asked",
    "drop.angle": "angle of incidence from the normal",
    "drop.gravity": "gravity",
    "drop.height": "drop height",
    "drop.position.x": "position of the drop, x",
    "drop.position.y": "position of the drop, y",
    "drop.speed": "speed at first touch",
    "plate.damping": "damping ratio of the plate",
    "plate.inclination": "inclination of the plate",
    "plate.element": "kind of element of the plate",
    "plate.max_frequency": "highest frequency of the plate's modes",
    "plate.modes": "number of modes of the plate",
    "plate.radius": "radius of the lower sphere",
    "run.impacts": "number of impacts",
    "run.rest_speed": "rest speed",
    "run.tolerance": "tolerance",
    "sphere.damping": "damping ratio of the sphere",
    "sphere.max_frequency": "highest frequency of the sphere's modes",
    "sphere.modes": "number of modes of the sphere",
    "sphere.material": "material of the sphere",
    "plate.material": "material of the plate",
}
"""What a reader calls a key whose path or meaning says it less well."""

_DIGITS_OF_ANGLES = 12  # so that 20 deg, given so, is 20

_UNSAID = ("material", "size")
"""Tables of a body whose keys are properties of the body."""


@dataclass(frozen=True, eq=False)
class StudyAxis:
    """A swept key.

    Attributes
    ----------
    key : str
        Dotted key.
    words : str
        What it is, such as "radius of the sphere".
    unit : str
        SI unit, but "deg" of an angle; "1" for a plain number.
    values : array
        Levels of a grid, or one value per drop; numbers in that unit, or names.
    """

    key: str
    words: str
    unit: str
    values: NDArray[Any]

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers."""
        return self.values.dtype.kind in "fiu"

    @property
    def varies(self) -> bool:
        """Whether it has two or more distinct values."""
        return bool(len(self.values) and (self.values != self.values[0]).any())


def study_axes(study: Study) -> list[StudyAxis]:
    """Return the axes of a study in order; the class of a population comes first."""
    columns = dict(study.coordinates)
    if CLASS in study.labels:
        columns = {CLASS: study.labels[CLASS], **columns}
    return [
        _axis(key, *study.meanings[key], _as_numbers(values)) for key, values in columns.items()
    ]


def _axis(key: str, unit: str, meaning: str, values: NDArray[Any]) -> StudyAxis:
    if unit == "rad":
        unit = "deg"
        values = np.degrees(values).round(_DIGITS_OF_ANGLES)
    return StudyAxis(key, key_words(key, meaning), unit, values)


def key_words(key: str, meaning: str) -> str:
    """Return what a key of a case is, in words.

    Parameters
    ----------
    key : str
        Dotted key.
    meaning : str
        Its meaning in the dataset; the key itself if it is not a quantity.

    Examples
    --------
    >>> (
    ...     key_words("sphere.radius", "radius"),
    ...     key_words("plate.material.youngs_modulus", "Young's modulus"),
    ... )
    ('radius of the sphere', "Young's modulus of the plate")
    >>> (
    ...     key_words("contact.exponent", "force exponent n, 1.5 for a sphere"),
    ...     key_words("plate.mesh.size", "plate.mesh.size"),
    ... )
    ('force exponent n', 'size of the mesh of the plate')
    >>> key_words(
    ...     "sensors.a1.accelerometer.noise", "standard deviation of the noise in its samples"
    ... )
    'noise of the accelerometer of a1'
    """
    if key in _WORDS:
        return _WORDS[key]
    if key.startswith("sensors."):
        _, name, rest = key.split(".", 2)
        return f"{key_words(rest, meaning)} of {name}"
    *way, last = key.split(".")
    if way == ["contact"] and meaning != key:
        return meaning.split(",")[0]
    name = last
    if way and way[-1] in _UNSAID and meaning != key:
        name = meaning.split(" of ")[0]
    owners = [section for section in reversed(way) if section not in _UNSAID]
    return " of the ".join([name, *owners]).replace("_", " ")


def _as_numbers(values: NDArray[Any]) -> NDArray[Any]:
    """Return strings that are all numbers as numbers, as some datasets store integers as
    strings.
    """
    if values.dtype != object or not len(values):
        return values
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return values
