"""The server of the live page: HTTP and web sockets around sessions, for this machine alone."""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
from collections.abc import Awaitable, Callable
from importlib.resources import files
from types import FrameType
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Receive, Scope
from starlette.types import Send as Answer
from starlette.websockets import WebSocket, WebSocketDisconnect

from vibroimpact.app.messages import LONGEST_OF_ALL
from vibroimpact.app.session import Session
from vibroimpact.report.page import plotly_script

HOST = "127.0.0.1"
"""The address of the server: nobody but this machine reaches it."""

MOST_WINDOWS = 12
"""Largest number of windows at a time."""

_LONGEST_END = 1.0
"""Time that the server takes at most to end after a signal [s]."""

_HOST_NAMES = ("127.0.0.1", "localhost", "[::1]")
_PACKAGES_OF_SCRIPTS = {
    "arrays.js": "vibroimpact.charts",
    "charts.js": "vibroimpact.charts",
    "scene.js": "vibroimpact.charts",
    "theme.css": "vibroimpact.charts",
    "live.css": "vibroimpact.app",
    "controls.js": "vibroimpact.app",
    "sound.js": "vibroimpact.app",
    "live.js": "vibroimpact.app",
}
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data: "
    "blob:; connect-src 'self' {socket}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-cache"),
)


def application(port: int) -> ASGIApp:
    """Return the live page as an application for an ASGI server that listens to a port.

    Requests that name another host than this machine, and web sockets from pages of another origin,
    are refused.
    """
    windows: set[WebSocket] = set()

    async def live(socket: WebSocket) -> None:
        if not _is_own(socket.headers.get("origin", ""), port):
            await socket.close(1008, "another origin")
            return
        if len(windows) >= MOST_WINDOWS:
            await socket.accept()
            await socket.close(1013, f"there are {MOST_WINDOWS} windows already; close one")
            return
        windows.add(socket)  # before it is accepted, so that windows that open at once are counted
        try:
            await socket.accept()
            await _serve_window(socket)
        finally:
            windows.discard(socket)

    routes = [Route("/", _page), Route("/scripts/{name}", _script), WebSocketRoute("/live", live)]
    return _guarded(Starlette(routes=routes), port)


async def _page(request: Request) -> Response:
    return HTMLResponse(_text("vibroimpact.app", "page.html"))


async def _script(request: Request) -> Response:
    name = request.path_params["name"]
    if name == "plotly.js":
        return Response(plotly_script(), media_type="text/javascript")
    if name not in _PACKAGES_OF_SCRIPTS:
        return PlainTextResponse("there is no such script", 404)
    text = _text(_PACKAGES_OF_SCRIPTS[name], f"scripts/{name}")
    media_type = "text/css" if name.endswith(".css") else "text/javascript"
    return Response(text, media_type=media_type)


async def _serve_window(socket: WebSocket) -> None:
    """Serve a window until it closes."""
    sending = asyncio.Lock()

    async def send(message: bytes) -> None:
        async with sending:
            # the window was closed meanwhile
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await socket.send_bytes(message)

    session = Session(send)
    await session.welcome()
    work = asyncio.create_task(session.work())
    try:
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect":
                break
            await session.receive(message.get("text") or message.get("bytes") or "")
    finally:
        work.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await work


def _guarded(app: ASGIApp, port: int) -> ASGIApp:
    """Return an application that refuses foreign hosts and tells browsers what a page may load."""

    async def guarded(scope: Scope, receive: Receive, send: Answer) -> None:
        if scope["type"] not in ("http", "websocket"):
            await app(scope, receive, send)
            return
        host = _host_asked_for(scope)
        if host not in _hosts(port):
            await _refuse(scope, receive, send, port)
            return
        policy = _POLICY.format(socket=f"ws://{host}").encode()
        headers = [(b"content-security-policy", policy), *_HEADERS]

        async def send_with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *headers]
            await send(message)

        await app(scope, receive, send_with_headers)

    return guarded


def _host_asked_for(scope: Scope) -> str:
    """Return the host that a request names, or ""."""
    for name, value in scope["headers"]:
        if name == b"host":
            return str(value.decode("latin-1"))
    return ""


async def _refuse(scope: Scope, receive: Receive, send: Answer, port: int) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": "another host"})
        return
    refusal = f"this page is only for the machine on which it runs; open http://{HOST}:{port} there"
    await PlainTextResponse(refusal, 403)(scope, receive, send)


def _is_own(origin: str, port: int) -> bool:
    """Return whether a web socket is opened by the live page itself.

    Examples
    --------
    >>> (
    ...     _is_own("http://127.0.0.1:8421", 8421),
    ...     _is_own("http://example.org", 8421),
    ...     _is_own("", 8421),
    ...     _is_own("http://[", 8421),
    ... )
    (True, False, False, False)
    """
    return origin in {f"http://{host}" for host in _hosts(port)}


def _hosts(port: int) -> set[str]:
    """Return the names of this server; browsers leave out the port where it is that of HTTP.

    Examples
    --------
    >>> sorted(_hosts(80))
    ['127.0.0.1', '127.0.0.1:80', '[::1]', '[::1]:80', 'localhost', 'localhost:80']
    """
    with_port = {f"{name}:{port}" for name in _HOST_NAMES}
    if port == 80:
        return with_port | set(_HOST_NAMES)
    return with_port


def _text(package: str, file: str) -> str:
    return files(package).joinpath(file).read_text(encoding="utf-8")


class _Server(uvicorn.Server):
    """A server that ends soon after a signal.

    It waits neither for what is computed in its threads nor for windows that do not read.
    """

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Close the connections; end the process if that takes longer than `_LONGEST_END`."""
        super().handle_exit(sig, frame)
        # no thread that computes can be ended otherwise
        end = threading.Timer(_LONGEST_END, os._exit, (128 + sig,))
        end.daemon = True
        end.start()


def serve(sockets: list[Any], port: int, started: Callable[[], None]) -> None:
    """Serve the live page on open sockets until interrupted: then it ends within two seconds.

    Parameters
    ----------
    sockets : list of socket.socket
        Bound sockets of this machine.
    port : int
        Their port.
    started : callable
        Called once it is served.
    """
    config = uvicorn.Config(
        application(port),
        log_level="warning",
        ws_max_size=LONGEST_OF_ALL,
        ws_per_message_deflate=False,
        lifespan="off",
        access_log=False,
    )
    server = _Server(config)

    async def run() -> None:
        task: Awaitable[None] = asyncio.ensure_future(server.serve(sockets))
        while not server.started and not task.done():  # type: ignore[attr-defined]
            await asyncio.sleep(0.01)
        if server.started:
            started()
        await task

    asyncio.run(run())
