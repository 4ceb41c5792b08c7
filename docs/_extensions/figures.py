"""Figures of the gallery's scripts: every matplotlib figure that a block assigns to a variable, and the thumbnails."""

import io
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image, ImageOps
from sphinx.application import Sphinx
from sphinx_gallery.scrapers import figure_rst

# Scripts in the order of the gallery, each with the figure and the panel of it that answers its title.
SCRIPTS = {
    "first_run": ("moved", 0),
    "records_for_a_target": ("spectra", 0),
    "models_compared": ("history", 3),
    "uplift_and_modes": ("ratios", 0),
    "shenton_map": ("figure", 0),
    "cabinet": ("curves", 1),
    "facade": ("drawing", 0),
    "facade_with_ties": ("history", 0),
    "columns_under_a_cap": ("figure", 0),
    "podium": ("history", 0),
    "wall_of_segments": ("figure", 0),
    "chimney": ("history", 4),
    "restrained_pier": ("history", 0),
    "controlled_rocking": ("flag", 0),
    "hybrid_wall": ("flag", 0),
    "nine_story_frame": ("profiles", 0),
    "pier_on_soil": ("soil", 0),
    "settling_footing": ("figure", 0),
    "fragility_of_a_frame": ("curves", 0),
    "ida_with_resurrections": ("curves", 0),
    "how_sure": ("tornado", 0),
    "identification": ("figure", 0),
}
SIZE, DPI = (400, 280), 150  # pixels of a thumbnail, and dots an inch
PANELS = Path("gallery", "images", "panels")


class Order:
    """Order of the gallery: from a first run to studies."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, script: str) -> tuple[int, str]:
        """Position of a script; unlisted ones come last, by name."""
        stem = script.removesuffix(".py")
        return list(SCRIPTS).index(stem) if stem in SCRIPTS else len(SCRIPTS), stem


def scrape(block: tuple[Any, ...], block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save the figures created since the last block, and return the reST that shows them."""
    del block
    names = block_vars["example_globals"]
    shown = names.setdefault("__figures_shown__", [])
    stem = Path(block_vars["src_file"]).stem
    paths = []
    for name, figure in [(name, value) for name, value in names.items() if isinstance(value, Figure)]:
        if not any(figure is other for other in shown):
            shown.append(figure)
            path = next(block_vars["image_path_iterator"])
            figure.savefig(path, dpi=DPI, bbox_inches="tight")
            paths.append(path)
            if stem in SCRIPTS and SCRIPTS[stem][0] == name:
                target = Path(gallery_conf["src_dir"]) / PANELS / f"{stem}.png"
                target.parent.mkdir(parents=True, exist_ok=True)
                panel(figure, SCRIPTS[stem][1]).save(target)
    return figure_rst(paths, gallery_conf["src_dir"])


def panel(figure: Figure, place: int) -> Image.Image:
    """Return one panel of a figure, with its labels; a wide one as high as a thumbnail."""
    size, axes = figure.get_size_inches(), figure.axes[place]
    wide = axes.bbox.width / axes.bbox.height
    figure.set_size_inches(size[0], size[1] * max(0.7 * wide, 1.0))
    content = io.BytesIO()
    figure.savefig(content, dpi=DPI)
    image = Image.open(content).convert("RGB")
    zoom, edge = DPI / figure.dpi, 0.05 * DPI
    box = axes.get_tightbbox(FigureCanvasAgg(figure).get_renderer(), bbox_extra_artists=[])
    left, right, top, bottom = zoom * box.x0, zoom * box.x1, image.height - zoom * box.y1, image.height - zoom * box.y0
    figure.set_size_inches(*size)
    ends = max(left - edge, 0), max(top - edge, 0), min(right + edge, image.width), min(bottom + edge, image.height)
    return image.crop(tuple(map(int, ends)))


def write_thumbnails(app: Sphinx) -> None:
    """Put the panels in the place of the thumbnails, which show whole figures."""
    folder = Path(app.srcdir) / PANELS
    for path in folder.glob("*.png"):
        target = folder.parent / "thumb" / f"sphx_glr_{path.stem}_thumb.png"
        ImageOps.pad(Image.open(path), SIZE, color="white").save(target)


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the thumbnails after the gallery, which is made when the builder is; the configuration names `scrape`."""
    app.connect("builder-inited", write_thumbnails, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
