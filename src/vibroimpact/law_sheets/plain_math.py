"""Conversion of LaTeX formulas in docstrings to plain text for the terminal, in the
notation of the laws' equations.
"""

from __future__ import annotations

import re

_PART = r"\{([^{}]*)\}"
_ROLE = re.compile(r":math:`([^`]*)`")
_NAMES = {
    r"\dot\delta_0": " v0 ",
    r"\dot\delta": " delta_dot ",
    r"\le": " <= ",
    r"\ge": " >= ",
    r"\varepsilon": " epsilon ",
}


def plain_text(text: str) -> str:
    """Return a paragraph of a docstring as plain text: formulas converted, backquotes removed.

    Examples
    --------
    >>> plain_text(
    ...     r"With :math:`\\dot\\delta_0` the speed, `restitution` is :math:`\\tfrac34 (1 - e^2)`."
    ... )
    'With v0 the speed, restitution is 3/4 (1 - e^2).'
    """
    return _ROLE.sub(lambda match: plain_math(match[1]), text).replace("`", "")


def plain_math(latex: str) -> str:
    """Return a LaTeX formula as plain text; the subset of LaTeX that the docstrings use.

    Examples
    --------
    >>> plain_math(r"\\delta_y = R \\left(\\frac{\\pi p_y}{2 E^*}\\right)^2")
    'delta_y = R ((pi p_y)/(2 E*))^2'
    >>> plain_math(r"v_y = \\sqrt{4 K \\delta_y^{5/2}/(5 m)},\\qquad e = \\sqrt5 \\ln x")
    'v_y = sqrt(4 K delta_y^(5/2)/(5 m)), e = sqrt(5) ln x'
    """
    text = latex
    for name, plain in _NAMES.items():
        text = re.sub(re.escape(name) + r"(?![A-Za-z])", lambda _, plain=plain: plain, text)  # type: ignore[misc]
    text = re.sub(r"\\(?:begin|end)\{cases\}", "", text)
    text = re.sub(r"\\(?:mathrm|text)" + _PART, r"\1", text)
    text = re.sub(r"\\tfrac(\d)(\d)", r" \1/\2 ", text)
    text = re.sub(r"\\sqrt\s*(\d|\\[A-Za-z]+|[A-Za-z])", r" sqrt(\1)", text)
    text = re.sub(r"\\(?:left|right|qquad|quad)(?![A-Za-z])", " ", text)
    text = re.sub(r"\\\\", "; ", text)
    text = re.sub(r"\s*&\s*", " for ", text)
    text = re.sub(r"\\[,; ]", " ", text)
    text = re.sub(r"\^\{\*(\d)\}", r"*^\1", text)
    before = ""
    while text != before:  # nested braces are resolved from the innermost
        before = text
        text = re.sub(r"_" + _PART, r"_\1", text)
        text = re.sub(r"\^" + _PART, lambda match: f"^{_grouped(match[1])}", text)
        text = re.sub(r"\\sqrt" + _PART, r" sqrt(\1)", text)
        text = re.sub(
            r"\\t?frac" + _PART + _PART,
            lambda match: f" {_grouped(match[1])}/{_grouped(match[2])} ",
            text,
        )
    text = re.sub(r"(?<=[A-Za-z0-9)])\\", r" \\", text).replace("\\", "")
    text = text.replace("^*", "*").replace("_+", "+").replace("_-", "-")
    text = re.sub(r"(?<=[A-Za-z])_(?=\d)", "", text)
    return _spaced(text)


def _grouped(part: str) -> str:
    part = part.strip()
    if re.fullmatch(r"[\w*.]+", part):
        return part
    return f"({part})"


def _spaced(text: str) -> str:
    text = re.sub(r"\s+", " ", text).strip()
    text = re.sub(r"([(\[]) ", r"\1", text)
    text = re.sub(r" ([)\],;^_.])", r"\1", text)
    text = re.sub(r"([=(]) ?- ", r"\1 -", text).replace("( -", "(-")
    return re.sub(r"(?<=\S)/ | /(?=\S)", "/", text)
