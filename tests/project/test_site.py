"""The documentation site: its reference has every public name with an example, and faults
of built pages are found.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections import Counter
from operator import attrgetter
from pathlib import Path
from types import ModuleType

import pytest

import vibroimpact as vi

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MODULES = [name for name in vi.__all__ if isinstance(getattr(vi, name), ModuleType)]
NAMES = [name for name in vi.__all__ if name not in (*MODULES, "__version__")]
NAMES_IN_MODULES = [
    f"{module}.{name}"
    for module in MODULES
    for name in getattr(vi, module).__all__
    # constants have no page, and what the top has is listed there
    if name.upper() != name and name not in NAMES
]

sys.path.insert(0, str(DOCS / "_extensions"))
from page_faults import page_faults, read_pages  # noqa: E402


def test_every_public_name_stands_in_one_group_of_the_reference() -> None:
    text = (DOCS / "reference.md").read_text(encoding="utf-8")
    groups = re.findall(
        r"^## ([^\n]+)\n(?:\n[^#`]+\n)?\n```\{eval-rst\}\n(.*?)```", text, flags=re.S | re.M
    )
    assert len(groups) == text.count("\n## ")
    for title, block in groups:
        assert f":caption: {title}\n" in block
    grouped = Counter(
        name for _, block in groups for name in re.findall(r"^   ([\w.]+)$", block, flags=re.M)
    )
    assert grouped == Counter([*NAMES, *NAMES_IN_MODULES])


def test_about_fifty_names_are_at_the_top() -> None:
    assert len(NAMES) <= 50


def test_type_checkers_know_the_laws() -> None:
    for module in (vi.laws, vi.friction):
        text = Path(module.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
        named = re.findall(r" import (?:\(\s*)?(\w+) as \1\b", text)
        assert sorted(named) == dir(module)
        for name in named:
            assert getattr(module, name).__name__ == name


def test_materials_are_attributes_by_their_names() -> None:
    for name, material in vi.materials.material_library().items():
        assert getattr(vi.materials, name.replace("-", "_")) is material
    with pytest.raises(AttributeError, match="has no attribute 'unobtainium'"):
        _ = vi.materials.unobtainium


def test_a_law_that_is_not_there_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'Herz'"):
        _ = vi.laws.Herz


def test_every_public_name_has_an_example() -> None:
    texts = {
        name: inspect.getdoc(attrgetter(name)(vi)) or "" for name in [*NAMES, *NAMES_IN_MODULES]
    }
    assert [
        name
        for name, text in texts.items()
        if not re.search(r"^Examples\n--------\n.*>>> ", text, flags=re.S | re.M)
    ] == []


GOOD = (
    '<h1 id="top">A</h1><a href="b.html#there">b</a><a class="right-next" '
    'href="b.html">next</a><img src="a.png" alt="A drop">'
)


@pytest.fixture
def site(tmp_path: Path) -> Path:
    (tmp_path / "a.html").write_text(GOOD)
    (tmp_path / "b.html").write_text(
        '<p id="there"><a href="a.html#top">a</a> <a href="https://example.org">elsewhere</a>'
    )
    (tmp_path / "a.png").write_bytes(bytes(100))
    return tmp_path


def test_good_pages_have_no_fault(site: Path) -> None:
    assert page_faults(read_pages(site)) == []


@pytest.mark.parametrize(
    ("added", "fault"),
    [
        ('<a href="c.html">', "a.html: a dead link: c.html"),
        ('<a href="b.html#nowhere">', "a.html: a dead link: b.html#nowhere"),
        ('<a href="#nowhere">', "a.html: a dead link: #nowhere"),
        ('<img src="a.png">', "a.html: a picture without words: a.png"),
        ('<img src="a.png" alt=" ">', "a.html: a picture without words: a.png"),
        ('<img src="b.png" alt="B">', "a.html: there is no b.png"),
        (
            '<script src="https://example.org/a.js"></script>',
            "a.html: loaded from a network: https://example.org/a.js",
        ),
        (
            '<link rel="stylesheet" href="//example.org/a.css">',
            "a.html: loaded from a network: //example.org/a.css",
        ),
        ("<p>" + 3_000_000 * "x", "a.html: it weighs 3.0 MB with its pictures"),
    ],
)
def test_a_fault_of_a_page_is_found(site: Path, added: str, fault: str) -> None:
    (site / "a.html").write_text(GOOD + added)
    assert page_faults(read_pages(site)) == [fault]


def test_only_the_last_page_leads_no_further(site: Path) -> None:
    (site / "a.html").write_text('<p id="top">')
    assert page_faults(read_pages(site)) == ["more than one page leads no further: a.html, b.html"]


def test_heavy_pictures_count(site: Path) -> None:
    (site / "a.png").write_bytes(bytes(4_000_000))
    assert page_faults(read_pages(site)) == ["a.html: it weighs 4.0 MB with its pictures"]


def test_a_figure_needs_a_title() -> None:
    pytest.importorskip("sphinx_gallery", reason="make docs-site installs it")
    from gallery_checks import has_title
    from matplotlib.figure import Figure

    figure = Figure()
    axes = figure.subplots()
    assert not has_title(figure)
    axes.set_title("Force", loc="left")
    assert has_title(figure)
