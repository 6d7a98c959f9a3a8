"""The public names of the module, for its loader and for type checkers."""

from .identify import Identification as Identification
from .identify import identify as identify
from .identify import identify_force as identify_force
from .setup import SetupErrors as SetupErrors
