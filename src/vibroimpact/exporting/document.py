"""What `export --json` prints: the formats, or what was written in one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, export_formats


def formats_document() -> dict[str, Any]:
    """Return the export formats by name: the programs that read one, its files, and what
    its writer was tested against.
    """
    return {
        "formats": {
            name: {
                "program": export_format.program,
                "files": export_format.files,
                "tested": export_format.tested,
            }
            for name, export_format in export_formats().items()
        }
    }


def export_document(drop: Drop, format: ExportFormat, files: Sequence[Path]) -> dict[str, Any]:
    """Return the files written, the limitations of the format for this drop, the doubts
    about it, the tests of the writer, a dialog, and tables of what is typed.
    """
    document: dict[str, Any] = {
        "format": format.name,
        "files": [str(file) for file in files],
        "notes": format.notes(drop),
    }
    document |= {"doubts": list(drop.doubts), "tested": format.tested}
    if dialog := format.dialog(drop):
        document["adams_dialog"] = dialog
    if tables := format.rows(drop):
        document["tables"] = tables
    return document
