"""Tables and sentences of a calibration of a contact law."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike

from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.contact_law.differences import (
    COMPARED,
    WAYS,
    differences,
    largest_misfit,
)
from vibroimpact.calibration.fit.tunables import law_parameter
from vibroimpact.calibration.observed.inputs import inputs_sentence
from vibroimpact.calibration.observed.matchable import MATCHABLE, REBOUNDS
from vibroimpact.cases.fields.contact import varies_with_speed
from vibroimpact.contact.speed_function import toml_of
from vibroimpact.report.report import Table, first_rows, table_of
from vibroimpact.runs.tables import formatted_column
from vibroimpact.units.display import (
    column_texts,
    digits,
    fixed,
    known_text,
    known_texts,
    largest,
    text,
)

_MET = 1e-3  # relative deviation up to which the target is met
_POWERS = ("", " v", " v²", " v³")
_MEANING = {
    "constant": "the value of the first impact throughout",
    "variable": "each impact its own value",
    "function": "the polynomial of the approach speed",
}


def values_table(calibration: Calibration) -> Table:
    """Return the table of the matched impacts."""
    seen = calibration.observations
    headers = [("", ""), ("Approach speed", "m/s"), (calibration.parameter, calibration.unit)]
    if seen.measured:
        speeds = known_texts(seen.speeds, seen.speed_deviations, 5)
    else:
        speeds = column_texts(seen.speeds)
    if calibration.intervals is None:
        columns = [list(seen.labels), speeds, column_texts(calibration.values, 6)]
    else:
        headers.append((f"Interval, {_percent(calibration.confidence)}", calibration.unit))
        half = 0.5 * np.ptp(calibration.intervals, axis=1)
        ends = zip(*(known_texts(end, half) for end in calibration.intervals.T), strict=True)
        columns = [
            list(seen.labels),
            speeds,
            known_texts(calibration.values, half),
            [f"{low} to {high}" for low, high in ends],
        ]
    if calibration.as_given:
        headers.append(("As the case gives it", calibration.unit))
        columns.append(column_texts(calibration.given, 6))
    for name in calibration.weights:
        header = MATCHABLE[name].phrase.capitalize()
        unit, cells = formatted_column(
            MATCHABLE[name].column, np.concatenate([seen.wanted[name], calibration.outcomes[name]])
        )
        headers += [(f"{header} of the target", unit), ("calibrated", unit)]
        columns += [cells[: len(seen.speeds)], cells[len(seen.speeds) :]]
        if calibration.as_given:
            headers.append(("as given, off by", "%"))
            columns.append(_off(calibration.as_given[name] / seen.wanted[name] - 1.0))
    rows = [list(row) for row in zip(*columns, strict=True)]
    return table_of(headers, first_rows(rows))


def differences_tables(calibration: Calibration) -> list[Table]:
    """Return for each compared quantity a table with the deviations of each way of prescribing
    the value [%], a row per impact.

    None for a single impact, which is matched, and without a reference.
    """
    if len(calibration.drops["variable"]["impact"]) <= 1:
        return []
    deviations = differences(calibration)
    if "rebound_height_m" in deviations and "separation_speed_m_s" in deviations:
        del deviations["separation_speed_m_s"]  # equivalent to the rebound height
    headings = [("Impact", ""), *((way, "%") for way in WAYS)]
    tables = []
    for name, ways in deviations.items():
        number = len(next(iter(ways.values())))
        # written together, so that all columns have the same decimals
        texts = _off(np.concatenate([ways[way] for way in WAYS]))
        columns = np.reshape(texts, (len(WAYS), number))
        rows = [[str(impact), *cells.tolist()] for impact, cells in enumerate(columns.T, start=1)]
        tables.append(table_of(headings, first_rows(rows), title=COMPARED[name]))
    return tables


def function_words(calibration: Calibration) -> str:
    """Return the fitted polynomial as text.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.calibration.contact_law.calibrate import calibrate
    >>> found = calibrate(vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory"))
    >>> print(function_words(found).replace("\u2212", "-"))
    damping_max = 139.408 + 5.86289 v - 0.145602 v² [N s/m], v in m/s from 3.180 to 8.827
    """
    function = calibration.fit.function
    phrase = ""
    if calibration.observations.measured:
        half = calibration.fit.half_widths(calibration.confidence)
    else:
        half = np.zeros(function.degree + 1)
    for power, (value, spread) in enumerate(zip(function.coefficients, half, strict=True)):
        speed_power = f" v^{power}"
        if power < len(_POWERS):
            speed_power = _POWERS[power]
        term = f"{known_text(abs(value), float(spread))}{speed_power}"
        if not phrase:  # the first term has a sign only if it is negative
            phrase = f"\u2212{term}" if value < 0.0 else term
        else:
            sign = "\u2212" if value < 0.0 else "+"
            phrase += f" {sign} {term}"
    unit = f" [{calibration.unit}]" if calibration.unit else ""
    if not function.degree:
        return f"{calibration.parameter} = {phrase}{unit}"
    speeds = f"v in m/s from {digits(function.slowest)} to {digits(function.fastest)}"
    return f"{calibration.parameter} = {phrase}{unit}, {speeds}"


def fit_sentences(calibration: Calibration) -> list[str]:
    """Return sentences on the uncertainty of the polynomial, or on its largest deviation."""
    fit = calibration.fit
    seen = calibration.observations
    sentences = list(seen.notes)
    if seen.measured:
        half = fit.half_widths(calibration.confidence)
        if np.isfinite(half).all():
            deviations = ", ".join(digits(value, 2) for value in half)
            sentences.append(
                "Uncertainty of its coefficients: ± "
                f"{deviations} at {_percent(calibration.confidence)}."
            )
        if calibration.bootstrap:
            way = f"by bootstrap with {calibration.bootstrap} draws"
        else:
            way = "to first order"
        if calibration.intervals is not None:
            source = "the scatter of the measurement"
            if seen.deviations_known:
                source = seen.noise_from
            sentences.append(f"Intervals are {way}, from {source}.")
        if seen.effects is not None and (
            calibration.intervals is not None or np.isfinite(half).all()
        ):
            sentences.append(inputs_sentence(seen.effects.inputs))
        if seen.deviations_known and np.isfinite(fit.scatter):
            sentences.append(
                f"Residuals are {digits(fit.scatter, 3)} times as large "
                "as their standard deviations."
            )
    else:
        where = "at the impacts"
        if calibration.curve is not None:
            where = "over these speeds"
        sentences.append(
            f"Its largest deviation is {digits(largest_misfit(calibration), 3)} {calibration.unit} "
            f"{where}.".replace("  ", " ")
        )
    if fit.function.degree and calibration.parameter in {
        item.name for item in fields(calibration.problem.laws[0]) if varies_with_speed(item)
    }:
        sentences.append(f"In a case: {calibration.parameter} = {toml_of(fit.function)}")
    return sentences


def given_sentences(calibration: Calibration) -> list[str]:
    """Return sentences on the deviation with the value given by the case, and on other
    parameters that would meet the target.
    """
    if not calibration.as_given:
        return []
    sentences = []
    missed = False
    for name in calibration.weights:
        wanted = calibration.observations.wanted[name]
        comes = calibration.as_given[name]
        off = comes / wanted - 1.0
        if np.all(np.abs(off) < 1e-6):
            continue
        worst = int(np.nanargmax(np.abs(off)))
        if calibration.intervals is None:
            half = 0.0
        else:
            half = float(0.5 * np.ptp(calibration.intervals[worst]))
        texts = (
            digits(calibration.given[worst], 6),
            known_text(float(calibration.values[worst]), half),
        )
        given, meets = (f"{value} {calibration.unit}".rstrip() for value in texts)
        phrase = (
            f"With {calibration.parameter} = {given}, as the case gives it, the "
            f"{MATCHABLE[name].phrase} of {calibration.observations.labels[worst]}"
        )
        instead, asked = (
            text(float(value), MATCHABLE[name].unit, 5) for value in (comes[worst], wanted[worst])
        )
        misses = abs(off[worst]) > _MET
        within = calibration.intervals is not None and bool(
            np.prod(calibration.intervals[worst] - calibration.given[worst]) <= 0.0
        )
        verdict = ""
        if within:
            verdict = ", within the uncertainty of the measurement"
        elif misses:
            verdict = ", and does not meet the target"
        met = abs(calibration.outcomes[name][worst] / wanted[worst] - 1.0) <= _MET
        verb = "meets" if met else "comes nearest to"
        best = f"{calibration.parameter} = {meets} {verb} the target"
        sentences.append(
            f"{phrase} is {instead} instead of {asked}, a deviation of "
            f"{_off(off[worst])[0]} %{verdict}. {best}."
        )
        missed |= misses and not within
    if missed and calibration.others:
        each = [
            f"{name} = {digits(value, 6)} {law_parameter(calibration.problem, name).unit}".rstrip()
            for name, value in calibration.others.items()
        ]
        sentences.append(
            "Other values that meet it at the first impact, with the rest as given: "
            f"{'; '.join(each)}."
        )
    return sentences


def match_words(calibration: Calibration) -> str:
    """Return in words what was matched."""
    if len(calibration.weights) == 1:
        (name,) = calibration.weights
        reached = (
            np.abs(calibration.outcomes[name] / calibration.observations.wanted[name] - 1.0) <= _MET
        )
        where = ""
        if not reached.all():
            where = ", or comes nearest to it where noise puts it out of reach"
        return f"the {MATCHABLE[name].phrase} of each impact matches the target{where}"
    every = " and ".join(
        f"the {MATCHABLE[name].phrase} (weight {weight:g})"
        for name, weight in calibration.weights.items()
    )
    return (
        f"{every} of each impact are fitted to the target by a weighted "
        "least-squares fit of one value"
    )


def ways_words(calibration: Calibration) -> str:
    """Return in words the ways of prescribing the value."""
    if set(calibration.weights) & set(REBOUNDS):
        chain = ""
    else:
        chain = ". The rebound is not matched, so that the speeds of later impacts differ"
    return "; ".join(f"{way}: {_MEANING[way]}" for way in WAYS) + chain


def _off(parts: ArrayLike) -> list[str]:
    """Return fractions as percentages with the same decimals: three, or two if one is 10
    % or more.
    """
    percent = 100.0 * np.atleast_1d(np.asarray(parts, dtype=float))
    decimals = 3 if largest(percent) < 10.0 else 2
    return [fixed(float(value), decimals) for value in percent]


def _percent(confidence: float) -> str:
    return f"{100.0 * confidence:g} %"
