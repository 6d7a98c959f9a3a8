"""Cases for tests."""

from __future__ import annotations


def plain_case(**changes: object) -> dict:
    """A valid case as a mapping; `section__key=value` changes a key, None removes it."""
    case: dict = {
        "name": "a test",
        "sphere": {"radius": 0.025, "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": 0.5},
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
        "run": {"impacts": 3},
    }
    for path, value in changes.items():
        *parents, key = path.split("__")
        table = case
        for parent in parents:
            table = table.setdefault(parent, {})
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value
    return case
