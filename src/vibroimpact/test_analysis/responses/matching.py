"""Which measured frequency response is which sensor's, and where its force acts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.errors import InputError, did_you_mean, listed
from vibroimpact.quoting import quoted
from vibroimpact.signals.frequency_response import DegreeOfFreedom, FrequencyResponse

UP = 3
"""Direction of a force along the normal of the plate, upwards."""

_ALONG = 0.99
"""Component of a unit vector along an axis that it is along."""

_AXES = "xyz"


@dataclass(frozen=True)
class Matched:
    """Frequency responses of the sensors of a case to a force at the place of its impact.

    Parameters
    ----------
    sensors : tuple of Sensor
        The sensors.
    responses : tuple of FrequencyResponse
        The response of each.
    signs : tuple of float
        1 where the measured response is that of the sensor to a force upwards, -1 where force or
        direction are the other way round.
    reference : str
        The place that is that of the impact.
    reciprocal : bool
        Whether the hammer was at the sensors, and the motion was measured at the place of the
        impact.
    sense_known : bool
        Whether it is stated in which direction the force is positive; else it is taken as that of a
        hammer, downwards.
    left_out : int
        Number of responses to this force that no sensor of the case is named after.
    """

    sensors: tuple[Sensor, ...]
    responses: tuple[FrequencyResponse, ...]
    signs: tuple[float, ...]
    reference: str
    reciprocal: bool
    sense_known: bool
    left_out: int


def matched(
    sensors: Sequence[Sensor], responses: Sequence[FrequencyResponse], reference: str | None
) -> Matched:
    """Return the responses of sensors.

    Parameters
    ----------
    sensors : sequence of Sensor
        The sensors of the case.
    responses : sequence of FrequencyResponse
        The measured responses.
    reference : str, optional
        Name of the place of the case's impact in the file; by default the only one where a force
        acts, or where motion was measured.

    Raises
    ------
    InputError
        If there is no response, it is not clear which place is that of the impact, no sensor has a
        response or one has several, or a direction or a unit is another.
    """
    if not responses:
        raise InputError("there is no frequency response; give at least one")
    name, at_impact, reciprocal = _of_impact(responses, reference)
    normal = [response for response in at_impact if abs(response.at_impact.direction) in (0, UP)]
    if not normal:
        what = "motions" if reciprocal else "forces"
        raise InputError(
            f"the {what} at {quoted(name)} are along the plate, and the case's force is normal "
            "to it; give responses with those along z"
        )
    response_of: dict[str, _PlacedResponse] = {}
    for sensor in sensors:
        response = _response_of(sensor, normal, name, reciprocal=reciprocal)
        if response is not None:
            response_of[sensor.name] = response
    if not response_of:
        raise _no_sensor(sensors, normal, name, reciprocal=reciprocal)
    used = [sensor for sensor in sensors if sensor.name in response_of]
    signs = []
    for sensor in used:
        response = response_of[sensor.name]
        _check_unit(sensor, response.response)
        force_direction = response.at_impact.direction
        force_sign = 1.0 if force_direction > 0 else -1.0
        signs.append(force_sign * _sense(sensor, response.at_sensor))
    chosen = [response_of[sensor.name] for sensor in used]
    return Matched(
        sensors=tuple(used),
        responses=tuple(response.response for response in chosen),
        signs=tuple(signs),
        reference=name,
        reciprocal=reciprocal,
        sense_known=all(response.at_impact.direction for response in chosen),
        left_out=len(normal) - len(chosen),
    )


class _PlacedResponse(NamedTuple):
    """A frequency response, its end at the place of the impact, and its end at a sensor."""

    response: FrequencyResponse
    at_impact: DegreeOfFreedom
    at_sensor: DegreeOfFreedom


def _response_of(
    sensor: Sensor, responses: Sequence[_PlacedResponse], place: str, *, reciprocal: bool
) -> _PlacedResponse | None:
    """Return the response of a sensor to a force at a place; None if it has none.

    Raises
    ------
    InputError
        If its direction is another, or there are several.
    """
    named = [response for response in responses if sensor.name in response.at_sensor.names]
    along = [response for response in named if _axis_fits(sensor, response.at_sensor)]
    if named and not along:
        axis = _AXES[abs(named[0].at_sensor.direction) - 1]
        raise InputError(
            f"the response {quoted(sensor.name)} is along {axis}, and the case's sensor along "
            f"{list(sensor.direction)}; write its direction as it was measured",
            "sensors.direction",
        )
    if len(along) > 1:
        # reciprocal responses have the force at the sensor, and the motion at the impact
        motion = place if reciprocal else sensor.name
        force = sensor.name if reciprocal else place
        raise InputError(
            f"there are {len(along)} frequency responses of the motion at {quoted(motion)} "
            f"to a force at {quoted(force)}; leave one of them in the file"
        )
    return along[0] if along else None


def _no_sensor(
    sensors: Sequence[Sensor], responses: Sequence[_PlacedResponse], place: str, *, reciprocal: bool
) -> InputError:
    """Return the error that no sensor of the case is named after a response."""
    if reciprocal:
        expected = f"a force with a response at {quoted(place)}"
    else:
        expected = f"a response to the force at {quoted(place)}"
    names = dict.fromkeys(response.at_sensor.name for response in responses)
    return InputError(
        f"no sensor of the case ({listed(sensor.name for sensor in sensors)}) is named after "
        f"{expected}: {listed(names, sensors[0].name)}; write the name of the sensor as the file "
        f'has it, such as name = "{responses[0].at_sensor.name}"',
        "sensors.name",
    )


def _of_impact(
    responses: Sequence[FrequencyResponse], reference: str | None
) -> tuple[str, list[_PlacedResponse], bool]:
    """Return the name of the place of the impact, its responses, and whether they are reciprocal.

    Raises
    ------
    InputError
        If there is no such place, or there are several and none is named.
    """
    forces = list(dict.fromkeys(response.reference.name for response in responses))
    motions = list(dict.fromkeys(response.response.name for response in responses))
    if reference is None:
        if len(forces) > 1 and len(motions) > 1:
            raise InputError(
                f"the forces act at {listed(forces)}; name the one at drop.position of the "
                "case by --hammer (in Python reference)"
            )
        reciprocal = len(forces) > 1
        name = motions[0] if reciprocal else forces[0]
    else:
        force_count = sum(reference in response.reference.names for response in responses)
        motion_count = sum(reference in response.response.names for response in responses)
        if not force_count and not motion_count:
            meant = did_you_mean(reference, [*motions, *forces])
            raise InputError(
                f"no force acts, and no motion was measured, at {quoted(reference)}; "
                f"forces act at {listed(forces)}, motion was measured at {listed(motions)}.{meant}",
                "--hammer",
            )
        reciprocal = motion_count > force_count
        name = reference
    placed = []
    for response in responses:
        at_impact = response.reference
        at_sensor = response.response
        if reciprocal:
            at_impact, at_sensor = at_sensor, at_impact
        if name in at_impact.names:
            placed.append(_PlacedResponse(response, at_impact, at_sensor))
    return name, placed, reciprocal


def _axis_fits(sensor: Sensor, end: DegreeOfFreedom) -> bool:
    return (
        end.direction == 0
        or sensor.subject == "strain"
        or abs(sensor.direction[abs(end.direction) - 1]) > _ALONG
    )


def _sense(sensor: Sensor, end: DegreeOfFreedom) -> float:
    """Return 1, or -1 where the response is measured against the direction of a sensor."""
    if end.direction == 0 or sensor.subject == "strain":
        return 1.0
    along = sensor.direction[abs(end.direction) - 1]
    return 1.0 if end.direction * along > 0.0 else -1.0


def unit_of(sensor: Sensor) -> str:
    """Return the unit of the frequency response of a sensor."""
    return "1/N" if sensor.subject == "strain" else f"{sensor.unit}/N"


def _check_unit(sensor: Sensor, response: FrequencyResponse) -> None:
    """Raise InputError if a response can't be that of a sensor.

    One of a sensor without an instrument may be of any motion.
    """
    if sensor.subject == "sound":
        raise InputError(
            f"{quoted(sensor.name)} is a microphone, which hears the whole plate; leave it out",
            "sensors",
        )
    motions = ("m/N", "m/s/N", "m/s2/N")
    any_motion = (
        sensor.instrument is None and response.unit in motions and unit_of(sensor) in motions
    )
    if response.unit not in ("", unit_of(sensor)) and not any_motion:
        raise InputError(
            f"the response {quoted(sensor.name)} is in {response.unit}, and the sensor of that "
            f"name gives {unit_of(sensor)}; give the case's sensor the quantity or the instrument "
            "that was used",
            "sensors",
        )
