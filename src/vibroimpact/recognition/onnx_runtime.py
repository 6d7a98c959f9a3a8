"""The one door to onnxruntime, which sends data on its use to its maker unless that is
switched off before it is loaded.
"""

from __future__ import annotations

import os
from typing import Any

from vibroimpact.recognition.extra import needs_extra

SWITCH = "ORT_DISABLE_TELEMETRY"
"""Environment variable by which onnxruntime sends nothing, and keeps no identifier of the
user and no events in the home.
"""


def silent_onnxruntime() -> Any:
    """Return the module onnxruntime, which sends nothing; every import of it is this one.

    The switch must be set before the library is loaded, since it records its start as it is loaded;
    worker processes inherit it. The call after that is for systems on which the variable is not
    heeded (Windows).

    Raises
    ------
    InputError
        If it is not installed.
    """
    os.environ[SWITCH] = "1"
    with needs_extra():
        import onnxruntime
    onnxruntime.disable_telemetry_events()
    return onnxruntime
