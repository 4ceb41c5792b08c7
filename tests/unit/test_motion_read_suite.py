"""Many record files: suites, surveys, and tables about records."""

import ast
import re

import numpy as np
import pytest

import rockflex as rf
from record_samples import SEARCH_RESULTS, at2, cosmos, esm, knet
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.motion import read_suite
from rockflex.motion._record_table import read_record_table

FLATFILE = (
    "Record Sequence Number,EQID,Earthquake Name,YEAR,Station Name,Earthquake Magnitude,EpiD (km),"
    "Joyner-Boore Dist. (km),ClstD (km),Vs30 (m/s) selected for analysis,File Name (Horizontal 1),"
    "File Name (Horizontal 2),File Name (Vertical)\n"
    '9001,1,"Somewhere, Italy-02",1940,Array #9,6.95,12.99,6.09,7.5,213.44,SOME\\ABC180.AT2,SOME\\ABC270.AT2,'
    "SOME\\ABC-UP.AT2\n"
    "9002,2,Elsewhere,1952,Courthouse,-999,-999,81.3,82.19,-999,-999,-999,-999\n"
)
ESM_FLATFILE = (
    "event_id;event_time;ML;Mw;EMEC_Mw;network_code;station_code;location_code;vs30_m_sec;vs30_m_sec_WA;epi_dist;JB_dist;"
    "rup_dist\n"
    "EMSC-20161030_0000029;2016-10-30 06:40:18;6.1;6.5;6.6;IT;NRC;00;498;450;4.6;0.1;5.4\n"
    "EMSC-20161030_0000029;2016-10-30 06:40:18;6.1;;6.6;IT;ACC;00;;712;19.5;11.2;12.8\n"
)


@pytest.fixture
def folder(tmp_path):
    """Two horizontal components, two vertical ones and two files that cannot be read."""
    folder = tmp_path / "records"
    folder.mkdir()
    for component, peak in (("000", 0.1), ("090", 0.2), ("-UP", 0.3)):
        (folder / f"RSN1_X_ABC{component}.AT2").write_text(at2(component.strip("-"), peak))
    (folder / "RSN2_X_DEF-V.AT2").write_text(at2("V", 0.4))
    (folder / "RSN3_X_GHI000.AT2").write_text("NPTS= 9, DT= .1\n0 1 0\n")
    (folder / "_SearchResults.csv").write_text("Result ID, Spectral Ordinate\n")
    return folder


def test_read_suite_reads_a_directory(tmp_path):
    (tmp_path / "b.csv").write_text("t,acc (g)\n0,0\n0.1,1\n0.2,0\n")
    (tmp_path / "a.AT2").write_text("NPTS= 3, DT= .1\n0 2 0\n")
    (tmp_path / "c.txt").write_text("0\n3\n0\n")
    (tmp_path / "readme.md").write_text("no record")
    suite = read_suite([tmp_path / "b.csv", tmp_path / "a.AT2"])
    assert suite.names == ("a", "b")
    assert [motion.pga for motion in suite] == [2 * GRAVITY, GRAVITY]
    with pytest.raises(InputError, match=r"c\.txt does not state the unit"):
        read_suite(tmp_path)
    (tmp_path / "c.txt").unlink()
    with pytest.warns(RecordWarning, match=r"Not tried, no records by suffix and beginning: readme\.md\.$"):
        whole = read_suite(str(tmp_path))
    assert (whole.names, whole.name) == (("a", "b"), tmp_path.name)
    assert read_suite(iter([tmp_path / "b.csv"])).names == ("b",)


def test_read_suite_refuses(tmp_path):
    with pytest.raises(InputError, match=r"no file ends in .at2.*in one of the formats K-NET, "):
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
    (folder / "lab.txt").write_text("0\n0.5\n0\n")
    both = r"2 of 7 files cannot be read\. \S*RSN3_X_GHI000\.AT2 is truncated: .* \S*lab\.txt does not state the unit.*"
    with pytest.raises(InputError, match=both + r'on_error="skip" continues with the other files\.$'):
        read_suite(folder)
    with pytest.warns(RecordWarning) as caught:
        suite = read_suite(folder, on_error="skip")
    assert suite.names == ("RSN1_X_ABC000", "RSN1_X_ABC090")
    assert [str(each.message)[:40] for each in caught] == [
        "Left out: 2 of 7 files cannot be read. /",
        "Left out: 1 file without an acceleration",
        "Left out: 2 vertical components, RSN1_X_",
    ]


def test_of_many_faults_the_first_are_told_and_all_files_named(tmp_path):
    for place in range(13):
        (tmp_path / f"r{place:02}.at2").write_text("no record")
    (tmp_path / "s.at2").write_text(at2("90"))
    with pytest.raises(InputError) as caught:
        read_suite(tmp_path)
    text = str(caught.value)
    assert text.startswith("13 of 14 files cannot be read. ")
    assert text.count("no header line with NPTS and DT") == 10
    assert all(text.count(f"r{place:02}.at2") == 1 for place in range(13))
    assert "The others: " in text


COLUMNS = "time (s),acc (g)\n0,0\n0.01,0.1\n0.02,0.05\n0.03,0\n"
BARE = "0 0\n0.01 0.1\n0.02 0.05\n0.03 0\n"
NO_RECORDS = {
    "A000.VT2": ("velocity", at2("0").replace("ACCELERATION", "VELOCITY").replace("OF G", "OF CM/S")),
    "A000.DT2": ("displacement", at2("0").replace("ACCELERATION", "DISPLACEMENT").replace("OF G", "OF CM")),
    "bare.vel": ("velocity", BARE),
    "vel.csv": ("velocity", COLUMNS.replace("acc (g)", "vel (m/s)")),
    "disp.txt": ("displacement", COLUMNS.replace("acc (g)", "disp (cm)")),
    "target.csv": ("spectrum", "Period (s),Sa (g)\n0,0.3\n0.1,0.75\n0.2,0.75\n1,0.3\n"),
    "readme.txt": ("no numbers", "How to cite\n1. Acceleration in g\n2. Velocity in cm/s\n"),
    "year.txt": ("text", "Downloaded in\n2022\nfrom the archive, with NPTS and DT in the header\n"),
    "stories.csv": ("table", "story;drift;PFA\n1;0.01;0.2\n2;0.02;0.3\n3;0.015;0.4\n"),
    "measures.csv": ("table", "PGA (g),PGV (cm/s),PGD (cm)\n0.1,10,2\n0.2,12,3\n0.1,9,1\n"),
    "sites.csv": ("no numbers", "name,country\nNRC,Italy\nACC,Italy\n"),
    "roof.disp": ("displacement", "".join(f"{0.01 * k} 0 1 2 3 4\n" for k in range(9))),
}


@pytest.fixture
def mixed(tmp_path):
    """A record, and files beside it that hold something else."""
    folder = tmp_path / "mixed"
    folder.mkdir()
    (folder / "A000.AT2").write_text(at2("0"))
    for name, (_, text) in NO_RECORDS.items():
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize("name", NO_RECORDS)
def test_what_is_no_record_is_left_out_with_a_word(mixed, name):
    what, _ = NO_RECORDS[name]
    with pytest.warns(
        RecordWarning, match=rf"^Left out: 1 file without an acceleration, {name} \({what}\)\.$"
    ) as caught:
        assert read_suite([mixed / "A000.AT2", mixed / name]).names == ("A000",)
    assert [each.filename for each in caught] == [__file__]
    (entry,) = rf.survey_records([mixed / "A000.AT2", mixed / name]).left_out
    assert (entry.file, entry.findings) == (name, ())
    with pytest.raises(InputError, match=name):
        read_suite([mixed / name])


def test_of_files_without_an_acceleration_all_are_named(mixed):
    with pytest.warns(RecordWarning, match="Left out: 12 files without an acceleration, ") as caught:
        assert read_suite(mixed).names == ("A000",)
    assert len(caught) == 1
    (mixed / "A000.AT2").unlink()
    with pytest.raises(
        InputError, match=r"^No record was given, only 12 files .*disp\.txt \(displacement\).*Give the files of"
    ):
        read_suite(mixed)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("B.AT2", "NPTS= 9, DT= .1\n0 1 0\n", "truncated"),
        ("B.AT2", "<html>Not found</html>\n", "no header line"),
        ("lab.txt", BARE, "does not state the unit"),
        ("lab.csv", COLUMNS.replace(" (g)", ""), "does not state the unit"),
        ("lab.csv", COLUMNS.replace("acc (g)", "channel 1"), "does not state the unit"),
        ("lab.csv", COLUMNS.replace("time (s),acc (g)", "left,right"), "does not state the unit"),
        ("rec.th", COLUMNS + "0.04,x\n", "line 6"),
        ("empty.txt", "", "is empty"),
        ("knet.csv", "#K-NET CSV\n#Event\n#OriginTime,Latitude\n#2020/01/01 00:00:00,31.7\n", "knet.csv"),
    ],
)
def test_a_record_that_cannot_be_read_is_an_error_beside_others(mixed, name, text, words):
    (mixed / name).write_text(text)
    with pytest.raises(InputError, match=rf"1 of 14 files cannot be read\. .*{words}"):
        read_suite(mixed)
    with pytest.warns(RecordWarning) as caught:
        assert read_suite(mixed, on_error="skip").names == ("A000",)
    assert re.match(rf"Left out: 1 of 14 files cannot be read\..*{words}", str(caught[0].message))


def test_files_of_any_suffix_are_read_if_they_name_an_acceleration(tmp_path):
    for k, name in enumerate(("a.acc", "b.asc", "c.prn", "d.out", "e.V2", "f.at2.bak", "g")):
        (tmp_path / name).write_text(COLUMNS.replace("0.05", f"0.0{k}"))
    (tmp_path / "h.th").write_text("ACCELERATION TIME SERIES\nNPTS= 6, DT= 0.01\nunits: g\n0 0.1\n0.2 0.1\n0.1 0\n")
    (tmp_path / "i.unknown").write_bytes(COLUMNS.encode("utf-16"))
    others = {
        "disp.out": BARE,
        "photo.png": "\x89PNG\x00\x01",
        "readme.md": "# K-NET\nOrigin Time       2006/01/18 23:25:00\n" + knet("N-S") + COLUMNS,
        "page.html": "<html><p>Accelerations in g</p>\n1\n2\n3\n</html>\n",
        "matrix.mtx": "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1\n1 2 1\n2 2 1\n",
    }
    for name, text in others.items():
        (tmp_path / name).write_text(text)
    with pytest.warns(
        RecordWarning, match=r"^Not tried.*: disp\.out, matrix\.mtx, page\.html, photo\.png, readme\.md\.$"
    ) as caught:
        suite = read_suite(tmp_path)
    assert suite.names == ("a", "b", "c", "d", "e", "f.at2", "g", "h", "i")
    assert len(caught) == 1
    left = {entry.file: entry.reason for entry in rf.survey_records(tmp_path).left_out}
    assert left == dict.fromkeys(others, "no record, by suffix and beginning")


def test_folders_and_archives_within_a_folder_are_said(tmp_path):
    (tmp_path / "a.csv").write_text(COLUMNS)
    for name in ("raw/b.csv", "raw/deep/c.csv", "raw/.d", ".git/config", "__MACOSX/._a.csv"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(COLUMNS)
    (tmp_path / "empty").mkdir()
    for name in ("more.zip", "b.csv.gz", "Thumbs.db", ".DS_Store", "~$book.xlsx", "desktop.ini"):
        (tmp_path / name).write_bytes(b"PK\3\4")
    with pytest.warns(RecordWarning) as caught:
        assert read_suite(tmp_path).names == ("a",)
    entered, unpacked = (str(each.message) for each in caught)
    assert entered.startswith("Not entered: the folder raw with 2 files.")
    assert f"read_suite('{(tmp_path / 'raw').as_posix()}')" in entered
    assert unpacked.startswith("Not unpacked: b.csv.gz, more.zip.")
    left = {entry.file: entry.reason for entry in rf.survey_records(tmp_path).left_out}
    assert left["raw/"] == "a folder with 2 files, which was not entered"
    assert left["more.zip"] == "an archive, which was not unpacked"
    assert left["Thumbs.db"] == "no record, by suffix and beginning"
    (tmp_path / "a.csv").unlink()
    with pytest.raises(
        InputError, match=r"holds no record: .*the folder raw with 2 files\. .*Not unpacked: b\.csv\.gz"
    ):
        read_suite(tmp_path)


def toy_format():
    """A format whose first line is the metadata of a record, as Python."""

    def parse(file, lines):
        info = rf.RecordInfo(source=file.name, source_format="toy", **ast.literal_eval(lines[0].partition(" ")[2]))
        return [rf.GroundMotion([0.0, float(lines[1]), 0.0], 0.01, file.stem, info)]

    return rf.motion.RecordFormat("toy", lambda lines: lines[0].startswith("toy "), parse)


RAW = {"station": "AAA", "network": "X", "component": "HNE", "start_time": "2020-01-01T00:00:00"}
RAW["processing"] = "uncorrected"


@pytest.mark.parametrize(
    ("raw", "other", "twice"),
    [
        ({}, {}, False),
        ({}, {"start_time": "2020-01-01T00:00:20"}, False),
        ({}, {"network": None, "location": "00"}, False),
        ({"azimuth": 359.5}, {"azimuth": 0.0, "component": "NS"}, False),
        ({"start_time": None, "event_id": "E1"}, {"start_time": None, "event_id": "e1"}, False),
        ({"start_time": None, "event": "Kobe"}, {"start_time": "2020-01-01T00:00:00+00:00", "event": "Kobe"}, False),
        ({}, {"start_time": "2020-01-01T00:10:00"}, True),
        ({}, {"station": "BBB"}, True),
        ({"location": "surface"}, {"location": "borehole"}, True),
        ({}, {"component": "HNN"}, True),
        ({}, {"component": "HNZ", "direction": "vertical"}, True),
        ({"azimuth": 0.0}, {"azimuth": 90.0}, True),
        ({"start_time": None}, {"start_time": None}, True),
        ({"processing": None}, {}, True),
        ({}, {"processing": "uncorrected, mean subtracted"}, True),
    ],
)
def test_of_an_uncorrected_and_a_corrected_record_the_corrected_one_is_taken(tmp_path, monkeypatch, raw, other, twice):
    monkeypatch.setitem(rf.motion.FORMATS, "toy", toy_format())
    (tmp_path / "raw.x").write_text(f"toy {RAW | raw}\n1.0\n")
    (tmp_path / "cut.x").write_text(f"toy {RAW | {'processing': 'baseline corrected'} | other}\n1.1\n")
    survey = rf.survey_records(tmp_path, vertical="pair" if other.get("direction") else None)
    left = {entry.file: entry.reason for entry in survey.left_out}
    if twice:
        assert not any("uncorrected" in reason for reason in left.values())
        return
    assert left == {"raw.x": "uncorrected; cut.x is the corrected record"}
    assert [len(each.horizontal) for each in survey.stations] == [1]
    with pytest.warns(
        RecordWarning, match=r"Left out: 1 uncorrected record beside corrected ones, raw\.x \(of cut\.x\)"
    ):
        assert read_suite(tmp_path).names == ("cut",)


def test_suffixes_tell_uncorrected_records_from_corrected_ones(tmp_path):
    for name, peak in (("AAA090.V1", 0.1), ("AAA090.V2", 0.09), ("BBB090.V1", 0.1), ("AAA180.v1c", 0.1)):
        (tmp_path / name).write_text(COLUMNS.replace("0.1", str(peak)))
    with pytest.warns(RecordWarning, match=r"1 uncorrected record beside corrected ones, AAA090\.V1 \(of AAA090\.V2\)"):
        suite = read_suite(tmp_path)
    assert suite.names == ("AAA090", "AAA180", "BBB090")
    assert suite["AAA090"].pga == 0.09 * GRAVITY


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("b.csv", COLUMNS.replace("acc (g)", "acc Z (g)")),
        ("b.csv", COLUMNS.replace("acc (g)", "AccZ (g)")),
        ("b-UD.csv", COLUMNS),
        ("STA.HNZ.txt", COLUMNS),
        ("b.txt", "# component: UP\n" + COLUMNS),
        ("b.txt", "STREAM: HNZ\n" + COLUMNS),
        ("b.UD", knet("U-D")),
        ("b.ASC", esm(stream="HNZ")),
        ("b.V2c", cosmos(400)),
    ],
)
def test_no_vertical_component_is_taken_as_horizontal(tmp_path, name, text):
    (tmp_path / "a.csv").write_text(COLUMNS)
    (tmp_path / name).write_text(text)
    with pytest.warns(RecordWarning, match="Left out: 1 vertical component"):
        assert read_suite(tmp_path).names == ("a",)


def test_without_any_record_nothing_can_be_skipped(tmp_path):
    (tmp_path / "a.at2").write_text("no record")
    for choice in ("raise", "skip"):
        with pytest.raises(InputError, match=r"a\.at2: no header line with NPTS and DT.*read_motion instead\.$"):
            read_suite(tmp_path, on_error=choice)
    with pytest.raises(InputError, match='on_error must be "raise" or "skip", but \'warn\' was given'):
        read_suite(tmp_path, on_error="warn")


@pytest.fixture
def folder_survey(tmp_path):
    folder_survey = tmp_path / "mixed"
    folder_survey.mkdir()
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
        (folder_survey / name).write_text(text)
    (folder_survey / "inner").mkdir()
    return folder_survey


def test_survey(folder_survey):
    survey = rf.survey_records(folder_survey)
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
    assert "table about the records; it lists 2 files that are not there: RSN9002_" in left["_SearchResults.csv"]
    assert left["lab.csv"].startswith("does not state the unit of its acceleration")
    assert left["notes.txt"].startswith("holds no numbers")
    assert left["readme.md"] == left[".hidden.txt"] == "no record, by suffix and beginning"
    told = {entry.file: entry.reason for entry in survey.taken if entry.reason}
    assert list(told) == ["IT.NRC.HNE.ASC"]
    assert told["IT.NRC.HNE.ASC"].startswith("the header states a PGA of 0.13 m/s², but the samples reach 0.12125")


def test_entries_state_what_is_known(folder_survey):
    entry = next(each for each in rf.survey_records(folder_survey).entries if each.name == "RSN9001_SOME_ABC270")
    assert (entry.dt, entry.n_samples, entry.pga, entry.stated_pga) == (0.1, 3, 0.2 * 9.81, None)
    assert (entry.magnitude, entry.distance_km, entry.vs30) == (6.95, 7.5, 213.44)
    assert (entry.station, entry.component, entry.direction) == ("Some Station", "270", "horizontal")
    assert {each.what: each.value for each in entry.findings}["unit"] == "g"


def test_findings_name_the_files_of_which_they_are_true(tmp_path):
    for name in ("b.csv", "a.csv"):
        (tmp_path / name).write_text(COLUMNS)
    (tmp_path / "c.csv").write_text(COLUMNS.replace("(g)", "(gal)"))
    survey = rf.survey_records(tmp_path)
    units = {(each.value, each.evidence): files for each, files in survey.findings.items() if each.what == "unit"}
    assert units == {("g", 'label "acc (g)"'): ("a.csv", "b.csv"), ("cm/s2", 'label "acc (gal)"'): ("c.csv",)}
    assert list(dict.fromkeys(each.what for each in survey.findings))[:3] == ["quantity", "unit", "time step"]
    assert survey.to_frame()["findings"][0].split("; ")[1] == 'unit: g (label "acc (g)")'


def test_it_agrees_with_read_suite(folder_survey):
    survey = rf.survey_records(folder_survey)
    with pytest.warns(rf.RecordWarning) as caught:
        suite = rf.read_suite(folder_survey, on_error="skip")
    assert survey.suite() == suite
    assert survey.name == suite.name == "mixed"
    said = " ".join(str(each.message) for each in caught)
    assert all(entry.file.rpartition(".")[0].split("-")[0] in said for entry in survey.left_out if
               "component" in entry.reason or "holds no numbers" in entry.reason)  # fmt: skip


def test_pairs(folder_survey):
    survey = rf.survey_records(folder_survey, units={"lab.csv": "m/s2"}, vertical="pair")
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
        rf.survey_records(folder_survey, vertical="yes")


def test_frame_and_text(folder_survey):
    survey = rf.survey_records(folder_survey)
    frame = survey.to_frame()
    assert len(frame) == len(survey.entries)
    assert list(frame.columns[:3]) == ["file", "taken", "reason"]
    assert frame["taken"].sum() == 6
    assert repr(survey) == "RecordSurvey('mixed', 6 taken, 8 left out)"


def test_a_list_of_files(folder_survey):
    survey = rf.survey_records([folder_survey / "notes.txt"])
    assert (survey.name, len(survey.entries), survey.taken) == ("", 1, ())
    with pytest.raises(rf.InputError, match="A suite needs at least one motion"):
        survey.suite()
    with pytest.raises(rf.InputError, match="is not a directory"):
        rf.survey_records(folder_survey / "none")
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
    with pytest.raises(rf.InputError, match="motions must be a sequence of GroundMotion objects, but 3 was given"):
        rf.group_stations(3)
    with pytest.raises(rf.InputError, match="motions must hold GroundMotion objects, but str was given"):
        rf.group_stations(["a"])


def table_of(samples, head, unit=1.0):
    return f"time (s),{head}\n" + "".join(f"{0.01 * k:.2f},{unit * value:.6f}\n" for k, value in enumerate(samples))


def test_a_record_that_several_files_hold_is_taken_once_and_its_pair_stays_a_pair(tmp_path):
    first, second = 0.2 * np.random.default_rng(1).standard_normal((2, 300))
    files = {
        "RSN5_ABC000.AT2": at2("000", samples=first, dt=0.01),
        "RSN5_ABC090.AT2": at2("090", samples=second, dt=0.01),
        "Copy of RSN5_ABC000.AT2": at2("000", samples=first, dt=0.01),
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
        (tmp_path / name).write_text(at2("000", samples=samples, dt=0.01))
    assert len(rf.read_suite([tmp_path / "RSN1_A000.AT2", tmp_path / "RSN2_A000.AT2"])) == 2


@pytest.fixture
def folder_record_table(tmp_path):
    folder_record_table = tmp_path / "peer"
    folder_record_table.mkdir()
    for name, component in (("ABC180", "180"), ("ABC270", "270"), ("ABC-UP", "UP")):
        (folder_record_table / f"RSN9001_SOME_{name}.AT2").write_text(at2(component))
    (folder_record_table / "RSN9002_ELSE_DEF042.AT2").write_text(at2("42"))
    return folder_record_table


def facts(motion):
    info = motion.metadata
    return info.rsn, info.magnitude, info.distance_km, info.distance_jb_km, info.vs30


def test_search_results_of_peer(folder_record_table):
    (folder_record_table / "_SearchResults.csv").write_text(SEARCH_RESULTS)
    with pytest.warns(rf.RecordWarning, match="Without a vertical component: 1 of 3 records, RSN9002_ELSE_DEF042"):
        suite = rf.read_suite(folder_record_table, vertical="pair")
    assert [facts(motion) for motion in suite] == [
        (9001, 6.95, 7.5, 6.09, 213.44),
        (9001, 6.95, 7.5, 6.09, 213.44),
        (9002, 7.36, 82.19, 81.3, None),
    ]
    # What the header says remains.
    assert {motion.metadata.event for motion in suite} == {"Some Event"}
    table = read_record_table(folder_record_table / "_SearchResults.csv")
    first = table.by_number[9001]
    assert (first.event, first.year, first.station) == ("Somewhere, Italy-02", 1940, "Array #9, East")
    assert table.by_file["rsn9001_some_abc-up.at2"].direction == "vertical"
    assert "-----" not in table.by_file


def test_a_flatfile_elsewhere(folder_record_table, tmp_path):
    (tmp_path / "flatfile.csv").write_text(FLATFILE)
    with pytest.warns(rf.RecordWarning, match="1 vertical component"):
        suite = rf.read_suite(folder_record_table, table=tmp_path / "flatfile.csv")
    assert [facts(motion) for motion in suite][1:] == [(9001, 6.95, 7.5, 6.09, 213.44), (9002, None, 82.19, 81.3, None)]
    assert suite[0].metadata.epicentral_km == 12.99


def test_a_flatfile_in_a_workbook(folder_record_table, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["RSN", "Magnitude", "Rrup (km)"], [9001, 6.95, 7.5]):
        book.active.append(row)
    book.save(folder_record_table / "about.xlsx")
    suite = rf.read_suite([*folder_record_table.glob("*180.AT2"), folder_record_table / "about.xlsx"])
    assert facts(suite[0]) == (9001, 6.95, 7.5, None, None)


def test_units_and_steps_by_file(tmp_path):
    for name in ("lab-1", "lab-2", "old"):
        (tmp_path / f"{name}.txt").write_text("0\n0.5\n0\n")
    (tmp_path / "units.csv").write_text(
        "file;units;dt\nlab-*.txt;g;0.005\nOLD.txt;2 cm/s2;0,01\n".replace("0,01", "0.02")
    )
    suite = rf.read_suite(tmp_path)
    assert [(motion.pga, motion.dt) for motion in suite] == [(4.905, 0.005), (4.905, 0.005), (0.01, 0.02)]
    (tmp_path / "units.csv").unlink()
    suite = rf.read_suite(tmp_path, units={"lab-1.txt": "m/s2", "*": "mg"}, dt=0.01)
    assert [motion.pga for motion in suite] == pytest.approx([0.5, 0.004905, 0.004905])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("file,units\na.txt,furlongs\n", r"t\.csv, line 2: units must be one of .* but 'furlongs' was given"),
        ("file,units,dt\na.txt,g,-1\n", r"t\.csv, line 2: dt must be a positive"),
        ("file,notes\na.txt,good\n", r"t\.csv is no table about records: a header line is expected with a column of"),
        ("time,acc\n0,1\n", "is no table about records"),
    ],
)
def test_refuses(tmp_path, text, message):
    (tmp_path / "a.txt").write_text("0\n0.5\n0\n")
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(rf.InputError, match=message):
        rf.read_suite([tmp_path / "a.txt"], units="g", dt=0.01, table=tmp_path / "t.csv")


def test_refuses_other_arguments(tmp_path):
    (tmp_path / "units.csv").write_text("file,units\na.txt,g\n")
    with pytest.raises(rf.InputError, match=r"units\.csv: only tables about records were given, but no record"):
        rf.read_suite(tmp_path)
    (tmp_path / "a.txt").write_text("0\n0.5\n0\n")
    (tmp_path / "binary.bin").write_bytes(b"\0\1" * 20)
    for arguments, message in (
        ({"units": ["g"]}, "units must be a text such as 'g', or a dictionary"),
        ({"units": {"a.txt": "counts"}}, "units must be one of"),
        ({"table": 3}, "table must be a path"),
        ({"table": tmp_path / "binary.bin"}, "is no table about records"),
    ):
        with pytest.raises(rf.InputError, match=message):
            rf.read_suite(tmp_path, **arguments)


def test_a_unit_in_the_table_must_fit_the_file(tmp_path):
    (tmp_path / "units.csv").write_text("file,units\n*.AT2,m/s2\n")
    (tmp_path / "A090.AT2").write_text(at2("90"))
    with pytest.raises(rf.InputError, match=r"the unit is g .*line 2: .*, but units='m/s2' was given"):
        rf.read_suite(tmp_path)


def test_the_flatfile_of_esm(tmp_path):
    (tmp_path / "records").mkdir()
    for station in ("NRC", "ACC", "XYZ"):
        changed = {"MAGNITUDE_W": "", "MAGNITUDE_L": "", "VS30_M_S": "", "STATION_CODE": station}
        (tmp_path / "records" / f"IT.{station}.ASC").write_text(esm(**changed))
    (tmp_path / "flatfile.csv").write_text(ESM_FLATFILE)
    suite = rf.read_suite(tmp_path / "records", table=tmp_path / "flatfile.csv")
    assert [facts(motion) for motion in suite] == [
        (None, 6.6, 12.8, 11.2, 712.0),  # what EMEC and the slope give, where the first column is empty
        (None, 6.5, 5.4, 0.1, 498.0),
        (None, None, None, None, None),
    ]
    assert {motion.metadata.epicentral_km for motion in suite} == {4.6}  # as the header says
    assert {motion.metadata.event_id for motion in suite} == {"EMSC-20161030_0000029"}
