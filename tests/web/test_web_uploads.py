"""Files of visitors: good ones are read as the library reads them, bad ones are refused, and quickly."""

import io
import json
import time
import tomllib
import zipfile
from contextlib import suppress
from urllib.parse import urlencode

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from record_samples import cosmos, esm, knet
from rockflex.structure.file import StructureEntry
from rockflex.web._download import download
from rockflex.web._records import record_view
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_state
from rockflex.web._uploads import KEPT, Uploads, clean_name, read_matrices, read_record, read_vertical

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
    motion, expected = read_record(name, content, None, None), rf.read_motion(tmp_path / name)
    assert np.array_equal(motion.acceleration, expected.acceleration)
    assert (motion.dt, motion.name) == (expected.dt, expected.name)


def test_a_column_may_be_vertical_and_comes_back(client, tmp_path) -> None:
    content = b"time (s),acc (m/s2),vertical (m/s2)\n0,0,0\n0.01,1,0.5\n0.02,0,0\n"
    assert read_record("a.csv", content, None, None).vertical.tolist() == [0.0, 0.5, 0.0]
    alone = b"time (s),vertical (m/s2)\n0,0\n0.01,1\n0.02,0\n"
    assert "is a vertical component by its header or its name" in refusal(read_record, "a.csv", alone, None, None)
    uploads = Uploads()
    key = uploads.add(read_record("a.csv", content, None, None), content, "")
    state = parse_state(client.state() | {"record": {"source": "upload", "upload": key}})
    name, saved = download(state, "record", uploads)[0::2]
    (tmp_path / name).write_bytes(saved)
    assert rf.read_motion(tmp_path / name).vertical.tolist() == [0.0, 0.5, 0.0]
    told = record_view(state, None, uploads)["measures"]
    assert [each["value"] for each in told if each["name"] in ("PVA", "PVA/PGA")] == [0.5, 0.5]


def test_files_of_networks() -> None:
    east = read_record("MYG0020601182325.EW", knet("E-W").encode(), None, None)
    assert (east.name, east.metadata.source_format, east.metadata.direction) == (
        "MYG0020601182325",
        "K-NET",
        "horizontal",
    )
    up = read_vertical("MYG0020601182325.UD", knet("U-D").encode(), None, None, east)
    assert np.array_equal(up.vertical, east.acceleration)
    assert read_record("a.asc", esm().encode(), None, None).pga == 0.12125
    said = refusal(read_record, "a.v2c", (cosmos(90) + cosmos(180)).encode(), None, None)
    assert said == "a.v2c holds 2 components: '090', '180'. Choose a file with a single one."


def test_a_name_with_folders_is_no_path(tmp_path) -> None:
    motion = read_record("../../etc/pass wd<b>.csv", CSV, None, None)
    assert motion.name == "pass wd_b_"
    assert clean_name("C:\\temp\\..\\a.csv") == "a.csv"
    assert clean_name("/") == "record"
    assert len(clean_name("x" * 500)) == 80


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
    assert text in refusal(read_record, "mine.txt", content, None, None)


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
        refusal(read_record, name, content, None, None)


@given(st.binary(max_size=400) | st.text("0123456789.eE+-,; \t\n()[]#NPTSDT=", max_size=300).map(str.encode))
def test_any_bytes_are_a_record_or_a_refusal(content) -> None:
    for name in ("mine.at2", "mine.csv"):
        with suppress(Refusal):
            assert np.isfinite(read_record(name, content, "g", 0.01).acceleration).all()


@given(st.data())
def test_a_record_with_a_slip_is_read_or_refused(data) -> None:
    content = bytearray(data.draw(st.sampled_from([CSV, AT2])))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with suppress(Refusal):
        read_record("mine.at2", bytes(content), None, None)


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
    found = read_matrices("fe.npz", npz(mass=m, stiffness=k, heights=h), "")
    assert found == {"mass": m.tolist(), "stiffness": k.tolist(), "heights": h.tolist()}
    assert read_matrices("k.csv", b"4,-2\n-2,2\n", "stiffness") == {"stiffness": k.tolist()}
    assert read_matrices("h.csv", b"3\n6\n", "heights") == {"heights": [3.0, 6.0]}


NAN = np.nan
BAR = {"mass": [30e3, 0.0, 80e3, 0.0], "stiffness": beam(16.0, 4e9)}
SCALARS = {"base_mass": 60e3, "half_width": 1.8, "damping_ratio": 0.02}


@pytest.mark.parametrize(
    "heights",
    [[8.0, NAN, 16.0, NAN], [8.0, 8.0, 16.0, 16.0], [8.0, 0.0, 16.0, 0.0], [8.0, 16.0], [[0.0, 8.0], [2.0, 16.0]]],
)
def test_rotations_are_imported_in_any_layout(client, heights) -> None:
    expected = rf.from_matrices(**BAR, heights={0: 8.0, 2: 16.0}, rotations=[1, 3], **SCALARS)
    found = read_matrices("fe.npz", npz(**BAR, heights=heights, rotations=[1, 3]), "")
    view = client.ask("/api/structure", client.state(structure={"matrices": found | SCALARS}))
    periods = [mode["period"] for mode in view["modes"]]
    np.testing.assert_allclose(periods, expected.modal().period, rtol=1e-12)
    assert [each["value"] for each in view["properties"] if each["symbol"] == "I_θ"] == pytest.approx(
        [expected.rocking().i_theta], rel=1e-12
    )
    assert view["freedoms"] == "Degrees of freedom: 2 sideways, 2 rotational. Without mass, and condensed out: 2."
    state = client.state(structure={"matrices": found | SCALARS})
    _, toml = client.download("/api/download/structure", state)
    again = StructureEntry.model_validate(tomllib.loads(toml.decode())).build()
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
    assert read_matrices("a.csv", content, part) == {part: found}


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
    assert text in refusal(read_matrices, name, content, part)


def test_a_file_that_unpacks_to_gigabytes_is_refused_before_it_is_unpacked() -> None:
    file = io.BytesIO()
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (50_000, 50_000)})
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("stiffness.npy", header.getvalue() + bytes(4_000_000))
    assert "numbers for up to 200 freedoms" in refusal(read_matrices, "k.npz", file.getvalue(), "")


@given(st.binary(max_size=300))
def test_any_bytes_are_matrices_or_a_refusal(content) -> None:
    for name in ("k.npz", "k.csv"):
        with suppress(Refusal):
            read_matrices(name, content, "mass")


def test_the_latest_records_are_kept_by_their_checksum() -> None:
    kept, motion = Uploads(), rf.quiet_motion(1.0)
    keys = [kept.add(motion, bytes([i]), "") for i in range(KEPT + 1)]
    assert kept.get(keys[-1]) is motion
    with pytest.raises(Refusal, match=r"which a link does not contain\. Choose the file again\.") as caught:
        kept.get(keys[0])
    assert caught.value.status == 410


def test_a_vertical_component_joins_its_record_and_contradictions_are_told(tmp_path):
    along = read_record("a.csv", CSV, None, None)
    rows = "".join(f"{along.dt * i:.4f},{0.1 * i}\n" for i in range(along.acceleration.size))
    both = read_vertical("up.csv", f"time (s),vertical (m/s2)\n{rows}".encode(), None, None, along)
    np.testing.assert_array_equal(both.acceleration, along.acceleration)
    assert both.vertical.tolist() == pytest.approx([0.1 * i for i in range(along.acceleration.size)])
    assert both.name == "a"
    east = f"Event, 1/1/2001, Station, 090\nUNITS OF G\nNPTS= 4, DT= {along.dt}\n0 .3 -.2 0\n"
    with pytest.raises(Refusal) as raised:
        read_vertical("RSN1_X_ABC090.AT2", east.encode(), None, None, along)
    assert "is a horizontal component" in raised.value.errors["record.vertical"]
    with pytest.raises(Refusal) as raised:
        read_vertical("up.csv", b"nothing\n", None, None, along)
    assert raised.value.errors["record.vertical"].startswith("up.csv")


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
