"""A plate that nothing holds, without gravity: its rigid motions are modes of frequency zero."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from random_systems import HERTZ
from vibrating import drop_on
from vibroimpact.cli import main
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.structures.recipe import PlateOfPlates, Recipe, Reduction, modal_model_of
from vibroimpact.structures.static_compliance import static_compliance

CASE = {
    "name": "a ball against a free plate",
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {
        "size": [0.2, 0.15, 0.008],
        "material": "steel",
        "model": "elastic",
        "modes": 12,
        "supports": "free",
        "damping": 0.01,
    },
    "drop": {"speed": "2 m/s", "gravity": 0, "position": [0.03, 0.02]},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.8},
    "run": {"duration": "2 ms", "impacts": 3},
    "sensors": [
        {
            "name": "under it",
            "position": [0.03, 0.02],
            "rate": 2e5,
            "quantity": "displacement",
            "filter": "none",
        }
    ],
}


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(vi.case_of(CASE))


def rigid_motions(mass: float, lever: float = 0.0, inertia: float = 1.0) -> ModalBasis:
    """Heave and one rotation of a plate that is hit at a lever [m]."""
    contact = np.array([mass**-0.5, lever * inertia**-0.5])
    return ModalBasis(
        np.zeros(2),
        np.zeros(2),
        contact,
        np.array([[0.0, 0.0, mass**0.5], [0.0, 0.0, 0.0]]),
        mass=mass,
    )


def test_momentum_and_energy_are_kept(response: vi.Response) -> None:
    history, mass = response.history(), float(response.problem.sphere.mass)
    plate = response.problem.plate.rigid
    assert plate is not None
    assert plate.mass == pytest.approx(7850.0 * 0.2 * 0.15 * 0.008, rel=1e-9)
    momentum = mass * history["velocity_m_s"] + plate.mass * history["plate_velocity_m_s"]
    np.testing.assert_allclose(momentum, -2.0 * mass, rtol=1e-9)
    assert response.energy["closure_relative"] < 1e-9
    assert (
        response.impacts["restitution_achieved"][0]
        == response.impacts["separation_speed_m_s"][0] / 2.0
    )


def test_it_is_the_system_of_both_bodies(response: vi.Response) -> None:
    """The same modes, and the rigid motions from mass and inertia instead of the mesh."""
    problem, (x, y) = response.problem, CASE["drop"]["position"]
    basis = problem.plate.modes
    assert basis is not None
    mass = 7850.0 * 0.2 * 0.15 * 0.008
    inertia = mass / 12.0 * np.array([0.15**2 + 0.008**2, 0.2**2 + 0.008**2, 0.2**2 + 0.15**2])
    modes = replace(basis, points={"at": np.outer(basis.contact, [0.0, 0.0, 1.0])})
    bodies = {
        "ball": vi.MovingBody(mass=float(problem.sphere.mass), velocity=(0.0, 0.0, -2.0)),
        "plate": vi.MovingBody(mass=mass, inertia=inertia, modes=modes),
    }
    law = problem.laws[0]
    contact = vi.PointContact(
        above="ball", below="plate", law=law, point=(x, y, 0.004), series=problem.quasi_static
    )
    found = vi.simulate_system(vi.System(bodies=bodies, contacts={"at": contact}), duration=2e-3)
    assert found.impacts["max_force_N"][0] == pytest.approx(
        response.impacts["max_force_N"][0], rel=1e-8
    )
    times = np.linspace(0.0, 2e-3, 101)
    moved, history = found.at(times), response.at(times)
    np.testing.assert_allclose(moved["ball"].velocity[:, 2], history["velocity_m_s"], atol=1e-8)
    np.testing.assert_allclose(
        moved["plate"].velocity[:, 2], history["plate_velocity_m_s"], atol=1e-8
    )


def test_a_sensor_moves_with_it(response: vi.Response) -> None:
    signal = response.signals()["under it"]
    history = response.at(signal.time)
    apart = history["force_N"] == 0.0
    assert apart.sum() > 100
    np.testing.assert_allclose(
        signal.value[apart], history["plate_deflection_m"][apart], atol=1e-12
    )
    assert signal.value[-1] < -1e-4  # it flies off


@pytest.mark.parametrize(("lever", "inertia"), [(0.0, 1.0), (0.1, 3e-3)])
def test_a_rigid_one_is_the_reduced_mass(lever: float, inertia: float) -> None:
    """Of ball and plate, of which the latter is 1 / (1/M + x^2/I) at a lever x."""
    problem = drop_on(HERTZ, gravity=0.0)
    mass, moving = float(problem.sphere.mass), 1.0 / (1.0 / 0.5 + lever**2 / inertia)
    plate = vi.Body(mass=np.inf, contact_offset=0.0, rigid=rigid_motions(0.5, lever, inertia))
    row = vi.simulate(replace(problem, plate=plate)).impacts
    reduced = vi.simulate(
        replace(problem, sphere=vi.Body(mass=mass * moving / (mass + moving), contact_offset=0.025))
    ).impacts
    for name in ("max_force_N", "max_indentation_m", "duration_s", "separation_speed_m_s"):
        assert row[name] == pytest.approx(reduced[name], rel=1e-10)
    assert row["restitution_achieved"] == pytest.approx([1.0], rel=1e-10)


@pytest.mark.slow
def test_its_static_compliance_is_that_of_its_modes() -> None:
    """By the thin theory, where a point has a finite one: under the force and the inertia
    that balances it.
    """
    recipe = Recipe(
        PlateOfPlates((0.2, 0.15, 0.004), 0.02, theory="thin"),
        7850.0,
        210e9,
        0.3,
        (),
        Reduction(modes=160),
    )
    model, place = modal_model_of(recipe), (0.03, 0.02)
    shapes = model.at(np.array([place]))[0][:, 0, 2]
    carried = np.cumsum((shapes / model.angular_frequencies) ** 2)
    whole = static_compliance(recipe, place)
    assert carried[-1] < whole
    assert whole == pytest.approx(carried[-1], rel=0.02)
    assert whole - carried[-1] < 0.5 * (whole - carried[len(carried) // 2])


def test_under_gravity_it_would_fall(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`check` and `run` say so before any mode is computed, `modes` computes them."""
    with pytest.raises(
        vi.InputError,
        match=r"falls away from under the sphere.*with drop.gravity = 0 and drop.speed",
    ):
        vi.simulate(vi.case_of({**CASE, "drop": {"height": "1 m"}}))
    case = tmp_path / "free.toml"
    case.write_text(
        '[sphere]\nradius = "10 mm"\nmaterial = "steel"\n[plate]\nsize = [0.2, 0.15, '
        '0.008]\nmaterial = "steel"\nmodel = "elastic"\n'
        'modes = 2\nsupports = "free"\nmesh = { element_size = 0.08 }\n[drop]\nheight = '
        '1.0\n[contact]\nlaw = "hertz"\n'
    )
    monkeypatch.setattr("sys.argv", ["vibroimpact", "check", str(case)])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    assert "plate.supports: the supports let the plate fall or tilt" in capsys.readouterr().err
    with pytest.raises(
        vi.InputError,
        match=r"the supports let the plate fall or tilt: under gravity it falls away .*; set "
        r"gravity to 0, and give speed",
    ):
        replace(
            drop_on(HERTZ), plate=vi.Body(mass=np.inf, contact_offset=0.0, rigid=rigid_motions(1.0))
        )
