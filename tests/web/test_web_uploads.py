"""Files that visitors send: single records, folders and matrices."""

import asyncio
import io
import json
import time
import tomllib
import zipfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from types import SimpleNamespace
from urllib.parse import urlencode

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from record_samples import cosmos, esm, knet
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.web import _app
from rockflex.web._downloads import file_maker
from rockflex.web._earthquake import record_view
from rockflex.web._folders import (
    SentRecordFile,
    flat_file_names,
    read_record_folder,
    unpacked_record_files,
)
from rockflex.web._limits import MAX_FILE_BYTES, MAX_FOLDER_BYTES, MAX_FOLDER_FILES
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import (
    MAX_RECORDS,
    RecordFolders,
    UploadedRecords,
    clean_upload_name,
    read_uploaded_matrices,
    read_uploaded_record,
    read_uploaded_vertical,
)

HANG = 120.0  # s: a guard against what never ends, not a measure of speed

CSV = b"time (s),acc (g)\n0.00,0.0\n0.01,0.1\n0.02,-0.2\n0.03,0.0\n"
AT2 = (
    b"PEER\nNorthridge-01, 1/17/1994, Beverly, 9\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0100 SEC\n"
    + (b" .1000000E-01 -.2000000E-01 .3000000E-01 .0000000E+00\n")
)


def refusal(call, *arguments):
    begun = time.perf_counter()
    with pytest.raises(Refusal) as caught:
        call(*arguments)
    assert time.perf_counter() - begun < HANG
    (text,) = caught.value.errors.values()
    assert "/tmp" not in text
    return text


def npz(**arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


@pytest.mark.parametrize(("name", "content"), [("quake.csv", CSV), ("RSN1_X.AT2", AT2)])
def test_a_record_is_what_the_library_reads(tmp_path, name, content) -> None:
    (tmp_path / name).write_bytes(content)
    motion, expected = read_uploaded_record(name, content, None, None), rf.read_motion(tmp_path / name)
    assert np.array_equal(motion.acceleration, expected.acceleration)
    assert (motion.dt, motion.name) == (expected.dt, expected.name)


def test_a_column_may_be_vertical_and_comes_back(client, tmp_path) -> None:
    content = b"time (s),acc (m/s2),vertical (m/s2)\n0,0,0\n0.01,1,0.5\n0.02,0,0\n"
    assert read_uploaded_record("a.csv", content, None, None).vertical.tolist() == [0.0, 0.5, 0.0]
    alone = b"time (s),vertical (m/s2)\n0,0\n0.01,1\n0.02,0\n"
    assert "is a vertical component by its header or its name" in refusal(
        read_uploaded_record, "a.csv", alone, None, None
    )
    uploads = UploadedRecords()
    key = uploads.add(read_uploaded_record("a.csv", content, None, None), content, "")
    state = parse_page_state(client.state() | {"record": {"source": "upload", "upload": key}})
    name, saved = file_maker(state, "record", uploads)(lambda *_: None)
    (tmp_path / name).write_bytes(saved)
    assert rf.read_motion(tmp_path / name).vertical.tolist() == [0.0, 0.5, 0.0]
    told = record_view(state, uploads)["measures"]
    assert [each["value"] for each in told if each["name"] in ("PVA", "PVA/PGA")] == [0.5, 0.5]


def test_files_of_networks() -> None:
    east = read_uploaded_record("MYG0020601182325.EW", knet("E-W").encode(), None, None)
    found = (east.name, east.metadata.source_format, east.metadata.direction)
    assert found == ("MYG0020601182325", "K-NET", "horizontal")
    up = read_uploaded_vertical("MYG0020601182325.UD", knet("U-D").encode(), None, None, east)
    assert np.array_equal(up.vertical, east.acceleration)
    assert read_uploaded_record("a.asc", esm().encode(), None, None).pga == 0.12125
    said = refusal(read_uploaded_record, "a.v2c", (cosmos(90) + cosmos(180)).encode(), None, None)
    assert said == "a.v2c holds 2 components: '090', '180'. Choose a file with a single one."


def test_a_name_with_folders_is_no_path(tmp_path) -> None:
    motion = read_uploaded_record("../../etc/pass wd<b>.csv", CSV, None, None)
    assert motion.name == "pass wd_b_"
    assert clean_upload_name("C:\\temp\\..\\a.csv") == "a.csv"
    assert clean_upload_name("/") == "record"
    assert len(clean_upload_name("x" * 500)) == 80


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"", "is empty"),
        (b"\x00\x01\x02" * 99, "is a binary file"),
        (b"hello\nworld\n", "holds no numbers"),
        (b"time (s),acc (g)\n0,1\n1,x\n", "expected a finite number"),
        (b"time (s),acc (g)\n0,0\n0.01,nan\n0.02,0\n", "expected a finite number, but found 'nan'"),
        (b"time (s),acc (g)\n0,0\n0.01,900\n0.02,0\n", "above 5 g"),
        (b"0 1\n0.01 2\n0.02 1\n", "does not state the unit"),
        (b"x" * 5_000_001, "has 5.0 MB, but the page takes 5 MB at most."),
        (b"time (s),acc (g)\n" + b"".join(b"%.2f,0.1\n" % (0.01 * i) for i in range(30_002)), "300 s at most"),
        (b"time (s),acc (g)\n" + b"".join(b"%.4f,0.1\n" % (1e-3 * i) for i in range(200_002)), "200000 samples"),
    ],
)
def test_a_bad_record_is_refused_with_a_reason(content, text) -> None:
    assert text in refusal(read_uploaded_record, "mine.txt", content, None, None)


@pytest.mark.slow
@pytest.mark.parametrize(
    "content",
    [
        b"(" * 2_000_000 + b"\n1.0\n2.0\n",
        b"".join(b"(" * 5000 + b"\n" for _ in range(500)) + b"1 2\n",
        b"1" * 1_000_000 + b"x\n",
        b"NPTS= 4, DT= " + b"1" * 2_000_000 + b"x\n",
        b"4" + b" " * 1_000_000 + b"0.01" + b" " * 1_000_000 + b"x\n",
        b"1,2\n" + b"1" * 4_000_000 + b"\n",
        b"\n".join(b"1." + b"1" * 60 + b"x" for _ in range(60_000)),
        b"a" * 99_000 + b"\n" + b"[" * 990 + b"\n1.0 2.0\n",
    ],
    ids=range(8),
)
def test_a_file_made_to_keep_the_reader_busy_is_refused_in_time(content) -> None:
    for name in ("mine.txt", "mine.at2"):
        refusal(read_uploaded_record, name, content, None, None)


@given(st.binary(max_size=400) | st.text("0123456789.eE+-,; \t\n()[]#NPTSDT=", max_size=300).map(str.encode))
def test_any_bytes_are_a_record_or_a_refusal(content) -> None:
    for name in ("mine.at2", "mine.csv"):
        with suppress(Refusal):
            assert np.isfinite(read_uploaded_record(name, content, "g", 0.01).acceleration).all()


@given(st.data())
def test_a_record_with_a_slip_is_read_or_refused(data) -> None:
    content = bytearray(data.draw(st.sampled_from([CSV, AT2])))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with suppress(Refusal):
        read_uploaded_record("mine.at2", bytes(content), None, None)


def beam(length, ei):
    """Stiffness of a cantilever of two equal elements, with freedoms (w, φ) from the bottom up."""
    h = length / 2.0
    k_e = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], dtype=float)
    k_e *= ei / h**3 * np.outer([1, h, 1, h], [1, h, 1, h])
    k = np.zeros((6, 6))
    for at in (0, 2):
        k[at : at + 4, at : at + 4] += k_e
    return k[2:, 2:]


def test_matrices_are_read() -> None:
    m, k, h = np.diag([2.0, 3.0]), np.array([[4.0, -2.0], [-2.0, 2.0]]), np.array([3.0, 6.0])
    found = read_uploaded_matrices("fe.npz", npz(mass=m, stiffness=k, heights=h), "")
    assert found == {"mass": m.tolist(), "stiffness": k.tolist(), "heights": h.tolist()}
    assert read_uploaded_matrices("k.csv", b"4,-2\n-2,2\n", "stiffness") == {"stiffness": k.tolist()}
    assert read_uploaded_matrices("h.csv", b"3\n6\n", "heights") == {"heights": [3.0, 6.0]}


NAN = np.nan
BAR = {"mass": [30e3, 0.0, 80e3, 0.0], "stiffness": beam(16.0, 4e9)}
SCALARS = {"base_mass": 60e3, "half_width": 1.8, "damping_ratio": 0.02}


@pytest.mark.parametrize(
    "heights",
    [[8.0, NAN, 16.0, NAN], [8.0, 8.0, 16.0, 16.0], [8.0, 0.0, 16.0, 0.0], [8.0, 16.0], [[0.0, 8.0], [2.0, 16.0]]],
)
def test_rotations_are_imported_in_any_layout(client, heights) -> None:
    expected = rf.from_matrices(**BAR, heights={0: 8.0, 2: 16.0}, rotations=[1, 3], **SCALARS)
    found = read_uploaded_matrices("fe.npz", npz(**BAR, heights=heights, rotations=[1, 3]), "")
    view = client.ask("/api/structure", client.state(structure={"matrices": found | SCALARS}))
    periods = [mode["period"] for mode in view["modes"]]
    np.testing.assert_allclose(periods, expected.modal().period, rtol=1e-12)
    assert [each["value"] for each in view["properties"] if each["symbol"] == "I_θ"] == pytest.approx(
        [expected.rocking().i_theta], rel=1e-12
    )
    assert view["freedoms"] == "Degrees of freedom: 2 sideways, 2 rotational. Without mass, and condensed out: 2."
    state = client.state(structure={"matrices": found | SCALARS})
    again = StructureEntry.model_validate(client.ask("/api/state", state)["structure"]).build()
    np.testing.assert_allclose(again.modal().period, expected.modal().period, rtol=1e-12)


@pytest.mark.parametrize(
    ("content", "part", "found"),
    [
        (b"8,nan,16,nan\n", "heights", {"0": 8.0, "2": 16.0}),
        (b"8,,16,-\n", "heights", {"0": 8.0, "2": 16.0}),
        (b"0,8\n2,16.5\n", "heights", {"0": 8.0, "2": 16.5}),
        (b"0;8\n2;16,5\n", "heights", {"0": 8.0, "2": 16.5}),
        (b"1\n3\n", "rotations", [1, 3]),
        (b"4,5;-2\n-2;2\n", "stiffness", [[4.5, -2.0], [-2.0, 2.0]]),
        (b"4.5e0 -2\n-2 2\n", "stiffness", [[4.5, -2.0], [-2.0, 2.0]]),
        (b"8\tnan\t16\tnan\n", "heights", {"0": 8.0, "2": 16.0}),
    ],
)
def test_freedoms_in_csv_files(content, part, found) -> None:
    assert read_uploaded_matrices("a.csv", content, part) == {part: found}


@pytest.mark.parametrize(
    ("name", "content", "part", "text"),
    [
        ("r.csv", b"1.5\n", "rotations", "whole indices of freedoms, counted from 0, but 1.5"),
        ("h.csv", b"0.5,3\n1,6\n2,9\n", "heights", "whole indices"),
        ("h.csv", b"0,3\n0,6\n", "heights", "each freedom once"),
        ("h.csv", b"0,3\nnan,6\n", "heights", "whole indices"),
        ("h.csv", b"nan\nnan\n", "heights", "finite numbers"),
        ("k.csv", b"4,\n,2\n", "stiffness", "finite numbers"),
        ("k.csv", b"4,-2\n-2,2\n", "soul", "say which of mass, stiffness, heights, rotations"),
        ("k.csv", b"4,x\n", "mass", "does not hold matrices that can be read"),
        ("k.csv", b"4,nan\n", "mass", "mass must hold finite numbers"),
        ("k.csv", b"", "mass", "k.csv"),
        ("k.npz", b"PK", "", "does not hold matrices that can be read"),
        ("k.npz", npz(mass=np.eye(2)), "", "must hold the arrays mass, stiffness and heights"),
        ("k.npz", npz(stiffness=np.eye(201)), "", "numbers for up to 200 freedoms are expected"),
        ("k.npz", npz(stiffness=np.array(["a"])), "", "numbers for up to 200 freedoms are expected"),
        ("k.npz", npz(stiffness=np.array([{}], dtype=object)), "", "numbers for up to 200 freedoms are expected"),
        ("k.npz", b"x" * 5_000_001, "", "5 MB at most"),
    ],
)
def test_bad_matrices_are_refused_with_a_reason(name, content, part, text) -> None:
    assert text in refusal(read_uploaded_matrices, name, content, part)


def test_a_file_that_unpacks_to_gigabytes_is_refused_before_it_is_unpacked() -> None:
    file = io.BytesIO()
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (50_000, 50_000)})
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("stiffness.npy", header.getvalue() + bytes(4_000_000))
    assert "numbers for up to 200 freedoms" in refusal(read_uploaded_matrices, "k.npz", file.getvalue(), "")


@given(st.binary(max_size=300))
def test_any_bytes_are_matrices_or_a_refusal(content) -> None:
    for name in ("k.npz", "k.csv"):
        with suppress(Refusal):
            read_uploaded_matrices(name, content, "mass")


def test_the_latest_records_are_kept_by_their_checksum() -> None:
    kept, motion = UploadedRecords(), rf.quiet_motion(1.0)
    keys = [kept.add(motion, bytes([i]), "") for i in range(MAX_RECORDS + 1)]
    assert kept.get(keys[-1]) is motion
    with pytest.raises(Refusal, match=r"which a link does not contain\. Choose the file again\.") as caught:
        kept.get(keys[0])
    assert caught.value.status == 410


def test_a_vertical_component_joins_its_record_and_contradictions_are_told(tmp_path):
    along = read_uploaded_record("a.csv", CSV, None, None)
    rows = "".join(f"{along.dt * i:.4f},{0.1 * i}\n" for i in range(along.acceleration.size))
    both = read_uploaded_vertical("up.csv", f"time (s),vertical (m/s2)\n{rows}".encode(), None, None, along)
    np.testing.assert_array_equal(both.acceleration, along.acceleration)
    assert both.vertical.tolist() == pytest.approx([0.1 * i for i in range(along.acceleration.size)])
    assert both.name == "a"
    east = f"Event, 1/1/2001, Station, 090\nUNITS OF G\nNPTS= 4, DT= {along.dt}\n0 .3 -.2 0\n"
    for name, content, said in (
        ("RSN1_X_ABC090.AT2", east.encode(), "is a horizontal component"),
        ("up.csv", b"nothing\n", "up.csv"),
    ):
        assert said in refusal(read_uploaded_vertical, name, content, None, None, along)


def test_a_vertical_file_is_uploaded_under_its_record(client):
    def send(name, content, **query):
        path = f"/api/upload?{urlencode({'name': name, **query})}"
        status, _, body = client.request(path, content, Content_Type="application/octet-stream")
        return status, json.loads(body)

    _, first = send("a.csv", b"time (s),acc (m/s2)\n0,0\n0.01,1\n0.02,0\n")
    assert first["pva"] is None
    _, second = send("up.csv", b"time (s),vertical (m/s2)\n0,0\n0.01,0.5\n0.02,0\n", under=first["upload"])
    assert (second["name"], second["pga"], second["pva"]) == ("a", 1.0, 0.5)
    assert second["upload"] != first["upload"]
    view = client.ask("/api/record", client.state(record={"source": "upload", "upload": second["upload"]}))
    assert view["vertical"] is not None
    status, answer = send("up.csv", b"0\n", under="0" * 64)
    assert (status, list(answer["errors"])) == (410, ["record.upload"])


FLAT = (
    " -- Summary of Metadata of Selected Records --\n"
    "Record Sequence Number, Magnitude, Rrup (km), Vs30 (m/sec), Horizontal-1 Acc. Filename\n"
    "7, 6.6, 12.1, 366.0, RSN7_TEST000.AT2\n"
)


def at2(size: float, component: str = "0", n: int = 120, dt: float = 0.01) -> str:
    rows = "\n".join(f" {size * np.sin(0.3 * i):.7E}" for i in range(n))
    head = f"PEER\nSome Event, 1/1/2001, Some Station, {component}\nACCELERATION TIME SERIES IN UNITS OF G\n"
    return f"{head}NPTS= {n}, DT= {dt} SEC\n{rows}\n"


GIVEN = {
    "set/RSN7_TEST000.AT2": at2(0.2).encode(),
    "set/RSN7_TEST090.AT2": at2(0.3, "90").encode(),
    "set/RSN7_TEST-UP.AT2": at2(0.1, "UP").encode(),
    "set/other/alone.csv": b"time (s),acc (m/s2)\n0.00,0\n0.02,1.5\n0.04,-0.5\n0.06,0\n",
    "set/_SearchResults.csv": FLAT.encode(),
    "set/notes.txt": b"Downloaded in spring <b>2001</b>\n",
    "set/.DS_Store": b"\x00\x01",
    "set/picture.png": b"\x89PNG",
}


def body_of(files: dict[str, bytes], **more: object) -> bytes:
    head = [{"name": name, "size": len(content), "sent": True, **more} for name, content in files.items()]
    return json.dumps(head).encode() + b"\n" + b"".join(files.values())


def zipped(files: dict[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return packed.getvalue()


def give(client, body: bytes, query: str = ""):
    status, _, answer = client.request("/api/folder" + query, body, Content_Type="application/octet-stream")
    return status, json.loads(answer)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("records")
    for name, content in GIVEN.items():
        (place / name.rsplit("/", 1)[-1]).write_bytes(content)
    return place


@pytest.mark.parametrize("archive", [False, True])
def test_a_folder_is_what_the_library_surveys(client, folder, archive) -> None:
    status, found = give(client, body_of({"records.zip": zipped(GIVEN)} if archive else GIVEN))
    assert status == 200
    expected = rf.survey_records(folder)
    assert [each["file"] for each in found["entries"]] == [each.file for each in expected.entries]
    for entry, told in zip(found["entries"], expected.entries, strict=True):
        assert entry["taken"] == told.taken
        for name, other in (("pga", "pga"), ("dt", "dt"), ("magnitude", "magnitude"), ("distance", "distance_km")):
            assert entry[name] == getattr(told, other)
        if not entry["taken"] and not entry["paired"]:
            assert entry["reason"] == told.reason != ""
    by_name = {each["name"]: each for each in found["entries"] if each["taken"]}
    assert set(by_name) == {"RSN7_TEST000", "RSN7_TEST090", "alone"}
    assert (by_name["RSN7_TEST000"]["vs30"], by_name["RSN7_TEST000"]["magnitude"]) == (366.0, 6.6)
    assert [by_name[name]["vertical"] for name in sorted(by_name)] == [True, True, False]
    station = next(each for each in found["stations"] if each["name"] == "RSN7")
    assert (station["horizontal"], station["vertical"]) == (["RSN7_TEST000", "RSN7_TEST090"], "RSN7_TEST-UP")
    units = [each for each in found["findings"] if each.startswith("unit: g (")]
    assert any("RSN7_TEST000.AT2" in each for each in units)
    # The page asks again after it was reloaded.
    assert json.loads(client.request(f"/api/folder/{found['folder']}")[2]) == found


def test_a_folder_is_reported_in_the_language_of_the_page(client) -> None:
    _, found = give(client, body_of(GIVEN), "?language=de")
    reasons = {entry["file"]: entry["reason"] for entry in found["entries"]}
    assert reasons["RSN7_TEST-UP.AT2"] == "vertikale Komponente, mit den horizontalen verwendbar"
    assert give(client, body_of(GIVEN), "?language=la")[0] == 422


def test_a_record_of_it_is_simulated_with_and_without_its_vertical_component(client, folder, frame) -> None:
    _, found = give(client, body_of(GIVEN))
    choice = {"source": "folder", "folder": found["folder"], "given": "RSN7_TEST000"}
    for vertical, pair in ((False, None), (True, "pair")):
        motion = rf.survey_records(folder, vertical=pair).suite()["RSN7_TEST000"]
        state = client.state(record=choice | {"vertical": vertical}, models=["2DOF-S"], scale=3.0)
        run = rf.simulate(frame, motion.scaled(3.0), "2DOF-S", free_vibration=5.0)
        (told,) = client.ask("/api/response", state)["models"]
        assert told["peaks"]["max_rotation"] == run.max_rotation
        measures = {each["name"]: each["value"] for each in client.ask("/api/record", state)["measures"]}
        assert ("PVA" in measures) == vertical
        assert measures["PGA"] == motion.scaled(3.0).pga
    errors = client.refused("/api/record", client.state(record=choice | {"given": "RSN8"}))
    assert "is named 'RSN8'" in errors["record.folder"]


def test_a_study_of_it_its_archive_its_file_and_its_program(client, tmp_path, frame, monkeypatch) -> None:
    _, found = give(client, body_of(GIVEN))
    record = {"folder": found["folder"], "vertical": True}
    cloud = {"suites": ["given"], "models": ["2DOF-S"], "scales": [2.0, 4.0]}
    state = client.state(record=record, cloud=cloud)
    token, answer = client.study("cloud", state)
    assert answer["status"] == "done"
    table = client.download(f"/api/study/cloud/{token}/table", state)[1]
    name, packed = client.download("/api/file/records", state)
    assert name == "your-records.zip"
    zipfile.ZipFile(io.BytesIO(packed)).extractall(tmp_path / "records")
    suite = rf.read_suite(tmp_path / "records")
    assert [motion.vertical is not None for motion in suite] == [True, True, False]
    assert suite["RSN7_TEST000"].metadata.magnitude == 6.6
    runs = rf.run_cloud(frame, suite, ["2DOF-S"], scales=[2.0, 4.0], free_vibration="settle")
    told = pd.read_csv(io.BytesIO(table)).sort_values(["motion", "scale"])
    assert told["max_rotation"].to_numpy() == pytest.approx(
        runs.sort_values(["motion", "scale"])["max_rotation"].to_numpy(), rel=1e-12
    )
    text = client.download("/api/file/cloud-study", state)[1].decode()
    assert "# Unpack the records, which the page saves as records.zip, into the folder records" in text
    (tmp_path / "cloud.toml").write_text(text)
    records = tomllib.loads(text)["records"]
    assert rf.CloudStudy(**tomllib.loads(text)).read_from(tmp_path).plan().n_runs == 6
    assert records["folder"] == "records"
    monkeypatch.chdir(tmp_path)
    space = client.program("cloud-python", state)
    assert space["runs"]["max_rotation"].max() == pytest.approx(runs["max_rotation"].max(), rel=1e-12)


def test_a_folder_that_the_server_does_not_have(client) -> None:
    state = client.state(record={"source": "folder", "folder": "0" * 64, "given": "x"})
    status, answer = client.post("/api/record", {"state": state})
    assert status == 410
    assert "Give the folder again" in answer["errors"]["record.folder"]
    errors = client.refused("/api/study/cloud", client.state(cloud={"suites": ["given"]}))
    assert errors == {"cloud.suites": "no records were given yet. Choose a folder on the Earthquake tab first."}
    assert client.request("/api/folder/" + "0" * 64)[0] == 410


@pytest.mark.parametrize("name", ["../a.AT2", "set/../../a.AT2", "/etc/a.AT2", "C:\\a.AT2", "..\\a.AT2"])
def test_names_that_point_out_of_the_folder_are_refused(name) -> None:
    content = at2(0.2).encode()
    for body in (body_of({name: content}), body_of({"a.zip": zipped({name: content})})):
        assert "points out of its folder" in refusal(unpacked_record_files, body)


def test_archives_that_grow_are_refused() -> None:
    zeros = b"0\n" * (MAX_FILE_BYTES // 2 - 10)
    bomb = zipped({f"{i}.txt": zeros for i in range(MAX_FOLDER_BYTES // len(zeros) + 1)})
    assert len(bomb) < MAX_FOLDER_BYTES / 50
    assert refusal(unpacked_record_files, body_of({"bomb.zip": bomb})) == (
        "the files have more than 80 MB, which is more than the page takes. Choose fewer."
    )
    single = zipped({"a.AT2": at2(0.2).encode(), "large.txt": b"0\n" * MAX_FILE_BYTES})
    files = {each.name: each for each in unpacked_record_files(body_of({"one.zip": single}))}
    assert files["large.txt"].content is None
    assert files["a.AT2"].content is not None
    many = zipped({f"{i}.txt": b"" for i in range(MAX_FOLDER_FILES + 1)})
    assert "501 files, more than 500" in refusal(unpacked_record_files, body_of({"many.zip": many}))
    assert "more than 500 files" in refusal(
        unpacked_record_files, body_of({f"{i}.txt": b"" for i in range(MAX_FOLDER_FILES + 1)})
    )
    book = zipped({"xl/workbook.xml": b"0" * (MAX_FOLDER_BYTES + 1)})
    assert "more than 80 MB" in refusal(unpacked_record_files, body_of({"book.xlsx": book}))


def test_damaged_requests_and_archives_are_refused(client) -> None:
    assert "damaged archive" in refusal(unpacked_record_files, body_of({"a.zip": b"PK\x03\x04 and no more"}))
    assert refusal(unpacked_record_files, body_of({})) == "there is no file in it."
    for body in (b"", b"no list\n", b"{}\n", b'[{"name": 3}]\n', b'[{"name": "a", "size": 9, "sent": true}]\nabc',
                 b"[]\nabc", b'[{"name": "a", "size": -1, "sent": true}]\n', b"[" * 3000 + b"\n"):  # fmt: skip
        status, answer = give(client, body)
        assert 400 <= status < 500, (body, answer)
    status, answer = give(client, body_of({"a.txt": b"no numbers\n"}))
    assert status == 422
    assert "none of the files is a horizontal record" in answer["errors"]["record.folder"]
    assert "a.txt: holds no numbers" in answer["errors"]["record.folder"]
    assert "holds no record" in give(client, body_of({"a.png": b"x"}))[1]["errors"]["record.folder"]
    status, answer = give(client, body_of(GIVEN), "?dt=fast")
    assert answer["errors"]["record.folder"] == "the sampling step must be a number in s, but 'fast' was given."


def test_names_in_one_folder_differ_and_are_short() -> None:
    names = flat_file_names(
        ["a/x.txt", "b/x.txt", "b/X.TXT", "x.txt", "a/" + "y" * 300 + ".AT2", "c/a<b>|?.csv", "a/."]
    )
    assert len({name.casefold() for name in names}) == len(names)
    assert max(map(len, names)) < 100
    assert names[4].endswith(".AT2")
    long = flat_file_names(
        ["\N{VOLCANO}" * 75 + ".csv", "b/" + "\N{VOLCANO}" * 75 + ".csv", "c." + "\N{VOLCANO}" * 75] * 2
    )
    assert len(set(long)) == 6
    assert all(len(name.encode()) <= 255 and name.isprintable() for name in long)
    assert not any(set('<>:"|?*/\\') & set(name) for name in names)


def test_records_too_long_are_left_out_and_files_of_one_name_are_told_apart() -> None:
    long = at2(0.2, n=3101, dt=0.1).encode()
    same = b"time (s),acc (m/s2)\n0.00,0\n0.02,1\n0.04,0\n"
    found = read_record_folder(
        [
            SentRecordFile("long.AT2", long, len(long)),
            SentRecordFile("x.csv", same, len(same)),
            SentRecordFile("x.txt", same, 1),
        ],
        None,
        None,
    )
    assert found.along.names == ("x-1", "x-2")
    entry = next(each for each in found.report["entries"] if each["file"] == "long.AT2")
    assert not entry["taken"]
    assert "3101 samples over 310 s, but the page takes" in entry["reason"]
    large = read_record_folder(
        [SentRecordFile("x.csv", same, 40), SentRecordFile("big.csv", None, 7_000_000)], None, None
    )
    assert large.report["entries"][0]["reason"] == "it has 7.0 MB, but the page takes files of 5 MB at most"


def test_only_as_many_folders_are_kept_as_there_is_room_for(monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._uploads.MAX_CACHED_SAMPLES", 300)
    folders, tokens = RecordFolders(), []
    for size in (0.1, 0.2, 0.3):
        files = [SentRecordFile("a.AT2", at2(size).encode(), 1)]
        tokens.append(folders.add(read_record_folder(files, None, None), files, ""))
    assert "Give the folder again" in refusal(folders.get, tokens[0])
    assert folders.get(tokens[2]).along[0].pga == pytest.approx(0.3 * 9.81, rel=0.01)


def test_only_a_few_folders_are_received_at_once(monkeypatch) -> None:
    body, inside, seen = body_of(GIVEN), [0], list[int]()

    async def file_of(*_: object) -> bytes:
        inside[0] += 1
        await asyncio.sleep(0.01)
        return body

    async def answer(_request, work, _most: int):
        await asyncio.sleep(0.01)
        found = work()
        seen.append(inside[0])
        inside[0] -= 1
        return found

    monkeypatch.setattr(_app, "uploaded_file_bytes", file_of)
    request = SimpleNamespace(query_params={})
    server = _app.PageServer()
    monkeypatch.setattr(server, "run", answer)

    async def all_at_once() -> list[int]:
        return [each.status_code for each in await asyncio.gather(*(server.folder(request) for _ in range(8)))]

    with ThreadPoolExecutor() as pool:  # the thread of the tests may have the event loop of a browser
        assert pool.submit(lambda: asyncio.run(all_at_once())).result() == [200] * 8
    assert max(seen) == _app.MAX_FOLDERS_RECEIVED
