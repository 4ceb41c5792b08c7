"""The file of an animation: its path, and what its suffix needs."""

from importlib.util import find_spec
from pathlib import Path

from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown

GIF, MP4 = ".gif", ".mp4"


def file_of(path: str | Path) -> tuple[Path, str]:
    """Return the path of an animation and its suffix in small letters.

    Raises
    ------
    InputError
        If the suffix is another one, the path is that of a folder, or what writes such files is not installed.
    """
    target = path_of("path", path)
    suffix = target.suffix.lower()
    if suffix not in (GIF, MP4):
        raise InputError(
            f"An animation can be written as .gif or .mp4, but the path {shown(str(path))} ends in "
            f"{shown(target.suffix)}. Change the suffix.",
            field="path",
        )
    if target.is_dir():
        raise InputError(f"{target} is a folder, but a file is expected. Give a file in it.", field="path")
    if suffix == MP4 and find_spec("imageio_ffmpeg") is None:
        raise InputError(
            "An .mp4 file needs imageio-ffmpeg, which is not installed. Install it: pip install 'rockflex[video]', or "
            "write a .gif file, which needs nothing else.",
            field="path",
        )
    return target, suffix
