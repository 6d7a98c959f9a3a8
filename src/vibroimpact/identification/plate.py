"""The plate of a case as what lies between a force and the sensors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial

import numpy as np
from scipy.stats.qmc import Halton

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import check_case, problem_of
from vibroimpact.cases.elastic.coupling import at_place, treatment_of
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.rigid.oblique import oblique_keys
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.place_responses import (
    PlaceResponses,
    sensor_shapes,
    unit_responses,
)
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate
from vibroimpact.errors import InputError
from vibroimpact.identification.setup import Setup, SetupErrors, stretched, with_resonance
from vibroimpact.structures.finite_elements.surface import Side, place_of
from vibroimpact.structures.modal_model import ModalBasis, ModalModel, rigid_basis
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids
from vibroimpact.structures.static_compliance import computed_compliances

Place = tuple[float, float]
"""x and y on the plate [m]."""

_PER_WAVELENGTH = 6.0
"""Places of the grid per shortest wavelength of the modes."""
_DETUNED = 1e-5
"""Relative step of a frequency in derivatives."""
_SIMILAR = 1e-4
"""Largest relative difference of frequencies between plates that share these derivatives."""
_KEPT_CONTACTS = 4
"""Number of places of the contact that are kept."""
_LEFT_OUT = 16
"""Number of modes that stand for those left out.

They are so dense that they do not swing back during a contact.
"""
_FINER = 1.5
"""How much finer a mesh is whose static compliance is compared."""
_PLACES = 32
"""At how many places it is compared."""
_MIDDLE = 0.6
"""Part of the length and width of the plate over which these places lie."""
_MARGIN = 1.5
"""Least distance of a place from the edge, in thicknesses."""
_SHEAR = 5.0 / 6.0
"""Part of the section of a plate that carries shear."""


@dataclass(frozen=True, eq=False)
class Plate:
    """An elastic plate with its sensors, ready for forces anywhere.

    Parameters
    ----------
    case : CaseTable
        The case.
    problem : Problem
        The problem that it states, with the contact at the place of the drop.
    window : float
        Length of the responses [s].
    frequency_errors : array, shape (modes,)
        Standard deviation of the relative error of the frequency of each rigid motion and mode [-].
    errors : SetupErrors
        What is not certain of the case.
    model_error : float
        Part of the estimated errors of the mesh and of the modes left out that records have: 1 of
        those of a plate, 0 of those of a run of this same model.
    setup : Setup, optional
        How the plate and its sensors differ from the case.
    stated : Plate, optional
        The plate as the case states it, of one that differs.
    responses : dict
        Responses that were computed, by the names of sensors.
    detunings : dict
        Their derivatives in the frequencies, with these frequencies, which plates in similar
        set-ups share.
    """

    case: CaseTable
    problem: Problem
    window: float
    frequency_errors: Floats
    errors: SetupErrors = field(default_factory=SetupErrors)
    model_error: float = 1.0
    setup: Setup | None = None
    stated: Plate | None = None
    responses: dict[tuple[str, ...], PlaceResponses] = field(default_factory=dict)
    detunings: dict[tuple[str, ...], tuple[Floats, Floats]] = field(default_factory=dict)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Least and largest x and y of a place [m], (2,) each."""
        nodes = self._model.mesh.nodes[:, :2]
        margin = _MARGIN * self._thickness
        return nodes.min(axis=0) + margin, nodes.max(axis=0) - margin

    @property
    def _model(self) -> ModalModel:
        """Its mesh with all of its modes."""
        return self.problem.models["plate"]

    @property
    def _thickness(self) -> float:
        """Its thickness as the case states it [m]."""
        return self._model.thickness or float(self._model.mesh.extent[2])

    @property
    def modes(self) -> ModalBasis:
        """Its modes, with the contact at the place of the drop."""
        modes = self.problem.plate.modes
        assert modes is not None  # `plate_of` has seen to it
        return modes

    @cached_property
    def grid(self) -> tuple[Floats, Floats, Floats]:
        """A grid of places that no mode oscillates between: x, y [m], deflections (y, x, modes)."""
        low, high = self.bounds
        length, width = high - low
        modes = len(self._model.angular_frequencies)
        # a mode has the area of its wavelength squared over pi (Weyl)
        step = np.sqrt(np.pi * length * width / modes) / _PER_WAVELENGTH

        def coordinates(axis: int) -> Floats:
            start = float(low[axis])
            end = float(high[axis])
            count = round((end - start) / step) + 1
            return np.linspace(start, end, max(5, count))

        x = coordinates(0)
        y = coordinates(1)
        places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return x, y, self.deflections(places).reshape(len(y), len(x), -1)

    @cached_property
    def lacking(self) -> tuple[float, float]:
        """Mean and deviation over places of the part of its static compliance that the mesh lacks.

        It is what a finer mesh adds [-], which is most of it: near a point force the error falls
        with the square of the element size or faster. For the mesh of a file it is 0.
        """
        if self.stated is not None:  # it is relative to what changes
            return self.stated.lacking
        recipe = elastic_bodies(self.case)["plate"].recipe
        if not isinstance(recipe.shape, PlateOfPlates | PlateOfSolids):
            return 0.0, 0.0
        element_size = recipe.shape.element_size / _FINER
        finer = replace(recipe, shape=replace(recipe.shape, element_size=element_size))
        size = np.asarray(recipe.shape.size[:2])
        # evenly spread and without a draw; the first point of the sequence is the origin
        in_square = Halton(2, scramble=False).random(_PLACES + 1)[1:] - 0.5
        places = [(x, y) for x, y in (_MIDDLE * size * in_square).tolist()]
        stated = computed_compliances(recipe, places)
        added = computed_compliances(finer, places) / stated - 1.0
        return float(added.mean()), float(added.std())

    @cached_property
    def thickness_exponents(self) -> Floats:
        r"""Exponents n of the modes, whose frequencies are proportional to :math:`h^n`, (modes,).

        With the thickness h it is that of a plane bending wave of the wavenumber k in Mindlin's
        theory, :math:`\omega \propto k^2 h\,(1 + c (k h)^2)^{-1/2}`: one in thin plates, and less
        where shear and rotary inertia count.
        """
        material = self.case.plate.material
        ratio = material.poissons_ratio
        # c, of shear and rotary inertia
        inertia = (1.0 + 2.0 / (_SHEAR * (1.0 - ratio))) / 12.0
        speed = np.sqrt(material.youngs_modulus / (12.0 * material.density * (1.0 - ratio**2)))
        # (kh)^4 / (1 + c (kh)^2), which the frequency gives
        square = (self.modes.angular_frequencies * self._thickness / speed) ** 2
        # c (kh)^2 is the root of that quadratic equation
        shear = 0.5 * inertia * (inertia * square + np.sqrt((inertia * square) ** 2 + 4.0 * square))
        return np.asarray(1.0 / (1.0 + shear))

    @property
    def touched(self) -> CaseTable:
        """The case with the modulus of the plate as the set-up has it, for its contact."""
        if self.setup is None or not self.setup.modulus:
            return self.case
        material = self.case.plate.material
        modulus = (1.0 + self.setup.modulus) * material.youngs_modulus
        stiffer = replace(material, youngs_modulus=modulus)
        plate = self.case.plate.model_copy(update={"material": stiffer})
        return self.case.model_copy(update={"plate": plate})

    def under(self, setup: Setup, names: Sequence[str]) -> Plate:
        """Return the plate of a set-up that differs from the case, whose sensors are these."""
        moved = {
            name: self._at_sensor(name, (float(x), float(y)))
            for name, (x, y) in zip(names, setup.moved, strict=True)
            if x or y
        }
        resonances = dict(zip(names, setup.resonance.tolist(), strict=True))
        sensors = tuple(
            with_resonance(sensor, resonances.get(sensor.name, 0.0))
            for sensor in self.problem.sensors
        )
        modes = replace(self.modes, points={**self.modes.points, **moved})
        problem = replace(
            self.problem, plate=replace(self.problem.plate, modes=modes), sensors=sensors
        )
        return replace(
            self,
            problem=stretched(problem, setup, self.thickness_exponents),
            setup=setup,
            stated=self,
            responses={},
        )

    def _at_sensor(self, name: str, by: Place) -> Floats:
        """Return the mode shapes at a sensor that is moved along x and y [m], (modes, 3).

        Sensors of supports are not moved.
        """
        model = self._model
        body = elastic_bodies(self.case)["plate"]
        if name in body.pressed:
            return self.modes.points[name]
        spot, side = body.sensors[name]
        x, y = place_of(model.mesh, spot, side)
        nodes = model.mesh.nodes[:, :2]
        stated = np.array([x, y])
        # a sensor does not leave the plate
        moved = np.clip(stated + by, nodes.min(axis=0), nodes.max(axis=0))

        def seen(place: Floats, side: Side) -> Floats:
            if name in body.strained:
                return model.strains((float(place[0]), float(place[1])), side)
            return model.at(place[None], side)[0][:, 0]

        # the difference, since the shapes at the sensor include what the theory of plates adds at a
        # face
        return np.asarray(self.modes.points[name] + seen(moved, side) - seen(stated, side))

    def deflections(self, places: Floats) -> Floats:
        """Return the upward deflection at places (P, 2), (P, modes) [kg^-1/2].

        The modes are rigid motions, if the plate has some, and those of vibration.
        """
        lighter = 1.0
        if self.setup is not None:
            # of unit modal mass, of a plate that is thicker by a part
            lighter = (1.0 + self.setup.thickness) ** -0.5
        of_modes = lighter * self._model.at(places, "upper")[0][:, :, 2].T
        if self.problem.plate.rigid is None:
            return np.asarray(of_modes)
        of_rigid = []
        for x, y in places:
            rigid = rigid_basis(self._model, ((float(x), float(y)), "upper"), {})
            if rigid is not None:
                of_rigid.append(lighter * rigid.contact)
        return np.concatenate([of_rigid, of_modes], axis=1)

    def at(self, place: Place) -> Problem:
        """Return the problem with the contact at a place."""
        if self.setup is None or self.stated is None:
            return self._touched(place)
        as_stated = self.stated._touched(place)
        on_this_plate = self.problem.on_plate(as_stated.plate, as_stated.quasi_static)
        touched = stretched(on_this_plate, self.setup, self.thickness_exponents)
        assert touched.plate.modes is not None  # as those of the plate
        modes = replace(touched.plate.modes, points=self.modes.points)
        return touched.on_plate(replace(touched.plate, modes=modes), touched.quasi_static)

    @cached_property
    def _touched(self) -> Callable[[Place], Problem]:
        """The problem with the contact at a place of the plate as the case states it.

        The last ones are kept, as plates in similar set-ups are touched at one place.
        """
        return lru_cache(maxsize=_KEPT_CONTACTS)(partial(at_place, self.case, self.problem))

    def sensors(self, names: Sequence[str]) -> list[Sensor]:
        """Return the sensors of some names."""
        by_name = {sensor.name: sensor for sensor in self.problem.sensors}
        return [by_name[name] for name in names]

    def heard(self, names: Sequence[str]) -> PlaceResponses:
        """Return the responses of some sensors."""
        unit = self.unit(names)
        return replace(unit, values=self.seen(names)[:, :, None] * unit.values)

    def seen(self, names: Sequence[str]) -> Floats:
        """Return what each rigid motion and mode does at some sensors, (modes, S)."""
        return sensor_shapes(self.problem, self.sensors(names))

    def unit(self, names: Sequence[str]) -> PlaceResponses:
        """Return the responses of some sensors at which each mode is one."""
        key = tuple(names)
        if key not in self.responses:
            self.responses[key] = unit_responses(self.problem, self.sensors(names), self.window)
        return self.responses[key]

    def detuned(self, names: Sequence[str]) -> Floats:
        """Return the derivatives of responses by the logarithms of frequencies.

        They are (modes, S, points).
        """
        return np.asarray(self.seen(names)[:, :, None] * self.unit_detuned(names))

    def unit_detuned(self, names: Sequence[str]) -> Floats:
        """Return those of `unit`; of a similar set-up, those that are known of it."""
        key = tuple(names)
        frequencies = self.modes.frequencies
        if key in self.detunings:
            known_frequencies, derivatives = self.detunings[key]
            if np.abs(frequencies / known_frequencies - 1.0).max() <= _SIMILAR:
                return derivatives
        modes = replace(self.modes, frequencies=(1.0 + _DETUNED) * frequencies)
        problem = replace(self.problem, plate=replace(self.problem.plate, modes=modes))
        higher = unit_responses(problem, self.sensors(names), self.window)
        derivatives = (higher.values - self.unit(names).values) / _DETUNED
        self.detunings[key] = frequencies, derivatives
        return derivatives


def shapes_of(problem: Problem) -> Floats:
    """Return the upward displacement of the contact point in each mode of the plate, (modes,).

    Rigid motions are the first of these modes, if the plate has some.
    """
    return np.concatenate([basis.contact for basis in bases_of_plate(problem)])


def compliances_of(problem: Problem, names: Sequence[str]) -> Floats:
    """Return the residual compliances between the contact point and sensors [m/N], (S,)."""
    assert problem.plate.modes is not None  # `plate_of` has seen to it
    directions = {sensor.name: np.asarray(sensor.components) for sensor in problem.sensors}
    residuals = problem.plate.modes.residuals
    compliances = np.zeros(len(names))
    for number, name in enumerate(names):
        if name in residuals:
            compliances[number] = residuals[name] @ directions[name]
    return compliances


def with_modes_left_out(problem: Problem) -> list[Problem]:
    r"""Return problems whose plate has an estimate of the modes left out at the contact.

    These are two: with the modes of the next octave, and with those above it. Where the modes above
    the last, at :math:`\omega_c`, are as dense as in the octave below it and move the contact as
    much, their receptance at :math:`\omega` is :math:`\int_{\omega_c}^\infty C
    \omega_c\,d\varpi/(\varpi^2 - \omega^2)`, with their static compliance C. By the rule of Gauss
    and Legendre in :math:`\xi = \omega_c/\varpi`, with nodes :math:`\xi_k` and weights
    :math:`w_k`, it is that of modes at :math:`\omega_c/\xi_k` of compliances :math:`C w_k`, those
    of the next octave with :math:`\xi_k > 1/2`. Statically nothing changes, since all compliance is
    there already.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_of` has seen to it
    last = float(modes.angular_frequencies[-1])
    in_octave = modes.angular_frequencies > 0.5 * last
    compliance = float((modes.contact[in_octave] ** 2).sum()) / (0.5 * last) / last
    # the rule on (0, 1) for an even function: the positive half of that on (-1, 1), from 1 down
    nodes, weights = np.polynomial.legendre.leggauss(2 * _LEFT_OUT)
    nodes = nodes[: _LEFT_OUT - 1 : -1]
    weights = weights[: _LEFT_OUT - 1 : -1]
    next_octave = nodes > 0.5
    return [
        _with_modes(problem, last / nodes[chosen], compliance * weights[chosen])
        for chosen in (next_octave, ~next_octave)
    ]


def _with_modes(problem: Problem, frequencies: Floats, compliances: Floats) -> Problem:
    """Return a problem whose plate has more modes at the contact.

    They have angular frequencies [rad/s] and static compliances [m/N], (n,).
    """
    modes = problem.plate.modes
    assert modes is not None
    count = len(frequencies)
    damping_ratios = np.full(count, modes.damping_ratios[-1])
    more_modes = replace(
        modes,
        frequencies=np.append(modes.frequencies, frequencies / (2.0 * np.pi)),
        damping_ratios=np.append(modes.damping_ratios, damping_ratios),
        contact=np.append(modes.contact, frequencies * np.sqrt(compliances)),
        participation=np.concatenate([modes.participation, np.zeros((count, 3))]),
        points={},
        rotation=None,
        frequency_errors=None,
        residuals={},
        along=None,
    )
    # what they add statically is in the quasi-static compliance already
    return replace(
        with_compliance(problem, -compliances.sum()),
        plate=replace(problem.plate, modes=more_modes),
        sensors=(),
    )


def with_compliance(problem: Problem, more: float) -> Problem:
    """Return a problem with more static compliance at its contact [m/N]."""
    linear = problem.quasi_static.linear + more
    return replace(problem, quasi_static=replace(problem.quasi_static, linear=linear))


def compliance_error(plate: Plate, problem: Problem) -> tuple[float, float]:
    """Return what the static compliance of the plate lacks at the contact of a problem [m/N].

    These are its mean and its standard deviation. The mesh of the plate makes it too stiff. What
    makes the frequencies too high does too: the errors of all its modes have one sign.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_of` has seen to it
    of_modes = (modes.contact / modes.angular_frequencies) ** 2
    mean_share, deviation_share = plate.lacking
    mean = float(mean_share * of_modes.sum())
    deviation = float(deviation_share * of_modes.sum())
    # the compliance of a mode goes with the inverse square of its frequency
    by_frequencies = 2.0 * float(plate.frequency_errors[-len(of_modes) :] @ of_modes)
    return mean, math.hypot(deviation, by_frequencies)


def plate_of(
    case: CaseTable,
    window: float,
    frequency_error: float = 0.0,
    progress: Callable[[float], None] | None = None,
    *,
    errors: SetupErrors | None = None,
    model_error: float = 1.0,
) -> Plate:
    """Return the plate of a case.

    Parameters
    ----------
    case : CaseTable
        The case.
    window : float
        Time from first touch on that is used [s].
    frequency_error : float, default 0
        Standard deviation of the relative error of the frequencies of the plate, beside what the
        mesh makes [-].
    progress : callable, optional
        Called with the fraction done while modes are computed.
    errors : SetupErrors, optional
        What is not certain of the case; nothing by default.
    model_error : float, default 1
        Part of the estimated errors of the mesh and of the modes left out that records have.

    Raises
    ------
    InputError
        If the plate is rigid, narrow or moves, the case has no sensors, or the sphere's own modes
        would change with its size.
    """
    check_case(case)
    _check_identifiable(case)
    problem = replace(problem_of(case, progress), impacts=1, duration=None)
    frequency_errors = _frequency_errors(problem, model_error, frequency_error)
    plate = Plate(case, problem, window, frequency_errors, errors or SetupErrors(), model_error)
    low, high = plate.bounds
    if not (low < high).all():
        raise InputError(
            f"an impact is identified {_MARGIN:g} thicknesses or more from the edge, and the plate "
            f"is at most {2.0 * _MARGIN:g} thicknesses long or wide",
            "plate",
        )
    return plate


def _check_identifiable(case: CaseTable) -> None:
    """Raise InputError unless impacts on the plate of a case can be identified."""
    if case.plate.model == "rigid":
        raise InputError(
            'the plate is rigid, so that its points do not move; give it model = "elastic"',
            "plate.model",
        )
    if case.plate.motion is not None:
        raise InputError(
            "only an impact on a plate that is at rest before it is identified; leave this out",
            "plate.motion",
        )
    if not case.sensors:
        raise InputError("the case has no sensors; say where those of the records are", "sensors")
    if isinstance(case.plate.mesh, BroughtMeshTable) and case.plate.mesh.contact:
        raise InputError(
            "an identification places the force itself, and this fixes its place; leave it out",
            "plate.mesh.contact",
        )
    if case.sphere.model == "elastic":
        raise InputError(
            'the modes of a sphere change with its size, which is sought; leave it "rigid"',
            "sphere.model",
        )
    finite_sphere = case.contact.local.finite_sphere
    if finite_sphere or treatment_of(case) == "identified":
        key = "finite_sphere" if finite_sphere else "local_compliance"
        raise InputError(
            "it changes with the size of the sphere, which is sought; leave it out",
            f"contact.{key}",
        )
    if keys := oblique_keys(case):
        raise InputError("only an impact along the normal is identified; leave this out", keys[0])


def _frequency_errors(problem: Problem, model_error: float, frequency_error: float) -> Floats:
    """Return standard deviations of the relative errors of frequencies, of rigid motions first."""
    rigid = problem.plate.rigid
    modes = problem.plate.modes
    assert modes is not None  # the plate is elastic
    rigid_count = 0 if rigid is None else len(rigid.frequencies)
    of_rigid = np.zeros(rigid_count)
    if modes.frequency_errors is None:
        of_mesh = np.zeros(len(modes.frequencies))
    else:
        of_mesh = np.nan_to_num(modes.frequency_errors)
    return np.concatenate([of_rigid, np.hypot(model_error * of_mesh, frequency_error)])
