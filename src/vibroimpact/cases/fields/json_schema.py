"""The JSON schema of a field whose values pydantic does not check itself, made only when
the schema of a case is asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import GetJsonSchemaHandler
from pydantic_core import CoreSchema


@dataclass(frozen=True)
class JsonSchema:
    """Annotation of a field with what it is, and a function that returns the rest of its JSON
    schema.

    Making the schemas of all tables and contact laws takes longer than reading a case.
    """

    description: str
    rest: Callable[[], dict[str, Any]]

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"description": self.description, **self.rest()}
