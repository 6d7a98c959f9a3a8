"""Completion in the shell. It imports nothing heavy, since every Tab starts the program."""

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

PROGRAM = "vibroimpact"
VARIABLE = "_VIBROIMPACT_COMPLETE"
"""Environment variable by which a shell asks for completion."""

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
    words: dict[str, Any] = json.loads(WORDS.read_text(encoding="utf-8"))
    return words


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
    """Return what KEY=VALUE may be: keys of a case or, of a single key, the words that it takes.

    Examples
    --------
    >>> complete_change("plate.size.th"), complete_change("drop.same_spot=")
    (['plate.size.thickness=', 'plate.size.thickness=VALUE'], ['drop.same_spot=true',
    'drop.same_spot=false'])
    """
    return _assignments(incomplete, {**_words()["keys"], "contact.law": _laws()})


def complete_parameter(incomplete: str) -> list[str]:
    """Return what KEY=VALUE may be for a comparison: a parameter of any law, or LAW.PARAMETER.

    Examples
    --------
    >>> complete_parameter("newton.")
    ['newton.restitution=', 'newton.restitution=VALUE']
    """
    laws: dict[str, list[str]] = _words()["laws"]
    parameters = sorted({parameter for law in laws for parameter in laws[law]})
    of_one_law = [f"{law}.{parameter}" for law in laws for parameter in laws[law]]
    return _assignments(incomplete, {key: [] for key in (*parameters, *of_one_law)})


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

    of_other_packages = [point.name for point in entry_points(group="vibroimpact.contact_laws")]
    return [*_words()["laws"], *of_other_packages]


def _starting(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _lists(incomplete: str, names: Iterable[str]) -> list[str]:
    complete, comma, last = incomplete.rpartition(",")
    chosen = complete.split(",")
    return [f"{complete}{comma}{name}" for name in _starting(last, names) if name not in chosen]


def _assignments(incomplete: str, values_of_keys: dict[str, list[str]]) -> list[str]:
    typed_key, sign, typed_value = incomplete.partition("=")
    if sign:
        values = _starting(typed_value, values_of_keys.get(typed_key, ()))
        return [f"{typed_key}={value}" for value in values]
    keys = _starting(typed_key, values_of_keys)
    if len(keys) != 1:
        return [f"{key}=" for key in keys]
    (key,) = keys
    values = values_of_keys[key] or ["VALUE"]
    if len(values) == 1:
        values = ["", *values]  # a shell would add a blank to a single one
    return [f"{key}={value}" for value in values]


def _shipped() -> list[str]:
    return sorted(f"{path.parent.name}:{path.stem}" for path in _LIBRARY.glob("*/*.toml"))


def _files(incomplete: str, endings: tuple[str, ...]) -> list[str]:
    """Return the folders and the files with these endings; of a single folder what is in it."""
    parent, slash, start = incomplete.rpartition("/")
    names = []
    with suppress(OSError):
        for path in sorted(Path(parent + slash).iterdir()):
            name = f"{parent}{slash}{path.name}"
            if not path.name.startswith(start) or not _can_be_typed(name):
                continue
            if path.name.startswith(".") and not start:
                continue  # hidden
            if path.is_dir():
                names.append(f"{name}/")
            elif path.suffix in endings:
                names.append(name)
    if len(names) == 1 and names[0].endswith("/"):
        return _files(names[0], endings)  # a shell would add a blank to a single one
    return names


def _can_be_typed(name: str) -> bool:
    return name.isprintable() and _SPECIAL.isdisjoint(name)


def concerns_completion() -> bool:
    """Return whether this process completes a command line, or installs completion."""
    if VARIABLE in os.environ:
        return True
    return "--install-completion" in sys.argv or "--show-completion" in sys.argv


@contextmanager
def whole_words() -> Iterator[None]:
    """Undo that bash breaks words at ":" and "=": they are joined, and completions are cut."""
    if os.environ.get(VARIABLE) != "complete_bash":
        yield
        return
    text = os.environ["COMP_WORDS"]
    separator = "\n" if "\n" in text else " "
    words, current, prefix = joined(text.split(separator), int(os.environ["COMP_CWORD"]))
    if prefix.startswith("-"):
        # of --from=paper:type1 the option is not part of what is completed
        prefix = prefix.partition("=")[2]
    os.environ |= {"COMP_WORDS": separator.join(words), "COMP_CWORD": str(current)}
    printed = io.StringIO()
    try:
        with redirect_stdout(printed):
            yield
    finally:
        completions = printed.getvalue().splitlines()
        print("\n".join(completion.removeprefix(prefix) for completion in completions))


def joined(broken: list[str], current: int) -> tuple[list[str], int, str]:
    """Return words whole again that bash broke at ":" and "=".

    Parameters
    ----------
    broken : list of str
        Words as bash has them, with the breaks as words.
    current : int
        Index of the current one.

    Returns
    -------
    words : list of str
        The whole words.
    current : int
        Index of the current one among them.
    prefix : str
        What the current one has up to its last break.

    Examples
    --------
    >>> joined(["vibroimpact", "run", "paper", ":", "ty"], 4)
    (['vibroimpact', 'run', 'paper:ty'], 2, 'paper:')
    """
    words: list[str] = []
    index_of_current = 0
    prefix = ""
    after_break = False
    for index, word in enumerate(broken):
        is_break = bool(word) and set(word) <= set(":=")
        continues = is_break or (after_break and word != "")
        start = words.pop() if words and continues else ""
        words.append(start + word)
        if index == current:
            index_of_current = len(words) - 1
            prefix = start + word if is_break else start
        after_break = is_break
    return words, index_of_current, prefix
