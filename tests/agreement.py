"""What tests compare with what we did not write: one call asserts that both agree, and records by
how much.

Tests take the fixture `agrees`; a module says whom it compares with in its constant `AGAINST`.
`pytest --validation FILE` writes the comparisons of the tests that passed into a file of JSON
lines, in place of what it had of these tests; `validation_page.py` makes docs/validation.md of it.
The default suite holds each comparison against what is told in `TOLD`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
TOLD = Path(__file__).with_name("validation.jsonl")

Kind = Literal[
    "closed form",
    "published computation",
    "other program",
    "own independent computation",
    "consistency",
    "fitted to published numbers",
    "experiment",
    "experiment, speed assumed",
    "fitted to measurements",
]
Subject = Literal[
    "Hertz and elastic contact",
    "damping laws",
    "elastic-plastic contact",
    "adhesion",
    "oblique impact and friction",
    "flight, bounces and shaken plates",
    "several bodies",
    "plates, spheres and modes",
    "impacts on vibrating bodies",
    "sensors and signals",
    "calibration, identification and studies",
    "programs and files",
]
MEASURES: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "relative": lambda apart, theirs: apart / np.abs(theirs),
    "absolute": lambda apart, theirs: apart,
    "of the largest": lambda apart, theirs: apart / np.abs(theirs).max(),
    "rms": lambda apart, theirs: np.sqrt((apart**2).mean() / (theirs**2).mean()),
    "mean": lambda apart, theirs: apart.mean(),
}
ROUNDING = 1e-12
"""Deviations below it, as parts of what is compared, differ from machine to machine and
are not told.
"""


Agrees = Callable[..., None]


@dataclass(frozen=True)
class Against:
    """Whom a test compares with: a short name, what kind of opponent, in which subject,
    and where their numbers are from.
    """

    opponent: str
    kind: Kind
    subject: Subject
    source: str

    def __post_init__(self) -> None:
        assert self.kind in get_args(Kind), self.kind
        assert self.subject in get_args(Subject), self.subject


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--validation",
        metavar="FILE",
        type=Path,
        help="write what agrees with others, and by how much, as JSON lines",
    )


@pytest.fixture
def agrees(request: pytest.FixtureRequest) -> Agrees:
    """Assert that two values or arrays agree within a tolerance, and record it."""

    def agrees(
        case: str,
        quantity: str,
        ours: Any,
        theirs: Any,
        *,
        unit: str = "",
        against: Against | None = None,
        **tolerances: float,
    ) -> None:
        """Compare ours with theirs; one tolerance: `relative`, `absolute`,
        `of_the_largest` of theirs, `rms` over theirs, or `mean`.
        """
        ((name, tolerance),) = tolerances.items()
        measure = name.replace("_", " ")
        ours = np.atleast_1d(np.asarray(ours, dtype=float))
        theirs = np.broadcast_to(np.asarray(theirs, dtype=float), ours.shape)
        assert ours.size, f"{case}, {quantity}: nothing to compare"
        deviation = float(MEASURES[measure](np.abs(ours - theirs), theirs).max())
        assert deviation <= tolerance, (
            f"{case}, {quantity}: {deviation:.3g} off ({measure}), at most "
            f"{tolerance:g}\n{ours}\n{theirs}"
        )
        file, test = _place(request.node.nodeid)
        asked = _digits(tolerance, 2)
        row = {
            "file": file,
            "test": test,
            **asdict(against or request.module.AGAINST),
            "case": case,
            "quantity": quantity,
            "unit": unit,
            "measure": measure,
            "tolerance": asked,
            "deviation": min(_upper(deviation, measure, tolerance, theirs), asked),
            "points": ours.size,
            "theirs": _ends(theirs, theirs, measure, tolerance),
            "ours": _ends(ours, theirs, measure, tolerance),
        }
        request.node.user_properties.append(("agreement", row))
        if request.config.getoption("--validation") is None and not any(
            map(request.node.get_closest_marker, ("peers", "slow"))
        ):
            _check_told(row)

    return agrees


def _place(node: str) -> tuple[str, str]:
    """The file and the function of a test, without its parameters."""
    file, _, test = node.split("[")[0].partition("::")
    return file, test


def _upper(deviation: float, measure: str, tolerance: float, theirs: np.ndarray) -> float:
    """A bound of a deviation that is the same on all machines: a decade below 1e-6, one
    digit above.
    """
    scale = (
        (float(np.abs(theirs).max()) or 1e4 * tolerance) if measure in ("absolute", "mean") else 1.0
    )
    deviation = max(deviation, ROUNDING * scale)
    decade = 10.0 ** math.ceil(math.log10(deviation) - 1e-9)
    return _digits(decade if deviation < 1e-6 * scale else deviation, 1)


def _digits(value: float, digits: int) -> float:
    """A positive value, rounded up to so many digits."""
    power = math.floor(math.log10(value)) + 1 - digits
    return float(f"{math.ceil(value / 10.0**power - 1e-6)}e{power}")


def _ends(values: np.ndarray, theirs: np.ndarray, measure: str, tolerance: float) -> list[float]:
    """The least and the largest value, to six digits of each, or of the largest of theirs."""
    ends = float(values.min()), float(values.max())
    if measure == "relative":
        return [float(f"{end:.5e}") for end in ends]
    decimals = 5 - math.floor(math.log10(float(np.abs(theirs).max()) or tolerance))
    return [round(end, decimals) + 0.0 for end in ends]


def key(row: dict[str, Any]) -> tuple[Any, ...]:
    """What rows have in common that are one row of the page: all but the numbers."""
    return tuple(
        row[name]
        for name in ("file", "test", "opponent", "case", "quantity", "measure", "tolerance")
    )


def merged(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row for all points of the same comparison, whose parameters may differ, in order."""
    found: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row in rows:
        here = found.setdefault(key(row), {**row, "points": 0, "deviation": 0.0})
        here["points"] += row["points"]
        here["deviation"] = max(here["deviation"], row["deviation"])
        for name in ("theirs", "ours"):
            here[name] = [min(here[name][0], row[name][0]), max(here[name][1], row[name][1])]
    return [found[one] for one in sorted(found)]


@cache
def _told() -> dict[tuple[Any, ...], dict[str, Any]]:
    return {key(row): row for row in read(TOLD)}


def _check_told(row: dict[str, Any]) -> None:
    """What is told of a comparison holds on this machine too, but for a decade of rounding."""
    remedy = (
        f"; `pytest {row['file']} --validation {TOLD.relative_to(ROOT)}` tells it, `python "
        "tests/validation_page.py` writes the page"
    )
    told = _told().get(key(row))
    assert told, f"docs/validation.md lacks {row['case']}, {row['quantity']}{remedy}"
    (low, high), slack = told["theirs"], 1e-4 * max(map(abs, told["theirs"]))
    same = low - slack <= row["theirs"][0] and row["theirs"][1] <= high + slack
    assert same, f"docs/validation.md tells other numbers of theirs than {row}{remedy}"
    assert row["deviation"] <= 10.0 * told["deviation"] * (1.0 + 1e-9), (
        f"docs/validation.md tells a smaller deviation than {row}{remedy}"
    )


def read(file: Path) -> list[dict[str, Any]]:
    return (
        [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
        if file.exists()
        else []
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """A run that records leaves out the tests that compare nothing."""
    if config.getoption("--validation") is not None:
        config.hook.pytest_deselected(items=[item for item in items if not _compares(item)])
        items[:] = filter(_compares, items)


def _compares(item: pytest.Item) -> bool:
    return "agrees" in getattr(item, "fixturenames", ())


def pytest_configure(config: pytest.Config) -> None:
    file = config.getoption("--validation")
    # the workers of pytest-xdist report to the one that writes
    if file is not None and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Recorder(file), "recorder of agreements")


class Recorder:
    """Collects the comparisons of tests that passed, from all workers, and writes them at
    the end.
    """

    def __init__(self, file: Path) -> None:
        self.file, self.rows, self.tests = file, [], set()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep what a test that passed has compared, or one that fails as expected had
        compared before it did.
        """
        if report.when == "call" and (report.passed or hasattr(report, "wasxfail")):
            self.rows += [row for name, row in report.user_properties if name == "agreement"]
            self.tests.add(_place(report.nodeid))

    def pytest_sessionfinish(self) -> None:
        kept = [row for row in read(self.file) if (row["file"], row["test"]) not in self.tests]
        lines = [json.dumps(row, ensure_ascii=False) + "\n" for row in merged([*kept, *self.rows])]
        self.file.write_text("".join(lines), encoding="utf-8")
