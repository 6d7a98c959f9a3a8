"""Names that somebody chose, as figures show them."""

from __future__ import annotations

from vibroimpact.shown import shortened, visible


def lettering(name: str, most: int = 60) -> str:
    r"""Return a name such that a figure shows it letter by letter, in one line and not too long.

    A dollar sign would begin a formula, a line break would push the figure's titles apart.

    Examples
    --------
    >>> print(lettering(r"a$\frac{$b"))
    a\$\frac{\$b
    >>> print(lettering("left\nupper"), lettering("a" * 300, 10))
    left\nupper aaaa ... a
    """
    return shortened(visible(name[: 10 * most]), most).replace("$", r"\$")
