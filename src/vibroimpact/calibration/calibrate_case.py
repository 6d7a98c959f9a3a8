"""Calibrate a case with a [calibrate] section."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import fields, replace
from os import PathLike
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.calibration.contact_law.calibrate import calibrate
from vibroimpact.calibration.contact_law.calibration import DAMPINGS, Calibration
from vibroimpact.calibration.fit.calibrated_drops import impact_count
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.fit.tunables import law_parameter, modal_damping
from vibroimpact.calibration.fit.typed_inputs import Moved, moved_inputs, typed_inputs
from vibroimpact.calibration.friction.calibrate import FrictionCalibration, calibrate_friction
from vibroimpact.calibration.friction.measured import oblique_impacts_in_file
from vibroimpact.calibration.friction.parameters import friction_parameters
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.observed.section import (
    FRICTION,
    CalibrateSection,
    FileTarget,
    friction_names,
)
from vibroimpact.calibration.targets import target_of
from vibroimpact.cases.build import problem_of
from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.contact import read_contact
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.reader import case_of, load_table, prefix_errors
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import find_contact_law
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError, listed
from vibroimpact.results.result import result_of

MODEL = "adams-impact"
"""The law that is tuned by default."""

_LOCAL = tuple(LocalSection.model_fields)
"""Keys of [contact] that are not of the contact law, but of the contact itself."""

_COEFFICIENT = FrictionLaw.__dataclass_fields__["coefficient"].metadata["example"]
"""Initial guess of the coefficient of friction."""

_ANY_PAIR = ContactPair(1e9, 0.01, 0.01, 1e8, 0.3)
"""A pair of bodies with which the parameters of a law are tried."""

_FRICTION_TARGET = "a table of measured oblique impacts; give its file"


class ToCalibrate(NamedTuple):
    """A case whose contact law is to be tuned.

    Whether the case gives the value of the parameter, or it is only an initial guess; and the key
    under which the law was given.
    """

    case: Case
    given: bool
    law_at: str = "contact"


def load_calibration(
    source: str | PathLike[str], changes: Mapping[str, Any] | None = None
) -> ToCalibrate:
    """Read a case to calibrate from a file, as `load_case` does.

    The parameter to be found may be missing.

    Parameters
    ----------
    source : path or str
        A TOML file, or "paper:NAME".
    changes : mapping, optional
        Other values by dotted key, such as ``{"calibrate.degree": 1}``.

    Examples
    --------
    >>> load_calibration("paper:type1-theory").case.contact.law
    'adams-impact'
    >>> load_calibration("paper:calibration", {"calibrate.degree": 1}).case.calibrate.degree
    1
    """
    return prefix_errors(source, lambda: calibration_of(load_table(source, changes)))


def calibration_of(table: Mapping[str, Any]) -> ToCalibrate:
    """Read a case to calibrate from a mapping with the structure of a TOML case file.

    Raises
    ------
    InputError
        If it is not a valid case, or defines no target.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-constant").to_problem().source
    >>> what = vi.calibration.calibration_of(
    ...     {**case, "calibrate": {"target": {"restitution": 0.7}}}
    ... )
    >>> what.case.contact.law, what.case.calibrate.target.restitution
    ('adams-impact', 0.7)
    """
    whole = dict(table)
    section = whole.get("calibrate", {})
    if isinstance(section, dict):
        section = dict(section)
    contact: Any = whole.get("contact")
    readable = isinstance(section, dict) and isinstance(contact, dict)
    if not readable or not set(section) <= set(CalibrateSection.model_fields):
        return ToCalibrate(case_of(whole), True)  # which reports what is wrong
    model = section.pop("model", None)
    if isinstance(model, str):
        model = {"law": model}
    law_at = "contact" if model is None else "calibrate.model"
    own_target = "target" in section
    if not own_target:
        # the contact law of the case is the target, and the law to be tuned takes its place
        _check_own_law(contact, model, section)
        section["target"] = {key: value for key, value in contact.items() if key not in _LOCAL}
        model = {"law": MODEL} if model is None else model
    if isinstance(model, dict):
        local = {key: value for key, value in contact.items() if key in _LOCAL}
        contact = {**local, **model}
    elif model is not None:
        contact = model
    started = _with_start(contact, section.get("parameter"))
    whole["contact"] = started
    whole["calibrate"] = section
    try:
        return ToCalibrate(case_of(whole), started is contact, law_at)
    except InputError as error:
        raise InputError.of_several(
            _under_written_key(fault, own_target, model is not None) for fault in error.faults
        ) from None


def _check_own_law(contact: Mapping[str, Any], model: Any, section: Mapping[str, Any]) -> None:
    """Check that the contact law of the case can be the target."""
    names = friction_names(section.get("parameter"))
    if names:
        raise InputError(
            f"it is missing; {names[0]} is fitted to {_FRICTION_TARGET}", "calibrate.target"
        )
    if contact.get("law") == MODEL and model is None:
        raise InputError(
            f"there is no target, since the law of the case is {MODEL} itself; give a target, "
            "such as { restitution = 0.7 }",
            "calibrate.target",
        )


def calibrate_case(
    what: ToCalibrate,
    progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Calibration | FrictionCalibration:
    """Calibrate the contact law of a case, the damping of its elastic bodies, or its friction law.

    Parameters
    ----------
    what : ToCalibrate
        The case, as read by `load_calibration` or `calibration_of`.
    progress : callable, optional
        Called with the fraction done, in [0, 1].
    tell : callable, optional
        Called with a sentence if there is a problem with the store of modes.

    Raises
    ------
    InputError
        If no value matches the target, or the measurement can't be read.

    Examples
    --------
    >>> calibrate_case(load_calibration("paper:type1-theory")).values.round(3).tolist()
    [179.79, 172.746, 166.419, 160.869, 156.663]
    """
    case = what.case
    section = case.calibrate
    if section is None or section.target is None:
        raise InputError(
            "it is missing; it specifies what is matched, such as { restitution = 0.7 }",
            "calibrate.target",
        )
    if case.plate.motion is not None:
        raise InputError(
            "only impacts on a plate at rest can be matched; leave the motion out", "plate.motion"
        )
    problem = problem_of(case, progress, tell)
    names = friction_names(section.parameter)
    if not names:
        _check_contact_law(what, problem)
    calibration: Calibration | FrictionCalibration
    try:
        if names:
            calibration = _calibrated_friction(what, problem, section, names, progress)
        else:
            calibration = _calibrated_law(what, problem, section, progress)
    except InputError as error:
        raise InputError(error.message, f"calibrate.{error.key}".rstrip(".")) from None
    tuned = names
    if not isinstance(calibration, FrictionCalibration):
        tuned = (calibration.parameter,)
    # computed values are not checked for slips of units
    not_checked = {*tuned, *(f"contact.{name}" for name in tuned)}
    doubts = _doubts_of_a_run(calibration, not_checked)
    return replace(calibration, doubts=(*doubts, *calibration.doubts))


def _check_contact_law(what: ToCalibrate, problem: Problem) -> None:
    """Check that the contact law can be tuned impact by impact."""
    if problem.by_speed:
        name = next(iter(problem.by_speed))
        raise InputError(
            "a calibration begins from numbers, and takes no function of the approach speed; "
            "give a number in place of the function",
            f"{what.law_at}.{name}",
        )
    if problem.memory_lasts and impact_count(problem) > 1:
        raise InputError(
            f"{what.case.contact.law} leaves a dent that the next impact falls into, and each "
            "impact is matched on fresh surfaces; set it to false, or run.impacts = 1",
            "drop.same_spot",
        )


def _doubts_of_a_run(
    calibration: Calibration | FrictionCalibration, not_checked: Container[str]
) -> list[str]:
    """Return the doubts that a run of the calibrated case states.

    What is matched to a rebound may still exceed a limit of the theory.
    """
    problem = calibration.calibrated_case.to_problem()
    return result_of(simulate(problem)).doubts_but(not_checked)


def _calibrated_law(
    what: ToCalibrate,
    problem: Problem,
    section: CalibrateSection,
    progress: Callable[[float], None] | None,
) -> Calibration:
    parameter = section.parameter
    assert not isinstance(parameter, tuple)
    tunable = _tunable(problem, parameter)
    if not what.given:
        tunable = replace(tunable, given=np.full(1, np.nan))
    target = target_of(what.case, problem, section)

    def evaluated(case: Case) -> tuple[Observations, Tunable]:
        changed_problem = problem_of(case)
        seen = target_of(case, changed_problem, section)
        assert isinstance(seen, Observations)
        return seen, _tunable(changed_problem, parameter)

    moved: Sequence[Moved] = ()
    if isinstance(target, Observations) and target.measured:
        moved = moved_inputs(what.case, evaluated, target)
    speeds = None
    if section.speeds is not None:
        speeds = section.speeds.values()
    return calibrate(
        problem,
        target,
        tunable=tunable,
        moved=moved,
        weights=section.match,
        degree=section.degree,
        speeds=speeds,
        confidence=section.confidence,
        bootstrap=section.bootstrap,
        seed=section.seed,
        progress=progress,
    )


def _calibrated_friction(
    what: ToCalibrate,
    problem: Problem,
    section: CalibrateSection,
    names: tuple[str, ...],
    progress: Callable[[float], None] | None,
) -> FrictionCalibration:
    if not isinstance(section.target, FileTarget):
        raise InputError(f"{names[0]} is fitted to {_FRICTION_TARGET}", "target")
    for key in ("degree", "speeds", "air"):
        if getattr(section, key):
            raise InputError(
                f"{names[0]} is one number, fitted to single impacts; leave this out", key
            )
    # an error in the names is reported before one in the file
    friction_parameters(problem, names)
    calibration = calibrate_friction(
        problem,
        oblique_impacts_in_file(what.case, section.target, section.match),
        names,
        weights=section.match,
        confidence=section.confidence,
        bootstrap=section.bootstrap or 0,
        seed=section.seed,
        progress=progress,
    )
    unused = [typed.name for typed in typed_inputs(what.case) if typed.value.stated]
    if unused and calibration.intervals is not None:
        if len(unused) > 1:
            doubt = f"the standard deviations of {listed(unused)} are no part of these intervals"
        else:
            doubt = f"the standard deviation of {listed(unused)} is no part of these intervals"
        calibration = replace(calibration, doubts=(*calibration.doubts, doubt))
    if what.given:
        return calibration
    unknown = np.array([name == "coefficient" for name in calibration.parameters.names])
    given = np.where(unknown, np.nan, calibration.given)
    return replace(calibration, given=given, as_given={})


def _under_written_key(message: str, own_target: bool, own_model: bool) -> str:
    """Return an error message under the key that the user wrote.

    Target and law may come from [contact], the law from calibrate.model.
    """
    if not own_target and message.startswith("calibrate.target"):
        return message.replace("calibrate.target", "contact", 1)
    of_local = message.startswith(tuple(f"contact.{key}" for key in _LOCAL))
    if own_model and message.startswith("contact") and not of_local:
        return message.replace("contact", "calibrate.model", 1)
    return message


def _first(value: Any) -> Any:
    """Return a value, or the first of one for each impact."""
    return value[0] if isinstance(value, tuple) else value


def _with_start(contact: Any, parameter: Any) -> Any:
    """Return a [contact] section with an initial guess of the tuned parameter.

    It is the same object if it has a value.
    """
    names = friction_names(parameter)
    if names:
        return _with_coefficient(contact, names)
    try:
        section = read_contact(contact)
    except InputError:
        return contact  # reported when the case is read
    law = find_contact_law(section.law)
    if not isinstance(parameter, str) or parameter not in {field.name for field in fields(law)}:
        parameter = None  # one that is not known, or is no name, is reported later
    values = {key: _first(value) for key, value in section.parameters.items()}
    for field in fields(law):
        start = field.metadata["example"]
        if field.name in contact or start is None:
            continue
        if parameter is not None and field.name != parameter:
            continue
        try:
            tried_law = law.for_pair(_ANY_PAIR, **{**values, field.name: start})
        except InputError:
            continue
        if field.name == (parameter or tried_law.free_parameter):
            return {**contact, field.name: start}
    return contact


def _with_coefficient(contact: dict[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Return a [contact] section with an initial guess of the coefficient of friction.

    It is the same object if the coefficient is not tuned, or has a value.
    """
    friction = contact.get("friction")
    if not isinstance(friction, dict) or "coefficient" in friction:
        return contact
    law = friction_laws().get(str(friction.get("law")))
    known: set[str] = set()
    if law:
        known = {f"{FRICTION}{field.name}" for field in fields(law)}
    # an unknown parameter is reported later
    if f"{FRICTION}coefficient" not in names and known.issuperset(names):
        return contact
    return {**contact, "friction": {**friction, "coefficient": _COEFFICIENT}}


def _tunable(problem: Problem, parameter: str | None) -> Tunable:
    if parameter not in DAMPINGS:
        return law_parameter(problem, parameter)
    if parameter == "sphere.damping":
        return modal_damping(problem, "sphere")
    return modal_damping(problem, "plate")
