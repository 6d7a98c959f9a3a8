"""The subpackages in groups, each with its contents.

Draws the figure of docs/architecture.md.
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
from matplotlib.patches import FancyBboxPatch

import vibroimpact

PACKAGE = Path(vibroimpact.__file__).parent
FLOORS = {  # top to bottom: name of a group, its colour, its subpackages and their contents
    "commands and page": (
        "#e4e4e4",
        {"cli": "commands, help,\nexit status", "app": "the live page"},
    ),
    "tasks": (
        "#a9c4dc",
        {
            "runs": "one case: folder,\nreport, animation",
            "law_comparison": "one case with\nseveral laws",
            "calibration": "parameters from\nmeasurements",
            "studies": "many drops,\ndataset, report",
            "modes": "frequencies,\nshapes",
            "law_sheets": "sheets, curves,\npages",
            "exporting": "files for other\nprograms",
            "paper": "reproduction of\nthe paper",
        },
    ),
    "signal analysis": (
        "#c3b9dd",
        {
            "identification": "force, position, size\nand speed from records",
            "test_analysis": "tests compared with\nsimulations",
            "bayes_error": "lowest error from\nstated quantities",
            "recognition": "classifiers and their\nvalidation",
        },
    ),
    "input and output": (
        "#cfe0d1",
        {
            "cases": "the case file: sections,\nlimits, unit errors",
            "results": "the result of a run\nand its folder",
            "signals": "records, packets,\nfeatures, decays",
            "charts": "chart data, drawing in\npages and for print",
            "report": "pages, tables,\nprogress",
            "meshes": "mesh files",
            "measurements": "records and tables",
        },
    ),
    "physics": (
        "#f1d9b5",
        {
            "dynamics": "problem, simulate, response;\ncore, rigid, oblique, shaken,\nvibrating, sensors",
            "bodies": "sphere, plate",
            "structures": "meshes, supports, modes,\nreduction, store",
            "contact": "laws, pair, statics",
        },
    ),
    "base": (
        "#e6bfa8",
        {
            "materials": "library",
            "units": "reading and display",
            "files": "atomic writing,\nchecksums",
            "compiler": "scalar functions,\ncompiled code",
            "modules": "errors, arrays, ranges,\nregistry, resolved_case",
        },
    ),
}

SHOWN = {room for _, rooms in FLOORS.values() for room in rooms}
assert {place.parent.name for place in PACKAGE.glob("*/__init__.py")} <= SHOWN, (
    "a subpackage is not in the figure"
)


figure, axes = plt.subplots(figsize=(11.0, 6.2))
axes.set(xlim=(-0.17, 1.0), ylim=(0.0, len(FLOORS)))
axes.axis("off")
for number, (floor, (colour, rooms)) in enumerate(reversed(FLOORS.items())):
    axes.text(-0.165, number + 0.5, floor, va="center", fontsize=10, style="italic")
    width = 1.0 / len(rooms)
    size = 10.0 if len(rooms) < 8 else 8.5  # of names, so that the longest fits its box
    for place, (room, holds) in enumerate(rooms.items()):
        box = FancyBboxPatch(
            (place * width + 0.006, number + 0.1),
            width - 0.012,
            0.8,
            boxstyle="round,pad=0,rounding_size=0.012",
            fc=colour,
            ec="#6b6b6b",
        )
        axes.add_patch(box)
        middle = (place + 0.5) * width
        axes.text(
            middle, number + 0.66, room, ha="center", va="center", fontsize=size, weight="bold"
        )
        axes.text(middle, number + 0.36, holds, ha="center", va="center", fontsize=7.5)
figure.tight_layout(pad=0.3)
figure.savefig("architecture.png", dpi=110)
print("architecture.png")
