"""The server of the live page: for this machine alone, and what `vibroimpact serve` says
when it can't serve.
"""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, suppress
from http.client import HTTPConnection
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from live_page import ELASTIC
from serving import Server
from vibroimpact.app.address import fragment_of
from vibroimpact.app.messages import LONGEST, LONGEST_OF_ALL
from vibroimpact.app.server import MOST_WINDOWS
from vibroimpact.cases.reader import load_table
from vibroimpact.charts.pack import unpack


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    with Server() as running:
        yield running


def asked(server: Server, path: str, **headers: str) -> tuple[int, dict[str, str], str]:
    with closing(HTTPConnection("127.0.0.1", server.port, timeout=60)) as connection:
        connection.putrequest("GET", path, skip_host=True)
        for name, value in {"Host": f"127.0.0.1:{server.port}", **headers}.items():
            connection.putheader(name, value)
        connection.endheaders()
        with connection.getresponse() as answer:
            return answer.status, dict(answer.getheaders()), answer.read().decode()


def test_the_page_loads_what_is_its_own_alone(server: Server) -> None:
    status, headers, page = asked(server, "/")
    assert status == 200
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe-eval" not in policy
    assert f"connect-src 'self' ws://127.0.0.1:{server.port};" in policy
    assert "http" not in page.replace("http-equiv", "")


@pytest.mark.parametrize(
    "host",
    [
        "example.org",
        "127.0.0.1",
        "127.0.0.1:1",
        "localhost.example.org:{port}",
        "0.0.0.0:{port}",
        "",
    ],
)
def test_another_host_is_refused(host: str, server: Server) -> None:
    status, _, words = asked(server, "/", Host=host.format(port=server.port))
    assert status in (400, 403)
    assert "<html" not in words


@pytest.mark.parametrize(
    "path",
    [
        "/scripts/../server.py",
        "/scripts/%2e%2e/server.py",
        "/scripts/live.py",
        "/etc/passwd",
        "/live",
        "/scripts/",
    ],
)
def test_there_are_no_other_files(path: str, server: Server) -> None:
    status, _, words = asked(server, path)
    assert status in (404, 405)
    assert "import" not in words


@pytest.mark.parametrize(
    "origin",
    [
        "http://example.org",
        "https://127.0.0.1:{port}",
        "http://127.0.0.1:1",
        "null",
        "http://localhost.example.org:{port}",
    ],
)
def test_another_origin_is_refused(origin: str, server: Server) -> None:
    with pytest.raises(InvalidStatus):
        connect(f"ws://127.0.0.1:{server.port}/live", origin=origin.format(port=server.port))  # type: ignore[arg-type]


def test_a_program_without_an_origin_is_refused(server: Server) -> None:
    with pytest.raises(InvalidStatus):
        connect(f"ws://127.0.0.1:{server.port}/live")


def window(server: Server):  # type: ignore[no-untyped-def]
    return connect(
        f"ws://127.0.0.1:{server.port}/live",
        origin=f"http://127.0.0.1:{server.port}",
        max_size=None,
    )  # type: ignore[arg-type]


def test_a_window_is_welcomed_and_served(server: Server) -> None:
    with window(server) as socket:
        welcome = unpack(socket.recv())
        assert (welcome["type"], welcome["longest"]) == ("welcome", LONGEST)
        socket.send(json.dumps({"type": "open", "number": 1, "source": "paper:type1-theory"}))
        case = unpack(socket.recv())["case"]
        socket.send(json.dumps({"type": "case", "number": 2, "case": case}))
        answers = iter(lambda: unpack(socket.recv()), None)
        # which a busy machine tells
        state = next(one for one in answers if one["type"] != "progress")
        assert state["status"].startswith("Stopped after 5 impacts")


def test_a_message_that_is_too_long_ends_the_window_alone(server: Server) -> None:
    with window(server) as socket:
        socket.recv()
        # the server may close while it is sent
        with suppress(ConnectionClosed):
            socket.send(" " * (LONGEST_OF_ALL + 1))
        with pytest.raises(ConnectionClosed):
            socket.recv()
    test_a_window_is_welcomed_and_served(server)


def test_there_is_a_largest_number_of_windows(server: Server) -> None:
    with ExitStack() as open_ones:
        for _ in range(MOST_WINDOWS):
            open_ones.enter_context(window(server)).recv()
        with window(server) as one_more, pytest.raises(ConnectionClosed) as closed:
            one_more.recv()
        assert f"there are {MOST_WINDOWS} windows already" in str(closed.value)


def serve(*arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    command = [
        sys.executable,
        *more.get("options", "").split(),
        "-m",
        "vibroimpact",
        "serve",
        "--no-browser",
        *arguments,
    ]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=300, cwd=more.get("folder")
    )


def test_a_port_in_use(server: Server) -> None:
    found = serve("--port", str(server.port))
    assert found.returncode == 2
    assert f"port {server.port} can't be used" in found.stderr
    assert "--port 0" in found.stderr


def test_a_port_that_is_none() -> None:
    found = serve("--port", "70000")
    assert found.returncode == 2
    assert "70000 is not a port" in found.stderr


def test_a_case_that_is_none() -> None:
    found = serve("paper:type9")
    assert found.returncode == 2
    assert "there is no shipped case" in found.stderr


def test_who_opens_the_page_is_told_the_address_with_the_case() -> None:
    with Server("paper:type1-theory") as other:
        assert (
            other.said == "the live page is at "
            f"{other.address}{fragment_of(load_table('paper:type1-theory'))}; Ctrl-C ends it\n"
        )


def test_without_the_extra(tmp_path: Path) -> None:
    """A module of this name in the folder that is looked into first stands for one that
    is not installed.
    """
    (tmp_path / "starlette.py").write_text(
        "raise ModuleNotFoundError(\"No module named 'starlette'\", name='starlette')\n"
    )
    found = serve(folder=str(tmp_path))
    assert found.returncode == 2
    assert 'pip install "vibroimpact[app]"' in found.stderr
    assert "Traceback" not in found.stderr


def test_it_is_bound_to_this_machine(server: Server) -> None:
    for family, *_, address in socket.getaddrinfo(
        socket.gethostname(), server.port, type=socket.SOCK_STREAM
    ):
        if address[0].startswith("127.") or address[0] == "::1":
            continue
        with socket.socket(family, socket.SOCK_STREAM) as other:
            other.settimeout(2.0)
            assert other.connect_ex(address) != 0


@pytest.mark.slow
def test_ctrl_c_ends_it_whoever_does_not_read_and_whatever_it_computes() -> None:
    """A client that never reads a script, and a window whose modes take a minute: neither
    holds the server.
    """
    plate = {**ELASTIC["plate"], "modes": 60, "mesh": {"element_size": "5 mm"}}
    with Server() as server, ExitStack() as clients:
        deaf = clients.enter_context(socket.socket())
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        deaf.connect(("127.0.0.1", server.port))
        deaf.sendall(
            f"GET /scripts/plotly.js HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode()
        )
        address = f"ws://127.0.0.1:{server.port}/live"
        window = clients.enter_context(
            connect(address, origin=f"http://127.0.0.1:{server.port}", max_size=None)
        )
        window.send(
            json.dumps(
                {"type": "case", "number": 1, "case": {**ELASTIC, "plate": plate}, "detail": "full"}
            )
        )
        time.sleep(1.0)  # so that it computes, or has begun to
        server.stopped = True
        server.process.send_signal(signal.SIGINT)
        try:
            # about a second; a guard against a hang
            wrote = server.process.communicate(timeout=20)[1]
        finally:
            server.process.kill()
        assert server.process.returncode == 130
        assert "Traceback" not in wrote
