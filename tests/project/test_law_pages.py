"""The pages of the contact laws say what the laws say: they are as `make docs` would
write them, and every law has one.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import vibroimpact as vi
from vibroimpact.law_sheets.pages import law_pages, write_law_pages

DOCS = Path(__file__).parents[2] / "docs"
LAWS = [
    name
    for name, law in vi.laws.contact_laws().items()
    if law.__module__.startswith("vibroimpact.")
]


def test_pages_are_not_stale() -> None:
    for name, page in law_pages((DOCS / "laws.md").read_text(encoding="utf-8")).items():
        assert (DOCS / name).read_text(encoding="utf-8") == page, f"docs/{name} is stale: make docs"


def test_every_law_has_a_page_and_every_page_a_law() -> None:
    assert {path.stem for path in (DOCS / "laws").glob("*.md")} == set(LAWS)
    assert all(
        f"](laws/{name}.md)" in (DOCS / "laws.md").read_text(encoding="utf-8") for name in LAWS
    )


def test_markup_is_githubs() -> None:
    for name in LAWS:
        text = (DOCS / "laws" / f"{name}.md").read_text(encoding="utf-8")
        assert ":math:" not in text, name
        assert ".. math::" not in text, name
        assert text.count("```") % 2 == 0, name
        assert f"$ vibroimpact laws {name} -o {name}.png\n" in text
        assert [
            target
            for target in re.findall(r"\]\(([^)#]+)\)", text)
            if not (DOCS / "laws" / target).exists()
        ] == [], name


def test_writing_again_changes_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "laws.md").write_text(
        (DOCS / "laws.md").read_text(encoding="utf-8"), encoding="utf-8"
    )
    assert len(write_law_pages(tmp_path)) == len(LAWS) + 1
    assert (tmp_path / "laws.md").read_text(encoding="utf-8") == (DOCS / "laws.md").read_text(
        encoding="utf-8"
    )
    with pytest.raises(vi.InputError, match="must stand around the table"):
        law_pages("no markers")
