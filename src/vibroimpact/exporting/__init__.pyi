"""The public names of the module, for its loader and for type checkers."""

from .export_format import export_formats as export_formats
from .export_result import export_result as export_result
