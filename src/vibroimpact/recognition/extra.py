"""The extra `ml`: what is said where it is missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from vibroimpact.errors import InputError


@contextmanager
def needs_extra() -> Iterator[None]:
    """Turn a failed import of a library of the extra into an InputError that says how to
    install it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package, _, part = (error.name or "").partition(".")
        if part:  # a package of another version is there
            raise _unloadable(error) from None
        name = {"sklearn": "scikit-learn"}.get(package, package)
        raise InputError(
            f'recognition needs {name}, which is not installed: pip install "vibroimpact[ml]"'
        ) from None
    except ImportError as error:  # versions that do not fit together
        raise _unloadable(error) from None


def _unloadable(error: ImportError) -> InputError:
    return InputError(
        f'recognition can\'t load its libraries ({error}): pip install --upgrade "vibroimpact[ml]"'
    )
