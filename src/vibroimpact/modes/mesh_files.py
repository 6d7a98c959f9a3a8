"""The mesh of an elastic body as files for other programs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.materials import Material
from vibroimpact.meshes.write_abaqus import write_abaqus
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.meshes.write_vtu import write_vtu
from vibroimpact.structures.modal_model import ModalModel

_SHAPES_WRITTEN = 50  # limits the size of the file for ParaView


def mesh_files(
    name: str, body: BodyModes, material: Material
) -> dict[str, Callable[[Path], object]]:
    """Return the files of a body by their names, each with the function that writes it.

    The mesh is written for Nastran and Abaqus, and with its lowest shapes for ParaView.
    """
    return {
        f"{name}.bdf": partial(_write_nastran, name, body.model, material),
        f"{name}.inp": partial(_write_abaqus, body.model, material),
        f"{name}.vtu": partial(_write_shapes, body.model),
    }


def _write_nastran(name: str, model: ModalModel, material: Material, path: Path) -> None:
    write_nastran(model.mesh, path, material, f"vibroimpact: {name}", model.thickness or None)


def _write_abaqus(model: ModalModel, material: Material, path: Path) -> None:
    write_abaqus(model.mesh, path, material, model.thickness or None)


def _write_shapes(model: ModalModel, path: Path) -> None:
    shapes = {
        f"mode {mode + 1:03d}, {model.frequencies[mode]:.6g} Hz": model.displacements(mode)
        for mode in range(min(_SHAPES_WRITTEN, len(model.frequencies)))
    }
    write_vtu(model.mesh, path, shapes)
