"""HTML report of a run: tables, figures, animation, case and provenance on one page."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping
from pathlib import Path

import tomli_w

from vibroimpact.dynamics.energy import CLOSURE_LIMIT
from vibroimpact.report.figure_files import save_figures
from vibroimpact.report.page import Picture, picture, template
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.results.result import Result
from vibroimpact.runs.animation import animate
from vibroimpact.runs.captions import animation_caption, caption, left_out, sensors_left_out
from vibroimpact.runs.deformation import deformation_rows, treatment_sentence
from vibroimpact.runs.figures import draw_figures
from vibroimpact.runs.sensor_figures import drawn_sensors
from vibroimpact.runs.tables import impact_table, ledger_table
from vibroimpact.units.display import digits

_TITLES = {
    "position": "Position",
    "force": "Contact force",
    "velocity": "Velocity",
    "acceleration": "Acceleration",
    "force_indentation": "Force over indentation",
    "energy": "Energy",
    "sphere_energy": "Energy of the sphere",
    "plate_motion": "Motion of the plate",
    "plate_energy": "Energy of the plate",
    "deflection": "Deflection of the plate",
}


ANIMATION = "figures/plate.gif"
_LARGEST_HELD = 1_500_000  # bytes of the largest animation embedded in the page


def write_report(result: Result, directory: Path) -> None:
    """Write `report.html` into a directory, and its figures and animation into the folder `figures`.

    Parameters
    ----------
    result : Result
        Result of one drop.
    directory : pathlib.Path
        Existing directory.
    """
    (directory / "figures").mkdir(exist_ok=True)
    pictures = save_figures(draw_figures(result), directory / "figures")
    animation = animate(result) if result.deflection is not None else b""
    if animation:
        (directory / ANIMATION).write_bytes(animation)
    (directory / "report.html").write_text(render_page(result, pictures, animation), encoding="utf-8")


def render_page(result: Result, pictures: Mapping[str, bytes], animation: bytes = b"") -> str:
    """Return the report as one self-contained HTML page without scripts.

    Parameters
    ----------
    result : Result
        Result of one drop.
    pictures : mapping of str to bytes
        Figures as SVG by name, in the order of the page.
    animation : bytes, optional
        Animation of plate and sphere as GIF. One of more than 1.5 MB is not embedded; the page then only links to its file.
    """
    unit, ledger = ledger_table(result)
    return template(__package__).render(
        name=result.name[:1].upper() + result.name[1:],
        status=result.status,
        failed=result.status.startswith("Failed"),
        impacts=impact_table(result),
        ledger_unit=unit,
        ledger=ledger,
        closure=f"{digits(result.energy['closure_J'], 2)} J",
        closure_relative=digits(result.energy["closure_relative"], 2),
        closure_limit=digits(CLOSURE_LIMIT, 1),
        pictures=_pictures(result, pictures),
        left_out=left_out(result),
        sentence=treatment_sentence(result),
        deformation=deformation_rows(result),
        sensors_left_out=sensors_left_out(result),
        animation=_animation(result, animation),
        animation_file=ANIMATION,
        case=_case_text(result.case),
        doubts=result.doubts,
        provenance=result.provenance,
    )


def _pictures(result: Result, pictures: Mapping[str, bytes]) -> list[Picture]:
    titles = {**_TITLES, **{figure: f"Sensor {name}" for figure, name in drawn_sensors(result).items()}}
    return [picture(name, titles[name], caption(name, result), svg) for name, svg in pictures.items()]


def _animation(result: Result, gif: bytes) -> Picture | None:
    """Return the animation for the page, with an empty source if it is too large to embed; None if there is none."""
    if not gif:
        return None
    source = f"data:image/gif;base64,{b64encode(gif).decode()}" if len(gif) <= _LARGEST_HELD else ""
    return Picture("animation", "Plate and ball in slow motion", animation_caption(result), source)


def _case_text(case: ResolvedCase) -> str:
    return tomli_w.dumps(case) if case else ""
