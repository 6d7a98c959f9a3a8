"""Numbers, expressions and titles in the syntax of Adams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

LINE = 80
"""Largest length of a line."""


def adams_number(value: float) -> str:
    """Return a number in Adams' syntax with 15 digits: with a decimal point, and an exponent with
    capital E.

    Examples
    --------
    >>> (
    ...     adams_number(1e-05),
    ...     adams_number(25.0),
    ...     adams_number(0.1 + 0.2),
    ...     adams_number(5),
    ...     adams_number(1e22),
    ... )
    ('1.0E-05', '25.0', '0.3', '5.0', '1.0E+22')
    """
    mantissa, _, exponent = repr(float(f"{value:.15g}")).partition("e")
    if "." not in mantissa:
        mantissa += ".0"
    if not exponent:
        return mantissa
    return f"{mantissa}E{exponent}"


def adams_numbers(values: Sequence[float]) -> str:
    """Return numbers as a comma-separated list."""
    return ", ".join(map(adams_number, values))


def column_titles(readings: Mapping[int, tuple[str, str]]) -> str:
    """Return the titles of the columns of a request up to the last one used, empty for
    unused columns.
    """
    return ", ".join(
        f'"{readings.get(column, ("",))[0]}"' for column in range(1, max(readings) + 1)
    )


def wrapped(text: str, width: int) -> list[str]:
    """Return an expression as lines of at most `width` characters, broken at blanks.

    Examples
    --------
    >>> wrapped("A + B * (C - D)", 8)
    ['A + B *', '(C - D)']
    """
    lines = [""]
    for word in text.split(" "):
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width:
            lines.append(word)
        else:
            lines[-1] = f"{lines[-1]} {word}".lstrip()
    return lines


def view_function(expression: str) -> str:
    """Return an expression for a command of Adams View: a series of quoted strings, one per line,
    which it concatenates.

    Examples
    --------
    >>> view_function("VARVAL(damping)")
    '"VARVAL(damping)"'
    """
    *first, last = wrapped(expression, LINE - 20)
    return ",  &\n   ".join([*(f'"{line} "' for line in first), f'"{last}"'])


def solver_lines(argument: str) -> str:
    """Return an argument of a statement of Adams/Solver, whose continuation lines have a comma in
    the first column.

    An expression must end with a backslash if another argument follows.

    Examples
    --------
    >>> print(", " + solver_lines("FUNCTION = " + " + ".join(["VARVAL(1)"] * 7)))
    , FUNCTION = VARVAL(1) + VARVAL(1) + VARVAL(1) + VARVAL(1) + VARVAL(1) +
    , VARVAL(1) + VARVAL(1)
    """
    return "\n, ".join(wrapped(argument, LINE - 2))
