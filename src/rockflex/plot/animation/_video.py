"""Frames as MP4, by the ffmpeg that imageio-ffmpeg brings along."""

from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

from rockflex._files import writing
from rockflex.plot.animation._clock import LAST, Clock
from rockflex.plot.animation._scene import Scene

# H.264 in the format that every browser plays; the index at the front, so that it plays while it loads.
_OPTIONS = ["-crf", "20", "-preset", "veryfast", "-tune", "animation", "-movflags", "+faststart"]


def write_video(target: Path, scene: Scene, clock: Clock, advance: Callable[[int], None]) -> Path:
    """Write the frames of a scene to an MP4; return its path."""
    from imageio_ffmpeg import count_frames_and_secs, write_frames

    count, still = clock.times.size, round(0.01 * LAST * clock.frames_per_second)
    with writing(target, ".mp4") as temporary:  # ffmpeg chooses the format by it
        look: dict[str, Any] = {"pix_fmt_in": "rgb24", "pix_fmt_out": "yuv420p", "codec": "libx264"}
        look |= {
            "macro_block_size": 1,
            "quality": None,
            "fps": clock.frames_per_second,
            "output_params": _OPTIONS,
            "ffmpeg_log_level": "error",
        }
        with closing(write_frames(str(temporary), scene.size, **look)) as encoder:
            encoder.send(None)
            for picture in scene.pictures(count):
                encoder.send(picture)
                advance(1)
            for _ in range(still):
                encoder.send(scene.picture(count - 1))
        # A full disk shows only here: the encoder ends without an error.
        written = count_frames_and_secs(str(temporary))[0] if temporary.is_file() else 0
        if written != count + still:
            raise OSError(f"Only {written} of {count + still} frames could be written to {target}; is the disk full?")
    return target
