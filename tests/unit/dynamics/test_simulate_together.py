"""Several drops, of which each is what it is alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

import vibroimpact as vi
from vibrating import drop_on
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.simulate import simulate_together
from vibroimpact.structures.modal_model import ModalBasis

HUNT, ADAMS = (
    HuntCrossley(stiffness=1e9, restitution=0.7),
    AdamsImpact(stiffness=2e9, damping_max=100.0, full_damping_penetration=1e-4),
)


def plate_of(modes: int, seed: int) -> ModalBasis:
    random = np.random.default_rng(seed)
    return ModalBasis(
        np.sort(random.uniform(50.0, 2e4, modes)),
        np.full(modes, 0.01),
        random.normal(size=modes),
        np.zeros((modes, 3)),
    )


def test_digits_do_not_depend_on_the_others() -> None:
    drops = [(HUNT, 8, 1.0, 0.0), (HUNT, 8, 2.0, 1e-10), (ADAMS, 8, 1.5, 0.0)]
    drops += [(HUNT, 5, 1.0, 0.0), (HUNT, 8, 3.0, -1e-10), (ADAMS, 8, 0.7, 0.0)]
    problems = [
        replace(
            drop_on(law, plate_of(modes, seed), speed=speed),
            impacts=2,
            quasi_static=QuasiStatic(linear=linear),
        )
        for seed, (law, modes, speed, linear) in enumerate(drops)
    ]
    for one, together in zip(map(vi.simulate, problems), simulate_together(problems), strict=True):
        assert isinstance(together, vi.Response)
        for column, values in one.impacts.items():
            np.testing.assert_array_equal(together.impacts[column], values, err_msg=column)


def test_one_that_fails_leaves_the_others_alone() -> None:
    good = replace(drop_on(HUNT, plate_of(4, 1)), impacts=1)
    found = simulate_together([good, object(), good])  # type: ignore[list-item]
    assert isinstance(found[1], vi.InputError)
    for response in (found[0], found[2]):
        assert isinstance(response, vi.Response)
        np.testing.assert_array_equal(
            response.impacts["max_force_N"], vi.simulate(good).impacts["max_force_N"]
        )


@pytest.mark.filterwarnings("ignore::vibroimpact.errors.SlowLawWarning")
def test_what_a_law_raises_ends_its_drop_alone() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Fragile(HuntCrossley):
        def forces(self, delta, delta_dot, approach_speed):  # type: ignore[no-untyped-def]
            if np.any(np.asarray(approach_speed) > 2.0):
                raise ZeroDivisionError("too fast for me")
            return super().forces(delta, delta_dot, approach_speed)

    law = Fragile(stiffness=1e9, restitution=0.7)
    found = simulate_together(
        [replace(drop_on(law, plate_of(4, 1), speed=speed), impacts=1) for speed in (1.0, 3.0, 1.5)]
    )
    assert isinstance(found[1], ZeroDivisionError)
    assert isinstance(found[0], vi.Response)
    assert isinstance(found[2], vi.Response)
