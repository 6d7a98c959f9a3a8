"""Elastic bodies: recipes of their modes from geometry and material, with the choice of a
mesh that resolves them.
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
from vibroimpact.structures.sphere_mesh import MOST_ACROSS
from vibroimpact.structures.support_force import SupportForces, support_forces
from vibroimpact.structures.supports.edge import Edge
from vibroimpact.structures.supports.support import Support
from vibroimpact.structures.surface import Side, Spot, place_of

_PER_WAVE = 3.0  # second-order bricks per shortest shear wavelength
_ACROSS = 8  # least number of elements from pole to pole, for errors of 0.03 % of the lowest modes
# sides of second-order bricks and of plate elements, over the shortest bending wavelength
_SOLID_STEP, _PLATE_STEP = 0.1, 0.6
# thicknesses: width of plate elements along edges, where the shear varies within half a thickness
_MARGIN = 1.5
# wave number times thickness above which a plate has two, three and four layers of bricks
_LAYERS = (0.32, 0.9, 3.0)
# of a mesh that is chosen here; finer meshes, for higher modes, have to be specified
_MOST_BRICKS = 6000
# of bricks at rims; the remaining error of frequencies is 0.1 to 0.3 %
_RIM_SPLITS, _LOWER_SPLITS = 2, 1
_SIDE = 7  # least number of plate elements along the longer side
_SOLID_SIDE = 30  # least number of bricks along the longer side


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
        return replace(
            basis, points={**basis.points, **dict(zip(self.pressed, forces, strict=True))}
        )

    def support_forces(
        self, model: ModalModel, tell: Callable[[str], None] | None = None
    ) -> SupportForces:
        """Return the forces of supports at the sensors of force; parameters and errors
        are those of `support_forces`.
        """
        place = place_of(model.mesh, self.contact, self.side)
        return support_forces(
            self.recipe, place, self.side, [spot for spot, _ in self.pressed.values()], tell
        )

    def rigid_motions(self, model: ModalModel) -> ModalBasis | None:
        """Return the rigid motions that the supports permit, at the same points, as modes
        of frequency zero; None if there are none.
        """
        return rigid_basis(
            model,
            (self.contact, self.side),
            self.watched,
            [*self.strained, *self.pressed],
            self.heard,
        )


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
        wave_number = _shear_wave_number(radius, material, reduction) * radius
        across = max(_ACROSS, 2 * math.ceil(_PER_WAVE * wave_number / (2.0 * math.pi)))
        mesh["elements_across"] = 2 * math.ceil(0.5 * across * math.sqrt(mesh.get("grading", 1.0)))
        if mesh["elements_across"] > MOST_ACROSS:
            kept = (
                f"{reduction.modes} modes"
                if reduction.modes
                else f"modes up to {reduction.max_frequency:g} Hz"
            )
            raise InputError(
                f"{kept} need {mesh['elements_across']} elements across the sphere, and "
                f"{MOST_ACROSS} are the most; "
                "ask for fewer modes, or give mesh.elements_across"
            )
    return recipe_of(SphereOfSolids(radius, **mesh), material, reduction)


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
    if element == "solid":
        _choose_bricks(mesh, size, wave_number, supports)
    else:
        mesh.setdefault("margin", _MARGIN * size[2])
    if not mesh.get("element_size"):
        step, least = (_PLATE_STEP, _SIDE) if element == "plate" else (_SOLID_STEP, _SOLID_SIDE)
        side = min(step * 2.0 * math.pi / wave_number, max(size[:2]) / least)
        if element == "solid":
            side = max(
                side,
                math.sqrt(
                    size[0] * size[1] * (mesh["layers"] + mesh["lower_splits"]) / _MOST_BRICKS
                ),
            )
        mesh["element_size"] = float(f"{side:.3g}")
    kind = PlateOfPlates if element == "plate" else PlateOfSolids
    return recipe_of(kind(size=size, **mesh), material, reduction, supports)


def _choose_bricks(
    mesh: dict[str, Any],
    size: tuple[float, float, float],
    wave_number: float,
    supports: tuple[Support, ...],
) -> None:
    """Set the number of layers and of splits at edges and rims of a mesh of bricks,
    unless given.
    """
    held_below = any(support.discs or any(support.rims) for support in supports)
    mesh.setdefault("lower_splits", mesh.get("splits", _LOWER_SPLITS) if held_below else 0)
    mesh.setdefault("splits", _RIM_SPLITS)
    needed = 1 + sum(wave_number * size[2] > limit for limit in _LAYERS)
    mesh.setdefault("layers", max(1, needed - mesh["lower_splits"]))


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
        return float(
            wave_numbers(
                np.array(2.0 * math.pi * (reduction.max_frequency or 0.0)),
                thickness,
                material,
                thin=True,
            )
        )
    held = {support.edge: support.condition for support in supports if isinstance(support, Edge)}
    part = -sum(
        OF_AN_EDGE[how] * (width if edge[0] == "x" else length) for edge, how in held.items()
    )
    area = length * width
    of_area = (part + math.sqrt(part**2 + 16.0 * math.pi * (reduction.modes + 4) * area)) / (
        2.0 * area
    )
    # a narrow plate has the modes of a beam
    return min(of_area, math.pi * (reduction.modes + 4) / max(length, width))
