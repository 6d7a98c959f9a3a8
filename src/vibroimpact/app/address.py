"""The address of the live page, which carries the case after its "#"."""

from __future__ import annotations

import json
import zlib
from base64 import urlsafe_b64encode
from typing import Any


def fragment_of(table: dict[str, Any]) -> str:
    """Return the fragment of an address that carries a case, so that a link reproduces it.

    It is the table of the case as JSON, compressed, in the letters of an address.

    Parameters
    ----------
    table : dict
        The case, with the structure of a TOML case file.

    Examples
    --------
    >>> from base64 import urlsafe_b64decode
    >>> carried = fragment_of({"name": "a"}).removeprefix("#case=")
    >>> zlib.decompress(urlsafe_b64decode(carried + "=="))
    b'{"name":"a"}'
    """
    text = json.dumps(table, separators=(",", ":"), default=str, ensure_ascii=False)
    letters = urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode()
    return f"#case={letters.rstrip('=')}"
