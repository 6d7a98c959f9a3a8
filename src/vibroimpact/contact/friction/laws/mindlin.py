"""Mindlin's stiffness as a single spring with history, as discrete-element codes have it."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.friction.law import CompliantFriction


@dataclass(frozen=True, kw_only=True)
class Mindlin(CompliantFriction):
    r"""A tangential spring of Mindlin's stiffness, whose displacement is kept as the force changes.

    .. math:: Q = 2 G^* a\, \xi,\qquad \dot\xi = \dot s,\qquad Q \le \mu F

    with a the radius of Hertz's contact under the normal force.

    Notes
    -----
    The stiffness is that of a contact without slip. As the contact shrinks, the spring gives back
    less than it was given, and the energy is lost. LAMMPS calls it `mindlin`; `mindlin-rescale` and
    `mindlin-force` are its variants.

    References
    ----------
    Mindlin, R. D. (1949). Compliance of elastic bodies in contact. J. Appl. Mech. 16, 259-268.

    Examples
    --------
    >>> Mindlin(
    ...     coefficient=0.1,
    ...     effective_modulus=60e9,
    ...     effective_shear_modulus=50e9,
    ...     effective_radius=2.5e-3,
    ... ).name
    'mindlin'
    """

    name = "mindlin"
    equation = "Q = 2 G* a xi, at most mu F"
    source = "Mindlin 1949, J. Appl. Mech. 16:259; LAMMPS, granular: mindlin"
    stretching = (1, 1)
    sliding_energy = 4.0 / 15.0


@dataclass(frozen=True, kw_only=True)
class MindlinRescale(Mindlin):
    r"""Mindlin's stiffness as a single spring, whose displacement shrinks with the contact.

    .. math::
        Q = 2 G^* a\, \xi,\qquad \dot\xi = \dot s + \xi\, \min(\dot a, 0) / a,\qquad Q \le \mu F

    Notes
    -----
    So the unloading of the normal force does not make energy (Thornton and others 2013).

    References
    ----------
    Thornton, C., Cummins, S. J. and Cleary, P. W. (2013). An investigation of the comparative
    behaviour of alternative contact force models during inelastic collisions. Powder Technol. 233,
    30-46.

    Examples
    --------
    >>> MindlinRescale(
    ...     coefficient=0.1,
    ...     effective_modulus=60e9,
    ...     effective_shear_modulus=50e9,
    ...     effective_radius=2.5e-3,
    ... ).stretching
    (1, 2)
    """

    name = "mindlin-rescale"
    equation = "Q = 2 G* a xi, xi shrinks with a, at most mu F"
    source = (
        "Thornton, Cummins & Cleary 2013, Powder Technol. 233:30; LAMMPS, granular: mindlin_rescale"
    )
    stretching = (1, 2)


@dataclass(frozen=True, kw_only=True)
class MindlinForce(Mindlin):
    r"""Mindlin's stiffness as a single spring, whose force is kept.

    .. math:: \dot Q = 2 G^* a\, \dot s,\qquad Q \le \mu F

    Notes
    -----
    This is the stiffness of the contact as long as no point of it slips.

    References
    ----------
    Mindlin, R. D. and Deresiewicz, H. (1953). Elastic spheres in contact under varying oblique
    forces. J. Appl. Mech. 20, 327-344.

    Examples
    --------
    >>> MindlinForce(
    ...     coefficient=0.1,
    ...     effective_modulus=60e9,
    ...     effective_shear_modulus=50e9,
    ...     effective_radius=2.5e-3,
    ... ).name
    'mindlin-force'
    """

    name = "mindlin-force"
    equation = "dQ = 2 G* a ds, at most mu F"
    source = "Mindlin & Deresiewicz 1953, J. Appl. Mech. 20:327; LAMMPS, granular: mindlin/force"
    stretching = (0, 0)
    sliding_energy = 0.4
