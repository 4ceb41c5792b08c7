import os
import stat
import struct

import pytest
from matplotlib.figure import Figure

from rockflex._errors import InputError
from rockflex.plot import save_figure


@pytest.fixture
def figure():
    figure = Figure(figsize=(2.0, 1.5))
    figure.subplots().plot([0.0, 1.0], [1.0, 0.0])
    return figure


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.pdf", b"%PDF"), ("a.svg", b"<?xml"), ("A.PNG", b"\x89PNG")]
)
def test_the_suffix_names_the_format(figure, tmp_path, name, start):
    path = save_figure(figure, tmp_path / name)
    assert path == tmp_path / name
    assert path.read_bytes().startswith(start)
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_png_has_two_hundred_dots_an_inch(figure, tmp_path):
    content = save_figure(figure, str(tmp_path / "a.png")).read_bytes()
    assert struct.unpack(">II", content[16:24]) == (400, 300)


def test_folders_are_made(figure, tmp_path):
    assert save_figure(figure, tmp_path / "b" / "c" / "a.svg").is_file()


@pytest.mark.parametrize("name", ["a.png", "a.pdf", "a.svg"])
def test_equal_figures_give_equal_files(tmp_path, name):
    contents = set()
    for folder in ("one", "two"):
        figure = Figure(figsize=(2.0, 1.5))
        figure.subplots().plot([0.0, 1.0], [1.0, 0.0], clip_on=True)
        contents.add(save_figure(figure, tmp_path / folder / name).read_bytes())
    (content,) = contents
    assert b"CreationDate" not in content
    assert b"<dc:date>" not in content


@pytest.mark.parametrize(("name", "suffix"), [("a.jpg", ".jpg"), ("a", ""), (".png", "")])
def test_other_suffixes_are_refused(figure, tmp_path, name, suffix):
    path = tmp_path / name
    with pytest.raises(InputError) as caught:
        save_figure(figure, path)
    assert str(caught.value) == (
        f"A figure can be saved as .png, .pdf or .svg, but the path {str(path)!r} ends in {suffix!r}. "
        "Change the suffix."
    )
    assert not list(tmp_path.iterdir())


def test_a_figure_that_cannot_be_drawn_leaves_the_old_file(figure, tmp_path):
    path = save_figure(figure, tmp_path / "a.png")
    before = path.read_bytes()
    figure.axes[0].set_title("$x")
    figure.axes[0].set_xlabel(r"$\nothing$")
    with pytest.raises(ValueError, match="nothing"):
        save_figure(figure, path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_leaves_the_old_file(figure, tmp_path, monkeypatch):
    path = save_figure(figure, tmp_path / "a.png")
    before = path.read_bytes()

    def fill(_descriptor):
        message = "No space left on device"
        raise OSError(message)

    monkeypatch.setattr("os.fsync", fill)
    with pytest.raises(OSError, match="No space left"):
        save_figure(figure, path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_in_the_way_leaves_nothing_behind(figure, tmp_path):
    (tmp_path / "a.png" / "full").mkdir(parents=True)
    with pytest.raises(OSError, match=r"a\.png"):
        save_figure(figure, tmp_path / "a.png")
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.skipif(os.name == "nt", reason="file modes are POSIX")
def test_the_file_has_the_usual_mode(figure, tmp_path):
    (tmp_path / "plain").touch()
    usual = stat.S_IMODE((tmp_path / "plain").stat().st_mode)
    assert stat.S_IMODE(save_figure(figure, tmp_path / "a.png").stat().st_mode) == usual
