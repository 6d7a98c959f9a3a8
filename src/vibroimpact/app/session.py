"""One window of the live page: it computes one case at a time, and the last one asked for wins."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from threading import Event
from typing import Any, NamedTuple

from vibroimpact.app.messages import Message, read_message
from vibroimpact.app.offer import offer
from vibroimpact.app.saved import files_of
from vibroimpact.app.served_cases import without_other_work
from vibroimpact.app.state import MODES, State, Tell, state_of, table_document
from vibroimpact.cases.reader import load_table, parse_case, shipped_cases
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import drawn
from vibroimpact.charts.pack import pack
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.compiler.notice import heard_by
from vibroimpact.errors import ComputationError, InputError, choices
from vibroimpact.files.hdf5 import short_reason
from vibroimpact.quoting import quoted
from vibroimpact.signals.record import Record

Send = Callable[[bytes], Awaitable[None]]
"""Function that brings a message to the window."""

_SECONDS_BETWEEN = 0.1
"""Time between two messages on progress [s]."""

_SHORT = 2.0
"""Time until which a draft is finished though another case is asked for [s].

So charts follow a slider.
"""

_MOST_FILES = 2
"""Number of reports, figures, measurements and the like that wait for the one being made.

With more, the session takes no message until one is made.
"""


class GivenUp(Exception):
    """What is being computed is no longer wanted."""


class _Measurement(NamedTuple):
    """A measurement that is open: name of its file, records, and charts by their names."""

    name: str
    records: list[Record]
    charts: dict[str, Chart]


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
        self._running: Message | None = None  # the case that is being computed
        self._activity = ""  # what of it is being computed
        self._start = 0.0  # and since when [s]
        self._stop = Event()
        self._changed = asyncio.Event()
        self._last_state: State | None = None  # computed in full
        self._measurement: _Measurement | None = None
        # the files to make, each of a state
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
                await self._reply("opened", message, lambda: _opened(message))
            case "case":
                self._want(message)
            case "cancel":
                await self._cancel()
            case _:
                await self._files.put((message, self._last_state))

    def _want(self, message: Message) -> None:
        """Compute a case next."""
        self._wanted = message
        if self._running is not None and not self._is_worth_finishing(self._running, message):
            self._stop.set()
        self._changed.set()

    def _is_worth_finishing(self, running: Message, wanted: Message) -> bool:
        """Return whether what is computed is short, or the modes that the next case needs too."""
        if self._activity == MODES:
            return _same_bodies(running, wanted)
        elapsed = asyncio.get_running_loop().time() - self._start
        return running.content["detail"] == "draft" and elapsed < _SHORT

    async def _cancel(self) -> None:
        """Give up the case that is being computed, and the one that waits."""
        waiting = self._wanted
        self._wanted = None
        self._stop.set()
        if waiting is not None:
            await self._tell("cancelled", waiting.number, {})

    async def work(self) -> None:
        """Compute the cases that are asked for, and make files beside them, until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._compute_cases())
            tasks.create_task(self._make_files())

    async def _make_files(self) -> None:
        while True:
            message, state = await self._files.get()
            content = message.content
            match message.type:
                case "measurement" | "overlay":
                    overlay = partial(self._overlay, content, state)
                    work = self._reply("overlay", message, overlay)
                case "forget":
                    self._measurement = None
                    continue
                case kind:
                    charts = {}
                    if self._measurement is not None:
                        charts = self._measurement.charts
                    files = partial(files_of, kind, content, state, charts)
                    work = self._reply("files", message, files)
            await self._answer(message.number, work)

    def _overlay(self, content: Mapping[str, Any], state: State | None) -> dict[str, Any]:
        """Return a measurement over what was computed: one that comes, or that of before."""
        # imports scipy.signal
        from vibroimpact.app.measurement import compared, read_measurement

        if "data" in content:
            self._measurement = None
            self._measurement = _Measurement(
                content["name"], read_measurement(content["name"], content["data"]), {}
            )
        measurement = self._measurement
        if measurement is None:
            raise InputError("no measurement is open; drop its file on the page")
        if state is None:
            raise InputError("nothing was computed in full yet")
        shown = compared(measurement.records, state.case, state.response)
        self._measurement = measurement._replace(charts={one.name: one for one in shown.charts})
        return {
            "name": measurement.name,
            "charts": [drawn(chart, plotly_chart) for chart in shown.charts],
            "tables": [table_document(table) for table in shown.tables],
            "notes": shown.notes,
        }

    async def _compute_cases(self) -> None:
        try:
            while True:
                await self._changed.wait()
                self._changed.clear()
                while (message := self._wanted) is not None:
                    self._wanted = None
                    self._running = message
                    self._activity = ""
                    self._start = asyncio.get_running_loop().time()
                    self._stop.clear()
                    await self._answer(message.number, self._compute(message))
                    self._running = None
        finally:
            self._stop.set()

    async def _compute(self, message: Message) -> None:
        loop = asyncio.get_running_loop()
        # what is done at once needs no progress
        last_shown = loop.time() + _SECONDS_BETWEEN

        def show(activity: str, fraction: float = 0.0) -> None:
            # modes and compiled code are also for the case that was asked for last
            number = (self._wanted or message).number
            content = {"what": activity, "part": fraction}
            asyncio.run_coroutine_threadsafe(self._tell("progress", number, content), loop)

        def tell(activity: str, fraction: float) -> None:
            nonlocal last_shown
            if self._stop.is_set():
                raise GivenUp
            self._activity = activity
            if loop.time() - last_shown > _SECONDS_BETWEEN:
                last_shown = loop.time()
                show(activity, fraction)

        with heard_by(show):
            state, reply = await asyncio.to_thread(_state_and_reply, message, tell)
        if message.content["detail"] == "full":
            self._last_state = state
        await self._send(reply)

    async def _answer(self, number: int, work: Awaitable[None]) -> None:
        """Do what a message asks for, and tell the window of whatever goes wrong."""
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

    async def _reply(
        self, kind: str, message: Message, content: Callable[[], Mapping[str, Any]]
    ) -> None:
        """Reply to a message with what a function returns, which is called in a thread."""
        await self._send(await asyncio.to_thread(_packed, kind, message, content))

    async def _tell(self, kind: str, number: int, content: dict[str, Any]) -> None:
        await self._send(pack({"type": kind, "number": number, **content}))

    async def _fault(self, number: int, error: InputError | ComputationError) -> None:
        await self._tell("fault", number, {"lines": str(error).split("\n")})


def _state_and_reply(message: Message, tell: Tell) -> tuple[State, bytes]:
    """Return the state of the case of a message, and the reply that has it."""
    content = message.content
    state = state_of(content["case"], content["detail"], tell, content.get("charts"))
    return state, _packed("state", message, lambda: state.document)


def _packed(kind: str, message: Message, content: Callable[[], Mapping[str, Any]]) -> bytes:
    """Return the reply of a kind to a message."""
    return pack({"type": kind, "number": message.number, **content()})


def _same_bodies(first: Message, second: Message) -> bool:
    """Return whether two cases have the same bodies, and so the same modes."""
    return _bodies_text(first) == _bodies_text(second)


def _bodies_text(message: Message) -> str:
    case = message.content["case"]
    return json.dumps([case.get("sphere"), case.get("plate")], sort_keys=True)


def _opened(message: Message) -> dict[str, Any]:
    """Return the table of a case, and sentences on the sections that are left out."""
    table, left_out = without_other_work(_table_to_open(message.content))
    return {"case": json.loads(json.dumps(table, default=str)), "left_out": left_out}


def _table_to_open(content: dict[str, Any]) -> dict[str, Any]:
    """Return the table of a shipped case, or of the text of a TOML file."""
    source = content.get("source")
    if source is None:
        return parse_case(content["text"])
    names = shipped_cases()
    # a source is never read as the path of a file
    if source not in names:
        raise InputError(
            f"there is no shipped case {quoted(source)}; there are "
            f"{choices(names, source, 'cases')}"
        )
    return load_table(source)
