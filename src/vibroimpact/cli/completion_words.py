"""What a shell completes, collected from the schema and the registries into a file.

To import these would take a second at each Tab.
`python -m vibroimpact.cli.completion_words` writes the file again, and `make docs` does; a test
finds it stale.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

from vibroimpact.cases.case import case_schema
from vibroimpact.cases.sections.keys import quantity_keys
from vibroimpact.cli.completion import WORDS
from vibroimpact.contact.registry import contact_laws
from vibroimpact.exporting.export_format import export_formats
from vibroimpact.materials import RIGID, material_library
from vibroimpact.paper.report.outline import PARTS
from vibroimpact.signals.registry import signal_features
from vibroimpact.test_analysis.compared_kind import KINDS

Schema = Mapping[str, Any]


def completion_words() -> dict[str, Any]:
    """Return keys of a case with the words that they take, laws with their parameters, and names.

    Examples
    --------
    >>> words = completion_words()
    >>> words["keys"]["sphere.model"], words["laws"]["newton"], words["materials"][0]
    (['rigid', 'elastic'], ['restitution'], 'rock-paper')
    """
    materials = list(material_library())
    return {
        "keys": _keys_of_case(materials),
        "laws": _parameters_of_laws(),
        "materials": [*materials, RIGID.name],
        "formats": list(export_formats()),
        "parts": list(PARTS),
        "features": list(signal_features()),
        "compared": list(KINDS),
    }


def _parameters_of_laws() -> dict[str, list[str]]:
    """Return the parameters of the laws of this package."""
    return {
        name: [field.name for field in fields(law) if not field.metadata["memory"]]
        for name, law in contact_laws().items()
        if law.__module__.startswith("vibroimpact.")
    }


def _keys_of_case(materials: list[str]) -> dict[str, list[str]]:
    schema = case_schema()
    # such as "drop.position.x", which no schema has
    keys: dict[str, list[str]] = {key: [] for key in quantity_keys({}) if key.count(".") == 2}
    for key, phrase in _keys(schema, schema["$defs"]):
        keys[key] = list(dict.fromkeys([*keys.get(key, []), *phrase]))
    keys["sphere.material"] = materials
    keys["plate.material"] = [*materials, RIGID.name]
    return dict(sorted(keys.items()))


def _keys(
    schema: Schema, definitions: Mapping[str, Schema], prefix: str = ""
) -> Iterator[tuple[str, list[str]]]:
    """Yield the dotted keys of a JSON schema with the words that each takes.

    Keys of tables in lists are left out.
    """
    for table in _alternatives(schema, definitions):
        for name, value in table.get("properties", {}).items():
            # a table is given by its keys
            scalars = [
                alternative
                for alternative in _alternatives(value, definitions)
                if not _is_table(alternative, definitions)
            ]
            if scalars:
                yield f"{prefix}{name}", [word for scalar in scalars for word in _words(scalar)]
            yield from _keys(value, definitions, f"{prefix}{name}.")


def _alternatives(schema: Schema, definitions: Mapping[str, Schema]) -> Iterator[Schema]:
    if "$ref" in schema:
        yield from _alternatives(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    elif alternatives := schema.get("anyOf") or schema.get("oneOf"):
        for alternative in alternatives:
            yield from _alternatives(alternative, definitions)
    elif schema.get("type") != "null":
        yield schema


def _is_table(schema: Schema, definitions: Mapping[str, Schema]) -> bool:
    """Return whether a schema is that of a table, or of a list of tables."""
    if schema.get("type") == "object":
        return True
    if "items" not in schema:
        return False
    items = list(_alternatives(schema["items"], definitions))
    return bool(items) and all(_is_table(item, definitions) for item in items)


def _words(schema: Schema) -> list[str]:
    """Return the words that a schema allows."""
    if schema.get("type") == "boolean":
        return ["true", "false"]
    values = (*schema.get("enum", ()), schema.get("const"))
    return [value for value in values if isinstance(value, str) and " " not in value]


if __name__ == "__main__":
    WORDS.write_text(json.dumps(completion_words(), indent=1) + "\n", encoding="utf-8")
