"""Achieved restitution of many (law, mass, speed): by closed form, and by integration. CPU time on
one core.

Asked: 100,000 of a closed-form law within 1 s, of an integrated law within 60 s.
"""

from __future__ import annotations

import os

# before NumPy is loaded: small matrices gain nothing from threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable

import numpy as np

import vibroimpact as vi
from vibroimpact.contact.pair import ContactPair

NUMBER = 100_000
RANDOM = np.random.default_rng(0)
MASS, SPEED = 10 ** RANDOM.uniform(-3, 0.5, NUMBER), 10 ** RANDOM.uniform(-1, 1.3, NUMBER)
MODULUS = 10 ** RANDOM.uniform(9, 11, NUMBER)
PAIR = ContactPair(
    MODULUS, (MASS / 6000.0) ** (1 / 3), MASS, yield_strength=3e-3 * MODULUS, poissons_ratio=0.3
)


def cpu_seconds(call: Callable[[], object], repeats: int) -> float:
    """Return the median CPU time of a call [s]."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return float(np.median(times))


def random_law(name: str) -> vi.laws.ContactLaw:
    """Return a law with random parameters, one a drop."""
    law = vi.laws.find_contact_law(name)
    given = (
        {"restitution": RANDOM.uniform(0.3, 1.0, NUMBER)}
        if "restitution" in law.__dataclass_fields__
        else {}
    )
    made = law.example(PAIR)
    if name == "adams-impact":
        given = {"damping_max": 2e3 * MASS * 10 ** RANDOM.uniform(-1, 0.5, NUMBER)}
    if name in ("kuwabara-kono", "krijt"):
        given = {"dissipation_time": 10 ** RANDOM.uniform(-7, -5, NUMBER)}
    return made.changed(given)


def main() -> None:
    """Print a row a law."""
    print(f"achieved restitution of {NUMBER:,} random drops, CPU time on one core")
    for name in vi.laws.contact_laws():
        law = random_law(name)
        if law.closed_form_restitution(MASS, SPEED) is None:
            seconds, way = (
                cpu_seconds(lambda law=law: vi.laws.achieved_restitution(law, MASS, SPEED), 1),
                "integrated",
            )
        else:
            seconds, way = (
                cpu_seconds(lambda law=law: vi.laws.achieved_restitution(law, MASS, SPEED), 3),
                "closed form",
            )
        print(f"  {name:24} {way:12} {seconds:8.3f} s   {1e6 * seconds / NUMBER:7.2f} us a drop")


if __name__ == "__main__":
    main()
