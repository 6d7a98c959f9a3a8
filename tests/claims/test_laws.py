"""Numbers and lists of the pages on contact laws, and of others that count the laws."""

from __future__ import annotations

import re

import pytest

import vibroimpact as vi
from stated import ROOT, page_text, says
from vibroimpact.contact.law import CompliantLaw

PAGE = "docs/laws.md"
LAWS = {name: law for name, law in vi.contact_laws().items() if law.__module__.startswith("vibroimpact.")}
CHANGED = [name for name, law in LAWS.items() if law.departure]
DENTING = {name for name, law in LAWS.items() if issubclass(law, CompliantLaw) and law.lasting}


def test_how_many_are_as_published() -> None:
    counts = len(LAWS), len(LAWS) - len(CHANGED), len(CHANGED)
    says(PAGE, 'There are {} contact laws: {} are as published, and {}, marked "changed" in the table,', *counts)
    says("README.md", "[{} contact laws](docs/laws.md), {} as published and {} with changes that their pages state", *counts)


@pytest.mark.parametrize("name", CHANGED)
def test_a_change_is_stated_on_the_page_of_the_law(name: str) -> None:
    assert "## Departure from the source" in (ROOT / "docs" / "laws" / f"{name}.md").read_text(encoding="utf-8")
    assert f"[`{name}`](laws/{name}.md)" in next(row for row in _rows() if f"`{name}`" in row)
    assert [row.split("|")[1].strip() for row in _rows() if row.rstrip(" |").endswith("; changed")] == [
        f"[`{other}`](laws/{other}.md)" for other in CHANGED
    ]


def _rows() -> list[str]:
    return [line for line in (ROOT / PAGE).read_text(encoding="utf-8").splitlines() if line.startswith("| [")]


def test_elastic_plastic_laws() -> None:
    """The laws that the page names as retaining the dent are all that do."""
    named = re.search(r"\*\*Elastic-plastic laws\*\* \(([^)]*)\) retain the dent", page_text(PAGE))
    assert named
    assert set(re.findall(r"`([a-z-]+)`", named[1])) == DENTING


def test_restitutions_of_lankarani_and_nikravesh() -> None:
    def achieved(asked: float) -> float:
        law = vi.find_contact_law("lankarani-nikravesh")(stiffness=1e8, restitution=asked)
        return float(vi.achieved_restitution(law, 0.1, 1.0))

    one, other, least = map(achieved, (0.9, 0.65, 0.0))
    says(PAGE, "than the one asked: {} gives {}, {} gives {}, and no value gives less than {}.", 0.9, one, 0.65, other, least)


def test_the_pile_up_between_the_published_values() -> None:
    kind = vi.find_contact_law("storakers")
    law = kind(effective_modulus=1e11, effective_radius=0.01, yield_strength=1e8, hardening_exponent=3.0)
    says("docs/laws/storakers.md", "and gives {} for m = 3", float(law.pile_up))
