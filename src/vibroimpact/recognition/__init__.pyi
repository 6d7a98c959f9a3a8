"""The public names of the module, for its loader and for type checkers."""

from .apply import Recognised as Recognised
from .apply import apply_recogniser as apply_recogniser
from .dataset_signals import load_labelled_signals as load_labelled_signals
from .labelled_signals import LabelledSignals as LabelledSignals
from .labelled_signals import SensorSignals as SensorSignals
from .recognise import Recognition as Recognition
from .recognise import recognise as recognise
from .recogniser import Recogniser as Recogniser
from .recogniser import load_recogniser as load_recogniser
