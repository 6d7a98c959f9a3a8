"""What is typed into programs of discrete elements, as tables."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping

from vibroimpact.exporting.contact_parameters import approach_speeds, laws_of_impacts, shared_notes
from vibroimpact.exporting.dem_programs import (
    dem_contact,
    entries,
    softened,
    time_steps,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, Rows, file_name
from vibroimpact.exporting.rigid_drop import as_rigid


def rows(drop: Drop) -> Mapping[str, Rows]:
    """Return what is typed into each program, a time step for each, and softer contacts.

    Raises
    ------
    InputError
        If the spring of the drop's law is not linear or Hertz's.
    """
    contact = dem_contact(drop)
    softer = []
    for row in softened(contact, drop):
        cells = {
            "stiffness_divided_by": row.factor,
            "stiffness_N_m_n": row.stiffness,
            "contact_time_s": row.duration,
            "times_longer": row.longer,
            "overlap_over_radius": row.overlap,
            "largest_force_N": row.force,
            "restitution": row.restitution,
        }
        if contact.is_hertzian:
            cells["youngs_modulus_Pa"] = row.youngs_modulus
        softer.append(cells)
    return {
        "typed": [entry._asdict() for entry in entries(contact)],
        "time-steps": [
            {
                "program": step.program,
                "time_step_s": step.step,
                "steps_per_contact": step.steps_per_contact,
                "rule": step.rule,
            }
            for step in time_steps(contact)
        ],
        "softened": softer,
    }


def _write(drop: Drop) -> Mapping[str, bytes]:
    return {
        file_name(drop, f"-{name}.csv"): _text(table).encode() for name, table in rows(drop).items()
    }


def _text(table: Rows) -> str:
    """Return rows as CSV."""
    lines = io.StringIO()
    writer = csv.DictWriter(lines, list(table[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(table)
    return lines.getvalue()


def _notes(drop: Drop) -> list[str]:
    contact = dem_contact(drop)
    law = laws_of_impacts(drop)[0]
    notes = [
        *shared_notes(drop),
        f"The restitution is that of {law.name} at the first impact, {contact.restitution:.4g} at "
        f"{contact.speed:.4g} m/s; in these programs it is the same at all speeds, and that of the "
        "law at others may differ.",
        "A sphere on a plate at rest that is held; sphere and plate have one modulus, with which "
        "the contact has the stiffness of the law.",
        "Rocky's stiffness is modulus times size, of sphere and plate in series, as an article "
        "quotes its manual; its spring is linear, with the contact time of the law.",
        "With a lower stiffness the contact time grows by the factor to the power "
        f"{1.0 / (contact.exponent + 1.0):g} at the same restitution, and the time step with it; "
        "overlaps grow, and forces fall.",
    ]
    if contact.is_hertzian:
        notes.append(
            "MFiX's number is not the restitution: its Hertzian damping is 2/sqrt(5) of that with "
            "which a restitution is achieved."
        )
    else:
        notes.append(
            "EDEM's linear spring takes its stiffness from the modulus and a speed, and is left "
            "out."
        )
    if len(approach_speeds(drop)) > 1 and len(laws_of_impacts(drop)) > 1:
        notes.append("The law changes from impact to impact; the numbers are of the first.")
    return notes


FORMAT = ExportFormat(
    name="dem",
    program="people who set up LAMMPS, YADE, LIGGGHTS, EDEM, Rocky or MFiX",
    files="NAME-typed.csv, NAME-time-steps.csv and NAME-softened.csv",
    tested="each program's documented force, integrated with the typed numbers by SciPy; LAMMPS "
    "22 Jul 2025, update 4, was run with them. The others were not run",
    write=_write,
    notes=_notes,
    rows=rows,
    prepare=as_rigid,
)
