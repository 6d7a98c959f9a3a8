"""A case: what its file says, and the problem that it states."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vibroimpact.cases.build import problem_of
from vibroimpact.cases.fields.contact import contact_schema
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem


class Case(CaseTable):
    """A case: the file, validated, in SI.

    Read one with `load_case` or `read_case`; `to_problem` states it for the simulation.
    """

    def to_problem(self, progress: Callable[[float], None] | None = None, tell: Callable[[str], None] | None = None) -> Problem:
        """Return the problem that the case states; modes of elastic bodies are computed, or fetched from the store.

        Parameters
        ----------
        progress : callable, optional
            Called with a number from 0 to 1 while modes are computed.
        tell : callable, optional
            Called with a sentence if something is wrong with the store.

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
    ['calibrate', 'contact', 'drop', 'name', 'plate', 'run', 'schema_version', 'sensors', 'sphere', 'sweep']
    """
    schema = Case.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["properties"]["contact"] = contact_schema()
    schema["$defs"].pop("ContactSection", None)
    return schema
