"""What recognition is given and must not trust: each fault of a data set, of a card and
of a graph is named before anything is computed.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import onnx
import pytest
from onnx import helper, numpy_helper

import vibroimpact as vi
from knock_data import write_knocks
from recognition_mutations import add_loop, after_probabilities
from trained_models import TINY
from vibroimpact.files.check_sums import CHECK_SUMS, read_sealed, sealed
from vibroimpact.recognition.graph_classifiers import CLASSIFIERS
from vibroimpact.recognition.graph_size import check_size


@pytest.fixture
def model(tiny_models: Path) -> Path:
    return tiny_models / "logistic regression"


@pytest.fixture(scope="module")
def signals(tiny_models: Path) -> vi.recognition.LabelledSignals:
    return vi.recognition.load_labelled_signals(tiny_models / "data")


# data sets


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda file: file.create_group("signal_b"), "signal_b is a group; it must be a variable of two dimensions"),
        (lambda file: file.update(signal_b=h5py.SoftLink("/nothing")), "signal_b is a link that leads nowhere"),
        (lambda file: file.update(signal_b=h5py.ExternalLink("/dev/zero", "/")), "signal_b is a link that leads out of the file"),
        (lambda file: file.update(signal_b=np.zeros((5, 128))), "signal_a1 has 36 signals, and signal_b has 5; a row"),
        (lambda file: file.update(signal_b=np.zeros((36, 0))), "signal_b has no samples"),
        (lambda file: file.create_dataset("signal_b", (36, 10**9), "f4", chunks=(1, 1000)), "signal_b is damaged .its shape .36, 10"),
        (lambda file: file["signal_a1"].attrs.update(rate_Hz="fast"), 'rate_Hz of signal_a1 is "fast"; it must be a number greater than 0'),
        (lambda file: replace_variable(file, "class", np.full(36, np.nan)), "class of signal 0 is nan; it must be a whole number"),
        (lambda file: replace_variable(file, "class", ["coal"] * 36), "class is of the type object; number each class with whole numbers"),
        (lambda file: replace_variable(file, "rock", np.full(36, 1.5)), "rock of signal 0 is 1.5; it must be a whole number"),
        (lambda file: replace_variable(file, "rock", np.zeros(35)), r"rock is of the shape \(35,\); it must have a value"),
        (lambda file: file["class"].attrs.update(flag_values=["a", "b"]), r'flag_values of the variable class is \["a", "b"\]'),
        (lambda file: file["class"].attrs.update(flag_meanings="coal coal"), 'flag_meanings of the variable class is "coal coal"'),
    ],
)  # fmt: skip
def test_what_a_person_may_write_wrongly_is_named(
    change: Callable[[h5py.File], Any],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # HDF5 endures them, and a process takes time
    monkeypatch.setattr("vibroimpact.files.damaged_part.endures", lambda path: True)
    place = write_knocks(tmp_path / "data", **TINY)
    with h5py.File(place / "dataset.nc", "a") as file:
        change(file)
    with pytest.raises(vi.InputError, match=f"dataset.nc: .*{message}") as raised:
        vi.recognition.load_labelled_signals(place)
    assert len(str(raised.value)) < 500


def replace_variable(file: h5py.File, name: str, values: Any) -> None:
    attributes = {key: value for key, value in file[name].attrs.items() if key.startswith("flag_")}
    del file[name]
    file[name] = values
    file[name].attrs.update(attributes)


def test_a_study_is_verified_before_it_is_opened(tmp_path: Path) -> None:
    place = write_knocks(tmp_path / "data", **TINY)
    (place / "summary.json").write_bytes(sealed({CHECK_SUMS: {"dataset.nc": "0" * 64}}))
    with pytest.raises(
        vi.InputError,
        match=r"dataset\.nc: the file is damaged, or was changed after it was written",
    ):
        vi.recognition.load_labelled_signals(place)


def test_a_file_on_which_hdf5_hangs_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # no process starts so fast
    monkeypatch.setattr("vibroimpact.files.damaged_part._TIMEOUT", 0.001)
    with pytest.raises(
        vi.InputError,
        match=r"HDF5 did not get through the file within 0\.001 s: it is damaged, or its disk",
    ):
        vi.recognition.load_labelled_signals(write_knocks(tmp_path / "data", **TINY))


# cards


def change_card(model: Path, tmp_path: Path, **changes: Any) -> Path:
    place = tmp_path / "model"
    place.mkdir()
    (place / "model.onnx").write_bytes((model / "model.onnx").read_bytes())
    (place / "card.json").write_bytes(sealed({**read_sealed(model / "card.json"), **changes}))
    return place


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"classes": 5}, "classes of the card is 5; it must be a list of different names, from 2 " "" "" "to " "100"),
        ({"features": ["a", "a"]}, "features of the card is .*; it must be a list of different names"),
        ({"sensors": {"a1": {"rate_Hz": "1", "unit": "V", "samples": 128}}}, 'sensors.a1.rate_Hz of the card is "1"'),
        ({"confusion": {"coal": {"true_rate": [2.0], "false_rate": [0.1]}}}, "confusion.coal.true_rate of the card is .2.0."),
        ({"data": []}, "data of the card is ..; it must be a table with the text sha256"),
        ({CHECK_SUMS: {}}, "the card has no check sum of model.onnx"),
    ],
)  # fmt: skip
def test_a_card_of_wrong_types_is_refused(
    change: dict[str, Any], message: str, model: Path, tmp_path: Path
) -> None:
    place = change_card(model, tmp_path, **change)
    with pytest.raises(vi.InputError, match=f"card.json: {message}") as raised:
        vi.recognition.load_recogniser(place)
    assert len(str(raised.value)) < 500


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"[" * 100_000, "it has tables and lists more than 100 deep in one another"),
        (
            b'{"a":' * 200 + b"1" + b"}" * 200,
            "it has tables and lists more than 100 deep in one another",
        ),
        (b"[" + b"1," * 5_000_001 + b"1]", "it has more than 5,000,000 values and keys"),
        (b'{"a": NaN}', "it is not JSON"),
        (b'{"a": "\\ud800"}', "it is not JSON"),
        (b"[1]", "it holds no table"),
    ],
)
def test_json_is_bounded(text: bytes, message: str, model: Path, tmp_path: Path) -> None:
    place = change_card(model, tmp_path)
    (place / "card.json").write_bytes(text)
    with pytest.raises(vi.InputError, match=f"card.json: .*{message}"):
        vi.recognition.load_recogniser(place)


# graphs


def with_graph(model: Path, change: Callable[[Any], Any]) -> vi.recognition.Recogniser:
    """The saved model with another graph."""
    known = vi.recognition.load_recogniser(model)
    model = onnx.load_model_from_string(known.graph)
    change(model)
    return vi.recognition.Recogniser(known.card, model.SerializeToString())


def with_probabilities(factor: float) -> Callable[[Any], None]:
    def change(model: Any) -> None:
        model.graph.initializer.append(
            numpy_helper.from_array(np.array(factor, np.float32), "factor")
        )
        after_probabilities(
            model, helper.make_node("Mul", ["inner_probabilities", "factor"], ["probabilities"])
        )

    return change


def with_loop(model: Any) -> None:
    add_loop(model, random.Random(0))


def with_large_tensor(model: Any) -> None:
    model.graph.initializer.append(numpy_helper.from_array(np.array([10**12]), "count"))
    after_probabilities(model, helper.make_node("ConstantOfShape", ["count"], ["probabilities"]))


def doubled(model: Any) -> None:
    names = ["inner_probabilities", *(f"doubled{number}" for number in range(40))]
    nodes = [
        helper.make_node("Concat", [one, one], [other], axis=0) for one, other in pairwise(names)
    ]
    after_probabilities(model, *nodes, helper.make_node("Identity", [names[-1]], ["probabilities"]))


def with_external_data(model: Any) -> None:
    tensor = model.graph.initializer.add(
        name="more", data_type=1, data_location=onnx.TensorProto.EXTERNAL
    )
    tensor.external_data.add(key="location", value="/dev/zero")


def without_features(model: Any) -> None:
    model.graph.input[0].type.tensor_type.shape.dim[1].dim_value = 3


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            with_probabilities(np.nan),
            "the model gives .nan, nan. for a signal; probabilities are from 0 "
            "to 1, and add up to 1",
        ),
        (
            with_probabilities(-1.0),
            "the model gives .* for a signal; probabilities are from 0 to 1",
        ),
        (with_probabilities(1.5), "the model gives .* for a signal; probabilities are from 0 to 1"),
        (
            with_loop,
            'the operator "Loop" of the graph has an attribute "body" that is no number or text',
        ),
        (
            with_large_tensor,
            'the graph uses the operator "ConstantOfShape" as no classifier of this program does',
        ),
        (doubled, "the results of the graph have more than 40000 numbers a signal"),
        (with_external_data, 'the constant "more" of the graph lies in another file'),
        (without_features, "the graph does not take the .* features of the card"),
        (
            lambda model: model.ClearField("graph"),
            "the graph takes 0 arrays; a model takes the features alone",
        ),
        (
            lambda model: model.graph.output.pop(),
            "the graph does not give a class and the probabilities of the 2 classes of the card",
        ),
    ],
)
def test_a_graph_is_checked_before_it_runs(
    change: Callable[[Any], None],
    message: str,
    model: Path,
    signals: vi.recognition.LabelledSignals,
) -> None:
    with pytest.raises(vi.InputError, match=message) as raised:
        vi.recognition.apply_recogniser(with_graph(model, change), signals)
    assert len(str(raised.value)) < 500


def test_trees_are_followed_to_their_leaves() -> None:
    """A branch that leads back would be followed without end."""
    nodes = {
        "treeids": [0, 0, 0],
        "nodeids": [0, 1, 2],
        "featureids": [0, 0, 0],
        "values": [0.5, 0.0, 0.0],
    }
    trees: dict[str, Any] = {f"nodes_{name}": np.array(values) for name, values in nodes.items()}
    trees |= {
        "nodes_modes": [b"BRANCH_LEQ", b"LEAF", b"LEAF"],
        "classlabels_int64s": np.array([0, 1]),
    }
    trees |= {
        "class_treeids": np.zeros(2, int),
        "class_nodeids": np.array([1, 2]),
        "class_ids": np.array([0, 1]),
        "class_weights": np.ones(2),
    }
    ends = {"nodes_truenodeids": np.array([1, 0, 0]), "nodes_falsenodeids": np.array([2, 0, 0])}
    check = CLASSIFIERS["TreeEnsembleClassifier"]
    assert check({**trees, **ends}, 10, 3, 2) == [(10,), (10, 2)]
    for change, message in (
        ({"nodes_truenodeids": np.array([0, 0, 0])}, "trees that do not end"),
        ({"nodes_truenodeids": np.array([2, 0, 0])}, "nodes that two branches lead to"),
        ({"nodes_truenodeids": np.array([7, 0, 0])}, "refers to nodes that there are not"),
        ({"nodes_featureids": np.array([3, 0, 0])}, "nodes_featureids that are not from 0 to 2"),
        ({"class_ids": np.array([0, 2])}, "class_ids that are not from 0 to 1"),
        ({"class_nodeids": np.array([0, 2])}, "weights of nodes that are no leaves"),
        ({"class_weights": np.array([1.0, np.nan])}, "numbers that are not finite"),
    ):
        with pytest.raises(vi.InputError, match=message):
            check({**trees, **ends, **change}, 10, 3, 2)


def test_bytes_that_would_grow_are_refused_before_they_are_parsed() -> None:
    """Two million nodes of two bytes each take 300 MB as objects."""
    nodes = b"\x0a\x00" * 2_100_000
    size = bytes(
        [
            len(nodes) & 127 | 128,
            len(nodes) >> 7 & 127 | 128,
            len(nodes) >> 14 & 127 | 128,
            len(nodes) >> 21,
        ]
    )
    with pytest.raises(vi.InputError, match="the graph has a table of 200,000 fields or more"):
        check_size(b"\x3a" + size + nodes)
    with pytest.raises(vi.InputError, match="the graph has more than 4 MB beside its numbers"):
        check_size(b"\x0a" + size + nodes)
