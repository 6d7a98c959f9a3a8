"""What the command line prints: tables of results, laws, materials, and a case explained."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields

import numpy as np
from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from vibroimpact.cases.build import contact_pair, impacts_of
from vibroimpact.cases.schema import Case
from vibroimpact.contact.law import CompliantLaw, contact_laws
from vibroimpact.dynamics.columns import LEDGER
from vibroimpact.dynamics.encounter import encounter_of
from vibroimpact.materials import material_library
from vibroimpact.storage.result import Result

# column, heading, factor, digits
_IMPACT_TABLE = (
    ("time_s", "time\n[s]", 1.0, 6),
    ("duration_s", "contact\n[us]", 1e6, 5),
    ("approach_speed_m_s", "approach\n[m/s]", 1.0, 5),
    ("separation_speed_m_s", "separation\n[m/s]", 1.0, 5),
    ("restitution_asked", "e\nasked", 1.0, 4),
    ("restitution_achieved", "e\nachieved", 1.0, 5),
    ("max_indentation_m", "indentation\n[um]", 1e6, 5),
    ("max_force_N", "force\n[N]", 1.0, 6),
    ("max_acceleration_m_s2", "acceleration\n[m/s2]", 1.0, 6),
    ("rebound_height_m", "rebound\n[m]", 1.0, 6),
    ("energy_lost_J", "lost\n[J]", 1.0, 4),
)
_MOST_ROWS = 40


def impact_table(impacts: Mapping[str, np.ndarray]) -> RenderableType:
    """Return the table of impacts; the middle of a long one is left out and said so."""
    table = Table(title="Impacts", title_justify="left", header_style="bold")
    table.add_column("#", justify="right")
    for _, heading, _, _ in _IMPACT_TABLE:
        table.add_column(escape(heading), justify="right", no_wrap=True)
    number = len(impacts["impact"])
    for index in range(number):
        if number > _MOST_ROWS and 30 <= index < number - 5:
            if index == 30:
                table.add_row("...", *(["..."] * len(_IMPACT_TABLE)))
            continue
        cells = (_number(float(impacts[name][index]) * factor, digits) for name, _, factor, digits in _IMPACT_TABLE)
        table.add_row(str(int(impacts["impact"][index])), *cells)
    return table


def energy_table(energy: Mapping[str, float]) -> RenderableType:
    """Return the ledger at the end of the run."""
    table = Table(title="Energy at the end", title_justify="left", header_style="bold")
    table.add_column("")
    table.add_column(escape("[J]"), justify="right")
    table.add_column("% of input", justify="right")
    whole = energy["input_J"]
    for name in LEDGER:
        part = energy[name] / whole if abs(energy[name]) > 1e-12 * whole else 0.0  # rounding is not energy
        table.add_row(name.removesuffix("_J").replace("_", " "), _number(part * whole, 6), _number(100.0 * part, 4))
    table.add_row("[bold]put in[/bold]", f"[bold]{_number(whole, 6)}[/bold]", "100")
    table.caption = f"closure {energy['closure_relative']:.1e} of the energy put in"
    return table


def result_summary(result: Result) -> RenderableType:
    """Return what a run prints: the tables and the status."""
    return Group(Text(result.name, style="bold"), impact_table(result.impacts), energy_table(result.energy), Text(result.status))


def law_table() -> RenderableType:
    """Return the table of contact laws."""
    table = Table(title="Contact laws", title_justify="left", header_style="bold", show_lines=True)
    for heading in ("name", "force or speed", "parameters", "contact ends", "tension", "source"):
        table.add_column(heading, overflow="fold")
    for name, law in contact_laws().items():
        parameters = "\n".join(
            f"{item.name}{f' [{unit}]' if (unit := item.metadata['unit']) else ''}{_origin(item)}" for item in fields(law)
        )
        end, tension = ("at zero indentation", law.tension) if issubclass(law, CompliantLaw) else ("at once", "-")
        if issubclass(law, CompliantLaw) and law.contact_end == "zero-force":
            end = "at zero force"
        table.add_row(name, escape(law.equation), escape(parameters), end, tension, escape(law.source))
    return table


def material_table() -> RenderableType:
    """Return the table of shipped materials, with the source of each density, modulus and ratio."""
    table = Table(title="Materials", title_justify="left", header_style="bold")
    table.add_column("name", no_wrap=True)
    for heading in ("density\n[kg/m3]", "Young's\n[GPa]", "Poisson's\n[-]"):
        table.add_column(escape(heading), justify="right", no_wrap=True)
    table.add_column("what, and source of Young's modulus", overflow="fold")
    for name, material in material_library().items():
        text = f"{escape(material.description)}\n[dim]{escape(material.sources['youngs_modulus'])}[/dim]"
        table.add_row(name, f"{material.density:g}", f"{material.youngs_modulus / 1e9:g}", f"{material.poissons_ratio:g}", text)
    table.caption = 'also "rigid", of infinite modulus, for a plate; field samples of rock and coal vary widely: measure yours'
    return table


def case_explained(case: Case) -> RenderableType:
    """Return what a case means: the resolved numbers, what to expect, and what to doubt."""
    problem, pair = case.to_problem(), contact_pair(case)
    mass, radius, gravity = float(problem.sphere.mass), case.sphere.radius, case.drop.gravity
    speed = case.drop.speed or math.sqrt(2.0 * gravity * (float(case.drop.height or radius) - radius))
    rows: list[tuple[str, str]] = [
        ("sphere", f"radius {radius:g} m, mass {mass:.6g} kg, {case.sphere.model}"),
        (
            "plate",
            f"{case.plate.model}, held fixed" + (f", {' x '.join(f'{side:g}' for side in case.plate.size)} m" if case.plate.size else ""),
        ),
        ("effective modulus", f"{pair.effective_modulus:.6g} Pa"),
        ("first approach speed", f"{speed:.6g} m/s, gravity {gravity:g} m/s2"),
        ("contact law", f"{case.contact.law}: {problem.laws[0].equation}"),
    ]
    for item in fields(problem.laws[0]):
        values = [getattr(law, item.name) for law in problem.laws]
        shown = (
            ", ".join(f"{value:.9g}" for value in values) if len(set(values)) > 1 else f"{values[0]:.9g}" if values[0] is not None else "-"
        )
        rows.append(
            (f"  {item.name}", f"{shown} {item.metadata['unit']}".replace("N/m^n", f"N/m^{getattr(problem.laws[0], 'exponent', 1):g}"))
        )
    number = impacts_of(case)
    stop = [f"after {number} impacts" if number else "at rest"] + ([f"at {case.run.duration:g} s"] if case.run.duration else [])
    rows += [("stops", " or ".join(stop) + ", or at rest"), ("tolerance", f"{case.run.tolerance:g}")]
    law = problem.laws[0]
    doubts: list[str] = []
    if isinstance(law, CompliantLaw):
        one = np.ones(1)
        encounter = encounter_of(law, mass * one, gravity * one, speed * one)
        depth = encounter.depth
        force = float(np.asarray(law.forces(depth, 0.0 * one, encounter.approach_speed)[0])[0])
        rows.append(("if nothing were lost", f"indentation {float(depth[0]):.4g} m, force {force:.4g} N"))
        if depth[0] > 0.09 * radius:
            part = math.sqrt(float(depth[0]) / radius)
            doubts.append(f"the contact radius would be about {part:.2g} of the sphere's: Hertz's theory holds for small contacts")
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    return Group(Text(case.name or "a drop", style="bold"), table, *(Text(f"Doubt: {doubt}.", style="yellow") for doubt in doubts))


def versions_table(rows: Iterable[tuple[str, str]]) -> RenderableType:
    """Return a plain table of two columns."""
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    return table


def _origin(item: object) -> str:
    metadata, default = item.metadata, item.default  # type: ignore[attr-defined]
    if metadata["from_pair"]:
        return " (from the materials)" if "stiffness" in metadata["from_pair"] else " (from the bodies)"
    return "" if default is MISSING else " (optional)" if default is None else f" = {default:g}"


def _number(value: float, digits: int) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{value:.{digits}g}" if value == 0 or 1e-3 <= abs(value) < 10.0 ** (digits + 1) else f"{value:.{max(digits - 2, 1)}e}"
