"""Recipe of the modes of a body, and the computation of its modal model.

A recipe is mesh, material, supports and reduction.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh, solid_plate_mesh
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.stated_materials import contradictions
from vibroimpact.structures.finite_elements.structure import (
    Structure,
    plate_structure,
    solid_structure,
)
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of, surface_motion
from vibroimpact.structures.frequency_error import (
    MESH,
    REDUCTION,
    SUPPORTS,
    THEORY,
    main_cause,
    mesh_errors,
    one_layer_errors,
    plate_theory_errors,
    support_errors,
)
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.mirrored import elastic_system
from vibroimpact.structures.modal_model import ModalModel, modal_model
from vibroimpact.structures.modes import Eigenmodes, ElasticSystem, Progress
from vibroimpact.structures.reduction import attachment_modes, craig_bampton, projected
from vibroimpact.structures.store import key_of, load_model, save_model, store_folder
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.support import Support, held_by, joint_remarks

Place = tuple[Spot, Side]
"""A spot, and the side of the body where it lies."""

# of the coarser mesh, over those of the mesh: elements across a sphere, sizes of elements, margin
_COARSE_ACROSS = 0.67
_COARSE_SOLID = 1.5
_COARSE_PLATE = 1.5
_COARSE_MARGIN = 4.0 / 3.0
# ratios of the errors of both meshes, measured: docs/elastic-bodies.md compares estimated with true
# errors
_SOLID_GAIN = 4.0
_PLATE_GAIN = 3.0

REMARKS = "remarks on the file"
"""Name of the fact with what is doubtful about a mesh file, one sentence a line."""
MAIN_CAUSE = "frequencies are off most for"
"""Name of the fact with the main cause of errors of frequencies."""

_RECENT = 64
"""Recipes whose keys are kept."""
_MODELS = MemoryCache[ModalModel](capacity=500e6)
_ROUGH = 1e-4
"""Residual of the modes of the coarser mesh, of which only the frequencies are used.

Their relative error is 1e-8.
"""
_MODES_PART = 0.6
"""Part of the time that modes take, as told by `progress`.

The rest is for their errors, from a coarser mesh.
"""


@dataclass(frozen=True)
class Shape:
    """Base class of the shapes of bodies: how to mesh and assemble them.

    The elements are solid unless overridden.
    """

    def mesh(self, supports: tuple[Support, ...] = ()) -> Mesh:
        """Return the mesh; meshes that are generated here follow the supports."""
        raise NotImplementedError

    def structure(self, mesh: Mesh, material: Material) -> Structure:
        """Return the structure: the assembled finite elements of the mesh."""
        return solid_structure(mesh, material)

    def coarser(self) -> tuple[Shape, float] | None:
        """Return a shape with a coarser mesh and the ratio of its errors to those of this one.

        The errors are those of frequencies. None stands for no such shape.
        """
        return None

    def one_layer(self) -> float:
        """Return the thickness [m] of a plate of one layer of second-order bricks, else 0."""
        return 0.0


@dataclass(frozen=True)
class SphereOfSolids(Shape):
    """Solid sphere with a mesh of `sphere_mesh`."""

    radius: float
    elements_across: int = 8
    kind: str = "hex27"
    grading: float = 1.0

    def mesh(self, supports: tuple[Support, ...] = ()) -> Mesh:
        """Return the mesh."""
        return sphere_mesh(self.radius, self.elements_across, self.kind, self.grading)

    def coarser(self) -> tuple[Shape, float] | None:
        """Return the sphere with two thirds or half as many elements across.

        The error is a power of their size.
        """
        across = max(4, 4 * int(_COARSE_ACROSS * self.elements_across / 4))
        if across >= self.elements_across:
            return None
        order = ELEMENT_KINDS[self.kind].order
        power = 4.0 if order == 2 else 2.0
        return replace(self, elements_across=across), (self.elements_across / across) ** power


@dataclass(frozen=True)
class PlateOfSolids(Shape):
    """Plate of solid elements with a mesh of `solid_plate_mesh`."""

    size: tuple[float, float, float]
    element_size: float
    layers: int = 1
    kind: str = "hex20"
    splits: int = 0
    lower_splits: int | None = None

    def mesh(self, supports: tuple[Support, ...] = ()) -> Mesh:
        """Return the mesh."""
        discs, lines = mesh_features(supports)
        return solid_plate_mesh(
            self.size,
            self.element_size,
            self.layers,
            self.kind,
            discs,
            lines,
            splits=self.splits,
            lower_splits=self.lower_splits,
            rims=_rims(supports),
        )

    def coarser(self) -> tuple[Shape, float] | None:
        """Return the plate with larger elements, and one split of rims less.

        Both have about four times the error.
        """
        coarser = replace(
            self,
            element_size=_COARSE_SOLID * self.element_size,
            splits=max(0, self.splits - 1),
            lower_splits=max(0, self._splits_below - 1),
        )
        return coarser, _SOLID_GAIN

    def one_layer(self) -> float:
        """Return the thickness if there is one second-order layer without splits, else 0."""
        is_second_order = ELEMENT_KINDS[self.kind].order == 2
        if self.layers == 1 and not self._splits_below and is_second_order:
            return self.size[2]
        return 0.0

    @property
    def _splits_below(self) -> int:
        """Number of splits of the lowest layer, by default that of rims."""
        if self.lower_splits is None:
            return self.splits
        return self.lower_splits


@dataclass(frozen=True)
class PlateOfPlates(Shape):
    """Plate of plate elements with a mesh of `plate_mesh`; see `assemble_plate`."""

    size: tuple[float, float, float]
    element_size: float
    theory: Literal["thick", "thin"] = "thick"
    margin: float = 0.0

    def mesh(self, supports: tuple[Support, ...] = ()) -> Mesh:
        """Return the mesh."""
        discs, lines = mesh_features(supports)
        margins = (self.margin,) if self.margin else ()
        return plate_mesh(self.size[:2], self.element_size, discs, lines, margins, _rims(supports))

    def structure(self, mesh: Mesh, material: Material) -> Structure:
        """Return the structure: the assembled plate elements."""
        return plate_structure(mesh, material, self.size[2], self.theory)

    def coarser(self) -> tuple[Shape, float] | None:
        """Return the plate with larger elements and the ratio of the errors."""
        coarser = replace(
            self,
            element_size=_COARSE_PLATE * self.element_size,
            margin=_COARSE_MARGIN * self.margin,
        )
        return coarser, _PLATE_GAIN


@dataclass(frozen=True)
class ImportedMesh(Shape):
    """Body with an imported mesh.

    Parameters
    ----------
    digest : str
        Hash of the file and of the options of its reader.
    read : callable
        Reads the mesh [m].
    """

    digest: str
    read: Callable[[], Mesh] = field(compare=False)

    def mesh(self, supports: tuple[Support, ...] = ()) -> Mesh:
        """Return the mesh of the file."""
        return self.read()


@dataclass(frozen=True)
class Reduction:
    """Reduction: which modes are kept.

    Parameters
    ----------
    modes : int, optional
        Number of modes; in Craig-Bampton reduction, of fixed-interface modes.
    max_frequency : float, optional
        Keep all modes up to this frequency [Hz], instead of a number.
    method : str, default "modal"
        "modal" truncation, or "craig-bampton".
    interface : tuple of places
        Interface of Craig-Bampton reduction: all degrees of freedom of the nearest nodes.
    attachment : tuple of places
        Places of vertical forces for which a residual attachment mode is added.
    """

    modes: int | None = None
    max_frequency: float | None = None
    method: Literal["modal", "craig-bampton"] = "modal"
    interface: tuple[Place, ...] = ()
    attachment: tuple[Place, ...] = ()


@dataclass(frozen=True)
class Recipe:
    """Everything that determines the modes of a body."""

    shape: Shape
    density: float
    youngs_modulus: float
    poissons_ratio: float
    supports: tuple[Support, ...] = ()
    reduction: Reduction = Reduction(modes=20)


def is_thin(recipe: Recipe) -> bool:
    """Return whether a recipe is that of a plate by Kirchhoff's thin theory."""
    return isinstance(recipe.shape, PlateOfPlates) and recipe.shape.theory == "thin"


def modal_model_of(
    recipe: Recipe, progress: Progress | None = None, tell: Callable[[str], None] | None = None
) -> ModalModel:
    """Return the modal model of a recipe, from the store if it is there.

    A model read from the store is shared within the process, so that it is in memory once; it must
    not be changed. Modes of free spheres, if given by number, are computed once per Poisson's
    ratio, and scaled.

    Parameters
    ----------
    recipe : Recipe
        Recipe of the modes.
    progress : callable, optional
        Called with the estimated progress, from 0 to 1, while modes are computed.
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError
        If the mesh, a support or a number of the recipe is invalid.
    ComputationError
        If the modes cannot be computed.
    """
    tell = tell or (lambda text: None)
    normalised = _normalised(recipe)
    if normalised is recipe:
        return _stored_model(recipe, progress, tell)
    assert isinstance(recipe.shape, SphereOfSolids)
    key = _memory_key(recipe)
    model = _MODELS.get(key)  # which knows its shapes at places that were asked for before
    if model is None:
        unit_model = _stored_model(normalised, progress, tell)
        model = unit_model.scaled(recipe.shape.radius, recipe.density, recipe.youngs_modulus)
        _MODELS.put(key, model, model.size)
    return model


@lru_cache(maxsize=_RECENT)
def recipe_key(recipe: Recipe) -> str:
    """Return the key of a recipe, kept for the next drop on the same plate."""
    return key_of(recipe)


def plate_key(recipe: Recipe) -> str:
    """Return the key of a held body, whatever its reduction, on which its statics do not depend."""
    return recipe_key(replace(recipe, reduction=Reduction()))


def model_key(recipe: Recipe) -> str:
    """Return the key of the modes of a recipe in the store."""
    return recipe_key(_normalised(recipe))


def _normalised(recipe: Recipe) -> Recipe:
    """Return the recipe whose modes are stored.

    For a free sphere it is that of unit radius, density and modulus, else the recipe itself.
    """
    shape = recipe.shape
    reduction = recipe.reduction
    if not isinstance(shape, SphereOfSolids) or recipe.supports or reduction.modes is None:
        return recipe
    # places that are given by x and y do not scale with the sphere
    if any(spot is not None for spot, _ in (*reduction.interface, *reduction.attachment)):
        return recipe
    return replace(recipe, shape=replace(shape, radius=1.0), density=1.0, youngs_modulus=1.0)


def _stored_model(
    recipe: Recipe, progress: Progress | None, tell: Callable[[str], None]
) -> ModalModel:
    """Return a model from memory, else from the store, else computed.

    A model that cannot be stored stays in memory.
    """
    key = recipe_key(recipe)
    model = _MODELS.get(_memory_key(recipe))
    if model is not None:
        return model
    model, trouble = load_model(key)
    if trouble:
        tell(trouble)
    if model is None:
        model = computed_model(recipe, progress)
        trouble = save_model(key, model)
        if not trouble:
            return model
        tell(trouble)
    _MODELS.put(_memory_key(recipe), model, model.size)
    return model


def _memory_key(recipe: Recipe) -> str:
    """Return the key of the modes of a recipe in memory, which differs from store to store."""
    return f"{store_folder()}/{recipe_key(recipe)}"


def computed_model(recipe: Recipe, progress: Progress | None = None) -> ModalModel:
    """Return the modal model of a recipe, computed anew; errors are those of `modal_model_of`."""
    begun = time.process_time()
    tell = progress or (lambda part: None)
    material = Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)
    held = _held_structure(recipe, recipe.shape, material)
    modes = _reduced_modes(held, recipe.reduction, lambda part: tell(_MODES_PART * part))
    errors_by_cause = _errors(
        recipe, held, modes, material, lambda part: tell(_MODES_PART + (1.0 - _MODES_PART) * part)
    )
    facts = _facts(recipe, held, material)
    facts[MAIN_CAUSE] = main_cause(errors_by_cause)
    facts["processor time"] = f"{time.process_time() - begun:.2f} s"
    errors = np.full(len(modes.angular_frequencies), np.nan)
    if errors_by_cause:
        total = np.sum(list(errors_by_cause.values()), axis=0)
        errors[: len(total)] = total
    return modal_model(held, modes, {name: text for name, text in facts.items() if text}, errors)


def _held_structure(recipe: Recipe, shape: Shape, material: Material) -> HeldStructure:
    """Return the structure of a shape with the supports of a recipe."""
    structure = shape.structure(shape.mesh(recipe.supports), material)
    return held_by(structure, recipe.supports)


def _facts(recipe: Recipe, held: HeldStructure, material: Material) -> dict[str, str]:
    """Return facts on the mesh of a model, for users; some may be empty."""
    mesh = held.structure.mesh
    remarks = [
        *mesh.remarks,
        *joint_remarks(held, recipe.supports),
        *contradictions(mesh.stated, material),
    ]
    return {
        "nodes": f"{len(mesh.nodes)}",
        "elements": ", ".join(f"{len(block.connectivity)} {block.kind}" for block in mesh.blocks),
        "degrees of freedom": f"{held.stiffness.shape[0]}",
        "materials": mesh.materials_text,
        "joined by": ", ".join(f"{name} ({count})" for name, count in mesh.joined_by.items()),
        "left out of the file": ", ".join(
            f"{name} ({count})" for name, count in mesh.skipped.items()
        ),
        REMARKS: "\n".join(remarks),
    }


def _errors(
    recipe: Recipe, held: HeldStructure, modes: Eigenmodes, material: Material, progress: Progress
) -> dict[str, Floats]:
    """Return estimated relative errors of frequencies by cause; empty if unknown.

    Modes that are added static shapes have none.
    """
    coarser = recipe.shape.coarser()
    if coarser is None:
        return {}
    coarse_shape, gain = coarser
    number = recipe.reduction.modes or len(modes.angular_frequencies)
    kept = Eigenmodes(modes.angular_frequencies[:number], modes.shapes[:, :number])
    errors = {}
    if recipe.reduction.method == "craig-bampton":
        reduced_frequencies = kept.angular_frequencies
        kept = _improved(held, modes, number)
        errors[REDUCTION] = np.asarray(reduced_frequencies / kept.angular_frequencies - 1.0)
    try:
        coarse = _held_structure(recipe, coarse_shape, material)
        coarse_modes = elastic_system(coarse).modes(number, progress, _ROUGH)
    except (InputError, ComputationError):
        return {}  # the coarser mesh has too few modes, or does not follow the supports
    errors[MESH] = mesh_errors(kept.angular_frequencies, coarse_modes.angular_frequencies, gain)
    if held.structure.thickness:
        errors[SUPPORTS] = support_errors(held, kept)
        errors[THEORY] = plate_theory_errors(held, kept, material, is_thin(recipe))
        # shear at clamped edges adds to that of plane waves
        if isinstance(recipe.shape, PlateOfPlates) and is_thin(recipe):
            thick = _held_structure(recipe, replace(recipe.shape, theory="thick"), material)
            thick_modes = elastic_system(thick).modes(number, progress, _ROUGH)
            difference = kept.angular_frequencies / thick_modes.angular_frequencies - 1.0
            errors[THEORY] = np.maximum(errors[THEORY], np.abs(difference))
    thickness_of_layer = recipe.shape.one_layer()
    if thickness_of_layer:
        errors[MESH] = errors[MESH] + one_layer_errors(
            kept.angular_frequencies, material, thickness_of_layer
        )
    return errors


def _improved(held: HeldStructure, modes: Eigenmodes, number: int) -> Eigenmodes:
    """Return the lowest modes after one step of inverse iteration on those of a reduction."""
    elastic = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    basis = elastic.static(held.mass @ modes.shapes)
    improved = projected(held.stiffness, held.mass, basis, elastic.rigid)
    return Eigenmodes(improved.angular_frequencies[:number], improved.shapes[:, :number])


def _reduced_modes(held: HeldStructure, reduction: Reduction, progress: Progress) -> Eigenmodes:
    """Return the modes of a held structure by truncation or Craig-Bampton reduction.

    Truncated modes may have attachment modes in addition.
    """
    elastic = elastic_system(held)
    number = reduction.modes
    if number is None:
        number = elastic.count_below(2.0 * np.pi * (reduction.max_frequency or 0.0))
        if number < 1:
            lowest = elastic.modes(1).angular_frequencies[0] / (2.0 * np.pi)
            raise InputError(
                f"there is no mode below {reduction.max_frequency:g} Hz; the lowest is at "
                f"{lowest:.5g} Hz",
                "max_frequency",
            )
    if reduction.method == "craig-bampton":
        interface = np.concatenate([_nearest_dofs(held, place) for place in reduction.interface])
        basis = craig_bampton(
            held.stiffness, held.mass, interface, number, held.order, elastic.rigid, progress
        )
        return projected(held.stiffness, held.mass, basis, elastic.rigid)
    modes = elastic.modes(number, progress)
    if not reduction.attachment:
        return modes
    loads = np.stack([_vertical_load(held, place) for place in reduction.attachment], axis=1)
    basis = np.concatenate([modes.shapes, attachment_modes(elastic, modes, loads)], axis=1)
    return projected(held.stiffness, held.mass, basis, elastic.rigid)


def _vertical_load(held: HeldStructure, place: Place) -> Floats:
    """Return the load of a unit vertical force at a place, on the free degrees of freedom."""
    motion, _ = _motion_at(held.structure, place)
    return np.asarray((motion @ held.expansion)[[2]].toarray()[0])


def _nearest_dofs(held: HeldStructure, place: Place) -> Integers:
    """Return the free degrees of freedom of the node nearest to a place."""
    structure = held.structure
    mesh = structure.mesh
    _, position = _motion_at(structure, place)
    # nodes of plate elements lie in the middle plane
    sign = 1.0 if place[1] == "upper" else -1.0
    height = sign * 0.5 * structure.thickness
    distance = np.linalg.norm(mesh.nodes - position + [0.0, 0.0, height], axis=1)
    dofs = mesh.dofs_per_node * distance.argmin() + np.arange(mesh.dofs_per_node)
    return np.unique(held.expansion[dofs].indices)


def _motion_at(structure: Structure, place: Place) -> tuple[csr_array, Floats]:
    """Return the displacements and the position of a place, as `surface_motion`."""
    spot, side = place
    point = np.array([place_of(structure.mesh, spot, side)])
    return surface_motion(structure.mesh, point, side, structure.thickness)


def mesh_features(
    supports: tuple[Support, ...],
) -> tuple[list[Disc], tuple[list[float], list[float]]]:
    """Return the discs, and the x and y of lines [m], that edges of elements must follow."""
    discs = [disc for support in supports for disc in support.discs]
    xs = [x for support in supports for x in support.lines[0]]
    ys = [y for support in supports for y in support.lines[1]]
    return discs, (xs, ys)


def _rims(supports: tuple[Support, ...]) -> tuple[list[float], list[float]]:
    """Return the x and y [m] of straight rims of supports of the lower face."""
    xs = [x for support in supports for x in support.rims[0]]
    ys = [y for support in supports for y in support.rims[1]]
    return xs, ys
