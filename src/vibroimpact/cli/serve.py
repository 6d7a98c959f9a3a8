"""The command `serve`: the live page."""

from __future__ import annotations

import socket
from typing import Annotated, Any

import typer

from vibroimpact.cli.shared import app, note, say
from vibroimpact.errors import InputError

_PORT = 8421


@app.command()
def serve(
    case: Annotated[
        str | None,
        typer.Argument(
            metavar="[CASE]", help="The case to open, such as paper:type3 or a TOML file."
        ),
    ] = None,
    port: Annotated[
        int, typer.Option("--port", metavar="N", help="Port on this machine; 0 for any free port.")
    ] = _PORT,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Whether to open the browser.")
    ] = True,
) -> None:
    """Open a browser page that recomputes a case as it changes.

    The page is served on this machine only, until Ctrl-C.
    """
    try:
        from vibroimpact.app.server import HOST
        from vibroimpact.app.server import serve as serve_page
    except ImportError as error:
        raise InputError(
            f"the live page needs {error.name}, which is not installed: pip install "
            '"vibroimpact[app]"'
        ) from None
    fragment = _fragment_of(case)
    listening = _listen(HOST, port)
    port = int(listening.getsockname()[1])
    page = f"http://{HOST}:{port}/"
    address = page + fragment
    # the address with the case is long, and shown only where people open it themselves
    shown = page if browser else address

    def say_address() -> None:
        say(f"the live page is at {shown}; Ctrl-C ends it")
        note(
            f"on another machine: ssh -L {port}:{HOST}:{port} THIS-MACHINE, and open {shown} there"
        )
        if browser and not _open(address):
            note(f"no browser could be opened; open this address in one: {address}")

    serve_page([listening], port, say_address)


def _fragment_of(case: str | None) -> str:
    """Return the part of the address that carries a case; empty without one."""
    if case is None:
        return ""
    from vibroimpact.app.address import fragment_of
    from vibroimpact.app.served_cases import check_table, without_other_work
    from vibroimpact.cases.reader import load_case, load_table, prefix_errors

    load_case(case)
    whole_table = prefix_errors(case, lambda: load_table(case))
    table, left_out = without_other_work(whole_table)
    prefix_errors(case, lambda: check_table(table))
    for sentence in left_out:
        note(sentence)
    return fragment_of(table)


def _listen(host: str, port: int) -> Any:
    """Return a socket that is bound to a port of this machine."""
    if not 0 <= port <= 65535:
        raise InputError(
            f"{port} is not a port; give one from 1 to 65535, or 0 for any that is free", "--port"
        )
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(64)
    except OSError as error:
        listening.close()
        raise InputError(
            f"port {port} can't be used: {error.strerror or error}; is a live page open "
            "already? --port 0 takes any free port"
        ) from None
    return listening


def _open(address: str) -> bool:
    """Open an address in a browser; return whether there is one."""
    import webbrowser

    try:
        return webbrowser.open(address)
    except webbrowser.Error:
        return False
