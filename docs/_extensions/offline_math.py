"""Formulas as MathML, written when the site is built: no script and no network reads them.

The font is STIX Two Math, copied from the package ziamath: a browser stretches brackets
and roots only in a font that has a table for mathematics.
"""

from __future__ import annotations

import unicodedata
from pathlib import Path
from shutil import copyfile
from xml.etree import ElementTree

import latex2mathml.converter
import ziamath
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

FONT = Path(ziamath.__file__).parent / "fonts" / "STIXTwoMath-Regular.ttf"
SPACE = "http://www.w3.org/1998/Math/MathML"
ALPHABETS = {
    "bold": "MATHEMATICAL BOLD",
    "bold-italic": "MATHEMATICAL BOLD ITALIC",
    "double-struck": "MATHEMATICAL DOUBLE-STRUCK",
}

ElementTree.register_namespace("", SPACE)


def mathml(latex: str, display: bool = False) -> str:
    """Return a formula as an element `math`, its source as the text that is read aloud
    where MathML is not.
    """
    # $`x`$ is how GitHub writes $x$ where Markdown would read the formula
    formula = latex.strip().strip("`")
    tree = ElementTree.fromstring(
        latex2mathml.converter.convert(formula, display="block" if display else "inline")
    )
    if "\\" in "".join(tree.itertext()):
        raise ValueError(f"a formula has a command that latex2mathml does not know: {formula}")
    for element in tree.iter():
        match element.tag.removeprefix(f"{{{SPACE}}}"):
            case "mover":
                element.set("accent", "true")  # which brings dots and bars down to their letter
            case "mo" if element.text == "/":
                element.attrib |= {"lspace": "0", "rspace": "0"}
            case "mi" if (
                element.get("mathvariant") in ALPHABETS and element.text and len(element.text) == 1
            ):
                element.text = _in_alphabet(
                    element.text, ALPHABETS[element.attrib.pop("mathvariant")]
                )
    return ElementTree.tostring(tree, encoding="unicode")


def _in_alphabet(letter: str, alphabet: str) -> str:
    """Return a letter in bold and the like: of the attribute for it MathML Core knows
    only "normal".
    """
    case = "CAPITAL" if letter.isupper() else "SMALL"
    name = unicodedata.name(letter).split()[-2 if "SYMBOL" in unicodedata.name(letter) else -1]
    return unicodedata.lookup(
        f"{alphabet} {name} SYMBOL"
        if "SYMBOL" in unicodedata.name(letter)
        else f"{alphabet} {case} {name}"
    )


def visit_math(self: HTML5Translator, node: nodes.math) -> None:
    self.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def visit_math_block(self: HTML5Translator, node: nodes.math_block) -> None:
    self.body.append(f'<div class="formula">{mathml(node.astext(), display=True)}</div>\n')
    raise nodes.SkipNode


def copy_font(app: Sphinx, fault: Exception | None) -> None:
    if fault is None:
        copyfile(FONT, Path(app.outdir) / "_static" / FONT.name)


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_html_math_renderer(
        "mathml", inline_renderers=(visit_math, None), block_renderers=(visit_math_block, None)
    )
    app.connect("build-finished", copy_font)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
