"""The public names of the module, for its loader and for type checkers."""

from .run_sweep import run_sweep as run_sweep
from .study import Study as Study
from .study import load_study as load_study
from .sweep import Sweep as Sweep
from .sweep_file import load_sweep as load_sweep
from .sweep_file import sweep_of as sweep_of
