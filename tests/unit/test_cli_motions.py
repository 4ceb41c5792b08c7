"""Ground motions by name and path."""

import hashlib

import numpy as np
import pytest

from rockflex import InputError, RecordWarning, load_suite, read_motion
from rockflex.cli._find_motions import embedded_suites, find_motions

ACCELERATION = 0.1 * np.sin(np.arange(50))


@pytest.fixture
def record(tmp_path):
    path = tmp_path / "record.csv"
    np.savetxt(path, ACCELERATION)
    return path


def names(found):
    return [item.motion.name for item in found]


def test_suites_records_and_files_in_order(record):
    found = find_motions(["fema-p695-far-field/FF-12-a", "el-centro-1940", str(record)], "g", 0.01)
    assert names(found) == ["FF-12-a", "EL-CENTRO-1940-NS", "record"]
    assert [item.origin for item in found] == ["fema-p695-far-field", "el-centro-1940", str(record)]
    np.testing.assert_allclose(found[2].motion.acceleration, 9.81 * ACCELERATION, rtol=1e-15)
    assert found[2].motion.dt == 0.01


def test_whole_suite():
    assert names(find_motions(["fema-p695-near-field-pulse"])) == list(load_suite("fema-p695-near-field-pulse").names)


def test_directory(tmp_path):
    for name, factor in (("b", 1.0), ("a", 2.0)):
        np.savetxt(tmp_path / f"{name}.txt", np.column_stack((0.02 * np.arange(50), factor * ACCELERATION)))
    assert names(find_motions([str(tmp_path)], units="m/s2")) == ["a", "b"]


def test_named_twice_is_taken_once():
    assert names(find_motions(["el-centro-1940", "el-centro-1940/EL-CENTRO-1940-NS"])) == ["EL-CENTRO-1940-NS"]


def test_checksum_is_of_the_samples():
    found = find_motions(["el-centro-1940"])[0]
    samples = found.motion.acceleration.astype("<f8").tobytes()
    assert found.describe()["sha256"] == hashlib.sha256(samples).hexdigest()
    assert found.describe()["pga"] == found.motion.pga


def test_embedded_suites():
    rows = embedded_suites()
    assert rows[0] == {"suite": "fema-p695-far-field", "motions": 44, "first": "FF-1-a", "last": "FF-22-b"}
    assert [row["motions"] for row in rows] == [44, 28, 28, 1]


def test_two_motions_of_one_name(tmp_path, record):
    other = tmp_path / "other"
    other.mkdir()
    np.savetxt(other / "record.csv", 2 * ACCELERATION)
    with pytest.raises(InputError, match=r"hold different motions, both named 'record'\. Rename one of the files\."):
        find_motions([str(record), str(other / "record.csv")], "g", 0.01)


def test_unknown_names():
    with pytest.raises(
        InputError, match=r"'el-centro' is neither a suite \(fema.*\), nor a record in one.*el-centro-1940\?"
    ):
        find_motions(["el-centro"])
    with pytest.raises(InputError, match=r"No motion of the suite 'el-centro-1940' is named 'EW'"):
        find_motions(["el-centro-1940/EW"])


def test_nothing_given():
    with pytest.raises(InputError, match=r"No ground motion was given\. Name a suite \(fema-p695-far-field, "):
        find_motions([])


def test_structure_among_motions():
    with pytest.raises(InputError, match=r"other\.toml is a structure file, and one structure is simulated at a time"):
        find_motions(["el-centro-1940", "other.toml"])


def test_units_without_a_file():
    with pytest.raises(InputError, match="--units, --dt and --on-error are for record files, but no file was given"):
        find_motions(["el-centro-1940"], units="g")


def test_missing_unit_and_step_name_the_options(record):
    for units, dt in ((None, 0.01), ("g", None)):
        with pytest.raises(InputError, match=r"On the command line these are --units and --dt\.$"):
            find_motions([str(record)], units, dt)


def test_other_faults_of_a_file_are_told_as_they_are(tmp_path):
    for name in ("empty.csv", "units=g, dt=0.01.csv"):
        path = tmp_path / name
        path.touch()
        with pytest.raises(InputError, match=r"\.csv is empty\.$"):
            find_motions([str(path)])


def test_options_are_named_where_one_of_several_files_lacks_its_unit(tmp_path, record):
    (tmp_path / "empty.csv").touch()
    told = r"2 of 2 files .*is empty\. .*unit of its acceleration.* On the command line these are --units and --dt\.$"
    with pytest.raises(InputError, match=told) as caught:
        find_motions([str(tmp_path / "empty.csv"), str(record)], dt=0.01)
    assert caught.value.field == "units"


def at2(folder, name, component):
    """A record file of four samples."""
    file = folder / name
    file.write_text(f"Event, 1/1/2001, Station, {component}\nUNITS OF G\nNPTS= 4, DT= .1\n0 .3 -.2 0\n")
    return str(file)


def test_vertical_components_of_a_list_of_files_are_left_out(tmp_path):
    files = [at2(tmp_path, name, name[2:-4]) for name in ("a-000.at2", "a-090.at2", "a-UP.at2")]
    for given in (files, [str(tmp_path)]):
        with pytest.warns(RecordWarning, match=r"^Left out: 1 vertical component, a-UP\.at2\.$"):
            assert names(find_motions(given)) == ["a-000", "a-090"]
    with pytest.raises(InputError, match=r"No horizontal component was given, only 1 vertical component: a-UP\.at2\."):
        find_motions(files[2:])


def test_all_files_that_cannot_be_read_are_told(tmp_path):
    bad = [tmp_path / name for name in ("b.at2", "c.at2")]
    for file in bad:
        file.write_text("no record")
    files = [at2(tmp_path, "a.at2", "90"), *map(str, bad)]
    with pytest.raises(
        InputError, match=r"2 of 3 files .*b\.at2: no .*c\.at2: no .*--on-error skip continues with the other files"
    ) as caught:
        find_motions(files)
    assert "on_error" not in str(caught.value)
    with pytest.warns(RecordWarning, match=r"^Left out: 2 of 3 files cannot be read\."):
        assert names(find_motions(files, on_error="skip")) == ["a"]
    with pytest.raises(InputError, match="--units, --dt and --on-error are for record files"):
        find_motions(["el-centro-1940"], on_error="skip")


def test_a_vertical_file_belongs_to_one_motion(tmp_path):
    along, upwards = at2(tmp_path, "a-000.at2", "0"), at2(tmp_path, "a-UP.at2", "UP")
    (found,) = find_motions([along], vertical=upwards)
    assert found.motion == read_motion(along, vertical=upwards)
    assert found.describe()["pva"] == found.motion.pva
    assert "pva" not in find_motions([along])[0].describe()
    other = at2(tmp_path, "a-090.at2", "90")
    with pytest.raises(
        InputError, match=r"a-UP\.at2 is the vertical component of one motion, but 2 were given\. Name one"
    ):
        find_motions([along, other], vertical=upwards)
    paired = find_motions([along, other, upwards], vertical="pair")
    assert [item.motion.vertical.tolist() for item in paired] == [found.motion.vertical.tolist()] * 2


def test_a_suite_with_a_vertical_file_of_columns(tmp_path):
    np.savetxt(tmp_path / "up.txt", ACCELERATION)
    with pytest.warns(
        RecordWarning, match=r"The motion 'EL-CENTRO-1940-NS' lasts 31\.18 s, and its vertical component 0"
    ):
        (found,) = find_motions(["el-centro-1940"], "m/s2", 0.02, vertical=str(tmp_path / "up.txt"))
    assert found.motion.vertical[:50].tolist() == ACCELERATION.tolist()
    with pytest.raises(InputError, match=r"On the command line these are --units and --dt\.$"):
        find_motions(["el-centro-1940"], "m/s2", vertical=str(tmp_path / "up.txt"))


def test_motions_that_differ_only_vertically_are_two(tmp_path):
    for folder, peak in (("x", 1.0), ("y", 2.0)):
        (tmp_path / folder).mkdir()
        text = f"time (s),acc (m/s2),vertical (m/s2)\n0,0,0\n1,1,{peak}\n2,0,0\n"
        (tmp_path / folder / "a.csv").write_text(text)
    with pytest.raises(InputError, match="hold different motions, both named 'a'"):
        find_motions([str(tmp_path / "x"), str(tmp_path / "y")])
