"""Hunt and Crossley's law: hysteretic damping."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from vibroimpact.arrays import Array
from vibroimpact.contact.hysteretic import HystereticLaw
from vibroimpact.contact.parameters import parameter
from vibroimpact.errors import InputError


@dataclass(frozen=True, kw_only=True)
class HuntCrossley(HystereticLaw):
    r"""Hertz's force with hysteretic damping (Hunt and Crossley 1975).

    Give either the `restitution` e or the `dissipation` d:

    .. math:: F = K \delta^n \left[1 + \tfrac32 (1 - e)\, \dot\delta / \dot\delta_0\right]

    .. math:: F = K \delta^n (1 + d\, \dot\delta)

    with :math:`\dot\delta_0` the closing speed at touch; each further contact of an impact has its
    own.

    Raises
    ------
    InputError
        Unless exactly one of `restitution` and `dissipation` is given.

    Notes
    -----
    The relation with e is for e near 1. For e < 1 the restitution achieved is larger than the one
    asked for: 0.7 gives 0.768, and no value gives less than 0.487. With a dissipation the
    restitution falls with the approach speed v, and tends
    to :math:`1 - \alpha v` with :math:`\alpha = \tfrac23 d` at low speeds. In Hunt and Crossley's
    notation
    :math:`d = \lambda / k`.

    References
    ----------
    Hunt, K. H. and Crossley, F. R. E. (1975). Coefficient of restitution interpreted as damping in
    vibroimpact. J. Appl. Mech. 42, 440-445.

    Examples
    --------
    >>> law = HuntCrossley(stiffness=2.0, restitution=0.5)
    >>> elastic, dissipative = law.forces(4.0, 1.0, 1.0)
    >>> float(elastic), round(float(dissipative), 6)
    (16.0, 12.0)
    >>> law = HuntCrossley(stiffness=2.0, dissipation=0.5)
    >>> [
    ...     round(float(law.closed_form_restitution(mass=1.0, speed=speed)), 4)
    ...     for speed in (0.01, 1.0, 2.0)
    ... ]
    [0.9967, 0.7484, 0.5936]
    """

    name = "hunt-crossley"
    equation = "F = K delta^n [1 + 3/2 (1 - e) delta_dot / v0], or K delta^n [1 + d delta_dot]"
    source = "Hunt & Crossley 1975, J. Appl. Mech. 42:440"

    restitution: Array | None = parameter(
        "restitution asked for, e, unless a dissipation is given",
        detail="Restitution asked for, :math:`e`.",
        example=0.7,
        at_least=0,
        at_most=1,
        default=None,
    )
    dissipation: Array | None = parameter(
        "dissipation d, instead of restitution",
        "s/m",
        detail="Dissipation :math:`d`.",
        at_least=0,
        default=None,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.restitution is None) == (self.dissipation is None):
            raise InputError(
                f"{self.name} needs either restitution or dissipation [s/m], and not both"
            )

    @property
    def free_parameter(self) -> str:
        """The name of the parameter given, dissipation or restitution."""
        return "dissipation" if self.restitution is None else "restitution"

    @property
    def damping_factor(self) -> Array:
        """The damping factor D(e) [-].

        Raises
        ------
        InputError
            If a dissipation is given, with which it depends on the approach speed.
        """
        if self.restitution is None:
            raise InputError(
                "with a dissipation the damping factor depends on the approach speed; take "
                "damping_factor_at"
            )
        return 1.5 * (1.0 - self.restitution)

    def damping_factor_at(self, approach_speed: Array) -> Array:
        """Return the damping factor of an impact [-]: D(e), or the dissipation times the
        approach speed [m/s].
        """
        if self.dissipation is None:
            return self.damping_factor
        return self.dissipation * approach_speed

    @cached_property
    def coefficients(self) -> tuple[Array, ...]:
        """Stiffness, exponent, damping factor and dissipation, one of which is zero."""
        if self.dissipation is None:
            return super().coefficients
        return self.stiffness, self.exponent, 0.0, self.dissipation
