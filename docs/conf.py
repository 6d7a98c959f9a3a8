"""The documentation site: these pages, the docstrings and the gallery, built by `make
docs-site` and read without a network.
"""

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx
from sphinx_gallery.sorting import ExplicitOrder

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))

import vibroimpact  # noqa: E402

project = "vibroimpact"
copyright = "the vibroimpact authors"
release = version = vibroimpact.__version__

extensions = [
    "myst_parser",
    "plotly_gallery",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "offline_math",
    "check_pages",
]
templates_path = ["_templates"]
exclude_patterns = ["_*", "gallery/**/*.ipynb", "gallery/**/*.py", "gallery/**/*.zip"]
nitpicky = True
default_role = "code"

# pages
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
math_numfig = False
html_math_renderer = "mathml"
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True

# reference
autodoc_typehints = "none"  # the docstrings have the types, with units and shapes
autosummary_generate = ["reference.md"]
numpydoc_show_class_members = False
# sections that are known and in order, a summary that ends in a full stop, and parameters that
# exist, in their order, with words
numpydoc_validation_checks = {
    "GL06",
    "GL07",
    "SS01",
    "SS03",
    "SS05",
    "PR02",
    "PR03",
    "PR07",
    "PR09",
    "RT03",
    "RT05",
}

# gallery: one drop and its law, vibrating bodies, sensors, estimates from records, many drops, and
# other programs
EXAMPLES = """
    drop laws_phase restitution_in_dem own_law energy tolerance air
    dent adhesion rolling oblique_measured
    plate_modes plate_thickness elastic_bodies newtons_cradle shaken_table sprung_deck
    instruments accelerometer features
    bounces_heard identify bound recognition
    sensitivity study_map
    damping_for_adams export
"""
sphinx_gallery_conf = {
    "examples_dirs": ["../examples/gallery"],
    "gallery_dirs": ["gallery"],
    # an example that is not in it is an error
    "within_subsection_order": ExplicitOrder([f"plot_{name}.py" for name in EXAMPLES.split()]),
    "image_scrapers": ("gallery_checks.scrape", "plotly_gallery.scrape"),
    "reset_modules": ("matplotlib", "gallery_checks.check_example"),
    "reset_modules_order": "both",
    "run_stale_examples": True,  # they test the library, which changes without them
    "capture_repr": ("_repr_html_", "__repr__"),
    "ignore_repr_types": "NoneType|matplotlib",
    "write_computation_times": False,
    "backreferences_dir": "gallery/used",
    "doc_module": ("vibroimpact",),
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1e9,  # times of the machine that builds say nothing to a reader
    "download_all_examples": False,
    "nested_sections": False,
    "abort_on_example_error": True,
}

# look
html_theme = "pydata_sphinx_theme"
html_title = f"vibroimpact {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_context = {"default_mode": "auto"}
html_sidebars = {"first-steps": []}  # it has no pages below it
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "navbar_end": ["versions", "theme-switcher"],
    "header_links_before_dropdown": 6,
    "navbar_align": "left",
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}


PAGES_OF_FILES = {
    "README.md#use": "use.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "CODE_OF_CONDUCT.md": "code-of-conduct.md",
    "SECURITY.md": "security.md",
}
LAWS = """
```{toctree}
:hidden:
:glob:

laws/*
```
"""


def lead_to_pages(source: list[str]) -> None:
    """Lead links to files beside this folder, and between these files, to the pages that
    include them.
    """
    for file, own in PAGES_OF_FILES.items():
        source[0] = re.sub(
            rf"\]\((?:((?:\.\./)*)\.\./)?{re.escape(file)}\)", rf"](\1{own})", source[0]
        )


def complete(app: Sphinx, page: str, source: list[str]) -> None:
    """Lead links to pages, and put the pages of the laws below their table."""
    lead_to_pages(source)
    if page == "laws":
        source[0] += LAWS


def skip_fields_of_tuples(
    app: Sphinx, what: str, name: str, member: object, skip: bool, options: object
) -> bool | None:
    """Leave out what Python says of the fields of named tuples, "Alias for field number
    0": their docstrings have them as parameters.
    """
    return True if type(member).__name__ == "_tuplegetter" else None


def setup(app: Sphinx) -> None:
    app.connect("autodoc-skip-member", skip_fields_of_tuples)
    app.connect("source-read", complete)
    app.connect("include-read", lambda app, path, page, source: lead_to_pages(source))
