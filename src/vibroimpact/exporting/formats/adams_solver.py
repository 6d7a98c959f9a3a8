"""Adams/Solver: the model as a dataset (.adm), and the commands that run it (.acf)."""

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

# identifiers of the elements in the dataset, which has them as numbers
_NAMES = Names(
    centre="11", spot="1", sensor="1", speed="1", damping="2", slip_x="3", slip_y="4", drag="5"
)


def write(drop: Drop) -> dict[str, bytes]:
    """Return the dataset and the file of solver commands.

    Raises
    ------
    InputError
        If the contact law is not supported.
    """
    model = adams_model(drop)
    dataset = render_deck("adams_solver.adm.j2", **adams_quantities(model, _NAMES, contact="1"))
    commands = render_deck("adams_solver.acf.j2", model=model)
    return {
        f"{model.name}.adm": dataset.encode("ascii"),
        f"{model.name}.acf": commands.encode("ascii"),
    }


FORMAT = ExportFormat(
    name="adams",
    program="MSC Adams/Solver",
    files="a dataset NAME.adm, and NAME.acf with the commands that run it",
    tested=TESTED,
    write=write,
    notes=adams_notes,
    dialog=adams_dialog,
    prepare=as_rigid,
)
