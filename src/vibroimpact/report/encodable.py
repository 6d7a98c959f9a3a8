"""Words for a terminal or a file that can't show every letter: readable stand-ins for those that it lacks."""

from __future__ import annotations

import re
import unicodedata

_SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_RAISED = re.compile(rf"[⁻⁺]?[{_SUPERSCRIPTS}]+(?:·[{_SUPERSCRIPTS}]+)?")
_PLAIN_RAISED = str.maketrans(f"⁻⁺·{_SUPERSCRIPTS}", "-+.0123456789")

_TIMES_TEN = re.compile(r"(?<=\d)·10([⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)")

_STAND_INS = {
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


def encodable(words: str, encoding: str) -> str:
    """Return words in letters that an encoding has: as they are where it has them all, else with stand-ins that can be read.

    Powers and powers of ten are written as in a program, Greek letters by their names, accents are left away; a letter that
    nothing stands for is given by its number.

    Parameters
    ----------
    words : str
        What is to be shown.
    encoding : str
        Name of the encoding; one that is not known counts as ASCII.

    Examples
    --------
    >>> encodable("9.7·10³ N/m¹·⁵ in 269 µs \u2212 1.2·10⁻⁷ m/s²", "ascii")
    '9.7e3 N/m^1.5 in 269 us - 1.2e-7 m/s^2'
    >>> encodable("269 µs, 10⁻⁷ m²", "cp1252")
    '269 µs, 10^-7 m²'
    """
    try:
        words.encode(encoding)
    except UnicodeEncodeError:
        pass
    except LookupError:
        return encodable(words, "ascii")
    else:
        return words
    words = _TIMES_TEN.sub(lambda found: found[0] if _has(encoding, found[0]) else f"e{found[1].translate(_PLAIN_RAISED)}", words)
    words = _RAISED.sub(lambda found: found[0] if _has(encoding, found[0]) else f"^{found[0].translate(_PLAIN_RAISED)}", words)
    return "".join(letter if _has(encoding, letter) else _stand_in(letter) for letter in words)


def _has(encoding: str, words: str) -> bool:
    try:
        words.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def _stand_in(letter: str) -> str:
    """Return what stands for a letter that an encoding lacks, in letters that every encoding has."""
    if letter in _STAND_INS:
        return _STAND_INS[letter]
    if greek := _GREEK.match(unicodedata.name(letter, "")):
        return greek[2].lower() if greek[1] == "SMALL" else greek[2].capitalize()
    bare = "".join(part for part in unicodedata.normalize("NFKD", letter) if not unicodedata.combining(part))
    if bare and _has("ascii", bare):
        return bare
    return letter.encode("ascii", "backslashreplace").decode("ascii")
