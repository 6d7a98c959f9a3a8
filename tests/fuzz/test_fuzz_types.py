"""Values of another kind at every place of a case: each is accepted, or refused in a
clean sentence of its own, whose remedy is one.
"""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from test_fuzz_cases import check

import vibroimpact as vi
from hostile_runs import failures, number, seed
from seeds import Table
from substitutions import (
    MISSING,
    MISSPELT_KEY,
    Substitution,
    all_substitutions,
    value_at,
    with_key,
    with_value,
)

OF_PYDANTIC = re.compile(
    r"Input should|Field required|Value error|valid "
    r"(integer|number|string|tuple|list|dict|date|bool)|instance of|\[type=|validation error"
    r"|(less|greater) than or equal"
)
"""Words that the library which checks types says, and that no case file has."""

REMEDIES = (
    r"rite (\d[^ ]*) \(it is then",
    r'rite \S+ \(it is then in [^)]*\) or ("[^"]*")',
    r"is wanted: write (\d\S*)",
    r"a point: (\S+ ?\S+)$",
)
REMEDIES = (*REMEDIES, r'Write ("[^"]*"|\[[^\]]*\])$')
"""What a message tells to write in place of a value, as a case file has it."""


AGAIN = re.compile(r"it is then in|is wanted: write|write a point|put it in quotes")
"""Remedies after which no other one may be needed at the same place."""


def refusal(table: Table, folder: Path) -> str:
    """Return the message with which a case is refused, without the name of its file; ""
    if it is accepted.
    """
    try:
        check(tomli_w.dumps(table).encode(), folder)
    except vi.InputError as error:
        return str(error).replace(f"{folder / 'case.toml'}: ", "")
    return ""


def remedies(message: str, changed: Substitution) -> Iterator[Table]:
    """Yield the case in which what a message of one fault tells is done; the fault is at
    the place that was changed.
    """
    meant = re.search(r'Did you mean "([^"]*)"\?$', message)
    if changed.kind in (MISSPELT_KEY, MISSING):
        if (
            meant is not None
            and changed.kind == MISSPELT_KEY
            and meant[1] not in value_at(changed.table, changed.place[:-1])
        ):
            yield with_key(changed.case, changed.place, meant[1])
        return
    given = value_at(changed.table, changed.place)
    put: Callable[[Any], Table] = partial(with_value, changed.case, changed.place)
    for pattern in REMEDIES:
        yield from (
            put(tomllib.loads(f"value = {found}")["value"])
            for found in re.findall(pattern, message)
        )
    if "put it in quotes" in message:
        yield put(str(given))
    if (
        meant is not None
        and isinstance(given, dict)
        and given
        and "unknown key" in message
        and meant[1] not in given
    ):
        yield with_key(changed.table, (*changed.place, next(iter(given))), meant[1])
    if meant is not None and isinstance(given, str) and f'"{given}"' in message[: meant.start()]:
        yield put(meant[1])


def is_said_well(changed: Substitution, folder: Path) -> None:
    """Check one case: `attack` judges the length of the message; its words and its
    remedies are judged here.
    """
    message = refusal(changed.table, folder)
    if not message:
        return
    assert not OF_PYDANTIC.search(message), message
    where = message.partition(": ")[0]
    for remedied in remedies(message, changed) if "\n" not in message else ():
        again = refusal(remedied, folder)
        assert again != message, f"the remedy leads to itself: {message}"
        assert not again.startswith(f"{where}: ") or not AGAIN.search(again), (
            f"{message}\nthen {again}"
        )
    raise vi.InputError.of_several(message.split("\n"))


def judge(changed: list[Substitution], folder: Path) -> None:
    told = failures(lambda one: is_said_well(one, folder), changed)
    assert not told, told


def test_values_of_other_kinds(tmp_path: Path) -> None:
    judge(random.Random(seed(5)).sample(all_substitutions(), number(100)), tmp_path)


@pytest.mark.slow
def test_all_values_of_other_kinds(population: Callable[..., int], tmp_path: Path) -> None:
    every = all_substitutions()
    judge(random.Random(seed(6)).sample(every, population(len(every), share=10)), tmp_path)


def calibrate(changed: Substitution) -> None:
    vi.calibration.calibrate_case(vi.calibration.calibration_of(changed.table))


@pytest.mark.slow
def test_calibrations_with_values_of_other_kinds() -> None:
    """What `check` accepts in [calibrate] is calibrated or refused."""
    concerned = [
        changed
        for changed in all_substitutions()
        if changed.place[0] == "calibrate" and "sweep" not in changed.case
    ]
    told = failures(calibrate, concerned)
    assert not told, told


@pytest.mark.parametrize(
    ("where", "kind", "words"),
    [
        (
            "contact.friction.law sweep",
            "empty list",
            "contact.friction.law: [] is not the name of a friction law",
        ),
        (
            "calibrate.parameter calibrate",
            "empty table",
            "calibrate.parameter: {} is not allowed; it takes the tuned parameter",
        ),
        (
            "calibrate.parameter calibrate",
            "empty list",
            "calibrate.parameter: the list is empty; name a parameter, such as",
        ),
        ("schema_version", "true", "schema_version: true is no version; write 1"),
        (
            "sweep.over.drop.height.factor sweep",
            "list of texts",
            'sweep.over."drop.height".factor: "x" is not a plain number',
        ),
        (
            "sweep.classes.fine.over.sphere.radius sweep",
            "list of tables",
            "sphere.radius has values that are not numbers",
        ),
        (
            "calibrate.degree calibrate",
            "text",
            'calibrate.degree: "steel" is not allowed; it must be a whole number from 0 to 12',
        ),
        (
            "calibrate.speeds.from calibrate",
            "misspelt key",
            'unknown key "form"; [calibrate.speeds] takes from, to, number, scale.',
        ),
        (
            "drop.spin",
            "table",
            "drop.spin: { a = 1 } is not a list; it takes angular velocity about x, y and z",
        ),
        (
            "drop.height",
            "infinity as a text",
            'drop.height: "1e999" is beyond what can be computed',
        ),
    ],
)
def test_what_is_said_of_some(where: str, kind: str, words: str, tmp_path: Path) -> None:
    changed = next(one for one in all_substitutions() if (one.where, one.kind) == (where, kind))
    assert words in refusal(changed.table, tmp_path)
