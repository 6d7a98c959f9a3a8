"""One window of the live page: it computes one case at a time, and the last one asked for wins."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Awaitable, Callable, Mapping
from threading import Event
from typing import Any

from vibroimpact.app.messages import Message, read_message
from vibroimpact.app.offer import offer
from vibroimpact.app.served_cases import without_other_work
from vibroimpact.app.state import MODES, State, Tell, state_of
from vibroimpact.cases.reader import load_table, parse_case, shipped_cases
from vibroimpact.charts.pack import pack
from vibroimpact.compiler.notice import heard_by
from vibroimpact.errors import ComputationError, InputError, choices
from vibroimpact.files.hdf5 import short_reason
from vibroimpact.files.plain_names import identifier, plain_names
from vibroimpact.quoting import quoted
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.results.csv_files import signal_csv
from vibroimpact.runs.report import report_of

Send = Callable[[bytes], Awaitable[None]]
"""Function that brings a message to the window."""

_SECONDS_BETWEEN = 0.1
"""Time between two messages on progress [s]."""

_SHORT = 2.0
"""Time after which a draft is given up for what is asked for next [s]; until then it is
finished, so that charts follow a slider.
"""


_MOST_FILES = 2
"""Number of reports and signals that wait for the one being made; for a further one the
session takes no message until there is room.
"""


class GivenUp(Exception):
    """What is being computed is no longer wanted."""


class Session:
    """One window.

    Parameters
    ----------
    send : callable
        Brings a message to the window.
    """

    def __init__(self, send: Send) -> None:
        self._send = send
        self._wanted: Message | None = None  # the case to compute next
        self._running: Message | None = None
        self._stage = ""  # what is being computed
        self._since = 0.0  # and since when [s]
        self._stop = Event()
        self._changed = asyncio.Event()
        self._last: State | None = None  # computed in full
        # those to make, each of a state
        self._files: asyncio.Queue[tuple[Message, State | None]] = asyncio.Queue(_MOST_FILES)

    async def welcome(self) -> None:
        """Tell the window what there is."""
        await self._tell("welcome", 0, await asyncio.to_thread(offer))

    async def receive(self, text: str | bytes) -> None:
        """Take a message of the window; a message that is none is answered by a fault."""
        try:
            message = read_message(text)
        except InputError as error:
            await self._fault(0, error)
        else:
            await self._answer(message.number, self._take(message))

    async def _take(self, message: Message) -> None:
        match message.type:
            case "open":
                await self._send(
                    await asyncio.to_thread(_packed, "opened", message, lambda: _opened(message))
                )
            case "case":
                self._want(message)
            case "cancel":
                waiting, self._wanted = self._wanted, None
                self._stop.set()
                if waiting is not None:
                    await self._tell("cancelled", waiting.number, {})
            case "report" | "signals":
                await self._files.put((message, self._last))

    def _want(self, message: Message) -> None:
        """Compute a case next. What is computed now is given up unless it is short, or
        the modes that the new case needs as well.
        """
        self._wanted = message
        if self._running is not None:
            modes = self._stage == MODES
            begun = asyncio.get_running_loop().time() - self._since
            short = not modes and self._running.content["detail"] == "draft" and begun < _SHORT
            if not (short or (modes and _same_bodies(self._running, message))):
                self._stop.set()
        self._changed.set()

    async def work(self) -> None:
        """Compute the cases that are asked for, and make files beside them, until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._compute_cases())
            tasks.create_task(self._make_files())

    async def _make_files(self) -> None:
        while True:
            message, state = await self._files.get()
            await self._answer(message.number, self._send_files(message, state))

    async def _send_files(self, message: Message, state: State | None) -> None:
        await self._send(
            await asyncio.to_thread(_packed, "files", message, lambda: _files(message.type, state))
        )

    async def _compute_cases(self) -> None:
        try:
            while True:
                await self._changed.wait()
                self._changed.clear()
                while (message := self._wanted) is not None:
                    self._wanted, self._running, self._stage = None, message, ""
                    self._since = asyncio.get_running_loop().time()
                    self._stop.clear()
                    await self._answer(message.number, self._compute(message))
                    self._running = None
        finally:
            self._stop.set()

    async def _compute(self, message: Message) -> None:
        loop, told = asyncio.get_running_loop(), [0.0]

        def show(what: str, part: float = 0.0) -> None:
            # modes and compiled code are also for the case that was asked for last
            asked = self._wanted or message
            asyncio.run_coroutine_threadsafe(
                self._tell("progress", asked.number, {"what": what, "part": part}), loop
            )

        def tell(what: str, part: float) -> None:
            if self._stop.is_set():
                raise GivenUp
            self._stage = what
            if loop.time() - told[0] > _SECONDS_BETWEEN:
                told[0] = loop.time()
                show(what, part)

        told[0] = loop.time() + _SECONDS_BETWEEN  # what is done at once needs no progress
        with heard_by(show):
            state, answer = await asyncio.to_thread(_answered, message, tell)
        if message.content["detail"] == "full":
            self._last = state
        await self._send(answer)

    async def _answer(self, number: int, work: Awaitable[None]) -> None:
        """Do what a message asks for; the window hears of whatever goes wrong, and the
        next message is taken.
        """
        try:
            await work
        except GivenUp:
            await self._tell("cancelled", number, {})
        except (InputError, ComputationError) as error:
            await self._fault(number, error)
        except MemoryError:
            await self._fault(number, ComputationError("there is not enough memory for this case"))
        except Exception as error:
            logging.getLogger(__name__).exception("a message of the live page")
            await self._fault(
                number, ComputationError(f"the case can't be computed: {short_reason(error)}")
            )

    async def _tell(self, kind: str, number: int, content: dict[str, Any]) -> None:
        await self._send(pack({"type": kind, "number": number, **content}))

    async def _fault(self, number: int, error: InputError | ComputationError) -> None:
        await self._tell("fault", number, {"lines": str(error).split("\n")})


def _answered(message: Message, tell: Tell) -> tuple[State, bytes]:
    """Return the state of the case of a message, and the answer that brings it."""
    state = state_of(
        message.content["case"], message.content["detail"], tell, message.content.get("charts")
    )
    return state, _packed("state", message, lambda: state.document)


def _packed(kind: str, message: Message, content: Callable[[], Mapping[str, Any]]) -> bytes:
    """Return the answer of a kind to a message."""
    return pack({"type": kind, "number": message.number, **content()})


def _same_bodies(first: Message, second: Message) -> bool:
    """Return whether two cases have the same bodies, and so the same modes."""
    return all(
        json.dumps(first.content["case"].get(name), sort_keys=True)
        == json.dumps(second.content["case"].get(name), sort_keys=True)
        for name in ("sphere", "plate")
    )


def _opened(message: Message) -> dict[str, Any]:
    """Return the table of a shipped case, or of a text."""
    source = message.content.get("source")
    # a source is never the path of a file
    if source is not None and source not in (known := shipped_cases()):
        raise InputError(
            f"there is no shipped case {quoted(source)}; there are "
            f"{choices(known, source, 'cases')}"
        )
    table = parse_case(message.content["text"]) if source is None else load_table(source)
    table, left_out = without_other_work(table)
    return {"case": json.loads(json.dumps(table, default=str)), "left_out": left_out}


def _files(kind: str, state: State | None) -> dict[str, Any]:
    """Return the report, or the signals, of a state as files."""
    if state is None:
        raise InputError("nothing was computed in full yet")
    result = state.result
    if kind == "report":
        return {
            "files": [
                {
                    "name": f"{identifier(result.name, 'A-Za-z0-9', 'drop', '-')}.html",
                    "kind": "text/html",
                    "text": page_of_report(report_of(result)),
                }
            ]
        }
    if not result.signals:
        raise InputError("there are no signals: the case has no sensors", "sensors")
    names = plain_names(list(result.signals))
    return {
        "files": [
            {"name": f"{names[name]}.csv", "kind": "text/csv", "text": signal_csv(signal)}
            for name, signal in result.signals.items()
        ]
    }
