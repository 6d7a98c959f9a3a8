"""What every export format keeps, whatever it is: a new file in exporting/formats is
covered without a new test.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from exported_drops import MASS, RADIUS, STIFFNESS, told
from support import one_in
from vibroimpact.compiled import scalar
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, export_formats, find_export_format
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.results.result import result_of

FORMATS = list(export_formats().values())
DATA = {"csv", "mat", "parquet", "uff58", "vtu", "wav"}
"""Those that hold what came of a drop; the others state it to another program."""
PACKAGES = {"parquet": "pyarrow", "uff58": "pyuff"}
"""What a format needs beside what vibroimpact always has."""
every_format = pytest.mark.parametrize("format", FORMATS, ids=lambda format: format.name)


@pytest.fixture(autouse=True)
def has_its_package(request: pytest.FixtureRequest) -> None:
    format = (
        request.node.callspec.params.get("format") if hasattr(request.node, "callspec") else None
    )
    if format and format.name in PACKAGES:
        pytest.importorskip(PACKAGES[format.name])


@scalar
def strange_forces(
    delta: Any, delta_dot: Any, approach_speed: Any, coefficients: Any
) -> tuple[Any, Any]:
    return 1e4 * np.tanh(100.0 * delta), 0.0 * delta


@scalar
def strange_energies(delta: Any, coefficients: Any) -> tuple[Any, Any]:
    return 100.0 * np.log(np.cosh(100.0 * delta)), 0.0 * delta


@dataclass(frozen=True, kw_only=True)
class Strange(CompliantLaw):
    """A law that no program has."""

    name = "strange"
    equation = "F = F1 tanh(delta / d)"
    source = "nobody"
    contact_end = "zero-indentation"
    tension = "none"
    scalar_forces = staticmethod(strange_forces)
    scalar_energies = staticmethod(strange_energies)


def written(format: ExportFormat, drop: Drop) -> dict[str, bytes] | None:
    """Return the files, or None if the drop is refused as it should be: in one clear line."""
    files, message = {}, ""
    try:
        drop = format.prepare(drop)
        files = dict(format.write(drop))
    except vi.InputError as error:
        message = str(error)
    if message:
        assert len(message.splitlines()) == 1, format.name
        assert len(message) > 20, format.name
        return None
    assert files, format.name
    for name, content in files.items():
        assert isinstance(content, bytes), name
        assert content, name
        assert not PurePosixPath(name).is_absolute()
        assert ".." not in PurePosixPath(name).parts
        assert "\\" not in name
        assert PurePosixPath(name).suffix
    for note in format.notes(drop):
        assert note.strip() == note
        assert note.endswith("."), note
    return files


@pytest.fixture(scope="module")
def rigid() -> dict[str, Drop]:
    cases = {name: vi.load_case(name) for name in vi.shipped_cases()}
    cases = {
        name: case
        for name, case in cases.items()
        if case.sphere.model == case.plate.model == "rigid"
    }
    assert len(cases) >= 3
    return {
        name: drop_of_result(result_of(vi.simulate(case)), case) for name, case in cases.items()
    }


def test_formats_are_found_by_name() -> None:
    assert {"adams", "adams-view", "lammps", "yade", "mujoco", "exudyn", *DATA} <= set(
        export_formats()
    )
    for name, format in export_formats().items():
        assert find_export_format(name) is format
    with pytest.raises(vi.InputError, match='Did you mean "parquet"'):
        find_export_format("parqet")


@every_format
def test_a_format_tells_what_it_is(format: ExportFormat) -> None:
    assert format.name == format.name.lower().strip()
    assert " " not in format.name
    for words in (format.program, format.files, format.tested):
        assert words.strip() == words
        assert len(words) >= 4
        assert not words.endswith(".")
    assert len(format.tested) > 15
    # a version, or one's own reader
    assert any(letter.isdigit() for letter in format.tested) or "parser" in format.tested


@pytest.mark.parametrize("format", one_in(3, FORMATS, lambda format: format.name))
def test_shipped_cases_are_written_or_refused(
    format: ExportFormat, rigid: dict[str, Drop], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = {name: written(format, drop) for name, drop in rigid.items()}
    assert any(found.values()) == (format.name != "wav")  # which have no sensors
    assert not list(tmp_path.iterdir())
    name = next((name for name, files in found.items() if files), None)
    if name:
        assert written(format, rigid[name]) == found[name], "the same drop gives the same bytes"


@pytest.mark.parametrize("name", one_in(2, sorted(set(export_formats()) - DATA)))
def test_every_law_is_written_or_refused(name: str) -> None:
    format = find_export_format(name)
    pair = ContactPair(
        effective_modulus=2.4e9,
        effective_radius=RADIUS,
        effective_mass=MASS,
        yield_strength=5e7,
        poissons_ratio=0.28,
    )
    for law in contact_laws().values():
        drop = told(law.example(pair), number=1)
        if written(format, drop) is None:
            with pytest.raises(vi.InputError, match=law.name):  # the message names the law
                format.write(drop)


@every_format
def test_every_friction_law_is_written_or_refused(format: ExportFormat) -> None:
    pair = ContactPair(2.4e9, RADIUS, MASS, effective_shear_modulus=2e9)
    for law in (None, *friction_laws().values()):
        oblique = vi.Oblique(
            velocity=(1.0, 0.5),
            spin=(1.0, 2.0, 3.0),
            friction=None if law is None else law.example(pair),
        )
        drop = told(
            LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.7), number=1, oblique=oblique
        )
        if format.name not in DATA and written(format, drop) is None:
            with pytest.raises(
                vi.InputError,
                match="along the plate" if law is None else f"{law.name} can't|along the plate",
            ):
                format.write(format.prepare(drop))


@every_format
def test_a_law_that_no_program_has_is_refused(format: ExportFormat) -> None:
    drop = told(Strange(), number=1)
    if format.name in DATA - {"wav", "uff58", "vtu"}:
        assert written(format, drop)
    else:
        assert written(format, drop) is None


@every_format
def test_a_drop_without_an_impact_is_written_or_refused(format: ExportFormat) -> None:
    whole = told(LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.7), number=1)
    none = {name: values[:0] for name, values in whole.impacts.items()}
    written(format, replace(whole, impacts=none, end_time=0.1))


@pytest.mark.parametrize("name", sorted(DATA))
def test_a_drop_of_which_nothing_is_known_is_refused(name: str) -> None:
    whole = told(LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.7), number=1)
    assert (
        written(
            find_export_format(name), replace(whole, impacts={}, history={}, signals={}, surface={})
        )
        is None
    )
