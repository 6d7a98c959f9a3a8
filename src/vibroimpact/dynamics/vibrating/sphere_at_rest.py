"""Whether a sphere in contact rests on bodies that vibrate, and how it and they move on then."""

from __future__ import annotations

from vibroimpact.dynamics.vibrating.carried_motion import carry
from vibroimpact.dynamics.vibrating.carried_oscillations import (
    SteadyResponse,
    carry_oscillating,
    steady_response,
)
from vibroimpact.dynamics.vibrating.contact_equilibrium import (
    ContactEquilibrium,
    near_equilibrium,
    rides_for_good,
)
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion, bring_to_rest


class Equilibria:
    """The equilibria of a drop under the laws of its contacts, of which the last one is kept.

    Parameters
    ----------
    system : LinearSystem
        The sphere and the bodies that vibrate.
    """

    def __init__(self, system: LinearSystem) -> None:
        self.system = system
        self._last: tuple[LocalContact, ContactEquilibrium, SteadyResponse | None] | None = None

    def of(self, local: LocalContact) -> tuple[ContactEquilibrium, SteadyResponse | None]:
        """Return the equilibrium of a contact, and its steady motion where the plate is shaken."""
        if self._last is None or self._last[0] is not local:
            equilibrium = ContactEquilibrium(self.system, local)
            self._last = local, equilibrium, steady_response(equilibrium)
        return self._last[1:]

    def holds(self, local: LocalContact, state: State, force: float) -> bool:
        """Whether a contact carries the weight, and its force [N] will not vanish again."""
        is_shaken = self.system.driven > 0
        if not is_shaken:
            approach = float(self.system.approach(state)[0])
            overlap = max(approach - local.release_level, 0.0)
            if not near_equilibrium(self.system, state, force, overlap):
                return False
        equilibrium, response = self.of(local)
        if not is_shaken:
            return equilibrium.linear and equilibrium.cannot_separate(state)
        if rides_for_good(equilibrium, state, force):
            return True
        return response is not None and response.carries_for_good(state, force)

    def rest_from(self, local: LocalContact, state: State, stored: float) -> RestMotion:
        """Return the small oscillations that replace the contact of a sphere that stays.

        The contact stores an energy `stored` [J].
        """
        equilibrium, response = self.of(local)
        if not self.system.driven:
            return bring_to_rest(equilibrium, state, stored)
        if response is None:
            return carry(equilibrium, state, stored)
        return carry_oscillating(response, state, stored)
