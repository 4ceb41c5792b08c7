"""Excel workbooks, written with openpyxl."""

import io
import re
import subprocess
import sys
import zipfile

import pytest

import rockflex as rf
from rockflex.motion import _columns

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
    monkeypatch.setattr(_columns, "MAX_UNPACKED_BYTES", 100)
    with pytest.raises(rf.InputError, match=r"has 0 MB when unpacked, above 0\.0001 MB\. Save it as CSV"):
        rf.read_motion(file)


MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
KINDS = "application/vnd.openxmlformats-officedocument.spreadsheetml."
PARTS = {
    "[Content_Types].xml": f'<Types xmlns="{PACKAGE}/content-types">'
    f'<Override PartName="/xl/workbook.xml" ContentType="{KINDS}sheet.main+xml"/>'
    f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{KINDS}worksheet+xml"/></Types>',
    "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}">'
    '<sheets><sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>',
    "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}/relationships">'
    f'<Relationship Id="r1" Type="{OFFICE}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
}
BOUNDED = """
import resource, sys
import rockflex as rf
import openpyxl
resource.setrlimit(resource.RLIMIT_AS, (2_000_000_000, 2_000_000_000))
try:
    print(rf.read_motion(sys.argv[1], units="g").acceleration.size)
except rf.InputError as error:
    print(error)
"""


def crafted(file, last_row, dimension="", columns=""):
    """Write a workbook of some kilobytes: three rows of a record, and one far below them."""
    cells = [f"<c><v>{0.01 * k:.2f}</v></c><c><v>{a}</v></c>" for k, a in enumerate((0.1, -0.2, 0.3, 0.0))]
    places = [*range(1, len(cells)), last_row]
    rows = "".join(f'<row r="{place}">{each}</row>' for place, each in zip(places, cells, strict=True))
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in PARTS.items():
            archive.writestr(name, text)
        sheet = f'<worksheet xmlns="{MAIN}">{dimension}<sheetData>{rows}{columns}</sheetData></worksheet>'
        archive.writestr("xl/worksheets/sheet1.xml", sheet)
    return file


@pytest.mark.skipif(sys.platform == "win32", reason="the memory of a process is limited as on Unix")
@pytest.mark.parametrize(
    ("last_row", "more", "said"),
    [
        (2**20, {"dimension": '<dimension ref="A1:XFD1048576"/>'}, "4"),
        (10**12, {}, "million cells lie before its last filled ones"),
        (4, {"columns": "".join(f'<row r="{k}"><c r="XFD{k}"/></row>' for k in range(5, 30_000))}, "million cells lie"),
        (4, {"columns": f"<row>{8_000_000 * '<c/>'}</row>"}, "row of more than 2 MB"),
    ],
    ids=["claimed size", "row far below", "columns far away", "one long row"],
)
def test_a_small_workbook_with_cells_far_apart_takes_little_time_and_memory(tmp_path, last_row, more, said):
    file = crafted(tmp_path / "far.xlsx", last_row, **more)
    found = subprocess.run(
        [sys.executable, "-c", BOUNDED, file], capture_output=True, text=True, timeout=60.0, check=False
    )
    assert found.returncode == 0, found.stderr
    assert said in found.stdout


def test_a_written_record_that_a_spreadsheet_saved_keeps_what_is_known(tmp_path):
    info = rf.RecordInfo(event="Kocaeli, Turkey", year=1999, scale=1.5)
    written = rf.motion.record_csv(rf.GroundMotion([0.0, 1.0, 0.0], 0.01, metadata=info))
    (tmp_path / "a.csv").write_text(re.sub("^#.*", r"\g<0>,", written, flags=re.MULTILINE))
    rows = [[line] if "#" in line else line.split(",") for line in written.splitlines()]
    for file in (tmp_path / "a.csv", write(tmp_path, {"S": rows})):
        found = rf.read_motion(file).metadata
        assert (found.event, found.year, found.scale) == ("Kocaeli, Turkey", 1999, 1.5)


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
