"""Record files read into a suite: what is read, what is left out, and what is said of it."""

import pytest

from rockflex._constants import GRAVITY
from rockflex._errors import InputError, RecordWarning
from rockflex.motion import read_suite

AT2 = "Some Event, 1/1/2001, Some Station, {}\nACCELERATION IN UNITS OF G\nNPTS= 3, DT= .1\n0 {} 0\n"


@pytest.fixture
def folder(tmp_path):
    """Two horizontal components, two vertical ones and two files that cannot be read."""
    folder = tmp_path / "records"
    folder.mkdir()
    for component, peak in (("000", 0.1), ("090", 0.2), ("-UP", 0.3)):
        (folder / f"RSN1_X_ABC{component}.AT2").write_text(AT2.format(component.strip("-"), peak))
    (folder / "RSN2_X_DEF-V.AT2").write_text(AT2.format("V", 0.4))
    (folder / "RSN3_X_GHI000.AT2").write_text("NPTS= 9, DT= .1\n0 1 0\n")
    (folder / "_SearchResults.csv").write_text("Result ID, Spectral Ordinate\n")
    return folder


def test_read_suite_reads_a_directory(tmp_path):
    (tmp_path / "b.csv").write_text("t,acc (g)\n0,0\n1,1\n2,0\n")
    (tmp_path / "a.AT2").write_text("NPTS= 3, DT= .1\n0 2 0\n")
    (tmp_path / "c.txt").write_text("0\n3\n0\n")
    (tmp_path / "readme.md").write_text("no record")
    suite = read_suite([tmp_path / "b.csv", tmp_path / "a.AT2"])
    assert suite.names == ("a", "b")
    assert [motion.pga for motion in suite] == [2 * GRAVITY, GRAVITY]
    with pytest.raises(InputError, match=r"c\.txt does not state the unit"):
        read_suite(tmp_path)
    (tmp_path / "c.txt").unlink()
    whole = read_suite(str(tmp_path))
    assert (whole.names, whole.name) == (("a", "b"), tmp_path.name)
    assert read_suite(iter([tmp_path / "b.csv"])).names == ("b",)


def test_read_suite_refuses(tmp_path):
    with pytest.raises(InputError, match=r"holds no record: no file ends in .at2"):
        read_suite(tmp_path)
    with pytest.raises(InputError, match=r"is not a directory. Give a directory or a list of files"):
        read_suite(tmp_path / "none")
    for folder in ("x", "y"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "a.at2").write_text("NPTS= 3, DT= .1\n0 2 0\n")
    with pytest.raises(InputError, match="need different names, but 'a' occurs"):
        read_suite([tmp_path / "x" / "a.at2", tmp_path / "y" / "a.at2"])


def test_vertical_components_are_left_out_and_named(folder):
    for file in ("RSN3_X_GHI000.AT2", "_SearchResults.csv"):
        (folder / file).unlink()
    left_out = r"^Left out: 2 vertical components, RSN1_X_ABC-UP\.AT2, RSN2_X_DEF-V\.AT2\.$"
    for paths in (folder, folder.glob("*.AT2")):
        with pytest.warns(RecordWarning, match=left_out) as caught:
            suite = read_suite(paths)
        assert suite.names == ("RSN1_X_ABC000", "RSN1_X_ABC090")
        assert [warning.filename for warning in caught] == [__file__]
    assert {motion.metadata.direction for motion in suite} == {"horizontal"}
    only = r"No horizontal component was given, only 1 vertical component: RSN2_X_DEF-V\.AT2\. Give horizontal ones; if"
    with pytest.raises(InputError, match=only):
        read_suite([folder / "RSN2_X_DEF-V.AT2"])


def test_all_files_that_cannot_be_read_are_named_at_once(folder):
    both = r"2 of 6 files cannot be read\. \S*RSN3_X_GHI000\.AT2 is truncated: .* \S*_Search\S* holds no numbers.*"
    with pytest.raises(InputError, match=both + r'on_error="skip" continues with the other files\.$'):
        read_suite(folder)
    with pytest.warns(RecordWarning) as caught:
        suite = read_suite(folder, on_error="skip")
    assert suite.names == ("RSN1_X_ABC000", "RSN1_X_ABC090")
    assert len(caught) == 2
    assert caught[0].message.args[0].startswith("Left out: 2 of 6 files cannot be read. ")
    assert caught[1].message.args[0].startswith("Left out: 2 vertical components, ")


def test_of_many_faults_the_first_are_told_and_all_files_named(tmp_path):
    for place in range(13):
        (tmp_path / f"r{place:02}.at2").write_text("no record")
    (tmp_path / "s.at2").write_text(AT2.format("90", 0.1))
    with pytest.raises(InputError) as caught:
        read_suite(tmp_path)
    text = str(caught.value)
    assert text.startswith("13 of 14 files cannot be read. ")
    assert text.count("no header line with NPTS and DT") == 10
    assert all(text.count(f"r{place:02}.at2") == 1 for place in range(13))
    assert "The others: " in text


def test_without_any_record_nothing_can_be_skipped(tmp_path):
    (tmp_path / "a.at2").write_text("no record")
    for choice in ("raise", "skip"):
        with pytest.raises(InputError, match=r"a\.at2: no header line with NPTS and DT.*read_motion instead\.$"):
            read_suite(tmp_path, on_error=choice)
    with pytest.raises(InputError, match='on_error must be "raise" or "skip", but \'warn\' was given'):
        read_suite(tmp_path, on_error="warn")
