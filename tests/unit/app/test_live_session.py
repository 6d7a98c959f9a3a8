"""Sessions of the live page: one computation at a time, the last one wins, and nothing
that comes in does harm.
"""

from __future__ import annotations

import asyncio
import json
import random
import time
import tomllib
from collections.abc import Awaitable, Callable
from threading import Event
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.app import saved
from vibroimpact.app import session as sessions
from vibroimpact.app.messages import LONGEST, LONGEST_FILE, read_message
from vibroimpact.app.served_cases import LONGEST_RUN, MOST_IMPACTS, MOST_MODES, MOST_SENSORS
from vibroimpact.app.session import Session
from vibroimpact.app.state import state_of
from vibroimpact.cases.reader import load_table
from vibroimpact.charts.pack import unpack
from vibroimpact.errors import InputError

RIGID = load_table("paper:type1-theory")
PLATE = {
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {
        "size": ["200 mm", "150 mm", "5 mm"],
        "material": "steel",
        "model": "elastic",
        "modes": 6,
        "supports": "simply-supported",
    },
    "drop": {"speed": 1.0},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
}


def changed(table: dict[str, Any], **sections: dict[str, Any]) -> dict[str, Any]:
    return {
        **table,
        **{name: {**table.get(name, {}), **values} for name, values in sections.items()},
    }


def told(talk: Callable[[Session, list[dict[str, Any]]], Awaitable[None]]) -> list[dict[str, Any]]:
    """What a session tells a window while somebody talks to it."""
    heard: list[dict[str, Any]] = []

    async def send(message: bytes) -> None:
        heard.append(unpack(message))

    async def run() -> None:
        session = Session(send)
        work = asyncio.create_task(session.work())
        try:
            # a session that has died answers nothing
            await asyncio.wait_for(talk(session, heard), 120.0)
        finally:
            work.cancel()
            await asyncio.gather(work, return_exceptions=True)

    asyncio.run(run())
    return heard


async def until(heard: list[dict[str, Any]], number: int, *kinds: str) -> dict[str, Any]:
    while not (
        found := [
            one
            for one in heard
            if one["number"] == number and one["type"] in (kinds or ("state", "fault", "files"))
        ]
    ):
        await asyncio.sleep(0.005)
    return found[-1]


def case(number: int, table: Any, detail: str = "full", **more: Any) -> str:
    return json.dumps({"type": "case", "number": number, "case": table, "detail": detail, **more})


def test_a_case_comes_as_the_library_computes_it() -> None:
    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(3, RIGID))
        await until(heard, 3)

    found = told(talk)[-1]
    response = vi.simulate(vi.load_case("paper:type1-theory"))
    line = next(
        trace
        for trace in found["charts"][0]["data"]
        if trace["type"] == "scatter" and trace["mode"] == "lines" and len(trace["x"]) > 9
    )
    assert found["status"] == response.status
    assert line["y"] == pytest.approx(response.history()["position_m"], rel=1e-6, abs=1e-9)
    assert vi.case_of(tomllib.loads(found["toml"])) == vi.load_case("paper:type1-theory")


def test_only_the_charts_that_are_looked_at_are_made() -> None:
    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, RIGID, "draft", charts=["force"]))
        await until(heard, 1)

    found = told(talk)[-1]
    assert [chart["name"] for chart in found["charts"]] == ["force"]
    assert found["names"][:2] == ["position", "force"]


def test_the_last_case_wins(monkeypatch: pytest.MonkeyPatch) -> None:
    """While a draft is computed, cases come; of these the last one alone is computed."""
    computed = []

    def slow(table: dict[str, Any], *_: Any) -> Any:
        computed.append(table["name"])
        time.sleep(0.2)
        return state_of(RIGID, "full", lambda what, part: None)

    monkeypatch.setattr(sessions, "state_of", slow)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        for number in range(1, 6):
            await session.receive(case(number, {**RIGID, "name": str(number)}, "draft"))
            await asyncio.sleep(0.01)
        await until(heard, 5)

    told(talk)
    assert computed == ["1", "5"]


@pytest.mark.parametrize("same", [False, True], ids=["of another plate", "of the same plate"])
def test_modes_are_given_up_for_another_plate_alone(
    same: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    given_up = []

    def modes(
        table: dict[str, Any], detail: str, tell: Callable[[str, float], None], *_: Any
    ) -> Any:
        try:
            for step in range(40):
                tell("computing modes", step / 40)
                time.sleep(0.01)
        except sessions.GivenUp:
            given_up.append(table["name"])
            raise
        return state_of(RIGID, "full", lambda what, part: None)

    monkeypatch.setattr(sessions, "state_of", modes)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, {**PLATE, "name": "first"}, "draft"))
        await until(heard, 1, "progress")
        second = PLATE if same else changed(PLATE, plate={"modes": 7})
        await session.receive(case(2, {**second, "name": "second"}, "draft"))
        await until(heard, 2)

    heard = told(talk)
    assert given_up == ([] if same else ["first"])
    # of what was asked for last
    assert any(one["type"] == "progress" and one["number"] == 2 for one in heard)


def test_cancel_gives_up(monkeypatch: pytest.MonkeyPatch) -> None:
    def long(
        table: dict[str, Any], detail: str, tell: Callable[[str, float], None], *_: Any
    ) -> Any:
        while True:
            tell("computing modes", 0.0)
            time.sleep(0.01)

    monkeypatch.setattr(sessions, "state_of", long)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, RIGID))
        await asyncio.sleep(0.05)
        await session.receive('{"type": "cancel", "number": 1}')
        await until(heard, 1, "cancelled")
        # the case in full waits for the modes that the draft computes: both are given up, and told
        await session.receive(case(2, PLATE, "draft"))
        await asyncio.sleep(0.05)
        await session.receive(case(3, PLATE))
        await session.receive('{"type": "cancel", "number": 3}')
        await until(heard, 2, "cancelled")
        await until(heard, 3, "cancelled")

    told(talk)


def test_a_long_draft_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sessions, "_SHORT", 0.2)

    def long(
        table: dict[str, Any], detail: str, tell: Callable[[str, float], None], *_: Any
    ) -> Any:
        while table["name"] == "long":
            tell("computing the drop", 0.0)
            time.sleep(0.01)
        return state_of(RIGID, "full", lambda what, part: None)

    monkeypatch.setattr(sessions, "state_of", long)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, {**RIGID, "name": "long"}, "draft"))
        await asyncio.sleep(0.3)
        await session.receive(case(2, {**RIGID, "name": "short"}, "draft"))
        await until(heard, 1, "cancelled")
        await until(heard, 2, "state")

    told(talk)


def test_cancel_does_not_wait_for_a_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Further reports wait in order, each of the case that was the last one when it was
    asked for; the cancel overtakes them.
    """
    done = Event()

    def slow(result: Any) -> str:
        assert done.wait(60.0)
        return str(result.name)

    def long_second(
        table: dict[str, Any], detail: str, tell: Callable[[str, float], None], *_: Any
    ) -> Any:
        while table["name"] == "second":
            tell("computing modes", 0.0)
            time.sleep(0.01)
        return state_of(table, "full", lambda what, part: None)

    monkeypatch.setattr(saved, "report_of", lambda result: result)
    monkeypatch.setattr(saved, "page_of_report", slow)
    monkeypatch.setattr(sessions, "state_of", long_second)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, {**RIGID, "name": "first"}))
        await until(heard, 1)
        await session.receive('{"type": "report", "number": 2}')
        await session.receive('{"type": "report", "number": 3}')
        await session.receive(case(4, {**RIGID, "name": "second"}))
        await until(heard, 4, "progress")
        await session.receive('{"type": "cancel", "number": 4}')
        await until(heard, 4, "cancelled")
        await session.receive(case(5, {**RIGID, "name": "third"}))
        await until(heard, 5)
        assert not any(one["type"] == "files" for one in heard)
        done.set()
        for number in (2, 3):
            assert (await until(heard, number))["files"][0]["text"] == "first"

    told(talk)


def test_a_report_that_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(result: Any) -> str:
        raise ZeroDivisionError("by nothing")

    monkeypatch.setattr(saved, "report_of", fails)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, RIGID))
        await until(heard, 1)
        await session.receive('{"type": "report", "number": 2}')
        await until(heard, 2, "fault")
        await session.receive(case(3, RIGID))
        await until(heard, 3, "state")

    told(talk)


def test_a_failure_is_told_and_the_next_case_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(table: dict[str, Any], *rest: Any) -> Any:
        if table["name"] == "bad":
            raise ZeroDivisionError("by nothing")
        return state_of(RIGID, "full", lambda what, part: None)

    monkeypatch.setattr(sessions, "state_of", fails)

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(case(1, {**RIGID, "name": "bad"}))
        await until(heard, 1)
        await session.receive(case(2, {**RIGID, "name": "good"}))
        await until(heard, 2)

    kinds = [one["type"] for one in told(talk)]
    assert kinds == ["fault", "state"]


@pytest.mark.slow
def test_report_and_signals_are_those_of_the_last_case() -> None:
    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive('{"type": "report", "number": 1}')
        await until(heard, 1)
        await session.receive(
            case(
                2,
                changed(
                    {**PLATE, "sensors": [{"name": "a/1", "position": [0.02, 0.0]}]},
                    run={"duration": "2 ms"},
                ),
            )
        )
        await until(heard, 2)
        await session.receive('{"type": "signals", "number": 3}')
        await session.receive('{"type": "report", "number": 4}')
        await until(heard, 4)

    heard = told(talk)
    first, signals, report = heard[0], *(one for one in heard if one["type"] == "files")
    assert first["lines"] == ["nothing was computed in full yet"]
    (file,) = signals["files"]
    assert file["name"] == "a_1.csv"
    assert file["text"].startswith("time_s,acceleration_m_s2\n")
    assert "<!DOCTYPE html>" in report["files"][0]["text"]


@pytest.mark.parametrize(
    "table",
    [
        {"plate": {"mesh": "/etc/passwd"}},
        {"plate": {"mesh": {"file": "/etc/passwd"}}},
        {"plate": {"motion": {"file": "/etc/passwd"}}},
        {"sphere": {"mesh": "../../etc/passwd.bdf"}},
        {"calibrate": {"target": {"file": "/etc/passwd"}}},
        {"calibrate": {"target": "/etc/passwd"}},
        {"sweep": {"points": {"file": "/etc/passwd"}}},
        {"sweep": {"over": {"sphere.radius": {"file": "/etc/passwd"}}}},
    ],
    ids=str,
)
def test_no_file_is_read(table: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    def opened(*names: Any, **_: Any) -> Any:
        raise AssertionError(f"{names} is read")

    monkeypatch.setattr("vibroimpact.files.reading.read_bytes", opened)
    monkeypatch.setattr("vibroimpact.files.reading.read_text", opened)
    monkeypatch.setattr("vibroimpact.files.reading.input_file_digest", opened)
    merged = {
        **RIGID,
        **{name: {**RIGID.get(name, {}), **values} for name, values in table.items()},
    }
    with pytest.raises(InputError, match="live page"):
        state_of(merged, "full", lambda what, part: None)


@pytest.mark.parametrize(
    "source",
    [
        "/etc/passwd",
        "paper:../../../etc/passwd",
        "paper:type3.toml",
        "type3",
        "file:///etc/passwd",
        "",
    ],
)
def test_a_source_is_a_shipped_case(source: str) -> None:
    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        await session.receive(json.dumps({"type": "open", "number": 1, "source": source}))

    (fault,) = told(talk)
    assert fault["type"] == "fault"
    assert "there is no shipped case" in fault["lines"][0]


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (changed(PLATE, plate={"modes": MOST_MODES + 1}), "modes"),
        (changed(PLATE, plate={"mesh": {"element_size": 1e-5}}), ""),
        (changed(PLATE, plate={"element": "solid", "mesh": {"elements": 10_000_000}}), ""),
        (changed(PLATE, sphere={"model": "elastic", "mesh": {"elements_across": 1000}}), ""),
        ({**RIGID, "contact": {"law": "hertz"}, "run": {"impacts": MOST_IMPACTS + 1}}, "impacts"),
        (changed(RIGID, run={"impacts": "all"}, contact={"restitution": 0.999999}), "impacts"),
        (changed(RIGID, run={"duration": f"{2 * LONGEST_RUN} s"}), "run.duration"),
        (
            {
                **PLATE,
                "sensors": [
                    {"name": str(one), "position": [0.0, 0.0]} for one in range(MOST_SENSORS + 1)
                ],
            },
            "sensors",
        ),
        ({**PLATE, "sensors": [{"name": "a", "position": [0.0, 0.0], "rate": "1 GHz"}]}, "samples"),
    ],
    ids=[
        "modes",
        "element size",
        "elements",
        "elements across",
        "impacts",
        "all impacts",
        "duration",
        "sensors",
        "rate",
    ],
)
def test_what_takes_long_is_refused_at_once(table: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as refused:
        state_of(table, "full", lambda what, part: pytest.fail("it is computed"))
    assert words in str(refused.value)


def test_broken_messages_are_answered_by_a_fault() -> None:
    """Two thousand of them, most of which are valid ones with something changed; then a
    case is computed.
    """
    dice = random.Random(21)
    valid = [
        case(1, RIGID),
        '{"type": "open", "number": 1, "source": "paper:type3"}',
        '{"type": "report", "number": 1}',
    ]
    odd = [
        "NaN",
        "1e999",
        '"\\u0000"',
        "[" * 5000,
        "{}",
        "null",
        '{"$": ["f4", 0, 9]}',
        "-1",
        "true",
        '"' + "x" * 9000 + '"',
        "99999999999999999999",
    ]

    def broken() -> str | bytes:
        text = dice.choice(valid)
        match dice.randrange(6):
            case 0:
                return text[: dice.randrange(len(text))]
            case 1:
                return bytes(dice.randrange(256) for _ in range(dice.randrange(200)))
            case 2:
                place = dice.randrange(len(text))
                return text[:place] + dice.choice(odd) + text[place + dice.randrange(30) :]
            case 3:
                found = json.loads(text)
                found[
                    dice.choice(["type", "number", "case", "detail", "charts", "source", "extra"])
                ] = json.loads(dice.choice(odd[4:]))
                return json.dumps(found)
            case 4:
                found = json.loads(valid[0])
                found["case"][dice.choice(list(found["case"]))] = json.loads(dice.choice(odd[4:]))
                return json.dumps(found)
            case _:
                return dice.choice(odd)

    messages = [broken() for _ in range(2000)]
    refused = 0
    for message in messages:
        try:
            read_message(message)
        except InputError:
            refused += 1
    assert refused > 1000

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        for message in messages:
            await session.receive(message)
        await session.receive(case(10**6, RIGID))
        await until(heard, 10**6)

    heard = told(talk)
    assert heard[-1]["type"] == "state"
    assert {one["type"] for one in heard} <= {
        "fault",
        "state",
        "opened",
        "files",
        "cancelled",
        "progress",
    }


def test_a_message_has_a_largest_size() -> None:
    with pytest.raises(InputError, match="bytes"):
        read_message(" " * (LONGEST + 1))


def measurement(number: int, name: str, content: bytes) -> bytes:
    line = json.dumps({"type": "measurement", "number": number, "name": name})
    return b"\0" + line.encode() + b"\n" + content


def test_a_measurement_is_kept_until_it_is_forgotten() -> None:
    """It comes once, and lies over each case that is computed after it."""
    rows = [f"{1e-5 * row!r},{max(0.0, 100.0 - (row - 50) ** 2)!r}" for row in range(100)]
    content = "\n".join(["time [s],force [N]", *rows]).encode()

    def ask(kind: str, number: int, **more: str) -> str:
        return json.dumps({"type": kind, "number": number, **more})

    async def talk(session: Session, heard: list[dict[str, Any]]) -> None:
        kinds = ("overlay", "fault", "files")
        await session.receive(ask("overlay", 1))
        await until(heard, 1, *kinds)
        await session.receive(case(2, RIGID))
        await until(heard, 2)
        await session.receive(measurement(3, "../hammer.csv", content))
        await until(heard, 3, *kinds)
        await session.receive(case(4, changed(RIGID, drop={"height": 1.0})))
        await until(heard, 4)
        await session.receive(ask("overlay", 5))
        await until(heard, 5, *kinds)
        await session.receive(ask("figure", 6, chart="record", format="svg"))
        await until(heard, 6, *kinds)
        await session.receive(ask("forget", 7))
        await session.receive(ask("overlay", 8))
        await until(heard, 8, *kinds)

    heard = {one["number"]: one for one in told(talk) if one["type"] != "progress"}
    assert heard[1]["lines"] == ["no measurement is open; drop its file on the page"]
    assert heard[3]["name"] == "hammer.csv"
    (before,), (after,) = heard[3]["tables"][0]["rows"], heard[5]["tables"][0]["rows"]
    assert before[1] == after[1] == "100.0"
    assert float(after[2]) < 0.6 * float(before[2])
    assert heard[6]["files"][0]["name"].endswith("-record.svg")
    assert heard[8]["lines"] == heard[1]["lines"]


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (b"\0", "the message is not JSON"),
        (measurement(1, "a" * 3000, b""), "the line ahead of a file is too long"),
        (b'\0{"type": "case", "case": {}}\n', "a message is a table with a type: measurement"),
        (b'\0{"type": "measurement"}\n', "a message of type measurement has a name"),
        (b'\0{"type": "measurement", "name": 3}\n', "name of a message must be a text"),
        (b'{"type": "figure", "chart": "force"}', "a message of type figure has a format"),
        (
            measurement(1, "/tmp/hammer.csv", bytes(LONGEST_FILE + 1)),
            "hammer.csv: the file has 16000001 bytes, more than the 16000000 of the live page; keep",
        ),
    ],
    ids=["no line", "long line", "another type", "no name", "a number", "no format", "large"],
)
def test_a_message_with_a_file_is_one_of_the_protocol(message: bytes, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read_message(message)
    assert str(refused.value).startswith(words)
