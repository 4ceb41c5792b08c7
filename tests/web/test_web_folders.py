"""Folders of records: what the library reads is what the server has, and archives of strangers do no harm."""

import asyncio
import io
import json
import tomllib
import zipfile
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest

import rockflex as rf
from rockflex.web import _folder_requests
from rockflex.web._folders import Folders, read_folder
from rockflex.web._limits import FILE, FILES, FOLDER
from rockflex.web._refusal import Refusal
from rockflex.web._unpacking import GivenFile, flat_names, unpacked

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


def refused(call, *arguments) -> str:
    with pytest.raises(Refusal) as caught:
        call(*arguments)
    (text,) = caught.value.errors.values()
    assert "/tmp" not in text
    return text


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
    # The page asks again after it was reloaded.
    assert json.loads(client.request(f"/api/folder/{found['folder']}")[2]) == found


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
    _, token = client.post("/api/study/cloud", {"state": state})
    assert client.wait("cloud", token["token"], state)["status"] == "done"
    table = client.download(f"/api/study/cloud/{token['token']}/table", state)[1]
    name, packed = client.download("/api/download/records", state)
    assert name == "your-records.zip"
    zipfile.ZipFile(io.BytesIO(packed)).extractall(tmp_path / "records")
    suite = rf.read_suite(tmp_path / "records")
    assert [motion.vertical is not None for motion in suite] == [True, True, False]
    assert suite["RSN7_TEST000"].metadata.magnitude == 6.6
    runs = rf.run_cloud(frame, suite, ["2DOF-S"], scales=[2.0, 4.0], free_vibration="settle")
    import pandas as pd

    told = pd.read_csv(io.BytesIO(table)).sort_values(["motion", "scale"])
    assert told["max_rotation"].to_numpy() == pytest.approx(
        runs.sort_values(["motion", "scale"])["max_rotation"].to_numpy(), rel=1e-12
    )
    text = client.download("/api/download/cloud-study", state)[1].decode()
    assert "# Unpack the records, which the page saves as records.zip, into the folder records" in text
    (tmp_path / "cloud.toml").write_text(text)
    records = tomllib.loads(text)["records"]
    assert rf.CloudStudy(**tomllib.loads(text)).read_from(tmp_path).plan().n_runs == 6
    assert records["folder"] == "records"
    monkeypatch.chdir(tmp_path)
    program = client.download("/api/download/cloud-python", state)[1].decode()
    space: dict = {}
    exec(program, space)
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
        assert "points out of its folder" in refused(unpacked, body)


def test_archives_that_grow_are_refused() -> None:
    zeros = b"0\n" * (FILE // 2 - 10)
    bomb = zipped({f"{i}.txt": zeros for i in range(FOLDER // len(zeros) + 1)})
    assert len(bomb) < FOLDER / 50
    assert refused(unpacked, body_of({"bomb.zip": bomb})) == (
        "the files have more than 80 MB, which is more than the page takes. Choose fewer."
    )
    single = zipped({"a.AT2": at2(0.2).encode(), "large.txt": b"0\n" * FILE})
    files = {each.name: each for each in unpacked(body_of({"one.zip": single}))}
    assert files["large.txt"].content is None
    assert files["a.AT2"].content is not None
    many = zipped({f"{i}.txt": b"" for i in range(FILES + 1)})
    assert "501 files, but the page takes 500" in refused(unpacked, body_of({"many.zip": many}))
    assert "more than 500 files" in refused(unpacked, body_of({f"{i}.txt": b"" for i in range(FILES + 1)}))
    assert "more than 500 files" in refused(unpacked, body_of({"x.zip": b"PK\x03\x04" + b"PK\x01\x02" * 2000}))
    book = zipped({"xl/workbook.xml": b"0" * (FOLDER + 1)})
    assert "more than 80 MB" in refused(unpacked, body_of({"book.xlsx": book}))


def test_damaged_requests_and_archives_are_refused(client) -> None:
    assert "damaged archive" in refused(unpacked, body_of({"a.zip": b"PK\x03\x04 and no more"}))
    assert refused(unpacked, body_of({})) == "there is no file in it."
    for body in (b"", b"no list\n", b"{}\n", b'[{"name": 3}]\n', b'[{"name": "a", "size": 9, "sent": true}]\nabc',
                 b"[]\nabc", b'[{"name": "a", "size": -1, "sent": true}]\n', b"[" * 3000 + b"\n"):  # fmt: skip
        status, answer = give(client, body)
        assert 400 <= status < 500, (body, answer)
    status, answer = give(client, body_of({"a.txt": b"no numbers\n"}))
    assert status == 422
    assert "none of the files is a horizontal record" in answer["errors"]["record.folder"]
    assert "a.txt: a.txt holds no numbers" in answer["errors"]["record.folder"]
    assert "holds no record" in give(client, body_of({"a.png": b"x"}))[1]["errors"]["record.folder"]
    status, answer = give(client, body_of(GIVEN), "?dt=fast")
    assert answer["errors"]["record.folder"] == "the sampling step must be a number in s, but 'fast' was given."


def test_names_in_one_folder_differ_and_are_short() -> None:
    names = flat_names(["a/x.txt", "b/x.txt", "b/X.TXT", "x.txt", "a/" + "y" * 300 + ".AT2", "c/a<b>|?.csv", "a/."])
    assert len({name.casefold() for name in names}) == len(names)
    assert max(map(len, names)) < 100
    assert names[4].endswith(".AT2")
    long = flat_names(["\N{VOLCANO}" * 75 + ".csv", "b/" + "\N{VOLCANO}" * 75 + ".csv", "c." + "\N{VOLCANO}" * 75] * 2)
    assert len(set(long)) == 6
    assert all(len(name.encode()) <= 255 and name.isprintable() for name in long)
    assert not any(set('<>:"|?*/\\') & set(name) for name in names)


def test_records_too_long_are_left_out_and_files_of_one_name_are_told_apart() -> None:
    long = at2(0.2, n=3101, dt=0.1).encode()
    same = b"time (s),acc (m/s2)\n0.00,0\n0.02,1\n0.04,0\n"
    found = read_folder(
        [GivenFile("long.AT2", long, len(long)), GivenFile("x.csv", same, len(same)), GivenFile("x.txt", same, 1)],
        None,
        None,
    )
    assert found.along.names == ("x-1", "x-2")
    entry = next(each for each in found.report["entries"] if each["file"] == "long.AT2")
    assert not entry["taken"]
    assert "3101 samples over 310 s, but the page takes" in entry["reason"]
    large = read_folder([GivenFile("x.csv", same, 40), GivenFile("big.csv", None, 7_000_000)], None, None)
    assert large.report["entries"][0]["reason"] == "it has 7.0 MB, but the page takes files of 5 MB at most"


def test_only_as_many_folders_are_kept_as_there_is_room_for(monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._folders.SAMPLES_KEPT", 300)
    folders, tokens = Folders(), []
    for size in (0.1, 0.2, 0.3):
        files = [GivenFile("a.AT2", at2(size).encode(), 1)]
        tokens.append(folders.add(read_folder(files, None, None), files, ""))
    assert "Give the folder again" in refused(folders.get, tokens[0])
    assert folders.get(tokens[2]).along[0].pga == pytest.approx(0.3 * 9.81, rel=0.01)


def test_only_a_few_folders_are_received_at_once(monkeypatch) -> None:
    body, inside, seen = body_of(GIVEN), [0], list[int]()

    async def file_of(*_: object) -> bytes:
        inside[0] += 1
        await asyncio.sleep(0.01)
        return body

    async def answer(work, _most: int):
        await asyncio.sleep(0.01)
        found = work()
        seen.append(inside[0])
        inside[0] -= 1
        return found

    monkeypatch.setattr(_folder_requests, "file_of", file_of)
    request = SimpleNamespace(query_params={})
    give_, _ = _folder_requests.folder_routes(answer, Folders())

    async def all_at_once() -> list[int]:
        return [each.status_code for each in await asyncio.gather(*(give_.endpoint(request) for _ in range(8)))]

    with ThreadPoolExecutor() as pool:  # the thread of the tests may have the event loop of a browser
        assert pool.submit(lambda: asyncio.run(all_at_once())).result() == [200] * 8
    assert max(seen) == _folder_requests.ROOM
