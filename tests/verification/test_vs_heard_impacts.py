"""Restitution from the sound of bounces against the impacts that were simulated, through
a WAV file.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from support import plain_case

AGAINST = Against(
    "simulated bounces, identified from a WAV file",
    "consistency",
    "calibration, identification and studies",
    "coefficients of restitution and impact times of the recorded "
    "simulation; no external reference",
)


RATE = 48e3


@pytest.mark.slow
@pytest.mark.parametrize(("restitution", "impacts"), [(0.3, 6), (0.5, 7), (0.7, 9), (0.9, 11)])
def test_restitutions_of_a_simulated_record(
    agrees: Agrees, restitution: float, impacts: int, tmp_path: Path
) -> None:
    """A steel ball on a clamped steel plate that rings: with 20 dB of noise too."""
    case = vi.case_of(
        plain_case(
            sphere={"radius": "5 mm", "material": "steel"},
            plate={
                "size": ["300 mm", "200 mm", "20 mm"],
                "material": "steel",
                "model": "elastic",
                "supports": "clamped",
                "modes": 12,
                "damping": 0.02,
            },
            drop={"height": 0.3},
            contact={"law": "lankarani-nikravesh", "restitution": restitution},
            run={"impacts": impacts},
            sensors=[{"name": "plate", "position": [0.05, 0.03], "rate": RATE}],
        )
    )
    response = vi.simulate(case)
    folder = response.save(tmp_path / "drop")
    (file,) = vi.exporting.export_result(folder, "wav", tmp_path / "sound")
    record = vi.signals.one_record(file)
    assert (record.rate, record.unit) == (RATE, "m/s2")
    true = response.impacts["restitution_achieved"]
    for noise in (0.0, 0.1):
        value = record.value + noise * np.sqrt(np.mean(record.value**2)) * np.random.default_rng(
            impacts
        ).standard_normal(len(record.value))
        found = vi.calibration.rebounds_of(
            vi.signals.find_bounces(vi.signals.Record("plate", value, RATE, record.unit)),
            height=0.295,
        )
        number = len(found.restitution)
        assert number >= 4
        case = (
            "coefficients of restitution 0.3 to 0.9, "
            f"{'signal-to-noise ratio 20 dB' if noise else 'no noise'}"
        )
        agrees(
            case,
            "time of impact",
            found.bounces.time,
            response.impacts["time_s"][:number],
            unit="s",
            absolute=5e-4,
        )
        # what the contact lasts is added to a flight
        last = response.impacts["duration_s"][: number - 1]
        longer = (1.0 - true[: number - 1]) * last / np.append(0.5, found.bounces.flight[:-1])
        longer[0] = 0.5 * 9.80665 * last[0] / response.impacts["approach_speed_m_s"][0]
        errors = np.abs(found.restitution - true[:number])[:-1]
        assert np.all(errors <= 1.5 * longer + 3.0 * found.deviation[:-1])
        within = 2e-4 if noise == 0.0 else 0.01
        agrees(
            case,
            "coefficient of restitution",
            found.restitution[:-1],
            true[: number - 1],
            absolute=within,
        )
        speeds = response.impacts["approach_speed_m_s"][: number - 1]
        agrees(case, "approach speed", found.approach_speed[:-1], speeds, unit="m/s", relative=2e-3)
