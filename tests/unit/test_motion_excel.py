"""Excel workbooks, written with openpyxl."""

import io
import sys
import zipfile

import pytest

import rockflex as rf
from rockflex.motion import _excel

openpyxl = pytest.importorskip("openpyxl")


def write(folder, sheets, name="records.xlsx"):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title, rows in sheets.items():
        sheet = book.create_sheet(title)
        for row in rows:
            sheet.append(row)
    book.save(folder / name)
    return folder / name


ROWS = [[0.0, 0.1], [0.01, -0.25], [0.02, 1 / 3], [0.03, 0]]


def test_a_sheet_is_read_as_columns_are(tmp_path):
    file = write(tmp_path, {"S": [["Laboratory", None], [], ["time (s)", "Acc (g)"], *ROWS]})
    motion = rf.read_motion(file)
    assert motion.acceleration.tolist() == [9.81 * row[1] for row in ROWS]  # every digit of the cells
    assert (motion.dt, motion.name, motion.metadata.source_format) == (0.01, "records", "columns")


def test_empty_columns_and_rows_are_passed_over(tmp_path):
    rows = [[None, None, None, "note"], [None, "time (s)", None, "acc (m/s2)"]]
    rows += [[None, t, None, a] for t, a in ROWS] + [[None], [None]]
    assert rf.read_motion(write(tmp_path, {"S": rows})).acceleration.tolist() == [row[1] for row in ROWS]


def test_units_and_step_from_the_caller(tmp_path):
    file = write(tmp_path, {"S": [[a] for _, a in ROWS]})
    assert rf.read_motion(file, units="cm/s2", dt=0.02).pga == pytest.approx(0.01 / 3)
    with pytest.raises(rf.InputError, match=r"records\.xlsx does not state the unit of its acceleration"):
        rf.read_motion(file)


def test_components_in_columns_and_in_sheets(tmp_path):
    head = ["time (s)", "NS (gal)", "EW (gal)", "UD (gal)"]
    both = {"first": [head, *([t, a, 2 * a, 3 * a] for t, a in ROWS)], "notes": [["nothing"]]}
    found = rf.read_components(write(tmp_path, both))
    assert [motion.name for motion in found] == ["records-NS", "records-EW", "records-UD"]
    assert [motion.metadata.direction for motion in found] == ["horizontal", "horizontal", "vertical"]
    assert rf.read_motion(tmp_path / "records.xlsx", component="ew").pga == pytest.approx(0.02 / 3)
    sheets = {"A": [["t", "acc (g)"], *ROWS], "B": [["t", "acc (g)"], *ROWS]}
    write(tmp_path, sheets, "two.xlsx")
    assert [motion.name for motion in rf.read_components(tmp_path / "two.xlsx")] == ["two-A", "two-B"]
    assert rf.read_suite([tmp_path / "two.xlsx"]).names == ("two-A", "two-B")
    sheets["B"] = [["t", "acc"], *ROWS]
    with pytest.raises(rf.InputError, match=r"Sheet 'B': .*two\.xlsx does not state the unit"):
        rf.read_components(write(tmp_path, sheets, "two.xlsx"))


def test_refuses(tmp_path):
    with pytest.raises(rf.InputError, match="holds no numbers: a sheet is expected with columns of time and accel"):
        rf.read_motion(write(tmp_path, {"S": [["a", "b"]]}))
    with pytest.raises(rf.InputError, match="line 3: expected a finite number, but found 'x'"):
        rf.read_motion(write(tmp_path, {"S": [["t", "acc (g)"], [0, 1], [1, "x"], [2, 3]]}))
    (tmp_path / "a.xls").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"0" * 100)
    with pytest.raises(rf.InputError, match=r"a\.xls is a workbook of the old format\. Save it as \.xlsx or CSV"):
        rf.read_motion(tmp_path / "a.xls")
    (tmp_path / "b.xlsx").write_bytes(b"PK\x03\x04" + b"0" * 100)
    with pytest.raises(rf.InputError, match=r"b\.xlsx is a damaged archive or workbook\. Download it again"):
        rf.read_motion(tmp_path / "b.xlsx")
    with zipfile.ZipFile(tmp_path / "c.zip", "w") as archive:
        archive.writestr("a.txt", "0 1")
    with pytest.raises(rf.InputError, match=r"c\.zip is an archive, but no workbook\. Unpack it"):
        rf.read_motion(tmp_path / "c.zip")
    with zipfile.ZipFile(tmp_path / "d.xlsx", "w") as archive:
        archive.writestr("xl/workbook.xml", "<broken")
    with pytest.raises(rf.InputError, match=r"d\.xlsx cannot be read as an Excel workbook"):
        rf.read_motion(tmp_path / "d.xlsx")


def test_a_workbook_that_unpacks_to_more_than_it_may(tmp_path, monkeypatch):
    file = write(tmp_path, {"S": ROWS})
    monkeypatch.setattr(_excel, "LARGEST", 100)
    with pytest.raises(rf.InputError, match=r"has 0 MB when unpacked, above 0\.0001 MB\. Save it as CSV"):
        rf.read_motion(file)


def test_without_openpyxl(tmp_path, monkeypatch):
    file = write(tmp_path, {"S": ROWS})
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(rf.InputError, match=r"needs openpyxl to be read\. Install it: pip install 'rockflex\[excel\]'"):
        rf.read_motion(file)


def test_the_page_takes_workbooks(tmp_path):
    pytest.importorskip("starlette")
    from rockflex.web._uploads import read_record

    content = io.BytesIO(write(tmp_path, {"S": [["time (s)", "acc (g)"], *ROWS]}).read_bytes())
    assert read_record("mine.xlsx", content.getvalue(), None, None).name == "mine"
