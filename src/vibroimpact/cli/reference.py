"""The commands `cases`, `new`, `units`, `laws`, `materials`, `schema` and `doctor`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_case, complete_law, complete_material
from vibroimpact.cli.shared import Changes, Json, app, console, say, settings_of, show
from vibroimpact.errors import ComputationError, InputError


@app.command()
def cases(as_json: Json = False) -> None:
    """List the shipped cases."""
    from vibroimpact.cli.case_text import shipped_cases_document, shipped_cases_table

    show(shipped_cases_document, shipped_cases_table, as_json=as_json)


@app.command()
def new(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME", help="Name of the case; the file is NAME.toml in the current folder."
        ),
    ],
    source: Annotated[
        str,
        typer.Option(
            "--from",
            metavar="CASE",
            autocompletion=complete_case,
            help='The case to start from: a TOML file, or a shipped one such as "paper:type3".',
        ),
    ] = "paper:type1-theory",
    changes: Changes = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Write a new case file from an existing case. Unused keys are in it as comments."""
    from vibroimpact.cases.reader import load_table
    from vibroimpact.cases.template import case_template
    from vibroimpact.cli.case_text import DEEDS, command_for
    from vibroimpact.files.atomic_write import write_text_file
    from vibroimpact.files.recover import recover

    title = name.removesuffix(".toml")
    path = Path(f"{title}.toml")
    if not title.strip() or title != path.stem:
        raise InputError(f'"{name}" is not a file name; give one without folders, such as my-plate')
    if path.is_dir():
        raise InputError(f"{path} is a folder; take another name")
    if path.exists() and not force:
        raise InputError(f"{path} exists; take another name, or --force to replace it")
    text = case_template(source, title, settings_of(changes))
    recover(path)
    write_text_file(path, text)
    quoted = shlex.quote(str(path))
    command = command_for(load_table(path))
    say(
        f"wrote {path}; explain it: vibroimpact check {quoted}; {DEEDS[command]}: vibroimpact "
        f"{command} {quoted}"
    )


@app.command(context_settings={"ignore_unknown_options": True})  # a number may be negative
def units(
    quantity: Annotated[
        list[str],
        typer.Argument(metavar="NUMBER UNIT", help='Such as 5.115e8 N/m^1.5, or "179.75 N s/m".'),
    ],
    to: Annotated[
        str | None,
        typer.Option(
            "--to",
            metavar="UNIT",
            help="In quotes if it has blanks; without it the common unit systems are shown.",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Convert a contact parameter to another unit.

    The number of a stiffness in N/m^n is 1000^n times that in N/mm^n.
    """
    from vibroimpact.cli.unit_table import unit_conversion, unit_document, unit_table
    from vibroimpact.units.reading import parse_quantity

    try:
        value, unit = parse_quantity(" ".join(quantity))
        table = unit_table(value, unit) if to is None else unit_conversion(value, unit, to)
    except InputError as error:
        hint = _quotes_hint(quantity, to) if to else ""
        raise InputError(f"{error}{hint}") from None
    show(lambda: unit_document(value, unit, to), lambda: table, as_json=as_json)


def _quotes_hint(quantity: list[str], to: str) -> str:
    """Return a hint that the unit of --to needs quotes, or "".

    It does if the end of the quantity is that of the unit: 5 N/mm --to N m has "5 N/mm m".
    """
    from vibroimpact.units.reading import convert_units, parse_quantity

    for length in range(1, len(quantity) - 1):
        whole_unit = " ".join([to, *quantity[-length:]])
        try:
            value, unit = parse_quantity(" ".join(quantity[:-length]))
            convert_units(value, unit, whole_unit)
        except InputError:
            continue
        return f'; a unit with blanks needs quotes: --to "{whole_unit}"'
    return ""


@app.command()
def laws(
    name: Annotated[
        str | None,
        typer.Argument(metavar="[NAME]", autocompletion=complete_law, help="Show one law."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="PNG", help="Write its curves to this image file."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing image file.")] = False,
    as_json: Json = False,
) -> None:
    """List the contact and friction laws, or show one. With -o PNG the curves of a
    contact law are drawn.
    """
    from vibroimpact.contact.friction.registry import friction_laws
    from vibroimpact.contact.registry import find_contact_law
    from vibroimpact.law_sheets.document import law_document, laws_document
    from vibroimpact.law_sheets.sheet import law_sheet, law_table

    if name is None:
        if output is not None:
            raise InputError("name the law that is to be drawn: vibroimpact laws NAME -o PNG")
        show(laws_document, lambda: law_table(console().width), as_json=as_json)
        return
    law = friction_laws().get(name) or find_contact_law(name)
    if output is not None and name in friction_laws():
        raise InputError(
            f"{name} is a friction law, and curves are drawn of contact laws only", "-o"
        )
    if output is not None:
        from vibroimpact.law_sheets.curves import check_picture

        check_picture(output, force=force)  # fail before anything is printed or drawn
    show(lambda: law_document(law), lambda: law_sheet(name), as_json=as_json)
    if output is not None:
        from vibroimpact.law_sheets.curves import save_law_picture

        say(f"\nwrote {save_law_picture(name, output)}", err=as_json)


@app.command()
def materials(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            autocompletion=complete_material,
            help="Show one material, with the source of each number.",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """List the shipped materials, or one with its sources."""
    from vibroimpact.cli.material_text import (
        material_document,
        material_library_table,
        material_sheet,
        materials_document,
    )

    if name:
        show(lambda: material_document(name), lambda: material_sheet(name), as_json=as_json)
    else:
        show(materials_document, material_library_table, as_json=as_json)


@app.command()
def schema() -> None:
    """Print the JSON schema of a case file."""
    import json

    from vibroimpact.cases.case import case_schema

    say(json.dumps(case_schema(), indent=2))


@app.command()
def doctor(
    clear_store: Annotated[
        bool,
        typer.Option(
            "--clear-store", help="Remove the computed modes and the compiled code that are kept."
        ),
    ] = False,
    as_json: Json = False,
) -> None:
    """Show versions and what is kept on disk, and test this program."""
    from vibroimpact.cli.doctor import diagnose, diagnosis_rows, first_rebound_error
    from vibroimpact.report.terminal_table import facts

    if clear_store:
        _clear_stores(as_json=as_json)
        return
    diagnosis = diagnose()
    show(
        lambda: {**diagnosis, "first_rebound_error": first_rebound_error()},
        lambda: facts(diagnosis_rows(diagnosis)),
        as_json=as_json,
    )
    error = first_rebound_error()
    if not error < 1e-7:
        raise ComputationError(
            "self-test failed: the speed of the paper's first rebound is off by "
            f"{error:.1e}; reinstall the package"
        )
    say("self-test passed: the speed of the paper's first rebound is right to 1e-7", err=as_json)


def _clear_stores(*, as_json: bool) -> None:
    from vibroimpact.compiler.code_store import clear_code
    from vibroimpact.structures.store import clear_store

    entries = clear_store()
    functions = clear_code()
    show(lambda: {"removed": entries, "removed_functions": functions}, as_json=as_json)
    say(
        f"removed {entries} entries from the store of modes, and {functions} compiled functions",
        err=as_json,
    )
