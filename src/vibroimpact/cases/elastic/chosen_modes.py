"""The modes of an elastic body of a case, where their number is left to the program.

They are enough for an accuracy of the largest force and of each sensor, as estimated from the
contact of rigid bodies, within limits of their number.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.fields.elastic_body import DEFAULT_ACCURACY
from vibroimpact.cases.rigid.expected import expected_of, plate_impedance
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.enough_modes import (
    Band,
    Impulse,
    ModalDensity,
    enough_frequency,
)
from vibroimpact.structures.finite_elements.geometry import mass_properties
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of, thickness_at
from vibroimpact.structures.mode_count import modes_expected, modes_per_volume
from vibroimpact.structures.plate_waves import wave_numbers
from vibroimpact.structures.recipe import (
    ImportedMesh,
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
)
from vibroimpact.structures.store import key_of, load_or_compute_array
from vibroimpact.structures.supports.edge import EDGES, Edge

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable

LEAST_MODES = 20
"""Modes that are kept if fewer are enough, or if nothing is known of the contact."""
MOST_MODES = {"sphere": 100, "plate": 400}
"""Modes that are chosen at most, which take half a minute of CPU time; a case may ask for more."""

_OF_AN_EDGE = 4.0
"""Modal density at a free edge over that in the middle of a plate; 3.9 was computed.

At a corner it is 11, less than the square of it.
"""
_AT_SURFACE = 2.5
"""Squares of modes at the surface of a solid over their mean in its volume, along the normal.

Computed for a sphere, whose 100th to 200th modes have 2.3 to 2.9.
"""
_BEYOND_PASSED = {"sigma-delta": 1.25, "butterworth": 2.0, "none": math.inf}
"""Highest frequency in a signal over the one that its anti-alias filter passes."""


def with_chosen_modes(
    case: CaseTable,
    name: Literal["sphere", "plate"],
    recipe_with: Callable[[Reduction], Recipe],
    reduction: Reduction,
    contact: Spot,
) -> Recipe:
    """Return the recipe of a body with the modes that the case asks for, or with enough of them.

    Parameters
    ----------
    case : CaseTable
        The case.
    name : str
        The body: "sphere" or "plate".
    recipe_with : callable
        Makes the recipe with a reduction.
    reduction : Reduction
        The reduction; without a number of modes and a highest frequency, these are chosen.
    contact : spot
        The contact point.
    """
    if reduction.modes is not None or reduction.max_frequency is not None:
        return recipe_with(reduction)
    least = recipe_with(replace(reduction, modes=LEAST_MODES))
    impulse = _impulse(case)
    if impulse is None:
        return least
    plate_like = _plate_like(least, contact, "lower" if name == "sphere" else "upper")
    try:
        frequency = _enough_frequency(case, name, plate_like, impulse)
        edges = _free_edges_near(least, contact, frequency)
        if edges:
            frequency = _enough_frequency(case, name, plate_like, impulse, _OF_AN_EDGE**edges)
    except InputError:
        return recipe_with(replace(reduction, modes=MOST_MODES[name]))
    up_to_frequency = Reduction(max_frequency=frequency)
    expected = modes_expected(replace(plate_like, reduction=up_to_frequency))
    if expected < LEAST_MODES:
        return least
    if expected > MOST_MODES[name]:
        return recipe_with(replace(reduction, modes=MOST_MODES[name]))
    return recipe_with(replace(reduction, max_frequency=frequency))


def chosen_for(case: CaseTable, name: str) -> str:
    """Return what the modes of a body are chosen for, in words; "" if the case states them."""
    section = getattr(case, name)
    if section.max_frequency is not None or section.modes not in (None, "auto"):
        return ""
    if _impulse(case) is None:
        return ", as nothing is known of the contact"
    return f", chosen for an accuracy of {100.0 * _accuracy(section):g} %"


def _accuracy(section: Any) -> float:
    """Return the accuracy that the section of a body asks for."""
    return DEFAULT_ACCURACY if section.accuracy is None else float(section.accuracy)


def _impulse(case: CaseTable) -> Impulse | None:
    """Return the first contact, of rigid bodies; None of a law that gives no force."""
    expected = expected_of(case)
    if not expected.force > 0.0:
        return None
    # the tangent of F ~ delta^(3/2)
    return Impulse(float(expected.duration), float(1.5 * expected.force / expected.depth))


def _enough_frequency(
    case: CaseTable,
    name: Literal["sphere", "plate"],
    recipe: Recipe,
    impulse: Impulse,
    edge_factor: float = 1.0,
) -> float:
    """Return the frequency up to which the modes are enough [Hz].

    Raises
    ------
    InputError
        If none is.
    """
    bands = _bands(case) if name == "plate" else []
    density = _density(recipe)
    return enough_frequency(
        impulse,
        density._replace(bending=edge_factor * density.bending),
        bands,
        _accuracy(getattr(case, name)),
        is_carried=case.contact.local.local_compliance != "superposed",
    )


def _bands(case: CaseTable) -> list[Band]:
    """Return what the sensors of a case see of the velocity of the plate."""
    bands = []
    for section in case.sensors:
        sensor = section.sensor()
        highest = _BEYOND_PASSED[sensor.filter] * sensor.passed
        bands.append(Band(sensor.order + sensor.steepness - 1.0, highest))
    return bands


def _density(recipe: Recipe) -> ModalDensity:
    """Return the density of the modes of a body in the middle of its surface."""
    # waves in the volume, whose number grows with the cube of the frequency
    of_volume = _AT_SURFACE * modes_per_volume(recipe, 1.0) / recipe.density
    if not isinstance(recipe.shape, (PlateOfPlates, PlateOfSolids)):
        return ModalDensity(0.0, of_volume)  # a sphere
    of_bending = 2.0 / (math.pi * plate_impedance(_material(recipe), recipe.shape.size[2]))
    if isinstance(recipe.shape, PlateOfPlates):
        of_volume = 0.0
    return ModalDensity(of_bending, of_volume)


def _material(recipe: Recipe) -> Material:
    """Return the material of a recipe."""
    return Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)


def _free_edges_near(recipe: Recipe, contact: Spot, frequency: float) -> int:
    """Return the number of free edges of a plate within half a bending wave of the contact."""
    if not isinstance(recipe.shape, (PlateOfPlates, PlateOfSolids)):
        return 0
    assert isinstance(contact, tuple)  # x and y on a plate that is meshed here
    size = recipe.shape.size
    omega = np.array(2.0 * math.pi * frequency)
    half_wave = math.pi / float(wave_numbers(omega, size[2], _material(recipe), thin=True))
    held_edges = {support.edge for support in recipe.supports if isinstance(support, Edge)}
    number = 0
    for edge in EDGES:
        axis = 0 if edge[0] == "x" else 1
        outwards = -1.0 if edge.endswith("min") else 1.0
        distance = 0.5 * size[axis] - outwards * contact[axis]
        if edge not in held_edges and distance < half_wave:
            number += 1
    return number


def _plate_like(recipe: Recipe, contact: Spot, side: Side) -> Recipe:
    """Return a recipe whose modes can be counted before they are computed.

    An imported mesh counts as a plate of its thickness at the contact, and of its volume.
    """
    shape = recipe.shape
    if not isinstance(shape, ImportedMesh):
        return recipe

    def measured() -> Floats:
        mesh = shape.mesh()
        place = place_of(mesh, contact, side)
        return np.array([thickness_at(mesh, place, side), mass_properties(mesh, 1.0).mass])

    thickness, volume = load_or_compute_array(
        key_of(["thickness at a contact", shape.digest, contact, side]), measured
    )
    length = math.sqrt(volume / thickness)
    plate = PlateOfSolids((length, length, float(thickness)), length)
    return replace(recipe, shape=plate, supports=())
