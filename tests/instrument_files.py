"""Tables as twelve instruments and programs write them, of one record: the bounces of a
ball, seen by an accelerometer or a camera.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

RATE = 20e3
RESTITUTION = 0.8
BOUNCES = 4
GRAVITY = 9.80665
FIRST = 0.05
"""Time of the first touch [s]."""
SPEED = 1.0
"""Speed of the first touch [m/s]."""
RADIUS = 0.01

_TOUCHES = FIRST + np.cumsum([0.0, *(2.0 * SPEED * RESTITUTION ** np.arange(1, BOUNCES) / GRAVITY)])
TIME = np.arange(int(0.55 * RATE)) / RATE


def ringing(time: np.ndarray = TIME, sharp: float = 1.0) -> np.ndarray:
    """Return what a sensor on the plate shows: decaying oscillations from each touch on,
    with noise; of a phone a hundredth as fast.
    """
    found = np.zeros_like(time)
    for number, touch in enumerate(_TOUCHES):
        since = np.maximum(time - touch, 0.0)
        found += (
            50.0
            * RESTITUTION**number
            * np.exp(-since / (4e-3 / sharp))
            * np.sin(2.0 * np.pi * 2000.0 * sharp * since)
        )
    return found + 0.02 * np.random.default_rng(4).standard_normal(len(time))


def height(time: np.ndarray) -> np.ndarray:
    """Return the height of the ball's centre, which rests at the end of what is simulated."""
    found = RADIUS + np.maximum(SPEED * (FIRST - time) - 0.5 * GRAVITY * (FIRST - time) ** 2, 0.0)
    for number, touch in enumerate(_TOUCHES):
        since, up = time - touch, SPEED * RESTITUTION ** (number + 1)
        found = np.where(
            since >= 0.0, RADIUS + np.maximum(up * since - 0.5 * GRAVITY * since**2, 0.0), found
        )
    return found


class Instrument(NamedTuple):
    """A file: its name, bytes, `--columns` if the file does not tell what its columns
    are, and the channel with the ringing.
    """

    name: str
    data: bytes
    channel: str
    factor: float = 1.0
    columns: str | None = None


def _rows(
    columns: list[np.ndarray], mark: str = ",", digits: int = 7, end: str = "", newline: str = "\n"
) -> str:
    return "".join(
        mark.join(f"{value:.{digits}g}" for value in row) + end + newline
        for row in zip(*columns, strict=True)
    )


def labview() -> Instrument:
    """Return what LabVIEW's Write To Measurement File writes, with one column of times,
    of six decimals, for the first channel.
    """
    slow = ["" if at >= 5 else f"{at:.6f}" for at in range(len(TIME))]
    head = (
        "LabVIEW "
        "Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tNo\n"
        "X_Columns\tOne\nTime_Pref\tAbsolute\nOperator\tlab\nDate\t2026/05/05\nTime\t13:39:50.8870199312495426037\n***End_of_Header***\t\n\t\n"
        f"Channels\t2\t\t\nSamples\t{len(TIME)}\t5\t\nDate\t2026/05/05\t2026/05/05\t\nTime\t13:39:50.887\t13:39:50.887\t\n"
        "Y_Unit_Label\tVolts\t\t\nX_Dimension\tTime\tTime\t\nX0\t0.0000000000000000E+0\t0.0000000000000000E+0\t\n"
        f"Delta_X\t{1 / RATE:.6E}\t1.000000\t\n***End_of_Header***\t\t\t\nX_Value\tPlate\tUntitled\tComment\n"
    )
    rows = "".join(
        f"{t:.6f}\t{v:.6f}\t{one}\n" for t, v, one in zip(TIME, ringing(), slow, strict=True)
    )
    return Instrument("labview.lvm", (head + rows).replace("\n", "\r\n").encode(), "plate")


def picoscope() -> Instrument:
    """Return PicoScope's export: units in a row of their own, and a line without anything."""
    rows = _rows([1e3 * TIME, ringing()])
    return Instrument(
        "picoscope.csv", f"Time,Channel A\r\n(ms),(V)\r\n\r\n{rows}".encode(), "channel_a"
    )


def tektronix() -> Instrument:
    """Return what a Tektronix oscilloscope writes: the units stand in lines above the header."""
    head = (
        "Model,MDO4014B-3\nFirmware Version,3.22\n\nWaveform Type,ANALOG\nPoint "
        "Format,Y\nHorizontal Units,s\nHorizontal Scale,4e-05\n"
        f"Horizontal Delay,0\nSample Interval,{1 / RATE:g}\nRecord "
        f"Length,{len(TIME)}\nGating,0.0% to 100.0%\nProbe Attenuation,10\n"
        "Vertical Units,V\nVertical Offset,0\nVertical Scale,0.5\nVertical "
        "Position,-3.76\n,\n,\n,\nLabel,\nTIME,CH2\n"
    )
    return Instrument("tektronix.csv", (head + _rows([TIME - 0.1, ringing()])).encode(), "ch2")


def rigol() -> Instrument:
    """Return what a Rigol oscilloscope writes: numbers of samples, and the step in the
    second line.
    """
    rows = "".join(f"{number},{value:.6e},,\n" for number, value in enumerate(ringing()))
    return Instrument(
        "rigol.csv",
        f"X,CH1,Start,Increment,\nSequence,VOLT,-1.000000e-01,{1 / RATE:.6e}\n{rows}".encode(),
        "ch1",
    )


def keysight() -> Instrument:
    """Return what a Keysight oscilloscope writes: names of units in the second line."""
    rows = "".join(
        f"{t:+.10E},{v:+.5E},{0.01 * v:+.5E}\n" for t, v in zip(TIME - 0.1, ringing(), strict=True)
    )
    return Instrument("keysight.csv", f"x-axis,1,2\nsecond,Volt,Ampere\n{rows}".encode(), "1")


def phyphox() -> Instrument:
    """Return the accelerometer of a phone, 400 times a second at times that jitter; the
    plate rings as slowly as it can follow.
    """
    random = np.random.default_rng(7)
    time = np.arange(220) / 400.0 + 1e-4 * random.standard_normal(220)
    value = ringing(time, 0.02)
    rows = "".join(
        f"{t:.9E},{0.1 * v:.9E},{9.81 + v:.9E},{abs(v):.9E}\n"
        for t, v in zip(time, value, strict=True)
    )
    header = (
        '"Time (s)","Linear Acceleration x (m/s^2)","Linear Acceleration z (m/s^2)","Absolute '
        'acceleration (m/s^2)"\n'
    )
    return Instrument("phyphox.csv", (header + rows).encode(), "absolute_acceleration")


def tracker() -> Instrument:
    """Return two point masses on a video of 240 frames a second; it states no units, and
    the ball was lost in two frames.
    """
    time = np.arange(132) / 240.0
    text = ",mass_A,,mass_B,\nt,x,y,x,y\n"
    for at, (t, y) in enumerate(zip(time, height(time), strict=True)):
        text += f"{t:.6E},{0.1 + 0.02 * t:.6E},{'' if at in (40, 41) else f'{y:.6E}'},{0.3:.6E},{0.01:.6E}\n"
    return Instrument("tracker.txt", text.encode(), "position", columns="time=s,-,position=m,-,-")


def numpy_savetxt() -> Instrument:
    """Return what numpy.savetxt writes: numbers and nothing else."""
    text = io.StringIO()
    np.savetxt(text, np.stack([TIME, ringing()], axis=1))
    return Instrument("savetxt.txt", text.getvalue().encode(), "plate", 1.0, "time=s,plate=V")


def matlab() -> Instrument:
    """Return a table of MATLAB, which makes names of variables of "time [s]" and "plate
    [m/s^2]".
    """
    return Instrument(
        "writetable.csv",
        ("time_s_,plate_m_s_2_\n" + _rows([TIME, ringing()], digits=15)).encode(),
        "plate",
    )


def german_excel() -> Instrument:
    """Return a table of a German spreadsheet: decimal commas, points between thousands,
    semicolons, and its old encoding.
    """
    numbers = (f"{t:.5f};{1000.0 * v:,.3f}" for t, v in zip(TIME, ringing(), strict=True))
    rows = "\n".join(numbers).translate(str.maketrans(",.", ".,"))
    text = f"Messung an der Platte;\nPrüfer: Müller;\n\nZeit [s];Beschleunigung [mm/s²]\n{rows}\n"
    return Instrument("excel.csv", text.replace("\n", "\r\n").encode("cp1252"), "beschleunigung")


def audacity() -> Instrument:
    """Return Audacity's export of sample data: samples without names or times below lines
    that state the rate.
    """
    head = (
        f"bounces.txt   1 channel (mono)\nSample Rate: {RATE:.0f} Hz. Sample values on "
        "linear scale.\n"
        f"Length processed: {len(TIME)} samples {len(TIME) / RATE:.5f} seconds.\n"
    )
    return Instrument(
        "audacity.txt",
        (head + "".join(f"{v / 64.0:.5f}\n" for v in ringing())).encode(),
        "sound",
        1.0 / 64.0,
    )


def catman() -> Instrument:
    """Return HBM catman's ASCII export with information on the channels, in German; all
    lines end in a tab.
    """
    names = ["Zeit  1 - Standardmessrate", "Platte", "Kraftaufnehmer 1"]
    of_channels = ["T0 = 24.05.2026 13:00:00", "SR = 20000 Hz", "SR = 20000 Hz"]
    lines = [
        names,
        ["s", "m/s²", "kN"],
        ["MX440A", "MX840B", "MX840B"],
        ["0", "0", "0"],
        of_channels,
    ]
    head = "HBM Data Export\n3 Kanäle\n" + "".join("\t".join(line) + "\t\n" for line in lines)
    rows = "".join(
        f"{t:.5f}\t{v:.6f}\t{0.001 * v:.8f}\t\n".replace(".", ",")
        for t, v in zip(TIME, ringing(), strict=True)
    )
    return Instrument("catman.asc", (head + rows).replace("\n", "\r\n").encode("latin-1"), "platte")


INSTRUMENTS: tuple[Callable[[], Instrument], ...] = (
    labview,
    picoscope,
    tektronix,
    rigol,
    keysight,
    phyphox,
    tracker,
    numpy_savetxt,
    matlab,
    german_excel,
    audacity,
    catman,
)
"""The twelve files."""
