"""The signals of sensors as CSV: one file each, where they are small enough to be of use so."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from vibroimpact.dynamics.recording import Signal
from vibroimpact.exchange.drop_tables import signal_csv
from vibroimpact.exchange.plain_names import plain_names

MOST_SAMPLES = 250_000
"""Of a signal that is written; a longer one is in `result.nc` alone."""


def write_signal_files(signals: Mapping[str, Signal], directory: Path) -> None:
    """Write `NAME.csv` for each signal that is not too long, with its unit in the header; no folder if there is none."""
    for name, plain in plain_names(list(signals)).items():
        signal = signals[name]
        if len(signal.value) > MOST_SAMPLES:
            continue
        directory.mkdir(exist_ok=True)
        (directory / f"{plain}.csv").write_text(signal_csv(signal), encoding="utf-8", newline="\n")
