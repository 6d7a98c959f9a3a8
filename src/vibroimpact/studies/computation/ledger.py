"""The ledger of a study: its chunks and their state, in an SQLite database.

The process that computes the study holds an exclusive lock on it, which the operating system
releases even if the process is killed.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from vibroimpact.errors import ComputationError, InputError
from vibroimpact.files.atomic_write import atomic_file

LEDGER = "ledger.sqlite"

_SCHEMA = """
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE chunk (number INTEGER PRIMARY KEY, first INTEGER NOT NULL, count INTEGER NOT NULL,
                    state TEXT NOT NULL DEFAULT 'waiting', failed INTEGER, sha256 TEXT,
                    finished TEXT);
"""


class Span(NamedTuple):
    """A chunk: its number, its first point, and its number of points."""

    number: int
    first: int
    size: int


@dataclass(frozen=True)
class Ledger:
    """An open ledger."""

    connection: sqlite3.Connection
    path: Path

    @property
    def facts(self) -> dict[str, str]:
        """Fingerprint of the study, versions that created it, and number of drops."""
        return dict(self.connection.execute("SELECT key, value FROM study"))

    def chunks(self, state: str) -> list[Span]:
        """Return the chunks in state "waiting" or "done", in order."""
        rows = self.connection.execute(
            "SELECT number, first, count FROM chunk WHERE state = ? ORDER BY number", (state,)
        )
        return [Span(*row) for row in rows]

    def checksums(self) -> dict[int, str]:
        """Return the checksums of the completed chunks by number."""
        return dict(
            self.connection.execute(
                "SELECT number, sha256 FROM chunk WHERE state = 'done' ORDER BY number"
            )
        )

    def done(self, chunk: Span, sha256: str, failed: int) -> None:
        """Record that a chunk is computed and written."""
        with _translated_faults(self.path), self.connection:
            self.connection.execute(
                "UPDATE chunk SET state = 'done', sha256 = ?, failed = ?, finished = "
                "datetime('now') WHERE number = ?",
                (sha256, failed, chunk.number),
            )

    def undone(self, chunk: int) -> None:
        """Record that a chunk must be recomputed, as its file is damaged or missing."""
        with _translated_faults(self.path), self.connection:
            self.connection.execute(
                "UPDATE chunk SET state = 'waiting', sha256 = NULL, failed = NULL WHERE number = ?",
                (chunk,),
            )


def make_ledger(folder: Path, facts: Mapping[str, str], size: int, chunk: int) -> None:
    """Create the ledger of a study of `size` points, in chunks of `chunk` points, all waiting.

    It appears atomically.
    """
    with (
        _translated_faults(folder / LEDGER),
        atomic_file(folder / LEDGER) as working,
        closing(sqlite3.connect(working)) as connection,
    ):
        # the file appears atomically, without a journal beside it
        connection.execute("PRAGMA journal_mode = MEMORY")
        with connection:
            connection.executescript(_SCHEMA)
            connection.executemany(
                "INSERT INTO study VALUES (?, ?)", {**facts, "size": str(size)}.items()
            )
            for number, first in enumerate(range(0, size, chunk)):
                connection.execute(
                    "INSERT INTO chunk (number, first, count) VALUES (?, ?, ?)",
                    (number, first, min(chunk, size - first)),
                )


def busy(folder: Path) -> str:
    """Return the error message for a folder in use by another process."""
    return f"{folder}: another sweep is at work in this folder; wait for it, or name another folder"


def is_held(folder: Path) -> bool:
    """Return whether a process is computing the study in a folder."""
    if not (folder / LEDGER).is_file():
        return False
    connection = sqlite3.connect(folder / LEDGER, timeout=0.2)
    try:
        connection.execute("BEGIN EXCLUSIVE")
    except sqlite3.DatabaseError as error:
        return "locked" in str(error)
    finally:
        connection.close()
    return False


@contextmanager
def open_ledger(folder: Path) -> Iterator[Ledger]:
    """Open the ledger of a study with an exclusive lock.

    Raises
    ------
    InputError
        If there is none, it is damaged, or another process holds the lock.
    ComputationError
        If it can't be written.
    """
    path = folder / LEDGER
    if not path.is_file():
        raise InputError(f"{folder}: this is not the folder of a study; it has no {LEDGER}")
    with _translated_faults(path):
        connection = sqlite3.connect(path, timeout=0.2)
    try:
        with _translated_faults(path):
            # the journal of a killed process remains until the next write; changing the journal
            # mode rolls it back and deletes it
            connection.execute("PRAGMA journal_mode = TRUNCATE")
            connection.execute("PRAGMA journal_mode = DELETE")
            # the lock lasts from the first write to the end of the connection; the system releases
            # it if the process is killed
            connection.execute("PRAGMA locking_mode = EXCLUSIVE")
            connection.execute("BEGIN EXCLUSIVE")
            connection.execute("COMMIT")
            _check_schema(connection)
            damage = connection.execute("PRAGMA quick_check").fetchone()[0]
            if damage != "ok":
                raise sqlite3.DatabaseError(damage)
            _check_chunks(connection)
        yield Ledger(connection, path)
    finally:
        connection.close()


def _check_schema(connection: sqlite3.Connection) -> None:
    """Check that the database has the tables of a ledger.

    It may have no views and triggers, which would run.
    """
    expected = {
        " ".join(statement.split()) for statement in _SCHEMA.split(";") if statement.strip()
    }
    rows = connection.execute(
        "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL LIMIT 10"
    ).fetchall()
    if {" ".join(str(sql).split()) for (sql,) in rows} != expected:
        raise sqlite3.DatabaseError("it has other tables than a ledger")


def _check_chunks(connection: sqlite3.Connection) -> None:
    """Check that the chunks are contiguous and their states valid.

    The database has no checksums of its own.
    """
    rows = connection.execute(
        "SELECT number, first, count, state FROM chunk ORDER BY number"
    ).fetchall()
    size = 0
    for expected_number, (number, first, count, state) in enumerate(rows):
        if (
            number != expected_number
            or first != size
            or not isinstance(count, int)
            or count < 1
            or state not in ("waiting", "done")
        ):
            raise sqlite3.DatabaseError(f"chunk {expected_number} is not what it was")
        size += count
    sizes = connection.execute("SELECT value FROM study WHERE key = 'size'").fetchall()
    if sizes != [(str(size),)]:
        raise sqlite3.DatabaseError("chunks are missing")


@contextmanager
def _translated_faults(path: Path) -> Iterator[None]:
    """Translate database errors into errors of this package."""
    try:
        yield
    except sqlite3.OperationalError as error:
        if "locked" in str(error):
            raise InputError(busy(path.parent)) from None
        if "no such table" in str(error):
            raise InputError(_damage(path, str(error))) from None
        raise ComputationError(_write_failure(path, str(error))) from None
    except (sqlite3.Error, UnicodeError) as error:
        raise InputError(_damage(path, str(error))) from None
    except OSError as error:
        raise ComputationError(_write_failure(path, error.strerror or str(error))) from None


def _write_failure(path: Path, why: str) -> str:
    """Return the error message for a ledger that can't be written."""
    return f"{path}: the ledger can't be written: {why}; see to the disk, then go on with --resume"


def _damage(path: Path, why: str) -> str:
    """Return the error message for a damaged ledger."""
    reason = "".join(letter if letter.isprintable() else " " for letter in why)[:100]
    return (
        f"{path}: the ledger is damaged ({reason}); delete this file and go on with --resume: it "
        "is made anew from the chunks that are there and whole"
    )
