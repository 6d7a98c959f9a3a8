"""The registry of friction laws: those of this package, and those of other packages by their entry
points.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.registry import find_law, registered_laws


@cache
def friction_laws() -> Mapping[str, type[FrictionLaw]]:
    """Return all friction laws by name.

    They are those of this package and of the entry points "vibroimpact.friction_laws".

    Raises
    ------
    InputError
        If two laws have the same name, or an entry point can't be loaded or is not a friction law.

    Examples
    --------
    >>> "mdr" in friction_laws()
    True
    """
    return registered_laws(
        "friction law",
        FrictionLaw,
        "vibroimpact.contact.friction.laws",
        "vibroimpact.friction_laws",
    )


def find_friction_law(name: str) -> type[FrictionLaw]:
    """Return the friction law with a name.

    Raises
    ------
    InputError
        If there is none; the message names the closest.

    Examples
    --------
    >>> find_friction_law("mdr").__name__
    'MDR'
    """
    return find_law("friction law", name, friction_laws())
