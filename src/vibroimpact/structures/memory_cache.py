"""Cache of recently used objects in the memory of a process, limited in size.

Many drops on one plate share its modes and factors.
"""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock
from typing import Generic, TypeVar

Content = TypeVar("Content")


class MemoryCache(Generic[Content]):
    """Cache that removes the least recently used objects first.

    It may be used by several threads. Objects are shared and must not be changed.

    Parameters
    ----------
    capacity : float
        Largest total size [bytes]; larger objects are not kept.

    Examples
    --------
    >>> cache = MemoryCache[str](capacity=10)
    >>> cache.put("first", "a", 6)
    >>> cache.put("second", "b", 6)
    >>> cache.get("first"), cache.get("second")
    (None, 'b')
    """

    def __init__(self, capacity: float) -> None:
        self._capacity = capacity
        self._kept: OrderedDict[str, tuple[Content, float]] = OrderedDict()
        self._lock = Lock()

    def get(self, key: str) -> Content | None:
        """Return the object under a key, or None."""
        with self._lock:
            if key not in self._kept:
                return None
            self._kept.move_to_end(key)
            return self._kept[key][0]

    def put(self, key: str, content: Content, size: float) -> None:
        """Keep an object of a size [bytes] under a key."""
        with self._lock:
            self._kept[key] = content, size
            self._kept.move_to_end(key)
            while sum(size for _, size in self._kept.values()) > self._capacity:
                self._kept.popitem(last=False)

    def clear(self) -> None:
        """Remove all objects."""
        with self._lock:
            self._kept.clear()
