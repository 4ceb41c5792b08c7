import subprocess
import sys

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

import rockflex as rf
from builders import make_frame

# imageio-ffmpeg leaves the closing of its pipes to the interpreter, which says so.
pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")

FRAME = make_frame()
PULSE = rf.ricker_pulse(4.0, 0.6)
SMALL = {"width": 320, "frames_per_second": 10, "panels": ["rotation"]}
MARGIN = 100  # hundredths of a second for which the last frame of a GIF stays


@pytest.fixture(scope="module")
def response():
    return rf.simulate(FRAME, PULSE, "2DOF-S", free_vibration=1.0)


def gif_of(path):
    """The frames of a GIF as arrays, and their times in hundredths of a second."""
    frames, shown = [], []
    with Image.open(path) as image:
        for place in range(image.n_frames):
            image.seek(place)
            frames.append(np.asarray(image.convert("RGB")))
            shown.append(image.info["duration"] // 10)
    return frames, shown


def test_frames_and_times_of_a_gif(response, tmp_path):
    file = rf.animate(response, tmp_path / "deep" / "run.gif", **SMALL, speed=0.5, start=0.2, stop=1.2)
    frames, shown = gif_of(file)
    assert len(frames) == 21  # 1 s in 2 s at ten a second, with both ends
    assert sum(shown) == 210 + MARGIN
    assert len({frame.shape for frame in frames}) == 1
    assert frames[0].shape[1] == 320
    with Image.open(file) as image:
        assert image.info["loop"] == 0


def test_hundredths_of_a_rate_that_they_cannot_hold_add_up(response, tmp_path):
    file = rf.animate(response, tmp_path / "run.gif", width=320, frames_per_second=30, panels=["rotation"], stop=1.0)
    _, shown = gif_of(file)
    assert len(shown) == 31
    assert set(shown[:-1]) == {3, 4}
    assert abs(sum(shown) - MARGIN - 31 / 0.3) <= 0.5


@pytest.mark.slow
def test_a_gif_shows_what_an_mp4_does(response, tmp_path):
    how = {"width": 480, "frames_per_second": 10, "stop": 1.5}
    frames, _ = gif_of(rf.animate(response, tmp_path / "run.gif", **how))
    reader = imageio_ffmpeg.read_frames(str(rf.animate(response, tmp_path / "run.mp4", **how)))
    meta = next(reader)
    pictures = [np.frombuffer(data, np.uint8).reshape(*meta["size"][::-1], 3) for data in reader]
    assert meta["codec"] == "h264"
    assert meta["pix_fmt"].startswith("yuv420p")
    assert meta["fps"] == 10
    assert len(frames) == 16
    assert len(pictures) == 16 + 10  # the last one stays for a second, here too
    for frame, picture in zip(frames, pictures[:16], strict=True):
        assert np.abs(frame.astype(int) - picture.astype(int)).mean() < 4.0  # of 255: compressed, and few colours
    moved = [np.abs(a.astype(int) - frames[0].astype(int)).mean() for a in frames[1:]]
    assert min(moved) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize(("width", "wide"), [(320, 320), (481, 480)])
def test_sizes_are_even(response, tmp_path, width, wide):
    file = rf.animate(response, tmp_path / "run.mp4", width=width, frames_per_second=5, stop=0.4)
    reader = imageio_ffmpeg.read_frames(str(file))
    assert next(reader)["size"][0] == wide
    reader.close()


@pytest.mark.slow
def test_an_existing_file_is_replaced_and_nothing_else_is_left(response, tmp_path):
    file = tmp_path / "run.gif"
    file.write_bytes(b"old")
    rf.animate(response, file, **SMALL, stop=0.3)
    assert file.read_bytes()[:6] == b"GIF89a"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, ZeroDivisionError])
def test_what_stops_the_drawing_leaves_the_folder_as_it_was(response, tmp_path, suffix, error):
    file = tmp_path / f"run{suffix}"
    file.write_bytes(b"old")

    def stop(done, _):
        if done == 3:
            raise error

    with pytest.raises(error):
        rf.animate(response, file, **SMALL, progress=stop)
    assert list(tmp_path.iterdir()) == [file]
    assert file.read_bytes() == b"old"


def test_an_encoder_that_stops_short_is_an_error(response, tmp_path, monkeypatch):
    monkeypatch.setattr(imageio_ffmpeg, "count_frames_and_secs", lambda _: (2, 0.2))
    with pytest.raises(rf.InputError, match=r"Only 2 of 15 frames could be written to .*run\.mp4; is the disk full\?"):
        rf.animate(response, tmp_path / "run.mp4", **SMALL, stop=0.4)
    assert not list(tmp_path.iterdir())


def test_a_path_that_cannot_be_written(response, tmp_path):
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(rf.InputError, match=r"run\.gif cannot be written \(.*\)\. Give another path\."):
        rf.animate(response, tmp_path / "file" / "run.gif", **SMALL, stop=0.4)


def test_progress_counts_the_frames(response, tmp_path):
    told = []
    rf.animate(response, tmp_path / "run.gif", **SMALL, stop=0.5, progress=lambda *now: told.append(now))
    assert told == [(done, 6) for done in range(7)]


def test_mp4_without_the_extra_says_how_to_get_it(response, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(rf.InputError, match=r"pip install 'rockflex\[video\]'"):
        rf.animate(response, tmp_path / "run.mp4")
    assert not list(tmp_path.iterdir())


def test_peaks_alone_cannot_move(tmp_path):
    peaks = rf.simulate(FRAME, PULSE, "2DOF-S", output="peaks")
    with pytest.raises(rf.InputError, match=r'keeps peaks only.*Simulate it with output="history"'):
        rf.animate(peaks, tmp_path / "run.gif")


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"speed": 0}, "speed must be a positive, finite number in seconds of the response per second"),
        ({"speed": -1.0}, "speed must be a positive, finite number"),
        ({"speed": 1e-6}, r"3\.4 s at speed 1e-06 and 25 frames per second are 8\.5e\+07 frames, above the limit of "
         r"20000\. Raise the speed, lower frames_per_second, or give start and stop\."),
        ({"frames_per_second": 0.5}, r"frames_per_second must be from 1 to 50 for \.gif, but 0\.5 was given\. Give 25"),
        ({"frames_per_second": 60}, r"but 60 was given\. Give 25, which is smooth, or write \.mp4\."),
        ({"start": 1.0, "stop": 1.0}, r"start and stop must be times within the responses, from 0 to 3\.4 s, start "
         r"before stop, but 1 and 1 s were given\."),
        ({"start": -1.0}, "but -1 and"),
        ({"stop": 1e3}, "but 0 and 1000 s were given"),
        ({"stop": "late"}, "stop must be a finite number in s, but 'late' was given"),
        ({"amplification": 0.0}, "amplification must be a positive, finite number, but"),
        ({"amplification": 1e5}, "amplification must be from 0.01 to 10000, but 100000.0 was given. Leave it out"),
        ({"panels": ["sway"]}, "panels must be one or more of rotation, top_displacement, .* each once, but .*sway"),
        ({"labels": ["a", "b"]}, "labels must be a sequence of 1 strings, one per response, but 2 was given"),
        ({"width": 100}, "width must be a whole number from 320 to 3840, but 100 was given"),
        ({"progress": 3}, r'progress must be None, "bar" or a function of \(done, total\), but 3 was given'),
        ({"structure": [FRAME, FRAME]}, "structure must be one structure, or one for each of the 1 responses, but 2"),
        ({"structure": 3}, r"structure must be that of responses\[0\], such as a Frame, but int was given"),
        ({"structure": make_frame(aspect_ratio=3.0)}, r"structure is not that of responses\[0\]: it has .* and B = "),
    ],
)  # fmt: skip
def test_bad_arguments_are_told_and_leave_nothing(response, tmp_path, how, said):
    with pytest.raises(rf.InputError, match=said):
        rf.animate(response, tmp_path / "new" / "run.gif", **how)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "count", "said"),
    [
        *((name, 1, r"as \.gif or \.mp4, but the path .* ends in") for name in ("run.avi", "run", "run.png")),
        ("folder.gif", 1, r"folder\.gif is a folder, but a file is expected"),
        ("run.gif", 7, "shows up to 6 responses, but 7 were given"),
    ],
)
def test_other_paths_and_too_many_responses_are_refused(response, tmp_path, name, count, said):
    (tmp_path / "folder.gif").mkdir()
    with pytest.raises(rf.InputError, match=said):
        rf.animate([response] * count, tmp_path / name)


@pytest.mark.slow
def test_the_encoder_is_loaded_only_for_mp4():
    program = "import sys, rockflex as rf; rf.animate; print('imageio_ffmpeg' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
