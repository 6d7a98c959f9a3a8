"""Laws that other packages bring."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import EntryPoint

import pytest

import vibroimpact as vi
from vibroimpact.contact import registry as module
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.law_sheets.pages import law_page
from vibroimpact.law_sheets.text import law_text


@dataclass(frozen=True, kw_only=True)
class Foreign(HystereticLaw):
    """A law of someone else."""

    name = "foreign"
    equation = "F = K delta^n (1 + (1 - e) delta_dot / v0)"
    source = "nobody"

    @property
    def damping_factor(self) -> float:
        return 1.0 - self.restitution


@dataclass(frozen=True, kw_only=True)
class Documented(Foreign):
    """A law with a Parameters section of its own.

    Parameters
    ----------
    stiffness, restitution, exponent : float
        As those of Hertz's law.

    References
    ----------
    Nobody, N. (2020). Nowhere.
    """

    name = "documented"


@dataclass(frozen=True, kw_only=True)
class Usurper(Foreign):
    """A law with a name that is taken."""

    name = "hertz"


def bring(monkeypatch: pytest.MonkeyPatch, *values: str) -> dict:
    points = [
        EntryPoint(name=f"law{number}", value=value, group="vibroimpact.contact_laws")
        for number, value in enumerate(values)
    ]
    monkeypatch.setattr(module, "entry_points", lambda group: points)
    return dict(module.contact_laws.__wrapped__())


def test_a_law_is_brought_by_an_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    laws = bring(monkeypatch, f"{__name__}:Foreign")
    assert laws["foreign"] is Foreign
    assert len(laws) == len(vi.laws.contact_laws()) + 1


def test_parameters_are_documented_from_their_declarations() -> None:
    assert Foreign.__doc__ is not None
    assert (
        "\nstiffness : float or array\n    Contact stiffness :math:`K`.\n    In N/m^n, "
        "greater than 0.\n" in Foreign.__doc__
    )
    assert "\nexponent : float or array, default 1.5\n" in Foreign.__doc__
    assert "| `restitution` | Restitution asked for, $`e`$. |" in law_page(Foreign)


def test_a_parameters_section_in_the_docstring_is_kept() -> None:
    assert Documented.__doc__ is not None
    assert Documented.__doc__.count("Parameters") == 2
    assert Documented.__doc__.count(" : float") == 1
    text = law_text(Documented)
    assert text.title == "A law with a Parameters section of its own."
    assert text.references == ("Nobody, N. (2020). Nowhere.",)
    assert [item.meaning for item in text.parameters] == [
        item.meaning for item in law_text(Foreign).parameters
    ]


def test_a_duplicate_name_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(vi.InputError, match='two contact laws are called "hertz"'):
        bring(monkeypatch, f"{__name__}:Usurper")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("no.such.module:Law", "can't be loaded"),
        (f"{__name__}:Nothing", "can't be loaded"),
        ("math:pi", "is not a contact law"),
    ],
)
def test_a_broken_entry_point_is_named(
    monkeypatch: pytest.MonkeyPatch, value: str, message: str
) -> None:
    with pytest.raises(vi.InputError, match=message):
        bring(monkeypatch, value)
