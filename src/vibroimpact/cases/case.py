"""The case: a validated case file with its conversion to a problem, and its JSON schema."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vibroimpact.cases.build import problem_of
from vibroimpact.cases.fields.contact import contact_schema
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.statement.problem import Problem


class Case(CaseTable):
    """A validated case, in SI units.

    Read one with `load_case` or `case_of`; `to_problem` states it for the simulation.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory")
    >>> case.sphere.radius, case.drop.height, case.contact.law
    (0.025, 4.0, 'lankarani-nikravesh')
    >>> case.to_problem().gravity
    9.8
    """

    def to_problem(
        self,
        progress: Callable[[float], None] | None = None,
        tell: Callable[[str], None] | None = None,
    ) -> Problem:
        """Return the problem that the case describes; modes of elastic bodies are computed, or read
        from the mode store.

        Parameters
        ----------
        progress : callable, optional
            Called with the fraction done, 0 to 1, while modes are computed.
        tell : callable, optional
            Called with a warning if the mode store is faulty.

        Raises
        ------
        InputError
            If the contact law can't be made for these two bodies, or an elastic body can't.
        """
        return problem_of(self, progress, tell)


def case_schema() -> dict[str, Any]:
    """Return the JSON schema of a case file, with every contact law and its parameters.

    Examples
    --------
    >>> sorted(case_schema()["properties"])
    ['calibrate', 'contact', 'drop', 'name', 'plate', 'run', 'schema_version', 'sensors', 'sphere',
    'sweep']
    """
    schema = Case.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["properties"]["contact"] = contact_schema()
    # their keys are those of the laws
    for name in ("ContactSection", "SpeedFunction", "SpeedTable", "FrictionTable"):
        schema["$defs"].pop(name, None)
    return schema
