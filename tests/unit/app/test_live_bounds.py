"""What the live page refuses, and how little it takes to know: bounds on cases and
messages, and the names of its server.
"""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.app.messages import LONGEST, read_message
from vibroimpact.app.offer import offer
from vibroimpact.app.served_cases import MOST_MODES, MOST_NODES, check_bounds, check_table
from vibroimpact.app.server import application
from vibroimpact.app.session import Session
from vibroimpact.cases import costs
from vibroimpact.cases.reader import load_table
from vibroimpact.charts.pack import unpack
from vibroimpact.errors import InputError
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids, SphereOfSolids

RIGID = load_table("paper:type1-theory")
BALL = {"radius": "10 mm", "material": "steel"}
PLATE = {
    "size": ["200 mm", "150 mm", "5 mm"],
    "material": "steel",
    "model": "elastic",
    "supports": "simply-supported",
}
PATCHES = [
    {"type": "patch", "position": [0.005 * x, 0.005 * y], "radius": "2 mm"}
    for x in range(-10, 11, 2)
    for y in range(-10, 11, 2)
]


def a_case(
    sphere: dict[str, Any] | None = None, plate: dict[str, Any] | None = None, **sections: Any
) -> vi.Case:
    table = {
        "sphere": {**BALL, **(sphere or {})},
        "plate": {**PLATE, **(plate or {})},
        "drop": {"speed": 1.0},
        "contact": {"law": "hertz"},
    }
    return vi.case_of({**table, **sections})


@pytest.fixture
def no_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    for shape in (SphereOfSolids, PlateOfPlates, PlateOfSolids):
        monkeypatch.setattr(shape, "mesh", lambda *_: pytest.fail("a mesh is made"))


@pytest.mark.usefixtures("no_mesh")
@pytest.mark.parametrize(
    ("case", "key", "what"),
    [
        ({"plate": {"max_frequency": "200 kHz"}}, "plate.max_frequency", "modes"),
        ({"plate": {"max_frequency": 1e50}}, "plate.max_frequency", "modes"),
        (
            {"plate": {"max_frequency": "200 kHz", "element": "solid"}},
            "plate.max_frequency",
            "modes",
        ),
        (
            {"sphere": {"model": "elastic", "max_frequency": "1 MHz"}},
            "sphere.max_frequency",
            "modes",
        ),
        ({"sphere": {"model": "elastic", "modes": MOST_MODES + 1}}, "sphere.modes", "modes"),
        (
            {"sphere": {"model": "elastic", "mesh": {"elements_across": 100}}},
            "sphere.mesh",
            "nodes",
        ),
        ({"sphere": {"model": "elastic", "mesh": {"grading": 50.0}}}, "sphere.mesh", "nodes"),
        ({"plate": {"mesh": {"element_size": 1e-4}}}, "plate.mesh", "nodes"),
        (
            {"plate": {"size": [1e6, 1e-6, 1e-6], "mesh": {"element_size": 1.0}}},
            "plate.mesh",
            "nodes",
        ),
        ({"plate": {"element": "solid", "mesh": {"layers": 10**9}}}, "plate.mesh", "nodes"),
        ({"plate": {"supports": PATCHES}}, "plate.mesh", "nodes"),
    ],
    ids=str,
)
def test_bodies_that_are_too_large_are_refused_before_they_are_meshed(
    case: dict[str, Any], key: str, what: str
) -> None:
    most = {"modes": MOST_MODES, "nodes": MOST_NODES}[what]
    with pytest.raises(
        InputError,
        match=rf"^{key}: \S+ {what} are more than the {most:,} of the live page; vibroimpact "
        r"run takes more$",
    ):
        check_bounds(a_case(**case))


def test_modes_up_to_a_frequency_may_be_few() -> None:
    check_bounds(a_case(plate={"max_frequency": "5 kHz"}))


def watched(rate: str, **sections: Any) -> vi.Case:
    sensors = [{"name": str(one), "position": [0.0, 0.0], "rate": rate} for one in range(8)]
    return a_case(sensors=sensors, plate={"modes": 6}, **sections)


def test_samples_are_those_of_the_expected_length() -> None:
    """Of ten seconds, which was a guess once, the first would have 16 million samples,
    the second 0.4 million.
    """
    check_bounds(watched("200 kHz", run={"impacts": 2}))
    with pytest.raises(InputError, match=r"sensors: \S+ samples in all are more"):
        check_bounds(
            watched(
                "5 kHz",
                drop={"height": "4 m"},
                contact={"law": "newton", "restitution": 0.999},
                run={"impacts": 300},
            )
        )


def test_many_impacts_that_soon_end_have_few_samples() -> None:
    bounce = {"drop": {"height": "4 m"}, "contact": {"law": "newton", "restitution": 0.5}}
    check_bounds(watched("50 kHz", **bounce, run={"impacts": 30}))


def test_no_contact_is_integrated_where_few_impacts_are_allowed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        costs, "achieved_restitution", lambda *_: pytest.fail("a contact is integrated")
    )
    check_bounds(vi.load_case("paper:type1-variable"))
    check_bounds(watched("5 kHz", run={"impacts": 5}))


def test_a_contact_is_integrated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    integrated = []

    def counted(*arguments: Any) -> Any:
        integrated.append(arguments)
        return vi.laws.achieved_restitution(*arguments)

    monkeypatch.setattr(costs, "achieved_restitution", counted)
    check_bounds(vi.load_case("paper:type1-variable", {"run.impacts": "all"}))
    assert len(integrated) == 1


def test_a_message_is_measured_in_bytes() -> None:
    message = json.dumps(
        {"type": "open", "number": 1, "text": "€" * (LONGEST // 2)}, ensure_ascii=False
    )
    assert len(message) < LONGEST < len(message.encode())
    with pytest.raises(InputError, match=f"the message has {len(message.encode())} bytes"):
        read_message(message)
    assert read_message(message[: LONGEST // 4] + '"}').content


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ({**RIGID, "sphere": None}, "sphere"),
        ({**RIGID, "drop": {**RIGID["drop"], "speed": None}}, "drop.speed"),
        (
            {**RIGID, "contact": {**RIGID["contact"], "restitution": [0.5, None]}},
            "contact.restitution (the 2nd)",
        ),
        ({**RIGID, "sensors": [{"name": None}]}, "sensors.name"),
    ],
    ids=["section", "key", "list", "table in a list"],
)
def test_null_is_refused_in_one_sentence(table: dict[str, Any], key: str) -> None:
    with pytest.raises(InputError) as refused:
        check_table(table)
    assert refused.value.lines == (f"{key}: null is not a value of a case; leave it out",)


def answers(*messages: str) -> list[dict[str, Any]]:
    """What a window is told while its messages are not waited for."""
    heard: list[dict[str, Any]] = []

    async def send(message: bytes) -> None:
        heard.append(unpack(message))

    async def talk() -> None:
        session = Session(send)
        work = asyncio.create_task(session.work())
        for message in messages:
            await session.receive(message)
        while len(heard) < len(messages):
            await asyncio.sleep(0.005)
        work.cancel()
        await asyncio.gather(work, return_exceptions=True)

    asyncio.run(asyncio.wait_for(talk(), 60.0))
    return heard


@pytest.mark.parametrize("depth", [30, 90, 200, 900, 980, 5000, 90_000])
def test_deep_nesting_is_refused_in_one_sentence(depth: int) -> None:
    (found,) = answers(
        '{"type": "case", "number": 7, "case": {"sphere": ' + "[" * depth + "]" * depth + "}}"
    )
    assert found["type"] == "fault"
    (line,) = found["lines"]
    assert "deep in one another" in line
    assert found["number"] == (7 if depth < 100 else 0)


def test_half_of_a_surrogate_pair_is_refused_and_the_window_goes_on() -> None:
    broken, whole = (
        json.dumps({"type": "open", "number": 1, "text": f'name = "{text}"'})
        for text in ("\ud800", "\U0001f600")
    )
    first, second = answers(broken, whole)
    assert first["lines"] == ["the message is not JSON"]
    assert second["case"] == {"name": "\U0001f600"}


def test_the_offer_is_made_once() -> None:
    assert offer() is offer()


@pytest.mark.parametrize(
    ("port", "host", "status"),
    [
        (80, "localhost", 200),
        (80, "127.0.0.1", 200),
        (80, "[::1]", 200),
        (80, "127.0.0.1:80", 200),
        (80, "example.org", 403),
        (80, "127.0.0.1:8421", 403),
        (8421, "127.0.0.1:8421", 200),
        (8421, "127.0.0.1", 403),
        (8421, "127.0.0.1:80", 403),
    ],
)
def test_a_host_without_a_port_is_that_of_port_80(port: int, host: str, status: int) -> None:
    answered = asked(port, {"type": "http", "method": "GET"}, host)
    assert answered[0]["status"] == status


@pytest.mark.parametrize(
    ("port", "origin", "answer"),
    [(80, "http://localhost", "accept"), (8421, "http://localhost", "close")],
)
def test_an_origin_without_a_port_is_that_of_port_80(port: int, origin: str, answer: str) -> None:
    answered = asked(port, {"type": "websocket", "subprotocols": []}, f"localhost:{port}", origin)
    assert answered[0]["type"] == f"websocket.{answer}"


def asked(port: int, scope: dict[str, Any], host: str, origin: str = "") -> list[Any]:
    """What the application answers at a port."""
    received = iter(
        [
            {"type": "websocket.connect"}
            if scope["type"] == "websocket"
            else {"type": "http.request"}
        ]
    )
    answered: list[Any] = []

    async def receive() -> Any:
        return next(received, {"type": f"{scope['type']}.disconnect", "code": 1000})

    async def send(message: Any) -> None:
        answered.append(message)

    path = "/live" if scope["type"] == "websocket" else "/"
    headers = [(b"host", host.encode()), (b"origin", origin.encode())]
    place = {
        "path": path,
        "raw_path": path.encode(),
        "root_path": "",
        "query_string": b"",
        "headers": headers,
    }
    asyncio.run(application(port)({**scope, **place}, receive, send))  # type: ignore[arg-type]
    return answered
