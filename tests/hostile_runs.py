"""Run a function on many hostile inputs, each within a limit of processor time and
memory, in a process that may die of them.
"""

from __future__ import annotations

import os
import resource
import signal
import traceback
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from multiprocessing.connection import Pipe
from typing import Any

import numpy as np

from vibroimpact.bodies.body import Body
from vibroimpact.contact.friction.laws.coulomb import Coulomb
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.tabulate import tabulate
from vibroimpact.errors import VibroimpactError
from vibroimpact.structures.modal_model import ModalBasis

SECONDS = 10
"""Of processor time, for one input."""

MEMORY = 1_000_000_000
"""Bytes of address space more than at the start."""

WAITING = 300.0
"""Seconds after which an input that computes nothing is taken to wait for ever; the
machine may be busy.
"""

LONGEST = 500
"""Characters of a message: of all its lines."""

LINES = 12
"""Of a message: there may be one for each fault, but not a screen of them."""


@dataclass(frozen=True)
class Outcome:
    """What came of one input: "accepted", "refused" (a message), or one of the failures
    "traceback", "hung", "memory", "message".
    """

    kind: str
    text: str = ""

    @property
    def failed(self) -> bool:
        return self.kind not in ("accepted", "refused")


def number(few: int) -> int:
    """Return how many inputs a test tries: a few, times VIBROIMPACT_FUZZ where it is set."""
    return max(1, round(few * float(os.environ.get("VIBROIMPACT_FUZZ", "1"))))


def seed(given: int) -> int:
    """Return a seed of random numbers: the one given, or where VIBROIMPACT_SEED is set
    another, for inputs not met before.
    """
    return given + 1_000_003 * int(os.environ.get("VIBROIMPACT_SEED", "0"))


@cache
def make_ready() -> None:
    """Load what calibrations and their reports are made with, and compute a drop on a rigid and
    on an elastic plate with its history and oblique impacts, so that no input's process loads or
    compiles them.
    """
    import_module("vibroimpact.calibration.calibrate_case")
    import_module("vibroimpact.calibration.report")
    modes = ModalBasis(np.array([200.0]), np.array([0.01]), np.array([0.5]), np.zeros((1, 3)))
    law = find_contact_law("hertz")(stiffness=1e9)
    sphere = Body(mass=0.1, contact_offset=0.02)
    for plate in (
        Body(mass=np.inf, contact_offset=0.0),
        Body(mass=np.inf, contact_offset=0.0, modes=modes),
    ):
        simulate(Problem(laws=(law,), sphere=sphere, plate=plate, speed=1.0, impacts=1)).history()
    oblique = Oblique(velocity=(0.5, 0.0), friction=Coulomb(coefficient=0.1))
    for oblique_law in (law, Newton(restitution=np.full(1000, 0.5))):
        tabulate(
            Problem(
                laws=(oblique_law,),
                sphere=sphere,
                plate=Body(mass=np.inf, contact_offset=0.0),
                oblique=oblique,
                speed=1.0,
                impacts=1,
            )
        )


def attack(function: Callable[[Any], object], inputs: Sequence[Any]) -> list[Outcome]:
    """Return what came of each input: of a hang or a crash too, which end the process
    that works on it and no other.
    """
    make_ready()
    outcomes: list[Outcome] = []
    while len(outcomes) < len(inputs):
        outcomes += _in_a_child(function, inputs[len(outcomes) :])
    return outcomes


def failures(function: Callable[[Any], object], inputs: Iterable[Any]) -> str:
    """Return what failed, a paragraph an input, and the counts; "" if nothing did."""
    inputs = list(inputs)
    outcomes = attack(function, inputs)
    print(dict(Counter(one.kind for one in outcomes)))
    bad = [
        f"{one.kind}: {one.text}\n    of {given!r:.2000}"
        for given, one in zip(inputs, outcomes, strict=True)
        if one.failed
    ]
    return "\n".join([f"{len(bad)} of {len(inputs)} failed", *bad[:20]]) if bad else ""


def _in_a_child(function: Callable[[Any], object], inputs: Sequence[Any]) -> list[Outcome]:
    """Work on inputs until all are done or one kills the process, which is the last of
    those returned.
    """
    mine, theirs = Pipe(duplex=False)
    child = os.fork()
    if child == 0:  # never returns into the test
        try:
            os.setsid()
            mine.close()
            _bound_memory()
            for given in inputs:
                _bound_time()
                theirs.send(_outcome(function, given))
        finally:
            os._exit(0)
    theirs.close()
    outcomes: list[Outcome] = []
    with mine, suppress(EOFError):
        while len(outcomes) < len(inputs) and mine.poll(WAITING):
            outcomes.append(mine.recv())
    with suppress(ProcessLookupError):
        # what waits for ever, and what a hostile input has started
        os.killpg(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    if len(outcomes) < len(inputs):
        died = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        outcomes.append(
            Outcome(
                "hung" if died in (signal.SIGXCPU, signal.SIGKILL) else "traceback",
                f"the process ended by signal {died}",
            )
        )
    return outcomes


def _outcome(function: Callable[[Any], object], given: Any) -> Outcome:
    try:
        function(given)
    except VibroimpactError as error:
        return _judged(str(error))
    except MemoryError:
        return Outcome("memory", traceback.format_exc()[-1500:])
    except BaseException:
        return Outcome("traceback", traceback.format_exc()[-1500:])
    return Outcome("accepted")


def _judged(message: str) -> Outcome:
    """Hold a message to what a terminal and a reader can take."""
    lines = message.split("\n")
    if (
        not message.strip()
        or len(lines) > LINES
        or len(message) > LONGEST
        or not all(line.isprintable() for line in lines)
    ):
        return Outcome("message", message[:2000])
    return Outcome("refused", message)


def _bound_time() -> None:
    used = resource.getrusage(resource.RUSAGE_SELF)
    resource.setrlimit(
        resource.RLIMIT_CPU,
        (int(used.ru_utime + used.ru_stime) + SECONDS + 1, resource.RLIM_INFINITY),
    )


def _bound_memory() -> None:
    with open("/proc/self/statm") as file:
        pages = int(file.read().split()[0])
    most = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
