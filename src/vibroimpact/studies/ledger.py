"""The ledger of a study: which chunks there are, and which of them are done.

It is an SQLite database, held locked for as long as a study is at work on it, whatever ends that work.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from vibroimpact.errors import ComputationError, InputError
from vibroimpact.files.write_file import new_file

LEDGER = "ledger.sqlite"

_SCHEMA = """
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE chunk (number INTEGER PRIMARY KEY, first INTEGER NOT NULL, count INTEGER NOT NULL, state TEXT NOT NULL DEFAULT 'waiting',
                    failed INTEGER, sha256 TEXT, finished TEXT);
"""


class Span(NamedTuple):
    """A chunk: its number, its first point, and how many it has."""

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
        """What the study is: its fingerprint, the version that began it, how large it is."""
        return dict(self.connection.execute("SELECT key, value FROM study"))

    def chunks(self, state: str) -> list[Span]:
        """Return the chunks that are "waiting" or "done", in order."""
        rows = self.connection.execute("SELECT number, first, count FROM chunk WHERE state = ? ORDER BY number", (state,))
        return [Span(*row) for row in rows]

    def checksums(self) -> dict[int, str]:
        """Return the checksum of each chunk that is done, by its number."""
        return dict(self.connection.execute("SELECT number, sha256 FROM chunk WHERE state = 'done' ORDER BY number"))

    def done(self, chunk: Span, sha256: str, failed: int) -> None:
        """Note that a chunk is done and on disk."""
        with _translated_faults(self.path), self.connection:
            self.connection.execute(
                "UPDATE chunk SET state = 'done', sha256 = ?, failed = ?, finished = datetime('now') WHERE number = ?",
                (sha256, failed, chunk.number),
            )

    def undone(self, chunk: int) -> None:
        """Note that a chunk has to be done again: what is on disk is not what was written."""
        with _translated_faults(self.path), self.connection:
            self.connection.execute("UPDATE chunk SET state = 'waiting', sha256 = NULL, failed = NULL WHERE number = ?", (chunk,))


def make_ledger(folder: Path, facts: Mapping[str, str], size: int, chunk: int) -> None:
    """Make, whole or not at all, the ledger of a study of `size` points in chunks of `chunk`, none of them done."""
    with _translated_faults(folder / LEDGER), new_file(folder / LEDGER) as working, closing(sqlite3.connect(working)) as connection:
        connection.execute("PRAGMA journal_mode = MEMORY")  # it is whole or not at all, and nothing is beside it
        with connection:
            connection.executescript(_SCHEMA)
            connection.executemany("INSERT INTO study VALUES (?, ?)", {**facts, "size": str(size)}.items())
            spans = ((number, first, min(chunk, size - first)) for number, first in enumerate(range(0, size, chunk)))
            connection.executemany("INSERT INTO chunk (number, first, count) VALUES (?, ?, ?)", spans)


def busy(folder: Path) -> str:
    """Return what to tell of a folder in which another process is at work."""
    return f"{folder}: another sweep is at work in this folder; wait for it, or name another folder"


def is_held(folder: Path) -> bool:
    """Is a process at work on the study in a folder?"""
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
    """Open the ledger of a study, and keep everyone else from it.

    Raises
    ------
    InputError
        If there is none, it is damaged, or another process has it open.
    ComputationError
        If it can't be written to.
    """
    path = folder / LEDGER
    if not path.is_file():
        raise InputError(f"{folder}: this is not the folder of a study; it has no {LEDGER}")
    with _translated_faults(path):
        connection = sqlite3.connect(path, timeout=0.2)
    try:
        with _translated_faults(path):
            # the journal of a process that died stays until something is written; leaving this mode rolls it back and deletes it
            connection.execute("PRAGMA journal_mode = TRUNCATE")
            connection.execute("PRAGMA journal_mode = DELETE")
            # an exclusive lock is held from the first write to the end of the connection, and the system frees it of a process that died
            connection.execute("PRAGMA locking_mode = EXCLUSIVE")
            connection.execute("BEGIN EXCLUSIVE")
            connection.execute("COMMIT")
            found = connection.execute("PRAGMA quick_check").fetchone()[0]
            if found != "ok":
                raise sqlite3.DatabaseError(found)
            _check_chunks(connection)
        yield Ledger(connection, path)
    finally:
        connection.close()


def _check_chunks(connection: sqlite3.Connection) -> None:
    """Raise unless the chunks follow each other without a gap, and are done or not: a database has no check sums of its own."""
    rows = connection.execute("SELECT number, first, count, state FROM chunk ORDER BY number").fetchall()
    begin = 0
    for place, (number, first, count, state) in enumerate(rows):
        if number != place or first != begin or not isinstance(count, int) or count < 1 or state not in ("waiting", "done"):
            raise sqlite3.DatabaseError(f"chunk {place} is not what it was")
        begin += count
    if [str(begin)] != [value for (value,) in connection.execute("SELECT value FROM study WHERE key = 'size'")]:
        raise sqlite3.DatabaseError("chunks are missing")


@contextmanager
def _translated_faults(path: Path) -> Iterator[None]:
    """Say what a fault of the database means."""
    try:
        yield
    except sqlite3.OperationalError as error:
        if "locked" in str(error):
            raise InputError(busy(path.parent)) from None
        if "no such table" in str(error):
            raise InputError(_damaged(path, str(error))) from None
        raise ComputationError(_unwritten(path, str(error))) from None
    except (sqlite3.Error, UnicodeError) as error:
        raise InputError(_damaged(path, str(error))) from None
    except OSError as error:
        raise ComputationError(_unwritten(path, error.strerror or str(error))) from None


def _unwritten(path: Path, why: str) -> str:
    """Return what to tell of a ledger that can't be written."""
    return f"{path}: the ledger can't be written: {why}; see to the disk, then go on with --resume"


def _damaged(path: Path, why: str) -> str:
    """Return what to tell of a ledger that is damaged."""
    shown = "".join(letter if letter.isprintable() else " " for letter in why)[:100]
    words = "delete this file and go on with --resume: it is made anew from the chunks that are there and whole"
    return f"{path}: the ledger is damaged ({shown}); {words}"
