"""The gallery: each example runs by itself, asserts something that is true, and ends in a figure with words for those who do not see it."""

from __future__ import annotations

import ast
import re
import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

FILES = sorted((Path(__file__).parents[2] / "examples" / "gallery").glob("*.py"))

# modes of elastic bodies, thousands of bounces, classifiers: more than 2 s of processor time
LONG = {
    f"plot_{name}"
    for name in (
        "accelerometer",
        "bound",
        "elastic_bodies",
        "energy",
        "features",
        "identify",
        "instruments",
        "plate_modes",
        "plate_thickness",
        "recognition",
        "sensitivity",
        "shaken_table",
    )
}


@pytest.mark.parametrize("file", [pytest.param(file, id=file.stem, marks=pytest.mark.slow if file.stem in LONG else ()) for file in FILES])
def test_example_runs(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plt, "show", lambda: None)
    plt.switch_backend("agg")
    plt.close("all")  # what other tests left open
    try:
        with plt.rc_context():
            runpy.run_path(str(file), run_name="__main__")
        (number,) = plt.get_fignums()
        figure = plt.figure(number)
        # from these Sphinx-Gallery makes the words that stand for the picture
        assert figure.get_suptitle() or any(axes.get_title(side) for axes in figure.axes for side in ("left", "center"))
    finally:
        plt.close("all")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_example_is_of_the_gallery(file: Path) -> None:
    """A title with two or three sentences, cells, an assertion, and the figure last."""
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
