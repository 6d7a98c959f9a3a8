"""The plate of a case as what lies between a force and the sensors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.stats.qmc import Halton

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import check_case, problem_of
from vibroimpact.cases.elastic.bodies import elastic_bodies
from vibroimpact.cases.elastic.coupling import at_place, treatment_of
from vibroimpact.cases.fields.elastic_body import BroughtMeshTable
from vibroimpact.cases.oblique import oblique_keys
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.place_responses import PlaceResponses, place_responses
from vibroimpact.dynamics.vibrating.bodies import bases_of_plate
from vibroimpact.errors import InputError
from vibroimpact.structures.modal_model import rigid_basis
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids
from vibroimpact.structures.static_compliance import computed_compliances

Place = tuple[float, float]
"""x and y on the plate [m]."""

_PER_WAVE = 6.0
"""Places of the grid per shortest wavelength of the modes."""
_DETUNED = 1e-5
"""Relative step of a frequency in derivatives."""
_LEFT_OUT = 16
"""Number of modes that stand for those left out: so dense that they do not swing back during a contact."""
_FINER, _PLACES, _MIDDLE = 1.5, 32, 0.6
"""How much finer a mesh is whose static compliance is compared, at how many places, over what part of the length and width of the plate."""
_MARGIN = 1.5
"""Least distance of a place from the edge, in thicknesses."""


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
    responses : dict
        Responses that were computed, by the names of sensors.
    """

    case: CaseTable
    problem: Problem
    window: float
    frequency_errors: Floats
    responses: dict[tuple[str, ...], PlaceResponses] = field(default_factory=dict)

    @property
    def half(self) -> tuple[float, float]:
        """Largest x and y of a place [m]."""
        extent, thickness = self.problem.models["plate"].mesh.extent, self.problem.models["plate"].thickness
        margin = _MARGIN * (thickness or float(extent[2]))
        return 0.5 * float(extent[0]) - margin, 0.5 * float(extent[1]) - margin

    @cached_property
    def grid(self) -> tuple[Floats, Floats, Floats]:
        """x and y of a grid of places that no mode oscillates between [m], and the deflections there, (y, x, modes)."""
        (length, width), modes = (2.0 * np.asarray(self.half)), len(self.problem.models["plate"].angular_frequencies)
        step = np.sqrt(np.pi * length * width / modes) / _PER_WAVE  # a mode has the area of its wavelength squared over pi (Weyl)
        x, y = (np.linspace(-half, half, max(5, round(2.0 * half / step) + 1)) for half in self.half)
        places = np.stack(np.meshgrid(x, y), axis=-1)
        return x, y, self.deflections(places.reshape(-1, 2)).reshape(len(y), len(x), -1)

    @cached_property
    def lacking(self) -> tuple[float, float]:
        """Mean and deviation over places of the part of its static compliance that the mesh lacks, 0 for the mesh of a file [-].

        It is what a finer mesh adds, which is most of it: near a point force the error falls with the square of the element size or faster.
        """
        recipe = elastic_bodies(self.case)["plate"].recipe
        if not isinstance(recipe.shape, PlateOfPlates | PlateOfSolids):
            return 0.0, 0.0
        finer = replace(recipe, shape=replace(recipe.shape, element_size=recipe.shape.element_size / _FINER))
        spread = _MIDDLE * np.asarray(recipe.shape.size[:2]) * (Halton(2, scramble=False).random(_PLACES + 1)[1:] - 0.5)
        places = [(x, y) for x, y in spread.tolist()]
        added = computed_compliances(finer, places) / computed_compliances(recipe, places) - 1.0
        return float(added.mean()), float(added.std())

    def deflections(self, places: Floats) -> Floats:
        """Return the upward deflection at places (P, 2) in each rigid motion and mode, (P, modes) [kg^-1/2]."""
        model = self.problem.models["plate"]
        of_modes = model.at(places, "upper")[0][:, :, 2].T
        if self.problem.plate.rigid is None:
            return np.asarray(of_modes)
        rigid = [rigid_basis(model, ((float(x), float(y)), "upper"), {}) for x, y in places]
        return np.concatenate([[one.contact for one in rigid if one is not None], of_modes], axis=1)

    def at(self, place: Place) -> Problem:
        """Return the problem with the contact at a place."""
        return at_place(self.case, self.problem, place)

    def heard(self, names: Sequence[str]) -> PlaceResponses:
        """Return the responses of some sensors."""
        return self._responses(tuple(names), self.problem, "")

    def detuned(self, names: Sequence[str]) -> Floats:
        """Return the derivatives of the responses in the logarithm of the frequency of each mode, (modes, S, points)."""
        modes = self.problem.plate.modes
        assert modes is not None  # `plate_of` has seen to it
        higher = replace(modes, frequencies=(1.0 + _DETUNED) * modes.frequencies)
        problem = replace(self.problem, plate=replace(self.problem.plate, modes=higher))
        return (self._responses(tuple(names), problem, "detuned").values - self.heard(names).values) / _DETUNED

    def _responses(self, names: tuple[str, ...], problem: Problem, what: str) -> PlaceResponses:
        """Return responses, from those that were computed if they are there."""
        key = (*names, what)
        if key not in self.responses:
            by_name = {sensor.name: sensor for sensor in problem.sensors}
            self.responses[key] = place_responses(problem, [by_name[name] for name in names], self.window)
        return self.responses[key]


def shapes_of(problem: Problem) -> Floats:
    """Return the upward displacement of the contact point of a problem in each rigid motion and mode of its plate, (modes,)."""
    return np.concatenate([basis.contact for basis in bases_of_plate(problem)])


def compliances_of(problem: Problem, names: Sequence[str]) -> Floats:
    """Return the residual compliances between the contact point of a problem and sensors [m/N], (S,)."""
    assert problem.plate.modes is not None  # `plate_of` has seen to it
    directions = {sensor.name: np.asarray(sensor.components) for sensor in problem.sensors}
    residuals = problem.plate.modes.residuals
    return np.array([residuals[name] @ directions[name] if name in residuals else 0.0 for name in names])


def with_modes_left_out(problem: Problem) -> list[Problem]:
    r"""Return problems whose plate has an estimate of the modes left out at the contact: those of the next octave, and those above it.

    Where the modes above the last, at :math:`\omega_c`, are as dense as in the octave below it and move the contact as much, their
    receptance at :math:`\omega` is :math:`\int_{\omega_c}^\infty C \omega_c\,d\varpi/(\varpi^2 - \omega^2)`, with their static compliance
    C. By the rule of Gauss and Legendre in :math:`\xi = \omega_c/\varpi`, with nodes :math:`\xi_k` and weights :math:`w_k`, it is that of
    modes at :math:`\omega_c/\xi_k` of compliances :math:`C w_k`, those of the next octave with :math:`\xi_k > 1/2`. Statically nothing
    changes, since all compliance is there already.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_of` has seen to it
    last = float(modes.angular_frequencies[-1])
    octave = modes.angular_frequencies > 0.5 * last
    compliance = float((modes.contact[octave] ** 2).sum()) / (0.5 * last) / last
    nodes, weights = (both[: _LEFT_OUT - 1 : -1] for both in np.polynomial.legendre.leggauss(2 * _LEFT_OUT))
    next_octave = nodes > 0.5
    return [_with_modes(problem, last / nodes[part], compliance * weights[part]) for part in (next_octave, ~next_octave)]


def _with_modes(problem: Problem, frequencies: Floats, compliances: Floats) -> Problem:
    """Return a problem whose plate has more modes at the contact, of angular frequencies [rad/s] and static compliances [m/N] (n,)."""
    modes = problem.plate.modes
    assert modes is not None
    number = len(frequencies)
    above = replace(
        modes,
        frequencies=np.append(modes.frequencies, frequencies / (2.0 * np.pi)),
        damping_ratios=np.append(modes.damping_ratios, np.full(number, modes.damping_ratios[-1])),
        contact=np.append(modes.contact, frequencies * np.sqrt(compliances)),
        participation=np.concatenate([modes.participation, np.zeros((number, 3))]),
        points={},
        rotation=None,
        frequency_errors=None,
        residuals={},
        along=None,
    )
    return replace(with_compliance(problem, -compliances.sum()), plate=replace(problem.plate, modes=above), sensors=())


def with_compliance(problem: Problem, more: float) -> Problem:
    """Return a problem with more static compliance at its contact [m/N]."""
    return replace(problem, quasi_static=replace(problem.quasi_static, linear=problem.quasi_static.linear + more))


def compliance_error(plate: Plate, problem: Problem) -> tuple[float, float]:
    """Return mean and standard deviation of what the static compliance of the plate lacks at the contact of a problem [m/N].

    Its mesh makes a plate too stiff. What makes the frequencies too high does too: the errors of all its modes have one sign.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_of` has seen to it
    of_modes = (modes.contact / modes.angular_frequencies) ** 2
    mean, spread = (float(part * of_modes.sum()) for part in plate.lacking)
    return mean, math.hypot(spread, 2.0 * float(plate.frequency_errors[-len(of_modes) :] @ of_modes))


def plate_of(case: CaseTable, window: float, frequency_error: float = 0.0, progress: Callable[[float], None] | None = None) -> Plate:
    """Return the plate of a case.

    Parameters
    ----------
    case : CaseTable
        The case.
    window : float
        Time from first touch on that is used [s].
    frequency_error : float, default 0
        Standard deviation of the relative error of the frequencies of the plate, beside what the mesh makes [-].
    progress : callable, optional
        Called with the fraction done while modes are computed.

    Raises
    ------
    InputError
        If the plate is rigid or moves, the case has no sensors, or the sphere's own modes would change with its size.
    """
    check_case(case)
    if case.plate.model == "rigid":
        raise InputError('the plate is rigid, so that its points do not move; give it model = "elastic"', "plate.model")
    if case.plate.motion is not None:
        raise InputError("only an impact on a plate that is at rest before it is identified; leave this out", "plate.motion")
    if not case.sensors:
        raise InputError("the case has no sensors; say where those of the records are", "sensors")
    if isinstance(case.plate.mesh, BroughtMeshTable) and case.plate.mesh.contact:
        raise InputError("the place of the force is sought, and this names one; leave it out", "plate.mesh.contact")
    if case.sphere.model == "elastic":
        raise InputError('the modes of a sphere change with its size, which is sought; leave it "rigid"', "sphere.model")
    if case.contact.local.finite_sphere or treatment_of(case) == "identified":
        key = "finite_sphere" if case.contact.local.finite_sphere else "local_compliance"
        raise InputError("it changes with the size of the sphere, which is sought; leave it out", f"contact.{key}")
    if keys := oblique_keys(case):
        raise InputError("only an impact along the normal is identified; leave this out", keys[0])
    problem = replace(problem_of(case, progress), impacts=1, duration=None)
    rigid, modes = problem.plate.rigid, problem.plate.modes
    assert modes is not None  # the plate is elastic
    of_mesh = np.zeros(len(modes.frequencies)) if modes.frequency_errors is None else np.nan_to_num(modes.frequency_errors)
    errors = np.concatenate([np.zeros(0 if rigid is None else len(rigid.frequencies)), np.hypot(of_mesh, frequency_error)])
    return Plate(case, problem, window, errors)
