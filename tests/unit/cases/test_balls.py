"""Balls whose mass and moment of inertia are given: hollow, filled, of two materials."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from dataclasses import replace
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from rich.console import Console

import vibroimpact as vi
from oracles.adams import Motion
from oracles.adams_dataset import read_dataset, read_solver_commands
from oracles.bouncing_in_air import AIR, Medium, bounces
from support import plain_case
from vibroimpact.bayes_error.falls import falls_of_sweep
from vibroimpact.bodies.ball import HOLLOW, SOLID, ball_volume, mean_density
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.rigid.expected import expected_of
from vibroimpact.cases.rigid.pair import ball_of, contact_pair, resized, sphere_density
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.exporting.formats import adams_solver, exudyn, lammps, matlab, mujoco, yade
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.report.slip_chart import slip_chart

CELLULOID = {"density": 1400.0, "youngs_modulus": 2.5e9, "poissons_ratio": 0.35}
RADIUS, MASS = 0.02, 2.7e-3
LIGHT = 80.0  # kg/m^3, a mean density
STEEL = {"density": 7850.0, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3}


def table(**changes: Any) -> dict[str, Any]:
    """A table tennis ball on a steel plate, with other values at dotted keys, in which
    "__" stands for the dot.
    """
    plain = {
        "sphere": {"radius": RADIUS, "material": CELLULOID, "mass": MASS},
        "plate": {"size": [1.0, 1.0, 0.02], "material": STEEL},
        "drop": {"speed": 2.0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    return with_values(plain, {key.replace("__", "."): value for key, value in changes.items()})


def first(**changes: Any) -> dict[str, float]:
    """The first impact of a case."""
    impacts = vi.simulate(vi.case_of(table(**changes))).impacts
    return {name: float(values[0]) for name, values in impacts.items()}


def pair_of(given: dict[str, Any]) -> tuple[vi.Case, vi.Case]:
    """The same case with a mass, and with a material of the mean density, whose product
    with the volume that mass is.
    """
    given, solid = copy.deepcopy(given), copy.deepcopy(given)
    solid["sphere"].pop("mass", None)
    solid["sphere"]["material"] = {**CELLULOID, "density": LIGHT}
    given["sphere"] |= {
        "mass": ball_volume(given["sphere"]["radius"]) * LIGHT,
        "material": CELLULOID,
    }
    return vi.case_of(given), vi.case_of(solid)


BENDING = {
    "plate__model": "elastic",
    "plate__modes": 10,
    "plate__supports": "clamped",
    "plate__damping": 0.01,
}
OBLIQUE = {
    "drop__angle": 0.5,
    "drop__spin": [3.0, 40.0, 5.0],
    "contact__friction": {"law": "mdr", "coefficient": 0.2},
}
DROPS: dict[str, dict[str, Any]] = {
    "speed": {"run__impacts": 3, "contact": {"law": "flores", "restitution": 0.7}},
    "oblique": {**OBLIQUE, "run__impacts": 3},
    "air": {"drop": {"height": 0.3, "air": True, "velocity": [0.5, 0.0, 0.0]}, "run__impacts": 3},
    "liquid": {
        "drop": {"height": 0.3}, "contact": {"law": "tsuji", "restitution": 0.8, "liquid": {"density": 10.0, "viscosity": 1e-3}},
    },
    "elastic plate": {
        **BENDING, "plate__size": [0.3, 0.3, 0.01],
    },
    "shaken": {
        "plate__motion": {"amplitude": 1e-4, "frequency": 50.0}, "drop": {"height": 0.03}, "run__impacts": 3,
        "contact": {"law": "flores", "restitution": 0.8},
    },
    "a free sphere below": {"plate": {"radius": 0.03, "material": STEEL, "supports": "free"}, "drop": {"speed": 2.0, "gravity": 0.0}},
    "finite sphere": {"contact__finite_sphere": True},
}  # fmt: skip


@pytest.mark.parametrize("name", DROPS)
def test_a_mass_counts_as_the_density_of_the_same_mass(name: str) -> None:
    """In impact, flight, estimates, doubts and ledger, to the last digit."""
    given, solid = pair_of(table(**DROPS[name]))
    found, known = vi.simulate(given), vi.simulate(solid)
    for key, values in known.impacts.items():
        np.testing.assert_array_equal(found.impacts[key], values, err_msg=key)
    for key, value in known.energy.items():
        np.testing.assert_array_equal(found.energy[key], value, err_msg=key)
    expected = expected_of(solid)
    assert expected_of(given) == expected
    assert doubts(resolved_case(given), expected) == doubts(resolved_case(solid), expected)
    assert float(found.impacts["max_force_N"][0]) < 0.5 * float(
        vi.simulate(vi.case_of(without_mass(name))).impacts["max_force_N"][0]
    )


def without_mass(name: str) -> dict[str, Any]:
    solid = table(
        **{key: value for key, value in DROPS[name].items() if name != "liquid" or key != "contact"}
    )
    del solid["sphere"]["mass"]
    return solid


def test_density_times_volume_is_the_mass_without_one() -> None:
    """Given, it changes no digit; nor does the word for what is there by default."""
    solid = table(**OBLIQUE)
    del solid["sphere"]["mass"]
    told = {
        **solid,
        "sphere": {
            **solid["sphere"],
            "mass": 4.0 / 3.0 * np.pi * RADIUS**3 * 1400.0,
            "inertia": "solid",
        },
    }
    known, found = (vi.simulate(vi.case_of(one)) for one in (solid, told))
    for key, values in known.impacts.items():
        np.testing.assert_array_equal(found.impacts[key], values, err_msg=key)


def test_hertz_in_closed_form() -> None:
    """The largest force grows with the power 3/5 of the mass."""
    found = first(sphere__mass="2.7 g", drop__gravity=0.0)
    modulus = 1.0 / ((1.0 - 0.35**2) / 2.5e9 + (1.0 - 0.3**2) / 2.1e11)
    stiffness = 4.0 / 3.0 * modulus * RADIUS**0.5
    assert found["max_force_N"] == pytest.approx(
        stiffness * (1.25 * MASS * 2.0**2 / stiffness) ** 0.6, rel=1e-9
    )


@pytest.mark.parametrize(
    ("inertia", "ratio"),
    [("hollow", 2.0 / 3.0), ("solid", 0.4), ("5 g cm^2", 5e-7 / (MASS * RADIUS**2))],
)
class TestRigidBodyImpact:
    """Oblique impacts of rigid bodies in closed form, with the moment of inertia I = k m
    R^2 of a ball.
    """

    def test_sliding(self, inertia: Any, ratio: float) -> None:
        """Coulomb's impulse mu m (1 + e) v changes velocity and spin."""
        along, coefficient = 2.0 * np.tan(1.3), 0.1
        friction = {
            "law": "newton",
            "restitution": 0.8,
            "friction": {"law": "coulomb", "coefficient": coefficient},
        }
        found = first(
            sphere__inertia=inertia,
            drop={"velocity": [along, 0.0, -2.0], "spin": [0.0, 7.0, 0.0], "gravity": 0.0},
            contact=friction,
        )
        impulse = coefficient * 1.8 * 2.0
        assert along - RADIUS * 7.0 > (1.0 + 1.0 / ratio) * impulse, "it slides throughout"
        assert found["separation_velocity_x_m_s"] == pytest.approx(along - impulse, rel=1e-12)
        assert found["spin_y_after_rad_s"] == pytest.approx(
            7.0 + impulse / (ratio * RADIUS), rel=1e-12
        )

    def test_rolling(self, inertia: Any, ratio: float) -> None:
        """What slides to its end leaves 1/(1 + k) of the velocity: 3/5 of a shell, 5/7 of
        a solid ball; the energy is lost in the slip.
        """
        friction = {"law": "hertz", "friction": {"law": "coulomb", "coefficient": 0.9}}
        found = first(
            sphere__inertia=inertia,
            drop={"velocity": [0.5, 0.0, -2.0], "gravity": 0.0},
            contact=friction,
        )
        assert found["separation_velocity_x_m_s"] == pytest.approx(0.5 / (1.0 + ratio), rel=1e-9)
        assert found["spin_y_after_rad_s"] == pytest.approx(0.5 / (1.0 + ratio) / RADIUS, rel=1e-9)
        lost = 0.5 * MASS * 0.5**2 * ratio / (1.0 + ratio)
        assert found["friction_lost_J"] == pytest.approx(lost, rel=1e-8)

    def test_a_slip_that_is_reversed(self, inertia: Any, ratio: float) -> None:
        """Walton's impulse leaves (1 - k beta) / (1 + k) of the velocity."""
        friction = {
            "law": "newton",
            "restitution": 0.8,
            "friction": {"law": "rigid", "coefficient": 9.0, "slip_restitution": 0.3},
        }
        found = first(
            sphere__inertia=inertia,
            drop={"velocity": [0.5, 0.0, -2.0], "gravity": 0.0},
            contact=friction,
        )
        assert found["separation_velocity_x_m_s"] == pytest.approx(
            0.5 * (1.0 - 0.3 * ratio) / (1.0 + ratio), rel=1e-12
        )

    def test_a_ball_that_rolls_down(self, inertia: Any, ratio: float) -> None:
        """It accelerates by g sin(a) / (1 + k), and its rotation has k of its kinetic energy."""
        given = table(
            sphere__inertia=inertia, plate__inclination=0.1, drop={"speed": 1e-3}, run={"duration": 0.4},
            contact={"law": "newton", "restitution": 0.01, "friction": {"law": "coulomb", "coefficient": 0.5}},
        )  # fmt: skip
        ends = vi.simulate(vi.case_of(given)).at([0.2, 0.4])
        speed = np.diff(ends["velocity_x_m_s"])[0]
        assert speed == pytest.approx(9.80665 * np.sin(0.1) / (1.0 + ratio) * 0.2, rel=1e-9)
        along = 0.5 * MASS * ends["velocity_x_m_s"] ** 2
        np.testing.assert_allclose(ends["rotation_J"], ratio * along, rtol=1e-8)


@pytest.mark.parametrize("law", ["mdr", "mindlin-force"])
@pytest.mark.parametrize("model", ["rigid", "elastic"])
def test_friction_with_compliance_goes_to_the_closed_form(law: str, model: str) -> None:
    """A shell that slides throughout, on a rigid plate and on an elastic one, gets mu
    times the impulse along the normal.
    """
    plate = {**BENDING, "plate__size": [0.3, 0.3, 0.05]} if model == "elastic" else {}
    found = first(
        sphere__inertia="hollow", **plate, contact__friction={"law": law, "coefficient": 0.05},
        drop={"velocity": [6.0, 0.0, -2.0], "gravity": 0.0},
    )  # fmt: skip
    impulse = 0.05 * (found["approach_speed_m_s"] + found["separation_speed_m_s"])
    assert found["separation_velocity_x_m_s"] == pytest.approx(6.0 - impulse, abs=2e-6)
    assert RADIUS * found["spin_y_after_rad_s"] == pytest.approx(1.5 * impulse, abs=3e-6)


@pytest.mark.parametrize(
    ("changes", "medium"),
    [
        ({"drop": {"height": 0.305, "air": True}}, AIR),
        (
            {"drop": {"height": 0.305}, "contact__liquid": {"density": 1.2, "viscosity": 1.81e-5}},
            Medium(1.2, 1.81e-5, 1.0, 0.5),
        ),
    ],
    ids=["drag alone", "with buoyancy and added mass"],
)
def test_a_table_tennis_ball_in_air(changes: dict[str, Any], medium: Medium) -> None:
    """It falls and bounces as SciPy integrates it, with its mean density."""
    law = {"law": "newton", "restitution": 0.9}
    given = table(contact=law, **{**changes, "run__impacts": 3})
    impacts = vi.simulate(vi.case_of(given)).impacts
    # the film of a liquid takes from the restitution, by the speed
    achieved = dict(
        zip(impacts["approach_speed_m_s"].round(3), impacts["restitution_achieved"], strict=True)
    )
    known = bounces(
        RADIUS,
        MASS / (4.0 / 3.0 * np.pi * RADIUS**3),
        0.305,
        lambda speed: float(achieved[round(speed, 3)]),
        2,
        medium=medium,
    )
    np.testing.assert_allclose(impacts["time_s"], known.touches, rtol=1e-8)
    np.testing.assert_allclose(impacts["approach_speed_m_s"], known.before, rtol=1e-8)


def test_a_ball_that_floats_or_is_too_light_for_drag_alone() -> None:
    """The mean density counts in what is refused, not that of the material."""
    with pytest.raises(
        vi.InputError,
        match=r"contact.liquid.density: the liquid has 12.* times the density of the sphere, "
        r"which floats",
    ):
        vi.case_of(
            table(
                drop={"height": 0.3}, contact={"law": "tsuji", "restitution": 0.8, "liquid": True}
            )
        ).to_problem()
    with pytest.raises(
        vi.InputError,
        match=r"drop.air.density: the medium of the fall has 4.02 % of the density of the sphere",
    ):
        vi.case_of(table(sphere__mass="1 g", drop={"height": 0.3, "air": True})).to_problem()


def test_a_study_over_mass_and_inertia() -> None:
    """As a batch and one by one; a mass that no ball of this inertia has fails alone."""
    given = table(**{**OBLIQUE, "sphere__inertia": 7e-7})
    masses = np.array([1.2e-3, 2.7e-3, 5e-3])
    keep = ("impacts",)
    found = compute_points(given, keep, 0, {"sphere.mass": masses})
    assert list(found.failures) == [0]
    assert found.failures[0].startswith(
        "sphere.inertia: it is 1.458 times the mass and the squared radius"
    )
    for place in (1, 2):
        known = vi.simulate(vi.case_of(with_values(given, {"sphere.mass": masses[place]}))).impacts
        for name in ("max_force_N", "separation_velocity_x_m_s", "spin_y_after_rad_s"):
            assert found.arrays[name][place, 0] == pytest.approx(known[name][0], rel=1e-8), name
    words = np.array(["solid", "hollow", 7e-7], dtype=object)
    turned = compute_points(given, keep, 0, {"sphere.inertia": words}).arrays["spin_y_after_rad_s"][
        :, 0
    ]
    assert turned[1] != turned[0] != turned[2]


def test_inertia_as_a_swept_key() -> None:
    over = {
        "sphere.inertia": ["solid", "hollow", "5 g cm^2"],
        "sphere.mass": {"from": "2 g", "to": "3 g", "number": 2},
    }
    study = vi.studies.sweep_of({**table(**OBLIQUE), "sweep": {"over": over}})
    assert study.size == 6
    assert study.plan.columns["sphere.inertia"].tolist()[-1] == pytest.approx(5e-7)
    ranged = vi.studies.sweep_of(
        {
            **table(**OBLIQUE),
            "sweep": {
                "over": {"sphere.inertia": {"from": "4 g cm^2", "to": "7 g cm^2", "number": 2}}
            },
        }
    )
    np.testing.assert_allclose(ranged.plan.columns["sphere.inertia"], [4e-7, 7e-7])
    with pytest.raises(
        vi.InputError, match=r"it must be .solid. or .hollow., or a moment of inertia"
    ):
        vi.studies.sweep_of(
            {**table(**OBLIQUE), "sweep": {"over": {"sphere.inertia": ["solid", "holow"]}}}
        )


@pytest.mark.slow
def test_the_slip_map_of_a_study_has_the_line_of_a_shell(tmp_path: Path) -> None:
    """Impacts that slip throughout lie on the line of slope one that is lower by (1 +
    3/2) (1 + e) G*/E*.
    """
    drop = {"angle": 1.2, "speed": 2.0, "gravity": 0.0}
    given = table(
        sphere__inertia="hollow", drop=drop, contact__friction={"law": "mdr", "coefficient": 0.1}
    )
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**given, "sweep": {"over": {"drop.angle": [1.1, 1.2, 1.3]}}}),
            tmp_path / "study",
        )
    )
    chart = slip_chart(study)
    assert chart is not None
    line = next(
        mark
        for row in chart.rows
        for panel in row
        for mark in panel.marks
        if getattr(mark, "name", "") == "slips throughout"
    )
    points = next(
        mark
        for row in chart.rows
        for panel in row
        for mark in panel.marks
        if hasattr(mark, "texts")
    )
    np.testing.assert_allclose(points.y - points.x, line.y[0] - line.x[0], rtol=1e-4)


class TestCaseFile:
    def test_the_resolved_case_gives_the_same(self) -> None:
        case = vi.case_of(table(sphere__mass="2.7 g", sphere__inertia="7 g cm^2"))
        resolved = resolved_case(case)
        assert (resolved["sphere"]["mass"], resolved["sphere"]["inertia"]) == (
            MASS,
            pytest.approx(7e-7),
        )
        assert resolved_case(vi.case_of(resolved)) == resolved
        assert (
            resolved_case(vi.case_of(table(sphere__inertia="hollow")))["sphere"]["inertia"]
            == "hollow"
        )

    def test_without_them_nothing_is_added(self) -> None:
        assert not {"mass", "inertia"} & set(resolved_case(vi.case_of(plain_case()))["sphere"])

    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"sphere__mass": 0}, "sphere.mass: 0 is not allowed; it must be greater than 0 kg"),
            ({"sphere__mass": "2.7 mm"}, 'sphere.mass: "2.7 mm" is a length; expected a mass'),
            (
                {"sphere__inertia": "holow"},
                'sphere.inertia: "holow" is not allowed; it must be "solid" or "hollow", or '
                "a moment of inertia with its unit [kg m^2]. "
                'Did you mean "hollow"?',
            ),
            (
                {"sphere__inertia": 1e-6},
                "sphere.inertia: it is 0.9259 times the mass and the squared radius, and no "
                "sphere has more than the 2/3 of a thin shell: "
                'give at most 7.2e-07 kg m^2, or "hollow"',
            ),
            (
                {"sphere__inertia": 0},
                "sphere.inertia: 0 is not allowed; it must be greater than 0 kg m^2",
            ),
            (
                {"sphere__model": "elastic"},
                "sphere.mass: an elastic sphere is solid, 0.04691 kg of its material, not "
                "0.0027 kg; leave it out, or give model = "
                '"rigid", or a material with the density 80.57 kg/m^3',
            ),
            (
                {
                    "sphere": {
                        "radius": RADIUS,
                        "material": CELLULOID,
                        "model": "elastic",
                        "inertia": "hollow",
                    }
                },
                "sphere.inertia: an elastic sphere is solid, with 7.506e-06 kg m^2 of its "
                "material, not 1.251e-05 kg m^2; leave it out, or "
                'give model = "rigid"',
            ),
            (
                {"sphere__material": "rigid"},
                'sphere.material: "rigid" has no modulus, and the sphere needs one; only the plate',
            ),
        ],
    )
    def test_messages(self, changes: dict[str, Any], words: str) -> None:
        with pytest.raises(vi.InputError) as error:
            vi.case_of(table(**changes))
        assert str(error.value).startswith(words)

    def test_an_elastic_sphere_of_its_own_mass(self) -> None:
        """Rounded, as it is typed."""
        assert (
            vi.case_of(
                table(sphere__model="elastic", sphere__mass="46.9 g", sphere__inertia="solid")
            ).sphere.mass
            == 0.0469
        )

    @pytest.mark.parametrize(
        ("key", "value", "words"),
        [
            (
                "mass",
                2.7,
                'would be 81000 kg/m^3, heavier than any metal; was 2.7 g meant? Write "2.7 g"',
            ),
            ("mass", 1e-5, "is lighter than the air in its place; was 0.01 kg meant?"),
            (
                "inertia",
                7e-13,
                "times less than that of a solid ball, 4.32e-7 kg m^2; was 7e-7 kg m^2 "
                'meant? Write "7e-7 kg m^2"',
            ),
            (
                "inertia",
                1e-9,
                "is 432 times less than that of a solid ball, 4.32e-7 kg m^2; leave it out "
                "if the ball is solid, or look at",
            ),
        ],
    )
    def test_slips_of_units(self, key: str, value: float, words: str) -> None:
        case = vi.case_of(table(**{f"sphere__{key}": value}))
        (said,) = [
            one
            for one in doubts(resolved_case(case), expected_of(case))
            if one.startswith(f"sphere.{key}")
        ]
        assert words in said

    @pytest.mark.parametrize(
        ("changes", "said"),
        [
            (
                {},
                [
                    "of a mean density of 80.57 kg/m3, 0.0576 times its material's, so "
                    "hollow or light inside; "
                    "a stiffness from Hertz's theory is that of a solid ball"
                ],
            ),
            (
                {"sphere__mass": 0.1},
                ["of a mean density of 2984 kg/m3, 2.13 times its material's, so heavy inside"],
            ),
            ({"sphere__mass": 0.047}, ["of a mean density of 1403 kg/m3, 1 times its material's"]),
            (
                {"sphere__inertia": "hollow"},
                ["moment of inertia 7.2e-07 kg m2, 0.6667 times mass and squared radius"],
            ),
            (
                OBLIQUE,
                [
                    "moment of inertia 4.32e-07 kg m2, 0.4 times mass and squared radius, "
                    "as of a solid ball; "
                    'of a shell: sphere.inertia = "hollow"'
                ],
            ),
        ],
    )
    def test_what_check_says(self, changes: dict[str, Any], said: list[str]) -> None:
        """How far the mean density is from that of the material, which is no doubt: it is
        what a hollow ball is.
        """
        case = vi.case_of(table(**changes))
        written = StringIO()
        Console(file=written, width=300).print(case_explained(case))
        lines = [line.strip() for line in written.getvalue().splitlines()]
        for one in said:
            assert one in lines
        assert not [line for line in lines if line.startswith("Doubt") and "density" in line]

    def test_the_page_of_a_run_says_it(self) -> None:
        from vibroimpact.runs.setup import setup_rows

        result = vi.result_of(vi.simulate(vi.case_of(table(sphere__inertia="hollow"))))
        assert (
            dict(setup_rows(result))["Sphere"]
            .replace("\xa0", " ")
            .startswith("rigid, radius 20 mm, mass 2.7 g, hollow, ")
        )


class TestPython:
    def test_a_batch(self) -> None:
        """Arrays of masses and moments of inertia, as one drop after the other."""
        material, law = (
            vi.Material(**CELLULOID),
            vi.laws.find_contact_law("newton")(restitution=0.8),
        )
        oblique = vi.Oblique(
            velocity=(0.5, 0.0), friction=vi.friction.find_friction_law("coulomb")(coefficient=0.9)
        )

        def problem(mass: Any, inertia: Any) -> vi.Problem:
            ball = vi.rigid_sphere(RADIUS, material, mass=mass, inertia=inertia)
            return vi.Problem(
                sphere=ball,
                plate=vi.rigid_plate(),
                laws=law,
                speed=2.0,
                oblique=oblique,
                impacts=1,
                gravity=0.0,
            )

        masses, moments = [1e-3, 2e-3], [1e-7, 4e-7]
        both = problem(masses, moments)
        assert both.shape == (2,)
        found = vi.simulate(both).impacts["separation_velocity_x_m_s"][:, 0]
        ratio = np.array(moments) / (np.array(masses) * RADIUS**2)
        np.testing.assert_allclose(found, 0.5 / (1.0 + ratio), rtol=1e-12)
        np.testing.assert_allclose(both.inertia_ratio, ratio)
        one = both.take(1)
        assert (one.sphere.mass, one.sphere.inertia) == (2e-3, 4e-7)

    def test_inertia_is_given_once(self) -> None:
        ball = vi.rigid_sphere(RADIUS, vi.Material(**CELLULOID), inertia="hollow")
        law = vi.laws.find_contact_law("hertz")(stiffness=1e8)
        with pytest.raises(vi.InputError, match="the moment of inertia is given twice"):
            vi.Problem(
                sphere=ball,
                plate=vi.rigid_plate(),
                laws=law,
                speed=1.0,
                oblique=vi.Oblique(inertia_ratio=0.5),
            )

    @pytest.mark.parametrize(
        ("given", "words"),
        [
            (
                {"inertia": "full"},
                '"full" is not allowed; inertia must be a number in kg m^2, "solid" or "hollow"',
            ),
            ({"inertia": -1.0}, "the moment of inertia of a body must be positive and finite"),
            ({"inertia": np.nan}, "the moment of inertia of a body must be positive and finite"),
            ({"mass": -1.0}, "the mass of a body must be positive"),
        ],
    )
    def test_messages(self, given: Mapping[str, Any], words: str) -> None:
        with pytest.raises(vi.InputError, match=re.escape(words)):
            vi.rigid_sphere(RADIUS, vi.Material(**CELLULOID), **given)

    def test_words(self) -> None:
        steel = vi.Material(**STEEL)
        solid, hollow = (vi.rigid_sphere(0.1, steel, inertia=word) for word in ("solid", "hollow"))
        assert solid.inertia == pytest.approx(SOLID * solid.mass * 0.01)
        assert hollow.inertia == pytest.approx(HOLLOW * solid.mass * 0.01)
        assert mean_density(solid.mass, 0.1) == pytest.approx(7850.0)


class TestExports:
    """Mass and moment of inertia in the files for other programs."""

    def drop(
        self,
        inertia: Any = "hollow",
        law: str = "coulomb",
        contact: str = "tsuji",
        coefficient: float = 0.9,
    ) -> Any:
        start = {"height": 0.3, "velocity": [0.5, 0.0, 0.0]}
        given = table(
            sphere__inertia=inertia, drop=start, contact={"law": contact, "restitution": 0.8}
        )
        if law:
            given["contact"]["friction"] = {"law": law, "coefficient": coefficient}
        case = vi.case_of(given)
        return drop_of_result(vi.result_of(vi.simulate(case)), case)

    def test_mass_and_inertia(self) -> None:
        drop = self.drop()
        assert (drop.mass, drop.inertia, drop.is_solid) == (MASS, pytest.approx(7.2e-7), False)
        assert self.drop("solid").is_solid

    def test_adams(self) -> None:
        drop = self.drop(contact="flores")
        (text,) = (
            one.decode() for name, one in adams_solver.write(drop).items() if name.endswith(".adm")
        )
        assert float(re.search(r"MASS = ([0-9.]+)", text)[1]) == MASS
        moments = [float(value) for value in re.search(r"IP = ([^\n]+)", text)[1].split(",")]
        assert moments == pytest.approx([0.72] * 3)  # kg mm^2

    @pytest.mark.slow
    @pytest.mark.parametrize("coefficient", [0.05, 0.9])
    def test_adams_integrated(self, coefficient: float) -> None:
        """The model that a parser reads moves as the drop did: a shell that slides
        throughout, and one that rolls at last.
        """
        drop = self.drop(contact="flores", coefficient=coefficient)
        files = {name[-3:]: text.decode() for name, text in adams_solver.write(drop).items()}
        model = read_dataset(files["adm"])
        read_solver_commands(files["acf"], model)
        found = Motion(model).run()[0].along
        impacts = {name: float(values[0]) for name, values in drop.impacts.items()}
        assert found[0] == pytest.approx(impacts["separation_velocity_x_m_s"], abs=2e-5)
        assert RADIUS * found[3] == pytest.approx(RADIUS * impacts["spin_y_after_rad_s"], abs=2e-5)

    def test_mujoco(self) -> None:
        root = ElementTree.fromstring(
            next(iter(mujoco.FORMAT.write(self.drop(law="")).values())).decode()
        )
        inertial = root.find("worldbody/body/inertial")
        assert inertial is not None
        assert float(inertial.attrib["mass"]) == MASS
        assert [float(value) for value in inertial.attrib["diaginertia"].split()] == pytest.approx(
            [7.2e-7] * 3
        )

    def test_exudyn(self) -> None:
        text = next(iter(exudyn.FORMAT.write(self.drop()).values())).decode()
        values = {"RADIUS": RADIUS, "MASS": MASS}
        assert f"RADIUS, MASS, GRAVITY = {RADIUS!r}, {MASS!r}, " in text
        assert eval(re.search(r"INERTIA = (.+)", text)[1], values) == pytest.approx(7.2e-7)

    def test_yade(self) -> None:
        """The mass is that of the density; the inertia is set where the sphere is not solid."""
        text = next(iter(yade.FORMAT.write(self.drop(law="mindlin-force")).values())).decode()
        compile(text, "script.py", "exec")
        assert float(re.search(r"density=([^,]+),", text)[1]) == pytest.approx(80.57, rel=1e-4)
        names = {"ball": SimpleNamespace(state=SimpleNamespace())}
        exec(re.search(r"ball\.state\.inertia = .+", text)[0], names)
        assert names["ball"].state.inertia == pytest.approx((7.2e-7,) * 3)
        solid = next(iter(yade.FORMAT.write(self.drop("solid", "mindlin-force")).values())).decode()
        assert "inertia" not in solid

    def test_lammps(self) -> None:
        """Its spheres are solid: friction on another one is refused, and without friction
        it does not matter.
        """
        with pytest.raises(
            vi.InputError,
            match=r"sphere.inertia: 7.2e-07 kg m\^2 can't be written for LAMMPS, whose spheres",
        ):
            lammps.FORMAT.write(self.drop(law="mindlin"))
        drop = self.drop(law="")
        text = next(iter(lammps.FORMAT.write(drop).values())).decode()
        assert float(re.search(r"density (\S+)", text)[1]) == pytest.approx(80.57, rel=1e-4)
        note = (
            "LAMMPS has the moment of inertia of a solid sphere, which does "
            "not matter without friction."
        )
        assert note in lammps.FORMAT.notes(drop)
        assert note not in lammps.FORMAT.notes(replace(drop, inertia_ratio=0.4))

    def test_matlab(self, tmp_path: Path) -> None:
        from scipy.io import loadmat

        (file,) = matlab.FORMAT.write(self.drop()).values()
        (tmp_path / "drop.mat").write_bytes(file)
        facts = loadmat(tmp_path / "drop.mat", simplify_cells=True)
        drop, units = facts["drop"], facts["units"]["drop"]
        assert (drop["mass"], drop["inertia"], units["inertia"]) == (
            MASS,
            pytest.approx(7.2e-7),
            "kg m2",
        )


class TestEstimates:
    def test_a_sphere_of_another_radius_has_the_mean_density(self) -> None:
        sphere = vi.case_of(table(sphere__inertia="7 g cm^2")).sphere
        other = resized(sphere, 0.03)
        assert sphere_density(other) == pytest.approx(sphere_density(sphere), rel=1e-14)
        ratios = [
            ball_of(one).inertia / (ball_of(one).mass * one.radius**2) for one in (sphere, other)
        ]
        assert ratios[1] == pytest.approx(ratios[0])
        plain = vi.case_of(plain_case()).sphere
        assert resized(plain, 0.03).mass is None

    @pytest.mark.parametrize("air", [None, True])
    def test_a_calibration_to_flights(self, air: bool | None) -> None:
        """Heights of rebound, in a vacuum and in air, as with a material of that density."""
        target = {"rebound_heights": [0.25, 0.2, 0.17]}
        calibrate = {"target": target, **({} if air is None else {"air": air})}
        law = {"law": "hunt-crossley", "restitution": 0.9}
        found, known = (
            vi.calibration.calibrate_case(
                vi.calibration.calibration_of({**resolved_case(case), "calibrate": calibrate})
            )
            for case in pair_of(table(drop={"height": 0.305}, contact=law, run__impacts=3))
        )
        np.testing.assert_array_equal(found.values, known.values)

    def test_friction_that_is_calibrated_to_a_shell(self, tmp_path: Path) -> None:
        """Sticking impacts leave 3/5 - 2/5 beta of the velocity of a shell: closed form;
        the chart lies on its points.
        """
        beta, angles = 0.3, np.radians([2.0, 5.0, 8.0])
        rows = "".join(f"{np.degrees(angle):.9g},3.0,{0.6 - 0.4 * beta:.9g}\n" for angle in angles)
        (tmp_path / "measured.csv").write_text(
            f"angle [deg],speed [m/s],tangential_restitution\n{rows}", encoding="utf-8"
        )
        given = table(
            sphere__inertia="hollow", drop={"speed": 3.0, "angle": 0.1, "gravity": 0.0},
            contact={"law": "newton", "restitution": 0.8, "friction": {"law": "rigid", "coefficient": 0.5}},
        )  # fmt: skip
        calibrate = {
            "target": str(tmp_path / "measured.csv"),
            "parameter": "friction.slip_restitution",
        }
        found = vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**given, "calibrate": calibrate})
        )
        assert found.values == pytest.approx([beta], abs=1e-6)

    @pytest.mark.parametrize("measured", ["velocity", "spin"])
    def test_the_slip_map_of_a_calibration(self, tmp_path: Path, measured: str) -> None:
        """Marks of measured impacts lie where momentum has them: friction that slows a
        shell by dv changes its spin by 3/2 dv/R.
        """
        angles, speed = np.radians([20.0, 30.0, 40.0]), 3.0
        given = table(
            sphere__inertia="hollow", drop={"speed": speed, "angle": 0.1, "gravity": 0.0},
            contact={"law": "newton", "restitution": 0.8, "friction": {"law": "coulomb", "coefficient": 0.1}},
        )  # fmt: skip
        along, normal = speed * np.sin(angles), speed * np.cos(angles)
        slowed = np.array([0.31, 0.35, 0.3])
        column = {
            "velocity": ("separation_velocity_x [m/s]", along - slowed),
            "spin": ("spin_y_after [rad/s]", 1.5 * slowed / RADIUS),
        }
        name, values = column[measured]
        rows = "".join(
            f"{np.degrees(angle):.12g},3.0,{value:.12g}\n"
            for angle, value in zip(angles, values, strict=True)
        )
        (tmp_path / "measured.csv").write_text(
            f"angle [deg],speed [m/s],{name}\n{rows}", encoding="utf-8"
        )
        calibrate = {"target": str(tmp_path / "measured.csv"), "parameter": "friction.coefficient"}
        found = vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**given, "calibrate": calibrate})
        )
        assert isinstance(found, vi.calibration.FrictionCalibration)
        chart = found.charts["slip_map"]
        marks = next(
            mark
            for row in chart.rows
            for panel in row
            for mark in panel.marks
            if getattr(mark, "name", "") == "measured"
        )
        pair = contact_pair(vi.case_of(given))
        scale = (
            found.values[0] * float(pair.effective_modulus / pair.effective_shear_modulus) * normal
        )
        np.testing.assert_allclose(marks.x, along / scale, rtol=1e-9)
        np.testing.assert_allclose(marks.y, (along - 2.5 * slowed) / scale, rtol=1e-6, atol=1e-6)

    def test_the_falls_of_a_population(self) -> None:
        classes = {
            "light": {
                "share": 0.5,
                "over": {"sphere.mass": {"distribution": "uniform", "from": "2 g", "to": "3 g"}},
            },
            "heavy": {
                "share": 0.5,
                "over": {"sphere.mass": {"distribution": "uniform", "from": "20 g", "to": "30 g"}},
            },
        }
        given = table(contact={"law": "tsuji", "restitution": 0.6})
        falls = falls_of_sweep(
            vi.studies.sweep_of(
                {
                    **given,
                    "sweep": {
                        "design": "population",
                        "samples": 20,
                        "over": {"drop.speed": {"distribution": "uniform", "from": 1.0, "to": 2.0}},
                        "classes": classes,
                    },
                }
            )
        )
        light = falls.classes == "light"
        assert 2e-3 <= falls.mass[light].min() < falls.mass[light].max() <= 3e-3
        assert 20e-3 <= falls.mass[~light].min() < falls.mass[~light].max() <= 30e-3
        np.testing.assert_allclose(
            falls.impulse, falls.mass * falls.speed * (1.0 + falls.restitution)
        )


@pytest.mark.slow
def test_identification_has_the_mean_density() -> None:
    """A sphere is identified among balls of the mean density of the case's, as with a
    material of that density.
    """
    plate = {
        "size": [0.3, 0.3, 0.02],
        "material": STEEL,
        "model": "elastic",
        "modes": 20,
        "supports": "clamped",
        "damping": 0.01,
    }
    sensors = [
        {"name": name, "position": place, "rate": 20e3}
        for name, place in (("a", [0.1, 0.03]), ("b", [-0.05, 0.08]))
    ]
    given = {
        **table(),
        "plate": plate,
        "sensors": sensors,
        "drop": {"speed": 2.0, "position": [0.02, 0.01]},
    }
    heavy = 1500.0
    given["sphere"] |= {
        "material": {**CELLULOID, "density": 9000.0},
        "mass": ball_volume(RADIUS) * heavy,
    }
    solid = copy.deepcopy(given)
    solid["sphere"] = {"radius": RADIUS, "material": {**CELLULOID, "density": heavy}}
    cases = [vi.case_of(one) for one in (given, solid)]
    records = [
        vi.signals.Record(name, one.value, 20e3, "m/s2")
        for name, one in vi.simulate(cases[0]).signals().items()
    ]
    found, known = (vi.identification.identify(case, records).estimates for case in cases)
    assert found["mass_kg"].value == pytest.approx(given["sphere"]["mass"], rel=0.05)
    for name, estimate in known.items():
        assert found[name].value == pytest.approx(estimate.value, rel=1e-6), name


def test_a_mass_or_an_inertia_that_is_no_number_is_refused_as_such() -> None:
    steel, rigid = vi.find_material("steel"), vi.find_material("rigid")
    with pytest.raises(
        vi.InputError, match="the moment of inertia of a body must be positive and finite"
    ):
        vi.rigid_sphere(0.02, steel, inertia=float("nan"))
    with pytest.raises(vi.InputError, match="the mass of a body must be positive"):
        vi.rigid_sphere(0.02, rigid, inertia=1e-5)  # a rigid material has no density
    with pytest.raises(vi.InputError, match="the mass of a body must be positive"):
        vi.rigid_sphere(0.02, steel, mass=0.0, inertia=1e-5)
