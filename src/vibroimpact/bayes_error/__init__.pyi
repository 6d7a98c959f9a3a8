"""The public names of the module, for its loader and for type checkers."""

from .bound import Bound as Bound
from .bound import bound_of as bound_of
from .observations import Channel as Channel
