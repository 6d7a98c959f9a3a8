"""The public names of the module, for its loader and for type checkers."""

from .correlate import Correlation as Correlation
from .correlate import correlate as correlate
from .mode_pairs import ModePair as ModePair
from .responses.compare import correlate_responses as correlate_responses
from .responses.compare import responses_of_case as responses_of_case
from .responses.result import ResponseCorrelation as ResponseCorrelation
