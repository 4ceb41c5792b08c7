"""What the report of a run refuses, in which words, and that nothing is half written."""

import pytest

import rockflex as rf
from report_case import FRAME, PULSE, runs
from rockflex.report.run import _page


@pytest.fixture(scope="module")
def one():
    return runs(FRAME, PULSE, ["2DOF-S"])


OTHER = rf.Frame(2, 3.0, 40e3, 40e3, 1e9, period=0.6, aspect_ratio=5.0, damping_ratio=0.02)


def refused(words, responses, path, **options):
    with pytest.raises(rf.InputError) as error:
        rf.write_report(responses, path, **options)
    assert words in str(error.value)
    assert not path.is_file()


def test_responses_that_cannot_be_reported(one, tmp_path):
    path = tmp_path / "r.html"
    peaks = rf.simulate(FRAME, PULSE, "2DOF-S", output="peaks")
    refused('keeps peaks only, but a report draws the history. Simulate it with output="history".', [peaks], path)
    refused('There is no response to report. Give what simulate(..., output="history") returned', [], path)
    refused("responses must be one or several responses, but 'x' was given.", "x", path)
    refused("responses[1] must be a Response, but int was given.", [*one, 3], path)
    refused("A page has room for 6 runs, but 7 were given. Choose the models that matter", one * 7, path)
    scaled = runs(FRAME, PULSE.scaled(2.0), ["2DOF-S"])
    refused("one record at one scale, but the responses are of several scales. Write a report", one + scaled, path)
    named = runs(FRAME, rf.GroundMotion(PULSE.acceleration, PULSE.dt, name="b"), ["2DOF-S"])
    refused("the responses are of 2 records, 'Ricker", one + named, path)
    refused("A report is of one structure, but 2DOF-S was run with", one + runs(OTHER, PULSE, ["2DOF-S"]), path)
    assert list(tmp_path.iterdir()) == []


def test_a_structure_or_a_motion_of_other_runs(one, tmp_path):
    path = tmp_path / "r.html"
    refused("structure is not that of the responses: 2DOF-S was run with half_width", one, path, structure=OTHER)
    refused("structure must be a structure, such as a Frame", one, path, structure=3)
    refused("is the ground acceleration of 'Ricker", one, path, motion=rf.one_sine_pulse(1.0, 0.5))
    refused("motion must be a GroundMotion, but str was given.", one, path, motion="el-centro-1940")


def test_values_out_of_range(one, tmp_path):
    path = tmp_path / "r.html"
    refused("friction must be a friction coefficient above zero", one, path, friction=-0.1)
    refused("title must be a text, but 3 was given.", one, path, title=3)
    refused("date must be a text or a datetime.date, but 3 was given.", one, path, date=3)
    refused("The page has room for notes of 800 letters, but 900 were given. Shorten them.", one, path, notes="a" * 900)
    refused("notes must be texts, but 3 was given.", one, path, notes=[3])


def test_paths_that_are_no_page(one, tmp_path):
    refused("is a folder. Give a file in it, such as", one, tmp_path)
    refused("ends in '.pdf'. Let it end in .html", one, tmp_path / "r.pdf")
    refused("ends in ''. Let it end in .html", one, tmp_path / "r")
    (tmp_path / "file").write_text("x")
    refused("Cannot write to", one, tmp_path / "file" / "r.html")


def test_folders_are_made_and_files_replaced(one, tmp_path):
    path = tmp_path / "a" / "b" / "r.HTML"
    rf.write_report(one, path, date="1")
    first = path.read_bytes()
    rf.write_report(one, path, date="2")
    assert path.read_bytes() != first
    assert [each.name for each in path.parent.iterdir()] == ["r.HTML"]


def test_an_earlier_page_survives_an_error(one, tmp_path, monkeypatch):
    path = rf.write_report(one, tmp_path / "r.html")
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_page, "write_whole", full)
    with pytest.raises(rf.InputError, match=r"Cannot write to .*: No space left on device"):
        rf.write_report(one, path)
    assert path.read_bytes() == before
