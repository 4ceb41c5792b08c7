"""Figures of the gallery's scripts: every matplotlib figure that a block assigns to a variable."""

from typing import Any

from matplotlib.figure import Figure
from sphinx.application import Sphinx
from sphinx_gallery.scrapers import figure_rst


class Order:
    """Order of the gallery: from a first run to studies."""

    SCRIPTS = (
        "first_run",
        "records_for_a_target",
        "models_compared",
        "uplift_and_modes",
        "shenton_map",
        "chimney",
        "restrained_pier",
        "controlled_rocking",
        "hybrid_wall",
        "nine_story_frame",
        "pier_on_soil",
        "fragility_of_a_frame",
        "ida_with_resurrections",
    )

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, script: str) -> tuple[int, str]:
        """Position of a script; unlisted ones come last, by name."""
        stem = script.removesuffix(".py")
        return self.SCRIPTS.index(stem) if stem in self.SCRIPTS else len(self.SCRIPTS), stem


def scrape(block: tuple[Any, ...], block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save the figures created since the last block, and return the reST that shows them."""
    del block
    names = block_vars["example_globals"]
    shown = names.setdefault("__figures_shown__", [])
    paths = []
    for figure in [value for value in names.values() if isinstance(value, Figure)]:
        if not any(figure is other for other in shown):
            shown.append(figure)
            path = next(block_vars["image_path_iterator"])
            figure.savefig(path, dpi=150, bbox_inches="tight")
            paths.append(path)
    return figure_rst(paths, gallery_conf["src_dir"])


def setup(app: Sphinx) -> dict[str, bool]:
    """Nothing to register: the configuration names `scrape`."""
    del app
    return {"parallel_read_safe": True, "parallel_write_safe": True}
