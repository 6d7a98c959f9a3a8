"""The [calibrate] section of a case: target, tuned law and parameter, and options."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, StrictBool, model_validator

from vibroimpact.calibration.observed.matchable import ALONG_PLATE, MATCHABLE, check_weights
from vibroimpact.cases.fields.contact import ContactSection, in_table, law_schema, read_contact
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.cases.fields.size_limits import FileName, Name, at_most
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.files.reading import FileKind, beginning, with_path
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

MOST_SPEEDS = 10_000
FRICTION = "friction."
"""Beginning of the names of parameters of the friction law."""

_MOST_PARAMETERS = 10

_POSITIVE = Range(above=0)
_Measured = Annotated[
    float, Quantity("", "restitution; noise may lift it a little above 1", _POSITIVE)
]
_Speed = Annotated[float, Quantity("m/s", "approach speed", _POSITIVE)]
_Restitution = Annotated[float, Quantity("", "restitution", Range(above=0, at_most=1))]
_Height = Annotated[
    float, Quantity("m", "height of the sphere's centre at the top of a rebound", _POSITIVE)
]


class RestitutionTarget(Section):
    """A restitution: one for every impact, or one at each of several approach speeds."""

    restitution: Annotated[
        _Restitution | tuple[_Measured, ...], at_most(MOST_SPEEDS, "restitutions")
    ] = Field(description="separation speed over approach speed")
    approach_speed: Annotated[tuple[_Speed, ...], at_most(MOST_SPEEDS, "speeds")] | None = Field(
        None,
        description="a list of speeds [m/s] at which each of several restitutions was measured",
    )
    standard_deviation: (
        Annotated[float, Quantity("", "standard deviation of each", _POSITIVE)] | None
    ) = None

    @model_validator(mode="after")
    def _paired(self) -> RestitutionTarget:
        several = self.restitution
        speeds = self.approach_speed
        if several == ():
            raise InputError(
                "the list is empty; give the restitutions, or the number "
                "that holds for every impact",
                "restitution",
            )
        if isinstance(several, tuple) and (speeds is None or len(speeds) != len(several)):
            have = "no approach_speed is given"
            if speeds is not None:
                have = f"there are {len(speeds)}"
            if len(several) > 1:
                need = f"{len(several)} restitutions need"
            else:
                need = "a list of one restitution needs"
            raise InputError(f"{need} as many approach speeds, and {have}", "approach_speed")
        if not isinstance(several, tuple) and (speeds or self.standard_deviation):
            key = "standard_deviation"
            if speeds:
                key = "approach_speed"
            raise InputError(
                "one restitution holds at any approach speed, and exactly; leave this out", key
            )
        return self


class HeightsTarget(Section):
    """Measured rebound heights, from the first impact on."""

    rebound_heights: Annotated[tuple[_Height, ...], at_most(MOST_SPEEDS, "heights")] = Field(
        min_length=1,
        description="a list of heights of the sphere's centre above the plate, one an impact [m]",
    )
    standard_deviation: (
        Annotated[float, Quantity("m", "standard deviation of each", _POSITIVE)] | None
    ) = None


class ImpactTarget(Section):
    """What was measured of the first impact of the drop."""

    max_force: Annotated[float, Quantity("N", "largest contact force", _POSITIVE)] | None = None
    max_indentation: Annotated[float, Quantity("m", "largest indentation", _POSITIVE)] | None = None
    duration: Annotated[float, Quantity("s", "duration of the contact", _POSITIVE)] | None = None
    separation_speed: (
        Annotated[float, Quantity("m/s", "speed after the impact", _POSITIVE)] | None
    ) = None
    rebound_height: _Height | None = None
    restitution: _Measured | None = None
    relative_deviation: (
        Annotated[
            float,
            Quantity(
                "", "standard deviation of each, as a fraction of it", Range(above=0, below=1)
            ),
        ]
        | None
    ) = None

    @model_validator(mode="after")
    def _one_rebound(self) -> ImpactTarget:
        given = [
            key
            for key in ("separation_speed", "rebound_height", "restitution")
            if getattr(self, key) is not None
        ]
        if len(given) > 1:
            raise InputError(f"{' and '.join(given)} are equivalent; give one of them", given[1])
        return self


class FileTarget(Section):
    """A file: impacts, rebound heights, a record of position, force or the sphere's
    acceleration, or one in which bounces are heard.
    """

    file: FileName = Field(
        description="a CSV file whose header names its columns with their units, a universal file "
        "(UFF 58) with a record, or a "
        "sound (WAV, FLAC, ...) or NetCDF file with a record of bounces"
    )
    function: str | None = Field(
        None,
        description="which function of a universal file, by its first line of identification or "
        "its number",
    )
    channel: str | None = Field(
        None,
        description="the channel with the bounces: of a sound or NetCDF file that has several, or "
        "of a file of another kind",
    )
    contact_duration: (
        Annotated[
            float, Quantity("s", "contact time of the impacts in a record of bounces", _POSITIVE)
        ]
        | None
    ) = None
    columns: str | None = Field(
        None,
        description="the columns of a table in place of its header, in order, such as "
        '"time=s,-,force=N", with - for one left out',
    )


Target = ContactSection | RestitutionTarget | HeightsTarget | ImpactTarget | FileTarget
_KEYS: dict[str, type[Section]] = {
    "file": FileTarget,
    "rebound_heights": HeightsTarget,
    **dict.fromkeys(
        ("max_force", "max_indentation", "duration", "separation_speed", "rebound_height"),
        ImpactTarget,
    ),
    "restitution": RestitutionTarget,
}


def _read_target(value: Any) -> Any:
    if isinstance(value, (ContactSection, Section)):
        return value
    if isinstance(value, str):
        return read_table(FileTarget, {"file": value})
    if not isinstance(value, dict):
        raise InputError(
            f"{quoted(value)} is not allowed; it must be a table with one of law, "
            f"{', '.join(_KEYS)}, or the name of a file"
        )
    if "law" in value:
        return read_contact(value)
    kind = next((key for key in _KEYS if key in value), None)
    if kind is None:
        keys = ["law", *_KEYS]
        hint = next((phrase for key in value if (phrase := did_you_mean(key, keys))), "")
        raise InputError(f"it needs one of {', '.join(keys)}.{hint}")
    return read_table(_KEYS[kind], value)


def _read_model(value: Any) -> Any:
    if isinstance(value, str):
        value = {"law": value}
    return read_contact(value)


def _read_match(value: Any) -> Any:
    if isinstance(value, str):
        value = {value: 1.0}
    if not isinstance(value, dict):
        known = ", ".join((*MATCHABLE, *ALONG_PLATE))
        raise InputError(
            f"{quoted(value)} is not allowed; it must be one of {known}, or a "
            "table of them with weights"
        )
    wrong = next(
        (
            weight
            for weight in value.values()
            if isinstance(weight, bool) or not isinstance(weight, (int, float))
        ),
        None,
    )
    if wrong is not None:
        raise InputError(
            f"{quoted(wrong)} is not allowed; the weights must be numbers, such as {{ "
            f"separation_speed = 1, max_force = 0.5 }}"
        )
    weights = {str(name): float(weight) for name, weight in value.items()}
    try:
        check_weights(weights)
    except InputError as error:
        raise InputError(error.message) from None
    return weights


class SpeedsTable(Section):
    """Approach speeds that the polynomial is fitted over."""

    start: Annotated[float, Quantity("m/s", "slowest", _POSITIVE)] = Field(alias="from")
    end: Annotated[float, Quantity("m/s", "fastest", _POSITIVE)] = Field(alias="to")
    number: Annotated[int, Field(ge=2, le=MOST_SPEEDS, strict=True)] = Field(
        50, description="number of speeds"
    )
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _rises(self) -> SpeedsTable:
        if not self.end > self.start:
            raise InputError(
                f"{self.end:g} m/s is not more than the first speed, {self.start:g} m/s", "to"
            )
        return self

    def values(self) -> np.ndarray:
        """Return the approach speeds [m/s]."""
        if self.scale == "linear":
            return np.linspace(self.start, self.end, self.number)
        return np.geomspace(self.start, self.end, self.number)


_LAW = "a contact law and its parameters"


def _target_schema() -> dict[str, Any]:
    file = {"type": "string", "description": "the name of a file with what was measured"}
    tables = [kind.model_json_schema() for kind in dict.fromkeys(_KEYS.values())]
    return {"anyOf": [file, {"description": _LAW, **law_schema()}, *tables]}


def _match_schema() -> dict[str, Any]:
    known = [*MATCHABLE, *ALONG_PLATE]
    weights = {
        "type": "object",
        "properties": {name: {"type": "number"} for name in known},
        "additionalProperties": False,
    }
    return {"anyOf": [{"enum": known}, weights]}


def _some_names(given: Any) -> Any:
    if given in ([], ()):
        raise InputError(
            f'the list is empty; name a parameter, such as "{FRICTION}coefficient", or '
            "leave the key out"
        )
    return given


class CalibrateSection(Section):
    """Settings of `vibroimpact calibrate`; a run ignores them."""

    target: Annotated[
        Any, BeforeValidator(_read_target), JsonSchema("target of the calibration", _target_schema)
    ] = Field(None, description="target of the calibration; by default the law of the case")
    model: Annotated[Any, BeforeValidator(_read_model), JsonSchema(_LAW, law_schema)] = Field(
        None,
        description="the tuned contact law; by default that of the case, or, without a target, "
        "Adams' IMPACT",
    )
    parameter: (
        Annotated[
            Name | tuple[Name, ...],
            BeforeValidator(_some_names),
            at_most(_MOST_PARAMETERS, "parameters"),
        ]
        | None
    ) = Field(
        None,
        description='the tuned parameter: one of the law, "sphere.damping" or "plate.damping"; or '
        "one or a list of those of the friction "
        'law, such as "friction.coefficient"; by default the loss parameter of the law',
    )
    air: StrictBool | None = Field(
        None,
        description="whether the sphere was measured in air: its flights then have the drag of "
        "drop.air, or of air at 20 C and sea "
        "level; without either key they are those in a vacuum, and a warning "
        "is given where drag matters",
    )
    match: Annotated[
        Any,
        BeforeValidator(_read_match),
        JsonSchema("matched quantity of an impact", _match_schema),
    ] = Field(
        None,
        description="the matched quantity: one, or a table of several with weights; by default the "
        "rebound, or all that was measured if that was not, and of friction the motion along the "
        "plate and the spin",
    )
    degree: Annotated[int, Field(ge=0, le=12, strict=True)] | None = Field(
        None,
        description="degree of the polynomial of the approach speed; by default 2, or less where "
        "there are fewer speeds",
    )
    speeds: SpeedsTable | None = Field(
        None,
        description="speeds over which the polynomial is fitted, instead of those of the impacts",
    )
    confidence: Annotated[
        float, Quantity("", "confidence level of the intervals", Range(above=0, below=1))
    ] = 0.95
    bootstrap: Annotated[int, Field(ge=0, le=100_000, strict=True)] | None = Field(
        None,
        description="number of bootstrap samples for the intervals, 0 or at least 20; by "
        "default 0, or some hundred where they are wide",
    )
    seed: Annotated[int, Field(ge=0, strict=True)] = Field(0, description="seed of the bootstrap")


def friction_names(parameter: Any) -> tuple[str, ...]:
    """Return the parameters of the friction law that are fitted together.

    There are none if the parameter is another one, or what a user wrote is not a name.

    Examples
    --------
    >>> friction_names("friction.coefficient"), friction_names("damping_max")
    (('friction.coefficient',), ())
    """
    if isinstance(parameter, (list, tuple)):
        return tuple(str(name) for name in parameter)
    if isinstance(parameter, str) and parameter.startswith(FRICTION):
        return (parameter,)
    return ()


def calibrate_table(section: CalibrateSection) -> dict[str, Any]:
    """Return the section as a table of the case file, in SI units."""
    table = section.model_dump(
        exclude_defaults=True, exclude={"target", "model"}, by_alias=True, mode="json"
    )
    laws = {
        name: value for name in ("target", "model") if (value := getattr(section, name)) is not None
    }
    return {**{name: _as_table(value) for name, value in laws.items()}, **table}


def _as_table(value: Target) -> dict[str, Any]:
    if isinstance(value, ContactSection):
        return {
            "law": value.law,
            **{name: in_table(parameter) for name, parameter in value.parameters.items()},
        }
    return value.model_dump(exclude_none=True, mode="json")


_MEASURED = FileKind(
    "what was measured is in a CSV, universal, sound or NetCDF file",
    500_000_000,
    "keep the part with the impacts",
)


def check_target(section: CalibrateSection | None) -> None:
    """Check that the file of a measurement, if there is one, can be read.

    Its contents are not evaluated.

    Raises
    ------
    InputError
        If it can't be read.
    """
    if section is not None and isinstance(section.target, FileTarget):
        try:
            beginning(section.target.file, _MEASURED, 1)
        except InputError as error:
            raise with_path(section.target.file, error, "calibrate.target") from None
