"""One case under several laws: which parameters they get, what is written, and what is refused."""

from __future__ import annotations

import csv
import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.marks import Level, Line, Points
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.cli import main
from vibroimpact.law_comparison.charts import comparison_charts, spread_labels
from vibroimpact.law_comparison.comparison import compare_laws
from vibroimpact.law_comparison.laws import cases_under

CASE = vi.case_of(plain_case())


def test_parameters_of_the_same_name_and_unit_are_taken_from_the_case() -> None:
    case = vi.case_of(
        plain_case(contact={"law": "hunt-crossley", "restitution": 0.6, "stiffness": 3e8})
    )
    under = cases_under(case, ["flores", "hunt-crossley", "tsuji"])
    for one in under.values():
        assert one.contact.parameters["restitution"] == 0.6
        assert one.contact.parameters["stiffness"] == 3e8
    with pytest.raises(
        vi.InputError, match=r"walton-braun: contact\.stiffness: this key is missing"
    ):
        cases_under(case, ["walton-braun"])  # its stiffness is another one, in N/m


def test_given_parameters_come_first_and_a_laws_own_before_all() -> None:
    under = cases_under(
        CASE, ["flores", "gonthier"], {"restitution": 0.5, "gonthier.restitution": 0.4}
    )
    assert [one.contact.parameters["restitution"] for one in under.values()] == [0.5, 0.4]
    stiff = cases_under(CASE, ["hertz"], {"stiffness": "16000 N/mm^1.5"})["hertz"]
    assert stiff.contact.parameters["stiffness"] == pytest.approx(5.0596e8, rel=1e-4)


@pytest.mark.parametrize(
    ("laws", "given", "achieving", "message"),
    [
        (["flors"], {}, None, 'Did you mean "flores"'),
        ([], {}, None, "at least one"),
        (["flores", "flores"], {}, None, "named twice"),
        (["flores"], {"restitutoin": 0.5}, None, 'Did you mean "restitution"'),
        (
            ["tsuji", "walton-braun"],
            {"stiffness": 1e7},
            None,
            '"stiffness" does not have the same unit in all laws: tsuji [N/m^1.5], '
            "walton-braun [N/m]",
        ),
        (
            ["flores"],
            {"hertz.exponent": 1.5},
            None,
            '"hertz.exponent" is not a parameter of flores',
        ),
        (
            ["flores"],
            {"restitution": 0},
            None,
            "flores: contact.restitution: 0 is not allowed; it must be greater "
            "than 0 and at most 1",
        ),
        (["adams-impact"], {}, None, "adams-impact needs largest damping C"),
        (["thornton"], {}, None, "neither material has a yield_strength to take it from"),
        (["lankarani-nikravesh"], {}, 0.5, "lankarani-nikravesh: reaches restitutions from 0.663"),
        (["walton-braun"], {}, 0.5, "walton-braun: contact.stiffness: this key is missing"),
        (["krijt"], {}, 0.5, "krijt: contact.work_of_adhesion: this key is missing"),
        (
            ["flores"],
            {"restitution": 0.6},
            0.5,
            "restitution is tuned to achieve 0.5, so it can't be given too",
        ),
    ],
)
def test_what_is_refused(
    laws: list[str], given: dict, achieving: float | None, message: str
) -> None:
    with pytest.raises(vi.InputError) as raised:
        cases_under(CASE, laws, given, achieving)
    assert message in str(raised.value)


def test_all_laws_tuned_to_one_restitution() -> None:
    names = [name for name in vi.laws.contact_laws() if name not in ("hertz", "jkr", "krijt")]
    linear = [
        name
        for name in names
        if name in ("linear-spring-dashpot", "anagnostopoulos", "walton-braun")
    ]
    others = [name for name in names if name not in linear]
    comparison = vi.laws.compare_laws(CASE, others, {"penalty": 2e6}, achieving=0.8)
    linear_comparison = vi.laws.compare_laws(CASE, linear, {"stiffness": 2e6}, achieving=0.8)
    for one in (*comparison.results.values(), *linear_comparison.results.values()):
        # gravity acts in the contact too
        assert one.impacts["restitution_achieved"][0] == pytest.approx(0.8, abs=3e-3)


def lines(chart: Chart) -> dict[str, Line]:
    return {mark.name: mark for mark in chart.panels[0].marks if isinstance(mark, Line)}


def test_the_charts_hold_the_results() -> None:
    """Each law's whole run, its first contact from touch to release, and the restitution
    of every impact beside the curve.
    """
    names = [
        "flores",
        "newton",
        "adams-impact",
        "tsuji",
        "hunt-crossley",
        "gonthier",
        "jankowski",
        "lee-wang",
        "hu-guo",
    ]
    comparison = vi.laws.compare_laws(
        vi.load_case("paper:type1-theory"),
        names,
        {"restitution": 0.65, "adams-impact.damping_max": 180},
    )
    position, force, loops, restitution = comparison_charts(comparison)
    assert [chart.name for chart in (position, force, loops, restitution)] == [
        "position",
        "force",
        "force_indentation",
        "restitution",
    ]
    assert list(lines(position)) == names
    assert list(lines(force)) == list(lines(loops)) == [name for name in names if name != "newton"]
    # the ninth is told from the first
    assert len({mark.role for mark in lines(position).values()}) == len(names)
    points = {mark.role: mark for mark in restitution.panels[0].marks if isinstance(mark, Points)}
    for name, one in comparison.results.items():
        drawn = lines(position)[name]
        np.testing.assert_array_equal(drawn.y, one.history["position_m"])
        np.testing.assert_array_equal(lines(restitution)[name].y, comparison.restitutions[name])
        reached = points[drawn.role]
        np.testing.assert_array_equal(reached.x, one.impacts["approach_speed_m_s"])
        np.testing.assert_array_equal(reached.y, one.impacts["restitution_achieved"])
        if name == "newton":
            continue
        pulse, loop = lines(force)[name], lines(loops)[name]
        assert pulse.x[-1] == pytest.approx(one.impacts["duration_s"][0], rel=1e-6)
        assert pulse.y.max() == pytest.approx(one.impacts["max_force_N"][0], rel=1e-3)
        assert np.trapezoid(loop.y, loop.x) == pytest.approx(
            one.impacts["energy_lost_J"][0], rel=1e-2
        )
    (view,) = position.views
    assert view.origin == comparison.results["newton"].impacts["time_s"][0]
    for chart in (position, force, loops, restitution):
        matplotlib_figure(chart)
        assert plotly_chart(chart)["frames"]


def test_a_sphere_that_rests_stays_there_until_the_longest_run_ends() -> None:
    case = vi.case_of(plain_case(run={"impacts": 40, "duration": 3.0}))
    found = vi.laws.compare_laws(case, ["newton", "hertz"], {"restitution": 0.1})
    resting, bouncing = lines(comparison_charts(found)[0]).values()
    assert found.results["newton"].status.startswith("At rest")
    assert resting.x[-1] == bouncing.x[-1]
    assert resting.y[-1] == resting.y[-2]


def test_labels_of_a_comparison_at_one_restitution_do_not_overlap() -> None:
    laws = [
        "hunt-crossley",
        "flores",
        "lankarani-nikravesh",
        "newton",
        "gonthier",
        "zhiying-qishao",
        "hu-guo",
    ]
    found = compare_laws(vi.load_case("paper:type1-theory"), laws, achieving=0.7)
    chart = comparison_charts(found)[-1]
    figure = matplotlib_figure(chart)
    figure.canvas.draw()
    labels = [
        label.get_window_extent()
        for label in figure.axes[0].texts
        if label.get_text().startswith("asked")
    ]
    levels = [mark.value for mark in chart.panels[0].marks if isinstance(mark, Level)]
    assert levels == sorted(
        {round(float(one.impacts["restitution_asked"][0]), 4) for one in found.results.values()}
    )
    assert len(labels) > 3
    assert all(
        below.y1 <= above.y0 for below, above in pairwise(sorted(labels, key=lambda box: box.y0))
    )
    assert len({round(label.x1) for label in labels}) == 1


@pytest.mark.parametrize(
    "places", [[], [0.5], [0.1, 0.1001, 0.1002, 0.9], list(np.linspace(0.6, 0.62, 7))]
)
def test_places_are_brought_apart_and_no_further(places: list[float]) -> None:
    found = spread_labels(places, 0.05)
    assert all(above - below >= 0.05 - 1e-12 for below, above in pairwise(found))
    assert all(there >= here for here, there in zip(places, found, strict=True))
    assert found[:1] == places[:1]
    if len(places) == 4:
        assert found[-1] == 0.9  # which has room


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["vibroimpact", "compare", "paper:type1-theory", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


def test_the_command_writes_a_whole_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "compared"
    arguments = [
        "--laws",
        "hertz, newton,adams-impact",
        "--set",
        "adams-impact.damping_max=180",
        "-o",
        str(folder),
    ]
    assert run(monkeypatch, *arguments) == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in ("hertz", "newton", "adams-impact", "achieved"))
    rows = list(csv.DictReader((folder / "comparison.csv").read_text().splitlines()))
    assert [row["law"] for row in rows] == ["hertz"] * 5 + ["newton"] * 5 + ["adams-impact"] * 5
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["laws"]["newton"]["impacts"][0]["max_force_N"] is None
    again = vi.simulate(vi.load_case(folder / "cases" / "adams-impact.toml"))
    np.testing.assert_allclose(
        again.impacts["max_force_N"], [float(row["max_force_N"]) for row in rows[-5:]], rtol=1e-12
    )
    page = (folder / "report.html").read_text()
    figures = {"position", "force", "force_indentation", "restitution"}
    assert all(f'data-chart="{name}"' in page for name in figures)
    assert "<img" not in page
    assert not (folder / "figures").exists()
    assert run(monkeypatch, *arguments) == 2
    assert "is there already" in capsys.readouterr().err
    assert run(monkeypatch, *arguments, "--force", "--figures") == 0
    assert {file.name for file in (folder / "figures").iterdir()} == {
        f"{name}.png" for name in figures
    }


def test_settings_that_are_none_are_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert (
        run(monkeypatch, "--laws", "flores", "--set", "restitution", "-o", str(tmp_path / "x")) == 2
    )
    assert "give KEY=VALUE" in capsys.readouterr().err


def test_friction_and_a_liquid_stay_under_each_law() -> None:
    """The drop is that of the case: what is beside the law in its section is not left
    out, and lowers the curves of restitution.
    """
    liquid, friction = (
        {"density": 1000.0, "viscosity": 0.002},
        {"law": "coulomb", "coefficient": 0.2},
    )
    table: dict[str, Any] = {
        "sphere": {"radius": "1 mm", "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": "50 mm"},
        "contact": {"law": "tsuji", "restitution": 0.7, "liquid": liquid},
        "run": {"impacts": 1},
    }
    wet = vi.laws.compare_laws(vi.case_of(table), ["tsuji", "newton"])
    for name, result in wet.results.items():
        speed, achieved = (
            float(result.impacts[column][0])
            for column in ("approach_speed_m_s", "restitution_achieved")
        )
        assert achieved < 0.69
        assert np.interp(speed, wet.speeds, wet.restitutions[name]) == pytest.approx(
            achieved, abs=5e-4
        )
    table |= {
        "plate": {"material": "steel", "inclination": "20 deg"},
        "contact": {"law": "tsuji", "restitution": 0.7, "friction": friction},
    }
    rough = vi.laws.compare_laws(vi.case_of(table), ["tsuji", "newton"])
    assert all(result.energy["friction_J"] > 0.0 for result in rough.results.values())
