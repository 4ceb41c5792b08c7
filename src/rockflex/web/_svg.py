"""Figures as files."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any


def svg(figure: Any) -> bytes:
    """Return a figure as SVG."""
    from rockflex.plot import save_figure

    with TemporaryDirectory() as folder:
        return save_figure(figure, Path(folder) / "figure.svg").read_bytes()
