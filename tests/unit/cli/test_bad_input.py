"""Bad input: one clear message that names where, what and what is allowed; exit status 2;
never a traceback.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import tomli_w

import vibroimpact as vi
from support import plain_case, run_command
from vibroimpact.cli import main

NAN, INF = float("nan"), float("inf")
FAULTS = [
    (
        {"sphere__raduis": 1},
        'sphere.raduis: unknown key "raduis"; [sphere] takes radius, material, mass, '
        "inertia, model,",
    ),
    (
        {"sphere__diameter": "50 mm"},
        "sphere.diameter: give radius, half the diameter, in its place",
    ),
    ({"contakt": {}}, 'contakt: unknown key "contakt"; a case takes'),
    ({"contact__restitutoin": 0.5}, 'contact.restitutoin: unknown key "restitutoin"'),
    (
        {"contact__damping_max": 5},
        'contact.damping_max: unknown key "damping_max"; lankarani-nikravesh takes',
    ),
    ({"sphere": None}, "sphere: this section is missing"),
    ({"plate": None}, "plate: this section is missing"),
    ({"drop": None}, "drop: this section is missing"),
    ({"contact": None}, "contact: this section is missing"),
    ({"sphere__radius": None}, "sphere.radius: this key is missing"),
    ({"contact__restitution": None}, "contact.restitution: this key is missing"),
    ({"contact__law": None}, "contact: it needs law"),
    ({"contact__law": "lankarani"}, 'Did you mean "lankarani-nikravesh"?'),
    ({"sphere__radius": "25 kg"}, 'sphere.radius: "25 kg" is a mass; expected a length'),
    (
        {"sphere__radius": "25"},
        'sphere.radius: "25" has no unit: write 25 (it is then in m) or "25 m"',
    ),
    ({"sphere__radius": "25 lightbulbs"}, '"lightbulbs" in "25 lightbulbs" is not a unit'),
    ({"sphere__radius": "9**9**9 m"}, "is not a unit that is known"),
    ({"sphere__radius": NAN}, "sphere.radius: nan is not finite"),
    ({"drop__height": INF}, "drop.height: inf is not finite"),
    ({"contact__stiffness": NAN}, "contact.stiffness: nan is not finite"),
    ({"sphere__radius": 0}, "sphere.radius: 0 is not allowed; it must be greater than 0 m"),
    (
        {"sphere__radius": "-25 mm"},
        'sphere.radius: "-25 mm" is not allowed; it must be greater than 0 m',
    ),
    ({"drop__gravity": -9.8}, "drop.gravity: -9.8 is not allowed; it must be at least 0 m/s^2"),
    ({"drop__height": 0.02}, "drop.height: 0.02 m does not lift the sphere off the surface"),
    ({"drop__speed": 3}, "drop: give either height or speed; both are given"),
    ({"drop__height": None}, "drop: give either height or speed; neither is given"),
    ({"drop__gravity": 0}, "drop.gravity: without gravity a sphere does not fall"),
    (
        {"plate__size": [0.1, 0.1, 0.01], "drop__position": [0.06, 0]},
        "drop.position: (0.06, 0) m lies outside the plate",
    ),
    (
        {"plate__size": [0.1, 0.1]},
        "plate.size: there are too few values; it takes length (x), width (y) and thickness (z)",
    ),
    ({"plate__size": [0.1, 0.1, -0.1]}, "plate.size.thickness: -0.1 is not allowed"),
    ({"sphere__material": "steal"}, 'Did you mean "steel"?'),
    ({"sphere__material": "rigid"}, 'sphere.material: "rigid" has no density'),
    (
        {"sphere__material": {"density": 1, "youngs_modulus": 1, "poissons_ratio": 0.5}},
        "poissons_ratio: 0.5 is not allowed",
    ),
    (
        {"sphere__material": {"density": 1, "youngs_modulus": 1, "poissons_ratio": -1}},
        "must be greater than -1 and less than 0.5",
    ),
    (
        {"sphere__material": {"density": 1, "youngs_modulus": 1}},
        "sphere.material.poissons_ratio: this key is missing",
    ),
    (
        {"contact__restitution": 1.01},
        "contact.restitution: 1.01 is not allowed; it must be at least 0 and at most 1",
    ),
    ({"contact__restitution": -0.1}, "contact.restitution: -0.1 is not allowed"),
    ({"contact__restitution": []}, "contact.restitution: the list is empty"),
    ({"contact__restitution": [0.5, 2]}, "contact.restitution: 2 is not allowed"),
    ({"contact__restitution": "high"}, 'contact.restitution: "high" is not a plain number'),
    ({"contact__exponent": "0.5 m"}, "contact.exponent"),
    ({"contact__stiffness": "5 N/m"}, "contact.stiffness"),
    (
        {"contact": {"law": "flores", "restitution": 0}},
        "contact.restitution: 0 is not allowed; it must be greater than 0 and at most 1",
    ),
    (
        {"contact": {"law": "thornton", "restitution": 0.5}},
        'contact.restitution: unknown key "restitution"; thornton takes',
    ),
    (
        {"contact": {"law": "thornton"}},
        "contact.yield_pressure: thornton needs limiting contact pressure p_y [Pa], and "
        "neither material has a yield_strength",
    ),
    (
        {"contact": {"law": "jkr"}},
        "contact.work_of_adhesion: this key is missing; jkr needs work of adhesion w [J/m^2]",
    ),
    (
        {"contact": {"law": "walton-braun", "stiffness": 1e6}},
        "walton-braun needs either restitution or stiffening [1/m], and not both",
    ),
    (
        {"contact": {"law": "storakers", "yield_strength": "5 MPa", "hardening_exponent": 1}},
        "contact.hardening_exponent: 1 is not allowed",
    ),
    ({"drop__same_spot": "yes"}, 'drop.same_spot: "yes" is not allowed; it must be true or false'),
    (
        {"contact": {"law": "walton-braun", "stiffness": 1e6, "stiffening": "5 m"}},
        'contact.stiffening: "5 m" is a length',
    ),
    (
        {"run__impacts": 0},
        "run.impacts: 0 is not allowed; it must be a whole number from 1 to 100000",
    ),
    (
        {"run__impacts": "all", "contact": {"law": "hertz"}},
        'run.impacts: "all" needs a law that loses energy',
    ),
    (
        {"run__impacts": "all", "contact": {"law": "thornton", "yield_pressure": 1e7}},
        'run.impacts: "all" needs a law that loses energy, and thornton loses none on a '
        "dent that it has made",
    ),
    (
        {"run__impacts": "all", "contact": {"law": "hertz"}, "drop__air": True},
        "and this hertz loses none; give a number, or run.duration",
    ),
    (
        {"run__impacts": "all", "contact__restitution": {"speed": [0.1, 1.0], "value": [1.0, 0.5]}},
        "and this lankarani-nikravesh loses none of slow impacts",
    ),
    (
        {
            "contact__finite_sphere": True,
            "contact__friction": {"law": "coulomb", "coefficient": 0.2},
        },
        "contact.finite_sphere: this is for drops along the normal, without spin and "
        "friction; leave it out, or contact.friction",
    ),
    (
        {
            "contact": {
                "law": "linear-spring-dashpot",
                "stiffness": 1e6,
                "damping": 3.0,
                "liquid": True,
            }
        },
        "linear-spring-dashpot is given without a restitution, of which a liquid leaves a "
        "part; give contact.restitution in place of contact.damping",
    ),
    (
        {"plate__radius": 0.1, "sensors": [{"name": "a", "position": [0, 0]}]},
        "sensors: sensors are on a plate, and a sphere takes its place",
    ),
    (
        {
            "contact": {
                "law": "walton-braun",
                "stiffness": 1e6,
                "restitution": 0.8,
                "loaded_to": {"speed": [1, 2], "value": [0, 1]},
            }
        },
        "contact.loaded_to: it is the state before the first impact, and can't be a "
        "function of the approach speed",
    ),
    ({"run__impacts": 2.5}, "run.impacts: 2.5 is not allowed"),
    ({"run__duration": "5 m"}, 'run.duration: "5 m" is a length'),
    ({"run__tolerance": 0.1}, "run.tolerance: 0.1 is not allowed"),
    (
        {"sphere__model": "soft"},
        'sphere.model: "soft" is not allowed; it must be "rigid" or "elastic"',
    ),
    ({"schema_version": 2}, "schema_version: 2 is not allowed; it must be 1"),
    ({"sphere": 3}, "sphere: 3 is not a table"),
    (
        {"sensors": {"name": "a1"}},
        "sensors: this is one table, and it must be a list of tables; write [[sensors]] above each",
    ),
    (
        {"plate__thickness": 0.01},
        'plate.thickness: give size = ["600 mm", "400 mm", "10 mm"] (length, width, '
        "thickness), or with --set",
    ),
    ({"name": 3}, "name: 3 is not a text; put it in quotes"),
]


def outcome(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *arguments: str
) -> tuple[int, str]:
    """Run the command line; return its exit status and what it wrote to the error stream."""
    status, _, errors = run_command(monkeypatch, capsys, *arguments)
    return status, errors


@pytest.mark.parametrize(
    ("changes", "message"), FAULTS, ids=[message[:40] for _, message in FAULTS]
)
def test_wrong_case(
    changes: dict,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(plain_case(**changes))
    assert message in str(raised.value)
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(plain_case(**changes)))
    status, written = outcome(monkeypatch, capsys, "run", str(file), "-o", str(tmp_path / "out"))
    assert status == 2
    assert written.startswith(f"vibroimpact: {file}: ")
    assert message in written
    assert "Traceback" not in written
    assert not (tmp_path / "out").exists()


def test_every_fault_of_a_case_is_named_at_once() -> None:
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(plain_case(sphere__radius=-1, drop__gravity="x", foo=1))
    assert len(str(raised.value).splitlines()) == 3


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"radius = = 3", "this is not valid TOML"),
        (b"\xff\xfe\x00", "the file is not UTF-8 text but UTF-16; save it as UTF-8"),
        (b"a = 1\n" * 200_000, "the file is larger than 1 MB"),
        (b"a = " + b"[" * 5000, "nested too deeply"),
        (b"", "sphere: this section is missing"),
        (b"x = " + b"9" * 5000, "this is not valid TOML"),
    ],
)
def test_unreadable_files(
    content: bytes,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    for command in ("check", "run"):
        status, written = outcome(monkeypatch, capsys, command, str(file))
        assert status == 2
        assert message in written


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run", "no-such.toml"), "no-such.toml: there is no such file"),
        (("check", "."), ".: this is a directory"),
        (("run", "paper:type1-theroy"), 'Did you mean "paper:type1-theory"?'),
        (("run", "paper:../reader"), "there is no shipped case"),
        (("report", "."), "this is not a result folder"),
        (("run", "."), ".: this is a directory"),
        (("run", ""), "this is a directory"),
        (("run", "paper:"), "there is no shipped case"),
        (("run", "paper:type1-theory", "-o", ""), "this is the current folder"),
        (("run", "paper:type1-theory", "-o", "/proc/no/such"), "can't be"),
        (("materials", "steal"), 'Did you mean "steel"?'),
        (("run",), "Missing argument"),
        (("runn",), "No such command 'runn'"),
    ],
)
def test_wrong_arguments(
    arguments: tuple[str, ...],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    status, written = outcome(monkeypatch, capsys, *arguments)
    assert status == 2
    assert message in written


def test_a_misspelt_key_is_not_reported_as_missing_too() -> None:
    table = plain_case()
    table["sphere"]["raduis"] = table["sphere"].pop("radius")
    with pytest.raises(vi.InputError) as raised:
        vi.case_of(table)
    assert len(str(raised.value).splitlines()) == 1
    assert 'Did you mean "radius"?' in str(raised.value)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("radius = 25 mm", 'a number with a unit is a text: write it in quotes, such as "25 mm"'),
        ("radius = 2.5e-2m", "write it in quotes"),
        ("radius = 1\nradius = 2", "stands there twice"),
        ("[sensors]\n[sensors]", "write [[sensors]] above each table of a list"),
        ('material = "steel', "close the quotes on the line where they are opened"),
    ],
)
def test_what_toml_does_not_say(line: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(f"[sphere]\n{line}\n")
    with pytest.raises(vi.InputError, match="this is not valid TOML") as raised:
        vi.load_case(tmp_path / "case.toml")
    assert words in str(raised.value)


def test_check_sees_that_what_was_measured_is_not_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    table = plain_case(
        contact={"law": "adams-impact", "damping_max": 100.0},
        calibrate={"target": {"file": "none.csv"}},
    )
    (tmp_path / "case.toml").write_text(tomli_w.dumps(table))
    monkeypatch.setattr("sys.argv", ["vibroimpact", "check", str(tmp_path / "case.toml")])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    told = capsys.readouterr().err
    assert "calibrate.target" in told
    assert "none.csv: there is no such file" in told
