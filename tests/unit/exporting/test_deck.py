"""Rendering of decks from templates."""

from __future__ import annotations

import subprocess
import sys
from importlib.resources import files
from types import SimpleNamespace

import pytest
from jinja2 import UndefinedError

from vibroimpact.exporting.deck import _environment, render_deck

TEMPLATES = sorted(
    item.name for item in files("vibroimpact.exporting.formats").joinpath("templates").iterdir()
)


def test_a_name_is_not_read_as_a_template() -> None:
    name = "{{ 7 * 7 }} {% raise %} <&>"
    model = SimpleNamespace(name=name, end=1.0, output_step=0.5)
    assert render_deck("adams_solver.acf.j2", model=model) == (
        f"FILE/MODEL={name}\nSIMULATE/DYNAMICS, END=1.0, DTOUT=0.5\nSTOP\n"
    )


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_missing_quantity_is_an_error(name: str) -> None:
    with pytest.raises(UndefinedError):
        _environment().get_template(name).render()


def test_lists_of_formats_need_no_templates() -> None:
    """Completion in the shell asks for the names of the formats."""
    code = (
        "import sys\nfrom vibroimpact.exporting.export_format import export_formats\n"
        "assert export_formats()\nassert 'jinja2' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
