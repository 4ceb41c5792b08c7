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

    Missing folders are made. The file appears whole or not at all, and equal figures give equal files.

    Parameters
    ----------
    figure
        What one of the plot functions returned, or any matplotlib figure.
    path
        Where to; a file that is there is replaced.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        If the suffix is none of .png, .pdf and .svg.

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
    content = io.BytesIO()
    with styled():
        figure.savefig(content, format=suffix[1:], dpi=_DPI, metadata=_UNDATED[suffix])
    return write_whole(target, content.getvalue())
