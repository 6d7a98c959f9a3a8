"""Every control of the live page, by mouse and by keyboard: what it says is what is computed."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from live_page import (
    ELASTIC,
    PATCHES,
    RIGID,
    faults,
    open_live,
    row,
    settle,
    shown,
    type_value,
    value_at,
)
from vibroimpact.contact.registry import contact_laws

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

    from serving import Server

CASES = {"rigid": RIGID, "elastic": ELASTIC}
MORE_CONTROLS = [pytest.param("rigid", marks=pytest.mark.whole), "elastic"]
"""The elastic case has the controls of the rigid one, and more."""
SIZES = {"mm": 1e-3, "GPa": 1e9, "MPa": 1e6, "µs": 1e-6, "deg": np.pi / 180.0}


def keys(page: Page, kind: str) -> list[str]:
    return [
        one.get_attribute("data-key") or ""
        for one in page.locator(".row", has=page.locator(kind)).all()
    ]


def told(line: Locator) -> float:
    """Return the number that a row shows, in SI units."""
    unit = line.locator(".unit").text_content() or ""
    return float(line.locator("input[type=number]").input_value()) * SIZES.get(unit, 1.0)


def assert_is_shown(page: Page, key: str, before: float) -> None:
    """Check that the case computed has the value that the row of a key shows, and that it
    is another one than before.
    """
    assert faults(page) == []
    now = value_at(shown(page), key)
    assert now == pytest.approx(told(row(page, key)), rel=2e-5)
    assert now != before


def move_by_mouse(page: Page, key: str) -> None:
    """Drag the slider of a key to another place."""
    before = value_at(shown(page), key)
    slider = row(page, key).locator("input[type=range]")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box is not None
    place = float(slider.input_value())
    page.mouse.move(box["x"] + (0.1 + 0.8 * place) * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(
        box["x"] + (0.45 if place > 0.55 else 0.6) * box["width"], box["y"] + 0.5 * box["height"]
    )
    page.mouse.up()
    settle(page)
    assert_is_shown(page, key, before)


@pytest.mark.parametrize("case", MORE_CONTROLS)
def test_every_slider_by_mouse(case: str, page: Page, server: Server) -> None:
    open_live(page, server, CASES[case])
    found = keys(page, "input[type=range]")
    assert len(found) >= (12 if case == "rigid" else 20)
    for key in found:
        move_by_mouse(page, key)


@pytest.mark.parametrize("case", MORE_CONTROLS)
def test_every_slider_by_keyboard(case: str, page: Page, server: Server) -> None:
    open_live(page, server, CASES[case])
    for key in keys(page, "input[type=range]"):
        slider = row(page, key).locator("input[type=range]")
        for press in (
            ("ArrowRight", "PageUp")
            if float(slider.input_value()) < 0.85
            else ("ArrowLeft", "PageDown")
        ):
            before = value_at(shown(page), key)
            row(page, key).locator("input[type=range]").press(press)
            settle(page)
            assert_is_shown(page, key, before)
            # the key can be pressed again, also where controls were made anew
            assert page.evaluate("() => document.activeElement.closest('.row')?.dataset.key") == key
            spoken = row(page, key).locator("input[type=range]").get_attribute("aria-valuetext")
            assert spoken.split()[0] == row(page, key).locator("input[type=number]").input_value()


@pytest.mark.parametrize("case", MORE_CONTROLS)
def test_every_field_takes_all_digits(case: str, page: Page, server: Server) -> None:
    open_live(page, server, CASES[case])
    for key in keys(page, "input[type=number]"):
        field = row(page, key).locator("input[type=number]")
        # a parameter that is not given, such as a dissipation beside a restitution
        if not field.input_value():
            continue
        whole = key.split(".")[-1] in ("modes", "impacts")
        value = float(field.input_value()) or 1.0
        wanted = value + 1 if whole else float(f"{value * 1.01:.4g}") + 1.2345e-9 * abs(value)
        size = SIZES.get(row(page, key).locator(".unit").text_content() or "", 1.0)
        type_value(page, key, f"{wanted:.0f}" if whole else repr(wanted))
        assert faults(page) == []
        assert value_at(shown(page), key) == pytest.approx(wanted * size, rel=1e-13), key


@pytest.mark.parametrize("case", CASES)
def test_every_choice(
    case: str, page: Page, server: Server, population: Callable[..., int]
) -> None:
    open_live(page, server, CASES[case])
    for key in keys(page, "select"):
        if key == "contact.law":
            continue
        options = [one.get_attribute("value") for one in row(page, key).locator("option").all()]
        first = row(page, key).locator("select").input_value()
        if key.endswith("material"):  # there are dozens, chosen in one way
            options = options[: population(len(options), share=10)]
        for value in [one for one in options if one not in (first, "given")] + [first]:
            row(page, key).locator("select").select_option(value)
            settle(page)
            assert faults(page) == [], (key, value)
            assert row(page, key).locator("select").input_value() == value
            case_shown = shown(page)
            if key == "drop.from":
                assert ("speed" in case_shown["drop"]) == (value == "speed")
            elif key.endswith("supports"):
                given = case_shown["plate"]["supports"]
                assert {
                    "patches": "patches",
                    "free": "free",
                    "clamped": "clamped",
                    "simply-supported": "simply-supported",
                }[value] in str(given)
            elif key.endswith("damping"):
                assert (value_at(case_shown, key) == "adams-default") == (value == "adams-default")
            elif key == "drop.air":
                assert ("air" in case_shown["drop"]) == (value == "air")
            elif key == "plate.motion":
                assert ("motion" in case_shown["plate"]) == (value == "shaken")
            elif key == "contact.friction.law":
                assert case_shown["contact"].get("friction", {}).get("law", "none") == value
            elif key.endswith("material"):
                found = value_at(case_shown, key)
                assert (found if found == "rigid" else found["name"]) == value
            else:
                assert value_at(case_shown, key) == value


def test_patches_are_moved_and_stay_on_the_plate(page: Page, server: Server) -> None:
    open_live(page, server, {**ELASTIC, "plate": {**ELASTIC["plate"], "supports": PATCHES}})
    found = [key for key in keys(page, "input[type=range]") if key.startswith("plate.supports.")]
    assert len(found) == 3
    for key in found:
        move_by_mouse(page, key)
        for end in ("End", "Home"):
            row(page, key).locator("input[type=range]").press(end)
            settle(page)
            assert faults(page) == [], (key, end)


def test_every_law(page: Page, server: Server) -> None:
    open_live(page, server, RIGID)
    assert {
        one.get_attribute("value") for one in row(page, "contact.law").locator("option").all()
    } == set(contact_laws())
    for law in contact_laws():
        row(page, "contact.law").locator("select").select_option(law)
        settle(page)
        assert faults(page) == [], law
        assert shown(page)["contact"]["law"] == law
    row(page, "contact.law").locator("select").select_option("hertz")
    settle(page)
    assert [one for one in keys(page, "input[type=range]") if one.startswith("contact.")] == [
        "contact.stiffness",
        "contact.exponent",
    ]


@pytest.mark.parametrize(
    ("law", "key", "unit"),
    [("thornton", "yield_pressure", "MPa"), ("meyer", "yield_strength", "MPa")],
)
def test_a_law_that_needs_what_the_materials_do_not_tell(
    law: str, key: str, unit: str, page: Page, server: Server
) -> None:
    stone = {"density": "2700 kg/m^3", "youngs_modulus": "60 GPa", "poissons_ratio": 0.2}
    open_live(
        page,
        server,
        {
            **RIGID,
            "sphere": {"radius": "20 mm", "material": stone},
            "plate": {**RIGID["plate"], "material": stone},
        },
    )
    row(page, "contact.law").locator("select").select_option(law)
    settle(page)
    assert faults(page)[0].startswith(f"contact.{key}: ")
    field = row(page, f"contact.{key}")
    assert field.locator(".unit").text_content() == unit
    assert field.locator(".fault-here").count() == 1
    assert page.locator("#controls .note").text_content() == page.evaluate(
        f"() => vibroimpact.live.state.offer.laws['{law}'].equation"
    )
    type_value(page, f"contact.{key}", 400)
    assert faults(page) == []
    assert shown(page)["contact"][key] == pytest.approx(400e6)
    assert field.locator("input[type=range]").count() == 1


def test_patches_come_back_where_they_were(page: Page, server: Server) -> None:
    open_live(page, server, {**ELASTIC, "plate": {**ELASTIC["plate"], "supports": PATCHES}})
    before = shown(page)
    for value in ("clamped", "free", "patches"):
        row(page, "plate.supports").locator("select").select_option(value)
        settle(page)
        assert faults(page) == []
    assert shown(page) == before


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"drop": {"height": "0.2 m", "position": ["150 mm", 0]}}, "drop.position.0"),
        (
            {
                "sensors": [
                    {"name": "a1", "position": [0, 0]},
                    {"name": "the 2nd: b", "position": ["150 mm", 0]},
                ]
            },
            "sensors.1.position.0",
        ),
        (
            {
                "sensors": [
                    {"name": "a1", "position": [0, 0], "rate": "20 kHz"},
                    {"name": "", "position": [0, 0]},
                ]
            },
            "sensors.1.name",
        ),
        (
            {
                "sensors": [
                    {"name": "a1", "position": [0, 0]},
                    {"name": "a1", "position": ["9 mm", 0]},
                ]
            },
            "sensors.1.name",
        ),
    ],
)
def test_a_message_stands_at_the_field_that_it_is_about(
    change: dict[str, Any], field: str, page: Page, server: Server
) -> None:
    kept = {
        "sensors": [{"name": "a1", "position": [0, 0]}, {"name": "a2", "position": ["9 mm", 0]}]
    }
    open_live(page, server, {**ELASTIC, **kept})
    edit = (
        "(change) => vibroimpact.live.controls.change((table) "
        "=> Object.assign(table, change), true)"
    )
    page.evaluate(edit, change)
    settle(page)
    (words,) = faults(page)
    assert row(page, field).locator(".fault-here").all_text_contents() == [words]
    marked = page.locator("[aria-invalid=true]")
    assert (
        marked.count(),
        page.locator(f"#{marked.get_attribute('aria-describedby')}").text_content(),
    ) == (1, words)
    page.evaluate(edit, kept | {"drop": ELASTIC["drop"]})
    settle(page)
    assert page.locator("[aria-invalid], [aria-describedby], .fault-here").count() == 0


def test_an_oblique_drop(page: Page, server: Server) -> None:
    """Angle, friction and inclination have controls, and the ball moves along the plate,
    also along one that vibrates.
    """
    open_live(
        page,
        server,
        {
            **RIGID,
            "drop": {"speed": 3.0, "angle": 0.3},
            "contact": {**RIGID["contact"], "friction": {"law": "mdr", "coefficient": 0.2}},
        },
    )
    assert faults(page) == []
    type_value(page, "drop.angle", 30)
    type_value(page, "contact.friction.coefficient", 0.1)
    type_value(page, "plate.inclination", 5)
    case = shown(page)
    assert case["drop"]["angle"] == pytest.approx(np.radians(30))
    assert (case["contact"]["friction"]["law"], case["contact"]["friction"]["coefficient"]) == (
        "mdr",
        0.1,
    )
    assert page.locator("#chart-along_plate").count() == 1
    path = page.evaluate("() => Array.from(vibroimpact.live.state.last.scene.path[0])")
    assert path[-1] > path[0] + 0.01
    row(page, "plate.model").locator("select").select_option("elastic")
    settle(page)
    assert faults(page) == []
    assert shown(page)["contact"]["friction"] == case["contact"]["friction"]
    assert page.locator("#chart-along_plate").count() == 1
    row(page, "plate.model").locator("select").select_option("rigid")
    settle(page)
    assert (faults(page), shown(page)) == ([], case)


@pytest.mark.parametrize("case", CASES)
def test_a_plate_that_is_shaken(case: str, page: Page, server: Server) -> None:
    """Amplitude, frequency, phase and direction have controls, and impacts and charts are
    those of the plate that moves.
    """
    open_live(page, server, CASES[case])
    before, columns = shown(page), set(page.locator("table th").all_text_contents())
    row(page, "plate.motion").locator("select").select_option("shaken")
    settle(page)
    for key, value, told_as in (
        ("amplitude", 0.5, 5e-4),
        ("frequency", 40, 40.0),
        ("phase", 90, np.pi / 2.0),
    ):
        type_value(page, f"plate.motion.{key}", value)
        assert faults(page) == []
        assert value_at(shown(page), f"plate.motion.{key}") == pytest.approx(told_as)
    assert set(page.locator("table th").all_text_contents()) > columns
    for value, direction in (("x", [1, 0, 0]), ("z", [0, 0, 1])):
        row(page, "plate.motion.direction").locator("select").select_option(value)
        settle(page)
        assert faults(page) == []
        assert shown(page)["plate"]["motion"]["direction"] == direction
    row(page, "plate.motion").locator("select").select_option("rest")
    settle(page)
    assert shown(page) == before


def test_a_body_that_becomes_elastic_and_rigid_again(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    before = shown(page)
    for value in ("rigid", "elastic"):
        row(page, "plate.model").locator("select").select_option(value)
        settle(page)
        assert faults(page) == []
        assert page.get_by_role("group", name="Supports").count() == (value == "elastic")
    assert shown(page) == before  # modes, supports and sensors are those of before


def test_a_ball_that_is_hollow_and_again_solid(page: Page, server: Server) -> None:
    """Mass and inertia are given, kept while other values change, put aside for an
    elastic sphere, which is solid, and come back.
    """
    open_live(page, server, RIGID)
    row(page, "contact.friction.law").locator("select").select_option("mdr")
    settle(page)
    type_value(page, "sphere.mass", 2.7)
    row(page, "sphere.inertia").locator("select").select_option("hollow")
    settle(page)
    type_value(page, "sphere.radius", 20)
    assert faults(page) == []
    case = shown(page)
    assert (case["sphere"]["radius"], case["sphere"]["mass"], case["sphere"]["inertia"]) == (
        0.02,
        0.0027,
        "hollow",
    )
    for value in ("elastic", "rigid"):
        row(page, "sphere.model").locator("select").select_option(value)
        settle(page)
        assert faults(page) == []
        assert ("mass" in shown(page)["sphere"]) == (value == "rigid")
    assert shown(page)["sphere"] == case["sphere"]


def test_sensors_are_added_named_moved_and_removed(page: Page, server: Server) -> None:
    open_live(page, server, ELASTIC)
    page.get_by_role("button", name="Add a sensor").click()
    settle(page)
    assert [one["name"] for one in shown(page)["sensors"]] == ["a1", "a2"]
    name = row(page, "sensors.1.name").locator("input")
    name.fill('<b>"$x$" \U0001f600')
    name.press("Enter")
    settle(page)
    assert shown(page)["sensors"][1]["name"] == '<b>"$x$" \U0001f600'
    type_value(page, "sensors.1.position.0", -40)
    assert shown(page)["sensors"][1]["position"] == [-0.04, 0.05]
    assert page.locator("#charts section h2", has_text="Sensor").count() == 2
    page.get_by_role("button", name="Remove sensor a1").click()
    settle(page)
    assert len(shown(page)["sensors"]) == 1
    page.get_by_role("button", name=re.compile("Remove sensor <b>")).click()
    settle(page)
    assert "sensors" not in shown(page)
    assert page.locator("#charts section h2", has_text="Sensor").count() == 0
    assert page.locator("#get-signals").is_disabled()


def test_what_is_typed_is_kept_while_results_arrive(page: Page, server: Server) -> None:
    open_live(page, server, RIGID)
    row(page, "drop.height").locator("input[type=range]").press("ArrowRight")
    field = row(page, "sphere.radius").locator("input[type=number]")
    field.press("Control+a")
    field.press_sequentially("3")
    settle(page)
    field.press_sequentially("1")
    assert field.input_value() == "31"
    field.press("Enter")
    settle(page)
    assert shown(page)["sphere"]["radius"] == pytest.approx(0.031)
    field.fill("")
    field.press("Tab")
    assert field.input_value() == "31"


def test_moving_on_while_a_result_is_under_way_ends_at_the_last_place(
    page: Page, server: Server
) -> None:
    """A slider that is dragged does not jump back when an earlier place of it is shown."""
    open_live(page, server, ELASTIC)
    slider = row(page, "drop.height").locator("input[type=range]")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    for step in range(40):
        page.mouse.move(
            box["x"] + (0.2 + 0.015 * step) * box["width"], box["y"] + 0.5 * box["height"]
        )
        wanted = slider.input_value()
        page.evaluate("() => new Promise((done) => requestAnimationFrame(done))")
        assert slider.input_value() == wanted
    page.mouse.up()
    settle(page)
    assert (
        slider.input_value() == pytest.approx(wanted)
        or abs(float(slider.input_value()) - float(wanted)) < 0.01
    )
    assert_is_shown(page, "drop.height", 0.2)


def test_a_case_with_values_that_the_controls_have_no_words_for(page: Page, server: Server) -> None:
    table: dict[str, Any] = {
        **ELASTIC,
        "plate": {
            **ELASTIC["plate"],
            "modes": None,
            "max_frequency": "3 kHz",
            "damping": {"rayleigh": [1.0, 1e-6]},
            "supports": "clamped",
        },
        "contact": {
            "law": "adams-impact",
            "damping_max": [20.0, 10.0],
            "full_damping_penetration": "0.1 mm",
        },
        "run": {"duration": "0.5 s"},
    }
    del table["plate"]["modes"]
    open_live(page, server, table)
    assert faults(page) == []
    assert row(page, "plate.damping").locator("select").input_value() == "given"
    type_value(page, "drop.height", 0.25)
    case = shown(page)
    assert case["contact"]["damping_max"] == [20.0, 10.0]
    assert case["plate"]["damping"] == {"rayleigh": [1.0, 1e-06]}
    type_value(page, "plate.modes", 5)
    assert faults(page) == []
    assert shown(page)["plate"]["modes"] == 5
    damping = row(page, "contact.damping_max").locator("input")
    assert (damping.count(), damping.input_value()) == (1, "20, 10")
    type_value(page, "contact.damping_max", "20, 15, 12.5")
    assert faults(page) == []
    assert shown(page)["contact"]["damping_max"] == [20.0, 15.0, 12.5]
    type_value(page, "contact.damping_max", "20, -1")
    assert row(page, "contact.damping_max").locator(".fault-here").count() == 1
    type_value(page, "contact.damping_max", 15)
    assert faults(page) == []
    assert shown(page)["contact"]["damping_max"] in (15, [15.0])
