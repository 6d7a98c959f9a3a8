"""Numbers and lists of the pages on contact laws, and of others that count the laws."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pytest

import vibroimpact as vi
from stated_numbers import ROOT, page_text, says
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.contact.pair import ContactPair

PAGE = "docs/laws.md"
LAWS = {
    name: law
    for name, law in vi.laws.contact_laws().items()
    if law.__module__.startswith("vibroimpact.")
}
CHANGED = [name for name, law in LAWS.items() if law.departure]
DENTING = {name for name, law in LAWS.items() if issubclass(law, CompliantLaw) and law.lasting}


def test_how_many_are_as_published() -> None:
    counts = len(LAWS), len(LAWS) - len(CHANGED), len(CHANGED)
    says(
        PAGE,
        'There are {} contact laws. The pages of {} of them, marked "changed" in the table,',
        len(LAWS),
        len(CHANGED),
    )
    says(
        "README.md",
        "[{} contact laws](docs/laws.md), {} as published and {} with "
        "changes that their pages state",
        *counts,
    )


@pytest.mark.parametrize("name", CHANGED)
def test_a_change_is_stated_on_the_page_of_the_law(name: str) -> None:
    assert "## Departure from the source" in (ROOT / "docs" / "laws" / f"{name}.md").read_text(
        encoding="utf-8"
    )
    assert f"[`{name}`](laws/{name}.md)" in next(row for row in _rows() if f"`{name}`" in row)
    assert [
        row.split("|")[1].strip() for row in _rows() if row.rstrip(" |").endswith("; changed")
    ] == [f"[`{other}`](laws/{other}.md)" for other in CHANGED]


def _rows() -> list[str]:
    return [
        line
        for line in (ROOT / PAGE).read_text(encoding="utf-8").splitlines()
        if line.startswith("| [")
    ]


def test_elastic_plastic_laws() -> None:
    """The laws that the page names as retaining the dent are all that do."""
    named = re.search(r"\*\*Elastic-plastic laws\*\* \(([^)]*)\) retain the dent", page_text(PAGE))
    assert named
    assert set(re.findall(r"`([a-z-]+)`", named[1])) == DENTING


def test_restitutions_of_lankarani_and_nikravesh() -> None:
    one, other, least = (achieved("lankarani-nikravesh", asked) for asked in (0.9, 0.65, 0.0))
    says(
        PAGE,
        "than the one asked: {} gives {}, {} gives {}, and no value gives less than {}.",
        0.9,
        one,
        0.65,
        other,
        least,
    )


def fully_plastic_restitution(squared_radius: float) -> float:
    """Return the restitution of a contact of constant pressure with a^2 = 2 c^2 R delta,
    of which `squared_radius` is c^2.
    """
    radius, modulus, pressure, energy = 0.01, 1e11, 1e9, 100.0
    # W = integral of pi a^2 p over delta, and Hertz's unloading gives back 3 F^2 / (10 E* a)
    contact_radius = (4.0 * squared_radius * radius * energy / (np.pi * pressure)) ** 0.25
    force = np.pi * contact_radius**2 * pressure
    return float(np.sqrt(0.3 * force**2 / (modulus * contact_radius) / energy))


def test_the_contact_radius_of_the_source_of_storakers() -> None:
    assert "c^2 is 0.5 for m = 1, and 1.43 without hardening" in page_text("docs/laws/storakers.md")
    ratio = fully_plastic_restitution(1.43) / fully_plastic_restitution(0.5)
    says(
        "docs/laws/storakers.md", "the restitution far above yield would be {} times as high", ratio
    )


def achieved(name: str, asked: float) -> float:
    """Return the restitution that a law achieves for one asked."""
    law = (
        LAWS[name]
        .example(ContactPair(2.4e9, 0.025, 0.09, 8e7, 0.28))
        .changed({"restitution": asked})
    )
    return float(vi.laws.achieved_restitution(law, 0.09, 1.0))


@pytest.mark.parametrize(
    "name",
    [
        name
        for name in LAWS
        if re.search(r"[\d.]+ gives [\d.]+\d", page_text(f"docs/laws/{name}.md"))
    ],
)
def test_what_a_restitution_asked_gives(name: str) -> None:
    text = page_text(f"docs/laws/{name}.md")
    pairs = [(float(asked), given) for asked, given in re.findall(r"(0\.\d+) gives (0\.\d+)", text)]
    assert pairs
    for asked, given in pairs:
        assert f"{achieved(name, asked):.{len(given) - 2}f}" == given
    for least in re.findall(r"no value gives less than (0\.\d+)", text):
        assert float(least) <= achieved(name, 0.0) < float(least) + 10.0 ** (2 - len(least))


def test_how_near_the_restitutions_are_to_those_asked() -> None:
    asked = np.arange(0.01, 1.0, 0.01)
    larger = ("herbert-mcwhannell", "hunt-crossley", "lankarani-nikravesh")
    names = ("hu-guo", "flores", "gonthier", "safaeifar", "lee-wang", *larger)
    found = {name: np.array([achieved(name, one) for one in asked]) for name in names}
    says("docs/laws/hu-guo.md", "is within {} of the one asked for above {}", 0.01, 0.55)
    assert np.abs(found["hu-guo"] - asked)[asked > 0.55].max() < 0.01
    assert "For e < 1 the restitution achieved is smaller than the one asked for" in page_text(
        "docs/laws/flores.md"
    )
    assert (found["flores"] < asked).all()
    says("docs/laws/gonthier.md", "is within {} of the one asked for", 0.033)
    assert 0.032 < np.abs(found["gonthier"] - asked).max() < 0.033
    for name in larger:
        assert "For e < 1 the restitution achieved is larger than the one asked" in page_text(
            f"docs/laws/{name}.md"
        )
        assert (found[name] > asked).all()
    assert "larger than the one asked for above 0.22 and below 1" in page_text(
        "docs/laws/safaeifar.md"
    )
    assert (found["safaeifar"] > asked)[asked > 0.22].all()
    assert "The energy lost is about half of that at the restitution asked for" in page_text(
        "docs/laws/lee-wang.md"
    )
    assert ((1 - found["lee-wang"] ** 2) / (1 - asked**2)) == pytest.approx(0.5, abs=0.06)


def test_programs_that_cut_the_tension_of_tsuji() -> None:
    class Cut(Tsuji):
        tension = "cut"

    law = Cut(stiffness=1e8, restitution=0.5, effective_mass=0.1)
    body = vi.Body(mass=0.1, contact_offset=0.01)
    drop = vi.Problem(
        sphere=body, plate=vi.rigid_plate(), laws=(law,), speed=1.0, gravity=0.0, impacts=1
    )
    says(
        "docs/laws/tsuji.md",
        "with the tension cut, 0.5 would give {}.",
        float(vi.simulate(drop).impacts["restitution_achieved"][0]),
    )


def test_rebounds_without_the_clip_of_adams() -> None:
    class Pulling(AdamsImpact):
        tension = "kept"

    problem = vi.load_case("paper:type1-variable").to_problem()
    pulling = tuple(Pulling(**dataclasses.asdict(law)) for law in problem.laws)
    with_clip, without = (
        vi.simulate(dataclasses.replace(problem, laws=laws)).impacts["rebound_height_m"]
        for laws in (problem.laws, pulling)
    )
    lower = 100.0 * (1.0 - without / with_clip)
    ends = lower.min(), lower.max()
    says(
        "docs/laws/adams-impact.md",
        "the rebound heights of the case `paper:type1-variable` are {} to {} % lower",
        *ends,
    )


def test_the_speed_of_full_plasticity_of_the_default_of_meyer() -> None:
    law = LAWS["meyer"](effective_modulus=7e10, effective_radius=0.0025, yield_strength=3e8)
    begins, full = (
        float(law.loading_work(np.asarray(at)))
        for at in (law.yield_indentation, law.breakpoints[1])
    )
    says(
        "docs/laws/meyer.md",
        "fully plastic from {} times the speed of first yield on",
        np.sqrt(full / begins),
    )
