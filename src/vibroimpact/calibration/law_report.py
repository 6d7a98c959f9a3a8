"""Tables and sentences of a calibration of a contact law."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.differences import COMPARED, WAYS, differences, largest_misfit
from vibroimpact.calibration.inputs import inputs_sentence
from vibroimpact.calibration.matchable import MATCHABLE, REBOUNDS
from vibroimpact.calibration.tunables import law_parameter
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


def values_table(found: Calibration) -> Table:
    """Return the table of the matched impacts."""
    seen = found.observations
    headers = [("", ""), ("Approach speed", "m/s"), (found.parameter, found.unit)]
    speeds = (
        known_texts(seen.speeds, seen.speed_deviations, 5)
        if seen.measured
        else column_texts(seen.speeds)
    )
    if found.intervals is None:
        columns = [list(seen.labels), speeds, column_texts(found.values, 6)]
    else:
        headers.append((f"Interval, {_percent(found.confidence)}", found.unit))
        half = 0.5 * np.ptp(found.intervals, axis=1)
        ends = zip(*(known_texts(end, half) for end in found.intervals.T), strict=True)
        columns = [
            list(seen.labels),
            speeds,
            known_texts(found.values, half),
            [f"{low} to {high}" for low, high in ends],
        ]
    if found.as_given:
        headers.append(("As the case gives it", found.unit))
        columns.append(column_texts(found.given, 6))
    for name in found.weights:
        header = MATCHABLE[name].phrase.capitalize()
        unit, cells = formatted_column(
            MATCHABLE[name].column, np.concatenate([seen.wanted[name], found.outcomes[name]])
        )
        headers += [(f"{header} of the target", unit), ("calibrated", unit)]
        columns += [cells[: len(seen.speeds)], cells[len(seen.speeds) :]]
        if found.as_given:
            headers.append(("as given, off by", "%"))
            columns.append(_off(found.as_given[name] / seen.wanted[name] - 1.0))
    rows = [list(row) for row in zip(*columns, strict=True)]
    return table_of(headers, first_rows(rows))


def differences_tables(found: Calibration) -> list[Table]:
    """Return for each compared quantity a table with the deviations of each way of prescribing
    the value [%], a row per impact.

    None for a single impact, which is matched, and without a reference.
    """
    if len(found.drops["variable"]["impact"]) <= 1:
        return []
    deviations = differences(found)
    if "rebound_height_m" in deviations and "separation_speed_m_s" in deviations:
        del deviations["separation_speed_m_s"]  # equivalent to the rebound height
    headings = [("Impact", ""), *((way, "%") for way in WAYS)]
    tables = []
    for name, ways in deviations.items():
        number = len(next(iter(ways.values())))
        cells = np.reshape(_off(np.concatenate([ways[way] for way in WAYS])), (len(WAYS), number))
        rows = [[str(impact + 1), *cells[:, impact].tolist()] for impact in range(number)]
        tables.append(table_of(headings, first_rows(rows), title=COMPARED[name]))
    return tables


def function_words(found: Calibration) -> str:
    """Return the fitted polynomial as text.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.calibration.calibrate import calibrate
    >>> found = calibrate(vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory"))
    >>> print(function_words(found).replace("\u2212", "-"))
    damping_max = 139.408 + 5.86289 v - 0.145602 v² [N s/m], v in m/s from 3.180 to 8.827
    """
    function, words = found.fit.function, ""
    half = (
        found.fit.half_widths(found.confidence)
        if found.observations.measured
        else np.zeros(function.degree + 1)
    )
    for power, (value, spread) in enumerate(zip(function.coefficients, half, strict=True)):
        minus = "\u2212" if value < 0.0 else "+" if words else ""
        words += f" {minus} " if words else minus
        words += known_text(abs(value), float(spread)) + (
            _POWERS[power] if power < len(_POWERS) else f" v^{power}"
        )
    unit = f" [{found.unit}]" if found.unit else ""
    if not function.degree:
        return f"{found.parameter} = {words}{unit}"
    speeds = f"v in m/s from {digits(function.slowest)} to {digits(function.fastest)}"
    return f"{found.parameter} = {words}{unit}, {speeds}"


def fit_sentences(found: Calibration) -> list[str]:
    """Return sentences on the uncertainty of the polynomial, or on its largest deviation."""
    fit, seen = found.fit, found.observations
    told = list(seen.notes)
    if seen.measured:
        half = fit.half_widths(found.confidence)
        if np.isfinite(half).all():
            told.append(
                "Uncertainty of its coefficients: ± "
                f"{', '.join(digits(value, 2) for value in half)} at {_percent(found.confidence)}."
            )
        way = f"by bootstrap with {found.bootstrap} draws" if found.bootstrap else "to first order"
        if found.intervals is not None:
            told.append(
                f"Intervals are {way}, from "
                f"{seen.noise_from if seen.deviations_known else 'the scatter of the measurement'}."
            )
        if seen.effects is not None and (found.intervals is not None or np.isfinite(half).all()):
            told.append(inputs_sentence(seen.effects.inputs))
        if seen.deviations_known and np.isfinite(fit.scatter):
            told.append(
                f"Residuals are {digits(fit.scatter, 3)} times as large "
                "as their standard deviations."
            )
    else:
        where = "over these speeds" if found.curve is not None else "at the impacts"
        told.append(
            f"Its largest deviation is {digits(largest_misfit(found), 3)} {found.unit} "
            f"{where}.".replace("  ", " ")
        )
    if fit.function.degree and found.parameter in {
        item.name for item in fields(found.problem.laws[0]) if varies_with_speed(item)
    }:
        told.append(f"In a case: {found.parameter} = {toml_of(fit.function)}")
    return told


def given_sentences(found: Calibration) -> list[str]:
    """Return sentences on the deviation with the value given by the case, and on other
    parameters that would meet the target.
    """
    told, missed = [], False
    for name in found.weights if found.as_given else ():
        wanted, comes = found.observations.wanted[name], found.as_given[name]
        off = comes / wanted - 1.0
        if np.all(np.abs(off) < 1e-6):
            continue
        worst = int(np.nanargmax(np.abs(off)))
        half = 0.0 if found.intervals is None else float(0.5 * np.ptp(found.intervals[worst]))
        texts = (digits(found.given[worst], 6), known_text(float(found.values[worst]), half))
        given, meets = (f"{value} {found.unit}".rstrip() for value in texts)
        words = (
            f"With {found.parameter} = {given}, as the case gives it, the "
            f"{MATCHABLE[name].phrase} of {found.observations.labels[worst]}"
        )
        instead, asked = (
            text(float(value), MATCHABLE[name].unit, 5) for value in (comes[worst], wanted[worst])
        )
        misses = abs(off[worst]) > _MET
        within = found.intervals is not None and bool(
            np.prod(found.intervals[worst] - found.given[worst]) <= 0.0
        )
        verdict = (
            ", within the uncertainty of the measurement"
            if within
            else ": it does not meet the target"
            if misses
            else ""
        )
        met = abs(found.outcomes[name][worst] / wanted[worst] - 1.0) <= _MET
        best = f"{meets} {'meets' if met else 'comes nearest to'} the target"
        told.append(
            f"{words} is {instead} instead of {asked}, a deviation of "
            f"{_off(off[worst])[0]} %{verdict}. {best}."
        )
        missed |= misses and not within
    if missed and found.others:
        each = [
            f"{name} = {digits(value, 6)} {law_parameter(found.problem, name).unit}".rstrip()
            for name, value in found.others.items()
        ]
        told.append(
            "Other values that meet it at the first impact, with the rest as given: "
            f"{'; '.join(each)}."
        )
    return told


def match_words(found: Calibration) -> str:
    """Return in words what was matched."""
    if len(found.weights) == 1:
        (name,) = found.weights
        reached = np.abs(found.outcomes[name] / found.observations.wanted[name] - 1.0) <= _MET
        where = "" if reached.all() else ", or comes nearest to it where noise puts it out of reach"
        return f"the {MATCHABLE[name].phrase} of each impact matches the target{where}"
    every = " and ".join(
        f"the {MATCHABLE[name].phrase} (weight {weight:g})"
        for name, weight in found.weights.items()
    )
    return (
        f"{every} of each impact are fitted to the target by a weighted "
        "least-squares fit of one value"
    )


def ways_words(found: Calibration) -> str:
    """Return in words the ways of prescribing the value."""
    chain = (
        ""
        if set(found.weights) & set(REBOUNDS)
        else ". The rebound is not matched, so that the speeds of later impacts differ"
    )
    return "; ".join(f"{way}: {_MEANING[way]}" for way in WAYS) + chain


def _off(parts: ArrayLike) -> list[str]:
    """Return fractions as percentages with the same decimals: three, or two if one is 10
    % or more.
    """
    percent = 100.0 * np.atleast_1d(np.asarray(parts, dtype=float))
    return [fixed(float(value), 3 if largest(percent) < 10.0 else 2) for value in percent]


def _percent(confidence: float) -> str:
    return f"{100.0 * confidence:g} %"
