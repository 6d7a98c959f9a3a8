"""Bad input of a calibration: one message that names the file, the line, the column and
what is allowed; and the files that are fine.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.contact_law.law_report import fit_sentences
from vibroimpact.cli import main
from vibroimpact.measurements.table_file import read_table_file

NAN = float("nan")
ADAMS = {"law": "adams-impact"}
RESTITUTION = {"restitution": 0.7}
SEVERAL = {"restitution": [0.7, 0.6, 0.5], "approach_speed": [1, 2, 3]}


def calibrated(section: object, **changes: object) -> Calibration:
    return calibrate_case(
        calibration_of(plain_case(**{"contact": ADAMS, "calibrate": section, **changes}))
    )


def refused(section: object, **changes: object) -> str:
    with pytest.raises(vi.InputError) as caught:
        calibrated(section, **changes)
    return str(caught.value)


FAULTS = [
    ({"target": {}}, "calibrate.target: it needs one of law, file, rebound_heights, max_force"),
    ({"target": 3}, "calibrate.target: 3 is not allowed; it must be a table with one of law, file"),
    ({"target": RESTITUTION, "dergee": 1}, 'calibrate.dergee: unknown key "dergee"'),
    ({}, "calibrate.target: there is no target, since the law of the case is adams-impact itself"),
    ({"target": {"law": "hertzz"}}, 'calibrate.target.law: there is no contact law "hertzz"'),
    ({"target": {"law": "newton"}}, "restitution: this key is missing"),
    ({"target": {"law": "newton", "restitution": 2}}, "restitution: 2 is not allowed"),
    (
        {"target": {"law": "newton", "restitution": 0}},
        "under the law of the target the sphere comes to rest in the first impact",
    ),
    (
        {"target": {"restitution": 0}},
        "calibrate.target.restitution: 0 is not allowed; it must be greater than 0 and at most 1",
    ),
    ({"target": {"restitution": 1.1}}, "calibrate.target.restitution: 1.1 is not allowed"),
    ({"target": {"restitution": NAN}}, "calibrate.target.restitution: nan is not finite"),
    (
        {"target": {"restitution": [0.7, 0.6]}},
        "2 restitutions need as many approach speeds, and no approach_speed is given",
    ),
    (
        {"target": {"restitution": [0.7], "approach_speed": [1, 2]}},
        "a list of one restitution needs as many approach speeds, and there are 2",
    ),
    (
        {"target": {"restitution": 0.7, "approach_speed": [1]}},
        "one restitution holds at any approach speed",
    ),
    (
        {"target": {"restitution": 0.7, "standard_deviation": 0.1}},
        "one restitution holds at any approach speed",
    ),
    (
        {"target": {**SEVERAL, "standard_deviation": 0}},
        "calibrate.target.standard_deviation: 0 is not allowed",
    ),
    (
        {"target": {**SEVERAL, "approach_speed": [1, -2, 3]}},
        "calibrate.target.approach_speed (the 2nd): -2 is not allowed",
    ),
    (
        {"target": {**SEVERAL, "approach_speed": ["1 m", 2, 3]}},
        '"1 m" is a length; expected a speed',
    ),
    ({"target": {"rebound_heights": []}}, "calibrate.target.rebound_heights"),
    (
        {"target": {"rebound_heights": [0.3, -0.1]}},
        "calibrate.target.rebound_heights (the 2nd): -0.1 is not allowed",
    ),
    ({"target": {"rebound_heights": [0.3, "2 kg"]}}, '"2 kg" is a mass; expected a length'),
    (
        {"target": {"rebound_heights": [0.3, 0.025]}},
        "impact 2: 0.025 m is not above where the sphere lies on the plate",
    ),
    (
        {"target": {"rebound_heights": [0.3], "standard_deviation": -1}},
        "calibrate.target.standard_deviation: -1 is not allowed",
    ),
    (
        {"target": {"rebound_heights": [0.6]}},
        "impact 1: 0.6 m is higher than the 0.5 m from which the sphere fell",
    ),
    (
        {"target": {"rebound_heights": [0.3, 0.31]}},
        "impact 2: 0.31 m is higher than the 0.3 m from which the sphere fell",
    ),
    (
        {"target": {"max_force": 0}},
        "calibrate.target.max_force: 0 is not allowed; it must be greater than 0 N",
    ),
    ({"target": {"max_force": "3 m"}}, '"3 m" is a length; expected a force'),
    (
        {"target": {"separation_speed": 1, "restitution": 0.5}},
        "separation_speed and restitution are equivalent",
    ),
    (
        {"target": {"max_force": 3e3, "relative_deviation": 1}},
        "calibrate.target.relative_deviation: 1 is not allowed",
    ),
    (
        {"target": {"max_force": 3e3}, "match": "separation_speed"},
        "calibrate.match: separation_speed was not measured; there is max_force",
    ),
    (
        {"target": RESTITUTION, "match": "max_force"},
        "calibrate.match: max_force does not follow from the target, newton",
    ),
    ({"tagret": RESTITUTION}, 'unknown key "tagret"; [calibrate] takes target, model'),
    ({"target": {"restituton": 0.7}}, 'Did you mean "restitution"?'),
    ({"target": {"restitution": "0,7"}}, '"0,7" has a comma in its number; write a point: 0.7'),
    (
        {"target": {"separation_speed": 5}},
        "a separation speed of 5 m/s is wanted, and newton gives 0 to "
        "3.0523 m/s, whatever restitution is",
    ),
    (
        {"target": RESTITUTION, "match": "speed"},
        'calibrate.match: "speed" can\'t be matched; there are separation_speed',
    ),
    (
        {"target": RESTITUTION, "match": {"max_force": 0}},
        "calibrate.match: 0 is not allowed as a weight",
    ),
    (
        {"target": RESTITUTION, "match": {"max_force": "much"}},
        'calibrate.match: "much" is not allowed; the weights must be numbers',
    ),
    (
        {"target": RESTITUTION, "match": {}},
        "calibrate.match: name at least one of separation_speed",
    ),
    ({"target": RESTITUTION, "match": 3}, "calibrate.match: 3 is not allowed"),
    (
        {"target": RESTITUTION, "parameter": "dampign_max"},
        'calibrate.parameter: adams-impact has no parameter "dampign_max"',
    ),
    (
        {"target": RESTITUTION, "parameter": "sphere.damping"},
        "calibrate.parameter: the sphere is rigid and has no modes to damp",
    ),
    (
        {"target": RESTITUTION, "degree": 3},
        "calibrate.degree: a polynomial of degree 3 needs 4 speeds, and 3 that differ by "
        "more than 1 % of the largest are",
    ),
    ({"target": RESTITUTION, "degree": -1}, "calibrate.degree: -1 is not allowed"),
    ({"target": RESTITUTION, "degree": 1.5}, "calibrate.degree: 1.5 is not allowed"),
    ({"target": RESTITUTION, "confidence": 1}, "calibrate.confidence: 1 is not allowed"),
    ({"target": RESTITUTION, "confidence": 95}, "calibrate.confidence: 95 is not allowed"),
    (
        {"target": SEVERAL, "bootstrap": 5},
        "calibrate.bootstrap: 5 draws give no interval; it must be 0, or at least 20",
    ),
    ({"target": SEVERAL, "bootstrap": -5}, "calibrate.bootstrap: -5 is not allowed"),
    ({"target": RESTITUTION, "seed": -1}, "calibrate.seed: -1 is not allowed"),
    (
        {"target": RESTITUTION, "speeds": {"from": 3, "to": 1}},
        "calibrate.speeds.to: 1 m/s is not more than the first speed, 3 m/s",
    ),
    (
        {"target": RESTITUTION, "speeds": {"from": 0, "to": 1}},
        "calibrate.speeds.from: 0 is not allowed",
    ),
    (
        {"target": RESTITUTION, "speeds": {"from": 1, "to": 3, "number": 1}},
        "calibrate.speeds.number: 1 is not allowed",
    ),
    (
        {"target": SEVERAL, "speeds": {"from": 1, "to": 3}},
        "calibrate.speeds: this target is matched at its own speeds alone",
    ),
    (
        {"target": RESTITUTION, "model": {"law": "hertz"}},
        "calibrate.parameter: hertz has no loss parameter; name another law, or, to match "
        "something other than the rebound, one",
    ),
    ({"target": RESTITUTION, "model": {"law": "adams-impcat"}}, 'Did you mean "adams-impact"?'),
    (
        {"target": RESTITUTION, "match": "spin_y_after"},
        "calibrate.match: spin_y_after follows from friction",
    ),
    (
        {
            "target": RESTITUTION,
            "model": {"law": "hunt-crossley", "restitution": 0.8},
            "parameter": "dissipation",
        },
        "the case gives no dissipation of hunt-crossley, in whose place it gives another "
        "parameter; give dissipation alone, or tune one",
    ),
    ({"target": {"restitution": []}}, "calibrate.target.restitution: the list is empty"),
    (
        {"target": {"restitution": [], "approach_speed": []}},
        "calibrate.target.restitution: the list is empty",
    ),
    (
        {
            "target": {"restitution": [0.7, 0.7, 0.7], "approach_speed": [1, 1.001, 1.002]},
            "degree": 1,
        },
        "a polynomial of degree 1 needs 2 speeds, and all that are there lie within "
        "1 % of the largest",
    ),
    (
        {
            "target": RESTITUTION,
            "model": {"law": "tsuji", "restitution": {"speed": [1, 3], "value": [0.8, 0.7]}},
        },
        "calibrate.model.restitution: a calibration begins from numbers",
    ),
    ({"target": "nowhere.csv"}, "nowhere.csv: there is no such file"),
    ("high", "calibrate: "),
]


def _quick(words: str) -> dict[str, str]:
    """A law that soon tells what it can't reach, where that is what is wrong."""
    return {"law": "newton"} if "after" in words or "is wanted" in words else ADAMS


@pytest.mark.parametrize(("section", "words"), FAULTS, ids=[str(fault[0])[:80] for fault in FAULTS])
def test_faults_of_the_section(section: object, words: str) -> None:
    assert words in refused(section, contact=_quick(words))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"drop": {"speed": 1, "gravity": 0}, "run__impacts": 1},
            "without gravity a sphere rises for ever",
        ),
        (
            {"contact": {"law": "thornton"}, "calibrate": {"target": RESTITUTION}},
            "drop.same_spot: thornton leaves a dent",
        ),
    ],
)
def test_faults_of_the_case(changes: dict, words: str) -> None:
    assert words in refused(
        changes.pop("calibrate", {"target": {"rebound_heights": [0.3]}}), **changes
    )


def test_nothing_to_match_and_no_section() -> None:
    with pytest.raises(vi.InputError, match="there is no target"):
        calibration_of(plain_case(contact={"law": "adams-impact", "damping_max": 100.0}))


# --- files
#
#
#
# -------------------------------------------------------------------------------------------------------------------------------

ROWS = "approach_speed_m_s,restitution\n1,0.7\n2,0.6\n3,0.5\n"
FILES = [
    ("", "the file is empty"),
    ("# only a comment\n\n", "the file is empty but for comments, separators and blanks"),
    ("approach_speed_m_s,restitution\n", "there are no rows under the header"),
    (
        "1,0.7\n2,0.6\n",
        "line 1: it has 2 numbers, and no header is above it; write a header, "
        "such as time [s],force [N]",
    ),
    ("restitutoin\n0.7\n", 'Did you mean "restitution"?'),
    (
        "approach_speed,restitution\n1,0.7\n",
        'line 1, column "approach_speed": the unit is missing; write it in brackets, such as',
    ),
    ("approach_speed [m],restitution\n1,0.7\n", 'line 1, column "approach_speed [m]"'),
    (
        "approach_speed [furlong/lightbulb],restitution\n1,0.7\n",
        'line 1, column "approach_speed [furlong/lightbulb]"',
    ),
    ("# a comment\n\ntime [m],force_N\n0,1\n", 'line 3, column "time [m]"'),
    ("time [],force_N\n0,1\n", 'line 1, column "time []": the unit is missing'),
    (
        "approach_speed_m_s,restitution [m]\n1,0.7\n",
        'column "restitution [m]": it is a plain number, and must have no unit',
    ),
    (
        "time_s,force_N,force_kN\n0,0,1\n1,1,1\n",
        'several columns are called "force"; state them all by columns = "time=s,-,force=kN"',
    ),
    ("restitution,restitution\n1,1\n", 'line 1: there are two columns "restitution"'),
    (
        "approach_speed_m_s,restitution\n1,0.7\n\n# more\n2,high\n",
        'line 5, column "restitution": "high" is not a number',
    ),
    (
        "approach_speed_m_s,restitution\n1,0.7\n2,\n",
        'line 3, column "restitution": the cell is empty',
    ),
    (
        "approach_speed_m_s,restitution\n1,0.7\n2\n",
        'line 3, column "restitution": the cell is missing; the line has 1 field',
    ),
    (
        "approach_speed_m_s,restitution\n1,nan\n",
        'line 2, column "restitution": "nan" is not finite',
    ),
    (
        "approach_speed_m_s,restitution\n1,1e999\n",
        'line 2, column "restitution": "1e999" is not finite',
    ),
    (
        "approach_speed_m_s,restitution\n1,n/a\n",
        'line 2, column "restitution": "n/a" is no number; fill it in',
    ),
    (
        "approach_speed_m_s,restitution\n1,9.9e37\n",
        '"9.9e37" stands for a sample that is over the range (SCPI); fill it in',
    ),
    (
        "approach_speed_m_s,restitution\n1,0.7\n-2,0.6\n",
        "line 3: approach_speed is -2 m/s; it must be greater than 0",
    ),
    (
        "approach_speed_m_s,restitution\n1,0.7\n2,0\n",
        "line 3: restitution is 0; it must be greater than 0",
    ),
    (
        "approach_speed_m_s,max_force_N\n1,100\n2,-5\n",
        "line 3: max_force is -5 N; it must be greater than 0",
    ),
    (
        "approach_speed_m_s,restitution\n1,0.7\n2,1.5\n",
        "line 3: restitution is 1.5; it is 1 at most",
    ),
    (
        "approach_speed_m_s\n1\n",
        "beside approach_speed a column is missing; give one of restitution, "
        "separation_speed, max_force",
    ),
    (
        "restitution\n0.7\n",
        "the columns restitution do not describe impacts; a file "
        "has approach_speed with restitution",
    ),
    ("time_s\n0\n1\n", "the columns time do not describe impacts"),
    ("position_m\n0.5\n0.4\n", "there is no column time [s]"),
    ("force_N\n5\n4\n", "there is no column time [s]"),
    (
        "rebound_height_m\n0.3\n0.02\n",
        "line 3: 0.02 m is not above where the sphere lies on the plate",
    ),
    (
        "rebound_height_m\n0.3\n\n0.2\n",
        "line 3: the line is empty; rebound heights are those of one impact after another",
    ),
    (
        "rebound_height_m\n0.3\n0.4\n",
        "line 3: 0.4 m is higher than the 0.3 m from which the sphere fell",
    ),
    (
        "rebound_height [m]\n2,41\n1,457\n",
        "line 2: there are 2 fields, and the header has 1; where a comma is the decimal point",
    ),
    (
        "approach_speed_m_s,restitution,restitution_standard_deviation\n1,0.7,0\n",
        "restitution_standard_deviation is 0; it must be",
    ),
    ("approach_speed_m_s,restitution\n1,0.7_5\n", '"0.7_5" is not a number'),
    (
        "time_s,force_N\n0,0\n1e-3,0\n5e-4,0\n2e-3,1\n",
        "line 4: time goes backwards, from 0.001 s to 0.0005 s",
    ),
    (
        "time_ms,position_m\n0,1\n\n2,1\n1,1\n",
        "line 5: time goes backwards, from 0.002 s to 0.001 s",
    ),
]


def file_with(folder: Path, text: str, encoding: str = "utf-8") -> str:
    file = folder / "measured.csv"
    file.write_bytes(text.encode(encoding))
    return str(file)


@pytest.mark.parametrize(("text", "words"), FILES, ids=[repr(text)[:70] for text, _ in FILES])
def test_faults_of_a_file(tmp_path: Path, text: str, words: str) -> None:
    told = refused({"target": {"file": file_with(tmp_path, text)}}, contact=_quick(words))
    assert words in told
    assert "line" not in words or "measured.csv" in told or "after" in words or "not above" in words


def test_one_of_two_deviations(tmp_path: Path) -> None:
    text = "approach_speed_m_s,restitution,restitution_standard_deviation,max_force_N\n1,0.7,0.01,900\n2,0.6,0.01,2000\n"
    told = refused(
        {
            "target": {"file": file_with(tmp_path, text)},
            "match": {"separation_speed": 1, "max_force": 1},
        }
    )
    assert (
        "restitution has a standard deviation and max_force has none; give "
        "max_force_standard_deviation" in told
    )


def test_columns_have_the_names_of_the_file(tmp_path: Path) -> None:
    text = "v [m/s],e,n\n1,0.7,2\n-2,0.6,3\n"
    assert "line 3: v is -2 m/s; it must be greater than 0" in refused(
        {"target": {"file": file_with(tmp_path, text)}}
    )
    text = "v [m/s],e,n\n1,0.7,2.5\n"
    assert "line 2: n is 2.5; it must be a whole number" in refused(
        {"target": {"file": file_with(tmp_path, text)}}
    )
    text = "v [m/s],e,max_force_N,max_force_standard_deviation_N\n1,0.7,900,10\n2,0.6,2000,10\n"
    told = refused(
        {
            "target": {"file": file_with(tmp_path, text)},
            "match": {"separation_speed": 1, "max_force": 1},
        }
    )
    assert "max_force has a standard deviation and e has none; give e_standard_deviation" in told


def test_a_force_out_of_reach_is_told_with_the_dampings_tried() -> None:
    """The force rises with a large damping: its largest is not that without any."""
    target = {"max_force": "10 MN"}
    told = refused(
        {"target": target},
        contact={"law": "adams-impact", "damping_max": 100.0},
        run={"impacts": 1},
    )
    assert "with damping_max from 0 to 6.55e+06 N s/m" in told


def test_the_rest_as_given_includes_no_guess() -> None:
    target = {"max_force": "1 kN"}
    told = refused(
        {"target": target},
        contact={"law": "adams-impact", "damping_max": 100.0},
        run={"impacts": 1},
    )
    assert "; with the rest as given it would take stiffness = " in told
    told = refused({"target": target}, contact={"law": "adams-impact"}, run={"impacts": 1})
    assert "; with damping_max = 150 N s/m and the rest as given it would take stiffness = " in told


def test_without_gravity_there_is_no_rebound_height() -> None:
    newton = {"law": "newton", "restitution": 0.7}
    told = refused(
        {"match": "rebound_height"},
        contact=newton,
        drop={"speed": 1.0, "gravity": 0.0},
        run={"impacts": 1},
    )
    assert "calibrate.match: without gravity a sphere rises for ever" in told


def test_intervals_that_are_not_there_are_not_told() -> None:
    drop = {"height": "0.5 m +- 1 cm"}
    found = calibrated({"target": {"rebound_height": 0.3}}, drop=drop, run={"impacts": 1})
    assert found.intervals is None
    assert not any("The intervals include" in sentence for sentence in fit_sentences(found))


def test_files_that_are_none(tmp_path: Path) -> None:
    assert "this is a directory; a table is a text file, such as CSV" in refused(
        {"target": {"file": str(tmp_path)}}
    )
    assert "the file is not UTF-8 text" in refused(
        {"target": {"file": file_with(tmp_path, "# \u0081\n" + ROWS, "latin-1")}}
    )
    # UTF-16 is read
    assert '"x" is not a number' in refused(
        {"target": {"file": file_with(tmp_path, ROWS.replace("0.7", "x"), "utf-16")}}
    )


# --- records that do not show what they should
# -------------------------------------------------------------------------------------------


def record(name: str, time: np.ndarray, values: np.ndarray) -> str:
    return f"time_s,{name}\n" + "\n".join(
        f"{t:.9g},{value:.9g}" for t, value in zip(time, values, strict=True)
    )


TIME = np.linspace(0.0, 1e-3, 201)
PULSE = np.where((TIME > 3e-4) & (TIME < 6e-4), np.sin(np.pi * (TIME - 3e-4) / 3e-4), 0.0)
SECONDS = np.linspace(0.0, 1.2, 601)
NOISE = np.random.default_rng(3).normal(size=601)


def bounces(restitution: float = 0.7, level: float = 0.025) -> np.ndarray:
    fall, out = np.sqrt(2.0 * 0.475 / 9.8), np.full(len(SECONDS), level)
    begin, speed = fall, 3.05 * restitution
    out = np.where(fall > SECONDS, level + 0.475 - 4.9 * SECONDS**2, out)
    for _ in range(4):
        since = SECONDS - begin
        out = np.where(
            (since >= 0.0) & (since < 2.0 * speed / 9.8),
            level + speed * since - 4.9 * since**2,
            out,
        )
        begin, speed = begin + 2.0 * speed / 9.8, speed * restitution
    return out


RECORDS = [
    (
        "force_N",
        TIME,
        0.0 * TIME,
        "the record does not show an impact: the force is the same throughout",
    ),
    (
        "force_N",
        SECONDS,
        NOISE,
        "the record does not show an impact: no force stands out from the noise",
    ),
    (
        "force_N",
        TIME,
        -1000.0 * PULSE,
        "the pulses of the force are negative; it must be positive where it pushes the sphere up",
    ),
    (
        "force_N",
        TIME[80:],
        1000.0 * PULSE[80:],
        "the record begins in the middle of an impact, at line 2",
    ),
    (
        "force_N",
        TIME[:100],
        1000.0 * PULSE[:100],
        "the record ends in the middle of an impact, at line",
    ),
    (
        "force_N",
        20.0 * TIME,
        np.where((TIME > 1.5e-4) & (TIME < 1.66e-4), 1000.0, 0.0),
        "samples, but 5 are needed; sample faster",
    ),
    ("force_N", TIME, 1000.0 * PULSE, "the force, the mass or the drop can't be right"),
    ("force_N", TIME, 1e5 * PULSE, "the force, the mass or the drop can't be right"),
    (
        "position_m",
        SECONDS,
        0.5 + 0.0 * SECONDS,
        "the record does not show an impact: nowhere does the sphere stop falling and rise again",
    ),
    ("position_m", SECONDS, 0.5 + 1e-3 * NOISE, "the record does not show an impact"),
    ("position_m", SECONDS[:150], bounces()[:150], "the record does not show an impact"),
    (
        "position_m",
        SECONDS[:160],
        bounces()[:160],
        "the record shows too little of the rebound from the first impact",
    ),
    (
        "position_m",
        SECONDS,
        bounces() + 0.5,
        "position must be the height of its centre above the plate",
    ),
]


@pytest.mark.parametrize(
    ("name", "time", "values", "words"),
    RECORDS,
    ids=[f"{fault[0]}: {fault[3][:60]}" for fault in RECORDS],
)
def test_records_that_do_not_show_an_impact(
    tmp_path: Path, name: str, time: np.ndarray, values: np.ndarray, words: str
) -> None:
    told = refused({"target": {"file": file_with(tmp_path, record(name, time, values))}})
    assert words in told
    assert "measured.csv" in told


# --- on the command line
#
#
#
# -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "approach_speed_m_s,restitution\n1,0.7\n2,high\n",
            'measured.csv, line 3, column "restitution": "high" is not a number',
        ),
        ("time_s,force_N\n0,0\n1,0\n0.5,0\n", "measured.csv, line 4: time goes backwards"),
        ("approach_speed,restitution\n1,0.7\n", "the unit is missing"),
        ("approach_speed_m_s,restitution\n1,1.5\n", "line 2: restitution is 1.5; it is 1 at most"),
    ],
)
def test_on_the_command_line(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    text: str,
    words: str,
) -> None:
    """Exit status 2, one message, no traceback, and nothing written."""
    case = tmp_path / "case.toml"
    case.write_text(
        tomli_w.dumps(
            plain_case(
                contact=_quick(words), calibrate={"target": {"file": file_with(tmp_path, text)}}
            )
        )
    )
    before = sorted(tmp_path.iterdir())
    monkeypatch.setattr(
        "sys.argv", ["vibroimpact", "calibrate", str(case), "-o", str(tmp_path / "out")]
    )
    with pytest.raises(SystemExit) as left:
        main()
    told = capsys.readouterr().err
    assert left.value.code == 2
    assert words in " ".join(told.split())
    assert "Traceback" not in told
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    "keys",
    [
        {"columns": "time=s,position=m"},
        {"channel": "geophone", "contact_duration": 2e-4},
        {"function": "load cell"},
    ],
)
def test_a_case_file_keeps_what_it_states_of_the_target(
    keys: dict[str, object], tmp_path: Path
) -> None:
    """Columns, channel, contact time and function were lost with the folder of the file."""
    case = tmp_path / "case.toml"
    section = {"target": {"file": "record.csv", **keys}}
    case.write_text(tomli_w.dumps(plain_case(contact=ADAMS, calibrate=section)))
    for changes in ({}, {"calibrate.degree": 0}):
        target = vi.calibration.load_calibration(case, changes).case.calibrate.target
        assert target.file == str(tmp_path / "record.csv")
        assert {key: getattr(target, key) for key in keys} == keys


def test_columns_that_a_case_file_states_are_read(tmp_path: Path) -> None:
    """The header of the table names none that is known."""
    rows = record("y", SECONDS, bounces()).partition("\n")[2]
    file_with(tmp_path, f"seconds since start,y\n{rows}")
    section = {"target": {"file": "measured.csv", "columns": "time=s,position=m"}, "degree": 0}
    changes = {"contact": {"law": "newton", "restitution": 0.5}, "drop__gravity": 9.8}
    case = tmp_path / "case.toml"
    case.write_text(tomli_w.dumps(plain_case(calibrate=section, **changes)))
    found = calibrate_case(vi.calibration.load_calibration(case))
    np.testing.assert_allclose(found.values, 0.7, atol=2e-3)


def test_a_file_that_describes_no_impacts_is_told_with_what_was_understood(tmp_path: Path) -> None:
    file = file_with(tmp_path, "Zeit [s];Weg [mm]\n0;1\n1;2\n")
    assert (
        "line 1 was taken for the header: Zeit [s], Weg [mm], separated by semicolons. Name them "
        'so, or state them beside file: columns = "time=s,position=m"'
        in refused({"target": {"file": file}})
    )
    nothing_known = file_with(tmp_path, "CH1 [V],CH2 [V]\n0,1\n1,2\n")
    assert 'Name the columns so, or give --columns "ch1=V,ch2=V"' in refused(
        {"target": {"file": nothing_known}}
    )
    stated = {"file": nothing_known, "columns": "x=s,-"}
    assert 'State columns with these names, such as "time=s,force=N"' in refused({"target": stated})


def test_a_folder_that_is_there_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "kept.txt").write_text("mine")
    monkeypatch.setattr(
        "sys.argv", ["vibroimpact", "calibrate", "paper:calibration", "-o", str(tmp_path)]
    )
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    assert str(tmp_path.name) in "".join(capsys.readouterr().err.split())
    assert [file.name for file in tmp_path.iterdir()] == ["kept.txt"]


# --- files that are fine
#
#
#
# -----------------------------------------------------------------------------------------------------------------

UNITS = {"time": "s", "force": "N", "position": "m", "restitution": "", "approach_speed": "m/s"}
DIALECTS = {
    "plain": "time_s,force_N\n0.001,1.5\n0.002,2.5\n",
    "brackets": "time [ms],force [N]\n1,1.5\n2,2.5\n",
    "parentheses": "time (ms),force (kN)\n1,0.0015\n2,0.0025\n",
    "endings": "time_ms,force_kN\n1,0.0015\n2,0.0025\n",
    "microseconds": "time_us,force_N\n1000,1.5\n2000,2.5\n",
    "capitals and blanks": " Time [s] , Force [N] \n 0.001 , 1.5 \n 0.002 , 2.5 \n",
    "semicolons": "time_s;force_N\n0.001;1.5\n0.002;2.5\n",
    "decimal commas": "time_s;force_N\n0,001;1,5\n0,002;2,5\n",
    "tabs": "time_s\tforce_N\n0.001\t1.5\n0.002\t2.5\n",
    "tabs and decimal commas": "time_s\tforce_N\n0,001\t1,5\n0,002\t2,5\n",
    "a byte order mark": "\ufefftime_s,force_N\n0.001,1.5\n0.002,2.5\n",
    "comments and empty lines": "# from the scope\n\ntime_s,force_N\n# a gap\n0.001,1.5\n\n0.002,2.5\n\n",
    "carriage returns": "time_s,force_N\r\n0.001,1.5\r\n0.002,2.5\r\n",
    "quotes": '"time [s]","force [N]"\n"0.001","1.5"\n"0.002","2.5"\n',
    "other columns": 'note,time_s,force_N,temperature\na,0.001,1.5,20\n"b",0.002,2.5,\n',
    "exponents": "force_N,time_s\n15e-1,1E-3\n+2.5,2e-03\n",
}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_dialects(tmp_path: Path, dialect: str) -> None:
    table = read_table_file(file_with(tmp_path, DIALECTS[dialect]), UNITS)
    np.testing.assert_allclose(table.columns["time"], [1e-3, 2e-3], rtol=1e-14)
    np.testing.assert_allclose(table.columns["force"], [1.5, 2.5], rtol=1e-14)


@pytest.mark.parametrize("header", ["restitution [%]", "restitution (%)", "Restitution [%]"])
def test_percent(tmp_path: Path, header: str) -> None:
    table = read_table_file(
        file_with(tmp_path, f"approach_speed [mm/s],{header}\n1500,70\n"), UNITS
    )
    assert table.columns["restitution"][0] == pytest.approx(0.7, rel=1e-14)
    assert table.columns["approach_speed"][0] == pytest.approx(1.5, rel=1e-14)


@pytest.mark.parametrize(
    "header", ["restitution", "restitution []", "restitution [-]", "restitution [1]"]
)
def test_a_plain_number_needs_no_unit(tmp_path: Path, header: str) -> None:
    assert read_table_file(file_with(tmp_path, f"{header}\n0.7\n"), UNITS).columns[
        "restitution"
    ].tolist() == [0.7]


def test_lines_are_those_of_the_file(tmp_path: Path) -> None:
    table = read_table_file(
        file_with(tmp_path, "# one\n\ntime_s,force_N\n\n1,2\n# two\n3,4\n"), UNITS
    )
    assert list(table.lines) == [5, 7]


@pytest.mark.slow
def test_the_same_measurement_in_the_case_and_in_a_file(tmp_path: Path) -> None:
    inside = calibrated({"target": SEVERAL, "degree": 1, "bootstrap": 0}, run={"impacts": 1})
    for text in (ROWS, "restitution [%];approach_speed (mm/s)\n70;1000\n60;2000\n50;3000\n"):
        file = calibrated(
            {"target": file_with(tmp_path, text), "degree": 1, "bootstrap": 0}, run={"impacts": 1}
        )
        np.testing.assert_allclose(file.values, inside.values, rtol=1e-10)
        np.testing.assert_allclose(
            file.fit.function.coefficients, inside.fit.function.coefficients, rtol=1e-8
        )
    assert file.observations.labels == ("line 2", "line 3", "line 4")


def test_a_restitution_just_beyond_noise_is_told_apart_from_it() -> None:
    told = refused({"target": {"restitution": [1.01001], "approach_speed": [1]}})
    assert "1.01001 is more than the 1.01 that is attributed to noise" in told
