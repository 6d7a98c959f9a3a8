"""The commands of a LAMMPS input file, by the parsing rules of its manual
(Commands_parse) and by nothing that writes one.
"""

from __future__ import annotations


class Refused(Exception):
    """What LAMMPS would not take, or take otherwise than it looks."""


def commands(text: str) -> list[str]:
    """Return the commands: lines joined where they go on, without comments, with single
    blanks outside quotes.
    """
    if not text.isascii() or any(letter < " " and letter not in "\n\t" for letter in text):
        raise Refused("a letter that is no printable ASCII")
    joined, line = [], ""
    for part in text.split("\n"):
        line += part
        if line.count('"""') % 2:  # triple quotes go on over lines, whatever is in them
            line += "\n"
        elif line.rstrip().endswith("&"):  # also at the end of a comment
            line = line.rstrip()[:-1]
        else:
            joined.append(line)
            line = ""
    if line:
        raise Refused("the last line goes on")
    return [command for command in (_without_comment(line) for line in joined) if command]


def _without_comment(line: str) -> str:
    quote, kept, at = "", "", 0
    while at < len(line):
        letter = line[at]
        if quote:
            quote = "" if line.startswith(quote, at) else quote
        elif letter == "#":
            break
        elif letter in "\"'":
            quote = letter
        kept += letter
        at += 1
    if quote:
        raise Refused(f"a quote that is not closed: {line}")
    return " ".join(kept.split())
