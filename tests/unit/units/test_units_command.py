"""Units of contact parameters: converted, shown in the systems of other programs, and
refused with both dimensions.
"""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import vibroimpact as vi
from support import outcome
from vibroimpact.cli.shared import pair_in
from vibroimpact.cli.unit_table import in_unit_systems, number_text
from vibroimpact.units.reading import dimension_of, parse_quantity, unit_text

POWERS = st.floats(1.0, 3.0).map(lambda power: round(power, 3))


@pytest.mark.parametrize(
    ("value", "unit", "to", "expected"),
    [
        (5.115e8, "N/m^1.5", "N/mm^1.5", 5.115e8 / 1000.0**1.5),
        (5.115e8, "N m^-1.5", "N mm^-1.5", 5.115e8 / 1000.0**1.5),
        (5.115e8, "N/m^1.5", "kN/mm^1.5", 5.115e8 / 1000.0**2.5),
        (5.115e8, "N/m**1.5", "N/m^(3/2)", 5.115e8),
        (16175.0, "N/mm^1.5", "N/m^1.5", 16175.0 * 1000.0**1.5),
        (1.2e6, "N/m", "N/mm", 1200.0),
        (7.0, "N/m^2.2", "N/mm^2.2", 7.0 / 1000.0**2.2),
        (179.75, "N s/m", "N s/mm", 0.17975),
        (179.75, "N*s/m", "kg/s", 179.75),
        (179.75, "N·s/m", "tonne/s", 0.17975),
        (1.0, "lbf/in", "N/m", 4.4482216152605 / 0.0254),
        (2.26, "GPa", "MPa", 2260.0),
        (3.0, "s/m", "s/mm", 0.003),
    ],
)
def test_conversions(value: float, unit: str, to: str, expected: float) -> None:
    assert vi.units.convert_units(value, unit, to) == pytest.approx(expected, rel=1e-13)
    assert vi.units.convert_units(expected, to, unit) == pytest.approx(value, rel=1e-13)


@given(power=POWERS, stiffness=st.floats(1e3, 1e12))
def test_the_factor_is_1000_to_the_power(power: float, stiffness: float) -> None:
    there = vi.units.convert_units(stiffness, f"N/m^{power:g}", f"N/mm^{power:g}")
    assert there == pytest.approx(stiffness / 1000.0**power, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "unit", "to", "words"),
    [
        (
            1.0,
            "N/m^1.5",
            "N/mm",
            [
                "contact stiffness (force/length^1.5)",
                "a stiffness or a work of adhesion (force/length)",
            ],
        ),
        (
            1.0,
            "N/m^1.5",
            "N/mm^1.6",
            ["contact stiffness (force/length^1.5)", "of the dimension force/length^1.6"],
        ),
        (1.0, "N s/m", "N/m", ["a damping (force time/length)", "a stiffness"]),
        (1.0, "kg", "m", ['"kg" is a mass', '"m" is a length']),
        (1.0, "m/m", "s", ["a plain number", "a time"]),
        (1.0, "foo", "m", ['"foo" is not a unit']),
        (1.0, "m", "", ['"" is not a unit']),
        (1.0, "m^9999", "m", ["is not a unit"]),
        (1.0, "N/m^n", "m", ["is not a unit"]),
        (1e308, "GPa", "Pa", ["is not finite"]),
        (float("nan"), "m", "m", ["is not finite"]),
        ("3 m", "m", "m", ["has a unit"]),
    ],
)
def test_what_is_refused(value: float, unit: str, to: str, words: list[str]) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.units.convert_units(value, unit, to)
    for word in words:
        assert word in str(raised.value)


def test_dimensions_are_told_with_force() -> None:
    assert dimension_of("Pa") == {"force": 1.0, "length": -2.0}
    assert dimension_of("kg/m^3") == {"mass": 1.0, "length": -3.0}
    assert dimension_of("J") == {"force": 1.0, "length": 1.0}
    assert dimension_of("m/m") == {}
    assert unit_text([("mm", -1.0)]) == "1/mm"


@pytest.mark.parametrize(
    "unit", ["N/m^1.5", "N s/m", "N s/m^2.5", "m/s", "kg/m^3", "Pa", "J/m^2", "kg", "1/m", "s/m"]
)
def test_every_system_is_another_way_to_say_the_same(unit: str) -> None:
    for name, number, there in in_unit_systems(5.0, unit):
        assert vi.units.convert_units(number, there, unit) == pytest.approx(5.0, rel=1e-12), name


def test_consistent_systems_agree_with_their_base_units() -> None:
    """In a system where force is mass length / time^2, the number is that of the base
    units alone.
    """
    base = {
        "mm, tonne, N, s, MPa": ("tonne", "s"),
        "mm, g, N, ms, MPa": ("g", "ms"),
        "mm, kg, kN, ms, GPa": ("kg", "ms"),
    }
    found = {name: number for name, number, _ in in_unit_systems(5.115e8, "N/m^1.5")}
    for name, (mass, time) in base.items():
        assert found[name] == pytest.approx(
            vi.units.convert_units(5.115e8, "N/m^1.5", f"{mass} mm^-0.5/{time}^2"), rel=1e-12
        )


def test_numbers_have_no_noise() -> None:
    assert number_text(16175.000000000002) == "16175"
    assert number_text(0.1 + 0.2) == "0.3"
    assert number_text(5.115e8 / 1000.0**1.5) == "16175.05023"


def test_quantities_are_read() -> None:
    assert parse_quantity("5.115e8 N/m^1.5") == (5.115e8, "N/m^1.5")
    assert parse_quantity("-3mm") == (-3.0, "mm")
    for text in ("N/m", "3", "", "x" * 99, "1e999 m"):
        with pytest.raises(vi.InputError):
            parse_quantity(text)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("5.115e8", "N/m^1.5", "--to", "N/mm^1.5"), "511500000 N/m^1.5 = 16175.05023 N/mm^1.5"),
        (("5.115e8 N/m^1.5", "--to", "N/mm^1.5"), "divided by 1000^1.5 = 31622.7766, not by 1000"),
        (("179.75", "N", "s/m", "--to", "N s/mm"), "179.75 N s/m = 0.17975 N s/mm"),
        (("-5", "mm", "--to", "m"), "-5 mm = -0.005 m"),
        (("5.115e8", "N", "m^-1.5"), "mm, kg, N, s (Adams MMKS) 16175.05023 N/mm^1.5"),
        (("5.115e8", "N/m^1.5"), "mm, kg, kN, ms, GPa 16.17505023 kN/mm^1.5"),
        (("179.75", "kg/s"), "mm, g, N, ms, MPa 179.75 N ms/mm"),
        (("179.75", "kg/s"), "divided by 1000:"),
    ],
)
def test_the_command(
    arguments: tuple[str, ...],
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    status, printed = outcome(monkeypatch, capsys, "units", *arguments)
    assert (status, words in printed) == (0, True), printed


def test_an_option_takes_a_bare_number_in_si() -> None:
    """There are no quotes in a shell, so that a number can't be written otherwise."""
    assert pair_in("--band", "100, 5 kHz", "Hz", "two frequencies", "100 Hz, 5 kHz") == (
        100.0,
        5000.0,
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("3",), "is not a number with a unit"),
        (("3", "N/m", "--to", "N"), "can't be converted"),
        (
            ("3", "degC"),
            '"degC" holds temperature; only units of force, mass, length and time are shown',
        ),
        (("3", "A"), "holds current"),
        (("3", "m/m"), "holds no dimension"),
        (("N/m", "3"), "is not a number with a unit"),
        (("3", "N/m", "--tu", "N/mm"), "is not a unit"),
    ],
)
def test_the_command_refuses(
    arguments: tuple[str, ...],
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    status, printed = outcome(monkeypatch, capsys, "units", *arguments)
    assert (status, words in printed) == (2, True), printed


def test_quotes_are_advised_only_where_words_of_the_unit_are_missing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A blank in the unit of --to makes its last word one of the quantity; that of the
    quantity needs no quotes.
    """
    assert (
        '--to "N s/mm"'
        in outcome(monkeypatch, capsys, "units", "179.75", "N", "s/m", "--to", "N", "s/mm")[1]
    )
    for unit in ("kg", "foo"):
        assert (
            "quotes" not in outcome(monkeypatch, capsys, "units", "5", "N", "s/m", "--to", unit)[1]
        )
