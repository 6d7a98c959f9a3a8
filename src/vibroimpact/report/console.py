"""What the command line prints: tables of results and materials, and a case explained."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import fields

from rich.console import Group, RenderableType
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from vibroimpact.cases.build import contact_laws_of, contact_pair, deforms, elastic_names, first_speed, impacts_of, resolved
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.expected import expected_of
from vibroimpact.cases.schema import Case, SensorSection
from vibroimpact.contact.law import CompliantLaw, ContactLaw, unit_of
from vibroimpact.contact.restitution import achieved_restitution
from vibroimpact.dynamics.columns import LEDGER, VIBRATION_LEDGER
from vibroimpact.errors import InputError
from vibroimpact.materials import RIGID, Material, find_material, material_library
from vibroimpact.report.comparison import Comparison, comparison_doubts, comparison_table, free_parameter_words
from vibroimpact.report.deformation import deformation_rows, treatment_sentence
from vibroimpact.report.tables import certain_figures, several_contacts, takes_digits
from vibroimpact.storage.result import Result

# column, heading, factor, digits
_IMPACT_TABLE = (
    ("time_s", "time\n[s]", 1.0, 6),
    ("duration_s", "contact\n[us]", 1e6, 4),
    ("approach_speed_m_s", "approach\n[m/s]", 1.0, 4),
    ("separation_speed_m_s", "separation\n[m/s]", 1.0, 4),
    ("restitution_asked", "e\nasked", 1.0, 3),
    ("restitution_achieved", "e\nachieved", 1.0, 5),
    ("max_indentation_m", "indentation\n[um]", 1e6, 4),
    ("max_force_N", "force\n[N]", 1.0, 5),
    ("max_acceleration_m_s2", "acceleration\n[m/s2]", 1.0, 6),
    ("rebound_height_m", "rebound\n[m]", 1.0, 5),
    ("energy_lost_J", "lost\n[J]", 1.0, 4),
    ("contacts", "con-\ntacts", 1.0, 3),
    ("sensitivity", "sensi-\ntivity", 1.0, 2),
)
_FIRST_LEFT_OUT = (
    "max_acceleration_m_s2",
    "energy_lost_J",
    "separation_speed_m_s",
    "restitution_asked",
    "max_indentation_m",
    "contacts",
    "rebound_height_m",
    "duration_s",
    "approach_speed_m_s",
)
"""Columns that a narrow terminal does without, in this order, until the others fit."""
_BETWEEN = 2  # columns of a terminal between two columns of a table
_FIRST_ROWS, _LAST_ROWS = 15, 3


def impact_table(result: Result, width: int) -> RenderableType:
    """Return the table of impacts for a terminal of a width: columns that do not fit are left out, numbers are not cut.

    The middle of a long table is left out. Numbers are shown with the digits that they have where the drop is sensitive.
    """
    impacts, change = result.impacts, result.change_by_impact
    number = len(impacts["impact"])
    if not number:
        return Text("No impact within the run.")
    rows = [index for index in range(number) if not _FIRST_ROWS <= index < number - _LAST_ROWS]
    told = {"contacts": several_contacts(impacts), "sensitivity": takes_digits(change)}
    columns = {"impact": ["", "#", *(str(int(impacts["impact"][index])) for index in rows)]}
    for name, heading, factor, digits in _IMPACT_TABLE:
        if told.get(name, True):
            figures, values = certain_figures(change, name), impacts[name]
            cells = (_number(float(values[index]) * factor, digits, int(figures[index])) for index in rows)
            columns[name] = [*heading.split("\n"), *cells]
    for name in _FIRST_LEFT_OUT:
        if sum(max(map(len, column)) + _BETWEEN for column in columns.values()) > width:
            columns.pop(name, None)
    table = Table(box=None, padding=(0, 1), header_style="bold")
    for above, below, *_ in columns.values():
        table.add_column(escape(f"{above}\n{below}"), justify="right", no_wrap=True)
    for place, row in enumerate(zip(*(column[2:] for column in columns.values()), strict=True)):
        if place == _FIRST_ROWS and len(rows) < number:
            table.add_row("...")
        table.add_row(*row)
    return table


def energy_table(energy: Mapping[str, float]) -> RenderableType:
    """Return the ledger at the end of the run, without the entries that are zero."""
    table = Table(box=None, padding=(0, 1), header_style="bold")
    table.add_column("energy at the end")
    table.add_column(escape("[J]"), justify="right")
    table.add_column("%", justify="right")
    whole = energy["input_J"]
    for name in (*LEDGER, *(name for name in VIBRATION_LEDGER if name in energy)):
        part = energy[name] / whole
        if abs(part) > 1e-12:  # less is rounding
            table.add_row(name.removesuffix("_J").replace("_", " "), _number(energy[name], 6), _number(100.0 * part, 4))
    table.add_row("[bold]put in[/bold]", f"[bold]{_number(whole, 6)}[/bold]", "100")
    return Group(table, Text(f" closure {energy['closure_relative']:.1e} of the energy put in", style="dim"))


def result_summary(result: Result, width: int) -> RenderableType:
    """Return what a run prints in a terminal of a width: the tables, the status, and what to doubt."""
    return Group(
        Text(result.name, style="bold"),
        impact_table(result, width),
        Text(),
        energy_table(result.energy),
        Text(),
        Text(result.status),
        *_deformation(result),
        *_doubt_lines(result.doubts),
    )


def _deformation(result: Result) -> list[RenderableType]:
    """Return how the bodies deform, where they do: a sentence, and its numbers."""
    rows, table = deformation_rows(result), Table.grid(padding=(0, 2))
    for words, value in rows:
        table.add_row(f" {escape(words)}", escape(value))
    sentence = treatment_sentence(result)
    return [Text(), *([Text(sentence)] if sentence else []), table] if rows or sentence else []


def comparison_summary(comparison: Comparison) -> RenderableType:
    """Return what a comparison prints: a row a law, and the parameter that sets the loss of each."""
    headers, rows = comparison_table(comparison)
    table = Table(box=None, padding=(0, 1), header_style="bold")
    for number, (heading, unit) in enumerate(headers):
        words = f"{heading}\n[{unit}]" if unit else heading
        table.add_column(escape(words), justify="right" if number else "left", no_wrap=not number, vertical="bottom")
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    free = Table.grid(padding=(0, 2))
    for name, law in comparison.laws.items():
        free.add_row(f" {name}", escape(free_parameter_words(law)), escape(comparison.results[name].status))
    note = Text(" Indentation, force, duration, height and energy are those of the first impact.", style="dim")
    title = Text("What sets the loss, and how the run ended", style="bold")
    return Group(Text(comparison.name, style="bold"), table, note, Text(), title, free, *_doubt_lines(comparison_doubts(comparison)))


def material_table() -> RenderableType:
    """Return the table of shipped materials."""
    table = Table(box=None, padding=(0, 1), header_style="bold")
    table.add_column("\nname", no_wrap=True)
    for heading in ("density\n[kg/m3]", "Young's\n[GPa]", "Poisson's\n[-]"):
        table.add_column(escape(heading), justify="right", no_wrap=True)
    table.add_column("\nwhat", overflow="fold")
    for name, material in material_library().items():
        numbers = f"{material.density:g}", f"{material.youngs_modulus / 1e9:g}", f"{material.poissons_ratio:g}"
        table.add_row(name, *numbers, escape(material.description))
    notes = 'Also "rigid" for a plate. "vibroimpact materials NAME" gives the source of each number. Rock and coal vary widely.'
    return Group(table, Text(), Text(notes))


def material_sheet(name: str) -> RenderableType:
    """Return one material with the source of each number.

    Raises
    ------
    InputError
        If there is no such material.
    """
    material, table = find_material(name), Table.grid(padding=(0, 2))
    for key, unit in (
        ("density", "kg/m3"),
        ("youngs_modulus", "Pa"),
        ("poissons_ratio", ""),
        ("yield_strength", "Pa"),
        ("compressive_strength", "Pa"),
        ("tensile_strength", "Pa"),
        ("loss_factor", ""),
    ):
        value = getattr(material, key)
        if value is not None:
            table.add_row(key, f"{value:g} {unit}".strip(), escape(material.sources.get(key, "")))
    note = [Text(material.note)] if material.note else []
    return Group(Text(f"{material.name}: {material.description}", style="bold"), table, *note)


def case_explained(case: Case) -> RenderableType:
    """Return what a case means: the resolved numbers, what to expect, and what to doubt."""
    laws, pair, speed = contact_laws_of(case), contact_pair(case), first_speed(case)
    mass, radius, gravity = float(pair.effective_mass), case.sphere.radius, case.drop.gravity
    rows: list[tuple[str, str]] = [
        ("sphere", f"radius {radius:g} m, mass {mass:.6g} kg, {case.sphere.model}, of {_stuff(case.sphere.material)}"),
        (
            "plate",
            f"{'rigid, held fixed' if case.plate.model == 'rigid' else 'elastic'}, of {_stuff(case.plate.material)}"
            + (f", {' x '.join(f'{side:g}' for side in case.plate.size)} m" if case.plate.size else ""),
        ),
        *_elastic_rows(case),
        *_coupling_rows(case),
        ("effective modulus", f"{pair.effective_modulus:.6g} Pa"),
        ("first approach speed", f"{speed:.6g} m/s, gravity {gravity:g} m/s2"),
        ("contact law", f"{case.contact.law}: {laws[0].equation}"),
    ]
    for item in fields(laws[0]):
        values = [getattr(law, item.name) for law in laws]
        if values[0] is None or (item.metadata["memory"] and not any(values)):
            continue
        shown = (
            ", ".join(f"{value:.9g}" for value in values) if len(set(values)) > 1 else f"{values[0]:.9g}" if values[0] is not None else "-"
        )
        rows.append((f"  {item.name}", f"{shown} {unit_of(item, getattr(laws[0], 'exponent', 1))}"))
    number = impacts_of(case)
    stop = ["at rest"] + ([f"after {number} impact{'' if number == 1 else 's'}"] if number else [])
    stop += [f"at {case.run.duration:g} s"] if case.run.duration else []
    rows += [("stops", " or ".join(stop)), ("tolerance", f"{case.run.tolerance:g}")]
    if case.calibrate is not None:
        tuned = case.calibrate.parameter or "what sets the loss of the law"
        rows.append(("to calibrate", f"{tuned}; a run takes no notice of [calibrate]"))
    if isinstance(laws[0], CompliantLaw) and laws[0].lasting:
        where = "on the same spot: the dent of the last one lasts" if case.drop.same_spot else "on fresh surfaces"
        rows.append(("each impact", f"{where} (drop.same_spot = {str(case.drop.same_spot).lower()})"))
    rigid = not deforms(case)
    label = "restitution" if rigid else "restitution if rigid"
    rows += [("" if number else label, line) for number, line in enumerate(_restitution_lines(laws[0], mass, speed))]
    expected = expected_of(case)
    if not math.isnan(expected.force):
        numbers = f"indentation {expected.depth:.4g} m, force {expected.force:.4g} N"
        rows.append(("if nothing were lost" + ("" if rigid else ", rigid"), numbers))
    found = doubts(resolved(case), expected)
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    return Group(Text(case.name or "a drop", style="bold"), table, *_doubt_lines(found))


def _elastic_rows(case: Case) -> list[tuple[str, str]]:
    if not elastic_names(case):
        return []
    from vibroimpact.report.modes_text import elastic_rows  # which loads sparse matrices

    return elastic_rows(case)


def _coupling_rows(case: Case) -> list[tuple[str, str]]:
    """Say how local indentation is treated, and what is watched."""
    if not deforms(case):
        return []
    local = case.contact.local
    words: list[str] = []
    if elastic_names(case) or local.local_compliance is not None:
        words.append(local.local_compliance or "consistent, by default")
    if local.finite_sphere:
        words.append("Hertz's half space corrected to a sphere of finite size")
    if local.local_stiffness is not None:
        words.append(f"local element of {local.local_stiffness:.6g} N/m and {local.local_damping:.6g} N s/m")
    if local.measured is not None:
        where = "on a rigid plate" if local.measured.plate == "rigid" else "on this plate"
        words.append(f"local element found from a largest force of {local.measured.max_force:.6g} N {where}")
    rows = [("local compliance", "; ".join(words))]
    for sensor in case.sensors:
        place = sensor.position if isinstance(sensor.position, str) else f"({sensor.position[0]:g}, {sensor.position[1]:g}) m"
        words = [f"{sensor.quantity} at {place}, {sensor.face} face", *_accelerometer(sensor), f"{sensor.rate:g} Hz", _filter(sensor)]
        rows.append((f"sensor {sensor.name}", ", ".join(words)))
    return rows


def _accelerometer(sensor: SensorSection) -> list[str]:
    """Say what reads a sensor's acceleration, where something does."""
    meter = sensor.accelerometer
    if meter is None:
        return []
    given = [
        ("resonance", meter.resonance, f"Hz with a damping ratio of {meter.damping_ratio:g}"),
        ("range", meter.range, "m/s2"),
        ("noise", meter.noise or None, "m/s2"),
        ("resolution", meter.resolution, "m/s2"),
    ]
    words = [f"{name} {value:g} {unit}" for name, value, unit in given if value is not None]
    return [f"by an accelerometer ({'; '.join(words) or 'ideal'})"]


def _filter(sensor: SensorSection) -> str:
    """Say what keeps a sensor's samples from folding."""
    if sensor.filter == "none":
        return "no anti-alias filter"
    corner = f" at {sensor.corner:g} Hz" if sensor.corner else ""
    return f"{sensor.filter} filter{corner}"


def _restitution_lines(law: ContactLaw, mass: float, speed: float) -> list[str]:
    """Say what a law achieves, and what to ask it for where that is something else."""
    achieved = float(achieved_restitution(law, mass, speed))
    asked = getattr(law, "restitution", achieved) if law.free_parameter == "restitution" else achieved
    if abs(achieved - asked) < 5e-4:
        return [f"{achieved:.5g} achieved at the first touch, without gravity"]
    lines = [f"{asked:.5g} asked, {achieved:.5g} achieved at the first touch, without gravity"]
    try:
        better = getattr(law.achieving(asked, mass, speed), "restitution", asked)
        lines.append(f"restitution = {better:.6g} would achieve {asked:.5g}")
    except InputError as error:
        lines.append(error.message)
    return lines


def versions_table(rows: Iterable[tuple[str, str]]) -> RenderableType:
    """Return a plain table of two columns."""
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    return table


def _stuff(material: Material) -> str:
    name = material.name or "a material"
    return (
        name
        if material is RIGID
        else f"{name} (E {material.youngs_modulus:.4g} Pa, nu {material.poissons_ratio:g}, {material.density:g} kg/m3)"
    )


def _doubt_lines(found: Iterable[str]) -> list[RenderableType]:
    return [Text(f"Doubt: {doubt}.", style="yellow") for doubt in found]


def _number(value: float, digits: int, certain: int = 17) -> str:
    """Return a number in so many digits, or in the fewer that are certain."""
    if not math.isfinite(value):
        return "-"
    if certain < digits:
        return f"{value:#.{certain}g}".replace(".e", "e").rstrip(".") if certain else "?"  # zeros at the end are digits too
    return f"{value:.{digits}g}" if value == 0 or 1e-3 <= abs(value) < 10.0 ** (digits + 1) else f"{value:.{max(digits - 2, 1)}e}"
