"""Transliteration of text to a limited character encoding, for terminals and files."""

from __future__ import annotations

import re
import unicodedata

_SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_RAISED = re.compile(rf"[⁻⁺]?[{_SUPERSCRIPTS}]+(?:·[{_SUPERSCRIPTS}]+)?")
_PLAIN_RAISED = str.maketrans(f"⁻⁺·{_SUPERSCRIPTS}", "-+.0123456789")

_TIMES_TEN = re.compile(r"(?<=\d)·10([⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)")

_REPLACEMENTS = {
    "\u00b5": "u",  # micro
    "\u03bc": "u",
    "\u03b5": "e",
    "\u00d7": "x",
    "·": "*",
    "÷": "/",
    "±": "+-",
    "\u2212": "-",  # minus
    "\u2010": "-",  # hyphens and dashes
    "\u2011": "-",
    "\u2013": "-",
    "\u2014": "-",
    "…": "...",
    "≤": "<=",
    "≥": ">=",
    "≠": "!=",
    "≈": "~",
    "√": "sqrt",
    "∞": "inf",
    "°": " deg",
    "→": "->",
    "←": "<-",
    "•": "*",
    "\u2018": "'",
    "\u2019": "'",
    "\u201c": '"',
    "\u201d": '"',
    "\u201e": '"',
    "«": '"',
    "»": '"',
    "ß": "ss",
    "æ": "ae",
    "Æ": "AE",
    "ø": "o",
    "Ø": "O",
    "ł": "l",
    "Ł": "L",
}

_GREEK = re.compile(r"GREEK (SMALL|CAPITAL) LETTER (\w+)$")


def encodable(phrase: str, encoding: str) -> str:
    """Return a text with characters that an encoding lacks replaced by readable ones.

    Powers and powers of ten are written as in a program, Greek letters by name, accents are
    dropped; any other character becomes its code point as an escape.

    Parameters
    ----------
    phrase : str
        The text.
    encoding : str
        Name of the encoding; an unknown one is treated as ASCII.

    Examples
    --------
    >>> encodable("9.7·10³ N/m¹·⁵ in 269 µs \u2212 1.2·10⁻⁷ m/s²", "ascii")
    '9.7e3 N/m^1.5 in 269 us - 1.2e-7 m/s^2'
    >>> encodable("269 µs, 10⁻⁷ m²", "cp1252")
    '269 µs, 10^-7 m²'
    """
    try:
        phrase.encode(encoding)
    except UnicodeEncodeError:
        pass
    except LookupError:
        return encodable(phrase, "ascii")
    else:
        return phrase

    def plain_power_of_ten(match: re.Match[str]) -> str:
        if _can_encode(encoding, match[0]):
            return match[0]
        return f"e{match[1].translate(_PLAIN_RAISED)}"

    def plain_exponent(match: re.Match[str]) -> str:
        if _can_encode(encoding, match[0]):
            return match[0]
        return f"^{match[0].translate(_PLAIN_RAISED)}"

    # powers of ten first, whose exponents are raised digits too
    phrase = _TIMES_TEN.sub(plain_power_of_ten, phrase)
    phrase = _RAISED.sub(plain_exponent, phrase)
    letters = []
    for letter in phrase:
        if not _can_encode(encoding, letter):
            letter = _replacement(letter)
        letters.append(letter)
    return "".join(letters)


def _can_encode(encoding: str, phrase: str) -> bool:
    try:
        phrase.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def _replacement(letter: str) -> str:
    """Return the ASCII replacement of a character."""
    if letter in _REPLACEMENTS:
        return _REPLACEMENTS[letter]
    if greek := _GREEK.match(unicodedata.name(letter, "")):
        name = greek[2]
        return name.lower() if greek[1] == "SMALL" else name.capitalize()
    # a letter without its accents
    parts = unicodedata.normalize("NFKD", letter)
    bare = "".join(part for part in parts if not unicodedata.combining(part))
    if bare and _can_encode("ascii", bare):
        return bare
    return letter.encode("ascii", "backslashreplace").decode("ascii")
