"""Adams View: a command file that builds the model (.cmd)."""

from __future__ import annotations

from vibroimpact.exporting.adams_contact import Names
from vibroimpact.exporting.adams_model import (
    TESTED,
    adams_dialog,
    adams_model,
    adams_notes,
    adams_quantities,
)
from vibroimpact.exporting.deck import render_deck
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.exporting.rigid_drop import as_rigid


def write(drop: Drop) -> dict[str, bytes]:
    """Return the command file.

    Raises
    ------
    InputError
        If the contact law is not supported.
    """
    model = adams_model(drop)
    names = Names(
        centre=f".{model.name}.sphere.cm",
        spot=f".{model.name}.ground.spot",
        sensor=f".{model.name}.touch",
        speed=f".{model.name}.approach_speed",
        damping=f".{model.name}.damping",
        slip_x=f".{model.name}.slip_x",
        slip_y=f".{model.name}.slip_y",
        drag=f".{model.name}.drag",
    )
    quantities = adams_quantities(model, names, contact=f".{model.name}.contact")
    commands = render_deck("adams_view.cmd.j2", **quantities)
    return {f"{model.name}.cmd": commands.encode("ascii")}


FORMAT = ExportFormat(
    name="adams-view",
    program="MSC Adams View",
    files="a command file NAME.cmd",
    tested=TESTED,
    write=write,
    notes=adams_notes,
    dialog=adams_dialog,
    prepare=as_rigid,
)
