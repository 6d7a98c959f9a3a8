"""The public names of the module, for its loader and for type checkers."""

from .files import save_charts as save_charts
from .matplotlib import matplotlib_figure as matplotlib_figure
from .notebook import plotly_figure as plotly_figure
