"""What a mesh file holds besides solid elements, and what its absence does to the body."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from vibroimpact.meshes.parsed_mesh import FLUID_ELEMENTS
from vibroimpact.quoting import quoted

_MOST_NAMES = 5


class _Effect(NamedTuple):
    """Names of cards, keywords and element types, and what leaving them out does."""

    names: re.Pattern[str]
    effect: str


def _effect(names: str, effect: str) -> _Effect:
    return _Effect(re.compile(names), effect)


_EFFECTS = (
    _effect(
        r"CONM[12]|CMASS\d|NSM\w*|\*MASS|MASS|\*ROTARY INERTIA|ROTARYI|\*NONSTRUCTURAL MASS",
        "masses are not part of the body, which is lighter without them and has higher frequencies",
    ),
    _effect(
        r"CELAS\d|CBUSH\w*|CGAP|CFAST|CWELD|CSEAM|SPRING\w*|GAP\w+|CONN\w+"
        r"|\*SPRING|\*GAP|\*CONNECTOR \w+",
        "springs and connectors are not part of the body, whose frequencies are lower "
        "without their stiffness",
    ),
    _effect(
        r"CDAMP\d|CVISC|DASHPOT\w*|\*DASHPOT",
        "dampers are not part of the body, which rings for longer without them",
    ),
    _effect(
        r"RBE[123]|RBAR\w*|RROD|RTRPLT\w*|RSPLINE|RSSCON|MPC\w*|\*EQUATION|\*MPC|\*TIE( of "
        r"cyclic symmetry)?|\*COUPLING|\*KINEMATIC|\*DISTRIBUTING\w*( COUPLING)?"
        r"|\*RIGID BODY|\*KINEMATIC COUPLING|\*SHELL TO SOLID COUPLING|\*CYCLIC SYMMETRY "
        r"MODEL|\*PRE-TENSION SECTION|\*EMBEDDED ELEMENT",
        "constraints of nodes are not applied: what they hold or tie together moves freely",
    ),
    _effect(
        r"BCTABLE|BCTSET|BCTADD|BCONP|BGSET|BGADD|BSURF|BSURFS|BLSEG|\*CONTACT "
        r"PAIR|\*CONTACT( \w+)?",
        "surfaces that touch one another do not press on one another",
    ),
    _effect(
        r"CBAR|CBEAM\w?|CBEND|CROD|CONROD|CTUBE|CQUAD\w*|CTRIA\w*|CSHEAR|CRAC\w+|CTRAX\w*|B\d\w*|T[23]D\d\w*|(DS|S|STRI|M3D|PIPE|ELBOW|U)\d\w*|SFM3D\d\w*",
        "elements other than solids in three dimensions are not part of the body, which "
        "lacks their stiffness and mass",
    ),
    _effect(
        rf"{FLUID_ELEMENTS}|CHACAB|CHACBR|CAABSF|CACINF\d|AC\w+|F3D\w+",
        "the fluid is not part of the body, which has higher frequencies without its mass",
    ),
    _effect(r"DC\w+", "elements of heat conduction have no stiffness"),
    _effect(
        r"SPC\w*|PS of GRID|SUPORT\d?|\*BOUNDARY",
        "supports of the file are not used: the body has the supports of the case",
    ),
)


def remarks_of(counts: Mapping[str, int]) -> tuple[str, ...]:
    """Return what is left out of a mesh and what that does to the body.

    There is one sentence per effect, without a full stop.

    Parameters
    ----------
    counts : mapping of str to int
        Cards, keywords and element types that are not in the mesh, and how many of each.

    Examples
    --------
    >>> remarks_of({"CONM2": 3, "FORCE": 2})
    ('left out of the mesh file: CONM2 (3); masses are not part of the body, which is lighter
    without them and has higher frequencies',)
    """
    remarks = []
    for names, effect in _EFFECTS:
        items = [
            f"{quoted(name)[1:-1]} ({count})"
            for name, count in counts.items()
            if names.fullmatch(name)
        ]
        if items:
            listed = ", ".join(items[:_MOST_NAMES])
            if len(items) > _MOST_NAMES:
                listed += f" and {len(items) - _MOST_NAMES} more kinds"
            remarks.append(f"left out of the mesh file: {listed}; {effect}")
    return tuple(remarks)
