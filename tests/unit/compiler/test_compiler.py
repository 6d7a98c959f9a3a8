"""Compiled functions: equal to interpreted ones, kept on the disk whatever happens to it,
and none where there is no compiler.
"""

from __future__ import annotations

import importlib
import os
import pickle
import pkgutil
import signal
import subprocess
import sys
import time
import warnings
from collections import namedtuple
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, TypeVar

import numpy as np
import pytest

import vibroimpact as vi
import vibroimpact.dynamics.core
from vibroimpact.arrays import Vector
from vibroimpact.compiled import (
    SWITCH,
    Address,
    compiled,
    force_at,
    law_addresses,
    law_coefficients,
    why_not_compiled,
)
from vibroimpact.compiler import code_store, deferred, notice
from vibroimpact.compiler.code_store import PLACE, load_code, save_code
from vibroimpact.compiler.deferred import DeferredFunction
from vibroimpact.compiler.digest import Digest
from vibroimpact.compiler.marks import DEFERRED
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley

needs_compiler = pytest.mark.skipif(bool(why_not_compiled()), reason=why_not_compiled())

_CALLEE = """
FACTOR = 2.0


def scaled(value):
    return FACTOR * value
"""

_MODULE = """
import sys

import numpy as np

from callee import scaled
from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled, scalar

scalar(scaled)


@compiled
def total(values: Vector) -> float:
    answer = 0.0
    for value in values:
        answer += scaled(value)
    return answer


@compiled
def twice(values: Vector) -> float:
    return 2.0 * total(values)


print(twice(np.arange(4.0)))
if hasattr(twice, "compiled") and twice.compiled is not twice.py_func:
    print("loaded" if twice.compiled._cache_hits else "compiled")
"""


_LAWS = """
import sys

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import Address, compiled, force_at, law_addresses, law_coefficients, law_function
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import find_contact_law


@compiled
def static_force(address: Address, delta: float, coefficients: Vector) -> float:
    force = force_at(address)
    return force(delta, 0.0, 1.0, coefficients)[0]


PAIR = ContactPair(effective_modulus=1e11, effective_radius=0.01, effective_mass=0.1, yield_strength=3e8, poissons_ratio=0.3)
laws = [find_contact_law(name).example(PAIR) for name in sys.argv[1:]]
for law in laws:
    law_function(type(law))
for law in laws:
    coefficients = law_coefficients(law)
    delta = 3.0 * law.yield_indentation
    expected = type(law).scalar_forces(delta, 0.0, 1.0, coefficients)[0]
    print(np.isclose(static_force(law_addresses(type(law))[0], delta, coefficients), expected, rtol=1e-12, atol=0.0))
"""


class Toy:
    """A program with a compiled function, which calls one of another file.

    Parameters
    ----------
    folder : Path
        An empty folder, for the program and the code that it compiles.
    """

    def __init__(self, folder: Path) -> None:
        self.code = folder / "code"
        self.callee = folder / "callee.py"
        self.callee.write_text(_CALLEE)
        self.program = folder / "toy.py"
        self.program.write_text(_MODULE)
        self.environment = {**os.environ, PLACE: str(self.code)}

    def start(self, **environment: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, str(self.program)],
            env=self.environment | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, **environment: str) -> list[str]:
        return printed(self.start(**environment))

    def files(self) -> list[Path]:
        return sorted(self.code.glob("*/*"))


def printed(process: subprocess.Popen[str]) -> list[str]:
    out, errors = process.communicate(timeout=120)
    assert (process.returncode, errors) == (0, "")
    return out.split()


@pytest.fixture
def toy(tmp_path: Path) -> Toy:
    return Toy(tmp_path)


@compiled
def work_of_law(steps: int, address: Address, coefficients: Vector) -> float:
    force = force_at(address)
    total = 0.0
    for step in range(steps):
        static, dissipative = force(1e-4 * step, 1.0, 2.0, coefficients)
        total += static + dissipative
    return total


def work_of_arrays(law: vi.laws.ContactLaw) -> float:
    static, dissipative = law.forces(1e-4 * np.arange(10), np.ones(10), 2.0 * np.ones(10))  # type: ignore[attr-defined]
    return float(np.sum(static + dissipative))


@compiled
def largest_of(values: Vector) -> float:
    answer = values[0]
    for value in values:
        answer = max(answer, value)
    return answer


# laws


@pytest.mark.parametrize(
    "law",
    [HuntCrossley(stiffness=1e9, restitution=0.6), Hertz(stiffness=1e9)],
    ids=lambda law: law.name,
)
def test_a_law_is_called_by_value_and_by_address(law: vi.laws.ContactLaw) -> None:
    expected = pytest.approx(work_of_arrays(law), rel=1e-14)
    assert work_of_law(10, law_addresses(type(law))[0], law_coefficients(law)) == expected


@dataclass(frozen=True, kw_only=True)
class OfArrays(Hertz):
    """A law of another package that has no force of floats."""

    name = "of-arrays"

    def forces(
        self, delta: np.ndarray, delta_dot: np.ndarray, approach_speed: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        static, dissipative = super().forces(delta, delta_dot, approach_speed)
        return static, dissipative + 0.1 * delta_dot


def of_dictionaries(
    delta: Any, delta_dot: Any, approach_speed: Any, coefficients: Any
) -> tuple[Any, Any]:
    forces = dict.fromkeys(("static", "dissipative"), coefficients[0] * delta)
    return forces["static"], dict(**forces)["dissipative"]


@dataclass(frozen=True, kw_only=True)
class NotCompilable(Hertz):
    """A law of another package whose force numba refuses."""

    name = "not-compilable"
    scalar_forces = staticmethod(of_dictionaries)


@needs_compiler
@pytest.mark.parametrize(
    "law", [OfArrays(stiffness=1e9), NotCompilable(stiffness=1e9)], ids=lambda law: law.name
)
def test_a_law_that_is_not_compiled_is_called_and_says_so_once(law: vi.laws.ContactLaw) -> None:
    with pytest.warns(
        vi.errors.SlowLawWarning,
        match=f"the law {law.name} is not compiled, and its force takes microseconds",
    ):
        address = law_addresses(type(law))[0]
    coefficients = law_coefficients(law)
    expected = pytest.approx(work_of_arrays(law), rel=1e-14)
    assert work_of_law(10, address, coefficients) == expected
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert work_of_law(10, law_addresses(type(law))[0], coefficients) == expected
    with ThreadPoolExecutor(4) as threads:
        assert set(threads.map(lambda _: work_of_law(500, address, coefficients), range(8))) == {
            work_of_law(500, address, coefficients)
        }


@dataclass(frozen=True, kw_only=True)
class Failing(Hertz):
    """A law whose force raises."""

    name = "failing"

    def forces(
        self, delta: np.ndarray, delta_dot: np.ndarray, approach_speed: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        raise vi.InputError("no force")


@needs_compiler
def test_an_error_of_a_law_reaches_the_caller() -> None:
    law = Failing(stiffness=1.0)
    with pytest.warns(vi.errors.SlowLawWarning):
        address = law_addresses(Failing)[0]
    with pytest.raises(vi.InputError, match="no force"):
        work_of_law(10, address, law_coefficients(law))


# on the disk


@needs_compiler
def test_code_is_loaded_by_the_next_process(toy: Toy) -> None:
    assert toy.run() == ["24.0", "compiled"]
    assert toy.run(PYTHONHASHSEED="7") == ["24.0", "loaded"]


@pytest.mark.slow
@needs_compiler
def test_a_large_function_is_called_by_its_symbol(toy: Toy) -> None:
    toy.program.write_text(
        "from vibroimpact.compiler import symbols\nsymbols.LARGE = 1\n" + _MODULE
    )
    assert toy.run() == ["24.0", "compiled"]
    (caller,), (callee,) = (
        [path for path in toy.files() if path.name.startswith(name)] for name in ("twice", "total")
    )
    assert toy.run() == ["24.0", "loaded"]
    callee.unlink()  # the caller needs it, so that it is compiled again, under the same symbol
    assert toy.run() == ["24.0", "loaded"]
    assert callee.exists()
    callee.write_bytes(b"damaged")
    assert toy.run() == ["24.0", "loaded"]
    toy.callee.write_text(_CALLEE.replace("2.0", "3.0"))
    assert toy.run() == ["36.0", "compiled"]
    assert caller.exists()


@pytest.mark.slow
def test_functions_of_one_name_from_several_processes_are_told_apart(tmp_path: Path) -> None:
    """Two laws made by one function that makes functions, compiled apart and loaded together."""
    program = tmp_path / "laws.py"
    program.write_text(_LAWS)
    environment = {**os.environ, PLACE: str(tmp_path / "code")}

    def run(*laws: str) -> list[str]:
        return subprocess.run(
            [sys.executable, str(program), *laws],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            timeout=300,
        ).stdout.split()

    assert run("thornton") == ["True"]
    assert run("storakers") == ["True"]
    assert run("thornton", "storakers") == ["True", "True"]


@pytest.mark.slow
@needs_compiler
def test_an_edited_callee_or_constant_is_compiled_anew(toy: Toy) -> None:
    assert toy.run() == ["24.0", "compiled"]
    toy.callee.write_text(_CALLEE.replace("FACTOR = 2.0", "FACTOR = 3.0"))
    assert toy.run() == ["36.0", "compiled"]
    toy.callee.write_text(f'"""What it is."""\n{_CALLEE}')
    assert toy.run() == ["24.0", "loaded"]


@pytest.mark.slow
@needs_compiler
def test_a_damaged_file_is_replaced(toy: Toy) -> None:
    toy.run()
    for path in toy.files():
        path.write_bytes(path.read_bytes()[:-1000])
    assert toy.run() == ["24.0", "compiled"]
    assert toy.run() == ["24.0", "loaded"]


@pytest.mark.parametrize(
    "damage",
    [lambda data: data[:500], lambda data: b"", lambda data: data[:99] + b"+" + data[100:]],
)
def test_damage_is_seen(tmp_path: Path, damage: Callable[[bytes], bytes]) -> None:
    assert save_code(tmp_path, "name", bytes(1000)) == ""
    (path,) = tmp_path.iterdir()
    path.write_bytes(damage(path.read_bytes()))
    assert load_code(tmp_path, "name") is None


@needs_compiler
def test_a_store_that_cannot_be_written_is_done_without(toy: Toy) -> None:
    toy.code.write_text("a file in place of the folder")
    assert toy.run() == ["24.0", "compiled"]


@pytest.mark.slow
@needs_compiler
def test_another_processor_has_its_own_code(toy: Toy) -> None:
    assert toy.run() == ["24.0", "compiled"]
    assert toy.run(NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="") == ["24.0", "compiled"]
    assert len({path.parent for path in toy.files()}) == 2


@pytest.mark.slow
@needs_compiler
def test_of_two_processes_one_compiles(toy: Toy) -> None:
    answers = [printed(process) for process in [toy.start(), toy.start()]]
    assert [answer[0] for answer in answers] == ["24.0", "24.0"]
    if sys.platform.startswith("linux"):
        assert sorted(answer[1] for answer in answers) == ["compiled", "loaded"]


@pytest.mark.slow
@needs_compiler
@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_a_killed_process_leaves_nothing_in_the_way(toy: Toy) -> None:
    process = toy.start()
    while not toy.code.exists():
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert toy.run() == ["24.0", "compiled"]
    assert toy.run() == ["24.0", "loaded"]
    assert all(path.suffix == ".code" for path in toy.files())


def test_the_least_recently_used_code_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(PLACE, str(tmp_path))
    monkeypatch.setattr(code_store, "LARGEST", 2500)
    old, new = tmp_path / "old", tmp_path / "new"
    assert save_code(old, "first", bytes(1000)) == ""
    os.utime(next(old.iterdir()), (0, 0))
    assert save_code(new, "second", bytes(1000)) == ""
    assert load_code(old, "first") == bytes(1000)  # and is thereby the last that was used
    os.utime(next(new.iterdir()), (1, 1))
    assert save_code(new, "third", bytes(1000)) == ""
    assert (load_code(old, "first"), load_code(new, "second"), load_code(new, "third")) == (
        bytes(1000),
        None,
        bytes(1000),
    )
    assert code_store.code_size() == 2064
    assert code_store.clear_code() == 2
    assert list(tmp_path.iterdir()) == []


def test_a_store_that_was_never_made_is_cleared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(PLACE, str(tmp_path / "never made"))
    assert code_store.clear_code() == 0


def test_a_full_disk_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(code_store, "write_file", fail)
    assert (
        save_code(tmp_path / "new", "name", b"")
        == f"{tmp_path / 'new'} can't be written to: No space left on device"
    )


@needs_compiler
def test_numbers_of_other_types_are_converted_or_refused() -> None:
    assert largest_of(np.array([1.0, 3.0])) == 3.0
    with pytest.raises(TypeError, match="No matching definition"):
        largest_of(np.array([[1.0, 3.0]]))
    with pytest.raises(TypeError, match="No matching definition"):
        largest_of(np.arange(8.0)[::2])


@needs_compiler
def test_a_function_is_pickled_by_name() -> None:
    assert pickle.loads(pickle.dumps(largest_of)) is largest_of
    assert pickle.loads(pickle.dumps(largest_of.compiled)) is largest_of.compiled  # type: ignore[attr-defined]


@needs_compiler
def test_all_functions_of_the_core_can_be_kept() -> None:
    from vibroimpact.compiler.functions import _REPLACED

    for module in pkgutil.iter_modules(vibroimpact.dynamics.core.__path__):
        importlib.import_module(f"vibroimpact.dynamics.core.{module.name}")
    functions = [
        function
        for function in DEFERRED
        if function.py_func.__module__.startswith("vibroimpact.dynamics.core.")
    ]
    assert len(functions) > 10
    for function in functions:
        function.compiled.is_on_disk()
        assert function.compiled.is_kept, function
        words = Digest(function, _REPLACED)._words
        # an address, which differs between processes
        assert not [word for word in words if " at 0x" in word], function


@needs_compiler
def test_the_digest_heeds_signatures_and_members_of_named_tuples() -> None:
    def digest(members: str, returned: type) -> str:
        row = namedtuple("row", members)
        row.__annotations__ = dict.fromkeys(row._fields, float)

        def first(pair):  # type: ignore[no-untyped-def]
            return pair.a

        first.__annotations__ = {"pair": row, "return": returned}
        callee = DeferredFunction(first, lambda: "")
        assert callee.compiled.py_func is callee.py_func
        return Digest(callee, {}).text

    assert digest("a b", float) == digest("a b", float)
    assert len({digest("a b", float), digest("b a", float), digest("a b", int)}) == 3


@needs_compiler
def test_an_annotation_that_names_no_type_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deferred, "DEFERRED", [])  # whose compiling time is foretold

    @compiled
    def longest(words: list[str]) -> float:
        return float(max(map(len, words)))

    @compiled
    def doubled(value) -> float:  # type: ignore[no-untyped-def]
        return 2.0 * value

    with pytest.raises(TypeError, match=r"longest: words: no type .* list\[str\]"):
        longest(["a"])
    with pytest.raises(TypeError, match=r"doubled: value: .* not annotated"):
        doubled(1.0)


@needs_compiler
def test_arrays_are_known_however_numpy_names_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """`NDArray` is an expanded alias before NumPy 2.5, and one of its own from then on."""
    from numba import types as numba_types
    from typing_extensions import TypeAliasType

    from vibroimpact.compiler import types

    element = TypeVar("element", bound=np.generic)
    expanded = np.ndarray[tuple[Any, ...], np.dtype[element]]  # type: ignore[valid-type]
    named = TypeAliasType("named", expanded, type_params=(element,))  # type: ignore[valid-type,misc]
    monkeypatch.setattr(types, "NDArray", named)
    for alias in (named[np.int64], expanded[np.int64]):
        assert types.type_of(alias) == numba_types.int64[::1]
        assert types.type_of(Annotated[alias, 2]) == numba_types.int64[:, ::1]


# what is said


def test_a_long_compilation_is_told_to_a_listener_each_time(
    capsys: pytest.CaptureFixture[str],
) -> None:
    sentences: list[str] = []
    with notice.heard_by(sentences.append):
        for seconds in (42.0, 1.0, 23.0):
            notice.say_how_long(lambda seconds=seconds: seconds)
    notice.say_how_long(lambda: 42.0)
    assert sentences == [
        f"Compiling the solver for this machine, once; about {seconds} s." for seconds in (40, 25)
    ]
    assert capsys.readouterr() == ("", "")


def test_a_long_compilation_is_said_once_in_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(notice, "_SAID", set())
    notice.say_how_long(lambda: 23.0)
    notice.say_trouble("no room")
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    notice.say_how_long(lambda: 1.0)
    for _ in range(2):
        notice.say_how_long(lambda: 23.0)
        notice.say_trouble("no room")
    assert capsys.readouterr() == (
        "",
        "Compiling the solver for this machine, once; about 25 s.\n"
        "The compiled solver can't be kept, and is compiled again the next time: no room.\n",
    )


# without a compiler


@pytest.mark.parametrize("switch", [SWITCH, "NUMBA_DISABLE_JIT"])
def test_a_switch_leaves_functions_in_python(toy: Toy, switch: str) -> None:
    assert toy.run(**{switch: "0" if switch == SWITCH else "1"}) == ["24.0"]
    assert toy.files() == []


def test_without_numba_functions_stay_in_python(toy: Toy) -> None:
    finder = "import sys; sys.modules['numba'] = None"
    toy.program.write_text(
        f"{finder}\n{_MODULE}\nfrom vibroimpact.compiled import why_not_compiled; "
        "print(why_not_compiled())"
    )
    assert toy.run() == ["24.0", *["numba", "is", "not", "installed"]]


def test_numba_that_does_not_load_is_done_without(toy: Toy) -> None:
    (toy.program.parent / "numba.py").write_text(
        "raise ImportError('Numba needs NumPy 2.6 or less')"
    )
    toy.program.write_text(
        f"{_MODULE}\nfrom vibroimpact.compiled import why_not_compiled; print(why_not_compiled())"
    )
    assert " ".join(toy.run()) == "24.0 numba cannot be loaded: Numba needs NumPy 2.6 or less"


def test_commands_that_compute_no_drop_load_no_compiler() -> None:
    program = (
        "import sys\nfrom vibroimpact.cli import main\n"
        "for words in (['--help'], ['check', 'paper:type3'], ['laws'], ['laws', 'hertz'], "
        "['units', '1 mm']):\n"
        "    sys.argv = ['vibroimpact', *words]\n"
        "    try:\n        main()\n    except SystemExit:\n        pass\n"
        "assert 'numba' not in sys.modules\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
