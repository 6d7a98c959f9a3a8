"""Completion in the shell: what can follow at each place of the command line. It imports
nothing heavy: every Tab starts the program.
"""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from functools import cache
from pathlib import Path
from typing import Any

PROGRAM, VARIABLE = "vibroimpact", "_VIBROIMPACT_COMPLETE"

WORDS = Path(__file__).with_name("completion.json")
"""The names and keys, which `completion_words` collects."""

TABLES = (".csv", ".txt", ".tsv", ".asc", ".lvm")
RECORDS = (
    ".wav",
    ".m4a",
    ".mp3",
    ".ogg",
    ".opus",
    ".flac",
    *TABLES,
    ".uff",
    ".unv",
    ".nc",
    ".nc4",
    ".h5",
)
"""Endings of the files of records."""

_LIBRARY = Path(__file__).parents[1] / "cases" / "library"
_SPECIAL = set(" \t\n\"'\\$`*?[]{}()<>|&;!#~")  # letters that a shell would read otherwise


@cache
def _words() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(WORDS.read_text(encoding="utf-8"))
    return found


def complete_case(incomplete: str) -> list[str]:
    """Return the shipped cases, the TOML files and the folders that a case may begin with.

    Examples
    --------
    >>> complete_case("paper:type1-t")
    ['paper:type1-theory']
    """
    return [*_starting(incomplete, _shipped()), *_files(incomplete, (".toml",))]


def complete_case_or_record(incomplete: str) -> list[str]:
    """Return what `complete_case` does, and the files of records.

    Examples
    --------
    >>> complete_case_or_record("paper:type1-t")
    ['paper:type1-theory']
    """
    return [*_starting(incomplete, _shipped()), *_files(incomplete, (".toml", *RECORDS))]


def complete_change(incomplete: str) -> list[str]:
    """Return what KEY=VALUE may be: the keys of a case; or, of one key alone, the words that it
    takes.

    Examples
    --------
    >>> complete_change("plate.size.th"), complete_change("drop.same_spot=")
    (['plate.size.thickness=', 'plate.size.thickness=VALUE'], ['drop.same_spot=true',
    'drop.same_spot=false'])
    """
    words = {**_words()["keys"], "contact.law": _laws()}
    return _assignments(incomplete, words)


def complete_parameter(incomplete: str) -> list[str]:
    """Return what KEY=VALUE may be for a comparison: a parameter of any law, or LAW.PARAMETER.

    Examples
    --------
    >>> complete_parameter("newton.")
    ['newton.restitution=', 'newton.restitution=VALUE']
    """
    laws: dict[str, list[str]] = _words()["laws"]
    parameters = sorted({one for several in laws.values() for one in several})
    return _assignments(
        incomplete,
        {key: [] for key in (*parameters, *(f"{law}.{one}" for law in laws for one in laws[law]))},
    )


def complete_law(incomplete: str) -> list[str]:
    """Return the contact laws whose names begin so, with those of other packages."""
    return _starting(incomplete, _laws())


def complete_laws(incomplete: str) -> list[str]:
    """Return what a list of laws, separated by commas, may go on with.

    Examples
    --------
    >>> complete_laws("flores,hert")
    ['flores,hertz']
    """
    return _lists(incomplete, _laws())


def complete_material(incomplete: str) -> list[str]:
    """Return the materials whose names begin so."""
    return _starting(incomplete, _words()["materials"])


def complete_format(incomplete: str) -> list[str]:
    """Return the export formats whose names begin so."""
    return _starting(incomplete, _words()["formats"])


def complete_parts(incomplete: str) -> list[str]:
    """Return what a list of parts of the reproduction, separated by commas, may go on with."""
    return _lists(incomplete, _words()["parts"])


def complete_features(incomplete: str) -> list[str]:
    """Return what a list of features, separated by commas, may go on with."""
    return _lists(incomplete, _words()["features"])


def complete_compared(incomplete: str) -> list[str]:
    """Return what `correlate` may compare.

    Examples
    --------
    >>> complete_compared("re")
    ['records', 'responses']
    """
    return _starting(incomplete, _words()["compared"])


def _laws() -> list[str]:
    from importlib.metadata import entry_points

    return [
        *_words()["laws"],
        *(point.name for point in entry_points(group="vibroimpact.contact_laws")),
    ]


def _starting(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _lists(incomplete: str, names: Iterable[str]) -> list[str]:
    before, comma, last = incomplete.rpartition(",")
    return [
        f"{before}{comma}{name}" for name in _starting(last, names) if name not in before.split(",")
    ]


def _assignments(incomplete: str, words: dict[str, list[str]]) -> list[str]:
    key, sign, value = incomplete.partition("=")
    if sign:
        return [f"{key}={word}" for word in _starting(value, words.get(key, ()))]
    keys = _starting(key, words)
    if len(keys) > 1:
        return [f"{one}=" for one in keys]
    # two or more are offered, as a shell would add a blank to one
    return [
        f"{one}={word}"
        for one in keys
        for word in (words[one] if len(words[one]) > 1 else ("", *(words[one] or ["VALUE"])))
    ]


def _shipped() -> list[str]:
    return sorted(f"{path.parent.name}:{path.stem}" for path in _LIBRARY.glob("*/*.toml"))


def _files(incomplete: str, endings: tuple[str, ...]) -> list[str]:
    """Return the files with these endings and folders; of a single folder what is in it,
    as a shell would add a blank to one.
    """
    before, slash, start = incomplete.rpartition("/")
    found = []
    with suppress(OSError):
        for entry in sorted(Path(before + slash).iterdir()):
            name, is_folder = f"{before}{slash}{entry.name}", entry.is_dir()
            hidden = entry.name.startswith(".") and not start.startswith(".")
            if (
                not entry.name.startswith(start)
                or hidden
                or _SPECIAL & set(name)
                or not name.isprintable()
            ):
                continue
            if is_folder or entry.suffix in endings:
                found.append(f"{name}/" if is_folder else name)
    return _files(found[0], endings) if len(found) == 1 and found[0].endswith("/") else found


def concerns_completion() -> bool:
    """Return whether this process was started to complete a command line, or to install
    completion.
    """
    return VARIABLE in os.environ or not {"--install-completion", "--show-completion"}.isdisjoint(
        sys.argv
    )


@contextmanager
def whole_words() -> Iterator[None]:
    """Context manager that joins the words that bash breaks at ":" and "=", and cuts what
    is printed to what follows the break.
    """
    if os.environ.get(VARIABLE) != "complete_bash":
        yield
        return
    text = os.environ["COMP_WORDS"]
    between = "\n" if "\n" in text else " "
    words, place, before = joined(text.split(between), int(os.environ["COMP_CWORD"]))
    if before.startswith("-"):
        # of --from=paper:type1 the option is not part of what is completed
        before = before.partition("=")[2]
    os.environ |= {"COMP_WORDS": between.join(words), "COMP_CWORD": str(place)}
    printed = io.StringIO()
    try:
        with redirect_stdout(printed):
            yield
    finally:
        print("\n".join(line.removeprefix(before) for line in printed.getvalue().splitlines()))


def joined(words: list[str], place: int) -> tuple[list[str], int, str]:
    """Return words whole again that bash broke at ":" and "=", the place of the current one, and
    what it has before the last break.

    Parameters
    ----------
    words : list of str
        Words as bash has them, with the breaks as words.
    place : int
        Index of the current one.

    Examples
    --------
    >>> joined(["vibroimpact", "run", "paper", ":", "ty"], 4)
    (['vibroimpact', 'run', 'paper:ty'], 2, 'paper:')
    """
    found: list[str] = []
    at, before, goes_on = 0, "", False
    for number, word in enumerate(words):
        is_break = bool(word) and set(word) <= set(":=")
        start = found.pop() if found and (is_break or (goes_on and word)) else ""
        found.append(start + word)
        if number == place:
            at, before = len(found) - 1, start + word if is_break else start
        goes_on = is_break
    return found, at, before
