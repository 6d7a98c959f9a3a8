"""What is printed of a drop, against a second drop that differs by less than anybody can
know: the digits that both print agree.
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibrating import STIFFNESS, drop_on, random_modes
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.law_comparison.comparison import Comparison
from vibroimpact.law_comparison.report import first_impacts
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.captions import caption
from vibroimpact.runs.tables import impact_table, ledger_table

AGAINST = Against(
    "second simulation with the approach speed changed by 1e-9",
    "consistency",
    "impacts on vibrating bodies",
    "agreement of the printed digits; no external reference",
)


LAWS = (Hertz(stiffness=STIFFNESS), LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.7))
_NUMBER = re.compile(r"(-?[\d.]+)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)|e([-+]\d+))?")
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def read(cell: str) -> tuple[float, float] | None:
    """A printed number, and a unit of its last digit; None where none is printed."""
    found = _NUMBER.fullmatch(cell.replace("\u2212", "-"))
    if found is None or cell == "0":
        return None
    power = int((found[2] or "0").translate(_RAISED)) if found[3] is None else int(found[3])
    decimals = len(found[1].partition(".")[2])
    return float(found[1]) * 10.0**power, 10.0 ** (power - decimals)


def agree(first: str, second: str) -> bool:
    """Are two printed numbers the same but for three units of the last digit, or not both
    certain?
    """
    one, other = read(first), read(second)
    return one is None or other is None or abs(one[0] - other[0]) <= 3.01 * max(one[1], other[1])


def beside(law: CompliantLaw, seed: int, damping: float) -> list[Result]:
    problem = drop_on(law, random_modes(seed, 10, 150.0, 15e3, 1.2, damping), speed=3.0, impacts=6)
    return [
        result_of(vi.simulate(replace(problem, speed=3.0 * (1.0 + part)))) for part in (0.0, 1e-9)
    ]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize(
    ("seed", "damping"),
    [
        (0, 0.0),
        (4, 0.02),
        *(pytest.param(*one, marks=pytest.mark.slow) for one in ((2, 0.0), (5, 0.02))),
    ],
)
def test_printed_digits_are_those_of_both(
    agrees: Agrees, law: CompliantLaw, seed: int, damping: float
) -> None:
    pair = beside(law, seed, damping)
    (unit, rows), (other_unit, others) = map(ledger_table, pair)
    assert unit == other_unit
    off = [
        not agree(getattr(row, name), getattr(other, name))
        for row, other in zip(rows, others, strict=True)
        for name in ("energy", "part")
    ]
    agrees(
        "six impacts, two contact laws",
        "indicator of differing printed energies",
        off,
        0.0,
        absolute=0.5,
    )
    first, second = (
        re.findall(r"(about )?(-?[\d.]+(?:·10[⁻\d⁰¹²³⁴⁵⁶⁷⁸⁹]+|e[-+]\d+)?) (?:s|J)\b", one.status)
        for one in pair
    )
    for (vague, here), (other_vague, there) in zip(first, second, strict=True):
        assert vague or other_vague or agree(here, there), (pair[0].status, pair[1].status)


def test_a_chaotic_drop_prints_no_digits_that_it_lacks() -> None:
    """Without damping, six impacts leave nothing of the last: its energies and its
    restitution are not told.
    """
    first, second = beside(LAWS[0], 2, 0.0)
    assert first.change_by_impact[-1] > 1.0
    apart = abs(second.energy["plate_strain_J"] / first.energy["plate_strain_J"] - 1.0)
    assert apart > 1e-3  # of a change of 1e-9
    told = {row.name: row.energy for row in ledger_table(first)[1]}
    assert told["plate_strain_J"] == told["potential_J"] == "?"
    assert len(told["Put in at the start"].replace(".", "")) >= 6
    comparison = Comparison("a drop", {"hertz": first}, {"hertz": LAWS[0]}, *([None] * 2))
    table = {column.heading: column.cells[0] for column in first_impacts(comparison).columns}
    assert re.fullmatch(r"\d\.\d{5}", table["Restitution achieved, first"])
    assert table["achieved, last"] == "?"
    table = impact_table(first)
    headers, rows = table.headings, table.rows
    assert rows[-1][headers.index(("Largest force", "kN"))] == "?"
    assert "? mJ (? %) remains in the motion of the plate" in caption("energy", first).replace(
        "\u00a0", " "
    )
