"""Sphinx configuration of the documentation; `make docs` builds it."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))

import rockflex  # noqa: E402

project = "rockflex"
author = "The rockflex developers"
copyright = "The rockflex developers"  # noqa: A001
version = release = rockflex.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "docstrings",
    "drawings",
    "sphinxcontrib.katex",
    "figures",
    "navigation",
    "reference",
    "signatures",
]
exclude_patterns = [
    "_build",
    "_extensions",
    "_templates",
    "joss",
    "gallery/*.py",
    "gallery/*.ipynb",
]
templates_path = ["_templates"]
nitpicky = True

# In docstrings a name in single backticks is a link where it can be one;
# see _extensions/docstrings.py.
default_role = "py:obj"

myst_enable_extensions = [
    "amsmath",
    "attrs_inline",
    "colon_fence",
    "deflist",
    "dollarmath",
]
myst_heading_anchors = 3

autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_maximum_signature_line_length = 88
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]
napoleon_use_rtype = False
napoleon_preprocess_types = False
napoleon_attr_annotations = False

# Scripts come with sphinxcontrib-katex; style and fonts of the same version
# of KaTeX are in _static: no network.
html_math_renderer = "katex"
katex_css_path = "katex/katex.min.css"
html_theme = "furo"
html_title = f"rockflex {release}"
html_static_path = ["_static"]
html_css_files = ["rockflex.css"]
html_copy_source = False

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

sphinx_gallery_conf = {
    "examples_dirs": str(HERE.parent / "examples" / "gallery"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"/[a-z]",
    "ignore_pattern": r"/_",
    "image_scrapers": ("figures.scrape",),
    "within_subsection_order": "figures.Order",
    "parallel": True,
    "backreferences_dir": "gallery/used",
    "doc_module": ("rockflex",),
    "reference_url": {"rockflex": None},
    "download_all_examples": False,
    "show_signature": False,
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "min_reported_time": 3600,
    "show_memory": False,
    "write_computation_times": False,
    "copyfile_regex": r".*\.toml",
}
suppress_warnings = ["config.cache"]
