"""The figures of the paper that show results, by their names and in its order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.report.mesh_figure import draw_meshes
from vibroimpact.paper.report.model_figure import draw_model
from vibroimpact.paper.report.plate_figures import PLATE, draw_plate
from vibroimpact.paper.report.rigid_figures import RIGID_FIGURES, draw_rigid
from vibroimpact.paper.report.type_figures import ENERGY, MOTION, draw_types
from vibroimpact.paper.runs import Runs

PAPER_FIGURES: Mapping[str, Callable[[Runs], Drawing]] = {
    "fig3": draw_model,
    **{f"fig{what.number}": partial(draw_rigid, what) for what in RIGID_FIGURES},
    "fig9": draw_meshes,
    **{f"fig{what.number}": partial(draw_types, what) for what in (*MOTION, *ENERGY)},
    **{f"fig{what.number}": partial(draw_plate, what) for what in PLATE},
}
"""Each is drawn from the simulations."""
