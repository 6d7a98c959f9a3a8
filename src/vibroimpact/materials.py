"""Isotropic linear-elastic materials, and the material library of the package.

The materials of the library are attributes, too, with underscores for hyphens:

>>> import vibroimpact as vi
>>> vi.materials.rock_paper.youngs_modulus
2260000000.0
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

__all__ = ["RIGID", "Material", "find_material", "material_library"]

_RANGES = {
    "density": Range(above=0),
    "youngs_modulus": Range(above=0),
    "poissons_ratio": Range(above=-1, below=0.5),
    "yield_strength": Range(above=0),
    "compressive_strength": Range(above=0),
    "tensile_strength": Range(above=0),
    "hardness": Range(above=0),
    "loss_factor": Range(at_least=0),
}


@dataclass(frozen=True)
class Material:
    """An isotropic, linear-elastic material.

    Parameters
    ----------
    density : float
        Density [kg/m^3], > 0; NaN if the mass is not needed (a fixed body).
    youngs_modulus : float
        Young's modulus [Pa], > 0; infinite for a rigid material.
    poissons_ratio : float
        Poisson's ratio [-], in (-1, 0.5).
    yield_strength : float, optional
        Yield strength of a ductile material in uniaxial compression or tension [Pa], > 0.
    loss_factor : float, optional
        Loss factor of vibration [-], >= 0.
    compressive_strength, tensile_strength : float, optional
        Strength of a brittle material in uniaxial compression and tension [Pa], > 0.
    hardness : float, optional
        Vickers hardness [Pa], > 0: the Vickers number times 9.80665 MPa. See Notes.
    name, description, note : str
        Name in the library, description, and a note on the reliability of the values.
    sources : mapping of str to str
        Source of each value.

    Raises
    ------
    InputError
        If a value is outside its range.

    Notes
    -----
    Nothing is computed from the hardness. It is for those who estimate parameters of contact laws
    with plastic yield from it: the hardness of a metal is about 2.8 times its flow stress [1]_, at
    a strain of some 8 %. This is close to the yield strength of a hardened steel, and above that of
    a metal that hardens under the indenter.

    References
    ----------
    .. [1] Tabor, D. (1951). The Hardness of Metals. Clarendon Press, Oxford.

    Examples
    --------
    >>> steel = Material(density=7850, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> round(steel.plane_strain_modulus / 1e9, 3)
    230.769
    """

    density: float
    youngs_modulus: float
    poissons_ratio: float
    yield_strength: float | None = None
    loss_factor: float | None = None
    compressive_strength: float | None = None
    tensile_strength: float | None = None
    hardness: float | None = None
    name: str = ""
    description: str = ""
    note: str = ""
    sources: Mapping[str, str] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        for name, allowed in _RANGES.items():
            value = getattr(self, name)
            if _may_be_any(name, value):
                continue
            try:
                allowed.check(value)
            except InputError as error:
                raise InputError(error.message, name) from None

    @property
    def plane_strain_modulus(self) -> float:
        """Plane-strain modulus E / (1 - nu^2) [Pa], as in Hertz contact."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)


def _may_be_any(name: str, value: Any) -> bool:
    """Return whether a value is left out: None, the density of a fixed body, rigidity."""
    if value is None:
        return True
    if name == "density":
        return bool(np.all(np.isnan(value)))
    if name == "youngs_modulus":
        return bool(np.all(np.isinf(value)))
    return False


_OTHER_NAMES = "other_names"
"""Key of the library file for other common names of a material."""

RIGID = Material(
    density=math.nan,
    youngs_modulus=math.inf,
    poissons_ratio=0.0,
    name="rigid",
    description="a material of infinite modulus",
)


@cache
def material_library() -> Mapping[str, Material]:
    """Return the materials of the library by name; each value has an entry in `sources`.

    Examples
    --------
    >>> material_library()["rock-paper"].youngs_modulus
    2260000000.0
    """
    library = {}
    for name, entry in _library_file().items():
        values = {key: value for key, value in entry.items() if key != _OTHER_NAMES}
        library[name] = Material(name=name, **values)
    return library


@cache
def _library_file() -> Mapping[str, Mapping[str, Any]]:
    file = files("vibroimpact").joinpath("materials.toml")
    return tomllib.loads(file.read_text(encoding="utf-8"))


@cache
def _names_in_library() -> Mapping[str, str]:
    """Return the name in the library for each known name of a material, reduced by `_plain`."""
    names = {}
    for name, entry in _library_file().items():
        for known_name in (name, *entry.get(_OTHER_NAMES, ())):
            names[_plain(known_name)] = name
    return names


def _plain(name: str) -> str:
    """Return the letters and digits of a name in lower case."""
    return "".join(character for character in name.lower() if character.isalnum())


def _did_you_mean(name: str) -> str:
    """Return " Did you mean ...?" for the material with this other name or the closest, or ""."""
    name_in_library = _names_in_library().get(_plain(name))
    if name_in_library:
        return f' Did you mean "{name_in_library}"?'
    # a wrong material is worse than none: copper is not meant by "cork", nor pyrite by "ptfe"
    return did_you_mean(name.lower(), material_library(), cutoff=0.65)


def find_material(name: str) -> Material:
    """Return the library material called `name`, or `RIGID` for "rigid".

    Raises
    ------
    InputError
        If there is none; the message suggests the one with this other name ("PMMA", "alu"), or the
        closest name.

    Examples
    --------
    >>> find_material("rigid").youngs_modulus
    inf
    """
    if name == RIGID.name:
        return RIGID
    library = material_library()
    if name not in library:
        remedy = (
            "or give its numbers: { density = ..., youngs_modulus = ..., poissons_ratio = ... }"
        )
        raise InputError(
            f'there is no material {quoted(name)} in the library; "vibroimpact materials" '
            f"lists them, {remedy}.{_did_you_mean(name)}"
        )
    return library[name]


def __getattr__(name: str) -> Material:
    library = material_library()
    name_in_library = name.replace("_", "-")
    if name_in_library not in library:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return library[name_in_library]


def __dir__() -> list[str]:
    names = [name.replace("-", "_") for name in material_library()]
    return sorted([*__all__, *names])
