"""The laws of contacts as the core wrote them, made into contacts where these are asked for."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.core.contact_records import OF_IMPACT, Parts
from vibroimpact.dynamics.core.system_records import SystemParts
from vibroimpact.dynamics.motion.collocation import Rule
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.local import LocalContact


@dataclass(eq=False, kw_only=True)
class RecordedLaws(ABC):
    """The laws of a motion, each another one with a memory of its own, or as it is stated."""

    _locals: dict[int, LocalContact] = field(default_factory=dict)

    @property
    @abstractmethod
    def _written(self) -> Parts | SystemParts:
        """What the core wrote."""

    @abstractmethod
    def _stated_law(self, law: int) -> CompliantLaw:
        """Return the law as it is stated, by the number of one that it was at first."""

    @abstractmethod
    def _series(self, law: int) -> QuasiStatic:
        """Return the compliance in series with a law."""

    def local(self, law: int) -> LocalContact:
        """Return the contact under a law, by its number."""
        if law not in self._locals:
            self._locals[law] = self._made_local(law)
        return self._locals[law]

    def _made_local(self, law: int) -> LocalContact:
        written = self._written
        origin = int(written.origin[law])
        compressed = float(written.compressed[law])
        if not np.isnan(compressed):
            return self.local(origin).after_indentation(compressed)
        if origin == OF_IMPACT:
            acting = self._stated_law(law)
        else:  # that has gone on from another one
            local = self.local(origin)
            acting = local.law
        return LocalContact(acting, self._series(law), float(written.closing_speed[law]))

    def _history(self, row: int, contact: int, rule: Rule) -> ContactHistory:
        """Return the history of a contact in a stretch, from its row; `contact`: its number."""
        written = self._written
        static = written.static[row]
        return ContactHistory(
            number=contact,
            local=self.local(int(written.law[row])),
            rule=rule,
            static=static,
            dissipative=written.force[row] - static,
            approach=written.approach[row],
            rate=written.rate[row],
            closing=written.closing[row],
            delta=written.delta[row],
            work=float(written.work[row]),
            dissipated=float(written.dissipated[row]),
            separation_loss=float(written.separation_loss[row]),
        )
