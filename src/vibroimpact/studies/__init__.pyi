"""The public names of the module, for its loader and for type checkers."""

from .computation.study import Study as Study
from .computation.study import load_study as load_study
from .planning.sweep import Sweep as Sweep
from .planning.sweep_file import load_sweep as load_sweep
from .planning.sweep_file import sweep_of as sweep_of
from .run_sweep import run_sweep as run_sweep
