"""ParaView files of the moving elastic bodies during and after the first visit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.results.deflection import contact_point_of, frame_times_of

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response
    from vibroimpact.structures.finite_elements.mesh import Mesh
    from vibroimpact.structures.modal_model import ModalModel


PARAVIEW = "paraview"
"""Name of the folder of these files, inside a result folder."""
_FRAMES = 40
"""Number of frames, at most."""
_MOST_BYTES = 40e6
"""Limit of the size of all files together, which reduces the number of frames of fine meshes."""
_BLOCK = 1024
"""Number of degrees of freedom whose mode shapes are multiplied at all times together:
they lie in the processor's cache.
"""


def write_paraview(response: Response, folder: Path) -> None:
    """Write `plate.pvd` and `sphere.pvd` with their data files into a new folder.

    Both use the coordinates of the plate. `displacement_m` is relative to the configuration in
    which the plate is at rest and the sphere just touches it; `deformation_m`, of the sphere only,
    is the modal displacement without the motion of its centre. No folder is written if no body has
    a modal model, there is no impact, or two frames would already exceed 40 MB.

    Parameters
    ----------
    response : Response
        Response of one drop.
    folder : pathlib.Path
        The folder to make.
    """
    models = response.problem.models
    if not models:
        return
    # not needed by a case with rigid bodies
    from vibroimpact.meshes.vtu_series import series_size, write_vtu_series

    times = frame_times_of(response)
    if not len(times):
        return
    # a file of the sphere has its displacement and its deformation
    fields = {"plate": 1, "sphere": 2}
    size = sum(series_size(model.mesh, fields[name]) for name, model in models.items())
    count = min(_FRAMES, len(times), int(_MOST_BYTES / size))
    if count < 2:
        return
    times = times[np.unique(np.linspace(0, len(times) - 1, count).round().astype(int))]
    modal = response.modal(times)
    folder.mkdir()
    if "plate" in models:
        plate = models["plate"]
        write_vtu_series(
            plate.mesh,
            folder / "plate.pvd",
            times,
            ({"displacement_m": moved} for moved in _moved(plate, modal["plate"])),
        )
    if "sphere" in models:
        sphere = models["sphere"]
        offset = float(response.problem.sphere.contact_offset)
        fall = response.at(times)["position_m"] - offset
        write_vtu_series(
            _at_first_touch(response, offset),
            folder / "sphere.pvd",
            times,
            (
                {"displacement_m": moved + np.array([0.0, 0.0, down]), "deformation_m": moved}
                for moved, down in zip(_moved(sphere, modal["sphere"]), fall, strict=True)
            ),
        )


def _moved(model: ModalModel, modal: Floats) -> Iterator[Floats]:
    """Yield the nodal displacements at each time, (nodes, 3) [m]."""
    moved = np.empty((len(modal), model.shapes.shape[1]))
    for first in range(0, moved.shape[1], _BLOCK):
        block = slice(first, first + _BLOCK)
        for number, amplitudes in enumerate(modal):
            moved[number, block] = amplitudes @ model.shapes[:, block]
    yield from moved.reshape(len(modal), len(model.mesh.nodes), -1)[:, :, :3]


def _at_first_touch(response: Response, offset: float) -> Mesh:
    """Return the mesh of the sphere at the position where it just touches the plate, in
    the coordinates of the plate.
    """
    sphere = response.problem.models["sphere"]
    plate = response.problem.models.get("plate")
    above = np.zeros(3)
    if plate is not None:
        above = plate.at(np.array([contact_point_of(response, plate)]))[1][0]
    move = above + np.array([0.0, 0.0, offset]) - sphere.properties.centre
    return replace(sphere.mesh, nodes=sphere.mesh.nodes + move)
