"""The look of every role of a chart: colours on light and on dark ground, dashes, hatches
and symbols that differ in greyscale too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

SERIES = 8
"""Number of looks for lines of one kind: `series 0` to `series 7`."""

MANY = 60
"""Number of points of one kind above which they are small, so that they can be told apart."""


@dataclass(frozen=True)
class Look:
    """How a role is drawn.

    Parameters
    ----------
    light, dark : str
        Colour on light and on dark ground, in hexadecimal.
    dashes : tuple of int
        Lengths of dashes and gaps [pt]; empty for a full line.
    width : float
        Width of lines [pt].
    opacity : float
        Opacity of areas.
    line_opacity : float
        Opacity of lines.
    hatch : str
        Hatch of areas: "", "/", "\\", "|", "-", "x" or ".".
    symbol : str
        Symbol of points: "circle", "square", "triangle-up", "diamond", "triangle-down", "x" or
        "cross".
    hollow : bool
        Whether symbols are filled with the ground.
    size : float
        Size of symbols on a page [px].
    size_of_many : float
        The same where there are many.
    """

    light: str
    dark: str
    dashes: tuple[int, ...] = ()
    width: float = 1.2
    opacity: float = 1.0
    line_opacity: float = 1.0
    hatch: str = ""
    symbol: str = "circle"
    hollow: bool = False
    size: float = 7.0
    size_of_many: float = 4.0


GROUND = Look("#ffffff", "#14181d")
INK = Look("#1b1b1b", "#e8e8e8")
SOFT = Look("#5a5a5a", "#a8adb3")
GRID = Look("#dcdcdc", "#343a41")
"""The ground of a page, text, less important text, and grid lines."""

# lines of one kind differ in luminance and in dashes
_SERIES = (
    Look("#00204d", "#8ab4ff", width=1.5, symbol="circle"),
    Look("#0072b2", "#4cc3ff", (6, 2), 1.5, symbol="square"),
    Look("#b3400e", "#ff9a62", (6, 2, 1, 2), 1.5, symbol="triangle-up"),
    Look("#5f8f3e", "#9fd67a", (2, 1), 1.5, symbol="diamond"),
    Look("#cc79a7", "#ffb3d9", (), 1.5, symbol="triangle-down"),
    Look("#6b6b6b", "#c4c4c4", (10, 2, 2, 2), 1.5, symbol="cross"),
    Look("#c79000", "#ffd454", (4, 3), 1.5, symbol="x"),
    Look("#56a8d8", "#2f9fdd", (1, 1), 1.5, symbol="circle"),
)

# points of classes differ in symbols and luminance, and are large enough for symbols to be seen
_CLASSES = (
    Look("#00204d", "#8ab4ff", symbol="circle", size_of_many=5.5),
    Look("#d9772f", "#ffb37a", symbol="triangle-up", size_of_many=6.5),
    Look("#5f8f3e", "#9fd67a", symbol="diamond", size_of_many=6.5),
    Look("#6b6b6b", "#c4c4c4", symbol="x", size_of_many=5.5),
    Look("#0072b2", "#4cc3ff", symbol="square", size_of_many=5.5),
    Look("#cc79a7", "#ffb3d9", symbol="triangle-down", size_of_many=6.5),
    Look("#1b1b1b", "#e8e8e8", symbol="cross", size_of_many=5.5),
    Look("#c79000", "#ffd454", symbol="diamond", size_of_many=6.5),
)

LOOKS: dict[str, Look] = {
    "main": Look("#1b1b1b", "#e8e8e8", width=1.1),
    "detail": Look("#0b4f8a", "#6cb6ff", width=1.4, opacity=0.35),
    "mark": Look("#b3400e", "#ff9a62", hollow=True),
    "other mark": Look("#0b4f8a", "#6cb6ff", symbol="triangle-down", hollow=True),
    "mark line": Look("#b3400e", "#ff9a62", (5, 3), 0.9),
    # what was measured has one colour: values, samples, and a record over which a curve is drawn
    "measured": Look("#b3400e", "#ff9a62"),
    "measured samples": Look("#b3400e", "#ff9a62", size=3.5),
    "measured record": Look("#b3400e", "#ff9a62", width=2.6, line_opacity=0.4),
    "matched": Look("#b3400e", "#ff9a62"),
    "published": Look("#b3400e", "#ff9a62"),
    "difference": Look("#6b6b6b", "#c4c4c4"),
    "fit": Look("#0b4f8a", "#6cb6ff", (6, 2), 1.2),
    "reference": Look("#777777", "#9a9a9a", (4, 3), 0.9),
    "dotted": Look("#1b1b1b", "#e8e8e8", (1, 2), 0.8),
    # on maps, whose colours are the same on dark ground
    "contour": Look("#1b1b1b", "#1b1b1b", width=0.6),
    "muted": Look("#9a9a9a", "#7d7d7d", width=0.7, symbol="x"),
    "contact": Look("#8a8a8a", "#b0b0b0", opacity=0.22),
    "band": Look("#0b4f8a", "#6cb6ff", opacity=0.15),
    "inner band": Look("#0b4f8a", "#6cb6ff", opacity=0.45),
    "total": Look("#1b1b1b", "#e8e8e8", (6, 3), 1.6),
    "body": Look("#cfd6dd", "#4a525b", width=0.8),
    "sphere": Look("#b9b2a7", "#8b857b", width=0.9),
    "support": Look("#6b6b6b", "#9a9a9a", width=0.8, hatch="/"),
    "held": Look("#444444", "#bbbbbb", width=0.8, opacity=0.55),
    "held nodes": Look("#444444", "#bbbbbb", symbol="square", size=3.0),
    "sensor": Look("#c79000", "#ffd454", symbol="triangle-up"),
    "lower": Look("#b3400e", "#ff9a62", hatch="/"),
    # edges on facets, which are light on any ground
    "edge": Look("#1b1b1b", "#1b1b1b", width=0.6, size=2.5),
    "pale": Look("#b9c9d8", "#39536b"),
    "ghost": Look("#9a9a9a", "#7d7d7d", (3, 2), 1.2),
    # overlapping curves: the first is wide and pale, so that it is seen under the others
    "under": Look("#00204d", "#8ab4ff", width=2.6, line_opacity=0.35),
    # the energy ledger, from the bottom of the stack to its top: distinct in luminance and hatch
    "contact damping": Look("#404040", "#8f8f8f"),
    "plastic work": Look("#9c6b52", "#b98468", hatch="."),
    "sphere damping": Look("#7d7d7d", "#737373", hatch="\\"),
    "plate damping": Look("#a3a3a3", "#5d5d5d", hatch="|"),
    "written off": Look("#ffffff", "#2a2f35", hatch="x"),
    "contact elastic": Look("#f7cd6b", "#d9a83a", hatch="/"),
    "sphere motion": Look("#e8a0a0", "#c46f6f", hatch="."),
    "plate motion": Look("#c9e3b4", "#74a456", hatch="-"),
    "potential": Look("#d6e6f4", "#2f4a63"),
    "kinetic": Look("#4a8cc7", "#3f86c6", hatch="\\"),
    **{f"series {number}": look for number, look in enumerate(_SERIES)},
    **{f"class {number}": look for number, look in enumerate(_CLASSES)},
    **{f"thin series {number}": replace(look, width=0.75) for number, look in enumerate(_SERIES)},
    **{
        f"series {number} band": Look(look.light, look.dark, opacity=0.15)
        for number, look in enumerate(_SERIES)
    },
}
"""The look of each role."""

DIVERGING = (
    (0.0, "#0b3c73"),
    (0.25, "#5b9bcf"),
    (0.5, "#f7f7f7"),
    (0.75, "#e38a63"),
    (1.0, "#8f1d14"),
)
"""Colours of a scale that is symmetric about zero, in even steps."""

DIVERGING_ON_DARK = (
    (0.0, "#a8d6ff"),
    (0.25, "#4a8fca"),
    (0.5, "#4a525b"),
    (0.75, "#cc6a48"),
    (1.0, "#ffb79c"),
)
"""The same for surfaces on dark ground, where zero is dark; maps have the first on any ground."""

SEQUENTIAL = (
    (0.0, "#00224e"),
    (0.25, "#3b496c"),
    (0.5, "#7d7c78"),
    (0.75, "#bcae6c"),
    (1.0, "#fee838"),
)
"""Colours of a scale from small to large, of rising luminance."""

SHADES = ((0.0, "#6b8599"), (1.0, "#eef2f6"))
"""Colours of a surface from shade to full light."""


def of_class(number: int) -> str:
    """Return the role of the points of a class, by its number; the ninth looks as the first.

    Examples
    --------
    >>> of_class(0), of_class(9)
    ('class 0', 'class 1')
    """
    return f"class {number % len(_CLASSES)}"


def series(number: int) -> str:
    """Return the role of the line with a number, among lines of one kind; beyond the first eight
    they are thin.

    Examples
    --------
    >>> series(0), series(9)
    ('series 0', 'thin series 1')
    """
    role = f"series {number % SERIES}"
    return role if number < SERIES else f"thin {role}"
