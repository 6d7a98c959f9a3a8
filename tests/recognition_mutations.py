"""Hostile versions of what recognition reads: data sets, cards and graphs of models. Each
is reproducible from its seed.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from folder_mutations import places
from mutations import NUMBERS, OTHERS, TEXTS, deep
from vibroimpact.files.check_sums import CHECK_SUMS, SHA256, digest, file_digest


class Hostile(NamedTuple):
    """A change of a file, and its seed."""

    change: str
    seed: int


# data sets


def damage_dataset(path: Path, hostile: Hostile) -> None:
    """Change `dataset.nc`, or the summary beside it."""
    draw = random.Random(hostile.seed)
    change = DATASET_CHANGES[hostile.change]
    if change in (_bytes, _summary):
        change(path, draw)
        return
    with h5py.File(path, "a") as file:
        change(file, draw)


def _variable(file: h5py.File, draw: random.Random) -> str:
    return draw.choice(sorted(file))


def _replaced(file: h5py.File, name: str, values: Any, **options: Any) -> h5py.Dataset:
    """Put other values in place of a variable, with its attributes but those of dimensions."""
    old = {
        key: value
        for key, value in file[name].attrs.items()
        if key not in ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME")
    }
    del file[name]
    data = file.create_dataset(name, data=values, **options)
    data.attrs.update(old)
    return data


def _group(file: h5py.File, draw: random.Random) -> None:
    name = draw.choice([*sorted(file), "signal_b", "signal_/x", "more"])
    if name in file:
        del file[name]
    file.create_group(name).attrs["rate_Hz"] = 1.0


def _link(file: h5py.File, draw: random.Random) -> None:
    name = draw.choice([*sorted(file), "signal_b", "drop.mass"])
    target = draw.choice(
        (
            h5py.SoftLink("/nothing"),
            h5py.SoftLink(f"/{name}"),
            h5py.SoftLink("/"),
            h5py.ExternalLink("nothing.nc", "/signal_a1"),
            h5py.ExternalLink("/dev/zero", "/"),
            h5py.ExternalLink("dataset.nc", "/class"),
            h5py.ExternalLink("/proc/self/mem", "/"),
        )
    )
    if name in file:
        del file[name]
    file[name] = target


def _other_type(file: h5py.File, draw: random.Random) -> None:
    name = _variable(file, draw)
    values = file[name][()]
    other = draw.choice(
        (
            lambda: np.array(
                [str(one) for one in values.ravel()], dtype=h5py.string_dtype()
            ).reshape(values.shape),
            lambda: values.astype(np.complex64),
            lambda: values.astype(bool),
            lambda: values.astype("S8"),
            lambda: np.full(values.shape, np.nan),
            lambda: np.full(values.shape, np.inf),
            lambda: np.full(values.shape, draw.choice((-1e300, 1e300, 1e19, -1.0, 1e-320))),
            lambda: np.where(np.arange(values.size).reshape(values.shape) % 3, values, np.nan),
            lambda: np.zeros(values.shape, dtype=[("x", "f4"), ("y", "i2")]),
            lambda: None,
            lambda: np.zeros(values.shape, dtype=np.uint64) + np.uint64(2**64 - 1),
        )
    )()
    if other is None:
        del file[name]
        file.create_dataset(name, values.shape, dtype=h5py.ref_dtype)
    else:
        _replaced(file, name, other)


def _other_shape(file: h5py.File, draw: random.Random) -> None:
    name = _variable(file, draw)
    values = file[name][()]
    other = draw.choice(
        (
            lambda: values[:-1],
            lambda: values[:0],
            lambda: np.concatenate([values, values]),
            lambda: values.ravel()[:1].reshape(()),
            lambda: values[..., np.newaxis],
            lambda: values.ravel(),
            lambda: values[..., :1],
            lambda: values[..., :0],
            lambda: np.stack([values.ravel()] * 3),
        )
    )()
    _replaced(file, name, other)


def _huge(file: h5py.File, draw: random.Random) -> None:
    """Declare a shape that the file does not hold."""
    name = _variable(file, draw)
    old = file[name]
    shape = draw.choice(((10**9,), (10**6, 10**4), (36, 10**9), (10**5, 10**5), (2**40,)))
    dtype = old.dtype
    del file[name]
    options = {"compression": "gzip"} if draw.random() < 0.5 else {}
    file.create_dataset(
        name, shape, dtype, chunks=tuple(min(one, 1000) for one in shape), **options
    )


def _sensor(file: h5py.File, draw: random.Random) -> None:
    """Add a sensor that does not agree with the other."""
    values = file["signal_a1"][()]
    other = draw.choice(
        (
            lambda: values[:-5],
            lambda: values[:1],
            lambda: values[:0],
            lambda: values[:, :0],
            lambda: values.astype("S4"),
        )
    )()
    data = file.create_dataset("signal_b", data=other)
    if draw.random() < 0.7:
        data.attrs["rate_Hz"] = 1e4


_ATTRIBUTES: tuple[Callable[[], Any], ...] = (
    lambda: "fast", lambda: "", lambda: "\x1b[31m" * 20, lambda: b"\xff\xfe", lambda: np.nan, lambda: np.inf,
    lambda: -1.0, lambda: 0, lambda: 1e308, lambda: [1.0, 2.0], list,
    lambda: ["a", "b"], lambda: h5py.Empty("f4"), lambda: np.zeros((2, 2)), lambda: 1j, lambda: "x " * 3000,
    lambda: np.zeros(2, dtype=[("x", "f4")]), lambda: 2**63 - 1, lambda: "coal coal", lambda: "coal", lambda: [0, 0], lambda: [np.nan, 1.0],
)  # fmt: skip


def _attribute(file: h5py.File, draw: random.Random) -> None:
    places = [(file, name) for name in ("format", "title", "version", "study")]
    places += [(file["signal_a1"], name) for name in ("rate_Hz", "rate_Hz", "units", "CLASS")]
    places += [
        (file["class"], name)
        for name in ("flag_values", "flag_values", "flag_meanings", "flag_meanings")
    ]
    for _ in range(draw.choice((1, 1, 2))):
        holder, name = draw.choice(places)
        if draw.random() < 0.15:
            holder.attrs.pop(name, None)
        else:
            holder.attrs[name] = draw.choice(_ATTRIBUTES)()


def _removed(file: h5py.File, draw: random.Random) -> None:
    for _ in range(draw.choice((1, 1, 2))):
        name = _variable(file, draw)
        del file[name]
    if draw.random() < 0.5 and "signal_a1" in file:
        file["signal_a1"].attrs.pop("rate_Hz", None)


def _times(file: h5py.File, draw: random.Random) -> None:
    """Leave the rate to times that give none."""
    signal = file["signal_a1"]
    del signal.attrs["rate_Hz"]
    count = signal.shape[1]
    time = draw.choice(
        (
            lambda: np.zeros(count),
            lambda: np.full(count, np.nan),
            lambda: np.arange(count)[::-1].astype(float),
            lambda: np.array([str(one) for one in range(count)], dtype="S8"),
            lambda: np.zeros(count, dtype=[("x", "f4")]),
            lambda: np.arange(count) * 1e-320,
        )
    )()
    file["other_time"] = time
    file["other_time"].make_scale("other_time")
    signal.dims[1].attach_scale(file["other_time"])


def _bytes(path: Path, draw: random.Random) -> None:
    path.write_bytes(bytes_damaged(path.read_bytes(), draw))


def _summary(path: Path, draw: random.Random) -> None:
    summary = path.with_name("summary.json")
    value = draw.choice((*_VALUES, lambda: "0.1", lambda: True, lambda: -0.1, lambda: 1.0))()
    text = json.dumps({"bayes_error": value}) if draw.random() < 0.7 else None
    summary.write_bytes(text.encode() if text else draw.choice(_JSON_TEXTS))


DATASET_CHANGES: dict[str, Callable[..., None]] = {
    "group": _group, "link": _link, "type": _other_type, "shape": _other_shape, "huge": _huge, "sensor": _sensor, "attribute": _attribute,
    "removed": _removed, "times": _times, "bytes": _bytes, "summary": _summary,
}  # fmt: skip


def bytes_damaged(data: bytes, draw: random.Random) -> bytes:
    """Return the content of a file with a damage of the kinds that disks and cables make."""
    place = draw.randrange(len(data))
    kind = draw.choice(("bit", "bytes", "zeros", "torn", "twice"))
    if kind == "bit":
        return data[:place] + bytes([data[place] ^ 1 << draw.randrange(8)]) + data[place + 1 :]
    if kind == "torn":
        return data[:place]
    if kind == "twice":
        return data[:place] + data[place // 2 :]
    length = draw.choice((1, 2, 8, 64, 512))
    return (
        data[:place]
        + (draw.randbytes(length) if kind == "bytes" else bytes(length))
        + data[place + length :]
    )[: len(data)]


# cards

_VALUES: tuple[Callable[[], Any], ...] = (
    *(lambda text=text: text for text in TEXTS if "\ud7ff" not in text),
    *(lambda number=number: number for number in NUMBERS),
    *OTHERS,
    lambda: None,
    lambda: ["coal", "coal"],
    lambda: {"coal": {"true_rate": [], "false_rate": []}},
    lambda: deep(5000),
)
_JSON_TEXTS = (
    b"[" * 100_000, b"[" * 100_000 + b"]" * 100_000, b'{"a":' * 100_000 + b"1" + b"}" * 100_000, b"[]", b"1", b"null",
    b'"x"', b"", b"{", b"\xff\xfe{",
    b"\x00" * 100, b'{"format": NaN}', b'{"format": 1e999}', b'{"a": ' + b"9" * 5000 + b"}", b'{"format": "\\ud800"}',
    b'{"version": "\\ud800"}', b"\xef\xbb\xbf{}",
    b"[" + b"[]," * 2_000_000 + b"1]", b"{}" * 3,
)  # fmt: skip


def damage_card(folder: Path, hostile: Hostile) -> None:
    """Change `card.json`; most get the check sum of what they then hold."""
    draw = random.Random(hostile.seed)
    path = folder / "card.json"
    if hostile.change == "text":
        path.write_bytes(draw.choice(_JSON_TEXTS))
        return
    if hostile.change == "bytes":
        path.write_bytes(bytes_damaged(path.read_bytes(), draw))
        return
    table = json.loads(path.read_text())
    table.pop(SHA256)
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        holder, key = draw.choice(places(table))
        if hostile.change == "removed" and isinstance(holder, dict):
            holder.pop(key, None)
        else:
            holder[key] = draw.choice(_VALUES)()
    try:
        if draw.random() < 0.8:
            table[SHA256] = digest(table)
        path.write_text(json.dumps(table))
    except (RecursionError, UnicodeEncodeError):
        path.write_bytes(b"[" * 5000)


CARD_CHANGES = ("value", "value", "value", "removed", "text", "bytes")


# graphs


def damage_graph(folder: Path, hostile: Hostile) -> None:
    """Change `model.onnx`, of which the card then has the check sum."""
    draw = random.Random(hostile.seed)
    path = folder / "model.onnx"
    data = path.read_bytes()
    if hostile.change == "bytes":
        path.write_bytes(bytes_damaged(data, draw))
    else:
        model = onnx.load_model_from_string(data)
        for _ in range(draw.choice((1, 1, 2))):
            GRAPH_CHANGES[hostile.change](model, draw)
        path.write_bytes(model.SerializeToString())
    card = json.loads((folder / "card.json").read_text())
    card.pop(SHA256)
    card[CHECK_SUMS] = {"model.onnx": file_digest(path)}
    (folder / "card.json").write_text(json.dumps({**card, SHA256: digest(card)}))


def _node(model: Any, draw: random.Random) -> Any:
    return draw.choice(list(model.graph.node))


def _numbers(model: Any, draw: random.Random) -> None:
    """Change numbers of attributes: coefficients, thresholds, places of nodes of trees."""
    attributes = [
        one for node in model.graph.node for one in node.attribute if one.floats or one.ints
    ]
    attribute = draw.choice(attributes)
    values = attribute.floats if attribute.floats else attribute.ints
    others: tuple[Any, ...] = (
        (np.nan, np.inf, -np.inf, 1e38, -5.0)
        if attribute.floats
        else (-1, 0, 10**6, 2**62, -(2**62), 3)
    )
    other = draw.choice(others)
    if draw.random() < 0.3:
        for place in range(len(values)):
            values[place] = other
    else:
        values[draw.randrange(len(values))] = other


def _lengths(model: Any, draw: random.Random) -> None:
    attributes = [
        one
        for node in model.graph.node
        for one in node.attribute
        if one.floats or one.ints or one.strings
    ]
    attribute = draw.choice(attributes)
    values = next(one for one in (attribute.floats, attribute.ints, attribute.strings) if one)
    kept = list(values)
    del values[:]
    values.extend(draw.choice((kept[:-1], kept[:1], kept + kept, kept * 50)))


def _operator(model: Any, draw: random.Random) -> None:
    node = _node(model, draw)
    node.op_type = draw.choice(
        (
            "Loop",
            "Scan",
            "If",
            "Tile",
            "Expand",
            "Conv",
            "RandomNormal",
            "NonZero",
            "nothing",
            "",
            "Identity",
            "Neg",
            "Exp",
        )
    )
    if draw.random() < 0.5:
        node.domain = draw.choice(("", "com.microsoft", "ai.onnx.ml", "evil"))


def _attributes(model: Any, draw: random.Random) -> None:
    node = next(
        iter([one for one in model.graph.node if one.attribute and draw.random() < 0.5]),
        model.graph.node[0],
    )
    attribute = draw.choice(list(node.attribute)) if node.attribute else None
    if attribute is None or draw.random() < 0.3:
        del node.attribute[:]
    elif attribute.HasField("s"):
        attribute.s = draw.choice(
            (b"PROBIT", b"nothing", b"", b"\xff\xfe", b"SOFTMAX_ZERO", b"NONE")
        )
    else:
        attribute.name = draw.choice(("axis", "to", "nothing", "", "post_transform"))


def add_loop(model: Any, draw: random.Random) -> None:
    """Add a loop that never ends, whose result the probabilities depend on."""
    body = helper.make_graph(
        [
            helper.make_node("Identity", ["condition"], ["goes_on"]),
            helper.make_node("Identity", ["state"], ["state_out"]),
        ],
        "body",
        [
            helper.make_tensor_value_info("step", TensorProto.INT64, []),
            helper.make_tensor_value_info("condition", TensorProto.BOOL, []),
            helper.make_tensor_value_info("state", TensorProto.FLOAT, None),
        ],
        [
            helper.make_tensor_value_info("goes_on", TensorProto.BOOL, []),
            helper.make_tensor_value_info("state_out", TensorProto.FLOAT, None),
        ],
    )
    model.graph.initializer.extend(
        [
            numpy_helper.from_array(np.array(2**62), "for_ever"),
            numpy_helper.from_array(np.array(True), "always"),
        ]
    )
    after_probabilities(
        model,
        helper.make_node(
            "Loop", ["for_ever", "always", "inner_probabilities"], ["probabilities"], body=body
        ),
    )


def _tensors(model: Any, draw: random.Random) -> None:
    """Add a result that does not fit into memory."""
    count = draw.choice((10**8, 8 * 10**8, 10**12, -1, 2**62))
    model.graph.initializer.append(
        numpy_helper.from_array(np.array([count], dtype=np.int64), "count")
    )
    made = helper.make_node("ConstantOfShape", ["count"], ["large"])
    total = helper.make_node("ReduceSum", ["large"], ["total"], keepdims=0)
    model.graph.node.extend([made, total])
    after_probabilities(
        model, helper.make_node("Add", ["inner_probabilities", "total"], ["probabilities"])
    )


def _growing(model: Any, draw: random.Random) -> None:
    """Double a result again and again, by an operator that the classifiers have too."""
    last = "inner_probabilities"
    nodes = []
    for number in range(draw.choice((8, 20, 40))):
        nodes.append(
            helper.make_node("Concat", [last, last], [f"doubled{number}"], axis=draw.choice((0, 1)))
        )
        last = f"doubled{number}"
    after_probabilities(model, *nodes, helper.make_node("Identity", [last], ["probabilities"]))


def after_probabilities(model: Any, *nodes: Any) -> None:
    """Put nodes between what gives the probabilities and the output."""
    for node in model.graph.node:
        for place, name in enumerate(node.output):
            if name == "probabilities":
                node.output[place] = "inner_probabilities"
        for place, name in enumerate(node.input):
            if name == "probabilities":
                node.input[place] = "inner_probabilities"
    model.graph.node.extend(nodes)


def _initializers(model: Any, draw: random.Random) -> None:
    if not model.graph.initializer:
        tensor = model.graph.initializer.add(name="extra", data_type=1)
        model.graph.node[0].input.append("extra")
    else:
        tensor = draw.choice(list(model.graph.initializer))
    kind = draw.choice(("external", "dims", "type", "values"))
    if kind == "external":
        tensor.data_location = TensorProto.EXTERNAL
        tensor.external_data.add(
            key="location", value=draw.choice(("/dev/zero", "../../../etc/passwd", "card.json"))
        )
    elif kind == "dims":
        del tensor.dims[:]
        tensor.dims.extend(draw.choice(([2**40], [10**5, 10**5], [-1], [0], [2**62, 4], [3])))
    elif kind == "type":
        tensor.data_type = draw.choice((0, 1, 8, 16, 99))
    else:
        tensor.raw_data = draw.choice((b"", b"\xff" * 8, b"\x00" * 4096, b"\x01"))


def _ends(model: Any, draw: random.Random) -> None:
    """Change what goes in and what comes out."""
    graph = model.graph
    change = draw.choice(
        (
            lambda: graph.input.pop(),
            lambda: graph.output.pop(),
            lambda: graph.output.reverse(),
            lambda: graph.input.append(
                helper.make_tensor_value_info("more", TensorProto.FLOAT, [2**40])
            ),
            lambda: graph.output.append(
                helper.make_tensor_value_info("nothing", TensorProto.FLOAT, None)
            ),
            lambda: setattr(graph.input[0], "name", "other"),
            lambda: setattr(graph.input[0].type.tensor_type, "elem_type", draw.choice((7, 8, 11))),
            lambda: setattr(
                graph.input[0].type.tensor_type.shape.dim[1],
                "dim_value",
                draw.choice((0, 1, 5000, 2**62)),
            ),
            lambda: setattr(graph.output[0], "name", "probabilities"),
            lambda: graph.node.pop(),
            lambda: graph.node.reverse(),
            lambda: graph.node.add().CopyFrom(graph.node[0]),
            lambda: model.ClearField("opset_import"),
            lambda: model.opset_import.append(
                helper.make_opsetid(
                    draw.choice(("", "evil", "ai.onnx.ml")), draw.choice((0, -1, 99, 5))
                )
            ),
            lambda: setattr(model, "ir_version", draw.choice((0, 99, -1))),
            lambda: model.ClearField("graph"),
            lambda: model.functions.add(name="f", domain="ai.onnx.ml"),
            lambda: setattr(model.graph.node[0], "op_type", "f"),
        )
    )
    try:
        change()
    except IndexError:  # two changes, the first of which took it away
        model.graph.name = "changed"


def _probabilities(model: Any, draw: random.Random) -> None:
    """Return what is no probability, by operators that the classifiers have too."""
    factor = np.float32(draw.choice((np.nan, -1.0, 2.0, np.inf, 0.0, 1.01)))
    model.graph.initializer.append(numpy_helper.from_array(np.array(factor), "factor"))
    after_probabilities(
        model, helper.make_node("Mul", ["inner_probabilities", "factor"], ["probabilities"])
    )


GRAPH_CHANGES: dict[str, Callable[[Any, random.Random], None]] = {
    "numbers": _numbers, "lengths": _lengths, "operator": _operator, "attributes": _attributes, "loop": add_loop, "tensors": _tensors,
    "growing": _growing, "initializers": _initializers, "ends": _ends, "probabilities": _probabilities,
}  # fmt: skip


def hostiles(changes: Iterator[str] | Any, count: int, seed: int) -> list[Hostile]:
    """Return as many changes, of each kind in turn."""
    draw, kinds = random.Random(seed), list(changes)
    return [Hostile(kinds[number % len(kinds)], draw.getrandbits(32)) for number in range(count)]
