"""The linear spring-dashpot (Kelvin-Voigt) model of discrete-element programs."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.arrays import Array
from vibroimpact.contact.kelvin_voigt import KelvinVoigtLaw, dashpot_for_restitution
from vibroimpact.contact.parameters import parameter
from vibroimpact.errors import InputError


@dataclass(frozen=True, kw_only=True)
class LinearSpringDashpot(KelvinVoigtLaw):
    r"""Linear spring and dashpot in parallel.

    Give either the dashpot's `damping` or the `restitution` wanted and the `effective_mass` m; then

    .. math:: c = 2 \beta \sqrt{k m},\qquad \beta = -\ln e / \sqrt{\pi^2 + \ln^2 e}

    Raises
    ------
    InputError
        Unless exactly one of `damping` and `restitution` is given, the latter with a mass.

    Notes
    -----
    The contact ends at zero overlap, and the dashpot may pull before that. Without gravity the
    restitution of an
    impact with this effective mass is the one asked for. The force jumps at first touch from zero
    to :math:`c\dot\delta_0`.

    References
    ----------
    Garg, R., Galvin, J., Li, T. and Pannala, S. (2012). Open-source MFIX-DEM software for
    gas-solids flows: Part I, verification studies. Powder Technology 220, 122-137.

    Examples
    --------
    >>> law = LinearSpringDashpot(stiffness=100.0, restitution=1.0, effective_mass=1.0)
    >>> elastic, dissipative = law.forces(0.5, 1.0, 1.0)
    >>> float(elastic), abs(float(dissipative))
    (50.0, 0.0)
    """

    name = "linear-spring-dashpot"
    equation = "F = k delta + c delta_dot"
    source = "Garg et al. 2012, Powder Technology 220:122"

    damping: Array | None = parameter(
        "dashpot c, unless a restitution is given",
        "N s/m",
        detail="Dashpot :math:`c`.",
        at_least=0,
        default=None,
    )
    restitution: Array | None = parameter(
        "restitution asked for, instead of damping",
        detail="Restitution asked for, :math:`e`.",
        example=0.7,
        above=0,
        at_most=1,
        default=None,
    )
    effective_mass: Array | None = parameter(
        "mass for which the restitution is asked",
        "kg",
        detail="Effective mass of the pair.",
        above=0,
        from_pair="effective_mass",
        default=None,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.damping is None) == (self.restitution is None):
            raise InputError(
                f"{self.name} needs either damping [N s/m] or restitution, and not both"
            )
        if self.restitution is not None and self.effective_mass is None:
            raise InputError(f"{self.name} needs effective_mass [kg] with restitution")

    @property
    def free_parameter(self) -> str:
        """The name of the parameter given, damping or restitution."""
        return "damping" if self.restitution is None else "restitution"

    @property
    def dashpot(self) -> Array:
        """The dashpot constant c [N s/m], given or computed from the restitution."""
        if self.damping is not None:
            return self.damping
        return dashpot_for_restitution(self.restitution, self.stiffness, self.effective_mass)
