"""The parameters of a law: declared, checked, and taken from the bodies.

They are the fields of a dataclass. Where a case leaves them out, they follow from the bodies.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.contact.docstring import with_parameters
from vibroimpact.contact.pair import ContactPair
from vibroimpact.errors import InputError, choices
from vibroimpact.ranges import Range


def parameter(
    meaning: str,
    unit: str = "",
    *,
    detail: str = "",
    from_pair: str | None = None,
    default: Any = dataclasses.MISSING,
    example: float | None = None,
    **bounds: float,
) -> Any:
    """Declare a parameter of a law, or a property of an instrument.

    Parameters
    ----------
    meaning : str
        What it is, in a few words of plain text; messages and the JSON schema print it.
    unit : str, default ""
        SI unit; "N/m^n" follows the exponent.
    detail : str, optional
        What it is, in sentences with reStructuredText markup; the law's docstring, sheet and page
        print it. Left out, it is the meaning as a sentence.
    from_pair : str, optional
        The attribute of `ContactPair` from which the parameter is taken where a case leaves it out.
    default : optional
        The default value.
    example : float, optional
        A typical value, for figures and tests, of a parameter with neither `from_pair` nor
        `default`.
    **bounds : float
        The range, in the arguments of `Range`.
    """
    return dataclasses.field(
        default=default,
        metadata=_metadata(meaning, unit, detail, Range(**bounds), from_pair, example),
    )


def memory(meaning: str, unit: str = "", *, detail: str = "") -> Any:
    """Declare a state variable that a law carries through a contact.

    It is at least zero, and zero in a fresh contact.

    Parameters
    ----------
    meaning, unit, detail : str
        As those of `parameter`.
    """
    return dataclasses.field(
        default=0.0,
        metadata={**_metadata(meaning, unit, detail, Range(at_least=0)), "memory": True},
    )


def inherited_parameter(
    base: type[Parameters], name: str, *, detail: str = "", **bounds: float
) -> Any:
    """Declare a parameter or state of a base class again.

    Its detail or range is another one; the rest is kept.

    Parameters
    ----------
    base : type of ContactLaw
        The class that declares it.
    name : str
        Its name.
    detail : str, optional
        As that of `parameter`.
    **bounds : float
        The new range; left out, the range is kept.
    """
    item = base.__dataclass_fields__[name]
    metadata = dict(item.metadata)
    if detail:
        metadata["detail"] = detail
    if bounds:
        metadata["range"] = Range(**bounds)
    return dataclasses.field(default=item.default, metadata=metadata)


def _metadata(
    meaning: str,
    unit: str,
    detail: str,
    allowed: Range,
    from_pair: str | None = None,
    example: float | None = None,
) -> dict[str, Any]:
    return {
        "meaning": meaning,
        "detail": detail or f"{meaning[:1].upper()}{meaning[1:]}.",
        "unit": unit,
        "range": allowed,
        "from_pair": from_pair,
        "example": example,
        "memory": False,
    }


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Base of contact and friction laws.

    Their parameters are floats, or arrays with one value per drop.
    """

    name: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]

    function_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    """The functions of floats of a law, `scalar_...`, which compiled code calls, and the methods
    for arrays that stand for each in a law that is not compiled. The methods evaluate
    `_array_...`: the functions of the law, or those of its base where the law defines the methods
    anew.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        for function, methods in cls.function_methods.items():
            if getattr(cls, function) is not None:
                setattr(
                    cls, function.replace("scalar", "_array"), staticmethod(getattr(cls, function))
                )
            if function not in vars(cls) and any(method in vars(cls) for method in methods):
                setattr(cls, function, None)  # compiled code would pass over the new method
        items: dict[str, dataclasses.Field[Any]] = {}
        for base in reversed(cls.__mro__[1:]):
            items |= getattr(base, "__dataclass_fields__", {})
        # `dataclass` decorates the class after this: its own fields are still class attributes
        for name, attribute in vars(cls).items():
            if isinstance(attribute, dataclasses.Field):
                items[name] = attribute
        # class variables are fields as well, without a meaning
        declared = {name: item for name, item in items.items() if "meaning" in item.metadata}
        if cls.__doc__:  # None under python -OO
            cls.__doc__ = with_parameters(cls.__doc__, declared)

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, (str, bytes)):
                raise InputError(
                    f'"{value!s}" is a text; it must be a number in SI, or an array of them',
                    item.name,
                )
            if isinstance(value, (list, tuple)):
                value = np.asarray(value, dtype=float)
                object.__setattr__(self, item.name, value)
            try:
                if value is not None:
                    item.metadata["range"].check(value, item.metadata["unit"])
            except InputError as error:
                raise InputError(error.message, item.name) from None

    @classmethod
    def missing_functions(cls) -> list[str]:
        """Return the names of the functions of floats that the law lacks; it is compiled
        if it has all.
        """
        return [function for function in cls.function_methods if getattr(cls, function) is None]

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """The numbers that the functions of floats take, made once from parameters and memory.

        They are floats, or arrays with one value per drop; compiled code has them as an array of
        floats, one drop at a time.
        """
        return ()

    def memories(self) -> dict[str, Array]:
        """Return the state variables by name."""
        return {
            item.name: getattr(self, item.name) for item in fields(self) if item.metadata["memory"]
        }

    @classmethod
    def example(cls, pair: ContactPair) -> Self:
        """Return the law of a pair, for figures and tests.

        Parameters that the pair does not give have typical values.
        """
        typical_values = {}
        for item in fields(cls):
            source = item.metadata["from_pair"]
            is_of_pair = source and getattr(pair, source) is not None
            if item.metadata["example"] is not None and not is_of_pair:
                typical_values[item.name] = item.metadata["example"]
        return cls.for_pair(pair, **typical_values)

    @classmethod
    def for_pair(cls, pair: ContactPair, **parameters: Any) -> Self:
        """Return the law of two bodies.

        Parameters that are not given come from the pair or from their defaults.

        Raises
        ------
        InputError
            If a parameter is unknown, missing, outside its range, or can't be taken from the pair.
        """
        items = {item.name: item for item in fields(cls)}
        for key in parameters:
            if key not in items:
                raise InputError(
                    f'unknown key "{key}"; {cls.name} takes {choices(items, key)}', key
                )
        values = dict(parameters)
        for key, item in items.items():
            if key not in values and item.metadata["from_pair"]:
                values[key] = cls._value_of_pair(pair, item)
            if key not in values and item.default is dataclasses.MISSING:
                raise InputError(f"this key is missing; {cls.name} needs {_with_unit(item)}", key)
        return cls(**values)

    @classmethod
    def _value_of_pair(cls, pair: ContactPair, item: dataclasses.Field[Any]) -> Any:
        """Return the value that a parameter takes from the bodies.

        Raises
        ------
        InputError
            If the pair has none, or an infinite one, as two rigid materials do.
        """
        source = item.metadata["from_pair"]
        value = getattr(pair, source)
        if value is None:
            need = f"{cls.name} needs {_with_unit(item)}, and"
            if source not in ("yield_strength", "yield_pressure"):
                raise InputError(f"{need} the pair of bodies has none; give it here", item.name)
            raise InputError(
                f"{need} neither material has a yield_strength to take it from; "
                f"give it here, or give one of the materials a yield_strength",
                item.name,
            )
        if np.any(np.isinf(value)):
            if source in ("effective_radius", "effective_mass"):
                reason = "that of the pair is infinite"
            else:
                reason = "two rigid materials have no contact stiffness of their own"
            raise InputError(f"it must be given, since {reason}", item.name)
        return value

    def take(self, drops: Any) -> Self:
        """Return the law of selected drops of a batch: array parameters are indexed by `drops`."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return self.changed(
            {name: value[drops] for name, value in values.items() if np.ndim(value)}
        )

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with some fields replaced; the new values are not checked."""
        if not changes:
            return self
        copy = object.__new__(type(self))
        for item in fields(self):
            object.__setattr__(copy, item.name, changes.get(item.name, getattr(self, item.name)))
        return copy


def _with_unit(item: dataclasses.Field[Any]) -> str:
    """Return the meaning of a parameter with its unit, for messages."""
    meaning = str(item.metadata["meaning"])
    unit = item.metadata["unit"]
    return f"{meaning} [{unit}]" if unit else meaning
