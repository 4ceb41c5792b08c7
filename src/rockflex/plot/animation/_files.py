"""Frames as a file: GIF, or MP4."""

from collections.abc import Callable
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray
from PIL import GifImagePlugin, Image
from scipy.spatial import KDTree

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, writing_atomically
from rockflex.foundation.shown import shown
from rockflex.plot.animation._poses import FrameTiming
from rockflex.plot.animation._scene import AnimatedFigure, Picture

GIF, MP4 = ".gif", ".mp4"
LAST_FRAME = 100  # hundredths of a second for which the last frame stays: a fall must be seen before the GIF repeats
MAX_COLORS = 255  # and one that is transparent
_SAMPLES = 12  # frames from which the palette is taken
_BITS = 6  # of red, green and blue each, by which the palette is indexed
_LEVELS = (1 << _BITS) - 1
Indices = NDArray[np.uint8]
# H.264 in the format that every browser plays; the index at the front, so that it plays while it loads.
_OPTIONS = ["-crf", "20", "-preset", "veryfast", "-tune", "animation", "-movflags", "+faststart"]


def animation_path_and_suffix(path: str | Path) -> tuple[Path, str]:
    """Return the path of an animation and its suffix in small letters.

    Raises
    ------
    InputError
        If the suffix is another one, the path is that of a folder, or what writes such files is not installed.
    """
    target = checked_file_path("path", path)
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


def write_gif(target: Path, figure: AnimatedFigure, timing: FrameTiming, advance: Callable[[int], None]) -> Path:
    """Write the frames of a scene to a GIF that repeats; return its path."""
    count = timing.times.size
    palette, table = _gif_palette([figure.picture(int(each)) for each in np.linspace(0, count - 1, _SAMPLES)])
    shown_for = timing.hundredths
    shown_for[-1] += LAST_FRAME
    with writing_atomically(target) as temporary, temporary.open("wb") as file:
        before: Indices | None = None
        for place, picture in enumerate(map(figure.picture, range(count))):
            indices = table[_packed_colors(picture)]
            if before is None:
                file.writelines(GifImagePlugin.getheader(_image_of_palette(indices, palette), info={"loop": 0})[0])
            _write_changed_gif_rectangle(file, indices, before, palette, int(shown_for[place]))
            before = indices
            advance(1)
        file.write(b";")
    return target


def _gif_palette(samples: list[Picture]) -> tuple[bytes, Indices]:
    """Return the colours of some frames, and which of them is nearest to each colour of `_packed_colors`."""
    present, often = np.unique(np.concatenate([_packed_colors(each).ravel() for each in samples]), return_counts=True)
    # Letters and thin lines matter as much as the ground behind them: each colour counts by the root of its pixels.
    weighted = np.repeat(present, np.ceil(np.sqrt(often)).astype(int))
    few = Image.fromarray(_unpacked_colors(weighted)[None]).quantize(MAX_COLORS, Image.Quantize.MAXCOVERAGE, kmeans=1)
    colors = np.array(few.getpalette("RGB"), np.uint8).reshape(-1, 3)[:MAX_COLORS]
    nearest = KDTree(colors.astype(float)).query(_unpacked_colors(np.arange(1 << (3 * _BITS))).astype(float))[1]
    palette = np.zeros((MAX_COLORS + 1, 3), np.uint8)
    palette[: colors.shape[0]] = colors
    return palette.tobytes(), np.asarray(nearest, np.uint8)


def _packed_colors(picture: Picture) -> NDArray[np.uint32]:
    """Return the colours of pixels as one number each, shape (height, width)."""
    few = (picture >> (8 - _BITS)).astype(np.uint32)
    packed = (few[..., 0] << (2 * _BITS)) | (few[..., 1] << _BITS) | few[..., 2]
    return packed.astype(np.uint32, copy=False)


def _unpacked_colors(packed: NDArray[np.integer]) -> Picture:
    """Return the colours of such numbers, shape (n, 3)."""
    parts = [packed >> (2 * _BITS), (packed >> _BITS) & _LEVELS, packed & _LEVELS]
    return np.round(np.stack(parts, axis=-1) * (255.0 / _LEVELS)).astype(np.uint8)


def _image_of_palette(indices: Indices, palette: bytes) -> Image.Image:
    image = Image.fromarray(indices, "P")
    image.putpalette(palette)
    return image


def _write_changed_gif_rectangle(
    file: IO[bytes], indices: Indices, before: Indices | None, palette: bytes, hundredths: int
) -> None:
    """Write the smallest rectangle that changed, with its unchanged pixels transparent."""
    offset, part = (0, 0), indices
    if before is not None:
        differs = indices != before
        rows, columns = (np.flatnonzero(differs.any(axis=axis)) for axis in (1, 0))
        ends = (rows[0], rows[-1] + 1, columns[0], columns[-1] + 1) if rows.size else (0, 1, 0, 1)
        where = np.s_[ends[0] : ends[1], ends[2] : ends[3]]
        offset = int(ends[2]), int(ends[0])
        part = np.where(differs[where], indices[where], MAX_COLORS).astype(np.uint8)
    more = {"duration": 10 * hundredths, "disposal": 1, "transparency": MAX_COLORS, "interlace": 0}
    file.writelines(GifImagePlugin.getdata(_image_of_palette(part, palette), offset, **more))


def write_video(target: Path, figure: AnimatedFigure, timing: FrameTiming, advance: Callable[[int], None]) -> Path:
    """Write the frames of a scene to an MP4; return its path."""
    from imageio_ffmpeg import count_frames_and_secs, write_frames

    count, still = timing.times.size, round(0.01 * LAST_FRAME * timing.frames_per_second)
    with writing_atomically(target, ".mp4") as temporary:  # ffmpeg chooses the format by it
        style: dict[str, Any] = {"quality": None, "fps": timing.frames_per_second}
        frames = write_frames(
            str(temporary), figure.size, pix_fmt_in="rgb24", pix_fmt_out="yuv420p", codec="libx264",
            macro_block_size=1, output_params=_OPTIONS, ffmpeg_log_level="error", **style,
        )  # fmt: skip
        with closing(frames) as encoder:
            encoder.send(None)
            for picture in map(figure.picture, range(count)):
                encoder.send(picture)
                advance(1)
            for _ in range(still):
                encoder.send(figure.picture(count - 1))
        # A full disk shows only here: the encoder ends without an error.
        written = count_frames_and_secs(str(temporary))[0] if temporary.is_file() else 0
        if written != count + still:
            raise OSError(f"Only {written} of {count + still} frames could be written to {target}; is the disk full?")
    return target
