"""A folder as it comes: what is taken, and what is not, and why; and the components by recording."""

import numpy as np
import pytest

import rockflex as rf
from record_samples import SEARCH_RESULTS, at2, cosmos, esm, knet


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "mixed"
    folder.mkdir()
    files = {
        "RSN9001_SOME_ABC180.AT2": at2("180"),
        "RSN9001_SOME_ABC270.AT2": at2("270", 0.2),
        "RSN9001_SOME_ABC-UP.AT2": at2("UP"),
        "_SearchResults.csv": SEARCH_RESULTS,
        "MYG002.NS": knet("N-S"),
        "MYG002.UD": knet("U-D"),
        "IT.NRC.HNE.ASC": esm(PGA_CM_S_2="13.0"),
        "CE13921.V2c": cosmos(90) + cosmos(360) + cosmos(400),
        "lab.csv": "time;acc\n0,0;1\n0,1;2\n0,2;3\n",
        "readme.md": "A folder of records.\n",
        "notes.txt": "Downloaded in spring\n",
        ".hidden.txt": "0 1\n",
    }
    for name, text in files.items():
        (folder / name).write_text(text)
    (folder / "inner").mkdir()
    return folder


def test_survey(folder):
    survey = rf.survey_records(folder)
    assert [(entry.file, entry.name) for entry in survey.taken] == [
        ("CE13921.V2c", "CE13921-090"),
        ("CE13921.V2c", "CE13921-360"),
        ("IT.NRC.HNE.ASC", "IT.NRC.HNE"),
        ("MYG002.NS", "MYG002-NS"),
        ("RSN9001_SOME_ABC180.AT2", "RSN9001_SOME_ABC180"),
        ("RSN9001_SOME_ABC270.AT2", "RSN9001_SOME_ABC270"),
    ]
    assert [entry.format for entry in survey.taken] == ["COSMOS", "COSMOS", "ESM", "K-NET", "AT2", "AT2"]
    left = {entry.file: entry.reason for entry in survey.left_out}
    assert list(left) == [
        ".hidden.txt", "CE13921.V2c", "MYG002.UD", "RSN9001_SOME_ABC-UP.AT2", "_SearchResults.csv", "lab.csv",
        "notes.txt", "readme.md",
    ]  # fmt: skip
    assert {left[name] for name in ("CE13921.V2c", "MYG002.UD", "RSN9001_SOME_ABC-UP.AT2")} == {"vertical component"}
    assert left["_SearchResults.csv"] == (
        "a table about the records; it lists 2 files that are not there: RSN9002_ELSE_DEF042.AT2, "
        "RSN9002_ELSE_DEF132.AT2"
    )
    assert left["lab.csv"].startswith("lab.csv does not state the unit of its acceleration")
    assert left["notes.txt"].startswith("notes.txt holds no numbers")
    assert left["readme.md"] == left[".hidden.txt"] == "no record, by suffix and beginning"
    told = {entry.file: entry.reason for entry in survey.taken if entry.reason}
    assert list(told) == ["IT.NRC.HNE.ASC"]
    assert told["IT.NRC.HNE.ASC"].startswith("the header states a PGA of 0.13 m/s², but the samples reach 0.12125")


def test_entries_state_what_is_known(folder):
    entry = next(each for each in rf.survey_records(folder).entries if each.name == "RSN9001_SOME_ABC270")
    assert (entry.dt, entry.n_samples, entry.pga, entry.stated_pga) == (0.1, 3, 0.2 * 9.81, None)
    assert (entry.magnitude, entry.distance_km, entry.vs30) == (6.95, 7.5, 213.44)
    assert (entry.station, entry.component, entry.direction) == ("Some Station", "270", "horizontal")


def test_it_agrees_with_read_suite(folder):
    survey = rf.survey_records(folder)
    with pytest.warns(rf.RecordWarning) as caught:
        suite = rf.read_suite(folder, on_error="skip")
    assert survey.suite() == suite
    assert survey.name == suite.name == "mixed"
    said = " ".join(str(each.message) for each in caught)
    assert all(entry.file.rpartition(".")[0].split("-")[0] in said for entry in survey.left_out if
               "component" in entry.reason or "holds no numbers" in entry.reason)  # fmt: skip


def test_pairs(folder):
    survey = rf.survey_records(folder, units={"lab.csv": "m/s2"}, vertical="pair")
    assert {entry.name for entry in survey.taken} >= {"MYG002-UD", "CE13921-UP", "RSN9001_SOME_ABC-UP", "lab"}
    assert {entry.name: entry.reason for entry in survey.taken if entry.reason}.keys() == {"IT.NRC.HNE", "lab"}
    assert next(e.reason for e in survey.entries if e.name == "lab") == "without a vertical component"
    stations = {each.name: (len(each.horizontal), each.vertical is not None) for each in survey.stations}
    assert stations == {
        "CE 13921 Fontana, Wed Jan 15, 2014 01:35 PST": (2, True),
        "IT NRC 00 CENTRAL_ITALY 2016-10-30 06:40": (1, False),
        "NIED MYG002 2006-01-18 23:25": (1, True),
        "RSN9001": (2, True),
        "lab": (1, False),
    }
    with pytest.raises(rf.InputError, match='vertical must be "pair" or None'):
        rf.survey_records(folder, vertical="yes")


def test_frame_and_text(folder):
    survey = rf.survey_records(folder)
    frame = survey.to_frame()
    assert len(frame) == len(survey.entries)
    assert list(frame.columns[:3]) == ["file", "taken", "reason"]
    assert frame["taken"].sum() == 6
    assert repr(survey) == "RecordSurvey('mixed', 6 taken, 8 left out)"


def test_a_list_of_files(folder):
    survey = rf.survey_records([folder / "notes.txt"])
    assert (survey.name, len(survey.entries), survey.taken) == ("", 1, ())
    with pytest.raises(rf.InputError, match="A suite needs at least one motion"):
        survey.suite()
    with pytest.raises(rf.InputError, match="is not a directory"):
        rf.survey_records(folder / "none")
    with pytest.raises(rf.InputError, match="paths must be a directory or a sequence of files, but int was given"):
        rf.survey_records(3)


def motion(name, **info):
    return rf.GroundMotion([0.0, 1.0, 0.0], 0.1, name, rf.RecordInfo(**info) if info else None)


def test_stations_by_name():
    found = rf.group_stations(
        [motion("ABC090"), motion("ABC180"), motion("abc-UP", direction="vertical"), motion("DEF090"), motion("plain")]
    )
    assert [(each.name, len(each.horizontal), each.vertical is not None) for each in found] == [
        ("ABC", 2, True),
        ("DEF090", 1, False),
        ("plain", 1, False),
    ]
    assert [each.name for each in found[0].pair] == ["ABC090", "ABC180"]
    with pytest.raises(rf.InputError, match="A pair of horizontal components is expected, but the record DEF090 has 1"):
        found[1].pair  # noqa: B018


def test_stations_bring_their_vertical_component():
    both = rf.GroundMotion([0.0, 1.0, 0.0], 0.1, "A", rf.RecordInfo(rsn=3), vertical=[0.0, 0.5, 0.0])
    (found,) = rf.group_stations([both])
    assert found.vertical.pga == 0.5
    with pytest.raises(rf.InputError, match="motions must be a sequence of GroundMotion objects, but int was given"):
        rf.group_stations(3)
    with pytest.raises(rf.InputError, match="motions must hold GroundMotion objects, but str was given"):
        rf.group_stations(["a"])


def long_at2(component, samples):
    lines = "\n".join(f" {value: .7E}" for value in samples)
    return f"Event, 1/1/2001, Station, {component}\nUNITS OF G\nNPTS= {len(samples)}, DT= .01\n{lines}\n"


def table_of(samples, head, unit=1.0):
    return f"time (s),{head}\n" + "".join(f"{0.01 * k:.2f},{unit * value:.6f}\n" for k, value in enumerate(samples))


def test_a_record_that_several_files_hold_is_taken_once_and_its_pair_stays_a_pair(tmp_path):
    first, second = 0.2 * np.random.default_rng(1).standard_normal((2, 300))
    files = {
        "RSN5_ABC000.AT2": long_at2("000", first),
        "RSN5_ABC090.AT2": long_at2("090", second),
        "Copy of RSN5_ABC000.AT2": long_at2("000", first),
        "a.csv": table_of(first, "acc (g)"),
        "b.csv": table_of(second, "acc (m/s2)", 9.80665),
        "half.csv": table_of(0.5 * first, "acc (g)"),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    survey = rf.survey_records(tmp_path)
    assert [entry.file for entry in survey.taken] == ["RSN5_ABC000.AT2", "RSN5_ABC090.AT2", "half.csv"]
    kept = {entry.file: name for entry in survey.left_out for name in files if name in entry.reason}
    assert kept == {
        "Copy of RSN5_ABC000.AT2": "RSN5_ABC000.AT2",
        "a.csv": "RSN5_ABC000.AT2",
        "b.csv": "RSN5_ABC090.AT2",
    }
    with pytest.warns(rf.RecordWarning, match=r"Left out: 3 copies .*a\.csv \(of RSN5_ABC000\.AT2\)"):
        suite = rf.read_suite(tmp_path)
    assert suite.names == ("RSN5_ABC000", "RSN5_ABC090", "half")
    assert [each.pair for each in rf.group_stations(suite) if len(each.horizontal) == 2] == [tuple(suite)[:2]]
    assert [len(each.horizontal) for each in survey.stations] == [2, 1]


def test_components_that_names_tell_apart_are_no_copies(tmp_path):
    samples = 0.1 * np.random.default_rng(2).standard_normal(100)
    both = "time (s),acc NS (g),acc EW (g)\n" + "".join(f"{0.01 * k:.2f},{a},{a}\n" for k, a in enumerate(samples))
    for name in ("ABC000.csv", "ABC090.csv"):
        (tmp_path / name).write_text(table_of(samples, "acc (g)"))
    assert rf.read_suite(tmp_path).names == ("ABC000", "ABC090")
    (tmp_path / "both.csv").write_text(both)
    assert rf.read_suite([tmp_path / "both.csv"]).names == ("both-NS", "both-EW")
    for name in ("RSN1_A000.AT2", "RSN2_A000.AT2"):
        (tmp_path / name).write_text(long_at2("000", samples))
    assert len(rf.read_suite([tmp_path / "RSN1_A000.AT2", tmp_path / "RSN2_A000.AT2"])) == 2
