"""How elastic bodies go together with a contact law: what is refused, and in which words."""

from __future__ import annotations

import re
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case

SPHERE = {"radius": "25 mm", "material": "rock-paper"}
PLATE = {
    "size": [0.52, 0.42, 0.008],
    "material": "steel-paper",
    "model": "elastic",
    "modes": 10,
    "supports": "clamped",
}
COARSE = {"mesh": {"elements_across": 6}}
RIGID = {"model": "rigid", "modes": None, "supports": None}
SENSOR = {"name": "a1", "position": [0.1, 0.05]}
MEASURED = {"max_force": 3582.0, "rebound_height": 0.26}


def case(
    sphere: dict[str, Any] | None = None, plate: dict[str, Any] | None = None, **sections: Any
) -> dict[str, Any]:
    """A drop on an elastic plate with some keys of it changed."""
    whole: dict[str, Any] = {
        "sphere": {**SPHERE, **(sphere or {})},
        "plate": {**PLATE, **(plate or {})},
        "drop": {"height": 1.0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    whole["plate"] = {key: value for key, value in whole["plate"].items() if value is not None}
    return {**whole, **sections}


def contact(**keys: Any) -> dict[str, Any]:
    return {"contact": {"law": "hertz", **keys}}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"sensors": [{**SENSOR, "position": [0.3, 0.0]}]},
            r'sensors\."a1"\.position: \(0\.3, 0\) m lies outside the plate',
        ),
        (
            {"sensors": [{**SENSOR, "rate": 0}]},
            r'sensors\."a1"\.rate: 0 is not allowed; it must be greater than 0 Hz',
        ),
        (
            {"sensors": [{**SENSOR, "direction": [0, 0, 0]}]},
            r'sensors\."a1"\.direction: it has no length',
        ),
        (
            {"sensors": [{**SENSOR, "quantity": "velocity", "accelerometer": {}}]},
            "an accelerometer measures acceleration",
        ),
        (
            {
                "plate": {"material": "rigid", "model": "rigid", "modes": None, "supports": None},
                "sensors": [SENSOR],
            },
            "sensors: the plate is rigid",
        ),
        (
            {"drop": {"height": 1.0, "position": [0.3, 0.0]}},
            r"drop\.position: \(0\.3, 0\) m lies outside the plate",
        ),
        (
            {"plate": {"supports": "free", "mesh": {"element_size": 0.14}}},
            r"plate\.supports: the supports let the plate fall or tilt",
        ),
        (
            {"contact": {"law": "newton", "restitution": 0.5}},
            r"contact\.law: newton gives no force",
        ),
        (
            contact(local_compliance="consitent"),
            r'contact\.local_compliance: .* or "identified"\. Did you mean "consistent"\?',
        ),
        (
            contact(local_compliance="identified"),
            "needs either local_stiffness and local_damping, or measured",
        ),
        (
            contact(local_compliance="identified", local_stiffness=1e6),
            "needs either local_stiffness and local_damping, or measured",
        ),
        (
            contact(local_stiffness=1e6),
            r'contact\.local_stiffness: only local_compliance = "identified" takes it',
        ),
        (
            contact(local_compliance="identified", measured={"max_force": 1.0}),
            "one of rebound_height, separation_speed and restitution, not none",
        ),
        (
            contact(local_compliance="identified", measured={**MEASURED, "restitution": 0.5}),
            "not rebound_height and restitution",
        ),
        (
            contact(local_compliance="identified", measured={**MEASURED, "rebound_height": 0.02}),
            "0.02 m is no rebound",
        ),
        (
            contact(local_compliance="identified", measured={**MEASURED, "max_force": 1e5}),
            "a local element only makes the impact softer",
        ),
        (contact(stiffnes=1e6), 'Did you mean "stiffness"'),
    ],
)
def test_what_does_not_fit_is_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        vi.simulate(vi.case_of(case(**changes)))


def test_an_elastic_sphere_has_no_local_element_as_well() -> None:
    sphere = {"model": "elastic", "modes": 8}
    with pytest.raises(
        vi.InputError,
        match=r'sphere\.model: the local element of "identified" stands for the deformation of '
        r"the sphere",
    ):
        vi.simulate(
            vi.case_of(case(sphere, **contact(local_compliance="identified", measured=MEASURED)))
        )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "restitution", "message"),
    [
        (
            {"law": "hunt-crossley", "restitution": 0.5},
            0.99,
            r"no local element gives both: .* the rebound can be 0 to [\d.]+ m/s, and 4\.3",
        ),
        (
            {"law": "hertz"},
            0.01,
            r"no local element was found that gives both a largest force of 1000 N and a "
            r"rebound of 0\.04\d+ m/s",
        ),
    ],
)
def test_a_rebound_that_no_local_element_gives_is_refused_with_what_it_can(
    law: dict[str, Any], restitution: float, message: str
) -> None:
    """A sphere that hardly rebounds stays in its indentation: of the range that ends
    there, not every rebound is found.
    """
    rigid = case(plate=RIGID)
    rigid["contact"] = {
        **law,
        "local_compliance": "identified",
        "measured": {"max_force": 1000.0, "restitution": restitution},
    }
    with pytest.raises(vi.InputError, match=rf"contact\.measured: {message}"):
        vi.case_of(rigid).to_problem()


def test_a_basis_that_leaves_nothing_of_the_law_is_refused() -> None:
    sphere = {"model": "elastic", "modes": 8, "attachment_mode": True, **COARSE}
    with pytest.raises(
        vi.InputError,
        match=r"sphere\.attachment_mode: the modes of the sphere carry .* not be unique; leave "
        r"this out",
    ):
        vi.case_of(case(sphere, RIGID)).to_problem()


def test_a_correction_that_leaves_nothing_of_a_stiff_law_is_refused_without_a_word_of_modes() -> (
    None
):
    stiff = case(plate=RIGID)
    stiff["contact"] = {"law": "hertz", "stiffness": 1e12, "finite_sphere": True}
    with pytest.raises(
        vi.InputError,
        match=r"contact\.finite_sphere: .* the law is much stiffer than Hertz's contact; leave "
        r"this out",
    ) as refused:
        vi.case_of(stiff).to_problem()
    assert "modes" not in str(refused.value)


@pytest.mark.parametrize(
    "name",
    [
        f"paper:type{number}{kind}"
        for number in (2, 3)
        for kind in ("", "-superposed", "-identified")
    ],
)
def test_shipped_cases_come_back_from_their_resolved_form(name: str) -> None:
    shipped = vi.load_case(name)
    assert resolved_case(vi.case_of(resolved_case(shipped))) == resolved_case(shipped)


def test_consistent_bodies_tell_what_was_done() -> None:
    problem = vi.case_of(
        case({"model": "elastic", "modes": 10, "damping": 0.01, **COARSE})
    ).to_problem()
    assert problem.facts["treatment"] == "consistent"
    assert problem.sphere_inside
    assert problem.quasi_static.unit == pytest.approx(1.0 / (2.26e9 * 0.025))
    carried = float(problem.facts["sphere_modal_compliance_m_N"])
    left_out = float(problem.facts["plate_static_compliance_m_N"]) - float(
        problem.facts["plate_modal_compliance_m_N"]
    )
    assert problem.quasi_static.linear == pytest.approx(left_out - carried)
    assert set(problem.models) == {"sphere", "plate"}


def test_superposed_bodies_have_nothing_taken_out() -> None:
    problem = vi.case_of(
        case({"model": "elastic", "modes": 10, **COARSE}, **contact(local_compliance="superposed"))
    ).to_problem()
    assert not problem.quasi_static
    assert not problem.sphere_inside


def test_too_few_modes_and_an_overdriven_accelerometer_are_doubted() -> None:
    from vibroimpact.results.result import result_of

    sensor = {**SENSOR, "rate": "1 kHz", "accelerometer": {"range": 1e-3}}
    found = result_of(vi.simulate(vi.case_of(case(plate={"modes": 3}, sensors=[sensor])))).doubts
    # that which changes more is first
    driven, few, *_ = (doubt for doubt in found if "modes" in doubt or "accelerometer" in doubt)
    assert few.startswith("the modes of the plate end at ")
    assert "max_frequency" in few
    assert driven.startswith(
        'the accelerometer of sensor "a1" is overloaded beyond its range of 0.001 m/s2 for '
    )
    assert "take one with a range of " in driven


def test_an_unknown_key_of_an_accelerometer_is_named_with_the_others() -> None:
    with pytest.raises(
        vi.InputError,
        match=r'unknown key "nois"; .* takes resonance, damping_ratio, range, noise, resolution, '
        r'seed, sensitivity\. Did you mean "noise"',
    ):
        vi.case_of(case(sensors=[{**SENSOR, "accelerometer": {"nois": 0.5}}]))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            {"filter": "butterwort"},
            r'sensors\."a1"\.filter.*one of "sigma-delta", "butterworth", "none"\. Did you '
            r'mean "butterworth"',
        ),
        ({"filter": 8}, r'sensors\."a1"\.filter'),
        (
            {"corner": "10 kHz"},
            r'sensors\."a1"\.corner.*"sigma-delta" takes no corner; leave it out, or take '
            r'"butterworth"',
        ),
        ({"filter": "butterworth", "corner": -1.0}, r'sensors\."a1"\.corner'),
        (
            {"filter": "butterworth", "rate": "50 kHz", "corner": "25 kHz"},
            r'sensors\."a1"\.corner: 25000 Hz is not allowed.*below half of the 50000 '
            r"samples.*20000 Hz or less",
        ),
        ({"fliter": "none"}, r'unknown key "fliter".*Did you mean "filter"'),
    ],
)
def test_a_filter_that_does_not_exist_is_explained(given: dict[str, Any], said: str) -> None:
    with pytest.raises(vi.InputError, match=said):
        vi.case_of(case(sensors=[{**SENSOR, **given}]))


def test_the_resolved_case_has_the_filter() -> None:
    (sensor,) = (
        vi.case_of(case(sensors=[{**SENSOR, "filter": "butterworth", "corner": "15 kHz"}]))
        .to_problem()
        .source["sensors"]
    )  # type: ignore[index]
    assert (sensor["filter"], sensor["corner"]) == ("butterworth", 15e3)
    (sensor,) = vi.case_of(case(sensors=[SENSOR])).to_problem().source["sensors"]  # type: ignore[index]
    assert sensor["filter"] == "sigma-delta"


def test_superposed_points_move_with_their_modes_alone() -> None:
    given = {"sensors": [SENSOR]}
    assert set(vi.case_of(case(**given)).to_problem().plate.modes.residuals) == {SENSOR["name"]}  # type: ignore[union-attr]
    superposed = vi.case_of(case(**given, **contact(local_compliance="superposed"))).to_problem()
    assert superposed.plate.modes is not None
    assert not superposed.plate.modes.residuals


def test_samples_of_sensors_of_several_rates_are_counted_each() -> None:
    sensors = [{**SENSOR, "rate": "1 GHz"}, {**SENSOR, "name": "a2", "rate": "1 kHz"}]
    response = vi.simulate(vi.case_of(case(sensors=sensors)))
    with pytest.raises(
        vi.InputError,
        match=re.escape(
            f"{1e9 * response.end_time[0]:.3g} samples, of all sensors, are more than 1e+08"
        ),
    ):
        response.signals()


def test_a_microphone_is_not_told_to_take_another_filter() -> None:
    with pytest.raises(
        vi.InputError, match=r'the filter "sigma-delta" takes no corner; leave it out$'
    ):
        vi.sensors.Sensor("m1", quantity="pressure", instrument=vi.sensors.Microphone(), corner=1e3)
