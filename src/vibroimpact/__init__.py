"""What happens when a particle hits a plate: contact, energy and vibration.

>>> import vibroimpact as vi
>>> response = vi.simulate(vi.load_case("paper:type1-theory"))
>>> response.impacts["rebound_height_m"].round(4).tolist()
[2.4111, 1.4572, 0.8846, 0.5409, 0.3346]

Names are loaded when they are first asked for, so that `vibroimpact --help` is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from vibroimpact._version import __version__

if TYPE_CHECKING:
    from vibroimpact.bayes_error.bound import Bound as Bound
    from vibroimpact.bayes_error.bound import bound_of as bound_of
    from vibroimpact.bayes_error.observations import Channel as Channel
    from vibroimpact.bodies.body import Body as Body
    from vibroimpact.bodies.rigid_bodies import rigid_plate as rigid_plate
    from vibroimpact.bodies.rigid_bodies import rigid_sphere as rigid_sphere
    from vibroimpact.calibration.bounce_record import impacts_in_bounces as impacts_in_bounces
    from vibroimpact.calibration.bounces.rebounds import Rebounds as Rebounds
    from vibroimpact.calibration.bounces.rebounds import rebounds_of as rebounds_of
    from vibroimpact.calibration.calibrate import calibrate as calibrate
    from vibroimpact.calibration.calibrate_case import calibrate_case as calibrate_case
    from vibroimpact.calibration.calibrate_case import calibrated_case as calibrated_case
    from vibroimpact.calibration.calibrate_case import load_calibration as load_calibration
    from vibroimpact.calibration.calibrate_case import read_calibration as read_calibration
    from vibroimpact.calibration.calibration import Calibration as Calibration
    from vibroimpact.calibration.charts import calibration_charts as calibration_charts
    from vibroimpact.calibration.force_record import impacts_in_force as impacts_in_force
    from vibroimpact.calibration.friction.calibrate import (
        FrictionCalibration as FrictionCalibration,
    )
    from vibroimpact.calibration.friction.calibrate import calibrate_friction as calibrate_friction
    from vibroimpact.calibration.friction.measured import ObliqueImpacts as ObliqueImpacts
    from vibroimpact.calibration.observations import Observations as Observations
    from vibroimpact.calibration.position_record import impacts_in_position as impacts_in_position
    from vibroimpact.calibration.restitutions.restitutions import Restitutions as Restitutions
    from vibroimpact.calibration.restitutions.restitutions import (
        read_restitutions as read_restitutions,
    )
    from vibroimpact.calibration.save_calibration import save_calibration as save_calibration
    from vibroimpact.calibration.tunables import law_parameter as law_parameter
    from vibroimpact.calibration.tunables import modal_damping as modal_damping
    from vibroimpact.cases.case import Case as Case
    from vibroimpact.cases.case import case_schema as case_schema
    from vibroimpact.cases.elastic.modes import BodyModes as BodyModes
    from vibroimpact.cases.elastic.modes import compute_modes as compute_modes
    from vibroimpact.cases.reader import load_case as load_case
    from vibroimpact.cases.reader import read_case as read_case
    from vibroimpact.cases.reader import shipped_cases as shipped_cases
    from vibroimpact.cases.template import case_template as case_template
    from vibroimpact.charts.files import save_charts as save_charts
    from vibroimpact.charts.matplotlib import matplotlib_figure as matplotlib_figure
    from vibroimpact.charts.notebook import plotly_figure as plotly_figure
    from vibroimpact.contact.friction.law import FrictionLaw as FrictionLaw
    from vibroimpact.contact.law import ContactLaw as ContactLaw
    from vibroimpact.contact.quasi_static import QuasiStatic as QuasiStatic
    from vibroimpact.contact.registry import contact_laws as contact_laws
    from vibroimpact.contact.registry import find_contact_law as find_contact_law
    from vibroimpact.contact.registry import find_friction_law as find_friction_law
    from vibroimpact.contact.registry import friction_laws as friction_laws
    from vibroimpact.contact.speed_function import SpeedFunction as SpeedFunction
    from vibroimpact.contact.speed_function import SpeedTable as SpeedTable
    from vibroimpact.dynamics.air import Air as Air
    from vibroimpact.dynamics.liquid import Liquid as Liquid
    from vibroimpact.dynamics.local_element import identify_local_element as identify_local_element
    from vibroimpact.dynamics.local_element import (
        local_element_deviations as local_element_deviations,
    )
    from vibroimpact.dynamics.oblique.statement import Oblique as Oblique
    from vibroimpact.dynamics.outcome import Outcome as Outcome
    from vibroimpact.dynamics.problem import Problem as Problem
    from vibroimpact.dynamics.response import Response as Response
    from vibroimpact.dynamics.restitution import achieved_restitution as achieved_restitution
    from vibroimpact.dynamics.restitution import integrated_restitution as integrated_restitution
    from vibroimpact.dynamics.restitution import law_achieving as law_achieving
    from vibroimpact.dynamics.sensors.electronics import Amplifier as Amplifier
    from vibroimpact.dynamics.sensors.electronics import Converter as Converter
    from vibroimpact.dynamics.sensors.instruments.accelerometer import (
        Accelerometer as Accelerometer,
    )
    from vibroimpact.dynamics.sensors.instruments.force_sensor import ForceSensor as ForceSensor
    from vibroimpact.dynamics.sensors.instruments.geophone import Geophone as Geophone
    from vibroimpact.dynamics.sensors.instruments.microphone import Microphone as Microphone
    from vibroimpact.dynamics.sensors.instruments.strain_gauge import StrainGauge as StrainGauge
    from vibroimpact.dynamics.sensors.recording import Signal as Signal
    from vibroimpact.dynamics.sensors.sensor import Sensor as Sensor
    from vibroimpact.dynamics.shaken.statement import PlateMotion as PlateMotion
    from vibroimpact.dynamics.simulate import simulate as simulate
    from vibroimpact.dynamics.simulate_system import BodyMotion as BodyMotion
    from vibroimpact.dynamics.simulate_system import SystemResponse as SystemResponse
    from vibroimpact.dynamics.simulate_system import simulate_system as simulate_system
    from vibroimpact.dynamics.system import MovingBody as MovingBody
    from vibroimpact.dynamics.system import PointContact as PointContact
    from vibroimpact.dynamics.system import System as System
    from vibroimpact.dynamics.tabulate import tabulate as tabulate
    from vibroimpact.errors import ComputationError as ComputationError
    from vibroimpact.errors import InputError as InputError
    from vibroimpact.errors import VibroimpactError as VibroimpactError
    from vibroimpact.exporting.export_format import export_formats as export_formats
    from vibroimpact.exporting.export_result import export_result as export_result
    from vibroimpact.figures import save_figures as save_figures
    from vibroimpact.identification.identify import Identification as Identification
    from vibroimpact.identification.identify import identify as identify
    from vibroimpact.identification.identify import identify_force as identify_force
    from vibroimpact.identification.setup import SetupErrors as SetupErrors
    from vibroimpact.law_comparison.comparison import Comparison as Comparison
    from vibroimpact.law_comparison.comparison import compare_laws as compare_laws
    from vibroimpact.law_sheets.curves import law_chart as law_chart
    from vibroimpact.materials import Material as Material
    from vibroimpact.materials import find_material as find_material
    from vibroimpact.materials import material_library as material_library
    from vibroimpact.meshes.mesh_file import read_mesh as read_mesh
    from vibroimpact.meshes.write_abaqus import write_abaqus as write_abaqus
    from vibroimpact.meshes.write_nastran import write_nastran as write_nastran
    from vibroimpact.meshes.write_vtu import write_vtu as write_vtu
    from vibroimpact.modes.charts import mode_charts as mode_charts
    from vibroimpact.modes.folder import save_modes as save_modes
    from vibroimpact.paper.report.folder import reproduce_paper as reproduce_paper
    from vibroimpact.recognition.apply import Recognised as Recognised
    from vibroimpact.recognition.apply import apply_recogniser as apply_recogniser
    from vibroimpact.recognition.labelled_signals import LabelledSignals as LabelledSignals
    from vibroimpact.recognition.labelled_signals import SensorSignals as SensorSignals
    from vibroimpact.recognition.read_dataset import read_labelled_signals as read_labelled_signals
    from vibroimpact.recognition.recognise import Recognition as Recognition
    from vibroimpact.recognition.recognise import recognise as recognise
    from vibroimpact.recognition.recogniser import Recogniser as Recogniser
    from vibroimpact.recognition.recogniser import load_recogniser as load_recogniser
    from vibroimpact.regenerate import remake_report as remake_report
    from vibroimpact.results.folder import read_result as read_result
    from vibroimpact.results.result import Result as Result
    from vibroimpact.results.result import result_of as result_of
    from vibroimpact.runs.charts import run_charts as run_charts
    from vibroimpact.runs.notebook import plot_result as plot_result
    from vibroimpact.runs.notebook import result_html as result_html
    from vibroimpact.runs.save import save_result as save_result
    from vibroimpact.signals.bounces.find import Bounces as Bounces
    from vibroimpact.signals.bounces.find import find_bounces as find_bounces
    from vibroimpact.signals.decay.find import DecayMode as DecayMode
    from vibroimpact.signals.decay.find import modes_in_decay as modes_in_decay
    from vibroimpact.signals.decay.responses import modes_in_responses as modes_in_responses
    from vibroimpact.signals.feature_table import FeatureTable as FeatureTable
    from vibroimpact.signals.feature_table import feature_table as feature_table
    from vibroimpact.signals.frac import frac as frac
    from vibroimpact.signals.frequency_response import DegreeOfFreedom as DegreeOfFreedom
    from vibroimpact.signals.frequency_response import FrequencyResponse as FrequencyResponse
    from vibroimpact.signals.one_record import one_record as one_record
    from vibroimpact.signals.onset import from_onset as from_onset
    from vibroimpact.signals.onset import onset_time as onset_time
    from vibroimpact.signals.packets import Packets as Packets
    from vibroimpact.signals.packets import find_packets as find_packets
    from vibroimpact.signals.packets import packet_records as packet_records
    from vibroimpact.signals.read_records import read_records as read_records
    from vibroimpact.signals.reading.universal_responses import read_responses as read_responses
    from vibroimpact.signals.record import Record as Record
    from vibroimpact.signals.record_table import RecordTable as RecordTable
    from vibroimpact.signals.record_table import record_table as record_table
    from vibroimpact.signals.registry import features as features
    from vibroimpact.signals.registry import find_feature as find_feature
    from vibroimpact.structures.mesh import Mesh as Mesh
    from vibroimpact.structures.modal_model import ModalBasis as ModalBasis
    from vibroimpact.studies.read_sweep import load_sweep as load_sweep
    from vibroimpact.studies.read_sweep import read_sweep as read_sweep
    from vibroimpact.studies.report.charts import study_charts as study_charts
    from vibroimpact.studies.report.notebook import plot_study as plot_study
    from vibroimpact.studies.report.notebook import study_html as study_html
    from vibroimpact.studies.run_sweep import run_sweep as run_sweep
    from vibroimpact.studies.study import Study as Study
    from vibroimpact.studies.study import read_study as read_study
    from vibroimpact.studies.sweep import Sweep as Sweep
    from vibroimpact.test_analysis.correlate import Correlation as Correlation
    from vibroimpact.test_analysis.correlate import correlate as correlate
    from vibroimpact.test_analysis.mode_pairs import ModePair as ModePair
    from vibroimpact.test_analysis.responses.compare import (
        correlate_responses as correlate_responses,
    )
    from vibroimpact.test_analysis.responses.compare import responses_of_case as responses_of_case
    from vibroimpact.test_analysis.responses.result import (
        ResponseCorrelation as ResponseCorrelation,
    )
    from vibroimpact.units.reading import convert_units as convert_units
    from vibroimpact.units.reading import to_si as to_si

_HOME = {
    "Accelerometer": "dynamics.sensors.sensor",
    "Air": "dynamics.air",
    "Amplifier": "dynamics.sensors.electronics",
    "Body": "bodies.body",
    "BodyModes": "cases.elastic.modes",
    "BodyMotion": "dynamics.simulate_system",
    "Bounces": "signals.bounces.find",
    "Bound": "bayes_error.bound",
    "Calibration": "calibration.calibration",
    "Case": "cases.case",
    "Channel": "bayes_error.observations",
    "Comparison": "law_comparison.comparison",
    "ComputationError": "errors",
    "ContactLaw": "contact.law",
    "Converter": "dynamics.sensors.electronics",
    "Correlation": "test_analysis.correlate",
    "DecayMode": "signals.decay.find",
    "DegreeOfFreedom": "signals.frequency_response",
    "FeatureTable": "signals.feature_table",
    "ForceSensor": "dynamics.sensors.instruments.force_sensor",
    "FrequencyResponse": "signals.frequency_response",
    "FrictionCalibration": "calibration.friction.calibrate",
    "FrictionLaw": "contact.friction.law",
    "Geophone": "dynamics.sensors.instruments.geophone",
    "Identification": "identification.identify",
    "InputError": "errors",
    "LabelledSignals": "recognition.labelled_signals",
    "Liquid": "dynamics.liquid",
    "Material": "materials",
    "Mesh": "structures.mesh",
    "Microphone": "dynamics.sensors.instruments.microphone",
    "ModalBasis": "structures.modal_model",
    "ModePair": "test_analysis.mode_pairs",
    "MovingBody": "dynamics.system",
    "Oblique": "dynamics.oblique.statement",
    "ObliqueImpacts": "calibration.friction.measured",
    "Observations": "calibration.observations",
    "Outcome": "dynamics.outcome",
    "Packets": "signals.packets",
    "PlateMotion": "dynamics.shaken.statement",
    "PointContact": "dynamics.system",
    "Problem": "dynamics.problem",
    "QuasiStatic": "contact.quasi_static",
    "Rebounds": "calibration.bounces.rebounds",
    "Recognised": "recognition.apply",
    "Recogniser": "recognition.recogniser",
    "Recognition": "recognition.recognise",
    "Record": "signals.record",
    "RecordTable": "signals.record_table",
    "Response": "dynamics.response",
    "ResponseCorrelation": "test_analysis.responses.result",
    "Restitutions": "calibration.restitutions.restitutions",
    "Result": "results.result",
    "Sensor": "dynamics.sensors.sensor",
    "SensorSignals": "recognition.labelled_signals",
    "SetupErrors": "identification.setup",
    "Signal": "dynamics.sensors.recording",
    "SpeedFunction": "contact.speed_function",
    "SpeedTable": "contact.speed_function",
    "StrainGauge": "dynamics.sensors.instruments.strain_gauge",
    "Study": "studies.study",
    "Sweep": "studies.sweep",
    "System": "dynamics.system",
    "SystemResponse": "dynamics.simulate_system",
    "VibroimpactError": "errors",
    "achieved_restitution": "dynamics.restitution",
    "apply_recogniser": "recognition.apply",
    "bound_of": "bayes_error.bound",
    "calibrate": "calibration.calibrate",
    "calibrate_case": "calibration.calibrate_case",
    "calibrate_friction": "calibration.friction.calibrate",
    "calibrated_case": "calibration.calibrate_case",
    "calibration_charts": "calibration.charts",
    "case_schema": "cases.case",
    "case_template": "cases.template",
    "compare_laws": "law_comparison.comparison",
    "compute_modes": "cases.elastic.modes",
    "contact_laws": "contact.registry",
    "convert_units": "units.reading",
    "correlate": "test_analysis.correlate",
    "correlate_responses": "test_analysis.responses.compare",
    "export_formats": "exporting.export_format",
    "export_result": "exporting.export_result",
    "feature_table": "signals.feature_table",
    "features": "signals.registry",
    "find_bounces": "signals.bounces.find",
    "find_contact_law": "contact.registry",
    "find_feature": "signals.registry",
    "find_friction_law": "contact.registry",
    "find_material": "materials",
    "find_packets": "signals.packets",
    "frac": "signals.frac",
    "friction_laws": "contact.registry",
    "from_onset": "signals.onset",
    "identify": "identification.identify",
    "identify_force": "identification.identify",
    "identify_local_element": "dynamics.local_element",
    "impacts_in_bounces": "calibration.bounce_record",
    "impacts_in_force": "calibration.force_record",
    "impacts_in_position": "calibration.position_record",
    "integrated_restitution": "dynamics.restitution",
    "law_achieving": "dynamics.restitution",
    "law_chart": "law_sheets.curves",
    "law_parameter": "calibration.tunables",
    "load_calibration": "calibration.calibrate_case",
    "load_case": "cases.reader",
    "load_recogniser": "recognition.recogniser",
    "load_sweep": "studies.read_sweep",
    "local_element_deviations": "dynamics.local_element",
    "material_library": "materials",
    "matplotlib_figure": "charts.matplotlib",
    "modal_damping": "calibration.tunables",
    "mode_charts": "modes.charts",
    "modes_in_decay": "signals.decay.find",
    "modes_in_responses": "signals.decay.responses",
    "one_record": "signals.one_record",
    "onset_time": "signals.onset",
    "packet_records": "signals.packets",
    "plot_result": "runs.notebook",
    "plot_study": "studies.report.notebook",
    "plotly_figure": "charts.notebook",
    "read_calibration": "calibration.calibrate_case",
    "read_case": "cases.reader",
    "read_labelled_signals": "recognition.read_dataset",
    "read_mesh": "meshes.mesh_file",
    "read_records": "signals.read_records",
    "read_responses": "signals.reading.universal_responses",
    "read_restitutions": "calibration.restitutions.restitutions",
    "read_result": "results.folder",
    "read_study": "studies.study",
    "read_sweep": "studies.read_sweep",
    "rebounds_of": "calibration.bounces.rebounds",
    "recognise": "recognition.recognise",
    "record_table": "signals.record_table",
    "remake_report": "regenerate",
    "reproduce_paper": "paper.report.folder",
    "responses_of_case": "test_analysis.responses.compare",
    "result_html": "runs.notebook",
    "result_of": "results.result",
    "rigid_plate": "bodies.rigid_bodies",
    "rigid_sphere": "bodies.rigid_bodies",
    "run_charts": "runs.charts",
    "run_sweep": "studies.run_sweep",
    "save_calibration": "calibration.save_calibration",
    "save_charts": "charts.files",
    "save_figures": "figures",
    "save_modes": "modes.folder",
    "save_result": "runs.save",
    "shipped_cases": "cases.reader",
    "simulate": "dynamics.simulate",
    "simulate_system": "dynamics.simulate_system",
    "study_charts": "studies.report.charts",
    "study_html": "studies.report.notebook",
    "tabulate": "dynamics.tabulate",
    "to_si": "units.reading",
    "write_abaqus": "meshes.write_abaqus",
    "write_nastran": "meshes.write_nastran",
    "write_vtu": "meshes.write_vtu",
}

__all__ = [*sorted(_HOME), "__version__"]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
