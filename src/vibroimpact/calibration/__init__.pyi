"""The public names of the module, for its loader and for type checkers."""

from .bounces.rebounds import Rebounds as Rebounds
from .bounces.rebounds import rebounds_of as rebounds_of
from .calibrate_case import calibrate_case as calibrate_case
from .calibrate_case import calibration_of as calibration_of
from .calibrate_case import load_calibration as load_calibration
from .contact_law.calibrate import calibrate as calibrate
from .contact_law.calibration import Calibration as Calibration
from .fit.tunables import law_parameter as law_parameter
from .fit.tunables import modal_damping as modal_damping
from .friction.calibrate import FrictionCalibration as FrictionCalibration
from .friction.calibrate import calibrate_friction as calibrate_friction
from .friction.measured import ObliqueImpacts as ObliqueImpacts
from .observed.observations import Observations as Observations
from .records.bounce_record import impacts_in_bounces as impacts_in_bounces
from .records.force_record import impacts_in_force as impacts_in_force
from .records.position_record import impacts_in_position as impacts_in_position
from .restitutions.restitutions import Restitutions as Restitutions
from .restitutions.restitutions import load_restitutions as load_restitutions
