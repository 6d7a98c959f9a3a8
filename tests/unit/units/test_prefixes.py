"""SI units with a prefix are read without pint, exactly as pint reads them."""

from __future__ import annotations

import subprocess
import sys

import pytest

from vibroimpact.units.reading import _EXAMPLE, _PREFIXED, _PREFIXES, _pint_factor, to_si


@pytest.mark.parametrize("unit", _PREFIXED)
@pytest.mark.parametrize("prefix", _PREFIXES)
def test_the_factors_are_those_of_pint(prefix: str, unit: str) -> None:
    assert to_si(f"1 {prefix}{unit}", unit) == _pint_factor(f"{prefix}{unit}", unit, "")


@pytest.mark.parametrize("unit", _EXAMPLE)
def test_a_unit_is_one_of_itself(unit: str) -> None:
    assert to_si(f"1 {unit}", unit) == 1.0 == _pint_factor(unit, unit, "")


def test_a_prefix_is_that_of_the_unit_that_is_wanted() -> None:
    """A gram is no multiple of a kilogram by a prefix, and "min" no thousandth of an inch."""
    assert to_si("1 g", "kg") == 1e-3
    assert to_si("1 min", "s") == 60.0
    assert to_si("1 mg", "m/s^2") == pytest.approx(9.80665e-3)


def test_the_usual_units_need_no_pint() -> None:
    code = (
        "import sys, vibroimpact as vi; [vi.load_case(name) for name in vi.shipped_cases()]; "
        "assert 'pint' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
