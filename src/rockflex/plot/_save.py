"""Figures on disk."""

import io
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from rockflex._errors import InputError
from rockflex._files import path_of, write_whole
from rockflex._shown import shown
from rockflex.plot._style import styled

# A date in the file would make equal figures differ.
_UNDATED: dict[str, dict[str, Any]] = {".png": {}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
_DPI = 200


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a figure as PNG (200 dots per inch), PDF or SVG, by the suffix of `path`.

    Missing folders are created. The file is written completely or not at all, and equal figures give equal files.

    Parameters
    ----------
    figure
        A figure of one of the plot functions, or any matplotlib figure.
    path
        Path of the file; an existing file is replaced.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        If the suffix is not .png, .pdf or .svg.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> folder = Path(tempfile.mkdtemp())
    >>> rf.save_figure(rf.plot_motion(rf.ricker_pulse(4.0, 0.6)), folder / "pulse.svg").name
    'pulse.svg'
    """
    target = path_of("path", path)
    suffix = target.suffix.lower()
    if suffix not in _UNDATED:
        raise InputError(
            f"A figure can be saved as .png, .pdf or .svg, but the path {shown(str(path))} ends in "
            f"{shown(target.suffix)}. Change the suffix."
        )
    return write_whole(target, _content(figure, suffix))


def svg_of(figure: Figure) -> str:
    """Return a figure as the text of an SVG file."""
    return _content(figure, ".svg").decode()


def _content(figure: Figure, suffix: str) -> bytes:
    content = io.BytesIO()
    with styled():
        figure.savefig(content, format=suffix[1:], dpi=_DPI, metadata=_UNDATED[suffix])
    return content.getvalue()
