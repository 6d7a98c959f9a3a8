"""What a process made last, kept in its memory up to a number of bytes: many drops on one plate ask for the same again and again."""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock
from typing import Generic, TypeVar

Content = TypeVar("Content")


class Recent(Generic[Content]):
    """Contents under their keys; those that were not used for longest go first.

    What is found is shared: it must not be changed. Threads may ask at once.

    Parameters
    ----------
    most : float
        How many bytes it keeps, at most; what is larger than that is not kept.

    Examples
    --------
    >>> recent = Recent[str](most=10)
    >>> recent.keep("first", "a", 6)
    >>> recent.keep("second", "b", 6)
    >>> recent.find("first"), recent.find("second")
    (None, 'b')
    """

    def __init__(self, most: float) -> None:
        self._most = most
        self._kept: OrderedDict[str, tuple[Content, float]] = OrderedDict()
        self._lock = Lock()

    def find(self, key: str) -> Content | None:
        """Return what is kept under a key, or None."""
        with self._lock:
            if key not in self._kept:
                return None
            self._kept.move_to_end(key)
            return self._kept[key][0]

    def keep(self, key: str, content: Content, size: float) -> None:
        """Keep what takes so many bytes under a key."""
        with self._lock:
            self._kept[key] = content, size
            self._kept.move_to_end(key)
            while sum(size for _, size in self._kept.values()) > self._most:
                self._kept.popitem(last=False)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._kept.clear()
