"""Exports for Adams against a strict parser of its documented syntax, which moves the model that it
reads with SciPy.

No Adams was run. The parser knows the manual's statements, functions and units; it does not know
the writer.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.adams import Bounce, Model, Motion
from oracles.adams_commands import read_commands
from oracles.adams_dataset import read_dataset, read_solver_commands
from oracles.adams_functions import Refused, Scope, State, parse_function
from support import one_in
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.formats import adams_solver, adams_view
from vibroimpact.materials import find_material

AGAINST = Against(
    "strict parser of Adams datasets and commands, and SciPy's DOP853 on the parsed model",
    "own independent computation",
    "programs and files",
    "Adams Solver manual, statements and functions; "
    "tests/oracles/adams.py; Adams itself was not run",
)


RADIUS, MASS = 0.025, 0.09032078879
K = 5.1154524848e8
PAPER = SpeedFunction((138.93525, 6.00288, -0.15582), 3.18, 8.83)
COLUMNS = {
    "approach_speed": "approach_speed_m_s",
    "separation_speed": "separation_speed_m_s",
    "duration": "duration_s",
    "largest_force": "max_force_N",
    "rebound_height": "rebound_height_m",
}
QUANTITIES = {"duration": "contact duration", "largest_force": "maximum contact force"}
HYSTERETIC = [law for law in vi.laws.contact_laws().values() if issubclass(law, HystereticLaw)]


def drop_of(
    laws: tuple[ContactLaw, ...] | ContactLaw,
    *,
    start: dict | None = None,
    impacts: int = 3,
    **given: object,
) -> Drop:
    """A drop of the paper's sphere under some laws, and what came of it."""
    start = start or {"height": 4.0}
    laws = laws if isinstance(laws, tuple) else (laws,)
    problem = Problem(
        sphere=Body(MASS, RADIUS), plate=rigid_plate(), laws=laws, impacts=impacts, gravity=9.8, rest_speed=0.0, tolerance=1e-12,
        oblique=given.get("oblique"), **start,
    )  # fmt: skip
    response = vi.simulate(problem)
    told = {"height": start.get("height", RADIUS), "speed": start.get("speed", 0.0)} | given
    return Drop(
        name="a drop", radius=RADIUS, mass=MASS, gravity=9.8, laws=laws, plate_size=(0.52, 0.42, 0.008),
        sphere_material=find_material("rock-paper"), plate_material=find_material("steel-paper"),
        end_time=float(np.ravel(response.end_time)[0]), impacts=response.impacts, **told,
    )  # fmt: skip


def impact(**given: float) -> AdamsImpact:
    return AdamsImpact(**{"stiffness": K, "damping_max": 179.75, **given})


def dataset(drop: Drop) -> Model:
    files = adams_solver.write(drop)
    (name,) = (name[:-4] for name in files if name.endswith(".adm"))
    model = read_dataset(files[f"{name}.adm"].decode())
    assert read_solver_commands(files[f"{name}.acf"].decode(), model) == name
    return model


def commands(drop: Drop) -> Model:
    (text,) = adams_view.write(drop).values()
    return read_commands(text.decode())


AFTER = [
    *("separation_velocity_x_m_s", "separation_velocity_y_m_s"),
    *("spin_x_after_rad_s", "spin_y_after_rad_s", "spin_z_after_rad_s"),
]
READERS = [pytest.param(dataset, id="adm"), pytest.param(commands, id="cmd")]


def same(agrees: Agrees, case: str, drop: Drop, bounces: list[Bounce]) -> None:
    """Are the bounces those that were computed here?"""
    table = drop.impacts
    assert len(bounces) == len(table["time_s"])
    for name, column in COLUMNS.items():
        theirs, unit = (
            [getattr(bounce, name) for bounce in bounces],
            "m/s" if "speed" in name else column.rsplit("_", 1)[1],
        )
        agrees(
            case,
            QUANTITIES.get(name, name.replace("_", " ")),
            table[column],
            theirs,
            unit=unit,
            relative=1e-7,
        )
    restitution = [bounce.separation_speed / bounce.approach_speed for bounce in bounces]
    agrees(
        case,
        "coefficient of restitution",
        table["restitution_achieved"],
        restitution,
        relative=1e-7,
    )


# both files hold the same expression: each drop is read from one of them, and from the other where
# there is time
@pytest.mark.parametrize(
    ("read", "case"),
    [
        pytest.param(
            read.values[0],
            case,
            id=f"{case}-{read.id}",
            marks=() if kept == read.id else pytest.mark.slow,
        )
        for case, kept in (("variable", "adm"), ("constant", ""), ("function", "cmd"))
        for read in READERS
    ],
)
def test_the_papers_drops(agrees: Agrees, read, case: str) -> None:
    dampings = {"constant": [179.75], "variable": [179.75, 172.8, 166.3, 160.9, 156.5]}
    if case == "function":
        # the damping of each impact is the polynomial at its approach speed
        laws, function = (
            (impact(damping_max=PAPER(np.sqrt(2 * 9.8 * 3.975))),),
            ("damping_max", PAPER),
        )
        for _ in range(4):
            speeds = drop_of(laws, impacts=5).impacts["approach_speed_m_s"]
            laws = tuple(
                impact(damping_max=float(PAPER(speed))) for speed in speeds[: len(laws) + 1]
            )
    else:
        laws, function = tuple(impact(damping_max=damping) for damping in dampings[case]), None
    drop = drop_of(laws, impacts=5, function=function)
    model = read(drop)
    bounces = Motion(model).run()
    same(
        agrees,
        "the paper's drop, damping constant, per impact and as a function of the approach speed",
        drop,
        bounces,
    )
    assert model.end == pytest.approx(drop.end_time)
    assert bounces[0].rebound_height == pytest.approx(
        {"function": 2.41124}.get(case, 2.411319), rel=1e-4
    )
    if case != "constant":
        # whether the sensor stores once or all the time makes no difference
        same(
            agrees,
            "the paper's drop, sensor triggered once per impact",
            drop,
            Motion(model).run(always=False),
        )


@pytest.mark.slow
@pytest.mark.parametrize(
    "read", one_in(2, [read.values[0] for read in READERS], lambda read: read.__name__)
)
def test_random_laws(agrees: Agrees, read) -> None:
    random = np.random.default_rng(20240611)
    for exponent in np.linspace(1.2, 2.2, 10):
        # like stiffness at 0.5 mm, whatever the exponent
        stiffness = K * 5e-4 ** (1.5 - exponent) * random.uniform(0.3, 3.0)
        law = impact(
            stiffness=stiffness,
            exponent=float(exponent),
            damping_max=random.uniform(10, 400),
            full_damping_penetration=random.uniform(2e-5, 5e-4),
        )
        drop = drop_of(law, start={"height": random.uniform(0.1, 5.0)}, impacts=2)
        same(
            agrees,
            "ten random contact laws, force exponents 1.2 to 2.2",
            drop,
            Motion(read(drop)).run(),
        )


# by turns, every third: both files hold the same expression, and the others are for when there is
# time
@pytest.mark.parametrize(
    ("read", "law"),
    [
        pytest.param(
            read.values[0],
            law,
            id=f"{law.name}-{read.id}",
            marks=pytest.mark.slow if (number + place) % 3 else (),
        )
        for number, law in enumerate(HYSTERETIC)
        for place, read in enumerate(READERS)
    ],
)
def test_hysteretic_laws(agrees: Agrees, read, law: type[HystereticLaw]) -> None:
    drop = drop_of(law(stiffness=K, restitution=0.65), impacts=3)
    model = read(drop)
    same(agrees, "all laws with hysteretic damping", drop, Motion(model).run())
    same(agrees, "all laws with hysteretic damping", drop, Motion(model).run(always=False))


@pytest.mark.parametrize("read", READERS)
def test_a_restitution_for_each_impact(agrees: Agrees, read) -> None:
    lankarani = vi.laws.find_contact_law("lankarani-nikravesh")
    drop = drop_of(tuple(lankarani(stiffness=K, restitution=e) for e in (0.7, 0.8, 0.9)), impacts=4)
    same(
        agrees,
        "different coefficient of restitution at each impact",
        drop,
        Motion(read(drop)).run(),
    )


@pytest.mark.parametrize("read", READERS)
def test_what_starts_at_first_touch(agrees: Agrees, read) -> None:
    drop = drop_of((impact(), impact(damping_max=100.0)), start={"speed": 3.0}, impacts=3)
    same(agrees, "start at first contact", drop, Motion(read(drop)).run())
    assert (
        read(drop)
        .parts[next(key for key, part in read(drop).parts.items() if not part.ground)]
        .velocity
        == -3000.0
    )


@pytest.mark.parametrize("read", READERS)
def test_hertz_loses_nothing(agrees: Agrees, read) -> None:
    drop = drop_of(Hertz(stiffness=K), start={"height": 0.5}, impacts=2)
    same(agrees, "Hertz contact", drop, Motion(read(drop)).run())


@pytest.mark.parametrize("read", READERS)
def test_a_sensor_that_never_fires_leaves_the_first_speed(agrees: Agrees, read) -> None:
    drop = drop_of(tuple(impact(damping_max=damping) for damping in (180.0, 20.0)), impacts=2)
    constant = drop_of(impact(damping_max=180.0), impacts=2)
    same(
        agrees,
        "sensor that is never triggered",
        constant,
        Motion(replace(read(drop), end=constant.end_time)).run(never=True),
    )


@pytest.mark.parametrize("read", READERS)
def test_the_model_is_that_of_the_drop(read) -> None:
    drop = drop_of(impact(), position=(0.1, -0.05))
    model = read(drop)
    (sphere,) = (part for part in model.parts.values() if not part.ground)
    assert (model.length, model.newton, model.gravity) == (1e-3, 1e3, (0.0, 0.0, -9800.0))
    assert sphere.position == (100.0, -50.0, 4000.0)
    assert sphere.mass == pytest.approx(MASS)
    assert sphere.inertia == pytest.approx([0.4 * MASS * 625.0] * 3)
    assert model.balls == {sphere.centre: 50.0}
    duration = float(drop.impacts["duration_s"][0])
    assert duration / 56 < model.longest_step <= duration / 50
    assert duration / 23 < model.output_step <= duration / 20
    assert not model.sensors
    assert not model.variables


def test_what_cannot_be_written_is_refused() -> None:
    drop = drop_of(impact())
    refused = [
        (
            replace(drop, laws=(vi.laws.find_contact_law("newton")(restitution=0.7),)),
            "adams-impact, hertz and the laws with hysteretic damping",
        ),
        (replace(drop, laws=(impact(), impact(exponent=1.6))), "nothing else"),
        (replace(drop, function=("stiffness", PAPER)), "damping_max of adams-impact can"),
        (
            replace(drop, laws=(Hertz(stiffness=K),), function=("damping_max", PAPER)),
            "damping_max of adams-impact can",
        ),
        (replace(drop, impacts={"approach_speed_m_s": np.empty(0)}), "does not reach the plate"),
        (
            replace(
                drop,
                laws=(impact(), impact(damping_max=1.0)),
                impacts={"approach_speed_m_s": np.array([2.0, 2.0])},
            ),
            "impact 2 is not slower than impact 1",
        ),
    ]
    for wrong, words in refused:
        for write in (adams_solver.write, adams_view.write):
            with pytest.raises(InputError, match=words):
                write(wrong)


def test_notes_and_names() -> None:
    drop = drop_of(impact())
    assert adams_solver.FORMAT.notes(drop) == []
    (note,) = adams_view.FORMAT.notes(replace(drop, elastic=("sphere", "plate")))
    assert "rigid" in note
    odd = replace(drop, name="Größe & Höhe; 4 m\\")
    assert list(adams_solver.write(odd)) == ["Gr_e_H_he_4_m.adm", "Gr_e_H_he_4_m.acf"]
    assert dataset(odd).forces
    assert commands(odd).forces
    assert dataset(replace(drop, plate_size=None)).forces
    assert commands(replace(drop, plate_size=None)).forces


VARIABLE = drop_of((impact(), impact(damping_max=150.0)), start={"height": 0.5}, impacts=2)
BROKEN_DATASETS = [
    ("UNITS/", "UNIT/", "no statement"),
    (", TIME = SECOND\n", "", "lacks TIME"),
    ("MILLIMETER", "FURLONG", "no unit"),
    ("MARKER/11", "MARKER/1", "twice"),
    (", J = 1\n", ", J = 7\n", "ground on the centre"),
    ("IMPACT(", "IMPACTS(", "no function"),
    (", VARVAL(2), 0.1)", ", 0.1)", "7 arguments"),
    ("VARVAL(2), 0.1)", "VARVAL(3), 0.1)", "there is no 3"),
    ("SENVAL(1)", "SENVAL(2)", "there is no 2"),
    (", ACTIONONLY\n", "", "lacks ACTIONONLY"),
    (", GSTIFF\n", ", GSTIF\n", "no argument"),
    ("25.0\\", "25.0", "EVALUATE"),
    ("KGRAV = -9800.0", "KGRAV = -9.8O", "no number"),
    ("\nEND", "", "END"),
    ("CM = 11", "CM = 1", "no marker of its own"),
    (", MASS = 0.09", "  , MASS = 0.09", "PART lacks"),
    ("! adams_view_name='spot'", "! " + "x" * 80, "80 columns"),
]


@pytest.mark.parametrize(
    ("right", "wrong", "words"),
    BROKEN_DATASETS,
    ids=[one[1].strip()[:20] or one[0] for one in BROKEN_DATASETS],
)
def test_the_parser_refuses_broken_datasets(right: str, wrong: str, words: str) -> None:
    text = adams_solver.write(VARIABLE)["a_drop.adm"].decode()
    assert right in text
    with pytest.raises(Refused, match=words):
        Motion(read_dataset(text.replace(right, wrong, 1)))


BROKEN_COMMANDS = [
    ("defaults units", "default units", "no command"),
    ("   time = sec", "   time = sec  &", "continued by a comment"),
    ("length = mm", "length = inches", "no unit"),
    ("compare = ge", "compare = gt", "must be ge"),
    ("j_marker_name = .a_drop.ground.spot", "j_marker_name = .a_drop.ground.spott", "no marker"),
    ("marker_name = .a_drop.ground.corner", "marker_name = .a_drop.ground.spot", "twice"),
    ("part_name = .a_drop.sphere", "part_name = .another.sphere", "belongs to"),
    ("SENVAL(.a_drop.touch)", "SENVAL(.a_drop.touched)", "there is no .a_drop.touched"),
    ("IMPACT(", "IMPAKT(", "no function"),
    ("action_only = on", "action_only = yes", "must be on"),
    ("   mass = 0.0", "   masse = 0.0", "masse"),
    ("   y_component_gravity = 0.0  &\n", "", "lacks y_component_gravity"),
    ('"DZ(', "DZ(", "quote"),
]


@pytest.mark.parametrize(
    ("right", "wrong", "words"),
    BROKEN_COMMANDS,
    ids=[one[1].strip()[:20] or one[0] for one in BROKEN_COMMANDS],
)
def test_the_parser_refuses_broken_commands(right: str, wrong: str, words: str) -> None:
    text = adams_view.write(VARIABLE)["a_drop.cmd"].decode()
    assert right in text
    with pytest.raises(Refused, match=words):
        Motion(read_commands(text.replace(right, wrong, 1)))


def test_the_parser_would_see_wrong_units(agrees: Agrees) -> None:
    """A stiffness per metre, a damping in N s/m, a gravity in m/s^2: each changes what
    comes out.
    """
    text = adams_solver.write(VARIABLE)["a_drop.adm"].decode()
    stiffness = f"{K / 1000**1.5:.15g}"
    assert stiffness in text
    first = {name: column[:1] for name, column in VARIABLE.impacts.items()}
    until = float(first["time_s"][0] + 2.0 * first["duration_s"][0])

    def agrees(dataset: str) -> bool:
        model = read_dataset(dataset)
        model.end = until
        try:
            bounces = Motion(model).run()
        except Refused:
            return False
        return len(bounces) == 1 and all(
            getattr(bounces[0], name) == pytest.approx(first[column][0], rel=1e-6)
            for name, column in COLUMNS.items()
            if name != "rebound_height"
        )

    assert agrees(text)
    for old, new in [
        (stiffness, f"{K / 1000:.15g}"),
        ("0.17975", "179.75"),
        ("-9800.0", "-9810.0"),
        ("MASS = KILOGRAM", "MASS = GRAM"),
    ]:
        assert old in text
        assert not agrees(text.replace(old, new))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-2.0**2", -4.0),
        ("2**-1", 0.5),
        ("2**3**2", 512.0),
        ("1 - 2 - 3 * 4 / 2", -7.0),
        ("IF(-1: 1, 2, 3) + 10 * IF(0: 1, 2, 3) + 100 * IF(5: 1, 2, 3)", 321.0),
        ("STEP(0.25, 0, 0, 1, 2)", 2.0 * 0.25**2 * 2.5),
        ("IMPACT(0.9, -2.0, 1.0, 100, 1.5, 25, 0.1)", 100 * 0.1**1.5 + 50.0),
        ("IMPACT(0.9, 20.0, 1.0, 100, 1.5, 25, 0.1)", 0.0),
        ("IMPACT(1.1, -2.0, 1.0, 100, 1.5, 25, 0.1)", 0.0),
        ("1.5E+01 + MAX(1, 2)", 17.0),
    ],
)
def test_the_oracles_functions(text: str, value: float) -> None:
    assert parse_function(text, Scope({}, {}, {}))(State({}, {}, {})) == pytest.approx(
        value, rel=1e-14
    )


@pytest.mark.slow
@pytest.mark.parametrize("read", READERS)
@pytest.mark.parametrize("coefficient", [0.05, 0.4])
def test_oblique_drops(agrees: Agrees, read, coefficient: float) -> None:
    """That slip throughout, and that roll at last; on an inclined plate."""
    coulomb = vi.friction.find_friction_law("coulomb")(coefficient=coefficient)
    oblique = vi.Oblique(
        velocity=(0.6, 0.0), spin=(0.0, -16.0, 5.0), gravity=(0.5, 0.0), friction=coulomb
    )
    drop = drop_of(impact(), start={"height": 0.5}, impacts=2, oblique=oblique)
    model = read(drop)
    bounces = Motion(model).run()
    same(agrees, "oblique impacts on an inclined plate", drop, bounces)
    found = np.array([bounce.along for bounce in bounces]).T
    for values, column in zip(found, AFTER, strict=True):
        scale = RADIUS if "spin" in column else 1.0
        quantity = (
            "angular velocity times radius after impact"
            if "spin" in column
            else "tangential velocity after impact"
        )
        agrees(
            "oblique impacts on an inclined plate",
            quantity,
            scale * drop.impacts[column],
            scale * values,
            unit="m/s",
            absolute=2e-5,
        )
    assert model.gravity == pytest.approx((500.0, 0.0, -9800.0))


def test_friction_that_stands_for_another() -> None:
    moduli = {
        "effective_modulus": 2.4e9,
        "effective_shear_modulus": 2e9,
        "effective_radius": RADIUS,
    }
    mdr = vi.friction.find_friction_law("mdr")(coefficient=0.3, **moduli)
    drop = drop_of(
        impact(),
        start={"height": 0.5},
        impacts=1,
        oblique=vi.Oblique(velocity=(0.6, 0.0), friction=mdr),
    )
    for format in adams_solver.FORMAT, adams_view.FORMAT:
        assert "its coulomb stands for it" in " ".join(format.notes(drop))
        assert any(b"0.3 * MAX(SFORCE(" in content for content in format.write(drop).values())
    rigid = vi.Oblique(friction=vi.friction.find_friction_law("rigid")(coefficient=0.3))
    with pytest.raises(InputError, match="rigid can't be written for Adams; coulomb, mdr"):
        adams_solver.write(drop_of(impact(), start={"height": 0.5}, impacts=1, oblique=rigid))


@pytest.mark.parametrize(
    ("right", "wrong", "words"),
    [
        (", FLOATING\n", "", "has a place, or floats"),
        (", JFLOAT = 3", ", JFLOAT = 2", "no floating marker"),
        (", TZ = 0.0\n", "", "lacks TZ"),
        ("GFORCE/1\n, I = 11", "GFORCE/1\n, I = 1", "act on the centre"),
        ("WY(11, 1, 1)", "WY(11, 1, 1, 1)", "4 markers"),
        ("SFORCE(1, 0, 4, 1), 0.0)", "SFORCE(2, 0, 4, 1), 0.0)", "there is no 2"),
    ],
)
def test_the_parser_refuses_broken_friction(right: str, wrong: str, words: str) -> None:
    oblique = vi.Oblique(
        velocity=(0.6, 0.0), friction=vi.friction.find_friction_law("coulomb")(coefficient=0.3)
    )
    text = adams_solver.write(drop_of(impact(), start={"height": 0.5}, impacts=1, oblique=oblique))[
        "a_drop.adm"
    ].decode()
    assert right in text
    with pytest.raises(Refused, match=words):
        Motion(read_dataset(text.replace(right, wrong, 1)))
