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
    phrase = _TIMES_TEN.sub(
        lambda match: (
            match[0] if _can_encode(encoding, match[0]) else f"e{match[1].translate(_PLAIN_RAISED)}"
        ),
        phrase,
    )
    phrase = _RAISED.sub(
        lambda match: (
            match[0] if _can_encode(encoding, match[0]) else f"^{match[0].translate(_PLAIN_RAISED)}"
        ),
        phrase,
    )
    return "".join(
        letter if _can_encode(encoding, letter) else _replacement(letter) for letter in phrase
    )


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
        return greek[2].lower() if greek[1] == "SMALL" else greek[2].capitalize()
    bare = "".join(
        part for part in unicodedata.normalize("NFKD", letter) if not unicodedata.combining(part)
    )
    if bare and _can_encode("ascii", bare):
        return bare
    return letter.encode("ascii", "backslashreplace").decode("ascii")
