"""What is written for LAMMPS, YADE, MuJoCo and EXUDYN; that the programs take it is seen
in tests/verification/test_vs_peers.py.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from exported_drops import MASS, RADIUS, STIFFNESS, told, told_case
from vibroimpact.contact.friction.laws.mindlin import MindlinForce
from vibroimpact.contact.friction.registry import find_friction_law
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.parameters import parameter
from vibroimpact.contact.registry import contact_laws
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import clipped_dashpot
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.formats import adams_solver, exudyn, lammps, mujoco, yade

FORMATS = [lammps.FORMAT, yade.FORMAT, mujoco.FORMAT, exudyn.FORMAT]
TSUJI = Tsuji(stiffness=STIFFNESS, restitution=0.7, effective_mass=MASS)
PAIR = ContactPair(
    effective_modulus=2.4265e9, effective_radius=RADIUS, effective_mass=MASS, poissons_ratio=0.28
)


@dataclass(frozen=True, kw_only=True)
class WithOffset(HystereticLaw):
    """A law whose damping factor has a parameter beside the restitution."""

    name = "with-offset"
    equation = "F = K delta^n [1 + (c + (1 - e) / sqrt(e)) delta_dot / v0]"
    source = "nobody"

    offset: float = parameter("offset", at_least=0)

    @property
    def damping_factor(self) -> Any:
        return self.offset + (1.0 - self.restitution) / np.sqrt(self.restitution)


@dataclass(frozen=True, kw_only=True)
class InPieces(HystereticLaw):
    """A law with one damping factor for soft, and another for hard impacts."""

    name = "in-pieces"
    equation = "F = K delta^n [1 + D delta_dot / v0]"
    source = "nobody"

    @property
    def damping_factor(self) -> Any:
        return np.where(self.restitution < 0.5, 1.0, 2.0 * (1.0 - self.restitution))


def text_of(form: Any, drop: Drop) -> str:
    (content,) = form.write(drop).values()
    return content.decode()


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)
class TestAll:
    def test_says_units_law_and_notes(self, form: Any) -> None:
        drop = told_case("paper:type1-variable")
        text = text_of(form, drop)
        assert "Units: m, kg, s, N" in text
        assert "adams-impact" in text
        assert all(note in text for note in form.notes(drop))
        assert "was not run" not in form.tested

    def test_odd_names(self, form: Any) -> None:
        drop = replace(told(TSUJI), name='a """ <name> --> & \\ $x\nnewline &')
        text = text_of(form, drop)
        if form is mujoco.FORMAT:
            ElementTree.fromstring(text)
        elif form is not lammps.FORMAT:
            compile(text, "script.py", "exec")
        else:
            assert not re.search(r"^#.*&\s*$", text, re.MULTILINE)
        (name,) = form.write(drop)
        assert re.fullmatch(r"a-name-x-newline[-a-z]*\.[a-z]+", name)

    def test_refuses_laws_without_a_spring(self, form: Any) -> None:
        with pytest.raises(InputError, match=r"newton can't be written for"):
            form.write(told(Newton(restitution=0.7)))

    def test_refuses_a_drop_without_impacts(self, form: Any) -> None:
        drop = told(TSUJI)
        with pytest.raises(InputError, match="does not reach the plate"):
            form.write(
                replace(drop, impacts={name: column[:0] for name, column in drop.impacts.items()})
            )

    def test_refuses_a_drop_without_gravity(self, form: Any) -> None:
        with pytest.raises(InputError, match="no gravity"):
            form.write(replace(told(TSUJI), gravity=0.0))

    def test_elastic_bodies_are_noted(self, form: Any) -> None:
        notes = form.notes(replace(told(TSUJI), elastic=("sphere", "plate")))
        assert any("sphere and plate are written as rigid" in note for note in notes)


@pytest.mark.parametrize("form", [lammps.FORMAT, yade.FORMAT], ids=lambda form: form.name)
class TestParticlePrograms:
    def test_refuse_another_exponent(self, form: Any) -> None:
        with pytest.raises(InputError, match=r"1\.2 can't be written"):
            form.write(told(Hertz(stiffness=1e8, exponent=1.2)))

    def test_refuse_a_spring_that_changes(self, form: Any) -> None:
        with pytest.raises(InputError, match="spring changes from impact to impact"):
            form.write(told(Hertz(stiffness=1e8), Hertz(stiffness=2e8)))


class TestLammps:
    @staticmethod
    def wall(drop: Drop) -> tuple[str, float, list[float], str]:
        """Return spring, its stiffness, the coefficient of each impact and the damping."""
        text = text_of(lammps.FORMAT, drop)
        found = re.search(
            r"wall/gran granular (\w+) (\S+) \S+ damping (\w+(?: limit_damping)?) ", text
        )
        values = re.search(r"coefficient vector \[(.*)\]", text)
        assert found is not None
        assert values is not None
        return found[1], float(found[2]), [float(value) for value in values[1].split(",")], found[3]

    def test_own_laws(self) -> None:
        assert self.wall(told(TSUJI)) == (
            "hertz",
            STIFFNESS / math.sqrt(RADIUS),
            [pytest.approx(0.7, abs=1e-15)] * 3,
            "coeff_restitution",
        )
        linear = LinearSpringDashpot(stiffness=2e6, damping=80.0)
        assert self.wall(told(linear)) == ("hooke", 2e6, [80.0] * 3, "velocity")
        kono = KuwabaraKono(stiffness=STIFFNESS, dissipation_time=1e-5)
        eta = 1.5 * STIFFNESS * 1e-5 / (MASS * math.sqrt(RADIUS))
        assert self.wall(told(kono)) == (
            "hertz",
            STIFFNESS / math.sqrt(RADIUS),
            [eta] * 3,
            "viscoelastic limit_damping",
        )
        for law in (TSUJI, linear, kono):
            assert lammps.FORMAT.notes(told(law)) == []

    def test_calibrated_at_each_impact(self) -> None:
        drop = told_case("paper:type1-variable")
        _, _, dashpots, damping = self.wall(drop)
        assert damping == "velocity limit_damping"
        for law, dashpot, speed in zip(
            drop.laws, dashpots, drop.impacts["approach_speed_m_s"], strict=True
        ):
            theirs = AdamsImpact(
                stiffness=law.stiffness, damping_max=dashpot, full_damping_penetration=1e-9
            )
            wanted = achieved_restitution(law, drop.mass, speed)
            assert achieved_restitution(theirs, drop.mass, speed) == pytest.approx(wanted, abs=1e-6)

    def test_function_of_the_speed(self) -> None:
        law = LinearSpringDashpot(stiffness=2e6, damping=80.0)
        drop = replace(told(law), function=("damping", SpeedFunction((50.0, 10.0), 1.0, 3.0)))
        np.testing.assert_allclose(
            self.wall(drop)[2], 50.0 + 10.0 * drop.impacts["approach_speed_m_s"]
        )

    def test_oblique(self) -> None:
        """In the frame of the plate: gravity is inclined."""
        law = MindlinForce(
            coefficient=0.3,
            effective_modulus=2.4e9,
            effective_shear_modulus=2e9,
            effective_radius=RADIUS,
        )
        oblique = Oblique(
            velocity=(1.0, -0.5), spin=(1.0, 2.0, 3.0), gravity=(3.0, 0.0), friction=law
        )
        hertz = Hertz(stiffness=4.0 / 3.0 * 2.4e9 * math.sqrt(RADIUS))
        text = text_of(lammps.FORMAT, told(hertz, oblique=oblique, gravity=4.0))
        assert "set             group all omega 1.0 2.0 3.0" in text
        assert "velocity        all set 1.0 -0.5 -0.0" in text
        assert "gravity 5.0 vector 3.0 0.0 -4.0" in text
        found = re.search(r"tangential mindlin/force (\S+) 0\.0 0\.3 zplane", text)
        assert found is not None
        assert float(found[1]) == pytest.approx(2.0 * 2e9, rel=1e-14)

    @pytest.mark.parametrize("name", ["coulomb", "rigid"])
    def test_refuses_friction_without_a_stiffness(self, name: str) -> None:
        oblique = Oblique(friction=find_friction_law(name)(coefficient=0.3))
        with pytest.raises(
            InputError,
            match=f"{name} can't be written for LAMMPS; mindlin, mindlin-rescale, mindlin-force, "
            "mdr can",
        ):
            lammps.FORMAT.write(told(TSUJI, oblique=oblique))


class TestYade:
    def test_modulus_gives_the_stiffness(self) -> None:
        text = text_of(yade.FORMAT, told(Hertz(stiffness=STIFFNESS)))
        youngs = re.search(r"young=([^,]+)", text)
        assert youngs is not None
        # a wall is taken as a sphere of the same size and material
        assert 4 / 3 * float(youngs[1]) / (2 * (1 - 0.28**2)) * math.sqrt(
            RADIUS / 2
        ) == pytest.approx(STIFFNESS)
        assert "DAMPING = [0.0]" in text

    @pytest.mark.parametrize(
        "law", [TSUJI, LinearSpringDashpot(stiffness=2e6, damping=80.0)], ids=lambda law: law.name
    )
    def test_is_python(self, law: Any) -> None:
        compile(text_of(yade.FORMAT, told(law)), "script.py", "exec")
        assert "never pulls" in " ".join(yade.FORMAT.notes(told(law)))

    def test_friction(self) -> None:
        """Poisson's ratio gives the tangential stiffness, and the modulus then that along
        the normal.
        """
        law = MindlinForce(
            coefficient=0.3,
            effective_modulus=2.4e9,
            effective_shear_modulus=2e9,
            effective_radius=RADIUS,
        )
        hertz = Hertz(stiffness=4.0 / 3.0 * 2.4e9 * math.sqrt(RADIUS))
        oblique = Oblique(
            velocity=(1.0, -0.5), spin=(1.0, 2.0, 3.0), gravity=(3.0, 0.5), friction=law
        )
        text = text_of(yade.FORMAT, told(hertz, oblique=oblique))
        compile(text, "script.py", "exec")
        found = re.search(r"young=([^,]+), poisson=([^,]+), .*frictionAngle=([^)]+)", text)
        assert found is not None
        youngs, poisson, angle = map(float, found.groups())
        assert math.tan(angle) == pytest.approx(0.3)
        root = math.sqrt(RADIUS / 2)
        assert 4 / 3 * youngs / (2 * (1 - poisson**2)) * root == pytest.approx(hertz.stiffness)
        assert 4 * youngs / (2 * (1 + poisson)) / (2 - poisson) * root == pytest.approx(
            2 * 2e9 * math.sqrt(RADIUS)
        )
        assert "PULL = (3.0, 0.5)" in text
        assert "ball.state.angVel = (1.0, -0.5, -SPEED), (1.0, 2.0, 3.0)" in text

    def test_refuses_friction_that_it_has_no_stiffness_for(self) -> None:
        moduli = {
            "effective_modulus": 2.4e9,
            "effective_shear_modulus": 2e9,
            "effective_radius": RADIUS,
        }
        for law in LinearSpringDashpot(stiffness=2e6, damping=80.0), Hertz(stiffness=1e7):
            with pytest.raises(InputError, match="mindlin-force can't be written for YADE unless"):
                yade.FORMAT.write(
                    told(law, oblique=Oblique(friction=MindlinForce(coefficient=0.3, **moduli)))
                )


class TestMujoco:
    def test_model(self) -> None:
        drop = told(TSUJI)
        root = ElementTree.fromstring(text_of(mujoco.FORMAT, drop))
        geom, joint, key = (
            root.find("default/geom"),
            root.find("worldbody/body/joint"),
            root.find("keyframe/key"),
        )
        assert geom is not None
        assert joint is not None
        assert key is not None
        stiffness, damping = (-MASS * float(value) for value in geom.attrib["solref"].split())
        speed = float(drop.impacts["approach_speed_m_s"][0])
        assert damping == pytest.approx(clipped_dashpot(stiffness, 1.0, 0.7, MASS, speed))
        assert float(joint.attrib["ref"]) == float(key.attrib["qpos"]) == 0.5
        assert "exponent 1.5" in " ".join(mujoco.FORMAT.notes(drop))

    def test_a_free_body(self) -> None:
        oblique = Oblique(velocity=(1.0, -0.5), spin=(1.0, 2.0, 3.0), gravity=(3.0, 0.0))
        root = ElementTree.fromstring(
            text_of(mujoco.FORMAT, told(TSUJI, oblique=oblique, position=(0.1, 0.2)))
        )
        option, key = root.find("option"), root.find("keyframe/key")
        assert option is not None
        assert key is not None
        assert option.attrib["gravity"] == "3.0 0.0 -9.8"
        assert key.attrib["qpos"] == "0.1 0.2 0.5 1.0 0.0 0.0 0.0"
        assert [float(part) for part in key.attrib["qvel"].split()] == [
            1.0,
            -0.5,
            0.0,
            1.0,
            2.0,
            3.0,
        ]
        assert root.find("worldbody/body/freejoint") is not None

    def test_refuses_friction(self) -> None:
        oblique = Oblique(friction=find_friction_law("coulomb")(coefficient=0.3))
        with pytest.raises(InputError, match="coulomb can't be written for MuJoCo"):
            mujoco.FORMAT.write(told(TSUJI, oblique=oblique))


class TestExudyn:
    @staticmethod
    def functions(drop: Drop) -> dict[str, Any]:
        """Return what the script defines before it needs EXUDYN."""
        text = text_of(exudyn.FORMAT, drop)
        compile(text, "script.py", "exec")
        head = text[: text.index("now = SimpleNamespace")]
        made: dict[str, Any] = {}
        exec(re.sub(r"import exudyn as exu\nfrom exudyn.*?\)\n", "", head, flags=re.DOTALL), made)
        return made

    @pytest.mark.parametrize("name", exudyn.laws_of_exudyn())
    def test_force_is_the_laws(self, name: str) -> None:
        law = contact_laws()[name].example(PAIR)
        made = self.functions(told(law))
        p = made["parameters"](0, 2.0)
        for delta in (1e-6, 3e-5, 4e-4):
            for rate in (2.0, 0.5, -0.3, -1.5):
                # those that know the way out apart
                now = law.after_compression(delta) if rate < 0.0 else law
                wanted = float(sum(now.forces(delta, rate, 2.0)))
                wanted = max(wanted, 0.0) if law.tension == "cut" else wanted
                assert made["contact_force"](delta, rate, 2.0, p) == pytest.approx(
                    wanted, rel=1e-12
                )

    def test_damping_factors_are_formulas_of_the_laws(self) -> None:
        hysteretic = {
            name: law for name, law in contact_laws().items() if issubclass(law, HystereticLaw)
        }
        assert len(hysteretic) >= 9
        assert hysteretic.keys() <= set(exudyn.laws_of_exudyn())
        for name, kind in hysteretic.items():
            law = kind.example(PAIR)
            text = text_of(exudyn.FORMAT, told(law))
            (formula,) = re.findall(r"factor = (.*)", text)
            for e in np.random.default_rng(1).uniform(0.05, 1.0, 20):
                value = eval(formula, {"math": math, "e": float(e)})
                wanted = law.changed({"restitution": float(e)}).damping_factor
                assert value == pytest.approx(float(wanted), rel=1e-15), name

    def test_a_hysteretic_law_of_another_package_is_written(self) -> None:
        law = WithOffset(stiffness=STIFFNESS, restitution=0.7, offset=0.25)
        assert "factor = p.offset + (1.0 - e) / math.sqrt(e)\n" in text_of(exudyn.FORMAT, told(law))
        made = self.functions(told(law))
        force = made["contact_force"](3e-5, 0.5, 2.0, made["parameters"](0, 2.0))
        assert force == pytest.approx(float(sum(law.forces(3e-5, 0.5, 2.0))), rel=1e-12)

    def test_refuses_a_damping_factor_in_pieces(self) -> None:
        law = InPieces(stiffness=STIFFNESS, restitution=0.7)
        with pytest.raises(InputError, match="in-pieces can't be written for EXUDYN, as its"):
            exudyn.FORMAT.write(told(law))

    def test_values_of_impacts_and_function(self) -> None:
        drop = told_case("paper:type1-variable")
        dampings = [
            self.functions(drop)["parameters"](impact, 3.0).damping_max for impact in range(7)
        ]
        assert dampings == [179.75, 172.8, 166.3, 160.9, 156.5, 156.5, 156.5]
        function = SpeedFunction((138.93525, 6.00288, -0.15582), 3.2, 8.8)
        made = self.functions(replace(drop, laws=drop.laws[:1], function=("damping_max", function)))
        assert isinstance(made["parameters"](0, 5.0), SimpleNamespace)
        assert made["parameters"](0, 5.0).damping_max == pytest.approx(function(5.0), rel=1e-14)

    def test_forces_along_the_plate(self) -> None:
        """Coulomb's, proportional to the slip where it is small; the moment turns the
        sphere forwards.
        """
        oblique = Oblique(
            velocity=(1.0, -0.5),
            spin=(1.0, 2.0, 3.0),
            gravity=(3.0, 0.5),
            friction=find_friction_law("coulomb")(coefficient=0.3),
        )
        text = text_of(exudyn.FORMAT, told(Hertz(stiffness=STIFFNESS), oblique=oblique))
        compile(text, "script.py", "exec")
        made = self.functions(told(Hertz(stiffness=STIFFNESS), oblique=oblique))
        exec(text[text.index("FRICTION, PULL") : text.index("INERTIA =")], made)
        made["now"] = SimpleNamespace(in_contact=True, approach=2.0, p=made["parameters"](0, 2.0))
        made["state"] = lambda: (-1e-4, 0.0)
        normal, weight = STIFFNESS * 1e-6, MASS * np.array([3.0, 0.5])
        x, y, about_x, about_y = made["forces_along_plate"](
            None, 0.0, 0, [0.0] * 4, [3.0, 4.0, 0.0, 0.0]
        )
        np.testing.assert_allclose(
            [x, y] - weight, [-0.6 * 0.3 * normal, -0.8 * 0.3 * normal], rtol=1e-12
        )
        np.testing.assert_allclose(
            [about_x, about_y],
            [-RADIUS * 0.8 * 0.3 * normal, RADIUS * 0.6 * 0.3 * normal],
            rtol=1e-12,
        )
        rolling = made["forces_along_plate"](
            None, 0.0, 0, [0.0] * 4, [1.0, -1.0, 1.0 / RADIUS, 1.0 / RADIUS]
        )
        np.testing.assert_allclose(rolling, [*weight, 0.0, 0.0], atol=1e-12)
        made["state"] = lambda: (1e-4, 0.0)
        assert made["forces_along_plate"](None, 0.0, 0, [0.0] * 4, [3.0, 4.0, 0.0, 0.0]) == [
            *weight,
            0.0,
            0.0,
        ]

    def test_says_that_nothing_resists_rolling(self) -> None:
        for rolling, said in ((0.0, False), (0.02, True)):
            law = find_friction_law("coulomb")(coefficient=0.3, rolling_coefficient=rolling)
            notes = exudyn.FORMAT.notes(
                told(Hertz(stiffness=STIFFNESS), oblique=Oblique(friction=law))
            )
            assert (
                "This input of EXUDYN is written without rolling resistance: "
                "contact.friction.rolling_coefficient, 0.02, is left out." in notes
            ) == said

    def test_refuses_friction_that_reverses_the_slip(self) -> None:
        with pytest.raises(InputError, match="rigid can't be written for EXUDYN; coulomb, mdr"):
            exudyn.FORMAT.write(
                told(TSUJI, oblique=Oblique(friction=find_friction_law("rigid")(coefficient=0.3)))
            )

    def test_refusal_names_the_laws(self) -> None:
        with pytest.raises(
            InputError,
            match=r"thornton can't be written for EXUDYN; adams-impact, anagnostopoulos, "
            r".*calibrate",
        ):
            exudyn.FORMAT.write(told(contact_laws()["thornton"].example(PAIR)))


def test_the_dialog_of_adams_is_the_exported_force() -> None:
    drop = told_case("paper:type1-constant")
    (row,) = adams_solver.FORMAT.dialog(drop)
    text = "".join(
        content.decode()
        for name, content in adams_solver.FORMAT.write(drop).items()
        if name.endswith(".adm")
    )
    # wrapped: a line begins with a comma
    terms = text.split("IMPACT(DZ(11, 1, 1), VZ(11, 1, 1, 1), 25.0, ")[1].split(")")[0]
    written = [term for term in terms.replace("\n", "").split(",") if term.strip()]
    assert [float(number) for number in written] == pytest.approx(list(row.values()), rel=1e-14)
    assert len(adams_solver.FORMAT.dialog(told_case("paper:type1-variable"))) == 5
    assert not adams_solver.FORMAT.dialog(told_case("paper:type1-theory"))


def _changing(law: Any, **values: Any) -> Drop:
    """Return a drop whose law has other values in its second impact."""
    return replace(told(law), laws=(law, law.changed(values)))


def test_refusals_name_the_key_of_the_case() -> None:
    """A spring that changes, or has an exponent that a program lacks, is refused at the
    key that sets it.
    """
    with pytest.raises(
        InputError, match=r"^contact\.stiffness: the spring changes from impact to impact"
    ):
        lammps.FORMAT.write(_changing(TSUJI, stiffness=2.0 * STIFFNESS))
    with pytest.raises(InputError, match=r"^contact\.exponent: 1\.4 can't be written"):
        lammps.FORMAT.write(told(AdamsImpact(stiffness=STIFFNESS, exponent=1.4, damping_max=100.0)))
    with pytest.raises(InputError, match=r"^contact: Adams' contact can change its damping"):
        adams_solver.FORMAT.write(
            _changing(
                AdamsImpact(stiffness=STIFFNESS, damping_max=100.0), stiffness=2.0 * STIFFNESS
            )
        )


def test_yade_tells_at_which_speeds_the_restitution_is_that_of_the_law() -> None:
    """With a damping for each impact it is so at each of them, not only at the first."""
    assert "at the first impact's speed, and" in " ".join(yade.FORMAT.notes(told(TSUJI)))
    assert "at the speed of each impact of this drop, and" in " ".join(
        yade.FORMAT.notes(_changing(TSUJI, restitution=0.5))
    )


def test_the_way_to_rigid_bodies_that_rebound_as_elastic_ones() -> None:
    """It names a law that can be calibrated, and is not told where no rigid body can rebound so."""
    hertz = replace(told(Hertz(stiffness=STIFFNESS)), elastic=("plate",))
    slower = replace(hertz, original_impacts={"restitution_achieved": np.array([0.5])})
    (way,) = (note for note in lammps.FORMAT.notes(slower) if "calibrate the case" in note)
    assert all(
        words in way
        for words in (
            "none of the keys of elastic bodies, no [[sensors]] and",
            "loss parameter, such as tsuji",
        )
    )
    faster = replace(hertz, original_impacts={"restitution_achieved": np.array([0.5, 1.3])})
    assert (
        "Rigid bodies can't rebound as in the run, where an impact has a restitution above 1."
        in lammps.FORMAT.notes(faster)
    )
