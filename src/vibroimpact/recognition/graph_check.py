"""Checks the graph of a saved model before it runs: only what scikit-learn's classifiers become, of
known shapes, without loops.

Each result of the graph is followed with its shape, so that its memory is known before; trees are
followed from root to leaf.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.recognition.extra import needs_extra
from vibroimpact.recognition.graph_classifiers import CLASSIFIERS, Attributes, one_of, with_length
from vibroimpact.recognition.graph_size import check_size

ROWS = 4096
"""Signals that a graph is given at once."""

_MOST_COLUMNS = 40_000
"""Numbers a signal, of all results of a graph."""

_MOST_NODES = 20_000
_FLOAT = 1
_NUMBERS = (1, 6, 7, 9, 11)
"""Types of ONNX: single precision; and those of constants (also whole numbers, truth
values and double precision).
"""

_DOMAINS = ("", "ai.onnx.ml")
_ML = "ai.onnx.ml"
_KINDS = {1: "f", 2: "i", 3: "s", 6: "floats", 7: "ints", 8: "strings"}
"""Types of attributes that hold no graph and no tensor, each with its field."""

Shape = tuple[int, ...]


def check_graph(data: bytes, features: int, classes: int) -> None:
    """Check that an ONNX graph is a classifier of this program.

    Parameters
    ----------
    data : bytes
        The graph.
    features, classes : int
        Number of features that it must take, and of classes of which it must give the probability.

    Raises
    ------
    InputError
        If it is damaged, or holds anything else than such a classifier does.
    """
    check_size(data)
    model = _parsed(data)
    graph = model.graph
    if model.functions or model.training_info or graph.sparse_initializer:
        raise InputError(
            "the graph holds functions, training or sparse tensors, as no model of this "
            "program does; train it anew"
        )
    if len(graph.node) > _MOST_NODES:
        raise InputError(
            f"the graph has {len(graph.node)} nodes; {_MOST_NODES} are the "
            "most; train the model anew"
        )
    constants = _constants(graph.initializer)
    known: dict[str, Shape] = {name: values.shape for name, values in constants.items()}
    known[_input_name(graph, features)] = (ROWS, features)
    columns = 0
    for node in graph.node:
        shapes = _shapes_of(node, known, constants, features, classes)
        for name, shape in zip(node.output, shapes, strict=False):
            if name in known:
                raise InputError(f"the graph gives {quoted(name)} twice; train the model anew")
            known[name] = shape
            columns += -(-prod(shape) // ROWS)
        if columns > _MOST_COLUMNS:
            raise InputError(
                f"the results of the graph have more than {_MOST_COLUMNS} numbers a "
                "signal; no model of this program has so many"
            )
    _check_outputs(graph, known, classes)


def _parsed(data: bytes) -> Any:
    with needs_extra():
        import onnx
    try:
        return onnx.load_model_from_string(data)
    except Exception:  # of protobuf, whose classes differ by version
        raise InputError("the graph is damaged: it is no model in ONNX") from None


def _constants(initializers: Sequence[Any]) -> dict[str, NDArray[Any]]:
    """Return the constants of a graph by name."""
    from onnx import TensorProto, numpy_helper

    constants: dict[str, NDArray[Any]] = {}
    for tensor in initializers:
        name = quoted(tensor.name)
        if tensor.data_location == TensorProto.EXTERNAL or tensor.external_data:
            raise InputError(
                f"the constant {name} of the graph lies in another file; train the model anew"
            )
        if tensor.name in constants:
            raise InputError(f"the graph gives {name} twice; train the model anew")
        if tensor.data_type not in _NUMBERS or len(tensor.dims) > 1:
            raise InputError(
                f"the constant {name} of the graph is not a number or a list of numbers; "
                "train the model anew"
            )
        try:
            constants[tensor.name] = numpy_helper.to_array(tensor)
        except Exception:  # of many types, by what is damaged
            raise InputError(
                f"the constant {name} of the graph does not have as many values as it "
                "states; train the model anew"
            ) from None
    return constants


def _input_name(graph: Any, features: int) -> str:
    if len(graph.input) != 1:
        raise InputError(
            f"the graph takes {len(graph.input)} arrays; a model takes "
            "the features alone: train it anew"
        )
    (given,) = graph.input
    kind = given.type.tensor_type
    dimensions = [dimension.dim_value for dimension in kind.shape.dim]
    if (
        kind.elem_type != _FLOAT
        or len(dimensions) != 2
        or dimensions[0]
        or dimensions[1] != features
    ):
        raise InputError(
            f"the graph does not take the {features} features of the card, in single "
            "precision; train the model anew"
        )
    return str(given.name)


def _check_outputs(graph: Any, known: Mapping[str, Shape], classes: int) -> None:
    names = [output.name for output in graph.output]
    if len(names) != 2 or [known.get(name) for name in names] not in (
        [(ROWS,), (ROWS, classes)],
        [(ROWS, 1), (ROWS, classes)],
    ):
        raise InputError(
            f"the graph does not give a class and the probabilities of the {classes} "
            "classes of the card; train the model anew"
        )


def _attributes(node: Any) -> Attributes:
    """Return the attributes of a node: numbers, texts and arrays of them."""
    attributes: Attributes = {}
    for attribute in node.attribute:
        field = _KINDS.get(attribute.type)
        if attribute.name in attributes:
            raise InputError(
                f"{_name(node)} of the graph has two attributes {quoted(attribute.name)}; "
                "train the model anew"
            )
        if field is None or attribute.ref_attr_name:
            message = (
                f"{_name(node)} of the graph has an attribute {quoted(attribute.name)} that is "
                "no number or text"
            )
            raise InputError(f"{message}; train the model anew")
        value = getattr(attribute, field)
        if field == "floats":
            value = np.fromiter(value, float, len(value))
        elif field == "ints":
            value = np.fromiter(value, np.int64, len(value))
        elif field == "strings":
            value = list(value)
        attributes[attribute.name] = value
    return attributes


def _shapes_of(
    node: Any,
    known: Mapping[str, Shape],
    constants: Mapping[str, NDArray[Any]],
    features: int,
    classes: int,
) -> list[Shape]:
    """Return the shapes of the results of a node, after a check that it is one of a classifier."""
    name = _name(node)
    attributes = _attributes(node)
    missing = [given for given in node.input if given not in known]
    if missing:
        raise InputError(
            f"{name} of the graph takes {quoted(missing[0])}, which nothing before it "
            "gives; train the model anew"
        )
    inputs = [known[given] for given in node.input]
    try:
        if node.domain == _ML and node.op_type in CLASSIFIERS and inputs == [(ROWS, features)]:
            return CLASSIFIERS[node.op_type](attributes, ROWS, features, classes)
        if (node.domain, node.op_type) in _OPERATORS:
            allowed, shape_of = _OPERATORS[node.domain, node.op_type]
            if attributes.keys() <= allowed:
                return [
                    shape_of(inputs, attributes, [constants.get(given) for given in node.input])
                ]
    except InputError as error:
        raise InputError(f"{name} of the graph {error}; train the model anew") from None
    except (ValueError, IndexError, KeyError, TypeError):
        raise InputError(
            f"{name} of the graph does not fit its inputs; train the model anew"
        ) from None
    raise InputError(
        f"the graph uses {name} as no classifier of this program does; train the model anew"
    )


def _name(node: Any) -> str:
    domain = ""
    if node.domain not in _DOMAINS:
        domain = f" of {quoted(node.domain)}"
    return f"the operator {quoted(node.op_type)}{domain}"


# shapes of the results of operators

Constants = Sequence["NDArray[Any] | None"]


def _same(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    (shape,) = inputs
    return shape


def _broadcast(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    return np.broadcast_shapes(*inputs)


def _normalised(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    one_of(attributes, "norm", (b"L1",))
    return _same(inputs, attributes, constants)


def _filled(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    (shape,) = inputs
    with_length(attributes, "imputed_value_floats", shape[1])
    return shape


def _scaled(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    (shape,) = inputs
    for key in ("offset", "scale"):
        with_length(attributes, key, shape[1])
    return shape


def _extracted(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    (shape, places), (_, chosen) = inputs, constants
    if chosen is not None and not ((chosen >= 0) & (chosen < shape[-1])).all():
        raise InputError("takes a column that there is not")
    return (*(shape[:-1] or (1,)), prod(places))


def _joined(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    axis = int(attributes["axis"])
    first = inputs[0]
    if len({(*shape[:axis], *shape[axis + 1 :]) for shape in inputs}) != 1 or not 0 <= axis < len(
        first
    ):
        raise InputError("joins what does not fit")
    return (*first[:axis], sum(shape[axis] for shape in inputs), *first[axis + 1 :])


def _reduced(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    """Return the shape of what takes one number of each row."""
    if "axis" in attributes:
        axes = [int(attributes["axis"])]
    else:
        axes = np.atleast_1d(constants[1]).tolist()  # type: ignore[arg-type]
    if axes not in ([1], [-1]) or attributes.get("keepdims", 1) != 1 or len(inputs[0]) != 2:
        raise InputError("does not work along the rows")
    return (inputs[0][0], 1)


def _flattened(inputs: Sequence[Shape], attributes: Attributes, constants: Constants) -> Shape:
    target = constants[1]
    if target is None or target.tolist() != [-1]:
        raise InputError("gives another shape than a list")
    return (prod(inputs[0]),)


_OPERATORS: dict[
    tuple[str, str], tuple[set[str], Callable[[Sequence[Shape], Attributes, Constants], Shape]]
] = {
    (_ML, "Imputer"): ({"imputed_value_floats", "replaced_value_float"}, _filled),
    (_ML, "Scaler"): ({"offset", "scale"}, _scaled),
    (_ML, "Normalizer"): ({"norm"}, _normalised),
    (_ML, "ArrayFeatureExtractor"): (set(), _extracted),
    ("", "ArgMax"): ({"axis", "keepdims", "select_last_index"}, _reduced),
    ("", "ReduceSum"): ({"keepdims", "noop_with_empty_axes"}, _reduced),
    ("", "Concat"): ({"axis"}, _joined),
    ("", "Reshape"): ({"allowzero"}, _flattened),
    ("", "Cast"): ({"to", "saturate", "round_mode"}, _same),
    **{("", name): (set(), _same) for name in ("Identity", "Neg", "Abs", "Exp", "Not")},
    **{("", name): (set(), _broadcast) for name in ("Add", "Sub", "Mul", "Div", "Less", "Sum")},
}
