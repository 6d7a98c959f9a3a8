"""What makes a page usable by everybody, as a browser finds it: names of controls,
headings in order, text that stands out.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

CONTRAST = 4.5
"""Of text against its ground, at least: level AA of the Web Content Accessibility Guidelines."""

_NAMED = {
    "slider",
    "spinbutton",
    "textbox",
    "combobox",
    "checkbox",
    "button",
    "link",
    "progressbar",
    "form",
    "region",
    "navigation",
}
"""Roles that say nothing without a name; those of pictures are read from the page, which
has them also where nothing is drawn yet.
"""

# colours of any notation are read as a canvas paints them; a translucent ground lets through what
# is behind it
_CONTRASTS = """() => {
  const pen = Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true });
  const painted = (colours) => {
    pen.globalAlpha = 1;
    pen.fillStyle = "white";
    pen.fillRect(0, 0, 1, 1);
    for (const [colour, opacity] of colours) { pen.globalAlpha = opacity; pen.fillStyle = colour; pen.fillRect(0, 0, 1, 1); }
    return Array.from(pen.getImageData(0, 0, 1, 1).data.slice(0, 3), (part) => part / 255);
  };
  const luminance = (colour) => {
    const [red, green, blue] = colour.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const found = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const words = walker.currentNode.textContent.trim(), element = walker.currentNode.parentElement;
    if (!words || element.matches("script, style, noscript, :disabled, :disabled *") || !element.checkVisibility()) continue;
    const grounds = [];
    let opacity = 1;
    for (let one = element; one; one = one.parentElement) {
      const style = getComputedStyle(one);
      grounds.unshift([style.backgroundColor, 1]);
      opacity *= Number(style.opacity);
    }
    const style = getComputedStyle(element), ink = element instanceof SVGElement ? style.fill : style.color;
    const [dark, light] = [luminance(painted(grounds)), luminance(painted([...grounds, [ink, opacity]]))].sort((a, b) => a - b);
    found.push([element.tagName.toLowerCase(), (light + 0.05) / (dark + 0.05), words.slice(0, 40)]);
  }
  return found;
}"""


def names_of_controls(page: Page) -> list[tuple[str, str]]:
    """Return role and name of everything that needs a name, as a screen reader is told them."""
    tree = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")["nodes"]
    found = [
        (node["role"]["value"], node["name"]["value"].strip())
        for node in tree
        if not node["ignored"] and node["role"]["value"] in _NAMED
    ]
    pictures: list[str] = page.evaluate(
        "() => [...document.querySelectorAll('canvas, [role=img]')].map((one) => "
        "one.ariaLabel || '')"
    )
    return found + [("img", name) for name in pictures]


def headings(page: Page) -> list[int]:
    """Return the levels of the headings that are shown, in the order of the page."""
    found: list[int] = page.evaluate(
        """() => [...document.querySelectorAll("h1, h2, h3, h4, h5, h6")]
          .filter((one) => one.checkVisibility()).map((one) => Number(one.tagName[1]))"""
    )
    return found


def assert_headings_are_in_order(page: Page) -> None:
    """Check that there is one heading of the page, which comes first, and that none is
    more than a level below the one before.
    """
    levels = headings(page)
    assert levels.count(1) == 1
    assert levels[0] == 1
    assert all(later <= before + 1 for before, later in pairwise(levels)), levels


def faint_texts(page: Page) -> list[tuple[str, float, str]]:
    """Return the element of each text that is too faint, its contrast and the words; what
    is switched off may be.
    """
    found = page.evaluate(_CONTRASTS)
    assert len(found) > 100
    return [
        (where, round(contrast, 2), words)
        for where, contrast, words in found
        if contrast < CONTRAST
    ]


def scrolls_sideways(page: Page) -> bool:
    """Return whether the document as a whole is wider than the window; a table may be, in
    a frame of its own.
    """
    found: bool = page.evaluate(
        "() => document.documentElement.scrollWidth > document.documentElement.clientWidth"
    )
    return found
