"""The public names of the module, for its loader and for type checkers."""

from .mesh_file import load_mesh as load_mesh
from .write_abaqus import write_abaqus as write_abaqus
from .write_nastran import write_nastran as write_nastran
from .write_vtu import write_vtu as write_vtu
