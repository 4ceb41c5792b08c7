"""``rockflex animate``: the file that the library writes of the same runs."""

from pathlib import Path

import imageio_ffmpeg
import pytest
from PIL import Image
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app
from rockflex.plot.animation import _animate

pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")

STRUCTURE = str(Path(__file__).parents[2] / "examples" / "structure_1.toml")
SMALL = ("--width", "320", "--fps", "5", "--panels", "rotation,base_moment", "--stop", "2")


def invoke(*arguments):
    return CliRunner().invoke(app, ["animate", *map(str, arguments)], env={"COLUMNS": "200"})


@pytest.mark.slow
def test_writes_what_the_library_does(tmp_path):
    file = tmp_path / "run.gif"
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "MDOF-S,fixed", "--scale", "1.5", *SMALL, "--out", file)
    assert result.exit_code == 0, result.stderr
    assert f"Written to {file}" in result.stderr
    record = rf.load_suite("el-centro-1940")[0]
    runs = [rf.simulate(make_frame(), record.scaled(1.5), model) for model in ("MDOF-S", "fixed")]
    same = rf.animate(
        runs, tmp_path / "same.gif", width=320, frames_per_second=5, panels=["rotation", "base_moment"], stop=2.0,
        title=f"{record.name} × 1.5", structure=make_frame()
    )  # fmt: skip
    with Image.open(file) as image, Image.open(same) as other:
        assert image.n_frames == other.n_frames == 11
    assert file.read_bytes() == same.read_bytes()


def test_speed_and_times_reach_the_file(tmp_path):
    file = tmp_path / "run.mp4"
    how = ("--speed", "0.5", "--start", "1", "--amplification", "4")
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S", *SMALL, *how, "--out", file)
    assert result.exit_code == 0, result.stderr
    assert imageio_ffmpeg.count_frames_and_secs(str(file))[0] == 11 + 5  # and a second of the last one


def test_a_release_needs_no_motion(tmp_path):
    how = ("--initial-rotation", "0.03", "--free-vibration", "2")
    result = invoke(STRUCTURE, "--model", "2DOF-C", *how, *SMALL, "--out", tmp_path / "run.gif")
    assert result.exit_code == 0, result.stderr


def test_an_existing_file_needs_force(tmp_path):
    file = tmp_path / "run.gif"
    file.write_bytes(b"mine")
    command = (STRUCTURE, "el-centro-1940", "--model", "2DOF-S", *SMALL, "--out", file)
    result = invoke(*command)
    assert result.exit_code == 2
    assert f"The file {file} exists. Give another one by --out, or --force to replace it." in result.stderr
    assert file.read_bytes() == b"mine"
    assert invoke(*command, "--force").exit_code == 0
    assert file.read_bytes()[:6] == b"GIF89a"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "An animation is a file. Give its path by --out, such as --out run.gif or --out run.mp4."),
        (("--out", "run.avi"), "An animation can be written as .gif or .mp4, but the path 'run.avi' ends in '.avi'."),
        (("--out", "run.gif", "--speed", "0"), "--speed must be a positive, finite number"),
        (("--out", "run.gif", "--fps", "90"), "--fps must be from 1 to 50 for .gif, but 90.0 was given."),
        (("--out", "run.gif", "--panels", "sway"), "--panels must be one or more of rotation, top_displacement"),
        (("--out", "run.gif", "--start", "5", "--stop", "2"), "--start and stop must be times within the responses"),
        (("--out", "run.gif", "--width", "10"), "--width must be a whole number from 320 to 3840, but 10 was given."),
        (("--out", "run.gif", "--motion", "fema-p695-far-field"), "An animation shows one ground motion, but 45 were"),
    ],
)
def test_what_cannot_be_drawn_is_told(tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S", *arguments)
    assert result.exit_code == 2
    assert said in " ".join(result.stderr.split())
    assert not list(tmp_path.iterdir())


def test_a_stop_leaves_nothing(tmp_path, monkeypatch):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(_animate, "animate", stopped)
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S", "--out", tmp_path / "run.gif")
    assert result.exit_code == 130
    assert not list(tmp_path.iterdir())
