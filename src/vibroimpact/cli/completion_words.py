"""What a shell completes, collected from the schema and the registries into a file: to import these
takes a second at each Tab.

`python -m vibroimpact.cli.completion_words` writes the file again, and `make docs` does; a test
finds it stale.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

from vibroimpact.cases.case import case_schema
from vibroimpact.cases.keys import quantity_keys
from vibroimpact.cli.completion import WORDS
from vibroimpact.contact.registry import contact_laws
from vibroimpact.exporting.export_format import export_formats
from vibroimpact.materials import RIGID, material_library
from vibroimpact.paper.report.outline import PARTS
from vibroimpact.signals.registry import signal_features
from vibroimpact.test_analysis.compared_kind import KINDS

Schema = Mapping[str, Any]


def completion_words() -> dict[str, Any]:
    """Return the keys of a case with the words that each takes, the laws of this package with their
    parameters, and other names.

    Examples
    --------
    >>> words = completion_words()
    >>> words["keys"]["sphere.model"], words["laws"]["newton"], words["materials"][0]
    (['rigid', 'elastic'], ['restitution'], 'rock-paper')
    """
    laws = {
        name: law
        for name, law in contact_laws().items()
        if law.__module__.startswith("vibroimpact.")
    }
    parameters = {
        name: [item.name for item in fields(law) if not item.metadata["memory"]]
        for name, law in laws.items()
    }
    materials, schema = list(material_library()), case_schema()
    keys: dict[str, list[str]] = {
        key: [] for key in quantity_keys({}) if key.count(".") == 2
    }  # such as "drop.position.x", which no schema has
    for key, words in _keys(schema, schema["$defs"]):
        keys[key] = list(dict.fromkeys([*keys.get(key, []), *words]))
    keys |= {"sphere.material": materials, "plate.material": [*materials, RIGID.name]}
    return {
        "keys": dict(sorted(keys.items())),
        "laws": parameters,
        "materials": [*materials, RIGID.name],
        "formats": list(export_formats()),
        "parts": list(PARTS),
        "features": list(signal_features()),
        "compared": list(KINDS),
    }


def _keys(
    schema: Schema, definitions: Mapping[str, Schema], prefix: str = ""
) -> Iterator[tuple[str, list[str]]]:
    """Yield each dotted key of a JSON schema, but for those of tables in lists, with the
    words that it takes.
    """
    for table in _options(schema, definitions):
        for name, inner in table.get("properties", {}).items():
            options = [
                option
                for option in _options(inner, definitions)
                if not _is_table(option, definitions)
            ]
            if options:  # a table is given by its keys
                yield f"{prefix}{name}", [word for option in options for word in _words(option)]
            yield from _keys(inner, definitions, f"{prefix}{name}.")


def _options(schema: Schema, definitions: Mapping[str, Schema]) -> Iterator[Schema]:
    """Yield the alternatives of a schema."""
    if "$ref" in schema:
        yield from _options(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    elif several := schema.get("anyOf") or schema.get("oneOf"):
        for one in several:
            yield from _options(one, definitions)
    elif schema.get("type") != "null":
        yield schema


def _is_table(schema: Schema, definitions: Mapping[str, Schema]) -> bool:
    """Return whether a schema is that of a table, or of a list of tables."""
    items = [*_options(schema["items"], definitions)] if "items" in schema else []
    return schema.get("type") == "object" or (
        bool(items) and all(_is_table(one, definitions) for one in items)
    )


def _words(schema: Schema) -> list[str]:
    """Return the words that a schema allows."""
    if schema.get("type") == "boolean":
        return ["true", "false"]
    return [
        word
        for word in (*schema.get("enum", ()), schema.get("const"))
        if isinstance(word, str) and " " not in word
    ]


if __name__ == "__main__":
    WORDS.write_text(json.dumps(completion_words(), indent=1) + "\n", encoding="utf-8")
