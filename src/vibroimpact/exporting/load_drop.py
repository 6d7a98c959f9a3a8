"""Load the drop of a result folder or of a calibration folder, for export."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact.calibration.contact_law.file_contents import CALIBRATION
from vibroimpact.cases.case import Case
from vibroimpact.cases.reader import case_of, load_case
from vibroimpact.cases.rigid.oblique import normal_motion_of, oblique_of
from vibroimpact.cases.rigid.plate_motion import motion_of
from vibroimpact.cases.rigid.rigid_problem import (
    by_speed_of,
    deforms,
    elastic_names,
    mass_of_sphere,
    rigid_problem,
)
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import laws_at_impacts
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.matched_rebound import matched_drop
from vibroimpact.files.check_sums import CHECK_SUMS, DamageError, check_file, read_sealed
from vibroimpact.files.hdf5 import short_reason
from vibroimpact.files.recover import recover
from vibroimpact.results.folder import load_result
from vibroimpact.results.result import Result, result_of


def load_drop(directory: str | PathLike[str]) -> Drop:
    """Return the drop of a result folder, or of the calibrated case of a calibration folder, which
    is simulated.

    Parameters
    ----------
    directory : path
        A result folder or a calibration folder.

    Raises
    ------
    InputError
        If it is neither, a file is missing or damaged, or the result is that of a problem defined
        in Python, which has no case.
    """
    folder = Path(directory)
    recover(folder)
    if (folder / CALIBRATION).is_file():
        return _of_calibration(folder)
    drop, _ = _drop_and_case(folder)
    return drop


def load_matched_drop(directory: str | PathLike[str], target: str) -> Drop:
    """Load the drop of a result folder, with Adams' IMPACT matched to a rebound.

    Parameters
    ----------
    directory : path
        A result folder.
    target : str
        Which rebound, a key of `MATCHES`: "rebound", of the run, or "contact", of its contact
        law alone.

    Raises
    ------
    InputError
        As `load_drop` and `matched_drop`, or if it is a calibration folder.
    """
    folder = Path(directory)
    recover(folder)
    if (folder / CALIBRATION).is_file():
        raise InputError(
            f"{folder}: a calibration is matched to its target already; leave --match out, or "
            "give the folder of a run"
        )
    drop, case = _drop_and_case(folder)
    return matched_drop(drop, case, target)


def _drop_and_case(folder: Path) -> tuple[Drop, Case]:
    """Return the drop of a result folder, and its case."""
    result = load_result(folder)
    if not result.case:
        raise InputError(
            f"{folder}: this run has no case.toml, as its problem was defined in Python; "
            "an export needs a case"
        )
    try:
        case = case_of(result.case)
        return drop_of_result(result, case), case
    except InputError as error:
        raise InputError(f"{folder / 'case.toml'}: {error}") from None


def drop_of_result(
    result: Result, case: Case, function: tuple[str, SpeedFunction] | None = None
) -> Drop:
    """Return the drop of a run, with the corresponding rigid-body problem if bodies deform or a
    function of the speed is given.

    Parameters
    ----------
    result : Result
        The result of the run.
    case : Case
        The case of the run.
    function : tuple of str and SpeedFunction, optional
        A parameter of the contact law as a function of the approach speed.
    """
    _check_flat(case)
    if function is not None and by_speed_of(case):
        message = (
            f"{function[0]} is fitted over the approach speed, and another parameter is given "
            "as a function of it"
        )
        raise InputError(
            f"{message}; give that as a number", f"contact.{next(iter(by_speed_of(case)))}"
        )
    deflection = result.deflection
    motion = normal_motion_of(case)
    rigid = None
    if deforms(case) or function is not None:
        rigid = rigid_problem(case)
    position = case.drop.position
    surface = {}
    if deflection is not None:
        # the impact point may be given as a node set of an imported mesh
        position = deflection.contact
        surface = {
            "time": deflection.time,
            "x": deflection.x,
            "y": deflection.y,
            "height": deflection.height.astype(float),
            "sphere_position": deflection.sphere_position,
        }
    return Drop(
        name=result.name,
        radius=float(case.sphere.radius),
        mass=mass_of_sphere(case),
        inertia_ratio=float(rigid_problem(case).inertia_ratio),
        sphere_material=case.sphere.material,
        plate_material=case.plate.material,
        plate_size=case.plate.size,
        position=position,
        height=float(motion.get("height", case.sphere.radius)),
        speed=float(motion.get("speed", 0.0 - motion.get("velocity", 0.0))),
        gravity=float(motion["gravity"]),
        oblique=oblique_of(case),
        motion=motion_of(case),
        in_air=case.drop.air is not None,
        in_liquid=case.contact.local.liquid is not None,
        laws=laws_at_impacts(rigid_problem(case), result.impacts["approach_speed_m_s"]),
        function=function,
        elastic=tuple(elastic_names(case)),
        local_element=case.contact.local.local_compliance == "identified",
        finite_sphere=case.contact.local.finite_sphere,
        rigid=rigid,
        end_time=float(result.history["time_s"][-1]),
        impacts=result.impacts,
        history=result.history,
        signals=result.signals,
        surface=surface,
        doubts=tuple(result.doubts),
    )


def _check_flat(case: Case) -> None:
    """Raise if the sphere falls on another sphere, which no export format supports."""
    if case.plate.radius is not None:
        raise InputError(
            "only a drop on a flat plate can be exported, and this sphere falls on another sphere",
            "plate.radius",
        )


def _of_calibration(folder: Path) -> Drop:
    """Return the drop of a calibration: its case, simulated, and the fitted function."""
    from vibroimpact.dynamics.simulate import simulate

    name = CALIBRATION
    try:
        table = read_sealed(folder / name)
        function = _fitted(table)
        name = "case.toml"
        check_file(folder / name, table.get(CHECK_SUMS, {}).get(name))
    except DamageError as error:
        raise InputError(f"{folder / name}: {error}; make the calibration anew") from None
    except KeyError as error:
        raise InputError(
            f"{folder / name}: the file is damaged: it has no {error}; make the calibration anew"
        ) from None
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise InputError(
            f"{folder / name}: the file is missing or damaged: {short_reason(error)}; make "
            "the calibration anew"
        ) from None
    case = load_case(folder / name)
    _check_flat(case)
    return drop_of_result(result_of(simulate(case.to_problem())), case, function)


def _fitted(calibration: dict[str, Any]) -> tuple[str, SpeedFunction] | None:
    """Return the fitted function; None if it is a constant, which the case holds, or not
    of a parameter of the contact law.
    """
    if "parameters" in calibration:  # of the friction
        return None
    fit = calibration["fit"]
    coefficients = tuple(float(coefficient) for coefficient in fit["coefficients"])
    if len(coefficients) == 1 or "." in calibration["parameter"]:
        return None
    return str(calibration["parameter"]), SpeedFunction(
        coefficients, float(fit["from_speed_m_s"]), float(fit["to_speed_m_s"])
    )
