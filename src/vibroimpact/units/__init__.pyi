"""The public names of the module, for its loader and for type checkers."""

from .reading import convert_units as convert_units
from .reading import to_si as to_si
