"""The target of a calibration: the drop under another law, or a measurement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.calibration.observed.matchable import REBOUND, REBOUNDS
from vibroimpact.calibration.observed.observations import Observations, from_table
from vibroimpact.calibration.observed.section import (
    CalibrateSection,
    FileTarget,
    HeightsTarget,
    ImpactTarget,
    RestitutionTarget,
)
from vibroimpact.calibration.records.evaluate_measurement import Measurement, evaluate
from vibroimpact.calibration.records.measured_case import (
    first_impact_measurement,
    heights_measurement,
    restitution_observations,
)
from vibroimpact.calibration.records.measured_file import file_measurement
from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.contact import ContactSection
from vibroimpact.cases.rigid.rigid_problem import by_speed_of, contact_laws_of, touch_speed
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError


def target_of(case: Case, problem: Problem, section: CalibrateSection) -> Problem | Observations:
    """Return the target: the drop under another law, or the evaluated measurement.

    Raises
    ------
    InputError
        If a file can't be read or contains no impacts (the message names the line), or the measured
        values are impossible.
    """
    target = section.target
    if isinstance(target, (HeightsTarget, ImpactTarget, FileTarget)):
        return evaluate(case, _measured(case, target, section), section.air)
    if section.air:
        raise InputError(
            "the target has no measured flights, which alone depend on air; leave this out", "air"
        )
    if isinstance(target, ContactSection):
        try:
            target_case = case.model_copy(update={"contact": target})
            return replace(
                problem, laws=contact_laws_of(target_case), by_speed=by_speed_of(target_case)
            )
        except InputError as error:
            raise InputError(error.message, error.key.replace("contact", "target", 1)) from None
    assert isinstance(target, RestitutionTarget)
    if isinstance(target.restitution, tuple):
        return restitution_observations(case, target)
    # an impulsive law is not defined with vibrating bodies: match the first impact, on bodies at
    # rest
    if problem.vibrates:
        speed = touch_speed(case)
        return from_table(
            np.array([speed]),
            {"separation_speed": np.array([target.restitution * speed])},
            None,
            ("impact 1",),
            of_the_drop=True,
        )
    return replace(problem, laws=(Newton(restitution=target.restitution),), by_speed={})


def _measured(
    case: Case, target: HeightsTarget | ImpactTarget | FileTarget, section: CalibrateSection
) -> Measurement:
    if isinstance(target, HeightsTarget):
        heights = np.array(target.rebound_heights)
        deviation = None
        if target.standard_deviation is not None:
            deviation = np.full(len(heights), target.standard_deviation)
        labels = tuple(f"impact {number + 1}" for number in range(len(heights)))
        return heights_measurement(case, heights, deviation, labels)
    if isinstance(target, ImpactTarget):
        return first_impact_measurement(case, target)
    by_rebound = set(section.match or REBOUND) <= set(REBOUNDS)
    return file_measurement(case, target, by_rebound)
