"""The public names of the module, for its loader and for type checkers."""

from .bounces.find import Bounces as Bounces
from .bounces.find import find_bounces as find_bounces
from .decay.find import DecayMode as DecayMode
from .decay.find import modes_in_decay as modes_in_decay
from .decay.responses import modes_in_responses as modes_in_responses
from .feature_table import FeatureTable as FeatureTable
from .feature_table import feature_table as feature_table
from .frac import frac as frac
from .frequency_response import DegreeOfFreedom as DegreeOfFreedom
from .frequency_response import FrequencyResponse as FrequencyResponse
from .onset import from_onset as from_onset
from .onset import onset_time as onset_time
from .packets import Packets as Packets
from .packets import find_packets as find_packets
from .packets import packet_records as packet_records
from .reading.one_record import one_record as one_record
from .reading.record_files import load_records as load_records
from .reading.universal_responses import load_responses as load_responses
from .record import Record as Record
from .record_table import RecordTable as RecordTable
from .record_table import record_table as record_table
from .registry import find_feature as find_feature
from .registry import signal_features as signal_features
