"""Against Craig and Bampton's reduction of a chain whose modes are known (AIAA J. 6:1313, 1968).

60 unit masses and springs, fixed at one end, have omega_j = 2 sin((2 j - 1) pi / 242); the
interface is masses 29 and 59.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array

from agreement import Against, Agrees
from vibroimpact.structures.reduction import craig_bampton, projected

AGAINST = Against(
    "Craig and Bampton, reduction of a chain of 60 masses",
    "closed form",
    "plates, spheres and modes",
    "Craig and Bampton 1968, AIAA J. 6, 1313; natural frequencies of the chain in closed form",
)


INTERFACE = [29, 59]


def chain(fixed: bool) -> tuple[csr_array, csr_array]:
    stiffness = 2.0 * np.eye(60) - np.eye(60, k=1) - np.eye(60, k=-1)
    stiffness[59, 59] = 1.0
    stiffness[0, 0] = 2.0 if fixed else 1.0
    return csr_array(stiffness), csr_array(np.eye(60))


EXACT = 2 * np.sin((2 * np.arange(1, 61) - 1) * np.pi / 242)


@pytest.mark.parametrize(
    ("number", "error"),
    [(0, 2.492e-2), (2, 5.513e-4), (4, 3.233e-4), (8, 5.079e-5), (16, 6.118e-6)],
)
def test_first_mode(agrees: Agrees, number: int, error: float) -> None:
    modes = projected(*chain(True), craig_bampton(*chain(True), INTERFACE, number))
    assert len(modes.angular_frequencies) == number + 2
    found = modes.angular_frequencies[0] / EXACT[0] - 1
    half_a_digit = 0.5e-3 * 10.0 ** np.floor(np.log10(error))
    agrees(
        f"{number} fixed-interface modes",
        "relative error of the first natural frequency",
        found,
        error,
        absolute=half_a_digit,
    )


def test_with_every_mode_it_is_exact(agrees: Agrees) -> None:
    modes = projected(*chain(True), craig_bampton(*chain(True), INTERFACE, 58))
    agrees(
        "all 58 fixed-interface modes",
        "natural angular frequencies",
        modes.angular_frequencies,
        EXACT,
        unit="rad/s",
        relative=1e-12,
    )
    # rounding, and not the same on every machine
    assert abs(modes.angular_frequencies[0] / EXACT[0] - 1) < 1e-12


@pytest.mark.parametrize("number", [0, 2, 8, 16])
def test_static_response_to_interface_loads(agrees: Agrees, number: int) -> None:
    stiffness, mass = chain(True)
    modes = projected(stiffness, mass, craig_bampton(stiffness, mass, INTERFACE, number))
    loads = np.zeros((60, 2))
    loads[INTERFACE, [0, 1]] = 1.0
    response = modes.shapes @ ((modes.shapes.T @ loads) / modes.angular_frequencies[:, None] ** 2)
    agrees(
        "static response, 0 to 16 fixed-interface modes",
        "displacements under interface loads",
        response,
        np.linalg.solve(stiffness.toarray(), loads),
        relative=1e-9,
    )


@pytest.mark.parametrize("number", [0, 3, 10])
def test_a_free_chain_has_one_zero_mode(number: int) -> None:
    stiffness, mass = chain(False)
    modes = projected(stiffness, mass, craig_bampton(stiffness, mass, INTERFACE, number))
    assert (modes.angular_frequencies < 1e-6).sum() == 1
    ratio = modes.angular_frequencies[1] / (2 * np.sin(np.pi / 120))
    assert 1 < ratio < {0: 1.4, 3: 1.003, 10: 1.0003}[number]  # a subspace makes no frequency lower
    np.testing.assert_allclose(modes.shapes[:, 0], modes.shapes[0, 0], rtol=1e-6)
