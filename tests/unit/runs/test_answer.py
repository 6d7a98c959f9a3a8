"""The answer of a run: its main results, with the digits that their errors leave, and the warning
that changes most.
"""

from __future__ import annotations

from io import StringIO
from typing import Any

import pytest
from rich.console import Console

import vibroimpact as vi
from vibroimpact.cases.validity.strength import plastic_impact
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.report.report import Quantity
from vibroimpact.report.result_warning import ResultWarning, effect_of, size_of
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.runs.answer import answer_of

STEEL: dict[str, Any] = {
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {"material": "steel"},
    "contact": {"law": "hertz"},
    "drop": {"speed": "0.5 m/s", "gravity": 0},
    "run": {"impacts": 1},
}


def result_of(table: dict[str, Any]) -> vi.Result:
    return vi.result_of(vi.simulate(vi.case_of(table)))


def first(result: vi.Result, column: str) -> float:
    return float(result.impacts[column][0])


@pytest.mark.parametrize(
    ("error", "shown"),
    [
        (float("nan"), "9708.9 N"),
        (0.0, "9708.9 N"),
        (0.003, "9710 N"),
        (0.08, "9700 N"),
        (0.4, "9700 N"),
        (3.0, "9700 N"),
    ],
)
def test_a_result_has_the_digits_that_its_error_leaves(error: float, shown: str) -> None:
    force = Quantity("Largest force", 0.970894e4, "N", error).text.replace("\u00a0", " ")
    kilo = {"9708.9 N": "9.7089 kN", "9710 N": "9.71 kN", "9700 N": "9.7 kN"}[shown]
    assert force == kilo


def test_the_error_stands_beside_it() -> None:
    assert Quantity("e", 0.5, error=0.0123).error_text == "± 1.2 %"
    assert Quantity("e", 0.5, error=0.0123, is_least=True).error_text == "± 1.2 % or more"
    assert Quantity("e", 0.5).error_text == Quantity("e", 0.5, error=1e-9).error_text == ""
    assert Quantity("a", 48105.0, "m/s2", 0.5).text.replace("\u00a0", " ") == "48000 m/s²"


def test_what_yield_means_is_what_the_plastic_law_computes() -> None:
    """Thornton's law with 2.8 times the yield strength, in a run of its own."""
    elastic = result_of(STEEL)
    table = STEEL | {"contact": {"law": "thornton", "yield_pressure": 2.8 * 235e6}}
    plastic = result_of(table)
    modulus = 0.5 * 210e9 / (1 - 0.3**2)
    ratio, restitution = plastic_impact(first(elastic, "max_force_N"), 0.01, modulus, 235e6)
    assert first(plastic, "max_force_N") / first(elastic, "max_force_N") == pytest.approx(ratio)
    assert first(plastic, "restitution_achieved") == pytest.approx(restitution, rel=1e-6)
    assert plastic_impact(1e-3, 0.01, modulus, 235e6) == (1.0, 1.0)
    (warning,) = elastic.doubts
    assert f"the largest force would be about {100 * (1 - ratio):.0f} % smaller" in warning
    assert f"restitution of the contact about {restitution:.1g}" in warning
    assert warning.startswith("the plate (steel) yields, and so does the sphere (steel): ")
    assert effect_of(warning) == pytest.approx(2 * (1 - restitution))
    # both bodies yield, and the contact is one
    assert elastic.relative_errors["restitution"] == pytest.approx(1 - restitution)


@pytest.mark.parametrize("remedy", ["contact.finite_sphere", "drop.air"])
def test_errors_are_what_the_remedies_change(remedy: str) -> None:
    """That of the force is the closer one; the time is estimated as if the impulse stayed."""
    section, key = remedy.split(".")
    table = {
        "sphere": {"radius": "25 mm", "material": "rock-paper"},
        "plate": {"material": "steel"},
        "contact": {"law": "hertz"},
        "drop": {"height": "4 m"},
        "run": {"impacts": 1},
    }
    result = result_of(table)
    remedied = result_of(table | {section: table[section] | {key: True}})
    names = {"max_force_N": ("largest force", 1.1), "duration_s": ("contact time", 1.4)}
    for column, (name, most) in names.items():
        change = abs(first(remedied, column) / first(result, column) - 1.0)
        error = result.relative_errors[name] - remedied.relative_errors[name]
        assert 0.9 < error / change < most, column


def test_the_answer_is_first_and_the_worst_warning_beside_it() -> None:
    result = result_of(
        STEEL
        | {
            "plate": {
                "material": "aluminium",
                "model": "elastic",
                "size": ["200 mm", "200 mm", "6 mm"],
                "supports": "simply-supported",
                "modes": 20,
            },
            "sensors": [{"name": "a", "position": ["40 mm", "30 mm"]}],
        }
    )
    names = [quantity.name for quantity in answer_of(result)]
    expected = ["Largest force", "Contact time", "Restitution", "Rebound height"]
    assert names == [*expected[:3], "Energy into vibration", "a"]  # without gravity it never falls
    assert answer_of(result)[-1].note.endswith(" g")
    written = StringIO()
    Console(width=400, file=written).print(terminal_report(result.report))
    lines = written.getvalue().splitlines()
    first_warning = next(number for number, line in enumerate(lines) if line.startswith("Warning"))
    assert first_warning == 2 + len(names)
    effects = [effect_of(warning) for warning in result.doubts]
    assert lines[first_warning] == f"Warning: {result.doubts[0]}."
    assert effects == sorted(effects, reverse=True)
    assert len(effects) > 1
    page = page_of_report(result.report)
    assert page.index('<dl class="answer">') < page.index("<strong>Warning:</strong>")
    assert page.index("<strong>Warning:</strong>") < page.index('<details class="warnings">')
    assert result.report.document["answer"][0]["value"] == first(result, "max_force_N")


def test_what_is_off_by_more_than_a_tenth_has_two_figures_in_tables() -> None:
    result = result_of(STEEL)
    (impacts, _) = result.tables[:2]
    cells = {column.heading: column.cells[0] for column in impacts.columns}
    digits = {heading: len(cell.replace(".", "").lstrip("0")) for heading, cell in cells.items()}
    assert digits["Largest force"] == digits["Restitution achieved"] == 2
    assert digits["Approach speed"] > 2


def test_an_unknown_strength_says_nothing_where_the_other_body_yields() -> None:
    rock = {"density": 2600, "youngs_modulus": 5e10, "poissons_ratio": 0.25}
    table = STEEL | {"sphere": {"radius": "10 mm", "material": rock}}
    (warning,) = result_of(table).doubts
    assert "(steel) yields" in warning


def test_sizes() -> None:
    effects = (0.3, 0.05, 0.001)
    assert [size_of(ResultWarning("w", effect)) for effect in effects] == ["large", "fair", "small"]
