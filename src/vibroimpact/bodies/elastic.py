"""Elastic bodies: recipes of their modes from geometry and material.

A mesh that resolves the modes is chosen here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.damping import ConstantRatio, Damping
from vibroimpact.structures.finite_elements.sphere_mesh import MOST_ACROSS
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of
from vibroimpact.structures.modal_model import ModalBasis, ModalModel, modal_basis, rigid_basis
from vibroimpact.structures.mode_count import OF_AN_EDGE
from vibroimpact.structures.plate_waves import wave_numbers
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    Shape,
    SphereOfSolids,
)
from vibroimpact.structures.sound_paths import Listener
from vibroimpact.structures.support_force import SupportForces, support_forces
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.support import Support

_PER_WAVE = 3.0  # second-order bricks per shortest shear wavelength
_ACROSS = 8  # least number of elements from pole to pole, for errors of 0.03 % of the lowest modes
# sides of second-order bricks and of plate elements, over the shortest bending wavelength
_BRICK_SIZE = 0.1
_PLATE_ELEMENT_SIZE = 0.6
# thicknesses: width of plate elements along edges, where the shear varies within half a thickness
_MARGIN = 1.5
# wave number times thickness above which a plate has two, three and four layers of bricks
_LAYERS = (0.32, 0.9, 3.0)
# of a mesh that is chosen here; finer meshes, for higher modes, have to be specified
_MOST_BRICKS = 6000
# of bricks at rims and in the lowest layer; the remaining error of frequencies is 0.1 to 0.3 %
_RIM_SPLITS = 2
_LOWER_SPLITS = 1
_LEAST_PLATE_ELEMENTS = 7  # along the longer side
_LEAST_BRICKS = 30  # along the longer side


@dataclass(frozen=True)
class ElasticBody:
    """Elastic body before its modes are computed.

    Parameters
    ----------
    recipe : Recipe
        Recipe of its modes.
    side : str
        Side of the contact: "upper" or "lower".
    contact : tuple of two floats, str or None
        Contact point: x and y [m], the name of a set of nodes, or None for the highest or lowest
        point of the side.
    damping : Damping, optional
        Damping of its modes; none by default.
    watched : mapping of str to (spot, side), optional
        Sensors of motion by name.
    strained : mapping of str to (spot, side), optional
        Sensors of strain by name.
    heard : mapping of str to Listener, optional
        Microphones by name.
    pressed : mapping of str to (spot, side), optional
        Sensors of the force of supports by name.
    """

    recipe: Recipe
    side: Side
    contact: Spot = None
    damping: Damping = ConstantRatio(0.0)
    watched: Mapping[str, tuple[Spot, Side]] = field(default_factory=dict)
    strained: Mapping[str, tuple[Spot, Side]] = field(default_factory=dict)
    heard: Mapping[str, Listener] = field(default_factory=dict)
    pressed: Mapping[str, tuple[Spot, Side]] = field(default_factory=dict)

    @property
    def sensors(self) -> dict[str, tuple[Spot, Side]]:
        """All sensors on the body by name."""
        return {**self.watched, **self.strained, **self.pressed}

    def basis(self, model: ModalModel) -> ModalBasis:
        """Return the modes of the recipe at the contact point and at the sensors.

        Raises
        ------
        InputError
            If a point is not on the body, or a set is not in its mesh.
        """
        basis = modal_basis(
            model, self.damping, self.contact, self.side, self.watched, self.strained, self.heard
        )
        if not self.pressed:
            return basis
        forces = self.support_forces(model).of_modes(model)
        force_sensors = dict(zip(self.pressed, forces, strict=True))
        return replace(basis, points={**basis.points, **force_sensors})

    def support_forces(
        self, model: ModalModel, tell: Callable[[str], None] | None = None
    ) -> SupportForces:
        """Return the forces of supports at the sensors of force.

        Parameters and errors are those of `support_forces`.
        """
        place = place_of(model.mesh, self.contact, self.side)
        spots = [spot for spot, _ in self.pressed.values()]
        return support_forces(self.recipe, place, self.side, spots, tell)

    def rigid_motions(self, model: ModalModel) -> ModalBasis | None:
        """Return the rigid motions that the supports permit, as modes of frequency zero.

        They are taken at the same points. It is None if there are none.
        """
        contact = (self.contact, self.side)
        unmoved_sensors = [*self.strained, *self.pressed]
        return rigid_basis(model, contact, self.watched, unmoved_sensors, self.heard)


def sphere_recipe(radius: float, material: Material, reduction: Reduction, **mesh: Any) -> Recipe:
    """Return the recipe of an elastic sphere.

    Parameters
    ----------
    radius : float
        Radius [m], > 0.
    material : Material
        Material of the sphere.
    reduction : Reduction
        Which modes are kept.
    **mesh : optional
        Fields of `SphereOfSolids`; `elements_across` is chosen to resolve the modes and the grading
        unless given.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> sphere_recipe(0.025, find_material("rock-paper"), Reduction(modes=10)).shape
    SphereOfSolids(radius=0.025, elements_across=8, kind='hex27', grading=1.0)
    """
    if not mesh.get("elements_across"):
        grading = mesh.get("grading", 1.0)
        mesh["elements_across"] = _elements_across(radius, material, reduction, grading)
    return recipe_of(SphereOfSolids(radius, **mesh), material, reduction)


def _elements_across(
    radius: float, material: Material, reduction: Reduction, grading: float
) -> int:
    """Return the number of bricks from pole to pole that resolve the modes of a sphere.

    Raises
    ------
    InputError
        If they are too many.
    """
    # so many per wave length on the radius, k R/(2 pi) wave lengths, and twice as many across
    wave_number = _shear_wave_number(radius, material, reduction) * radius
    ungraded = max(_ACROSS, 2 * math.ceil(_PER_WAVE * wave_number / (2.0 * math.pi)))
    elements = 2 * math.ceil(0.5 * ungraded * math.sqrt(grading))
    if elements > MOST_ACROSS:
        if reduction.modes:
            modes = f"{reduction.modes} modes"
        else:
            modes = f"modes up to {reduction.max_frequency:g} Hz"
        raise InputError(
            f"{modes} need {elements} elements across the sphere, and "
            f"{MOST_ACROSS} are the most; "
            "ask for fewer modes, or give mesh.elements_across"
        )
    return elements


def plate_recipe(
    size: tuple[float, float, float],
    material: Material,
    reduction: Reduction,
    supports: tuple[Support, ...] = (),
    element: Literal["plate", "solid"] = "plate",
    **mesh: Any,
) -> Recipe:
    """Return the recipe of an elastic plate.

    Parameters
    ----------
    size : tuple of three floats
        Length, width and thickness [m], > 0.
    material : Material
        Material of the plate.
    reduction : Reduction
        Which modes are kept.
    supports : tuple of supports
        Supports; none by default.
    element : str, default "plate"
        Elements: "plate" or "solid".
    **mesh : optional
        Fields of `PlateOfPlates` or `PlateOfSolids`; those not given are chosen to resolve the
        modes and the boundary layers at edges and rims.

    Examples
    --------
    >>> from vibroimpact.materials import find_material
    >>> plate_recipe((0.52, 0.42, 0.008), find_material("steel-paper"), Reduction(modes=20)).shape
    PlateOfPlates(size=(0.52, 0.42, 0.008), element_size=0.0743, theory='thick', margin=0.012)
    """
    wave_number = _bending_wave_number(size, material, reduction, supports)
    shape: Shape
    if element == "solid":
        _choose_layers(mesh, size, wave_number, supports)
        if not mesh.get("element_size"):
            layers = mesh["layers"] + mesh["lower_splits"]
            mesh["element_size"] = _brick_size(size, wave_number, layers)
        shape = PlateOfSolids(size=size, **mesh)
    else:
        mesh.setdefault("margin", _MARGIN * size[2])
        if not mesh.get("element_size"):
            mesh["element_size"] = _plate_element_size(size, wave_number)
        shape = PlateOfPlates(size=size, **mesh)
    return recipe_of(shape, material, reduction, supports)


def _plate_element_size(size: tuple[float, float, float], wave_number: float) -> float:
    """Return the side of plate elements that resolve bending waves [m]."""
    resolved = _PLATE_ELEMENT_SIZE * 2.0 * math.pi / wave_number
    largest = max(size[:2]) / _LEAST_PLATE_ELEMENTS
    return _rounded(min(resolved, largest))


def _brick_size(size: tuple[float, float, float], wave_number: float, layers: int) -> float:
    """Return the side of bricks that resolve bending waves, unless they are too many [m]."""
    resolved = _BRICK_SIZE * 2.0 * math.pi / wave_number
    largest = max(size[:2]) / _LEAST_BRICKS
    # with it the bricks of all layers are as many as may be
    affordable = math.sqrt(size[0] * size[1] * layers / _MOST_BRICKS)
    return _rounded(max(min(resolved, largest), affordable))


def _rounded(length: float) -> float:
    """Return a length with three digits."""
    return float(f"{length:.3g}")


def _choose_layers(
    mesh: dict[str, Any],
    size: tuple[float, float, float],
    wave_number: float,
    supports: tuple[Support, ...],
) -> None:
    """Set the number of layers and of splits of a mesh of bricks, unless given."""
    is_held_below = any(support.discs or any(support.rims) for support in supports)
    lower_splits = 0
    if is_held_below:
        lower_splits = mesh.get("splits", _LOWER_SPLITS)
    mesh.setdefault("lower_splits", lower_splits)
    mesh.setdefault("splits", _RIM_SPLITS)
    needed_layers = 1 + sum(wave_number * size[2] > limit for limit in _LAYERS)
    # splits of the lowest layer are layers too
    mesh.setdefault("layers", max(1, needed_layers - mesh["lower_splits"]))


def recipe_of(
    shape: Shape, material: Material, reduction: Reduction, supports: tuple[Support, ...] = ()
) -> Recipe:
    """Return the recipe of a body of a shape.

    Raises
    ------
    InputError
        If the material is rigid.
    """
    if not math.isfinite(material.youngs_modulus):
        raise InputError(
            '"rigid" does not deform; an elastic body needs a material with a modulus', "material"
        )
    return Recipe(
        shape,
        material.density,
        material.youngs_modulus,
        material.poissons_ratio,
        supports,
        reduction,
    )


def _shear_wave_number(radius: float, material: Material, reduction: Reduction) -> float:
    """Return the wave number of shear waves at the highest frequency of a reduction [1/m]."""
    speed = math.sqrt(
        material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio) * material.density)
    )
    if reduction.modes is None:
        return 2.0 * math.pi * (reduction.max_frequency or 0.0) / speed
    # Weyl's mode count of a ball, V k^3 / (6 pi^2) for each of three polarisations
    return float(1.9 * (reduction.modes + 1) ** (1.0 / 3.0) / radius)


def _bending_wave_number(
    size: tuple[float, float, float],
    material: Material,
    reduction: Reduction,
    supports: tuple[Support, ...],
) -> float:
    """Return the wave number of bending waves at the highest frequency of a reduction [1/m].

    Held edges reduce the number of modes below it: Weyl's count A k^2 / (4 pi) has a further term c
    P k / (4 pi) of each, of length P and with c < 0 of `OF_AN_EDGE` (E. Bogomolny and E. Hugues,
    Phys. Rev. E 57:5404, 1998).
    """
    length, width, thickness = size
    if reduction.modes is None:
        omega = np.array(2.0 * math.pi * (reduction.max_frequency or 0.0))
        return float(wave_numbers(omega, thickness, material, thin=True))
    modes = reduction.modes + 4
    conditions = {
        support.edge: support.condition for support in supports if isinstance(support, Edge)
    }
    # -c P, summed over the held edges
    of_edges = []
    for edge, condition in conditions.items():
        side = width if edge[0] == "x" else length
        of_edges.append(OF_AN_EDGE[condition] * side)
    edge_sum = -sum(of_edges)
    area = length * width
    # the positive root of A k^2 - edge_sum k - 4 pi modes
    discriminant = edge_sum**2 + 16.0 * math.pi * modes * area
    of_plate = (edge_sum + math.sqrt(discriminant)) / (2.0 * area)
    # a narrow plate has the modes of a beam
    of_beam = math.pi * modes / max(length, width)
    return min(of_plate, of_beam)
