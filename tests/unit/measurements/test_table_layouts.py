"""Tables as instruments and languages write them: where the header is, what separates
fields, how the text is encoded.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi

FORCE = np.array([0.0, 1.5, -2.25, 3.0])


def read(path: Path, text: str, encoding: str = "utf-8") -> vi.signals.Record:
    path.write_bytes(text.encode(encoding))
    (record,) = vi.signals.load_records(path)
    return record


LAYOUTS = {
    "a plain table": "time [s],force [N]\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "a comment above a header": "# of a hammer\ntime [s],force [N]\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "a header in a comment": "# time [s],force [N]\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "with other comments": "# a hammer, a plate, of steel\n#\n# time [s],force "
    "[N]\n\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "separated by blanks": "# time(s), \t \t force(N)\n0.0e+00 0.0e+00\n1.0e-03 1.5e+00\n2.0e-03 "
    "-2.25e+00\n3.0e-03 3.0e+00\n",
    "blanks in the header too": "# time [s] force [N]\n0 0\n0.001 1.5\n0.002 -2.25\n0.003 3\n",
    "blanks and decimal commas": "# time [s] force [N]\n0,0 0,0\n0,001 1,5\n0,002 -2,25\n0,003 3,0\n",
    "a line with the separator": "sep=;\ntime [s];force [N]\n0;0\n0,001;1,5\n0,002;-2,25\n0,003;3\n",
    "units in the second row": "Time,Force\n(ms),(kN)\n\n0,0\n1,0.0015\n2,-0.00225\n3,0.003\n",
    "units in brackets, with tabs": "Time\tForce\n[s]\t[N]\n0\t0\n0,001\t1,5\n0,002\t-2,25\n0,003\t3\n",
    "lines about the measurement": "Recorder 3\nRate: 1000, Hz, x\n\ntime [s],force "
    "[N]\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "such lines that state no unit": "Horizontal Units\nVertical Units,V\ntime [s],force "
    "[N]\n0,0\n0.001,1.5\n0.002,-2.25\n0.003,3\n",
    "such lines and a row of units": "Recorder\nModel;4711;x\nTime;Force\n(s);(N)\n0;0\n0,001;1,5\n0,002;-2,25\n0,003;3\n",
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_same_record_is_read(layout: str, encoding: str, tmp_path: Path) -> None:
    record = read(tmp_path / "hammer.csv", LAYOUTS[layout], encoding)
    assert (record.name, record.unit, record.rate, record.start, record.doubts) == (
        "force",
        "N",
        1000.0,
        0.0,
        (),
    )
    np.testing.assert_allclose(record.value, FORCE)


@pytest.mark.parametrize(
    ("delimiter", "decimal"), [(" ", "."), (",", "."), ("\t", "."), (";", ",")]
)
def test_tables_of_numpy(delimiter: str, decimal: str, tmp_path: Path) -> None:
    path = tmp_path / "force.txt"
    np.savetxt(
        path,
        np.stack([np.arange(4) / 1e3, FORCE], axis=1),
        delimiter=delimiter,
        header=delimiter.join(["time [s]", "force [N]"]),
    )
    path.write_text(path.read_text().replace(".", decimal))
    (record,) = vi.signals.load_records(path)
    np.testing.assert_allclose(record.value, FORCE)


def test_latin_1_is_read_and_told_by_its_byte(
    command: Callable[..., tuple[int, str, str]], tmp_path: Path
) -> None:
    path = tmp_path / "way.csv"
    record = read(path, "time [s],way [\u00b5m]\n0,0\n0.001,1.5\n", "latin-1")
    np.testing.assert_allclose(record.value, [0.0, 1.5e-6])
    (doubt,) = record.doubts
    assert (
        doubt == 'line 1 has the byte B5, which is not UTF-8: it is read as "\u00b5" of Latin-1; '
        "save the file as UTF-8 if it should be another"
    )
    assert "the byte B5" in command("features", path, "--only", "peak")[2]


@pytest.mark.parametrize("text", [b"time [s],force [N]\n0,0\n1,\x81\n", b"\xff\xfet\x00i\x00m"])
def test_bytes_that_are_no_text_are_refused(text: bytes, tmp_path: Path) -> None:
    (tmp_path / "way.csv").write_bytes(text)
    with pytest.raises(vi.InputError, match=r"way\.csv"):
        list(vi.signals.load_records(tmp_path / "way.csv"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "0,0\n0.001,1\n",
            r"line 1: it has 2 numbers, and no header is above it; write a header, such as "
            r"time \[s\],force \[N\]",
        ),
        (
            "# time [s],force [N],way [m]\n0,0\n1,1\n",
            r"line 2: it has 2 numbers, and the comment before it does not have as many names",
        ),
        (
            "# time [s],force [N]\n0,0\n0.001,x\n",
            r'line 3, column "force \[N\]": "x" is not a number',
        ),
        ("sep=;\n", "the file is empty"),
        (
            "Recorder\n\ntime [s],force [N]\n0,0\n0.001,1\n0.002,x\n",
            r'line 6, column "force \[N\]": "x" is not a number',
        ),
    ],
)
def test_what_is_not_read_is_said_with_its_line(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(vi.InputError, match=message):
        read(tmp_path / "wrong.csv", text)
