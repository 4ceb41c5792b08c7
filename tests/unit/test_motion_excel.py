"""Records in Excel workbooks."""

import datetime as dt
import io
import re
import subprocess
import sys
import zipfile

import pytest

import rockflex as rf
from rockflex.motion import _excel
from rockflex.motion._columns import record_csv

openpyxl = pytest.importorskip("openpyxl")
ROWS = [[0.0, 0.1], [0.01, -0.25], [0.02, 1 / 3], [0.03, 0]]
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
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


def write_excel(folder, sheets, name="records.xlsx"):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title, rows in sheets.items():
        sheet = book.create_sheet(title)
        for row in rows:
            sheet.append(row)
    book.save(folder / name)
    return folder / name


def test_a_sheet_is_read_as_columns_are(tmp_path):
    file = write_excel(tmp_path, {"S": [["Laboratory", None], [], ["time (s)", "Acc (g)"], *ROWS]})
    motion = rf.read_motion(file)
    assert motion.acceleration.tolist() == [9.81 * row[1] for row in ROWS]  # every digit of the cells
    assert (motion.dt, motion.name, motion.metadata.source_format) == (0.01, "records", "columns")


def test_empty_columns_and_rows_are_passed_over(tmp_path):
    rows = [[None, None, None, "note"], [None, "time (s)", None, "acc (m/s2)"]]
    rows += [[None, t, None, a] for t, a in ROWS] + [[None], [None]]
    assert rf.read_motion(write_excel(tmp_path, {"S": rows})).acceleration.tolist() == [row[1] for row in ROWS]


def test_units_and_step_from_the_caller(tmp_path):
    file = write_excel(tmp_path, {"S": [[a] for _, a in ROWS]})
    assert rf.read_motion(file, units="cm/s2", dt=0.02).pga == pytest.approx(0.01 / 3)
    with pytest.raises(rf.InputError, match=r"records\.xlsx does not state the unit of its acceleration"):
        rf.read_motion(file)


def test_components_in_columns_and_in_sheets(tmp_path):
    head = ["time (s)", "NS (gal)", "EW (gal)", "UD (gal)"]
    both = {"first": [head, *([t, a, 2 * a, 3 * a] for t, a in ROWS)], "notes": [["nothing"]]}
    found = rf.read_components(write_excel(tmp_path, both))
    assert [motion.name for motion in found] == ["records-NS", "records-EW", "records-UD"]
    assert [motion.metadata.direction for motion in found] == ["horizontal", "horizontal", "vertical"]
    assert rf.read_motion(tmp_path / "records.xlsx", component="ew").pga == pytest.approx(0.02 / 3)
    sheets = {"A": [["t", "acc (g)"], *ROWS], "B": [["t", "acc (g)"], *ROWS]}
    write_excel(tmp_path, sheets, "two.xlsx")
    assert [motion.name for motion in rf.read_components(tmp_path / "two.xlsx")] == ["two-A", "two-B"]
    assert rf.read_suite([tmp_path / "two.xlsx"]).names == ("two-A", "two-B")
    sheets["B"] = [["t", "acc"], *ROWS]
    with pytest.raises(rf.InputError, match=r"Sheet 'B': .*two\.xlsx does not state the unit"):
        rf.read_components(write_excel(tmp_path, sheets, "two.xlsx"))


def test_refuses_excel(tmp_path):
    (tmp_path / "a.xls").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"0" * 100)
    (tmp_path / "b.xlsx").write_bytes(b"PK\x03\x04" + b"0" * 100)
    for name, part, text in (("c.zip", "a.txt", "0 1"), ("d.xlsx", "xl/workbook.xml", "<broken")):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr(part, text)
    write_excel(tmp_path, {"S": [["a", "b"]]}, "empty.xlsx")
    write_excel(tmp_path, {"S": [["t", "acc (g)"], [0, 1], [1, "x"], [2, 3]]}, "x.xlsx")
    for name, message in (
        ("a.xls", "a workbook of the old format. Save it as .xlsx or CSV"),
        ("b.xlsx", "a damaged archive or workbook. Download it again"),
        ("c.zip", "an archive, but no workbook. Unpack it"),
        ("d.xlsx", "cannot be read as an Excel workbook"),
        ("empty.xlsx", "holds no numbers: a sheet is expected"),
        ("x.xlsx", "row 3: 'x' is no number"),
    ):
        with pytest.raises(rf.InputError, match=re.escape(message)) as caught:
            rf.read_motion(tmp_path / name)
        assert name in str(caught.value)


LABELS = ["time (s)", "acc (g)"]


@pytest.mark.parametrize("state", ["hidden", "veryHidden"])
def test_hidden_sheets_are_left_out_with_a_word(tmp_path, state):
    book = openpyxl.load_workbook(
        write_excel(tmp_path, {"new": [LABELS, *ROWS], "old": [LABELS, *ROWS], "n": [["no"]]})
    )
    book["old"].sheet_state = book["n"].sheet_state = state
    book.save(tmp_path / "a.xlsx")
    with pytest.warns(rf.RecordWarning, match=r"a\.xlsx: left out hidden sheet 'old'\.$"):
        assert [motion.name for motion in rf.read_components(tmp_path / "a.xlsx")] == ["a"]
    book["new"].sheet_state = state
    book.create_sheet("empty")
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(rf.InputError, match=r"holds no numbers.*hidden sheet 'new', hidden sheet 'old'; unhide"):
        rf.read_motion(tmp_path / "a.xlsx")


def test_hidden_columns_are_left_out_and_hidden_rows_refused(tmp_path):
    file = write_excel(tmp_path, {"S": [["time (s)", "acc (g)", "acc Y (g)", None], *([t, a, 2 * a] for t, a in ROWS)]})
    book = openpyxl.load_workbook(file)
    book["S"].column_dimensions.group("C", "H", hidden=True)
    book.save(file)
    with pytest.warns(rf.RecordWarning, match=r"records\.xlsx: left out hidden column C of sheet 'S'\.$"):
        assert rf.read_motion(file).acceleration.tolist() == [9.81 * a for _, a in ROWS]
    book["S"].row_dimensions[4].hidden = True
    book.save(file)
    with pytest.raises(rf.InputError, match=r"records\.xlsx, row 4 is hidden among the numbers"):
        rf.read_motion(file)


def test_sheets_of_something_else_beside_a_record(tmp_path):
    peaks = [["story", "drift (%)"], [1, 0.2], [2, 0.3], [3, 0.1]]
    target = [["Period (s)", "Sa (g)"], [0.0, 0.3], [0.1, 0.75], [0.2, 0.75]]
    file = write_excel(tmp_path, {"record": [LABELS, *ROWS], "peaks": peaks, "target": target})
    said = r"^records\.xlsx: left out sheet 'peaks' \(table\), sheet 'target' \(spectrum\)\.$"
    with pytest.warns(rf.RecordWarning, match=said):
        assert [motion.name for motion in rf.read_components(file)] == ["records"]
    with pytest.raises(rf.InputError, match=r"records\.xlsx"):
        rf.read_motion(write_excel(tmp_path, {"peaks": peaks}))


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([LABELS, [0.0, 0.1], [0.01, "#N/A"], [0.02, 0.1]], ("row 3", "#N/A", "error")),
        ([LABELS, [0.0, "#DIV/0!"], [0.01, 0.1], [0.02, 0.1]], ("row 2", "#DIV/0!")),
        ([LABELS, [0.0, "x"], [0.01, 0.1], [0.02, 0.1]], ("row 2", "'x'")),
        ([LABELS, [0.0, 0.1, None, "Event"], [0.01, 0.1], [0.02, 0.1]], ("row 2", "'Event'")),
        ([LABELS, [0.0, 0.1], [0.01, None], [0.02, 0.1]], ("row 3", "column B")),
        ([LABELS, [0.0, 0.1], [0.01, 0.2], [0.02, 0.1], [0.03]], ("row 5", "column B")),
        ([LABELS, *ROWS, [], LABELS, *ROWS], ("row 7", "second block", "sheet of its own")),
        ([["acc (g)"], *([a] for _, a in ROWS), [], *([a] for _, a in ROWS)], ("row 7", "second block")),
        ([[*LABELS, None, "T (s)", "Sa (g)"], [0, 0.1, None, 0.1, 0.3], [1, 0.1], [2, 0.1]], ("row 3", "side by side")),
        ([["t", "acc (g)"], *([dt.datetime(2020, 1, 1, 0, 0, k), 0.1] for k in range(4))], ("dates", "dt=0.01")),
        ([["t", "acc (g)"], *([dt.time(10, 0, k), 0.1] for k in range(4))], ("times of day", "dt=0.01")),
        ([LABELS, [0.0, 0.1], [0.01, "=B2*2"], [0.02, 0.1]], ("row 3", "formula has no stored value", "LibreOffice")),
        ([LABELS, ["=0", "=1"], ["=A2+0.01", "=B2*2"]], ("row 2", "formula has no stored value")),
        ([LABELS, *([t, "=0.1"] for t, _ in ROWS)], ("row 2", "formula has no stored value")),
    ],
)
def test_cells_without_a_number_are_refused_with_their_row(tmp_path, rows, words):
    with pytest.raises(rf.InputError) as caught:
        rf.read_motion(write_excel(tmp_path, {"S": rows}), dt=0.01 if "acc (g)" in rows[0][:1] else None)
    assert all(word in str(caught.value) for word in ("records.xlsx", *words))


def test_what_stands_above_the_numbers(tmp_path):
    rows = [["Peak", "=MAX(B5:B8)"], [dt.datetime(1999, 8, 17), 7.4], ["NPTS", 4], LABELS, *ROWS]
    assert rf.read_motion(write_excel(tmp_path, {"S": rows})).acceleration.size == 4


def test_a_workbook_that_unpacks_to_more_than_it_may(tmp_path, monkeypatch):
    file = write_excel(tmp_path, {"S": ROWS})
    monkeypatch.setattr(_excel, "MAX_UNPACKED_BYTES", 100)
    with pytest.raises(rf.InputError, match=r"more than 0\.0001 MB when unpacked\. Save it as CSV"):
        rf.read_motion(file)


def crafted(folder, last_row, dimension="", columns=""):
    """Write a workbook of some kilobytes: three rows of a record, and one far below them."""
    cells = [f"<c><v>{0.01 * k:.2f}</v></c><c><v>{a}</v></c>" for k, a in enumerate((0.1, -0.2, 0.3, 0.0))]
    places = [*range(1, len(cells)), last_row]
    rows = "".join(f'<row r="{place}">{each}</row>' for place, each in zip(places, cells, strict=True))
    sheet = f'<worksheet xmlns="{MAIN}">{dimension}<sheetData>{rows}{columns}</sheetData></worksheet>'
    file = folder / "far.xlsx"
    with (
        zipfile.ZipFile(write_excel(folder, {"S": []}, "empty.xlsx")) as empty,
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for name in empty.namelist():
            archive.writestr(name, sheet if name.endswith("sheet1.xml") else empty.read(name))
    return file


@pytest.mark.slow
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
    file = crafted(tmp_path, last_row, **more)
    found = subprocess.run(
        [sys.executable, "-c", BOUNDED, file], capture_output=True, text=True, timeout=60.0, check=False
    )
    assert found.returncode == 0, found.stderr
    assert said in found.stdout


def test_a_written_record_that_a_spreadsheet_saved_keeps_what_is_known(tmp_path):
    info = rf.RecordInfo(event="Kocaeli, Turkey", year=1999, scale=1.5)
    written = record_csv(rf.GroundMotion([0.0, 1.0, 0.0], 0.01, metadata=info))
    (tmp_path / "a.csv").write_text(re.sub("^#.*", r"\g<0>,", written, flags=re.MULTILINE))
    rows = [[line] if "#" in line else line.split(",") for line in written.splitlines()]
    for file in (tmp_path / "a.csv", write_excel(tmp_path, {"S": rows})):
        found = rf.read_motion(file).metadata
        assert (found.event, found.year, found.scale) == ("Kocaeli, Turkey", 1999, 1.5)


def test_without_openpyxl(tmp_path, monkeypatch):
    file = write_excel(tmp_path, {"S": ROWS})
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(rf.InputError, match=r"needs openpyxl to be read\. Install it: pip install 'rockflex\[excel\]'"):
        rf.read_motion(file)


def test_the_page_takes_workbooks(tmp_path):
    from rockflex.web._uploads import read_uploaded_record

    content = io.BytesIO(write_excel(tmp_path, {"S": [["time (s)", "acc (g)"], *ROWS]}).read_bytes())
    assert read_uploaded_record("mine.xlsx", content.getvalue(), None, None).name == "mine"
