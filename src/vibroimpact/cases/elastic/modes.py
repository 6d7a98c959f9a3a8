"""Modes of the elastic bodies of a case, and doubts about them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.bodies.ball import ball_volume
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.elastic.meshes import meshes_of
from vibroimpact.cases.limits.limit import two_digits
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.report.reported import Reported
from vibroimpact.report.result_warning import ResultWarning
from vibroimpact.structures.damping import ConstantRatio, RatioOfEach, RatioTable
from vibroimpact.structures.finite_elements.surface import Side, materials_at, place_of
from vibroimpact.structures.frequency_error import MESH, REDUCTION, SUPPORTS, THEORY
from vibroimpact.structures.modal_model import ModalBasis, ModalModel
from vibroimpact.structures.recipe import (
    MAIN_CAUSE,
    REMARKS,
    ImportedMesh,
    PlateOfSolids,
    Recipe,
    SphereOfSolids,
    is_thin,
    modal_model_of,
)

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable

_FREQUENCY_OFF = 0.005  # relative: a larger estimated frequency error is doubted
# relative: a larger difference in mass between an imported mesh and the case is doubted
_WEIGHT_OFF = 0.05
_FINER = 1.5  # times smaller elements are proposed
# relative: a larger difference between the material of a case and that of the elements touched is
# doubted
_MATERIAL_OFF = 0.1
_MESH_OFF = 0.005  # relative: a generated mesh with a larger error of its mass is too coarse
_LARGE = 50.0  # m: the coordinates of a larger body are probably in millimetres


@dataclass(frozen=True)
class BodyModes:
    """An elastic body of a case with its modes.

    Parameters
    ----------
    body : ElasticBody
        The body.
    model : ModalModel
        Its modes on its mesh.
    basis : ModalBasis
        Its modes at the contact point and the sensors.
    doubts : tuple of str
        Doubts about it, one sentence each.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type2", {"sphere.modes": 5})
    >>> sphere = vi.compute_modes(case)["sphere"]
    >>> len(sphere.basis.frequencies), round(sphere.basis.mass, 4)
    (5, 0.0903)
    """

    body: ElasticBody
    model: ModalModel
    basis: ModalBasis
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Modes(Reported, Mapping[str, BodyModes], reported_in="vibroimpact.modes.report"):
    """Modes of the elastic bodies of a case, by the name of the body.

    The folder that `save` writes has `report.html`, `modes.csv`, `points.csv` if points are
    watched, `summary.json`, `case.toml`, and for each body its mesh as .bdf and .inp and its shapes
    as .vtu. The charts are "sphere_modes" and "plate_modes", of the bodies that are elastic: their
    first shapes, up to twelve.

    Parameters
    ----------
    case : CaseTable
        The case.
    bodies : mapping of str to BodyModes
        The bodies with their modes, "sphere", "plate" or both.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> modes = vi.compute_modes(vi.load_case("paper:type2", {"sphere.modes": 5}))
    >>> list(modes), list(modes.charts)
    (['sphere'], ['sphere_modes'])
    """

    case: CaseTable
    bodies: Mapping[str, BodyModes]

    def __getitem__(self, name: str) -> BodyModes:
        return self.bodies[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.bodies)

    def __len__(self) -> int:
        return len(self.bodies)


def compute_modes(
    case: CaseTable,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Modes:
    """Return the modes of the elastic bodies of a case, by the name of the body.

    Parameters
    ----------
    case : CaseTable
        A case with `model = "elastic"` for the sphere, the plate, or both.
    progress : callable, optional
        Called with the fraction done, 0 to 1.
    tell : callable, optional
        Called with a warning if the mode store is faulty.

    Raises
    ------
    InputError
        If no body of the case is elastic, or one can't be made.
    ComputationError
        If the modes can't be computed.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> sphere = compute_modes(vi.load_case("paper:type2", {"sphere.modes": 5}))["sphere"]
    >>> [round(float(value), -2) for value in sphere.basis.frequencies[:2]]
    [12700.0, 12700.0]
    """
    bodies = elastic_bodies(case)
    if not bodies and case.plate.radius is not None:
        raise InputError(
            "two spheres are rigid but for their contact, and have no modes; leave out "
            "plate.radius for a plate",
            "plate.radius",
        )
    if not bodies:
        raise InputError(
            'no body of the case is elastic; give the sphere or the plate model = "elastic"'
        )
    modes_of_bodies = {}
    for number, (name, body) in enumerate(bodies.items()):

        def report_part(part: float, number: int = number) -> None:
            if progress is not None:
                progress((number + part) / len(bodies))

        try:
            model = modal_model_of(body.recipe, report_part, tell)
            basis = body.basis(model)
            modes_of_bodies[name] = BodyModes(
                body, model, basis, tuple(_doubts(case, name, body, model, basis))
            )
        except InputError as error:
            meshes_of(case)  # raises with the key, if something does not lie on a mesh
            raise InputError(
                error.message, ".".join(part for part in (name, error.key) if part)
            ) from None
    return Modes(case, modes_of_bodies)


def contact_place(body: BodyModes) -> tuple[tuple[float, float], Side]:
    """Return the position of the contact point of a body [m] and its side."""
    return place_of(body.model.mesh, body.body.contact, body.body.side), body.body.side


def _doubts(
    case: CaseTable, name: str, body: ElasticBody, model: ModalModel, basis: ModalBasis
) -> Iterator[str]:
    """Yield doubts about an elastic body: a plate that is not held, mesh quality and
    size, and overcritical damping.
    """
    if name == "plate" and not model.is_held_vertically and case.drop.gravity:
        yield (
            "the plate is not held: its supports let it fall or tilt, and a drop under gravity "
            "needs a plate that is held"
        )
    yield from _doubts_of_mass(case, name, body, model)
    yield from _doubts_of_materials(case, name, body, model)
    yield from _doubts_of_frequencies(case, name, body, model)
    if any(block.element.order == 1 for block in model.mesh.blocks):
        yield (
            f"the mesh of the {name} has elements of first order, which are far too stiff in "
            "bending; take elements of second order"
        )
    if (
        isinstance(body.damping, (ConstantRatio, RatioOfEach, RatioTable))
        and basis.damping_ratios.max() >= 1.0
    ):
        which = "" if isinstance(body.damping, ConstantRatio) else "of at least one mode "
        yield f"the damping {which}of the {name} is critical or more; a ratio of 0.01 is 1 %"


def _doubts_of_frequencies(
    case: CaseTable, name: str, body: ElasticBody, model: ModalModel
) -> Iterator[str]:
    """Yield a doubt if estimated frequency errors exceed half a per cent, with the main
    cause and a remedy.
    """
    errors = np.nan_to_num(model.frequency_errors)
    off = int((errors > _FREQUENCY_OFF).sum())
    if not off:
        return
    worst = int(errors.argmax())
    cause = model.facts.get(MAIN_CAUSE, MESH)
    remedy = _remedy(case, name, body.recipe, cause)
    which = f"{off} of the {len(errors)} modes" if len(errors) > 1 else "the mode"
    yield ResultWarning(
        f"the frequencies of {which} of the {name} may be off by more than "
        f"{100 * _FREQUENCY_OFF:g} %, most that of mode {worst + 1}, "
        f"{model.frequencies[worst]:.4g} Hz, by about {two_digits(100.0 * errors[worst])} "
        f"%, due to {cause}; {remedy}",
        float(errors[worst]),
    )


def _remedy(case: CaseTable, name: str, recipe: Recipe, cause: str) -> str:
    """Return the remedy for frequency errors by their main cause."""
    shape = recipe.shape
    if cause == THEORY and is_thin(recipe):
        return f'take {name}.mesh.theory = "thick", or keep fewer modes'
    if cause == REDUCTION:
        return f'ask for more modes, or for {name}.reduction = "modal"'
    if cause in (THEORY, SUPPORTS):
        return f'take {name}.element = "solid"'
    if isinstance(shape, SphereOfSolids):
        return f"give {name}.mesh.elements_across = {2 * math.ceil(0.75 * shape.elements_across)}"
    mesh = getattr(case, name).mesh
    if getattr(mesh, "elements", None):  # their size follows
        directions = 2 if mesh.layers else 3
        return f"give {name}.mesh.elements = {math.ceil(_FINER**directions * mesh.elements)}"
    size = getattr(shape, "element_size", 0.0)
    splits = (
        f", or {name}.mesh.splits = {shape.splits + 1}" if isinstance(shape, PlateOfSolids) else ""
    )
    return f'give {name}.mesh.element_size = "{1e3 * size / _FINER:.3g} mm"{splits}'


def _doubts_of_materials(
    case: CaseTable, name: str, body: ElasticBody, model: ModalModel
) -> Iterator[str]:
    """Yield what of a mesh file is not part of the body, and where its materials are not
    that of the case.
    """
    yield from filter(None, model.facts.get(REMARKS, "").split("\n"))
    if not model.mesh.materials:
        return
    material = getattr(case, name).material
    touched = materials_at(
        model.mesh, material, place_of(model.mesh, body.contact, body.side), body.side
    )
    other = next((candidate for candidate in touched if not _alike(candidate, material)), None)
    if other is not None:
        yield (
            f"the elements of the {name} at the contact point are of {other.density:.4g} "
            f"kg/m3 and {other.youngs_modulus:.4g} Pa, and "
            f"the contact is computed with {name}.material, of {material.density:.4g} "
            f"kg/m3 and {material.youngs_modulus:.4g} Pa; "
            "give there the material that is touched"
        )
    if getattr(case, name).damping == "loss-factor":
        yield (
            f"half the loss factor of {name}.material damps all modes of the {name}, whose "
            "mesh has its own materials; give ratios"
        )


def _alike(first: Material, other: Material) -> bool:
    """Return whether two materials are the same in contact, up to the spread of values in
    tables.
    """
    return all(
        abs(getattr(first, key) / getattr(other, key) - 1.0) < _MATERIAL_OFF
        for key in ("density", "youngs_modulus")
    )


def _doubts_of_mass(
    case: CaseTable, name: str, body: ElasticBody, model: ModalModel
) -> Iterator[str]:
    """Yield a doubt if the mass of a mesh differs from that of the case, or its size
    suggests millimetres.
    """
    brought = isinstance(body.recipe.shape, ImportedMesh)
    extent = model.mesh.extent
    size = " x ".join(f"{side:.3g}" for side in (*extent[:2], model.thickness or extent[2]))
    said = f"the mesh of the {name} is {size} m large and weighs {model.properties.mass:.4g} kg"
    if brought:
        remedy = 'give mesh = { file = "...", unit = "mm" }'
    else:
        remedy = 'write "520 mm", as a bare number is in metres'
    hint = f"; if it is in millimetres, {remedy}" if extent.max() > _LARGE else ""
    volume = None
    if name == "sphere":
        volume = ball_volume(case.sphere.radius)
    elif case.plate.size:
        volume = math.prod(case.plate.size)
    if name == "plate" and model.mesh.materials:
        # whose mass is that of no one material; a sphere falls with the mass that the case
        # describes
        volume = None
    expected = body.recipe.density * (volume or math.nan)
    difference = abs(model.properties.mass / expected - 1.0)
    if difference > (_WEIGHT_OFF if brought else _MESH_OFF):
        yield ResultWarning(
            f"{said}, and what the case describes weighs {expected:.4g} "
            f"kg{hint or ('' if brought else '; its elements are too large')}",
            difference,
        )
    elif hint:
        yield said + hint
