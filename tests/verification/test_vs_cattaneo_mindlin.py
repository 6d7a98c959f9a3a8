"""The contact that sticks in its middle and slips at its rim, against closed forms and
against rows of springs.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

import vibroimpact as vi
from agreement import Against, Agrees
from support import one_in
from turning_history import by_turning_points
from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.laws.mdr import MDR
from vibroimpact.dynamics.core.tangential_history import history_after, lost_in_microslip
from vibroimpact.dynamics.oblique.tangential_history import tangential_history

AGAINST = Against(
    "array of independent friction springs",
    "own independent computation",
    "oblique impact and friction",
    "4,000 springs, explicit time integration in the test",
)
SLIDING = Against(
    "gross sliding, closed form",
    "closed form",
    "oblique impact and friction",
    "friction impulse = coefficient of friction times normal impulse; Chung and Ooi 2011, "
    "Granular Matter 13, 643, test 6",
)
LOOP = Against(
    "Mindlin and Deresiewicz, hysteresis loop of microslip",
    "closed form",
    "oblique impact and friction",
    "Mindlin and Deresiewicz 1953; Johnson, Contact Mechanics, 1985, section 7.4",
)


NU, MU = 0.3, 0.3
DRIVE = 15.0 / 8.0 * 3.5 * 2.0 * (1.0 - NU) / (2.0 - NU)
"""Of an undamped impact of a solid sphere; see `by_springs`."""


def impact(
    psi: Floats,
    law: vi.laws.ContactLaw,
    *,
    mass: float = 0.02,
    radius: float = 0.01,
    spin: float = 0.0,
) -> vi.Response:
    """Return the impacts of spheres of the plate's material, by psi1 = [2 (1 - nu) / (mu
    (2 - nu))] v_t / v_n.
    """
    shear_ratio = 2.0 * (1.0 - NU) / (2.0 - NU)
    modulus = 1e9
    friction = MDR(
        coefficient=MU,
        effective_modulus=modulus,
        effective_shear_modulus=shear_ratio * modulus,
        effective_radius=radius,
    )
    speed = 2.0
    slip = psi * MU * speed / shear_ratio
    oblique = vi.Oblique(
        velocity=(slip + radius * spin, 0.0), spin=(0.0, spin, 0.0), friction=friction
    )
    ball = vi.Body(mass=mass, contact_offset=radius)
    return vi.tabulate(
        vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=speed,
            gravity=0.0,
            impacts=1,
            oblique=oblique,
        )
    )


def slip_after(response: vi.Response, radius: float = 0.01) -> Floats:
    impacts = response.impacts
    return np.asarray(
        impacts["separation_velocity_x_m_s"][:, 0] - radius * impacts["spin_y_after_rad_s"][:, 0]
    )


def slip_before(response: vi.Response, radius: float = 0.01) -> Floats:
    impacts = response.impacts
    return np.asarray(
        impacts["approach_velocity_x_m_s"][:, 0] - radius * impacts["spin_y_before_rad_s"][:, 0]
    )


HERTZ = vi.laws.find_contact_law("hertz")(stiffness=4.0 / 3.0 * 1e9 * 0.1)


def test_gross_sliding_is_exact(agrees: Agrees) -> None:
    chi = 7.0 * (1.0 - NU) / (2.0 * (2.0 - NU))
    psi = np.linspace(4.0 * chi - 1.0, 30.0, 12)
    found = impact(psi, HERTZ)
    expected = -1.0 + 14.0 * (1.0 - NU) / ((2.0 - NU) * psi)
    rebound = -slip_after(found) / slip_before(found)
    agrees(
        "gross sliding, undamped",
        "tangential coefficient of restitution at the contact point",
        rebound,
        expected,
        against=SLIDING,
        absolute=1e-7,
    )


@pytest.mark.parametrize("restitution", [1.0, 0.7, 0.3])
def test_gross_sliding_takes_the_coefficient_of_the_whole_normal_impulse(
    agrees: Agrees, restitution: float
) -> None:
    """Chung and Ooi's test 6 in closed form: kappa = 7/2 mu (1 + e) v_n / v_s, where it
    is below 1.
    """
    law = vi.laws.find_contact_law("flores")(stiffness=1e8, restitution=restitution)
    found = impact(np.array([15.0, 30.0]), law)
    achieved = found.impacts["restitution_achieved"][:, 0]
    kappa = (
        3.5 * MU * (1.0 + achieved) * found.impacts["approach_speed_m_s"][:, 0] / slip_before(found)
    )
    rebound = -slip_after(found) / slip_before(found)
    agrees(
        "gross sliding, normal coefficients of restitution 1, 0.7 and 0.3",
        "tangential coefficient of restitution at the contact point",
        rebound,
        kappa - 1.0,
        against=SLIDING,
        relative=1e-6,
    )


def test_friction_without_bound_sticks(agrees: Agrees) -> None:
    """With a coefficient that no slip reaches, springs that part take their energy with
    them: a row of springs without limits tells it.
    """
    shear, slip = 2.0 * (1.0 - NU) / (2.0 - NU) * 1e9, 0.4
    friction = MDR(
        coefficient=1e5, effective_modulus=1e9, effective_shear_modulus=shear, effective_radius=0.01
    )
    oblique = vi.Oblique(velocity=(slip, 0.0), friction=friction)
    ball = vi.Body(mass=0.02, contact_offset=0.01)
    problem = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(HERTZ,),
        speed=np.array([2.0]),
        gravity=0.0,
        impacts=1,
        oblique=oblique,
    )
    expected = by_springs(1.0, DRIVE, bound=1e9)[0]
    agrees(
        "contact without sliding (unbounded friction)",
        "ratio of contact-point velocity after to before impact",
        slip_after(vi.tabulate(problem)) / slip,
        expected,
        absolute=1e-4,
    )


def springs(depth: Floats, displacement: Floats, number: int) -> Floats:
    """Return the integral of the displacements of a row of springs along a history of
    straight steps (T,).
    """
    x = (np.arange(number) + 0.5) / number * np.sqrt(depth.max())
    u, found = np.zeros(number), [0.0]
    for step in range(1, len(depth)):
        parts = 400
        for part in range(1, parts + 1):
            deep = depth[step - 1] + (depth[step] - depth[step - 1]) * part / parts
            before = depth[step - 1] + (depth[step] - depth[step - 1]) * (part - 1) / parts
            moved = (displacement[step] - displacement[step - 1]) / parts
            entering = (
                np.clip((deep - x**2) / max(deep - before, 1e-300), 0.0, 1.0)
                if deep > before
                else (x**2 < deep).astype(float)
            )
            u = np.where(x**2 < deep, u + np.where(x**2 < before, 1.0, entering) * moved, 0.0)
            limit = np.maximum(deep - x**2, 0.0)
            u = np.clip(u, -limit, limit)
        found.append(float(u.sum()) * x[0] * 2.0)
    return np.array(found)


@pytest.mark.parametrize("seed", range(6))
def test_turning_points_are_a_row_of_springs(agrees: Agrees, seed: int) -> None:
    """Any history of straight steps, with reversals, partial unloading and sliding: the
    stack of corners is exact.
    """
    random = np.random.default_rng(seed)
    depth, displacement = (
        np.abs(np.cumsum(random.normal(0.4, 0.5, 14))),
        np.cumsum(random.normal(0.0, 0.35, 14)),
    )
    depth[0], displacement[0] = 0.0, 0.0
    found = by_turning_points(depth, displacement)
    expected = springs(depth, displacement, 4000)
    agrees(
        "random piecewise linear displacement histories",
        "integral of the tangential displacements",
        found,
        expected,
        of_the_largest=2e-3,
    )


def by_springs(
    psi: float, drive: float, bound: float = 1.0, number: int = 4000, steps: int = 6000
) -> tuple[float, float, float]:
    """Return the slip after over before of an undamped impact, with springs and small steps of
    time.

    In units of the greatest depth and the approach speed, with displacements over kappa: s'' =
    -drive int u dx. Then what springs took as they slipped, while some of them stuck and while all
    slipped, over the energy of the slip before.
    """
    time = np.linspace(0.0, 1.0, 20001)
    depth = np.sin(0.5 * np.pi * time) ** 2
    angle = 0.5 * np.pi * time
    rate = np.full_like(angle, np.sqrt(0.8))
    inside = angle < 0.5 * np.pi
    rate[inside] = (
        2.0
        * np.sin(angle[inside])
        * np.cos(angle[inside])
        / np.sqrt(1.0 - np.sin(angle[inside]) ** 5)
    )
    rate[-1] = 2.0 / np.sqrt(2.5)
    way_in = np.concatenate([[0.0], cumulative_trapezoid(rate, angle)])
    moments = np.linspace(0.0, 2.0 * way_in[-1], steps + 1)
    deep = np.interp(np.minimum(moments, 2.0 * way_in[-1] - moments), way_in, depth)
    x = (np.arange(number) + 0.5) / number
    u, velocity, acceleration, limit, lost = (
        np.zeros(number),
        psi,
        0.0,
        np.zeros(number),
        [0.0, 0.0],
    )
    for step in range(steps):
        length = moments[step + 1] - moments[step]
        moved = length * velocity + 0.5 * length**2 * acceleration
        before, now = deep[step], deep[step + 1]
        part = np.where(
            x**2 < before, 1.0, np.clip((now - x**2) / max(now - before, 1e-300), 0.0, 1.0)
        )
        stuck, limit_before = u + part * moved, limit
        limit = bound * np.maximum(now - x**2, 0.0)
        u = np.clip(stuck, -limit, limit)
        slipped = np.abs(stuck - u)
        lost[bool(slipped[x**2 < now].all())] += drive * float(
            (0.5 * (limit_before + limit) * slipped).mean()
        )
        later = -drive * float(u.mean())
        velocity += 0.5 * length * (acceleration + later)
        acceleration = later
    return velocity / psi, lost[0] / (0.5 * psi**2), lost[1] / (0.5 * psi**2)


@pytest.mark.parametrize("psi", [0.2, 0.5, 0.7, 0.99, 1.4, 2.3, 3.0, 3.6, 5.0])
def test_impacts_against_four_thousand_springs(agrees: Agrees, psi: float) -> None:
    """The velocity after is within 1e-4 of that of the springs."""
    found = impact(np.array([psi]), HERTZ)
    after = slip_after(found) / slip_before(found)
    agrees(
        "oblique impacts of similar materials, dimensionless angle of incidence ψ1 = 0.2 to 5",
        "ratio of contact-point velocity after to before impact",
        after,
        by_springs(psi, DRIVE)[0],
        absolute=1e-4,
    )


@pytest.mark.parametrize("psi", one_in(5, [0.7, 0.2, 1.4, 2.3, 3.6]))
def test_losses_in_microslip_and_in_gross_slip_against_springs(agrees: Agrees, psi: float) -> None:
    """Each is within 1e-4 of the energy of the slip of what springs take one by one,
    while some of them stick and while all slip.
    """
    found = impact(np.array([psi]), HERTZ)
    before = 0.5 * (2.0 / 7.0 * 0.02) * slip_before(found)[0] ** 2
    _, microslip, gross = by_springs(psi, DRIVE, number=1000, steps=24000)
    case = "oblique impacts, dimensionless angle of incidence ψ1 = 0.2 to 3.6"
    agrees(
        case,
        "energy dissipated by microslip, normalized by the tangential energy before impact",
        found.impacts["microslip_lost_J"][0, 0] / before,
        microslip,
        absolute=1e-4,
    )
    agrees(
        case,
        "energy dissipated by gross slip, normalized by the tangential energy before impact",
        found.impacts["gross_slip_lost_J"][0, 0] / before,
        gross,
        absolute=1e-4,
    )


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_cycle_of_tangential_force_is_lost_in_microslip(agrees: Agrees, share: float) -> None:
    """The loop at a constant normal force, below that of sliding (Mindlin and Deresiewicz
    1953; Johnson 1985, section 7.4).
    """
    force, modulus, shear, radius = 300.0, 1e9, 0.8e9, 0.01
    law = MDR(
        coefficient=MU,
        effective_modulus=modulus,
        effective_shear_modulus=shear,
        effective_radius=radius,
    )
    contact = np.cbrt(0.75 * force * radius / modulus)
    way = MU * modulus / shear * contact**2 / radius * (1.0 - (1.0 - share) ** (2.0 / 3.0))
    moved = np.stack(
        [way * np.diff(np.sin(np.linspace(0.0, 2.5 * np.pi, 1001))), np.zeros(1000)], axis=1
    )
    history = history_after(tangential_history(law, force), force, 0.0, 0.0)
    frictions, slid = [history.force], [history.slid]
    for step in moved:
        history = history_after(history, force, *step)
        frictions.append(history.force)
        slid.append(history.slid)
    assert np.max(frictions) == pytest.approx(share * MU * force, rel=1e-3)
    assert not np.any(slid)
    first = 200  # the first turning point, from which the loop is closed
    lost = lost_in_microslip(
        history,
        np.full(801, force),
        np.array(frictions)[first:],
        moved[first:],
        np.array(slid)[first:],
    )
    rest = 1.0 - share
    loop = 1.0 - rest ** (5.0 / 3.0) - 5.0 / 6.0 * share * (1.0 + rest ** (2.0 / 3.0))
    exact = 3.6 * (MU * force) ** 2 / (shear * contact) * loop
    agrees(
        "cyclic tangential force at constant normal force",
        "energy dissipated by microslip",
        lost,
        exact,
        unit="J",
        against=LOOP,
        relative=2e-3,
    )
