"""Tables about records: PEER's search results, flatfiles, and tables of one's own."""

import pytest

import rockflex as rf
from record_samples import SEARCH_RESULTS, at2, esm
from rockflex.motion._record_table import read_table

FLATFILE = (
    "Record Sequence Number,EQID,Earthquake Name,YEAR,Station Name,Earthquake Magnitude,EpiD (km),"
    "Joyner-Boore Dist. (km),ClstD (km),Vs30 (m/s) selected for analysis,File Name (Horizontal 1),"
    "File Name (Horizontal 2),File Name (Vertical)\n"
    '9001,1,"Somewhere, Italy-02",1940,Array #9,6.95,12.99,6.09,7.5,213.44,SOME\\ABC180.AT2,SOME\\ABC270.AT2,'
    "SOME\\ABC-UP.AT2\n"
    "9002,2,Elsewhere,1952,Courthouse,-999,-999,81.3,82.19,-999,-999,-999,-999\n"
)


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "peer"
    folder.mkdir()
    for name, component in (("ABC180", "180"), ("ABC270", "270"), ("ABC-UP", "UP")):
        (folder / f"RSN9001_SOME_{name}.AT2").write_text(at2(component))
    (folder / "RSN9002_ELSE_DEF042.AT2").write_text(at2("42"))
    return folder


def facts(motion):
    info = motion.metadata
    return info.rsn, info.magnitude, info.distance_km, info.distance_jb_km, info.vs30


def test_search_results_of_peer(folder):
    (folder / "_SearchResults.csv").write_text(SEARCH_RESULTS)
    with pytest.warns(rf.RecordWarning, match="Without a vertical component: 1 of 3 records, RSN9002_ELSE_DEF042"):
        suite = rf.read_suite(folder, vertical="pair")
    assert [facts(motion) for motion in suite] == [
        (9001, 6.95, 7.5, 6.09, 213.44),
        (9001, 6.95, 7.5, 6.09, 213.44),
        (9002, 7.36, 82.19, 81.3, None),
    ]
    # What the header says remains.
    assert {motion.metadata.event for motion in suite} == {"Some Event"}
    table = read_table(folder / "_SearchResults.csv")
    first = table.by_number[9001]
    assert (first.event, first.year, first.station) == ("Somewhere, Italy-02", 1940, "Array #9, East")
    assert table.by_file["rsn9001_some_abc-up.at2"].direction == "vertical"
    assert "-----" not in table.by_file


def test_a_flatfile_elsewhere(folder, tmp_path):
    (tmp_path / "flatfile.csv").write_text(FLATFILE)
    with pytest.warns(rf.RecordWarning, match="1 vertical component"):
        suite = rf.read_suite(folder, table=tmp_path / "flatfile.csv")
    assert [facts(motion) for motion in suite][1:] == [(9001, 6.95, 7.5, 6.09, 213.44), (9002, None, 82.19, 81.3, None)]
    assert suite[0].metadata.epicentral_km == 12.99


def test_a_flatfile_in_a_workbook(folder, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["RSN", "Magnitude", "Rrup (km)"], [9001, 6.95, 7.5]):
        book.active.append(row)
    book.save(folder / "about.xlsx")
    suite = rf.read_suite([*folder.glob("*180.AT2"), folder / "about.xlsx"])
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
    with pytest.raises(rf.InputError, match="units must be a text such as 'g', or a dictionary of texts by file names"):
        rf.read_suite(tmp_path, units=["g"])
    with pytest.raises(rf.InputError, match="units must be one of"):
        rf.read_suite(tmp_path, units={"a.txt": "counts"})
    with pytest.raises(rf.InputError, match="table must be a path"):
        rf.read_suite(tmp_path, table=3)
    (tmp_path / "binary.bin").write_bytes(b"\0\1" * 20)
    with pytest.raises(rf.InputError, match="is no table about records"):
        rf.read_suite(tmp_path, table=tmp_path / "binary.bin")
    (tmp_path / "units.csv").write_text("file,units\na.txt,furlongs\n")
    with pytest.raises(rf.InputError, match=r"units must be one of .* 'furlongs'"):
        rf.read_suite(tmp_path)


def test_a_unit_in_the_table_must_fit_the_file(tmp_path):
    (tmp_path / "units.csv").write_text("file,units\n*.AT2,m/s2\n")
    (tmp_path / "A090.AT2").write_text(at2("90"))
    with pytest.raises(rf.InputError, match="is an AT2 file, in g by definition, but units='m/s2' was given"):
        rf.read_suite(tmp_path)


ESM_FLATFILE = (
    "event_id;event_time;ML;Mw;EMEC_Mw;network_code;station_code;location_code;vs30_m_sec;vs30_m_sec_WA;epi_dist;JB_dist;"
    "rup_dist\n"
    "EMSC-20161030_0000029;2016-10-30 06:40:18;6.1;6.5;6.6;IT;NRC;00;498;450;4.6;0.1;5.4\n"
    "EMSC-20161030_0000029;2016-10-30 06:40:18;6.1;;6.6;IT;ACC;00;;712;19.5;11.2;12.8\n"
)


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
