"""What the files of an export say to a program, apart from what they call things: for
tests of names.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree

import numpy as np
from scipy.io import loadmat, wavfile

from exported_drops import ROCK, STEEL, STIFFNESS, told
from oracles.adams_commands import read_commands
from oracles.adams_dataset import read_dataset, read_solver_commands
from oracles.lammps_lines import commands
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat

_BASE = told(Hertz(stiffness=STIFFNESS), number=1)
_DEVICE = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)


def named(case: str, sensors: list[str], materials: tuple[str, str]) -> Drop:
    """Return a drop with given names; but for them all are the same."""
    times = np.arange(8) / 1e4
    return replace(
        _BASE,
        name=case,
        signals={name: Signal(Sensor(name, rate=1e4), times, np.sin(times), 0) for name in sensors},
        sphere_material=replace(ROCK, name=materials[0]),
        plate_material=replace(STEEL, name=materials[1]),
    )


def said(format: ExportFormat, drop: Drop) -> Any:
    """Return what the program is told, read as the program would; raises if it can't be,
    or a file or a note is called badly.
    """
    files = dict(format.write(drop))
    check_file_names(files)
    for note in format.notes(drop):
        assert note.isprintable(), note
        assert len(note) <= 500, note
    return _READERS[format.name](files)


def check_file_names(files: Mapping[str, bytes]) -> None:
    """Raise unless files of these names can be made anywhere, beside each other."""
    assert len({name.lower() for name in files}) == len(files)
    for name in files:
        for part in PurePosixPath(name).parts:
            assert re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", part), name
            assert not _DEVICE.fullmatch(part), name
            assert len(part) <= 120, name


def _adams(files: Mapping[str, bytes]) -> Any:
    texts = {PurePosixPath(name).suffix: content.decode("ascii") for name, content in files.items()}
    text = texts[".adm"]
    # Adams View names the next thing after this remark: there is one before each thing that has a
    # name, and no other
    assert all(
        re.fullmatch(r"! adams_view_name='[A-Za-z]\w{0,59}'", line)
        for line in re.findall("(?m)^!.*adams_view_name.*", text)
    )
    assert len(re.findall("(?m)^!.*adams_view_name", text)) == len(
        re.findall(r"(?m)^[A-Z]+/\d+$", text)
    )
    model = read_dataset(text)
    read_solver_commands(texts[".acf"], model)
    return asdict(model)


def _adams_view(files: Mapping[str, bytes]) -> Any:
    (content,) = files.values()
    text = content.decode("ascii")
    (name,) = re.findall(r"(?m)^   model_name = (\w+)$", text)
    assert re.fullmatch(r"[A-Za-z]\w{0,49}", name)
    assert all(len(line) <= 120 and line.isprintable() for line in text.split("\n"))
    materials = re.findall(r"(?m)^   material_name = \.\w+\.(\w+)  &$", text)
    assert not {one.lower() for one in materials} & {
        "ground",
        "sphere",
        "contact",
        "gravity",
        "motion",
        "drop",
    }
    assert len({one.lower() for one in materials}) == 2
    return asdict(
        read_commands(re.sub(rf"(?<![\w.])(\.|model_name = \.?){name}(?!\w)", r"\1model", text))
    )


def _lammps(files: Mapping[str, bytes]) -> Any:
    (content,) = files.values()
    return commands(content.decode())


def _python(files: Mapping[str, bytes]) -> Any:
    (content,) = files.values()
    assert tokenize.detect_encoding(io.BytesIO(content).readline)[0] == "utf-8"
    return ast.dump(ast.parse(content))


def _mujoco(files: Mapping[str, bytes]) -> Any:
    (content,) = files.values()
    root = ElementTree.fromstring(content)
    assert re.fullmatch(r"[ -~]{1,80}", root.attrib.pop("model"))
    return [(one.tag, one.attrib, (one.text or "").strip()) for one in root.iter()]


def _csv(files: Mapping[str, bytes]) -> Any:
    return sorted(files.values())


def _parquet(files: Mapping[str, bytes]) -> Any:
    from pyarrow import parquet

    tables = [parquet.read_table(io.BytesIO(content)) for content in files.values()]
    for table in tables:
        words = [
            table.schema.metadata[b"title"],
            *(field.metadata[b"long_name"] for field in table.schema),
        ]
        assert all(one.decode().isprintable() for one in words)
    return sorted(str(table.to_pydict()) for table in tables)


def _mat(files: Mapping[str, bytes]) -> Any:
    (content,) = files.values()
    found = loadmat(io.BytesIO(content), simplify_cells=True)
    for name in found["signals"]:
        assert re.fullmatch(r"[A-Za-z]\w{0,62}", name)
    assert str(found["drop"].pop("name")).isprintable()
    signals = [
        {key: value for key, value in one.items() if key != "name"}
        for one in found["signals"].values()
    ]
    return str([signals, found["drop"], found["impacts"], found["units"]])


def _uff58(files: Mapping[str, bytes]) -> Any:
    import pyuff

    (content,) = files.values()
    text = content.split(b"    58b")[0].decode("ascii")  # up to the first binary data
    assert all(
        len(line) <= 80 and line.isprintable() for line in text.replace("\r", "").split("\n")
    )
    with TemporaryDirectory() as folder:
        Path(folder, "a.uff").write_bytes(content)
        file = pyuff.UFF(str(Path(folder, "a.uff")))
        types = [int(one) for one in file.get_set_types()]
        sets = file.read_sets()
    for one in sets[2:]:
        assert re.fullmatch(r"[ -~]{1,80}", one["id1"])
        assert re.fullmatch(r"[ -~]{1,80}", one["id2"])
    return types, [(one["rsp_node"], one["data"].tolist()) for one in sets[2:]]


def _wav(files: Mapping[str, bytes]) -> Any:
    for content in files.values():
        (length,) = np.frombuffer(content[content.index(b"ICMT") + 4 :][:4], "<u4")
        assert content[content.index(b"ICMT") + 8 :][:length].rstrip(b"\0").decode().isprintable()
    return [
        (rate, values.tolist())
        for rate, values in (wavfile.read(io.BytesIO(content)) for content in files.values())
    ]


_READERS: dict[str, Callable[[Mapping[str, bytes]], Any]] = {
    "adams": _adams,
    "adams-view": _adams_view,
    "lammps": _lammps,
    "yade": _python,
    "exudyn": _python,
    "mujoco": _mujoco,
    "csv": _csv,
    "dem": _csv,
    "parquet": _parquet,
    "mat": _mat,
    "uff58": _uff58,
    "wav": _wav,
}
