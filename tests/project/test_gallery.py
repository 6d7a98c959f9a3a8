"""The gallery: each example has a title, prose, an assertion and a figure; `make
docs-site` runs them, and fails where one fails.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

FILES = sorted((Path(__file__).parents[2] / "examples" / "gallery").glob("*.py"))


def test_examples_are_of_the_gallery() -> None:
    """A title with two or three sentences, cells, an assertion, and the figure last."""
    assert len(FILES) >= 20
    for file in FILES:
        check_example(file)


def check_example(file: Path) -> None:
    assert file.stem.startswith("plot_")
    text = file.read_text(encoding="utf-8")
    tree = ast.parse(text)
    _, title, line, _, *words = (ast.get_docstring(tree, clean=False) or "").splitlines()
    assert line == "=" * len(title)
    assert " ".join(words).count(". ") + 1 in (1, 2, 3)
    assert text.count("\n# %%\n") >= 3
    assert any(isinstance(node, ast.Assert) for node in ast.walk(tree))
    assert ast.unparse(tree.body[-1]) == "plt.show()"
    assert "\n# sphinx_gallery_" not in re.sub(r"\n[^#\n][^\n]*\n# sphinx_gallery_", "", text), (
        "settings after a line of prose are read as prose"
    )
